//! A scene in words.

use std::fmt::Write;

use super::make::Made;
use crate::numbers::fixed;

/// A row a body, and what else is worth knowing.
pub(super) fn text(made: &Made) -> String {
    let Made { scene, settled, shares, files, .. } = made;
    let mut out = format!("{:<20} {:>9}  {:<24} {:>5}\n", "body", "mass g", "at mm", "seen");
    for (body, share) in scene.bodies.iter().zip(shares) {
        let at = body.pose.translation.vector.map(|v| 1e3 * v);
        let at = format!("{:.1} {:.1} {:.1}", at.x, at.y, at.z);
        let mass = fixed(1e3 * body.mass().mass, 1);
        // writing to a string does not fail
        let _ = writeln!(out, "{:<20} {mass:>9}  {at:<24} {:>3.0} %", body.name, 100.0 * share);
    }
    let _ = writeln!(
        out,
        "\nat rest after {:.2} s; deepest overlap {:.3} mm",
        settled.time,
        1e3 * settled.overlap
    );
    for file in files {
        let _ = writeln!(out, "{}", file.display());
    }
    out
}
