//! Watertight triangle meshes of closed parametric surfaces, adapted to curvature.
//!
//! A grid of the two angles: rows and columns are cut so that chords of meridians and of parallels stay within 0.45
//! of the tolerance of their arcs (`grid`); then every cell is compared with the surface at five points between its
//! corners, takes the better of its two diagonals, and its row or column is cut again where it is still too far.
//! Poles are single vertices and seams share theirs, so that the mesh is closed by construction.
//!
//! What holds: vertices lie on the surface, triangles face outwards, the mesh is closed, and at the five points of
//! every cell the distance is within the tolerance. What is not guaranteed: the distance between these points (within
//! the tolerance in all tests, at 10⁴ random points of each mesh), and that triangles are well shaped: near poles and
//! sharp edges they are thin.

use std::collections::BTreeSet;

use super::Mesh;
use super::grid::{cuts, distance_to_triangle, quarters, sagitta};
use crate::Point;
use crate::shape::Parametric;

/// Share of the tolerance that each direction of the grid may use.
const SHARE: f64 = 0.45;
/// Share of the tolerance that the compared points may use, since the farthest point may lie between them.
const CHECKED: f64 = 0.9;
/// Cells beyond which a tolerance is given up.
const MOST_CELLS: usize = 4_000_000;
/// Tolerances, as shares of the surface's size, that are not tried.
const FINEST: f64 = 1e-9;
/// How often cells that are too far are cut again.
const ROUNDS: usize = 24;

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TessellateError {
    /// The surface has a border, or is not of a size between 1e-100 and 1e100 m.
    #[error(
        "the surface is not closed (its angles end neither in poles nor where they began), or has no size"
    )]
    Open,
    /// The tolerance is no length.
    #[error("the tolerance is {0} m: it must be positive and finite")]
    Tolerance(f64),
    /// More triangles, or finer angles than numbers can tell apart, would be needed.
    #[error("a tolerance of {tolerance} m is too fine: the best mesh is {distance} m off")]
    TooFine {
        /// The tolerance asked for, in metres.
        tolerance: f64,
        /// The largest distance that was reached, in metres; infinite when the grid alone was too fine.
        distance: f64,
    },
}

/// A mesh, and how far it is from its surface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tessellation {
    /// The mesh: closed, its triangles counter-clockwise seen from outside.
    pub mesh: Mesh,
    /// The largest distance between mesh and surface that was asked for or chosen, in metres.
    pub tolerance: f64,
    /// The largest distance that was found, in metres, at most the tolerance.
    pub distance: f64,
}

/// The mesh of a closed surface, no farther than `tolerance` metres from it.
///
/// `None` chooses the tolerance from the ratio of volume and area so that the volume is within 0.1 % of the solid's.
/// Surfaces are closed when η ends in two poles or where it began, and ω where it began; any other has
/// [`TessellateError::Open`].
///
/// ```
/// use supersurface::deform::{Bend, Deformed};
/// use supersurface::{mesh::tessellate, shape::Superellipsoid};
/// let stick = Superellipsoid::new([0.01, 0.01, 0.06], [0.5, 1.0])?;
/// let banana = Deformed::new(stick, Bend::new(12.0, 0.0)?)?;
/// let found = tessellate(&banana, Some(1e-4))?;
/// assert!(found.mesh.is_watertight() && found.distance <= 1e-4);
/// assert!((found.mesh.volume() / stick.volume() - 1.0).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tessellate<S: Parametric + ?Sized>(
    surface: &S,
    tolerance: Option<f64>,
) -> Result<Tessellation, TessellateError> {
    let mut grid = Grid::closed(surface).ok_or(TessellateError::Open)?;
    if let Some(bad) = tolerance.filter(|t| !(*t > 0.0 && t.is_finite())) {
        return Err(TessellateError::Tolerance(bad));
    }
    let tolerance = tolerance.unwrap_or_else(|| grid.default_tolerance());
    let mut best = f64::INFINITY;
    if tolerance > FINEST * grid.size {
        grid.cut(SHARE * tolerance);
        // more than a few rounds are needed only where the two directions twist each other
        for _ in 0..ROUNDS {
            if grid.rows.len() * grid.columns.len() > MOST_CELLS {
                break;
            }
            let (mesh, distance, further) = grid.mesh(CHECKED * tolerance);
            best = best.min(distance);
            if distance <= CHECKED * tolerance {
                let mesh = if mesh.volume() < 0.0 { mesh.flipped() } else { mesh };
                return Ok(Tessellation { mesh, tolerance, distance });
            }
            if !grid.refine(&further) {
                break;
            }
        }
    }
    Err(TessellateError::TooFine { tolerance, distance: best })
}

