//! Floor 7: one supersurface for the points of one object.
//!
//! The fit maximises the likelihood of the points' first-order distances under a mixture of a Gaussian (on single views
//! a Student-t) and a constant density of outliers, whose scale and share are estimated. It begins from frames that the
//! structure of the cloud suggests, ranks them by a coarse search, refines the best, and tries the
//! near-symmetries of the family. For a single view it adds what else is known: the body stands on its
//! support, and it does not stick out into space that the camera's rays prove empty.
//!
//! ```
//! use supersurface::{Point, fit::{fit, FitOptions, View}};
//! use supersurface::shape::{Parametric, Superellipsoid};
//! let tin = Superellipsoid::new([0.03, 0.03, 0.05], [0.2, 1.0])?;
//! let mut points = Vec::new();
//! for i in 0..40 {
//!     for j in 0..40 {
//!         points.push(tin.point(-1.57 + 3.14 * i as f64 / 39.0, 6.28 * j as f64 / 40.0));
//!     }
//! }
//! let found = fit(&View::all_around(&points), &FitOptions::default())?;
//! assert!(found.residual < 2e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! It does not promise the global optimum, and the hidden side of a single view is the simplest body that
//! the evidence allows, not a measurement.

mod agreement;
mod bias;
mod centred;
mod choose;
mod columns;
mod covariance;
mod coverage;
mod finish;
mod free_space;
pub mod generic;
mod judge;
mod kernel;
mod mirror;
mod misfit;
mod neighbours;
mod noise;
mod normal;
mod parameters;
mod patches;
mod pieces;
mod poses;
mod prepare;
mod pull_back;
mod rays;
mod samples;
mod search;
mod sights;
mod smeared;
mod solver;
mod start;
mod switch;
mod terms;

use nalgebra::Isometry3;

pub use agreement::Agreement;
pub use covariance::Covariance;
pub(crate) use free_space::free_points_of;
pub use free_space::{free_points, outline_points};
pub use mirror::{Completion, Mirror, mirrored};
pub use parameters::Family;
pub use poses::PoseError;
pub use solver::Stopped;

use self::centred::{Placement, is_finite};
use self::choose::choose;
use self::columns::distances;
use self::judge::judge;
use self::mirror::completed_frames;
use self::parameters::Parameters;
use self::poses::{MovedView, moves};
use self::prepare::Normalised;
use self::search::best;
use self::solver::Hypothesis;
use crate::shape::{InvalidShape, Plane, Posed};
use crate::surface::Surface;
use crate::{Point, Vector};

/// What was seen of an object.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// Points on the object, in metres; rows that are not finite are left out.
    pub points: &'a [Point],
    /// Where the sensor stood; `None` when the object was seen from all around. A place nearer to the points' mean than
    /// 1.8 times their root mean square distance from it is no sensor's and counts as `None`; points at it are left out.
    pub viewpoint: Option<Point>,
    /// The plane that bounds the object from below, its normal towards the object.
    pub support: Option<Plane>,
    /// True when the object stands on the support, even if its foot is not seen.
    pub standing: bool,
    /// Points seen beside or behind the object: nothing lies between the viewpoint and them.
    pub free: &'a [Point],
}

impl<'a> View<'a> {
    /// The points that count.
    fn counted(&self) -> Vec<Vector> {
        self.points.iter().filter(|p| self.counts(p)).map(|p| p.coords).collect()
    }

    /// True for points that count: where a sensor saw nothing it may have written its own place.
    fn counts(&self, p: &Point) -> bool {
        is_finite(&p.coords) && Some(*p) != self.viewpoint
    }

    /// Points from all sides, with nothing else known.
    pub const fn all_around(points: &'a [Point]) -> Self {
        Self { points, viewpoint: None, support: None, standing: false, free: &[] }
    }
}

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// The families among which the evidence chooses; all by default.
    pub families: &'static [Family],
    /// How much time a fit may take.
    pub effort: Effort,
    /// From what guess of the unseen side of a single view a fit begins too.
    pub complete: Completion,
}

