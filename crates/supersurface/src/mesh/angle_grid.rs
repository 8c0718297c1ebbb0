//! A grid of a surface's two angles, from which the mesh is made.
//!
//! Rows and columns are cut so that chords of meridians and of parallels stay close to their arcs (`chords`); then every cell is compared with the surface at five points between its corners, takes the better
//! of its two diagonals, and its row or column is cut again where it is still too far. Poles are single vertices and
//! seams share theirs, so that the mesh of a closed surface is closed by construction.

use std::collections::BTreeSet;

use super::Mesh;
use super::chords::{cuts, distance_to_triangle, quarters, sagitta};
use crate::Point;
use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::Parametric;

/// Cells beyond which a tolerance is given up.
const MOST_CELLS: usize = 4_000_000;
/// Chords of the mesh on which a tolerance is chosen, as a share of the size: no less.
const COARSEST: f64 = 1e-4;

/// Angles at which a surface is cut into cells, by the parameters of [`QuarterAngle`]: faces of boxes are fine there.
pub(super) struct Grid<'a, S: ?Sized> {
    surface: &'a S,
    /// Ranges of the parameters of both angles.
    domain: [[f64; 2]; 2],
    /// The largest difference of a coordinate, in metres.
    pub(super) size: f64,
    /// Whether the first and the last row are a point each.
    poles: [bool; 2],
    /// Whether the last row is the first again, and the last column.
    joined: [bool; 2],
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
pub(super) struct Further {
    rows: BTreeSet<usize>,
    columns: BTreeSet<usize>,
}

impl<'a, S: Parametric + ?Sized> Grid<'a, S> {
    /// A first grid, if the surface is finite and of some size.
    pub(super) fn new(surface: &'a S) -> Option<Self> {
        let domain = surface.domain().map(|range| range.map(QuarterAngle::parameter));
        let [rows, columns] = domain.map(even);
        let points: Vec<Vec<Point>> =
            rows.iter().map(|e| columns.iter().map(|o| at(surface, *e, *o)).collect()).collect();
        let (first, last) = (points.first()?, points.last()?);
        let centre = first.first()?;
        let size = points.iter().flatten().map(|p| (p - centre).amax()).fold(0.0, f64::max);
        let finite = points.iter().flatten().flat_map(|p| p.iter()).all(|v| v.is_finite());
        if !finite || !(1e-100..1e100).contains(&size) {
            return None;
        }
        let same = |a: &Point, b: &Point| (a - b).amax() <= 1e-9 * size;
        let pole = |row: &[Point]| row.iter().zip(row.iter().skip(1)).all(|(a, b)| same(a, b));
        let joined = [
            first.iter().zip(last).all(|(a, b)| same(a, b)),
            points.iter().all(|r| r.first().zip(r.last()).is_some_and(|(a, b)| same(a, b))),
        ];
        // a ring whose hole has closed to a point is still a ring
        let poles = [first, last].map(|row| !joined[0] && pole(row));
        Some(Self { surface, domain, size, poles, joined, rows, columns })
    }

    /// True when the surface has no border.
    pub(super) fn is_closed(&self) -> bool {
        self.joined[1] && (self.joined[0] || self.poles == [true; 2])
    }

