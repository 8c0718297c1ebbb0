//! The way from points to a fit: normalise, search each family, choose, and judge every point.

use super::columns::{Evaluation, Sample};
use super::evidence::{shows_hole, toroid_margin};
use super::noise::{Law, Mixture};
use super::parameters::{Family, Parameters};
use super::patches::{dense, patches};
use super::rays::Rays;
use super::solver::{Hypothesis, Schedule, Workspace, refine};
use super::start::{Frame, frames, quantile, starts};
use super::switch::relatives;
use super::terms::{RAY_DENSITY, Support, Terms};
use super::{Fit, FitError, FitOptions, View};
use crate::{Point, Vector};

/// Fewer points than this determine no surface.
const LEAST_POINTS: usize = 12;
/// Points that sort out the starts, that rank them, that refine the best of them, and that decide.
const SKETCH: usize = 60;
const COARSE: usize = 160;
const MIDDLE: usize = 400;
const FINE: usize = 2000;
/// Lines of sight that are looked at beside the middle and the fine set of points.
const MIDDLE_RAYS: usize = 24;
const FINE_RAYS: usize = 48;
/// How many starts are ranked, and how many of these are refined.
const SHORTLIST: usize = 8;
const KEPT: usize = 3;
/// Share of points deep inside a convex body from which it may be hollow.
const HOLLOW: f64 = 0.02;
/// Share of points left out by a convex body from which it may be hollow.
const LEFT_OUT: f64 = 0.15;
/// Share of the lines of sight through a convex body from which it may be hollow.
const CROSSED: f64 = 0.03;
/// How far before a seen point nothing is, in normalised lengths.
const BEFORE: f64 = 0.15;
/// A piece stands on the support when the gap below it is less than this share of its size.
const HOVERING: f64 = 0.8;
/// A fit with a lesser share of inliers explains nothing.
const LEAST_SHARE: f64 = 0.1;
/// A toroid that explains its points badly must be nearer to them than the ellipsoid by this logarithm.
const CLEARLY: f64 = 0.25;
/// Noise is never estimated below this share of the cloud's size.
const NOISE_FLOOR: f64 = 1e-5;
/// The support is known no better than this share of the cloud's size.
const SUPPORT_TOLERANCE: f64 = 0.01;

pub(super) fn search(view: &View<'_>, options: &FitOptions) -> Result<Fit, FitError> {
    let cloud = Normalised::new(view)?;
    let (hypothesis, margin) = match options.families {
        [family] => (cloud.best(*family), 0.0),
        _ => cloud.choose(),
    };
    cloud.judge(view, &hypothesis, margin)
}

/// The view with zero mean and unit root mean square.
struct Normalised {
    centre: Vector,
    scale: f64,
    sketch: Sample,
    coarse: Sample,
    middle: Sample,
    fine: Sample,
    points: Vec<Vector>,
    frames: Vec<Frame>,
    terms: Terms,
}

