//! Between the library's nalgebra and parry's glam. Both are metres and unit quaternions; nothing is scaled.

use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector as ParryVector};
use supersurface::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use supersurface::{Point, Pose, Vector};

/// A point or vector of parry's as a vector of the library's.
pub fn to_vector(v: ParryVector) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

/// A point of parry's as a point of the library's.
pub fn to_point(v: ParryVector) -> Point {
    Point::new(v.x, v.y, v.z)
}

/// A vector of the library's as parry's.
pub fn from_vector(v: &Vector) -> ParryVector {
    ParryVector::new(v.x, v.y, v.z)
}

/// A point of the library's as parry's.
pub fn from_point(p: &Point) -> ParryVector {
    from_vector(&p.coords)
}

/// A pose of parry's as the library's.
pub fn to_pose(pose: &ParryPose) -> Pose {
    let q = pose.rotation;
    let rotation = UnitQuaternion::new_normalize(Quaternion::new(q.w, q.x, q.y, q.z));
    Pose::from_parts(Translation3::from(to_vector(pose.translation)), rotation)
}

/// A pose of the library's as parry's.
pub fn from_pose(pose: &Pose) -> ParryPose {
    let q = pose.rotation.coords;
    let rotation = Rotation::from_xyzw(q.x, q.y, q.z, q.w);
    ParryPose::from_parts(from_vector(&pose.translation.vector), rotation)
}
