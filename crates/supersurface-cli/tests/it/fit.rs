//! `supersurface fit`: what it finds, what it leaves, how it fails.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use serde_json::{Value, json};
use supersurface::Point;
use supersurface::measure::NearestFinder;
use supersurface::mesh::SurfaceSampler;
use supersurface::nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use supersurface::shape::{Parametric, Posed, Superellipsoid};
use supersurface::surface::Solid;
use supersurface_io::{Model, parse_shape};

use crate::{command, run, run_on, scratch, shared, text};

const TIN: [f64; 3] = [0.03, 0.03, 0.05];

/// The exact points of a tin at even angles, all lengths times `scale`.
fn tin(scale: f64) -> String {
    let tin = Superellipsoid::new(TIN, [0.2, 1.0]).unwrap();
    cloud((0..1600).map(|k| {
        let up = -1.5 + 3.0 * f64::from(k % 40) / 39.0;
        let p = tin.point(up, std::f64::consts::TAU * f64::from(k / 40) / 40.0);
        [p.x, p.y, p.z].map(|v| scale * v)
    }))
}

fn cloud(points: impl Iterator<Item = [f64; 3]>) -> String {
    points.fold(String::from("x y z\n"), |mut out, [x, y, z]| {
        let _ = writeln!(out, "{x:e} {y:e} {z:e}");
        out
    })
}

/// A folder of this test's own with these files in it.
fn folder(name: &str, files: &[(&str, &str)]) -> (PathBuf, Vec<PathBuf>) {
    let folder = scratch(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let paths = files.iter().map(|(name, content)| {
        let file = folder.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, content).unwrap();
        file
    });
    let paths = paths.collect();
    (folder, paths)
}

fn read_json(file: &Path) -> Value {
    serde_json::from_slice(&fs::read(file).unwrap()).unwrap()
}

fn axes(fit: &Value) -> [f64; 3] {
    std::array::from_fn(|k| fit["surface"]["semi_axes"][k].as_f64().unwrap())
}

#[test]
fn an_exact_tin_is_recovered_and_all_fields_are_there() {
    let fit = run_on(&["fit", "-", "--json"], tin(1.0).as_bytes()).ended(0).json();
    for (found, true_axis) in axes(&fit).into_iter().zip(TIN) {
        assert!((found / true_axis - 1.0).abs() < 1e-3, "{fit}");
    }
    assert_eq!(fit["format"], "supersurface-fit");
    assert_eq!(fit["version"], 1);
    assert_eq!(fit["status"], "ok");
    assert_eq!(fit["source"], "standard input");
    assert_eq!(fit["points"], 1600);
    assert_eq!(fit["family"], "superellipsoid");
    assert_eq!(fit["surface"]["type"], "superellipsoid");
    assert_eq!(fit["warnings"], json!([]));
    let number = |name: &str| fit[name].as_f64().unwrap_or_else(|| panic!("{name}: {fit}"));
    assert!(number("family_margin") >= 0.0);
    assert!(number("residual") < 1e-6 && number("noise") < 1e-5);
    assert!((0.99..=1.0).contains(&number("inlier_share")));
    assert!(number("iterations") >= 1.0);
    assert!(number("cpu_s") > 0.0 && number("time_s") > 0.0);
    assert!(["converged", "stuck", "rounds"].contains(&fit["stopped"].as_str().unwrap()));
    let covariance = &fit["covariance"];
    let names = ["a1", "a2", "a3", "e1", "e2", "x", "y", "z", "rx", "ry", "rz"];
    assert_eq!(covariance["parameters"], json!(names));
    for i in 0..names.len() {
        assert!(covariance["matrix"][i][i].as_f64().unwrap() >= 0.0);
        for k in 0..i {
            let [a, b] = [[i, k], [k, i]].map(|[r, c]| covariance["matrix"][r][c].as_f64());
            assert!((a.unwrap() - b.unwrap()).abs() <= 1e-9 * a.unwrap().abs(), "{i} {k}");
        }
    }
    // one that was asked for, and its words
    let ring = run_on(&["fit", "-", "--model", "tapered", "--json"], tin(1.0).as_bytes());
    let fit = ring.ended(0).json();
    assert_eq!(fit["family"], "tapered");
    assert_eq!(fit["surface"]["deformations"]["taper"].as_array().unwrap().len(), 2);
    let told = run_on(&["fit", "-"], tin(1.0).as_bytes()).ended(0).stdout;
    assert!(told.starts_with("standard input\n") && told.contains(", 50.00 mm"), "{told}");
}

