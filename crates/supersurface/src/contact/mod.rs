//! Floor 7: where two things touch, how far apart or how deep in each other they are, and with what force.
//!
//! | for | use | holds |
//! |---|---|---|
//! | two convex bodies | [`pair`], [`intersect`], [`certify`] | signed distance, normal, witness points, and bounds of the distance |
//! | the same in an optimisation | [`differentiate`] | derivatives by both poses and shapes |
//! | a point of both | [`common_point`] | the proof of an overlap |
//! | many convex bodies | [`contacts`] | all pairs within a distance |
//! | rings, tapered, twisted and bent bodies | [`solids`] of [`Sliced`] | the same, also through holes; wider bounds of the depth |
//! | a half space, a ball, a point | [`half_space`], [`sphere`] | the same for toroids |
//! | how deep a point lies in a solid | [`Indented`], [`ByClosestPoint`] | equation (46) without iteration; the exact closest point |
//! | a mesh against a supersurface | [`Foundation`] | forces of an elastic layer, wrench on both bodies, derivatives by both poses |
//! | what a force should be | [`laws`] | three laws in closed form, each with its name |

pub mod elastic;
mod many;
mod pair;
mod simple;
mod sliced;

pub use elastic::laws;
pub use elastic::{
    Application, BLOCK, ByClosestPoint, Foundation, FoundationContact, FoundationError,
    FoundationOptions, Indentation, IndentationSlope, IndentationSlopes, Indentations, Indented,
    SmoothlyIndented, Twist, VertexForce, Wrench, WrenchDerivative, layer_stiffness,
};
pub use many::{Neighbours, contacts};
pub use pair::{
    BodyDerivative, Contact, Convex, WarmStart, certify, common_point, differentiate, intersect,
    pair,
};
pub use simple::{half_space, sphere};
pub use sliced::{NotSliced, Sliced, solids};
