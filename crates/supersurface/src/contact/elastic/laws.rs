//! Three laws of normal contact in closed form, each with its name: they differ, so say which one is meant.
//!
//! | law | what gives way | sphere of radius R on a plane, depth δ |
//! |---|---|---|
//! | [`radial_sphere_on_plane`] | springs along the radial indentation (equation 46) | `π k (R - δ) δ²` |
//! | [`vertical_sphere_on_plane`] | springs that stand on the plane | `π k δ² (R - δ/3)` |
//! | [`hertz_sphere`], [`hertz`] | two elastic half-spaces (Hertz 1882) | `4/3 E* √R δ^(3/2)` |
//!
//! A [`Foundation`](super::Foundation) on a plane converges to the first; Drake's and Simbody's foundations to the second.
//! Springs feel nothing of their neighbours: twice the depth gives four times the force, Hertz's solids 2.83 times.
//! Radii, stiffnesses and moduli are positive; the plain formulas do not check it.

use std::f64::consts::PI;

use super::foundation_error::FoundationError;

/// Force in N of a rigid sphere on a plane of springs under equation (46): `π k (R - δ) δ²` for the radius `R` and the
/// depth `δ` in m, the latter up to `R`, and the stiffness `k` in Pa/m; 0 without contact.
///
/// A point of the plane at the distance `ρ` from the centre is `R - ρ` deep, and the push leans by `(R - δ)/ρ`.
pub fn radial_sphere_on_plane(radius: f64, depth: f64, stiffness: f64) -> f64 {
    let depth = depth.max(0.0);
    PI * stiffness * (radius - depth) * depth * depth
}

/// Force in N of a rigid sphere on a plane of springs that stand on it: `π k δ² (R - δ/3)`, the stiffness `k` in Pa/m
/// times the volume of the cap, for depths `δ` up to `R`; 0 without contact.
pub fn vertical_sphere_on_plane(radius: f64, depth: f64, stiffness: f64) -> f64 {
    let depth = depth.max(0.0);
    PI * stiffness * depth * depth * (radius - depth / 3.0)
}

/// Hertz's force in N between spheres, `4/3 E* √R δ^(3/2)`, with `1/R` the sum of both curvatures and the
/// [`effective_modulus`] `E*` in Pa; 0 without contact. It is meant for depths much smaller than `R`.
pub fn hertz_sphere(radius: f64, depth: f64, modulus: f64) -> f64 {
    let depth = depth.max(0.0);
    4.0 / 3.0 * modulus * (radius * depth).sqrt() * depth
}

/// Modulus `E*` in Pa of two bodies `[E, ν]`: `1/E* = (1 - ν1²)/E1 + (1 - ν2²)/E2`. An infinite `E` is a rigid body.
pub fn effective_modulus([e1, v1]: [f64; 2], [e2, v2]: [f64; 2]) -> f64 {
    1.0 / ((1.0 - v1 * v1) / e1 + (1.0 - v2 * v2) / e2)
}

/// Principal curvatures in 1/m of the gap between two surfaces, the larger first, from their own (convex positive) and the
/// angle in radians between the directions of their larger ones.
///
/// Half their sum is that of all four halves, half their difference the sum of two arrows at twice the angle.
///
/// ```
/// use supersurface::contact::laws::relative_curvatures;
/// // crossed cylinders of one radius are like a sphere on a plane
/// let crossed = relative_curvatures([2.0, 0.0], [2.0, 0.0], std::f64::consts::FRAC_PI_2);
/// assert!((crossed[0] - 2.0).abs() < 1e-15 && (crossed[1] - 2.0).abs() < 1e-15);
/// ```
pub fn relative_curvatures(first: [f64; 2], second: [f64; 2], angle: f64) -> [f64; 2] {
    let half = |k: [f64; 2]| [0.5 * (k[0] + k[1]), 0.5 * (k[0] - k[1])];
    let ([m1, d1], [m2, d2]) = (half(first), half(second));
    let (sine, cosine) = (2.0 * angle).sin_cos();
    let spread = (d1 + d2 * cosine).hypot(d2 * sine);
    [m1 + m2 + spread, m1 + m2 - spread]
}

/// An elliptic contact of two elastic solids.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HertzContact {
    /// Normal force in N.
    pub force: f64,
    /// Semi-axes of the contact's ellipse in m, the larger first: it runs along the smaller curvature.
    pub semi_axes: [f64; 2],
    /// Pressure in the middle in Pa, `3 F/(2π a b)`.
    pub pressure: f64,
    /// Stiffness `dF/dδ = 3 F/(2δ)` in N/m.
    pub stiffness: f64,
}

