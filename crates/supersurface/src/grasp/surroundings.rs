//! A scene as grippers meet it: what was seen, what no ray passed through, and the table, in a frame whose z
//! axis points up from the table.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};

use super::clumps::Clumps;
use super::shell::shell;
use super::sight::Sight;
use crate::cloud::{PointCloud, VoxelGrid, normals};
use crate::fit::Fit;
use crate::measure::OrientedBox;
use crate::segment::{Segmentation, Support};
use crate::shape::{Implicit, Plane};
use crate::{Direction, Point, Pose, Vector};

/// Spacing of the points that stand for a seen surface, in metres.
const SPACING: f64 = 0.003;
/// Spacing of the points that stand for obstacles and for what was not seen.
const COARSE: f64 = 0.005;
/// Most hidden places under a seen one, at twice the spacing: what is higher than 2 m is no object.
const TALLEST: u32 = 200;
/// How deep under a fitted surface rays must pass to disprove it, in metres.
const SKIN: f64 = 0.003;
/// Radius in which a normal is taken.
const NORMAL_RADIUS: f64 = 0.009;
/// How far a gripper reaches around an object, and how much higher another support is at least, in metres.
const REACH: f64 = 0.16;
const REACH_DOWN: f64 = 0.05;
/// One in so many points of an object in a box is one too many.
const INSIDE: usize = 10;
/// A fit decides about hidden sides up to this median residual, and from this share of inliers.
const TRUSTED_RESIDUAL: f64 = 0.003;
const TRUSTED_SHARE: f64 = 0.8;

/// A place on (or in) an object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// In the frame of the table.
    pub(super) at: Point,
    /// Outward; zero where it is not known.
    pub(super) normal: Vector,
    pub(super) seen: bool,
}

/// Everything that grasp planning shares between the objects of a scene.
#[derive(Clone, Debug)]
pub struct Surroundings<'a> {
    cloud: &'a PointCloud,
    segmentation: &'a Segmentation,
    /// The table's frame in the cloud's frame.
    pub(super) frame: Pose,
    /// True when z = 0 of that frame is a table.
    pub(super) has_table: bool,
    sight: Option<Sight>,
    /// Points that a gripper must not meet: of each object, and last of everything else.
    matter: Vec<Vec<Point>>,
    /// Walls, boards and furniture, in the frame of the table.
    solids: Vec<OrientedBox>,
}

/// One object with what is around it, in the frame of the table.
#[derive(Clone, Debug)]
pub(super) struct Local {
    pub(super) spots: Vec<Spot>,
    /// Points of everything else nearby, and of what hides behind it.
    pub(super) obstacles: Vec<Point>,
    pub(super) clumps: Clumps,
    pub(super) obstacle_clumps: Clumps,
    /// Walls, boards and furniture within reach.
    pub(super) solids: Vec<OrientedBox>,
    /// Middle of the object's matter, as far as it is known.
    pub(super) centre: Point,
    /// Heights of its lowest and highest spot.
    pub(super) heights: [f64; 2],
    pub(super) has_table: bool,
    /// True when the hidden side comes from a fit that can be trusted.
    pub(super) trusted: bool,
}

impl<'a> Surroundings<'a> {
    /// Looks at a scene once, for all objects on its main support and all grippers.
    pub fn new(cloud: &'a PointCloud, segmentation: &'a Segmentation) -> Self {
        Self::over(cloud, segmentation, 0)
    }

    /// The same for the objects on the support at place `k` of the segmentation's.
    pub fn over(cloud: &'a PointCloud, segmentation: &'a Segmentation, k: usize) -> Self {
        let support = segmentation.supports.get(k);
        let points = || segmentation.objects.iter().flatten().filter_map(|i| get(cloud, *i));
        let count = points().count().max(1) as f64;
        let middle = Point::from(points().map(|p| p.coords).sum::<Vector>() / count);
        let radius = points().map(|p| (p - middle).norm()).fold(0.0, f64::max) + 0.1;
        let frame = table_frame(support.map(|s| &s.plane), cloud.viewpoint, &middle);
        let sight = Sight::new(cloud, &middle, radius);
        let matter = matter(cloud, segmentation, support, &frame, sight.as_ref());
        let has_table = support.is_some();
        let solids = solids(cloud, segmentation, k, &frame);
        Self { cloud, segmentation, frame, has_table, sight, matter, solids }
    }

