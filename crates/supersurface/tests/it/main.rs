//! Integration tests of the library, one binary.

mod hit;
mod picture;
mod scene;
