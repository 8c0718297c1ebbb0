//! Floor 1: the small mathematics that every shape is made of.

pub mod column;
pub mod dirichlet;
pub mod gauss;
pub mod lanes;
pub mod powers;
pub mod quarter_angle;
pub mod random;
pub mod spline;
pub mod superellipse;
pub(crate) mod symmetric;
pub mod tanh_sinh;