    /// The object of an index; `None` for one without points.
    pub(super) fn local(&self, object: usize, fit: Option<&Fit>) -> Option<Local> {
        let indices = self.segmentation.objects.get(object)?;
        let thin: Vec<u32> = thinned(self.cloud, indices, self.spacing(indices));
        let inward = self.frame.inverse();
        let mut spots: Vec<Spot> = Vec::with_capacity(2 * thin.len());
        for (i, n) in thin.iter().zip(normals(self.cloud, &thin, NORMAL_RADIUS)) {
            let at = inward * get(self.cloud, *i)?;
            let normal = n.map_or(Vector::zeros(), |n| inward * n.into_inner());
            spots.push(Spot { at, normal, seen: true });
        }
        let (low, high) = spots.iter().fold(None, |b: Option<(Point, Point)>, s| {
            Some(b.map_or((s.at, s.at), |(l, h)| (l.inf(&s.at), h.sup(&s.at))))
        })?;
        let obstacles = self.obstacles(object, &low, &high);
        let trusted = fit.filter(|f| is_trusted(f));
        let seen = spots.len();
        match trusted {
            Some(fit) => self.hidden_by_fit(fit, &low, &high, &mut spots),
            None => self.hidden_columns(&mut spots),
        }
        let centre = match trusted {
            Some(fit) => inward * Point::from(fit.surface.pose().translation.vector),
            // between what was seen and what it stands on
            None => {
                let mean =
                    |s: &[Spot]| s.iter().map(|s| s.at.coords).sum::<Vector>() / s.len() as f64;
                let all = mean(&spots);
                Point::from(if spots.len() > seen {
                    0.5 * (mean(&spots[..seen]) + all)
                } else {
                    all
                })
            }
        };
        let floor = if self.has_table { 0.0 } else { low.z };
        Some(Local {
            clumps: Clumps::new(spots.iter().map(|s| s.at)),
            obstacle_clumps: Clumps::new(obstacles.iter().copied()),
            spots,
            obstacles,
            solids: self.solids_near(&low, &high),
            centre,
            heights: [floor.min(low.z), high.z],
            has_table: self.has_table,
            trusted: trusted.is_some(),
        })
    }

    /// Large objects are looked at more coarsely.
    fn spacing(&self, indices: &[u32]) -> f64 {
        let points = indices.iter().step_by(16).filter_map(|i| get(self.cloud, *i));
        let bounds = points.fold(None, |b: Option<(Point, Point)>, p| {
            Some(b.map_or((p, p), |(l, h)| (l.inf(&p), h.sup(&p))))
        });
        let size = bounds.map_or(0.0, |(low, high)| (high - low).norm());
        (size / 70.0).clamp(SPACING, 2.0 * SPACING)
    }

    fn is_free(&self, at: &Point) -> bool {
        self.sight.as_ref().is_some_and(|s| s.is_free(&(self.frame * at)))
    }

    /// The sides of a trusted body that no point shows and no ray disproves.
    fn hidden_by_fit(&self, fit: &Fit, low: &Point, high: &Point, spots: &mut Vec<Spot>) {
        let inward = self.frame.inverse();
        let surface = &fit.surface;
        let shape = surface.shape();
        let seen = spots.len();
        let size = (high - low).norm();
        let step = (Vector::from(shape.half_extents()).amax() / 12.0).max(SPACING);
        for p in shell(shape, step) {
            let at = inward * (surface.pose() * p);
            if at.coords.iter().any(|v| !v.is_finite()) || (at - low).norm() > 3.0 * size {
                continue;
            }
            let normal = inward * (surface.pose() * shape.gradient(&p));
            let normal = normal.try_normalize(0.0).unwrap_or_default();
            // looked at a little inside, as a body a millimetre too wide would be seen through
            if (self.has_table && at.z < 0.0) || self.is_free(&(at - normal * SKIN)) {
                continue;
            }
            spots.push(Spot { at, normal, seen: false });
        }
        drop_near(spots, seen, 1.5 * SPACING);
    }