/// How much time a fit may take: all else is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// A millisecond or two: few starts and points, to ask whether one surface explains some points.
    Rough,
    /// A few milliseconds: for the frames of a camera with many objects.
    Quick,
    /// Ten milliseconds or so: more starts and points, and for views a last stage along the rays.
    #[default]
    Thorough,
}

impl FitOptions {
    /// Every family.
    pub const ALL: Self = Self::among(&Family::ALL);

    /// Superellipsoids and supertoroids: what grasp tables know.
    pub const UNDEFORMED: Self = Self::among(&[Family::Superellipsoid, Family::Supertoroid]);

    /// The same in the least time.
    pub const fn rough(self) -> Self {
        Self { effort: Effort::Rough, ..self }
    }

    /// The same in less time.
    pub const fn quick(self) -> Self {
        Self { effort: Effort::Quick, ..self }
    }

    const fn among(families: &'static [Family]) -> Self {
        Self { families, effort: Effort::Thorough, complete: Completion::Nothing }
    }

    /// One family.
    pub const fn only(family: Family) -> Self {
        Self::among(family.alone())
    }
}

impl Default for FitOptions {
    fn default() -> Self {
        Self::ALL
    }
}

/// A recovered supersurface and how sure it is.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit {
    /// The family of the shape.
    pub family: Family,
    /// The shape in the frame of the points.
    pub surface: Posed<Surface>,
    /// Scale of the inliers' scatter about the surface in metres: the standard deviation of a Gaussian, or on a single view
    /// the scale of a Student-t with 3 degrees of freedom, with [`Effort::Thorough`] along the lines of sight.
    pub noise: f64,
    /// Median of the absolute first-order distances of all points, in metres.
    pub residual: f64,
    /// Which of the points belong to the surface (probability over one half), one view after the other; false for points
    /// that are not finite or lie at the viewpoint.
    pub inliers: Vec<bool>,
    /// Probability of each of these points to belong to the surface, in [0, 1]; 0 for those that do not count.
    pub probabilities: Vec<f32>,
    /// Evidence for the chosen family against the next best, in nats, after the price of parameters; 0 when one
    /// family was asked for or no other was worth a trial, negative on a view where the likelihood alone speaks for a ring
    /// whose hole is not seen.
    pub margin: f64,
    /// How each view was moved, in the frame of the points, for all to agree within the errors of their poses; as they are
    /// where no error was given.
    pub moves: Vec<Isometry3<f64>>,
    /// How sure the parameters are; `None` where the points leave that open, and with [`Effort::Rough`].
    pub covariance: Option<Covariance>,
    /// Rounds of the solver on the way from the start to this surface.
    pub iterations: usize,
    /// Why the last rounds ended.
    pub stopped: Stopped,
    /// The same body as the solver knows it.
    body: (Parameters, Placement),
}

impl Fit {
    /// First-order distances `(g - 1)/|∇g|` of points from the surface in metres, negative inside (Taubin, 1991): many at
    /// once, which takes a small part of the time of one after the other. A point that is not finite, or where the gradient
    /// vanishes, is far outside.
    ///
    /// ```
    /// # use supersurface::{Point, fit::{fit, FitOptions, View}};
    /// # let ball = |i: i32| {
    /// #     let (z, a) = ((f64::from(i) + 0.5) / 200.0 - 1.0, 2.4 * f64::from(i));
    /// #     Point::new((1.0 - z * z).sqrt() * a.cos(), (1.0 - z * z).sqrt() * a.sin(), z) * 0.05
    /// # };
    /// # let points: Vec<Point> = (0..400).map(ball).collect();
    /// let ball = fit(&View::all_around(&points), &FitOptions::default())?;
    /// let found = ball.distances([Point::new(0.06, 0.0, 0.0)].into_iter());
    /// assert!((found[0] - 0.01).abs() < 1e-5);
    /// # Ok::<(), supersurface::fit::FitError>(())
    /// ```
    pub fn distances(&self, points: impl Iterator<Item = Point>) -> Vec<f64> {
        let (body, placement) = &self.body;
        let mut found = distances(body, points.map(|p| placement.inward(&p)));
        found.iter_mut().for_each(|d| *d *= placement.scale);
        found
    }

