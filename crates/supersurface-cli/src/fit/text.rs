//! A fit for people: a row for each thing that is known.

use std::fmt::Write;

use supersurface::fit::Fit;

use crate::numbers::fixed;

/// The text of a fit; lengths are millimetres, with powers of ten for what is no object of a table.
pub(super) fn text(name: &str, points: usize, fit: &Fit) -> String {
    let shape = fit.surface.shape();
    let size = shape.semi_axes().into_iter().fold(0.0, f64::max) * 1e3;
    let mm = |v: f64| match (1.0..1e6).contains(&size) {
        true => fixed(1e3 * v, 2),
        false => format!("{:.3e}", 1e3 * v),
    };
    let all = |v: &[f64]| v.iter().map(|v| mm(*v)).collect::<Vec<_>>().join(", ");
    let plain = |v: &[f64], n: usize| v.iter().map(|v| fixed(*v, n)).collect::<Vec<_>>().join(", ");
    let mut out = format!("{name}\n");
    let mut line = |what: &str, value: String| {
        // writing to a string does not fail
        let _ = writeln!(out, "  {what:<18} {value}");
    };
    line("family", format!("{} (margin {:.1} nats)", fit.family.name(), fit.margin));
    line("semi-axes", format!("{} mm", all(&shape.semi_axes())));
    if let Some(ratio) = shape.ring_ratio() {
        line("ring ratio", plain(&[ratio], 3));
    }
    line("exponents", plain(&shape.exponents(), 3));
    if let Some(taper) = shape.taper() {
        line("taper", plain(&taper.slopes(), 3));
    }
    if let Some(twist) = shape.twist() {
        line("twist", format!("{} turns", plain(&[twist.turns()], 3)));
    }
    if let Some(bend) = shape.bend() {
        let angle = plain(&[bend.angle().to_degrees()], 1);
        line("bend", format!("{} 1/m towards {angle}°", plain(&[bend.curvature()], 3)));
    }
    let pose = fit.surface.pose();
    let q = pose.rotation.into_inner();
    let q = if q.w < 0.0 { -q } else { q };
    line("position", format!("{} mm", all(pose.translation.vector.as_slice())));
    line("orientation wxyz", plain(&[q.w, q.i, q.j, q.k], 4));
    line("residual", format!("{} mm (median)", mm(fit.residual)));
    line("noise", format!("{} mm", mm(fit.noise)));
    line("belonging", format!("{:.1} % of {points} points", 100.0 * fit.inlier_share()));
    out
}
