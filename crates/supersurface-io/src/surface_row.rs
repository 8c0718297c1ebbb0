//! A recovered surface as a row of JSON, with its pose: the named form that `docs/fit.md` explains.

use serde::Serialize;
use supersurface::Pose;
use supersurface::shape::Posed;
use supersurface::surface::Surface;

#[derive(Serialize)]
pub(crate) struct PoseRow {
    position: [f64; 3],
    orientation_wxyz: [f64; 4],
}

impl PoseRow {
    pub(crate) fn new(pose: &Pose) -> Self {
        // of the two quaternions of a rotation the one with w >= 0
        let q = match pose.rotation.w < 0.0 {
            true => -pose.rotation.into_inner(),
            false => pose.rotation.into_inner(),
        };
        Self { position: pose.translation.vector.into(), orientation_wxyz: [q.w, q.i, q.j, q.k] }
    }
}

#[derive(Serialize)]
pub(crate) struct SurfaceRow {
    r#type: &'static str,
    semi_axes: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    ring_ratio: Option<f64>,
    exponents: [f64; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    deformations: Option<DeformationsRow>,
    #[serde(flatten)]
    pose: PoseRow,
}

/// In the order in which they are done: taper, twist, bend.
#[derive(Serialize)]
struct DeformationsRow {
    #[serde(skip_serializing_if = "Option::is_none")]
    taper: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    twist: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bend: Option<BendRow>,
}

#[derive(Serialize)]
struct BendRow {
    k: f64,
    alpha: f64,
}

impl SurfaceRow {
    pub(crate) fn new(surface: &Posed<Surface>) -> Self {
        let shape = surface.shape();
        let deformations = DeformationsRow {
            taper: shape.taper().map(|t| t.slopes()),
            twist: shape.twist().map(|t| t.turns()),
            bend: shape.bend().map(|b| BendRow { k: b.curvature(), alpha: b.angle() }),
        };
        let straight = deformations.taper.is_none()
            && deformations.twist.is_none()
            && deformations.bend.is_none();
        Self {
            r#type: shape.name(),
            semi_axes: shape.semi_axes(),
            ring_ratio: shape.ring_ratio(),
            exponents: shape.exponents(),
            deformations: (!straight).then_some(deformations),
            pose: PoseRow::new(surface.pose()),
        }
    }
}

/// A surface with its pose as a JSON object: the named form of `docs/fit.md`.
///
/// ```
/// use supersurface::{Pose, shape::{Posed, Superellipsoid}, surface::Surface};
/// let egg = Surface::Superellipsoid(Superellipsoid::new([0.03, 0.02, 0.02], [1.0; 2])?);
/// let value = supersurface_io::surface_json(&Posed::new(egg, Pose::identity())?);
/// assert_eq!(value["semi_axes"][0], 0.03);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn surface_json(surface: &Posed<Surface>) -> serde_json::Value {
    // plain structs of numbers: serialisation has nothing to fail on
    serde_json::to_value(SurfaceRow::new(surface)).unwrap_or_default()
}
