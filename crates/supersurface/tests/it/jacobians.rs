//! Derivatives of distances by all parameters, against dual numbers put through the formulas as they are written, for
//! exponents from 0.1 to 2.5 and axis ratios to 100:1.

use num_dual::{DualNum, DualSVec64, gradient};
use supersurface::deform::{Deformed, Taper, Twist};
use supersurface::nalgebra::{Rotation3, SVector, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Posed, Superellipsoid, Supertoroid};
use supersurface::{Point, Pose, Vector};

/// A random body's numbers: semi-axes, exponents, pose.
struct Body {
    axes: [f64; 3],
    exponents: [f64; 2],
    pose: Pose,
}

fn body(random: &mut Stream) -> Body {
    let axes = [0; 3].map(|_| random.between(0.0, 100f64.ln()).exp() * 0.01);
    let exponents = [0; 2].map(|_| random.between(0.1, 2.5));
    let vector = |random: &mut Stream| Vector::from_fn(|_, _| random.normal());
    let rotation = UnitQuaternion::from_scaled_axis(vector(random));
    Body { axes, exponents, pose: Pose::from_parts(vector(random).into(), rotation) }
}

/// A point about as far from the body's middle as its surface, in no plane of symmetry.
fn place(body: &Body, reach: f64, random: &mut Stream) -> Point {
    let local = Vector::from_fn(|k, _| {
        let side = [1.0, -1.0][random.index(2)];
        body.axes[k] * reach * side * random.between(0.05, 1.3)
    });
    body.pose * Point::from(local)
}

/// The local coordinates of a world point after small changes of the pose.
fn local<D: DualNum<Primitive = f64> + Copy>(
    pose: &Pose,
    p: &Point,
    t: [D; 3],
    r: [D; 3],
) -> [D; 3] {
    // (R (I + [r]×))ᵀ (p - t) to first order, which is all that a first derivative sees
    let back: Rotation3<f64> = pose.rotation.inverse().into();
    let q = back * (p - pose.translation.vector).coords;
    let m = back.matrix();
    let moved: [D; 3] = std::array::from_fn(|i| {
        let shift = (0..3).map(|k| t[k] * m[(i, k)]).fold(D::from(0.0), |a, b| a + b);
        -shift + q[i]
    });
    let [rx, ry, rz] = r;
    let [x, y, z] = moved;
    [x - (ry * q.z - rz * q.y), y - (rz * q.x - rx * q.z), z - (rx * q.y - ry * q.x)]
}

fn norm<D: DualNum<Primitive = f64> + Copy>(u: D, v: D, e: D) -> D {
    let p = e.recip() * 2.0;
    ((u.abs().ln() * p).exp() + (v.abs().ln() * p).exp()).ln().mul(e * 0.5).exp()
}

fn length<D: DualNum<Primitive = f64> + Copy>([x, y, z]: [D; 3]) -> D {
    (x * x + y * y + z * z).sqrt()
}

fn radial<D: DualNum<Primitive = f64> + Copy>(q: [D; 3], a: [D; 3], e: [D; 2]) -> D {
    let g = norm(norm(q[0] / a[0], q[1] / a[1], e[1]), q[2] / a[2], e[0]);
    length(q) * (-g.recip() + 1.0)
}

fn meridian<D: DualNum<Primitive = f64> + Copy>(q: [D; 3], a: [D; 3], ring: D, e: [D; 2]) -> D {
    let radius = norm(q[0] / a[0], q[1] / a[1], e[1]);
    let g = norm(radius - ring, q[2] / a[2], e[0]);
    let planar = (q[0] * q[0] + q[1] * q[1]).sqrt();
    let across = planar / radius * (radius - ring);
    (across * across + q[2] * q[2]).sqrt() * (-g.recip() + 1.0)
}

/// Compares a row with the dual gradient; where the formula as written overflows there is nothing to compare.
fn agrees<const N: usize>(
    name: &str,
    at: [f64; N],
    formula: impl Fn([DualSVec64<N>; N]) -> DualSVec64<N>,
    found: (f64, &[f64]),
) -> bool {
    let (value, slopes) =
        gradient(|v: SVector<DualSVec64<N>, N>| formula(v.into()), &SVector::from(at));
    if !value.is_finite() || slopes.iter().any(|s| !s.is_finite()) {
        return false;
    }
    let scale = slopes.amax();
    assert!((found.0 - value).abs() <= 1e-9 * scale.max(value.abs()), "{name}: {found:?} {value}");
    for (k, (mine, dual)) in found.1.iter().zip(slopes.iter()).enumerate() {
        assert!((mine - dual).abs() <= 1e-7 * scale, "{name}, parameter {k}: {mine} {dual}");
    }
    true
}

