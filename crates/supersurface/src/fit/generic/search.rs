//! The way from points to a fit: normalise, fit the special members, embed them, rank, refine, judge.

use nalgebra::{Matrix3, Rotation3, SymmetricEigen};

use super::extended::Extended;
use super::hyperquadric::Terms;
use super::member::{Body, Member};
use super::solver::{Hypothesis, Schedule, refine};
use super::space::Space;
use super::supershape;
use super::toroid::Toroid;
use super::{GenericFit, GenericModel, GenericOptions};
use crate::fit::centred::{Centred, finite, is_finite, scatter, spread};
use crate::fit::noise::{Law, Mixture};
use crate::fit::start::quantile;
use crate::fit::{Family, FitError, FitOptions, Stopped, View, fit};
use crate::shape::Posed;
use crate::surface::Surface;
use crate::{Point, Vector};

/// Points that sort out many starts, that rank them, and that refine the best of them.
const SKETCH: usize = 90;
const COARSE: usize = 200;
const MIDDLE: usize = 600;
/// Of more starts than this only a shortlist is ranked.
const MANY: usize = 40;
const SHORTLIST: usize = 16;
const SKETCH_ROUNDS: usize = 7;
const COARSE_ROUNDS: usize = 14;
const MIDDLE_ROUNDS: usize = 40;
const TIGHT_ROUNDS: usize = 12;
const FINE_ROUNDS: usize = 40;
/// Shares of the estimated noise that are tried in its place.
const TIGHTER: [f64; 2] = [0.4, 0.4];
/// A fit with a lesser share of inliers explains nothing.
const LEAST_SHARE: f64 = 0.1;
/// Costs a point that differ less are those of one optimum.
const SAME_COST: f64 = 1e-4;

/// A box with exponents, in normalised coordinates.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub(super) rotation: Rotation3<f64>,
    pub(super) position: Vector,
    pub(super) half: [f64; 3],
    pub(super) exponents: [f64; 2],
}

impl Frame {
    /// The same box with each of its axes as z.
    pub(super) fn roles(&self) -> [Self; 3] {
        let m = self.rotation.matrix();
        [0, 1, 2].map(|shift| {
            let order = [0, 1, 2].map(|k| (k + shift) % 3);
            let columns = order.map(|k| Vector::from(m.column(k)));
            let mean = 0.5 * (self.exponents[0] + self.exponents[1]);
            Self {
                rotation: Rotation3::from_matrix_unchecked(Matrix3::from_columns(&columns)),
                position: self.position,
                half: order.map(|k| self.half[k]),
                exponents: if shift == 0 { self.exponents } else { [mean; 2] },
            }
        })
    }
}

/// What starts are made from.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    /// Some of the points.
    pub(super) points: Vec<Vector>,
    /// The superellipsoid that fits best, and the box along the principal axes.
    pub(super) frames: Vec<Frame>,
    /// The toroid that fits best, its ring ratio first.
    pub(super) toroid: Option<(f64, Frame)>,
}

/// The points and the space about them.
struct Cloud {
    centred: Centred,
    space: Space,
}

impl Cloud {
    fn new(points: &[Point], needed: usize) -> Result<Self, FitError> {
        let centred = Centred::new(&finite(points), needed)?;
        let space = Space::about(&centred.points);
        Ok(Self { centred, space })
    }

    fn spread(&self, count: usize) -> Vec<Vector> {
        spread(&self.centred.points, count.max(1))
    }

    fn ground(&self, toroid: bool) -> Ground {
        let points = self.spread(MIDDLE);
        let cloud: Vec<Point> = self.centred.points.iter().map(|p| Point::from(*p)).collect();
        let found = |family| {
            let options = FitOptions::only(family);
            let fit = fit(&View::all_around(&cloud), &options).ok()?;
            Some(frame_of(&fit.surface))
        };
        let principal = principal(&points);
        let superellipsoid = found(Family::Superellipsoid).map(|(_, frame)| frame);
        let toroid = if toroid { found(Family::Supertoroid) } else { None };
        Ground { points, frames: superellipsoid.into_iter().chain([principal]).collect(), toroid }
    }
}

