//! Shapes as JSON: any member of the family, deformed, posed, combined or joined (`docs/shape.md`).

mod rows;

use std::fmt;
use std::path::Path;

use nalgebra::{Isometry3, Quaternion, UnitQuaternion};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use supersurface::combine::{Alpha, Assembly, Blend, CombinedSolid, Joint, Part};
use supersurface::shape::{ExtendedSuperellipsoid, Implicit, InvalidShape, Posed, Quadric};
use supersurface::surface::{Solid, Surface};
use supersurface::{Pose, Vector};

use self::rows::{AssemblyRow, DeformationRow, Leaf, NamedDeformations, ShapeRow, TreeRow};
use crate::error::{Fault, ReadError};
use crate::fit_json;
use crate::read::{BOM, load, shown_name};

/// What a shape file holds.
pub enum Model {
    /// A closed member of the family with a parametric form, deformed or not.
    Solid(Posed<Solid>),
    /// A member by its implicit form alone, closed or not, with its name.
    Implicit(&'static str, Posed<Box<dyn Implicit + Send + Sync>>),
    /// The parametric extended superellipsoid (equation 23).
    Extended(Posed<ExtendedSuperellipsoid>),
    /// A general quadric.
    Quadric(Quadric),
    /// A Boolean tree.
    Combined(CombinedSolid),
    /// Parts and joints.
    Assembly(Assembly<Solid>),
}

impl fmt::Debug for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Solid(s) => f.debug_tuple("Solid").field(s).finish(),
            Self::Implicit(name, s) => f.debug_tuple(name).field(s.pose()).finish(),
            Self::Extended(s) => f.debug_tuple("Extended").field(s).finish(),
            Self::Quadric(q) => f.debug_tuple("Quadric").field(q).finish(),
            Self::Combined(s) => f.debug_tuple("Combined").field(s).finish(),
            Self::Assembly(a) => f.debug_tuple("Assembly").field(a).finish(),
        }
    }
}

/// Reads a shape file; `-` is standard input.
pub fn read_shape(file: &Path) -> Result<Model, ReadError> {
    parse_shape(&shown_name(file), &load(file)?)
}

/// A shape from the bytes of a JSON file, or the surface of a whole fit; the name is for errors.
///
/// ```
/// use supersurface_io::{Model, parse_shape};
/// let text = br#"{"type": "superellipsoid", "semi_axes": [0.03, 0.03, 0.05], "exponents": [0.1, 1.0],
///     "deformations": [{"type": "taper", "slopes": [0.2, 0.2]}], "position": [0, 0, 0.05]}"#;
/// assert!(matches!(parse_shape("cup", text)?, Model::Solid(_)));
/// let wrong = br#"{"type": "superellipsoid", "semi_axes": [0.03, 0.03, -0.05], "exponents": [0.1, 1.0]}"#;
/// let error = parse_shape("cup", wrong).err().unwrap().to_string();
/// assert!(error.contains("semi-axis a3 is -0.05"), "{error}");
/// # Ok::<(), supersurface_io::ReadError>(())
/// ```
pub fn parse_shape(name: &str, bytes: &[u8]) -> Result<Model, ReadError> {
    let fault = |f| ReadError::malformed(name, "shape JSON", f);
    let bytes = bytes.strip_prefix(BOM).unwrap_or(bytes);
    let value: Value = serde_json::from_slice(bytes)
        .map_err(|e| fault(Fault::new(format!("line {}", e.line()), e.to_string())))?;
    let (value, at) = surface_of_fit(value).map_err(fault)?;
    model(value, at).map_err(fault)
}

/// The surface where the file is a whole fit, else what is there.
fn surface_of_fit(mut value: Value) -> Result<(Value, &'static str), Fault> {
    if value.get("format").is_none_or(|f| f != fit_json::FORMAT) {
        return Ok((value, "shape"));
    }
    match value.get_mut("surface").map(Value::take) {
        None | Some(Value::Null) => {
            let why = value.get("error").and_then(Value::as_str).unwrap_or("it has no surface");
            Err(Fault::new("surface", format!("this fit failed: {why}")))
        }
        Some(surface) => Ok((surface, "surface")),
    }
}

