//! Grasps as JSON: all of a scene in one list, best first, in the frame that `frame_id` names.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use supersurface::grasp::{Grasp, Gripper, Kind};
use supersurface::pipeline::Object;

use crate::error::WriteError;
use crate::write::write_bytes;

#[derive(Serialize)]
struct File<'a> {
    format: &'static str,
    version: u32,
    frame_id: &'a str,
    gripper: &'a str,
    timing: Timing,
    grasps: Vec<Row>,
    refusals: Vec<Refused>,
}

#[derive(Serialize)]
struct Timing {
    total_s: f64,
}

#[derive(Serialize)]
struct Row {
    r#type: &'static str,
    /// Pose of the tool frame, row by row.
    pose: [[f64; 4]; 4],
    opening: f64,
    contact_width: f64,
    inside: bool,
    score: f64,
    terms: BTreeMap<&'static str, f64>,
    source: &'static str,
    object_id: usize,
}

#[derive(Serialize)]
struct Refused {
    object_id: usize,
    reason: String,
}

/// Writes the grasps of all objects; a file with none of them where there are no objects. `frame_id` names the
/// frame of their poses (`camera` for that of the cloud, else `world`), `seconds` is what
/// reading, segmenting, fitting and planning took.
pub fn write_grasps(
    file: &Path,
    objects: &[Object],
    gripper: &Gripper,
    frame_id: &str,
    seconds: f64,
) -> Result<(), WriteError> {
    let kind = match gripper.kind {
        Kind::Jaw(_) => "parallel",
        Kind::Suction(_) => "suction",
    };
    let (mut grasps, mut refusals) = (Vec::new(), Vec::new());
    for (object, id) in objects.iter().zip(1..) {
        match &object.grasps {
            Ok(found) => grasps.extend(found.iter().map(|g| row(g, id, kind))),
            Err(refusal) => refusals.push(Refused { object_id: id, reason: refusal.to_string() }),
        }
    }
    grasps.sort_by(|a, b| b.score.total_cmp(&a.score));
    let file_content = File {
        format: "grasps",
        version: 1,
        frame_id,
        gripper: &gripper.name,
        timing: Timing { total_s: seconds },
        grasps,
        refusals,
    };
    let text = serde_json::to_vec_pretty(&file_content)
        .map_err(|e| WriteError::new(file, std::io::Error::other(e)))?;
    write_bytes(file, &text)
}

fn row(grasp: &Grasp, object_id: usize, kind: &'static str) -> Row {
    let m = grasp.pose.to_homogeneous();
    Row {
        r#type: kind,
        pose: std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])),
        opening: grasp.opening,
        contact_width: grasp.contact_width,
        inside: grasp.inside,
        score: grasp.score,
        terms: grasp.terms.iter().copied().collect(),
        source: grasp.source,
        object_id,
    }
}
