//! A view made ready: centred, thinned, with all that is known beside the points and frames to begin in.

use super::centred::{Centred, Placement, axes_of, on_grid, scatter, spread_over};
use super::columns::Sample;
use super::free_space::outline;
use super::pieces::pieces;
use super::start::{Frame, NEIGHBOURHOODS, frames, quantile};
use super::terms::{Eye, Sight, Support, Terms};
use super::{Effort, FitError, View};
use crate::numeric::lanes::Lane;
use crate::{Point, Vector};

/// Fewer points than this determine no surface.
const LEAST_POINTS: usize = 12;
/// Points that sort out the starts of single views, that rank starts (the many of a view that is looked at thoroughly by
/// fewer), that refine the best of them, and that decide (for each effort).
const SKETCH: usize = 60;
const COARSE: usize = 160;
const COARSE_VIEW: usize = 128;
const MIDDLE: [usize; 3] = [200, 240, 400];
const FINE: [usize; 3] = [400, 600, 2000];
/// Neighbourhoods by which frames are found (for each effort).
const LOOKED_AT: [usize; 3] = [100, NEIGHBOURHOODS, NEIGHBOURHOODS];
/// Share of the points from which a piece is as good as all.
const WHOLE: f64 = 0.97;
/// How far before a seen point nothing is, in normalised lengths.
const BEFORE: f64 = 0.15;
/// A piece stands on the support when the gap below it is less than this share of its size.
const HOVERING: f64 = 0.8;
/// The support is known no better than this share of the cloud's size.
const SUPPORT_TOLERANCE: f64 = 0.01;

/// What was seen, with zero mean and unit root mean square, along its principal axes.
pub(super) struct Normalised {
    pub(super) placement: Placement,
    /// Single precision tells bodies apart as long as there is noise, and twice as many numbers fill a register.
    pub(super) sketch: Sample<f32>,
    pub(super) coarse: Sample<f32>,
    pub(super) middle: Sample<f32>,
    /// All points.
    pub(super) fine: Sample<f32>,
    pub(super) points: Vec<Vector>,
    /// Which view has seen each of the points.
    pub(super) seen_by: Vec<usize>,
    pub(super) frames: Vec<Frame>,
    pub(super) terms: Terms,
    pub(super) effort: Effort,
    /// Points that count.
    pub(super) total: usize,
}

