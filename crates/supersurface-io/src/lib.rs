//! Files for supersurface: point clouds and depth images in, labels, grasps, pictures and reports out.
//!
//! | file | direction | by |
//! |---|---|---|
//! | PCD, PLY, text, depth PNG | in | [`read`] |
//! | camera intrinsics (JSON) | in | [`read_camera`] |
//! | instance mask (PNG) | in | [`read_mask`] |
//! | gripper (TOML) | in | [`read_gripper`] |
//! | kinds of things (TOML) | in | [`read_things`] |
//! | shape (JSON) | in | [`read_shape`] |
//! | points (PCD, PLY, text) | out | [`write_points`] |
//! | labels (NPY), picture (PNG), grasps and report (JSON) | out | [`write_labels`], [`write_png`], [`write_grasps`], [`report_json`] |
//! | fit (JSON) | out, in as a shape | [`fit_json`], [`fit_json_line`], [`read_shape`] |
//! | pairs of bodies (JSON) | in | [`read_contact_cases`] |
//! | contact (JSON) | out | [`contact_json`], [`contact_line`] |
//! | mesh (OBJ, PLY, STL) | out | [`write_mesh`] |
//! | what a simulated camera saw (PNG, PCD, JSON) | out | [`write_view`] |
//! | scene (JSON, MJCF, URDF, SDFormat, USDA, GLB, meshes) | out | [`write_scene`] |
//! | scene (JSON) | in | [`read_scene`] |
//!
//! The readers are our own: of the kept crates, those for PCD and PLY allocate what a header promises
//! before they look at the file, and refuse files that depth cameras and PCL write every day (padding
//! fields, carriage returns, page-padded compressed data, integer coordinates). Here every length is
//! checked against the bytes that are there, and an error names the file, the place and the mend.
//!
//! ```
//! let text = "0.1 0.2 0.3\n0.4 0.5 0.6\n";
//! let read = supersurface_io::parse("corner.xyz", text.as_bytes(), &Default::default())?;
//! assert_eq!(read.cloud.points.len(), 2);
//! # Ok::<(), supersurface_io::ReadError>(())
//! ```

mod bytes;
mod camera_json;
mod cloud_files;
mod contact_json;
mod depth_png;
mod error;
mod fit_json;
mod grasps_json;
mod gripper;
mod mesh_files;
mod npy;
mod pcd;
mod ply;
mod read;
mod report_json;
mod scene;
mod shape_json;
mod surface_row;
mod text;
mod things;
mod view_files;
mod write;

pub use camera_json::{DepthCamera, read_camera};
pub use cloud_files::{check_points_file, write_points};
pub use contact_json::{
    ContactCase, contact_json, contact_line, parse_contact_cases, read_contact_cases,
};
pub use depth_png::read_mask;
pub use error::{ReadError, WriteError};
pub use fit_json::{FitHead, ViewHead, fit_json, fit_json_line};
pub use grasps_json::write_grasps;
pub use gripper::{BUILT_IN_GRIPPERS, read_gripper};
pub use mesh_files::write_mesh;
pub use npy::write_labels;
pub use read::{Read, ReadOptions, parse, read, shown_name};
pub use report_json::{ReportHead, failure_json, report_json};
pub use scene::{
    GRAVITY, SceneCamera, SceneExtras, SceneFile, SceneFormat, Site, Touch, parse_scene,
    read_scene, write_scene,
};
pub use shape_json::{Model, parse_shape, read_shape};
pub use surface_row::surface_json;
pub use things::{BUILT_IN_THINGS, read_things};
pub use view_files::write_view;
pub use write::{write_png, write_text};
