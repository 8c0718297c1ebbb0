//! The picture of a report: what the camera saw on the left, what was made of it on the right.

use std::fmt::Write;

use supersurface::cloud::PointCloud;
use supersurface::grasp::{Grasp, Gripper, Kind};
use supersurface::nalgebra::center;
use supersurface::picture::{Colour, Image, Picture, View, mix};
use supersurface::pipeline::{Object, Report};
use supersurface::{Point, Vector};

const WIDTH: usize = 800;
const HEIGHT: usize = 720;
/// Colours of objects, told apart also when dimmed.
const OBJECTS: [Colour; 8] = [
    [31, 119, 180],
    [255, 127, 14],
    [44, 160, 44],
    [214, 39, 40],
    [148, 103, 189],
    [140, 86, 75],
    [227, 119, 194],
    [23, 150, 165],
];
const GREY: Colour = [150, 152, 156];
/// What is in the way.
const CLAY: Colour = [150, 124, 100];
const STEEL: Colour = [70, 76, 86];
const INK: Colour = [28, 30, 34];

/// Draws cloud, surfaces and the best grasp of each object.
pub(crate) fn picture(cloud: &PointCloud, report: &Report, gripper: Option<&Gripper>) -> Image {
    let labels = report.segmentation.labels(&cloud.points);
    let shown = interest(cloud, report);
    let up = up(cloud, report, &shown);
    let from = viewpoint(cloud, &shown, &up);
    let solid = solid(cloud, report);
    let seen = seen(cloud, &labels, &solid, &View::towards(&shown, &up, &from));
    let turned = View::turned(&shown, &up, &from, -0.45, 0.2);
    let made = made(cloud, &labels, &solid, report, gripper, &View::towards(&shown, &up, &turned));
    let mut image = seen.beside(&made, 4);
    image.text(14.0, 12.0, "seen: the cloud, objects in colours", INK, 16.0);
    let grasps = gripper.map(|g| format!(" and best grasps of {}", g.name)).unwrap_or_default();
    let title = format!("made of it: surfaces{grasps}");
    image.text(WIDTH as f64 + 18.0, 12.0, &title, INK, 16.0);
    image
}

/// The points that a picture must show: the objects, with their surfaces.
fn interest(cloud: &PointCloud, report: &Report) -> Vec<Point> {
    let mut shown: Vec<Point> = Vec::new();
    for object in &report.segmentation.objects {
        let step = (object.len() / 500).max(1);
        shown.extend(object.iter().step_by(step).map(|i| cloud.points[*i as usize]));
    }
    if shown.is_empty() {
        let step = (cloud.points.len() / 2000).max(1);
        shown = cloud.points.iter().step_by(step).copied().collect();
        shown.retain(|p| p.coords.iter().all(|v| v.is_finite()));
    }
    // room for grippers and the table around
    let middle = shown.iter().map(|p| p.coords).sum::<Vector>() / shown.len().max(1) as f64;
    let edge: Vec<Point> = shown.iter().map(|p| p + (p.coords - middle) * 0.25).collect();
    shown.extend(edge);
    shown
}

/// The table's normal, or against gravity in an optical frame, whichever way it looks along z.
fn up(cloud: &PointCloud, report: &Report, shown: &[Point]) -> Vector {
    if let Some(table) = report.segmentation.support() {
        return table.normal().into_inner();
    }
    let origin = cloud.viewpoint.unwrap_or_else(Point::origin);
    let ahead = shown.first().map_or(1.0, |p| p.z - origin.z);
    if ahead < 0.0 { Vector::y() } else { -Vector::y() }
}

/// Where the sensor stood; for a cloud from all around a place in front of it.
fn viewpoint(cloud: &PointCloud, shown: &[Point], up: &Vector) -> Point {
    let Some(first) = shown.first() else { return Point::new(0.0, 0.0, 1.0) };
    let (low, high) =
        shown.iter().fold((*first, *first), |(low, high), p| (low.inf(p), high.sup(p)));
    let (middle, size) = (center(&low, &high), (high - low).norm());
    match cloud.viewpoint {
        Some(p) if (p - middle).norm() > 0.6 * size => p,
        _ => {
            let aside = if up.x.abs() < 0.7 { Vector::x() } else { Vector::z() };
            middle + (up.cross(&aside).normalize() + aside * 0.4 + up * 0.8) * (2.0 * size)
        }
    }
}

