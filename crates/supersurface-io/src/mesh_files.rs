//! Triangle meshes as OBJ (text), PLY (binary, little endian) and STL (binary), by the file's extension.
//!
//! Coordinates are metres. OBJ and PLY keep the shared vertices, OBJ with every digit, PLY as doubles; STL has three
//! single-precision corners a triangle and no shared vertices, so that a mesh that was closed is so only up to
//! rounding.

use std::fmt::Write as _;
use std::path::Path;

use supersurface::Point;
use supersurface::mesh::Mesh;

use crate::error::WriteError;
use crate::write::write_bytes;

/// Writes a mesh as `.obj`, `.ply` or `.stl`, in capitals or not; any other extension is an error that names these.
///
/// ```
/// use supersurface::{mesh::tessellate, shape::Superellipsoid};
/// let tin = Superellipsoid::new([0.033, 0.033, 0.05], [0.1, 1.0])?;
/// let file = std::env::temp_dir().join(format!("tin-{}.stl", std::process::id()));
/// supersurface_io::write_mesh(&file, &tessellate(&tin, None)?.mesh)?;
/// # std::fs::remove_file(&file)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_mesh(file: &Path, mesh: &Mesh) -> Result<(), WriteError> {
    let extension = file.extension().map(|e| e.to_string_lossy().to_lowercase());
    let bytes = match extension.as_deref() {
        Some("obj") => obj(mesh),
        Some("ply") => ply(mesh),
        Some("stl") => stl(mesh),
        _ => {
            let problem = "the extension of a mesh is .obj, .ply or .stl";
            return Err(WriteError::new(file, std::io::Error::other(problem)));
        }
    };
    write_bytes(file, &bytes)
}

/// Lines `v x y z` and `f i j k`, counted from 1.
pub(crate) fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from("# vertices in metres\n");
    // writing into a string cannot fail
    for v in mesh.vertices() {
        let _ = writeln!(text, "v {} {} {}", v.x, v.y, v.z);
    }
    for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|i| u64::from(i) + 1)) {
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text.into_bytes()
}

