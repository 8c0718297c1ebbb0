//! Figures 5 and 7: what deformations do, and the other members of the family.

use supersurface::combine::{Alpha, CombinedSolid};
use supersurface::mesh::{MarchOptions, Mesh, march, tessellate};
use supersurface::picture::Image;
use supersurface::shape::{
    ExtendedSuperellipsoid, Hyperquadric, Implicit, InvalidShape, SeparableSuperquadric, Supercone,
    Supercylinder, Superellipsoid, Superformula, SuperhyperboloidOneSheet,
    SuperhyperboloidTwoSheets, Superparaboloid, Supershape,
};
use supersurface::surface::Solid;

use super::sheet::{BLUE, GREEN, ORANGE, Sheet};
use crate::exit::Failure;

pub(super) fn deformations() -> Result<Image, Failure> {
    let solids = deformed().map_err(Failure::input)?;
    let mut sheet = Sheet::new("Deformations of a superellipsoid, ε = [0.3, 0.6]", 4);
    for (caption, solid) in &solids {
        sheet.solid(*caption, solid, GREEN);
    }
    Ok(sheet.finish())
}

fn deformed() -> Result<Vec<(&'static str, Solid)>, InvalidShape> {
    let stick = || Superellipsoid::new([0.5, 0.5, 1.5], [0.3, 0.6]).map(Solid::from);
    let dish = Superellipsoid::new([1.0, 1.0, 0.6], [0.3, 0.8])?;
    let hollow = Solid::from(dish).hollowed(1.6).unwrap_or_else(stick)?;
    Ok(vec![
        ("undeformed", stick()?),
        ("taper, K = (0.6, 0.6)", stick()?.tapered([0.6, 0.6])?),
        ("taper, K = (-0.8, 0.2)", stick()?.tapered([-0.8, 0.2])?),
        ("twist, a quarter turn", stick()?.twisted(0.25)?),
        ("bend, k = 0.7/m", stick()?.bent(0.7, 0.0)?),
        ("shear bend (21), k = 0.8 m", stick()?.shear_bent(0.8)?),
        ("taper, twist and bend", stick()?.tapered([-0.4, -0.4])?.twisted(0.3)?.bent(0.7, 0.8)?),
        ("cavity, c = 1.6", hollow),
    ])
}

pub(super) fn members() -> Result<Image, Failure> {
    let mut sheet = Sheet::new("Other members of the family; endless ones are cut by a box", 4);
    for (caption, mesh) in others()? {
        sheet.mesh(caption, &mesh, if caption.contains("cut") { ORANGE } else { BLUE });
    }
    Ok(sheet.finish())
}

fn others() -> Result<Vec<(&'static str, Mesh)>, Failure> {
    let made = || -> Result<Vec<(&'static str, Member)>, InvalidShape> {
        let [profile, section] =
            [vec![0.2, 0.9, 1.6, 0.4], vec![0.3, 1.0, 1.8, 1.0, 0.3, 1.0, 1.8, 1.0]];
        let star = Superformula::new(6.0, [0.6, 1.2, 1.2], [1.0; 2])?;
        let round = Superformula::new(4.0, [4.0, 4.0, 4.0], [1.0; 2])?;
        let planes = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.6, 0.6, 0.6, 0.3],
        ];
        let extended = ExtendedSuperellipsoid::new([1.0; 3], &profile, &section)?;
        let (a, e) = ([0.5, 0.5, 0.5], [0.8, 0.8]);
        Ok(vec![
            (
                "supercylinder, ε2 = 0.6",
                Member::Solid(Solid::Supercylinder(Supercylinder::new([1.0; 3], 0.6)?)),
            ),
            (
                "supercone, ε2 = 1.4",
                Member::Solid(Solid::Supercone(Supercone::new([1.0; 3], 1.4)?)),
            ),
            (
                "equation 6, k = (2, 4, 10)",
                Member::Solid(Solid::Separable(SeparableSuperquadric::new(
                    [1.0; 3],
                    [2.0, 4.0, 10.0],
                )?)),
            ),
            (
                "supershape, m = 6",
                Member::Solid(Solid::Supershape(Box::new(Supershape::new(star, round)?))),
            ),
            ("hyperquadric, 4 terms", marched(Hyperquadric::new(&planes, &[4.0, 4.0, 6.0, 8.0])?)),
            ("extended superellipsoid (23)", Member::Extended(extended.clone())),
            (
                "the same, radially",
                Member::Solid(Solid::RadialExtended(Box::new(extended.radial()))),
            ),
            ("superparaboloid, cut", cut(Superparaboloid::new(a, [0.7, 0.6])?)?),
            ("one sheet, cut", cut(SuperhyperboloidOneSheet::new(a, e)?)?),
            ("two sheets, cut", cut(SuperhyperboloidTwoSheets::new(a, e)?)?),
        ])
    };
    let mut meshes = Vec::new();
    for (caption, member) in made().map_err(Failure::input)? {
        meshes.push((caption, member.mesh()?));
    }
    Ok(meshes)
}

/// How a member comes to its mesh.
enum Member {
    Solid(Solid),
    Extended(ExtendedSuperellipsoid),
    Marched(Box<dyn Implicit + Send + Sync>),
}

impl Member {
    fn mesh(&self) -> Result<Mesh, Failure> {
        let fine = MarchOptions::default();
        match self {
            Self::Solid(s) => tessellate(s, None).map(|t| t.mesh).map_err(Failure::input),
            Self::Extended(s) => tessellate(s, None).map(|t| t.mesh).map_err(Failure::input),
            Self::Marched(s) => march(&**s, &fine).map_err(Failure::input),
        }
    }
}

fn marched(solid: impl Implicit + Send + Sync + 'static) -> Member {
    Member::Marched(Box::new(solid))
}

/// What of a solid is in a box.
fn cut(solid: impl Implicit + Send + Sync + 'static) -> Result<Member, InvalidShape> {
    let room = Superellipsoid::new([1.2; 3], [0.05, 0.05])?;
    let part = CombinedSolid::new(solid).intersection(CombinedSolid::new(room), Alpha::EXACT);
    Ok(marched(part))
}
