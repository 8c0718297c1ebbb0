//! Watertight meshes of implicit solids, by marching tetrahedra.
//!
//! Cubes of a grid are each cut into six tetrahedra around their long diagonal (Kuhn's subdivision, which fits
//! together from cube to cube). A tetrahedron has no ambiguous case: its corners inside are parted from those outside
//! by a triangle or two, with vertices where its edges cross `g = 1` (Doi and Koide 1991). Every grid edge has one
//! vertex at most, so the mesh is closed and without an edge of more than two triangles, whatever the function does.
//! Marching cubes and surface nets promise neither where two sheets of the surface share a cell: the kept crates leave
//! edges with four triangles already on a ball with a square hole.
//!
//! What is not guaranteed: what is thinner than a cell can be missed or torn apart, edges and corners are cut by up to
//! a cell, and triangles are as small and as thin as the grid cuts them.

use super::Mesh;
use crate::Point;
use crate::shape::Implicit;

/// How finely a solid is marched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// Cells along the longest side of the bounds, at least 1.
    Count(usize),
    /// Side of a cell in metres, positive.
    Size(f64),
}

/// How [`march`] works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarchOptions {
    /// The cells of the grid.
    pub resolution: Resolution,
    /// True: vertices are moved along their grid edges onto the surface. False: they are placed as if the gauge were
    /// linear between the nodes, which is faster.
    pub exact: bool,
    /// Most bytes that the grid may take, 8 a node (the mesh comes on top); over 4.9e9 is as much as that.
    pub memory: usize,
}

impl Default for MarchOptions {
    /// 64 cells, vertices on the surface, 1 GiB (a cube of 512 cells a side).
    fn default() -> Self {
        Self { resolution: Resolution::Count(64), exact: true, memory: 1 << 30 }
    }
}

/// Why a solid cannot be marched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MarchError {
    /// The solid has no finite bounds, or empty ones.
    #[error("the solid is not bounded, or empty: a grid needs finite bounds of some size")]
    Unbounded,
    /// The cell is no length.
    #[error("the cell is {0} m: it must be positive, finite and not too small to count")]
    Cell(f64),
    /// The grid is larger than allowed.
    #[error(
        "a grid with cells of {cell} m takes {needed:.3e} bytes and {allowed} are allowed: take larger cells or allow more memory"
    )]
    TooFine {
        /// Side of a cell, in metres.
        cell: f64,
        /// Bytes that the grid takes.
        needed: f64,
        /// Bytes that it may take.
        allowed: usize,
    },
}

/// The closed mesh of a bounded solid; without triangles where no node of the grid is inside.
///
/// The grid reaches a cell or more beyond the bounds. Where a solid does so too, it is cut off there.
///
/// ```
/// use supersurface::mesh::{MarchOptions, march};
/// use supersurface::shape::{Implicit, Supercylinder};
/// let tin = Supercylinder::new([0.03, 0.03, 0.05], 1.0)?;
/// let mesh = march(&tin, &MarchOptions::default())?;
/// assert!(mesh.is_watertight());
/// assert!((mesh.volume() / tin.volume() - 1.0).abs() < 0.02);
/// assert!(mesh.vertices().iter().all(|p| (tin.gauge(p) - 1.0).abs() < 1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn march<S: Implicit + Sync + ?Sized>(
    solid: &S,
    options: &MarchOptions,
) -> Result<Mesh, MarchError> {
    let grid = Lattice::new(solid.bounds(), options)?;
    let values = grid.values(solid);
    let mut marcher = Marcher {
        grid,
        values,
        solid: options.exact.then_some(solid),
        layers: [vec![[NONE; 7]; grid.layer()], vec![[NONE; 7]; grid.layer()]],
        vertices: Vec::new(),
        triangles: Vec::new(),
    };
    marcher.run();
    Ok(Mesh::from_checked(marcher.vertices, marcher.triangles))
}

/// No vertex yet.
const NONE: u32 = u32::MAX;
/// Steps by which a vertex is moved onto the surface.
const STEPS: usize = 110;
/// Corners of a cube's tetrahedra (bits 1, 2, 4 for x, y, z), each of positive volume.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 3, 2, 7], [0, 6, 4, 7], [0, 5, 1, 7]];

