//! Random points on a surface, uniform over its area, with normals.
//!
//! Equal steps of the angles crowd points at edges and poles, and the exact density `√(EG - F²)` is infinite at the
//! seams of small exponents (FORMULAS §7.5). So a point is drawn from the triangles of a fine mesh by their areas, and
//! moved on to the surface along the gauge's gradient.
//!
//! What is not guaranteed: a triangle is a little smaller than its piece of the surface, by about the tolerance over
//! the radius of curvature, and the density is larger there by as much; on the rounded edges of boxes, which are small,
//! by up to a few percent.

use super::{MeshSampler, TessellateError, tessellate};
use crate::numeric::random::Stream;
use crate::shape::{Implicit, Parametric};
use crate::{Direction, Point};

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, in metres.
    pub point: Point,
    /// Outward unit normal; next to cusps (exponents from 2) that of the mesh.
    pub normal: Direction,
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

impl<'a, S: Parametric + Implicit + ?Sized> SurfaceSampler<'a, S> {
    /// Tessellates the surface with the tolerance in metres, or by default; the errors are those of [`tessellate`].
    pub fn new(surface: &'a S, tolerance: Option<f64>) -> Result<Self, TessellateError> {
        let found = tessellate(surface, tolerance)?;
        let sampler = MeshSampler::new(found.mesh);
        Ok(Self { surface, sampler, tolerance: found.tolerance })
    }

    /// `count` points, each a function of the seed and of its place alone. Fewer when the surface has no area.
    ///
    /// Points lie on the surface to rounding; next to cusps (exponents over 2) within the mesh's tolerance.
    pub fn points(&self, count: usize, seed: u64) -> Vec<SurfacePoint> {
        (0..count as u64).filter_map(|i| self.draw(&mut Stream::new(seed, i))).collect()
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
        SurfacePoint { point, normal: normal.unwrap_or(facing) }
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
            // also when a number is not finite
            if !((p - start).norm() <= far) {
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
            points.iter().all(|p| (p.point.coords / 2.0 - p.normal.into_inner()).norm() < 1e-9)
        );
    }

    #[test]
    fn shares_of_the_faces_of_a_box() {
        let shape = Superellipsoid::new([1.0, 2.0, 3.0], [0.02, 0.02]).unwrap();
        let points = SurfaceSampler::new(&shape, None).unwrap().points(30_000, 1);
        let whole = 1.0 * 2.0 + 2.0 * 3.0 + 3.0 * 1.0;
        for (axis, area) in [(0, 6.0), (1, 3.0), (2, 2.0)] {
            let faces = points.iter().filter(|p| p.normal[axis].abs() > 0.8).count() as f64;
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
            let outward =
                |p: &&SurfacePoint| !solid.contains(&(p.point + p.normal.into_inner() * 1e-6));
            let out = points.iter().filter(outward).count();
            assert!(out >= 2900, "{e:?}: {out}");
        }
    }
}
