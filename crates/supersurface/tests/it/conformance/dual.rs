//! Gauges written again with plain powers, and their derivatives by dual numbers.

use num_dual::DualNum;
use supersurface::deform::{Bend, Cavity, Deformed, ShearBend, Taper, Twist};
use supersurface::nalgebra::SVector;
use supersurface::numeric::random::Stream;
use supersurface::shape::{
    Implicit, SecondOrder, SeparableSuperquadric, Superellipsoid, SuperhyperboloidOneSheet,
    SuperhyperboloidTwoSheets, Superparaboloid, Supertoroid,
};
use supersurface::{Point, Vector};

use super::members::Make;
use super::samples::{around, region, shapes};

/// The gauge as its equation is written, for any kind of number; right where no power overflows.
pub(super) trait ClosedForm: Implicit {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, p: [D; 3]) -> D;
}

/// `(|u|^p + |v|^p)^(1/p)`.
fn norm<D: DualNum<Primitive = f64> + Copy>(u: D, v: D, p: f64) -> D {
    (u.abs().powf(p) + v.abs().powf(p)).powf(1.0 / p)
}

impl ClosedForm for Superellipsoid {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        let planar = ((x / a1).abs().powf(2.0 / e2) + (y / a2).abs().powf(2.0 / e2)).powf(e2 / e1);
        (planar + (z / a3).abs().powf(2.0 / e1)).powf(0.5 * e1)
    }
}

impl ClosedForm for Supertoroid {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        norm(norm(x / a1, y / a2, 2.0 / e2) - self.ring_ratio(), z / a3, 2.0 / e1)
    }
}

impl ClosedForm for SuperhyperboloidOneSheet {
    /// `F = ρ̂^p - |z/a3|^p = 1` says `ρ̂ = (1 + |z/a3|^p)^(1/p)`.
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        let waist = ((z / a3).abs().powf(2.0 / e1) + 1.0).powf(0.5 * e1);
        norm(x / a1, y / a2, 2.0 / e2) / waist
    }
}

impl ClosedForm for SuperhyperboloidTwoSheets {
    /// Of `(X^p2 - Y^p2)^(ε2/ε1) - Z^p1 = 1` the `X` on the sheet over that of the point.
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        let meridian = ((z / a3).abs().powf(2.0 / e1) + 1.0).powf(e1 / e2);
        let sheet = (meridian + (y / a2).abs().powf(2.0 / e2)).powf(0.5 * e2);
        sheet / (x / a1).abs()
    }
}

impl ClosedForm for Superparaboloid {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes(), self.exponents());
        norm(x / a1, y / a2, 2.0 / e2) / (z / a3).powf(0.5 * e1)
    }
}

impl ClosedForm for SeparableSuperquadric {
    /// The root of `F(p/λ) = 1`: from its value two steps of Newton's method make two orders of derivatives exact.
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, p: [D; 3]) -> D {
        let (a, k) = (self.semi_axes(), self.powers());
        let real = Point::from(p.map(|c| c.re()));
        let mut root = D::from(self.gauge(&real));
        for _ in 0..3 {
            let terms = [0, 1, 2].map(|i| (p[i] / (root * a[i])).abs().powf(k[i]));
            let sum = terms[0] + terms[1] + terms[2];
            let fall = terms[0] * k[0] + terms[1] * k[1] + terms[2] * k[2];
            // ln F falls with ln λ by fall/sum
            root *= (sum.ln() * sum / fall).exp();
        }
        root
    }
}

impl ClosedForm for Deformed<Superellipsoid, Taper> {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let [kx, ky] = self.deformation().slopes();
        let height = z / self.deformation().half_height();
        self.shape().form([x / (height * kx + 1.0), y / (height * ky + 1.0), z])
    }
}

impl ClosedForm for Deformed<Superellipsoid, Twist> {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let twist = self.deformation();
        let turn = (z / twist.half_height() + 1.0) * (twist.turns() * std::f64::consts::PI);
        let (c, s) = (turn.cos(), turn.sin());
        self.shape().form([c * x + s * y, c * y - s * x, z])
    }
}

