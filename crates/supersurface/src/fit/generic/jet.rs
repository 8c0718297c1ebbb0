//! Numbers that carry what the derivative of a first-order distance needs.
//!
//! Of a function `l(x; θ)` the distance `(1 - e^-l)/|∇l|` asks for `l` and `∇l`, and its derivative by θ for those of
//! both. With the unit vector n of `∇l` held, `d|∇l| = d(∂l/∂n)`: so a [`Jet`] holds the value, the derivative along
//! one direction of space, those by some [`LANES`] parameters, and the mixed ones. Sums, products and the chain rule
//! then give the exact derivatives of any formula (forward differentiation, Griewank and Walther 2008).

use std::ops::{Add, Mul, Neg, Sub};

/// How many parameters are followed at once.
pub(super) const LANES: usize = 8;
/// Arguments of logarithms nearer to zero than this are pushed off it: the limits are the same.
const FLOOR: f64 = 1e-7;

/// Value, derivative along a direction, derivatives by parameters, and the mixed ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) along: f64,
    pub(super) lanes: [f64; LANES],
    pub(super) mixed: [f64; LANES],
}

impl Jet {
    pub(super) const fn constant(value: f64) -> Self {
        Self { value, along: 0.0, lanes: [0.0; LANES], mixed: [0.0; LANES] }
    }

    /// A function of this, from its value and two derivatives.
    #[inline]
    pub(super) fn chain(&self, [f, slope, bend]: [f64; 3]) -> Self {
        let turn = bend * self.along;
        Self {
            value: f,
            along: slope * self.along,
            lanes: std::array::from_fn(|i| slope * self.lanes[i]),
            mixed: std::array::from_fn(|i| slope * self.mixed[i] + turn * self.lanes[i]),
        }
    }

    /// A function of two, from its value, both slopes `[a, b]` and its second derivatives `[aa, ab, bb]`.
    #[inline]
    fn pair(a: &Self, b: &Self, value: f64, [fa, fb]: [f64; 2], [aa, ab, bb]: [f64; 3]) -> Self {
        let (to_a, to_b) = (aa * a.along + ab * b.along, ab * a.along + bb * b.along);
        let mixed =
            |i: usize| fa * a.mixed[i] + fb * b.mixed[i] + to_a * a.lanes[i] + to_b * b.lanes[i];
        Self {
            value,
            along: fa * a.along + fb * b.along,
            lanes: std::array::from_fn(|i| fa * a.lanes[i] + fb * b.lanes[i]),
            mixed: std::array::from_fn(mixed),
        }
    }

    pub(super) fn exp(&self) -> Self {
        let e = self.value.exp();
        self.chain([e, e, e])
    }

    /// `ln |f|`, not nearer to the zero than 1e-7.
    pub(super) fn log(&self) -> Self {
        let v = if self.value.abs() < FLOOR { FLOOR.copysign(self.value) } else { self.value };
        self.chain([v.abs().ln(), 1.0 / v, -1.0 / (v * v)])
    }

    pub(super) fn inverse(&self) -> Self {
        let r = 1.0 / self.value;
        self.chain([r, -r * r, 2.0 * r * r * r])
    }

    pub(super) fn sqrt(&self) -> Self {
        let r = self.value.max(FLOOR * FLOOR).sqrt();
        self.chain([r, 0.5 / r, -0.25 / (r * r * r)])
    }

    pub(super) fn cos_sin(&self) -> [Self; 2] {
        let (s, c) = self.value.sin_cos();
        [self.chain([c, -s, -c]), self.chain([s, c, -s])]
    }

    /// The angle of `(x, y)`.
    pub(super) fn atan2(y: &Self, x: &Self) -> Self {
        let (u, v) = (y.value, x.value);
        let square = (u * u + v * v).max(FLOOR * FLOOR);
        let (cross, rest) = (2.0 * u * v / square, (u * u - v * v) / square);
        let second = [-cross / square, rest / square, cross / square];
        Self::pair(y, x, u.atan2(v), [v / square, -u / square], second)
    }

    /// `ln (1 + e^f)`.
    fn soft_plus(&self) -> Self {
        let t = (-self.value.abs()).exp();
        let (major, minor) = (1.0 / (1.0 + t), t / (1.0 + t));
        let share = if self.value > 0.0 { major } else { minor };
        self.chain([self.value.max(0.0) + t.ln_1p(), share, major * minor])
    }

    /// `ln (e^a + e^b)`.
    pub(super) fn log_sum(a: &Self, b: &Self) -> Self {
        if a.value > b.value { *a + (*b - *a).soft_plus() } else { *b + (*a - *b).soft_plus() }
    }

    /// `ln (e^(2a/ε) + e^(2b/ε))^(ε/2)`: a layer of a superquadric's gauge.
    pub(super) fn layer(a: &Self, b: &Self, exponent: &Self) -> Self {
        let (large, small) = if a.value > b.value { (a, b) } else { (b, a) };
        let spread = (*small - *large) * exponent.inverse() * 2.0;
        *large + spread.soft_plus() * *exponent * 0.5
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            along: self.along + other.along,
            lanes: std::array::from_fn(|i| self.lanes[i] + other.lanes[i]),
            mixed: std::array::from_fn(|i| self.mixed[i] + other.mixed[i]),
        }
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    #[inline]
    fn add(mut self, number: f64) -> Self {
        self.value += number;
        self
    }
}

impl Neg for Jet {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Jet {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    #[inline]
    fn mul(self, by: f64) -> Self {
        self.chain([self.value * by, by, 0.0])
    }
}

impl Mul for Jet {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        Self::pair(&self, &other, value, [other.value, self.value], [0.0, 1.0, 0.0])
    }
}
