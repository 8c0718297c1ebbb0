//! Which points hang together: what is left of a cloud without stray points and without what lies beside the object.
//!
//! Clusters by density (DBSCAN): a point with enough neighbours within a radius joins them to its piece. The radius is
//! tied to the cloud's own spacing.

use std::collections::HashMap;

use super::start::quantile;
use crate::Vector;

/// Neighbours within the radius that make a point part of a surface.
const NEIGHBOURS: usize = 5;
/// Points by which the spacing is measured, and the radius in these spacings.
const MEASURED: usize = 64;
const REACH: f64 = 1.5;

/// What hangs together in a cloud.
pub(super) struct Pieces {
    /// Places of the points of the largest piece; of all where none hangs together.
    pub(super) largest: Vec<usize>,
    /// Those of all pieces that are no crumbs.
    pub(super) coherent: Vec<usize>,
}

/// Share of the points below which a piece is a crumb.
const CRUMB: f64 = 0.02;

/// The pieces of a cloud.
pub(super) fn pieces(points: &[Vector]) -> Pieces {
    let all = || (0..points.len()).collect();
    let whole = || Pieces { largest: all(), coherent: all() };
    let radius = REACH * spacing(points);
    if !(radius > 0.0 && radius.is_finite()) {
        return whole();
    }
    let cell = |p: &Vector| [0, 1, 2].map(|k| (p[k] / radius).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (p, i) in points.iter().zip(0..) {
        cells.entry(cell(p)).or_default().push(i);
    }
    let near = |i: usize, found: &mut Vec<usize>| {
        let [x, y, z] = cell(&points[i]);
        found.clear();
        for (dx, dy, dz) in (0..27).map(|c| (c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1)) {
            let there = cells.get(&[x + dx, y + dy, z + dz]).into_iter().flatten();
            let there = there.map(|j| *j as usize);
            found.extend(
                there.filter(|j| (points[*j] - points[i]).norm_squared() < radius * radius),
            );
        }
    };
    let (mut piece, mut sizes) = (vec![usize::MAX; points.len()], Vec::new());
    let (mut open, mut found) = (Vec::new(), Vec::new());
    for i in 0..points.len() {
        if piece[i] != usize::MAX {
            continue;
        }
        let mut size = 0;
        open.push(i);
        while let Some(at) = open.pop() {
            near(at, &mut found);
            // the point itself is among them
            if found.len() <= NEIGHBOURS {
                continue;
            }
            for j in &found {
                if piece[*j] == usize::MAX {
                    piece[*j] = sizes.len();
                    size += 1;
                    open.push(*j);
                }
            }
        }
        sizes.push(size);
    }
    let Some(largest) = (0..sizes.len()).max_by_key(|k| sizes[*k]).filter(|k| sizes[*k] > 0) else {
        return whole();
    };
    let of =
        |wanted: &dyn Fn(usize) -> bool| (0..points.len()).filter(|i| wanted(piece[*i])).collect();
    let crumb = (CRUMB * points.len() as f64) as usize;
    Pieces {
        largest: of(&|p| p == largest),
        coherent: of(&|p| sizes.get(p).is_some_and(|s| *s > crumb)),
    }
}

/// Median distance of the sixth neighbour.
fn spacing(points: &[Vector]) -> f64 {
    let mut squares = Vec::with_capacity(points.len());
    let stride = points.len().div_ceil(MEASURED).max(1);
    let mut all: Vec<f64> = points
        .iter()
        .step_by(stride)
        .map(|p| {
            squares.clear();
            squares.extend(points.iter().map(|q| (p - q).norm_squared()));
            let k = (NEIGHBOURS + 1).min(squares.len() - 1);
            squares.select_nth_unstable_by(k, f64::total_cmp).1.sqrt()
        })
        .collect();
    quantile(&mut all, 0.5)
}
