//! What is a point, by its height over a support?
//!
//! It is above when it is higher than the noise of the support's readings explains, and the camera's own distortion, which
//! bends flat things with the distance r: over 3 relative (3 sigma(r) |n·e| + floor) + 1 mm + 1.5 mm/m² min(r, 3 m)², with
//! the widths of a [`reading`](super::reading) and e the ray of unit length.

use crate::Point;
use crate::numeric::lanes::{Job, WIDTH, dispatch};
use crate::segment::SegmentOptions;
use crate::segment::reading::{BLIND, FLOOR, WIDTHS};
use crate::segment::sight::{NOISE_FLOOR, NOISE_GROWTH, NOISE_RANGE, REACH, Sight};
use crate::segment::table::Support;

/// What a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// Not a reading.
    Missing,
    /// Something that is not to be clustered.
    Other,
    /// The same, so deep that it may be of another support.
    Beneath,
    /// The same, but so high that it may be the edge of what is.
    Low,
    /// To be clustered.
    Above,
}

/// Depth beneath a support from which a point may be of another one, in metres.
const BENEATH: f64 = 0.1;
/// Share of the margin from which a point is low.
const LOW: f64 = 0.5;
/// Standard deviations of the support's points that count as noise.
const DEVIATIONS: f64 = 3.0;
/// The camera's distortion: in metres, what grows with the square of the distance, and up to where.
const UNEVEN: f64 = 0.001;
const BEND: f64 = 0.0015;
const BENT: f64 = 3.0;

/// Heights over a support from which points are above it rather than its noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margins {
    /// The support's normal and offset.
    plane: [f64; 4],
    eye: [f64; 3],
    /// The margin is `least + spread sigma(r) |n·e| + bend min(r, 3 m)²`.
    least: f64,
    spread: f64,
    bend: f64,
}

impl Margins {
    /// Those of a support.
    pub(crate) fn of(support: &Support, sight: &Sight, options: &SegmentOptions) -> Self {
        let noise = DEVIATIONS * support.relative;
        let [least, spread, bend] = match (options.margin, sight.eye) {
            (Some(margin), _) => [margin.max(0.0), 0.0, 0.0],
            (None, Some(_)) => [noise * FLOOR + UNEVEN, noise * WIDTHS, BEND],
            (None, None) => [noise * BLIND + UNEVEN, 0.0, 0.0],
        };
        let (normal, eye) = (support.plane.normal(), sight.eye.unwrap_or_default());
        let plane = [normal.x, normal.y, normal.z, support.plane.offset()];
        Self { plane, eye: eye.coords.into(), least, spread, bend }
    }

    /// The margin at a point, in metres.
    pub(crate) fn at(&self, p: &Point) -> f64 {
        self.margin(p.coords.into())
    }

    /// What some points are.
    pub(crate) fn classes(&self, points: &[Point]) -> Vec<Class> {
        let mut classes = Vec::with_capacity(points.len());
        dispatch(Classes { margins: self, points, classes: &mut classes });
        classes
    }

    /// What a point is.
    pub(crate) fn class(&self, p: &Point) -> Class {
        self.class_at(p.coords.into())
    }

    #[inline(always)]
    fn margin(&self, p: [f64; 3]) -> f64 {
        let [x, y, z] = [p[0] - self.eye[0], p[1] - self.eye[1], p[2] - self.eye[2]];
        let square = x * x + y * y + z * z;
        let along = self.plane[0] * x + self.plane[1] * y + self.plane[2] * z;
        let below = |v: f64, most: f64| if v < most { v } else { most };
        let noise = NOISE_FLOOR + NOISE_GROWTH * below(square, NOISE_RANGE * NOISE_RANGE);
        let range = square.sqrt() + f64::MIN_POSITIVE;
        self.least
            + self.spread * noise * along.abs() / range
            + self.bend * below(square, BENT * BENT)
    }

