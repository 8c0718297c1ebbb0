//! Small flat patches of a surface (supervoxels): the pieces that are too small to hold a crease.
//!
//! The points are thinned to voxels. Seeds on a coarser grid claim the voxels around them, step by step from
//! voxel to neighbour, so that no patch jumps over a gap; a voxel goes to the patch that is nearest by
//! `|p - c|/size + 4 (1 - n·m)`, with `c`, `m` the patch's mean place and normal (Papon et al., CVPR 2013,
//! without colour).

use std::ops::Range;

use crate::cloud::{Neighbourhood, Places, PointCloud, VoxelGrid};
use crate::{Point, Vector};

/// Side of a voxel, radius of its normal, and distance of the seeds, in metres.
const VOXEL: f64 = 0.005;
const NORMAL_RADIUS: f64 = 0.012;
const SEED: f64 = 0.022;
/// Voxels nearer than this are neighbours: those that share a face, an edge or a corner.
const NEIGHBOUR: f64 = 1.75 * VOXEL;
/// Points of an occupied voxel, on the average, below which they lie too far apart (some 4 mm) to show edges.
const SPARSE: f64 = 2.15;
/// How many times larger all is where the points lie farther apart, if they are no farther from the sensor than this, in
/// metres: beyond, its noise, which grows with the square of the distance, hides edges.
const COARSE: [f64; 2] = [1.4, 2.0];
const NEAR: f64 = 1.45;
/// Weight of the normals against space.
const NORMALS: f64 = 4.0;
/// Rounds in which the patches settle.
const ROUNDS: usize = 3;

/// A patch: its mean place and normal, and the voxel next to that place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    pub(crate) centre: Point,
    pub(crate) normal: Vector,
    /// Length of the mean of its unit normals: 1 on a plane.
    pub(crate) evenness: f64,
    seed: usize,
}

/// An object as patches.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patches {
    pub(crate) patches: Vec<Patch>,
    /// Pairs of patches that touch (smaller number first, rising), with the number of pairs of voxels that do.
    pub(crate) borders: Vec<([u32; 2], u32)>,
    /// The points of each patch.
    pub(crate) points: Vec<Vec<u32>>,
    /// Distance of their seeds, in metres.
    pub(crate) size: f64,
}

/// What has not been claimed yet.
const NOBODY: u32 = u32::MAX;

/// The patches of an object; points without a normal go with their neighbours or to none. None where the points are too far
/// apart.
pub(crate) fn patches(cloud: &PointCloud, object: &[u32]) -> Patches {
    let spread = |scale: f64| {
        let grid = VoxelGrid::new(&cloud.points, object.iter().copied(), scale * VOXEL)?;
        let dense = object.len() as f64 >= SPARSE * grid.occupied() as f64;
        dense.then_some((scale, grid))
    };
    let coarse = || COARSE.into_iter().filter(|_| is_near(cloud, object)).find_map(spread);
    let Some((scale, grid)) = spread(1.0).or_else(coarse) else { return Patches::default() };
    let voxels = Voxels::new(cloud, &grid, scale);
    let (owners, patches) = voxels.claim();
    // pairs as one number, which is sorted fast
    let mut borders: Vec<u64> = Vec::new();
    for (i, own) in owners.iter().enumerate() {
        let across = voxels.near(i).iter().map(|j| owners[*j as usize]);
        let across = across.filter(|other| own < other && *other != NOBODY);
        borders.extend(across.map(|other| u64::from(*own) << 32 | u64::from(other)));
    }
    borders.sort_unstable();
    let pair = |both: u64| [(both >> 32) as u32, both as u32];
    let counted = borders.chunk_by(|a, b| a == b).map(|all| (pair(all[0]), all.len() as u32));
    let mut points = vec![Vec::new(); patches.len()];
    for (c, owner) in owners.iter().enumerate() {
        if let Some(points) = points.get_mut(*owner as usize) {
            points.extend_from_slice(grid.members(c));
        }
    }
    Patches { patches, borders: counted.collect(), points, size: scale * SEED }
}

/// Whether the middle of an object's points is near the sensor.
fn is_near(cloud: &PointCloud, object: &[u32]) -> bool {
    let points = object.iter().map(|i| cloud.points[*i as usize].coords);
    let middle = Point::from(points.sum::<Vector>() / object.len().max(1) as f64);
    cloud.viewpoint.is_some_and(|eye| (middle - eye).norm() < NEAR)
}

struct Voxels {
    /// How many times larger than usual all is.
    scale: f64,
    at: Vec<Point>,
    normal: Vec<Option<Vector>>,
    /// The neighbours of all voxels, and where among them each one's are.
    near: Vec<u32>,
    ranges: Vec<Range<usize>>,
}