#[test]
fn any_size_gives_the_same_shape() {
    let one = run_on(&["fit", "-", "--json"], tin(1.0).as_bytes()).ended(0).json();
    for scale in [1e-9, 1e9] {
        let fit = run_on(&["fit", "-", "--json"], tin(scale).as_bytes()).ended(0).json();
        for (k, axis) in axes(&fit).into_iter().enumerate() {
            assert!((axis / scale / axes(&one)[k] - 1.0).abs() < 1e-6, "{scale}: {fit}");
        }
        for k in 0..2 {
            let e = |f: &Value| f["surface"]["exponents"][k].as_f64().unwrap();
            assert!((e(&fit) / e(&one) - 1.0).abs() < 1e-6, "{scale}: {fit}");
        }
    }
    let in_mm = run_on(&["fit", "-", "--json", "--units", "mm"], tin(1e3).as_bytes());
    let in_mm = in_mm.ended(0).json();
    assert!((axes(&in_mm)[2] / TIN[2] - 1.0).abs() < 1e-3, "{in_mm}");
}

#[test]
fn what_is_no_cloud_of_an_object_is_told_and_costs_no_other() {
    let line = cloud((0..300).map(|k| [0.001 * f64::from(k), 0.002 * f64::from(k), 1.0]));
    let corner = |n: i32| {
        let (a, b) = (|k: i32| 0.1 * f64::from(k % 2), |k: i32| 0.1 * f64::from(k % 3));
        cloud((0..n).map(|k| [a(k), b(k), 0.1 * f64::from(k)]))
    };
    let cases = [
        ("none.xyz", corner(0), "there are no points"),
        ("one.xyz", corner(1), "1 finite points: a surface needs at least"),
        ("two.xyz", corner(2), "2 finite points"),
        ("three.xyz", corner(3), "3 finite points"),
        ("four.xyz", corner(4), "4 finite points"),
        ("line.xyz", line, "lie on one line"),
        ("same.xyz", cloud((0..300).map(|_| [0.1, 0.2, 0.3])), "points are the same"),
        ("nan.xyz", cloud((0..300).map(|_| [f64::NAN; 3])), "the others are not finite"),
        ("words.xyz", "1 2 3\n1 two 3\n".to_owned(), "line 2"),
        ("blob.pcd", "VERSION .7\nFIELDS\n".to_owned(), "PCD"),
    ];
    let good = tin(1.0);
    let mut files: Vec<(&str, &str)> = vec![("tin.xyz", &good)];
    files.extend(cases.iter().map(|(name, content, _)| (*name, content.as_str())));
    let (folder, paths) = folder("odd", &files);
    let out = folder.join("fits");
    let mut words = vec!["fit", "-o", text(&out), "missing.ply"];
    words.extend(paths.iter().map(|p| text(p)));
    // the first that failed gives the status
    let ran = run(&words).ended(3);
    assert!(ran.stdout.is_empty());
    assert_eq!(ran.stderr.matches("error: ").count(), 11, "{}", ran.stderr);
    assert_eq!(read_json(&out.join("tin.json"))["status"], "ok");
    assert_eq!(read_json(&out.join("missing.json"))["status"], "failed");
    for (name, _, wanted) in &cases {
        let fit = read_json(&out.join(name).with_extension("json"));
        assert_eq!(fit["status"], "failed", "{name}");
        assert!(fit["surface"].is_null() && fit.get("residual").is_none(), "{name}");
        let error = fit["error"].as_str().unwrap();
        assert!(error.contains(wanted) && error.contains(name), "{error}");
        assert!(ran.stderr.contains(error), "{error}");
        // a fit that failed is no shape
        let json = out.join(name).with_extension("json");
        assert!(run(&["info", text(&json)]).ended(3).stderr.contains(wanted));
    }
    let status = |name: &str| run(&["fit", text(&folder.join(name))]).status;
    assert_eq!([status("none.xyz"), status("words.xyz")], [Some(3), Some(3)]);
    for name in ["one.xyz", "four.xyz", "line.xyz", "same.xyz", "nan.xyz"] {
        assert_eq!(status(name), Some(4), "{name}");
    }
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let clouds: Vec<String> = [1.0, 2.0, 3.0, 4.0].map(tin).into();
    let files = ["a.xyz", "b.xyz", "c.xyz", "d.xyz"];
    let files: Vec<_> = files.into_iter().zip(clouds.iter().map(String::as_str)).collect();
    let (_, paths) = folder("threads", &files);
    let mut words: Vec<&str> = vec!["fit", "--json"];
    words.extend(paths.iter().map(|p| text(p)));
    let without_times = |threads: &str| -> String {
        let printed = run(&[&words[..], &["--threads", threads]].concat()).ended(0).stdout;
        let lines = printed.lines().map(|line| {
            let (head, tail) = line.split_once(",\"cpu_s\":").unwrap();
            assert!(tail.contains("\"time_s\""), "the times are the last fields");
            format!("{head}\n")
        });
        lines.collect()
    };
    let one = without_times("1");
    assert_eq!(one.lines().count(), 4);
    for (line, path) in one.lines().zip(&paths) {
        assert!(line.contains(&format!("\"source\":\"{}\"", text(path))), "in their order");
    }
    assert_eq!(one, without_times("2"));
}

