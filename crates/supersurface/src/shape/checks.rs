//! Points for the tests of the members; what all of them have in common is tested by the suite in `tests/it/conformance`.

use crate::numeric::random::Stream;
use crate::{Point, Vector};

/// Points of a box of half edges `a` around `centre`, off the coordinate planes.
pub(super) fn points(centre: [f64; 3], a: [f64; 3], count: u64) -> impl Iterator<Item = Point> {
    (0..count).map(move |i| {
        let mut random = Stream::new(5, i);
        Point::from(Vector::from_fn(|k, _| {
            let side = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
            centre[k] + side * a[k] * random.between(0.15, 1.0)
        }))
    })
}
