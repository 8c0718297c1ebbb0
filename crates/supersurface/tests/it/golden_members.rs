//! The other members of the family and general quadrics against reference values with 50 digits.

use serde_json::Value;
use supersurface::shape::{
    Implicit, MassProperties, Parametric, Quadric, Sheet, Supercone, Supercylinder,
    SuperhyperboloidOneSheet, SuperhyperboloidTwoSheets, Superparaboloid,
};
use supersurface::{Point, Vector};

use crate::golden_shapes::{golden, numbers};

fn number(case: &Value, field: &str) -> f64 {
    case[field].as_f64().unwrap()
}

fn near(value: f64, case: &Value, field: &str, relative: f64) {
    let truth = number(case, field);
    assert!((value - truth).abs() <= relative * truth.abs(), "{field}: {value} against {truth}");
}

fn near_vector(value: &Vector, case: &Value, field: &str, relative: f64) {
    let truth = Vector::from(numbers::<3>(&case[field]).unwrap());
    assert!((value - truth).amax() <= relative * truth.amax(), "{field}: {value} not {truth}");
}

/// `F` is a difference of two terms, which may be close to each other.
fn near_value(value: f64, case: &Value, field: &str, terms: f64) {
    let truth = number(case, field);
    let scale = 1e-11 * truth.abs() + 1e-14 * terms;
    assert!((value - truth).abs() <= scale, "{field}: {value} against {truth}");
}

#[test]
fn golden_general_members() {
    let data = golden("general");
    let mut cases = 0;
    let read =
        |case: &Value| (numbers::<3>(&case["a"]).unwrap(), numbers::<2>(&case["e"]).unwrap());
    for case in data["superhyperboloid"].as_array().unwrap() {
        let (a, e) = read(case);
        let [eta, omega, second] = ["eta", "omega", "omega2"].map(|f| number(case, f));
        let q = Point::from(numbers::<3>(&case["q"]).unwrap());

        let one = SuperhyperboloidOneSheet::new(a, e).unwrap();
        let p = one.point(eta, omega);
        near_vector(&p.coords, case, "one_sheet_point", 1e-11);
        assert!((one.gauge(&p) - 1.0).abs() < 1e-12);
        near_vector(&one.normal(eta, omega).unwrap(), case, "one_sheet_grad_dir", 1e-11);
        near_vector(&one.gradient(&p).normalize(), case, "one_sheet_grad_dir", 1e-9);
        near_value(one.implicit_value(&q), case, "F_one", 1.0);

        let two = SuperhyperboloidTwoSheets::new(a, e).unwrap();
        let sheet = if case["sheet"] == 1 { Sheet::Positive } else { Sheet::Negative };
        let p = two.point_on(sheet, eta, second);
        near_vector(&p.coords, case, "two_sheet_point", 1e-11);
        assert!((two.gauge(&p) - 1.0).abs() < 1e-12);
        // F grows into the sheets, the gauge out of them
        let n = -two.normal_on(sheet, eta, second).unwrap().into_inner();
        near_vector(&n, case, "two_sheet_grad_dir", 1e-11);
        near_vector(&-two.gradient(&p).normalize(), case, "two_sheet_grad_dir", 1e-9);
        match two.implicit_value(&q) {
            Some(value) => near_value(value, case, "F_two", 1.0),
            None => assert!(case["F_two"].is_null()),
        }
        cases += 1;
    }
    for case in data["superparaboloid"].as_array().unwrap() {
        let (a, e) = read(case);
        let s = Superparaboloid::new(a, e).unwrap();
        let (u, omega) = (number(case, "u"), number(case, "omega"));
        let p = s.point(u, omega);
        near_vector(&p.coords, case, "point", 1e-11);
        assert!((s.gauge(&p) - 1.0).abs() < 1e-12);
        let q = Point::from(numbers::<3>(&case["q"]).unwrap());
        near_value(s.implicit_value(&q), case, "F", (q.z / a[2]).abs());
        cases += 1;
    }
    for case in data["supercylinder_cone"].as_array().unwrap() {
        let (a, e2) = (numbers::<3>(&case["a"]).unwrap(), number(case, "e2"));
        let p = Point::from(numbers::<3>(&case["p"]).unwrap());
        near(Supercylinder::new(a, e2).unwrap().gauge(&p), case, "g_cyl", 1e-11);
        let cone = Supercone::new(a, e2).unwrap();
        near_value(cone.implicit_value(&p), case, "f_cone", number(case, "rho"));
        assert_eq!(cone.contains(&p), case["inside_cone"] == true);
        cases += 1;
    }
    assert!(cases >= 90, "{cases} cases");
}

#[test]
fn golden_supercylinder_supercone() {
    let mut cases = 0;
    for case in golden("volume_inertia")["supercylinder_supercone"].as_array().unwrap() {
        let (a, e2) = (numbers::<3>(&case["a"]).unwrap(), number(case, "e2"));
        let (cylinder, cone) = (Supercylinder::new(a, e2).unwrap(), Supercone::new(a, e2).unwrap());
        near(cylinder.volume() / (2.0 * a[2]), case, "base_area", 1e-12);
        near(cylinder.volume(), case, "V_cyl", 1e-12);
        near(cone.volume(), case, "V_cone", 1e-12);
        let mass = cone.mass_properties(1.0);
        near(mass.mass, case, "V_cone", 1e-12);
        near(mass.centre.z, case, "z_centroid_cone", 1e-12);
        near(cylinder.mass_properties(1.0).mass, case, "V_cyl", 1e-12);
        cases += 1;
    }
    assert!(cases >= 8, "{cases} cases");
}

#[test]
fn golden_quadric() {
    let mut cases = 0;
    for case in golden("quadric")["cases"].as_array().unwrap() {
        let q = Quadric::new(numbers(&case["coeffs_ABCDEFGHIJ"]).unwrap()).unwrap();
        let form = q.normal_form();
        assert_eq!(form.kind.name(), case["type"].as_str().unwrap(), "{form:?}");
        assert_eq!(form.rank as u64, case["rank"].as_u64().unwrap());
        near_vector(&Vector::from(form.eigenvalues), case, "eigenvalues_sorted", 1e-10);
        match form.centre() {
            Some(c) if c.coords.norm() > 1e-9 => near_vector(&c.coords, case, "center", 1e-10),
            Some(_) => assert_eq!(numbers::<3>(&case["center"]), Some([0.0; 3])),
            None => assert!(case["center"].is_null()),
        }
        if !case["semi_axes_sorted_desc"].is_null() {
            let mut axes = form.semi_axes().map(Option::unwrap);
            axes.sort_by(|a, b| b.total_cmp(a));
            near_vector(&Vector::from(axes), case, "semi_axes_sorted_desc", 1e-10);
        }
        assert_eq!(q.as_ellipsoid().is_some(), case["type"] == "ellipsoid");
        // the equation times -1 is the same quadric
        let turned = Quadric::new(q.coefficients().map(|v| -v)).unwrap().normal_form();
        assert_eq!(turned.kind, form.kind);
        cases += 1;
    }
    assert!(cases >= 51, "{cases} cases");
}
