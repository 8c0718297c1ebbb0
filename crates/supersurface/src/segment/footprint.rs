//! Where something stands: convex outlines in the support plane.
//!
//! Outlines are convex polygons, counter-clockwise, found by Andrew's monotone chain; two are cut by
//! Sutherland and Hodgman's clipping.

use crate::shape::Plane;
use crate::{Direction, Point};

/// Spots from which it is worth while to look for those that cannot be corners of an outline.
const MANY: usize = 64;

/// Coordinates in a plane, in metres.
pub(crate) type Spot = [f64; 2];

/// Two axes in the support plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ground {
    axes: [Direction; 2],
}

impl Ground {
    /// Axes of a plane.
    pub(crate) fn of(plane: &Plane) -> Self {
        Self { axes: plane.tangents() }
    }

    /// The axes.
    pub(crate) const fn axes(&self) -> [Direction; 2] {
        self.axes
    }

    /// The foot of a point.
    #[inline]
    pub(crate) fn spot(&self, p: &Point) -> Spot {
        [self.axes[0].dot(&p.coords), self.axes[1].dot(&p.coords)]
    }
}

/// The point of a plane at a spot.
pub(crate) fn spot_on(plane: &Plane, s: &Spot) -> Point {
    let [u, v] = plane.tangents();
    Point::from(plane.normal().into_inner() * -plane.offset() + *u * s[0] + *v * s[1])
}

/// A rectangle: its middle, the direction of its longer side, half its sides, the longer one first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rectangle {
    pub(crate) middle: Spot,
    pub(crate) along: Spot,
    pub(crate) half: [f64; 2],
}

/// A convex polygon, counter-clockwise; empty, a point or a line when it has under three corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outline {
    corners: Vec<Spot>,
    /// For each edge its inward unit normal n and c, so that n·s + c is the depth of a spot s.
    edges: Vec<[f64; 3]>,
}

impl Outline {
    /// The convex hull of the spots, of which those that are no corner may be lost and the others are sorted.
    pub(crate) fn around(spots: &mut Vec<Spot>) -> Self {
        if spots.len() > MANY {
            // what lies within the octagon of the farthest ones is no corner (Akl and Toussaint, 1978)
            let (mut farthest, mut reach) = (vec![spots[0]; 8], [f64::NEG_INFINITY; 8]);
            for s in spots.iter() {
                let [x, y] = *s;
                let along = [x, x + y, y, y - x, -x, -x - y, -y, x - y];
                for k in 0..8 {
                    if along[k] > reach[k] {
                        (reach[k], farthest[k]) = (along[k], *s);
                    }
                }
            }
            let octagon = Self::around(&mut farthest);
            let rounding = 1e-9 * octagon.diameter();
            spots.retain(|s| !octagon.holds(s, rounding));
        }
        spots.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        spots.dedup();
        let mut corners: Vec<Spot> = Vec::new();
        let mut chain = |spots: &mut dyn Iterator<Item = &Spot>| {
            let start = corners.len();
            for s in spots {
                while corners.len() >= start + 2
                    && turn(corners[corners.len() - 2], corners[corners.len() - 1], *s) <= 0.0
                {
                    corners.pop();
                }
                corners.push(*s);
            }
            // The last one begins the next chain.
            corners.pop();
        };
        chain(&mut spots.iter());
        chain(&mut spots.iter().rev());
        if corners.is_empty() {
            corners.extend(spots.first());
        }
        Self::of(corners)
    }

    /// For each edge its inward unit normal n and c, so that n·s + c is the depth of a spot s.
    pub(crate) fn edges(&self) -> &[[f64; 3]] {
        &self.edges
    }

    /// Its corners.
    pub(crate) fn corners(&self) -> &[Spot] {
        &self.corners
    }

    /// The least rectangle around it, one of whose sides lies along an edge; `None` without area.
    pub(crate) fn rectangle(&self) -> Option<Rectangle> {
        let around = |[x, y, _]: &[f64; 3]| {
            let (along, across) = ([*y, -*x], [*x, *y]);
            let range = |d: Spot| {
                let at = |s: &Spot| d[0] * s[0] + d[1] * s[1];
                let values = self.corners.iter().map(at);
                values.fold([f64::MAX, f64::MIN], |r, v| [r[0].min(v), r[1].max(v)])
            };
            let ([a, b], [c, d]) = (range(along), range(across));
            let (u, v) = (0.5 * (a + b), 0.5 * (c + d));
            let middle = [u * along[0] + v * across[0], u * along[1] + v * across[1]];
            let half = [0.5 * (b - a), 0.5 * (d - c)];
            if half[0] >= half[1] {
                Rectangle { middle, along, half }
            } else {
                Rectangle { middle, along: across, half: [half[1], half[0]] }
            }
        };
        let size = |r: &Rectangle| r.half[0] * r.half[1];
        self.edges.iter().map(around).min_by(|a, b| size(a).total_cmp(&size(b)))
    }

    /// Area in square metres.
    pub(crate) fn area(&self) -> f64 {
        0.5 * self.sides().map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
    }

