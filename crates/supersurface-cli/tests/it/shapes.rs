//! The commands about one shape: info, mesh, sample, gallery.

use std::fs;

use crate::{run, run_on, scratch};

const TIN: &str = "0.03,0.03,0.05,0.1,1";
const BEAD: &str = r#"{"type": "difference", "of": [
    {"type": "superellipsoid", "semi_axes": [0.05, 0.05, 0.05], "exponents": [1, 1]},
    {"type": "supercylinder", "semi_axes": [0.02, 0.02, 0.2], "exponent": 1}]}"#;

#[test]
fn info_says_how_large_and_how_heavy() {
    let told =
        run(&["info", "--superellipsoid", "1,1,1,1,1", "--density", "3", "--json"]).ended(0).json();
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    assert!((told["mass"]["volume"].as_f64().unwrap() / ball - 1.0).abs() < 1e-12);
    assert!((told["mass"]["mass"].as_f64().unwrap() / ball - 3.0).abs() < 1e-12);
    assert_eq!(told["bounds"]["high"][2], 1.0);
    assert_eq!(told["convex"], true);
    // the same by file, by standard input and by flags
    let text = r#"{"type": "superellipsoid", "semi_axes": [0.03, 0.03, 0.05], "exponents": [0.1, 1],
        "deformations": [{"type": "taper", "slopes": [0.2, 0.1]}]}"#;
    let file = scratch("shape.json");
    fs::write(&file, text).unwrap();
    let by_file = run(&["info", file.to_str().unwrap()]).ended(0).stdout;
    let by_input = run_on(&["info", "-"], text.as_bytes()).ended(0).stdout;
    let by_flags = run(&["info", "--superellipsoid", TIN, "--taper", "0.2,0.1"]).ended(0).stdout;
    assert!(by_file.contains("superellipsoid, tapered"), "{by_file}");
    assert_eq!(by_file, by_input);
    assert_eq!(by_file, by_flags);
    // a ball with a hole through it: 4/3 π (R² - r²)^(3/2), where half the hole is √(R² - r²) long
    let bead = run(&["info", BEAD, "--json"]).ended(0).json();
    let half_hole = (0.05f64.powi(2) - 0.02f64.powi(2)).sqrt();
    let volume = 4.0 / 3.0 * std::f64::consts::PI * half_hole.powi(3);
    assert!((bead["mass"]["volume"].as_f64().unwrap() / volume - 1.0).abs() < 3e-3, "{bead}");
    let endless = r#"{"type": "superparaboloid", "semi_axes": [1, 1, 1], "exponents": [1, 1]}"#;
    let told = run(&["info", endless, "--json"]).ended(0).json();
    assert!(told["mass"].is_null() && told["bounds"]["high"][2].is_null(), "{told}");
}

#[test]
fn mesh_writes_what_it_says() {
    for ending in ["obj", "ply", "stl"] {
        let file = scratch(&format!("tin.{ending}"));
        let told = run(&["mesh", "--superellipsoid", TIN, "-o", file.to_str().unwrap(), "--json"]);
        let told = told.ended(0).json();
        assert_eq!(told["watertight"], true);
        assert_eq!(told["euler_characteristic"], 2);
        assert!(told["distance"].as_f64().unwrap() < 1e-4);
        assert!(fs::metadata(&file).unwrap().len() > 10_000);
    }
    let file = scratch("bead.stl");
    let told = run(&["mesh", BEAD, "-o", file.to_str().unwrap(), "--cells", "40", "--json"]);
    let told = told.ended(0).json();
    assert_eq!(told["euler_characteristic"], 0);
    assert!(told["distance"].is_null());
    let stl = fs::read(&file).unwrap();
    let triangles = u32::from_le_bytes(stl[80..84].try_into().unwrap());
    assert_eq!(u64::from(triangles), told["triangles"].as_u64().unwrap());
    assert_eq!(stl.len(), 84 + 50 * triangles as usize);
}

