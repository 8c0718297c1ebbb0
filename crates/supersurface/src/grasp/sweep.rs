//! Antipodal search over the points: for many approaches and closing directions the object is cut into strips as
//! wide as the pads, and every stretch of matter with room for a finger on both sides can be closed on.
//!
//! What lies under the tips is not looked at: matter above the tips decides where fingers fit, matter between
//! the pads what they touch. The search proposes; [`super::quality`] and [`super::check`] decide.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::gripper::Jaw;
use super::quality::Candidate;
use super::surroundings::{Local, Spot};
use crate::{Pose, Vector};

/// Distance between strips, in metres.
const STRIDE: f64 = 0.008;
/// How far the tips go below the highest matter of a strip.
const DEPTHS: [f64; 5] = [0.042, 0.032, 0.022, 0.014, 0.008];
/// The jaw closes about level.
const LEVEL: f64 = 0.5;
/// Least width that is worth closing on.
const LEAST_WIDTH: f64 = 0.003;
/// Tips stay this far above the table.
const FLOOR: f64 = 0.003;
/// Candidates that are kept for judgement.
const KEPT: usize = 220;

/// A candidate with the search's own estimate of its worth.
type Ranked = (f64, Candidate);

/// The most promising candidates, best first.
pub(super) fn sweep(local: &Local, jaw: &Jaw) -> Vec<Candidate> {
    let mut found: Vec<Ranked> = Vec::new();
    let mut strip = Strip::default();
    for rotation in orientations(local.heights[1] - local.heights[0] > 0.04) {
        strip.fill(&rotation, &local.spots);
        strip.search(&rotation, local, jaw, &mut found);
    }
    // stable, so that ties keep the order of the search
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(KEPT);
    found.into_iter().map(|(_, c)| c).collect()
}