    /// Largest distance between two corners.
    pub(crate) fn diameter(&self) -> f64 {
        let far = |a: &Spot| {
            let d = |b: &Spot| (a[0] - b[0]).hypot(a[1] - b[1]);
            self.corners.iter().map(d).fold(0.0, f64::max)
        };
        self.corners.iter().map(far).fold(0.0, f64::max)
    }

    /// Whether a spot is so deep inside at least, by the lines through the edges; outside by at most so much, where `depth`
    /// is negative. Nothing is inside an outline without area.
    pub(crate) fn holds(&self, s: &Spot, depth: f64) -> bool {
        let deep = |[x, y, c]: &[f64; 3]| x * s[0] + y * s[1] + c >= depth;
        self.corners.len() >= 3 && self.edges.iter().all(deep)
    }

    /// What two outlines have in common.
    pub(crate) fn common(&self, other: &Self) -> Self {
        if self.corners.len() < 3 || other.corners.len() < 3 {
            return Self::default();
        }
        let mut corners = self.corners.clone();
        for (a, b) in other.sides() {
            let mut kept: Vec<Spot> = Vec::with_capacity(corners.len() + 1);
            for (k, p) in corners.iter().enumerate() {
                let q = corners[(k + 1) % corners.len()];
                let (dp, dq) = (turn(a, b, *p), turn(a, b, q));
                if dp >= 0.0 {
                    kept.push(*p);
                }
                if (dp >= 0.0) != (dq >= 0.0) {
                    let t = dp / (dp - dq);
                    kept.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
                }
            }
            corners = kept;
        }
        Self::of(corners)
    }

    fn of(corners: Vec<Spot>) -> Self {
        let next = corners.iter().cycle().skip(1);
        let edge = |(a, b): (&Spot, &Spot)| {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = dx.hypot(dy);
            let n = [-dy / length, dx / length];
            [n[0], n[1], -(n[0] * a[0] + n[1] * a[1])]
        };
        let edges = corners.iter().zip(next).map(edge).filter(|e| e[2].is_finite()).collect();
        Self { corners, edges }
    }

    fn sides(&self) -> impl Iterator<Item = (Spot, Spot)> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(a, b)| (*a, *b))
    }
}

/// Twice the signed area of the triangle a b c: positive for a turn to the left.
fn turn(a: Spot, b: Spot, c: Spot) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    fn square(x: f64, y: f64, side: f64) -> Outline {
        let mut spots = Vec::new();
        for i in 0..=4 {
            for j in 0..=4 {
                spots.push([x + side * f64::from(i) / 4.0, y + side * f64::from(j) / 4.0]);
            }
        }
        Outline::around(&mut spots)
    }

    #[test]
    fn squares_are_measured_and_cut() {
        let (a, b) = (square(0.0, 0.0, 2.0), square(1.0, 1.5, 4.0));
        assert_eq!(a.corners.len(), 4);
        assert!((a.area() - 4.0).abs() < 1e-12 && (a.diameter() - 8f64.sqrt()).abs() < 1e-12);
        assert!((a.common(&b).area() - 0.5).abs() < 1e-12);
        assert_eq!(a.common(&square(5.0, 5.0, 1.0)).area(), 0.0);
        assert!(a.holds(&[0.5, 1.0], 0.499) && !a.holds(&[0.5, 1.0], 0.501));
        assert!(a.holds(&[3.0, 1.0], -1.01) && !a.holds(&[3.0, 1.0], -0.99));
    }

    #[test]
    fn hulls_of_many_are_those_of_all() {
        let mut random = Stream::new(8, 0);
        let spots: Vec<Spot> =
            (0..500).map(|_| [random.normal(), 0.3 * random.normal() + 5.0]).collect();
        let outline = Outline::around(&mut spots.clone());
        assert!(spots.iter().all(|s| outline.holds(s, -1e-12)));
        // each corner is one that the others do not hold
        for corner in outline.corners() {
            let mut others: Vec<Spot> = spots.iter().filter(|s| *s != corner).copied().collect();
            assert!(!Outline::around(&mut others).holds(corner, 0.0));
        }
    }

    #[test]
    fn rectangles_follow_the_longest_fit() {
        let (sine, cosine) = 0.4f64.sin_cos();
        let mut spots: Vec<Spot> = [[2.0, 1.0], [-2.0, 1.0], [-2.0, -1.0], [2.0, -1.0]]
            .map(|[x, y]| [3.0 + cosine * x - sine * y, 1.0 + sine * x + cosine * y])
            .to_vec();
        let r = Outline::around(&mut spots).rectangle().unwrap();
        assert!((r.half[0] - 2.0).abs() < 1e-12 && (r.half[1] - 1.0).abs() < 1e-12);
        assert!((r.along[0] * sine - r.along[1] * cosine).abs() < 1e-12);
        assert!((r.middle[0] - 3.0).abs() < 1e-12 && (r.middle[1] - 1.0).abs() < 1e-12);
        assert!(Outline::around(&mut vec![[0.0, 0.0]]).rectangle().is_none());
    }

    #[test]
    fn points_and_lines_have_no_area() {
        for mut spots in [vec![], vec![[1.0, 2.0]; 5], vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]] {
            let outline = Outline::around(&mut spots);
            assert_eq!(outline.area(), 0.0);
            assert!(!outline.holds(&[0.0, 0.0], -1.0));
        }
    }
}