pub(crate) fn ply(mesh: &Mesh) -> Vec<u8> {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment vertices in metres\n\
         element vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    );
    let mut bytes = header.into_bytes();
    bytes.reserve(24 * vertices.len() + 13 * triangles.len());
    bytes.extend(vertices.iter().flat_map(|v| v.iter()).flat_map(|c| c.to_le_bytes()));
    for t in triangles {
        bytes.push(3);
        bytes.extend(t.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}

/// 80 bytes of header (which must not begin with `solid`), the number of triangles; for each its normal (zero where
/// it has no area), its corners and two bytes that mean nothing.
pub(crate) fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = format!("{:80}", "binary STL, metres").into_bytes();
    bytes.reserve(4 + 50 * mesh.triangles().len());
    bytes.extend((mesh.triangles().len() as u32).to_le_bytes());
    for [a, b, c] in mesh.corners() {
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        let corners: [Point; 4] = [Point::from(normal), a, b, c];
        let numbers = corners.iter().flat_map(|p| p.iter());
        bytes.extend(numbers.flat_map(|v| (*v as f32).to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use supersurface::Vector;
    use supersurface::mesh::tessellate;
    use supersurface::shape::{Superellipsoid, Supertoroid};

    /// Readers of their own, for what is written here alone.
    fn read_obj(bytes: &[u8]) -> Mesh {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for line in std::str::from_utf8(bytes).unwrap().lines() {
            let words: Vec<_> = line.split(' ').collect();
            match words[0] {
                "v" => {
                    let c: Vec<f64> = words[1..].iter().map(|w| w.parse().unwrap()).collect();
                    vertices.push(Point::from_slice(&c));
                }
                "f" => {
                    let f: Vec<u32> = words[1..].iter().map(|w| w.parse().unwrap()).collect();
                    triangles.push([f[0] - 1, f[1] - 1, f[2] - 1]);
                }
                other => assert_eq!(other, "#"),
            }
        }
        Mesh::new(vertices, triangles).unwrap()
    }

    fn read_ply(bytes: &[u8]) -> Mesh {
        let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        let header = std::str::from_utf8(&bytes[..end]).unwrap();
        assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"));
        let count = |name: &str| -> usize {
            let line = header.lines().find_map(|l| l.strip_prefix(name)).unwrap();
            line.trim().parse().unwrap()
        };
        let (n, m) = (count("element vertex"), count("element face"));
        let body = &bytes[end..];
        assert_eq!(body.len(), 24 * n + 13 * m);
        let double = |i: usize| f64::from_le_bytes(body[8 * i..8 * i + 8].try_into().unwrap());
        let vertices =
            (0..n).map(|i| Point::new(double(3 * i), double(3 * i + 1), double(3 * i + 2)));
        let faces = body[24 * n..].chunks(13).map(|f| {
            assert_eq!(f[0], 3);
            let index = |k: usize| u32::from_le_bytes(f[1 + 4 * k..5 + 4 * k].try_into().unwrap());
            [index(0), index(1), index(2)]
        });
        Mesh::new(vertices.collect(), faces.collect()).unwrap()
    }

    /// Normals and corners.
    fn read_stl(bytes: &[u8]) -> Vec<[Vector; 4]> {
        assert!(!bytes.starts_with(b"solid"));
        let n = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
        assert_eq!(bytes.len(), 84 + 50 * n);
        let facet = |f: &[u8]| {
            let single = |i: usize| f32::from_le_bytes(f[4 * i..4 * i + 4].try_into().unwrap());
            std::array::from_fn(|k| Vector::from_fn(|c, _| f64::from(single(3 * k + c))))
        };
        bytes[84..].chunks(50).map(facet).collect()
    }

    #[test]
    fn meshes_come_back() {
        let ring = Supertoroid::new([0.02, 0.03, 0.01], 3.0, [0.4, 1.0]).unwrap();
        let box_like = Superellipsoid::new([0.02, 0.03, 0.01], [0.1; 2]).unwrap();
        for mesh in
            [tessellate(&ring, None).unwrap().mesh, tessellate(&box_like, None).unwrap().mesh]
        {
            assert_eq!(read_obj(&obj(&mesh)), mesh);
            assert_eq!(read_ply(&ply(&mesh)), mesh);
            let facets = read_stl(&stl(&mesh));
            assert_eq!(facets.len(), mesh.triangles().len());
            let mut volume = 0.0;
            for ([n, a, b, c], exact) in facets.iter().zip(mesh.corners()) {
                for (read, exact) in [a, b, c].into_iter().zip(exact) {
                    assert!((read - exact.coords).amax() < 1e-8);
                }
                assert!((n.norm() - 1.0).abs() < 1e-6 || n.norm() == 0.0);
                volume += a.dot(&b.cross(c)) / 6.0;
            }
            assert!((volume / mesh.volume() - 1.0).abs() < 1e-5);
        }
        assert!(read_stl(&stl(&Mesh::default())).is_empty());
    }

    #[test]
    fn the_extension_says_the_format() {
        let folder =
            std::env::temp_dir().join(format!("supersurface-meshes-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let ball = Superellipsoid::new([0.1; 3], [1.0; 2]).unwrap();
        let mesh = tessellate(&ball, Some(1e-3)).unwrap().mesh;
        for (name, bytes) in [("a.obj", obj(&mesh)), ("b.PLY", ply(&mesh)), ("c.Stl", stl(&mesh))] {
            let file = folder.join(name);
            write_mesh(&file, &mesh).unwrap();
            assert_eq!(std::fs::read(&file).unwrap(), bytes);
        }
        for name in ["d.gltf", "obj"] {
            let error = write_mesh(&folder.join(name), &mesh).unwrap_err().to_string();
            assert!(error.contains(".obj, .ply or .stl"), "{error}");
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
