//! From a shape of any kind to a convex body or a ring, or why it is neither and what to do.

use supersurface::contact::Convex;
use supersurface::shape::{Implicit, Posed, Supertoroid, SupportMap};
use supersurface::surface::Solid;
use supersurface::{Point, Pose, Vector};
use supersurface_io::Model;

use crate::exit::Failure;

/// What contact can be asked of.
#[derive(Clone, Copy)]
pub(super) enum Body {
    Convex(Posed<Convex>),
    /// With a section that is convex.
    Ring(Posed<Supertoroid>),
}

impl Body {
    pub(super) fn pose(&self) -> &Pose {
        match self {
            Self::Convex(body) => body.pose(),
            Self::Ring(ring) => ring.pose(),
        }
    }

    pub(super) fn solid(&self) -> Solid {
        match self {
            Self::Convex(body) => Solid::from(*body.shape().shape()),
            Self::Ring(ring) => Solid::from(*ring.shape()),
        }
    }

    /// The largest half width in metres.
    pub(super) fn largest(&self) -> f64 {
        self.bounds()[1].coords.amax()
    }

    /// The box in the body's own frame.
    pub(super) fn bounds(&self) -> [Point; 2] {
        match self {
            Self::Convex(body) => body.shape().shape().bounds(),
            Self::Ring(ring) => ring.shape().bounds(),
        }
    }

    /// The farthest point in a direction, both in the body's own frame.
    pub(super) fn support_point(&self, n: &Vector) -> Point {
        match self {
            Self::Convex(body) => body.shape().support_point(n),
            Self::Ring(ring) => ring.shape().support_point(n),
        }
    }
}

impl From<Posed<Convex>> for Body {
    fn from(body: Posed<Convex>) -> Self {
        Self::Convex(body)
    }
}

/// The body of a shape; the name is for messages.
pub(super) fn body(name: &str, model: &Model) -> Result<Body, Failure> {
    let wrong = |what: &str, mend: &str| {
        let needed = "contact needs a superellipsoid with exponents of at most 2, or a supertoroid with ε1 of at most 2, not deformed";
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
    let shape = match solid.shape() {
        Solid::Superellipsoid(shape) => shape,
        Solid::Supertoroid(shape) if shape.exponents()[0] <= 2.0 => {
            let posed = Posed::new(*shape, *solid.pose());
            return posed.map(Body::Ring).map_err(|e| Failure::input(format!("{name}: {e}")));
        }
        other => {
            let mend = match other {
                Solid::Separable(_) | Solid::Supercylinder(_) => {
                    "write it as a superellipsoid where it is one"
                }
                _ => AROUND,
            };
            return Err(wrong(&other.name(), mend));
        }
    };
    let convex = Convex::new(*shape).map_err(|e| {
        let what = format!("superellipsoid whose {} is {}", e.what, e.value);
        wrong(&what, "write 2 instead for its convex hull")
    })?;
    let posed = Posed::new(convex, *solid.pose());
    posed.map(Body::Convex).map_err(|e| Failure::input(format!("{name}: {e}")))
}