    /// What a point is, by choices that need no branch.
    #[inline(always)]
    fn class_at(&self, p: [f64; 3]) -> Class {
        let height =
            self.plane[0] * p[0] + self.plane[1] * p[1] + self.plane[2] * p[2] + self.plane[3];
        let margin = self.margin(p);
        let is_seen = (p[0].abs() < REACH) & (p[1].abs() < REACH) & (p[2].abs() < REACH);
        let class = if height < -BENEATH { Class::Beneath } else { Class::Other };
        let class = if height > LOW * margin { Class::Low } else { class };
        let class = if height > margin { Class::Above } else { class };
        if is_seen { class } else { Class::Missing }
    }
}

struct Classes<'a> {
    margins: &'a Margins,
    points: &'a [Point],
    classes: &'a mut Vec<Class>,
}

impl Job for Classes<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let (blocks, rest) = self.points.as_chunks::<WIDTH>();
        for block in blocks {
            let mut at = [[0.0; WIDTH]; 3];
            for i in 0..WIDTH {
                (at[0][i], at[1][i], at[2][i]) = (block[i].x, block[i].y, block[i].z);
            }
            let mut classes = [Class::Missing; WIDTH];
            for i in 0..WIDTH {
                classes[i] = self.margins.class_at([at[0][i], at[1][i], at[2][i]]);
            }
            self.classes.extend_from_slice(&classes);
        }
        self.classes.extend(rest.iter().map(|p| self.margins.class(p)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::PointCloud;
    use crate::numeric::random::Stream;
    use crate::segment::sight::depth_noise;
    use crate::segment::table::find;

    #[test]
    fn heights_are_told_apart_by_margins() {
        let mut random = Stream::new(2, 0);
        // a table 0.8 m below the sensor, and points over and under it
        let mut points: Vec<Point> = (0..3000)
            .map(|_| Point::new(random.between(-0.4, 0.4), random.between(-0.3, 0.3), 0.8))
            .collect();
        points.iter_mut().for_each(|p| p.z += 0.001 * random.normal());
        let mut cloud = PointCloud::from_points(points);
        cloud.viewpoint = Some(Point::origin());
        let all: Vec<u32> = (0..3000).collect();
        let (support, sight) = find(&cloud, &all, &mut random).unwrap();
        let options = SegmentOptions::default();
        let margins = Margins::of(&support, &sight, &options);
        let at = |height: f64| Point::new(0.1, 0.05, 0.8 - height);
        let range = (at(0.0) - Point::origin()).norm();
        let width = WIDTHS * depth_noise(range) * 0.8 / range + FLOOR;
        let known = DEVIATIONS * support.relative * width + UNEVEN + BEND * range * range;
        assert!((margins.at(&at(0.0)) - known).abs() < 1e-4, "{known}");
        let heights = [2.0 * known, 0.8 * known, 0.1 * known, -0.05, -0.2, f64::NAN, -1e9];
        let classes = [
            Class::Above,
            Class::Low,
            Class::Other,
            Class::Other,
            Class::Beneath,
            Class::Missing,
            Class::Missing,
        ];
        let points: Vec<Point> =
            heights.iter().cycle().take(3 * WIDTH + 2).map(|h| at(*h)).collect();
        let found = margins.classes(&points);
        for (k, class) in found.iter().enumerate() {
            assert_eq!((*class, margins.class(&points[k])), (classes[k % 7], classes[k % 7]));
        }
        let given = SegmentOptions { margin: Some(0.05), ..options };
        let margins = Margins::of(&support, &sight, &given);
        assert_eq!([0.06, 0.03].map(|h| margins.class(&at(h))), [Class::Above, Class::Low]);
        // a margin under the support is none
        let given = SegmentOptions { margin: Some(-0.05), ..given };
        let margins = Margins::of(&support, &sight, &given);
        assert_eq!([0.01, -0.03].map(|h| margins.class(&at(h))), [Class::Above, Class::Other]);
    }
}