impl ClosedForm for Deformed<Superellipsoid, Bend> {
    /// Polar coordinates about the centre of the circle.
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let (k, alpha) = (self.deformation().curvature(), self.deformation().angle());
        let across = x * alpha.cos() + y * alpha.sin();
        let (up, out) = (z * k, -across * k + 1.0);
        // the angle by its half, so that behind the centre it goes on
        let far = (up * up + out * out).sqrt();
        let angle = (up / (far + out)).atan() * 2.0;
        let (r, height) = ((-far + 1.0) / k, angle / k);
        let shift = across - r;
        self.shape().form([x - shift * alpha.cos(), y - shift * alpha.sin(), height])
    }
}

impl ClosedForm for Deformed<Superellipsoid, ShearBend> {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let k = self.deformation().radius();
        let shift = ((z * z + k * k).sqrt() - k.abs()) * k.signum();
        self.shape().form([x + shift, y, z])
    }
}

impl ClosedForm for Deformed<Superellipsoid, Cavity> {
    fn form<D: DualNum<Primitive = f64> + Copy>(&self, [x, y, z]: [D; 3]) -> D {
        let ([a1, a2, a3], [_, e2]) = (self.shape().semi_axes(), self.shape().exponents());
        let rho = norm(x / a1, y / a2, 2.0 / e2);
        if rho.re() >= 1.0 {
            return self.shape().form([x, y, z]);
        }
        let rest = -rho * rho + 1.0;
        let sunk = rest * rest * (0.5 * self.deformation().depth());
        self.shape().form([x, y, (z + sunk * a3) / (-sunk + 1.0)])
    }
}

/// A point where no power of the plain form comes near the end of the numbers.
fn tame(shape: &impl Implicit, random: &mut Stream) -> Option<Point> {
    let p = around(shape, random);
    (0.02..50.0).contains(&shape.gauge(&p)).then_some(p)
}

/// Value and gradient.
pub(super) fn dual_gradient<S: ClosedForm>(make: Make<S>) {
    let mut all = 0;
    for (case, shape) in shapes(make, 200) {
        let random = &mut Stream::new(21, case);
        let [low, high] = region(&shape);
        for p in (0..20).filter_map(|_| tame(&shape, random)) {
            let (value, slope) =
                num_dual::gradient(|v: SVector<_, 3>| shape.form([v[0], v[1], v[2]]), &p.coords);
            let slope = Vector::from(slope);
            if !(value.is_finite() && slope.iter().all(|v| v.is_finite())) {
                continue;
            }
            all += 1;
            let (gauge, gradient) = (shape.gauge(&p), shape.gradient(&p));
            assert!((gauge - value).abs() <= 1e-9 * gauge, "{case} {p}: {gauge} {value}");
            let error = (gradient - slope).component_mul(&(high - low)).norm();
            let size = slope.component_mul(&(high - low)).norm();
            assert!(error <= 1e-7 * size, "{case} {p}: {gradient} {slope}");
        }
    }
    assert!(all > 1500, "{all} points");
}

/// Value, gradient and second derivatives.
pub(super) fn dual<S: ClosedForm + SecondOrder>(make: Make<S>) {
    dual_gradient(make);
    let mut all = 0;
    for (case, shape) in shapes(make, 200) {
        let random = &mut Stream::new(22, case);
        let [low, high] = region(&shape);
        let edges = high - low;
        let units = edges * edges.transpose();
        for p in (0..20).filter_map(|_| tame(&shape, random)) {
            let (value, _, second) =
                num_dual::hessian(|v: SVector<_, 3>| shape.form([v[0], v[1], v[2]]), &p.coords);
            if !(value.is_finite() && second.iter().all(|v| v.is_finite())) {
                continue;
            }
            let Some(hessian) = shape.hessian(&p) else { continue };
            all += 1;
            let error = (hessian - second).component_mul(&units).norm();
            // a second derivative of 0 is a difference of terms of this size
            let size = second.component_mul(&units).norm() + value;
            assert!(error <= 1e-6 * size, "{case} {p}: {hessian} {second}");
        }
    }
    assert!(all > 1500, "{all} points");
}