/// A shape; `at` says where in the file it stands.
fn model(value: Value, at: &str) -> Result<Model, Fault> {
    let Value::Object(mut fields) = value else {
        return Err(Fault::new(at, "is no object with a \"type\""));
    };
    let invalid = |e: InvalidShape| Fault::new(at, e.to_string());
    // what every shape may have comes out first, so that what is left must be the shape's own
    let pose = pose(&mut fields, at)?;
    let deformations = match fields.remove("deformations") {
        Some(value) => deformations(value, &format!("{at}.deformations"))?,
        None => Vec::new(),
    };
    let undeformed = || match deformations.is_empty() {
        true => Ok(()),
        false => {
            let problem = "only closed solids with a parametric form can be deformed";
            Err(Fault::new(format!("{at}.deformations"), problem))
        }
    };
    let shape: ShapeRow = row(Value::Object(fields), at)?;
    let name = shape.name();
    match shape.leaf().map_err(invalid)? {
        Leaf::Solid(solid) => {
            let solid = deformations.iter().try_fold(solid, |solid, (place, d)| {
                d.apply(solid).map_err(|e| Fault::new(place.clone(), e))
            })?;
            Ok(Model::Solid(Posed::new(solid, pose).map_err(invalid)?))
        }
        Leaf::Implicit(shape) => {
            undeformed()?;
            Ok(Model::Implicit(name, Posed::new(shape, pose).map_err(invalid)?))
        }
        Leaf::Extended(shape) => {
            undeformed()?;
            Ok(Model::Extended(Posed::new(shape, pose).map_err(invalid)?))
        }
        Leaf::Quadric(quadric) => {
            undeformed()?;
            if pose != Pose::identity() {
                let problem = "a quadric stands where its coefficients put it: it takes no pose";
                return Err(Fault::new(at, problem));
            }
            Ok(Model::Quadric(quadric))
        }
        Leaf::Tree(tree) => {
            undeformed()?;
            let solid = combined(tree, name, at)?;
            let posed = match pose == Pose::identity() {
                true => solid,
                false => CombinedSolid::new(Posed::new(solid, pose).map_err(invalid)?),
            };
            Ok(Model::Combined(posed))
        }
        Leaf::Assembly(parts) => {
            undeformed()?;
            Ok(Model::Assembly(assembly(parts, &pose, at)?))
        }
    }
}

/// Deformations with their places: a list in its order, or the object of a fit.
fn deformations(value: Value, at: &str) -> Result<Vec<(String, DeformationRow)>, Fault> {
    if value.is_object() {
        let named = row::<NamedDeformations>(value, at)?.rows();
        return Ok(named.map(|(name, d)| (format!("{at}.{name}"), d)).collect());
    }
    let list: Vec<DeformationRow> = row(value, at)?;
    Ok(list.into_iter().enumerate().map(|(i, d)| (format!("{at}[{i}]"), d)).collect())
}

/// A Boolean tree of what has an implicit form.
fn combined(tree: TreeRow, operation: &str, at: &str) -> Result<CombinedSolid, Fault> {
    let invalid = |e: InvalidShape| Fault::new(at, e.to_string());
    let alpha = tree.alpha.map_or(Ok(Alpha::SMOOTH), Alpha::new).map_err(invalid)?;
    let blend = tree
        .blend
        .map(|b| Blend::new(b.amount, b.reach))
        .transpose()
        .map_err(|e| Fault::new(format!("{at}.blend"), e.to_string()))?;
    if blend.is_some() && (tree.alpha.is_some() || operation == "difference") {
        let problem = "a blend goes with a union or an intersection, without alpha";
        return Err(Fault::new(format!("{at}.blend"), problem));
    }
    let mut whole: Option<CombinedSolid> = None;
    for (i, value) in tree.of.into_iter().enumerate() {
        let place = format!("{at}.of[{i}]");
        let next = match model(value, &place)? {
            Model::Solid(s) => CombinedSolid::new(s),
            Model::Implicit(_, s) => CombinedSolid::new(s),
            Model::Combined(s) => s,
            Model::Extended(_) | Model::Quadric(_) | Model::Assembly(_) => {
                let problem = "has no inside: only solids can be combined";
                return Err(Fault::new(place, problem));
            }
        };
        whole = Some(match (whole, blend, operation) {
            (None, ..) => next,
            (Some(a), Some(b), "union") => a.blend_union(next, b),
            (Some(a), Some(b), _) => a.blend_intersection(next, b),
            (Some(a), None, "union") => a.union(next, alpha),
            (Some(a), None, "intersection") => a.intersection(next, alpha),
            (Some(a), None, _) => a.difference(next, alpha),
        });
    }
    whole.ok_or_else(|| Fault::new(format!("{at}.of"), "is empty"))
}

