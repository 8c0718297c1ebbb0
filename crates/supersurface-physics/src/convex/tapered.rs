//! Support points of a convex tapered superellipsoid.
//!
//! Its section at the height `z = a3 t` is the superellipse of the half widths `a1 (1 + Kx t) r(t)`, `a2 (1 + Ky t) r(t)`
//! with the profile `r(t) = (1 - |t|^(2/ε1))^(ε1/2)`. Towards a direction a section reaches `g(t) r(t)` with the dual norm
//! `g = ‖(a1 (1 + Kx t) n_x, a2 (1 + Ky t) n_y)‖_q2`; the solid is convex if that is a concave function of `t` for all
//! directions across z. Then `a3 t n_z + g r` has one maximum, where the profile's slope is `-m = r'`,
//! `m g - g' r = a3 n_z`: a root in `m`, of which `t` and `r` are closed forms.

use std::f64::consts::{FRAC_PI_2, TAU};

use supersurface::deform::{Deformed, Taper};
use supersurface::numeric::powers::{quadrant_cos_sin, quick_power, signed_power};
use supersurface::numeric::superellipse::{dual_exponent, touched, weighted};
use supersurface::shape::{Superellipsoid, SupportMap};
use supersurface::{Point, Vector};

/// Steps of Newton's method, of which a handful is needed.
const STEPS: usize = 60;
/// Heights and directions at which concavity is looked at.
const CHECKED: [usize; 2] = [200, 16];
/// From this exponent on a section's or profile's corners are taken as sharp.
const SHARP: f64 = 2.0 - 1e-9;

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

    /// `[g, g']` at a height towards a direction.
    fn across(&self, t: f64, n: [f64; 2]) -> [f64; 2] {
        let [a, b, _] = self.solid.shape().semi_axes();
        let [_, e2] = self.solid.shape().exponents();
        let [kx, ky] = self.solid.deformation().slopes();
        let (fx, fy) = (1.0 + kx * t, 1.0 + ky * t);
        let reach =
            weighted((a * fx * n[0]).abs(), (b * fy * n[1]).abs(), dual_exponent(e2.min(SHARP)));
        [reach.norm, reach.norm * (reach.first * kx / fx + reach.second * ky / fy)]
    }

    fn is_convex(&self) -> bool {
        let exponents = self.solid.shape().exponents();
        if exponents.iter().any(|e| *e > 2.0) {
            return false;
        }
        let [heights, directions] = CHECKED;
        let profiles: Vec<[f64; 2]> = (0..=heights)
            .map(|i| {
                let (cos, sin) =
                    quadrant_cos_sin((i as f64 / heights as f64 * 2.0 - 1.0) * FRAC_PI_2);
                [sin, cos].map(|v| signed_power(v, exponents[0]))
            })
            .collect();
        (0..=directions).all(|j| {
            let (sin, cos) = (0.25 * TAU * j as f64 / directions as f64).sin_cos();
            let reach: Vec<f64> =
                profiles.iter().map(|[t, r]| r * self.across(*t, [cos, sin])[0]).collect();
            let size = reach.iter().copied().fold(0.0, f64::max);
            (1..heights).all(|i| {
                let [before, at, after] = [i - 1, i, i + 1].map(|k| profiles[k][0]);
                let share = if after > before { (at - before) / (after - before) } else { 0.5 };
                let chord = reach[i - 1] + (reach[i + 1] - reach[i - 1]) * share;
                reach[i] >= chord - 1e-9 * size
            })
        })
    }

    /// `[t, r]` of the highest place towards a direction.
    fn touched(&self, n: &Vector) -> [f64; 2] {
        let [e1, _] = self.solid.shape().exponents();
        let [kx, ky] = self.solid.deformation().slopes();
        let up = self.solid.shape().semi_axes()[2] * n.z;
        let [middle, slope] = self.across(0.0, [n.x, n.y]);
        let across = |t: f64| match kx == ky {
            true => [middle + slope * t, slope],
            false => self.across(t, [n.x, n.y]),
        };
        // straight up or down, or no direction at all
        if middle <= 1e-200 * up.abs() {
            return if up == 0.0 { [0.0, 1.0] } else { [1f64.copysign(up), 0.0] };
        }
        // as |g'| <= k/(1 - k) g and g >= (1 - k) g(0)
        let k = kx.abs().max(ky.abs());
        let reach = (up.abs() / middle + k) / (1.0 - k);
        let (mut low, mut high) = (-reach, reach);
        let mut m = up / middle;
        let mut place = [0.0, 1.0];
        for _ in 0..STEPS {
            let (found, turn) = profile(m, e1.min(SHARP));
            place = found;
            let [t, r] = place;
            let [g, slope] = across(t);
            let off = m * g - slope * r - up;
            if off > 0.0 {
                high = m
            } else {
                low = m
            }
            // without the term of g'', which is 0 for equal slopes
            let rate = g + 2.0 * slope * turn;
            let next = m - off / rate;
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (next - m).abs() <= 1e-9 * m.abs() || next == m {
                break;
            }
            m = next;
        }
        place
    }
}

/// Where the profile's slope is `-m`: `[t, r]`, and `m dt/dm`.
fn profile(m: f64, e1: f64) -> ([f64; 2], f64) {
    let (q, half) = (dual_exponent(e1), 0.5 * e1);
    let size = m.abs();
    // t/r = m^(q-1), and its power 2/ε1 is m^q: whichever is at most 1
    let steep = size > 1.0;
    let base = if steep { size.recip() } else { size };
    let ratio = if base > 0.0 { quick_power(base, q - 1.0) } else { 0.0 };
    let share = ratio * base;
    let long = quick_power(1.0 + share, -half);
    let (t, r) = if steep { (long, ratio * long) } else { (ratio * long, long) };
    let rest = if steep { share / (1.0 + share) } else { 1.0 / (1.0 + share) };
    let t = t.copysign(m);
    ([t, r], t * (q - 1.0) * rest)
}

impl SupportMap for Tapered {
    fn support_point(&self, n: &Vector) -> Point {
        let [a, b, a3] = self.solid.shape().semi_axes();
        let [kx, ky] = self.solid.deformation().slopes();
        let [t, r] = self.touched(n);
        let [_, e2] = self.solid.shape().exponents();
        let [a, b] = [a * (1.0 + kx * t) * r, b * (1.0 + ky * t) * r];
        let (_, [x, y]) = touched((a * n.x).abs(), (b * n.y).abs(), e2);
        Point::new((a * x).copysign(n.x), (b * y).copysign(n.y), a3 * t)
    }
}
