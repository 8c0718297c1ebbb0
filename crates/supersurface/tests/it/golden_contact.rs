//! Signed distances, normals and witness points of convex pairs against reference values with 50 digits.

use serde_json::Value;
use supersurface::contact::{Contact, Convex, WarmStart, certify, pair};
use supersurface::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use supersurface::shape::{Posed, Superellipsoid};
use supersurface::{Pose, Vector};

use crate::golden_shapes::{golden, numbers};

fn body(v: &Value) -> Posed<Convex> {
    let shape = Superellipsoid::new(numbers(&v["a"]).unwrap(), numbers(&v["e"]).unwrap()).unwrap();
    let [w, x, y, z] = numbers(&v["quat_wxyz"]).unwrap();
    let turn = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    let pose = Pose::from_parts(Translation3::from(vector(&v["t"])), turn);
    Posed::new(Convex::new(shape).unwrap(), pose).unwrap()
}

fn vector(v: &Value) -> Vector {
    numbers(v).unwrap().into()
}

fn holds(found: &Contact, truth: f64, slack: f64) -> bool {
    found.bounds[0] <= truth + slack && truth <= found.bounds[1] + slack
}

#[test]
fn golden_contact() {
    let mut cases = 0;
    for case in golden("contact")["cases"].as_array().unwrap() {
        let bodies = ["A", "B"].map(|k| body(&case[k]));
        let axes = bodies.map(|b| b.shape().shape().semi_axes());
        let all = axes.as_flattened();
        let (least, largest) = all.iter().fold((f64::MAX, 0.0), |(l, h), a| (a.min(l), a.max(h)));
        let truth = case["signed_distance"].as_f64().unwrap();
        let found = pair(&bodies[0], &bodies[1], &mut WarmStart::default());
        let tolerance = if case["cls"] == "touching" { 1e-12 } else { 1e-9 * least };
        assert!((found.distance - truth).abs() <= tolerance, "{case} {found:?}");
        assert!(holds(&found, truth, 1e-12), "{case} {found:?}");
        let sure = certify(&bodies[0], &bodies[1], 1e-6 * largest);
        assert!(holds(&sure, truth, 1e-12), "{case} {sure:?}");
        assert!(sure.bounds[1] - sure.bounds[0] <= 1e-6 * largest, "{case} {sure:?}");
        let normal = vector(&case["normal_A_to_B"]);
        // symmetric bodies about one centre have two
        let away = (found.normal.into_inner() - normal).norm();
        assert!(away < 1e-5 || (found.normal.into_inner() + normal).norm() < 1e-5, "{case}");
        let exponents = bodies.map(|b| b.shape().shape().exponents());
        if away < 1e-5 && exponents.as_flattened().iter().all(|e| *e >= 0.2) {
            for (point, key) in found.witnesses.iter().zip(["x_A", "x_B"]) {
                let reference = vector(&case[key]);
                assert!((point.coords - reference).norm() < 1e-5 * largest, "{case} {found:?}");
            }
        }
        cases += 1;
    }
    assert!(cases >= 20, "{cases} cases");
}
