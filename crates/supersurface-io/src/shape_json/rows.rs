//! The rows of a shape file as they stand there, and the shapes that they make.

use nalgebra::UnitQuaternion;
use serde::Deserialize;
use serde_json::Value;
use supersurface::combine::JointKind;
use supersurface::shape::{
    ExtendedSuperellipsoid, Hyperquadric, Implicit, InvalidShape, Quadric, SeparableSuperquadric,
    Supercone, Supercylinder, Superellipsoid, Superformula, SuperhyperboloidOneSheet,
    SuperhyperboloidTwoSheets, Superparaboloid, Supershape, Supertoroid,
};
use supersurface::surface::Solid;

/// A shape by its type; pose and deformations are taken out before.
#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum ShapeRow {
    Superellipsoid { semi_axes: [f64; 3], exponents: [f64; 2] },
    Supertoroid { semi_axes: [f64; 3], ring_ratio: f64, exponents: [f64; 2] },
    SeparableSuperquadric { semi_axes: [f64; 3], powers: [f64; 3] },
    Supershape { longitude: FormulaRow, latitude: FormulaRow },
    Supercylinder { semi_axes: [f64; 3], exponent: f64 },
    Supercone { semi_axes: [f64; 3], exponent: f64 },
    Superparaboloid { semi_axes: [f64; 3], exponents: [f64; 2] },
    SuperhyperboloidOneSheet { semi_axes: [f64; 3], exponents: [f64; 2] },
    SuperhyperboloidTwoSheets { semi_axes: [f64; 3], exponents: [f64; 2] },
    Hyperquadric { planes: Vec<[f64; 4]>, exponents: Vec<f64> },
    ExtendedSuperellipsoid { semi_axes: [f64; 3], profile: Vec<f64>, section: Vec<f64> },
    RadialExtended { semi_axes: [f64; 3], profile: Vec<f64>, section: Vec<f64> },
    Quadric { coefficients: [f64; 10] },
    Union(TreeRow),
    Intersection(TreeRow),
    Difference(TreeRow),
    Assembly(AssemblyRow),
}

/// What a row makes.
pub(super) enum Leaf {
    Solid(Solid),
    Implicit(Box<dyn Implicit + Send + Sync>),
    Extended(ExtendedSuperellipsoid),
    Quadric(Quadric),
    Tree(TreeRow),
    Assembly(AssemblyRow),
}

