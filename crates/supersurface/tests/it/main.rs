//! Integration tests of the library, one binary.

mod floors;
mod golden_shapes;
mod segment;