#[test]
fn several_clouds_become_files_that_are_shapes() {
    let [small, large] = [tin(1.0), tin(2.0)];
    let (folder, paths) = folder("several", &[("small.xyz", &small), ("large.csv", &large)]);
    let out = folder.join("fits");
    let [one, other] = [&paths[0], &paths[1]].map(|p| text(p));
    let ran = run(&["fit", one, other, "-o", text(&out)]).ended(0);
    assert!(ran.stdout.is_empty() && ran.stderr.is_empty(), "{}", ran.stderr);
    assert!((axes(&read_json(&out.join("large.json")))[2] / 0.1 - 1.0).abs() < 1e-3);
    let (fit, mesh) = (out.join("small.json"), folder.join("small.ply"));
    let made = run(&["mesh", text(&fit), "-o", text(&mesh), "--json"]).ended(0).json();
    assert_eq!(made["watertight"], true);
    // one cloud into a folder, standard input among others, a file through a pipe
    run(&["fit", one, "-o", text(&folder)]).ended(0);
    assert!(folder.join("small.json").exists());
    run_on(&["fit", "-", other, "-o", text(&out)], small.as_bytes()).ended(0);
    assert_eq!(read_json(&out.join("standard_input.json"))["points"], 1600);
    let fit = run(&["fit", one, "--json"]).ended(0).stdout;
    let told = run_on(&["info", "-"], fit.as_bytes()).ended(0).stdout;
    assert!(told.contains("superellipsoid"), "{told}");
}

