//! Which points are near: a voxel grid held as one sorted list.
//!
//! Point p lies in the cube with key floor(p / cell), taken by component. The points are sorted by
//! their keys, so that a cube's points are one slice of the list and finding it is a binary search over the
//! occupied cubes: no hashing, no allocation after the build, and the same order on every machine. Keys of
//! absurd coordinates saturate instead of overflowing; distances are always checked on the points.

use crate::Point;
use crate::cloud::Sets;

/// Points of a cloud sorted into cubes of one size.
///
/// ```
/// use supersurface::{Point, cloud::VoxelGrid};
/// let points = [Point::new(0.0, 0.0, 0.0), Point::new(0.009, 0.0, 0.0), Point::new(0.5, 0.0, 0.0)];
/// let grid = VoxelGrid::new(&points, 0..3, 0.01).unwrap();
/// assert_eq!(grid.components(), [vec![0, 1], vec![2]]);
/// ```
#[derive(Clone, Debug)]
pub struct VoxelGrid<'a> {
    points: &'a [Point],
    cell: f64,
    /// Indices of the points, cube after cube, rising within each.
    entries: Vec<u32>,
    /// Keys of the cubes that are occupied, rising.
    cubes: Vec<u128>,
    /// First entry of each of them, and the number of entries at the end.
    starts: Vec<u32>,
}

/// Cubes along each axis: about 2e12 to either side of the origin.
const BITS: u32 = 42;
const SIDE: i64 = 1 << BITS;

/// The coordinates of a cube from 0, and the number whose order is theirs.
type Cube = [i64; 3];

fn pack(cube: Cube) -> u128 {
    cube.iter().fold(0, |key, c| key << BITS | (*c).clamp(0, SIDE - 1) as u128)
}

fn unpack(key: u128) -> Cube {
    [2, 1, 0].map(|k| (key >> (k * BITS)) as i64 & (SIDE - 1))
}

impl<'a> VoxelGrid<'a> {
    /// Sorts the points named by `indices` into cubes of side `cell` (metres). Points that are not
    /// finite, and indices beyond the points, are left out. `None` unless `cell` is positive and
    /// finite.
    pub fn new(
        points: &'a [Point],
        indices: impl IntoIterator<Item = u32>,
        cell: f64,
    ) -> Option<Self> {
        if !(cell > 0.0 && cell.is_finite()) {
            return None;
        }
        // points that follow each other often lie in one cube: such runs are sorted, not points
        let (mut named, mut runs): (Vec<u32>, Vec<(Cube, u32)>) = (Vec::new(), Vec::new());
        let mut rising = true;
        for i in indices {
            let Some(p) = points.get(i as usize) else { continue };
            if !p.coords.iter().all(|c| c.is_finite()) {
                continue;
            }
            let cube = cube(p, cell);
            if runs.last().is_none_or(|(last, _)| *last != cube) {
                runs.push((cube, named.len() as u32));
            }
            rising &= named.last().is_none_or(|last| *last < i);
            named.push(i);
        }
        let (mut cubes, mut starts) = (Vec::new(), Vec::new());
        let mut entries = Vec::with_capacity(named.len());
        for k in in_order(&runs) {
            let (from, key) = (runs[k].1, pack(runs[k].0));
            if cubes.last() != Some(&key) {
                cubes.push(key);
                starts.push(entries.len() as u32);
            }
            let to = runs.get(k + 1).map_or(named.len(), |next| next.1 as usize);
            entries.extend_from_slice(&named[from as usize..to]);
        }
        starts.push(entries.len() as u32);
        if !rising {
            starts.windows(2).for_each(|s| entries[s[0] as usize..s[1] as usize].sort_unstable());
        }
        Some(Self { points, cell, entries, cubes, starts })
    }

    /// Number of cubes that hold a point.
    pub fn occupied(&self) -> usize {
        self.cubes.len()
    }

