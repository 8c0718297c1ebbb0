//! Why there is no foundation, or no wrench.

/// What a foundation cannot work with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FoundationError {
    /// There is nothing to push at.
    #[error("the mesh has no triangle with an area")]
    NoArea,
    /// A number is out of its range.
    #[error("{what} is {value}: it must be {range}")]
    OutOfRange {
        /// The quantity, in the field's words ("stiffness").
        what: &'static str,
        /// The value that was given.
        value: f64,
        /// The range in words ("positive and finite").
        range: &'static str,
    },
    /// The numbers are too large for each other.
    #[error("the forces exceed the range of numbers")]
    Overflow,
}

impl FoundationError {
    pub(super) fn check(
        inside: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        if inside { Ok(()) } else { Err(Self::OutOfRange { what, value, range }) }
    }

    pub(super) fn positive(what: &'static str, value: f64) -> Result<(), Self> {
        Self::check(value > 0.0 && value.is_finite(), what, value, "positive and finite")
    }

    pub(super) fn not_negative(what: &'static str, value: f64) -> Result<(), Self> {
        Self::check(value >= 0.0 && value.is_finite(), what, value, "finite and not negative")
    }

    pub(super) fn finite<'a>(
        what: &'static str,
        values: impl IntoIterator<Item = &'a f64>,
    ) -> Result<(), Self> {
        values.into_iter().try_for_each(|v| Self::check(v.is_finite(), what, *v, "finite"))
    }
}
