//! The parametric form: on the surface, its tangents, its normals, on seams and poles too.

use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Parametric, Posed};
use supersurface::{Direction, Vector};

use super::members::{Make, pose};
use super::samples::{Difference, angles, difference, free_angles, scaled, shapes};

/// Points of the parametric form have a gauge of 1, and normals lie along the gradient, out of the solid.
pub(super) fn on_surface<S: Implicit + Parametric>(make: Make<S>) {
    let (mut agree, mut all) = (0, 0);
    for (case, shape) in shapes(make, 300) {
        let random = &mut Stream::new(31, case);
        for _ in 0..40 {
            let [eta, omega] = angles(&shape, random);
            let p = shape.point(eta, omega);
            let gauge = shape.gauge(&p);
            assert!((gauge - 1.0).abs() < 1e-9, "{case} {eta} {omega}: {p} {gauge}");
        }
        for _ in 0..40 {
            let [eta, omega] = free_angles(&shape, random);
            let (p, Some(normal)) = (shape.point(eta, omega), shape.normal(eta, omega)) else {
                continue;
            };
            let gradient = shape.gradient(&p);
            let Some(along) = Direction::try_new(gradient, 0.0) else { continue };
            all += 1;
            assert!(normal.dot(&along) > 0.0, "{case} {eta} {omega}: {normal:?} inwards");
            let off = normal.cross(&along).norm();
            // what a turn of the coordinates rounds off a point near a ridge turns the gradient
            agree += usize::from(off < 1e-6);
            assert!(off < 1e-2, "{case} {eta} {omega}: {normal:?} {along:?}");
        }
    }
    assert!(agree * 100 > all * 98 && all > 5000, "{agree} of {all} normals are the gradient's");
}

/// Tangents are differences of the points, normals stand on them; on seams and poles what there is, is finite and of
/// unit length; a pose turns all, a scale stretches points and tangents.
pub(super) fn parametric<S: Parametric + Clone>(make: Make<S>) {
    let (mut sharp, mut all) = (0, 0);
    for (case, shape) in shapes(make, 300) {
        let random = &mut Stream::new(32, case);
        for _ in 0..40 {
            seam(&shape, angles(&shape, random));
        }
        let pose = pose(random, 1.0);
        let posed = Posed::new(shape.clone(), pose).unwrap();
        let large = scaled(make, case, 16.0);
        for _ in 0..20 {
            let [eta, omega] = free_angles(&shape, random);
            let p = shape.point(eta, omega);
            assert!((large.point(eta, omega) - p * 16.0).norm() <= 1e-7 * p.coords.norm());
            assert!((posed.point(eta, omega) - pose * p).norm() == 0.0);
            let (Some(tangents), Some(normal)) =
                (shape.tangents(eta, omega), shape.normal(eta, omega))
            else {
                continue;
            };
            all += 1;
            let turned = posed.normal(eta, omega).unwrap();
            assert!((turned.into_inner() - pose.rotation * normal.into_inner()).norm() < 1e-14);
            let h = 1e-4;
            let found = [
                difference(|h| shape.point(eta + h, omega).coords, h),
                difference(|h| shape.point(eta, omega + h).coords, h),
            ];
            let mut fine = true;
            for (t, Difference { slope, error }) in tangents.iter().zip(found) {
                let size = t.norm() + 1e-9 * p.coords.norm() / h;
                assert!(
                    (t - slope).norm() <= 2.0 * error + 1e-6 * size,
                    "{case} {eta} {omega}: {t} {slope} {error}"
                );
                fine &= error < 1e-2 * size;
                assert!(
                    normal.dot(t).abs() <= 1e-9 * t.norm(),
                    "{case} {eta} {omega}: {normal:?} {t}"
                );
            }
            sharp += usize::from(fine);
            let cross = tangents[0].cross(&tangents[1]);
            if cross.norm() > 1e-6 * tangents[0].norm() * tangents[1].norm() {
                let off = normal.cross(&cross).norm() / cross.norm();
                assert!(off < 1e-7, "{case} {eta} {omega}: {normal:?} {cross}");
            }
        }
    }
    assert!(sharp * 10 > all * 9 && all > 3000, "{sharp} of {all} differences say something");
}

fn seam(shape: &impl Parametric, [eta, omega]: [f64; 2]) {
    let p = shape.point(eta, omega);
    assert!(p.iter().all(|v| v.is_finite()), "{eta} {omega}: {p}");
    let finite = |v: &Vector| v.iter().all(|c| c.is_finite());
    let tangents = shape.tangents(eta, omega);
    assert!(tangents.is_none_or(|t| t.iter().all(finite)), "{eta} {omega}: {tangents:?}");
    if let Some(n) = shape.normal(eta, omega) {
        assert!((n.norm() - 1.0).abs() < 1e-12, "{eta} {omega}: {n:?}");
        let stands = |t: &Vector| n.dot(t).abs() <= 1e-6 * t.norm();
        assert!(tangents.is_none_or(|t| t.iter().all(stands)), "{eta} {omega}: {n:?} {tangents:?}");
    }
}
