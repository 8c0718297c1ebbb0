//! Scenes of many seeds in all formats: what is written parses, is closed and weighs what it should, as each kind of program
//! reads it. SUPERSURFACE_EXPORTS says how many seeds; `compare/check_export.py --seeds` asks the programs themselves.

use std::collections::BTreeMap;
use std::path::Path;

use nalgebra::Matrix3;
use serde_json::Value;
use supersurface::Point;
use supersurface::mesh::Mesh;
use supersurface::scene::{Layout, arrange, draw};
use supersurface::shape::{Mass, MassProperties};
use supersurface_io::{SceneExtras, SceneFormat, read_scene, read_things, write_scene};

use crate::scene_files::{files, folder, well_formed};

/// Seeds that are tried.
const SEEDS: u64 = 50;
/// Things of a scene.
const THINGS: usize = 4;
/// Share by which masses and inertias may be off.
const SHARE: f64 = 1e-3;

#[test]
fn scenes_of_many_seeds_weigh_the_same_in_all_formats() {
    let asked = std::env::var("SUPERSURFACE_EXPORTS").ok().and_then(|n| n.parse().ok());
    let lists = ["household", "members"].map(|name| read_things(name).unwrap());
    let folder = folder("exports");
    for seed in 0..asked.unwrap_or(SEEDS) {
        let bodies = draw(&lists[seed as usize % 2], THINGS, seed).unwrap();
        let scene = arrange(bodies, Layout::Packed, seed).unwrap();
        let place = folder.join(seed.to_string());
        write_scene(&place, &scene, &SceneExtras::default(), &SceneFormat::ALL).unwrap();
        assert_eq!(read_scene(&place.join("scene.json")).unwrap().scene, scene, "seed {seed}");
        check(&place);
        std::fs::remove_dir_all(&place).unwrap();
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

fn check(place: &Path) {
    let all = files(place);
    let bytes = |name: &str| &all[&place.join(name)];
    let text = |name: &str| std::str::from_utf8(bytes(name)).unwrap();
    let told: Value = serde_json::from_str(text("scene.json")).unwrap();
    for (path, bytes) in &all {
        if matches!(path.extension().and_then(|e| e.to_str()), Some("xml" | "urdf" | "sdf")) {
            well_formed(std::str::from_utf8(bytes).unwrap());
        }
    }
    let bodies = told["bodies"].as_array().unwrap();
    // [mass, trace of the inertia], which no frame changes
    let known: Vec<[f64; 2]> = bodies.iter().map(weight).collect();
    let whole = [0, 1].map(|k| known.iter().map(|w| w[k]).sum());
    let same = |found: [f64; 2], known: [f64; 2], what: &str| {
        for (found, known) in found.iter().zip(known) {
            assert!((found / known - 1.0).abs() < SHARE, "{place:?} {what}: {found} for {known}");
        }
    };
    let moments = |text: &str, before: &[&str]| before.iter().map(|b| sum(text, b, 1)).sum();
    let mjcf = text("scene.xml");
    let inertial: String = mjcf.lines().filter(|l| l.contains("<inertial ")).collect();
    let found = [sum(&inertial, " mass=\"", 1), sum(&inertial, " fullinertia=\"", 3)];
    same(found, whole, "MJCF");
    let sdf = text("scene_world.sdf");
    same([sum(sdf, "<mass>", 1), moments(sdf, &["<ixx>", "<iyy>", "<izz>"])], whole, "SDFormat");
    let usda = text("scene.usda");
    let found = [sum(usda, " physics:mass = ", 1), sum(usda, " physics:diagonalInertia = (", 3)];
    same(found, whole, "USD");
    for (body, known) in bodies.iter().zip(&known) {
        let urdf = text(&format!("{}.urdf", body["id"].as_str().unwrap()));
        let found = moments(urdf, &["ixx=\"", "iyy=\"", "izz=\""]);
        same([sum(urdf, "<mass value=\"", 1), found], *known, "URDF");
    }
    let mut in_glb = glb(bytes("scene.glb"));
    for part in bodies.iter().flat_map(|b| b["parts"].as_array().unwrap()) {
        let id = part["id"].as_str().unwrap();
        let file = |kind: &str| bytes(&format!("meshes/{id}.{kind}"));
        let meshes = [
            ("OBJ", obj(file("obj"))),
            ("STL", stl(file("stl"))),
            ("PLY", ply(file("ply"))),
            ("glTF", in_glb.remove(id).unwrap()),
        ];
        for (kind, mesh) in meshes {
            assert!(mesh.is_watertight() && mesh.volume() > 0.0, "{place:?} {id}: {kind}");
            let Mass { mass, inertia, .. } =
                mesh.mass_properties(part["density"].as_f64().unwrap());
            same([mass, inertia.trace()], weight(part), kind);
            let known = moments_of(&matrix(&part["inertia"]));
            for (found, known) in moments_of(&inertia).iter().zip(known) {
                assert!((found / known - 1.0).abs() < SHARE, "{place:?} {id}: {kind}");
            }
        }
    }
}

/// Mass and trace of the inertia of a body or a part.
fn weight(row: &Value) -> [f64; 2] {
    [row["mass"].as_f64().unwrap(), matrix(&row["inertia"]).trace()]
}

fn matrix(rows: &Value) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j].as_f64().unwrap())
}

