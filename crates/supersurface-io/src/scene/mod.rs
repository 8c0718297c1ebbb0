//! Scenes as files for simulators and viewers, and our own JSON of them (`docs/scene.md`).
//!
//! | format | file | a superellipsoid or toroid becomes |
//! |---|---|---|
//! | [`SceneFormat::Json`] | `scene.json` | its numbers; what [`read_scene`] reads |
//! | [`SceneFormat::Mjcf`] | `scene.xml` | an ellipsoid or a mesh that MuJoCo (3.3.5 and later) makes itself |
//! | [`SceneFormat::Urdf`] | `scene.urdf`, and one a body | an OBJ mesh |
//! | [`SceneFormat::Sdf`] | `scene_world.sdf` | an ellipsoid or an OBJ mesh |
//! | [`SceneFormat::Usda`] | `scene.usda` | a mesh, with its numbers as attributes |
//! | [`SceneFormat::Glb`] | `scene.glb` | a mesh, with its numbers as extras |
//! | [`SceneFormat::Obj`], [`SceneFormat::Stl`], [`SceneFormat::Ply`] | one a part in `meshes` | a mesh in the part's own frame |
//!
//! Mass and inertia are written as they are, never left to meshes. Joints stand at their rest.

mod convex_pieces;
mod gltf;
mod links;
mod mjcf;
mod names;
mod part_mesh;
mod read_scene;
mod scene_json;
mod sdf;
mod urdf;
mod usda;
mod xml;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use supersurface::camera::Camera;
use supersurface::mesh::Mesh;
use supersurface::scene::Scene;
use supersurface::{Direction, Point, Pose};

use self::links::Prepared;
use crate::error::WriteError;
use crate::mesh_files;
use crate::write::write_bytes;

pub use read_scene::{SceneFile, parse_scene, read_scene};

/// Acceleration of gravity against z, in m/s².
pub const GRAVITY: f64 = 9.81;

/// A kind of file that a scene is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneFormat {
    /// MuJoCo's MJCF.
    Mjcf,
    /// URDF: the whole scene, and each body by itself.
    Urdf,
    /// A world of SDFormat 1.9.
    Sdf,
    /// OpenUSD as text.
    Usda,
    /// Binary glTF 2.0.
    Glb,
    /// A mesh of each part as OBJ.
    Obj,
    /// A mesh of each part as binary STL.
    Stl,
    /// A mesh of each part as binary PLY.
    Ply,
    /// Our own JSON.
    Json,
}

impl SceneFormat {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Json,
        Self::Mjcf,
        Self::Urdf,
        Self::Sdf,
        Self::Usda,
        Self::Glb,
        Self::Obj,
        Self::Stl,
        Self::Ply,
    ];
}

/// A camera that stands in a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneCamera {
    /// What a person would call it.
    pub name: String,
    /// Its intrinsics.
    pub camera: Camera,
    /// Pose of its optical frame (x right, y down, z forward) in the world.
    pub pose: Pose,
}

/// A frame with a name: where a gripper is to go, say.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// What a person would call it.
    pub name: String,
    /// Its pose in the world.
    pub pose: Pose,
}

/// Where two things of a scene touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Touch {
    /// Names of both, bodies or boards or `table`.
    pub between: [String; 2],
    /// A point between both surfaces, in metres, in the world.
    pub point: Point,
    /// Unit normal from the first to the second, in the world.
    pub normal: Direction,
    /// Distance in metres; negative where they overlap.
    pub distance: f64,
}

/// What goes with a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneExtras {
    /// Cameras; not in URDF and SDFormat.
    pub cameras: Vec<SceneCamera>,
    /// Named frames.
    pub sites: Vec<Site>,
    /// Contacts; in the JSON alone.
    pub touches: Vec<Touch>,
}

