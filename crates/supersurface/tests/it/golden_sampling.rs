//! Points at equal distances along superellipses against reference values.

use supersurface::mesh::{SuperellipseArc, pilu_fisher_step};

use crate::golden_shapes::{golden, numbers};

#[test]
fn golden_sampling() {
    let mut cases = 0;
    for case in golden("sampling")["cases"].as_array().unwrap() {
        let value = |name: &str| case[name].as_f64().unwrap();
        let (axes, exponent) = ([value("A"), value("B")], value("e"));
        let arc = SuperellipseArc::new(axes, exponent).unwrap();
        let length = value("quarter_length");
        assert!((arc.quarter_length() / length - 1.0).abs() < 1e-10, "{case}");
        let points = case["equal_arc_points_6"].as_array().unwrap();
        for (point, truth) in arc.quarter_arcs(6).iter().skip(1).zip(points) {
            let [x, y] = numbers(truth).unwrap();
            let off = (point[0] - x).abs().max((point[1] - y).abs());
            // the set's points miss their own arc lengths by up to 1.3e-9 (seen on the circle, whose points are
            // known); its quarter lengths are good to 1e-15
            assert!(off < 5e-9 * axes[0].max(axes[1]), "{off} at {truth} of ε = {exponent}");
        }
        if exponent == 1.0 && axes[0] == axes[1] {
            for (i, [x, y]) in arc.quarter_arcs(6).into_iter().enumerate() {
                let (sin, cos) = (i as f64 * std::f64::consts::PI / 12.0).sin_cos();
                assert!((x - axes[0] * cos).abs().max((y - axes[0] * sin).abs()) < 1e-13);
            }
        }
        for step in case["pilu_fisher"].as_array().unwrap() {
            let number = |name: &str| step[name].as_f64().unwrap();
            let found = pilu_fisher_step(axes, exponent, number("theta"), number("D"));
            let truth = number("dtheta");
            assert!((found - truth).abs() < 1e-10 * truth.abs(), "{found} {step}");
        }
        cases += 1;
    }
    assert!(cases >= 7, "{cases} cases");
}
