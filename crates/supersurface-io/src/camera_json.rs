//! Intrinsics of a depth camera as JSON: width, height, fx, fy, cx, cy, depth_scale, optionally D.

use std::path::Path;

use serde::Deserialize;
use supersurface::camera::Camera;

use crate::error::{Fault, ReadError};
use crate::read::load;

/// A camera and the unit of its depth images.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthCamera {
    /// Focal lengths fx, fy and principal point cx, cy in pixels, with the size where it is known.
    pub size: Option<[usize; 2]>,
    /// [fx, fy] in pixels.
    pub focal: [f64; 2],
    /// [cx, cy] in pixels.
    pub centre: [f64; 2],
    /// Lens distortion k1, k2, p1, p2, k3, k4, k5, k6.
    pub distortion: [f64; 8],
    /// Units of the depth image a metre (1000: millimetres).
    pub depth_scale: f64,
}

impl DepthCamera {
    /// The camera for an image of a size; the fault says which number is wrong.
    pub(crate) fn camera(&self, size: [usize; 2]) -> Result<Camera, Fault> {
        if let Some(expected) = self.size.filter(|s| *s != size) {
            let [w, h] = expected;
            let problem =
                format!("the image is {} x {} but the camera {w} x {h}", size[0], size[1]);
            return Err(Fault::new("size", problem));
        }
        if !(self.depth_scale > 0.0 && self.depth_scale.is_finite()) {
            let problem =
                format!("is {}: it must be positive (1000 for millimetres)", self.depth_scale);
            return Err(Fault::new("depth_scale", problem));
        }
        Camera::new(size, self.focal, self.centre)
            .and_then(|c| c.with_distortion(self.distortion))
            .map_err(|e| Fault::new("camera", e.to_string()))
    }
}

#[derive(Deserialize)]
struct File {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    depth_scale: f64,
    #[serde(rename = "D", default)]
    distortion: Vec<f64>,
}

/// Reads a camera file. Further fields are left alone; `depth_scale` must be there, as guessing it would
/// scale the world.
pub fn read_camera(file: &Path) -> Result<DepthCamera, ReadError> {
    let bytes = load(file)?;
    let name = file.display().to_string();
    let fault = |f| ReadError::malformed(&name, "camera JSON", f);
    let read: File = serde_json::from_slice(&bytes)
        .map_err(|e| fault(Fault::new(format!("line {}", e.line()), e.to_string())))?;
    let distortion = padded(&read.distortion).map_err(fault)?;
    let size = [read.width, read.height];
    let camera = DepthCamera {
        size: Some(size),
        focal: [read.fx, read.fy],
        centre: [read.cx, read.cy],
        distortion,
        depth_scale: read.depth_scale,
    };
    // now, while the file to be mended can be named
    camera.camera(size).map_err(fault)?;
    Ok(camera)
}

/// Up to eight coefficients, the rest zero.
fn padded(given: &[f64]) -> Result<[f64; 8], Fault> {
    let mut out = [0.0; 8];
    if given.len() > out.len() {
        let problem =
            format!("{} coefficients: at most 8 (k1 k2 p1 p2 k3 k4 k5 k6) are known", given.len());
        return Err(Fault::new("D", problem));
    }
    out[..given.len()].copy_from_slice(given);
    Ok(out)
}
