//! Floor 7: one supersurface for the points of one object.

use crate::Point;
use crate::shape::{Plane, Posed};
use crate::surface::Surface;

/// What was seen of an object.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// Points on the object, in metres; rows that are not finite are left out.
    pub points: &'a [Point],
    /// Where the sensor stood; `None` when the object was seen from all around.
    pub viewpoint: Option<Point>,
    /// The plane that the object stands on.
    pub support: Option<Plane>,
}

/// A recovered supersurface and how sure it is.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit {
    /// The shape in the frame of the points.
    pub surface: Posed<Surface>,
    /// Standard deviation of the inliers about the surface, in metres.
    pub noise: f64,
    /// Median of the absolute distances of all points, in metres.
    pub residual: f64,
    /// Which of the points belong to the surface.
    pub inliers: Vec<bool>,
    /// By how much the log-likelihood a point (in nats, penalised) of this family exceeds that of the
    /// other; 0 when only one was tried.
    pub margin: f64,
}

impl Fit {
    /// Share of the points that belong to the surface, in [0, 1].
    pub fn inlier_share(&self) -> f64 {
        let n = self.inliers.iter().filter(|i| **i).count();
        n as f64 / self.inliers.len().max(1) as f64
    }
}
