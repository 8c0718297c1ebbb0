//! The box around a hyperquadric, by supporting planes found from three of its terms.

use nalgebra::Matrix3;

use super::{Hyperquadric, reach};
use crate::{Point, Vector};

impl Hyperquadric {
    /// A box by supporting planes: certain, and within 0.1 % of the least for most convex forms; with an exponent
    /// under 1 it is the box of the planes `|h_i| = 1`.
    pub(super) fn bounding_box(&self) -> Option<[Point; 2]> {
        let normals = self.independent_normals();
        let basis = Matrix3::from_columns(
            &normals.map(|i| self.form.terms.get(i).map_or_else(Vector::zeros, |t| t.normal)),
        );
        let inverse = basis.try_inverse()?;
        let extent = |n: Vector| {
            let shares = inverse * n;
            let planes = std::array::from_fn(|k| {
                let ray = if shares[k] < 0.0 { -1.0 } else { 1.0 };
                let Some(t) = normals.get(k).and_then(|i| self.form.terms.get(*i)) else {
                    return Vector::zeros();
                };
                t.normal * (ray / (1.0 - ray * t.height(&self.interior)))
            });
            if self.convex {
                reach::reach(&n, planes, |v| self.radial_gauge(v))
            } else {
                reach::reach(&n, planes, |v| self.slab_gauge(v))
            }
        };
        let axes = [Vector::x(), Vector::y(), Vector::z()];
        let low = self.interior - Vector::from(axes.map(|n| extent(-n)));
        let high = self.interior + Vector::from(axes.map(extent));
        Some([low, high])
    }

    /// Three terms whose normals are as independent as can be.
    fn independent_normals(&self) -> [usize; 3] {
        let units: Vec<Vector> = self.form.terms.iter().map(|t| t.normal.normalize()).collect();
        let pick = |measure: &dyn Fn(&Vector) -> f64| {
            let best =
                units.iter().enumerate().max_by(|a, b| measure(a.1).total_cmp(&measure(b.1)));
            best.map_or((0, Vector::zeros()), |(i, u)| (i, *u))
        };
        let (i, a) = pick(&|_| 1.0);
        let (j, b) = pick(&|u| u.cross(&a).norm());
        let (k, _) = pick(&|u| a.cross(&b).dot(u).abs());
        [i, j, k]
    }
}
