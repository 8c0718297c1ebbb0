//! Mass of a hyperquadric: of a convex one by lines from its inner point ([`filled_mass`]), of another one with a bound
//! by the middles of cells, of one without bounds infinite.

use nalgebra::Matrix3;

use super::Hyperquadric;
use crate::shape::filled::{STAR_PIECES, filled_mass, star};
use crate::shape::{Filled, Implicit, Mass, MassEstimate, MassProperties, Moments};
use crate::{Point, Vector};

/// Cells a side for solids that are not convex.
const CELLS: usize = 100;

/// A convex one with bounds, seen from its inner point.
struct Seen<'a> {
    solid: &'a Hyperquadric,
    half: Vector,
}

impl Filled for Seen<'_> {
    fn pieces(&self) -> usize {
        STAR_PIECES
    }

    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64)) {
        let frame = [self.solid.interior.coords, self.half];
        star(frame, (piece, at), |d| self.solid.radial_gauge(d).0, shares, each);
    }
}

impl Hyperquadric {
    fn by_cells(&self, cells: usize) -> Moments {
        let [low, high] = self.bounds();
        let cell = (high - low) / cells as f64;
        let mut sum = Moments::nothing();
        for (i, j, k) in (0..cells)
            .flat_map(|i| (0..cells).flat_map(move |j| (0..cells).map(move |k| (i, j, k))))
        {
            let step = Vector::new(i as f64 + 0.5, j as f64 + 0.5, k as f64 + 0.5);
            let p = low + step.component_mul(&cell);
            if self.form.value(&p) <= 1.0 {
                sum.add(1.0, &p.coords);
            }
        }
        sum.scaled(cell.product())
    }
}

impl MassProperties for Hyperquadric {
    fn mass_properties(&self, density: f64) -> Mass {
        self.mass_estimate(density).mass
    }

    /// Infinite, about the inner point, without bounds; with an exponent under 1 good to about a thousandth.
    fn mass_estimate(&self, density: f64) -> MassEstimate {
        let [low, high] = self.bounds();
        let half = (high - low) * 0.5;
        if density == 0.0 {
            return MassEstimate::exact(Moments::nothing().mass(0.0));
        }
        if !half.iter().all(|v| v.is_finite()) {
            let mass = f64::INFINITY.copysign(density);
            let inertia = Matrix3::from_diagonal_element(mass);
            return MassEstimate::exact(Mass { mass, centre: self.interior, inertia });
        }
        if self.convex {
            return filled_mass(&Seen { solid: self, half }, density);
        }
        let [coarse, fine] = [CELLS / 2, CELLS].map(|n| self.by_cells(n).mass(density));
        MassEstimate::refined(&coarse, fine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Superellipsoid;

    #[test]
    fn a_moved_superellipsoid_weighs_the_same() {
        let planes = [[5.0, 0.0, 0.0, -1.0], [0.0, 2.0, 0.0, 3.0], [0.0, 0.0, 10.0, 0.5]];
        for (e, allowed) in [(0.25, 1e-5), (1.0, 1e-6), (1.6, 1e-4), (2.5, 3e-2)] {
            let truth = Superellipsoid::new([0.2, 0.5, 0.1], [e; 2]).unwrap().mass_properties(3.0);
            let solid = Hyperquadric::new(&planes, &[2.0 / e; 3]).unwrap();
            let found = solid.mass_estimate(3.0);
            let moved = truth.moved(&crate::Pose::translation(0.2, -1.5, -0.05));
            let off = MassEstimate::refined(&moved, found.mass).error;
            assert!(off < allowed && found.error < 3.0 * allowed, "{e}: {off} {}", found.error);
        }
    }

    #[test]
    fn a_pipe_without_end_weighs_without_end() {
        let pipe = [[1.0, 0.0, 0.0, -0.2], [0.0, 1.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0]];
        let pipe = Hyperquadric::new(&pipe, &[2.0; 3]).unwrap();
        assert_eq!(pipe.mass_properties(2.0).mass, f64::INFINITY);
        assert_eq!(pipe.mass_properties(0.0).mass, 0.0);
    }
}
