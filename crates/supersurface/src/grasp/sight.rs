//! What the sensor's rays prove: a picture of the farthest reading in each direction.

use crate::cloud::PointCloud;
use crate::{Point, Vector};

/// Cells a unit of tangent: about 2.3 mm at 0.7 m.
const FOCAL: f64 = 300.0;
/// Most cells on a side.
const MOST: f64 = 700.0;
/// A place is free when something was seen this much farther along its ray, in metres.
const TOLERANCE: f64 = 0.010;

/// The farthest depth that was read in each direction from the viewpoint.
#[derive(Clone, Debug)]
pub(super) struct Sight {
    viewpoint: Point,
    forward: Vector,
    right: Vector,
    down: Vector,
    corner: [f64; 2],
    focal: f64,
    size: [usize; 2],
    depth: Vec<f32>,
}

impl Sight {
    /// The picture of a cloud towards `centre`; `None` without a viewpoint outside of it.
    pub(super) fn new(cloud: &PointCloud, centre: &Point, radius: f64) -> Option<Self> {
        let viewpoint = cloud.viewpoint?;
        let distance = (centre - viewpoint).norm();
        if distance.is_nan() || distance <= 1.05 * radius {
            return None;
        }
        let forward = (centre - viewpoint) / distance;
        let helper = if forward.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
        let right = (helper - forward * forward.dot(&helper)).normalize();
        let down = forward.cross(&right);
        let reach = (radius / (distance - radius)).min(1.5);
        let focal = FOCAL.min(0.5 * MOST / reach);
        let side = (2.0 * reach * focal) as usize + 1;
        let mut sight = Self {
            viewpoint,
            forward,
            right,
            down,
            corner: [-reach; 2],
            focal,
            size: [side; 2],
            depth: vec![0.0; side * side],
        };
        for p in &cloud.points {
            if let Some((cell, depth)) = sight.cell(p) {
                sight.depth[cell] = sight.depth[cell].max(depth as f32);
            }
        }
        Some(sight)
    }

    #[inline]
    fn cell(&self, p: &Point) -> Option<(usize, f64)> {
        let r = p - self.viewpoint;
        let depth = r.dot(&self.forward);
        if depth.is_nan() || depth <= 0.0 {
            return None;
        }
        let u = (r.dot(&self.right) / depth - self.corner[0]) * self.focal;
        let v = (r.dot(&self.down) / depth - self.corner[1]) * self.focal;
        let inside = u >= 0.0 && v >= 0.0 && u < self.size[0] as f64 && v < self.size[1] as f64;
        inside.then(|| (v as usize * self.size[0] + u as usize, depth))
    }

    /// True where a ray passed: something was seen behind this place.
    #[inline]
    pub(super) fn is_free(&self, p: &Point) -> bool {
        self.cell(p).is_some_and(|(cell, depth)| f64::from(self.depth[cell]) > depth + TOLERANCE)
    }
}
