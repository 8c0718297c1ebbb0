//! A pinhole camera with the usual radial and tangential lens distortion.

use crate::numeric::lanes::{Job, dispatch};
use crate::{Direction, Point, Vector};

/// Numbers from which no camera can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("camera {what} is {value}: it must be {range}")]
pub struct InvalidCamera {
    /// The quantity.
    pub what: &'static str,
    /// The value that was given.
    pub value: f64,
    /// The range in words.
    pub range: &'static str,
}

/// A pinhole camera in its optical frame: x right, y down, z forward, pixel centres at integers.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    size: [usize; 2],
    focal: [f64; 2],
    centre: [f64; 2],
    distortion: [f64; 8],
}

/// Image coordinates of pixel coordinates along one axis, without distortion.
struct Scaled<'a> {
    column: &'a mut [f64],
    centre: f64,
    inverse: f64,
}

impl Job for Scaled<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        for place in self.column {
            *place = (*place - self.centre) * self.inverse;
        }
    }
}

impl Camera {
    /// Largest width or height that is accepted, in pixels.
    pub const MAX_SIDE: usize = 1 << 15;

    /// `size` is [width, height] in pixels, `focal` is [fx, fy] and `centre` [cx, cy], in pixels.
    pub fn new(size: [usize; 2], focal: [f64; 2], centre: [f64; 2]) -> Result<Self, InvalidCamera> {
        let check = |ok: bool, what, value, range| {
            if ok { Ok(()) } else { Err(InvalidCamera { what, value, range }) }
        };
        for (n, what) in size.iter().zip(["width", "height"]) {
            check((1..=Self::MAX_SIDE).contains(n), what, *n as f64, "in [1, 32768] pixels")?;
        }
        for (f, what) in focal.iter().zip(["fx", "fy"]) {
            check(*f > 0.0 && f.is_finite(), what, *f, "positive and finite")?;
        }
        for (c, what) in centre.iter().zip(["cx", "cy"]) {
            check(c.is_finite(), what, *c, "finite")?;
        }
        Ok(Self { size, focal, centre, distortion: [0.0; 8] })
    }

    /// The same camera with lens distortion `[k1, k2, p1, p2, k3, k4, k5, k6]` (the order of
    /// OpenCV's and ROS's `D`; fewer coefficients are padded with zeros by the caller).
    pub fn with_distortion(mut self, distortion: [f64; 8]) -> Result<Self, InvalidCamera> {
        for d in distortion {
            if !d.is_finite() {
                let what = "distortion coefficient";
                return Err(InvalidCamera { what, value: d, range: "finite" });
            }
        }
        self.distortion = distortion;
        Ok(self)
    }

    /// Width and height in pixels.
    pub const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Focal lengths [fx, fy] in pixels.
    pub const fn focal(&self) -> [f64; 2] {
        self.focal
    }

    /// Principal point [cx, cy] in pixels.
    pub const fn centre(&self) -> [f64; 2] {
        self.centre
    }

    /// Lens distortion `[k1, k2, p1, p2, k3, k4, k5, k6]`; zeros for a lens that has none.
    pub const fn distortion(&self) -> [f64; 8] {
        self.distortion
    }

    /// The point at depth 1 m (z = 1) that pixel (u, v) sees: its undistorted image coordinates.
    ///
    /// Distortion is undone by fixed-point iteration, which converges for lenses whose map is one to
    /// one over the image. Elsewhere the result is of no use: [`Camera::project`] then does not lead back
    /// to the pixel.
    pub fn unproject(&self, u: f64, v: f64) -> Vector {
        let x0 = (u - self.centre[0]) / self.focal[0];
        let y0 = (v - self.centre[1]) / self.focal[1];
        if self.distortion == [0.0; 8] {
            return Vector::new(x0, y0, 1.0);
        }
        let (mut x, mut y) = (x0, y0);
        // wide lenses need many steps near the corners, other pixels few
        for _ in 0..100 {
            let (radial, dx, dy) = self.distort(x, y);
            if radial.abs() < 1e-6 {
                break;
            }
            let (nx, ny) = ((x0 - dx) / radial, (y0 - dy) / radial);
            let moved = (nx - x).abs() + (ny - y).abs();
            (x, y) = (nx, ny);
            if moved < 1e-12 {
                break;
            }
        }
        Vector::new(x, y, 1.0)
    }

    /// [`Camera::unproject`] of many pixels at once: x and y in place of u and v.
    pub(crate) fn unproject_all(&self, u: &mut [f64], v: &mut [f64]) {
        if self.distortion == [0.0; 8] {
            for (column, k) in [u, v].into_iter().zip(0..) {
                dispatch(Scaled { column, centre: self.centre[k], inverse: 1.0 / self.focal[k] });
            }
            return;
        }
        for (u, v) in u.iter_mut().zip(v) {
            let along = self.unproject(*u, *v);
            (*u, *v) = (along.x, along.y);
        }
    }

    /// Unit direction of the ray through pixel (u, v), in the optical frame.
    pub fn direction(&self, u: f64, v: f64) -> Direction {
        Direction::new_normalize(self.unproject(u, v))
    }

    /// Pixel coordinates of a point in the optical frame; `None` behind the camera.
    pub fn project(&self, p: &Point) -> Option<[f64; 2]> {
        if p.z <= 1e-9 {
            return None;
        }
        let (x, y) = (p.x / p.z, p.y / p.z);
        let (radial, dx, dy) = self.distort(x, y);
        let u = self.focal[0] * (x * radial + dx) + self.centre[0];
        let v = self.focal[1] * (y * radial + dy) + self.centre[1];
        Some([u, v])
    }

    /// Radial factor and tangential shift of the lens at undistorted image coordinates.
    fn distort(&self, x: f64, y: f64) -> (f64, f64, f64) {
        let [k1, k2, p1, p2, k3, k4, k5, k6] = self.distortion;
        let r2 = x * x + y * y;
        let numerator = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let denominator = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
        let dx = 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
        let dy = p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
        (numerator / denominator, dx, dy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distortion_is_undone() {
        let camera = Camera::new([640, 480], [517.6, 517.8], [318.0, 242.8])
            .and_then(|c| c.with_distortion([-0.1, -0.05, 0.001, 3e-4, 0.01, 0.0, 0.0, 0.0]))
            .unwrap();
        for (u, v) in [(0.0, 0.0), (639.0, 479.0), (100.0, 300.0), (318.0, 242.8)] {
            let back = camera.project(&Point::from(camera.unproject(u, v) * 0.7)).unwrap();
            assert!((back[0] - u).abs() < 1e-6 && (back[1] - v).abs() < 1e-6);
        }
        // a depth camera of 120 degrees, towards its corners
        let wide = Camera::new([1024, 1024], [505.0, 505.0], [512.0, 512.0])
            .and_then(|c| c.with_distortion([5.6, 3.4, 0.0, 0.0, 0.18, 5.96, 5.5, 1.0]))
            .unwrap();
        let [u, v] = wide.project(&Point::new(1.5, 1.2, 1.0)).unwrap();
        assert!((wide.unproject(u, v) - Vector::new(1.5, 1.2, 1.0)).norm() < 1e-6);
    }
}
