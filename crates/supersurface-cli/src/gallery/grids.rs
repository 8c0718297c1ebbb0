//! Figures 1 to 4: superellipsoids and supertoroids over their exponents, seams and poles, cusps.

use std::f64::consts::{FRAC_PI_2, PI};

use supersurface::picture::{Colour, Image, Picture};
use supersurface::shape::{Parametric, Superellipsoid, Supertoroid};
use supersurface::surface::Solid;
use supersurface::{Point, Pose};

use super::sheet::{BLUE, GREEN, INK, ORANGE, RED, Sheet, box_corners};
use crate::exit::Failure;

const EXPONENTS: [f64; 5] = [0.1, 0.5, 1.0, 1.9, 2.5];

pub(super) fn superellipsoids() -> Result<Image, Failure> {
    let mut sheet = Sheet::new("Superellipsoids: ε1 down, ε2 across", EXPONENTS.len());
    for e1 in EXPONENTS {
        for e2 in EXPONENTS {
            let shape = Superellipsoid::new([1.0; 3], [e1, e2]).map_err(Failure::input)?;
            sheet.solid(format!("ε1 = {e1}, ε2 = {e2}"), &shape.into(), BLUE);
        }
    }
    Ok(sheet.finish())
}

pub(super) fn supertoroids() -> Result<Image, Failure> {
    let mut sheet = Sheet::new("Supertoroids, a4 = 3: ε1 down, ε2 across", EXPONENTS.len());
    for e1 in EXPONENTS {
        for e2 in EXPONENTS {
            let shape = Supertoroid::new([1.0, 1.0, 1.4], 3.0, [e1, e2]).map_err(Failure::input)?;
            sheet.solid(format!("ε1 = {e1}, ε2 = {e2}"), &shape.into(), ORANGE);
        }
    }
    Ok(sheet.finish())
}

/// The lines where an angle is a multiple of π/2, and the poles.
pub(super) fn seams() -> Result<Image, Failure> {
    let mut sheet =
        Sheet::new("Seams: multiples of 90 degrees along (red) and around z (black); poles", 3);
    for e in [[0.3, 0.3], [1.0, 1.0], [1.6, 0.6]] {
        let shape: Solid = Superellipsoid::new([1.0, 0.8, 1.2], e).map_err(Failure::input)?.into();
        draw_seams(&mut sheet, &shape, &[0.0], &format!("superellipsoid, ε = {e:?}"));
    }
    for e in [[0.3, 1.0], [1.0, 1.0], [1.6, 0.6]] {
        let shape: Solid =
            Supertoroid::new([1.0, 0.8, 1.2], 2.5, e).map_err(Failure::input)?.into();
        let rings = [0.0, FRAC_PI_2, -FRAC_PI_2, PI];
        draw_seams(&mut sheet, &shape, &rings, &format!("supertoroid, ε = {e:?}"));
    }
    Ok(sheet.finish())
}

fn draw_seams(sheet: &mut Sheet, solid: &Solid, etas: &[f64], caption: &str) {
    let [eta_range, _] = solid.domain();
    let closed = eta_range[0] < -FRAC_PI_2;
    sheet.cell(caption, &box_corners(solid), |picture| {
        picture.solid(solid, &Pose::identity(), [150, 180, 215], 1.0);
        for eta in etas {
            curve(picture, RED, |t| solid.point(*eta, -PI + 2.0 * PI * t));
        }
        for quarter in -1..=2 {
            let omega = f64::from(quarter) * FRAC_PI_2;
            let [from, to] = eta_range;
            curve(picture, INK, |t| solid.point(from + (to - from) * t, omega));
        }
        if !closed {
            let poles = [solid.point(FRAC_PI_2, 0.0), solid.point(-FRAC_PI_2, 0.0)];
            picture.points(&poles, |_| INK, Some(9.0));
        }
    });
}

/// A line along a curve, lifted off the surface a little.
fn curve(picture: &mut Picture, colour: Colour, at: impl Fn(f64) -> Point) {
    const STEPS: usize = 400;
    let points: Vec<Point> = (0..=STEPS).map(|i| at(i as f64 / STEPS as f64)).collect();
    for pair in points.windows(2) {
        if let [a, b] = pair {
            picture.line(&(a * 1.003), &(b * 1.003), colour, 2.5);
        }
    }
}

/// Exponents from 2 on: no normal where the surface comes to a point or an edge.
pub(super) fn cusps() -> Result<Image, Failure> {
    let mut sheet = Sheet::new("Normals, and cusps (red) where there are none: ε from 2 on", 3);
    for e in [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [1.0, 2.6], [2.6, 1.0], [3.0, 3.0]] {
        let shape = Superellipsoid::new([1.0; 3], e).map_err(Failure::input)?;
        let around = box_corners(&shape);
        sheet.cell(format!("ε = {e:?}"), &around, |picture| {
            picture.solid(&Solid::from(shape), &Pose::identity(), [165, 195, 165], 1.0);
            let mut cusps = Vec::new();
            for i in -4..=4 {
                for k in -8..8 {
                    // away from the seams, and on them
                    let (eta, omega) = (f64::from(i) * PI / 8.0, (f64::from(k)) * PI / 8.0);
                    let p = shape.point(eta, omega);
                    match shape.normal(eta, omega) {
                        Some(n) => {
                            let tip = p + n.into_inner() * 0.25;
                            picture.arrow(&p, &tip, GREEN, 1.5);
                        }
                        None => cusps.push(p),
                    }
                }
            }
            picture.points(&cusps, |_| RED, Some(8.0));
        });
    }
    Ok(sheet.finish())
}
