//! Figure 10: points on a surface, with noise and cut; spread by angles, by equal arcs, by area.

use std::f64::consts::{FRAC_PI_2, PI};

use supersurface::mesh::{Spacing, SurfaceSampler, superellipsoid_grid};
use supersurface::numeric::random::Stream;
use supersurface::picture::{Image, Picture};
use supersurface::shape::{Implicit, Parametric, Superellipsoid};
use supersurface::surface::Solid;
use supersurface::{Point, Vector};

use super::sheet::{INK, Sheet, VIEW, box_corners};
use crate::exit::Failure;

pub(super) fn samples() -> Result<Image, Failure> {
    let shape = Superellipsoid::new([1.0, 1.0, 1.4], [0.3, 0.5]).map_err(Failure::input)?;
    let solid = Solid::from(shape).tapered([-0.3, -0.3]).map_err(Failure::input)?;
    let mut sheet =
        Sheet::new("Samples of a tapered superellipsoid and of one with ε = [0.3, 0.5]", 5);
    let corners = box_corners(&solid);
    let uniform = |solid: &Solid, count| -> Result<Vec<Point>, Failure> {
        let sampler = SurfaceSampler::new(solid, None).map_err(Failure::input)?;
        Ok(sampler.points(count, 1).into_iter().map(|s| s.point).collect())
    };
    let mut noisy = uniform(&solid, 6000)?;
    noisy.retain(|p| p.x + 0.5 * p.z >= -0.3);
    for (i, p) in noisy.iter_mut().enumerate() {
        let mut stream = Stream::new(10, i as u64);
        *p += Vector::from_fn(|_, _| 0.03 * stream.normal());
    }
    sheet.cell("noise, cut by a plane", &corners, |picture| dots(picture, &solid, &noisy));

    let corners = box_corners(&shape);
    let by_angles: Vec<Point> = (0..2000)
        .map(|i| {
            let mut stream = Stream::new(11, i);
            shape.point(stream.between(-FRAC_PI_2, FRAC_PI_2), stream.between(-PI, PI))
        })
        .collect();
    sheet.cell("uniform in the angles", &corners, |picture| dots(picture, &shape, &by_angles));
    for (caption, spacing) in
        [("Pilu and Fisher", Spacing::PiluFisher), ("equal arcs", Spacing::EqualArc)]
    {
        let points = superellipsoid_grid(&shape, spacing, 0.13).map_err(Failure::input)?;
        sheet.cell(caption, &corners, |picture| dots(picture, &shape, &points));
    }
    let by_area = uniform(&shape.into(), 2000)?;
    sheet.cell("uniform over the area", &corners, |picture| dots(picture, &shape, &by_area));
    Ok(sheet.finish())
}

/// Points of the side that faces the viewer.
fn dots(picture: &mut Picture, solid: &impl Implicit, points: &[Point]) {
    let facing = |p: &&Point| solid.gradient(p).dot(&VIEW) > 0.0;
    let seen: Vec<Point> = points.iter().filter(facing).copied().collect();
    picture.points(&seen, |_| INK, Some(2.5));
}
