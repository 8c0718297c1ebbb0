//! One object or several that touch? What one surface explains badly is cut at its concave edges, and the cut
//! stands when the pieces' surfaces explain them well.
//!
//! - A hollow thing (its hole is seen, so it was found to be a toroid) stays whole: its inside is concave.
//! - A sliver along an edge belongs to the piece whose surface is nearest.
//! - Two pieces that one surface explains about as well as their own two do are one thing behind another.

use crate::cloud::{PointCloud, VoxelGrid};
use crate::fit::{Fit, FitError};
use crate::segment::convex_pieces;
use crate::surface::Surface;
use crate::{Point, shape::Implicit};

/// Points with their surface.
pub(super) type Fitted = (Vec<u32>, Result<Fit, FitError>);

/// Median distance to its surface from which a thing is explained badly, in metres, and the share of that
/// which the pieces of a heap may have.
const POOR: f64 = 0.0025;
const BETTER: f64 = 0.5;
/// Share of a heap's points under which a piece is a sliver, and the distance to the surface that it joins, in
/// metres.
const SLIVER: f64 = 0.05;
const BESIDE: f64 = 0.006;
/// How much worse a surface of both may explain each of two pieces, and up to which distance in metres that
/// does not matter.
const WORSE: f64 = 1.8;
const SLIGHT: f64 = 0.0012;
/// Pieces that come nearer than this were cut from each other, in metres.
const CONTACT: f64 = 0.008;
/// Most pieces of a heap between which joints are tried.
const MOST: usize = 12;

/// The things that a whole with its surface consists of.
pub(super) fn parted(
    cloud: &PointCloud,
    (whole, fit): Fitted,
    fit_points: &dyn Fn(&[u32]) -> Result<Fit, FitError>,
) -> Vec<Fitted> {
    let before = fit.as_ref().map_or(f64::INFINITY, |f| f.residual);
    let hollow = fit.as_ref().is_ok_and(|f| matches!(f.surface.shape(), Surface::Supertoroid(_)));
    if before < POOR || hollow {
        return vec![(whole, fit)];
    }
    let pieces = convex_pieces(cloud, &whole);
    let sliver = (SLIVER * whole.len() as f64) as usize;
    let (large, small): (Vec<_>, Vec<_>) = pieces.into_iter().partition(|p| p.len() > sliver);
    if large.len() < 2 {
        return vec![(whole, fit)];
    }
    let fitted = |points: Vec<u32>| {
        let fit = fit_points(&points);
        (points, fit)
    };
    let mut pieces: Vec<Fitted> = large.into_iter().map(fitted).collect();
    for points in small {
        add_sliver(cloud, &mut pieces, points, fit_points);
    }
    if pieces.len() <= MOST {
        pieces = joined(cloud, pieces, fit_points);
    }
    let count: usize = pieces.iter().map(|p| p.0.len()).sum();
    let residual =
        |(points, fit): &Fitted| points.len() as f64 * fit.as_ref().map_or(before, |f| f.residual);
    let after = pieces.iter().map(residual).sum::<f64>() / count as f64;
    if after < BETTER * before { pieces } else { vec![(whole, fit)] }
}

/// Gives a sliver to the piece whose surface is nearest; one that is near to none stays a piece.
fn add_sliver(
    cloud: &PointCloud,
    pieces: &mut Vec<Fitted>,
    points: Vec<u32>,
    fit_points: &dyn Fn(&[u32]) -> Result<Fit, FitError>,
) {
    let distance = |p: &Fitted| p.1.as_ref().map_or(f64::INFINITY, |f| typical(cloud, &points, f));
    let nearest = pieces.iter().map(distance).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    match nearest {
        Some((k, distance)) if distance < BESIDE => {
            pieces[k].0.extend(points);
            pieces[k].0.sort_unstable();
        }
        _ => {
            let fit = fit_points(&points);
            pieces.push((points, fit));
        }
    }
}

/// Joins pieces that one surface explains about as well as their own do.
fn joined(
    cloud: &PointCloud,
    pieces: Vec<Fitted>,
    fit_points: &dyn Fn(&[u32]) -> Result<Fit, FitError>,
) -> Vec<Fitted> {
    let mut out: Vec<Fitted> = Vec::new();
    for mut piece in pieces {
        // what a piece joins may join others in turn
        while let Some((k, joint)) =
            (0..out.len()).find_map(|k| Some((k, joint(cloud, &out[k], &piece, fit_points)?)))
        {
            drop(out.remove(k));
            piece = joint;
        }
        out.push(piece);
    }
    out
}

/// Both pieces as one, if they are.
fn joint(
    cloud: &PointCloud,
    a: &Fitted,
    b: &Fitted,
    fit_points: &dyn Fn(&[u32]) -> Result<Fit, FitError>,
) -> Option<Fitted> {
    let (first, second) = (a.1.as_ref().ok()?, b.1.as_ref().ok()?);
    if touch(cloud, &a.0, &b.0) {
        return None;
    }
    let mut points = [&a.0[..], &b.0[..]].concat();
    points.sort_unstable();
    let fit = fit_points(&points).ok()?;
    let explained = [(&a.0, first), (&b.0, second)]
        .iter()
        .all(|(points, own)| typical(cloud, points, &fit) < (WORSE * own.residual).max(SLIGHT));
    explained.then_some((points, Ok(fit)))
}

/// Whether two pieces come so near to each other that they meet at an edge.
fn touch(cloud: &PointCloud, a: &[u32], b: &[u32]) -> bool {
    let Some(grid) = VoxelGrid::new(&cloud.points, a.iter().copied(), CONTACT) else {
        return false;
    };
    b.iter().any(|i| {
        let mut near = false;
        grid.within(&cloud.points[*i as usize], CONTACT, |_, _| near = true);
        near
    })
}

/// Median of the first-order distances `|g - 1|/|∇g|` of some of the points.
fn typical(cloud: &PointCloud, points: &[u32], fit: &Fit) -> f64 {
    const SOME: usize = 200;
    let shape = fit.surface.shape();
    let distance = |i: &u32| {
        let p: Point = fit.surface.pose().inverse_transform_point(&cloud.points[*i as usize]);
        (shape.gauge(&p) - 1.0).abs() / shape.gradient(&p).norm().max(1e-9)
    };
    let mut distances: Vec<f64> =
        points.iter().step_by(points.len().div_ceil(SOME).max(1)).map(distance).collect();
    if distances.is_empty() {
        return f64::INFINITY;
    }
    let middle = distances.len() / 2;
    *distances.select_nth_unstable_by(middle, f64::total_cmp).1
}
