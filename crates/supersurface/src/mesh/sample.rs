//! Random points on a surface, uniform over its area, with normals.
//!
//! Equal steps of the angles crowd points at edges and poles, and the exact density `√(EG - F²)` is infinite at the
//! seams of small exponents (FORMULAS §7.5). So a point is drawn from the triangles of a fine mesh by their areas, and
//! moved on to the surface along the gauge's gradient.
//!
//! What is not guaranteed: a triangle is a little smaller than its piece of the surface, by about the tolerance over
//! the radius of curvature, and the density is larger there by as much: by a percent at most on the rounded edges of
//! boxes at the default tolerance, and less with a smaller one.

use super::{MeshSampler, TessellateError, tessellate, tessellate_patch};
use crate::numeric::random::Stream;
use crate::shape::{Implicit, Parametric};
use crate::{Direction, Point};

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfacePoint {
    /// The point, in metres.
    pub point: Point,
    /// Outward unit normal; `None` where there is none (next to cusps, exponents from 2).
    pub normal: Option<Direction>,
}

/// Draws points from a surface, uniform over its area.
///
/// ```
/// use supersurface::{mesh::SurfaceSampler, shape::{Implicit, Superellipsoid}};
/// let tin = Superellipsoid::new([0.033, 0.033, 0.05], [0.2, 1.0])?;
/// let sampler = SurfaceSampler::new(&tin, None)?;
/// let points = sampler.points(1000, 7);
/// assert!(points.iter().all(|p| (tin.gauge(&p.point) - 1.0).abs() < 1e-9));
/// assert_eq!(points, sampler.points(1000, 7));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SurfaceSampler<'a, S: ?Sized> {
    surface: &'a S,
    sampler: MeshSampler<super::Mesh>,
    tolerance: f64,
}

impl<'a, S: Parametric + Implicit + Sync + ?Sized> SurfaceSampler<'a, S> {
    /// Tessellates the surface with the tolerance in metres, or by default; the errors are those of [`tessellate`].
    /// A surface with a border (a paraboloid) needs a tolerance, and is sampled over its domain.
    pub fn new(surface: &'a S, tolerance: Option<f64>) -> Result<Self, TessellateError> {
        let found = match (tessellate(surface, tolerance), tolerance) {
            (Err(TessellateError::Open), Some(tolerance)) => tessellate_patch(surface, tolerance)?,
            (found, _) => found?,
        };
        let sampler = MeshSampler::new(found.mesh);
        Ok(Self { surface, sampler, tolerance: found.tolerance })
    }

    /// `count` points, each a function of the seed and of its place alone, so that they are the same on any number of
    /// threads. Fewer when the surface has no area.
    ///
    /// Points lie on the surface to rounding; next to cusps (exponents over 2) within the mesh's tolerance.
    pub fn points(&self, count: usize, seed: u64) -> Vec<SurfacePoint> {
        let draw = |i: u64| self.draw(&mut Stream::new(seed, i));
        #[cfg(feature = "parallel")]
        {
            use rayon::prelude::*;
            (0..count as u64).into_par_iter().filter_map(draw).collect()
        }
        #[cfg(not(feature = "parallel"))]
        (0..count as u64).filter_map(draw).collect()
    }

    fn draw(&self, stream: &mut Stream) -> Option<SurfacePoint> {
        // a triangle without area has no normal: drawn with probability 0, but rounding
        (0..8).find_map(|_| {
            let numbers = std::array::from_fn(|_| stream.uniform());
            let (point, normal) = self.sampler.sample_at(numbers)?;
            Some(self.settle(point, normal))
        })
    }

    /// The surface point next to a point of the mesh.
    fn settle(&self, start: Point, facing: Direction) -> SurfacePoint {
        let far = 4.0 * self.tolerance;
        let foot = self.newton(start, far).or_else(|| self.bisection(start, facing, far));
        let point = foot.unwrap_or(start);
        let gradient = self.surface.gradient(&point);
        let normal = Direction::try_new(gradient / gradient.amax(), 0.0);
        // next to a cusp the gradient can be infinite, or point anywhere
        let normal = normal.filter(|n| n.iter().all(|v| v.is_finite()) && foot.is_some());
        SurfacePoint { point, normal }
    }