/// The nodes of the grid.
#[derive(Clone, Copy)]
struct Lattice {
    origin: Point,
    cell: f64,
    count: [usize; 3],
}

impl Lattice {
    fn new([low, high]: [Point; 2], options: &MarchOptions) -> Result<Self, MarchError> {
        let sides = high - low;
        let longest = sides.max();
        if !(sides.min() >= 0.0 && longest > 0.0 && longest.is_finite()) {
            return Err(MarchError::Unbounded);
        }
        let cell = match options.resolution {
            Resolution::Count(n) => longest / n.max(1) as f64,
            Resolution::Size(size) => size,
        };
        // 1e-9: below, nodes far from the origin are no longer evenly spaced
        let size = low.coords.amax().max(high.coords.amax());
        if !(cell > 1e-9 * size && cell.is_finite()) {
            return Err(MarchError::Cell(cell));
        }
        // a cell to 1.5 more at each end
        let count = sides.map(|s| (s / cell).ceil() + 3.0);
        let needed = count.product() * 8.0;
        // seven vertices a node at most, counted by 32 bits
        let allowed = options.memory.min((u32::MAX as usize / 7).saturating_mul(8));
        if needed > allowed as f64 {
            return Err(MarchError::TooFine { cell, needed, allowed });
        }
        let origin = nalgebra::center(&low, &high) - count.add_scalar(-1.0) * (0.5 * cell);
        Ok(Self { origin, cell, count: [count.x, count.y, count.z].map(|n| n as usize) })
    }

    /// Nodes of a layer across z.
    const fn layer(&self) -> usize {
        self.count[0] * self.count[1]
    }

    fn node(&self, [x, y, z]: [usize; 3]) -> Point {
        let [x, y, z] = [x, y, z].map(|i| i as f64 * self.cell);
        self.origin + crate::Vector::new(x, y, z)
    }

    /// `g - 1` at all nodes; the outermost are outside, whatever it says there.
    fn values<S: Implicit + Sync + ?Sized>(&self, solid: &S) -> Vec<f64> {
        let [nx, ny, nz] = self.count;
        let mut values = vec![1.0; nx * ny * nz];
        let fill = |(z, layer): (usize, &mut [f64])| {
            for (i, value) in layer.iter_mut().enumerate() {
                let at = [i % nx, i / nx, z];
                let inner = at.iter().zip([nx, ny, nz]).all(|(i, n)| *i > 0 && i + 1 < n);
                if inner {
                    *value = solid.gauge(&self.node(at)) - 1.0;
                }
            }
        };
        #[cfg(feature = "parallel")]
        {
            use rayon::prelude::*;
            values.par_chunks_mut(nx * ny).enumerate().for_each(fill);
        }
        #[cfg(not(feature = "parallel"))]
        values.chunks_mut(nx * ny).enumerate().for_each(fill);
        values
    }
}

struct Marcher<'a, S: ?Sized> {
    grid: Lattice,
    values: Vec<f64>,
    /// Present when vertices are to lie on its surface.
    solid: Option<&'a S>,
    /// Vertices on the seven edges that go up from each node of this layer and of the next.
    layers: [Vec<[u32; 7]>; 2],
    vertices: Vec<Point>,
    triangles: Vec<[u32; 3]>,
}

