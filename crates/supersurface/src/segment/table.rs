//! Which of the planes is a table (or the floor that the objects stand on)?
//!
//! A support faces up: its normal leans towards the image's top, n·up = cos(pitch) for a camera
//! pitched down by `pitch`, while a wall seen by a level or lowered camera has n·up <= 0 and a side wall
//! n·up = 0. A plane faced squarely is a table only for a camera that looks straight down on it from an
//! arm's length. A support is near, wide, and what is seen in front of it is on its upper side.

use crate::cloud::{PointCloud, VoxelGrid};
use crate::numeric::column::Column;
use crate::numeric::random::Stream;
use crate::segment::columns::Columns;
use crate::segment::footprint::{Ground, Outline, Spot, spot_on};
use crate::segment::planes::{Candidate, TRIALS, dominant, spread};
use crate::segment::reading::{Reading, height, readings};
use crate::segment::sight::Sight;
use crate::shape::Plane;
use crate::{Direction, Point};

/// Why no plane of a cloud is a support, told of the largest one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoTable {
    /// No plane holds a fair share of the points.
    #[error("no plane holds enough of the points")]
    NoPlane,
    /// The largest plane is upright.
    #[error(
        "the largest plane, {distance:.2} m away, is a wall ({degrees:.0} degrees from facing up)"
    )]
    Wall {
        /// Distance of the sensor from it, in metres.
        distance: f64,
        /// Angle between its normal and the image's upward direction, in degrees.
        degrees: f64,
    },
    /// The largest plane that faces up is too far away.
    #[error("the largest plane that faces up is {distance:.2} m away: farther than {limit:.2} m")]
    Far {
        /// Median distance of its points, in metres.
        distance: f64,
        /// Largest distance of a support, in metres.
        limit: f64,
    },
    /// Too much was seen beneath the largest plane that faces up: it is the top of something.
    #[error("{percent:.0} % of the points are beneath the largest plane that faces up")]
    Below {
        /// Share of all points that are beneath it, in percent.
        percent: f64,
    },
    /// The largest plane that faces up is too narrow.
    #[error("the largest plane that faces up is {width:.2} m across, under {limit:.2} m")]
    Narrow {
        /// Its largest width, in metres.
        width: f64,
        /// Least width of a support, in metres.
        limit: f64,
    },
    /// The largest plane that faces up is too small.
    #[error(
        "the largest plane that faces up holds {percent:.1} % of the points, under {limit:.1} %"
    )]
    Small {
        /// Its share of the points, in percent.
        percent: f64,
        /// Least share, in percent.
        limit: f64,
    },
}

/// Median distance of a support's points from the sensor, at most, in metres.
const FARTHEST: f64 = 3.5;
/// Distance of a support that the camera faces squarely, at most, in metres.
const OVERHEAD: f64 = 1.3;
/// Cosine of the angle to the optical axis from which a plane counts as faced squarely (20 degrees).
const SQUARE: f64 = 0.94;
/// n·up of a support at least: a camera pitched down by up to 70 degrees, or rolled as much.
const LEAST_UP: f64 = 0.34;
/// Share of the points that a support holds at least.
const LEAST_SHARE: f64 = 0.1;
/// Points beneath a support (a floor beside the table) at most, in multiples of its own.
const MOST_BELOW: f64 = 2.0;
/// Width of a support at least, in metres.
const NARROWEST: f64 = 0.25;
/// What makes a plane over a floor a table rather than the top of a box: it is level (cosine), this far
/// above the floor, and this wide, in metres.
const LEVEL: f64 = 0.99;
const TABLE_HEIGHT: f64 = 0.3;
const TABLE_WIDTH: f64 = 0.5;
/// The floor's points, at most, in multiples of the table's.
const TABLE_SHARE: usize = 2;
/// Points of the cloud that the search sees, and that the last refinement sees.
const SAMPLE: usize = 6000;
const FINE_SAMPLE: usize = 20_000;
/// Points from which a support's outline is found.
const COARSE_SAMPLE: usize = 5000;
/// Standard deviation of what is normally distributed, by the median of its absolute values, which outliers do not move.
const NORMAL: f64 = 1.4826;
/// Gap in the support's points that parts it in two, in metres.
const PIECE_GAP: f64 = 0.06;
/// Depth inside its outline at which something is on it, in metres.
const EDGE: f64 = 0.01;
/// Gap that things on the support may make in what is seen of it, in metres.
const OBJECT_GAP: f64 = 0.25;

