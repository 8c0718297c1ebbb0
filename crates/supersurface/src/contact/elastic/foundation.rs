//! A mesh against a supersurface: the linear elastic foundation of section 6.2.
//!
//! Each vertex `x_i` of the mesh carries a third of the areas of its triangles, `A_i`. A vertex inside the solid is pushed
//! out along its indentation `I_i` (equation 46) by the pressure of a layer of springs,
//!
//! ```text
//! P_i = k |I_i| max(0, 1 + 3/2 c ḋ_i)        f_i = P_i A_i (n_i - μ s_i/√(|s_i|² + v²))
//! ```
//!
//! - `k` in Pa/m: of a bonded layer [`layer_stiffness`].
//! - `c` in s/m: the damping of Hunt and Crossley (1975), with `ḋ` the speed at which the vertex goes in along the
//!   normal. A body that falls on its layer at a small speed `u` leaves with `(1 - c u) u`; the pressure never pulls.
//! - `μ`: Coulomb friction against the slip `s`, the tangential velocity, smooth below the speed `v`. It holds nothing
//!   at rest: a body on a slope creeps with a part of `v`.
//!
//! The mesh feels `Σ f_i`, the solid the opposite, each at the vertex or at the surface ([`Application`]); without
//! friction both give the same moments, since `I_i` runs along `f_i`.
//!
//! What is not guaranteed: this is a law of its own, not Hertz's ([`laws`](super::laws) has both). It converges with the
//! mesh, as the solid has none. Vertices alone are looked at, not the sides of faces: a solid that slips between them is
//! not felt, and a mesh's back pushes too where it reaches into the solid.
//! Where the solid is sharp the laws part. A solid of semi-axes 1, 1, r that stands on its tip on a plane is pushed by
//! equation (46) harder than by [`ByClosestPoint`](super::ByClosestPoint), whose normals lean more, and less than by
//! springs that stand on the plane (`k` times the volume below it):
//!
//! | r | ε | depth 1 % | 5 % | 10 % |
//! |--:|--:|--:|--:|--:|
//! | 1 | 1 | 0.0 / -0.7 % | 0.0 / -3.4 % | 0.0 / -6.9 % |
//! | 1 | 0.3 | 0.0 / 0.0 % | 0.1 / -0.9 % | 0.1 / -3.5 % |
//! | 3 | 1 | 0.3 / -5.6 % | 6.9 / -22.3 % | 24.4 / -36.4 % |
//! | 3 | 0.3 | 0.0 / -0.5 % | 1.4 / -7.7 % | 16.4 / -19.1 % |
//! | 10 | 1 | 29.5 / -35.5 % | 160.3 / -68.7 % | 240.6 / -80.3 % |
//! | 10 | 0.3 | 1.1 / -4.9 % | 130.7 / -27.1 % | 1340.1 / -42.4 % |
//!
//! (depths as shares of the long semi-axis; exponents both ε.) Lying on the side such solids are within 1.1 % of the closest
//! points. So shallow means: less than the radius of curvature, which at the tip is 1/r.
//!
//! ```
//! use supersurface::contact::{Foundation, FoundationOptions, Twist};
//! use supersurface::mesh::tessellate;
//! use supersurface::shape::{Posed, Superellipsoid};
//! use supersurface::{Pose, Vector};
//! let finger = Superellipsoid::new([0.01, 0.01, 0.03], [0.8, 1.0])?;
//! let pad = Foundation::new(&tessellate(&finger, Some(2e-5))?.mesh)?;
//! let egg = Posed::new(Superellipsoid::new([0.02, 0.02, 0.03], [1.0, 1.0])?, Pose::identity())?;
//! let pose = Pose::translation(0.0295, 0.0, 0.0);
//! let options = FoundationOptions { stiffness: 1e8, ..FoundationOptions::default() };
//! let found = pad.press(&pose, &egg, &Twist::default(), &options)?;
//! assert!(found.on_mesh.force.x > 1.0 && found.deepest < 0.0005 + 1e-5);
//! assert_eq!(found.on_mesh.force, -found.on_solid.force);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::foundation_columns::{Law, Push, Sums};
use super::foundation_error::FoundationError;
use super::indentation::{BLOCK, Indentation, Indentations, Indented};
use super::twist::Twist;
use super::vertex_tree::VertexTree;
use super::wrench::Wrench;
use crate::mesh::Mesh;
use crate::numeric::lanes::dispatch;
use crate::shape::Posed;
use crate::{Point, Pose, Vector};

