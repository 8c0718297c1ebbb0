//! Integration tests of the physics, one binary.

mod households;
mod manifolds;
mod piles;
mod rest;
mod scenes;
mod settling;
mod shapes;
mod unsupported;
