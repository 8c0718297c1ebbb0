//! A triangle mesh: plain vertices and triangles, and what follows from them.
//!
//! Volume and centroid are sums over tetrahedra with one corner in common, `V = Σ a·(b × c)/6`; they mean something
//! where the mesh is watertight and its triangles run counter-clockwise seen from outside.

use std::borrow::Borrow;
use std::collections::HashMap;

use crate::shape::InvalidShape;
use crate::{Direction, Point, Pose, Vector};

/// Vertices in metres and triangles as indices of three vertices, counter-clockwise seen from outside.
///
/// ```
/// use supersurface::{Point, mesh::Mesh};
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let corners = corners.map(Point::from).to_vec();
/// let tetrahedron = Mesh::new(corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// assert!(tetrahedron.is_watertight());
/// assert_eq!(tetrahedron.euler_characteristic(), 2);
/// assert!((tetrahedron.volume() - 1.0 / 6.0).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    vertices: Vec<Point>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Fails when a coordinate is not finite or an index has no vertex.
    pub fn new(vertices: Vec<Point>, triangles: Vec<[u32; 3]>) -> Result<Self, InvalidShape> {
        for v in vertices.iter().flat_map(|v| v.iter()) {
            InvalidShape::check(v.is_finite(), "coordinate of a vertex", *v, "finite")?;
        }
        for i in triangles.iter().flatten() {
            let fits = (*i as usize) < vertices.len();
            InvalidShape::check(fits, "index of a vertex", f64::from(*i), "below their number")?;
        }
        Ok(Self { vertices, triangles })
    }

    /// The same for indices that are right by construction.
    pub(super) fn from_checked(vertices: Vec<Point>, triangles: Vec<[u32; 3]>) -> Self {
        Self { vertices, triangles }
    }

    /// The vertices, in metres.
    pub fn vertices(&self) -> &[Point] {
        &self.vertices
    }

    /// The triangles, as indices of three vertices.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Vertices and triangles.
    pub fn into_parts(self) -> (Vec<Point>, Vec<[u32; 3]>) {
        (self.vertices, self.triangles)
    }

    /// The same surface with its inside out.
    pub fn flipped(mut self) -> Self {
        for [_, b, c] in &mut self.triangles {
            std::mem::swap(b, c);
        }
        self
    }

    /// The same mesh moved by a motion.
    pub fn moved(mut self, motion: &Pose) -> Self {
        for v in &mut self.vertices {
            *v = motion * *v;
        }
        self
    }

    /// Both meshes as one; they share no vertex. `None` when together they have more than 2^32 vertices.
    pub fn beside(mut self, other: &Self) -> Option<Self> {
        let shift = u32::try_from(self.vertices.len()).ok()?;
        u32::try_from(self.vertices.len() + other.vertices.len()).ok()?;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + shift)));
        Some(self)
    }

    /// Corners of each triangle, in metres.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [Point; 3]> {
        self.triangles.iter().map(|t| self.corners_of(t))
    }

    fn corners_of(&self, triangle: &[u32; 3]) -> [Point; 3] {
        // `new` has seen that every index has its vertex
        triangle.map(|i| self.vertices.get(i as usize).copied().unwrap_or_default())
    }

    /// Area in m².
    pub fn area(&self) -> f64 {
        self.corners().map(area).sum()
    }

    /// Volume in m³, positive when the triangles face outwards.
    pub fn volume(&self) -> f64 {
        self.moments().0
    }

    /// Centre of the volume, in metres; `None` when there is no volume.
    pub fn centroid(&self) -> Option<Point> {
        let (volume, moment) = self.moments();
        let centre = self.vertices.first()? + moment / volume;
        centre.iter().all(|v| v.is_finite()).then_some(centre)
    }

    /// Volume, and first moment about the first vertex (near the mesh, so that little cancels).
    fn moments(&self) -> (f64, Vector) {
        let Some(origin) = self.vertices.first() else { return (0.0, Vector::zeros()) };
        self.corners().fold((0.0, Vector::zeros()), |(volume, moment), t| {
            let [a, b, c] = t.map(|p| p - origin);
            let part = a.dot(&b.cross(&c)) / 6.0;
            (volume + part, moment + (a + b + c) * (part / 4.0))
        })
    }

    /// Vertices less edges plus triangles: 2 for a sphere, 0 for a ring. Vertices without a triangle do not count.
    pub fn euler_characteristic(&self) -> i64 {
        let mut used: Vec<u32> = self.triangles.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        used.len() as i64 - self.edges().len() as i64 + self.triangles.len() as i64
    }

    /// True when every edge has two triangles that run along it in opposite directions, and no triangle has a
    /// vertex twice. A mesh without triangles is not.
    pub fn is_watertight(&self) -> bool {
        let proper = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        !self.triangles.is_empty()
            && self.triangles.iter().all(proper)
            && self.edges().values().all(|runs| *runs == [1, 1])
    }

    /// How often each edge is run along upwards and downwards, by (lower, higher) vertex.
    fn edges(&self) -> HashMap<(u32, u32), [u32; 2]> {
        let mut edges = HashMap::with_capacity(self.triangles.len() * 3 / 2);
        for [a, b, c] in &self.triangles {
            for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
                let [up, down] = edges.entry((from.min(to), from.max(to))).or_insert([0, 0]);
                *(if from < to { up } else { down }) += 1;
            }
        }
        edges
    }

    /// Running sums of the areas, from which points are drawn.
    pub fn sampler(&self) -> MeshSampler<&Self> {
        MeshSampler::new(self)
    }

    /// The point that three numbers in [0, 1) choose, uniform over the area, with the unit normal of its triangle;
    /// `None` when the mesh has no area. For many points make one [`sampler`](Self::sampler).
    pub fn sample_at(&self, numbers: [f64; 3]) -> Option<(Point, Direction)> {
        self.sampler().sample_at(numbers)
    }
}

