//! Shape files: every type is read as what it is, and faults are named with their place.

use supersurface::Point;
use supersurface::shape::Implicit;
use supersurface_io::{Model, parse_shape};

fn read(text: &str) -> Model {
    parse_shape("file.json", text.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

/// The solid of a file contains one point and not another.
fn holds(text: &str, inside: [f64; 3], outside: [f64; 3]) {
    let contains = |p: [f64; 3]| match read(text) {
        Model::Solid(s) => s.contains(&Point::from(p)),
        Model::Implicit(_, s) => s.contains(&Point::from(p)),
        Model::Combined(s) => s.contains(&Point::from(p)),
        other => panic!("{other:?} has no inside"),
    };
    assert!(contains(inside), "{text}");
    assert!(!contains(outside), "{text}");
}

#[test]
fn every_type_of_solid_is_read() {
    let box_like = r#""semi_axes": [1, 1, 1], "exponents": [0.1, 0.1]"#;
    let base = r#""semi_axes": [1, 1, 1], "exponent": 1"#;
    let formula = r#"{"m": 4, "n": [2, 2, 2]}"#;
    let splines = r#""semi_axes": [1, 1, 1], "profile": [1, 1, 1], "section": [1, 1, 1, 1]"#;
    let (corner, out) = ([0.9, 0.9, 0.9], [1.1, 0.0, 0.0]);
    let (low, ball_out) = ([0.0, 0.0, -0.9], [0.8, 0.8, 0.0]);
    holds(&format!(r#"{{"type": "superellipsoid", {box_like}}}"#), corner, out);
    let ring =
        r#"{"type": "supertoroid", "semi_axes": [1, 1, 1], "ring_ratio": 3, "exponents": [1, 1]}"#;
    holds(ring, [0.0, 3.0, 0.0], [0.0; 3]);
    let third =
        r#"{"type": "separable_superquadric", "semi_axes": [1, 1, 1], "powers": [20, 20, 20]}"#;
    holds(third, [0.8, 0.8, 0.8], out);
    holds(&format!(r#"{{"type": "supercylinder", {base}}}"#), [0.7, 0.7, 0.99], ball_out);
    holds(&format!(r#"{{"type": "supercone", {base}}}"#), low, [0.5, 0.0, 0.5]);
    let shape =
        format!(r#"{{"type": "supershape", "longitude": {formula}, "latitude": {formula}}}"#);
    holds(&shape, low, ball_out);
    let hyper = r#"{"type": "hyperquadric", "planes": [[1, 0, 0, -5], [0, 1, 0, 0], [0, 0, 1, 0]], "exponents": [2, 2, 2]}"#;
    holds(hyper, [5.9, 0.0, 0.0], [0.0; 3]);
    holds(&format!(r#"{{"type": "radial_extended", {splines}}}"#), low, ball_out);
    assert!(matches!(
        read(&format!(r#"{{"type": "extended_superellipsoid", {splines}}}"#)),
        Model::Extended(_)
    ));
    let open = |name: &str| format!(r#"{{"type": "{name}", {box_like}}}"#);
    holds(&open("superparaboloid"), [0.0, 0.0, 9.0], [0.0, 0.0, -0.1]);
    holds(&open("superhyperboloid_one_sheet"), [0.0, 0.0, 9.0], [1.1, 0.0, 0.0]);
    holds(&open("superhyperboloid_two_sheets"), [9.0, 0.0, 0.0], [0.0; 3]);
    assert!(matches!(
        read(r#"{"type": "quadric", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, -1]}"#),
        Model::Quadric(_)
    ));
}

#[test]
fn poses_deformations_and_trees_are_applied_in_order() {
    let moved = r#"{"type": "superellipsoid", "semi_axes": [0.1, 0.1, 1], "exponents": [1, 1],
        "position": [5, 0, 0], "orientation_wxyz": [0.7071067811865476, 0, 0.7071067811865476, 0]}"#;
    holds(moved, [5.9, 0.0, 0.0], [5.0, 0.0, 0.9]);
    // twisted by half a turn and then bent, not the other way round
    let deformed = r#"{"type": "superellipsoid", "semi_axes": [0.3, 0.1, 1], "exponents": [0.1, 0.1],
        "deformations": [{"type": "twist", "turns": 0.5}, {"type": "bend", "curvature": 0.5}]}"#;
    let twisted_and_bent = {
        use supersurface::deform::{Bend, Deformed, Twist};
        let stick = supersurface::shape::Superellipsoid::new([0.3, 0.1, 1.0], [0.1, 0.1]).unwrap();
        let stick = Deformed::new(stick, Twist::new(0.5, 1.0).unwrap()).unwrap();
        Deformed::new(stick, Bend::new(0.5, 0.0).unwrap()).unwrap()
    };
    let Model::Solid(read) = read(deformed) else { panic!("no solid") };
    for p in [[0.1, 0.2, 0.3], [0.25, 0.0, -0.8], [-0.2, 0.05, 0.5]].map(Point::from) {
        assert!((read.gauge(&p) - twisted_and_bent.gauge(&p)).abs() < 1e-12);
    }
    let ball = r#"{"type": "superellipsoid", "semi_axes": [1, 1, 1], "exponents": [1, 1]}"#;
    let bar = r#"{"type": "supercylinder", "semi_axes": [0.5, 0.5, 2], "exponent": 1}"#;
    let tree = |kind: &str| format!(r#"{{"type": "{kind}", "of": [{ball}, {bar}]}}"#);
    holds(&tree("union"), [0.0, 0.0, 1.9], [1.1, 0.0, 0.0]);
    holds(&tree("intersection"), [0.0, 0.0, 0.9], [0.0, 0.0, 1.1]);
    holds(&tree("difference"), [0.9, 0.0, 0.0], [0.0; 3]);
    let moved =
        format!(r#"{{"type": "difference", "of": [{ball}, {bar}], "position": [7, 0, 0]}}"#);
    holds(&moved, [7.9, 0.0, 0.0], [0.9, 0.0, 0.0]);
    let blend = r#""blend": {"amount": 0.5, "reach": [1, 1]}"#;
    holds(
        &format!(r#"{{"type": "union", "of": [{ball}, {bar}], {blend}}}"#),
        [0.6, 0.0, 1.0],
        [3.0, 0.0, 0.0],
    );
}

#[test]
fn a_fit_and_its_named_deformations_are_read_as_a_shape() {
    let surface = |deformations: &str| {
        format!(
            r#"{{"type": "superellipsoid", "semi_axes": [0.3, 0.2, 1], "exponents": [0.5, 0.7],
                "deformations": {deformations}, "position": [0, 0, 5]}}"#
        )
    };
    let listed = surface(
        r#"[{"type": "taper", "slopes": [0.2, -0.1]}, {"type": "twist", "turns": 0.3},
            {"type": "bend", "curvature": 0.5, "angle": 0.4}]"#,
    );
    // named in any order, done in one
    let named =
        surface(r#"{"bend": {"k": 0.5, "alpha": 0.4}, "twist": 0.3, "taper": [0.2, -0.1]}"#);
    let fit = format!(
        r#"{{"format": "supersurface-fit", "version": 1, "status": "ok", "surface": {named}, "cpu_s": 1}}"#
    );
    let Model::Solid(wanted) = read(&listed) else { panic!("no solid") };
    for text in [&named, &fit] {
        let Model::Solid(read) = read(text) else { panic!("no solid") };
        for p in [[0.1, 0.2, 5.3], [0.25, 0.0, 4.2], [-0.2, 0.05, 5.5]].map(Point::from) {
            assert_eq!(read.gauge(&p), wanted.gauge(&p));
        }
    }
    let Model::Solid(read) = read(&surface(r#"{"twist": 0.5}"#)) else { panic!("no solid") };
    assert!(read.contains(&Point::new(0.0, 0.0, 5.9)));
}

#[test]
fn an_assembly_is_a_tree_of_named_parts() {
    let part = |name: &str, x: f64| {
        format!(
            r#"{{"name": "{name}", "density": 1000, "shape": {{"type": "superellipsoid",
                "semi_axes": [1, 1, 1], "exponents": [1, 1], "position": [{x}, 0, 0]}}}}"#
        )
    };
    let parts = [part("a", 0.0), part("b", 2.0), part("c", 4.0)].join(",");
    let joints = r#"[{"parent": "a", "child": "b", "anchor": [1, 0, 0], "spring": {"stiffness": 2}},
        {"parent": "b", "child": "c", "anchor": [3, 0, 0], "fixed": true}]"#;
    let text = format!(
        r#"{{"type": "assembly", "parts": [{parts}], "joints": {joints}, "position": [0, 0, 7]}}"#
    );
    let Model::Assembly(read) = read(&text) else { panic!("no assembly") };
    assert_eq!(read.parts()[2].name(), "c");
    assert_eq!(read.joints()[0].anchor(), Point::new(1.0, 0.0, 7.0));
    let last = read.poses(&read.rest_rotations())[2];
    assert_eq!(last.translation.vector, supersurface::Vector::new(4.0, 0.0, 7.0));
}

#[test]
fn faults_name_the_file_and_the_place() {
    let ball = r#"{"type": "superellipsoid", "semi_axes": [1, 1, 1], "exponents": [1, 1]}"#;
    let with = |more: &str| ball.replacen('}', &format!(", {more}}}"), 1);
    let cases = [
        ("[1]".to_owned(), "shape"),
        ("{".to_owned(), "line 1"),
        (r#"{"semi_axes": [1, 1, 1]}"#.to_owned(), "type"),
        (r#"{"type": "superellipsoid", "semi_axes": [1, 1], "exponents": [1, 1]}"#.into(), "shape"),
        (ball.replace("[1, 1, 1]", "[1, 1, 0]"), "a3"),
        (ball.replace("[1, 1, 1]", "[1, 1, 1e999]"), "number"),
        (with(r#""colour": "red""#), "colour"),
        (with(r#""position": [0, 0]"#), "shape.position"),
        (with(r#""orientation_wxyz": [2, 0, 0, 0]"#), "shape.orientation_wxyz"),
        (with(r#""orientation_wxyz": [0, 0, 0, 0]"#), "length 0"),
        (with(r#""deformations": [{"type": "taper", "slopes": [1, 0]}]"#), "deformations[0]"),
        (with(r#""deformations": [{"type": "melt"}]"#), "melt"),
        (with(r#""deformations": {"taper": [1, 0]}"#), "shape.deformations.taper"),
        (with(r#""deformations": {"melt": 1}"#), "melt"),
        (with(r#""deformations": 1"#), "shape.deformations"),
        (
            r#"{"format": "supersurface-fit", "surface": null, "error": "3 finite points"}"#.into(),
            "this fit failed: 3 finite points",
        ),
        (
            format!(r#"{{"format": "supersurface-fit", "surface": {}}}"#, with(r#""position": 1"#)),
            "surface.position",
        ),
        (
            with(r#""deformations": [{"type": "twist", "turns": 1}, {"type": "cavity", "depth": 1}]"#),
            "before any other",
        ),
        (r#"{"type": "union", "of": []}"#.to_owned(), "shape.of"),
        (format!(r#"{{"type": "union", "of": [{ball}, {{"type": "blob"}}]}}"#), "shape.of[1]"),
        (format!(r#"{{"type": "union", "of": [{ball}], "alpha": -1}}"#), "alpha"),
        (
            format!(
                r#"{{"type": "difference", "of": [{ball}], "blend": {{"amount": 1, "reach": [1, 1]}}}}"#
            ),
            "shape.blend",
        ),
        (
            format!(
                r#"{{"type": "union", "of": [{ball}], "deformations": [{{"type": "twist", "turns": 1}}]}}"#
            ),
            "shape.deformations",
        ),
        (
            r#"{"type": "quadric", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, -1], "position": [1, 0, 0]}"#.into(),
            "no pose",
        ),
        (r#"{"type": "assembly", "parts": []}"#.to_owned(), "number of parts"),
        (
            format!(
                r#"{{"type": "assembly", "parts": [{{"name": "a", "density": 1, "shape": {ball}}}],
                "joints": [{{"parent": "a", "child": "z", "anchor": [0, 0, 0]}}]}}"#
            ),
            "shape.joints[0]",
        ),
    ];
    for (text, wanted) in cases {
        let error = parse_shape("file.json", text.as_bytes()).err().map(|e| e.to_string());
        let error = error.unwrap_or_else(|| panic!("{text} was read"));
        assert!(error.contains("file.json") && error.contains(wanted), "{error}\n{text}");
    }
    // nested deeper than any shape
    let deep = r#"{"type": "union", "of": ["#.repeat(5000);
    assert!(parse_shape("file.json", deep.as_bytes()).is_err());
}
