//! Support points of a convex tapered superellipsoid.
//!
//! Its section at the height `z = a3 t` is the superellipse of the half widths `a1 (1 + Kx t) r(t)`, `a2 (1 + Ky t) r(t)`
//! with the profile `r(t) = (1 - |t|^(2/ε1))^(ε1/2)`. Towards a direction a section reaches `‖(w1 n_x, w2 n_y)‖_q2`; the
//! solid is convex if that is a concave function of `t` for all directions across z, and then `a3 t n_z` plus it has
//! one maximum.

use std::f64::consts::{FRAC_PI_2, TAU};

use supersurface::deform::{Deformed, Taper};
use supersurface::numeric::powers::{quadrant_cos_sin, signed_power};
use supersurface::numeric::superellipse::dual_norm;
use supersurface::shape::{Superellipsoid, SupportMap};
use supersurface::{Point, Vector};

/// Golden sections of a quarter of a turn: to 1e-9.
const STEPS: usize = 44;
/// Heights and directions at which concavity is looked at.
const CHECKED: [usize; 2] = [200, 16];

#[derive(Clone, Debug)]
pub(super) struct Tapered {
    solid: Deformed<Superellipsoid, Taper>,
}

impl Tapered {
    /// `None` for a solid that is not convex.
    pub(super) fn new(solid: &Deformed<Superellipsoid, Taper>) -> Option<Self> {
        let tapered = Self { solid: *solid };
        tapered.is_convex().then_some(tapered)
    }

    pub(super) const fn shape(&self) -> &Deformed<Superellipsoid, Taper> {
        &self.solid
    }

    /// `(t, r)` at an angle of the profile.
    fn profile(&self, eta: f64) -> [f64; 2] {
        let [e1, _] = self.solid.shape().exponents();
        let (cos, sin) = quadrant_cos_sin(eta);
        [signed_power(sin, e1), signed_power(cos, e1)]
    }

    /// Half widths of the section.
    fn widths(&self, [t, r]: [f64; 2]) -> [f64; 2] {
        let [a, b, _] = self.solid.shape().semi_axes();
        let [kx, ky] = self.solid.deformation().slopes();
        [a * (1.0 + kx * t) * r, b * (1.0 + ky * t) * r]
    }

    fn across(&self, profile: [f64; 2], n: [f64; 2]) -> f64 {
        let [w1, w2] = self.widths(profile);
        dual_norm((w1 * n[0]).abs(), (w2 * n[1]).abs(), self.solid.shape().exponents()[1])
    }

    fn is_convex(&self) -> bool {
        let exponents = self.solid.shape().exponents();
        if exponents.iter().any(|e| *e > 2.0) {
            return false;
        }
        let [heights, directions] = CHECKED;
        let profiles: Vec<[f64; 2]> = (0..=heights)
            .map(|i| self.profile((i as f64 / heights as f64 * 2.0 - 1.0) * FRAC_PI_2))
            .collect();
        (0..=directions).all(|j| {
            let (sin, cos) = (0.25 * TAU * j as f64 / directions as f64).sin_cos();
            let reach: Vec<f64> = profiles.iter().map(|p| self.across(*p, [cos, sin])).collect();
            let size = reach.iter().copied().fold(0.0, f64::max);
            (1..heights).all(|i| {
                let [before, at, after] = [i - 1, i, i + 1].map(|k| profiles[k][0]);
                let share = if after > before { (at - before) / (after - before) } else { 0.5 };
                let chord = reach[i - 1] + (reach[i + 1] - reach[i - 1]) * share;
                reach[i] >= chord - 1e-9 * size
            })
        })
    }
}

impl SupportMap for Tapered {
    fn support_point(&self, n: &Vector) -> Point {
        let a3 = self.solid.shape().semi_axes()[2];
        let height = |eta: f64| {
            let profile = self.profile(eta);
            a3 * profile[0] * n.z + self.across(profile, super::planar(n))
        };
        let best = self.profile(super::highest(-FRAC_PI_2, FRAC_PI_2, STEPS, height));
        let [w1, w2] = self.widths(best);
        let e2 = self.solid.shape().exponents()[1];
        // the section as a flat superellipsoid
        let section = Superellipsoid::new([w1, w2, a3], [1.0, e2]);
        let p = section.map_or(Point::origin(), |s| s.support_point(&Vector::new(n.x, n.y, 0.0)));
        Point::new(p.x, p.y, a3 * best[0])
    }
}