/// Stiffness in Pa/m of an elastic layer on a rigid core, much wider than it is thick, so that it cannot give sideways:
/// `(1 - ν) E/((1 + ν)(1 - 2ν) h)` with the modulus `E` in Pa, Poisson's ratio `ν` in (-1, 0.5) and the thickness `h` in m.
///
/// ```
/// let rubber = supersurface::contact::layer_stiffness(1e6, 0.45, 0.005)?;
/// assert!((rubber - 7.586e8).abs() < 1e5);
/// # Ok::<(), supersurface::contact::FoundationError>(())
/// ```
pub fn layer_stiffness(modulus: f64, ratio: f64, thickness: f64) -> Result<f64, FoundationError> {
    FoundationError::positive("modulus of the layer", modulus)?;
    let inside = ratio > -1.0 && ratio < 0.5;
    FoundationError::check(inside, "Poisson's ratio", ratio, "in (-1, 0.5)")?;
    FoundationError::positive("thickness of the layer", thickness)?;
    let stiffness = (1.0 - ratio) / ((1.0 + ratio) * (1.0 - 2.0 * ratio)) * modulus / thickness;
    FoundationError::positive("stiffness of the layer", stiffness)?;
    Ok(stiffness)
}

/// Where the force of a vertex acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Application {
    /// At the vertex `x_i`: the mesh is the stiffer body and keeps its form.
    #[default]
    Vertex,
    /// At the surface `x_i + I_i`: the solid is the stiffer body, and the mesh gives way.
    Surface,
}

/// What the layer is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundationOptions {
    /// Pressure per depth `k` in Pa/m; the default, 1e8, is soft rubber of a centimetre.
    pub stiffness: f64,
    /// Hunt and Crossley's damping `c` in s/m: a share `c u` of a small speed `u` is lost in an impact.
    pub damping: f64,
    /// Coefficient of friction `μ`.
    pub friction: f64,
    /// Speed `v` in m/s at which friction is at 71 % of its limit.
    pub slip_speed: f64,
    /// Where the forces act.
    pub application: Application,
}

impl Default for FoundationOptions {
    fn default() -> Self {
        Self {
            stiffness: 1e8,
            damping: 0.0,
            friction: 0.0,
            slip_speed: 1e-3,
            application: Application::Vertex,
        }
    }
}

impl FoundationOptions {
    pub(super) fn check(&self) -> Result<(), FoundationError> {
        FoundationError::positive("stiffness", self.stiffness)?;
        FoundationError::not_negative("damping", self.damping)?;
        FoundationError::not_negative("friction", self.friction)?;
        FoundationError::positive("slip speed", self.slip_speed)
    }
}

/// What two bodies do to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FoundationContact {
    /// What the mesh feels, in world axes, about the solid's origin ([`Wrench::moved_to`] tells it about another point).
    pub on_mesh: Wrench,
    /// What the solid feels, about the same point: the opposite.
    pub on_solid: Wrench,
    /// How many vertices are inside.
    pub vertices: usize,
    /// Their areas together, in m².
    pub area: f64,
    /// The largest depth in metres.
    pub deepest: f64,
}

/// What one vertex does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct VertexForce {
    /// Index of the vertex in the mesh.
    pub vertex: u32,
    /// A third of the areas of its triangles, in m².
    pub area: f64,
    /// How deep it lies, in the world.
    pub indentation: Indentation,
    /// Force on the mesh, in N, world axes.
    pub force: Vector,
    /// Where it acts, in the world.
    pub at: Point,
}

/// A mesh made ready for contact: areas, and a tree of boxes that leaves out what is not near. Made once, it serves any
/// pose.
#[derive(Clone, Debug)]
pub struct Foundation {
    tree: VertexTree,
}

impl Foundation {
    /// Fails when no triangle has an area, or an area overflows.
    pub fn new(mesh: &Mesh) -> Result<Self, FoundationError> {
        let tree = VertexTree::new(mesh);
        let areas = tree.vertices().iter().map(|v| &v.area);
        FoundationError::finite("area of a vertex", areas)?;
        if tree.vertices().is_empty() { Err(FoundationError::NoArea) } else { Ok(Self { tree }) }
    }

    /// Index in the mesh and area in m² of each vertex that has one.
    pub fn areas(&self) -> impl ExactSizeIterator<Item = (u32, f64)> {
        self.tree.vertices().iter().map(|v| (v.index, v.area))
    }

