//! Volume and moments of a supershape.
//!
//! With `u = √(x² + y²)/r1(θ) = q cosφ` and `z = q sinφ` the volume element is `r1² u du dθ dz`, so every
//! moment is a product of two integrals over one angle:
//! `∫ x^i y^j z^k dV = ∫ r1^(2+i+j) cos^i θ sin^j θ dθ · ∫ r2^(n+k+3) cos^(n+1) φ sin^k φ dφ / (n+k+3)`
//! with `n = i + j`.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Matrix3;

use super::{Superformula, Supershape};
use crate::numeric::tanh_sinh::{Integral, integrate};
use crate::shape::{Mass, MassProperties};
use crate::{Point, Vector};

/// Relative difference at which the integration stops.
const ACCURACY: f64 = 1e-12;

impl Supershape {
    /// Volume in m³.
    pub fn volume(&self) -> f64 {
        self.volume_and_error()[0]
    }

    /// Volume and the estimated error of its integration, both in m³.
    pub fn volume_and_error(&self) -> [f64; 2] {
        let (around, along) = (self.around(), self.along());
        let ([l, ..], [p, ..]) = (around.value, along.value);
        let ([dl, ..], [dp, ..]) = (around.error, along.error);
        [l * p, dl * p + dp * l]
    }

    /// `∫ r1^(2+i+j) cos^i sin^j dθ` for (i, j) = (0,0), (1,0), (0,1), (2,0), (1,1), (0,2).
    fn around(&self) -> Integral<6> {
        let curve = self.longitude();
        pieces(curve, -PI, PI, |theta| {
            let r = curve.radius(theta);
            let (s, c) = theta.sin_cos();
            let (x, y) = (r * c, r * s);
            [1.0, x, y, x * x, x * y, y * y].map(|v| v * r * r)
        })
    }

    /// `∫ r2^(n+k+3) cos^(n+1) sin^k dφ / (n+k+3)` for (n, k) = (0,0), (1,0), (0,1), (2,0), (1,1), (0,2).
    fn along(&self) -> Integral<6> {
        let curve = self.latitude();
        pieces(curve, -FRAC_PI_2, FRAC_PI_2, |phi| {
            let r = curve.radius(phi);
            let (s, c) = phi.sin_cos();
            let (u, z) = (r * c, r * s);
            let five = [u * u, u * z, z * z].map(|v| v / 5.0);
            [1.0 / 3.0, u / 4.0, z / 4.0, five[0], five[1], five[2]].map(|v| v * r * r * u)
        })
    }
}

/// An integral over an interval, cut where a cosine or a sine of the curve changes sign.
fn pieces(curve: &Superformula, from: f64, to: f64, f: impl Fn(f64) -> [f64; 6]) -> Integral<6> {
    let mut total = Integral { value: [0.0; 6], error: [0.0; 6] };
    let width = 2.0 * PI / curve.m().max(1e-3);
    let (first, last) = ((from / width).floor() as i64, (to / width).ceil() as i64);
    for k in first..last {
        let low = if k == first { from } else { k as f64 * width };
        let high = if k + 1 == last { to } else { (k + 1) as f64 * width };
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
        let [l, lx, ly, lxx, lxy, lyy] = self.around().value;
        let [p, pu, pz, puu, puz, pzz] = self.along().value;
        let volume = l * p;
        let centre = Vector::new(lx * pu, ly * pu, l * pz) / volume;
        let (xy, xz, yz) = (lxy * puu, lx * puz, ly * puz);
        let second = Matrix3::new(lxx * puu, xy, xz, xy, lyy * puu, yz, xz, yz, l * pzz);
        let central = second - centre * centre.transpose() * volume;
        let inertia = Matrix3::identity() * central.trace() - central;
        Mass { mass: density * volume, centre: Point::from(centre), inertia: inertia * density }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