/// One of the surfaces that scenes are made of.
pub(crate) fn surface(value: Value, at: &str) -> Result<Posed<Surface>, Fault> {
    let other = || {
        let problem = "is none of the shapes of a scene: superellipsoids (tapered, twisted, bent, or tapered then bent) \
                       and supertoroids";
        Fault::new(at, problem)
    };
    let Model::Solid(solid) = model(value, at)? else { return Err(other()) };
    let surface = recovered(solid.shape()).ok_or_else(other)?;
    Posed::new(surface, *solid.pose()).map_err(|e| Fault::new(at, e.to_string()))
}

/// A solid as a surface, where it is one.
fn recovered(solid: &Solid) -> Option<Surface> {
    let core = |solid: &Solid| match solid {
        Solid::Superellipsoid(s) => Some(*s),
        _ => None,
    };
    match solid {
        Solid::Superellipsoid(s) => Some(Surface::Superellipsoid(*s)),
        Solid::Supertoroid(s) => Some(Surface::Supertoroid(*s)),
        Solid::Tapered(s) => Surface::tapered(core(s.shape())?, s.deformation().slopes()).ok(),
        Solid::Twisted(s) => Surface::twisted(core(s.shape())?, s.deformation().turns()).ok(),
        Solid::Bent(s) => {
            let (curvature, angle) = (s.deformation().curvature(), s.deformation().angle());
            match s.shape() {
                Solid::Tapered(cone) => {
                    let slopes = cone.deformation().slopes();
                    Surface::tapered_bent(core(cone.shape())?, slopes, curvature, angle).ok()
                }
                straight => Surface::bent(core(straight)?, curvature, angle).ok(),
            }
        }
        _ => None,
    }
}

/// Parts and joints, all moved by the assembly's pose.
fn assembly(row: AssemblyRow, pose: &Pose, at: &str) -> Result<Assembly<Solid>, Fault> {
    let mut parts = Vec::with_capacity(row.parts.len());
    for (i, part) in row.parts.into_iter().enumerate() {
        let place = format!("{at}.parts[{i}]");
        let Model::Solid(body) = model(part.shape, &format!("{place}.shape"))? else {
            let problem = "parts must be closed solids with a parametric form";
            return Err(Fault::new(place, problem));
        };
        let part = Part::new(part.name, body.moved(pose), part.density);
        parts.push(part.map_err(|e| Fault::new(place, e.to_string()))?);
    }
    let mut joints = Vec::with_capacity(row.joints.len());
    for (i, joint) in row.joints.into_iter().enumerate() {
        let place = format!("{at}.joints[{i}]");
        let index = |name: &str| {
            let problem = || Fault::new(place.clone(), format!("no part is called {name:?}"));
            parts.iter().position(|p| p.name() == name).ok_or_else(problem)
        };
        let (parent, child) = (index(&joint.parent)?, index(&joint.child)?);
        let anchor = pose * supersurface::Point::from(joint.anchor);
        let joint = Joint::new(parent, child, anchor, joint.kind());
        joints.push(joint.map_err(|e| Fault::new(place, e.to_string()))?);
    }
    Assembly::new(parts, joints).map_err(|e| Fault::new(at, e.to_string()))
}

/// Takes the pose out of a shape's fields.
fn pose(fields: &mut Map<String, Value>, at: &str) -> Result<Pose, Fault> {
    let mut take = |name: &str| fields.remove(name).map(|v| (v, format!("{at}.{name}")));
    let position = take("position").map(|(v, at)| row::<[f64; 3]>(v, &at)).transpose()?;
    let rotation = match take("orientation_wxyz") {
        Some((v, at)) => quaternion(row(v, &at)?).map_err(|e| Fault::new(at, e))?,
        None => UnitQuaternion::identity(),
    };
    Ok(Isometry3::from_parts(Vector::from(position.unwrap_or_default()).into(), rotation))
}

/// A unit quaternion from numbers that are one but for rounding.
pub(crate) fn quaternion([w, x, y, z]: [f64; 4]) -> Result<UnitQuaternion<f64>, String> {
    let q = Quaternion::new(w, x, y, z);
    let length = q.norm();
    if (length - 1.0).abs() <= 1e-15 {
        // as it is, so that what was written comes back with every digit
        Ok(UnitQuaternion::new_unchecked(q))
    } else if (length - 1.0).abs() <= 1e-3 {
        Ok(UnitQuaternion::from_quaternion(q))
    } else {
        Err(format!("has the length {length}: a rotation's quaternion w, x, y, z has 1"))
    }
}

pub(crate) fn row<T: DeserializeOwned>(value: Value, at: &str) -> Result<T, Fault> {
    serde_json::from_value(value).map_err(|e| Fault::new(at, e.to_string()))
}
