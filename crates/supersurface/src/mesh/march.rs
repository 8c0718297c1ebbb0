//! Closed meshes of implicit solids, by naive surface nets (Gibson 1998) on a regular grid.
//!
//! The nets are those of the `fast-surface-nets` crate: a vertex in each cell that the surface passes, a quad across
//! each grid edge with ends on both sides. Its vertices, the means of the crossings of a cell's edges, are then moved along
//! the gradient on to the surface. Every edge is run along as often one way as the other, so that the mesh is closed.
//!
//! What is not guaranteed: where two sheets pass one cell they share its vertex, and an edge can have four triangles;
//! what is thinner than a cell can be missed or torn apart; edges and corners are cut by up to a cell.

use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};

use super::Mesh;
use crate::shape::Implicit;
use crate::{Direction, Point, Vector};

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
    /// Most bytes that the grid may take, 8 a node (the mesh comes on top).
    pub memory: usize,
}

impl Default for MarchOptions {
    /// 64 cells, 1 GiB (a cube of 512 cells a side).
    fn default() -> Self {
        Self { resolution: Resolution::Count(64), memory: 1 << 30 }
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
    let mut net = SurfaceNetsBuffer::default();
    let shape = RuntimeShape::<u32, 3>::new(grid.count);
    surface_nets(&values, &shape, [0; 3], grid.count.map(|n| n - 1), &mut net);
    let vertices = grid.settled(solid, &net.positions);
    let triangles = net.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Ok(Mesh::from_checked(vertices, triangles))
}

/// Steps by which a vertex is moved on to the surface.
const STEPS: usize = 60;

/// The nodes of the grid.
#[derive(Clone, Copy)]
struct Lattice {
    origin: Point,
    cell: f64,
    count: [u32; 3],
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
        // 1.5 cells to 2 more at each end: nets leave the outermost cells open
        let count = sides.map(|s| (s / cell).ceil() + 4.0);
        let needed = count.product() * 8.0;
        // seven vertices a node at most, counted by 32 bits
        let allowed = options.memory.min((u32::MAX as usize / 7).saturating_mul(8));
        if needed > allowed as f64 {
            return Err(MarchError::TooFine { cell, needed, allowed });
        }
        let origin = nalgebra::center(&low, &high) - count.add_scalar(-1.0) * (0.5 * cell);
        Ok(Self { origin, cell, count: [count.x, count.y, count.z].map(|n| n as u32) })
    }

    /// A place in cells from the first node.
    fn place(&self, [x, y, z]: [f64; 3]) -> Point {
        self.origin + Vector::new(x, y, z) * self.cell
    }

    /// `g - 1` at all nodes; the two outermost of a row are outside, whatever it says there.
    fn values<S: Implicit + Sync + ?Sized>(&self, solid: &S) -> Vec<f32> {
        let [nx, ny, nz] = self.count.map(|n| n as usize);
        let mut values = vec![1.0; nx * ny * nz];
        let fill = |(z, layer): (usize, &mut [f32])| {
            for (i, value) in layer.iter_mut().enumerate() {
                let at = [i % nx, i / nx, z];
                let inner = at.iter().zip([nx, ny, nz]).all(|(i, n)| *i > 1 && i + 2 < n);
                if inner {
                    let off = solid.gauge(&self.place(at.map(|i| i as f64))) - 1.0;
                    // a small number must not lose its sign; what is no number is outside
                    *value = match off < 0.0 {
                        true => (off as f32).min(-f32::MIN_POSITIVE),
                        false => (off as f32).max(0.0),
                    };
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

    /// The vertices of a net, moved on to the surface where it is less than a cell away along the gradient.
    fn settled<S: Implicit + Sync + ?Sized>(&self, solid: &S, net: &[[f32; 3]]) -> Vec<Point> {
        let settle = |place: &[f32; 3]| {
            let start = self.place(place.map(f64::from));
            crossing(solid, start, self.cell).unwrap_or(start)
        };
        #[cfg(feature = "parallel")]
        {
            use rayon::prelude::*;
            net.par_iter().map(settle).collect()
        }
        #[cfg(not(feature = "parallel"))]
        net.iter().map(settle).collect()
    }
}

/// The point nearest to `start` along the gradient where the gauge crosses 1, at most `reach` away: a bracket by doubled
/// steps, then the rule of false position, and halving where that does not help.
fn crossing<S: Implicit + ?Sized>(solid: &S, start: Point, reach: f64) -> Option<Point> {
    let slope = solid.gradient(&start);
    let way = Direction::try_new(slope / slope.amax(), 0.0)?.into_inner();
    let off = |t: f64| solid.gauge(&(start + way * t)) - 1.0;
    let first = off(0.0);
    let outwards = if first <= 0.0 { 1.0 } else { -1.0 };
    let (mut near, mut at_near) = (0.0, first);
    let mut far = outwards * (2.0 * first.abs() / slope.norm()).clamp(1e-3 * reach, reach);
    let mut at_far = off(far);
    while (at_far <= 0.0) == (first <= 0.0) {
        if far.abs() >= reach {
            return None;
        }
        (near, at_near) = (far, at_far);
        far = outwards * (2.0 * far.abs()).min(reach);
        at_far = off(far);
    }
    let mut t = near;
    for step in 0..STEPS {
        let share = at_near / (at_near - at_far);
        let share = if step % 3 == 2 || !share.is_finite() { 0.5 } else { share };
        t = near + (far - near) * share;
        let value = off(t);
        if value.abs() <= 1e-14 || (far - near).abs() <= 1e-15 * reach {
            break;
        }
        if (value <= 0.0) == (first <= 0.0) {
            (near, at_near) = (t, value);
        } else {
            (far, at_far) = (t, value);
        }
    }
    Some(start + way * t)
}

#[cfg(test)]
mod tests {
    use super::*;
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
        let options = counted(60);
        for (mesh, volume, euler) in [
            (march(&ball, &options).unwrap(), ball.volume(), 2),
            (march(&ring, &options).unwrap(), ring.volume(), 0),
        ] {
            assert!(mesh.is_watertight());
            assert_eq!(mesh.euler_characteristic(), euler);
            let off = mesh.volume() / volume - 1.0;
            assert!(off.abs() < 2e-3, "{off}");
        }
        let mesh = march(&ball, &counted(40)).unwrap();
        assert!(mesh.vertices().iter().all(|p| (ball.gauge(p) - 1.0).abs() < 1e-12));
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
                assert!(mesh.triangles().is_empty() || mesh.is_closed(), "{n}");
                let mesh = march(&Pair(thin, ring, combine), &counted(n)).unwrap();
                assert!(mesh.triangles().is_empty() || mesh.is_closed(), "{n}");
            }
        }
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