/// Draws points from a mesh, uniform over its area.
///
/// ```
/// use supersurface::{Point, mesh::Mesh};
/// let corners = vec![Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)];
/// let mesh = Mesh::new(corners, vec![[0, 1, 2]])?;
/// let (point, normal) = mesh.sampler().sample_at([0.1, 0.25, 0.5]).unwrap();
/// assert!(point.x + point.y <= 1.0 && normal.z == 1.0);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeshSampler<M> {
    mesh: M,
    sums: Vec<f64>,
}

impl<M: Borrow<Mesh>> MeshSampler<M> {
    /// A sampler that borrows or owns its mesh.
    pub fn new(mesh: M) -> Self {
        let mut sum = 0.0;
        let running = mesh.borrow().corners().map(|t| {
            sum += area(t);
            sum
        });
        let sums = running.collect();
        Self { mesh, sums }
    }

    /// The mesh that is drawn from.
    pub fn mesh(&self) -> &Mesh {
        self.mesh.borrow()
    }

    /// The point that three numbers in [0, 1) choose (the triangle, and a point of it), with the unit normal of its
    /// triangle; `None` when the mesh has no area.
    pub fn sample_at(&self, [which, u, v]: [f64; 3]) -> Option<(Point, Direction)> {
        let at = which * self.sums.last()?;
        let index = self.sums.partition_point(|sum| *sum <= at);
        let mesh = self.mesh();
        let [a, b, c] = mesh.corners_of(mesh.triangles.get(index)?);
        let normal = Direction::try_new((b - a).cross(&(c - a)), 0.0)?;
        // the square root makes the strip at distance `1 - root` from `a` as likely as it is long
        let root = u.max(0.0).sqrt();
        Some((a + (b - a) * (root * (1.0 - v)) + (c - a) * (root * v), normal))
    }
}

fn area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * (b - a).cross(&(c - a)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    fn cube() -> Mesh {
        let corner = |i: u32| Point::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from));
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        Mesh::new((0..8).map(corner).collect(), halves.collect()).unwrap()
    }

    #[test]
    fn a_cube_is_a_cube() {
        let cube = cube();
        assert!(cube.is_watertight());
        assert_eq!(cube.euler_characteristic(), 2);
        assert!((cube.volume() - 1.0).abs() < 1e-15 && (cube.area() - 6.0).abs() < 1e-15);
        let half = Point::new(0.5, 0.5, 0.5);
        assert!((cube.centroid().unwrap() - half).norm() < 1e-15);
        assert!((cube.flipped().volume() + 1.0).abs() < 1e-15);
    }

    #[test]
    fn holes_and_turned_triangles_leak() {
        let (vertices, mut triangles) = cube().into_parts();
        let last = triangles.pop().unwrap();
        assert!(!Mesh::new(vertices.clone(), triangles.clone()).unwrap().is_watertight());
        triangles.push([last[1], last[0], last[2]]);
        assert!(!Mesh::new(vertices, triangles).unwrap().is_watertight());
        assert!(!Mesh::default().is_watertight() && Mesh::default().centroid().is_none());
        assert!(Mesh::new(vec![Point::origin()], vec![[0, 0, 1]]).is_err());
        assert!(Mesh::new(vec![Point::new(f64::NAN, 0.0, 0.0)], vec![]).is_err());
    }

    #[test]
    fn points_are_uniform_over_the_area() {
        let (cube, mut stream) = (cube(), Stream::new(1, 0));
        let sampler = cube.sampler();
        let mut sum = Vector::zeros();
        for _ in 0..6000 {
            let numbers = std::array::from_fn(|_| stream.uniform());
            let (p, n) = sampler.sample_at(numbers).unwrap();
            let high = n.iter().sum::<f64>() > 0.0;
            assert!((n.abs().dot(&p.coords) - f64::from(high)).abs() < 1e-15);
            sum += p.coords;
        }
        assert!((sum / 6000.0 - Vector::repeat(0.5)).amax() < 0.02);
    }
}
