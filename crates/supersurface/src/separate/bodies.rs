//! One surface for some points of a cloud, and how well it explains others.

use std::f64::consts::TAU;

use crate::cloud::PointCloud;
use crate::fit::{
    Effort, Family, Fit, FitError, FitOptions, View, fit, free_points_of, outline_points,
};
use crate::shape::{Implicit, Plane};
use crate::surface::Surface;
use crate::{Point, Vector};

/// Lowest points of an object nearer to the support than this, in metres, say that it stands there; higher ones may lie on
/// another object.
const STANDING: f64 = 0.015;
/// Points at which a surface is compared with what it should explain.
const SOME: usize = 200;
/// Points by which a rough fit is made.
const FEW: usize = 1000;
/// Readings on each side of the picture by which the space about it is known, for rough fits and for others.
const READINGS: [usize; 2] = [90, 126];
/// Points of an object that make its picture whole, for the same.
const SOLID: [usize; 2] = [4000, 12_000];
/// Farther from a surface than this, in metres, is off it.
const FAR: f64 = 0.01;
/// Mean distance from its surface of a thing without dents, and which share of its points may be how far off, in standard
/// deviations of the support's points: of 104 clumps of several things the least mean was 0.94.
const PLAIN: f64 = 0.8;
const STRAYS: f64 = 0.01;
const STRAY: f64 = 4.0;
/// Points of each of two pieces by which it is asked whether something convex has both, and how far one of them must lie
/// outside a plane that touches the other to speak against that, in metres.
const PLANES: usize = 24;
const BEYOND: f64 = 0.008;
/// Cosine between an upright ring's axis and the support's normal, at least.
const UPRIGHT: f64 = 0.7;

/// Sectors about the axis of a ring, and in how many of them it must be seen, all but where it stands: by how small a part of
/// the points that are due, within so many standard deviations of the support's points.
const SECTORS: usize = 16;
const AROUND: usize = 14;
const SPARSE: usize = 10;
const NEAR: f64 = 3.0;

/// How pieces are fitted.
pub(super) const ROUGHLY: FitOptions = FitOptions::only(Family::Superellipsoid).rough();
/// How rings among them are.
pub(super) const AS_RING: FitOptions = FitOptions::only(Family::Supertoroid).rough();

/// What is known of a scene beside the points of an object.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around<'a> {
    /// The scene.
    pub(crate) cloud: &'a PointCloud,
    /// What the objects stand on.
    pub(crate) support: Option<Plane>,
    /// Standard deviation of the support's points about it, in metres.
    pub(crate) noise: f64,
}

