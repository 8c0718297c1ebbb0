//! `supersurface info`: what a shape is, where it reaches, how heavy it is.

use std::fmt::Write;

use clap::Args;
use serde_json::{Value, json};
use supersurface::mesh::mass_of_solid;
use supersurface::nalgebra::Matrix3;
use supersurface::shape::{Implicit, Mass, MassEstimate, MassProperties};
use supersurface::{Point, Pose, Vector};
use supersurface_io::Model;

use super::args::ShapeArgs;
use crate::exit::{Failure, print};
use crate::numbers::short;

/// Cells along the longest side of what is marched.
const CELLS: usize = 96;

/// Estimated errors from which a marched mass is not told.
const COARSE: f64 = 0.2;

/// Which shape, of what.
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    which: ShapeArgs,
    /// Density in kg/m³; the parts of an assembly have their own.
    #[arg(long, value_name = "RHO", default_value_t = 1000.0)]
    density: f64,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

/// What is told of a shape; `None` is what it does not have.
struct Facts {
    name: String,
    bounds: Option<[Point; 2]>,
    convex: Option<bool>,
    mass: Option<Weighed>,
    notes: Vec<(&'static str, String)>,
}

/// Mass properties and how they came about.
struct Weighed {
    /// In m³; of an assembly the sum of its parts.
    volume: f64,
    mass: Mass,
    /// Estimated relative error.
    error: f64,
    how: &'static str,
}

/// Prints the facts.
pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    if !(args.density > 0.0 && args.density.is_finite()) {
        let given = args.density;
        return Err(Failure::usage(format!("--density: {given} is not positive and finite")));
    }
    let facts = facts(&args.which.name(), &args.which.model()?, args.density)?;
    print(&if args.json { as_json(&facts) } else { as_text(&facts) })
}

fn facts(name: &str, model: &Model, density: f64) -> Result<Facts, Failure> {
    let mut notes = Vec::new();
    let (kind, bounds, convex, own) = match model {
        Model::Solid(solid) => {
            let mass = Some(weighed(solid.mass_estimate(density), density));
            (solid.shape().name(), Some(solid.bounds()), Some(solid.shape().is_convex()), mass)
        }
        Model::Implicit(kind, solid) => {
            ((*kind).to_owned(), Some(solid.bounds()), Some(solid.is_convex()), None)
        }
        Model::Extended(solid) => {
            let mass = Some(weighed(solid.mass_estimate(density), density));
            ("extended superellipsoid".into(), None, None, mass)
        }
        Model::Combined(solid) => {
            notes.push(("solids", solid.leaves().to_string()));
            ("combination".into(), Some(solid.bounds()), Some(solid.is_convex()), None)
        }
        Model::Quadric(quadric) => {
            let form = quadric.normal_form();
            notes.push(("type", format!("{:?}", form.kind)));
            ("quadric".into(), quadric.as_ellipsoid().map(|e| e.bounds()), None, None)
        }
        Model::Assembly(assembly) => {
            notes.push(("parts", assembly.parts().len().to_string()));
            notes.push(("joints", assembly.joints().len().to_string()));
            let bodies = assembly.bodies(&assembly.rest_rotations());
            let boxes = bodies.iter().map(Implicit::bounds);
            let bounds = boxes.reduce(|[a, b], [c, d]| [a.inf(&c), b.sup(&d)]);
            ("assembly".into(), bounds, None, None)
        }
    };
    let bounded = bounds.is_none_or(|b| b.iter().all(|p| p.iter().all(|v| v.is_finite())));
    let mass = match (own, model) {
        (Some(mass), _) => Some(mass),
        (None, Model::Assembly(assembly)) => {
            let mut sum: Option<Weighed> = None;
            let poses = assembly.poses(&assembly.rest_rotations());
            for (part, pose) in assembly.parts().iter().zip(poses) {
                let own = Model::Solid(part.body().moved(&part.body().pose().inverse()));
                let own = facts(name, &own, part.density())?.mass;
                sum = joined(sum, own, &pose);
            }
            sum
        }
        (None, Model::Quadric(quadric)) => {
            quadric.as_ellipsoid().map(|e| weighed(e.mass_estimate(density), density))
        }
        (None, Model::Implicit(_, s)) if bounded => Some(of_meshes(name, s, density)?),
        (None, Model::Combined(s)) if bounded => Some(of_meshes(name, s, density)?),
        (None, _) => None,
    };
    // what is thinner than a cell of the grid is not seen, and must not be told as if it were not there
    let blind = |w: &Weighed| w.how == "of meshes" && !(w.volume > 0.0 && w.error < COARSE);
    let mass = mass.filter(|w| {
        let unknown = blind(w);
        if unknown {
            let why = format!("empty, or too thin for a grid of {CELLS} cells a side");
            notes.push(("mass_unknown", why));
        }
        !unknown
    });
    Ok(Facts { name: kind, bounds, convex, mass, notes })
}

