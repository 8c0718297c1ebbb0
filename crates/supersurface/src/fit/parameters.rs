//! The numbers that are estimated, in the coordinates in which the solver moves them.

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion};

use crate::Vector;
use crate::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use crate::surface::Surface;

/// Number of parameters of the largest family: `ln a1..a3`, `a4`, `ε1`, `ε2`, position, rotation
/// vector about the body's own axes.
pub(super) const COUNT: usize = 12;
/// One row of a Jacobian, or one step, in the order of [`COUNT`].
pub(super) type Row = [f64; COUNT];

/// Index of the ring ratio in a [`Row`].
pub(super) const RING: usize = 3;
/// Index of the first exponent in a [`Row`].
pub(super) const EXPONENT: usize = 4;

/// Exponents stay in this range (the practical range of FORMULAS §2).
pub(super) const EXPONENTS: [f64; 2] = [0.1, 1.9];
/// Ring ratios stay in this range: under 1.05 the hole is a needle, over 15 the tube is a wire.
pub(super) const RINGS: [f64; 2] = [1.05, 15.0];

/// The families that can be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Box, cylinder, ellipsoid and what lies between.
    Superellipsoid,
    /// Ring, roll, rim.
    Supertoroid,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    pub(super) family: Family,
    pub(super) log_axes: [f64; 3],
    /// Ring ratio `a4`; not used by the superellipsoid.
    pub(super) ring: f64,
    pub(super) exponents: [f64; 2],
    pub(super) position: Vector,
    pub(super) rotation: Rotation3<f64>,
}

impl Parameters {
    /// Half extents along the body's own axes.
    pub(super) fn half_extents(&self) -> [f64; 3] {
        let outer = match self.family {
            Family::Superellipsoid => 1.0,
            Family::Supertoroid => 1.0 + self.ring,
        };
        let [a, b, c] = self.log_axes.map(f64::exp);
        [a * outer, b * outer, c]
    }

    /// Surface area, within about a tenth: between box, ellipsoid and octahedron by the mean exponent; for a
    /// toroid the ring's length times the tube's girth.
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.log_axes.map(f64::exp);
        match self.family {
            Family::Superellipsoid => {
                let [ab, bc, ca] = [a * b, b * c, c * a];
                let box_area = 8.0 * (ab + bc + ca);
                // Knud Thomsen's formula with exponent 1.6 rounded to the power mean of squares and sum
                let squares = (ab * ab + bc * bc + ca * ca).sqrt();
                let mean = 0.6 * (ab + bc + ca) / 3.0 + 0.4 * squares / 3f64.sqrt();
                let ellipsoid = 4.0 * std::f64::consts::PI * mean;
                let octahedron = 4.0 * squares;
                let e = 0.5 * (self.exponents[0] + self.exponents[1]);
                let between = |low: f64, high: f64, t: f64| low * (t * (high / low).ln()).exp();
                if e <= 1.0 {
                    between(box_area, ellipsoid, e)
                } else {
                    between(ellipsoid, octahedron, e - 1.0)
                }
            }
            Family::Supertoroid => {
                let girth = |u: f64, v: f64, e: f64| {
                    let ellipse = std::f64::consts::TAU * (0.5 * (u * u + v * v)).sqrt();
                    ellipse * (0.24 * (1.0 - e)).exp()
                };
                self.ring
                    * girth(a, b, self.exponents[1])
                    * girth(0.5 * (a + b), c, self.exponents[0])
            }
        }
    }

    /// True for parameters that the family has.
    pub(super) fn is_active(&self, index: usize) -> bool {
        index != RING || self.family == Family::Supertoroid
    }

    /// The parameters after a step, kept in their ranges; long steps are cut, so that one bad
    /// linearisation cannot throw the body away.
    pub(super) fn stepped(&self, step: &Row) -> Self {
        let mut next = *self;
        for i in 0..3 {
            next.log_axes[i] = (self.log_axes[i] + step[i].clamp(-0.7, 0.7)).clamp(-5.0, 2.5);
            next.position[i] += step[6 + i].clamp(-2.0, 2.0);
        }
        next.ring = (self.ring + step[RING].clamp(-0.7, 0.7)).clamp(RINGS[0], RINGS[1]);
        for i in 0..2 {
            let e = self.exponents[i] + step[EXPONENT + i].clamp(-0.4, 0.4);
            next.exponents[i] = e.clamp(EXPONENTS[0], EXPONENTS[1]);
        }
        let turn = Vector::new(step[9], step[10], step[11]);
        next.rotation = self.rotation * Rotation3::new(turn.cap_magnitude(0.6));
        next
    }

    /// True when a downhill step along parameter `index` would leave its range.
    pub(super) fn is_held(&self, index: usize, gradient: f64) -> bool {
        let at = |v: f64, [low, high]: [f64; 2]| {
            (v <= low + 1e-9 && gradient > 0.0) || (v >= high - 1e-9 && gradient < 0.0)
        };
        match index {
            RING => at(self.ring, RINGS),
            4 | 5 => at(self.exponents[index - EXPONENT], EXPONENTS),
            _ => false,
        }
    }

    /// The posed surface, in the coordinates of these parameters times `scale` plus `centre`.
    pub(super) fn surface(
        &self,
        centre: &Vector,
        scale: f64,
    ) -> Result<Posed<Surface>, InvalidShape> {
        let axes = self.log_axes.map(|a| a.exp() * scale);
        let surface = match self.family {
            Family::Superellipsoid => {
                Surface::Superellipsoid(Superellipsoid::new(axes, self.exponents)?)
            }
            Family::Supertoroid => {
                Surface::Supertoroid(Supertoroid::new(axes, self.ring, self.exponents)?)
            }
        };
        let pose = Isometry3::from_parts(
            Translation3::from(self.position * scale + centre),
            UnitQuaternion::from_rotation_matrix(&self.rotation),
        );
        Posed::new(surface, pose)
    }
}
