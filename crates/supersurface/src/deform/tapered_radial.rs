//! Distance of a tapered superellipsoid along the ray from its centre, exactly and by equation (30); its volume.
//!
//! The surface lies at `s p` where `g(s x/fx, s y/fy, s z) = 1` with `f = 1 + K s z/h`. Over the height of the
//! solid the left side rises strictly with `s`, `d ln g/d ln s = w_x/fx + w_y/fy + w_z > 0`, so that the root is one
//! and Newton's method on the logarithms finds it inside a bracket (FORMULAS §4.1). The pull-back of `p` itself
//! says nothing about the distance, and does not exist everywhere.

use super::{Deformed, Taper};
use crate::Point;
use crate::numeric::powers::beta;
use crate::numeric::superellipse::weighted;
use crate::shape::{Implicit, Superellipsoid};

impl Deformed<Superellipsoid, Taper> {
    /// The scale `s > 0` for which `s p` lies on the surface; `None` at the centre, within 1e-307 of it, and for points
    /// that are not finite.
    ///
    /// ```
    /// use supersurface::{Point, deform::{Deformed, Taper}, shape::Superellipsoid};
    /// let tin = Superellipsoid::new([1.0, 1.0, 2.0], [0.01, 1.0])?;
    /// let cone = Deformed::new(tin, Taper::new([0.5, 0.5], 2.0)?)?;
    /// let s = cone.radial_scale(&Point::new(3.0, 0.0, 2.0)).unwrap();
    /// assert!((s - 0.4).abs() < 1e-12); // 3 s = 1 + 0.5 s
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn radial_scale(&self, p: &Point) -> Option<f64> {
        let [surface, length] = self.along(p)?;
        Some(surface / length).filter(|s| s.is_finite())
    }

    /// Distances from the centre, in metres, of the surface along the ray through `p` and of `p` itself.
    fn along(&self, p: &Point) -> Option<[f64; 2]> {
        // any point of the ray will do: one at the solid's size neither overflows nor underflows
        let length = p.coords.amax();
        let unit = self.shape().semi_axes().into_iter().fold(0.0, f64::max);
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let direction = p.coords / length;
        let p = Point::from(direction * unit);
        let g = self.shape().gauge(&p);
        let a3 = self.shape().semi_axes()[2];
        let ends = [self.deformation().factors(-a3), self.deformation().factors(a3)];
        let [least, most] = ends
            .iter()
            .flatten()
            .fold([1.0f64, 1.0f64], |[low, high], f| [low.min(*f), high.max(*f)]);
        // g(T⁻¹(s p)) lies between s g/most and s g/least
        let top = (a3 / p.z.abs()).ln();
        let (mut low, mut high) = ((least / g).ln(), (most / g).ln().min(top));
        let mut t = (-g.ln()).clamp(low.min(high), high);
        for _ in 0..200 {
            let [value, slope] = self.log_gauge(&p, t);
            if value == 0.0 {
                break;
            }
            if value > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - value / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            // the last step is still taken
            let done = (next - t).abs() <= 2.0 * f64::EPSILON * t.abs().max(1.0);
            t = next;
            if done {
                break;
            }
        }
        let norm = direction.norm();
        Some([t.exp() * unit * norm, length * norm])
    }

    /// `ln g(T⁻¹(eᵗ p))` and its derivative by `t`.
    fn log_gauge(&self, p: &Point, t: f64) -> [f64; 2] {
        let ([a1, a2, a3], [e1, e2]) = (self.shape().semi_axes(), self.shape().exponents());
        let s = t.exp();
        let [fx, fy] = self.deformation().factors(s * p.z);
        let planar = weighted((p.x / a1 / fx).abs(), (p.y / a2 / fy).abs(), 2.0 / e2);
        let whole = weighted(planar.norm, (p.z / a3).abs(), 2.0 / e1);
        let slope = whole.first * (planar.first / fx + planar.second / fy) + whole.second;
        [t + whole.norm.ln(), slope]
    }

