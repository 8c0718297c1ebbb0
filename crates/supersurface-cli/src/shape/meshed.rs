//! The mesh of whatever a shape file holds.

use supersurface::mesh::{MarchOptions, Mesh, Resolution, TessellateError, march, tessellate};
use supersurface::shape::{Implicit, Parametric, Posed};
use supersurface_io::Model;

use crate::exit::Failure;

/// A mesh and how near it is to its surface.
#[derive(Debug)]
pub(crate) struct Meshed {
    pub(crate) mesh: Mesh,
    /// Largest distance to the surface in metres; `None` for a marched mesh, which promises none.
    pub(crate) distance: Option<f64>,
}

/// How finely.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fineness {
    /// Largest distance between mesh and surface in metres, where it can be promised.
    pub(crate) tolerance: Option<f64>,
    /// Cells along the longest side where the implicit form is marched.
    pub(crate) cells: usize,
}

/// The mesh of a model in the frame of its file; `name` is for errors.
pub(crate) fn meshed(name: &str, model: &Model, fine: Fineness) -> Result<Meshed, Failure> {
    let endless = |mend: &str| Failure::input(format!("{name}: has no end: {mend}"));
    let cut = "cut it out of a solid (type \"intersection\")";
    match model {
        Model::Solid(solid) => tessellated(name, solid, fine),
        Model::Extended(surface) => tessellated(name, surface, fine),
        Model::Implicit(_, solid) => {
            if solid.bounds().iter().any(|p| p.iter().any(|v| v.is_infinite())) {
                return Err(endless(cut));
            }
            marched(name, solid, fine)
        }
        Model::Combined(solid) => marched(name, solid, fine),
        Model::Quadric(quadric) => match quadric.as_ellipsoid() {
            Some(ellipsoid) => tessellated(name, &ellipsoid, fine),
            None => Err(endless("only ellipsoids can be meshed")),
        },
        Model::Assembly(assembly) => {
            let mut whole = Meshed { mesh: Mesh::default(), distance: Some(0.0) };
            for body in assembly.bodies(&assembly.rest_rotations()) {
                let part = tessellated(name, &body, fine)?;
                let many = || Failure::input(format!("{name}: too many vertices for one mesh"));
                whole.mesh = whole.mesh.beside(&part.mesh).ok_or_else(many)?;
                whole.distance = whole.distance.zip(part.distance).map(|(a, b)| a.max(b));
            }
            Ok(whole)
        }
    }
}

fn tessellated<S: Parametric>(
    name: &str,
    body: &Posed<S>,
    fine: Fineness,
) -> Result<Meshed, Failure> {
    match tessellate(body.shape(), fine.tolerance) {
        Ok(found) => {
            Ok(Meshed { mesh: found.mesh.moved(body.pose()), distance: Some(found.distance) })
        }
        Err(error @ TessellateError::Tolerance(_)) => Err(Failure::usage(error)),
        Err(error) => Err(Failure::input(format!("{name}: {error}"))),
    }
}

fn marched<S: Implicit + Sync>(name: &str, solid: &S, fine: Fineness) -> Result<Meshed, Failure> {
    if fine.tolerance.is_some() {
        let problem = "has no parametric form: pass --cells instead of --tolerance";
        return Err(Failure::usage(format!("{name}: {problem}")));
    }
    let resolution = Resolution::Count(fine.cells);
    let mesh = march(solid, &MarchOptions { resolution, ..MarchOptions::default() })
        .map_err(|e| Failure::input(format!("{name}: {e}")))?;
    match mesh.triangles().is_empty() {
        true => Err(Failure::nothing(format!(
            "{name}: nothing is inside, or what is there is thinner than a cell: raise --cells"
        ))),
        false => Ok(Meshed { mesh, distance: None }),
    }
}