impl Voxels {
    fn new(cloud: &PointCloud, grid: &VoxelGrid<'_>, scale: f64) -> Self {
        let (radius, neighbour) = (scale * NORMAL_RADIUS, scale * NEIGHBOUR);
        let at: Vec<Point> = grid.representatives().map(|i| cloud.points[i as usize]).collect();
        let middle = at.iter().map(|p| p.coords).sum::<Vector>() / at.len().max(1) as f64;
        let mut about = vec![Neighbourhood::default(); at.len()];
        // neighbours as they are found, and where those of each voxel are
        let (mut found, mut ranges) = (Vec::new(), vec![0..0; at.len()]);
        if let Some(cells) = VoxelGrid::new(&at, 0..at.len() as u32, radius) {
            let (mut places, mut near) = (Places::default(), Vec::new());
            cells.neighbourhoods(|members, around| {
                places.set(around.iter().map(|j| at[*j as usize]));
                for i in members {
                    near.clear();
                    let [from, k] = [found.len(), *i as usize];
                    about[k] =
                        Neighbourhood::within(&places, &at[k], [radius, neighbour], &mut near);
                    found.extend(near.iter().map(|j| around[*j as usize]).filter(|j| j != i));
                    ranges[k] = from..found.len();
                }
            });
        }
        let outward = |i: usize| cloud.viewpoint.map_or(at[i].coords - middle, |eye| eye - at[i]);
        let normals = Neighbourhood::normals(&about, outward).into_iter();
        let normal = normals.map(|n| n.map(|n| n.into_inner())).collect();
        Self { scale, at, normal, near: found, ranges }
    }

    /// The neighbours of a voxel.
    fn near(&self, i: usize) -> &[u32] {
        &self.near[self.ranges[i].clone()]
    }

    /// The patch of each voxel, and the patches.
    fn claim(&self) -> (Vec<u32>, Vec<Patch>) {
        let mut patches = self.seeds();
        let mut owners = Vec::new();
        for _ in 0..ROUNDS {
            owners = self.grow(&patches);
            patches = self.means(&owners, &patches);
        }
        (owners, patches)
    }

    /// One seed in each occupied cube of the coarse grid: the voxel next to the middle of what is there.
    fn seeds(&self) -> Vec<Patch> {
        let with_normal = (0..self.at.len() as u32).filter(|i| self.normal[*i as usize].is_some());
        let Some(grid) = VoxelGrid::new(&self.at, with_normal, self.scale * SEED) else {
            return Vec::new();
        };
        let seed = |members: &[u32]| {
            let places = || members.iter().map(|i| self.at[*i as usize].coords);
            let mean = Point::from(places().sum::<Vector>() / members.len() as f64);
            let away = |i: &&u32| (self.at[**i as usize] - mean).norm_squared();
            let nearest = members.iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
            let i = *nearest as usize;
            Some(Patch { centre: self.at[i], normal: self.normal[i]?, evenness: 1.0, seed: i })
        };
        (0..grid.occupied()).filter_map(|c| seed(grid.members(c))).collect()
    }

    /// Each voxel's nearest patch among those that reach it.
    fn grow(&self, patches: &[Patch]) -> Vec<u32> {
        let mut owners = vec![NOBODY; self.at.len()];
        let mut far = vec![f64::INFINITY; self.at.len()];
        let nearness = 1.0 / (self.scale * SEED);
        let cost = |k: usize, i: usize| {
            let patch = &patches[k];
            let turned = self.normal[i].map_or(0.5, |n| 1.0 - n.dot(&patch.normal));
            (self.at[i] - patch.centre).norm() * nearness + NORMALS * turned
        };
        // the patch for which a voxel's neighbours were looked at
        let mut spread = vec![NOBODY; self.at.len()];
        let mut edge: Vec<usize> = Vec::new();
        for (k, patch) in patches.iter().enumerate() {
            let i = patch.seed;
            let c = cost(k, i);
            if c < far[i] {
                (far[i], owners[i]) = (c, k as u32);
                edge.push(i);
            }
        }
        // steps that a patch needs to cross twice its size
        for _ in 0..(2.0 * SEED / VOXEL) as usize {
            let mut next = Vec::new();
            for i in edge {
                let own = owners[i];
                if std::mem::replace(&mut spread[i], own) == own {
                    continue;
                }
                for j in self.near(i).iter().map(|j| *j as usize) {
                    if owners[j] == own {
                        continue;
                    }
                    let c = cost(own as usize, j);
                    if c < far[j] {
                        (far[j], owners[j]) = (c, own);
                        next.push(j);
                    }
                }
            }
            edge = next;
        }
        owners
    }

    /// The patches by what they claimed; one that claimed nothing stays where it is.
    fn means(&self, owners: &[u32], patches: &[Patch]) -> Vec<Patch> {
        let mut sums = vec![(Vector::zeros(), Vector::zeros(), 0.0); patches.len()];
        for (i, owner) in owners.iter().enumerate() {
            if let Some((place, normal, count)) = sums.get_mut(*owner as usize) {
                *place += self.at[i].coords;
                *normal += self.normal[i].unwrap_or_default();
                *count += 1.0;
            }
        }
        let mean = |(patch, (place, normal, count)): (&Patch, (Vector, Vector, f64))| {
            let evenness = normal.norm() / count;
            let normal = normal.try_normalize(1e-9).filter(|_| count > 0.0);
            let centre = Point::from(place / count);
            normal.map_or(*patch, |normal| Patch { centre, normal, evenness, ..*patch })
        };
        let mut means: Vec<Patch> = patches.iter().zip(sums).map(mean).collect();
        let mut nearest = vec![f64::INFINITY; means.len()];
        for (i, owner) in owners.iter().enumerate() {
            if let Some(patch) = means.get_mut(*owner as usize) {
                let away = (self.at[i] - patch.centre).norm_squared();
                if away < nearest[*owner as usize] {
                    nearest[*owner as usize] = away;
                    patch.seed = i;
                }
            }
        }
        means
    }
}
