//! The command about two bodies: `contact`.

use std::fs;
use std::process::Stdio;

use serde_json::{Value, json};

use crate::{command, run, run_on, scratch, text};

/// A box as JSON, x along the table.
fn boxed(x: f64) -> String {
    format!(
        r#"{{"type": "superellipsoid", "semi_axes": [0.02, 0.03, 0.04], "exponents": [0.1, 0.1], "position": [{x}, 0, 0]}}"#
    )
}

/// A list of pairs of balls of 1 m, so far apart.
fn balls(distances: &[f64]) -> String {
    let ball = |x: f64| json!({"a": [1, 1, 1], "e": [1, 1], "q": [1, 0, 0, 0], "t": [x, 0, 0]});
    let case =
        |(i, d): (usize, &f64)| json!({"id": format!("p{i}"), "A": ball(0.0), "B": ball(2.0 + d)});
    Value::from(distances.iter().enumerate().map(case).collect::<Vec<_>>()).to_string()
}

fn lines(text: &str) -> Vec<Value> {
    text.lines().map(|l| serde_json::from_str(l).unwrap_or_else(|e| panic!("{e}: {l}"))).collect()
}

#[test]
fn boxes_are_apart_touch_or_overlap() {
    let [a, b] = ["contact_a.json", "contact_b.json"].map(scratch);
    fs::write(&a, boxed(0.0)).unwrap();
    for (x, told) in
        [(0.05, "apart by 10.000 mm"), (0.03, "overlapping by 10.000 mm"), (0.04, "touching")]
    {
        fs::write(&b, boxed(x)).unwrap();
        let out = run(&["contact", text(&a), text(&b)]).ended(0).stdout;
        assert!(out.starts_with(&format!("{told}\n  bounds ")), "{out}");
        assert!(out.contains("(1.00000, 0.00000, 0.00000), from A to B"), "{out}");
        assert!(out.contains("contact_b.json"), "{out}");
        // the same by standard input and by JSON itself
        let input = run_on(&["contact", text(&a), "-"], boxed(x).as_bytes()).ended(0).stdout;
        assert!(input.starts_with(told) && input.contains("standard input"), "{input}");
        let itself = run(&["contact", &boxed(0.0), &boxed(x)]).ended(0).stdout;
        assert!(itself.starts_with(told), "{itself}");
    }
    // bodies of metres are told in metres
    let [a, b] = [0.0, 5.0].map(|x| boxed(x).replace("[0.02, 0.03, 0.04]", "[2, 3, 4]"));
    assert!(run(&["contact", &a, &b]).ended(0).stdout.starts_with("apart by 1.0000 m\n"));
}

#[test]
fn json_has_the_fields_of_a_contact() {
    let told = run(&["contact", &boxed(0.0), &boxed(0.03), "--json"]).ended(0).json();
    assert_eq!([&told["format"], &told["version"]], [&json!("supersurface-contact"), &json!(1)]);
    assert!((told["distance"].as_f64().unwrap() + 0.01).abs() < 1e-12, "{told}");
    let width = |told: &Value| {
        let [low, high] = [0, 1].map(|k| told["bounds"][k].as_f64().unwrap());
        assert!(low <= -0.01 + 1e-12 && -0.01 - 1e-12 <= high, "{told}");
        high - low
    };
    assert!(width(&told) < 1e-3 * 0.04);
    assert!((told["normal"][0].as_f64().unwrap() - 1.0).abs() < 1e-9, "{told}");
    let points = [0, 1].map(|k| told["witnesses"][k][0].as_f64().unwrap());
    assert!((points[0] - 0.02).abs() < 1e-9 && (points[1] - 0.01).abs() < 1e-9, "{told}");
    let common = told["common_point"][0].as_f64().unwrap();
    assert!((0.01..=0.02).contains(&common), "{told}");
    assert!(
        run(&["contact", &boxed(0.0), &boxed(0.05), "--json"]).json()["common_point"].is_null()
    );
    let words = ["contact", &boxed(0.0), &boxed(0.03), "--json", "--certify", "1e-9"];
    assert!(width(&run(&words).ended(0).json()) < 1.1e-9);
    assert!(include_str!("../../../../docs/contact.md").contains("`witnesses`"));
}

