//! Superellipsoid and supertoroid against reference values with 50 digits behind them
//! (`tests/golden`, or the folder that `SUPERSURFACE_GOLDEN` names).

use serde_json::Value;
use supersurface::measure::{Closest, ClosestFinder, first_order, second_order};
use supersurface::shape::{
    Implicit, Mass, MassProperties, Parametric, Posed, Superellipsoid, Supertoroid, SupportMap,
};
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
        let p1 = 2.0 / s.exponents()[0];
        let log = s.log_implicit_value(&p);
        close("ln F", log, &case["lnF"], 1e-13 * log.abs().max(1.0));
        let value = s.implicit_value(&p);
        close("F", value, &case["F"], 1e-13 * p1 * value);
        assert_eq!(value.is_finite(), !case["F"].is_null(), "{case}");
        if let Some(gradient) = s.implicit_gradient(&p) {
            close_vector("grad F", &gradient, &case["grad_F"], 1e-12);
        }
        cases += 1;
    }
    for case in data["supertoroid"].as_array().unwrap() {
        let (s, p) = (toroid(case), point(&case["p"]));
        let (g, ring) = (s.gauge(&p), s.ring_ratio().max(1.0));
        close("G", g, &case["G"], 1e-14 * ring * g.max(1.0));
        close("rho", s.planar_radius(&p), &case["rho"], 1e-14 * s.planar_radius(&p));
        cases += 1;
        // what G loses next to the centre line, all that is made of it loses too
        let lost = 1e-14 * ring / g.min(1.0);
        if lost > 1e-3 {
            continue;
        }
        let p1 = 2.0 / s.exponents()[0];
        let log = s.log_implicit_value(&p);
        close("ln F", log, &case["lnF"], 1e-13 * log.abs().max(1.0) + p1 * lost);
        let value = s.implicit_value(&p);
        close("F", value, &case["F"], p1 * (1e-13 + lost) * value);
        if let Some(gradient) = s.implicit_gradient(&p) {
            close_vector("grad F", &gradient, &case["grad_F"], 1e-12 + p1 * lost);
        }
    }
    assert!(cases >= 300, "{cases} cases");
}

