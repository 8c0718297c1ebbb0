//! Which large planes are in the cloud? Random samples and consensus (RANSAC), one plane after another.
//!
//! Planes are as wide as the noise of their [`reading`](super::reading)s: a fixed width would pick one level of a far wall
//! whose depths are quantised. A sample is scored by the sum of 1 - (distance / width)^2 over the points inside (MSAC, Torr
//! and Zisserman 2000).

use crate::numeric::random::Stream;
use crate::segment::columns::{Columns, towards_eye};
use crate::segment::reading::{Reading, height};
use crate::shape::Plane;
use crate::{Direction, Vector};

/// A plane n·v + d = 0 in vectors from the eye, and the readings of the sample that lie in it.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    /// Unit normal, towards the eye (d > 0) where the eye is known.
    pub(crate) normal: Direction,
    /// Height of the eye over the plane.
    pub(crate) offset: f64,
    /// Places in the sample of the readings in the plane.
    pub(crate) members: Vec<u32>,
}

impl Candidate {
    /// The plane in the cloud's frame, where the eye is at `origin`.
    pub(crate) fn plane(&self, origin: &Vector) -> Option<Plane> {
        Plane::new(self.normal.into_inner(), self.offset - self.normal.dot(origin)).ok()
    }

    /// Signed height of a reading over the plane, and the width that its noise allows.
    #[inline]
    pub(crate) fn height(&self, r: &Reading) -> (f64, f64) {
        height(&self.normal, self.offset, r)
    }
}

/// A spread of at most `count` points of the cloud, by index, one at random from each of `count`
/// equal stretches of the list: no stride that could run along a column of the image.
pub(crate) fn spread(indices: &[u32], count: usize, random: &mut Stream) -> Vec<u32> {
    if indices.len() <= count {
        return indices.to_vec();
    }
    let bound = |k: usize| k * indices.len() / count;
    (0..count)
        .filter_map(|k| indices.get(bound(k) + random.index(bound(k + 1) - bound(k))).copied())
        .collect()
}

/// The planes that hold the most readings, each with those that no earlier plane holds, until one
/// holds under 3 % of all or `most` are found, each by so many `trials`. Only normals that `allowed` lets pass are tried.
pub(crate) fn dominant(
    all: &[Reading],
    most: usize,
    trials: usize,
    random: &mut Stream,
    allowed: impl Fn(&Direction) -> bool,
) -> Vec<Candidate> {
    let mut free: Vec<u32> = (0..all.len() as u32).collect();
    let least = (all.len() / 33).max(20);
    let mut planes = Vec::new();
    while planes.len() < most && free.len() >= least {
        let Some(found) = best(all, &free, trials, random, &allowed) else { break };
        if found.members.len() < least {
            break;
        }
        free.retain(|i| {
            let (h, width) = found.height(&all[*i as usize]);
            h.abs() > 1.5 * width
        });
        planes.push(found);
    }
    planes
}

/// Samples that find a plane among much else.
pub(crate) const TRIALS: usize = 240;
/// Readings on which they are scored.
const JURY: usize = 1500;

/// The plane that most of the free readings agree with.
fn best(
    all: &[Reading],
    free: &[u32],
    trials: usize,
    random: &mut Stream,
    allowed: impl Fn(&Direction) -> bool,
) -> Option<Candidate> {
    let jury: Vec<Reading> = spread(free, JURY, random).iter().map(|i| all[*i as usize]).collect();
    let columns = Columns::of(jury.iter());
    let mut best: Option<(f64, Direction, f64)> = None;
    for trial in 0..trials {
        let Some((normal, offset)) = sample(&jury, trial % 2 == 0, random) else { continue };
        if !allowed(&normal) {
            continue;
        }
        let score = columns.score(&normal, offset);
        if best.is_none_or(|b| score > b.0) {
            best = Some((score, normal, offset));
        }
    }
    let (_, mut normal, mut offset) = best?;
    let columns = Columns::of(free.iter().map(|i| &all[*i as usize]));
    for _ in 0..3 {
        (normal, offset) = columns.least_squares(&normal, offset, 1.0)?;
    }
    let inside = |i: &&u32| {
        let (h, width) = height(&normal, offset, &all[**i as usize]);
        h.abs() < width
    };
    let members = free.iter().filter(inside).copied().collect();
    Some(Candidate { normal, offset, members })
}

/// A plane through three readings; when `near`, the second and third are the nearest to the first of
/// eight, which finds small planes among many things.
fn sample(jury: &[Reading], near: bool, random: &mut Stream) -> Option<(Direction, f64)> {
    let mut draw = || jury.get(random.index(jury.len())).map(|r| r.ray);
    let a = draw()?;
    let mut other = || {
        let mut chosen = draw()?;
        for _ in 1..if near { 8 } else { 1 } {
            let next = draw()?;
            if (next - a).norm_squared() < (chosen - a).norm_squared() {
                chosen = next;
            }
        }
        Some(chosen)
    };
    let (b, c) = (other()?, other()?);
    let (ab, ac) = (b - a, c - a);
    let cross = ab.cross(&ac);
    // Slim triangles say nothing.
    let slim = cross.norm() <= 0.1 * ab.norm() * ac.norm();
    if slim {
        return None;
    }
    towards_eye(Direction::try_new(cross, 1e-300)?, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Point;
    use crate::cloud::PointCloud;
    use crate::segment::reading::readings;
    use crate::segment::sight::Sight;

    #[test]
    fn a_quantised_wall_is_one_plane() {
        // Depths of a wall 5 m away come in steps of 70 mm; a table is in front of it.
        let mut random = Stream::new(1, 0);
        let mut points = Vec::new();
        for k in 0..6000 {
            let (x, y) = (random.between(-0.5, 0.5), random.between(-0.4, 0.4));
            let wall: f64 = 5.0 + 0.6 * x;
            let z =
                if k % 3 == 0 { 0.5 / (0.7 * y.abs() + 0.5) } else { (wall / 0.07).round() * 0.07 };
            points.push(if k % 3 == 0 {
                Point::new(x * z, y.abs() * z, z + 0.001 * random.normal())
            } else {
                Point::new(x * z, -y.abs() * z, z)
            });
        }
        let cloud =
            PointCloud { viewpoint: Some(Point::origin()), ..PointCloud::from_points(points) };
        let indices: Vec<u32> = (0..6000).collect();
        let sight = Sight::of(&cloud, &indices);
        let planes =
            dominant(&readings(&cloud, &indices, &sight), 4, TRIALS, &mut random, |_| true);
        assert_eq!(planes.len(), 2);
        assert!(planes[0].members.len() > 3800);
        let table = Vector::new(0.0, -0.7, -0.5).normalize();
        assert!(planes[1].normal.dot(&table) > 0.9999);
    }
}
