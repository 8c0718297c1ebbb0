//! A scene of the library that settles.

use supersurface::scene::Scene;

use super::{Falling, Ground, SettleError, SettleOptions, Settled, settle};

/// Friction of the table and of boards.
const GROUND: f64 = 0.6;

/// Lets the bodies of a scene fall on its table and boards, and moves them to where they lie. The table has no end here, so
/// that nothing falls off it; joints keep their rest.
///
/// ```
/// use supersurface::{Pose, scene::{Body, Layout, arrange}, shape::Superellipsoid, surface::Surface};
/// use supersurface_physics::{SettleOptions, settle_scene};
/// let egg = Surface::Superellipsoid(Superellipsoid::new([0.03, 0.02, 0.02], [1.0; 2])?);
/// let eggs = vec![Body::single("egg", egg, Pose::identity())?; 3];
/// let mut scene = arrange(eggs, Layout::Pile, 7)?;
/// let settled = settle_scene(&mut scene, &SettleOptions::default())?;
/// assert!(settled.overlap < 1e-4 && scene.bodies[0].pose.translation.z < 0.04);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn settle_scene(scene: &mut Scene, options: &SettleOptions) -> Result<Settled, SettleError> {
    let falling: Vec<Falling> = scene
        .bodies
        .iter()
        .map(|body| Falling {
            parts: body.shape.parts().to_vec(),
            start: body.pose,
            friction: body.friction,
            restitution: 0.0,
        })
        .collect();
    let ground = Ground {
        floor: Some(scene.support),
        cuboids: scene.boards.iter().map(|b| (b.pose, b.half_extents)).collect(),
        friction: GROUND,
        ..Ground::default()
    };
    let settled = settle(&falling, &ground, options)?;
    for (body, rest) in scene.bodies.iter_mut().zip(&settled.bodies) {
        body.pose = rest.pose;
    }
    Ok(settled)
}