#[test]
fn golden_parametric() {
    let mut cases = 0;
    for case in golden("parametric")["cases"].as_array().unwrap() {
        let (eta, omega) = (angle(&case["eta"]), angle(&case["omega"]));
        let shape: &dyn Parametric =
            if case["kind"] == "supertoroid" { &toroid(case) } else { &ellipsoid(case) };
        let (p, n) = (shape.point(eta, omega), shape.normal(eta, omega));
        close_vector("p", &p.coords, &case["p"], 1e-13);
        match shape.tangents(eta, omega) {
            // the set leaves out the tangents on all seams
            Some(_) if case["f_eta"].is_null() => {}
            Some([along, around]) => {
                close_vector("f_eta", &along, &case["f_eta"], 1e-11);
                close_vector("f_omega", &around, &case["f_omega"], 1e-11);
            }
            None => {
                let exists = |field: &str| numbers::<3>(&case[field]).is_some();
                assert!(!exists("f_eta") || !exists("f_omega"), "{case}");
            }
        }
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
    let euclid = |case: &Value, found: Option<Closest>, largest: f64| {
        let found = found.unwrap();
        close("euclid", found.distance, &case["euclid_signed"], 1e-11 * largest);
        if case["unique"] == true {
            let foot = point(&case["euclid_foot"]);
            assert!((found.point - foot).amax() < 1e-6 * largest, "{found:?} {case}");
        }
    };
    for case in data["superellipsoid"].as_array().unwrap() {
        let (s, p) = (ellipsoid(case), point(&case["p"]));
        let largest = s.semi_axes().into_iter().fold(0.0, f64::max);
        close("beta", 1.0 / s.gauge(&p), &case["beta"], 1e-12 / s.gauge(&p));
        close("radial", s.radial_distance(&p), &case["radial"], 1e-12 * largest);
        if let Some(foot) = s.radial_foot(&p) {
            close_vector("radial foot", &foot.coords, &case["radial_foot"], 1e-12);
        }
        let taubin = s.first_order_distance(&p).abs();
        close("taubin", taubin, &case["taubin1_g"], 1e-9 * taubin);
        let value = s.log_implicit_value(&p).exp_m1();
        let gradient = s.implicit_gradient(&p);
        if let Some(first) = gradient.and_then(|g| first_order(value, &g)) {
            close("taubin F", first, &case["taubin1_F"], 1e-9 * first);
        }
        let hessian = s.implicit_hessian(&p);
        if let Some(second) = gradient.zip(hessian).and_then(|(g, h)| second_order(value, &g, &h)) {
            close("taubin F, second", second, &case["taubin2_F"], 1e-9 * second);
        }
        euclid(case, ClosestFinder::superellipsoid(&s).find(&p), largest);
        cases += 1;
    }
    for case in data["supertoroid"].as_array().unwrap() {
        let (s, p) = (toroid(case), point(&case["p"]));
        let largest = s.semi_axes().into_iter().fold(0.0, f64::max) * (1.0 + s.ring_ratio());
        close("meridian", s.meridian_distance(&p), &case["meridian"], 1e-12 * largest);
        let foot = s.meridian_foot(&p).unwrap();
        close("omega_pi", foot.polar_angle, &case["omega_pi"], 1e-14);
        close("omega_s", foot.omega, &case["omega_s"], 1e-9);
        close("a_ws", foot.semi_axis, &case["a_ws"], 1e-12 * foot.semi_axis);
        close("beta1", foot.tube_scale, &case["beta1"], 1e-12 * foot.tube_scale);
        close("beta2", foot.mean_scale, &case["beta2"], 1e-12 * foot.mean_scale);
        close_vector("R_pi", &foot.mean_point.coords, &case["R_pi"], 1e-12);
        close_vector("p_s", &foot.foot.coords, &case["p_s"], 1e-12);
        if let Some(first) =
            s.implicit_gradient(&p).and_then(|g| first_order(s.log_implicit_value(&p).exp_m1(), &g))
        {
            close("taubin F", first, &case["taubin1_F"], 1e-9 * first);
        }
        euclid(case, ClosestFinder::supertoroid(&s).find(&p), largest);
        cases += 1;
    }
    for case in data["exact"].as_array().unwrap() {
        let (s, p) = (ellipsoid(case), point(&case["p"]));
        let largest = s.semi_axes().into_iter().fold(0.0, f64::max);
        euclid(case, ClosestFinder::superellipsoid(&s).find(&p), largest);
        cases += 1;
    }
    assert!(cases >= 180, "{cases} cases");
}

#[test]
fn golden_support() {
    let data = golden("support");
    let mut cases = 0;
    for case in data["superellipsoid"].as_array().unwrap() {
        let (s, n) = (ellipsoid(case), Vector::from(numbers::<3>(&case["n"]).unwrap()));
        let x = s.support_point(&n);
        let h = n.dot(&x.coords);
        close("h", h, &case["h"], 1e-13 * h.abs());
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
fn golden_volume_inertia() {
    let data = golden("volume_inertia");
    let mut cases = 0;
    let check = |case: &Value, volume: f64, mass: Mass, moment: &dyn Fn([u32; 3]) -> f64| {
        close("V", volume, &case["V"], 1e-12 * volume);
        close("mass", mass.mass, &case["V"], 1e-12 * volume);
        assert_eq!(mass.centre, Point::origin());
        for (k, i) in case["I"].as_array().unwrap().iter().enumerate() {
            close("I", mass.inertia[(k, k)], i, 1e-12 * mass.inertia[(k, k)]);
        }
        let moments = [
            ("mxx", [2, 0, 0]),
            ("myy", [0, 2, 0]),
            ("mzz", [0, 0, 2]),
            ("m_xxyy", [2, 2, 0]),
            ("m_zzzz", [0, 0, 4]),
        ];
        for (name, powers) in moments {
            let m = moment(powers);
            close(name, m, &case[name], 1e-12 * m);
        }
    };
    for case in data["superellipsoid"].as_array().unwrap() {
        let s = ellipsoid(case);
        check(case, s.volume(), s.mass_properties(1.0), &|p| s.moment(p));
        cases += 1;
    }
    for case in data["supertoroid"].as_array().unwrap() {
        let s = toroid(case);
        check(case, s.volume(), s.mass_properties(1.0), &|p| s.moment(p));
        cases += 1;
    }
    assert!(cases >= 80, "{cases} cases");
}

#[test]
fn golden_curvature() {
    let data = golden("curvature");
    let mut cases = 0;
    for case in data["cases"].as_array().unwrap() {
        let (eta, omega) = (case["eta"].as_f64().unwrap(), case["omega"].as_f64().unwrap());
        let (forms, normal, curvature) = if case["kind"] == "supertoroid" {
            let s = toroid(case);
            (
                s.fundamental_forms(eta, omega),
                s.normal_curvatures(eta, omega),
                s.curvature(eta, omega),
            )
        } else {
            let s = ellipsoid(case);
            (
                s.fundamental_forms(eta, omega),
                s.normal_curvatures(eta, omega),
                s.curvature(eta, omega),
            )
        };
        let (forms, curvature) = (forms.unwrap(), curvature.unwrap());
        let first = forms.first[0].max(forms.first[2]);
        for (name, value) in ["E", "F", "G"].into_iter().zip(forms.first) {
            close(name, value, &case[name], 1e-10 * first);
        }
        for (name, value) in ["L", "M", "N"].into_iter().zip(forms.second) {
            close(name, value, &case[name], 1e-10 * value.abs());
        }
        let [k1, k2] = curvature.principal;
        let largest = k1.abs().max(k2.abs());
        close("k1", k1, &case["k1"], 1e-10 * largest);
        close("k2", k2, &case["k2"], 1e-10 * largest);
        close("H", curvature.mean(), &case["H"], 1e-10 * largest);
        close("K", curvature.gaussian(), &case["K"], 1e-10 * (k1 * k2).abs());
        for (name, value) in ["k_eta", "k_omega"].into_iter().zip(normal) {
            close(name, value.unwrap(), &case[name], 1e-10 * largest);
        }
        cases += 1;
    }
    for case in data["seam"].as_array().unwrap() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let eta = if case["side"].as_i64() == Some(1) { 0.0 } else { 2.0 * quarter };
        let omega = if case["axis"].as_u64() == Some(0) { 0.0 } else { quarter };
        let (p, normal) = if case["kind"] == "supertoroid" {
            (toroid(case).point(eta, omega), toroid(case).normal_curvatures(eta, omega))
        } else {
            (ellipsoid(case).point(eta, omega), ellipsoid(case).normal_curvatures(eta, omega))
        };
        close_vector("p", &p.coords, &case["p"], 1e-13);
        for (name, value) in ["k_eta", "k_omega"].into_iter().zip(normal) {
            assert_eq!(value.is_none(), case[name].is_null(), "{name} {case}");
            value.inspect(|k| close(name, *k, &case[name], 1e-10 * k.abs()));
        }
        cases += 1;
    }
    assert!(cases >= 196, "{cases} cases");
}
