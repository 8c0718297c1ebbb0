//! Support points of deformed solids, by search: only the undeformed members have closed forms.
//!
//! The best node of a grid of surface angles, then a pattern search about it that halves its step down to rounding. The
//! height over a plane may have several maxima on a bent solid; the grid chooses among them, so that of two within its
//! resolution (a few thousandths of the size) the lower one may be found.

use std::f64::consts::TAU;

use super::{Deformation, Deformed};
use crate::shape::{Parametric, SupportMap};
use crate::{Point, Vector};

/// Nodes of the grid along both angles.
const NODES: [usize; 2] = [24, 48];

/// Steps below this, in radians, change nothing.
const LEAST_STEP: f64 = 1e-9;

impl<S, D> SupportMap for Deformed<S, D>
where
    Self: Parametric,
    D: Deformation,
{
    fn support_point(&self, n: &Vector) -> Point {
        let [[low, high], _] = self.domain();
        let height = |[eta, omega]: [f64; 2]| self.point(eta, omega).coords.dot(n);
        let node = |i: usize, j: usize| {
            let share = i as f64 / NODES[0] as f64;
            [low + (high - low) * share, TAU * j as f64 / NODES[1] as f64]
        };
        let nodes = (0..=NODES[0]).flat_map(|i| (0..NODES[1]).map(move |j| node(i, j)));
        let mut best = (f64::NEG_INFINITY, [low, 0.0]);
        for at in nodes {
            let height = height(at);
            if height > best.0 {
                best = (height, at);
            }
        }
        let mut step = (high - low) / NODES[0] as f64;
        while step > LEAST_STEP {
            let [eta, omega] = best.1;
            let around = [
                [eta + step, omega],
                [eta - step, omega],
                [eta, omega + step],
                [eta, omega - step],
            ];
            let before = best.0;
            for mut at in around {
                at[0] = at[0].clamp(low, high);
                let height = height(at);
                if height > best.0 {
                    best = (height, at);
                }
            }
            if best.0 <= before {
                step *= 0.5;
            }
        }
        let [eta, omega] = best.1;
        self.point(eta, omega)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::{Bend, Taper};
    use crate::numeric::random::Stream;
    use crate::shape::Superellipsoid;

    #[test]
    fn no_surface_point_lies_higher() {
        let mut random = Stream::new(4, 0);
        for _ in 0..40 {
            let axes = std::array::from_fn(|_| random.between(0.3, 1.0));
            let exponents = std::array::from_fn(|_| random.between(0.2, 1.8));
            let shape = Superellipsoid::new(axes, exponents).unwrap();
            let slopes = std::array::from_fn(|_| random.between(-0.7, 0.7));
            let cone = Deformed::new(shape, Taper::new(slopes, axes[2]).unwrap()).unwrap();
            let Ok(horn) = Deformed::new(cone, Bend::new(0.4, 0.7).unwrap()) else { continue };
            let n = Vector::from_fn(|_, _| random.normal()).normalize();
            let found = horn.support_point(&n).coords.dot(&n);
            for _ in 0..400 {
                let p = horn.point(random.between(-1.57, 1.57), random.between(0.0, TAU));
                assert!(p.coords.dot(&n) < found + 1e-3, "{} over {found}", p.coords.dot(&n));
            }
        }
    }
}
