//! The decision tables: where a supersurface can be held, in closed form.
//!
//! Superellipsoid: P1 to P4 for a jaw, S1 to S3 for a cup. Supertoroid: T1 to T4c and T5, T6. These are the
//! paper's Tables 2 to 4 corrected and completed (FORMULAS §8.3). A row holds for a class of exponents (below,
//! at, above 1) and of horizontal semi-axes (alike or not); near a border the rows of both neighbours are
//! given where they hold still: contacts on the axes up to a little above 1, those between the axes from 1.
//!
//! Everything is in the shape's own frame. A jaw's row stands for its mirror images too: its approach may be
//! reversed.

use super::section::{Section, Stationary};
use crate::surface::Surface;
use crate::{Direction, Point, Vector};

/// How near to a border of the classes the rows of both sides are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bands {
    /// Of an exponent about 1.
    pub exponent: f64,
    /// Of the ratio of two semi-axes about 1.
    pub axes: f64,
}

impl Bands {
    /// The classes as they are defined.
    pub const EXACT: Self = Self { exponent: 0.0, axes: 0.0 };
}

impl Default for Bands {
    fn default() -> Self {
        Self { exponent: 0.1, axes: 0.08 }
    }
}

/// Where a jaw closes.
#[derive(Clone, Debug, PartialEq)]
pub struct JawRow {
    /// The table: `P1` to `P4`, `T1` to `T4c`.
    pub table: &'static str,
    /// The two contacts with the outward normals of the solid. The jaw closes along the line through them.
    pub contacts: [(Point, Direction); 2],
    /// The approach that the table names.
    pub approach: Direction,
    /// Half the angle about the closing line over which the approach may turn, in radians.
    pub freedom: f64,
    /// True where every turn of the row about z is a row too.
    pub turning: bool,
    /// True for a jaw that goes into the hole and presses outwards.
    pub inside: bool,
    /// Curvatures at the contacts, horizontal and across; `None` where infinite, on an edge.
    pub curvatures: [Option<f64>; 2],
    /// 1, or 2 for a wider alternative of the same table.
    pub rank: u8,
}

impl JawRow {
    /// Distance between the contacts: the opening that is needed, without clearance.
    pub fn width(&self) -> f64 {
        (self.contacts[0].0 - self.contacts[1].0).norm()
    }

    /// From the second contact to the first.
    pub fn closing(&self) -> Option<Direction> {
        Direction::try_new(self.contacts[0].0 - self.contacts[1].0, 0.0)
    }

    /// True where a contact lies on an edge: its normal is defined, but it does not hold still.
    pub fn is_edge(&self) -> bool {
        self.curvatures.contains(&None)
    }
}

/// Where a vacuum cup is put; it approaches against the normal.
#[derive(Clone, Debug, PartialEq)]
pub struct CupRow {
    /// The table: `S1` to `S3`, `T5`, `T6`.
    pub table: &'static str,
    /// Centre of the cup.
    pub contact: Point,
    /// Outward normal there.
    pub normal: Direction,
    /// The plane sections through the contact in which the surface falls away, most curved first.
    pub sections: [Profile; 2],
    /// True where every turn of the row about z is a row too.
    pub turning: bool,
}

/// How a surface falls away from a contact in one plane section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile {
    /// A straight line.
    Straight,
    /// The vertex `(A, 0)` of a superellipse.
    Vertex(Section),
    /// A regular point of this curvature; negative where the surface rises.
    Curved(f64),
}

impl Profile {
    /// By how much the surface falls away within `radius`; infinite where it ends before.
    ///
    /// At a vertex `δ = A (1 - (1 - (ρ/B)^(2/ε))^(ε/2))` (FORMULAS §8.3), else `κ ρ² / 2`.
    ///
    /// ```
    /// use supersurface::grasp::{Profile, Section};
    /// let ball = Profile::Vertex(Section { a: 0.05, b: 0.05, epsilon: 1.0 });
    /// assert!((ball.sag(0.03) - 0.01).abs() < 1e-15);
    /// ```
    pub fn sag(&self, radius: f64) -> f64 {
        match self {
            Self::Straight => 0.0,
            Self::Curved(curvature) => 0.5 * curvature.abs() * radius * radius,
            Self::Vertex(Section { b, .. }) if radius >= *b => f64::INFINITY,
            Self::Vertex(Section { a, b, epsilon }) => {
                let gone = (2.0 / epsilon * (radius / b).ln()).exp();
                -a * (0.5 * epsilon * (-gone).ln_1p()).exp_m1()
            }
        }
    }

    /// Curvature at the contact; `None` where it is infinite.
    pub fn curvature(&self) -> Option<f64> {
        match self {
            Self::Straight => Some(0.0),
            Self::Curved(curvature) => Some(*curvature),
            Self::Vertex(section) => section.first().curvature,
        }
    }
}

