//! The points where two bodies are nearest, or deepest in each other.
//!
//! They are the support points of the normal, once these face each other. On faces so flat that no number says
//! where on the face a normal belongs, they need not: then a point of the tangent plane is looked for that lies on both
//! faces, where the larger of the two gauges is least. Both are convex: first the obvious candidates, then the
//! ellipsoid method in the plane.

use super::Convex;
use super::descent::Minimum;
use super::difference::{Difference, Triple, cross, difference, dot, scaled, sum, unit};
use crate::shape::{Implicit, Posed};
use crate::{Point, Vector};

/// Support points that face each other as well as this, in the pair's size, are taken as they are.
const FACING: f64 = 2e-10;
/// A gauge of a witness point may exceed 1 by this.
const ON_SURFACE: f64 = 1e-11;
/// Steps of the ellipsoid method, each of which takes a fifth of the area.
const STEPS: usize = 300;

/// A point of each body in A's frame, in the pair's size.
pub(super) struct Witnesses {
    pub(super) of_a: Triple,
    pub(super) of_b: Triple,
}

impl Witnesses {
    pub(super) fn of(
        a: &Posed<Convex>,
        b: &Posed<Convex>,
        pair: &Difference,
        found: &Minimum,
    ) -> Self {
        let [own, other] = found.expansion.points;
        let far = difference(&pair.centre, &pair.to_a(&other));
        let facing = found.slope();
        if facing <= FACING {
            return Self { of_a: own, of_b: far };
        }
        let search = Search {
            bodies: [a, b],
            pair,
            across: scaled(&found.normal[0], -found.expansion.value),
        };
        // where the two support points would meet, B moved into contact
        let ends = [own, difference(&far, &search.across)];
        let middle = scaled(&sum(&ends[0], &ends[1]), 0.5);
        let mut best = (search.gauge(&middle), middle);
        for end in ends {
            let gauge = search.gauge(&end);
            if gauge < best.0 {
                best = (gauge, end);
            }
        }
        if best.0 > 1.0 + ON_SURFACE {
            best = search.descend(best, &found.normal[0]);
        }
        search.on_surfaces(&best.1)
    }

    pub(super) fn distance(&self) -> f64 {
        let apart = difference(&self.of_b, &self.of_a);
        dot(&apart, &apart).sqrt()
    }
}

/// The search for a point that lies on both bodies, B moved by minus `across`.
struct Search<'a> {
    bodies: [&'a Posed<Convex>; 2],
    pair: &'a Difference,
    across: Triple,
}

impl Search<'_> {
    /// The point in each body's own frame, in metres.
    fn local(&self, p: &Triple) -> [Point; 2] {
        let far = self.pair.to_b(&difference(&sum(p, &self.across), &self.pair.centre));
        [*p, far].map(|p| Point::from(Vector::from(p) * self.pair.size))
    }

    /// The larger gauge.
    fn gauge(&self, p: &Triple) -> f64 {
        let [at_a, at_b] = self.local(p);
        let [a, b] = self.bodies.map(|body| body.shape().shape());
        a.gauge(&at_a).max(b.gauge(&at_b))
    }

    /// Its gradient, in A's frame; only the direction counts.
    fn gradient(&self, p: &Triple) -> Triple {
        let [at_a, at_b] = self.local(p);
        let [a, b] = self.bodies.map(|body| body.shape().shape());
        if a.gauge(&at_a) >= b.gauge(&at_b) {
            a.gradient(&at_a).into()
        } else {
            self.pair.to_a(&b.gradient(&at_b).into())
        }
    }

    /// The ellipsoid method (Shor 1977) in the plane across `normal`.
    fn descend(&self, start: (f64, Triple), normal: &Triple) -> (f64, Triple) {
        let aside = if normal[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let u = unit(&cross(normal, &aside));
        let w = cross(normal, &u);
        let (mut best, mut middle) = (start, start.1);
        // x'M⁻¹x <= 1
        let mut m = [4.0, 0.0, 4.0];
        for _ in 0..STEPS {
            let slope = self.gradient(&middle);
            let g = [dot(&slope, &u), dot(&slope, &w)];
            let mg = [m[0] * g[0] + m[1] * g[1], m[1] * g[0] + m[2] * g[1]];
            let length = (g[0] * mg[0] + g[1] * mg[1]).sqrt();
            if !(length > 0.0 && length.is_finite()) {
                break;
            }
            let s = [mg[0] / length, mg[1] / length];
            middle = sum(&middle, &sum(&scaled(&u, -s[0] / 3.0), &scaled(&w, -s[1] / 3.0)));
            let shrunk = |m: f64, s: f64| 4.0 / 3.0 * (m - 2.0 / 3.0 * s);
            m = [shrunk(m[0], s[0] * s[0]), shrunk(m[1], s[0] * s[1]), shrunk(m[2], s[1] * s[1])];
            let gauge = self.gauge(&middle);
            if gauge < best.0 {
                best = (gauge, middle);
                if gauge <= 1.0 + ON_SURFACE {
                    break;
                }
            }
        }
        best
    }

    /// The two points that meet there, drawn to the surfaces along their rays.
    fn on_surfaces(&self, p: &Triple) -> Witnesses {
        let [at_a, at_b] = self.local(p);
        let [a, b] = self.bodies.map(|body| body.shape().shape());
        let far = difference(&sum(p, &self.across), &self.pair.centre);
        Witnesses {
            of_a: scaled(p, 1.0 / a.gauge(&at_a)),
            of_b: sum(&scaled(&far, 1.0 / b.gauge(&at_b)), &self.pair.centre),
        }
    }
}
