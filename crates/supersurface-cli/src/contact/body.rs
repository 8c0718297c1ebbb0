//! From a shape of any kind to a convex body, or why it is none and what to do.

use supersurface::contact::Convex;
use supersurface::shape::Posed;
use supersurface::surface::Solid;
use supersurface_io::Model;

use crate::exit::Failure;

/// The body of a shape; the name is for messages.
pub(super) fn body(name: &str, model: &Model) -> Result<Posed<Convex>, Failure> {
    let wrong = |what: &str, mend: &str| {
        let needed = "contact needs a superellipsoid with exponents of at most 2, not deformed";
        Failure::input(format!("{name}: {what}: {needed}; {mend}"))
    };
    const AROUND: &str = "use one that encloses it, or several for its parts";
    const PARTS: &str = "ask for its parts one by one";
    let solid = match model {
        Model::Solid(solid) => solid,
        Model::Implicit(kind, _) => return Err(wrong(&kind.replace('_', " "), AROUND)),
        Model::Extended(_) => return Err(wrong("extended superellipsoid", AROUND)),
        Model::Quadric(_) => {
            let mend = "write an ellipsoid as a superellipsoid with exponents [1, 1] and its pose";
            return Err(wrong("quadric", mend));
        }
        Model::Combined(_) => return Err(wrong("combination", PARTS)),
        Model::Assembly(_) => return Err(wrong("assembly", PARTS)),
    };
    let Solid::Superellipsoid(shape) = solid.shape() else {
        let mend = match solid.shape() {
            Solid::Separable(_) | Solid::Supercylinder(_) => {
                "write it as a superellipsoid where it is one"
            }
            _ => AROUND,
        };
        return Err(wrong(&solid.shape().name(), mend));
    };
    let convex = Convex::new(*shape).map_err(|e| {
        let what = format!("superellipsoid whose {} is {}", e.what, e.value);
        wrong(&what, "write 2 instead for its convex hull")
    })?;
    Posed::new(convex, *solid.pose()).map_err(|e| Failure::input(format!("{name}: {e}")))
}