#[test]
fn radial_jacobians_are_those_of_the_formula() {
    let mut random = Stream::new(81, 0);
    let mut compared = 0;
    for _ in 0..4000 {
        let b = body(&mut random);
        let p = place(&b, 1.0, &mut random);
        let shape = Superellipsoid::new(b.axes, b.exponents).unwrap();
        let (r, row) = Posed::new(shape, b.pose).unwrap().radial_jacobian(&p);
        let [a1, a2, a3] = b.axes;
        let [e1, e2] = b.exponents;
        let at = [a1, a2, a3, e1, e2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let formula = |v: [DualSVec64<11>; 11]| {
            let [a1, a2, a3, e1, e2, tx, ty, tz, rx, ry, rz] = v;
            radial(local(&b.pose, &p, [tx, ty, tz], [rx, ry, rz]), [a1, a2, a3], [e1, e2])
        };
        compared += usize::from(agrees("radial", at, formula, (r, &row)));
    }
    assert!(compared > 3500, "{compared}");
}

#[test]
fn meridian_jacobians_are_those_of_the_formula() {
    let mut random = Stream::new(82, 0);
    let mut compared = 0;
    for _ in 0..4000 {
        let b = body(&mut random);
        let ring = random.between(1.0, 5.0);
        let p = place(&b, 1.0 + ring, &mut random);
        let shape = Supertoroid::new(b.axes, ring, b.exponents).unwrap();
        let (r, row) = Posed::new(shape, b.pose).unwrap().meridian_jacobian(&p);
        let [a1, a2, a3] = b.axes;
        let [e1, e2] = b.exponents;
        let at = [a1, a2, a3, ring, e1, e2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let formula = |v: [DualSVec64<12>; 12]| {
            let [a1, a2, a3, a4, e1, e2, tx, ty, tz, rx, ry, rz] = v;
            meridian(local(&b.pose, &p, [tx, ty, tz], [rx, ry, rz]), [a1, a2, a3], a4, [e1, e2])
        };
        compared += usize::from(agrees("meridian", at, formula, (r, &row)));
    }
    assert!(compared > 3500, "{compared}");
}

#[test]
fn pull_back_jacobians_are_those_of_the_formula() {
    let mut random = Stream::new(83, 0);
    let mut compared = [0; 2];
    for _ in 0..4000 {
        let b = body(&mut random);
        let p = place(&b, 1.0, &mut random);
        let [a1, a2, a3] = b.axes;
        let [e1, e2] = b.exponents;
        let shape = Superellipsoid::new(b.axes, b.exponents).unwrap();
        let slopes = [0; 2].map(|_| random.between(-0.7, 0.7));
        let tapered = Deformed::new(shape, Taper::new(slopes, a3).unwrap()).unwrap();
        let (r, row, own) = Posed::new(tapered, b.pose).unwrap().pull_back_jacobian(&p).unwrap();
        let row: Vec<f64> = row.into_iter().chain(own).collect();
        let [kx, ky] = slopes;
        let at = [a1, a2, a3, e1, e2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, kx, ky];
        let formula = |v: [DualSVec64<13>; 13]| {
            let [a1, a2, a3, e1, e2, tx, ty, tz, rx, ry, rz, kx, ky] = v;
            let [x, y, z] = local(&b.pose, &p, [tx, ty, tz], [rx, ry, rz]);
            let q = [x / (kx * z / a3 + 1.0), y / (ky * z / a3 + 1.0), z];
            radial(q, [a1, a2, a3], [e1, e2])
        };
        compared[0] += usize::from(agrees("taper", at, formula, (r, &row)));
        let turns = random.between(-0.4, 0.4);
        let twisted = Deformed::new(shape, Twist::new(turns, a3).unwrap()).unwrap();
        let (r, row, own) = Posed::new(twisted, b.pose).unwrap().pull_back_jacobian(&p).unwrap();
        let row: Vec<f64> = row.into_iter().chain(own).collect();
        let at = [a1, a2, a3, e1, e2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, turns];
        let formula = |v: [DualSVec64<12>; 12]| {
            let [a1, a2, a3, e1, e2, tx, ty, tz, rx, ry, rz, n] = v;
            let [x, y, z] = local(&b.pose, &p, [tx, ty, tz], [rx, ry, rz]);
            let (s, c) = ((z / a3 + 1.0) * n * std::f64::consts::PI).sin_cos();
            radial([c * x + s * y, c * y - s * x, z], [a1, a2, a3], [e1, e2])
        };
        compared[1] += usize::from(agrees("twist", at, formula, (r, &row)));
    }
    assert!(compared.iter().all(|n| *n > 3500), "{compared:?}");
}