/// A level thing that objects stand on: a table, a floor, a board.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Support {
    /// Its plane, the normal upwards.
    pub plane: Plane,
    /// Standard deviation of its points about the plane, in metres.
    pub noise: f64,
    /// The same in widths of the noise model.
    pub(crate) relative: f64,
    /// Where it was seen.
    pub(crate) outline: Outline,
}

impl Support {
    /// Corners of the convex outline of what was seen of it, counter-clockwise from above.
    pub fn corners(&self) -> Vec<Point> {
        self.outline.corners().iter().map(|s| spot_on(&self.plane, s)).collect()
    }

    /// Share of some points that is over the part of it that was seen.
    pub(crate) fn share_over<'a>(&self, points: impl Iterator<Item = &'a Point> + Clone) -> f64 {
        let ground = Ground::of(&self.plane);
        let inside = |p: &&Point| self.outline.holds(&ground.spot(p), EDGE);
        points.clone().filter(inside).count() as f64 / points.count().max(1) as f64
    }

    /// The same with its normal on the side of `up`.
    pub(crate) fn upwards(self, up: &Direction) -> Self {
        if self.plane.normal().dot(up) > 0.0 {
            return self;
        }
        // the same spots by the other normal's axes
        let (corners, plane) = (self.corners(), self.plane.flipped());
        let ground = Ground::of(&plane);
        let outline = Outline::around(&mut corners.iter().map(|p| ground.spot(p)).collect());
        Self { plane, outline, ..self }
    }
}

/// The support among the points named by `indices`.
pub(crate) fn find(
    cloud: &PointCloud,
    indices: &[u32],
    random: &mut Stream,
) -> Result<(Support, Sight), NoTable> {
    let sample = spread(indices, SAMPLE, random);
    let sight = Sight::of(cloud, &sample);
    let all = readings(cloud, &sample, &sight);
    let mut planes = dominant(&all, 6, TRIALS, random, |_| true);
    planes.sort_by_key(|c| std::cmp::Reverse(c.members.len()));
    // From the eye's frame to the cloud's.
    let origin =
        sample.first().and_then(|i| Some(cloud.points.get(*i as usize)?.coords - all.first()?.ray));
    let wide = |candidate: &Candidate, random: &mut Stream| {
        let plane = candidate.plane(&origin?)?;
        let support = refine(cloud, indices, &plane, &sight, random)?;
        let width = support.outline.diameter();
        Some((support, width))
    };
    let mut why = None;
    for candidate in &planes {
        if let Err(reason) = judge(candidate, &all, &sight) {
            why.get_or_insert(reason);
            continue;
        }
        let Some((support, width)) = wide(candidate, random) else { continue };
        if width < NARROWEST {
            why.get_or_insert(NoTable::Narrow { width, limit: NARROWEST });
            continue;
        }
        // A table is preferred to the floor that it stands on, though less of it may be seen.
        let above = planes.iter().filter(|c| {
            let rise = candidate.offset - c.offset;
            c.normal.dot(&candidate.normal) > LEVEL
                && rise > TABLE_HEIGHT
                && c.members.len() > candidate.members.len() / TABLE_SHARE
        });
        let table = above.filter_map(|c| wide(c, random)).find(|(_, width)| *width > TABLE_WIDTH);
        return Ok((table.map_or(support, |(table, _)| table), sight));
    }
    Err(why.unwrap_or(NoTable::NoPlane))
}