/// Writes a scene into a folder, which is made where it is missing, and returns the files that programs open (not the
/// meshes that these name). Files of the same names are replaced, others left alone; the same scene gives the same bytes.
///
/// Names are made safe and unique first: `tea box` becomes `tea_box`, and a second one `tea_box_2`. Fails when a file
/// cannot be written, when a pose or a length is out of range, and when a mass or an inertia is that of no solid (parts
/// without density), naming the body.
///
/// ```
/// use supersurface::scene::demo;
/// use supersurface_io::{SceneExtras, SceneFormat, read_scene, write_scene};
/// let folder = std::env::temp_dir().join(format!("scene-{}", std::process::id()));
/// let scene = demo(1)?.scene;
/// let files = write_scene(&folder, &scene, &SceneExtras::default(), &[SceneFormat::Json])?;
/// assert_eq!(read_scene(&files[0])?.scene, scene);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_scene(
    folder: &Path,
    scene: &Scene,
    extras: &SceneExtras,
    formats: &[SceneFormat],
) -> Result<Vec<PathBuf>, WriteError> {
    let prepared = Prepared::new(folder, scene, extras)?;
    let mut files = Files::default();
    for format in formats {
        match format {
            SceneFormat::Json => files.add("scene.json", scene_json::text(&prepared)),
            SceneFormat::Mjcf => mjcf::add(&prepared, &mut files),
            SceneFormat::Urdf => urdf::add(&prepared, &mut files),
            SceneFormat::Sdf => sdf::add(&prepared, &mut files),
            SceneFormat::Usda => files.add("scene.usda", usda::text(&prepared)),
            SceneFormat::Glb => files.add("scene.glb", gltf::bytes(&prepared)),
            SceneFormat::Obj => files.add_parts(&prepared, "obj", mesh_files::obj),
            SceneFormat::Stl => files.add_parts(&prepared, "stl", mesh_files::stl),
            SceneFormat::Ply => files.add_parts(&prepared, "ply", mesh_files::ply),
        }
    }
    let meshes = folder.join(MESHES);
    let made = if files.meshes.is_empty() { folder } else { &meshes };
    std::fs::create_dir_all(made).map_err(|e| WriteError::new(made, e))?;
    for (name, bytes) in &files.meshes {
        write_bytes(&meshes.join(name), bytes)?;
    }
    let mut written: Vec<PathBuf> = Vec::new();
    for (name, bytes) in files.opened {
        let file = folder.join(name);
        write_bytes(&file, &bytes)?;
        if !written.contains(&file) {
            written.push(file);
        }
    }
    Ok(written)
}

/// The folder of meshes beside the files that name them.
const MESHES: &str = "meshes";

/// What will be written.
#[derive(Default)]
struct Files {
    /// In the order of the formats.
    opened: Vec<(String, Vec<u8>)>,
    meshes: BTreeMap<String, Vec<u8>>,
}

impl Files {
    fn add(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.opened.push((name.into(), bytes.into()));
    }

    /// Adds an OBJ file to the folder of meshes; its name there.
    fn add_obj(&mut self, id: &str, mesh: &Mesh) -> String {
        let name = format!("{id}.obj");
        self.meshes.entry(name.clone()).or_insert_with(|| mesh_files::obj(mesh));
        name
    }

    /// The OBJ files of the pieces of a part, or of the part where it has none.
    fn add_pieces(&mut self, part: &links::LinkPart) -> Vec<String> {
        if part.pieces.is_empty() {
            return vec![self.add_obj(&part.id, &part.mesh)];
        }
        let pieces = part.pieces.iter().enumerate();
        // a dot is in no id, so that these are other names
        pieces.map(|(k, mesh)| self.add_obj(&format!("{}.piece_{k:02}", part.id), mesh)).collect()
    }

    fn add_parts(&mut self, prepared: &Prepared<'_>, extension: &str, bytes: fn(&Mesh) -> Vec<u8>) {
        for part in prepared.parts() {
            self.meshes.insert(format!("{}.{extension}", part.id), bytes(&part.mesh));
        }
    }
}
