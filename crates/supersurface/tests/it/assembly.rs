//! A teddy bear of ten ellipsoids, joined at nine joints: its mass, once and twice counted, against a
//! computation of its own.

use supersurface::combine::{Assembly, Joint, JointKind, Part};
use supersurface::nalgebra::{Matrix3, UnitQuaternion};
use supersurface::shape::{Implicit, Mass, MassEstimate, MassProperties, Posed, Superellipsoid};
use supersurface::{Point, Pose, Vector};

/// An ellipsoid that knows its mass by the schoolbook.
#[derive(Clone, Debug)]
struct Ellipsoid(Superellipsoid);

impl Implicit for Ellipsoid {
    fn gauge(&self, p: &Point) -> f64 {
        self.0.gauge(p)
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.0.gradient(p)
    }

    fn bounds(&self) -> [Point; 2] {
        self.0.bounds()
    }
}

impl MassProperties for Ellipsoid {
    fn mass_properties(&self, density: f64) -> Mass {
        let [a, b, c] = self.0.semi_axes();
        let mass = density * 4.0 / 3.0 * std::f64::consts::PI * a * b * c;
        let moments = Vector::new(b * b + c * c, a * a + c * c, a * a + b * b);
        let inertia = Matrix3::from_diagonal(&(moments * (mass / 5.0)));
        Mass { mass, centre: Point::origin(), inertia }
    }
}