impl Normalised {
    fn new(view: &View<'_>) -> Result<Self, FitError> {
        let points: Vec<Vector> = view
            .points
            .iter()
            .map(|p| p.coords)
            .filter(|p| p.iter().all(|v| v.is_finite()))
            .collect();
        let found = points.len();
        if found < LEAST_POINTS {
            return Err(FitError::TooFewPoints { found, needed: LEAST_POINTS });
        }
        // around the first point, so that far coordinates do not cancel, and by the largest, so that squares
        // do not overflow
        let origin = points[0];
        let reach = points.iter().map(|p| (p - origin).amax()).fold(0.0, f64::max);
        let magnitude = points.iter().map(|p| p.amax()).fold(0.0, f64::max);
        if reach.is_nan() || reach <= 1e-12 * magnitude || reach.is_infinite() {
            return Err(FitError::OnePoint { points: found });
        }
        let n = found as f64;
        let mean: Vector = points.iter().map(|p| (p - origin) / reach).sum::<Vector>() / n;
        let centre = origin + mean * reach;
        let square = points.iter().map(|p| ((p - centre) / reach).norm_squared()).sum::<f64>() / n;
        let scale = square.sqrt() * reach;
        if !(scale > 0.0 && scale.is_normal()) {
            return Err(FitError::OnePoint { points: found });
        }
        let inward = |p: &Vector| (p - centre) / scale;
        let sample = |count: usize| Sample::new(spread(&points, count).map(inward));
        let fine: Vec<Vector> = spread(&points, FINE).map(inward).collect();
        if is_line(&fine) {
            return Err(FitError::Line { points: found });
        }
        let sides = box_sides(&fine);
        let support = view.support.map(|plane| {
            let normal = plane.normal().into_inner();
            let offset = (normal.dot(&centre) + plane.offset()) / scale;
            let mut heights: Vec<f64> = fine.iter().map(|p| normal.dot(p) + offset).collect();
            // a piece that hovers higher than it is large is not the top of something that stands there
            let standing = view.standing && quantile(&mut heights, 0.02) < HOVERING * sides.max();
            let highest = quantile(&mut heights, 0.995);
            let above = view.viewpoint.is_some_and(|p| plane.height(&p) / scale > highest);
            let top = above.then_some(highest);
            Support { normal, offset, standing, top, tolerance: SUPPORT_TOLERANCE }
        });
        let tallest = support.filter(|s| s.standing).and_then(|s| s.top).unwrap_or(0.0);
        let outside = view.viewpoint.map(|p| inward(&p.coords)).filter(|p| p.norm() > 1.8);
        let free = view.free.iter().map(|p| inward(&p.coords)).collect();
        let closed = outside.is_none().then(|| sides.iter().map(|s| s.max(0.1)).product());
        let reach = 0.55 * sides.max().max(tallest);
        let before = outside.map_or(Vec::new(), |viewpoint| {
            let nearer = |p: &Vector| p - (p - viewpoint).normalize() * BEFORE;
            fine.iter().map(nearer).collect()
        });
        let patches = patches(&fine);
        let surely = dense(&patches);
        let coarse = if outside.is_none() && surely.len() > COARSE / 2 {
            Sample::new(spread(&surely, COARSE).copied())
        } else {
            sample(COARSE)
        };
        let terms = Terms { support, viewpoint: outside, free, before, closed, reach };
        Ok(Self {
            centre,
            scale,
            sketch: sample(SKETCH),
            coarse,
            middle: sample(MIDDLE),
            fine: Sample::new(fine.iter().copied()),
            frames: frames(&fine, &patches, &terms),
            points: fine,
            terms,
        })
    }

    /// The best body of one family.
    fn best(&self, family: Family) -> Hypothesis {
        let mut work = Workspace::default();
        // most starts are hopeless after a few rounds on few points
        let mut ranked: Vec<Hypothesis> = starts(&self.frames, &self.terms, family)
            .iter()
            .map(|s| begin(s, &self.terms))
            .collect();
        // among outliers a sketch misleads: there all starts are ranked at once
        let rounds: &[(&Sample, usize, usize)] = if self.terms.closed.is_some() {
            &[(&self.coarse, 10, KEPT)]
        } else {
            &[(&self.sketch, 4, SHORTLIST), (&self.coarse, 6, KEPT)]
        };
        for &(points, rounds, kept) in rounds {
            for h in &mut ranked {
                *h = refine(h, points, &self.terms, &coarse_schedule(h, rounds), &mut work);
            }
            ranked.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            if std::env::var("SS_DEBUG").is_ok() {
                for h in &ranked {
                    dbg_h("coarse", h);
                }
            }
            ranked.truncate(kept);
        }
        let finer = |h: &Hypothesis, work: &mut Workspace| {
            refine(
                h,
                &self.middle,
                &self.terms,
                &schedule(12, MIDDLE_RAYS, 2.0 * h.mixture.scale),
                work,
            )
        };
        let mut best = ranked
            .iter()
            .map(|h| finer(h, &mut work))
            .min_by(|a, b| a.cost.total_cmp(&b.cost))
            .unwrap_or_else(|| begin(&Parameters::ball(family), &self.terms));
        for relative in relatives(&best.parameters, self.terms.viewpoint) {
            let start = Hypothesis { parameters: relative, ..best };
            let scale = (2.0 * best.mixture.scale).max(0.05);
            let tried = refine(
                &start,
                &self.middle,
                &self.terms,
                &schedule(7, MIDDLE_RAYS, scale),
                &mut work,
            );
            if tried.cost < best.cost - 0.5 {
                best = tried;
            }
        }
        refine(
            &best,
            &self.fine,
            &self.terms,
            &schedule(15, FINE_RAYS, best.mixture.scale),
            &mut work,
        )
    }

