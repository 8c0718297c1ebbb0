//! Grippers as signs: a slim fork or a cup at a grasp's pose, with the way it comes.

use super::draw::Picture;
use super::{Colour, mix};
use crate::{Point, Pose, Vector};

impl Picture {
    /// A parallel jaw at the pose of its tool frame (z approaches, x closes, origin midway between the
    /// pads): fingers `opening` apart that reach `depth` back to the palm, and an arrow along the
    /// approach. Metres.
    pub fn jaw(&mut self, pose: &Pose, opening: f64, depth: f64, colour: Colour) -> &mut Self {
        let (thick, wide, tip) = (0.11 * depth, 0.24 * depth, 0.16 * depth);
        for side in [-1.0, 1.0] {
            let center = Point::new(side * 0.5 * (opening + thick), 0.0, 0.5 * (tip - depth));
            self.boxed(pose, &center, &Vector::new(thick, wide, depth + tip), colour, 1.0);
        }
        let palm = Vector::new(opening + 2.0 * thick, wide, 1.3 * thick);
        self.boxed(pose, &Point::new(0.0, 0.0, -depth - 0.65 * thick), &palm, colour, 1.0);
        self.approach(pose, 1.3 * thick + depth, 0.9 * depth, colour)
    }

    /// A vacuum cup at the pose of its tool frame (origin at the centre of the lip, z approaches):
    /// the lip of `radius`, the bell above it, and an arrow along the approach. Metres.
    pub fn cup(&mut self, pose: &Pose, radius: f64, colour: Colour) -> &mut Self {
        const SIDES: usize = 24;
        let neck = 0.45 * radius;
        let rim = |i: usize, r: f64, z: f64| {
            let (s, c) = (std::f64::consts::TAU * i as f64 / SIDES as f64).sin_cos();
            pose * Point::new(r * c, r * s, z)
        };
        for i in 0..SIDES {
            let bell = [rim(i, radius, 0.0), rim(i + 1, radius, 0.0)];
            let top = [rim(i, neck, -radius), rim(i + 1, neck, -radius)];
            let outward =
                pose.rotation * -Vector::z() * 0.5 + (bell[0] - pose * Point::origin()) / radius;
            let shade = self.shade(colour, &outward, 0.1);
            for [a, b, c] in [[bell[0], bell[1], top[1]], [bell[0], top[1], top[0]]] {
                self.triangle([(a, shade), (b, shade), (c, shade)], u8::MAX);
            }
            let lid = self.shade(colour, &(pose.rotation * -Vector::z()), 0.0);
            let middle = pose * Point::new(0.0, 0.0, -radius);
            self.triangle([top[0], top[1], middle].map(|p| (p, lid)), u8::MAX);
            self.line(&bell[0], &bell[1], mix(colour, [0; 3], 0.35), 2.0);
            self.line(&top[0], &top[1], mix(colour, [0; 3], 0.35), 1.0);
        }
        self.approach(pose, radius, 2.5 * radius, colour)
    }

    /// An arrow of `length` that ends `back` behind the tool's origin.
    fn approach(&mut self, pose: &Pose, back: f64, length: f64, colour: Colour) -> &mut Self {
        let at = |z: f64| pose * Point::new(0.0, 0.0, z);
        self.arrow(&at(-back - length), &at(-back - 0.04 * length), mix(colour, [0; 3], 0.2), 2.2)
    }
}