    fn parallel(&self, eta: f64) -> impl Fn(f64) -> Point + use<'a, S> {
        let surface = self.surface;
        move |omega| at(surface, eta, omega)
    }

    fn meridian(&self, omega: f64) -> impl Fn(f64) -> Point + use<'a, S> {
        let surface = self.surface;
        move |eta| at(surface, eta, omega)
    }

    /// Chooses columns and rows by the chords of some parallels and meridians, which stay within these distances of
    /// their arcs: those of meridians first.
    pub(super) fn cut(&mut self, [along, around]: [f64; 2]) {
        let [eta, omega] = self.domain;
        let parallels: Vec<_> = probes(eta, &self.rows).map(|t| self.parallel(t)).collect();
        self.columns = cuts(&parallels, omega, around);
        let meridians: Vec<_> = probes(omega, &self.columns).map(|t| self.meridian(t)).collect();
        self.rows = cuts(&meridians, eta, along);
    }

    /// Distances of chords for which the volume is right to a thousandth: 0.9 thousandths of volume over area, since
    /// chords cut off less than their largest distance times the area; and up to 16 times as much in a direction where
    /// that changes the volume by a ten thousandth at most (the circles of a thin disc).
    pub(super) fn default_chords(&mut self) -> [f64; 2] {
        let ratio = |[volume, area]: [f64; 2]| volume.abs() / area;
        let first = ratio(self.volume_and_area());
        self.cut([(0.05 * first).max(COARSEST * self.size); 2]);
        let least = 0.9e-3 * ratio(self.volume_and_area());
        let mut volume = |looser: [f64; 2]| {
            self.cut(looser.map(|k| k * least));
            (!self.is_too_fine()).then(|| self.volume_and_area()[0])
        };
        let mut looser = [1.0; 2];
        if let Some(fine) = volume(looser) {
            for direction in 0..2 {
                let enough = [16.0, 4.0].into_iter().find(|k| {
                    let mut tried = [1.0; 2];
                    tried[direction] = *k;
                    volume(tried).is_some_and(|v| (v - fine).abs() <= 1e-4 * fine.abs())
                });
                looser[direction] = enough.unwrap_or(1.0);
            }
        }
        looser.map(|k| k * least)
    }

    /// Volume and area of the mesh, the mean of both diagonals.
    fn volume_and_area(&self) -> [f64; 2] {
        let (vertices, numbers) = self.vertices();
        let width = self.columns.len();
        let cells = numbers.windows(width + 2).enumerate().filter(|(k, _)| (k + 1) % width != 0);
        let triangles = cells.flat_map(|(_, w)| {
            let [a, b, d, c] = [w[0], w[1], w[width], w[width + 1]];
            [[a, b, c], [a, c, d], [a, b, d], [b, c, d]]
        });
        let mesh = Mesh::from_checked(vertices, triangles.collect());
        [0.5 * mesh.volume(), 0.5 * mesh.area()]
    }

    /// True when the mesh would have too many cells.
    pub(super) fn is_too_fine(&self) -> bool {
        self.rows.len() * self.columns.len() > MOST_CELLS
    }

    /// The spans of rows and of columns; the inner angles quarter the longest of some chords.
    fn spans(&self) -> [Vec<Span>; 2] {
        let [eta, omega] = self.domain;
        let meridians: Vec<_> = even(omega).into_iter().map(|t| self.meridian(t)).collect();
        let parallels: Vec<_> = even(eta).into_iter().map(|t| self.parallel(t)).collect();
        [spans(&self.rows, &meridians), spans(&self.columns, &parallels)]
    }

    /// The mesh, the largest distance found, and what to cut where it is more than `allowed`.
    pub(super) fn mesh(&self, allowed: f64) -> (Mesh, f64, Further) {
        let [rows, columns] = self.spans();
        let (height, width) = (rows.len(), columns.len());
        let (vertices, numbers) = self.vertices();
        let number =
            |[i, j]: [usize; 2]| numbers.get(i * (width + 1) + j).copied().unwrap_or_default();
        let mut triangles = Vec::with_capacity(2 * height * width);
        let (mut farthest, mut further) = (0.0f64, Further::default());
        for (i, row) in rows.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                let corners = [[i, j], [i, j + 1], [i + 1, j + 1], [i + 1, j]];
                let corners = corners.map(number);
                let (cell, distance) = self.cell(corners, &vertices, row, column);
                // at a pole one of both has a corner twice
                let proper = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
                triangles.extend(cell.into_iter().filter(proper));
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

    /// The vertices, and their numbers at all crossings of rows and columns.
    fn vertices(&self) -> (Vec<Point>, Vec<u32>) {
        let (height, width) = (self.rows.len() - 1, self.columns.len() - 1);
        let (mut vertices, mut numbers) = (Vec::new(), Vec::<u32>::new());
        for (i, eta) in self.rows.iter().enumerate() {
            let pole = (i == 0 && self.poles[0]) || (i == height && self.poles[1]);
            for (j, omega) in self.columns.iter().enumerate() {
                let twin = match j > 0 && (pole || (self.joined[1] && j == width)) {
                    true => Some(i * (width + 1)),
                    false if self.joined[0] && i == height => Some(j),
                    false => None,
                };
                let known = twin.and_then(|at| numbers.get(at).copied());
                numbers.push(known.unwrap_or(vertices.len() as u32));
                if known.is_none() {
                    vertices.push(at(self.surface, *eta, *omega));
                }
            }
        }
        (vertices, numbers)
    }

    /// True when `∂/∂ω × ∂/∂η`, where triangles face, is inside at most places.
    pub(super) fn faces_inwards(&self) -> bool {
        let [eta, omega] = self.surface.domain();
        // away from seams, where there may be no tangents
        let shifted = |[from, to]: [f64; 2]| {
            (0..8).map(move |i| from + (to - from) * (f64::from(i) + 0.4) / 8.0)
        };
        let vote = |(eta, omega): (f64, f64)| {
            let ([along, around], normal) =
                (self.surface.tangents(eta, omega)?, self.surface.normal(eta, omega)?);
            Some(if around.cross(&along).dot(&normal) < 0.0 { 1 } else { -1 })
        };
        let places = shifted(eta).flat_map(|e| shifted(omega).map(move |o| (e, o)));
        places.filter_map(vote).sum::<i32>() > 0
    }

    /// The triangles of a cell, with the better diagonal, and the largest distance of five points of the surface
    /// from them.
    fn cell(
        &self,
        [a, b, c, d]: [u32; 4],
        vertices: &[Point],
        row: &Span,
        column: &Span,
    ) -> ([[u32; 3]; 2], f64) {
        let ([e0, e1, e2], [o0, o1, o2]) = (row.inner, column.inner);
        let points = [(e1, o1), (e0, o0), (e0, o2), (e2, o0), (e2, o2)]
            .map(|(eta, omega)| at(self.surface, eta, omega));
        let vertex = |k: u32| vertices.get(k as usize).copied().unwrap_or_default();
        let judged = |triangles: [[u32; 3]; 2]| {
            let [one, other] = triangles.map(|t| t.map(vertex));
            let off =
                |p: &Point| distance_to_triangle(p, &one).min(distance_to_triangle(p, &other));
            (triangles, points.iter().map(off).fold(0.0, f64::max))
        };
        let (straight, crossed) = (judged([[a, b, c], [a, c, d]]), judged([[a, b, d], [b, c, d]]));
        if crossed.1 < straight.1 { crossed } else { straight }
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
    pub(super) fn refine(&mut self, further: &Further) -> bool {
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

/// The point at two parameters.
fn at<S: Parametric + ?Sized>(surface: &S, eta: f64, omega: f64) -> Point {
    let [eta, omega] = [eta, omega].map(QuarterAngle::from_parameter);
    surface.point_at(eta, omega)
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