#[test]
fn a_fit_is_a_body() {
    let [cloud, fit] = ["contact_tin.ply", "contact_tin.json"].map(scratch);
    let tin =
        ["sample", "--superellipsoid", "0.03,0.03,0.05,0.1,1", "-n", "2000", "-o", text(&cloud)];
    run(&tin).ended(0);
    let words = ["fit", text(&cloud), "--model", "superellipsoid", "-o", text(&fit)];
    run(&words).ended(0);
    let told = run(&["contact", text(&fit), &boxed(0.1), "--json"]).ended(0).json();
    assert!((told["distance"].as_f64().unwrap() - 0.05).abs() < 1e-4, "{told}");
}

#[test]
fn the_picture_shows_both_bodies_and_the_points() {
    for x in [0.05, 0.03] {
        let file = scratch("contact.png");
        run(&["contact", &boxed(0.0), &boxed(x), "--png", text(&file)]).ended(0);
        let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(&file).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let count = |wanted: fn(i32, i32, i32) -> bool| {
            let pixels = pixels.chunks(3);
            pixels.filter(|p| wanted(p[0].into(), p[1].into(), p[2].into())).count()
        };
        let blue = count(|r, _, b| b > r + 30);
        let orange = count(|r, _, b| r > b + 30);
        let red = count(|r, g, b| r > 150 && g < 60 && b < 80);
        assert!(blue > 10_000 && orange > 10_000 && red > 150, "{blue} {orange} {red}");
    }
}

#[test]
fn a_ring_and_a_body_answer_in_both_orders() {
    let ring =
        r#"{"type": "supertoroid", "semi_axes": [1, 1, 1], "ring_ratio": 3, "exponents": [1, 1]}"#;
    let ball = |x: f64| {
        format!(
            r#"{{"type": "superellipsoid", "semi_axes": [1, 1, 1], "exponents": [1, 1], "position": [{x}, 0, 0]}}"#
        )
    };
    for (x, distance) in [(0.0, 1.0), (0.5, 0.5), (1.25, -0.25), (5.25, 0.25)] {
        let ball = ball(x);
        let told = [[ring, &ball], [&ball, ring]].map(|[a, b]| {
            let ran = run(&["contact", a, b, "--json"]).ended(0);
            serde_json::from_str::<Value>(&ran.stdout).unwrap()
        });
        for contact in &told {
            let found = contact["distance"].as_f64().unwrap();
            assert!((found - distance).abs() < 1e-9, "{x} {contact}");
        }
        let normal = |k: usize| told[k]["normal"][0].as_f64().unwrap();
        assert!((normal(0) + normal(1)).abs() < 1e-9, "{told:?}");
    }
}

