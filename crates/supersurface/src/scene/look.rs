//! What a depth camera sees of a scene: a ray a pixel against the bodies and the table's top.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use crate::camera::{Camera, DepthImage};
use crate::numeric::lanes::{Job, dispatch};
use crate::numeric::random::{Stream, normals};
use crate::scene::rays::{Along, MOST, Rays, Seen};
use crate::scene::tiles::{ROWS, RUN, Run, Tiles};
use crate::scene::{DepthNoise, Scene};
use crate::{Point, Pose, Vector};
use nalgebra::UnitQuaternion;
use std::iter::repeat_with;
use std::ops::Range;

/// A jump of depth between neighbours, relative to the depth, that counts as an edge.
const JUMP: f32 = 0.015;

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
    let mut look = Look::blank(camera);
    look.again(scene, camera, camera_pose, noise, seed);
    look
}

impl Look {
    /// The images of a camera before its first frame, all zero.
    pub fn blank(camera: &Camera) -> Self {
        let size = camera.size();
        let pixels = size[0] * size[1];
        // zeros that the system gives are written once, by the first frame
        let depth =
            DepthImage::new(size, vec![0.0; pixels]).unwrap_or_else(|| DepthImage::empty(camera));
        Self {
            depth,
            labels: vec![0; pixels],
            seen: vec![0; pixels],
            normals: vec![[0.0; 3]; pixels],
        }
    }

    /// What [`look`] returns, written over this one: the next frame of a camera, in the memory of the one before.
    pub fn again(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        camera_pose: &Pose,
        noise: &DepthNoise,
        seed: u64,
    ) {
        let [width, height] = camera.size();
        let rays = Rays::new(scene, camera_pose);
        let tiles = Tiles::of(camera);
        let pixels = width * height;
        let exact = *noise == DepthNoise::none();
        if self.depth.size() != camera.size() {
            self.depth = DepthImage::empty(camera);
        }
        self.labels.resize(pixels, 0);
        self.seen.resize(pixels, 0);
        self.normals.resize(pixels, [0.0; 3]);
        let mut incidence = vec![0.0; if exact { 0 } else { pixels }];
        let band = ROWS * width;
        let incidences = incidence.chunks_mut(band).map(Some).chain(repeat_with(|| None));
        let bands = self.depth.depth_mut().chunks_mut(band).zip(self.normals.chunks_mut(band));
        let bands = bands.zip(self.labels.chunks_mut(band).zip(self.seen.chunks_mut(band)));
        let bands = bands.zip(incidences).map(|(((depth, normals), (labels, seen)), incidence)| {
            Band { depth, normals, labels, seen, incidence }
        });
        each(bands.collect(), |band, mut images| {
            let (mut along, mut found) = (Along::ahead(), Seen::nothing());
            for tile in tiles.band(band) {
                tiles.aim(tile, camera, noise.lateral, seed, &mut along);
                rays.see(&along, &mut found);
                let cosines = images.incidence.is_some().then(|| found.incidence(&along));
                let runs = tiles.runs(tile).map(|Run { place, pixel, length }| {
                    let start = pixel - band * ROWS * width;
                    (place / RUN, start..start + length)
                });
                dispatch(Put { images: &mut images, runs, found: &found, cosines: &cosines });
            }
        });
        if !exact {
            self.err(noise, &incidence, seed);
        }
    }

    /// Readings in place of depths.
    fn err(&mut self, noise: &DepthNoise, incidence: &[f32], seed: u64) {
        let [width, height] = self.depth.size();
        let errors = Errors::new(noise, width, height, seed);
        let depth = self.depth.depth().to_vec();
        let seen = &self.seen;
        let rows = self.depth.depth_mut().chunks_mut(width).zip(self.labels.chunks_mut(width));
        each(rows.collect(), |v, (readings, labels)| {
            for (u, error) in errors.row(v).into_iter().enumerate() {
                let i = v * width + u;
                if depth[i].is_finite() {
                    let edge = noise.edge > 0.0 && beside_a_jump(&depth, i, width);
                    let kept = Stream::new(!seed, i as u64).uniform();
                    let (depth, incidence) = (depth[i].into(), incidence[i].into());
                    readings[u] = noise.reading(depth, incidence, edge, kept, error) as f32;
                    labels[u] = if readings[u].is_nan() { 0 } else { seen[i] };
                }
            }
        });
    }
}

