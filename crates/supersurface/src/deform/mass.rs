//! Mass of deformed solids: integrals over the solid before the deformation, `∫ f(T(x)) det J(x) dV` (FORMULAS §4).

use super::{Deformation, Deformed, Sections};
use crate::Point;
use crate::shape::{Filled, Mass, MassEstimate, MassProperties, filled_mass, mass_of_sections};

impl<S: Filled, D: Deformation> Filled for Deformed<S, D> {
    fn pieces(&self) -> usize {
        self.shape().pieces()
    }

    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64)) {
        let map = self.deformation();
        self.shape().along(piece, at, shares, &mut |p, volume| {
            each(map.forward(&p), volume * map.jacobian(&p).determinant());
        });
    }

    fn sections(&self, rule: &[[f64; 2]], each: &mut dyn FnMut(Point, f64)) -> bool {
        let map = self.deformation();
        // sections that have moved are not at their heights any more
        map.sections() == Sections::Kept
            && self.shape().sections(rule, &mut |p, volume| {
                each(map.forward(&p), volume * map.jacobian(&p).determinant());
            })
    }
}

impl<S: Filled, D: Deformation> MassProperties for Deformed<S, D> {
    fn mass_properties(&self, density: f64) -> Mass {
        self.mass_estimate(density).mass
    }

    /// ```
    /// use supersurface::deform::{Bend, Deformed};
    /// use supersurface::shape::{MassProperties, Superellipsoid};
    /// let stick = Superellipsoid::new([0.01, 0.01, 0.06], [0.3, 1.0])?;
    /// let banana = Deformed::new(stick, Bend::new(12.0, 0.0)?)?;
    /// let found = banana.mass_estimate(1.0);
    /// assert!((found.mass.mass / stick.volume() - 1.0).abs() < 1e-6 && found.error < 1e-6);
    /// assert!(found.mass.centre.x > 0.005);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    fn mass_estimate(&self, density: f64) -> MassEstimate {
        let map = self.deformation();
        let moved = |p: &Point| (map.forward(p), map.jacobian(p).determinant());
        let by_sections = match map.sections() {
            Sections::Kept | Sections::Moved => mass_of_sections(self.shape(), moved, density),
            Sections::Curved => None,
        };
        by_sections.unwrap_or_else(|| filled_mass(self, density))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::{Bend, Cavity, ShearBend, Taper, Twist};
    use crate::shape::{Superellipsoid, Supertoroid};

    fn close(found: &MassEstimate, truth: &Mass, allowed: f64) {
        let off = MassEstimate::refined(truth, found.mass).error;
        assert!(off < allowed && off <= 10.0 * found.error + 1e-9, "{off} {found:?} {truth:?}");
    }

    #[test]
    fn what_no_deformation_changes_has_its_closed_form() {
        for e1 in [0.01, 0.1, 0.3, 1.0, 1.7, 2.5] {
            for e2 in [0.01, 0.1, 0.3, 1.0, 1.7, 2.5] {
                let shape = Superellipsoid::new([0.2, 0.3, 1.1], [e1, e2]).unwrap();
                close(&filled_mass(&shape, 3.0), &shape.mass_properties(3.0), 1e-5);
                let ring = Supertoroid::new([0.2, 0.3, 0.4], 2.0, [e1, e2]).unwrap();
                close(&filled_mass(&ring, 3.0), &ring.mass_properties(3.0), 1e-5);
            }
        }
    }

    #[test]
    fn sections_weigh_what_lines_do() {
        for e in [[0.1, 1.0], [0.2, 0.1], [0.7, 1.4], [1.9, 0.3]] {
            let shape = Superellipsoid::new([0.2, 0.3, 1.1], e).unwrap();
            let taper = Taper::new([0.5, -0.7], 1.1).unwrap();
            let tapered = Deformed::new(shape, taper).unwrap();
            let bend = Bend::new(1.5, 0.7).unwrap();
            let bent = Deformed::new(tapered, bend).unwrap();
            let twisted = Deformed::new(tapered, Twist::new(0.4, 1.1).unwrap()).unwrap();
            let sheared = Deformed::new(shape, ShearBend::new(2.0).unwrap()).unwrap();
            close(&tapered.mass_estimate(3.0), &filled_mass(&tapered, 3.0).mass, 1e-5);
            close(&bent.mass_estimate(3.0), &filled_mass(&bent, 3.0).mass, 1e-5);
            close(&twisted.mass_estimate(3.0), &filled_mass(&twisted, 3.0).mass, 1e-5);
            close(&sheared.mass_estimate(3.0), &filled_mass(&sheared, 3.0).mass, 1e-5);
            // a taper of what is bent does not meet plane sections
            let bent = Deformed::new(shape, bend).unwrap();
            let both = Deformed::new(bent, Taper::new([0.2, 0.3], 1.1).unwrap()).unwrap();
            close(&both.mass_estimate(3.0), &filled_mass(&both, 3.0).mass, 1e-12);
        }
    }

    #[test]
    fn volumes_that_are_known() {
        for e in [[0.1, 1.0], [0.1, 0.1], [0.7, 1.4], [1.9, 0.3]] {
            let shape = Superellipsoid::new([0.2, 0.3, 1.1], e).unwrap();
            let v = shape.volume();
            let bent = Deformed::new(shape, Bend::new(2.2, 0.7).unwrap()).unwrap();
            let twisted = Deformed::new(shape, Twist::new(0.4, 1.1).unwrap()).unwrap();
            let sheared = Deformed::new(shape, ShearBend::new(2.0).unwrap()).unwrap();
            let tapered = Deformed::new(shape, Taper::new([0.5, -0.7], 1.1).unwrap()).unwrap();
            let ratio = tapered.volume() / v;
            let tapered = tapered.mass_estimate(1.0);
            let all = [bent.mass_estimate(1.0), twisted.mass_estimate(1.0)];
            for (found, ratio) in all
                .iter()
                .chain([&sheared.mass_estimate(1.0)])
                .map(|m| (m, 1.0))
                .chain([(&tapered, ratio)])
            {
                let off = found.mass.mass / (v * ratio) - 1.0;
                assert!(
                    off.abs() < 1e-5 && off.abs() < found.error * 10.0 + 1e-10,
                    "{e:?} {off} {found:?}"
                );
            }
            let bowl = Deformed::new(shape, Cavity::new(1.5, &shape).unwrap()).unwrap();
            assert!(bowl.mass_estimate(1.0).mass.mass < v && bowl.mass_estimate(1.0).error < 1e-4);
        }
    }
}