impl ShapeRow {
    /// The type in words.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Superellipsoid { .. } => "superellipsoid",
            Self::Supertoroid { .. } => "supertoroid",
            Self::SeparableSuperquadric { .. } => "separable superquadric",
            Self::Supershape { .. } => "supershape",
            Self::Supercylinder { .. } => "supercylinder",
            Self::Supercone { .. } => "supercone",
            Self::Superparaboloid { .. } => "superparaboloid",
            Self::SuperhyperboloidOneSheet { .. } => "superhyperboloid of one sheet",
            Self::SuperhyperboloidTwoSheets { .. } => "superhyperboloid of two sheets",
            Self::Hyperquadric { .. } => "hyperquadric",
            Self::ExtendedSuperellipsoid { .. } => "extended superellipsoid",
            Self::RadialExtended { .. } => "radial extended superellipsoid",
            Self::Quadric { .. } => "quadric",
            Self::Union(_) => "union",
            Self::Intersection(_) => "intersection",
            Self::Difference(_) => "difference",
            Self::Assembly(_) => "assembly",
        }
    }

    pub(super) fn leaf(self) -> Result<Leaf, InvalidShape> {
        let extended =
            |a, profile: &[f64], section: &[f64]| ExtendedSuperellipsoid::new(a, profile, section);
        Ok(match self {
            Self::Superellipsoid { semi_axes, exponents } => {
                Leaf::Solid(Superellipsoid::new(semi_axes, exponents)?.into())
            }
            Self::Supertoroid { semi_axes, ring_ratio, exponents } => {
                Leaf::Solid(Supertoroid::new(semi_axes, ring_ratio, exponents)?.into())
            }
            Self::SeparableSuperquadric { semi_axes, powers } => {
                Leaf::Solid(Solid::Separable(SeparableSuperquadric::new(semi_axes, powers)?))
            }
            Self::Supershape { longitude, latitude } => {
                let shape = Supershape::new(longitude.formula()?, latitude.formula()?)?;
                Leaf::Solid(Solid::Supershape(Box::new(shape)))
            }
            Self::Supercylinder { semi_axes, exponent } => {
                Leaf::Solid(Solid::Supercylinder(Supercylinder::new(semi_axes, exponent)?))
            }
            Self::Supercone { semi_axes, exponent } => {
                Leaf::Solid(Solid::Supercone(Supercone::new(semi_axes, exponent)?))
            }
            Self::Superparaboloid { semi_axes, exponents } => {
                Leaf::Implicit(Box::new(Superparaboloid::new(semi_axes, exponents)?))
            }
            Self::SuperhyperboloidOneSheet { semi_axes, exponents } => {
                Leaf::Implicit(Box::new(SuperhyperboloidOneSheet::new(semi_axes, exponents)?))
            }
            Self::SuperhyperboloidTwoSheets { semi_axes, exponents } => {
                Leaf::Implicit(Box::new(SuperhyperboloidTwoSheets::new(semi_axes, exponents)?))
            }
            Self::Hyperquadric { planes, exponents } => {
                Leaf::Implicit(Box::new(Hyperquadric::new(&planes, &exponents)?))
            }
            Self::ExtendedSuperellipsoid { semi_axes, profile, section } => {
                Leaf::Extended(extended(semi_axes, &profile, &section)?)
            }
            Self::RadialExtended { semi_axes, profile, section } => {
                let shape = extended(semi_axes, &profile, &section)?.radial();
                Leaf::Solid(Solid::RadialExtended(Box::new(shape)))
            }
            Self::Quadric { coefficients } => Leaf::Quadric(Quadric::new(coefficients)?),
            Self::Union(tree) | Self::Intersection(tree) | Self::Difference(tree) => {
                Leaf::Tree(tree)
            }
            Self::Assembly(parts) => Leaf::Assembly(parts),
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FormulaRow {
    m: f64,
    n: [f64; 3],
    #[serde(default = "ones")]
    scales: [f64; 2],
}

fn ones() -> [f64; 2] {
    [1.0; 2]
}

impl FormulaRow {
    fn formula(&self) -> Result<Superformula, InvalidShape> {
        Superformula::new(self.m, self.n, self.scales)
    }
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum DeformationRow {
    Taper {
        slopes: [f64; 2],
    },
    Twist {
        turns: f64,
    },
    Bend {
        curvature: f64,
        #[serde(default)]
        angle: f64,
    },
    ShearBend {
        radius: f64,
    },
    Cavity {
        depth: f64,
    },
}

impl DeformationRow {
    pub(super) fn apply(&self, solid: Solid) -> Result<Solid, String> {
        let made = match self {
            Self::Taper { slopes } => solid.tapered(*slopes),
            Self::Twist { turns } => solid.twisted(*turns),
            Self::Bend { curvature, angle } => solid.bent(*curvature, *angle),
            Self::ShearBend { radius } => solid.shear_bent(*radius),
            Self::Cavity { depth } => solid
                .hollowed(*depth)
                .ok_or("a cavity goes into a superellipsoid, before any other deformation")?,
        };
        made.map_err(|e| e.to_string())
    }
}

/// The deformations of a fit, by name.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NamedDeformations {
    taper: Option<[f64; 2]>,
    twist: Option<f64>,
    bend: Option<NamedBend>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NamedBend {
    k: f64,
    #[serde(default)]
    alpha: f64,
}

impl NamedDeformations {
    /// In the order in which they are done: taper, twist, bend.
    pub(super) fn rows(self) -> impl Iterator<Item = (&'static str, DeformationRow)> {
        let bend = |b: NamedBend| DeformationRow::Bend { curvature: b.k, angle: b.alpha };
        let taper = self.taper.map(|slopes| ("taper", DeformationRow::Taper { slopes }));
        let twist = self.twist.map(|turns| ("twist", DeformationRow::Twist { turns }));
        taper.into_iter().chain(twist).chain(self.bend.map(|b| ("bend", bend(b))))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TreeRow {
    pub(super) of: Vec<Value>,
    pub(super) alpha: Option<f64>,
    pub(super) blend: Option<BlendRow>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BlendRow {
    pub(super) amount: f64,
    pub(super) reach: [f64; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AssemblyRow {
    pub(super) parts: Vec<PartRow>,
    #[serde(default)]
    pub(super) joints: Vec<JointRow>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartRow {
    pub(super) name: String,
    pub(super) density: f64,
    pub(super) shape: Value,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointRow {
    pub(super) parent: String,
    pub(super) child: String,
    pub(super) anchor: [f64; 3],
    spring: Option<SpringRow>,
    #[serde(default)]
    fixed: bool,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct SpringRow {
    stiffness: f64,
    #[serde(default)]
    damping: f64,
    #[serde(default)]
    rest_rotation_vector: [f64; 3],
}

impl JointRow {
    pub(super) fn kind(&self) -> JointKind {
        match (self.fixed, self.spring) {
            (true, _) => JointKind::Fixed,
            (false, None) => JointKind::Spherical,
            (false, Some(s)) => JointKind::Spring {
                stiffness: s.stiffness,
                damping: s.damping,
                rest: UnitQuaternion::from_scaled_axis(s.rest_rotation_vector.into()),
            },
        }
    }
}