#[test]
fn no_file_is_written_over_another() {
    let good = tin(1.0);
    let (folder, paths) = folder(
        "places",
        &[("x.xyz", &good), ("in/x.csv", &good), ("x.json", &good), ("in/y.xyz", &good)],
    );
    let [one, same_stem, json, other] = [0, 1, 2, 3].map(|k| text(&paths[k]));
    let round = folder.join("in").join("..").join("x.xyz");
    for words in [
        &["fit", one, "-o", one][..],
        &["fit", one, "-o", text(&round)],
        &["fit", json, other, "-o", text(&folder)],
        &["fit", one, same_stem, "-o", text(&folder)],
        &["fit", one, one, "-o", text(&folder)],
        &["fit", one, other, "-o", one],
        &["fit", "-", "-"],
    ] {
        let ran = run(words).ended(2);
        assert!(ran.stdout.is_empty() && ran.stderr.starts_with("error: -"), "{}", ran.stderr);
    }
    for path in &paths {
        assert_eq!(fs::read_to_string(path).unwrap(), good);
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 3);
    let below_a_file = paths[0].join("fits");
    run(&["fit", one, "-o", text(&below_a_file)]).ended(5);
    run(&["fit", one, other, "-o", text(&below_a_file), "--json"]).ended(5);
}

#[test]
fn what_is_said_of_the_view_is_checked() {
    let tin_text = tin(1e3);
    let (_, paths) = folder("said", &[("tin.xyz", &tin_text)]);
    let tin = text(&paths[0]);
    for (option, value, wanted) in [
        ("--viewpoint", "1,2", "X,Y,Z"),
        ("--viewpoint", "1,2,nan", "X,Y,Z"),
        ("--plane", "0,0,1", "3 numbers"),
        ("--plane", "0,0,0,1", "normal"),
        ("--plane", "0,0,nan,1", "normal"),
        ("--plane", "0,0,1,inf", "offset"),
        ("--threads", "0", "threads"),
        ("--complete", "mirror", "--viewpoint"),
        ("--complete", "guess", "mirror"),
    ] {
        let ran = run(&["fit", tin, option, value]).ended(2);
        assert!(ran.stderr.contains(wanted), "{option} {value}: {}", ran.stderr);
    }
    let far = ["fit", tin, "--viewpoint", "1e308,0,0", "--units", "km"];
    assert!(run(&far).ended(2).stderr.contains("too far"));
    let fit = |more: &[&str]| {
        let ran = run(&[&["fit", tin, "--units", "mm", "--json"], more].concat()).ended(0);
        (axes(&ran.json()), ran.stderr)
    };
    let (free, told) = fit(&[]);
    assert!(told.is_empty(), "{told}");
    assert_eq!(fit(&["--viewpoint", "none"]).0, free);
    let (found, told) = fit(&["--viewpoint", "0,0,10"]);
    assert!(found == free && told.contains("lies within the object"), "{told}");
    // in the cloud's unit, whatever the length of the normal: the tin stands on z = -50 mm
    let plane = |text: &str| fit(&["--plane", text]);
    let (on, told) = plane("0,0,1,50");
    assert!(told.is_empty(), "{told}");
    assert_eq!(plane("0,0,8,400").0, on);
    assert!(plane("0,0,-1,-50").1.contains("must point towards"));
    // where a sensor saw nothing it writes its own place
    let zeros = tin_text + &"0.1 0 9e2\n".repeat(200);
    let seen = ["fit", "-", "--units", "mm", "--viewpoint", "0.1,0,9e2", "--json"];
    let ran = run_on(&seen, zeros.as_bytes()).ended(0);
    assert!(ran.stderr.contains("200 points lie at the viewpoint"), "{}", ran.stderr);
    assert!(ran.json()["residual"].as_f64().unwrap() < 1e-4, "{}", ran.stdout);
}

