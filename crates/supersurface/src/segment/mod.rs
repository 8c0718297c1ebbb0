//! Floor 7: from a cloud to the table plane and what stands on it.
//!
//! [`segment`] finds the main support (a table, or the floor that things stand on), further ones above and below it
//! (boards, a desk), and walls; it takes the points above each support and parts them into clumps. [`segment_whole`] takes
//! a cloud that is one object already, and [`segment_masks`] one whose objects are labelled. What was left out is listed
//! with the reason, and with its box where a gripper must not meet it.
//!
//! Objects that touch are one clump, which [`separate`](crate::separate) cuts.

mod boards;
mod class;
mod clusters;
mod columns;
mod convexity;
mod facets;
mod footprint;
mod frame;
mod image;
mod masks;
mod objects;
mod part;
mod patches;
mod piece;
mod planes;
mod raster;
mod reading;
mod room;
mod sight;
mod solids;
mod table;
mod walls;

pub use convexity::convex_pieces;
pub(crate) use frame::Frame;
pub(crate) use image::hangs;
pub use masks::{segment_masks, segment_whole};
pub(crate) use patches::{Patches, patches};
pub(crate) use raster::Raster;
pub use table::{NoTable, Support};

use crate::Point;
use crate::cloud::PointCloud;
use crate::measure::OrientedBox;
use crate::numeric::random::Stream;
use crate::segment::part::part;
use crate::segment::sight::Sight;
use crate::segment::solids::box_about;
use crate::shape::Plane;

/// What a cloud is made of. Indices into the cloud's points; never copies.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Segmentation {
    /// What objects may stand on, the main one first; none when the objects were given and none was found.
    pub supports: Vec<Support>,
    /// Points of each object.
    pub objects: Vec<Vec<u32>>,
    /// The support, by its place in `supports`, that each object stands on; empty without one.
    pub stands_on: Vec<usize>,
    /// What was seen above the support and left out, with the reason.
    pub dropped: Vec<Dropped>,
    /// The image that an unorganised cloud was taken as.
    image: Option<Raster>,
}

impl Segmentation {
    /// The plane of the main support, its normal towards the sensor.
    pub fn support(&self) -> Option<Plane> {
        self.supports.first().map(|s| s.plane)
    }

    /// What is in a gripper's way and no object: walls, furniture and what the image cuts off, each with its box.
    pub fn obstacles(&self) -> impl Iterator<Item = (&Dropped, &OrientedBox)> {
        self.dropped.iter().filter_map(|d| Some((d, d.bounds.as_ref()?)))
    }

    /// The image that an unorganised cloud was taken as.
    pub(crate) const fn image(&self) -> Option<&Raster> {
        self.image.as_ref()
    }

    /// What each of a cloud's points is: k for object number k (from 1), -1 for a piece that was
    /// dropped and for points that are not finite, 0 for the rest, support and background.
    pub fn labels(&self, points: &[Point]) -> Vec<i32> {
        let valid = |p: &Point| p.coords.iter().all(|v| v.is_finite());
        let mut labels: Vec<i32> = points.iter().map(|p| if valid(p) { 0 } else { -1 }).collect();
        let mut mark = |points: &[u32], label: i32| {
            for i in points {
                if let Some(l) = labels.get_mut(*i as usize) {
                    *l = label;
                }
            }
        };
        for piece in &self.dropped {
            mark(&piece.points, -1);
        }
        for (object, label) in self.objects.iter().zip(1..) {
            mark(object, label);
        }
        labels
    }
}

/// A piece that is not reported as an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Dropped {
    /// Its points.
    pub points: Vec<u32>,
    /// Why.
    pub reason: DropReason,
    /// Where it is large and solid, and so in a gripper's way: the box about what was seen of it.
    pub bounds: Option<OrientedBox>,
}

impl Dropped {
    /// A piece with its box, where its reason asks for one: in its own plane for a wall, else upright on `plane`.
    pub(crate) fn new(
        cloud: &[Point],
        points: Vec<u32>,
        reason: DropReason,
        plane: &Plane,
    ) -> Self {
        let large = |solid: &OrientedBox| {
            reason.is_solid() || solid.half_extents().iter().any(|h| 2.0 * h > FURNITURE)
        };
        let may_be = reason.is_solid() || reason == DropReason::OffSupport;
        let bounds = may_be.then(|| box_about(cloud, &points, plane)).flatten().filter(large);
        Self { points, reason, bounds }
    }
}

/// Why a piece was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DropReason {
    /// Too few points or too small to be an object.
    Speck,
    /// So low that it may be the support's own unevenness.
    Flat,
    /// Too large to be an object: furniture, a wall.
    TooLarge,
    /// It stands beside the part of the support that was seen.
    OffSupport,
    /// The border of the image cuts most of it off, and it touches nothing that is seen whole.
    CutOff,
    /// A small piece in the air, with the support seen under it: stray readings.
    Hanging,
    /// A large upright plane: a wall, or a side of a tote or a shelf.
    Wall,
    /// It hangs on a support or reaches up to it: an edge, a leg, a panel.
    Fixture,
}

impl DropReason {
    const fn is_solid(self) -> bool {
        matches!(self, Self::TooLarge | Self::CutOff | Self::Wall | Self::Fixture)
    }
}