/// The points of obstacles.
fn solid(cloud: &PointCloud, report: &Report) -> Vec<bool> {
    let mut solid = vec![false; cloud.points.len()];
    for (piece, _) in report.segmentation.obstacles() {
        piece.points.iter().for_each(|i| solid[*i as usize] = true);
    }
    solid
}

fn tint(label: i32) -> Option<Colour> {
    usize::try_from(label - 1).ok().map(|k| OBJECTS[k % OBJECTS.len()])
}

/// The cloud in its own colours (or grey), objects tinted.
fn seen(cloud: &PointCloud, labels: &[i32], solid: &[bool], view: &View) -> Image {
    let mut picture = Picture::new(WIDTH, HEIGHT, view);
    let own = |i: usize| cloud.colours.get(i).copied().unwrap_or(GREY);
    let colour = |i: usize| match tint(labels[i]) {
        Some(c) => mix(own(i), c, 0.55),
        None if solid[i] => mix(own(i), CLAY, 0.5),
        None => own(i),
    };
    picture.points(&cloud.points, colour, None);
    picture.finish()
}

/// The dimmed cloud, the surfaces over it, and the best grasp of each object.
fn made(
    cloud: &PointCloud,
    labels: &[i32],
    solid: &[bool],
    report: &Report,
    gripper: Option<&Gripper>,
    view: &View,
) -> Image {
    let mut picture = Picture::new(WIDTH, HEIGHT, view);
    let colour = |i: usize| match tint(labels[i]) {
        Some(c) => mix(c, [255; 3], 0.2),
        None if solid[i] => mix(CLAY, [255; 3], 0.35),
        None => [206, 208, 212],
    };
    picture.points(&cloud.points, colour, None);
    for (_, solid) in report.segmentation.obstacles() {
        frame(&mut picture, &solid.corners());
    }
    for support in report.segmentation.supports.iter().skip(1) {
        let corners = support.corners();
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            picture.line(a, b, STEEL, 1.5);
        }
    }
    for (k, object) in report.objects.iter().enumerate() {
        let colour = OBJECTS[k % OBJECTS.len()];
        if let Ok(fit) = &object.fit {
            picture.surface(&fit.surface, colour, 0.5);
        }
        let best = object.grasps.as_ref().ok().and_then(|g| g.first());
        if let (Some(gripper), Some(best)) = (gripper, best) {
            draw_gripper(&mut picture, gripper, best);
        }
    }
    for (k, object) in report.objects.iter().enumerate() {
        let points = &report.segmentation.objects[k];
        if let Some(at) = points.get(points.len() / 2).map(|i| cloud.points[*i as usize]) {
            picture.label(&at, &caption(k + 1, object), OBJECTS[k % OBJECTS.len()]);
        }
    }
    picture.finish()
}

/// The edges of a box, by its corners.
fn frame(picture: &mut Picture, corners: &[Point; 8]) {
    for (k, a) in corners.iter().enumerate() {
        for bit in [1, 2, 4].into_iter().filter(|bit| k & bit == 0) {
            picture.line(a, &corners[k | bit], CLAY, 1.0);
        }
    }
}

fn caption(id: usize, object: &Object) -> String {
    let mut words = id.to_string();
    if let Ok(fit) = &object.fit {
        let [x, y, z] = fit.surface.shape().half_extents().map(|h| 2e3 * h);
        let kind = if fit.surface.shape().ring_ratio().is_some() { "toroid " } else { "" };
        let _ = write!(words, " {kind}{x:.0}x{y:.0}x{z:.0}");
    }
    match &object.grasps {
        Ok(grasps) => {
            for best in grasps.iter().take(1) {
                let _ = write!(words, " {} {:.2}", best.source, best.score);
            }
        }
        Err(_) => words.push_str(" not held"),
    }
    words
}

/// A sign of the gripper where the grasp puts it, and the way in. Its real boxes would hide the scene.
fn draw_gripper(picture: &mut Picture, gripper: &Gripper, grasp: &Grasp) {
    match &gripper.kind {
        Kind::Jaw(jaw) => {
            // inside grasps name the distance over the outer faces
            let gap = match (grasp.inside, jaw.outer_width_closed) {
                (true, Some(closed)) => grasp.opening - closed,
                _ => grasp.opening,
            };
            picture.jaw(&grasp.pose, gap, jaw.finger_depth - jaw.tip_beyond_tcp, STEEL);
        }
        Kind::Suction(cup) => {
            picture.cup(&grasp.pose, cup.lip_radius, STEEL);
        }
    }
}