impl<S: Implicit + ?Sized> Marcher<'_, S> {
    fn run(&mut self) {
        let [nx, ny, nz] = self.grid.count;
        for z in 0..nz - 1 {
            for y in 0..ny - 1 {
                for x in 0..nx - 1 {
                    self.cube([x, y, z]);
                }
            }
            self.layers.swap(0, 1);
            self.layers[1].fill([NONE; 7]);
        }
    }

    fn value(&self, [x, y, z]: [usize; 3]) -> f64 {
        let [nx, ny, _] = self.grid.count;
        self.values.get((z * ny + y) * nx + x).copied().unwrap_or(1.0)
    }

    fn cube(&mut self, at: [usize; 3]) {
        let values: [f64; 8] = std::array::from_fn(|c| self.value(corner(at, c)));
        // also what is not a number is outside
        let inside = values.map(|v| v <= 0.0);
        if inside.iter().all(|i| *i == inside[0]) {
            return;
        }
        for corners in TETRAHEDRA {
            let (mut order, mut odd, mut within) = (corners, false, 0);
            // those inside come first; an odd number of swaps turns the tetrahedron
            for i in 0..4 {
                if inside[order[i]] {
                    for j in (within..i).rev() {
                        order.swap(j, j + 1);
                        odd = !odd;
                    }
                    within += 1;
                }
            }
            let [a, b, c, d] = order;
            match within {
                1 => self.triangle(at, &values, [[a, b], [a, c], [a, d]], odd),
                2 => {
                    self.triangle(at, &values, [[a, c], [a, d], [b, d]], odd);
                    self.triangle(at, &values, [[a, c], [b, d], [b, c]], odd);
                }
                3 => self.triangle(at, &values, [[d, a], [d, b], [d, c]], odd),
                _ => {}
            }
        }
    }

    fn triangle(
        &mut self,
        at: [usize; 3],
        values: &[f64; 8],
        edges: [[usize; 2]; 3],
        turned: bool,
    ) {
        let [a, b, c] = edges.map(|[i, j]| self.vertex(at, values, i.min(j), i.max(j)));
        self.triangles.push(if turned { [a, c, b] } else { [a, b, c] });
    }

    /// The vertex between two corners of a cube, the lower of which is below the other along each axis.
    fn vertex(&mut self, at: [usize; 3], values: &[f64; 8], low: usize, high: usize) -> u32 {
        let [x, y, z] = corner(at, low);
        let (layer, place) = (z - at[2], y * self.grid.count[0] + x);
        let edge = (high ^ low) - 1;
        let known = self.layers[layer][place][edge];
        if known != NONE {
            return known;
        }
        let ends = [low, high].map(|c| self.grid.node(corner(at, c)));
        let point = self.crossing(ends, [values[low], values[high]]);
        let new = self.vertices.len() as u32;
        self.vertices.push(point);
        self.layers[layer][place][edge] = new;
        new
    }

    /// Where the gauge crosses 1 between two nodes of different sides: by the rule of false position (Illinois, so that
    /// both ends move), and by halving in every other step where the gauge has a kink.
    fn crossing(&self, [p, q]: [Point; 2], [mut f, mut g]: [f64; 2]) -> Point {
        let linear = |f: f64, g: f64| {
            let share = f / (f - g);
            if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }
        };
        let at = |t: f64| p + (q - p) * t;
        let Some(solid) = self.solid else { return at(linear(f, g)) };
        let (mut from, mut to) = (0.0, 1.0);
        let first_inside = f <= 0.0;
        let (mut t, mut last) = (0.5, None);
        for step in 0..STEPS {
            let share = if step >= 10 && step % 2 == 0 { 0.5 } else { linear(f, g) };
            t = from + (to - from) * share;
            let value = solid.gauge(&at(t)) - 1.0;
            if value.abs() <= 1e-12 || to - from <= 1e-15 {
                break;
            }
            let lower = (value <= 0.0) == first_inside;
            // an end that stays again counts for half
            let weight = if last == Some(lower) { 0.5 } else { 1.0 };
            last = Some(lower);
            if lower {
                (from, f, g) = (t, value, weight * g);
            } else {
                (to, g, f) = (t, value, weight * f);
            }
        }
        at(t)
    }
}