    /// The better of the two families and its margin in nats.
    fn choose(&self) -> (Hypothesis, f64) {
        let ellipsoid = self.best(Family::Superellipsoid);
        if !self.may_be_hollow(&ellipsoid) {
            return (ellipsoid, 0.0);
        }
        let toroid = self.best(Family::Supertoroid);
        let mut margin = toroid_margin(&ellipsoid, &toroid, self.fine.len());
        let poor = |h: &Hypothesis| h.mixture.scale > 0.99 * h.mixture.law.largest_scale();
        if poor(&ellipsoid) && poor(&toroid) {
            // neither explains the points (a bowl): a ring that is clearly nearer to most of many says more
            let nearer = (self.typical(&ellipsoid) / self.typical(&toroid)).ln();
            margin = if self.points.len() < FINE { -1.0 } else { nearer - CLEARLY };
        }
        if margin > 0.0 && shows_hole(&toroid, &self.points, self.terms.viewpoint) {
            (toroid, margin)
        } else {
            (ellipsoid, -margin)
        }
    }

    /// Median distance of the points.
    fn typical(&self, h: &Hypothesis) -> f64 {
        let mut distances = distances(&h.parameters, self.points.iter().copied());
        distances.iter_mut().for_each(|d| *d = d.abs());
        quantile(&mut distances, 0.5)
    }

    /// A hole shows itself by points or by free lines of sight that lie deep in the convex body, or by many points
    /// that it leaves out: half of a ring.
    fn may_be_hollow(&self, h: &Hypothesis) -> bool {
        if h.mixture.outliers > LEFT_OUT {
            return true;
        }
        let deep = -(3.0 * h.mixture.scale).max(0.04);
        let deep_among = |points: &[Vector]| {
            let distances = distances(&h.parameters, points.iter().copied());
            distances.into_iter().filter(|d| *d < deep).count()
        };
        let within = deep_among(&self.points);
        let mut intrusions = Vec::new();
        let mut rays = Rays::default();
        self.terms.intrusions(&h.parameters, FINE_RAYS, true, &mut rays, &mut intrusions);
        let through = deep_among(&intrusions);
        let looked =
            self.terms.free.len().min(FINE_RAYS) + self.terms.before.len().min(FINE_RAYS / 2);
        within as f64 > HOLLOW * self.points.len() as f64
            || through as f64 > CROSSED * looked as f64
    }

    fn judge(&self, view: &View<'_>, h: &Hypothesis, margin: f64) -> Result<Fit, FitError> {
        let s = &h.parameters;
        let inward = |p: &Point| (p.coords - self.centre) / self.scale;
        let is_finite = |x: &Vector| x.iter().all(|v| v.is_finite());
        let finite = view.points.iter().map(inward).filter(is_finite);
        let mut distances = distances(s, finite);
        let mut next = distances.iter();
        let mut judge = |p: &Point| {
            is_finite(&inward(p)) && next.next().is_some_and(|d| h.mixture.belongs(*d) > 0.5)
        };
        let inliers: Vec<bool> = view.points.iter().map(&mut judge).collect();
        let share = inliers.iter().filter(|i| **i).count() as f64 / distances.len() as f64;
        distances.iter_mut().for_each(|d| *d = d.abs());
        if share.is_nan() || share < LEAST_SHARE {
            return Err(FitError::NoAgreement { share });
        }
        Ok(Fit {
            family: s.family,
            surface: s.surface(&self.centre, self.scale)?,
            noise: h.mixture.scale * self.scale,
            residual: quantile(&mut distances, 0.5) * self.scale,
            inliers,
            margin,
        })
    }
}