    /// Steps `(1 - g) ∇g/|∇g|²` until the gauge is 1.
    fn newton(&self, start: Point, far: f64) -> Option<Point> {
        let mut p = start;
        for _ in 0..30 {
            let off = self.surface.gauge(&p) - 1.0;
            if off.abs() <= 1e-12 {
                return Some(p);
            }
            let slope = self.surface.gradient(&p);
            p -= slope * (off / slope.norm_squared());
            let moved = (p - start).norm();
            if moved.is_nan() || moved > far {
                break;
            }
        }
        None
    }

    /// Where the line along the triangle's normal goes through the surface.
    fn bisection(&self, start: Point, facing: Direction, far: f64) -> Option<Point> {
        let at = |t: f64| start + facing.into_inner() * t;
        let (mut inside, mut outside) = (-far, far);
        if !self.surface.contains(&at(inside)) || self.surface.contains(&at(outside)) {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if self.surface.contains(&at(middle)) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        Some(at(inside))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::{Bend, Deformed, Taper};
    use crate::numeric::powers::power;
    use crate::numeric::superellipse::norm;
    use crate::numeric::tanh_sinh::integrate;
    use crate::shape::{Superellipsoid, Supertoroid};

    #[test]
    fn points_of_a_ball_are_uniform_along_any_axis() {
        let ball = Superellipsoid::new([2.0; 3], [1.0; 2]).unwrap();
        let points = SurfaceSampler::new(&ball, None).unwrap().points(40_000, 3);
        for axis in 0..3 {
            // Archimedes: heights are uniform
            let mut heights: Vec<_> = points.iter().map(|p| p.point[axis]).collect();
            heights.sort_by(f64::total_cmp);
            let expected = |i: usize| 4.0 * (i as f64 + 0.5) / 40_000.0 - 2.0;
            let worst = heights.iter().enumerate().map(|(i, h)| (h - expected(i)).abs());
            // the deviation of Kolmogorov and Smirnov at 0.1 %, 1.95/√n of the range
            assert!(worst.fold(0.0, f64::max) < 4.0 * 1.95 / 200.0);
        }
        assert!(
            points
                .iter()
                .all(|p| (p.point.coords / 2.0 - p.normal.unwrap().into_inner()).norm() < 1e-9)
        );
    }

    #[test]
    fn shares_of_the_faces_of_a_box() {
        let shape = Superellipsoid::new([1.0, 2.0, 3.0], [0.02, 0.02]).unwrap();
        let points = SurfaceSampler::new(&shape, None).unwrap().points(30_000, 1);
        let whole = 1.0 * 2.0 + 2.0 * 3.0 + 3.0 * 1.0;
        for (axis, area) in [(0, 6.0), (1, 3.0), (2, 2.0)] {
            let faces =
                points.iter().filter(|p| p.normal.unwrap()[axis].abs() > 0.8).count() as f64;
            assert!((faces / 30_000.0 - area / whole).abs() < 0.015, "{axis}: {faces}");
        }
    }

    #[test]
    fn outer_half_of_a_ring() {
        let ring = Supertoroid::new([1.0; 3], 2.0, [1.0; 2]).unwrap();
        let points = SurfaceSampler::new(&ring, None).unwrap().points(30_000, 1);
        let outer = points.iter().filter(|p| p.point.x.hypot(p.point.y) > 2.0).count() as f64;
        // ∫(R + r cos η) over half of the tube: (πR + 2r)/(2πR)
        let share = 0.5 + 1.0 / (2.0 * std::f64::consts::PI);
        assert!((outer / 30_000.0 - share).abs() < 0.01, "{outer}");
    }

    #[test]
    fn points_lie_on_any_surface() {
        for e in [[0.1, 0.1], [0.1, 1.9], [1.9, 0.5], [2.5, 1.0], [1.5, 2.5], [2.5, 2.5]] {
            let shape = Superellipsoid::new([0.05, 0.3, 0.2], e).unwrap();
            let tapered = Deformed::new(shape, Taper::new([0.5, -0.3], 0.2).unwrap()).unwrap();
            let solid = Deformed::new(tapered, Bend::new(3.0, 0.4).unwrap()).unwrap();
            let points = SurfaceSampler::new(&solid, Some(1e-3)).unwrap().points(3000, 9);
            assert_eq!(points.len(), 3000);
            let on = points.iter().filter(|p| (solid.gauge(&p.point) - 1.0).abs() < 1e-9).count();
            let smooth = e[0] < 2.0 && e[1] < 2.0;
            assert!(on >= if smooth { 3000 } else { 2900 }, "{e:?}: {on}");
            let outward = |p: &&SurfacePoint| {
                p.normal.is_some_and(|n| !solid.contains(&(p.point + n.into_inner() * 1e-6)))
            };
            let out = points.iter().filter(outward).count();
            assert!(out >= 2900, "{e:?}: {out}");
        }
    }

    /// Area of the patch between angles of a superellipsoid or supertoroid.
    fn area(shape: &dyn Parametric, [e0, e1]: [f64; 2], [o0, o1]: [f64; 2]) -> f64 {
        let strip = |eta: f64| {
            let element = |omega: f64| {
                let cross = shape.tangents(eta, omega).map(|[a, b]| a.cross(&b).norm());
                [cross.unwrap_or_default()]
            };
            integrate(element, o0, o1, 1e-7).value
        };
        integrate(strip, e0, e1, 1e-7).value[0]
    }

    #[test]
    fn patches_have_their_share_of_the_points() {
        let box_like = Superellipsoid::new([0.5, 1.0, 0.7], [0.5, 0.4]).unwrap();
        let diamond = Superellipsoid::new([1.0, 0.6, 1.5], [1.6, 1.2]).unwrap();
        let mixed = Superellipsoid::new([1.0, 0.6, 0.1], [0.4, 1.7]).unwrap();
        for shape in [box_like, diamond, mixed] {
            let cuts = [0.0, 0.3, 0.8, std::f64::consts::FRAC_PI_2];
            let [a1, a2, a3] = shape.semi_axes();
            let [e1, e2] = shape.exponents();
            let angle = |up: f64, out: f64, e: f64| power(up / out, 1.0 / e).atan();
            let bin = |t: f64| cuts.iter().take(3).filter(|c| t >= **c).count() - 1;
            let count = 60_000;
            // eight octants with nine patches each
            let mut counts = [[0.0; 9]; 8];
            for SurfacePoint { point: p, .. } in
                SurfaceSampler::new(&shape, None).unwrap().points(count, 5)
            {
                let [x, y, z] = [p.x / a1, p.y / a2, p.z / a3].map(f64::abs);
                let eta = angle(z, norm(x, y, 2.0 / e2), e1);
                let octant =
                    p.iter().enumerate().map(|(k, v)| usize::from(*v > 0.0) << k).sum::<usize>();
                counts[octant][3 * bin(eta) + bin(angle(y, x, e2))] += 1.0;
            }
            let areas: Vec<f64> = (0..9)
                .map(|k| {
                    area(&shape, [cuts[k / 3], cuts[k / 3 + 1]], [cuts[k % 3], cuts[k % 3 + 1]])
                })
                .collect();
            let whole = 8.0 * areas.iter().sum::<f64>();
            let expected = areas.iter().map(|a| a / whole * count as f64);
            let terms =
                expected.enumerate().flat_map(|(k, e)| counts.map(|c| (c[k] - e).powi(2) / e));
            let chi_squared: f64 = terms.sum();
            // 71 degrees of freedom: above 113 with a probability of 0.1 %
            assert!(chi_squared < 113.0, "{shape:?}: {chi_squared}");
        }
    }

    #[test]
    fn points_of_a_bowl_with_a_border() {
        let bowl = crate::shape::Superparaboloid::new([1.0; 3], [1.0; 2]).unwrap();
        assert!(SurfaceSampler::new(&bowl, None).is_err());
        let points = SurfaceSampler::new(&bowl, Some(1e-3)).unwrap().points(20_000, 1);
        // area below the height z: π/6 ((1 + 4z)^(3/2) - 1)
        let area = |z: f64| (1.0 + 4.0 * z).powi(3).sqrt() - 1.0;
        let lower = points.iter().filter(|p| p.point.z < 0.4).count() as f64 / 20_000.0;
        assert!((lower - area(0.4) / area(1.0)).abs() < 0.012, "{lower}");
        assert!(points.iter().all(|p| p.normal.is_some_and(|n| n.z < 0.0)));
    }

    #[cfg(feature = "parallel")]
    #[test]
    fn points_do_not_depend_on_threads() {
        let ring = Supertoroid::new([1.0; 3], 2.0, [0.4, 1.0]).unwrap();
        let sampler = SurfaceSampler::new(&ring, None).unwrap();
        let with = |n| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
            pool.install(|| sampler.points(5000, 3))
        };
        assert_eq!(with(1), with(3));
        assert_eq!(sampler.points(100, 3)[..], with(2)[..100]);
    }
}