/// Ring ratio (1 for a superellipsoid) and frame of a special fit.
fn frame_of(surface: &Posed<Surface>) -> (f64, Frame) {
    let (ring, half, exponents) = match surface.shape() {
        Surface::Superellipsoid(s) => (1.0, s.semi_axes(), s.exponents()),
        Surface::Supertoroid(s) => (s.ring_ratio(), s.semi_axes(), s.exponents()),
        other => (1.0, other.half_extents(), other.exponents()),
    };
    let rotation = surface.pose().rotation.to_rotation_matrix();
    (ring, Frame { rotation, position: surface.pose().translation.vector, half, exponents })
}

/// The box of the points along their principal axes.
fn principal(points: &[Vector]) -> Frame {
    let axes = SymmetricEigen::new(scatter(points.iter())).eigenvectors;
    let (x, y): (Vector, Vector) = (axes.column(0).into(), axes.column(1).into());
    let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    let (mut middle, mut half) = (Vector::zeros(), [0.0; 3]);
    for (k, half) in half.iter_mut().enumerate() {
        let mut heights: Vec<f64> = points.iter().map(|p| p.dot(&axes.column(k))).collect();
        let (low, high) = (quantile(&mut heights, 0.02), quantile(&mut heights, 0.98));
        middle[k] = 0.5 * (low + high);
        *half = (0.5 * (high - low)).max(0.03);
    }
    Frame {
        rotation: Rotation3::from_matrix_unchecked(axes),
        position: axes * middle,
        half,
        exponents: [0.7; 2],
    }
}

pub(super) fn search(
    points: &[Point],
    model: GenericModel,
    options: &GenericOptions,
) -> Result<GenericFit, FitError> {
    // twice as many points as parameters
    let numbers = match model {
        GenericModel::Hyperquadric { terms } => 5 * terms,
        GenericModel::Supershape => 16,
        GenericModel::Extended { profile, section } => 9 + profile + section,
        GenericModel::Toroid { .. } => 17,
    };
    let cloud = Cloud::new(points, 2 * numbers)?;
    match model {
        GenericModel::Hyperquadric { terms } => {
            let starts = Terms { count: terms }.starts(&cloud.ground(false));
            cloud.best(points, starts, |_| Vec::new(), options)
        }
        GenericModel::Supershape => {
            let starts = supershape::starts(&cloud.ground(false));
            cloud.best(points, starts, supershape::relatives, options)
        }
        GenericModel::Extended { profile, section } => {
            let starts = Extended::new(profile, section).starts(&cloud.ground(false));
            cloud.best(points, starts, |_| Vec::new(), options)
        }
        GenericModel::Toroid { taper, twist, bend } => {
            let starts = Toroid { taper, twist, bend }.starts(&cloud.ground(true));
            cloud.best(points, starts, |_| Vec::new(), options)
        }
    }
}

/// Refines all starts, in parallel where the feature is on; the order stays.
fn refine_all<M: Member>(
    starts: &[Hypothesis<M>],
    points: &[Vector],
    space: &Space,
    schedule: impl Fn(&Hypothesis<M>) -> Schedule + Sync,
) -> Vec<Hypothesis<M>> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        starts.par_iter().map(|h| refine(h, points, space, &schedule(h))).collect()
    }
    #[cfg(not(feature = "parallel"))]
    starts.iter().map(|h| refine(h, points, space, &schedule(h))).collect()
}

fn begin<M>(body: Body<M>) -> Hypothesis<M> {
    let mixture = Mixture { law: Law::Gaussian, scale: 0.1, outliers: 0.1, density: 1.0 };
    Hypothesis { body, mixture, cost: f64::MAX, iterations: 0, stopped: Stopped::Rounds }
}

/// The best optima, each once.
fn keep<M>(mut ranked: Vec<Hypothesis<M>>, points: usize, count: usize) -> Vec<Hypothesis<M>> {
    ranked.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    ranked.dedup_by(|b, a| (b.cost - a.cost).abs() < SAME_COST * points as f64);
    ranked.truncate(count.max(1));
    ranked
}