impl Around<'_> {
    /// The surface of the points named, seen from where the cloud was.
    pub(crate) fn fit(&self, object: &[u32], options: &FitOptions) -> Result<Fit, FitError> {
        match options.effort {
            Effort::Rough => self.seen(object).fit(options),
            _ => {
                let free = free_points_of(self.cloud, &thinned(object, SOLID[1]), READINGS[1]);
                self.view(object, self.cloud.viewpoint, free).fit(options)
            }
        }
    }

    /// The same for a cloud that shows nothing else.
    pub(crate) fn fit_alone(&self, object: &[u32], options: &FitOptions) -> Result<Fit, FitError> {
        self.view(object, self.cloud.viewpoint, outline_points(self.cloud, object)).fit(options)
    }

    /// A rough one of points of which a part may be seen from inside, as through the mouth of a cup.
    pub(super) fn fit_hollow(&self, object: &[u32]) -> Result<Fit, FitError> {
        self.view(&thinned(object, FEW), None, Vec::new()).fit(&ROUGHLY)
    }

    /// Points made ready for rough fits.
    pub(super) fn seen(&self, object: &[u32]) -> Seen {
        let free = free_points_of(self.cloud, &thinned(object, SOLID[0]), READINGS[0]);
        self.view(&thinned(object, FEW), self.cloud.viewpoint, free)
    }

    fn view(&self, object: &[u32], viewpoint: Option<Point>, free: Vec<Point>) -> Seen {
        let points: Vec<Point> = object.iter().map(|i| self.cloud.points[*i as usize]).collect();
        let heights = |t: &Plane| points.iter().map(|p| t.height(p)).fold(f64::INFINITY, f64::min);
        let standing = self.support.is_some_and(|t| heights(&t) < STANDING);
        Seen { points, viewpoint, support: self.support, standing, free }
    }

    /// Heights of the lowest, the middle and the highest points over the support without the last 2 %, in metres; 0 without a
    /// support.
    pub(super) fn heights(&self, points: &[u32]) -> [f64; 3] {
        let Some(support) = self.support.filter(|_| !points.is_empty()) else { return [0.0; 3] };
        let height = |i: &u32| support.height(&self.cloud.points[*i as usize]);
        let mut heights: Vec<f64> = points.iter().map(height).collect();
        let cut = heights.len() / 50;
        [cut, heights.len() / 2, heights.len() - 1 - cut]
            .map(|k| *heights.select_nth_unstable_by(k, f64::total_cmp).1)
    }

    /// Mean of the distances of some of the points from a surface, none counted for more than 10 mm, in metres.
    pub(super) fn rough(&self, points: &[u32], fit: &Fit) -> f64 {
        self.off(points, fit).mean()
    }

    /// Share of some points at which a surface faces the sensor; 1 where its place is not known.
    pub(super) fn facing(&self, points: &[u32], fit: &Fit) -> f64 {
        let Some(eye) = self.cloud.viewpoint else { return 1.0 };
        let some = || points.iter().step_by(points.len().div_ceil(SOME).max(1));
        let faces = |i: &&u32| {
            let p = &self.cloud.points[**i as usize];
            fit.surface.gradient(p).dot(&(eye - p)) > 0.0
        };
        some().filter(faces).count() as f64 / some().count().max(1) as f64
    }

    /// True for a ring on its side that some points do not show all around its axis: the corner between two things looks
    /// like the inside of such a pipe.
    pub(super) fn is_corner(&self, points: &[u32], fit: &Fit) -> bool {
        let axis = fit.surface.pose() * Vector::z();
        matches!(fit.surface.shape(), Surface::Supertoroid(_))
            && self.support.is_some_and(|s| axis.dot(&s.normal()).abs() < UPRIGHT)
            && !self.shows_all_around(points, fit)
    }

    /// Whether points lie on a surface in nearly all directions from its z axis.
    fn shows_all_around(&self, points: &[u32], fit: &Fit) -> bool {
        let mut found = [0; SECTORS];
        let places = || points.iter().map(|i| self.cloud.points[*i as usize]);
        let distances = fit.distances(places());
        for (p, _) in places().zip(distances).filter(|(_, d)| d.abs() < NEAR * self.noise) {
            let p = fit.surface.to_local(&p);
            let turn = 0.5 + p.y.atan2(p.x) / TAU;
            found[((turn * SECTORS as f64) as usize).min(SECTORS - 1)] += 1;
        }
        let due = points.len() / SECTORS;
        found.iter().filter(|n| **n * SPARSE >= due).count() >= AROUND
    }

    /// Share of some points that lie clearly outside the planes that touch a surface at some of its own points: none does of
    /// what is convex and has both. Planes turned from the eye count for nothing, as there the surface is a guess.
    pub(super) fn share_beyond(&self, own: &[u32], fit: &Fit, points: &[u32]) -> f64 {
        let some = |of: &[u32]| {
            let places = of.iter().step_by(of.len().div_ceil(PLANES).max(1));
            places.map(|i| self.cloud.points[*i as usize]).collect::<Vec<Point>>()
        };
        let seen =
            |p: &Point, out: &Vector| self.cloud.viewpoint.is_none_or(|e| out.dot(&(e - p)) > 0.0);
        let (mut beyond, mut all) = (0, 0);
        let others = some(points);
        for p in some(own) {
            let Some(out) = fit.surface.gradient(&p).try_normalize(0.0).filter(|out| seen(&p, out))
            else {
                continue;
            };
            all += others.len();
            beyond += others.iter().filter(|q| out.dot(&(*q - p)) > BEYOND).count();
        }
        beyond as f64 / all.max(1) as f64
    }

    /// Median of the distances of some of the points from a surface, in metres.
    pub(super) fn typical(&self, points: &[u32], fit: &Fit) -> f64 {
        self.off(points, fit).median()
    }

    /// Whether a surface leaves nothing of the points but noise, so that they are one thing without dents.
    pub(super) fn is_plain(&self, points: &[u32], fit: &Fit) -> bool {
        let off = self.off_at(points, FEW, fit);
        off.mean() < PLAIN * self.noise && off.share_beyond(STRAY * self.noise) < STRAYS
    }

    /// How far some of the points are from a surface.
    pub(super) fn off(&self, points: &[u32], fit: &Fit) -> Off {
        self.off_at(points, SOME, fit)
    }

    fn off_at(&self, points: &[u32], most: usize, fit: &Fit) -> Off {
        let some = points.iter().step_by(points.len().div_ceil(most).max(1));
        let mut distances = fit.distances(some.map(|i| self.cloud.points[*i as usize]));
        distances.iter_mut().for_each(|d| *d = d.abs());
        Off(distances)
    }
}

/// First-order distances of some points from a surface, in metres.
pub(super) struct Off(Vec<f64>);

impl Off {
    /// Their mean, none counted for more than 10 mm; 0 for none.
    pub(super) fn mean(&self) -> f64 {
        self.0.iter().map(|d| d.min(FAR)).sum::<f64>() / self.0.len().max(1) as f64
    }

    /// Share of them over a limit in metres.
    fn share_beyond(&self, limit: f64) -> f64 {
        self.0.iter().filter(|d| **d > limit).count() as f64 / self.0.len().max(1) as f64
    }

    /// The one in the middle; infinite for none.
    pub(super) fn median(mut self) -> f64 {
        if self.0.is_empty() {
            return f64::INFINITY;
        }
        let middle = self.0.len() / 2;
        *self.0.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// What was seen of some points, for more than one fit.
pub(super) struct Seen {
    points: Vec<Point>,
    viewpoint: Option<Point>,
    support: Option<Plane>,
    standing: bool,
    free: Vec<Point>,
}

impl Seen {
    /// Their surface.
    pub(super) fn fit(&self, options: &FitOptions) -> Result<Fit, FitError> {
        let Self { points, viewpoint, support, standing, free } = self;
        let (viewpoint, support, standing) = (*viewpoint, *support, *standing);
        fit(&View { points, viewpoint, support, standing, free }, options)
    }
}

/// At most `most` of the points, evenly spread over their order.
fn thinned(points: &[u32], most: usize) -> Vec<u32> {
    points.iter().step_by(points.len().div_ceil(most).max(1)).copied().collect()
}