#[test]
fn deformed_bodies_and_two_rings_answer() {
    let cup =
        boxed(0.0).replace('}', r#", "deformations": [{"type": "taper", "slopes": [0.2, 0.2]}]}"#);
    let far = boxed(0.5);
    let told = run(&["contact", &cup, &far, "--json"]).ended(0).stdout;
    let told: Value = serde_json::from_str(&told).unwrap();
    assert!(told["distance"].as_f64().unwrap() > 0.3, "{told}");
    let ring = |x: f64, turn: &str| {
        format!(
            r#"{{"type": "supertoroid", "semi_axes": [1, 1, 1], "ring_ratio": 4, "exponents": [1, 1], "position": [{x}, 0, 0], "orientation_wxyz": {turn}}}"#
        )
    };
    // two links of a chain
    let [flat, upright] =
        [ring(0.0, "[1, 0, 0, 0]"), ring(4.0, "[0.7071067811865476, 0.7071067811865476, 0, 0]")];
    let ran = run(&["contact", &flat, &upright]).ended(0);
    assert!(ran.stdout.starts_with("apart by 2.0"), "{}", ran.stdout);
}

#[test]
fn other_members_are_refused_with_what_to_do() {
    let toroid = r#"{"type": "supertoroid", "semi_axes": [1, 1, 1], "ring_ratio": 3, "exponents": [2.5, 1]}"#;
    let sharp = r#"{"type": "superellipsoid", "semi_axes": [1, 1, 1], "exponents": [1, 2.5]}"#;
    let wrong_order = boxed(0.0).replace(
        '}',
        r#", "deformations": [{"type": "twist", "turns": 0.1}, {"type": "taper", "slopes": [0.2, 0.2]}]}"#,
    );
    let cylinder = r#"{"type": "supercylinder", "semi_axes": [1, 1, 1], "exponent": 1}"#;
    let union = format!(r#"{{"type": "union", "of": [{}, {}]}}"#, boxed(0.0), boxed(1.0));
    let assembly = format!(
        r#"{{"type": "assembly", "parts": [{{"name": "a", "density": 1, "shape": {}}}], "joints": []}}"#,
        boxed(0.0)
    );
    let quadric = r#"{"type": "quadric", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, -1]}"#;
    let bowl = r#"{"type": "superparaboloid", "semi_axes": [1, 1, 1], "exponents": [1, 1]}"#;
    let file = scratch("other.json");
    for (shape, member, mend) in [
        (toroid, "supertoroid whose exponent ε1 is 2.5", "encloses"),
        (sharp, "superellipsoid whose exponent ε2 is 2.5", "2 instead"),
        (&wrong_order, "superellipsoid, twisted, tapered", "encloses"),
        (cylinder, "supercylinder", "superellipsoid where it is one"),
        (&union, "combination", "parts one by one"),
        (&assembly, "assembly", "parts one by one"),
        (quadric, "quadric", "exponents [1, 1]"),
        (bowl, "superparaboloid", "encloses"),
    ] {
        fs::write(&file, shape).unwrap();
        for words in [[text(&file), &boxed(0.0)], [&boxed(0.0), text(&file)]] {
            let ran = run(&["contact", words[0], words[1]]).ended(3);
            let wanted = ["other.json", member, mend];
            assert!(wanted.iter().all(|w| ran.stderr.contains(w)), "{wanted:?}: {}", ran.stderr);
        }
    }
}

#[test]
fn wrong_use_is_told_with_its_status() {
    let [list, out] = ["contact_list.json", "contact_never.jsonl"].map(scratch);
    fs::write(&list, balls(&[1.0])).unwrap();
    let (a, b) = (boxed(0.0), boxed(0.05));
    let cases: [(&[&str], i32, &str); 14] = [
        (&[], 2, "<A>"),
        (&[&a], 2, "<B>"),
        (&["-", "-"], 2, "only one"),
        (&[&a, "no-such-file.json"], 3, "no-such-file.json"),
        (&[&a, "{]"], 3, "command line"),
        (&[&a, &b, "--certify", "0"], 2, "--certify"),
        (&[&a, &b, "--certify", "nan"], 2, "--certify"),
        (&[&a, &b, "--png", "/no_such_folder/p.png"], 5, "/no_such_folder/p.png"),
        (&[&a, &b, "--repeat", "3"], 2, "--cases"),
        (&["--cases", text(&list)], 2, "--output"),
        (&["--cases", text(&list), "-o", text(&list)], 2, "the file is read"),
        (&["--cases", "no-such-list.json", "-o", text(&out)], 3, "no-such-list.json"),
        (&["--cases", text(&list), "-o", "/no_such_folder/o"], 5, "/no_such_folder/o"),
        (&["--cases", text(&list), "-o", "-", "--threads", "0"], 2, "--threads"),
    ];
    for (words, status, wanted) in cases {
        let ran = run(&[&["contact"], words].concat()).ended(status);
        assert!(ran.stderr.contains(wanted), "{words:?}: {}", ran.stderr);
    }
    let broken =
        run_on(&["contact", "--cases", "-", "-o", text(&out)], b"[{\"id\": 1},\n {]").ended(3);
    assert!(broken.stderr.contains("standard input") && broken.stderr.contains("line 2, column 3"));
    assert!(!out.exists());
    // a picture that fails costs no answer
    let ran = run(&["contact", &a, &b, "--png", "/no_such_folder/p.png"]).ended(5);
    assert!(ran.stdout.starts_with("apart by"), "{}", ran.stdout);
}

#[test]
fn lists_are_answered_in_their_order() {
    let list = balls(&[1.0, 0.5, -0.5]);
    let told = run_on(&["contact", "--cases", "-", "-o", "-", "--repeat", "2"], list.as_bytes());
    let told = lines(&told.ended(0).stdout);
    let ids: Vec<&str> = told.iter().filter_map(|l| l["id"].as_str()).collect();
    assert_eq!(ids, ["p0", "p1", "p2"]);
    for (line, distance) in told.iter().zip([1.0, 0.5, -0.5]) {
        assert!((line["signed_distance"].as_f64().unwrap() - distance).abs() < 1e-12, "{line}");
        assert!(line["ns"].as_f64().unwrap() > 10.0 && line["status"] == "ok", "{line}");
        assert!(line["lo"].as_f64() <= line["signed_distance"].as_f64(), "{line}");
    }
    // without times the same on any number of threads
    let many: Vec<f64> = (0..300).map(|i| 0.01 * f64::from(i) - 1.5).collect();
    let many = balls(&many);
    let answers = |threads: &[&str]| {
        let words = [&["contact", "--cases", "-", "-o", "-", "--repeat", "0"], threads].concat();
        run_on(&words, many.as_bytes()).ended(0).stdout
    };
    let one = answers(&["--threads", "1"]);
    assert!(!one.contains("\"ns\""), "{one}");
    assert_eq!(one, answers(&["--threads", "4"]));
    assert_eq!(one, answers(&[]));
}

#[test]
fn a_broken_pair_is_a_line_and_the_rest_is_answered() {
    let list = balls(&[1.0; 5]);
    let mut cases: Vec<Value> = serde_json::from_str(&list).unwrap();
    cases[0]["A"]["a"] = json!([1, 1, -1]);
    cases[1]["B"]["e"] = json!([2.5, 1]);
    cases[2]["A"].as_object_mut().unwrap().remove("t");
    cases[3]["A"]["q"] = json!([0, 0, 0, 0]);
    let list = Value::from(cases).to_string();
    let ran = run_on(&["contact", "--cases", "-", "-o", "-", "-q"], list.as_bytes()).ended(0);
    let told = lines(&ran.stdout);
    for (line, wanted) in told.iter().zip(["a3 is -1", "ε1 is 2.5", "A.t: is missing", "A.q", "ok"])
    {
        assert!(line["status"].as_str().unwrap().contains(wanted), "{line}");
        assert_eq!(line["signed_distance"].is_null(), wanted != "ok", "{line}");
    }
    assert!(ran.stderr.contains("4 of 5 pairs have no answer"), "{}", ran.stderr);
    // nothing is a list too
    let out = scratch("contact_none.jsonl");
    run_on(&["contact", "--cases", "-", "-o", text(&out)], b"[]").ended(0);
    assert_eq!(fs::read(&out).unwrap(), b"");
}

#[test]
fn numbers_at_the_ends_of_their_range_are_answered_or_refused() {
    let mut cases = Vec::new();
    for a in [5e-324, 1e-300, 1e-150, 1.0, 1e150, 1.7e308] {
        for t in [0.0, 1e-300, 1.0, 1e150, -1.7e308] {
            for e in [5e-324, 1e-9, 1.9, 2.0] {
                let body = |t: f64| json!({"a": [a, 1, 0.1], "e": [e, 0.1], "q": [0.5, 0.5, 0.5, 0.5], "t": [t, t, 0]});
                cases.push(json!({"id": cases.len(), "A": body(0.0), "B": body(t)}));
            }
        }
    }
    let list = Value::from(cases).to_string();
    let words = ["contact", "--cases", "-", "-o", "-", "--repeat", "0"];
    let told = lines(&run_on(&words, list.as_bytes()).ended(0).stdout);
    assert_eq!(told.len(), 120);
    for line in told {
        let [lo, distance, hi] = ["lo", "signed_distance", "hi"].map(|k| line[k].as_f64());
        match line["status"].as_str() {
            Some("ok") => assert!(lo.is_some() && lo <= distance && distance <= hi, "{line}"),
            status => assert!(status.unwrap().contains("overflow") && distance.is_none(), "{line}"),
        }
    }
}

#[test]
fn a_reader_of_answers_that_goes_away_is_no_failure() {
    let list = scratch("contact_pipe.json");
    fs::write(&list, balls(&[0.5; 2000])).unwrap();
    let mut command = command(&["contact", "--cases", text(&list), "-o", "-", "--repeat", "0"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}