    /// Matter under what was seen, down to the table, where no ray passed.
    fn hidden_columns(&self, spots: &mut Vec<Spot>) {
        if !self.has_table {
            return;
        }
        let seen: Vec<Point> = spots.iter().map(|s| s.at).collect();
        let columns: Vec<Point> = seen.iter().map(|p| Point::new(p.x, p.y, 0.0)).collect();
        let Some(grid) = VoxelGrid::new(&columns, 0..columns.len() as u32, COARSE) else { return };
        for i in grid.representatives() {
            let foot = columns[i as usize];
            let mut top = 0.0f64;
            grid.within(&foot, COARSE, |k, _| top = top.max(seen[k as usize].z));
            let heights = (0..2 * TALLEST).map(|k| COARSE * (f64::from(k) + 0.5));
            for z in heights.take_while(|z| *z < top - COARSE) {
                let at = Point::new(foot.x, foot.y, z);
                if !self.is_free(&at) {
                    spots.push(Spot { at, normal: Vector::zeros(), seen: false });
                }
            }
        }
    }

    /// Boxes around an object within a gripper's reach.
    fn solids_near(&self, low: &Point, high: &Point) -> Vec<OrientedBox> {
        let half = (high - low) * 0.5 + Vector::repeat(REACH);
        let middle = nalgebra::center(low, high);
        let about = OrientedBox::new(Pose::translation(middle.x, middle.y, middle.z), half.into());
        let near = |solid: &&OrientedBox| about.as_ref().is_ok_and(|about| about.meets(solid));
        self.solids.iter().filter(near).copied().collect()
    }

    /// What stands around an object within a gripper's reach.
    fn obstacles(&self, object: usize, low: &Point, high: &Point) -> Vec<Point> {
        let (low, high) = (low - Vector::repeat(REACH), high + Vector::repeat(REACH));
        let near = |p: &&Point| (0..3).all(|k| p[k] > low[k] && p[k] < high[k]);
        let others = self.matter.iter().enumerate().filter(|(k, _)| *k != object);
        others.flat_map(|(_, points)| points.iter().filter(near)).copied().collect()
    }
}

/// The points of each object above the table, and last those of everything else, in the frame of the table:
/// thinned, with points under them that stand for what they hide.
fn matter(
    cloud: &PointCloud,
    segmentation: &Segmentation,
    support: Option<&Support>,
    frame: &Pose,
    sight: Option<&Sight>,
) -> Vec<Vec<Point>> {
    let has_table = support.is_some();
    let margin = support.map_or(f64::MIN, |s| 3.0 * s.noise + 0.004);
    let inward = frame.inverse();
    let rest = segmentation.objects.len();
    let mut owners = vec![rest; cloud.points.len()];
    for (k, object) in segmentation.objects.iter().enumerate() {
        for i in object {
            if let Some(owner) = owners.get_mut(*i as usize) {
                *owner = k;
            }
        }
    }
    let mut groups: Vec<Vec<Point>> = vec![Vec::new(); rest + 1];
    for (p, owner) in cloud.points.iter().zip(owners) {
        let p = inward * p;
        if p.z > margin && p.coords.iter().all(|v| v.is_finite()) {
            groups[owner].push(p);
        }
    }
    let is_free = |p: &Point| sight.is_some_and(|s| s.is_free(&(frame * p)));
    let solid = |points: &Vec<Point>| {
        let mut out = Vec::new();
        let Some(grid) = VoxelGrid::new(points, 0..points.len() as u32, COARSE) else { return out };
        for i in grid.representatives() {
            let p = points[i as usize];
            out.push(p);
            let below = (1..TALLEST).map(|k| p.z - 2.0 * COARSE * f64::from(k));
            let hidden = below.take_while(|z| has_table && *z > 0.0);
            let places = hidden.map(|z| Point::new(p.x, p.y, z));
            out.extend(places.take_while(|p| !is_free(p)));
        }
        out
    };
    groups.iter().map(solid).collect()
}