/// Angles at which a surface is cut into cells.
struct Grid<'a, S: ?Sized> {
    surface: &'a S,
    size: f64,
    /// True when the first and the last row are poles, false when they are the same row.
    poles: bool,
    rows: Vec<f64>,
    columns: Vec<f64>,
}

/// A row or a column of cells: its ends, and three angles between them.
struct Span {
    ends: [f64; 2],
    inner: [f64; 3],
}

/// Rows and columns of cells that have to be cut again.
#[derive(Default)]
struct Further {
    rows: BTreeSet<usize>,
    columns: BTreeSet<usize>,
}

impl<'a, S: Parametric + ?Sized> Grid<'a, S> {
    /// A first grid, if the surface is closed.
    fn closed(surface: &'a S) -> Option<Self> {
        let [rows, columns] = surface.domain().map(even);
        let points: Vec<Vec<Point>> =
            rows.iter().map(|e| columns.iter().map(|o| surface.point(*e, *o)).collect()).collect();
        let (first, last) = (points.first()?, points.last()?);
        let centre = first.first()?;
        let size = points.iter().flatten().map(|p| (p - centre).amax()).fold(0.0, f64::max);
        let finite = points.iter().flatten().flat_map(|p| p.iter()).all(|v| v.is_finite());
        if !finite || !(1e-100..1e100).contains(&size) {
            return None;
        }
        let same = |a: &Point, b: &Point| (a - b).amax() <= 1e-9 * size;
        let pole = |row: &[Point]| row.iter().zip(row.iter().skip(1)).all(|(a, b)| same(a, b));
        let joined = first.iter().zip(last).all(|(a, b)| same(a, b));
        let around =
            points.iter().all(|r| r.first().zip(r.last()).is_some_and(|(a, b)| same(a, b)));
        // a ring whose hole has closed to a point is still a ring
        let poles = pole(first) && pole(last) && !joined;
        (around && (poles || joined)).then_some(Self { surface, size, poles, rows, columns })
    }