impl Cloud {
    fn best<M: Member>(
        &self,
        points: &[Point],
        starts: Vec<Body<M>>,
        relatives: impl Fn(&Body<M>) -> Vec<Body<M>>,
        options: &GenericOptions,
    ) -> Result<GenericFit, FitError> {
        let (sketch, coarse) = (self.spread(SKETCH), self.spread(COARSE));
        let schedule = |rounds| Schedule {
            rounds,
            scale: M::START_SCALE,
            ceiling: 2.0 * M::START_SCALE,
            tolerance: 1e-3,
        };
        let rank = |bodies: Vec<Body<M>>| {
            let mut starts: Vec<Hypothesis<M>> = bodies.into_iter().map(begin).collect();
            if starts.len() > MANY {
                // most are hopeless after a few rounds on few points
                let tried = refine_all(&starts, &sketch, &self.space, |_| schedule(SKETCH_ROUNDS));
                starts = keep(tried, sketch.len(), SHORTLIST);
            }
            let after = |h: &Hypothesis<M>| Schedule {
                scale: M::START_SCALE.min(2.0 * h.mixture.scale),
                ..schedule(COARSE_ROUNDS)
            };
            let mut ranked = refine_all(&starts, &coarse, &self.space, after);
            self.prefer_shapes(&mut ranked);
            ranked
        };
        let mut kept = keep(rank(starts), coarse.len(), options.kept);
        let others: Vec<Body<M>> = kept.iter().flat_map(|h| relatives(&h.body)).collect();
        if !others.is_empty() {
            kept.extend(rank(others));
            kept = keep(kept, coarse.len(), options.kept);
        }
        let middle = self.spread(MIDDLE);
        let next = |h: &Hypothesis<M>| Schedule {
            rounds: MIDDLE_ROUNDS,
            scale: 2.0 * h.mixture.scale,
            ceiling: 1.0,
            tolerance: 1e-4,
        };
        let mut kept = refine_all(&kept, &middle, &self.space, next);
        // a surface among outliers may be held off by noise that is thought too large
        for share in TIGHTER {
            let tight = |h: &Hypothesis<M>| Schedule {
                rounds: TIGHT_ROUNDS,
                scale: share * h.mixture.scale,
                ceiling: share * h.mixture.scale,
                tolerance: 1e-3,
            };
            let held = refine_all(&kept, &middle, &self.space, tight);
            kept.extend(refine_all(&held, &middle, &self.space, next));
            kept = keep(kept, middle.len(), options.kept);
        }
        self.prefer_shapes(&mut kept);
        let Some(best) = kept.first() else { return Err(FitError::NoAgreement { share: 0.0 }) };
        let fine = self.spread(options.most_points);
        let last = Schedule {
            rounds: FINE_ROUNDS,
            scale: best.mixture.scale,
            ceiling: 1.0,
            tolerance: 1e-5,
        };
        let finest = refine(best, &fine, &self.space, &last);
        self.judge(points, if self.is_shape(&finest) { &finest } else { best })
    }

    /// True when the numbers make a shape: a bend may fold, a hyperquadric may be empty.
    fn is_shape<M: Member>(&self, h: &Hypothesis<M>) -> bool {
        h.body.member.shape(&h.body.numbers, self.centred.placement.scale).is_ok()
    }

    /// Leaves out what is no shape, unless nothing is one: then the error says why.
    fn prefer_shapes<M: Member>(&self, all: &mut Vec<Hypothesis<M>>) {
        if all.iter().any(|h| self.is_shape(h)) {
            all.retain(|h| self.is_shape(h));
        }
    }

    fn judge<M: Member>(
        &self,
        points: &[Point],
        h: &Hypothesis<M>,
    ) -> Result<GenericFit, FitError> {
        let mut distances = h.body.distances(&self.centred.points);
        let mut next = h.mixture.belonging(&distances).into_iter();
        let belongs =
            |p: &Point| is_finite(&p.coords) && next.next().is_some_and(|share| share > 0.5);
        let inliers: Vec<bool> = points.iter().map(belongs).collect();
        let share = inliers.iter().filter(|i| **i).count() as f64 / distances.len() as f64;
        distances.iter_mut().for_each(|d| *d = d.abs());
        if share.is_nan() || share < LEAST_SHARE {
            return Err(FitError::NoAgreement { share });
        }
        let body = &h.body;
        let shape = body.member.shape(&body.numbers, self.centred.placement.scale)?;
        let pose = self.centred.placement.pose(&body.position, &body.rotation);
        Ok(GenericFit {
            surface: Posed::new(shape, pose)?,
            noise: h.mixture.scale * self.centred.placement.scale,
            residual: quantile(&mut distances, 0.5) * self.centred.placement.scale,
            inliers,
            iterations: h.iterations,
            stopped: h.stopped,
        })
    }
}