#[test]
fn samples_are_cut_hidden_and_the_same_again() {
    let sample = |name: &str, more: &[&str]| {
        let file = scratch(name);
        let path = file.to_str().unwrap().to_owned();
        let mut words = vec!["sample", "--superellipsoid", TIN, "-o", &path, "--json"];
        words.extend_from_slice(more);
        (run(&words).ended(0).json(), fs::read_to_string(&file).unwrap())
    };
    let (told, text) = sample("all.csv", &["-n", "2000"]);
    assert_eq!(told["points"], 2000);
    assert_eq!(text.lines().next(), Some("x,y,z,nx,ny,nz"));
    let (_, again) = sample("again.csv", &["-n", "2000"]);
    assert_eq!(text, again);
    let (_, other) = sample("other.csv", &["-n", "2000", "--seed", "2"]);
    assert_ne!(text, other);
    let (told, text) = sample("cut.xyz", &["-n", "2000", "--cut", "1,0,0,0", "--no-normals"]);
    let kept = told["points"].as_u64().unwrap();
    assert!((850..1150).contains(&kept), "{kept}");
    let numbers =
        |line: &str| -> Vec<f64> { line.split(' ').map(|v| v.parse().unwrap()).collect() };
    assert!(text.lines().all(|l| numbers(l)[0] <= 0.0 && numbers(l).len() == 3));
    let (told, _) = sample("seen.xyz", &["-n", "2000", "--seen-from", "1,0,0"]);
    let seen = told["points"].as_u64().unwrap();
    assert!((500..1000).contains(&seen), "{seen}");
    let (told, _) = sample("arcs.xyz", &["--spread", "equal-arc", "--distance", "0.005"]);
    assert!(told["points"].as_u64().unwrap() > 500);
    // noise of 1 mm is 1 mm: distances to the ball of 1 m
    let file = scratch("noise.xyz");
    let path = file.to_str().unwrap();
    let words = ["sample", "--superellipsoid", "1,1,1,1,1", "-o", path, "--noise", "0.001"];
    run(&words).ended(0);
    let text = fs::read_to_string(&file).unwrap();
    let squares: Vec<f64> = text
        .lines()
        .map(|l| (numbers(l)[..3].iter().map(|v| v * v).sum::<f64>().sqrt() - 1.0).powi(2))
        .collect();
    let scatter = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    assert!((scatter - 0.001).abs() < 3e-5, "{scatter}");
}

#[test]
fn wrong_use_is_told_with_its_status() {
    let out = scratch("never.stl");
    let path = out.to_str().unwrap();
    let bowl = r#"{"type": "superparaboloid", "semi_axes": [1, 1, 1], "exponents": [1, 1]}"#;
    let cases: [(&[&str], i32, &str); 12] = [
        (&["info"], 2, "SHAPE"),
        (&["info", "no-such-file.json"], 3, "no-such-file.json"),
        (&["info", r#"{"type": "blob"}"#], 3, "blob"),
        (&["info", "--superellipsoid", "1,2"], 2, "5 needed"),
        (&["info", "--superellipsoid", "1,2,3,nan,1"], 2, "finite"),
        (&["info", "--superellipsoid", "1,2,3,1,-1"], 3, "exponent"),
        (&["info", "--superellipsoid", TIN, "--density", "0"], 2, "--density"),
        (&["mesh", "--superellipsoid", TIN, "-o", "tin.xyz"], 5, ".stl"),
        (&["mesh", bowl, "-o", path], 3, "intersection"),
        (&["mesh", "--superellipsoid", TIN, "-o", path, "--tolerance", "0"], 2, "tolerance"),
        (&["sample", "--superellipsoid", TIN, "-o", path], 5, ".ply"),
        (&["sample", "--superellipsoid", TIN, "-o", path, "--spread", "angle"], 2, "--distance"),
    ];
    for (words, status, wanted) in cases {
        let ran = run(words).ended(status);
        assert!(ran.stderr.contains(wanted), "{words:?}: {}", ran.stderr);
    }
    let points = scratch("never.xyz");
    let words = points.to_str().unwrap();
    let plane = ["sample", "--superellipsoid", TIN, "-o", words, "--cut", "0,0,1,-9"];
    assert!(run(&plane).ended(4).stderr.contains("no point is left"));
    // the input is never written over, and what the grid cannot see is not weighed
    let file = scratch("input.ply");
    fs::write(&file, r#"{"type": "superellipsoid", "semi_axes": [1, 1, 1], "exponents": [1, 1]}"#)
        .unwrap();
    let same = file.to_str().unwrap();
    for command in ["mesh", "sample"] {
        assert!(run(&[command, same, "-o", same]).ended(2).stderr.contains("is the input"));
    }
    let ball = |x: f64| {
        format!(
            r#"{{"type": "superellipsoid", "semi_axes": [0.1, 0.1, 0.1], "exponents": [1, 1], "position": [{x}, 0, 0]}}"#
        )
    };
    let far = format!(r#"{{"type": "union", "of": [{}, {}]}}"#, ball(0.0), ball(300.0));
    let told = run(&["info", &far, "--json"]).ended(0).json();
    assert!(told["mass"].is_null() && told["mass_unknown"].is_string(), "{told}");
    assert!(!out.exists() && !points.exists());
}

#[test]
fn the_gallery_draws_its_figures() {
    let folder = scratch("gallery");
    let path = folder.to_str().unwrap();
    let listed = run(&["gallery", path, "--only", "5,10"]).ended(0).stdout;
    assert_eq!(listed.lines().count(), 2);
    for file in listed.lines() {
        let image = png::Decoder::new(std::io::BufReader::new(fs::File::open(file).unwrap()));
        let info = image.read_info().unwrap();
        assert!(info.info().width > 900, "{file}");
    }
    assert!(run(&["gallery", path, "--only", "6"]).ended(2).stderr.contains("figure 6"));
}