/// The boxes of obstacles and of the supports above support `k`, in the frame of the table. A box that an object is in is
/// that of something concave: its points alone are met.
fn solids(
    cloud: &PointCloud,
    segmentation: &Segmentation,
    k: usize,
    frame: &Pose,
) -> Vec<OrientedBox> {
    let thin = |object: &Vec<u32>| {
        object.iter().step_by(object.len().div_ceil(300).max(1)).copied().collect()
    };
    let points: Vec<Vec<u32>> = segmentation.objects.iter().map(thin).collect();
    let is_clear = |solid: &OrientedBox| {
        let inside = |i: &&u32| get(cloud, **i).is_some_and(|p| solid.contains(&p));
        points.iter().all(|object| INSIDE * object.iter().filter(inside).count() < object.len())
    };
    let own = segmentation.supports.get(k).map(|s| s.plane);
    let is_above = |s: &&Support| {
        own.is_some_and(|own| s.corners().first().is_some_and(|p| own.height(p) > REACH_DOWN))
    };
    let boards = segmentation.supports.iter().filter(is_above).filter_map(Support::board);
    let boxes = segmentation.obstacles().map(|(_, solid)| *solid);
    boxes.chain(boards).filter(is_clear).map(|solid| solid.moved(&frame.inverse())).collect()
}

/// True where a fit may decide about hidden sides.
pub(super) fn is_trusted(fit: &Fit) -> bool {
    fit.residual < TRUSTED_RESIDUAL && fit.inlier_share() > TRUSTED_SHARE
}

fn get(cloud: &PointCloud, i: u32) -> Option<Point> {
    cloud.points.get(i as usize).copied().filter(|p| p.coords.iter().all(|v| v.is_finite()))
}

fn thinned(cloud: &PointCloud, indices: &[u32], spacing: f64) -> Vec<u32> {
    VoxelGrid::new(&cloud.points, indices.iter().copied(), spacing)
        .map(|grid| grid.representatives().collect())
        .unwrap_or_default()
}

/// Drops spots from index `seen` on that lie within `radius` of one before.
fn drop_near(spots: &mut Vec<Spot>, seen: usize, radius: f64) {
    let places: Vec<Point> = spots[..seen].iter().map(|s| s.at).collect();
    let Some(grid) = VoxelGrid::new(&places, 0..seen as u32, radius) else { return };
    let mut index = 0;
    spots.retain(|s| {
        index += 1;
        let mut near = false;
        if index > seen {
            grid.within(&s.at, radius, |_, _| near = true);
        }
        !near
    });
}

/// z along the table's normal, or towards the sensor where there is no table; the origin under `middle`.
fn table_frame(support: Option<&Plane>, viewpoint: Option<Point>, middle: &Point) -> Pose {
    let towards = || {
        let view = viewpoint.map_or(Vector::z(), |p| p - middle);
        Direction::try_new(view, 1e-12).unwrap_or(Vector::z_axis())
    };
    let (normal, origin) =
        support.map_or_else(|| (towards(), *middle), |s| (s.normal(), s.project(middle)));
    let z = normal.into_inner();
    let helper = if z.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
    let x = (helper - z * z.dot(&helper)).normalize();
    let axes = Matrix3::from_columns(&[x, z.cross(&x), z]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    Isometry3::from_parts(Translation3::from(origin.coords), rotation)
}
