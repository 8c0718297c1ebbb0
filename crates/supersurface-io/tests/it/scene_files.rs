//! Scenes as files: what is written comes back, is safe whatever its names, and is the same each time.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use nalgebra::UnitQuaternion;
use supersurface::camera::Camera;
use supersurface::combine::{Assembly, Joint, JointKind, Part};
use supersurface::numeric::random::Stream;
use supersurface::scene::{Board, Body, Scene, demo, household, place};
use supersurface::shape::{Posed, Superellipsoid, Supertoroid};
use supersurface::surface::Surface;
use supersurface::{Direction, Point, Pose, Vector};
use supersurface_io::{
    SceneCamera, SceneExtras, SceneFormat, Site, Touch, parse_scene, read_scene, write_scene,
};

const NAMES: [&str; 8] =
    ["../../x", "<a&\"b\">", "", "", "Ünï ☕\u{7}\n", "NUL", "x' $(y) `z`", "Physics"];

/// An empty folder of this test alone.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("supersurface-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

pub(crate) fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => all.extend(files(&path)),
            false => {
                all.insert(path.clone(), std::fs::read(&path).unwrap());
            }
        }
    }
    all
}

fn pose(random: &mut Stream) -> Pose {
    let mut vector = || Vector::from_fn(|_, _| random.between(-1.0, 1.0));
    let (at, turn) = (vector(), vector() * 3.0);
    Pose::from_parts(at.into(), UnitQuaternion::from_scaled_axis(turn))
}

/// Joined, turned, deformed and badly named.
fn odd() -> (Scene, SceneExtras) {
    let mut random = Stream::new(5, 0);
    let core = Superellipsoid::new([0.01, 0.02, 0.03], [0.3, 1.1]).unwrap();
    let surfaces = [
        Surface::Superellipsoid(core),
        Surface::tapered(core, [0.3, -0.1]).unwrap(),
        Surface::twisted(core, 0.13).unwrap(),
        Surface::bent(core, 9.7, -2.9).unwrap(),
        Surface::tapered_bent(core, [0.1, 0.2], -7.1, 0.7).unwrap(),
        Surface::Supertoroid(Supertoroid::new([0.01, 0.012, 0.02], 2.9, [0.3, 1.1]).unwrap()),
    ];
    let parts = surfaces
        .iter()
        .map(|s| Part::new("<part>", Posed::new(*s, pose(&mut random)).unwrap(), 123.456).unwrap());
    let parts: Vec<_> = parts.collect();
    let spring =
        JointKind::Spring { stiffness: 0.1, damping: 0.3, rest: pose(&mut random).rotation };
    let joint = |a, b, kind| Joint::new(a, b, Point::new(0.1, 0.2, 0.3 / 7.0), kind).unwrap();
    let joints = vec![
        joint(2, 3, spring),
        joint(1, 2, JointKind::Fixed),
        joint(1, 0, JointKind::Spherical),
        joint(3, 4, JointKind::Fixed),
        joint(0, 5, spring),
    ];
    let mut scene = Scene::empty([0.6, 1.0 / 3.0]);
    let shape = Assembly::new(parts, joints).unwrap();
    scene.bodies.push(Body { name: "all".into(), shape, pose: pose(&mut random), friction: 0.0 });
    for name in NAMES {
        let surface = surfaces[random.index(surfaces.len())];
        scene.bodies.push(Body::single(name, surface, pose(&mut random)).unwrap());
        let half_extents = [0.1, 0.2, 0.01 / 3.0];
        scene.boards.push(Board { name: name.into(), half_extents, pose: pose(&mut random) });
    }
    scene.bodies.push(Body::single(&"y".repeat(300), surfaces[0], Pose::identity()).unwrap());
    let camera = Camera::new([640, 480], [600.1, 601.3], [320.7, 238.9]).unwrap();
    let camera = camera.with_distortion([0.1, 0.2, 0.0, 0.0, -0.3, 0.0, 0.0, 0.0]).unwrap();
    let extras = SceneExtras {
        cameras: vec![SceneCamera { name: "<eye>".into(), camera, pose: pose(&mut random) }],
        sites: vec![Site { name: "\"grasp\"".into(), pose: pose(&mut random) }],
        touches: vec![Touch {
            between: ["all".into(), "table".into()],
            point: Point::new(0.1, 0.2, 0.0),
            normal: Direction::new_normalize(Vector::new(0.1, 0.2, -0.7)),
            distance: -1e-4 / 3.0,
        }],
    };
    (scene, extras)
}

