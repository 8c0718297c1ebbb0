//! The report as a table for people.

use std::fmt::Write;

use supersurface::grasp::Grasp;
use supersurface::pipeline::{Object, Report};
use supersurface::segment::Segmentation;
use supersurface::separate::Reason;
use supersurface::{Point, Vector};

/// The whole text: the support, a row an object, its best `most_grasps` grasps, and what was left out.
pub(crate) fn table(report: &Report, most_grasps: usize) -> String {
    let mut out = String::new();
    let s = &report.segmentation;
    support(&mut out, s);
    if report.objects.is_empty() {
        out.push_str("no objects on it\n");
    } else {
        let _ = writeln!(
            out,
            "\n{:>3}  {:<14}  {:<17}  {:<11}  {:<23}  {:>8}  {:>7}",
            "#", "what", "size mm", "exponents", "centre m", "residual", "inliers"
        );
    }
    for (i, object) in report.objects.iter().enumerate() {
        row(&mut out, i + 1, object);
        if let Some(k) = s.stands_on.get(i).filter(|k| **k > 0) {
            let _ = writeln!(out, "       on support {}", k + 1);
        }
        joined(&mut out, object);
        grasps(&mut out, object, most_grasps);
    }
    obstacles(&mut out, s);
    dropped(&mut out, s);
    out
}

fn support(out: &mut String, s: &Segmentation) {
    if let Some(main) = s.supports.first() {
        let plane = main.plane;
        let n = plane.normal();
        let _ = writeln!(
            out,
            "table: normal {}, offset {:.3} m, scatter {:.1} mm",
            numbers(&[n.x, n.y, n.z]),
            plane.offset(),
            1e3 * main.noise
        );
        for (k, other) in s.supports.iter().enumerate().skip(1) {
            let corners = other.corners();
            let sum = corners.iter().map(|p| p.coords).sum::<Vector>();
            let middle = Point::from(sum / corners.len().max(1) as f64);
            let height = plane.height(&middle);
            let way = if height > 0.0 { "above" } else { "below" };
            let _ = writeln!(out, "support {}: {:.3} m {way} the table", k + 1, height.abs());
        }
    } else {
        out.push_str("no table: the objects were given\n");
    }
}

fn row(out: &mut String, id: usize, object: &Object) {
    let fit = match &object.fit {
        Ok(fit) => fit,
        Err(e) => {
            let _ = writeln!(out, "{id:>3}  no surface: {e}");
            return;
        }
    };
    let shape = fit.surface.shape();
    let [x, y, z] = shape.half_extents().map(|h| 2e3 * h);
    let [e1, e2] = shape.exponents();
    let c = fit.surface.pose().translation.vector;
    let exponents = match shape.ring_ratio() {
        Some(a4) => format!("{e1:.2} {e2:.2} /{a4:.1}"),
        None => format!("{e1:.2} {e2:.2}"),
    };
    let _ = writeln!(
        out,
        "{id:>3}  {:<14}  {:<17}  {:<11}  {:<23}  {:>5.1} mm  {:>5.0} %",
        shape.name(),
        format!("{x:.0} x {y:.0} x {z:.0}"),
        exponents,
        numbers(c.as_slice()),
        1e3 * fit.residual,
        1e2 * fit.inlier_share(),
    );
}

/// Why an object has pieces that do not hang together.
fn joined(out: &mut String, object: &Object) {
    let told = |r: &&Reason| !matches!(r, Reason::Whole | Reason::Sliver);
    let reasons: Vec<String> = object.joined.iter().filter(told).map(ToString::to_string).collect();
    if !reasons.is_empty() {
        let _ = writeln!(out, "       put together: {}", reasons.join(", "));
    }
}

fn grasps(out: &mut String, object: &Object, most: usize) {
    match &object.grasps {
        Err(refusal) => {
            let _ = writeln!(out, "       not held: {refusal}");
        }
        Ok(found) => {
            for (rank, g) in found.iter().take(most).enumerate() {
                grasp(out, rank + 1, g);
            }
            if found.len() > most {
                let _ = writeln!(out, "       and {} more", found.len() - most);
            }
        }
    }
}

fn grasp(out: &mut String, rank: usize, g: &Grasp) {
    let t = g.pose.translation.vector;
    let q = g.pose.rotation;
    let width = match (g.opening > 0.0, g.inside) {
        (false, _) => "suction".to_owned(),
        (true, false) => format!("opening {:.0} mm", 1e3 * g.opening),
        (true, true) => {
            format!("inside, {:.0} to {:.0} mm", 1e3 * g.opening, 1e3 * g.contact_width)
        }
    };
    let _ = writeln!(
        out,
        "       {rank}. score {:.2}  {:<22}  at {:<20}  wxyz {:<27}  {}",
        g.score,
        width,
        numbers(t.as_slice()),
        numbers(&[q.w, q.i, q.j, q.k]),
        g.source
    );
    if rank == 1 {
        let terms: Vec<String> = g.terms.iter().map(|(n, v)| format!("{n} {v:.2}")).collect();
        let _ = writeln!(out, "          {}", terms.join("  "));
    }
}

/// Three decimals each, zero without a sign.
fn numbers(values: &[f64]) -> String {
    let shown: Vec<String> =
        values.iter().map(|v| format!("{:.3}", (v * 1e3).round() / 1e3 + 0.0)).collect();
    shown.join(" ")
}

/// What is in a gripper's way, with its size.
fn obstacles(out: &mut String, s: &Segmentation) {
    if s.obstacles().next().is_some() {
        out.push_str("\nin the way:\n");
    }
    for (piece, solid) in s.obstacles() {
        let [x, y, z] = solid.half_extents().map(|h| 2e3 * h);
        let at = numbers(solid.pose().translation.vector.as_slice());
        let _ = writeln!(out, "  {x:.0} x {y:.0} x {z:.0} mm at {at}: {}", piece.reason);
    }
}

fn dropped(out: &mut String, s: &Segmentation) {
    if s.dropped.is_empty() {
        return;
    }
    let mut reasons: Vec<(String, usize, usize)> = Vec::new();
    for d in &s.dropped {
        let reason = d.reason.to_string();
        match reasons.iter_mut().find(|(r, ..)| *r == reason) {
            Some((_, pieces, points)) => {
                *pieces += 1;
                *points += d.points.len();
            }
            None => reasons.push((reason, 1, d.points.len())),
        }
    }
    out.push_str("\nleft out:\n");
    for (reason, pieces, points) in reasons {
        let _ = writeln!(out, "  {pieces} pieces, {points} points: {reason}");
    }
}
