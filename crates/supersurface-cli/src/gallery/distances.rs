//! Figures 8 and 9: distances of points to superellipsoids and supertoroids, along rays and exactly.

use supersurface::measure::ClosestFinder;
use supersurface::nalgebra::UnitQuaternion;
use supersurface::numeric::random::Stream;
use supersurface::picture::{Image, Picture};
use supersurface::shape::{Superellipsoid, Supertoroid};
use supersurface::{Point, Pose, Vector};

use super::sheet::{BLUE, GREEN, INK, RED, Sheet, box_corners};
use crate::exit::Failure;

/// Lines from points to their feet on the surface.
fn lines(picture: &mut Picture, pairs: &[(Point, Point)], colour: [u8; 3]) {
    for (p, foot) in pairs {
        picture.line(p, foot, colour, 2.0);
    }
    let (points, feet): (Vec<Point>, Vec<Point>) = pairs.iter().copied().unzip();
    picture.points(&points, |_| INK, Some(7.0)).points(&feet, |_| colour, Some(6.0));
}

/// Points of a ball's shell on the side of the viewer.
fn around(reach: [f64; 3], count: u64) -> Vec<Point> {
    let place = |i| {
        let mut stream = Stream::new(8, i);
        let v = Vector::from_fn(|_, _| stream.normal()).normalize();
        let v = Vector::new(v.x.abs(), -v.y.abs(), v.z.abs() - 0.15);
        Point::from(v.component_mul(&Vector::from(reach)))
    };
    (0..count).map(place).collect()
}

pub(super) fn radial() -> Result<Image, Failure> {
    let mut sheet =
        Sheet::new("Distances: along the ray from the centre (red), nearest (green)", 3);
    for e in [[0.3, 0.3], [1.0, 1.0], [0.3, 1.6]] {
        let shape = Superellipsoid::new([1.0, 0.6, 0.8], e).map_err(Failure::input)?;
        let finder = ClosestFinder::superellipsoid(&shape);
        let points = around([1.7, 1.3, 1.5], 14);
        let feet = |foot: &dyn Fn(&Point) -> Option<Point>| -> Vec<(Point, Point)> {
            points.iter().filter_map(|p| Some((*p, foot(p)?))).collect()
        };
        let along = feet(&|p| shape.radial_foot(p));
        let nearest = feet(&|p| finder.find(p).map(|c| c.point));
        let shown = [points.clone(), box_corners(&shape)].concat();
        sheet.cell(format!("ε = {e:?}"), &shown, |picture| {
            picture.solid(&shape.into(), &Pose::identity(), [170, 195, 225], 1.0);
            lines(picture, &along, RED);
            lines(picture, &nearest, GREEN);
        });
    }
    Ok(sheet.finish())
}

pub(super) fn meridian() -> Result<Image, Failure> {
    let title =
        "Distances: from the mean superellipse in the meridian plane (red), nearest (green)";
    let mut sheet = Sheet::new(title, 3);
    for e in [[0.4, 0.4], [1.0, 1.0], [1.6, 0.6]] {
        let shape = Supertoroid::new([0.3, 0.25, 0.4], 3.0, e).map_err(Failure::input)?;
        let finder = ClosestFinder::supertoroid(&shape);
        let points = around([1.9, 1.7, 0.9], 12);
        let pairs = |foot: &dyn Fn(&Point) -> Option<Point>| -> Vec<(Point, Point)> {
            points.iter().filter_map(|p| Some((*p, foot(p)?))).collect()
        };
        let along = pairs(&|p| shape.meridian_foot(p).map(|f| f.foot));
        let nearest = pairs(&|p| finder.find(p).map(|c| c.point));
        // the mean superellipse, by the parameter of many points around
        let ring: Vec<Point> = (0..=200)
            .filter_map(|k| {
                let turn = UnitQuaternion::from_scaled_axis(
                    Vector::z() * (f64::from(k) * std::f64::consts::TAU / 200.0),
                );
                shape.meridian_foot(&(turn * Point::new(9.0, 0.0, 0.0))).map(|f| f.mean_point)
            })
            .collect();
        let shown = [points.clone(), box_corners(&shape)].concat();
        sheet.cell(format!("ε = {e:?}"), &shown, |picture| {
            picture.solid(&shape.into(), &Pose::identity(), BLUE, 0.55);
            for pair in ring.windows(2) {
                if let [a, b] = pair {
                    picture.line(a, b, INK, 1.5);
                }
            }
            lines(picture, &along, RED);
            lines(picture, &nearest, GREEN);
        });
    }
    Ok(sheet.finish())
}