/// The node at a corner of the cube.
fn corner([x, y, z]: [usize; 3], corner: usize) -> [usize; 3] {
    [x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2 & 1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;
    use crate::shape::{Superellipsoid, Supertoroid};

    /// The gauge of one of two solids, and their bounds.
    struct Pair<A, B>(A, B, fn(f64, f64) -> f64);

    impl<A: Implicit, B: Implicit> Implicit for Pair<A, B> {
        fn gauge(&self, p: &Point) -> f64 {
            self.2(self.0.gauge(p), self.1.gauge(p))
        }
        fn gradient(&self, _: &Point) -> Vector {
            Vector::zeros()
        }
        fn bounds(&self) -> [Point; 2] {
            let ([a, b], [c, d]) = (self.0.bounds(), self.1.bounds());
            [a.inf(&c), b.sup(&d)]
        }
    }

    fn counted(n: usize) -> MarchOptions {
        MarchOptions { resolution: Resolution::Count(n), ..Default::default() }
    }

    #[test]
    fn solids_have_their_volume_and_topology() {
        let ball = Superellipsoid::new([1.0, 0.5, 0.7], [1.0, 0.6]).unwrap();
        let ring = Supertoroid::new([1.0; 3], 2.0, [1.0; 2]).unwrap();
        for (exact, most) in [(true, 2e-3), (false, 2e-3)] {
            let options = MarchOptions { exact, ..counted(60) };
            for (mesh, volume, euler) in [
                (march(&ball, &options).unwrap(), ball.volume(), 2),
                (march(&ring, &options).unwrap(), ring.volume(), 0),
            ] {
                assert!(mesh.is_watertight());
                assert_eq!(mesh.euler_characteristic(), euler);
                let off = mesh.volume() / volume - 1.0;
                assert!(off.abs() < most, "{exact} {off}");
            }
        }
        let mesh = march(&ball, &counted(40)).unwrap();
        assert!(mesh.vertices().iter().all(|p| (ball.gauge(p) - 1.0).abs() < 2e-12));
    }

    #[test]
    fn what_touches_and_what_is_torn_stays_closed() {
        let cube = Superellipsoid::new([1.0; 3], [0.1; 2]).unwrap();
        let ring = Supertoroid::new([0.5, 0.5, 1.2], 1.6, [0.3, 1.0]).unwrap();
        let thin = Superellipsoid::new([1.0, 1.0, 0.011], [2.5, 2.5]).unwrap();
        let all: [fn(f64, f64) -> f64; 3] = [f64::min, f64::max, |a, b| a.max(2.0 - b)];
        for combine in all {
            for n in [3, 10, 31] {
                let mesh = march(&Pair(cube, ring, combine), &counted(n)).unwrap();
                // a grid of three cells may miss all of it
                assert!(n == 3 || mesh.volume() > 0.0, "{n}");
                assert!(mesh.triangles().is_empty() || mesh.is_watertight(), "{n}");
                let mesh = march(&Pair(thin, ring, combine), &counted(n)).unwrap();
                assert!(mesh.triangles().is_empty() || mesh.is_watertight(), "{n}");
            }
        }
        // sides of any node by chance: no edge with more than two triangles
        struct Noise;
        impl Implicit for Noise {
            fn gauge(&self, p: &Point) -> f64 {
                let index = p.iter().fold(0u64, |h, v| h.wrapping_mul(31) ^ v.to_bits());
                2.0 * crate::numeric::random::Stream::new(1, index).uniform()
            }
            fn gradient(&self, _: &Point) -> Vector {
                Vector::zeros()
            }
            fn bounds(&self) -> [Point; 2] {
                [Point::origin(), Point::new(1.0, 0.7, 0.4)]
            }
        }
        let options = MarchOptions { exact: false, ..counted(17) };
        assert!(march(&Noise, &options).unwrap().is_watertight());
    }

    #[test]
    fn what_cannot_be_marched_says_why() {
        let ball = Superellipsoid::new([1.0; 3], [1.0; 2]).unwrap();
        let size = |s| MarchOptions { resolution: Resolution::Size(s), ..Default::default() };
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-12] {
            assert!(matches!(march(&ball, &size(bad)), Err(MarchError::Cell(_))), "{bad}");
        }
        let error = march(&ball, &size(1e-4)).unwrap_err();
        assert!(error.to_string().contains("larger cells"), "{error}");
        assert!(march(&ball, &size(50.0)).unwrap().triangles().len() <= 24 * 27);
        let bowl = crate::shape::Superparaboloid::new([1.0; 3], [1.0; 2]).unwrap();
        assert_eq!(march(&bowl, &counted(10)), Err(MarchError::Unbounded));
        assert!(march(&ball, &counted(0)).is_ok());
    }
}
