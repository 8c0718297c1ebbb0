//! Which points are near a place: all are looked at, eight at a time, which for some thousand points is faster than any
//! order among them.

use crate::Vector;
use crate::numeric::lanes::{Job, WIDTH, dispatch};

/// Points among which neighbours are sought.
#[derive(Clone, Debug)]
pub(super) struct Neighbours {
    /// Coordinates, padded with infinity.
    columns: [Vec<f64>; 3],
    count: usize,
    near: Vec<(f64, u32)>,
    /// Squared distance within which enough were found last.
    reach: f64,
}

impl Neighbours {
    pub(super) fn among(points: impl Iterator<Item = Vector>) -> Self {
        let mut columns = [(); 3].map(|()| Vec::new());
        for p in points {
            columns.iter_mut().zip(p.iter()).for_each(|(column, x)| column.push(*x));
        }
        let count = columns[0].len();
        for column in &mut columns {
            column.resize(count.next_multiple_of(WIDTH), f64::INFINITY);
        }
        Self { columns, count, near: Vec::new(), reach: f64::INFINITY }
    }

    /// The nearest to a place, as (squared distance, index): `count` of them or all there are, the last of them the
    /// farthest, the others in no order.
    pub(super) fn nearest(&mut self, p: &Vector, count: usize) -> &[(f64, u32)] {
        let count = count.min(self.count);
        if count == 0 {
            return &[];
        }
        loop {
            let (columns, near, reach) = (&self.columns, &mut self.near, self.reach);
            near.clear();
            dispatch(Near { columns, p, reach, visit: |square, i| near.push((square, i)) });
            if near.len() >= count || reach.is_infinite() {
                break;
            }
            self.reach = if reach > 0.0 { 4.0 * reach } else { f64::INFINITY };
        }
        let last = count.min(self.near.len()) - 1;
        self.near.select_nth_unstable_by(last, |a, b| a.0.total_cmp(&b.0));
        // about twice as many the next time
        self.reach = 2.0 * self.near[last].0;
        &self.near[..=last]
    }

    /// How many lie within a squared distance of a place.
    pub(super) fn within(&self, p: &Vector, reach: f64) -> usize {
        let mut found = 0.0;
        dispatch(Count { columns: &self.columns, p, reach, found: &mut found });
        found as usize
    }
}

/// Visits all points whose squared distance is less than `reach`.
struct Near<'a, V> {
    columns: &'a [Vec<f64>; 3],
    p: &'a Vector,
    reach: f64,
    visit: V,
}

impl<V: FnMut(f64, u32)> Job for Near<'_, V> {
    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        let [x, y, z] = self.columns;
        let blocks = x.as_chunks::<WIDTH>().0.iter().zip(y.as_chunks::<WIDTH>().0);
        for (b, ((x, y), z)) in blocks.zip(z.as_chunks::<WIDTH>().0).enumerate() {
            let squares: [f64; WIDTH] = std::array::from_fn(|i| {
                let (dx, dy, dz) = (x[i] - self.p.x, y[i] - self.p.y, z[i] - self.p.z);
                dx * dx + dy * dy + dz * dz
            });
            if squares.iter().fold(false, |any, s| any | (*s < self.reach)) {
                for (i, square) in squares.iter().enumerate() {
                    if *square < self.reach {
                        (self.visit)(*square, (b * WIDTH + i) as u32);
                    }
                }
            }
        }
    }
}

/// Counts them.
struct Count<'a> {
    columns: &'a [Vec<f64>; 3],
    p: &'a Vector,
    reach: f64,
    found: &'a mut f64,
}

impl Job for Count<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [x, y, z] = self.columns;
        let blocks = x.as_chunks::<WIDTH>().0.iter().zip(y.as_chunks::<WIDTH>().0);
        let mut lanes = [0.0; WIDTH];
        for ((x, y), z) in blocks.zip(z.as_chunks::<WIDTH>().0) {
            for i in 0..WIDTH {
                let (dx, dy, dz) = (x[i] - self.p.x, y[i] - self.p.y, z[i] - self.p.z);
                let square = dx * dx + dy * dy + dz * dz;
                lanes[i] += if square < self.reach { 1.0 } else { 0.0 };
            }
        }
        *self.found = lanes.iter().sum();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn finds_what_sorting_finds() {
        let mut random = Stream::new(2, 0);
        let points: Vec<Vector> =
            (0..301).map(|_| Vector::from_fn(|_, _| random.normal())).collect();
        let mut neighbours = Neighbours::among(points.iter().copied());
        for p in &points {
            let mut squares: Vec<f64> = points.iter().map(|q| (q - p).norm_squared()).collect();
            squares.sort_by(f64::total_cmp);
            let near = neighbours.nearest(p, 5);
            assert!(near.iter().any(|n| points[n.1 as usize] == *p));
            assert_eq!((near.len(), near[4].0), (5, squares[4]));
            assert_eq!(neighbours.within(p, squares[9]), 9);
        }
        assert_eq!(neighbours.nearest(&points[0], 999).len(), 301);
        let mut same = Neighbours::among((0..9).map(|_| Vector::zeros()));
        assert_eq!(same.nearest(&Vector::zeros(), 4).len(), 4);
        assert_eq!(same.nearest(&Vector::x(), 4).len(), 4);
        assert!(Neighbours::among(std::iter::empty()).nearest(&Vector::x(), 4).is_empty());
    }
}