impl Normalised {
    pub(super) fn new(views: &[View<'_>], effort: Effort) -> Result<Self, FitError> {
        let (mut points, mut seen_by) = (Vec::new(), Vec::new());
        for (k, view) in views.iter().enumerate() {
            points.extend(view.counted());
            seen_by.resize(points.len(), k);
        }
        let cloud = Centred::new(&points, LEAST_POINTS)?;
        let (placement, total) = (cloud.placement, points.len());
        let inward = |p: &Point| placement.inward(p).map(on_grid);
        let all = Seen { points: &cloud.points, by: &seen_by };
        let most = FINE[effort as usize];
        let thinned = (total > most).then(|| all.chosen(spread_over(total, most)));
        let fine = thinned.as_ref().map_or(all, Seen::of);
        let points = fine.points;
        let sides = box_sides(points);
        // one sensor whose place is not known leaves open what any sees
        let place =
            |view: &View<'_>| view.viewpoint.as_ref().map(inward).filter(|p| p.norm() > 1.8);
        let places: Vec<Vector> =
            views.iter().map(place).collect::<Option<_>>().unwrap_or_default();
        let support =
            views.iter().find_map(|view| Some((view, view.support?))).map(|(view, plane)| {
                let normal = placement.turned_inward(&plane.normal()).map(on_grid).normalize();
                let offset = plane.height(&Point::from(placement.centre)) / placement.scale;
                let offset = on_grid(offset);
                let mut heights: Vec<f64> = points.iter().map(|p| normal.dot(p) + offset).collect();
                // a piece that hovers higher than it is large is not the top of something that stands there
                let standing =
                    view.standing && quantile(&mut heights, 0.02) < HOVERING * sides.max();
                let highest = quantile(&mut heights, 0.995);
                let above = |p: &Vector| normal.dot(p) + offset > highest;
                let top = places.iter().any(above).then_some(highest);
                Support { normal, offset, standing, top, tolerance: SUPPORT_TOLERANCE }
            });
        let tallest = support.filter(|s| s.standing).and_then(|s| s.top).unwrap_or(0.0);
        let volume = sides.iter().map(|s| s.max(0.1)).product();
        let sight = if places.is_empty() { Sight::AllAround { volume } } else { Sight::OneSide };
        // seen from one side, stray points and what lies beside the object lead starts astray
        let parts = match (sight, effort) {
            (Sight::OneSide, Effort::Thorough) => Some(pieces(points)),
            _ => None,
        };
        let piece = parts.as_ref().map_or(&[][..], |p| &p.largest);
        let parted =
            piece.len() < (WHOLE * points.len() as f64) as usize && piece.len() > LEAST_POINTS;
        let largest = parted.then(|| fine.chosen(piece.iter().copied()));
        let start = largest.as_ref().map_or(fine, Seen::of);
        let eyes = places.iter().enumerate().map(|(k, place)| {
            let free = match &parts {
                Some(parts) if views[k].free.is_empty() => {
                    let (coherent, by) = fine.chosen(parts.coherent.iter().copied());
                    let own: Vec<Vector> = Seen { points: &coherent, by: &by }.own(k).collect();
                    outline(&own, place)
                }
                _ => views[k].free.iter().map(inward).collect(),
            };
            let nearer = |p: Vector| p - (p - place).normalize() * BEFORE;
            Eye { place: *place, free, before: start.own(k).map(nearer).collect() }
        });
        let eyes: Vec<Eye> = eyes.collect();
        let coarse = if parts.is_some() { COARSE_VIEW } else { COARSE };
        let seen = if parted { box_sides(start.points) } else { sides };
        let reach = 0.55 * seen.max().max(tallest);
        let terms = Terms { support, eyes, sight, reach };
        Ok(Self {
            placement,
            sketch: all.sample(&places, SKETCH),
            coarse: start.sample(&places, coarse),
            middle: all.sample(&places, MIDDLE[effort as usize]),
            fine: fine.sample(&places, total),
            frames: frames(start.points, &terms, LOOKED_AT[effort as usize]),
            points: points.to_vec(),
            seen_by: fine.by.to_vec(),
            terms,
            effort,
            total,
        })
    }

    /// All points as exactly as they are known.
    pub(super) fn exact(&self) -> Sample<f64> {
        let places: Vec<Vector> = self.terms.eyes.iter().map(|eye| eye.place).collect();
        Seen { points: &self.points, by: &self.seen_by }.sample(&places, self.total)
    }
}

/// Points and the numbers of the views that saw them.
#[derive(Clone, Copy)]
struct Seen<'a> {
    points: &'a [Vector],
    by: &'a [usize],
}

impl<'a> Seen<'a> {
    fn of((points, by): &'a (Vec<Vector>, Vec<usize>)) -> Self {
        Self { points, by }
    }

    /// What one view saw.
    fn own(self, view: usize) -> impl Iterator<Item = Vector> + 'a {
        self.points.iter().zip(self.by).filter(move |(_, k)| **k == view).map(|(p, _)| *p)
    }

    fn chosen(&self, places: impl Iterator<Item = usize>) -> (Vec<Vector>, Vec<usize>) {
        places.map(|i| (self.points[i], self.by[i])).unzip()
    }

    /// About `count` of the points, seen from the given places of the sensors where these are known.
    fn sample<L: Lane>(&self, sensors: &[Vector], count: usize) -> Sample<L> {
        let places = spread_over(self.points.len(), count);
        if sensors.is_empty() {
            return Sample::new(places.map(|i| self.points[i]));
        }
        let away = |i: usize| (self.points[i] - sensors[self.by[i]]).normalize();
        Sample::seen(places.map(|i| (self.points[i], away(i))))
    }
}

/// Sides of the points' box along their principal axes.
fn box_sides(points: &[Vector]) -> Vector {
    let axes = axes_of(&scatter(points.iter()));
    let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(-f64::INFINITY));
    for p in points.iter().map(|p| axes.tr_mul(p)) {
        (low, high) = (low.inf(&p), high.sup(&p));
    }
    high - low
}
