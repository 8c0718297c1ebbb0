//! Extended superellipsoids whose exponents follow the geometric angles (FORMULAS §5, form b).
//!
//! The exponents are splines, linear in their values: `f(η) = Σ v_j B_j(η)` with the spline `B_j` through 1 at the knot
//! j and 0 at the others.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI, TAU};

use nalgebra::Rotation3;

use super::GenericShape;
use super::jet::Jet;
use super::member::{AXES, Body, Member, Range, range};
use super::search::Ground;
use crate::Vector;
use crate::numeric::spline::Spline;
use crate::shape::{ExtendedSuperellipsoid, InvalidShape};
use crate::surface::Solid;

/// The shape clamps exponents to this range.
const CLAMPED: [f64; 2] = [0.05, 2.5];

#[derive(Clone, Debug)]
pub(super) struct Extended {
    profile: Vec<Spline>,
    section: Vec<Spline>,
}

impl Extended {
    pub(super) fn new(profile: usize, section: usize) -> Self {
        let units = |count: usize, spline: &dyn Fn(&[f64]) -> Spline| {
            let unit = |j: usize| (0..count).map(|i| f64::from(i == j)).collect::<Vec<_>>();
            (0..count).map(|j| spline(&unit(j))).collect::<Vec<_>>()
        };
        Self {
            profile: units(profile, &|v| Spline::natural(v, -FRAC_PI_2, FRAC_PI_2)),
            section: units(section, &|v| Spline::periodic(v, -PI, TAU)),
        }
    }
}

/// The exponent at an angle.
fn exponent(basis: &[Spline], values: &[Jet], angle: &Jet) -> Jet {
    let mut sum = [0.0; 3];
    let mut own = Jet::constant(0.0);
    for (spline, v) in basis.iter().zip(values) {
        let at = spline.derivatives(angle.value);
        for (s, b) in sum.iter_mut().zip(at) {
            *s += v.value * b;
        }
        for (i, by) in v.lanes.iter().enumerate().filter(|(_, by)| **by != 0.0) {
            own.lanes[i] += at[0] * by;
            own.mixed[i] += at[1] * angle.along * by;
        }
    }
    let [low, high] = CLAMPED;
    if sum[0] < low || sum[0] > high {
        return Jet::constant(sum[0].clamp(low, high));
    }
    angle.chain(sum) + own
}

impl Member for Extended {
    const POSED: bool = true;

    fn range(&self, number: usize) -> Range {
        if number < 3 { range(AXES[0], AXES[1], 0.7) } else { range(0.1, 2.2, 0.3) }
    }

    fn log_gauge(&self, numbers: &[Jet], [x, y, z]: &[Jet; 3]) -> Jet {
        let Some(([a, b, c], exponents)) = numbers.split_first_chunk::<3>() else {
            return Jet::constant(0.0);
        };
        let (profile, section) = exponents.split_at(self.profile.len().min(exponents.len()));
        let (u, v, w) = (*x * (-*a).exp(), *y * (-*b).exp(), *z * (-*c).exp());
        let eta = Jet::atan2(&w, &(u * u + v * v).sqrt());
        let f1 = exponent(&self.profile, profile, &eta);
        let f2 = exponent(&self.section, section, &Jet::atan2(&v, &u));
        let planar = Jet::layer(&u.log(), &v.log(), &f2);
        Jet::layer(&planar, &w.log(), &f1)
    }

    fn shape(&self, numbers: &[f64], scale: f64) -> Result<GenericShape, InvalidShape> {
        let (axes, exponents) = numbers.split_at(numbers.len().min(3));
        let (profile, section) = exponents.split_at(self.profile.len().min(exponents.len()));
        let axes = std::array::from_fn(|k| axes.get(k).map_or(0.0, |a| a.exp() * scale));
        let shape = ExtendedSuperellipsoid::new(axes, profile, section)?.radial();
        Ok(GenericShape::Solid(Solid::RadialExtended(Box::new(shape))))
    }
}

impl Extended {
    /// Superellipsoids of constant exponents in all roles of their axes, also turned by 45 degrees, each with the
    /// knots of the section at all places that a quarter turn can give them.
    pub(super) fn starts(&self, ground: &Ground) -> Vec<Body<Self>> {
        let mut out = Vec::new();
        for frame in ground.frames.iter().flat_map(|f| f.roles()) {
            let [e1, e2] = frame.exponents;
            let [a, b, c] = frame.half.map(f64::ln);
            // equal axes have nearly the same outline with ε2 -> 2 - ε2
            let mean = 0.5 * (a + b + (1.0 - e2) * LN_2);
            let straight = ([[a, b, c], [b, a, c]], [e1, e2], 0.0);
            let dual = ([[mean, mean, c]; 2], [e1, 2.0 - e2], FRAC_PI_4);
            for (axes, exponents, turn) in [straight, dual] {
                for quarter in 0..self.quarters() {
                    let turn = turn + FRAC_PI_2 * f64::from(quarter);
                    let rotation = frame.rotation * Rotation3::new(Vector::z() * turn);
                    let [even, odd] = axes;
                    let axes = if quarter % 2 == 0 { even } else { odd };
                    out.push(self.body(axes, exponents, frame.position, rotation));
                }
            }
        }
        out
    }

    /// Quarter turns about z that move the knots of the section to other places.
    fn quarters(&self) -> u8 {
        match self.section.len() {
            n if n == 1 || n % 4 == 0 => 1,
            n if n % 2 == 0 => 2,
            _ => 4,
        }
    }

    fn body(
        &self,
        axes: [f64; 3],
        exponents: [f64; 2],
        position: Vector,
        rotation: Rotation3<f64>,
    ) -> Body<Self> {
        let [e1, e2] = exponents.map(|e| e.clamp(0.2, 1.8));
        let mut numbers = axes.to_vec();
        numbers.extend(std::iter::repeat_n(e1, self.profile.len()));
        numbers.extend(std::iter::repeat_n(e2, self.section.len()));
        Body { member: self.clone(), numbers, position, rotation }
    }
}