/// Name, centre and semi-axes of each part in metres, tilt about y, and what it hangs from with the anchor.
type Row = (&'static str, [f64; 3], [f64; 3], f64, Option<(usize, [f64; 3])>);

const BEAR: [Row; 10] = [
    ("body", [0.0, 0.0, 0.10], [0.060, 0.050, 0.075], 0.0, None),
    ("head", [0.0, 0.0, 0.215], [0.050, 0.045, 0.050], 0.0, Some((0, [0.0, 0.0, 0.17]))),
    ("muzzle", [0.0, 0.045, 0.205], [0.020, 0.020, 0.016], 0.0, Some((1, [0.0, 0.035, 0.205]))),
    ("left ear", [0.040, 0.0, 0.260], [0.018, 0.008, 0.018], 0.4, Some((1, [0.033, 0.0, 0.25]))),
    (
        "right ear",
        [-0.040, 0.0, 0.260],
        [0.018, 0.008, 0.018],
        -0.4,
        Some((1, [-0.033, 0.0, 0.25])),
    ),
    ("left arm", [0.075, 0.010, 0.125], [0.020, 0.020, 0.045], -0.7, Some((0, [0.05, 0.0, 0.15]))),
    (
        "right arm",
        [-0.075, 0.010, 0.125],
        [0.020, 0.020, 0.045],
        0.7,
        Some((0, [-0.05, 0.0, 0.15])),
    ),
    ("left leg", [0.045, 0.030, 0.035], [0.024, 0.045, 0.024], 0.0, Some((0, [0.04, 0.0, 0.05]))),
    (
        "right leg",
        [-0.045, 0.030, 0.035],
        [0.024, 0.045, 0.024],
        0.0,
        Some((0, [-0.04, 0.0, 0.05])),
    ),
    ("tail", [0.0, -0.052, 0.055], [0.013, 0.013, 0.013], 0.0, Some((0, [0.0, -0.045, 0.055]))),
];

const DENSITY: f64 = 80.0;

fn bear() -> Assembly<Ellipsoid> {
    let part = |(name, centre, axes, tilt, _): Row| {
        let pose = Pose::new(Vector::from(centre), Vector::y() * tilt);
        let shape = Ellipsoid(Superellipsoid::new(axes, [1.0; 2]).unwrap());
        Part::new(name, Posed::new(shape, pose).unwrap(), DENSITY).unwrap()
    };
    let rest = UnitQuaternion::identity();
    let spring = JointKind::Spring { stiffness: 0.2, damping: 0.01, rest };
    let joint = |(i, row): (usize, &Row)| {
        let (parent, anchor) = row.4?;
        let soft = row.0.contains("arm") || row.0.contains("leg") || row.0 == "head";
        let kind = if soft { spring } else { JointKind::Fixed };
        Some(Joint::new(parent, i, Point::from(anchor), kind).unwrap())
    };
    let joints = BEAR.iter().enumerate().filter_map(joint).collect();
    Assembly::new(BEAR.map(part).into(), joints).unwrap()
}

/// Head nods, one arm waves, one leg is lifted.
fn waving(bear: &Assembly<Ellipsoid>) -> Vec<UnitQuaternion<f64>> {
    let turn = |joint: &Joint| {
        let axis = match bear.parts()[joint.child()].name() {
            "head" => Vector::new(-0.4, 0.0, 0.2),
            "left arm" => Vector::new(0.0, -1.2, 0.0),
            "right leg" => Vector::new(0.5, 0.0, 0.0),
            // a fixed joint: the turn is ignored
            "tail" => Vector::new(9.0, 0.0, 0.0),
            _ => Vector::zeros(),
        };
        UnitQuaternion::from_scaled_axis(axis)
    };
    bear.joints().iter().map(turn).collect()
}

/// The parts' transforms by 4x4 matrices, joint by joint up to the root.
fn matrices(
    bear: &Assembly<Ellipsoid>,
    turns: &[UnitQuaternion<f64>],
) -> Vec<supersurface::nalgebra::Matrix4<f64>> {
    let about = |joint: &Joint, turn: &UnitQuaternion<f64>| {
        let r = if joint.kind() == JointKind::Fixed { UnitQuaternion::identity() } else { *turn };
        let mut m = r.to_homogeneous();
        let a = joint.anchor().coords;
        m.fixed_view_mut::<3, 1>(0, 3).copy_from(&(a - r.to_rotation_matrix() * a));
        m
    };
    (0..bear.parts().len())
        .map(|part| {
            let mut m = bear.parts()[part].body().pose().to_homogeneous();
            let mut at = part;
            while let Some(i) = bear.joints().iter().position(|j| j.child() == at) {
                m = about(&bear.joints()[i], &turns[i]) * m;
                at = bear.joints()[i].parent();
            }
            m
        })
        .collect()
}

#[test]
fn the_bear_weighs_what_its_parts_weigh() {
    let bear = bear();
    for turns in [bear.rest_rotations(), waving(&bear)] {
        let mass = bear.mass_properties(&turns);
        // by 4x4 matrices and second moments about the origin
        let (mut total, mut first, mut second) = (0.0, Vector::zeros(), Matrix3::zeros());
        for (row, m) in BEAR.iter().zip(matrices(&bear, &turns)) {
            let [a, b, c] = row.2;
            let part = DENSITY * 4.0 / 3.0 * std::f64::consts::PI * a * b * c;
            let r = m.fixed_view::<3, 3>(0, 0).into_owned();
            let t = m.fixed_view::<3, 1>(0, 3).into_owned();
            let own = Matrix3::from_diagonal(&(Vector::new(a * a, b * b, c * c) / 5.0));
            total += part;
            first += t * part;
            second += (r * own * r.transpose() + t * t.transpose()) * part;
        }
        assert!((mass.mass / total - 1.0).abs() < 1e-14);
        assert!((mass.centre.coords - first / total).norm() < 1e-15);
        let about_origin = Matrix3::identity() * second.trace() - second;
        let error = (mass.inertia_about_origin() - about_origin).norm();
        assert!(error < 1e-13 * about_origin.norm());
    }
}

#[test]
fn overlaps_of_the_bear_are_counted_once() {
    let bear = bear();
    for turns in [bear.rest_rotations(), waving(&bear)] {
        let MassEstimate { mass: once, error } = bear.union_mass_properties(&turns, 64);
        let [overlap, off] = bear.overlap(&turns, 64);
        assert!(error > 0.0 && error < 3e-3 && off > 0.0 && off < 3e-3, "{error} {off}");
        // the whole bear on a grid of its own, cell by cell, with the 4x4 matrices turned back
        let parts: Vec<_> = matrices(&bear, &turns)
            .into_iter()
            .zip(BEAR)
            .map(|(m, row)| (m.try_inverse().unwrap(), Vector::from(row.2)))
            .collect();
        let inside = |p: &Point| {
            let held = |(m, axes): &(_, Vector)| {
                m_transform(m, p).coords.component_div(axes).norm_squared() <= 1.0
            };
            parts.iter().any(held)
        };
        let cell = 0.0015;
        let (mut count, mut first) = (0.0, Vector::zeros());
        for i in -100..100 {
            for j in -80..90 {
                for k in -20..200 {
                    let p = Point::new(f64::from(i), f64::from(j), f64::from(k)) * cell;
                    if inside(&p) {
                        count += 1.0;
                        first += p.coords;
                    }
                }
            }
        }
        let volume = count * cell.powi(3);
        assert!((once.mass / DENSITY / volume - 1.0).abs() < 1e-3, "{} {volume}", once.mass);
        assert!((once.centre.coords - first / count).norm() < 1e-4);
        let sum = bear.mass_properties(&turns).mass / DENSITY;
        assert!((overlap - (1.0 - volume / sum)).abs() < 1e-3, "{overlap}");
        assert!(overlap > 0.01 && overlap < 0.3, "{overlap}");
        assert!(once.inertia.symmetric_eigenvalues().min() > 0.0);
    }
}

fn m_transform(m: &supersurface::nalgebra::Matrix4<f64>, p: &Point) -> Point {
    m.transform_point(p)
}
