//! Which points hang together?
//!
//! On an organised cloud neighbours are pixels: two belong together when their distance is within the
//! gap plus a few pixels' width at their range, so that a depth jump parts them. Pixels without a
//! reading are bridged over a short way; pixels that show something else never. Other clouds are
//! clustered in cubes whose side follows the spacing of the points.

use crate::Point;
use crate::cloud::{PointCloud, Sets, VoxelGrid};
use crate::segment::class::Class;
use crate::segment::sight::{Sight, grid};

/// Pixels without reading that are bridged, and widths of a pixel added to the gap.
const BRIDGE: usize = 4;
const PIXELS: f64 = 4.0;

/// The pieces of the points that are `Above`, each in ascending order, those under `least` points
/// left out. `gap` is in metres.
pub(crate) fn pieces(
    cloud: &PointCloud,
    class: &[Class],
    sight: &Sight,
    gap: f64,
    least: usize,
) -> Vec<Vec<u32>> {
    match (grid(cloud), sight.pixel, sight.eye) {
        (Some([w, _]), Some(pixel), Some(eye)) => {
            let near = |a: &Point, b: &Point| {
                let square = (a - b).norm_squared();
                // most are nearer than what needs no range
                square <= gap * gap || {
                    let range = (a - eye).norm().max((b - eye).norm());
                    let reach = gap + PIXELS * pixel * range;
                    square <= reach * reach
                }
            };
            on_grid(&cloud.points, class, w, least, near)
        }
        _ => in_space(&cloud.points, class, gap, least),
    }
}

fn on_grid(
    points: &[Point],
    class: &[Class],
    width: usize,
    least: usize,
    near: impl Fn(&Point, &Point) -> bool,
) -> Vec<Vec<u32>> {
    let above: Vec<usize> = (0..class.len()).filter(|i| class[*i] == Class::Above).collect();
    let mut sets = Sets::new(class.len());
    // most pairs are known to hang together already
    let mut join = |i: usize, j: usize| {
        if !sets.seem_one(i, j) && near(&points[i], &points[j]) {
            sets.join(i, j);
        }
    };
    for &i in &above {
        let column = i % width;
        // Forwards along the row, and down; the two diagonals only directly.
        for (step, room) in [(1, width - 1 - column), (width, usize::MAX)] {
            for k in 1..=room.min(1 + BRIDGE) {
                let j = i + k * step;
                match class.get(j) {
                    Some(Class::Missing) => continue,
                    Some(Class::Above) => join(i, j),
                    _ => {}
                }
                break;
            }
        }
        let left = (column > 0).then(|| i + width - 1);
        let right = (column + 1 < width).then_some(i + width + 1);
        for j in [left, right].into_iter().flatten() {
            if class.get(j) == Some(&Class::Above) {
                join(i, j);
            }
        }
    }
    let mut sizes = vec![0u32; class.len()];
    for i in &above {
        sizes[sets.root(*i)] += 1;
    }
    // A root is the smallest of its set, so it is met first: its size gives way to its place.
    let mut pieces: Vec<Vec<u32>> = Vec::new();
    for i in above {
        let root = sets.root(i);
        if root == i {
            let size = sizes[i] as usize;
            sizes[i] = u32::MAX;
            if size >= least {
                sizes[i] = pieces.len() as u32;
                pieces.push(Vec::with_capacity(size));
            }
        }
        if let Some(piece) = pieces.get_mut(sizes[root] as usize) {
            piece.push(i as u32);
        }
    }
    pieces
}

fn in_space(points: &[Point], class: &[Class], gap: f64, least: usize) -> Vec<Vec<u32>> {
    let above: Vec<u32> =
        (0..class.len() as u32).filter(|i| class[*i as usize] == Class::Above).collect();
    let cell = gap.max(1.8 * spacing(points, &above));
    let Some(grid) = VoxelGrid::new(points, above, cell) else { return Vec::new() };
    let mut pieces = grid.components();
    pieces.retain(|p| p.len() >= least);
    pieces
}

/// Typical distance from a point to its nearest neighbour, in metres; 0 for fewer than two points.
fn spacing(points: &[Point], indices: &[u32]) -> f64 {
    let point = |i: &u32| points[*i as usize];
    let nearest = |i: &u32| {
        let others = indices.iter().filter(|j| *j != i);
        others.map(|j| (point(j) - point(i)).norm_squared()).fold(f64::INFINITY, f64::min)
    };
    let step = (indices.len() / 64).max(1);
    let mut distances: Vec<f64> = indices.iter().step_by(step).map(nearest).collect();
    if distances.is_empty() {
        return 0.0;
    }
    let middle = distances.len() / 2;
    let squared = *distances.select_nth_unstable_by(middle, f64::total_cmp).1;
    if squared.is_finite() { squared.sqrt() } else { 0.0 }
}
