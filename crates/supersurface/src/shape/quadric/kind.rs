//! The 17 types of quadrics (FORMULAS §1.1).

/// What a quadric is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum QuadricType {
    /// `x²/a² + y²/b² + z²/c² = 1` (equation 4).
    Ellipsoid,
    /// `-x²/a² - y²/b² - z²/c² = 1`: no real point.
    ImaginaryEllipsoid,
    /// `x²/a² + y²/b² + z²/c² = 0`.
    Point,
    /// `x²/a² + y²/b² - z²/c² = 1`.
    HyperboloidOneSheet,
    /// `x²/a² - y²/b² - z²/c² = 1`.
    HyperboloidTwoSheets,
    /// `x²/a² + y²/b² - z²/c² = 0`.
    EllipticCone,
    /// `x²/a² + y²/b² = z`.
    EllipticParaboloid,
    /// `x²/a² - y²/b² = z`.
    HyperbolicParaboloid,
    /// `x²/a² + y²/b² = 1`.
    EllipticCylinder,
    /// `-x²/a² - y²/b² = 1`: no real point.
    ImaginaryEllipticCylinder,
    /// `x²/a² + y²/b² = 0`.
    Line,
    /// `x²/a² - y²/b² = 1`.
    HyperbolicCylinder,
    /// `x²/a² - y²/b² = 0`.
    IntersectingPlanes,
    /// `x²/a² = z`.
    ParabolicCylinder,
    /// `x²/a² = 1`.
    ParallelPlanes,
    /// `-x²/a² = 1`: no real point.
    ImaginaryParallelPlanes,
    /// `x² = 0`.
    CoincidentPlanes,
}

/// The right side of a normal form `Σ squares_i x_i² = …`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RightSide {
    Zero,
    One,
    Z,
}

impl QuadricType {
    /// The type of a normal form with so many positive and negative squares. Without squares there is none;
    /// no quadric comes to that.
    pub(super) const fn of(positive: usize, negative: usize, right: RightSide) -> Self {
        match (positive, negative, right) {
            (3, _, RightSide::One) => Self::Ellipsoid,
            (3, _, _) => Self::Point,
            (2, 0, RightSide::One) => Self::EllipticCylinder,
            (2, 0, RightSide::Z) => Self::EllipticParaboloid,
            (2, 0, RightSide::Zero) => Self::Line,
            (2, _, RightSide::One) => Self::HyperboloidOneSheet,
            (2, _, _) => Self::EllipticCone,
            (1, 0, RightSide::One) => Self::ParallelPlanes,
            (1, 0, RightSide::Z) => Self::ParabolicCylinder,
            (1, 0, RightSide::Zero) => Self::CoincidentPlanes,
            (1, 1, RightSide::One) => Self::HyperbolicCylinder,
            (1, 1, RightSide::Z) => Self::HyperbolicParaboloid,
            (1, 1, RightSide::Zero) => Self::IntersectingPlanes,
            (1, _, _) => Self::HyperboloidTwoSheets,
            (_, 3, _) => Self::ImaginaryEllipsoid,
            (_, 2, _) => Self::ImaginaryEllipticCylinder,
            (_, _, _) => Self::ImaginaryParallelPlanes,
        }
    }

    /// Its name in words, with underscores ("hyperboloid_one_sheet").
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ellipsoid => "ellipsoid",
            Self::ImaginaryEllipsoid => "imaginary_ellipsoid",
            Self::Point => "point",
            Self::HyperboloidOneSheet => "hyperboloid_one_sheet",
            Self::HyperboloidTwoSheets => "hyperboloid_two_sheets",
            Self::EllipticCone => "elliptic_cone",
            Self::EllipticParaboloid => "elliptic_paraboloid",
            Self::HyperbolicParaboloid => "hyperbolic_paraboloid",
            Self::EllipticCylinder => "elliptic_cylinder",
            Self::ImaginaryEllipticCylinder => "imaginary_elliptic_cylinder",
            Self::Line => "line",
            Self::HyperbolicCylinder => "hyperbolic_cylinder",
            Self::IntersectingPlanes => "intersecting_planes",
            Self::ParabolicCylinder => "parabolic_cylinder",
            Self::ParallelPlanes => "parallel_planes",
            Self::ImaginaryParallelPlanes => "imaginary_parallel_planes",
            Self::CoincidentPlanes => "coincident_planes",
        }
    }
}
