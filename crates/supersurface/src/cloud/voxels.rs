//! Which points are near: a voxel grid held as one sorted list.
//!
//! Point p lies in the cube with key floor(p / cell), taken by component. The points are sorted by
//! their keys, so that a cube's points are one slice of the list and finding it is a binary search:
//! no hashing, no allocation after the build, and the same order on every machine. Keys of absurd
//! coordinates saturate instead of overflowing; distances are always checked on the points.

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
    /// (key, index of the point), sorted.
    entries: Vec<(Key, u32)>,
    /// First entry of each cube that is occupied, and the number of entries at the end.
    starts: Vec<u32>,
}

type Key = [i64; 3];

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
        let mut entries: Vec<(Key, u32)> = indices
            .into_iter()
            .filter_map(|i| {
                let p = points.get(i as usize)?;
                let finite = p.coords.iter().all(|c| c.is_finite());
                finite.then(|| (key(p, cell), i))
            })
            .collect();
        entries.sort_unstable();
        let mut starts = Vec::new();
        for (at, entry) in entries.iter().enumerate() {
            if at == 0 || entries[at - 1].0 != entry.0 {
                starts.push(at as u32);
            }
        }
        starts.push(entries.len() as u32);
        Some(Self { points, cell, entries, starts })
    }

    /// Number of cubes that hold a point.
    pub fn occupied(&self) -> usize {
        self.starts.len() - 1
    }

    /// One point of each occupied cube (the one with the smallest index), in the order of the cubes.
    pub fn representatives(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.occupied()).map(|c| self.cube(c)[0].1)
    }

    /// Calls `visit(index, squared distance)` for every point within `radius` of `p`, in a fixed
    /// order. Meant for radii of at most a few cells: it visits (2 radius / cell + 1)^3 cubes.
    pub fn within(&self, p: &Point, radius: f64, mut visit: impl FnMut(u32, f64)) {
        let finite = p.coords.iter().all(|c| c.is_finite()) && radius >= 0.0;
        let reach = (radius / self.cell).ceil();
        if !finite || reach.is_nan() || reach > 64.0 {
            return;
        }
        let (centre, reach) = (key(p, self.cell), reach as i64);
        for x in -reach..=reach {
            for y in -reach..=reach {
                // The cubes of a column along z are neighbours in the list: one search for all.
                let [cx, cy, cz] = centre;
                let (x, y) = (cx.saturating_add(x), cy.saturating_add(y));
                let last = [x, y, cz.saturating_add(reach)];
                let first = [x, y, cz.saturating_sub(reach)];
                let start = self.entries.partition_point(|e| e.0 < first);
                for (k, i) in &self.entries[start..] {
                    if *k > last {
                        break;
                    }
                    let d = (self.points[*i as usize] - p).norm_squared();
                    if d <= radius * radius {
                        visit(*i, d);
                    }
                }
            }
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
            let [x, y, z] = self.cube(c)[0].0;
            // Half of the 26 neighbours; the others see this cube from their side. Each of the four
            // columns ahead is followed by a cursor that only moves forwards.
            if c + 1 < n && self.cube(c + 1)[0].0 == [x, y, z.saturating_add(1)] {
                sets.join(c, c + 1);
            }
            for (cursor, (dx, dy)) in columns.iter_mut().zip([(0, 1), (1, -1), (1, 0), (1, 1)]) {
                let (x, y) = (x.saturating_add(dx), y.saturating_add(dy));
                let first = [x, y, z.saturating_sub(1)];
                while *cursor < n && self.cube(*cursor)[0].0 < first {
                    *cursor += 1;
                }
                let last = [x, y, z.saturating_add(1)];
                let ahead = (*cursor..n).take_while(|d| self.cube(*d)[0].0 <= last);
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
            let members = self.cube(c).iter().map(|e| e.1);
            clusters[place[root] as usize].extend(members);
        }
        clusters.iter_mut().for_each(|c| c.sort_unstable());
        clusters.sort_unstable_by_key(|c| c[0]);
        clusters
    }

    /// The entries of the c-th occupied cube.
    fn cube(&self, c: usize) -> &[(Key, u32)] {
        &self.entries[self.starts[c] as usize..self.starts[c + 1] as usize]
    }
}

fn key(p: &Point, cell: f64) -> Key {
    // `as` saturates, so that no coordinate overflows.
    [p.x, p.y, p.z].map(|x| (x / cell).floor() as i64)
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
    fn components_are_those_of_all_pairs_of_cubes() {
        let mut random = Stream::new(5, 0);
        let points: Vec<Point> =
            (0..300).map(|_| Point::from([0; 3].map(|_| random.between(-0.5, 0.5)))).collect();
        let grid = VoxelGrid::new(&points, 0..300, 0.08).unwrap();
        let mut sets = Sets::new(300);
        for (i, p) in points.iter().enumerate() {
            for (j, q) in points.iter().enumerate() {
                let (a, b) = (key(p, 0.08), key(q, 0.08));
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
