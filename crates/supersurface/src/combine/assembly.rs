//! Parts joined to one body: a tree of fixed, spherical and spring joints.
//!
//! At rest each part stands at its own pose in the assembly's frame. A joint turns its child (and all that hangs
//! from it) by a rotation `R` about its anchor `a`, carried along by its parent's motion:
//! `M_child = M_parent T(a) R T(-a)`, and a part's pose is its motion times its pose at rest.

use nalgebra::{Translation3, UnitQuaternion};

use crate::shape::{InvalidShape, Mass, MassProperties, Posed};
use crate::{Point, Pose, Vector};

/// A solid with its pose at rest, a density and a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Part<S> {
    name: String,
    body: Posed<S>,
    density: f64,
}

impl<S> Part<S> {
    /// `density` in kg/m³, not negative, at most 1e6; `body` stands in the assembly's frame.
    pub fn new(
        name: impl Into<String>,
        body: Posed<S>,
        density: f64,
    ) -> Result<Self, InvalidShape> {
        let inside = (0.0..=1e6).contains(&density);
        InvalidShape::check(inside, "density of a part", density, "in [0, 1e6] kg/m³")?;
        Ok(Self { name: name.into(), body, density })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The solid at rest.
    pub const fn body(&self) -> &Posed<S> {
        &self.body
    }

    /// Density in kg/m³.
    pub const fn density(&self) -> f64 {
        self.density
    }
}

/// What a joint allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind {
    /// Nothing: its rotation is ignored.
    Fixed,
    /// Any rotation about the anchor.
    Spherical,
    /// Any rotation about the anchor, drawn back to `rest`.
    Spring {
        /// Torque for an angle away from rest, in N m/rad.
        stiffness: f64,
        /// Torque for an angular velocity, in N m s/rad.
        damping: f64,
        /// Rotation at which the spring is slack.
        rest: UnitQuaternion<f64>,
    },
}

impl JointKind {
    /// Torque on the child in N m, in the parent's axes, at a rotation and a relative angular velocity in
    /// rad/s: `-k log(R R_rest⁻¹) - c ω` for a spring, 0 for the others.
    pub fn torque(&self, rotation: &UnitQuaternion<f64>, velocity: &Vector) -> Vector {
        match self {
            Self::Fixed | Self::Spherical => Vector::zeros(),
            Self::Spring { stiffness, damping, rest } => {
                let away = (rotation * rest.inverse()).scaled_axis();
                -away * *stiffness - velocity * *damping
            }
        }
    }
}

/// A joint between two parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    parent: usize,
    child: usize,
    anchor: Point,
    kind: JointKind,
}

impl Joint {
    /// Between the parts number `parent` and `child`, about `anchor` (metres, in the assembly's frame at
    /// rest). Stiffness and damping must be finite and not negative, everything finite.
    pub fn new(
        parent: usize,
        child: usize,
        anchor: Point,
        kind: JointKind,
    ) -> Result<Self, InvalidShape> {
        for v in anchor.iter() {
            InvalidShape::check(v.is_finite(), "anchor of a joint", *v, "finite")?;
        }
        if let JointKind::Spring { stiffness, damping, rest } = kind {
            for (v, what) in [(stiffness, "stiffness"), (damping, "damping")] {
                let inside = v >= 0.0 && v.is_finite();
                InvalidShape::check(inside, what, v, "finite and not negative")?;
            }
            for v in rest.coords.iter() {
                InvalidShape::check(v.is_finite(), "rest rotation of a joint", *v, "finite")?;
            }
        }
        Ok(Self { parent, child, anchor, kind })
    }

    /// Index of the part that carries.
    pub const fn parent(&self) -> usize {
        self.parent
    }

    /// Index of the part that is carried.
    pub const fn child(&self) -> usize {
        self.child
    }

    /// The point about which it turns, in the assembly's frame at rest.
    pub const fn anchor(&self) -> Point {
        self.anchor
    }

    /// What it allows.
    pub const fn kind(&self) -> JointKind {
        self.kind
    }

    /// The rotation that it takes by itself: a spring's rest, none otherwise.
    pub fn rest(&self) -> UnitQuaternion<f64> {
        match self.kind {
            JointKind::Spring { rest, .. } => rest,
            JointKind::Fixed | JointKind::Spherical => UnitQuaternion::identity(),
        }
    }

    /// The motion of the child relative to its parent's, for a rotation of the joint.
    fn motion(&self, rotation: &UnitQuaternion<f64>) -> Pose {
        let allowed = !matches!(self.kind, JointKind::Fixed);
        if !allowed || !rotation.coords.iter().all(|v| v.is_finite()) {
            return Pose::identity();
        }
        let to = Translation3::from(self.anchor.coords);
        to * *rotation * to.inverse()
    }
}