/// Hertz's contact of two smooth bodies with the principal [`relative_curvatures`] of their gap in 1/m, both positive, the
/// depth in m and the [`effective_modulus`] in Pa.
///
/// With `A <= B` half the curvatures, `e` the eccentricity of the ellipse, `K`, `E` the complete elliptic integrals of
/// modulus `e` (Johnson, Contact Mechanics, 1985, §4.2):
///
/// ```text
/// B/A = (E/(1 - e²) - K)/(K - E)      a² = δ (K - E)/(e² A K)      b² = (1 - e²) a²      F = 2π E* a δ/(3 K)
/// ```
///
/// ```
/// use supersurface::contact::laws::{hertz, hertz_sphere};
/// let ball = hertz([50.0, 50.0], 1e-5, 1e9)?;
/// assert!((ball.force / hertz_sphere(0.02, 1e-5, 1e9) - 1.0).abs() < 1e-12);
/// assert!((ball.semi_axes[0] / f64::sqrt(0.02 * 1e-5) - 1.0).abs() < 1e-12);
/// # Ok::<(), supersurface::contact::FoundationError>(())
/// ```
pub fn hertz(
    curvatures: [f64; 2],
    depth: f64,
    modulus: f64,
) -> Result<HertzContact, FoundationError> {
    for k in curvatures {
        FoundationError::positive("relative curvature", k)?;
    }
    FoundationError::positive("depth", depth)?;
    FoundationError::positive("modulus", modulus)?;
    let [less, more] = [curvatures[0].min(curvatures[1]), curvatures[0].max(curvatures[1])];
    let flatness = aspect(more / less)?;
    let Elliptic { k, share } = elliptic(flatness);
    let a = (2.0 * depth * share / less).sqrt();
    let force = 2.0 / 3.0 * PI * modulus * a * depth / k;
    let semi_axes = [a, flatness * a];
    Ok(HertzContact {
        force,
        semi_axes,
        pressure: 1.5 * force / (PI * semi_axes[0] * semi_axes[1]),
        stiffness: 1.5 * force / depth,
    })
}

/// Complete elliptic integrals of the modulus `e = √(1 - β²)`, in a form that loses nothing where `e` is small.
struct Elliptic {
    /// `K`.
    k: f64,
    /// `(K - E)/(e² K)`, from 1/2 for a circle to 1.
    share: f64,
}

/// By the arithmetic-geometric mean of 1 and `β`: `K = π/(2 M)`, `1 - E/K = Σ 2^(n-1) c_n²` with `c_0 = e` and
/// `c_{n+1} = c_n²/(4 a_{n+1})`.
fn elliptic(flatness: f64) -> Elliptic {
    let square = (1.0 - flatness) * (1.0 + flatness);
    let (mut a, mut b) = (1.0, flatness);
    // (c_n/e)² and c_n²
    let (mut share, mut relative, mut own, mut weight) = (0.5, 1.0, square, 0.5);
    // it converges quadratically: six steps at 1e-2, ten at 1e-300
    for _ in 0..16 {
        let mean = 0.5 * (a + b);
        (a, b) = (mean, (a * b).sqrt());
        let factor = own / (16.0 * a * a);
        relative *= factor;
        own *= factor;
        weight *= 2.0;
        share += weight * relative;
    }
    Elliptic { k: PI / (2.0 * a), share }
}