pub(super) fn dbg_h(what: &str, h: &Hypothesis) {
    let p = &h.parameters;
    eprintln!(
        "{what}: cost {:.2} scale {:.4} out {:.3} axes {:.3?} ring {:.2} e {:.2?} at {:.2?} area {:.2}",
        h.cost,
        h.mixture.scale,
        h.mixture.outliers,
        p.log_axes.map(f64::exp),
        p.ring,
        p.exponents,
        p.position.as_slice(),
        p.area()
    );
}

/// First-order distances of points in normalised coordinates.
fn distances(s: &Parameters, points: impl Iterator<Item = Vector>) -> Vec<f64> {
    let sample = Sample::new(points);
    let mut evaluation = Evaluation::default();
    evaluation.fill_distances(s, &sample);
    evaluation.distances.truncate(sample.len());
    evaluation.distances
}

fn begin(s: &Parameters, terms: &Terms) -> Hypothesis {
    let law = if terms.closed.is_some() { Law::Gaussian } else { Law::StudentT };
    let mixture = Mixture { law, scale: 0.1, outliers: 0.3, density: RAY_DENSITY };
    Hypothesis { parameters: *s, mixture, cost: f64::MAX }
}

/// The scale of the first rounds is tied to the start's own body, so that a small body among outliers is not
/// swallowed by a wide kernel; a body that has settled starts from its noise.
fn coarse_schedule(h: &Hypothesis, rounds: usize) -> Schedule {
    let size = h.parameters.half_extents().iter().sum::<f64>() / 3.0;
    let scale = if h.cost < f64::MAX { h.mixture.scale.min(0.04 * size) } else { 0.12 * size };
    Schedule { leash: 1.5, ..schedule(rounds, 0, scale) }
}

fn schedule(rounds: usize, rays: usize, scale: f64) -> Schedule {
    Schedule {
        rounds,
        rays,
        scale,
        decay: 0.7,
        floor: NOISE_FLOOR,
        leash: f64::INFINITY,
        tolerance: 0.02,
    }
}

/// About `count` of the points, evenly spread over their order: one of each of `count` equal stretches, not the
/// same of each, as a step of the rows of a regular cloud would see only some of its columns.
fn spread(points: &[Vector], count: usize) -> impl Iterator<Item = &Vector> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let n = points.len();
    let taken = n.min(count);
    let stretch = n as f64 / taken.max(1) as f64;
    let at = move |i: usize| ((i as f64 + (GOLDEN * i as f64).fract()) * stretch) as usize;
    (0..taken).map(move |i| &points[at(i).min(n - 1)])
}

/// Sides of the points' box along their principal axes.
fn box_sides(points: &[Vector]) -> Vector {
    let scatter: nalgebra::Matrix3<f64> = points.iter().map(|p| p * p.transpose()).sum();
    let axes = nalgebra::SymmetricEigen::new(scatter).eigenvectors;
    Vector::from_fn(|k, _| {
        let along = || points.iter().map(|p| p.dot(&axes.column(k)));
        let low = along().fold(f64::INFINITY, f64::min);
        along().fold(f64::NEG_INFINITY, f64::max) - low
    })
}

/// True when the points have no second direction.
fn is_line(points: &[Vector]) -> bool {
    let scatter: nalgebra::Matrix3<f64> = points.iter().map(|p| p * p.transpose()).sum();
    let mut values = nalgebra::SymmetricEigen::new(scatter / points.len() as f64).eigenvalues;
    values.as_mut_slice().sort_by(f64::total_cmp);
    values[1] < 1e-10 * values[2]
}