/// Whether a plane can be a support.
fn judge(candidate: &Candidate, all: &[Reading], sight: &Sight) -> Result<(), NoTable> {
    let inside = all.iter().filter(|r| {
        let (h, width) = candidate.height(r);
        h.abs() < width
    });
    let share = inside.count() as f64 / all.len() as f64;
    let beneath = all.iter().filter(|r| {
        let (h, width) = candidate.height(r);
        h < -3.0 * width - 0.02
    });
    let below = beneath.count() as f64 / all.len() as f64;
    let mut ranges: Vec<f64> =
        candidate.members.iter().map(|i| all[*i as usize].ray.norm()).collect();
    let middle = ranges.len() / 2;
    let range = *ranges.select_nth_unstable_by(middle, f64::total_cmp).1;
    if sight.eye.is_some() {
        // Rounding may take these past 1.
        let facing = (-candidate.normal.dot(&sight.forward)).clamp(-1.0, 1.0);
        let up = sight.up.map_or(facing, |up| candidate.normal.dot(&up).clamp(-1.0, 1.0));
        let overhead = facing > SQUARE && candidate.offset < OVERHEAD;
        if !overhead && (up < LEAST_UP || facing > SQUARE) {
            let degrees = up.acos().to_degrees();
            return Err(NoTable::Wall { distance: candidate.offset, degrees });
        }
        if range > FARTHEST {
            return Err(NoTable::Far { distance: range, limit: FARTHEST });
        }
    }
    if share < LEAST_SHARE {
        let (percent, limit) = (100.0 * share, 100.0 * LEAST_SHARE);
        return Err(NoTable::Small { percent, limit });
    }
    if below > MOST_BELOW * share {
        return Err(NoTable::Below { percent: 100.0 * below });
    }
    Ok(())
}

/// The plane by all its points, with its noise and outline.
pub(crate) fn refine(
    cloud: &PointCloud,
    indices: &[u32],
    plane: &Plane,
    sight: &Sight,
    random: &mut Stream,
) -> Option<Support> {
    let sample = spread(indices, FINE_SAMPLE, random);
    let all = readings(cloud, &sample, sight);
    // From the eye's frame to the cloud's.
    let origin = cloud.points.get(*sample.first()? as usize)?.coords - all.first()?.ray;
    let (mut normal, mut offset) = (plane.normal(), plane.height(&Point::from(origin)));
    let (mut relative, mut inside) = (0.0, Columns::of(all.iter()));
    let place = |r: &Reading| Point::from(r.ray + origin);
    let mut shares = Column::default();
    for _ in 0..2 {
        // The plane runs on through other things, which would tilt it: only its main piece counts.
        let ground = Ground::of(&Plane::new(normal.into_inner(), offset).ok()?);
        let outline = main_piece(&all, &normal, offset, PIECE_GAP, |r| ground.spot(&place(r)))?;
        inside.count_within(&outline, &ground, &origin);
        let mut share = 1.0;
        for _ in 0..3 {
            (normal, offset) = inside.least_squares(&normal, offset, share)?;
            relative = NORMAL * inside.deviation(&normal, offset, &mut shares)?;
            share = (2.5 * relative).clamp(0.05, 1.0);
        }
    }
    let mut heights: Vec<f64> = inside.near(&normal, offset).map(f64::abs).collect();
    let middle = heights.len() / 2;
    let median =
        (!heights.is_empty()).then(|| *heights.select_nth_unstable_by(middle, f64::total_cmp).1);
    let noise = NORMAL * median?;
    let plane = Plane::new(normal.into_inner(), offset - normal.dot(&origin)).ok()?;
    let ground = Ground::of(&plane);
    let outline = main_piece(&all, &normal, offset, OBJECT_GAP, |r| ground.spot(&place(r)))?;
    Some(Support { plane, noise, relative, outline })
}

/// Outline of the largest piece of the readings in a plane.
fn main_piece(
    all: &[Reading],
    normal: &Direction,
    offset: f64,
    gap: f64,
    foot: impl Fn(&Reading) -> Spot,
) -> Option<Outline> {
    let step = all.len() / COARSE_SAMPLE + 1;
    let inside = all.iter().step_by(step).filter(|r| {
        let (h, width) = height(normal, offset, r);
        h.abs() < width
    });
    let feet: Vec<Point> = inside.map(foot).map(|[x, y]| Point::new(x, y, 0.0)).collect();
    let pieces = VoxelGrid::new(&feet, 0..feet.len() as u32, gap)?.components();
    let main = pieces.into_iter().max_by_key(Vec::len)?;
    let spots = main.iter().filter_map(|i| feet.get(*i as usize));
    Some(Outline::around(&mut spots.map(|p| [p.x, p.y]).collect()))
}