    /// The wrenches between the mesh at `pose` and a solid, while the mesh moves relative to the solid as `motion` says
    /// (world axes; `Twist::default()` at rest, and of two moving bodies the difference of their twists).
    pub fn press<S: Indented>(
        &self,
        pose: &Pose,
        solid: &Posed<S>,
        motion: &Twist,
        options: &FoundationOptions,
    ) -> Result<FoundationContact, FoundationError> {
        let law = Law::new(solid.pose(), motion, options)?;
        let (mut found, mut sums) = (Indentations::default(), Sums::default());
        self.gather(pose, solid, |block| {
            solid.shape().indentations(&block.points, &mut found);
            dispatch(Push { block, found: &found, law: &law, sums: &mut sums });
        })?;
        let local = Wrench {
            force: Vector::from(sums.force),
            moment: Vector::from(sums.moment),
            about: Point::origin(),
        };
        let on_mesh = local.to_world(solid.pose());
        if !on_mesh.is_finite() {
            return Err(FoundationError::Overflow);
        }
        Ok(FoundationContact {
            on_mesh,
            on_solid: -on_mesh,
            vertices: sums.vertices,
            area: sums.area,
            deepest: sums.deepest,
        })
    }

    /// The same, vertex by vertex in the order of the mesh: for pictures, and to see what [`press`](Self::press) sums.
    pub fn forces<S: Indented>(
        &self,
        pose: &Pose,
        solid: &Posed<S>,
        motion: &Twist,
        options: &FoundationOptions,
    ) -> Result<Vec<VertexForce>, FoundationError> {
        // the pose is checked by the same door
        Law::new(solid.pose(), motion, options)?;
        FoundationError::finite("a number of the pose", pose_numbers(pose))?;
        let force = |vertex: &super::vertex_tree::Vertex| {
            let x = pose * Point::from(vertex.point);
            let indentation = solid.indentation(&x)?;
            let n = indentation.normal.into_inner();
            let at = match options.application {
                Application::Vertex => x,
                Application::Surface => x + n * indentation.depth,
            };
            let velocity = motion.velocity_at(&at);
            let closing = -velocity.dot(&n);
            let slip = velocity + n * closing;
            let damped = (1.0 + 1.5 * options.damping * closing).max(0.0);
            let pressure = options.stiffness * indentation.depth * damped;
            let drag = slip * (options.friction / slip.norm().hypot(options.slip_speed));
            let force = (n - drag) * (pressure * vertex.area);
            Some(VertexForce { vertex: vertex.index, area: vertex.area, indentation, force, at })
        };
        let mut forces: Vec<VertexForce> = self.tree.vertices().iter().filter_map(force).collect();
        forces.sort_unstable_by_key(|f| f.vertex);
        Ok(forces)
    }

    /// Hands over the vertices near a solid, in its frame, in blocks.
    pub(super) fn gather<S: Indented>(
        &self,
        pose: &Pose,
        solid: &Posed<S>,
        mut work: impl FnMut(&Block),
    ) -> Result<(), FoundationError> {
        FoundationError::finite("a number of the pose", pose_numbers(pose))?;
        let [low, high] = solid.shape().bounds().map(|p| p.coords);
        let (mut middle, mut half) = (low * 0.5 + high * 0.5, high * 0.5 - low * 0.5);
        if !middle.iter().chain(half.iter()).all(|v| v.is_finite()) {
            (middle, half) = (Vector::zeros(), Vector::repeat(f64::INFINITY));
        }
        let mut block = Block::default();
        self.tree.inside(&solid.pose().inv_mul(pose), &middle, &half, |p, vertex| {
            block.push(&p, vertex.area);
            if block.count == BLOCK {
                work(&block);
                block.count = 0;
            }
        });
        if block.count > 0 {
            block.fill_up();
            work(&block);
        }
        Ok(())
    }
}

fn pose_numbers(pose: &Pose) -> impl Iterator<Item = &f64> {
    pose.translation.vector.iter().chain(pose.rotation.coords.iter())
}

/// Vertices in the solid's frame.
pub(super) struct Block {
    pub(super) points: [[f64; BLOCK]; 3],
    pub(super) areas: [f64; BLOCK],
    pub(super) count: usize,
}

impl Default for Block {
    fn default() -> Self {
        Self { points: [[0.0; BLOCK]; 3], areas: [0.0; BLOCK], count: 0 }
    }
}

impl Block {
    fn push(&mut self, p: &Vector, area: f64) {
        for (column, v) in self.points.iter_mut().zip(p.iter()) {
            column[self.count] = *v;
        }
        self.areas[self.count] = area;
        self.count += 1;
    }

    /// The rest has no area.
    fn fill_up(&mut self) {
        for column in &mut self.points {
            let first = column[0];
            column[self.count..].fill(first);
        }
        self.areas[self.count..].fill(0.0);
    }
}
