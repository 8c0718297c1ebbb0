//! The generalised members and R-functions against reference values with 50 digits behind them.

use std::f64::consts::PI;

use serde_json::Value;
use supersurface::combine::rfunction::{difference, intersection, union};
use supersurface::combine::{Alpha, Blend};
use supersurface::shape::{
    ExtendedSuperellipsoid, Hyperquadric, HyperquadricForm, Implicit, Parametric, Superformula,
    Supershape,
};

use crate::golden_shapes::{close, close_vector, golden, numbers, point};

/// Relative to the value itself.
fn relative(name: &str, value: f64, truth: &Value, tolerance: f64) {
    close(name, value, truth, tolerance * value.abs());
}

fn curve([m, n1, n2, n3, a, b]: [f64; 6]) -> Superformula {
    Superformula::new(m, [n1, n2, n3], [a, b]).unwrap()
}

#[test]
fn golden_superformula() {
    let data = golden("general");
    let mut cases = 0;
    for case in data["superformula"].as_array().unwrap() {
        let params = ["m", "n1", "n2", "n3", "a", "b"].map(|k| case["params"][k].as_f64().unwrap());
        let phi = case["phi"].as_f64().unwrap();
        relative("r", curve(params).radius(phi), &case["r"], 1e-11);
        cases += 1;
    }
    for case in data["supershape3d"].as_array().unwrap() {
        let (lon, lat) = (numbers(&case["lon"]).unwrap(), numbers(&case["lat"]).unwrap());
        let shape = Supershape::new(curve(lon), curve(lat)).unwrap();
        let (theta, phi) = (case["theta"].as_f64().unwrap(), case["phi"].as_f64().unwrap());
        let p = shape.point(phi, theta);
        close_vector("point", &p.coords, &case["point"], 1e-11);
        assert!((shape.gauge(&p) - 1.0).abs() < 1e-11);
        let q = point(&case["q"]);
        relative("beta", shape.radial_scale(&q).unwrap(), &case["q_beta"], 1e-11);
        let reach = q.coords.norm().max(1.0);
        close("radial", shape.radial_distance(&q), &case["q_radial"], 1e-11 * reach);
        let [low, high] = shape.bounds();
        assert!((0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]));
        cases += 1;
    }
    assert!(cases >= 65, "{cases} cases");
    assert!((curve([4.0, 2.0, 2.0, 2.0, 1.0, 1.0]).radius(PI) - 1.0).abs() < 1e-15);
}

#[test]
fn golden_hyperquadric() {
    let data = golden("general");
    let mut cases = 0;
    for case in data["hyperquadric"].as_array().unwrap() {
        let list = |v: &Value| -> Vec<f64> {
            v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
        };
        let planes: Vec<[f64; 4]> =
            case["planes"].as_array().unwrap().iter().map(|row| numbers(row).unwrap()).collect();
        let form = HyperquadricForm::new(&planes, &list(&case["exponents"])).unwrap();
        let p = point(&case["p"]);
        let value = form.value(&p);
        relative("F", value, &case["F"], 1e-11);
        close_vector("grad F", &form.gradient(&p).unwrap(), &case["grad_F"], 1e-11);
        // the solid's gauge tells the same side, and its box holds the point if it is inside
        let Ok(solid) = Hyperquadric::from_form(form) else {
            assert!(value >= 1.0, "not empty: {case}");
            cases += 1;
            continue;
        };
        assert_eq!(solid.contains(&p), value <= 1.0);
        let [low, high] = solid.bounds();
        assert!(value > 1.0 || (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]));
        cases += 1;
    }
    assert!(cases >= 25, "{cases} cases");
}

#[test]
fn golden_extended() {
    let data = golden("general");
    let mut cases = 0;
    for case in data["extended"].as_array().unwrap() {
        let list = |v: &Value| -> Vec<f64> {
            v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
        };
        let (profile, section) = (list(&case["eta_knot_values"]), list(&case["omega_knot_values"]));
        let axes = numbers(&case["a"]).unwrap();
        let parametric = ExtendedSuperellipsoid::new(axes, &profile, &section).unwrap();
        let radial = parametric.clone().radial();
        for sample in case["samples"].as_array().unwrap() {
            let angle = |name: &str| sample[name].as_f64().unwrap();
            let (eta, omega) = (angle("eta"), angle("omega"));
            let [f1, f2] = parametric.exponents(eta, omega);
            relative("f1", f1, &sample["f1"], 1e-11);
            relative("f2", f2, &sample["f2"], 1e-11);
            close_vector("point", &parametric.point(eta, omega).coords, &sample["point"], 1e-11);
            let q = point(&sample["q"]);
            let [g1, g2] = radial.exponents_at(&q);
            relative("q_f1", g1, &sample["q_f1"], 1e-11);
            relative("q_f2", g2, &sample["q_f2"], 1e-11);
            relative("q_beta", radial.radial_scale(&q).unwrap(), &sample["q_beta"], 1e-11);
            cases += 1;
        }
    }
    assert!(cases >= 64, "{cases} cases");
}

#[test]
fn golden_rfunctions() {
    let data = golden("rfunctions");
    let mut cases = 0;
    for case in data["cases"].as_array().unwrap() {
        let number = |name: &str| case[name].as_f64().unwrap();
        let (f1, f2) = (number("f1"), number("f2"));
        let alpha = Alpha::new(number("alpha")).unwrap();
        close("union", union(f1, f2, alpha).0, &case["union"], 1e-13);
        close("intersection", intersection(f1, f2, alpha).0, &case["intersection"], 1e-13);
        close("difference", difference(f1, f2, alpha).0, &case["difference"], 1e-13);
        let blend = Blend::new(number("a0"), [number("a1"), number("a2")]).unwrap();
        let (added, _) = blend.displacement(f1, f2);
        let smooth = Alpha::SMOOTH;
        close("blend ∪", union(f1, f2, smooth).0 + added, &case["blend_union"], 1e-13);
        let both = intersection(f1, f2, smooth).0 + added;
        close("blend ∩", both, &case["blend_intersection"], 1e-13);
        cases += 1;
    }
    assert!(cases >= 40, "{cases} cases");
}
