//! Deformations and the radial distance of tapered superellipsoids against reference values.

use serde_json::Value;
use supersurface::deform::{Bend, Cavity, Deformation, Deformed, ShearBend, Taper, Twist};
use supersurface::nalgebra::Matrix3;
use supersurface::shape::{Implicit, Superellipsoid};
use supersurface::{Point, Vector};

use crate::golden_shapes::{golden, numbers};

fn deformation(case: &Value, shape: &Superellipsoid) -> Box<dyn Deformation> {
    let value = |name: &str| case["params"][name].as_f64().unwrap();
    let a3 = shape.semi_axes()[2];
    match case["kind"].as_str().unwrap() {
        "taper" => Box::new(Taper::new([value("Kx"), value("Ky")], a3).unwrap()),
        "bend" => Box::new(Bend::new(value("k"), value("alpha")).unwrap()),
        "twist" => Box::new(Twist::new(value("n"), a3).unwrap()),
        "cavity" => Box::new(Cavity::new(value("c"), shape).unwrap()),
        "bend21" => Box::new(ShearBend::new(value("k_radius")).unwrap()),
        other => panic!("{other}"),
    }
}

#[test]
fn golden_deform() {
    let data = golden("deform");
    let point = |v: &Value| Point::from(numbers::<3>(v).unwrap());
    let mut cases = 0;
    for case in data["cases"].as_array().unwrap() {
        let shape = Superellipsoid::new(numbers(&case["a"]).unwrap(), numbers(&case["e"]).unwrap())
            .unwrap();
        let size = shape.semi_axes().into_iter().fold(0.0, f64::max);
        let map = deformation(case, &shape);
        let (p, moved) = (point(&case["p"]), point(&case["P"]));
        assert!((map.forward(&p) - moved).amax() < 1e-12 * size, "{case}");
        let back = map.inverse(&moved).unwrap();
        assert!((back - point(&case["inv_of_P"])).amax() < 1e-12 * size, "{case}");
        let rows: Vec<_> =
            case["J"].as_array().unwrap().iter().map(|r| numbers::<3>(r).unwrap()).collect();
        let truth = Matrix3::from_fn(|i, j| rows[i][j]);
        let jacobian = map.jacobian(&p);
        assert!((jacobian - truth).amax() < 1e-10 * truth.amax(), "{case}");
        let det = case["det"].as_f64().unwrap();
        assert!((jacobian.determinant() - det).abs() < 1e-10 * det.abs().max(1.0), "{case}");
        let normal = jacobian.try_inverse().unwrap().transpose() * shape.gradient(&p);
        let truth = Vector::from(numbers::<3>(&case["normal_deformed"]).unwrap());
        assert!((normal.normalize() - truth).amax() < 1e-10, "{case}");
        cases += 1;
    }
    for case in data["tapered_radial"].as_array().unwrap() {
        let shape = Superellipsoid::new(numbers(&case["a"]).unwrap(), numbers(&case["e"]).unwrap())
            .unwrap();
        let [_, _, a3] = shape.semi_axes();
        let size = shape.semi_axes().into_iter().fold(0.0, f64::max);
        let slopes = [case["Kx"].as_f64().unwrap(), case["Ky"].as_f64().unwrap()];
        let solid = Deformed::new(shape, Taper::new(slopes, a3).unwrap()).unwrap();
        let p = point(&case["p"]);
        let s = case["s_exact"].as_f64().unwrap();
        assert!((solid.radial_scale(&p).unwrap() / s - 1.0).abs() < 1e-12, "{case}");
        let radial = case["radial_exact"].as_f64().unwrap();
        assert!((solid.radial_distance(&p) - radial).abs() < 1e-12 * size, "{case}");
        let paper = solid.approximate_radial_scale(&p);
        assert_eq!(paper.is_none(), case["beta_t_eq30"].is_null());
        if let (Some(paper), Some(truth)) = (paper, case["beta_t_eq30"].as_f64()) {
            assert!((paper - truth).abs() < 1e-12 * truth.abs().max(1.0), "{case}");
        }
        cases += 1;
    }
    assert!(cases >= 110, "{cases} cases");
}
