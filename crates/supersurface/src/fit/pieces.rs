//! Which points hang together: what is left of a cloud without stray points and without what lies beside the object.
//!
//! Clusters by density (DBSCAN): a point with enough neighbours within a radius joins them to its piece. The radius is
//! tied to the cloud's own spacing.

use super::neighbours::Neighbours;
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
    let mut neighbours = Neighbours::among(points);
    let radius = REACH * spacing(points, &mut neighbours);
    if !(radius > 0.0 && radius.is_finite()) {
        return whole();
    }
    let (mut piece, mut sizes) = (vec![usize::MAX; points.len()], Vec::new());
    let mut open = Vec::new();
    for i in 0..points.len() {
        if piece[i] != usize::MAX {
            continue;
        }
        let mut size = 0;
        open.push(i);
        while let Some(at) = open.pop() {
            let found = neighbours.within(&points[at], radius * radius);
            // the point itself is among them
            if found.len() <= NEIGHBOURS {
                continue;
            }
            for j in found.iter().map(|near| near.place()) {
                if piece[j] == usize::MAX {
                    piece[j] = sizes.len();
                    size += 1;
                    open.push(j);
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
fn spacing(points: &[Vector], neighbours: &mut Neighbours) -> f64 {
    let stride = points.len().div_ceil(MEASURED).max(1);
    // the point itself is the first
    let mut sixth =
        |p| neighbours.nearest(p, NEIGHBOURS + 2).last().map_or(0.0, |n| n.square().sqrt());
    let mut all: Vec<f64> = points.iter().step_by(stride).map(&mut sixth).collect();
    quantile(&mut all, 0.5)
}