    /// Share of the points that belong to the surface, in [0, 1].
    pub fn inlier_share(&self) -> f64 {
        let n = self.inliers.iter().filter(|i| **i).count();
        n as f64 / self.inliers.len().max(1) as f64
    }
}

/// Why points give no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Fewer finite points than a surface has parameters.
    #[error("{found} finite points: a surface needs at least {needed}")]
    TooFewPoints {
        /// Finite points in the view.
        found: usize,
        /// The least number.
        needed: usize,
    },
    /// All points are one point (or so near to it that rounding hides the rest).
    #[error("all {points} points are the same")]
    OnePoint {
        /// Finite points in the view.
        points: usize,
    },
    /// All points lie on a line.
    #[error("all {points} points lie on one line")]
    Line {
        /// Finite points in the view.
        points: usize,
    },
    /// No surface explains the points.
    #[error("no surface explains the points: the best fits {:.0} % of them", 100.0 * share)]
    NoAgreement {
        /// Share of inliers of the best surface.
        share: f64,
    },
    /// The numbers left the range of a shape.
    #[error(transparent)]
    Invalid(#[from] InvalidShape),
}

/// Fits one supersurface to one view.
pub fn fit(view: &View<'_>, options: &FitOptions) -> Result<Fit, FitError> {
    fit_views(std::slice::from_ref(view), &[], options)
}

/// Fits one supersurface to several views of the same object, all in one frame, whose poses may be off by `errors`, one a
/// view; a view without one is exact. At least one view should be: it holds the frame.
///
/// Lines of sight count where every view names its viewpoint. The first support counts. The covariance takes the poses
/// that were found as exact.
///
/// ```
/// use supersurface::{Point, fit::{FitOptions, Family, View, fit_views}};
/// // a ball of 5 cm, its left and its right half seen by two sensors
/// let ball = |i: i32| {
///     let (z, a) = ((f64::from(i) + 0.5) / 400.0 - 1.0, 2.4 * f64::from(i));
///     Point::new((1.0 - z * z).sqrt() * a.cos(), (1.0 - z * z).sqrt() * a.sin(), z) * 0.05
/// };
/// let (left, right): (Vec<Point>, Vec<Point>) = (0..800).map(ball).partition(|p| p.x < 0.0);
/// let see = |points, x| View { viewpoint: Some(Point::new(x, 0.0, 0.0)), ..View::all_around(points) };
/// let views = [see(&left, -0.6), see(&right, 0.6)];
/// let found = fit_views(&views, &[], &FitOptions::only(Family::Superellipsoid))?;
/// assert!(found.residual < 1e-4);
/// # Ok::<(), supersurface::fit::FitError>(())
/// ```
pub fn fit_views(
    views: &[View<'_>],
    errors: &[PoseError],
    options: &FitOptions,
) -> Result<Fit, FitError> {
    errors.iter().try_for_each(PoseError::check)?;
    let mut cloud = Normalised::new(views, options.effort)?;
    if let ([view], Completion::Mirror) = (views, options.complete) {
        cloud.frames.extend(completed_frames(view, &cloud));
    }
    let (hypothesis, margin) = recover(&cloud, options);
    let still = vec![Isometry3::identity(); views.len()];
    if views.len() < 2 || errors.iter().all(|e| *e == PoseError::NONE) {
        return judge(&cloud, views, &hypothesis, margin, still);
    }
    let moves = moves(&cloud, views, errors, &hypothesis);
    let moved: Vec<MovedView> =
        views.iter().zip(&moves).map(|(v, m)| MovedView::new(v, m)).collect();
    let views: Vec<View<'_>> =
        moved.iter().zip(views).map(|(moved, view)| moved.of(view)).collect();
    let cloud = Normalised::new(&views, options.effort)?;
    let (hypothesis, margin) = recover(&cloud, options);
    judge(&cloud, &views, &hypothesis, margin, moves)
}

/// The best body of the families that were asked for, and its margin.
fn recover(cloud: &Normalised, options: &FitOptions) -> (Hypothesis, f64) {
    match options.families {
        [family] => (best(cloud, *family), 0.0),
        families => choose(cloud, families),
    }
}
