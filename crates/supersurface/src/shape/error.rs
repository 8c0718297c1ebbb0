//! What can be wrong with the numbers of a shape.

/// A value from which no shape can be made, with the range that it must lie in.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} is {value}: it must be {range}")]
pub struct InvalidShape {
    /// The quantity, in the field's words ("semi-axis a2").
    pub what: &'static str,
    /// The value that was given.
    pub value: f64,
    /// The range in words ("positive and finite").
    pub range: &'static str,
}

impl InvalidShape {
    /// `Ok` when `inside` holds, otherwise the error about `value`.
    pub(crate) fn check(
        inside: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        if inside { Ok(()) } else { Err(Self { what, value, range }) }
    }
}
