//! Antipodal search over the points: for many approaches and closing directions the object is cut into strips as
//! wide as the pads, and every stretch of matter with room for a finger on both sides can be closed on.
//!
//! What lies under the tips is not looked at: matter above the tips decides where fingers fit, matter between
//! the pads what they touch. The search proposes; [`super::quality`] and [`super::check`] decide.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::gripper::Jaw;
use super::quality::Candidate;
use super::strip::Strips;
use super::surroundings::Local;
use crate::{Pose, Vector};

/// Matter this far beside the pads is in their way, in metres.
const BESIDE: f32 = 0.001;
/// How far the tips go below the highest matter of a strip.
const DEPTHS: [f32; 5] = [0.042, 0.032, 0.022, 0.014, 0.008];
/// The jaw closes about level.
const LEVEL: f64 = 0.5;
/// Least width that is worth closing on.
const LEAST_WIDTH: f64 = 0.003;
/// How near to an end of a stretch a pad touches, in metres.
const END: f32 = 0.005;
/// Tips stay this far above the table.
const FLOOR: f64 = 0.003;
/// Candidates that are kept for judgement.
const KEPT: usize = 140;

/// The most promising candidates, best first.
pub(super) fn sweep(local: &Local, jaw: &Jaw) -> Vec<Candidate> {
    let mut best = Best { least: f64::NEG_INFINITY, found: Vec::new() };
    let mut strips = Strips::new(&local.spots, &local.centre);
    for rotation in orientations(local.heights[1] - local.heights[0] > 0.04) {
        Turn { rotation, local, jaw, strips: &mut strips }.search(&mut best);
    }
    best.cut();
    best.found.into_iter().map(|(_, c)| c).collect()
}

/// The candidates with the highest worth by the search's own estimate.
struct Best {
    /// What is worth no more than this is not among them.
    least: f64,
    found: Vec<(f64, Candidate)>,
}

impl Best {
    fn take(&mut self, worth: f64, candidate: Candidate) {
        self.found.push((worth, candidate));
        if self.found.len() == 2 * KEPT {
            self.cut();
            self.least = self.found[KEPT - 1].0;
        }
    }

    fn cut(&mut self) {
        // stable, so that ties keep the order of the search
        self.found.sort_by(|a, b| b.0.total_cmp(&a.0));
        self.found.truncate(KEPT);
    }
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

/// One approach and closing direction of the search, with the object turned to it.
struct Turn<'a> {
    rotation: Rotation3<f64>,
    local: &'a Local,
    jaw: &'a Jaw,
    strips: &'a mut Strips,
}

