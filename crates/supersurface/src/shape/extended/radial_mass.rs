//! Mass of the radial extended superellipsoid, by lines from its centre.

use super::RadialExtended;
use crate::shape::filled::{STAR_PIECES, filled_mass, star};
use crate::shape::{Filled, Implicit, Mass, MassEstimate, MassProperties};
use crate::{Point, Vector};

impl Filled for RadialExtended {
    fn pieces(&self) -> usize {
        STAR_PIECES
    }

    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64)) {
        let frame = [Vector::zeros(), Vector::from(self.numbers().semi_axes())];
        star(frame, (piece, at), |d| self.gauge(&Point::from(*d)), shares, each);
    }
}

impl MassProperties for RadialExtended {
    fn mass_properties(&self, density: f64) -> Mass {
        self.mass_estimate(density).mass
    }

    fn mass_estimate(&self, density: f64) -> MassEstimate {
        filled_mass(self, density)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{ExtendedSuperellipsoid, Superellipsoid};

    #[test]
    fn constant_exponents_weigh_what_a_superellipsoid_weighs() {
        let (axes, e) = ([0.4, 0.3, 0.5], [0.6, 1.3]);
        let truth = Superellipsoid::new(axes, e).unwrap();
        let same = ExtendedSuperellipsoid::new(axes, &[e[0]; 3], &[e[1]]).unwrap().radial();
        let found = same.mass_estimate(2.0);
        let off = MassEstimate::refined(&truth.mass_properties(2.0), found.mass).error;
        assert!(off < 1e-6 && off < 10.0 * found.error, "{off} {}", found.error);
    }
}
