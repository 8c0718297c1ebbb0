//! What a simulated depth camera saw, as the files that cameras and data sets have.
//!
//! | file | content |
//! |---|---|
//! | `depth.png` | 16 bits, units as `camera.json` says, 0 without a reading |
//! | `labels.png` | 16 bits: k for the body k, 0 for the table and without a reading |
//! | `normals.png` | 8 bits: (n + 1)/2 of the normal in the optical frame; black where nothing is met |
//! | `color.png` | bodies in colours, lit from the camera |
//! | `cloud.pcd` | the depth as an organised cloud in the optical frame, with labels and the pose as VIEWPOINT |
//! | `camera.json` | intrinsics, unit of the depth, pose |

use std::path::Path;

use serde::Serialize;
use supersurface::Pose;
use supersurface::camera::Camera;
use supersurface::cloud::PointCloud;
use supersurface::picture::PALETTE;
use supersurface::scene::Look;

use crate::error::WriteError;
use crate::write::{write_bytes, write_grey, write_png};

/// Units a metre of depth images: tenths of millimetres, or millimetres where something is too far for these.
const SCALES: [f64; 2] = [1e4, 1e3];
/// The colour of what is no body.
const GROUND: [u8; 3] = [170, 170, 170];
/// Light that falls on what stands edgewise.
const AMBIENT: f32 = 0.3;

/// Writes a look into a folder that exists; `pose` is that of the camera's optical frame in the world.
pub fn write_view(
    folder: &Path,
    look: &Look,
    camera: &Camera,
    pose: &Pose,
) -> Result<(), WriteError> {
    let size = camera.size();
    let depth = look.depth.depth();
    let farthest = depth.iter().copied().filter(|z| z.is_finite()).fold(0.0, f32::max);
    let fits = |scale: &f64| f64::from(farthest) * scale <= f64::from(u16::MAX);
    let scale = SCALES.into_iter().find(fits).unwrap_or(SCALES[1]);
    // beyond what 16 bits hold there is no reading, and so it is for NaN
    let unit = |z: &f32| {
        let units = (f64::from(*z) * scale).round();
        if units <= f64::from(u16::MAX) { units as u16 } else { 0 }
    };
    let depths: Vec<u16> = depth.iter().map(unit).collect();
    write_grey(&folder.join("depth.png"), size, &depths)?;
    let labels: Vec<u16> = look.labels.iter().map(|k| u16::try_from(*k).unwrap_or(0)).collect();
    write_grey(&folder.join("labels.png"), size, &labels)?;
    write_png(&folder.join("normals.png"), size, &normals(look))?;
    write_png(&folder.join("color.png"), size, &colours(look, camera))?;
    write_bytes(&folder.join("cloud.pcd"), &cloud(look, camera, pose))?;
    write_bytes(&folder.join("camera.json"), camera_json(camera, pose, scale).as_bytes())
}

fn normals(look: &Look) -> Vec<u8> {
    let byte = |v: f32| (127.5 * (v + 1.0)).round() as u8;
    let pixel = |n: &[f32; 3]| if *n == [0.0; 3] { [0; 3] } else { n.map(byte) };
    look.normals.iter().flat_map(pixel).collect()
}

fn colours(look: &Look, camera: &Camera) -> Vec<u8> {
    let width = camera.size()[0];
    let pixels = look.normals.iter().zip(&look.seen).enumerate();
    pixels
        .flat_map(|(i, (n, label))| {
            if *n == [0.0; 3] {
                return [255; 3];
            }
            let ray = camera.direction((i % width) as f64, (i / width) as f64).cast::<f32>();
            let light = (n[0] * ray.x + n[1] * ray.y + n[2] * ray.z).abs();
            let body = (*label as usize).checked_sub(1);
            let colour = body.map_or(GROUND, |k| PALETTE[k % PALETTE.len()]);
            colour.map(|c| (f32::from(c) * (AMBIENT + (1.0 - AMBIENT) * light)) as u8)
        })
        .collect()
}

fn cloud(look: &Look, camera: &Camera, pose: &Pose) -> Vec<u8> {
    let [width, height] = camera.size();
    let count = width * height;
    let (at, turn) = (pose.translation.vector, pose.rotation);
    let mut bytes = format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\n\
         COUNT 1 1 1 1\nWIDTH {width}\nHEIGHT {height}\nVIEWPOINT {} {} {} {} {} {} {}\nPOINTS {count}\nDATA binary\n",
        at.x, at.y, at.z, turn.w, turn.i, turn.j, turn.k
    )
    .into_bytes();
    let points = PointCloud::from_depth(&look.depth, camera).points;
    bytes.reserve(16 * count);
    for (p, label) in points.iter().zip(&look.labels) {
        for v in p.iter() {
            bytes.extend((*v as f32).to_le_bytes());
        }
        bytes.extend(label.to_le_bytes());
    }
    bytes
}

#[derive(Serialize)]
struct CameraFile {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    #[serde(rename = "D", skip_serializing_if = "Option::is_none")]
    distortion: Option<[f64; 8]>,
    depth_scale: f64,
    position: [f64; 3],
    orientation_wxyz: [f64; 4],
}

fn camera_json(camera: &Camera, pose: &Pose, depth_scale: f64) -> String {
    let ([width, height], [fx, fy], [cx, cy]) = (camera.size(), camera.focal(), camera.centre());
    let turn = pose.rotation;
    let file = CameraFile {
        width,
        height,
        fx,
        fy,
        cx,
        cy,
        distortion: Some(camera.distortion()).filter(|d| *d != [0.0; 8]),
        depth_scale,
        position: pose.translation.vector.into(),
        orientation_wxyz: [turn.w, turn.i, turn.j, turn.k],
    };
    serde_json::to_string_pretty(&file).unwrap_or_default() + "\n"
}