/// Parts and the tree of joints between them. Methods take one rotation for each joint, in the order in which
/// the joints were given; a missing one stands for none, and so does one that is not finite.
///
/// ```
/// use supersurface::combine::{Assembly, Joint, JointKind, Part};
/// use supersurface::nalgebra::UnitQuaternion;
/// use supersurface::shape::{Posed, Superellipsoid};
/// use supersurface::{Point, Pose, Vector};
/// // a hammer whose head can turn at the end of its handle
/// let handle = Posed::new(Superellipsoid::new([0.01, 0.01, 0.15], [0.2, 1.0])?, Pose::identity())?;
/// let head = Superellipsoid::new([0.04, 0.02, 0.02], [0.3, 0.3])?;
/// let head = Posed::new(head, Pose::translation(0.0, 0.0, 0.16))?;
/// let parts = vec![Part::new("handle", handle, 700.0)?, Part::new("head", head, 7800.0)?];
/// let neck = Joint::new(0, 1, Point::new(0.0, 0.0, 0.15), JointKind::Spherical)?;
/// let hammer = Assembly::new(parts, vec![neck])?;
/// let turn = UnitQuaternion::from_scaled_axis(Vector::x() * std::f64::consts::FRAC_PI_2);
/// let head = hammer.poses(&[turn])[1];
/// assert!((head.translation.vector - Vector::new(0.0, -0.01, 0.15)).norm() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly<S> {
    parts: Vec<Part<S>>,
    joints: Vec<Joint>,
    /// Joints from the root outwards.
    order: Vec<usize>,
}

impl<S> Assembly<S> {
    /// Fails when there is no part, or when the joints do not make a tree over all parts: each part but one
    /// is the child of exactly one joint, and all hang from that one.
    pub fn new(parts: Vec<Part<S>>, joints: Vec<Joint>) -> Result<Self, InvalidShape> {
        let count = parts.len();
        InvalidShape::check(count > 0, "number of parts", count as f64, "at least 1")?;
        let given = joints.len();
        let right = given + 1 == count;
        InvalidShape::check(right, "number of joints", given as f64, "one less than parts")?;
        let mut hanging = vec![Vec::new(); count];
        let mut carried = vec![false; count];
        for (i, joint) in joints.iter().enumerate() {
            let inside = "the index of a part";
            let parent = hanging.get_mut(joint.parent).map(|h| h.push(i)).is_some();
            InvalidShape::check(parent, "parent of a joint", joint.parent as f64, inside)?;
            let free = carried.get_mut(joint.child).is_some_and(|c| !std::mem::replace(c, true));
            let once = "the index of a part that no other joint carries";
            InvalidShape::check(free, "child of a joint", joint.child as f64, once)?;
        }
        // with one joint less than parts and no child twice, exactly one part is no child
        let root = carried.iter().position(|c| !c).unwrap_or(0);
        let mut order = hanging.get(root).cloned().unwrap_or_default();
        let mut next = 0;
        while let Some(joint) = order.get(next).and_then(|j| joints.get(*j)) {
            order.extend(hanging.get(joint.child).into_iter().flatten());
            next += 1;
        }
        let reached = order.len();
        let all = reached == given;
        let whole = "all of them (the others go round in a circle)";
        InvalidShape::check(
            all,
            "number of joints that hang from the root",
            reached as f64,
            whole,
        )?;
        Ok(Self { parts, joints, order })
    }

    /// One part alone: the common case.
    pub fn single(part: Part<S>) -> Self {
        Self { parts: vec![part], joints: Vec::new(), order: Vec::new() }
    }

    /// Its parts.
    pub fn parts(&self) -> &[Part<S>] {
        &self.parts
    }

    /// Its joints.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Index of the part that no joint carries.
    pub fn root(&self) -> usize {
        let first = self.order.first().and_then(|j| self.joints.get(*j));
        first.map_or(0, Joint::parent)
    }

    /// The rotations that the joints take by themselves.
    pub fn rest_rotations(&self) -> Vec<UnitQuaternion<f64>> {
        self.joints.iter().map(Joint::rest).collect()
    }

    /// How each part moves away from its pose at rest.
    pub fn motions(&self, rotations: &[UnitQuaternion<f64>]) -> Vec<Pose> {
        let mut motions = vec![Pose::identity(); self.parts.len()];
        for index in &self.order {
            let Some(joint) = self.joints.get(*index) else { continue };
            let parent = motions.get(joint.parent).copied().unwrap_or_default();
            let own = rotations.get(*index).map_or_else(Pose::identity, |r| joint.motion(r));
            if let Some(motion) = motions.get_mut(joint.child) {
                *motion = parent * own;
            }
        }
        motions
    }

    /// Pose of each part in the assembly's frame.
    pub fn poses(&self, rotations: &[UnitQuaternion<f64>]) -> Vec<Pose> {
        let motions = self.motions(rotations);
        self.parts.iter().zip(motions).map(|(part, motion)| motion * part.body.pose()).collect()
    }

    /// The solids where the joints put them.
    pub fn bodies(&self, rotations: &[UnitQuaternion<f64>]) -> Vec<Posed<S>>
    where
        S: Clone,
    {
        let motions = self.motions(rotations);
        self.parts.iter().zip(motions).map(|(part, motion)| part.body.moved(&motion)).collect()
    }
}

