//! The `supersurface` command.
fn main() {}