#[test]
fn a_view_completed_by_symmetry_is_judged_by_what_was_seen() {
    let eye = Point::new(0.3, -0.4, 0.3);
    let tin = Superellipsoid::new(TIN, [0.2, 1.0]).unwrap();
    let seen = (0..1600).filter_map(|k| {
        let up = -1.5 + 3.0 * f64::from(k % 40) / 39.0;
        let around = std::f64::consts::TAU * f64::from(k / 40) / 40.0;
        let p = tin.point(up, around);
        tin.normal(up, around).filter(|n| n.dot(&(eye - p)) > 0.0).map(|_| [p.x, p.y, p.z])
    });
    let seen: Vec<_> = seen.collect();
    let view = ["fit", "-", "--json", "--viewpoint", "0.3,-0.4,0.3", "--plane", "0,0,1,0.05"];
    let completed = [&view[..], &["--complete", "mirror"]].concat();
    let fit = run_on(&completed, cloud(seen.iter().copied()).as_bytes()).ended(0).json();
    assert_eq!(fit["points"], seen.len());
    for (found, true_axis) in axes(&fit).into_iter().zip(TIN) {
        assert!((found / true_axis - 1.0).abs() < 0.02, "{fit}");
    }
    assert!(fit["residual"].as_f64().unwrap() < 1e-4, "{fit}");
    assert!(fit["inlier_share"].as_f64().unwrap() > 0.95, "{fit}");
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let good = tin(1.0);
    let (_, paths) = folder("gone", &[("a.xyz", &good), ("b.xyz", &good)]);
    let mut command = command(&["fit", text(&paths[0]), text(&paths[1]), "--json"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The truth of a made cloud as a solid, and its size.
fn truth(file: &Path) -> (Posed<Solid>, f64) {
    let file = read_json(file);
    let mut shape = file["primitive"].clone();
    let turn = Matrix3::from_fn(|i, k| shape["R"][i][k].as_f64().unwrap());
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
    let mut deformations = json!({});
    for name in ["taper", "twist", "bend"] {
        if !shape[name].is_null() {
            deformations[name] = shape[name].take();
        }
    }
    let mut solid = json!({
        "type": shape["type"],
        "semi_axes": shape["a"].as_array().unwrap()[..3],
        "exponents": shape["e"],
        "deformations": deformations,
        "position": shape["t"],
        "orientation_wxyz": [turn.w, turn.i, turn.j, turn.k],
    });
    if !shape["a"][3].is_null() {
        solid["ring_ratio"] = shape["a"][3].take();
    }
    (solid_of(&solid.to_string()), file["size"].as_f64().unwrap())
}

fn solid_of(text: &str) -> Posed<Solid> {
    let Model::Solid(solid) = parse_shape("made", text.as_bytes()).unwrap() else {
        panic!("no solid: {text}")
    };
    solid
}

/// Root mean square distance of points spread over one surface from another.
fn apart(from: &Posed<Solid>, to: &Posed<Solid>) -> f64 {
    let sampler = SurfaceSampler::new(from.shape(), None).unwrap();
    let finder = NearestFinder::of_surface(to.shape());
    let points = sampler.points(50, 1);
    let squares = points.iter().map(|s| {
        let p: Point = to.pose().inverse() * (from.pose() * s.point);
        finder.find(&p).map_or(0.0, |found| found.distance).powi(2)
    });
    (squares.sum::<f64>() / points.len() as f64).sqrt()
}

#[test]
fn made_clouds_are_near_to_their_truth_with_and_without_a_hint() {
    let Some(shared) = shared() else { return };
    for (class, family) in [
        ("a_clean_n2000", "superellipsoid"),
        ("b_noise_1", "superellipsoid"),
        ("c_outlier_u20", "superellipsoid"),
        ("e_tor_clean", "supertoroid"),
        ("f_taper", "tapered"),
        ("f_bend", "bent"),
        ("f_twist", "twisted"),
        ("f_taper_bend", "tapered_bent"),
    ] {
        let file = shared.join(format!("data/fit/{class}/{class}_000.ply"));
        let (solid, size) = truth(&file.with_extension("gt.json"));
        for model in ["auto", family] {
            let fit = run(&["fit", text(&file), "--model", model, "--json"]).ended(0);
            let found = solid_of(&fit.stdout);
            let [over, under] = [apart(&found, &solid), apart(&solid, &found)].map(|d| d / size);
            assert!(over < 0.02 && under < 0.02, "{class} {model}: {over} {under}");
        }
    }
    // the hidden side of a single view is a guess
    let file = shared.join("data/fit/d_view_clean/d_view_clean_000.ply");
    let (solid, size) = truth(&file.with_extension("gt.json"));
    let fit = run(&["fit", text(&file), "--viewpoint", "0,0,0", "--json"]).ended(0);
    assert!(fit.json()["residual"].as_f64().unwrap() < 0.005 * size, "{}", fit.stdout);
    assert!(apart(&solid, &solid_of(&fit.stdout)) < 0.05 * size, "{}", fit.stdout);
}

/// The halves of a tin towards -x and +x, in the frames of sensors at (-0.5, 0, 0) and (0.5, 0, 0).
fn halves() -> [String; 2] {
    let tin = Superellipsoid::new(TIN, [0.2, 1.0]).unwrap();
    let all = SurfaceSampler::new(&tin, None).unwrap().points(3000, 1);
    [-1.0, 1.0].map(|side| {
        let seen = all.iter().map(|p| p.point).filter(|p| side * p.x > 0.0);
        cloud(seen.map(|p| [p.x - 0.5 * side, p.y, p.z]))
    })
}

#[test]
fn views_of_one_object_are_merged() {
    let [left, right] = halves();
    let (folder, files) = folder("fit_merge", &[("left.xyz", &left), ("right.xyz", &right)]);
    let [left, right] = [0, 1].map(|i| files[i].to_str().unwrap());
    let seen = ["--viewpoint", "0,0,0", "--model", "superellipsoid", "--json"];
    let merged = |poses: &[&str], more: &[&str]| {
        let mut args = vec!["fit", left, right, "--merge"];
        poses.iter().for_each(|pose| args.extend(["--pose", pose]));
        run(&[&args, &seen[..], more].concat())
    };
    let exact = ["-0.5,0,0,1,0,0,0", "0.5,0,0,1,0,0,0"];
    let fit = merged(&exact, &[]).ended(0).json();
    let mut found = axes(&fit);
    found.sort_by(f64::total_cmp);
    for (found, true_axis) in found.into_iter().zip(TIN) {
        assert!((found / true_axis - 1.0).abs() < 1e-2, "{fit}");
    }
    let points = [0, 1].map(|k| fit["views"][k]["points"].as_u64().unwrap());
    assert_eq!(points[0] + points[1], 3000);
    assert_eq!(fit["views"][1]["moved"]["position"], json!([0.0, 0.0, 0.0]));
    // the second view is 4 mm off: told so, it is moved back
    let off = ["-0.5,0,0,1,0,0,0", "0.5,0.004,0,1,0,0,0"];
    let out = folder.join("both.json");
    let told = ["--pose-error", "0.003,1", "-o", out.to_str().unwrap()];
    let fit = merged(&off, &told).ended(0).json();
    let back = fit["views"][1]["moved"]["position"][1].as_f64().unwrap();
    assert!((back + 0.004).abs() < 1e-3, "{}", fit["views"]);
    assert_eq!(read_json(&out)["views"], fit["views"]);
    for (poses, more, problem) in [
        (&exact[..1], &[][..], "--pose: 1 are given for 2 clouds"),
        (&["1,2", "3,4"][..], &[], "--pose: 2 numbers"),
        (&["a,b", "c"][..], &[], "--pose \"a,b\""),
        (&exact[..], &["--pose-error", "1"][..], "--pose-error"),
        (&exact[..], &["--pose-error", "-1,2"][..], "--pose-error"),
        (&exact[..], &["--viewpoint", "1,1,1", "--viewpoint", "0,1,1"][..], "--viewpoint"),
    ] {
        assert!(merged(poses, more).ended(2).stderr.contains(problem), "{problem}");
    }
    assert!(run(&["fit", left, "--pose", exact[0]]).ended(2).stdout.is_empty());
    let lost = run(&["fit", left, "nowhere.ply", "--merge", "--json"]).ended(3);
    assert_eq!(lost.json()["status"], "failed");
}