impl<S: MassProperties> Assembly<S> {
    /// Mass, centre of mass and inertia of all parts together, in the assembly's frame. Where parts overlap
    /// they count twice: [`Assembly::union_mass_properties`] counts them once, [`Assembly::overlap`] says how
    /// much that is.
    pub fn mass_properties(&self, rotations: &[UnitQuaternion<f64>]) -> Mass {
        let nothing =
            Mass { mass: 0.0, centre: Point::origin(), inertia: nalgebra::Matrix3::zeros() };
        let poses = self.poses(rotations);
        let parts = self.parts.iter().zip(&poses);
        parts
            .map(|(part, pose)| part.body.shape().mass_properties(part.density).moved(pose))
            .fold(nothing, |sum, mass| sum.joined(&mass))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Superellipsoid;

    fn chain(
        joints: &[(usize, usize)],
        parts: usize,
    ) -> Result<Assembly<Superellipsoid>, InvalidShape> {
        let ball = Superellipsoid::new([0.1; 3], [1.0; 2])?;
        let part = |i: usize| {
            let pose = Pose::translation(i as f64, 0.0, 0.0);
            Part::new(format!("part {i}"), Posed::new(ball, pose)?, 1.0)
        };
        let parts = (0..parts).map(part).collect::<Result<Vec<_>, _>>()?;
        let joint = |(a, b): &(usize, usize)| {
            let anchor = Point::new(*b as f64 - 0.5, 0.0, 0.0);
            Joint::new(*a, *b, anchor, JointKind::Spherical)
        };
        Assembly::new(parts, joints.iter().map(joint).collect::<Result<Vec<_>, _>>()?)
    }

    #[test]
    fn only_trees_are_accepted() {
        assert!(chain(&[(0, 1), (1, 2)], 3).is_ok());
        // the order of the joints does not matter, nor which part is the root
        assert_eq!(chain(&[(1, 2), (0, 1)], 3).unwrap().order, [1, 0]);
        assert_eq!(chain(&[(2, 1), (1, 0)], 3).unwrap().root(), 2);
        let wrong: [&[(usize, usize)]; 6] = [
            &[],
            &[(0, 1)],
            &[(0, 1), (0, 1)],
            &[(1, 2), (2, 1)],
            &[(0, 1), (1, 3)],
            &[(9, 1), (1, 2)],
        ];
        for joints in wrong {
            assert!(chain(joints, 3).is_err(), "{joints:?}");
        }
        assert!(chain(&[], 0).is_err() && chain(&[], 1).is_ok());
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let spring = JointKind::Spring {
                stiffness: bad,
                damping: 0.0,
                rest: UnitQuaternion::identity(),
            };
            assert!(Joint::new(0, 1, Point::origin(), spring).is_err());
            let ball = Superellipsoid::new([0.1; 3], [1.0; 2]).unwrap();
            assert!(Part::new("", Posed::new(ball, Pose::identity()).unwrap(), bad).is_err());
        }
    }

    #[test]
    fn a_bent_arm_bends_at_its_anchors() {
        let arm = chain(&[(1, 2), (0, 1)], 3).unwrap();
        let quarter = UnitQuaternion::from_scaled_axis(Vector::z() * std::f64::consts::FRAC_PI_2);
        // both joints by 90°: (0,0) - (0.5,0) ↰ (0.5,0.5) - (0.5,1) ↰ (0,1)
        let poses = arm.poses(&[quarter, quarter]);
        let expected = [[0.0, 0.0], [0.5, 0.5], [0.0, 1.0]];
        for (pose, [x, y]) in poses.iter().zip(expected) {
            assert!((pose.translation.vector - Vector::new(x, y, 0.0)).norm() < 1e-15);
        }
        // anchors stay together
        let motions = arm.motions(&[quarter, quarter]);
        for joint in arm.joints() {
            let ends = [joint.parent(), joint.child()].map(|i| motions[i] * joint.anchor());
            assert!((ends[0] - ends[1]).norm() < 1e-15);
        }
        assert_eq!(arm.poses(&[])[2].translation.vector, Vector::new(2.0, 0.0, 0.0));
        assert_eq!(arm.bodies(&[quarter])[2].pose(), &arm.poses(&[quarter])[2]);
    }

    #[test]
    fn a_spring_pulls_back_to_its_rest() {
        let rest = UnitQuaternion::from_scaled_axis(Vector::x() * 0.3);
        let spring = JointKind::Spring { stiffness: 2.0, damping: 0.5, rest };
        let joint = Joint::new(0, 1, Point::origin(), spring).unwrap();
        assert_eq!(joint.rest(), rest);
        let turned = UnitQuaternion::from_scaled_axis(Vector::x() * 0.5);
        let torque = spring.torque(&turned, &Vector::new(0.0, 1.0, 0.0));
        assert!((torque - Vector::new(-0.4, -0.5, 0.0)).norm() < 1e-14);
        assert_eq!(JointKind::Spherical.torque(&turned, &Vector::x()), Vector::zeros());
    }
}