impl Turn<'_> {
    fn search(&mut self, best: &mut Best) {
        self.strips.turn(&self.rotation, self.jaw.pad_width as f32 + 2.0 * BESIDE);
        for strip in 0..self.strips.count() {
            let (y, places, top) = self.strips.open(strip);
            if places < 6 {
                continue;
            }
            let deepest = self.jaw.finger_depth as f32 - 0.004;
            for depth in DEPTHS {
                self.close(y, top + depth.min(deepest), best);
            }
            if let Some(tip) = self.floor(y)
                && tip - top < deepest
                && tip > top + 0.004
            {
                self.close(y, tip, best);
            }
        }
    }

    /// How far the tips may go along a steep approach before they meet the table.
    fn floor(&self, y: f32) -> Option<f32> {
        let m = self.rotation.matrix();
        if !self.local.has_table || m.m33 > -0.85 {
            return None;
        }
        let x = f64::from(self.strips.middle()?);
        // height of the tip at (x, y, t): that of the middle plus m31 x + m32 y + m33 t
        let height = FLOOR - self.local.centre.z - m.m31 * x - m.m32 * f64::from(y);
        Some((height / m.m33) as f32)
    }

    /// Closes on every stretch of matter above the tips.
    fn close(&self, y: f32, tip: f32, best: &mut Best) {
        let room = self.jaw.finger_thickness + 2.0 * self.jaw.clearance.min(0.004);
        self.strips.stretches(tip, room as f32, |from, to| {
            self.propose([from, to, y, tip], best);
        });
    }

    fn propose(&self, [from, to, y, tip]: [f32; 4], best: &mut Best) {
        let jaw = self.jaw;
        let width = f64::from(to - from);
        let least = LEAST_WIDTH.max(jaw.min_opening);
        if width < least || width + jaw.clearance > jaw.max_opening {
            return;
        }
        let tcp = f64::from(tip) - jaw.tip_beyond_tcp;
        let middle = Vector::new(f64::from(0.5 * (from + to)), f64::from(y), tcp);
        // the lever from the object's middle, which is the origin here
        let lever = middle.yz().norm();
        let price = 5.0 * lever
            + 0.15 * (1.0 + self.rotation.matrix().m33)
            + 0.5 * (1.0 - ((jaw.max_opening - width - jaw.clearance) / 0.015).min(1.0));
        // sides are worth 1.5 at most: most stretches need not be looked at
        if 1.5 - price <= best.least || self.meets_table([from, to, y, tip]) {
            return;
        }
        let Some(sides) = self.sides([from, to, tip]) else { return };
        let [good, other, bad] = sides.map(f64::from);
        let full = |v: f64| (v / 8.0).min(1.0);
        let worth = 0.5 * (full(good) + full(other)) + 0.5 * full(good.min(other))
            - 0.5 * bad / (bad + good + other + 1.0)
            - price;
        if worth > best.least {
            let at = self.local.centre.coords + self.rotation * middle;
            let turn = UnitQuaternion::from_rotation_matrix(&self.rotation);
            let pose = Pose::from_parts(at.into(), turn);
            best.take(worth, Candidate { pose, width, inside: false, source: "sweep" });
        }
    }

    /// True when a corner of an open tip would go into the table.
    fn meets_table(&self, [from, to, y, tip]: [f32; 4]) -> bool {
        let m = self.rotation.matrix();
        let thick = (self.jaw.finger_thickness + self.jaw.clearance) as f32;
        let half = 0.5 * self.jaw.pad_width as f32;
        let drop = |x: f32| f64::from(x) * m.m31;
        let lowest =
            self.local.centre.z + drop(from - thick).min(drop(to + thick)) + f64::from(y) * m.m32
                - f64::from(half) * m.m32.abs()
                + f64::from(tip) * m.m33;
        self.local.has_table && lowest < 0.5 * FLOOR
    }

    /// Evidence of places between the pads whose normals lie in the friction cone, at the +x end and at the -x
    /// end, and of those outside the cone; `None` where next to nothing was seen.
    fn sides(&self, [from, to, tip]: [f32; 3]) -> Option<[f32; 3]> {
        let cone = (1.0 / self.jaw.mu.hypot(1.0)) as f32;
        let pads = (tip - self.jaw.pad_length as f32)..=tip;
        let mut seen = 0;
        let mut out = [0.0; 3];
        let mut look = |from_bin: f32, to_bin: f32, end: bool| {
            for t in self.strips.within(from_bin, to_bin).flatten() {
                if !pads.contains(&t.z) || t.x < from || t.x > to {
                    continue;
                }
                seen += usize::from(t.seen);
                if !end {
                    if seen >= 3 {
                        return;
                    }
                    continue;
                }
                for (side, (gap, cosine)) in
                    [(to - t.x, t.cosine), (t.x - from, -t.cosine)].into_iter().enumerate()
                {
                    if gap < END {
                        out[if cosine > cone { side } else { 2 }] += t.evidence;
                    }
                }
            }
        };
        if to - from < 4.0 * END {
            look(from, to, true);
        } else {
            look(from, from + END, true);
            look(to - END, to, true);
            look(from + 1.5 * END, to - 1.5 * END, false);
        }
        (seen >= 3).then_some(out)
    }
}
