//! Points out: PCD and PLY (binary, little endian) and text, with normals where there are any.

use std::fmt::Write;
use std::path::Path;

use supersurface::{Direction, Point};

use crate::error::WriteError;
use crate::write::write_bytes;

/// How points are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Pcd,
    Ply,
    Text,
    Csv,
}

impl Format {
    fn of(file: &Path) -> Result<Self, WriteError> {
        let ending = file.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
        match ending.as_str() {
            "pcd" => Ok(Self::Pcd),
            "ply" => Ok(Self::Ply),
            "xyz" | "txt" => Ok(Self::Text),
            "csv" => Ok(Self::Csv),
            _ => Err(refused(file, "points are written to .pcd, .ply, .xyz, .txt or .csv".into())),
        }
    }
}

fn refused(file: &Path, problem: String) -> WriteError {
    WriteError::new(file, std::io::Error::new(std::io::ErrorKind::InvalidInput, problem))
}

/// Fails when a file's ending says no format of points: to be asked before points are made.
pub fn check_points_file(file: &Path) -> Result<(), WriteError> {
    Format::of(file).map(|_| ())
}

/// Writes points in metres, with a normal each or none at all, by the file's ending: `.pcd` or `.ply` (double precision,
/// binary little endian), `.xyz`, `.txt` or `.csv` (text). Fails for other endings, and when there are normals for some
/// points only.
pub fn write_points(
    file: &Path,
    points: &[Point],
    normals: &[Direction],
) -> Result<(), WriteError> {
    let (have, need) = (normals.len(), points.len());
    if have != 0 && have != need {
        return Err(refused(file, format!("{have} normals for {need} points")));
    }
    let bytes = match Format::of(file)? {
        Format::Pcd => binary(pcd_header(need, have > 0), points, normals),
        Format::Ply => binary(ply_header(need, have > 0), points, normals),
        Format::Text => text(points, normals, ' ').into_bytes(),
        Format::Csv => {
            let names = if have > 0 { "x,y,z,nx,ny,nz\n" } else { "x,y,z\n" };
            (names.to_owned() + &text(points, normals, ',')).into_bytes()
        }
    };
    write_bytes(file, &bytes)
}

fn pcd_header(count: usize, normals: bool) -> String {
    let (fields, each) =
        if normals { ("x y z normal_x normal_y normal_z", 6) } else { ("x y z", 3) };
    let row = |value: &str| vec![value; each].join(" ");
    format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {fields}\nSIZE {}\nTYPE {}\nCOUNT {}\n\
         WIDTH {count}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA binary\n",
        row("8"),
        row("F"),
        row("1")
    )
}

fn ply_header(count: usize, normals: bool) -> String {
    let names: &[&str] =
        if normals { &["x", "y", "z", "nx", "ny", "nz"] } else { &["x", "y", "z"] };
    let rows: String = names.iter().map(|n| format!("property double {n}\n")).collect();
    format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{rows}end_header\n")
}

fn binary(header: String, points: &[Point], normals: &[Direction]) -> Vec<u8> {
    let mut bytes = header.into_bytes();
    let mut put = |numbers: &[f64]| numbers.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    for (i, p) in points.iter().enumerate() {
        put(p.coords.as_slice());
        if let Some(n) = normals.get(i) {
            put(n.as_slice());
        }
    }
    bytes
}

fn text(points: &[Point], normals: &[Direction], between: char) -> String {
    let mut out = String::new();
    for (i, p) in points.iter().enumerate() {
        // writing to a string does not fail
        let _ = write!(out, "{}{between}{}{between}{}", p.x, p.y, p.z);
        if let Some(n) = normals.get(i) {
            let _ = write!(out, "{between}{}{between}{}{between}{}", n.x, n.y, n.z);
        }
        out.push('\n');
    }
    out
}
