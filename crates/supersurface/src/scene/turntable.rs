//! Where cameras stand to see a whole scene.

use super::{Scene, facing};
use crate::camera::Camera;
use crate::{Point, Pose, Vector};
use std::f64::consts::TAU;

/// How far the cameras look down, in radians.
const DOWN: f64 = 0.7;
/// Free space around what is seen, relative to it.
const AROUND: f64 = 1.15;

/// `count` poses of an optical frame around the vertical through the middle of the bodies, so far away that all bodies and
/// boards are in the image, the first from -y.
///
/// ```
/// use supersurface::scene::{demo, turntable};
/// let d = demo(1)?;
/// for pose in turntable(&d.scene, &d.camera, 4) {
///     let bodies = d.scene.bodies.iter();
///     let mut pixels = bodies.map(|b| d.camera.project(&pose.inverse_transform_point(&b.pose.translation.vector.into())));
///     assert!(pixels.all(|p| p.is_some_and(|[u, v]| (0.0..640.0).contains(&u) && (0.0..480.0).contains(&v))));
/// }
/// # Ok::<(), supersurface::scene::SceneError>(())
/// ```
pub fn turntable(scene: &Scene, camera: &Camera, count: usize) -> Vec<Pose> {
    let (mut low, mut high) =
        (Point::from([f64::INFINITY; 3]), Point::from([f64::NEG_INFINITY; 3]));
    let mut cover = |p: Point| (low, high) = (low.inf(&p), high.sup(&p));
    for [a, b] in scene.bodies.iter().map(super::Body::bounds) {
        cover(a);
        cover(b);
    }
    for board in &scene.boards {
        let reach = board.pose.rotation.to_rotation_matrix().matrix().abs()
            * Vector::from(board.half_extents);
        let middle = Point::from(board.pose.translation.vector);
        cover(middle - reach);
        cover(middle + reach);
    }
    if scene.bodies.is_empty() && scene.boards.is_empty() {
        let [x, y] = scene.half_size;
        cover(Point::new(-x, -y, 0.0));
        cover(Point::new(x, y, 0.0));
    }
    let middle = nalgebra::center(&low, &high);
    let radius = 0.5 * (high - low).norm();
    let ([w, h], [fx, fy]) = (camera.size(), camera.focal());
    let narrowest = (0.5 * w as f64 / fx).min(0.5 * h as f64 / fy).atan();
    let far = AROUND * radius / narrowest.sin();
    let eye = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
        middle + far * Vector::new(DOWN.cos() * sin, -DOWN.cos() * cos, DOWN.sin())
    };
    (0..count).map(|k| facing(&eye(k), &middle)).collect()
}