    fn parallel(&self, eta: f64) -> impl Fn(f64) -> Point + use<'a, S> {
        let surface = self.surface;
        move |omega| surface.point(eta, omega)
    }

    fn meridian(&self, omega: f64) -> impl Fn(f64) -> Point + use<'a, S> {
        let surface = self.surface;
        move |eta| surface.point(eta, omega)
    }

    /// Chooses columns and rows by the chords of some parallels and meridians.
    fn cut(&mut self, tolerance: f64) {
        let [eta, omega] = self.surface.domain();
        let parallels: Vec<_> = probes(eta, &self.rows).map(|t| self.parallel(t)).collect();
        self.columns = cuts(&parallels, omega, tolerance);
        let meridians: Vec<_> = probes(omega, &self.columns).map(|t| self.meridian(t)).collect();
        self.rows = cuts(&meridians, eta, tolerance);
    }

    /// 1.5 thousandths of volume over area, found on a coarse mesh: what chords cut off is two thirds of their largest
    /// distance times the area, or less.
    fn default_tolerance(&mut self) -> f64 {
        let ratio = |grid: &Self| {
            let (mesh, ..) = grid.mesh(f64::INFINITY);
            mesh.volume().abs() / mesh.area()
        };
        self.cut(0.05 * ratio(self));
        1.5e-3 * ratio(self)
    }

    /// The spans of rows and of columns; the inner angles quarter the longest of some chords.
    fn spans(&self) -> [Vec<Span>; 2] {
        let [eta, omega] = self.surface.domain();
        let meridians: Vec<_> = even(omega).into_iter().map(|t| self.meridian(t)).collect();
        let parallels: Vec<_> = even(eta).into_iter().map(|t| self.parallel(t)).collect();
        [spans(&self.rows, &meridians), spans(&self.columns, &parallels)]
    }

    /// The mesh, the largest distance found, and what to cut where it is more than `allowed`.
    fn mesh(&self, allowed: f64) -> (Mesh, f64, Further) {
        let [rows, columns] = self.spans();
        let (height, width) = (rows.len(), columns.len());
        let mut vertices = Vec::with_capacity(height * width + 1);
        let last = if self.poles { height } else { height - 1 };
        for (i, eta) in self.rows.iter().enumerate().take(last + 1) {
            let pole = self.poles && (i == 0 || i == height);
            let omegas = self.columns.iter().take(if pole { 1 } else { width });
            vertices.extend(omegas.map(|omega| self.surface.point(*eta, *omega)));
        }
        let index = |i: usize, j: usize| match self.poles {
            true if i == 0 => 0,
            true if i == height => 1 + (height - 1) * width,
            true => 1 + (i - 1) * width + j % width,
            false => (i % height) * width + j % width,
        };
        let mut triangles = Vec::with_capacity(2 * height * width);
        let (mut farthest, mut further) = (0.0f64, Further::default());
        for (i, row) in rows.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                let corners = [[i, j], [i, j + 1], [i + 1, j + 1], [i + 1, j]];
                let corners = corners.map(|[i, j]| index(i, j) as u32);
                let (cell, distance) = self.cell(corners, &vertices, row, column);
                triangles.extend(cell);
                farthest = farthest.max(distance);
                if distance > allowed {
                    match self.along_row(row, column, distance) {
                        true => further.columns.insert(j),
                        false => further.rows.insert(i),
                    };
                }
            }
        }
        (Mesh::from_checked(vertices, triangles), farthest, further)
    }

    /// The triangles of a cell, with the better diagonal, and the largest distance of five points of the surface
    /// from them.
    fn cell(
        &self,
        [a, b, c, d]: [u32; 4],
        vertices: &[Point],
        row: &Span,
        column: &Span,
    ) -> (Vec<[u32; 3]>, f64) {
        let ([e0, e1, e2], [o0, o1, o2]) = (row.inner, column.inner);
        let points = [(e1, o1), (e0, o0), (e0, o2), (e2, o0), (e2, o2)]
            .map(|(eta, omega)| self.surface.point(eta, omega));
        let vertex = |k: u32| vertices.get(k as usize).copied().unwrap_or_default();
        let judged = |triangles: [[u32; 3]; 2]| {
            // at a pole one of both has a corner twice
            let proper = triangles.into_iter().filter(|[a, b, c]| a != b && b != c && c != a);
            let proper: Vec<_> = proper.collect();
            let corners: Vec<_> = proper.iter().map(|t| t.map(vertex)).collect();
            let off = |p: &Point| {
                let distances = corners.iter().map(|t| distance_to_triangle(p, t));
                distances.fold(f64::INFINITY, f64::min)
            };
            let distance = points.iter().map(off).fold(0.0, f64::max);
            (proper, distance)
        };
        let straight = judged([[a, b, c], [a, c, d]]);
        if a == b || c == d {
            return straight;
        }
        let other = judged([[a, b, d], [b, c, d]]);
        if other.1 < straight.1 { other } else { straight }
    }

    /// True when a cell should be cut between columns: when its chords along the row are the worse ones, or, where
    /// none explains the distance, the longer ones.
    fn along_row(&self, row: &Span, column: &Span, distance: f64) -> bool {
        let worst = |off: [f64; 3]| off.into_iter().fold(0.0, f64::max);
        let [bottom, top] = row.ends;
        let [left, right] = column.ends;
        let (eta, omega) = (row.inner[1], column.inner[1]);
        let across = worst([bottom, eta, top].map(|t| sagitta(&self.parallel(t), left, right)));
        let along = worst([left, omega, right].map(|t| sagitta(&self.meridian(t), bottom, top)));
        if across.max(along) > 0.25 * distance {
            return across > along;
        }
        let (parallel, meridian) = (self.parallel(eta), self.meridian(omega));
        (parallel(left) - parallel(right)).norm() > (meridian(bottom) - meridian(top)).norm()
    }

    /// Cuts rows and columns once more; false when their angles can no longer be told apart.
    fn refine(&mut self, further: &Further) -> bool {
        let [rows, columns] = self.spans();
        let before = self.rows.len() + self.columns.len();
        for (list, spans, which) in [
            (&mut self.rows, &rows, &further.rows),
            (&mut self.columns, &columns, &further.columns),
        ] {
            let chosen = which.iter().filter_map(|i| spans.get(*i));
            let inside = chosen.filter(|s| s.inner[1] > s.ends[0] && s.inner[1] < s.ends[1]);
            list.extend(inside.map(|s| s.inner[1]));
            list.sort_by(f64::total_cmp);
        }
        self.rows.len() + self.columns.len() > before
    }
}