impl std::fmt::Display for DropReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Speck => "a speck: too few points or too small",
            Self::Flat => "hardly above the support: may be its unevenness",
            Self::TooLarge => "too large: furniture or a wall",
            Self::OffSupport => "not on the part of the support that was seen",
            Self::CutOff => "cut off by the border of the image",
            Self::Hanging => "hangs in the air: stray readings",
            Self::Wall => "a wall, or a side of a container or a shelf",
            Self::Fixture => "part of a support: its edge, a leg or a panel",
        })
    }
}

/// How a cloud is parted.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentOptions {
    /// Least number of points of an object.
    pub least_points: usize,
    /// Least size of an object (diagonal of its box), in metres.
    pub least_size: f64,
    /// Largest size of an object (diagonal of its box), in metres.
    pub largest_size: f64,
    /// Gap between two points that parts them, in metres; the spacing of the points adds to it.
    pub gap: f64,
    /// Height over the support from which a point belongs to an object, in metres; `None` takes it
    /// from the support's noise and the distance (4 to 6 mm at 0.7 m).
    pub margin: Option<f64>,
    /// Seed of the random samples by which planes are found.
    pub seed: u64,
}

impl Default for SegmentOptions {
    fn default() -> Self {
        Self {
            least_points: 100,
            least_size: 0.015,
            largest_size: 1.5,
            gap: 0.008,
            margin: None,
            seed: 0,
        }
    }
}

/// Why a cloud cannot be parted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SegmentError {
    /// The cloud has no points.
    #[error("the cloud is empty")]
    EmptyCloud,
    /// None of the points is finite (and within 100,000 km).
    #[error("none of the cloud's {points} points is a finite reading within 100,000 km")]
    NoFinitePoints {
        /// Number of points.
        points: usize,
    },
    /// There are too few readings to say anything.
    #[error("the cloud has {found} finite points within 100,000 km: at least {least} are needed")]
    TooFewPoints {
        /// Number of finite points.
        found: usize,
        /// Least number.
        least: usize,
    },
    /// No plane is a table.
    #[error("no table or floor to stand on: {why}")]
    NoSupport {
        /// What disqualified the largest plane.
        why: NoTable,
    },
    /// No point has a label other than 0.
    #[error("the given labels name no object")]
    NoLabels,
    /// More labels than a scene has objects.
    #[error("the given labels name {found} objects, more than {most}: is this a segmentation?")]
    TooManyLabels {
        /// Number of labels.
        found: usize,
        /// Most labels.
        most: usize,
    },
}

/// Length from which what stands beside a support is furniture and no stray reading, in metres.
const FURNITURE: f64 = 0.12;
/// Finite points without which nothing is tried.
const LEAST: usize = 30;

/// The readings of a cloud, by index.
fn readings(cloud: &PointCloud) -> Result<Vec<u32>, SegmentError> {
    let count = cloud.points.len();
    // each is written, and the next one over it where it is none: no branch to guess
    let (mut seen, mut found) = (vec![0; count], 0);
    for (p, i) in cloud.points.iter().zip(0u32..) {
        seen[found] = i;
        found += usize::from(sight::seen(p));
    }
    seen.truncate(found);
    match seen.len() {
        _ if count == 0 => Err(SegmentError::EmptyCloud),
        0 => Err(SegmentError::NoFinitePoints { points: count }),
        found if found < LEAST => Err(SegmentError::TooFewPoints { found, least: LEAST }),
        _ => Ok(seen),
    }
}

/// The supports of a scene and the objects on them.
///
/// ```
/// use supersurface::{Point, cloud::PointCloud, segment::{SegmentOptions, segment}};
/// // A table 0.6 m below the sensor with a box of 6 cm on it, seen from straight above.
/// let mut cloud = PointCloud::default();
/// for i in 0..200 * 200 {
///     let (x, y) = (0.003 * f64::from(i % 200 - 100), 0.003 * f64::from(i / 200 - 100));
///     let z = if x.abs().max(y.abs()) < 0.03 { 0.54 } else { 0.6 };
///     cloud.points.push(Point::new(x, y, z));
/// }
/// cloud.viewpoint = Some(Point::origin());
/// let found = segment(&cloud, &SegmentOptions::default())?;
/// assert_eq!(found.objects.len(), 1);
/// assert!((found.support().unwrap().offset() - 0.6).abs() < 1e-3);
/// # Ok::<(), supersurface::segment::SegmentError>(())
/// ```
pub fn segment(cloud: &PointCloud, options: &SegmentOptions) -> Result<Segmentation, SegmentError> {
    let seen = readings(cloud)?;
    let mut random = Stream::new(options.seed, 0);
    let (support, sight) =
        table::find(cloud, &seen, &mut random).map_err(|why| SegmentError::NoSupport { why })?;
    let normal = support.plane.normal().into_inner();
    let raster = match sight::grid(cloud) {
        Some(_) => None,
        None => Raster::of(cloud, &seen, &sight, &normal, &mut random),
    };
    let mut found = match &raster {
        None => part(cloud, support, &sight, options),
        Some(raster) => {
            let sight = Sight { pixel: Some(raster.pixel), ..sight };
            let mut found = part(&raster.cloud, support, &sight, options);
            found.objects.iter_mut().for_each(|o| *o = raster.back(o));
            found.dropped.iter_mut().for_each(|d| d.points = raster.back(&d.points));
            found
        }
    };
    found.image = raster;
    Ok(found)
}