/// Least width of the whole object over the level closing directions of an approach from above, in metres.
pub(super) fn narrowest(local: &Local) -> f64 {
    let width = |k: u32| {
        let (s, c) = (std::f64::consts::PI * f64::from(k) / 24.0).sin_cos();
        let along = || local.spots.iter().map(|p| p.at.x * c + p.at.y * s);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    (0..24).map(width).fold(f64::INFINITY, f64::min)
}

/// Tool rotations: from above, tilted by 25 and 50 degrees, and nearly level for tall things.
fn orientations(tall: bool) -> Vec<Rotation3<f64>> {
    let mut approaches = vec![(-Vector::z(), 12)];
    for degrees in [25.0f64, 50.0] {
        let (s, c) = degrees.to_radians().sin_cos();
        for k in 0..6 {
            let (sb, cb) = (f64::from(k) * std::f64::consts::FRAC_PI_3).sin_cos();
            approaches.push((Vector::new(s * cb, s * sb, -c), 6));
        }
    }
    if tall {
        for k in 0..12 {
            let (sb, cb) = (f64::from(k) * std::f64::consts::FRAC_PI_6).sin_cos();
            approaches.push((Vector::new(cb, sb, -0.15).normalize(), 6));
        }
    }
    let mut out = Vec::new();
    for (z, turns) in approaches {
        let helper = if z.z.abs() > 0.95 { Vector::x() } else { z.cross(&Vector::z()) };
        let x0 = (helper - z * z.dot(&helper)).normalize();
        let y0 = z.cross(&x0);
        for t in 0..turns {
            let (s, c) = (std::f64::consts::PI * f64::from(t) / f64::from(turns)).sin_cos();
            let x = x0 * c + y0 * s;
            if x.z.abs() <= LEVEL {
                let axes = Matrix3::from_columns(&[x, z.cross(&x), z]);
                out.push(Rotation3::from_matrix_unchecked(axes));
            }
        }
    }
    out
}

/// A place in the tool's directions: coordinates, cosine between its normal and the closing axis, and its weight
/// as evidence (0 where no normal is known).
#[derive(Clone, Copy, Debug, Default)]
struct Turned {
    x: f64,
    y: f64,
    z: f64,
    cosine: f64,
    evidence: f64,
    seen: bool,
}

/// All places of the object seen along one approach.
#[derive(Default)]
struct Strip {
    /// In rising y.
    all: Vec<Turned>,
    /// Those of one strip in rising x.
    inside: Vec<Turned>,
}

impl Strip {
    fn fill(&mut self, rotation: &Rotation3<f64>, spots: &[Spot]) {
        self.all.clear();
        self.all.extend(spots.iter().map(|s| {
            let q = rotation.inverse_transform_vector(&s.at.coords);
            let known = s.normal != Vector::zeros();
            Turned {
                x: q.x,
                y: q.y,
                z: q.z,
                cosine: rotation.matrix().column(0).dot(&s.normal),
                evidence: match (s.seen, known) {
                    (true, true) => 1.0,
                    (false, true) => 0.6,
                    _ => 0.0,
                },
                seen: s.seen,
            }
        }));
        self.all.sort_unstable_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
    }

    fn search(
        &mut self,
        rotation: &Rotation3<f64>,
        local: &Local,
        jaw: &Jaw,
        found: &mut Vec<Ranked>,
    ) {
        let (Some(first), Some(last)) = (self.all.first(), self.all.last()) else { return };
        let (low, high) = (first.y, last.y);
        let half = 0.5 * jaw.pad_width + 0.001;
        let strips = ((high - low) / STRIDE).clamp(0.0, 200.0) as usize + 1;
        for k in 0..strips {
            let y = if strips == 1 {
                0.5 * (low + high)
            } else {
                low + (high - low) * (k as f64 + 0.5) / strips as f64
            };
            let from = self.all.partition_point(|t| t.y < y - half);
            let to = self.all.partition_point(|t| t.y <= y + half);
            if to - from < 6 {
                continue;
            }
            self.inside.clear();
            self.inside.extend_from_slice(&self.all[from..to]);
            self.inside.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.z.total_cmp(&b.z)));
            let top = self.inside.iter().map(|t| t.z).fold(f64::INFINITY, f64::min);
            for depth in DEPTHS {
                let depth = depth.min(jaw.finger_depth - 0.004);
                let tip = top + depth;
                self.stretches(rotation, local, jaw, y, tip, found);
            }
            if let Some(tip) = self.floor(rotation, local, y)
                && tip - top < jaw.finger_depth - 0.004
                && tip > top + 0.004
            {
                self.stretches(rotation, local, jaw, y, tip, found);
            }
        }
    }

    /// How far the tips may go along a steep approach before they meet the table.
    fn floor(&self, rotation: &Rotation3<f64>, local: &Local, y: f64) -> Option<f64> {
        let z = rotation.matrix().column(2).z;
        if !local.has_table || z > -0.85 {
            return None;
        }
        let xs = &self.inside;
        let x = 0.5 * (xs.first()?.x + xs.last()?.x);
        let m = rotation.matrix();
        // height of the tip at (x, y, t): m31 x + m32 y + m33 t
        Some((FLOOR - m.m31 * x - m.m32 * y) / z)
    }

    /// Stretches of matter above the tips with room for a finger on both sides.
    fn stretches(
        &self,
        rotation: &Rotation3<f64>,
        local: &Local,
        jaw: &Jaw,
        y: f64,
        tip: f64,
        found: &mut Vec<Ranked>,
    ) {
        let room = jaw.finger_thickness + 2.0 * jaw.clearance.min(0.004);
        let mut start: Option<f64> = None;
        let mut end = 0.0;
        let above = self.inside.iter().filter(|t| t.z < tip + 0.001);
        for x in above.map(|t| t.x).chain([f64::INFINITY]) {
            match start {
                Some(from) if x - end > room => {
                    self.propose(rotation, local, jaw, [from, end, y, tip], found);
                    start = Some(x);
                }
                None => start = Some(x),
                _ => {}
            }
            end = x;
        }
    }

    fn propose(
        &self,
        rotation: &Rotation3<f64>,
        local: &Local,
        jaw: &Jaw,
        [from, to, y, tip]: [f64; 4],
        found: &mut Vec<Ranked>,
    ) {
        let width = to - from;
        if width < LEAST_WIDTH || width + jaw.clearance > jaw.max_opening {
            return;
        }
        let cone = 1.0 / (1.0 + jaw.mu * jaw.mu).sqrt();
        let (mut good, mut bad, mut seen) = ([0.0f64; 2], 0.0, 0usize);
        for t in &self.inside {
            if t.z > tip || t.z < tip - jaw.pad_length || t.x < from - 1e-9 || t.x > to + 1e-9 {
                continue;
            }
            seen += usize::from(t.seen);
            for (side, (gap, cosine)) in
                [(to - t.x, t.cosine), (t.x - from, -t.cosine)].into_iter().enumerate()
            {
                if gap < 0.005 {
                    if cosine > cone {
                        good[side] += t.evidence;
                    } else {
                        bad += t.evidence;
                    }
                }
            }
        }
        if seen < 3 {
            return;
        }
        let middle = Vector::new(0.5 * (from + to), y, tip - jaw.tip_beyond_tcp);
        let at = rotation * middle;
        let closing: Vector = rotation.matrix().column(0).into();
        let arm = local.centre.coords - at;
        let lever = (arm - closing * arm.dot(&closing)).norm();
        let full = |v: f64| (v / 8.0).min(1.0);
        let approach: Vector = rotation.matrix().column(2).into();
        let value = 0.5 * (full(good[0]) + full(good[1])) + 0.5 * full(good[0].min(good[1]))
            - 0.5 * bad / (bad + good[0] + good[1] + 1.0)
            - 5.0 * lever
            - 0.15 * (1.0 + approach.z)
            - 0.5 * (1.0 - ((jaw.max_opening - width - jaw.clearance) / 0.015).min(1.0));
        let pose = Pose::from_parts(at.into(), UnitQuaternion::from_rotation_matrix(rotation));
        found.push((value, Candidate { pose, width, inside: false, source: "sweep" }));
    }
}
