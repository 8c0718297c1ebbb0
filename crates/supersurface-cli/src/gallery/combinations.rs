//! Figure 11: solids combined by R-functions, and parts joined to an assembly.

use supersurface::combine::{Alpha, Blend, CombinedSolid};
use supersurface::mesh::{MarchOptions, Resolution, march};
use supersurface::picture::Image;
use supersurface::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use supersurface::{Pose, Vector};
use supersurface_io::{Model, parse_shape};

use super::sheet::{BLUE, ORANGE, Sheet, box_corners};
use crate::exit::Failure;

/// The teddy bear, as a shape file.
const BEAR: &str = include_str!("bear.json");

pub(super) fn combinations() -> Result<Image, Failure> {
    let mut sheet =
        Sheet::new("Boolean trees by R-functions, and a bear of ten parts at nine joints", 4);
    let fine = MarchOptions { resolution: Resolution::Count(90), ..MarchOptions::default() };
    for (caption, solid) in trees().map_err(Failure::input)? {
        sheet.mesh(caption, &march(&solid, &fine).map_err(Failure::input)?, ORANGE);
    }
    let Model::Assembly(bear) =
        parse_shape("bear.json", BEAR.as_bytes()).map_err(Failure::input)?
    else {
        return Err(Failure::input("bear.json: is no assembly"));
    };
    let bodies = bear.bodies(&bear.rest_rotations());
    let corners: Vec<_> = bodies.iter().flat_map(box_corners).collect();
    sheet.seen_from(Vector::new(0.5, 1.8, 0.5), "assembly", &corners, |picture| {
        for body in &bodies {
            picture.solid(body.shape(), body.pose(), [170, 120, 70], 1.0);
        }
    });
    let count = bear.parts().len();
    sheet.seen_from(Vector::new(0.5, 1.8, 0.5), "its joints", &corners, |picture| {
        for body in &bodies {
            picture.solid(body.shape(), body.pose(), BLUE, 0.3);
        }
        let anchors: Vec<_> = bear.joints().iter().map(|j| j.anchor()).collect();
        picture.points(&anchors, |_| [20, 20, 20], Some(9.0));
        picture.text(8.0, 8.0, &format!("{count} parts"), [60, 60, 60], 10.0);
    });
    Ok(sheet.finish())
}

fn trees() -> Result<Vec<(&'static str, CombinedSolid)>, InvalidShape> {
    let ball = || Superellipsoid::new([1.0; 3], [1.0; 2]).map(CombinedSolid::new);
    let bar = |turn: Vector| {
        let bar = Superellipsoid::new([0.45, 0.45, 1.5], [0.2, 0.3])?;
        Posed::new(bar, Pose::rotation(turn)).map(CombinedSolid::new)
    };
    let (upright, across) = (Vector::zeros(), Vector::x() * std::f64::consts::FRAC_PI_2);
    let ring = CombinedSolid::new(Supertoroid::new([0.3; 3], 3.0, [1.0; 2])?);
    Ok(vec![
        ("union", ball()?.union(bar(across)?, Alpha::SMOOTH)),
        ("intersection", ball()?.intersection(bar(upright)?, Alpha::SMOOTH)),
        (
            "difference",
            ball()?
                .difference(bar(upright)?, Alpha::SMOOTH)
                .difference(bar(across)?, Alpha::SMOOTH),
        ),
        ("blended union", ring.blend_union(bar(across)?, Blend::new(0.3, [0.5, 0.5])?)),
    ])
}
