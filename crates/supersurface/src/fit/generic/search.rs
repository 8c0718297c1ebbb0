//! The way from points to a fit: normalise, fit the special members, embed them, rank, refine, judge.

use nalgebra::{Matrix3, Rotation3, SymmetricEigen};

use super::extended::Extended;
use super::hyperquadric::Terms;
use super::member::{Body, Member};
use super::solver::{Hypothesis, Schedule, refine};
use super::space::Space;
use super::supershape;
use super::toroid::Toroid;
use super::{GenericFit, GenericModel, GenericOptions, Stopped};
use crate::fit::noise::{Law, Mixture};
use crate::fit::start::quantile;
use crate::fit::{Family, FitError, FitOptions, View, fit};
use crate::shape::Posed;
use crate::surface::Surface;
use crate::{Point, Pose, Vector};

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

/// The cloud with zero mean and unit root mean square.
struct Normalised {
    centre: Vector,
    scale: f64,
    points: Vec<Vector>,
    space: Space,
}

impl Normalised {
    fn new(points: &[Point], needed: usize) -> Result<Self, FitError> {
        let finite = |p: &Vector| p.iter().all(|v| v.is_finite());
        let points: Vec<Vector> = points.iter().map(|p| p.coords).filter(finite).collect();
        let found = points.len();
        let Some(origin) = points.first().copied().filter(|_| found >= needed) else {
            return Err(FitError::TooFewPoints { found, needed });
        };
        // about the first point and by the largest offset, so that nothing cancels or overflows
        let reach = points.iter().map(|p| (p - origin).amax()).fold(0.0, f64::max);
        let magnitude = points.iter().map(|p| p.amax()).fold(0.0, f64::max);
        if reach <= 1e-12 * magnitude || !reach.is_normal() {
            return Err(FitError::OnePoint { points: found });
        }
        let n = found as f64;
        let centre =
            origin + points.iter().map(|p| (p - origin) / reach).sum::<Vector>() / n * reach;
        let square = points.iter().map(|p| ((p - centre) / reach).norm_squared()).sum::<f64>() / n;
        let scale = square.sqrt() * reach;
        if !scale.is_normal() || !finite(&centre) {
            return Err(FitError::OnePoint { points: found });
        }
        let points: Vec<Vector> = points.iter().map(|p| (p - centre) / scale).collect();
        let mut values = SymmetricEigen::new(scatter(&points)).eigenvalues;
        values.as_mut_slice().sort_by(f64::total_cmp);
        if values[1] < 1e-10 * values[2] {
            return Err(FitError::Line { points: found });
        }
        let space = Space::about(&points);
        Ok(Self { centre, scale, points, space })
    }

    /// About `count` points, one of each of so many equal stretches of their order.
    fn spread(&self, count: usize) -> Vec<Vector> {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let n = self.points.len();
        let taken = n.min(count.max(1));
        let stretch = n as f64 / taken as f64;
        let at = |i: usize| ((i as f64 + (GOLDEN * i as f64).fract()) * stretch) as usize;
        (0..taken).filter_map(|i| self.points.get(at(i).min(n - 1)).copied()).collect()
    }

    fn ground(&self, toroid: bool) -> Ground {
        let points = self.spread(MIDDLE);
        let cloud: Vec<Point> = self.points.iter().map(|p| Point::from(*p)).collect();
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

fn scatter(points: &[Vector]) -> Matrix3<f64> {
    let n = points.len().max(1) as f64;
    let mean = points.iter().sum::<Vector>() / n;
    points.iter().map(|p| (p - mean) * (p - mean).transpose()).sum::<Matrix3<f64>>() / n
}

/// Ring ratio (1 for a superellipsoid) and frame of a special fit.
fn frame_of(surface: &Posed<Surface>) -> (f64, Frame) {
    let (ring, half, exponents) = match surface.shape() {
        Surface::Superellipsoid(s) => (1.0, s.semi_axes(), s.exponents()),
        Surface::Supertoroid(s) => (s.ring_ratio(), s.semi_axes(), s.exponents()),
        #[allow(unreachable_patterns)]
        other => (1.0, other.half_extents(), [1.0; 2]),
    };
    let rotation = surface.pose().rotation.to_rotation_matrix();
    (ring, Frame { rotation, position: surface.pose().translation.vector, half, exponents })
}

/// The box of the points along their principal axes.
fn principal(points: &[Vector]) -> Frame {
    let axes = SymmetricEigen::new(scatter(points)).eigenvectors;
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
    let cloud = Normalised::new(points, 2 * numbers)?;
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

impl Normalised {
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
        h.body.member.shape(&h.body.numbers, self.scale).is_ok()
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
        let mut distances = h.body.distances(&self.points);
        let mut next = distances.iter();
        let finite = |p: &Point| p.iter().all(|v| v.is_finite());
        let belongs =
            |p: &Point| finite(p) && next.next().is_some_and(|d| h.mixture.belongs(*d) > 0.5);
        let inliers: Vec<bool> = points.iter().map(belongs).collect();
        let share = inliers.iter().filter(|i| **i).count() as f64 / distances.len() as f64;
        distances.iter_mut().for_each(|d| *d = d.abs());
        if share.is_nan() || share < LEAST_SHARE {
            return Err(FitError::NoAgreement { share });
        }
        let body = &h.body;
        let shape = body.member.shape(&body.numbers, self.scale)?;
        let pose = Pose::from_parts(
            (body.position * self.scale + self.centre).into(),
            nalgebra::UnitQuaternion::from_rotation_matrix(&body.rotation),
        );
        Ok(GenericFit {
            surface: Posed::new(shape, pose)?,
            noise: h.mixture.scale * self.scale,
            residual: quantile(&mut distances, 0.5) * self.scale,
            inliers,
            iterations: h.iterations,
            stopped: h.stopped,
        })
    }
}
