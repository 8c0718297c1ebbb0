//! Residuals and their derivatives by all parameters against reference values.

use serde_json::Value;
use supersurface::deform::{Adjustable, Bend, Deformed, Taper, Twist};
use supersurface::nalgebra::{Isometry3, Quaternion, UnitQuaternion};
use supersurface::shape::{Posed, Superellipsoid, Supertoroid};
use supersurface::{Point, Pose, Vector};

use crate::golden_shapes::{close, golden, numbers, point};

fn pose(case: &Value) -> Pose {
    let [w, x, y, z] = numbers(&case["quat_wxyz"]).unwrap();
    let [tx, ty, tz] = numbers(&case["t"]).unwrap();
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    Isometry3::from_parts(Vector::new(tx, ty, tz).into(), rotation)
}

/// A posed superellipsoid's pull-back distance and row.
fn pulled<const K: usize, D: Adjustable<K>>(
    case: &Value,
    shape: Superellipsoid,
    deformation: D,
    p: &Point,
) -> (f64, Vec<f64>) {
    let solid = Posed::new(Deformed::new(shape, deformation).unwrap(), pose(case)).unwrap();
    let (residual, row, own) = solid.pull_back_jacobian(p).unwrap();
    (residual, row.into_iter().chain(own).collect())
}

#[test]
fn golden_jacobian() {
    let data = golden("jacobian");
    let mut cases = 0;
    for case in data["cases"].as_array().unwrap() {
        let p = point(&case["p_world"]);
        let params: Vec<f64> =
            case["params"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        let ext: Vec<f64> =
            case["ext"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        let a = [params[0], params[1], params[2]];
        let shape = || Superellipsoid::new(a, [params[3], params[4]]).unwrap();
        let mut largest = a.into_iter().fold(0.0, f64::max);
        let kind = case["kind"].as_str().unwrap();
        let (residual, row) = match kind {
            "se_radial" => {
                let (r, row) = Posed::new(shape(), pose(case)).unwrap().radial_jacobian(&p);
                (r, row.to_vec())
            }
            "st_meridian" => {
                let ring = Supertoroid::new(a, params[3], [params[4], params[5]]).unwrap();
                largest *= 1.0 + params[3];
                let (r, row) = Posed::new(ring, pose(case)).unwrap().meridian_jacobian(&p);
                (r, row.to_vec())
            }
            "taper_pullback" => {
                pulled(case, shape(), Taper::new([ext[0], ext[1]], a[2]).unwrap(), &p)
            }
            "bend_pullback" => pulled(case, shape(), Bend::new(ext[0], ext[1]).unwrap(), &p),
            "twist_pullback" => pulled(case, shape(), Twist::new(ext[0], a[2]).unwrap(), &p),
            "taper_exact" => {
                let taper = Taper::new([ext[0], ext[1]], a[2]).unwrap();
                let solid = Deformed::new(shape(), taper).unwrap();
                let (r, row, own) =
                    Posed::new(solid, pose(case)).unwrap().radial_jacobian(&p).unwrap();
                (r, row.into_iter().chain(own).collect())
            }
            other => panic!("unknown kind {other}"),
        };
        close(kind, residual, &case["residual"], 1e-12 * largest);
        let truth = case["J"].as_array().unwrap();
        assert_eq!(row.len(), truth.len());
        let scale = truth.iter().map(|v| v.as_f64().unwrap().abs()).fold(0.0, f64::max);
        for ((value, truth), name) in row.iter().zip(truth).zip(case["names"].as_array().unwrap()) {
            close(&format!("{kind} by {name}"), *value, truth, 1e-9 * scale);
        }
        cases += 1;
    }
    assert!(cases >= 60, "{cases} cases");
}
