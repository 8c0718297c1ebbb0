//! What a depth camera sees of a scene: a ray a pixel against the bodies and the table's top.

use crate::camera::{Camera, DepthImage};
use crate::numeric::random::{Stream, normals};
use crate::scene::rays::{MOST, NOTHING, Rays, Seen};
use crate::scene::tiles::{SIDE, Tiles};
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
    let tiles = Tiles::of(camera);
    let mut seen = vec![NOTHING; width * height];
    // a band of tiles each
    each(&mut seen, SIDE * width, |band, into| {
        for k in tiles.band(band) {
            let mut aside = [[0.0; MOST]; 2];
            if noise.lateral != 0.0 {
                for (place, [u, v], length) in tiles.rows(k) {
                    for (aside, skip) in aside.iter_mut().zip([0, 2]) {
                        let run = &mut aside[place..place + length];
                        normals(seed, (v * width + u) as u64, skip, run);
                        run.iter_mut().for_each(|a| *a *= noise.lateral);
                    }
                }
            }
            let [right, down] = aside;
            let aim = |(i, [u, v]): (usize, [usize; 2])| {
                camera.unproject(u as f64 + right[i], v as f64 + down[i])
            };
            let found = rays.see(&tiles.pixels(k).enumerate().map(aim).collect::<Vec<_>>());
            for (place, [u, v], length) in tiles.rows(k) {
                let start = (v - band * SIDE) * width + u;
                into[start..start + length].copy_from_slice(&found[place..place + length]);
            }
        }
    });
    let errors = Errors::new(noise, width, height, seed);
    let turn = camera_pose.rotation.inverse().to_rotation_matrix().cast::<f32>();
    let rows = gather(height, |v| {
        let row = v * width..(v + 1) * width;
        let error = errors.row(v);
        let reading = |(i, error): (usize, f64)| {
            let Seen { depth, incidence, label, .. } = seen[i];
            if !depth.is_finite() {
                return (f32::NAN, 0);
            }
            let edge = noise.edge > 0.0 && beside_a_jump(&seen, i, width);
            let kept = Stream::new(!seed, i as u64).uniform();
            let z = noise.reading(depth, incidence, edge, kept, error) as f32;
            (z, if z.is_nan() { 0 } else { label })
        };
        row.zip(error).map(reading).collect::<Vec<_>>()
    });
    let (depth, labels) = rows.into_iter().flatten().unzip();
    let depth = DepthImage::new([width, height], depth);
    let depth = depth.unwrap_or_else(|| DepthImage::empty(camera));
    let normals = seen.iter().map(|s| (turn * s.normal).into()).collect();
    Look { depth, labels, seen: seen.iter().map(|s| s.label).collect(), normals }
}

/// Errors of the readings in standard deviations.
struct Errors {
    seed: u64,
    width: usize,
    side: usize,
    /// One for each pixel of an image that is larger by a square; empty where each pixel errs alone.
    field: Vec<f64>,
}

impl Errors {
    fn new(noise: &DepthNoise, width: usize, height: usize, seed: u64) -> Self {
        let side = noise.patch.max(1);
        let across = width + side;
        let row = |v: usize| {
            let mut row = vec![0.0; across];
            normals(seed.rotate_left(32), (v * across) as u64, 0, &mut row);
            row
        };
        let field = if side > 1 { gather(height + side, row).concat() } else { Vec::new() };
        Self { seed, width, side, field }
    }

    /// Of a row of pixels. The error of a pixel that is the mean of its square's is scaled to a standard deviation of 1.
    fn row(&self, v: usize) -> Vec<f64> {
        let mut row = vec![0.0; self.width];
        if self.side == 1 {
            // the first number of each stream says whether there is a reading
            normals(!self.seed, (v * self.width) as u64, 1, &mut row);
            return row;
        }
        for above in self.field.chunks(self.width + self.side).skip(v).take(self.side) {
            for first in 0..self.side {
                row.iter_mut().zip(&above[first..]).for_each(|(sum, error)| *sum += error);
            }
        }
        row.iter_mut().for_each(|sum| *sum /= self.side as f64);
        row
    }
}

/// How much each body of a scene shows of what it would show alone: the share of its pixels at which nothing is nearer; 0
/// for a body outside the image.
pub fn visibility(scene: &Scene, camera: &Camera, camera_pose: &Pose) -> Vec<f64> {
    let rays = Rays::new(scene, camera_pose);
    let tiles = Tiles::of(camera);
    // pixels in which each body is seen, and in which it would be
    let counts = gather(tiles.count(), |k| {
        let aim = |[u, v]: [usize; 2]| camera.unproject(u as f64, v as f64);
        let along: Vec<Vector> = tiles.pixels(k).map(aim).collect();
        let alone = rays.alone(&along);
        let mut counts: Vec<[u32; 2]> = alone.into_iter().map(|n| [0, n]).collect();
        for seen in rays.see(&along).iter().take(along.len()).filter(|s| s.label > 0) {
            counts[seen.label as usize - 1][0] += 1;
        }
        counts
    });
    let sum = |k: usize, of: usize| counts.iter().map(|tile| f64::from(tile[k][of])).sum::<f64>();
    (0..scene.bodies.len()).map(|k| sum(k, 0) / sum(k, 1).max(1.0)).collect()
}

/// All values of `f` in order, on all cores.
#[cfg(feature = "parallel")]
fn gather<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    use rayon::prelude::*;
    (0..n).into_par_iter().map(f).collect()
}

/// All values of `f` in order.
#[cfg(not(feature = "parallel"))]
fn gather<T>(n: usize, f: impl Fn(usize) -> T) -> Vec<T> {
    (0..n).map(f).collect()
}

/// Tells `f` of each piece of so many values, on all cores.
#[cfg(feature = "parallel")]
fn each<T: Send>(values: &mut [T], length: usize, f: impl Fn(usize, &mut [T]) + Sync + Send) {
    use rayon::prelude::*;
    values.par_chunks_mut(length).enumerate().for_each(|(k, piece)| f(k, piece));
}

/// Tells `f` of each piece of so many values.
#[cfg(not(feature = "parallel"))]
fn each<T>(values: &mut [T], length: usize, f: impl Fn(usize, &mut [T])) {
    values.chunks_mut(length).enumerate().for_each(|(k, piece)| f(k, piece));
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
