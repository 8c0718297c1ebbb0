//! What a depth camera sees of a scene: a ray a pixel against the bodies and the table's top.

use crate::camera::{Camera, DepthImage};
use crate::numeric::random::Stream;
use crate::scene::rays::{Rays, Seen};
use crate::scene::{DepthNoise, Scene};
use crate::{Point, Pose, Vector};
use nalgebra::UnitQuaternion;

/// A jump of depth between neighbours, relative to the depth, that counts as an edge.
const JUMP: f64 = 0.015;

/// A depth image with the truth about it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Look {
    /// Depth along the optical axis in metres; NaN where there is no reading.
    pub depth: DepthImage,
    /// For each pixel: k for the body `bodies[k - 1]`, 0 for the table and where there is no reading.
    pub labels: Vec<u32>,
    /// The same of what each pixel's ray meets, read or not.
    pub seen: Vec<u32>,
    /// Outward unit normal in the optical frame of what each pixel's ray meets, without noise; zero where it meets
    /// nothing.
    pub normals: Vec<[f32; 3]>,
}

/// The pose of an optical frame at `eye` that looks at `target` with the world's z axis upright.
pub fn facing(eye: &Point, target: &Point) -> Pose {
    // the frame's z axis looks ahead and its y axis points down
    let rotation = UnitQuaternion::face_towards(&(target - eye), &-Vector::z());
    Pose::from_parts(eye.coords.into(), rotation)
}

/// The depth image and labels of a scene for a camera whose optical frame stands at `camera_pose` in
/// the world. Each pixel has its own random stream, so that the image depends on the seed alone.
pub fn look(
    scene: &Scene,
    camera: &Camera,
    camera_pose: &Pose,
    noise: &DepthNoise,
    seed: u64,
) -> Look {
    let [width, height] = camera.size();
    let rays = Rays::new(scene, camera_pose);
    let row = |v: usize| {
        let aim = |u: usize| {
            if noise.lateral == 0.0 {
                return camera.unproject(u as f64, v as f64);
            }
            let mut stream = Stream::new(seed, (v * width + u) as u64);
            let mut aside = || noise.lateral * stream.normal();
            camera.unproject(u as f64 + aside(), v as f64 + aside())
        };
        rays.see(&(0..width).map(aim).collect::<Vec<_>>())
    };
    let seen: Vec<Seen> = gather_by(1, height, row).concat();
    let reading = |i: usize| {
        let Some(Seen { depth, incidence, label, .. }) = seen.get(i).copied() else {
            return (f32::NAN, 0);
        };
        if !depth.is_finite() {
            return (f32::NAN, 0);
        }
        let mut stream = Stream::new(!seed, i as u64);
        let edge = noise.edge > 0.0 && beside_a_jump(&seen, i, width);
        let kept = stream.uniform();
        let error = match noise.patch {
            0 | 1 => stream.normal(),
            side => patch_error(i, width, side, seed),
        };
        let z = noise.reading(depth, incidence, edge, kept, error) as f32;
        (z, if z.is_nan() { 0 } else { label })
    };
    let (depth, labels) = gather(width * height, reading).into_iter().unzip();
    let depth = DepthImage::new([width, height], depth);
    let to_optical = camera_pose.rotation.inverse().cast::<f32>();
    let normals = seen.iter().map(|s| (to_optical * s.normal).into()).collect();
    let depth = depth.unwrap_or_else(|| DepthImage::empty(camera));
    Look { depth, labels, seen: seen.iter().map(|s| s.label).collect(), normals }
}

/// The error of a pixel that is the mean of its square's, scaled to a standard deviation of 1. The pixels of a square have
/// their own streams, so that this is the same on any number of threads.
fn patch_error(i: usize, width: usize, side: usize, seed: u64) -> f64 {
    let half = side / 2;
    let (u, v) = (i % width + half, i / width + half);
    let rows = (v - half..v - half + side)
        .flat_map(|v| (u - half..u - half + side).map(move |u| (v * (width + side) + u) as u64));
    rows.map(|k| Stream::new(seed.rotate_left(32), k).normal()).sum::<f64>() / side as f64
}

/// How much each body of a scene shows of what it would show alone: the share of its pixels at which nothing is nearer; 0
/// for a body outside the image.
pub fn visibility(scene: &Scene, camera: &Camera, camera_pose: &Pose) -> Vec<f64> {
    let [width, height] = camera.size();
    let rays = Rays::new(scene, camera_pose);
    // pixels in which each body is seen, and in which it would be
    let row = |v: usize| {
        let along: Vec<Vector> = (0..width).map(|u| camera.unproject(u as f64, v as f64)).collect();
        let alone = rays.alone(&along);
        let mut counts: Vec<[u32; 2]> = alone.into_iter().map(|n| [0, n]).collect();
        for seen in rays.see(&along).iter().filter(|s| s.label > 0) {
            counts[seen.label as usize - 1][0] += 1;
        }
        counts
    };
    let rows = gather_by(1, height, row);
    let sum = |k: usize, of: usize| rows.iter().map(|row| f64::from(row[k][of])).sum::<f64>();
    (0..scene.bodies.len()).map(|k| sum(k, 0) / sum(k, 1).max(1.0)).collect()
}

/// All values of `f` in order, on all cores.
#[cfg(feature = "parallel")]
fn gather<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    gather_by(1024, n, f)
}

/// The same, at least so many on one core.
#[cfg(feature = "parallel")]
fn gather_by<T: Send>(least: usize, n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    use rayon::prelude::*;
    (0..n).into_par_iter().with_min_len(least).map(f).collect()
}

/// All values of `f` in order.
#[cfg(not(feature = "parallel"))]
fn gather<T>(n: usize, f: impl Fn(usize) -> T) -> Vec<T> {
    (0..n).map(f).collect()
}

/// The same.
#[cfg(not(feature = "parallel"))]
fn gather_by<T>(_: usize, n: usize, f: impl Fn(usize) -> T) -> Vec<T> {
    gather(n, f)
}

/// True when a neighbour is much nearer or farther.
fn beside_a_jump(seen: &[Seen], i: usize, width: usize) -> bool {
    let depth = |j: Option<usize>| j.and_then(|j| seen.get(j)).map_or(f64::NAN, |s| s.depth);
    let here = depth(Some(i));
    let column = i % width;
    let neighbours = [
        (column > 0).then(|| i - 1),
        (column + 1 < width).then_some(i + 1),
        i.checked_sub(width),
        Some(i + width),
    ];
    neighbours.into_iter().any(|j| (depth(j) - here).abs() > JUMP * here)
}
