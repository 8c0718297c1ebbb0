//! A reading and the width of a plane that its noise allows.
//!
//! A point belongs to the plane n·p + d = 0 when |n·p + d| < 3 sigma(r) |n·e| + floor: depth noise
//! sigma acts along the ray e, so it counts only as far as the ray is square to the plane.

use crate::cloud::PointCloud;
use crate::segment::sight::{Sight, depth_noise};
use crate::{Point, Vector};

/// Widths: this many standard deviations, plus a floor in metres.
pub(crate) const WIDTHS: f64 = 3.0;
pub(crate) const FLOOR: f64 = 0.0015;
/// Width where the sensor's place is unknown, in metres.
pub(crate) const BLIND: f64 = 0.006;

/// A reading as the search sees it: the vector from the eye (or the cloud's middle), and the width
/// that its noise allows per unit of n·vector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading {
    pub(crate) ray: Vector,
    pub(crate) slope: f64,
    pub(crate) floor: f64,
}

impl Reading {
    /// The reading of a point.
    pub(crate) fn new(p: &Point, sight: &Sight, middle: &Point) -> Self {
        match sight.eye {
            Some(eye) => {
                let ray = p - eye;
                let range = ray.norm().max(1e-6);
                Self { ray, slope: WIDTHS * depth_noise(range) / range, floor: FLOOR }
            }
            None => Self { ray: p - middle, slope: 0.0, floor: BLIND },
        }
    }
}

/// Signed height of a reading over a plane, and the width that its noise allows.
#[inline]
pub(crate) fn height(normal: &Vector, offset: f64, r: &Reading) -> (f64, f64) {
    let along = normal.dot(&r.ray);
    (along + offset, r.slope * along.abs() + r.floor)
}

/// The readings of the points named in `sample`.
pub(crate) fn readings(cloud: &PointCloud, sample: &[u32], sight: &Sight) -> Vec<Reading> {
    let points = || sample.iter().filter_map(|i| cloud.points.get(*i as usize));
    let sum: Vector = points().map(|p| p.coords).sum();
    let middle = Point::from(sum / sample.len().max(1) as f64);
    points().map(|p| Reading::new(p, sight, &middle)).collect()
}