/// The images' rows of a band of tiles.
struct Band<'a> {
    depth: &'a mut [f32],
    normals: &'a mut [[f32; 3]],
    labels: &'a mut [u32],
    seen: &'a mut [u32],
    incidence: Option<&'a mut [f32]>,
}

/// Puts what a tile's rays met into the images.
struct Put<'a, 'b, R> {
    images: &'a mut Band<'b>,
    /// Runs with the place of each in the images.
    runs: R,
    found: &'a Seen,
    cosines: &'a Option<[f32; MOST]>,
}

impl<R: Iterator<Item = (usize, Range<usize>)>> Job for Put<'_, '_, R> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Band { depth, normals, labels, seen, incidence } = self.images;
        let Seen { depth: depths, label, normal: [xs, ys, zs] } = self.found;
        let depths = depths.as_chunks::<RUN>().0;
        let label = label.as_chunks::<RUN>().0;
        let [xs, ys, zs] = [xs, ys, zs].map(|column| column.as_chunks::<RUN>().0);
        for (k, to) in self.runs {
            let reading = |z: f64| if z < f64::INFINITY { z as f32 } else { f32::NAN };
            put(&mut depth[to.clone()], |i| reading(depths[k][i]));
            put(&mut normals[to.clone()], |i| [xs[k][i], ys[k][i], zs[k][i]]);
            put(&mut labels[to.clone()], |i| label[k][i]);
            put(&mut seen[to.clone()], |i| label[k][i]);
            if let (Some(incidence), Some(cosines)) = (incidence.as_mut(), self.cosines) {
                put(&mut incidence[to], |i| cosines.as_chunks::<RUN>().0[k][i]);
            }
        }
    }
}

/// Fills a run, at once where it is whole. Straight from the rays: a copy on the way would have to wait for its parts.
#[inline(always)]
fn put<T>(to: &mut [T], from: impl Fn(usize) -> T) {
    match to.first_chunk_mut::<RUN>() {
        Some(whole) => {
            for i in 0..RUN {
                whole[i] = from(i);
            }
        }
        None => to.iter_mut().zip(0..RUN).for_each(|(to, i)| *to = from(i)),
    }
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
    let counts = gather(tiles.count(), |tile| {
        let (mut along, mut seen) = (Along::ahead(), Seen::nothing());
        tiles.aim(tile, camera, 0.0, 0, &mut along);
        rays.see(&along, &mut seen);
        let count = |(met, label): (&[bool; MOST], u32)| -> [u32; 2] {
            let mut counts = [0, 0];
            for i in tiles.runs(tile).flat_map(|run| run.place..run.place + run.length) {
                counts[0] += u32::from(seen.label[i] == label);
                counts[1] += u32::from(met[i]);
            }
            counts
        };
        rays.alone(&along).iter().zip(1..).map(count).collect::<Vec<_>>()
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

/// Gives `f` each piece with its number, on all cores.
#[cfg(feature = "parallel")]
fn each<T: Send>(pieces: Vec<T>, f: impl Fn(usize, T) + Sync + Send) {
    use rayon::prelude::*;
    pieces.into_par_iter().enumerate().for_each(|(k, piece)| f(k, piece));
}

/// Gives `f` each piece with its number.
#[cfg(not(feature = "parallel"))]
fn each<T>(pieces: Vec<T>, f: impl Fn(usize, T)) {
    pieces.into_iter().enumerate().for_each(|(k, piece)| f(k, piece));
}

/// True when a neighbour is much nearer or farther.
fn beside_a_jump(depth: &[f32], i: usize, width: usize) -> bool {
    let here = depth.get(i).copied().unwrap_or(f32::NAN);
    // NaN where nothing is met
    let jumps = |z: &f32| z.is_nan() || (z - here).abs() > JUMP * here;
    let column = i % width;
    let neighbours = [
        (column > 0).then(|| i - 1),
        (column + 1 < width).then_some(i + 1),
        i.checked_sub(width),
        Some(i + width),
    ];
    neighbours.into_iter().flatten().filter_map(|j| depth.get(j)).any(jumps)
}
