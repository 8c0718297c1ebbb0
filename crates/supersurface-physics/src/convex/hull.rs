//! The convex hull of points, by its support points alone: no faces are made.

use supersurface::shape::SupportMap;
use supersurface::{Point, Vector};

/// Points in columns, so that their heights are found several at a time.
#[derive(Clone, Debug)]
pub(crate) struct Hull {
    columns: [Vec<f64>; 3],
}

impl Hull {
    /// `None` without points, or where one isn't finite.
    pub(crate) fn new(points: &[Point]) -> Option<Self> {
        let finite = points.iter().all(|p| p.iter().all(|v| v.is_finite()));
        let columns = [0, 1, 2].map(|k| points.iter().map(|p| p[k]).collect());
        (finite && !points.is_empty()).then_some(Self { columns })
    }
}

impl SupportMap for Hull {
    fn support_point(&self, n: &Vector) -> Point {
        let [x, y, z] = &self.columns;
        let heights = x.iter().zip(y).zip(z).map(|((x, y), z)| x * n.x + y * n.y + z * n.z);
        let mut best = (f64::NEG_INFINITY, 0);
        for (k, height) in heights.enumerate() {
            if height > best.0 {
                best = (height, k);
            }
        }
        let at = |column: &[f64]| column.get(best.1).copied().unwrap_or_default();
        Point::new(at(x), at(y), at(z))
    }
}
