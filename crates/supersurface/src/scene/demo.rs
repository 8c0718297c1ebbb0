//! The table that the first command of a newcomer looks at.

use crate::camera::Camera;
use crate::numeric::random::Stream;
use crate::scene::{Scene, SceneError, facing};
use crate::shape::{Superellipsoid, Supertoroid};
use crate::surface::Surface;
use crate::{Point, Pose};
use nalgebra::UnitQuaternion;

/// A laid table and the camera before it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Demo {
    /// The table with its bodies, z up.
    pub scene: Scene,
    /// A 640 x 480 depth camera.
    pub camera: Camera,
    /// Pose of the camera's optical frame in the world.
    pub camera_pose: Pose,
}

/// A box, a can, an egg, a ring and a bar of soap on a table, each graspable by a jaw that opens 80 mm,
/// seen from 0.8 m away and 45 degrees above. The seed varies sizes by a few percent, places by a
/// centimetre and headings freely; nothing hides another.
///
/// ```
/// use supersurface::scene::{DepthNoise, demo, look};
/// let d = demo(1)?;
/// let look = look(&d.scene, &d.camera, &d.camera_pose, &DepthNoise::default(), 1);
/// assert_eq!(look.labels.iter().max(), Some(&5));
/// # Ok::<(), supersurface::scene::SceneError>(())
/// ```
pub fn demo(seed: u64) -> Result<Demo, SceneError> {
    let mut scene = Scene::empty([0.60, 0.45]);
    let solid = |a, e| Superellipsoid::new(a, e).map(Surface::Superellipsoid);
    let ring = |a, r, e| Supertoroid::new(a, r, e).map(Surface::Supertoroid);
    let mut stream = Stream::new(seed, 0);
    // tall bodies at the back (+y), low ones in front
    for (index, (name, x, y)) in [
        ("tea box", -0.135, 0.085),
        ("can", 0.025, 0.125),
        ("ring", 0.165, 0.035),
        ("egg", -0.055, -0.075),
        ("soap", 0.085, -0.105),
    ]
    .into_iter()
    .enumerate()
    {
        let mut vary = |v: f64| v * stream.between(0.95, 1.05);
        let shape = match index {
            0 => solid([vary(0.044), vary(0.030), vary(0.062)], [0.12, 0.12])?,
            1 => {
                let radius = vary(0.033);
                solid([radius, radius, vary(0.055)], [0.12, 1.0])?
            }
            2 => {
                let tube = vary(0.0125);
                ring([tube, tube, vary(0.016)], vary(3.0), [0.8, 1.0])?
            }
            3 => solid([vary(0.036), vary(0.028), vary(0.027)], [1.0, 1.0])?,
            _ => solid([vary(0.042), vary(0.028), vary(0.018)], [0.6, 0.5])?,
        };
        let at = [x + stream.between(-0.01, 0.01), y + stream.between(-0.01, 0.01)];
        let yaw = stream.between(0.0, std::f64::consts::TAU);
        scene.put(name, shape, UnitQuaternion::identity(), at, yaw)?;
    }
    let camera = Camera::new([640, 480], [615.0, 615.0], [319.5, 239.5])?;
    let eye = Point::new(0.0, -0.56, 0.58);
    let camera_pose = facing(&eye, &Point::new(0.01, 0.0, 0.02));
    Ok(Demo { scene, camera, camera_pose })
}