impl CupRow {
    /// The largest gap under a lip of this radius that presses on the contact, in metres.
    pub fn sag(&self, radius: f64) -> f64 {
        self.sections[0].sag(radius).max(self.sections[1].sag(radius))
    }
}

/// The rows of the jaw's tables for a shape; none where its normals are undefined (exponents from 2).
///
/// ```
/// use supersurface::grasp::{Bands, jaw_rows};
/// use supersurface::{shape::Superellipsoid, surface::Surface};
/// let carton = Surface::Superellipsoid(Superellipsoid::new([0.04, 0.03, 0.1], [0.1, 0.1])?);
/// let rows = jaw_rows(&carton, &Bands::default());
/// let narrowest = rows.iter().map(|r| r.width()).fold(f64::INFINITY, f64::min);
/// assert_eq!(narrowest, 0.06);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn jaw_rows(surface: &Surface, bands: &Bands) -> Vec<JawRow> {
    let shape = Shape::new(surface, bands);
    let mut rows = Vec::new();
    for line in shape.lines() {
        match shape.ring {
            None => shape.solid_rows(&line, &mut rows),
            Some(ring) => shape.ring_rows(&line, ring, &mut rows),
        }
    }
    if shape.ring.is_none() && shape.profile.below {
        let edge = Section { a: shape.a3, b: shape.narrowest(), epsilon: shape.epsilon1 };
        let curvature = edge.first().curvature;
        rows.push(JawRow {
            table: "P3",
            contacts: pair(Vector::zeros(), Vector::z() * shape.a3),
            approach: Vector::x_axis(),
            freedom: std::f64::consts::PI,
            turning: false,
            inside: false,
            curvatures: [curvature; 2],
            rank: 1,
        });
    }
    rows
}

/// The rows of the cup's tables for a shape.
pub fn cup_rows(surface: &Surface, bands: &Bands) -> Vec<CupRow> {
    let shape = Shape::new(surface, bands);
    let mut rows = Vec::new();
    if shape.ring.is_none() && shape.profile.below {
        let towards =
            |half: f64| Profile::Vertex(Section { a: shape.a3, b: half, epsilon: shape.epsilon1 });
        let wide = shape.axes[0].max(shape.axes[1]);
        for normal in [Vector::z_axis(), -Vector::z_axis()] {
            rows.push(CupRow {
                table: "S1",
                contact: Point::from(normal.into_inner() * shape.a3),
                normal,
                sections: [towards(shape.narrowest()), towards(wide)],
                turning: false,
            });
        }
    }
    for line in shape.lines() {
        shape.cup_rows(&line, &mut rows);
    }
    rows
}

/// Which classes of rows hold for an exponent.
#[derive(Clone, Copy)]
struct Class {
    /// Rows of `ε <= 1`: contacts on the axes.
    below: bool,
    /// Rows of `ε = 1`, where alike axes leave the direction free.
    round: bool,
    /// Rows of `ε > 1`: contacts between the axes.
    above: bool,
    /// Normals are defined.
    smooth: bool,
}

impl Class {
    fn of(epsilon: f64, band: f64) -> Self {
        Self {
            below: epsilon <= 1.0 + band,
            round: (epsilon - 1.0).abs() <= band,
            above: epsilon > 1.0,
            smooth: epsilon < 2.0,
        }
    }
}

/// A horizontal line through the centre along which the cross-section is antipodal (step W of FORMULAS §8.3).
#[derive(Clone, Copy)]
struct Line {
    direction: Vector,
    /// Half width `a_w` of the solid, or of a toroid's tube, along it.
    half: f64,
    /// The same line in the first quadrant of the cross-section, for its curvature at another size.
    at: Along,
    turning: bool,
    rank: u8,
}

#[derive(Clone, Copy)]
enum Along {
    First,
    Second,
    Interior,
}

/// A shape's numbers as the tables name them.
struct Shape {
    axes: [f64; 2],
    a3: f64,
    /// `a4`, for a toroid.
    ring: Option<f64>,
    epsilon1: f64,
    epsilon2: f64,
    profile: Class,
    cross: Class,
    alike: bool,
    axes_band: f64,
}

impl Shape {
    fn new(surface: &Surface, bands: &Bands) -> Self {
        let [a1, a2, a3] = surface.semi_axes();
        let [epsilon1, epsilon2] = surface.exponents();
        Self {
            axes: [a1, a2],
            a3,
            ring: surface.ring_ratio(),
            epsilon1,
            epsilon2,
            profile: Class::of(epsilon1, bands.exponent),
            cross: Class::of(epsilon2, bands.exponent),
            alike: alike(a1, a2, bands.axes),
            axes_band: bands.axes,
        }
    }