/// Angles that part a range evenly, with the seams of a closed surface among them.
fn even([from, to]: [f64; 2]) -> Vec<f64> {
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    (-8..=8).map(|i| centre + half * (f64::from(i) / 8.0)).collect()
}

/// Angles whose curves stand for all: even ones, and some of those that were found to matter.
fn probes(range: [f64; 2], found: &[f64]) -> impl Iterator<Item = f64> {
    even(range).into_iter().chain(found.iter().copied().step_by(found.len().div_ceil(8)))
}

fn spans<C: Fn(f64) -> Point>(list: &[f64], curves: &[C]) -> Vec<Span> {
    let span = |ends: [f64; 2]| {
        let [from, to] = ends;
        let chord = |c: &&C| (c(from) - c(to)).norm();
        let longest = curves.iter().max_by(|a, b| chord(a).total_cmp(&chord(b)));
        let middle = 0.5 * (from + to);
        let inner = longest.map_or([middle; 3], |c| quarters(c, from, to));
        Span { ends, inner }
    };
    list.iter().zip(list.iter().skip(1)).map(|(from, to)| span([*from, *to])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;
    use crate::deform::{Bend, Cavity, Deformed, Taper, Twist};
    use crate::numeric::random::Stream;
    use crate::shape::{Implicit, Superellipsoid, Supertoroid};

    /// True when a point of the surface is found within `reach` of the point: by Newton's method, or by a step into one
    /// of 26 directions that changes sides.
    fn is_near(shape: &dyn Implicit, p: &Point, reach: f64) -> bool {
        let mut q = *p;
        for _ in 0..40 {
            let (off, slope) = (shape.gauge(&q) - 1.0, shape.gradient(&q));
            if off.abs() < 1e-12 {
                if (q - p).norm() <= reach {
                    return true;
                }
                break;
            }
            q -= slope * (off / slope.norm_squared());
        }
        let inside = shape.contains(p);
        (0..27).filter(|k| *k != 13).any(|k| {
            let d =
                Vector::new((k % 3) as f64, (k / 3 % 3) as f64, (k / 9) as f64).add_scalar(-1.0);
            let step = d.normalize() * reach;
            (0..16).any(|i| shape.contains(&(p + step * 0.5f64.powi(i))) != inside)
        })
    }

    fn is_good(shape: &(impl Parametric + Implicit), volume: f64, euler: i64, name: &str) {
        let found = tessellate(shape, None).unwrap_or_else(|e| panic!("{name}: {e}"));
        let mesh = &found.mesh;
        assert!(mesh.is_watertight(), "{name}");
        assert_eq!(mesh.euler_characteristic(), euler, "{name}");
        let off = mesh.volume() / volume - 1.0;
        assert!(off.abs() < 1e-3, "{name}: volume off by {off}");
        assert!(found.distance <= found.tolerance);
        let (mut stream, sampler) = (Stream::new(4, 0), mesh.sampler());
        for _ in 0..10_000 {
            let (p, _) = sampler.sample_at(std::array::from_fn(|_| stream.uniform())).unwrap();
            assert!(is_near(shape, &p, found.tolerance), "{name}: {p}");
        }
        if std::env::var("H3").is_ok() {
            eprintln!(
                "{name}: {} v, {off:.1e}, {:.2}",
                mesh.vertices().len(),
                found.distance / found.tolerance
            );
        }
    }

    const EXPONENTS: [f64; 6] = [0.1, 0.3, 1.0, 1.5, 1.9, 2.5];

    /// All pairs of exponents, with their number.
    fn pairs() -> impl Iterator<Item = (usize, [f64; 2])> {
        EXPONENTS.into_iter().flat_map(|e1| EXPONENTS.map(|e2| [e1, e2])).enumerate()
    }

    #[test]
    fn superellipsoids() {
        let axes = [[1.0, 1.0, 1.0], [1.0, 0.7, 0.05], [0.05, 0.05, 1.0], [0.05, 1.0, 0.3]];
        for (i, e) in pairs() {
            let a = axes[(i + i / 6) % 4];
            let shape = Superellipsoid::new(a, e).unwrap();
            is_good(&shape, shape.volume(), 2, &format!("{a:?} {e:?}"));
        }
    }

    #[test]
    fn supertoroids() {
        let axes = [[1.0, 1.0, 1.0], [1.0, 0.7, 0.05], [0.05, 0.05, 1.0], [0.05, 1.0, 0.3]];
        for (i, e) in pairs() {
            let (a, ring) = (axes[(i + i / 6) % 4], [3.0, 1.5, 1.0, 20.0][i % 4]);
            let shape = Supertoroid::new(a, ring, e).unwrap();
            is_good(&shape, shape.volume(), 0, &format!("{a:?} {ring} {e:?}"));
        }
    }

    #[test]
    fn deformed_solids() {
        for e in [[0.1, 0.1], [0.1, 1.0], [1.0, 1.0], [0.5, 1.6], [1.8, 0.3]] {
            let shape = Superellipsoid::new([0.1, 0.2, 0.6], e).unwrap();
            let tapered = Deformed::new(shape, Taper::new([0.6, -0.4], 0.6).unwrap()).unwrap();
            is_good(&tapered, tapered.volume(), 2, &format!("tapered {e:?}"));
            let twisted = Deformed::new(shape, Twist::new(0.4, 0.6).unwrap()).unwrap();
            is_good(&twisted, shape.volume(), 2, &format!("twisted {e:?}"));
            let bent = Deformed::new(shape, Bend::new(2.5, 0.5).unwrap()).unwrap();
            is_good(&bent, shape.volume(), 2, &format!("bent {e:?}"));
        }
        let ring = Supertoroid::new([0.1, 0.1, 0.05], 4.0, [0.6, 1.0]).unwrap();
        let bent = Deformed::new(ring, Bend::new(1.5, 0.5).unwrap()).unwrap();
        is_good(&bent, ring.volume(), 0, "bent ring");
    }

    #[test]
    fn bowls() {
        for e in [[0.1, 1.0], [0.4, 0.3], [1.0, 1.0]] {
            let shape = Superellipsoid::new([0.1, 0.1, 0.05], e).unwrap();
            let bowl = Deformed::new(shape, Cavity::new(1.5, &shape).unwrap()).unwrap();
            // the volume has no closed form: a finer mesh has it
            let fine = tessellate(&bowl, Some(5e-6)).unwrap().mesh;
            is_good(&bowl, fine.volume(), 2, &format!("bowl {e:?}"));
        }
    }

    #[test]
    fn what_cannot_be_meshed_says_why() {
        struct Band(Superellipsoid);
        impl Parametric for Band {
            fn domain(&self) -> [[f64; 2]; 2] {
                [[-0.5, 0.5], self.0.domain()[1]]
            }
            fn point(&self, eta: f64, omega: f64) -> Point {
                self.0.point(eta, omega)
            }
            fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
                self.0.tangents(eta, omega)
            }
            fn normal(&self, eta: f64, omega: f64) -> Option<crate::Direction> {
                self.0.normal(eta, omega)
            }
        }
        let ball = Superellipsoid::new([1.0; 3], [1.0; 2]).unwrap();
        assert_eq!(tessellate(&Band(ball), None), Err(TessellateError::Open));
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(tessellate(&ball, Some(bad)), Err(TessellateError::Tolerance(_))));
        }
        for fine in [1e-300, 1e-12, 3e-9] {
            let found = tessellate(&ball, Some(fine));
            assert!(matches!(found, Err(TessellateError::TooFine { .. })), "{fine}");
        }
        assert!(tessellate(&ball, Some(1e9)).unwrap().mesh.is_watertight());
        for size in [5e-324, 1e-200, 1e-90, 1e90, 1e308] {
            for e in [0.01, 1.0, 10.0] {
                let Ok(shape) = Superellipsoid::new([size, size, 1.0], [e, e]) else { continue };
                let _ = tessellate(&shape, None);
                let shape = Superellipsoid::new([size; 3], [e, e]).unwrap();
                let _ = tessellate(&shape, None);
            }
        }
    }
}
