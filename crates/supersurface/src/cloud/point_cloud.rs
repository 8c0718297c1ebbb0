//! A point cloud, organised (an image of points) or not.

use crate::camera::{Camera, DepthImage};
use crate::{Point, Pose};

/// Points in metres, in the frame of the file that they come from.
///
/// Rows without a reading stay in place as NaN, so that index `i` is the `i`-th point of the file and,
/// in organised clouds, pixel `(i % width, i / width)`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// All points; NaN where there is no reading.
    pub points: Vec<Point>,
    /// Colours (red, green, blue) of all points, or empty.
    pub colours: Vec<[u8; 3]>,
    /// Instance labels of all points, or empty: 0 is background, others number the objects. They are
    /// there only when the caller asked for a given segmentation.
    pub labels: Vec<u32>,
    /// Width and height of an organised cloud.
    pub grid: Option<[usize; 2]>,
    /// Where the sensor stood, in the frame of the points; `None` when it is not known.
    pub viewpoint: Option<Point>,
    /// Pose of the points' frame in the world when the file carries one (PCD VIEWPOINT).
    pub world: Option<Pose>,
}

impl PointCloud {
    /// An unorganised cloud of bare points, seen from nowhere.
    pub fn from_points(points: Vec<Point>) -> Self {
        Self { points, ..Self::default() }
    }

    /// The organised cloud of a depth image, in the optical frame of its camera. Depths that are not
    /// positive and finite become NaN.
    ///
    /// ```
    /// use supersurface::{camera::{Camera, DepthImage}, cloud::PointCloud};
    /// let camera = Camera::new([2, 1], [500.0; 2], [0.0; 2])?;
    /// let image = DepthImage::new([2, 1], vec![0.5, f32::NAN]).unwrap();
    /// let cloud = PointCloud::from_depth(&image, &camera);
    /// assert_eq!(cloud.points[0].z, 0.5);
    /// assert!(cloud.points[1].x.is_nan());
    /// # Ok::<(), supersurface::camera::InvalidCamera>(())
    /// ```
    pub fn from_depth(image: &DepthImage, camera: &Camera) -> Self {
        let [width, height] = image.size();
        let mut points = Vec::with_capacity(width * height);
        for (i, z) in image.depth().iter().enumerate() {
            let z = f64::from(*z);
            points.push(if z > 0.0 && z.is_finite() {
                Point::from(camera.unproject((i % width) as f64, (i / width) as f64) * z)
            } else {
                Point::new(f64::NAN, f64::NAN, f64::NAN)
            });
        }
        Self {
            points,
            grid: Some([width, height]),
            viewpoint: Some(Point::origin()),
            ..Self::default()
        }
    }

    /// True when point `i` has three finite coordinates.
    #[inline]
    pub fn is_finite(&self, i: usize) -> bool {
        finite(&self.points[i])
    }

    /// Number of points with three finite coordinates.
    pub fn finite_count(&self) -> usize {
        self.points.iter().filter(|p| finite(p)).count()
    }

    /// The cloud in another frame: every point, the viewpoint and the world pose are moved.
    pub fn moved(mut self, motion: &Pose) -> Self {
        for p in &mut self.points {
            *p = motion * *p;
        }
        self.viewpoint = self.viewpoint.map(|p| motion * p);
        self.world = self.world.map(|w| w * motion.inverse());
        self
    }

    /// The cloud with all lengths multiplied by `factor` (0.001 for millimetres).
    pub fn scaled(mut self, factor: f64) -> Self {
        for p in &mut self.points {
            p.coords *= factor;
        }
        self.viewpoint = self.viewpoint.map(|p| Point::from(p.coords * factor));
        if let Some(world) = &mut self.world {
            world.translation.vector *= factor;
        }
        self
    }
}

#[inline]
fn finite(p: &Point) -> bool {
    p.x.is_finite() && p.y.is_finite() && p.z.is_finite()
}
