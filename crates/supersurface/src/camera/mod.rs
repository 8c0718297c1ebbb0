//! Floor 3: pinhole cameras and depth images. A camera knows rays; it draws nothing.

mod depth_image;
mod pinhole;

pub use depth_image::DepthImage;
pub use pinhole::{Camera, InvalidCamera};