    /// One point of each occupied cube (the one with the smallest index), in the order of the cubes.
    pub fn representatives(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.occupied()).map(|c| self.members(c)[0])
    }

    /// Calls `visit(index, squared distance)` for every point within `radius` of `p`, in a fixed
    /// order. Meant for radii of at most a few cells: it visits (2 radius / cell + 1)^3 cubes.
    pub fn within(&self, p: &Point, radius: f64, mut visit: impl FnMut(u32, f64)) {
        let finite = p.coords.iter().all(|c| c.is_finite()) && radius >= 0.0;
        let reach = (radius / self.cell).ceil();
        if !finite || reach.is_nan() || reach > 64.0 {
            return;
        }
        let ([x, y, z], reach) = (cube(p, self.cell), reach as i64);
        let inside = |v: i64| (v - reach).max(0)..=(v + reach).min(SIDE - 1);
        for x in inside(x) {
            for y in inside(y) {
                // The cubes of a column along z are neighbours in the list: one search for all.
                let (first, last) = (pack([x, y, z - reach]), pack([x, y, z + reach]));
                let start = self.cubes.partition_point(|c| *c < first);
                let count = self.cubes[start..].iter().take_while(|c| **c <= last).count();
                let [from, to] = [start, start + count].map(|c| self.starts[c] as usize);
                for i in &self.entries[from..to] {
                    let d = (self.points[*i as usize] - p).norm_squared();
                    if d <= radius * radius {
                        visit(*i, d);
                    }
                }
            }
        }
    }

    /// Calls `visit(members, around)` for every cube with the points in it and those in it and in the 26 about it, both in
    /// the order of the cubes: for all points at once, which [`VoxelGrid::within`] looks up one by one.
    pub fn neighbourhoods(&self, mut visit: impl FnMut(&[u32], &[u32])) {
        let steps = [-1i64, 0, 1];
        let columns: Vec<[i64; 2]> = steps.iter().flat_map(|x| steps.map(|y| [*x, y])).collect();
        // each of the nine columns is followed by a cursor that only moves forwards
        let mut cursors = vec![0usize; columns.len()];
        let mut around = Vec::new();
        for c in 0..self.occupied() {
            let [x, y, z] = unpack(self.cubes[c]);
            around.clear();
            for (cursor, [dx, dy]) in cursors.iter_mut().zip(&columns) {
                let (x, y) = (x + dx, y + dy);
                if [x, y].iter().any(|v| !(0..SIDE).contains(v)) {
                    continue;
                }
                let (first, last) = (pack([x, y, z - 1]), pack([x, y, z + 1]));
                while *cursor < self.cubes.len() && self.cubes[*cursor] < first {
                    *cursor += 1;
                }
                let ahead = self.cubes[*cursor..].iter().take_while(|cube| **cube <= last).count();
                let [from, to] = [*cursor, *cursor + ahead].map(|c| self.starts[c] as usize);
                around.extend_from_slice(&self.entries[from..to]);
            }
            visit(self.members(c), &around);
        }
    }

    /// Clusters: cubes that share a face, an edge or a corner belong together. Points nearer than
    /// the cell are never parted, and points farther than 2 sqrt(3) cells are never joined directly.
    /// The clusters are in the order of their smallest index, the indices in ascending order.
    pub fn components(&self) -> Vec<Vec<u32>> {
        let n = self.occupied();
        let mut sets = Sets::new(n);
        let mut columns = [0usize; 4];
        for c in 0..n {
            let [x, y, z] = unpack(self.cubes[c]);
            // Half of the 26 neighbours; the others see this cube from their side. Each of the four
            // columns ahead is followed by a cursor that only moves forwards.
            if z + 1 < SIDE && self.cubes.get(c + 1) == Some(&(self.cubes[c] + 1)) {
                sets.join(c, c + 1);
            }
            for (cursor, (dx, dy)) in columns.iter_mut().zip([(0, 1), (1, -1), (1, 0), (1, 1)]) {
                let (first, last) = (pack([x + dx, y + dy, z - 1]), pack([x + dx, y + dy, z + 1]));
                while *cursor < n && self.cubes[*cursor] < first {
                    *cursor += 1;
                }
                let ahead = (*cursor..n).take_while(|d| self.cubes[*d] <= last);
                ahead.for_each(|d| sets.join(c, d));
            }
        }
        let mut place = vec![u32::MAX; n];
        let mut clusters: Vec<Vec<u32>> = Vec::new();
        for c in 0..n {
            let root = sets.root(c);
            if place[root] == u32::MAX {
                place[root] = clusters.len() as u32;
                clusters.push(Vec::new());
            }
            clusters[place[root] as usize].extend(self.members(c));
        }
        clusters.iter_mut().for_each(|c| c.sort_unstable());
        clusters.sort_unstable_by_key(|c| c[0]);
        clusters
    }

    /// The points of the c-th occupied cube.
    pub fn members(&self, c: usize) -> &[u32] {
        &self.entries[self.starts[c] as usize..self.starts[c + 1] as usize]
    }
}

/// The places of runs of points in the order of their cubes, and of the points within each.
fn in_order(runs: &[(Cube, u32)]) -> Vec<usize> {
    let ends = |k: usize, end: fn(i64, i64) -> i64| runs.iter().map(|r| r.0[k]).reduce(end);
    let [low, high] = [i64::min, i64::max].map(|end| [0, 1, 2].map(|k| ends(k, end).unwrap_or(0)));
    let bits = |span: usize| usize::BITS - span.leading_zeros();
    let widths = [0, 1, 2].map(|k| bits((high[k] - low[k]) as usize));
    let place = bits(runs.len());
    // short numbers are sorted fast
    if widths.iter().sum::<u32>() + place <= u64::BITS {
        let number = |cube: &Cube, at: usize| {
            let key = (0..3).fold(0, |key, k| key << widths[k] | (cube[k] - low[k]) as u64);
            key << place | at as u64
        };
        let mut numbers: Vec<u64> =
            runs.iter().zip(0..).map(|((c, _), at)| number(c, at)).collect();
        numbers.sort_unstable();
        return numbers.iter().map(|n| (n & ((1 << place) - 1)) as usize).collect();
    }
    let mut order: Vec<usize> = (0..runs.len()).collect();
    order.sort_by_key(|k| runs[*k].0);
    order
}

