//! From a shape of any kind to what contact can be asked of, or why it is not and what to do.

use supersurface::contact::{NotSliced, Sliced};
use supersurface::surface::Solid;
use supersurface_io::Model;

use crate::exit::Failure;

/// The body of a shape; the name is for messages.
pub(super) fn body(name: &str, model: &Model) -> Result<Sliced, Failure> {
    let wrong = |what: &str, mend: &str| {
        let needed = "contact needs a superellipsoid with ε2 of at most 2, as it is or tapered, then twisted, then bent, or a supertoroid with ε1 of at most 2";
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
    Sliced::new(solid).map_err(|why| {
        let kind = solid.shape().name();
        match (why, solid.shape()) {
            (NotSliced::Section(e), Solid::Supertoroid(_)) => {
                wrong(&format!("{kind} whose {} is {}", e.what, e.value), AROUND)
            }
            (NotSliced::Section(e), _) => wrong(
                &format!("{kind} whose {} is {}", e.what, e.value),
                "write 2 instead for its convex hull",
            ),
            (_, Solid::Separable(_) | Solid::Supercylinder(_)) => {
                wrong(&kind, "write it as a superellipsoid where it is one")
            }
            _ => wrong(&kind, AROUND),
        }
    })
}
