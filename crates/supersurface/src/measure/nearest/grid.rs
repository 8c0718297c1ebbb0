//! Samples of a parametric surface, about evenly far apart, and a search among the angles without derivatives.
//!
//! Even steps of the angles are far from even steps on the surface (a cube of ε = 0.1 has its faces within 1e-5 of a
//! multiple of π/2), so that the nodes of each angle are placed by halving the longest gap on the surface.

use std::fmt;

use super::simplex::lowest;
use crate::Point;
use crate::shape::Parametric;

/// Nodes along each angle less one.
const GAPS: usize = 40;
/// Sections of the surface on which gaps are measured.
const SECTIONS: [f64; 6] = [0.03, 0.2, 0.39, 0.58, 0.79, 0.96];

/// A grid over the domain of a surface.
pub(super) struct Grid<'a> {
    surface: &'a dyn Parametric,
    nodes: [Vec<f64>; 2],
    /// Row by row, one row for each node of eta.
    points: Vec<Point>,
}

impl fmt::Debug for Grid<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Grid").field("nodes", &self.nodes).finish_non_exhaustive()
    }
}

impl<'a> Grid<'a> {
    pub(super) fn new(surface: &'a dyn Parametric) -> Self {
        let [eta, omega] = surface.domain();
        let inside = |[from, to]: [f64; 2], share: f64| from + (to - from) * share;
        let nodes = [
            spread(eta, |e, share| surface.point(e, inside(omega, share))),
            spread(omega, |o, share| surface.point(inside(eta, share), o)),
        ];
        let [rows, columns] = &nodes;
        let points =
            rows.iter().flat_map(|e| columns.iter().map(|o| surface.point(*e, *o))).collect();
        Self { surface, nodes, points }
    }

    /// The places (row, column) of the samples that are nearer to `p` than their neighbours, nearest first.
    fn valley_places(&self, p: &Point) -> Vec<(f64, [usize; 2])> {
        let [rows, columns] = [0, 1].map(|k: usize| self.nodes[k].len());
        let squared: Vec<f64> = self.points.iter().map(|q| (q - p).norm_squared()).collect();
        let at = |i: usize, j: usize| squared.get(i * columns + j).copied().unwrap_or(f64::NAN);
        let mut found = Vec::new();
        for i in 0..rows {
            for j in 0..columns {
                let own = at(i, j);
                let around = (i.saturating_sub(1)..=i + 1)
                    .flat_map(|a| (j.saturating_sub(1)..=j + 1).map(move |b| (a, b)));
                // equal neighbours (poles, closed seams) count once
                let lowest = around.filter(|(a, b)| *a < rows && *b < columns).all(|(a, b)| {
                    let other = at(a, b);
                    own < other || own == other && (i, j) <= (a, b)
                });
                if lowest {
                    found.push((own, [i, j]));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    /// The samples that are nearer to `p` than their neighbours, nearest first.
    pub(super) fn valleys(&self, p: &Point) -> Vec<Point> {
        let columns = self.nodes[1].len();
        let places = self.valley_places(p);
        places.iter().filter_map(|(_, [i, j])| self.points.get(i * columns + j).copied()).collect()
    }

    /// The point of the patch nearest to `p` and its angles, from the best valleys.
    pub(super) fn narrow(&self, p: &Point) -> (Point, [f64; 2]) {
        let mut best = (f64::INFINITY, [0.0; 2]);
        for (_, place) in self.valley_places(p).into_iter().take(4) {
            let found = lowest(|at| self.squared(at, p), place.map(|k| k as f64), 0.4, 1e-12);
            if found.0 < best.0 {
                best = found;
            }
        }
        let angles = self.angles(best.1);
        (self.surface.point(angles[0], angles[1]), angles)
    }

    fn squared(&self, place: [f64; 2], p: &Point) -> f64 {
        let [eta, omega] = self.angles(place);
        (self.surface.point(eta, omega) - p).norm_squared()
    }

    /// The angles at a place between nodes, or at the nearest end.
    fn angles(&self, [row, column]: [f64; 2]) -> [f64; 2] {
        [self.angle(0, row), self.angle(1, column)]
    }

    fn angle(&self, which: usize, place: f64) -> f64 {
        let nodes = &self.nodes[which];
        let place = place.clamp(0.0, nodes.len().saturating_sub(1) as f64);
        let below = (place as usize).min(nodes.len().saturating_sub(2));
        match (nodes.get(below), nodes.get(below + 1)) {
            (Some(a), Some(b)) => a + (b - a) * (place - below as f64),
            _ => nodes.first().copied().unwrap_or(0.0),
        }
    }
}

/// Nodes of one angle: its eighths, then the middle of whatever interval is longest on the surface.
fn spread([from, to]: [f64; 2], at: impl Fn(f64, f64) -> Point) -> Vec<f64> {
    let gap = |a: f64, b: f64| {
        let lengths = SECTIONS.map(|share| (at(b, share) - at(a, share)).norm());
        lengths.into_iter().filter(|l| l.is_finite()).fold(0.0, f64::max)
    };
    let mut nodes: Vec<f64> = (0..=8).map(|k| from + (to - from) * (f64::from(k) / 8.0)).collect();
    let mut gaps: Vec<f64> = nodes.windows(2).map(|w| gap(w[0], w[1])).collect();
    while nodes.len() <= GAPS {
        let longest = gaps.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let Some(k) = longest.map(|(k, _)| k) else { break };
        let [a, b] = [nodes[k], nodes[k + 1]];
        let middle = 0.5 * (a + b);
        if !(middle > a && middle < b) {
            // neighbouring numbers: what lies between cannot be said in an angle
            gaps[k] = 0.0;
            if gaps.iter().all(|g| *g == 0.0) {
                break;
            }
            continue;
        }
        nodes.insert(k + 1, middle);
        gaps.splice(k..=k, [gap(a, middle), gap(middle, b)]);
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;
    use crate::shape::Superellipsoid;

    #[test]
    fn nodes_are_even_on_the_faces_of_a_cube() {
        let cube = Superellipsoid::new([1.0; 3], [0.1, 0.1]).unwrap();
        let grid = Grid::new(&cube);
        assert_eq!(grid.points.len(), (GAPS + 1) * (GAPS + 1));
        // a sample near every point of a face
        for (y, z) in [(0.0, 0.0), (0.5, 0.5), (-0.7, 0.2), (0.1, -0.9)] {
            let q = Point::new(1.0, y, z);
            let nearest = grid.points.iter().map(|p| (p - q).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.3, "{q}: {nearest}");
        }
        let (found, _) = grid.narrow(&Point::new(3.0, 0.3, -0.4));
        assert!((found - Vector::new(1.0, 0.3, -0.4)).coords.norm() < 1e-2, "{found}");
    }
}