    /// Signed distance `|p| (1 - s)` in metres along the ray from the centre, positive outside. At the centre it is
    /// minus the least semi-axis.
    ///
    /// ```
    /// use supersurface::{Point, deform::{Deformed, Taper}, shape::Superellipsoid};
    /// let tin = Superellipsoid::new([1.0, 1.0, 2.0], [0.01, 1.0])?;
    /// let cone = Deformed::new(tin, Taper::new([0.5, 0.5], 2.0)?)?;
    /// assert!((cone.radial_distance(&Point::new(0.0, 0.0, 5.0)) - 3.0).abs() < 1e-12);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn radial_distance(&self, p: &Point) -> f64 {
        match self.along(p) {
            Some([surface, length]) => length - surface,
            None if p.coords.amax() == 0.0 => {
                -self.shape().semi_axes().into_iter().fold(f64::INFINITY, f64::min)
            }
            None => f64::INFINITY,
        }
    }

    /// The paper's approximation of [`radial_scale`](Self::radial_scale), equation (30):
    /// `β_t = β (1 + K β z/h)` with `β = 1/g(p)` of the shape without taper. `None` unless `Kx = Ky`, and at the
    /// centre.
    ///
    /// It takes the surface for parallel to z where the ray meets it: its relative error reaches `|K|` at the poles
    /// (3 % on average at K = 0.3).
    pub fn approximate_radial_scale(&self, p: &Point) -> Option<f64> {
        let [kx, ky] = self.deformation().slopes();
        let g = self.shape().gauge(p);
        let scale = 1.0 / g;
        let h = self.deformation().half_height();
        let fits = kx == ky && g > 0.0 && g.is_finite();
        fits.then_some(scale * (1.0 + kx * (scale * p.z / h)))
    }

    /// Volume in m³: `V + Kx Ky M(0,0,2)/h²` with the volume and the second moment along z of the shape
    /// without taper.
    ///
    /// ```
    /// use supersurface::{deform::{Deformed, Taper}, shape::Superellipsoid};
    /// let ball = Superellipsoid::new([1.0; 3], [1.0, 1.0])?;
    /// let pear = Deformed::new(ball, Taper::new([0.5, 0.5], 1.0)?)?;
    /// // the second moment of a ball is V/5
    /// assert!((pear.volume() / ball.volume() - 1.05).abs() < 1e-12);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn volume(&self) -> f64 {
        let [kx, ky] = self.deformation().slopes();
        let e1 = self.shape().exponents()[0];
        let height = self.shape().semi_axes()[2] / self.deformation().half_height();
        // M(0,0,2)/(V a3²)
        let share = beta(1.5 * e1, e1 + 1.0) / beta(0.5 * e1, e1 + 1.0);
        self.shape().volume() * (1.0 + kx * ky * share * height * height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Deformation;
    use crate::numeric::random::Stream;

    #[test]
    fn the_scaled_point_lies_on_the_surface() {
        let mut stream = Stream::new(1, 0);
        for i in 0..3000 {
            let a = std::array::from_fn(|_| stream.between(0.05, 1.0));
            let e = std::array::from_fn(|_| stream.between(0.05, 2.5));
            let shape = Superellipsoid::new(a, e).unwrap();
            let k = std::array::from_fn(|_| stream.between(-0.99, 0.99));
            let solid = Deformed::new(shape, Taper::new(k, a[2]).unwrap()).unwrap();
            let p: [f64; 3] = std::array::from_fn(|_| stream.normal());
            let p = if i % 10 == 0 { Point::new(0.0, 0.0, p[2]) } else { Point::from(p) };
            let s = solid.radial_scale(&p).unwrap();
            let foot = Point::from(p.coords * s);
            let back = solid.deformation().inverse(&foot).unwrap();
            let off = shape.gauge(&back) - 1.0;
            assert!(off.abs() < 1e-12 / (1.0 - k[0].abs().max(k[1].abs())), "{off} {k:?} {e:?}");
        }
    }

    #[test]
    fn any_point_has_a_distance() {
        let shape = Superellipsoid::new([0.1, 0.2, 0.3], [0.1, 1.9]).unwrap();
        let solid = Deformed::new(shape, Taper::new([0.9, -0.9], 0.3).unwrap()).unwrap();
        for v in [0.0, 5e-324, 1e-300, 1.0, 1e307] {
            for p in [Point::new(v, 0.0, 0.0), Point::new(0.0, v, -v), Point::new(v, 1e-9, v)] {
                assert!(!solid.radial_distance(&p).is_nan(), "{p}");
            }
        }
        assert_eq!(solid.radial_distance(&Point::origin()), -0.1);
        assert_eq!(solid.approximate_radial_scale(&Point::new(0.1, 0.1, 0.1)), None);
    }
}