fn cube(p: &Point, cell: f64) -> Cube {
    // `as` saturates, so that no coordinate overflows.
    let place = |x: f64| {
        let (x, whole) = (x / cell, (x / cell) as i64);
        let floor = whole.saturating_sub(i64::from(whole as f64 > x));
        floor.saturating_add(SIDE / 2).clamp(0, SIDE - 1)
    };
    [place(p.x), place(p.y), place(p.z)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn finds_what_brute_force_finds() {
        let mut random = Stream::new(3, 0);
        let points: Vec<Point> =
            (0..500).map(|_| Point::from([0; 3].map(|_| random.between(-0.1, 0.1)))).collect();
        let grid = VoxelGrid::new(&points, 0..500, 0.02).unwrap();
        for p in points.iter().take(50) {
            let mut found = Vec::new();
            grid.within(p, 0.03, |i, _| found.push(i));
            found.sort_unstable();
            let near = |i: &u32| (points[*i as usize] - p).norm() <= 0.03;
            assert_eq!(found, (0..500).filter(near).collect::<Vec<u32>>());
        }
    }

    #[test]
    fn neighbourhoods_are_those_of_single_points() {
        let mut random = Stream::new(4, 0);
        let points: Vec<Point> =
            (0..500).map(|_| Point::from([0; 3].map(|_| random.between(-0.1, 0.1)))).collect();
        let grid = VoxelGrid::new(&points, 0..500, 0.03).unwrap();
        let mut seen = 0;
        grid.neighbourhoods(|members, around| {
            for i in members {
                seen += 1;
                let p = points[*i as usize];
                let mut found = Vec::new();
                grid.within(&p, 0.03, |j, _| found.push(j));
                let near = |j: &u32| (points[*j as usize] - p).norm_squared() <= 0.03 * 0.03;
                assert_eq!(found, around.iter().copied().filter(near).collect::<Vec<u32>>());
            }
        });
        assert_eq!(seen, 500);
    }

    #[test]
    fn the_order_of_the_indices_does_not_matter() {
        let mut random = Stream::new(6, 0);
        let points: Vec<Point> =
            (0..300).map(|_| Point::from([0; 3].map(|_| random.between(-0.1, 0.1)))).collect();
        let sorted = VoxelGrid::new(&points, 0..300, 0.05).unwrap();
        let mixed = VoxelGrid::new(&points, (0..300).map(|i| i * 7 % 300), 0.05).unwrap();
        assert_eq!((&sorted.cubes, &sorted.starts), (&mixed.cubes, &mixed.starts));
        assert_eq!(sorted.entries, mixed.entries);
    }

    #[test]
    fn components_are_those_of_all_pairs_of_cubes() {
        let mut random = Stream::new(5, 0);
        let points: Vec<Point> =
            (0..300).map(|_| Point::from([0; 3].map(|_| random.between(-0.5, 0.5)))).collect();
        let grid = VoxelGrid::new(&points, 0..300, 0.08).unwrap();
        let mut sets = Sets::new(300);
        for (i, p) in points.iter().enumerate() {
            for (j, q) in points.iter().enumerate() {
                let (a, b) = (cube(p, 0.08), cube(q, 0.08));
                if (0..3).all(|k| (a[k] - b[k]).abs() <= 1) {
                    sets.join(i, j);
                }
            }
        }
        let mut expected: Vec<Vec<u32>> = Vec::new();
        for i in 0..300 {
            let root = sets.root(i) as u32;
            match expected.iter_mut().find(|c| c[0] == root) {
                Some(c) => c.push(i as u32),
                None => expected.push(vec![i as u32]),
            }
        }
        assert_eq!(grid.components(), expected);
    }

    #[test]
    fn absurd_coordinates_do_not_overflow() {
        let nan = Point::new(f64::NAN, 0.0, 0.0);
        let points = [Point::new(1e300, -1e300, 0.0), Point::new(-1e300, 1e300, 0.0), nan];
        let grid = VoxelGrid::new(&points, 0..9, 1e-9).unwrap();
        assert_eq!(grid.components(), [vec![0], vec![1]]);
        grid.within(&points[0], 1e-9, |_, _| ());
        assert!(VoxelGrid::new(&points, 0..3, f64::NAN).is_none());
    }
}
