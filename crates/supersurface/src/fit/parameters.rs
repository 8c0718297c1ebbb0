//! The numbers that are estimated, in the coordinates in which the solver moves them.

use nalgebra::Rotation3;

use super::centred::Placement;
use crate::Vector;
use crate::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use crate::surface::Surface;

/// Number of parameters of all families together: `ln a1..a3`, `a4`, `ε1`, `ε2`, position, rotation vector about the
/// body's own axes, slopes of the taper, turns of the twist, curvature vector of the bend.
pub(super) const COUNT: usize = 17;
/// One row of a Jacobian, or one step, in the order of [`COUNT`].
pub(super) type Row = [f64; COUNT];

/// Index of the ring ratio in a [`Row`].
pub(super) const RING: usize = 3;
/// Index of the first exponent in a [`Row`].
pub(super) const EXPONENT: usize = 4;
/// Index of the first coordinate of the position in a [`Row`].
pub(super) const POSITION: usize = 6;
/// Index of the first coordinate of the rotation vector in a [`Row`].
pub(super) const ROTATION: usize = 9;
/// Index of the first slope of the taper in a [`Row`].
pub(super) const TAPER: usize = 12;
/// Index of the turns of the twist in a [`Row`].
pub(super) const TWIST: usize = 14;
/// Index of the first coordinate of the bend's curvature in a [`Row`].
pub(super) const BEND: usize = 15;

/// Exponents stay in this range: at 0 edges are sharp, at 2 sections are diamonds.
pub(super) const EXPONENTS: [f64; 2] = [0.05, 1.99];
/// Ring ratios stay in this range: under 1.01 the hole is a needle, over 15 the tube is a wire.
pub(super) const RINGS: [f64; 2] = [1.01, 15.0];
/// Slopes of tapers stay in this range: at 1 an end is an edge.
const SLOPES: [f64; 2] = [-0.97, 0.97];
/// Turns of twists stay in this range.
const TURNS: [f64; 2] = [-1.0, 1.0];
/// Half the angle of a bend stays below this, in radians.
const BENDING: f64 = 2.2;

/// The families that can be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// Box, cylinder, ellipsoid and what lies between.
    Superellipsoid,
    /// Ring, roll, rim.
    Supertoroid,
    /// A superellipsoid whose sections grow along its z axis: cups, cones, wedges.
    Tapered,
    /// A superellipsoid whose z axis is a circle's arc: bananas, handles.
    Bent,
    /// A superellipsoid whose sections turn along its z axis.
    Twisted,
    /// A tapered superellipsoid, bent: horns.
    TaperedBent,
}

impl Family {
    /// Every family, the simplest first.
    pub const ALL: [Self; 6] = [
        Self::Superellipsoid,
        Self::Supertoroid,
        Self::Tapered,
        Self::Bent,
        Self::Twisted,
        Self::TaperedBent,
    ];

    /// This family as the only one to choose from.
    pub const fn alone(self) -> &'static [Self] {
        match self {
            Self::Superellipsoid => &[Self::Superellipsoid],
            Self::Supertoroid => &[Self::Supertoroid],
            Self::Tapered => &[Self::Tapered],
            Self::Bent => &[Self::Bent],
            Self::Twisted => &[Self::Twisted],
            Self::TaperedBent => &[Self::TaperedBent],
        }
    }

    /// The name that files and programs use.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Superellipsoid => "superellipsoid",
            Self::Supertoroid => "supertoroid",
            Self::Tapered => "tapered",
            Self::Bent => "bent",
            Self::Twisted => "twisted",
            Self::TaperedBent => "tapered_bent",
        }
    }

    pub(super) const fn is_ring(self) -> bool {
        matches!(self, Self::Supertoroid)
    }

    pub(super) const fn is_tapered(self) -> bool {
        matches!(self, Self::Tapered | Self::TaperedBent)
    }

    pub(super) const fn is_twisted(self) -> bool {
        matches!(self, Self::Twisted)
    }

    pub(super) const fn is_bent(self) -> bool {
        matches!(self, Self::Bent | Self::TaperedBent)
    }

    /// True for what a taper, a twist or a bend makes of a superellipsoid.
    pub const fn is_deformed(self) -> bool {
        self.is_tapered() || self.is_twisted() || self.is_bent()
    }

    /// True for parameters that the family has.
    pub(super) const fn has(self, index: usize) -> bool {
        match index {
            RING => self.is_ring(),
            12 | 13 => self.is_tapered(),
            TWIST => self.is_twisted(),
            15 | 16 => self.is_bent(),
            _ => true,
        }
    }

    /// Number of parameters.
    pub(super) fn freedoms(self) -> usize {
        (0..COUNT).filter(|i| self.has(*i)).count()
    }
}

/// A body of one family. The deformations count from the middle: a twist turns the section at `z` by `n π z/a3`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    pub(super) family: Family,
    pub(super) log_axes: [f64; 3],
    /// Ring ratio `a4`; only used by the supertoroid.
    pub(super) ring: f64,
    pub(super) exponents: [f64; 2],
    pub(super) position: Vector,
    pub(super) rotation: Rotation3<f64>,
    /// Slopes `[Kx, Ky]`.
    pub(super) taper: [f64; 2],
    /// Full turns over the height.
    pub(super) twist: f64,
    /// Curvature `k (cos α, sin α)`, in 1/length.
    pub(super) bend: [f64; 2],
}

impl Parameters {
    /// A ball of radius 1 at the origin.
    pub(super) fn ball(family: Family) -> Self {
        Self {
            family,
            log_axes: [0.0; 3],
            ring: 2.0,
            exponents: [1.0; 2],
            position: Vector::zeros(),
            rotation: Rotation3::identity(),
            taper: [0.0; 2],
            twist: 0.0,
            bend: [0.0; 2],
        }
    }