/// From the library's own answer.
fn weighed(found: MassEstimate, density: f64) -> Weighed {
    let how = if found.error == 0.0 { "closed form" } else { "by integration" };
    Weighed { volume: found.mass.mass / density, mass: found.mass, error: found.error, how }
}

/// Two weighed parts as one; the second stands at a pose.
fn joined(sum: Option<Weighed>, part: Option<Weighed>, pose: &Pose) -> Option<Weighed> {
    let part = part?;
    let moved = part.mass.moved(pose);
    Some(match sum {
        None => Weighed { mass: moved, ..part },
        Some(sum) => Weighed {
            volume: sum.volume + part.volume,
            mass: sum.mass.joined(&moved),
            error: sum.error.max(part.error),
            how: if sum.how == part.how { part.how } else { "partly by integration" },
        },
    })
}

/// Of two meshes.
fn of_meshes(name: &str, solid: &(impl Implicit + Sync), density: f64) -> Result<Weighed, Failure> {
    let found = mass_of_solid(solid, density, CELLS);
    let found = found.map_err(|e| Failure::input(format!("{name}: {e}")))?;
    Ok(Weighed { how: "of meshes", ..weighed(found, density) })
}

fn as_text(facts: &Facts) -> String {
    let mut out = format!("{}\n", facts.name);
    let mut line = |what: &str, value: String| {
        // writing to a string does not fail
        let _ = writeln!(out, "  {what:<18} {value}");
    };
    for (what, value) in &facts.notes {
        line(&what.replace('_', " "), value.clone());
    }
    match facts.bounds {
        Some([low, high]) if (high - low).iter().all(|v| v.is_finite()) => {
            let size = high - low;
            line("size", format!("{} x {} x {} m", short(size.x), short(size.y), short(size.z)));
            line("from", row(&low.coords));
            line("to", row(&high.coords));
        }
        Some(_) => line("size", "without end".into()),
        None => {}
    }
    if let Some(convex) = facts.convex {
        line("convex", if convex { "yes".into() } else { "not known to be".into() });
    }
    if let Some(Weighed { volume, mass, error, how }) = &facts.mass {
        line("volume", format!("{volume:.6e} m³ ({how}{})", about(*error)));
        line("mass", format!("{} kg", short(mass.mass)));
        line("centre of mass", row(&mass.centre.coords));
        let moments = principal(&mass.inertia);
        line("principal moments", format!("{} kg m²", row(&moments)));
    }
    out
}

fn as_json(facts: &Facts) -> String {
    let point = |p: &Point| json!(finite(&p.coords));
    let mut value = json!({
        "name": facts.name,
        "bounds": facts.bounds.map(|[low, high]| json!({"low": point(&low), "high": point(&high)})),
        "convex": facts.convex,
        "mass": facts.mass.as_ref().map(|w| json!({
            "volume": w.volume,
            "mass": w.mass.mass,
            "centre": point(&w.mass.centre),
            "inertia": (0..3).map(|i| finite(&w.mass.inertia.column(i).into_owned())).collect::<Vec<_>>(),
            "relative_error": w.error,
            "method": w.how,
        })),
    });
    for (what, note) in &facts.notes {
        value[*what] = json!(note);
    }
    format!("{value:#}\n")
}

/// Numbers of a vector, null where there is none.
fn finite(v: &Vector) -> Vec<Value> {
    v.iter().map(|x| if x.is_finite() { json!(x) } else { Value::Null }).collect()
}

/// Principal moments, least first, in one vector.
fn principal(inertia: &Matrix3<f64>) -> Vector {
    let mut values: Vec<f64> = inertia.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    Vector::from_column_slice(&values)
}

fn about(error: f64) -> String {
    if error > 0.0 { format!(", about {error:.1e} off") } else { String::new() }
}

fn row(v: &Vector) -> String {
    format!("({}, {}, {})", short(v.x), short(v.y), short(v.z))
}