    /// The cross-section, `scale` times as large.
    fn cross(&self, scale: f64) -> Section {
        Section { a: scale * self.axes[0], b: scale * self.axes[1], epsilon: self.epsilon2 }
    }

    /// The section through z along a line of half width `half`.
    fn upright(&self, half: f64) -> Section {
        Section { a: half, b: self.a3, epsilon: self.epsilon1 }
    }

    fn lines(&self) -> Vec<Line> {
        let mut out = Vec::new();
        if !self.cross.smooth || !self.profile.smooth {
            return out;
        }
        let [a1, a2] = self.axes;
        let narrow_is_y = a2 <= a1;
        if self.cross.below {
            let free = self.alike && self.cross.round;
            let mut vertex = |y: bool, rank: u8| {
                let (direction, half, at) = if y {
                    (Vector::y(), a2, Along::Second)
                } else {
                    (Vector::x(), a1, Along::First)
                };
                out.push(Line { direction, half, at, turning: free, rank });
            };
            vertex(narrow_is_y, 1);
            // where every direction is a row, one stands for all
            if !free {
                vertex(!narrow_is_y, if self.alike { 1 } else { 2 });
            }
        }
        if self.cross.above
            && let Some(corner) = self.cross(1.0).interior()
        {
            let half = corner.radius();
            for sign in [1.0, -1.0] {
                let direction = Vector::new(corner.point[0], sign * corner.point[1], 0.0) / half;
                out.push(Line { direction, half, at: Along::Interior, turning: false, rank: 1 });
            }
        }
        out
    }

    /// Least half width of the cross-section: on an axis, or between the axes.
    fn narrowest(&self) -> f64 {
        let corner = self.cross(1.0).interior().map_or(f64::INFINITY, |c| c.radius());
        self.axes[0].min(self.axes[1]).min(corner)
    }

    /// The cross-section's stationary point on a line where the section is `scale` times as large.
    fn on(&self, line: &Line, scale: f64) -> Option<Stationary> {
        let section = self.cross(scale);
        match line.at {
            Along::First => Some(section.first()),
            Along::Second => Some(section.second()),
            Along::Interior => section.interior(),
        }
    }

    fn horizontal(&self, line: &Line, scale: f64) -> Option<f64> {
        self.on(line, scale)?.curvature
    }

    /// P1, P2 and P4.
    fn solid_rows(&self, line: &Line, rows: &mut Vec<JawRow>) {
        let d = line.direction;
        let curvatures = [self.horizontal(line, 1.0), self.upright(line.half).first().curvature];
        let row = |table, arm: Vector, approach: Vector, curvatures| JawRow {
            table,
            contacts: pair(Vector::zeros(), arm),
            approach: Direction::new_unchecked(approach),
            freedom: std::f64::consts::FRAC_PI_4,
            turning: line.turning,
            inside: false,
            curvatures,
            rank: line.rank,
        };
        rows.push(row("P1", d * line.half, Vector::z().cross(&d), curvatures));
        rows.push(row("P2", d * line.half, -Vector::z(), curvatures));
        let oblique = |point: [f64; 2]| d * point[0] + Vector::z() * point[1];
        let p4 = |arm: Vector, curvature: Option<f64>| JawRow {
            freedom: std::f64::consts::FRAC_PI_2,
            ..row("P4", arm, Vector::z().cross(&d), [curvatures[0], curvature])
        };
        if self.profile.above
            && let Some(corner) = self.upright(line.half).interior()
        {
            for sign in [1.0, -1.0] {
                rows.push(p4(oblique([corner.point[0], sign * corner.point[1]]), corner.curvature));
            }
        }
        // a circle has no narrow place: some of its diameters stand for all
        if self.profile.round && alike(line.half, self.a3, self.axes_band) {
            for degrees in [-60.0f64, -30.0, 30.0, 60.0] {
                let (s, c) = degrees.to_radians().sin_cos();
                let point = [c * line.half, s * self.a3];
                rows.push(p4(oblique(point), Some(1.0 / line.half)));
            }
        }
    }

