//! Volume and moments of a supershape, a product of two curves ([`ProductMoments`]): around z their turn is
//! `r1² dθ`, from pole to pole `r2² dφ`.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Superformula, Supershape};
use crate::Point;
use crate::numeric::tanh_sinh::{Integral, integrate};
use crate::shape::product_moments::ProductMoments;
use crate::shape::{Filled, Mass, MassEstimate, MassProperties, Parametric};

/// The angles of longitude and latitude.
const AROUND: [f64; 2] = [-PI, PI];
const ALONG: [f64; 2] = [-FRAC_PI_2, FRAC_PI_2];

/// Relative difference at which the integration stops.
const ACCURACY: f64 = 1e-12;

impl Supershape {
    /// Volume in m³.
    pub fn volume(&self) -> f64 {
        self.volume_and_error()[0]
    }

    /// Volume and the estimated error of its integration, both in m³.
    pub fn volume_and_error(&self) -> [f64; 2] {
        let moments = self.moments();
        [moments.volume(), moments.volume() * moments.error()]
    }

    fn moments(&self) -> ProductMoments {
        let (longitude, latitude) = (self.longitude(), self.latitude());
        let around = pieces(longitude, AROUND, |theta| {
            let r = longitude.radius(theta);
            let (s, c) = theta.sin_cos();
            let (x, y) = (r * c, r * s);
            [1.0, x, y, x * x, x * y, y * y].map(|v| v * r * r)
        });
        let along = pieces(latitude, ALONG, |phi| {
            let r = latitude.radius(phi);
            let (s, c) = phi.sin_cos();
            let (u, z) = (r * c, r * s);
            [1.0, u, z, u * u, u * z, z * z].map(|v| v * r * r * u)
        });
        ProductMoments { around, along }
    }
}

/// Number of pieces of an interval in which no cosine or sine of the curve changes sign.
fn smooth_pieces(curve: &Superformula, [from, to]: [f64; 2]) -> usize {
    let width = 2.0 * PI / curve.m().max(1e-3);
    ((to / width).ceil() - (from / width).floor()) as usize
}

/// One of them.
fn smooth_piece(curve: &Superformula, [from, to]: [f64; 2], k: usize) -> [f64; 2] {
    let width = 2.0 * PI / curve.m().max(1e-3);
    let start = (from / width).floor() + k as f64;
    [(start * width).max(from), ((start + 1.0) * width).min(to)]
}

/// Pieces for the filling, at most: of curves that have more of them a few stand together.
const MOST: usize = 16;

/// A place in one of the pieces, and how fast it moves with its share of the piece.
fn place(curve: &Superformula, range: [f64; 2], piece: usize, share: f64) -> [f64; 2] {
    let [low, high] = if smooth_pieces(curve, range) <= MOST {
        smooth_piece(curve, range, piece)
    } else {
        let width = (range[1] - range[0]) / MOST as f64;
        [range[0] + width * piece as f64, range[0] + width * (piece as f64 + 1.0)]
    };
    [low + share * (high - low), high - low]
}

impl Filled for Supershape {
    fn pieces(&self) -> usize {
        let around = smooth_pieces(self.longitude(), AROUND).min(MOST);
        around * smooth_pieces(self.latitude(), ALONG).min(MOST)
    }

    fn along(
        &self,
        piece: usize,
        [u, v]: [f64; 2],
        shares: &[f64],
        each: &mut dyn FnMut(Point, f64),
    ) {
        let count = smooth_pieces(self.longitude(), AROUND).min(MOST);
        let [theta, turn] = place(self.longitude(), AROUND, piece % count.max(1), u);
        let [phi, tilt] = place(self.latitude(), ALONG, piece / count.max(1), v);
        let (r1, r2) = (self.longitude().radius(theta), self.latitude().radius(phi));
        let volume = r1 * r1 * r2 * r2 * r2 * phi.cos() * turn * tilt;
        let end = self.point(phi, theta);
        for r in shares {
            each(end * *r, volume * r * r);
        }
    }
}

/// An integral over an interval, cut where a cosine or a sine of the curve changes sign.
fn pieces(curve: &Superformula, range: [f64; 2], f: impl Fn(f64) -> [f64; 6]) -> Integral<6> {
    let mut total = Integral { value: [0.0; 6], error: [0.0; 6] };
    for k in 0..smooth_pieces(curve, range) {
        let [low, high] = smooth_piece(curve, range, k);
        let part = integrate(&f, low, high, ACCURACY);
        for i in 0..6 {
            total.value[i] += part.value[i];
            total.error[i] += part.error[i];
        }
    }
    total
}

impl MassProperties for Supershape {
    fn mass_properties(&self, density: f64) -> Mass {
        self.mass_estimate(density).mass
    }

    fn mass_estimate(&self, density: f64) -> MassEstimate {
        self.moments().mass([1.0; 3], density)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::*;
    use crate::Vector;
    use crate::shape::Implicit;

    #[test]
    fn a_ball_and_an_egg() {
        let circle = Superformula::new(4.0, [2.0; 3], [1.0; 2]).unwrap();
        let ball = Supershape::new(circle, circle).unwrap().mass_properties(3.0);
        assert!((ball.mass / (4.0 * PI) - 1.0).abs() < 1e-12 && ball.centre.coords.norm() < 1e-14);
        assert!((ball.inertia - Matrix3::identity() * (0.4 * 4.0 * PI)).norm() < 1e-11);
        // a circle again, but with m = 0: one piece
        let round = Superformula::new(0.0, [1.0; 3], [1.0; 2]).unwrap();
        let [volume, error] = Supershape::new(round, round).unwrap().volume_and_error();
        assert!((volume - 4.0 / 3.0 * PI).abs() < 1e-12 && error < 1e-10);
    }

    #[test]
    fn moments_agree_with_a_grid() {
        let longitude = Superformula::new(3.0, [2.0, 1.4, 3.1], [0.8, 1.3]).unwrap();
        let latitude = Superformula::new(2.0, [4.0, 3.0, 5.0], [1.2, 0.8]).unwrap();
        let shape = Supershape::new(longitude, latitude).unwrap();
        let mass = shape.mass_properties(1.0);
        let [low, high] = shape.bounds();
        let (n, size) = (120, high - low);
        let cell = size / n as f64;
        let (mut volume, mut first, mut second) = (0.0, Vector::zeros(), Matrix3::zeros());
        for i in 0..n * n * n {
            let step = Vector::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64);
            let p = low + (step + Vector::repeat(0.5)).component_mul(&cell);
            if shape.contains(&p) {
                volume += 1.0;
                first += p.coords;
                second += p.coords * p.coords.transpose();
            }
        }
        let centre = first / volume;
        assert!((volume * cell.product() / mass.mass - 1.0).abs() < 2e-3);
        assert!((centre - mass.centre.coords).norm() < 2e-3);
        let central = (second - centre * centre.transpose() * volume) * cell.product();
        let inertia = Matrix3::identity() * central.trace() - central;
        assert!((inertia - mass.inertia).norm() < 3e-3 * mass.inertia.norm());
    }
}
