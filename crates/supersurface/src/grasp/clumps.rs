//! Which of many places are near? Lists of places that follow each other in space are tested a clump at a time.

use std::ops::Range;

use crate::{Point, Vector};

/// Places in a clump.
const SIZE: usize = 32;

/// The balls around stretches of a list of places.
#[derive(Clone, Debug, Default)]
pub(super) struct Clumps {
    balls: Vec<(Point, f64)>,
    count: usize,
}

impl Clumps {
    /// Clumps of a list; the more its neighbours are neighbours in space, the smaller they are.
    pub(super) fn new(places: impl ExactSizeIterator<Item = Point> + Clone) -> Self {
        let count = places.len();
        let mut rest = places;
        let mut balls = Vec::with_capacity(count.div_ceil(SIZE));
        while rest.len() > 0 {
            let taken = rest.len().min(SIZE);
            let clump = || rest.clone().take(taken);
            let middle = clump().map(|p| p.coords).sum::<Vector>() / taken as f64;
            let radius = clump().map(|p| (p.coords - middle).norm()).fold(0.0, f64::max);
            balls.push((Point::from(middle), radius));
            rest.nth(taken - 1);
        }
        Self { balls, count }
    }

    /// Stretches of the list outside which no place lies within `radius` of `centre`.
    pub(super) fn near(&self, centre: Point, radius: f64) -> impl Iterator<Item = Range<usize>> {
        let met = self.balls.iter().enumerate().filter(move |(_, (middle, own))| {
            let reach = radius + own;
            (middle - centre).norm_squared() <= reach * reach
        });
        met.map(|(k, _)| k * SIZE..((k + 1) * SIZE).min(self.count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn no_near_place_is_left_out() {
        let mut random = Stream::new(4, 0);
        let mut shift = || Vector::from([0; 3].map(|_| random.between(-0.1, 0.1)));
        let along = |i: i32| Point::new(0.002 * f64::from(i), 0.0, 0.0);
        let places: Vec<Point> = (0..1001).map(|i| along(i) + shift()).collect();
        let clumps = Clumps::new(places.iter().copied());
        for i in 0..50 {
            let centre = along(20 * i) + shift();
            let found: Vec<usize> = clumps.near(centre, 0.2).flatten().collect();
            assert!(found.len() < places.len());
            let near = (0..places.len()).filter(|i| (places[*i] - centre).norm() <= 0.2);
            assert!(near.into_iter().all(|i| found.contains(&i)));
        }
        assert_eq!(Clumps::new([].into_iter()).near(Point::origin(), 1.0).count(), 0);
    }
}
