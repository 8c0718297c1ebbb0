//! Superellipsoid and supertoroid against reference values with 50 digits behind them
//! (`tests/golden`, or the folder that `SUPERSURFACE_GOLDEN` names).

use serde_json::Value;
use supersurface::shape::{Implicit, Parametric, Posed, Superellipsoid, Supertoroid, SupportMap};
use supersurface::{Point, Pose, Vector};

pub(crate) fn golden(topic: &str) -> Value {
    let folder = std::env::var("SUPERSURFACE_GOLDEN")
        .unwrap_or_else(|_| format!("{}/tests/golden", env!("CARGO_MANIFEST_DIR")));
    let text = std::fs::read_to_string(format!("{folder}/{topic}.json")).unwrap();
    serde_json::from_str::<Value>(&text).unwrap()["data"].take()
}

pub(crate) fn numbers<const N: usize>(v: &Value) -> Option<[f64; N]> {
    let list = v.as_array()?;
    let mut out = [0.0; N];
    for (o, x) in out.iter_mut().zip(list) {
        *o = x.as_f64()?;
    }
    (list.len() == N).then_some(out)
}

fn ellipsoid(case: &Value) -> Superellipsoid {
    Superellipsoid::new(numbers(&case["a"]).unwrap(), numbers(&case["e"]).unwrap()).unwrap()
}

fn toroid(case: &Value) -> Supertoroid {
    let [a, b, c, ring] = numbers(&case["a"]).unwrap();
    Supertoroid::new([a, b, c], ring, numbers(&case["e"]).unwrap()).unwrap()
}

pub(crate) fn point(v: &Value) -> Point {
    Point::from(numbers::<3>(v).unwrap())
}

/// An angle is exact radians or an exact fraction of π.
fn angle(v: &Value) -> f64 {
    v["rad"].as_f64().unwrap_or_else(|| {
        v["num"].as_f64().unwrap() * std::f64::consts::PI / v["den"].as_f64().unwrap()
    })
}

pub(crate) fn close(name: &str, value: f64, truth: &Value, tolerance: f64) {
    let Some(truth) = truth.as_f64() else { return };
    assert!((value - truth).abs() <= tolerance, "{name}: {value} against {truth}");
}

/// Components that are `null` do not exist at that point.
pub(crate) fn close_vector(name: &str, value: &Vector, truth: &Value, relative: f64) {
    let list = truth.as_array().unwrap();
    let largest = list.iter().filter_map(Value::as_f64).fold(0.0f64, |m, v| m.max(v.abs()));
    for (v, t) in value.iter().zip(list) {
        close(name, *v, t, relative * largest.max(1e-300));
    }
}

#[test]
fn golden_implicit() {
    let data = golden("implicit");
    let mut cases = 0;
    for case in data["superellipsoid"].as_array().unwrap() {
        let (s, p) = (ellipsoid(case), point(&case["p"]));
        let g = s.gauge(&p);
        close("g", g, &case["g"], 1e-14 * g);
        close_vector("grad g", &s.gradient(&p), &case["grad_g"], 1e-12);
        cases += 1;
    }
    for case in data["supertoroid"].as_array().unwrap() {
        let (s, p) = (toroid(case), point(&case["p"]));
        let g = s.gauge(&p);
        close("G", g, &case["G"], 1e-14 * s.ring_ratio().max(1.0) * g.max(1.0));
        cases += 1;
    }
    assert!(cases >= 300, "{cases} cases");
}

#[test]
fn golden_parametric() {
    let mut cases = 0;
    for case in golden("parametric")["cases"].as_array().unwrap() {
        let (eta, omega) = (angle(&case["eta"]), angle(&case["omega"]));
        let (p, n) = if case["kind"] == "supertoroid" {
            (toroid(case).point(eta, omega), toroid(case).normal(eta, omega))
        } else {
            (ellipsoid(case).point(eta, omega), ellipsoid(case).normal(eta, omega))
        };
        close_vector("p", &p.coords, &case["p"], 1e-13);
        if let (Some(truth), Some(n)) = (numbers::<3>(&case["n"]), n) {
            assert!((n.into_inner() - Vector::from(truth)).amax() < 1e-12);
        } else {
            assert!(n.is_none() == case["n"].is_null(), "{case}");
        }
        cases += 1;
    }
    assert!(cases >= 150, "{cases} cases");
}

#[test]
fn golden_distance() {
    let data = golden("distance");
    let mut cases = 0;
    for case in data["superellipsoid"].as_array().unwrap() {
        let (s, p) = (ellipsoid(case), point(&case["p"]));
        let largest = s.semi_axes().into_iter().fold(0.0, f64::max);
        close("radial", s.radial_distance(&p), &case["radial"], 1e-12 * largest);
        let taubin = s.first_order_distance(&p).abs();
        close("taubin", taubin, &case["taubin1_g"], 1e-9 * taubin);
        cases += 1;
    }
    for case in data["supertoroid"].as_array().unwrap() {
        let (s, p) = (toroid(case), point(&case["p"]));
        let largest = s.semi_axes().into_iter().fold(0.0, f64::max) * (1.0 + s.ring_ratio());
        close("meridian", s.meridian_distance(&p), &case["meridian"], 1e-12 * largest);
        cases += 1;
    }
    assert!(cases >= 150, "{cases} cases");
}

#[test]
fn golden_support() {
    let data = golden("support");
    let mut cases = 0;
    for case in data["superellipsoid"].as_array().unwrap() {
        let (s, n) = (ellipsoid(case), Vector::from(numbers::<3>(&case["n"]).unwrap()));
        let x = s.support_point(&n);
        let h = n.dot(&x.coords);
        close("h", h, &case["h"], 1e-12 * h.abs());
        if !case["x"].is_null() {
            close_vector("x", &x.coords, &case["x"], 1e-11);
        }
        cases += 1;
    }
    for case in data["minkowski"].as_array().unwrap() {
        let n = Vector::from(numbers::<3>(&case["n"]).unwrap());
        let body = |which: &str| {
            let field = |name: &str| &case[format!("{name}_{which}")];
            let shape =
                Superellipsoid::new(numbers(field("a")).unwrap(), numbers(field("e")).unwrap())
                    .unwrap();
            let [w, x, y, z] = numbers(field("quat")).unwrap();
            let turn = supersurface::nalgebra::UnitQuaternion::from_quaternion(
                supersurface::nalgebra::Quaternion::new(w, x, y, z),
            );
            Posed::new(shape, Pose::from_parts(Vector::zeros().into(), turn)).unwrap()
        };
        let sum = body("A").support_point(&n).coords + body("B").support_point(&n).coords;
        close("h sum", n.dot(&sum), &case["h_sum"], 1e-11);
        close_vector("x sum", &sum, &case["x_sum"], 1e-10);
        cases += 1;
    }
    assert!(cases >= 120, "{cases} cases");
}

#[test]
fn golden_volume() {
    let data = golden("volume_inertia");
    let mut cases = 0;
    for case in data["superellipsoid"].as_array().unwrap() {
        let v = ellipsoid(case).volume();
        close("V", v, &case["V"], 1e-12 * v);
        cases += 1;
    }
    for case in data["supertoroid"].as_array().unwrap() {
        let v = toroid(case).volume();
        close("V", v, &case["V"], 1e-12 * v);
        cases += 1;
    }
    assert!(cases >= 80, "{cases} cases");
}