    /// Half extents along the body's own axes before it is deformed.
    pub(super) fn half_extents(&self) -> [f64; 3] {
        let outer = if self.family.is_ring() { 1.0 + self.ring } else { 1.0 };
        let [a, b, c] = self.log_axes.map(f64::exp);
        [a * outer, b * outer, c]
    }

    /// Their logarithms.
    pub(super) fn log_half_extents(&self) -> [f64; 3] {
        let outer = if self.family.is_ring() { (1.0 + self.ring).ln() } else { 0.0 };
        let [a, b, c] = self.log_axes;
        [a + outer, b + outer, c]
    }

    /// Where the deformations take a point of the undeformed body, in the body's frame.
    pub(super) fn deformed(&self, p: &Vector) -> Vector {
        let mut q = *p;
        if !self.family.is_deformed() {
            return q;
        }
        let height = self.log_axes[2].exp();
        if self.family.is_tapered() {
            q.x *= 1.0 + self.taper[0] * p.z / height;
            q.y *= 1.0 + self.taper[1] * p.z / height;
        }
        if self.family.is_twisted() {
            let (sin, cos) = (self.twist * std::f64::consts::PI * p.z / height).sin_cos();
            q = Vector::new(cos * q.x - sin * q.y, sin * q.x + cos * q.y, q.z);
        }
        let [bx, by] = self.bend;
        let k = bx.hypot(by);
        if self.family.is_bent() && k > 1e-12 {
            let (sin, cos) = (k * q.z).sin_cos();
            let inwards = (bx * q.x + by * q.y) / k;
            let shift = (1.0 - cos) * (1.0 / k - inwards) / k;
            q = Vector::new(q.x + bx * shift, q.y + by * shift, sin * (1.0 / k - inwards));
        }
        q
    }

    /// Surface area, within about a tenth: between box, ellipsoid and octahedron by the mean exponent; for a
    /// toroid the ring's length times the tube's girth. Deformations change it little.
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.log_axes.map(f64::exp);
        if self.family.is_ring() {
            let girth = |u: f64, v: f64, e: f64| {
                let ellipse = std::f64::consts::TAU * (0.5 * (u * u + v * v)).sqrt();
                ellipse * (0.24 * (1.0 - e)).exp()
            };
            let ring = self.ring * girth(a, b, self.exponents[1]);
            return ring * girth(0.5 * (a + b), c, self.exponents[0]);
        }
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

    /// The parameters after a step, kept in their ranges; long steps are cut, so that one bad
    /// linearisation cannot throw the body away.
    pub(super) fn stepped(&self, step: &Row) -> Self {
        let mut next = *self;
        for i in 0..3 {
            next.log_axes[i] = (self.log_axes[i] + step[i].clamp(-0.7, 0.7)).clamp(-5.0, 2.5);
            next.position[i] += step[POSITION + i].clamp(-2.0, 2.0);
        }
        let moved = |value: f64, step: f64, most: f64, [low, high]: [f64; 2]| {
            (value + step.clamp(-most, most)).clamp(low, high)
        };
        next.ring = moved(self.ring, step[RING], 0.7, RINGS);
        for i in 0..2 {
            next.exponents[i] = moved(self.exponents[i], step[EXPONENT + i], 0.4, EXPONENTS);
            next.taper[i] = moved(self.taper[i], step[TAPER + i], 0.4, SLOPES);
        }
        next.twist = moved(self.twist, step[TWIST], 0.2, TURNS);
        let height = next.log_axes[2].exp();
        let longest = 0.5 / height;
        for i in 0..2 {
            next.bend[i] += step[BEND + i].clamp(-longest, longest);
        }
        let (curvature, most) = (next.bend[0].hypot(next.bend[1]), BENDING / height);
        if curvature > most {
            next.bend = next.bend.map(|b| b * most / curvature);
        }
        let turn = Vector::new(step[ROTATION], step[ROTATION + 1], step[ROTATION + 2]);
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
            12 | 13 => at(self.taper[index - TAPER], SLOPES),
            TWIST => at(self.twist, TURNS),
            _ => false,
        }
    }

    /// The posed surface where these coordinates are placed.
    pub(super) fn surface(&self, placement: &Placement) -> Result<Posed<Surface>, InvalidShape> {
        let scale = placement.scale;
        let axes = self.log_axes.map(|a| a.exp() * scale);
        let core = || Superellipsoid::new(axes, self.exponents);
        let [bx, by] = self.bend;
        let (curvature, angle) = (bx.hypot(by) / scale, by.atan2(bx));
        let surface = match self.family {
            Family::Superellipsoid => Surface::Superellipsoid(core()?),
            Family::Supertoroid => {
                Surface::Supertoroid(Supertoroid::new(axes, self.ring, self.exponents)?)
            }
            Family::Tapered => Surface::tapered(core()?, self.taper)?,
            Family::Twisted => Surface::twisted(core()?, self.twist)?,
            Family::Bent => Surface::bent(core()?, curvature, angle)?,
            Family::TaperedBent => Surface::tapered_bent(core()?, self.taper, curvature, angle)?,
        };
        let mut rotation = self.rotation;
        if self.family.is_twisted() {
            // equation 22 counts the turns from the lower end
            let back = -self.twist * std::f64::consts::PI;
            rotation *= Rotation3::new(Vector::z() * back);
        }
        let pose = placement.pose(&self.position, &rotation);
        Posed::new(surface, pose)
    }
}