    /// T1 to T4c.
    fn ring_rows(&self, line: &Line, ring: f64, rows: &mut Vec<JawRow>) {
        let (d, half) = (line.direction, line.half);
        let up = Vector::z();
        let [outer, inner] = [half * (ring + 1.0), half * (ring - 1.0)];
        let equator = self.upright(half).first().curvature;
        let ridge = self.upright(half).second().curvature;
        let outside = [self.horizontal(line, ring + 1.0), equator];
        let hole = [self.horizontal(line, ring - 1.0).map(|k| -k), equator];
        let row = |table, contacts, approach: Vector, freedom, curvatures| JawRow {
            table,
            contacts,
            approach: Direction::new_unchecked(approach),
            freedom,
            turning: line.turning,
            inside: false,
            curvatures,
            rank: line.rank,
        };
        let quarter = std::f64::consts::FRAC_PI_4;
        rows.push(row("T1", pair(Vector::zeros(), d * outer), up.cross(&d), quarter, outside));
        rows.push(row("T2", pair(Vector::zeros(), d * outer), -up, quarter, outside));
        if ring > 1.0 {
            // the fingers press outwards: the solid's normals point at each other
            let facing =
                |sign: f64| (Point::from(d * (sign * inner)), Direction::new_unchecked(-d * sign));
            rows.push(JawRow {
                inside: true,
                ..row("T3", [facing(1.0), facing(-1.0)], -up, 0.0, hole)
            });
        }
        for side in [d, -d] {
            let middle = side * (ring * half);
            if ring > 1.0 {
                rows.push(row("T4a", pair(middle, side * half), -up, quarter, outside));
            }
            if self.profile.below {
                let curvatures = [Some(0.0), ridge];
                rows.push(row("T4b", pair(middle, up * self.a3), -side, quarter, curvatures));
            }
            if self.profile.above
                && let Some(corner) = self.upright(half).interior()
            {
                for sign in [1.0, -1.0] {
                    let arm = side * corner.point[0] + up * (sign * corner.point[1]);
                    let curvatures = [outside[0], corner.curvature];
                    let freedom = std::f64::consts::FRAC_PI_2;
                    rows.push(row("T4c", pair(middle, arm), up.cross(&side), freedom, curvatures));
                }
            }
        }
    }

    /// S2 and S3, T5 and T6.
    fn cup_rows(&self, line: &Line, rows: &mut Vec<CupRow>) {
        let (up, half) = (Vector::z(), line.half);
        let ring = self.ring.unwrap_or(0.0);
        for d in [line.direction, -line.direction] {
            let mut push = |table, contact: Vector, normal: Vector, sections| {
                if let Some(normal) = Direction::try_new(normal, 0.0) {
                    let contact = Point::from(contact);
                    rows.push(CupRow { table, contact, normal, sections, turning: line.turning });
                }
            };
            let outer = half * (ring + 1.0);
            let cross = self.around(line, ring + 1.0);
            if self.profile.below {
                let side = Section { a: half, b: self.a3, epsilon: self.epsilon1 };
                let table = if self.ring.is_some() { "T6" } else { "S2" };
                push(table, d * outer, d, [cross, Profile::Vertex(side)]);
                if self.ring.is_some() {
                    let top = Section { a: self.a3, b: half, epsilon: self.epsilon1 };
                    for up in [up, -up] {
                        let contact = d * (ring * half) + up * self.a3;
                        push("T5", contact, up, [Profile::Vertex(top), Profile::Straight]);
                    }
                }
            }
            if !self.profile.above {
                continue;
            }
            if self.ring.is_some() {
                // the flank at 45 degrees of the tube's parameter, above the sharp equator and under the ridge
                let flank = self.upright(half).middle();
                let tube = Profile::Curved(flank.curvature.unwrap_or(f64::INFINITY));
                let around = self.around(line, ring + flank.point[0] / half);
                for up in [up, -up] {
                    let contact = d * (ring * half + flank.point[0]) + up * flank.point[1];
                    push("T5", contact, d * self.a3 + up * half, [tube, around]);
                }
            } else if let Some(corner) = self.upright(half).interior() {
                for sign in [1.0, -1.0] {
                    let p = d * corner.point[0] + up * (sign * corner.point[1]);
                    let tube = Profile::Curved(corner.curvature.unwrap_or(f64::INFINITY));
                    push("S3", p, p, [tube, self.around(line, corner.point[0] / half)]);
                }
            }
        }
    }

    /// How the cross-section, `scale` times as large, falls away from a line: at least as much as the surface does
    /// that leans against it.
    fn around(&self, line: &Line, scale: f64) -> Profile {
        let Section { a, b, epsilon } = self.cross(scale);
        match line.at {
            Along::First => Profile::Vertex(Section { a, b, epsilon }),
            Along::Second => Profile::Vertex(Section { a: b, b: a, epsilon }),
            Along::Interior => {
                Profile::Curved(self.horizontal(line, scale).unwrap_or(f64::INFINITY))
            }
        }
    }
}

/// The points `middle ± arm` with their normals along the arm.
fn pair(middle: Vector, arm: Vector) -> [(Point, Direction); 2] {
    let along = Direction::new_normalize(arm);
    [(Point::from(middle + arm), along), (Point::from(middle - arm), -along)]
}

fn alike(a: f64, b: f64, band: f64) -> bool {
    a.max(b) <= (1.0 + band) * a.min(b)
}
