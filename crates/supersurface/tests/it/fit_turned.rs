//! A cloud that is moved, turned and in another unit has the same surface, and is as sure of it.

use supersurface::fit::{Family, FitOptions, View, fit};
use supersurface::nalgebra::{Rotation3, Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Parametric, Superellipsoid};
use supersurface::surface::Surface;
use supersurface::{Point, Pose, Vector};

/// Points of a superellipsoid of some centimetres, half a millimetre off; with a part of them, one side of it.
fn points(half: bool) -> Vec<Point> {
    let shape = Superellipsoid::new([0.04, 0.025, 0.06], [0.4, 0.8]).unwrap();
    let mut random = Stream::new(17, u64::from(half));
    let mut noisy = || {
        let p = shape.point(random.between(-1.5, 1.5), random.between(-3.1, 3.1));
        p + Vector::from_fn(|_, _| 0.0005 * random.normal())
    };
    (0..1200).map(|_| noisy()).filter(|p| !half || p.x + p.z > 0.0).collect()
}

#[test]
fn a_turned_cloud_has_the_turned_surface() {
    let turn = UnitQuaternion::new(Vector::new(0.7, -1.1, 0.4));
    let (scale, motion) = (1e3, Pose::from_parts(Translation3::new(0.2, -0.5, 0.3), turn));
    let moved = |p: &Point| Point::from((motion * p).coords * scale);
    for half in [false, true] {
        let (here, eye) = (points(half), half.then(|| Point::new(0.6, 0.0, 0.6)));
        let there: Vec<Point> = here.iter().map(moved).collect();
        let options = FitOptions::only(Family::Superellipsoid);
        let fitted = |points, viewpoint| {
            fit(&View { viewpoint, ..View::all_around(points) }, &options).unwrap()
        };
        let (a, b) = (fitted(&here, eye), fitted(&there, eye.as_ref().map(moved)));
        let (Surface::Superellipsoid(s), Surface::Superellipsoid(t)) =
            (a.surface.shape(), b.surface.shape())
        else {
            panic!("neither is what was asked for")
        };
        for k in 0..3 {
            assert!((t.semi_axes()[k] / s.semi_axes()[k] / scale - 1.0).abs() < 1e-8);
        }
        let off = b.surface.pose().rotation.angle_to(&(turn * a.surface.pose().rotation));
        assert!(off < 1e-8, "{off}");
        // the place is as sure in the turned frame
        let sure = |fit: &supersurface::fit::Fit| {
            let covariance = fit.covariance.as_ref().unwrap();
            let x = covariance.names.iter().position(|n| *n == "x").unwrap();
            covariance.matrix.fixed_view::<3, 3>(x, x).into_owned()
        };
        let rotation = Rotation3::from(turn);
        let expected = rotation.matrix() * sure(&a) * rotation.matrix().transpose() * scale * scale;
        assert!((sure(&b) - expected).norm() < 1e-6 * expected.norm());
    }
}
