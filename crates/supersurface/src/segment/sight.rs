//! How the cloud was seen: the sensor's place, which way is up in its image, how noisy a depth is.
//!
//! No gravity is known and files differ in their axes. An organised cloud tells its own camera: the
//! direction d(u, v) from the viewpoint to the point of pixel (u, v) is nearly linear in the pixel,
//! d = a + b u + c v, so that a looks forwards, b to the right and -c up, whatever the axes are.

use nalgebra::Matrix3;

use crate::cloud::PointCloud;
use crate::{Direction, Point, Vector};

/// Farthest coordinate that is taken for a reading, in metres.
pub(crate) const REACH: f64 = 1e8;

/// Standard deviation of a depth reading at distance z: a floor, and the growth of a structured-light
/// camera's error with the square of the distance (Khoshelham and Elberink 2012, eq. 10).
pub(crate) const NOISE_FLOOR: f64 = 0.001;
pub(crate) const NOISE_GROWTH: f64 = 1.4e-3;
/// Distance beyond which the noise grows no more, in metres: such clouds come from other sensors.
pub(crate) const NOISE_RANGE: f64 = 8.0;

/// Standard deviation of a depth reading at distance `range`, in metres.
pub(crate) fn depth_noise(range: f64) -> f64 {
    let z = range.min(NOISE_RANGE);
    NOISE_FLOOR + NOISE_GROWTH * z * z
}

/// True when the point is a reading.
#[inline]
pub(crate) fn seen(p: &Point) -> bool {
    p.x.abs() < REACH && p.y.abs() < REACH && p.z.abs() < REACH
}

/// Width and height of an organised cloud; `None` for others and where they do not fit the points.
pub(crate) fn grid(cloud: &PointCloud) -> Option<[usize; 2]> {
    let fits = |[w, h]: &[usize; 2]| w.checked_mul(*h) == Some(cloud.points.len());
    cloud.grid.filter(fits).filter(|[w, h]| *w > 1 && *h > 1)
}

/// Where the sensor is and how it is held.
#[derive(Clone, Debug)]
pub(crate) struct Sight {
    /// The sensor; `None` when it is not known.
    pub(crate) eye: Option<Point>,
    /// Where it looks: the mean direction of the points.
    pub(crate) forward: Direction,
    /// Which way is up in its image, square to `forward`; `None` when nothing tells.
    pub(crate) up: Option<Direction>,
    /// Angle between neighbouring pixels of an organised cloud, in radians.
    pub(crate) pixel: Option<f64>,
}

impl Sight {
    /// Reads the camera off a cloud, by the points named in `sample`.
    pub(crate) fn of(cloud: &PointCloud, sample: &[u32]) -> Self {
        let points = || sample.iter().filter_map(|i| cloud.points.get(*i as usize));
        // Without a viewpoint the sensor is taken to be at the origin if that is in front of all.
        let eye = cloud.viewpoint.filter(seen).or_else(|| Some(Point::origin()));
        let eye = eye.filter(|eye| {
            let rays = || points().filter_map(|p| (p - eye).try_normalize(1e-9));
            let mean: Vector = rays().sum();
            let inside = rays().filter(|d| d.dot(&mean) > 0.5 * mean.norm()).count();
            inside * 20 >= sample.len() * 19
        });
        let Some(eye) = eye else {
            return Self { eye: None, forward: Vector::z_axis(), up: None, pixel: None };
        };
        let mean: Vector = points().filter_map(|p| (p - eye).try_normalize(1e-9)).sum();
        let forward = Direction::try_new(mean, 1e-9).unwrap_or(Vector::z_axis());
        let image = grid(cloud).and_then(|[w, _]| image_axes(cloud, sample, &eye, w));
        let across = |v: Vector| Direction::try_new(v - *forward * forward.dot(&v), 1e-9);
        let up = match image {
            Some((_, down)) => across(-down),
            // An unorganised cloud in a camera's own frame looks along z with y down, or along -z
            // with y up.
            None if forward.z.abs() > 0.5 && eye == Point::origin() => {
                across(Vector::new(0.0, -forward.z.signum(), 0.0))
            }
            None => None,
        };
        let pixel = image.map(|(right, down)| (right.norm() * down.norm()).sqrt());
        Self { eye: Some(eye), forward, up, pixel }
    }
}

/// Change of the viewing direction from one column to the next, and from one row to the next.
fn image_axes(
    cloud: &PointCloud,
    sample: &[u32],
    eye: &Point,
    width: usize,
) -> Option<(Vector, Vector)> {
    let (mut squares, mut rays) = (Matrix3::zeros(), Matrix3::zeros());
    for i in sample {
        let p = cloud.points.get(*i as usize)?;
        let Some(d) = (p - eye).try_normalize(1e-9) else { continue };
        let i = *i as usize;
        let pixel = Vector::new(1.0, (i % width) as f64, (i / width) as f64);
        squares += pixel * pixel.transpose();
        rays += d * pixel.transpose();
    }
    let slopes = rays * squares.try_inverse()?;
    let (right, down) = (slopes.column(1).into_owned(), slopes.column(2).into_owned());
    let plausible = |v: &Vector| v.norm() > 1e-6 && v.norm() < 0.2;
    (plausible(&right) && plausible(&down)).then_some((right, down))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pose;
    use crate::camera::{Camera, DepthImage};

    #[test]
    fn up_is_read_off_the_image_in_any_frame() {
        let camera = Camera::new([64, 48], [60.0; 2], [31.5, 23.5]).unwrap();
        let depth = (0..64 * 48).map(|i| 1.0 + 0.001 * (i % 7) as f32).collect();
        let cloud = PointCloud::from_depth(&DepthImage::new([64, 48], depth).unwrap(), &camera);
        let sample: Vec<u32> = (0..64 * 48).step_by(5).collect();
        let turn = Pose::new(Vector::new(1.0, 2.0, 3.0), Vector::new(0.7, -1.2, 0.4));
        let sight = Sight::of(&cloud.moved(&turn), &sample);
        let up = turn * -Vector::y();
        assert!(sight.up.unwrap().dot(&up) > 0.999);
        assert!((sight.pixel.unwrap() * 60.0 - 1.0).abs() < 0.15);
    }
}