#[test]
fn our_json_comes_back_with_every_digit() {
    let folder = folder("scene-json");
    let (scene, extras) = odd();
    let written = write_scene(&folder, &scene, &extras, &[SceneFormat::Json]).unwrap();
    let read = read_scene(&written[0]).unwrap();
    assert_eq!((&read.scene, &read.extras), (&scene, &extras));
    for seed in 0..20 {
        let scene = place(&household(6, seed).unwrap(), [0.5, 0.5], seed).unwrap();
        let extras = SceneExtras::default();
        write_scene(&folder, &scene, &extras, &[SceneFormat::Json]).unwrap();
        assert_eq!(read_scene(&folder.join("scene.json")).unwrap().scene, scene);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn odd_names_stay_in_the_folder_and_break_nothing() {
    let outer = folder("scene-names");
    let inner = outer.join("a").join("b");
    let (scene, extras) = odd();
    let written = write_scene(&inner, &scene, &extras, &SceneFormat::ALL).unwrap();
    let all = files(&outer);
    assert!(written.iter().all(|file| all.contains_key(file)));
    for (path, bytes) in &all {
        let name = path.file_name().unwrap().to_str().unwrap();
        let allowed = |c: char| c.is_ascii_alphanumeric() || "._".contains(c);
        assert!(path.starts_with(&inner) && name.chars().all(allowed), "{path:?}");
        assert!(name.len() < 100 && !name.to_lowercase().starts_with("nul."), "{name}");
        let text = || std::str::from_utf8(bytes).unwrap();
        match path.extension().and_then(|e| e.to_str()) {
            Some("xml" | "urdf" | "sdf") => well_formed(text()),
            Some("json") => assert!(parse_scene(name, bytes).is_ok()),
            Some("usda") => assert_eq!(text().matches('{').count(), text().matches('}').count()),
            _ => (),
        }
    }
    // each mesh that is named is there
    for path in &written {
        let Ok(text) = std::str::from_utf8(&all[path]) else { continue };
        let words = text.split(['"', '<', '>']).filter(|w| w.ends_with(".obj"));
        for word in words {
            let word = word.trim_start_matches("meshes/");
            assert!(all.contains_key(&inner.join("meshes").join(word)), "{path:?}: {word}");
        }
    }
    std::fs::remove_dir_all(&outer).unwrap();
}

/// Tags close in order, and what has a meaning in XML stands only where it has it.
pub(crate) fn well_formed(text: &str) {
    let mut open = Vec::new();
    for piece in text.split('<').skip(1) {
        let (tag, after) = piece.split_once('>').expect("a tag that ends");
        assert!(!after.contains('>'), "{after}");
        for entity in after.split('&').skip(1).chain(tag.split('&').skip(1)) {
            assert!(["lt;", "gt;", "amp;", "quot;"].iter().any(|e| entity.starts_with(e)));
        }
        let name = tag.split([' ', '/']).find(|w| !w.is_empty()).unwrap();
        if tag.starts_with('?') {
            continue;
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let [first, second] = ["scene-once", "scene-twice"].map(folder);
    let (scene, extras) = odd();
    for folder in [&first, &second] {
        write_scene(folder, &scene, &extras, &SceneFormat::ALL).unwrap();
    }
    let bytes = |folder: &Path| files(folder).into_values().collect::<Vec<_>>();
    assert!(bytes(&first) == bytes(&second));
    // again over what is there
    write_scene(&first, &scene, &extras, &SceneFormat::ALL).unwrap();
    assert!(bytes(&first) == bytes(&second));
    for folder in [first, second] {
        std::fs::remove_dir_all(&folder).unwrap();
    }
}

#[test]
fn what_no_simulator_takes_is_refused() {
    let folder = folder("scene-wrong");
    let good = demo(1).unwrap().scene;
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = good.clone();
        change(&mut scene);
        let extras = SceneExtras::default();
        write_scene(&folder, &scene, &extras, &SceneFormat::ALL).unwrap_err().to_string()
    };
    let weightless = |scene: &mut Scene| {
        let body = *scene.bodies[1].shape.parts()[0].body();
        scene.bodies[1].shape = Assembly::single(Part::new("can", body, 0.0).unwrap());
    };
    let error = refused(&weightless);
    assert!(error.contains("\"can\"") && error.contains("density"), "{error}");
    let error = refused(&|s| s.bodies[0].friction = f64::NAN);
    assert!(error.contains("\"tea box\": friction is NaN"), "{error}");
    let error = refused(&|s| s.bodies[0].pose.translation.x = f64::INFINITY);
    assert!(error.contains("pose is not finite"), "{error}");
    let error = refused(&|s| s.half_size[0] = 0.0);
    assert!(error.contains("table"), "{error}");
    assert!(files(&folder).is_empty());
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn faults_of_a_scene_name_their_place() {
    let folder = folder("scene-faults");
    let (scene, extras) = odd();
    write_scene(&folder, &scene, &extras, &[SceneFormat::Json]).unwrap();
    let bytes = std::fs::read(folder.join("scene.json")).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let text = String::from_utf8(bytes.clone()).unwrap();
    for (from, to, said) in [
        ("supersurface-scene", "other", "format: is not"),
        ("\"version\": 1", "\"version\": 2", "version"),
        ("\"density\": 123.456", "\"density\": \"x\"", "bodies[0].parts[0]"),
        ("\"friction\": 0.0", "\"friction\": -1", "bodies[0].friction"),
        ("\"parent\": 2", "\"parent\": 77", "bodies[0]: parent of a joint is 77"),
        ("\"half_extents\"", "\"half\"", "boards[0]"),
        ("\"fx\": 600.1", "\"fx\": -600.1", "cameras[0]: camera fx is -600.1"),
        ("\"semi_axes\"", "\"axes\"", "bodies[0].parts[0].shape"),
        ("\"distance\": -", "\"distance\": --", "line"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = parse_scene("s.json", text.replacen(from, to, 1).as_bytes()).unwrap_err();
        let error = error.to_string();
        assert!(error.starts_with("s.json: scene JSON: ") && error.contains(said), "{error}");
    }
    let mut random = Stream::new(23, 0);
    for _ in 0..400 {
        let mut changed = bytes.clone();
        for _ in 0..1 + random.index(3) {
            let at = random.index(changed.len());
            changed[at] = b"0-9{}[],:\"e.x"[random.index(13)];
        }
        let _ = parse_scene("s.json", &changed);
    }
}