/// Principal moments, the least first.
fn moments_of(inertia: &Matrix3<f64>) -> [f64; 3] {
    let mut moments: [f64; 3] = inertia.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    moments
}

/// Sum of the first `count` numbers after each place of a word.
fn sum(text: &str, word: &str, count: usize) -> f64 {
    let after = text.split(word).skip(1);
    let numbers = |piece: &str| {
        let words = piece.split([' ', ',', '"', '<', ')', '\n', '(']).filter(|w| !w.is_empty());
        words.take(count).map(|w| w.parse::<f64>().unwrap()).sum::<f64>()
    };
    after.map(numbers).sum()
}

fn obj(bytes: &[u8]) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for line in std::str::from_utf8(bytes).unwrap().lines() {
        let words: Vec<&str> = line.split(' ').collect();
        match words[..] {
            ["v", x, y, z] => vertices.push([x, y, z].map(|w| w.parse().unwrap()).into()),
            ["f", a, b, c] => triangles.push([a, b, c].map(|w| w.parse::<u32>().unwrap() - 1)),
            _ => (),
        }
    }
    Mesh::new(vertices, triangles).unwrap()
}

fn single(bytes: &[u8]) -> f64 {
    f64::from(f32::from_le_bytes(bytes.try_into().unwrap()))
}

fn corner(bytes: &[u8]) -> Point {
    [0, 4, 8].map(|k| single(&bytes[k..k + 4])).into()
}

/// Corners at the same place are one vertex.
fn stl(bytes: &[u8]) -> Mesh {
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let (mut known, mut vertices) = (BTreeMap::new(), Vec::new());
    let mut number = |bytes: &[u8]| {
        let place = corner(bytes);
        *known.entry(<[f64; 3]>::from(place).map(|v| (v + 0.0).to_bits())).or_insert_with(|| {
            vertices.push(place);
            vertices.len() as u32 - 1
        })
    };
    let triangle = |t: &[u8]| [12, 24, 36].map(|k| number(&t[k..k + 12]));
    let triangles: Vec<[u32; 3]> = bytes[84..].chunks(50).map(triangle).collect();
    // triangles too thin for single precision are none
    let whole = triangles.into_iter().filter(|[a, b, c]| a != b && b != c && a != c).collect();
    Mesh::new(vertices, whole).unwrap()
}

fn ply(bytes: &[u8]) -> Mesh {
    let end = b"end_header\n";
    let header = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    let counts: Vec<usize> = std::str::from_utf8(&bytes[..header])
        .unwrap()
        .lines()
        .filter_map(|line| line.strip_prefix("element ")?.split(' ').nth(1)?.parse().ok())
        .collect();
    let (vertices, faces) = bytes[header..].split_at(24 * counts[0]);
    assert_eq!(faces.len(), 13 * counts[1]);
    let number = |b: &[u8]| f64::from_le_bytes(b.try_into().unwrap());
    let vertex = |b: &[u8]| [0, 8, 16].map(|k| number(&b[k..k + 8])).into();
    let index = |b: &[u8]| u32::from_le_bytes(b.try_into().unwrap());
    let triangle = |b: &[u8]| [1, 5, 9].map(|k| index(&b[k..k + 4]));
    let triangles = faces.chunks(13).map(triangle).collect();
    Mesh::new(vertices.chunks(24).map(vertex).collect(), triangles).unwrap()
}

/// The meshes of a binary glTF by name.
fn glb(bytes: &[u8]) -> BTreeMap<String, Mesh> {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
    let end = 20 + word(12);
    let json: Value = serde_json::from_slice(&bytes[20..end]).unwrap();
    let data = &bytes[end + 8..];
    let view = |accessor: &Value| {
        let accessor = &json["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let number = |row: &Value, name: &str| row[name].as_u64().unwrap_or(0) as usize;
        let start = number(view, "byteOffset") + number(accessor, "byteOffset");
        (&data[start..start + number(view, "byteLength")], number(accessor, "count"))
    };
    let mut found = BTreeMap::new();
    for mesh in json["meshes"].as_array().unwrap() {
        let primitive = &mesh["primitives"][0];
        let (places, count) = view(&primitive["attributes"]["POSITION"]);
        let (indices, corners) = view(&primitive["indices"]);
        let size = indices.len() / corners;
        let index = |b: &[u8]| match size {
            2 => u32::from(u16::from_le_bytes(b.try_into().unwrap())),
            _ => u32::from_le_bytes(b.try_into().unwrap()),
        };
        let indices: Vec<u32> = indices.chunks(size).map(index).collect();
        let vertices: Vec<Point> = places.chunks(12).take(count).map(corner).collect();
        let triangles = indices.chunks(3).map(|t| [t[0], t[1], t[2]]).collect();
        let name = mesh["name"].as_str().unwrap().to_owned();
        found.insert(name, Mesh::new(vertices, triangles).unwrap());
    }
    found
}
