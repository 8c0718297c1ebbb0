//! Random bodies and grounds that several tests and the bench drop.

use supersurface::Pose;
use supersurface::combine::Part;
use supersurface::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Posed, Superellipsoid};
use supersurface::surface::Surface;
use supersurface_physics::{Falling, Ground};

/// How many of something: an environment variable, or a default small enough for every run.
pub(crate) fn count(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// Any rotation, all alike.
pub(crate) fn turn(random: &mut Stream) -> UnitQuaternion<f64> {
    let [w, x, y, z] = [0; 4].map(|_| random.normal());
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

/// A part of 800 kg/m³.
pub(crate) fn part(surface: Surface, pose: Pose) -> Part<Surface> {
    Part::new("part", Posed::new(surface, pose).unwrap(), 800.0).unwrap()
}

/// One part at the body's frame.
pub(crate) fn falling(surface: Surface, start: Pose) -> Falling {
    Falling { parts: vec![part(surface, Pose::identity())], start, friction: 0.5, restitution: 0.1 }
}

/// Ten superellipsoids of 2.4 to 9 cm over a bin of 22 cm.
pub(crate) fn pile(seed: u64) -> (Vec<Superellipsoid>, Vec<Pose>) {
    let mut random = Stream::new(seed, 0);
    let mut draw = |k: usize| {
        let axes = [0; 3].map(|_| random.between(0.012, 0.045));
        let exponents = [0; 2].map(|_| random.between(0.1, 1.9));
        let [x, y] = [0; 2].map(|_| random.between(-0.04, 0.04));
        let place = Translation3::new(x, y, 0.06 + 0.09 * k as f64);
        let shape = Superellipsoid::new(axes, exponents).unwrap();
        (shape, Pose::from_parts(place, turn(&mut random)))
    };
    (0..10).map(&mut draw).unzip()
}

/// A floor and four walls 20 cm high.
pub(crate) fn bin() -> Ground {
    let wall = |x: f64, y: f64, hx: f64, hy: f64| (Pose::translation(x, y, 0.1), [hx, hy, 0.1]);
    let cuboids = vec![
        wall(0.12, 0.0, 0.01, 0.13),
        wall(-0.12, 0.0, 0.01, 0.13),
        wall(0.0, 0.12, 0.13, 0.01),
        wall(0.0, -0.12, 0.13, 0.01),
    ];
    Ground { cuboids, ..Ground::default() }
}
