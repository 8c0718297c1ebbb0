//! Depth as an image.

use crate::camera::Camera;

/// Depth along the optical axis for each pixel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthImage {
    size: [usize; 2],
    depth: Vec<f32>,
}

impl DepthImage {
    /// `depth` in metres, NaN where there is no reading; `None` when its length is not width x
    /// height of `size`.
    pub fn new(size: [usize; 2], depth: Vec<f32>) -> Option<Self> {
        (size[0].checked_mul(size[1]) == Some(depth.len())).then_some(Self { size, depth })
    }

    /// An image without any reading.
    pub fn empty(camera: &Camera) -> Self {
        let [w, h] = camera.size();
        Self { size: [w, h], depth: vec![f32::NAN; w * h] }
    }

    /// Width and height in pixels.
    pub const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Depths in metres, row by row; NaN where there is no reading.
    pub fn depth(&self) -> &[f32] {
        &self.depth
    }

    /// The same, to be changed.
    pub fn depth_mut(&mut self) -> &mut [f32] {
        &mut self.depth
    }
}