/// The ratio `b/a` of the contact's ellipse for a ratio of curvatures from 1.
///
/// With [`Elliptic::share`] `s`, `B/A = (1 - s)/(β² s)`; its logarithm falls evenly with that of `β`, which is halved.
fn aspect(ratio: f64) -> Result<f64, FoundationError> {
    // beyond, 1 - s is lost in rounding: a line rather than an ellipse
    let range = "at most 1e12";
    FoundationError::check(ratio <= 1e12, "ratio of the relative curvatures", ratio, range)?;
    let (mut low, mut high) = (-16.0 * std::f64::consts::LN_10, 0.0);
    for _ in 0..80 {
        let middle: f64 = 0.5 * (low + high);
        let flatness = middle.exp();
        let share = elliptic(flatness).share;
        let found = (1.0 - share) / share / (flatness * flatness);
        if found > ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok((0.5f64 * (low + high)).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::gauss::Rule;

    fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let at = |[x, w]: &[f64; 2]| w * (to - from) * f(from + (to - from) * x);
        Rule::drawn_to_ends(60).nodes.iter().map(at).sum()
    }

    #[test]
    fn springs_add_up_to_the_closed_forms() {
        let (radius, k) = (0.04, 3e6);
        for depth in [0.0, 1e-4, 0.004, 0.02, 0.04] {
            let height = radius - depth;
            let reach = f64::sqrt(radius * radius - height * height);
            let radial = integral(0.0, reach, |s| {
                let far = s.hypot(height);
                2.0 * PI * s * k * (radius - far) * height / far
            });
            let vertical = integral(0.0, reach, |s| {
                2.0 * PI * s * k * ((radius * radius - s * s).sqrt() - height)
            });
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * k * radius.powi(3);
            assert!(close(radial, radial_sphere_on_plane(radius, depth, k)), "{depth}");
            assert!(close(vertical, vertical_sphere_on_plane(radius, depth, k)), "{depth}");
        }
        let laws = [radial_sphere_on_plane, vertical_sphere_on_plane, hertz_sphere];
        assert!(laws.iter().all(|law| law(radius, -0.01, k) == 0.0));
    }

    #[test]
    fn elliptic_integrals_are_their_integrals() {
        for flatness in [1.0, 0.999_999, 0.9, 0.5, 0.1, 0.01] {
            let square = 1.0 - flatness * flatness;
            let root = |t: f64| (1.0 - square * t.sin().powi(2)).sqrt();
            let first = integral(0.0, PI / 2.0, |t| 1.0 / root(t));
            // (K - E)/e²
            let third = integral(0.0, PI / 2.0, |t| t.sin().powi(2) / root(t));
            let found = elliptic(flatness);
            assert!((found.k / first - 1.0).abs() < 1e-7, "{flatness}");
            assert!((found.share * first / third - 1.0).abs() < 1e-7, "{flatness}");
        }
        // Legendre's relation E K' + E' K - K K' = π/2
        for flatness in [0.05f64, 0.3, 0.8] {
            let other = (1.0 - flatness * flatness).sqrt();
            let (one, two) = (elliptic(flatness), elliptic(other));
            let second = |e: &Elliptic, square: f64| e.k * (1.0 - square * e.share);
            let (e, e_other) = (second(&one, other * other), second(&two, flatness * flatness));
            let relation = e * two.k + e_other * one.k - one.k * two.k;
            assert!((relation / (PI / 2.0) - 1.0).abs() < 1e-13, "{flatness}");
        }
    }

    /// Half the larger and the smaller axis over `(3 F/(4 E* (A + B)))^(1/3)`, for `cos θ = (B - A)/(A + B)`, as they
    /// are printed since Hertz (Timoshenko and Goodier, Theory of Elasticity, §140).
    #[test]
    fn ellipses_are_those_of_the_printed_table() {
        let printed = [
            (30.0f64, 2.731, 0.493),
            (45.0, 1.926, 0.604),
            (60.0, 1.486, 0.717),
            (75.0, 1.202, 0.845),
            (90.0, 1.0, 1.0),
        ];
        for (degrees, m, n) in printed {
            let cosine = degrees.to_radians().cos();
            let [less, more] = [20.0 * (1.0 - cosine), 20.0 * (1.0 + cosine)];
            let found = hertz([less, more], 1e-5, 1e9).unwrap();
            let unit = (3.0 * found.force / (4.0 * 1e9 * 0.5 * (less + more))).cbrt();
            assert!((found.semi_axes[0] / unit - m).abs() < 6e-4, "{degrees}: {found:?}");
            assert!((found.semi_axes[1] / unit - n).abs() < 6e-4, "{degrees}: {found:?}");
        }
    }

    #[test]
    fn the_ellipse_meets_both_curvatures() {
        for ratio in [1.0, 1.0 + 1e-9, 1.5, 10.0, 1e3, 1e6, 1e12] {
            let found = hertz([7.0 * ratio, 7.0], 1e-5, 1e9).unwrap();
            let [a, b] = found.semi_axes;
            // of the smaller one: F and δ belong to one pressure p0 = 3F/(2πab)
            let e = elliptic(b / a);
            let less = found.pressure / 1e9 * b / (a * a) * e.k * e.share;
            let more = found.pressure / 1e9 / b * e.k * (1.0 - e.share);
            assert!((2.0 * less / 7.0 - 1.0).abs() < 1e-10, "{ratio}");
            assert!((2.0 * more / (7.0 * ratio) - 1.0).abs() < 1e-10, "{ratio}");
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
            assert!(hertz([1.0, bad], 1e-5, 1e9).is_err(), "{bad}");
        }
        assert!(hertz([1.0, 2.0], 0.0, 1e9).is_err() && hertz([1.0, 2.0], 1.0, f64::NAN).is_err());
        let rigid = effective_modulus([2e11, 0.3], [f64::INFINITY, 0.3]);
        assert!((rigid * 0.91 / 2e11 - 1.0).abs() < 1e-15);
    }
}
