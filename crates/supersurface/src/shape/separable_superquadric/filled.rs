//! The separable superquadric as lines from its centre, by its gauge.

use super::SeparableSuperquadric;
use crate::shape::filled::{STAR_PIECES, star};
use crate::shape::{Filled, Implicit};
use crate::{Point, Vector};

impl Filled for SeparableSuperquadric {
    fn pieces(&self) -> usize {
        STAR_PIECES
    }

    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64)) {
        let frame = [Vector::zeros(), Vector::from(self.semi_axes())];
        star(frame, (piece, at), |d| self.gauge(&Point::from(*d)), shares, each);
    }
}
