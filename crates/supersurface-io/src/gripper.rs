//! Grippers as TOML, three of them built in.

use std::path::Path;

use serde::Deserialize;
use supersurface::grasp::{Boxed, Cup, Gripper, InvalidGripper, Jaw, Kind};
use supersurface::nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use supersurface::{Point, Pose, Vector};

use crate::error::{Fault, ReadError};
use crate::read::load;

/// Names of the grippers that need no file, with their content.
pub const BUILT_IN_GRIPPERS: [(&str, &str); 3] = [
    ("panda_hand", include_str!("../grippers/panda_hand.toml")),
    ("robotiq_2f85", include_str!("../grippers/robotiq_2f85.toml")),
    ("suction_cup_30", include_str!("../grippers/suction_cup_30.toml")),
];

/// A gripper by the name of a built-in one or from a file.
///
/// ```
/// let hand = supersurface_io::read_gripper("panda_hand")?;
/// assert_eq!(hand.name, "panda_hand");
/// # Ok::<(), supersurface_io::ReadError>(())
/// ```
pub fn read_gripper(name_or_file: &str) -> Result<Gripper, ReadError> {
    if let Some((name, text)) = BUILT_IN_GRIPPERS.iter().find(|(name, _)| *name == name_or_file) {
        return parse(name, text);
    }
    let path = Path::new(name_or_file);
    if !path.exists() {
        let known: Vec<&str> = BUILT_IN_GRIPPERS.iter().map(|(name, _)| *name).collect();
        let problem = format!("no such file, nor one of the built-in {}", known.join(", "));
        let fault = Fault::new("name", problem);
        return Err(ReadError::malformed(name_or_file, "gripper", fault));
    }
    let bytes = load(path)?;
    let text = String::from_utf8(bytes).map_err(|_| {
        ReadError::malformed(
            name_or_file,
            "gripper TOML",
            Fault::new("content", "is no text (UTF-8)"),
        )
    })?;
    parse(name_or_file, &text)
}

fn parse(file: &str, text: &str) -> Result<Gripper, ReadError> {
    let fault = |place: String, problem: String| {
        ReadError::malformed(file, "gripper TOML", Fault::new(place, problem))
    };
    let read: File = toml::from_str(text).map_err(|e| {
        let line = e.span().map_or(1, |s| text[..s.start.min(text.len())].lines().count().max(1));
        fault(format!("line {line}"), e.message().to_owned())
    })?;
    read.gripper().map_err(|e| fault(e.what.to_owned(), e.to_string()))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: String,
    version: u32,
    name: String,
    kind: String,
    frame: Frame,
    jaw: Option<JawTable>,
    cup: Option<CupTable>,
    #[serde(default)]
    finger: Vec<BoxTable>,
    #[serde(default)]
    body: Vec<BoxTable>,
    motion: Motion,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Frame {
    approach_axis: Option<String>,
    closing_axis: Option<String>,
    #[serde(default)]
    mount_frame: String,
    #[serde(rename = "T_tcp_mount")]
    mount: [[f64; 4]; 4],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JawTable {
    max_opening: f64,
    min_opening: f64,
    clearance: f64,
    pad_length: f64,
    pad_width: f64,
    finger_thickness: f64,
    tip_beyond_tcp: f64,
    finger_depth: f64,
    force: f64,
    mu: f64,
    torsion_mu: f64,
    #[serde(default)]
    tip_arc: Vec<[f64; 2]>,
    #[serde(default)]
    inside: bool,
    outer_width_closed: Option<f64>,
    outside_mu: Option<f64>,
    /// Known, and of no influence on grasps.
    #[serde(rename = "max_force")]
    _max_force: Option<f64>,
    #[serde(rename = "speed")]
    _speed: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CupTable {
    lip_radius: f64,
    inner_radius: f64,
    height: f64,
    stroke: f64,
    lip_tolerance: f64,
    max_tilt_deg: f64,
    min_curvature_radius: f64,
    vacuum: f64,
    mu: f64,
    /// Known, and of no influence on grasps.
    #[serde(rename = "spring_strain_max")]
    _spring_strain_max: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BoxTable {
    center: [f64; 3],
    size: [f64; 3],
    #[serde(default)]
    pad: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Motion {
    approach_distance: f64,
    lift_distance: f64,
}

/// The ranges that every length, force and coefficient must keep.
const POSITIVE: &str = "positive and finite";
const NOT_NEGATIVE: &str = "zero or positive, and finite";
/// The tool frame is fixed: a file may name its axes, not choose them.
const AXES: &str = "that of the tool frame (approach_axis +z, closing_axis +x): \
                    turn the boxes and T_tcp_mount into it";

impl File {
    fn gripper(&self) -> Result<Gripper, InvalidGripper> {
        self.check(
            self.format == "grasp-gripper",
            "format",
            format!("{:?}", self.format),
            "\"grasp-gripper\"",
        )?;
        self.check(self.version == 1, "version", f64::from(self.version), "1")?;
        let printable = |c: char| !c.is_control();
        let fair =
            (1..=64).contains(&self.name.chars().count()) && self.name.chars().all(printable);
        self.check(
            fair,
            "name",
            format!("{:?}", self.name),
            "1 to 64 characters without controls",
        )?;
        let (approach, closing) = (&self.frame.approach_axis, &self.frame.closing_axis);
        for (what, said, is) in [("approach_axis", approach, "+z"), ("closing_axis", closing, "+x")]
        {
            let said = said.as_deref().unwrap_or(is);
            self.check(said == is, what, format!("{said:?}"), AXES)?;
        }
        let kind = match (self.kind.as_str(), &self.jaw, &self.cup) {
            ("parallel", Some(jaw), None) => Kind::Jaw(self.jaw(jaw)?),
            ("suction", None, Some(cup)) if self.finger.is_empty() => Kind::Suction(self.cup(cup)?),
            _ => {
                let range = "\"parallel\" with a [jaw] and no [cup], or \"suction\" with a [cup] and no \
                             [jaw] or [[finger]]";
                return Err(self.error("kind", format!("{:?}", self.kind), range));
            }
        };
        self.positive("approach_distance", self.motion.approach_distance)?;
        self.positive("lift_distance", self.motion.lift_distance)?;
        Ok(Gripper {
            name: self.name.clone(),
            kind,
            body: self.boxes(&self.body, "body")?,
            mount: self.mount()?,
            mount_frame: self.frame.mount_frame.clone(),
            approach_distance: self.motion.approach_distance,
            lift_distance: self.motion.lift_distance,
        })
    }

    fn jaw(&self, t: &JawTable) -> Result<Jaw, InvalidGripper> {
        for (what, value) in [
            ("max_opening", t.max_opening),
            ("pad_length", t.pad_length),
            ("pad_width", t.pad_width),
            ("finger_thickness", t.finger_thickness),
            ("finger_depth", t.finger_depth),
            ("force", t.force),
            ("mu", t.mu),
        ] {
            self.positive(what, value)?;
        }
        for (what, value) in [
            ("min_opening", t.min_opening),
            ("clearance", t.clearance),
            ("torsion_mu", t.torsion_mu),
            ("tip_beyond_tcp", t.tip_beyond_tcp),
        ] {
            self.check(value >= 0.0 && value.is_finite(), what, value, NOT_NEGATIVE)?;
        }
        let below = t.min_opening < t.max_opening;
        self.check(below, "min_opening", t.min_opening, "less than max_opening")?;
        let below = t.clearance < t.max_opening;
        self.check(below, "clearance", t.clearance, "less than max_opening, in metres")?;
        let rising = t.tip_arc.windows(2).all(|w| w[0][0] < w[1][0]);
        let finite = t.tip_arc.iter().flatten().all(|v| v.is_finite());
        self.check(
            rising && finite,
            "tip_arc",
            "not rising",
            "[opening, dz] pairs in rising order",
        )?;
        let finger = self.boxes(&self.finger, "finger")?;
        self.check(!finger.is_empty(), "finger", 0.0, "at least one box")?;
        let outer_width_closed = match (t.inside, t.outer_width_closed) {
            (false, _) => None,
            (true, Some(width)) => {
                self.positive("outer_width_closed", width)?;
                Some(width)
            }
            (true, None) => {
                return Err(self.error(
                    "outer_width_closed",
                    "missing",
                    "given where inside = true",
                ));
            }
        };
        let outside_mu = t.outside_mu.unwrap_or(t.mu);
        self.positive("outside_mu", outside_mu)?;
        Ok(Jaw {
            max_opening: t.max_opening,
            min_opening: t.min_opening,
            clearance: t.clearance,
            pad_length: t.pad_length,
            pad_width: t.pad_width,
            finger_thickness: t.finger_thickness,
            tip_beyond_tcp: t.tip_beyond_tcp,
            finger_depth: t.finger_depth,
            force: t.force,
            mu: t.mu,
            torsion_mu: t.torsion_mu,
            tip_arc: t.tip_arc.clone(),
            outer_width_closed,
            outside_mu,
            finger,
        })
    }

    fn cup(&self, t: &CupTable) -> Result<Cup, InvalidGripper> {
        for (what, value) in [
            ("lip_radius", t.lip_radius),
            ("inner_radius", t.inner_radius),
            ("height", t.height),
            ("stroke", t.stroke),
            ("lip_tolerance", t.lip_tolerance),
            ("max_tilt_deg", t.max_tilt_deg),
            ("min_curvature_radius", t.min_curvature_radius),
            ("vacuum", t.vacuum),
            ("mu", t.mu),
        ] {
            self.positive(what, value)?;
        }
        let within = t.inner_radius <= t.lip_radius;
        self.check(within, "inner_radius", t.inner_radius, "at most lip_radius")?;
        Ok(Cup {
            lip_radius: t.lip_radius,
            inner_radius: t.inner_radius,
            height: t.height,
            stroke: t.stroke,
            lip_tolerance: t.lip_tolerance,
            max_tilt: t.max_tilt_deg.to_radians(),
            min_curvature_radius: t.min_curvature_radius,
            vacuum: t.vacuum,
            mu: t.mu,
        })
    }

    fn boxes(&self, tables: &[BoxTable], what: &'static str) -> Result<Vec<Boxed>, InvalidGripper> {
        for table in tables {
            for value in table.size {
                self.positive(what, value)?;
            }
            for value in table.center {
                self.check(value.is_finite(), what, value, "finite")?;
            }
        }
        let boxed = |t: &BoxTable| Boxed {
            center: Point::from(t.center),
            size: Vector::from(t.size),
            pad: t.pad,
        };
        Ok(tables.iter().map(boxed).collect())
    }

    fn mount(&self) -> Result<Pose, InvalidGripper> {
        let m = &self.frame.mount;
        let rotation = Matrix3::from_fn(|i, j| m[i][j]);
        let rigid = (rotation.transpose() * rotation - Matrix3::identity()).amax() < 1e-6
            && rotation.determinant() > 0.0
            && m[3] == [0.0, 0.0, 0.0, 1.0]
            && (0..3).all(|i| m[i][3].is_finite());
        self.check(rigid, "T_tcp_mount", "not rigid", "a rigid pose, row by row")?;
        let turn =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        Ok(Pose::from_parts(Vector::new(m[0][3], m[1][3], m[2][3]).into(), turn))
    }

    fn positive(&self, what: &'static str, value: f64) -> Result<(), InvalidGripper> {
        self.check(value > 0.0 && value.is_finite(), what, value, POSITIVE)
    }

    fn check(
        &self,
        ok: bool,
        what: &'static str,
        value: impl ToString,
        range: &'static str,
    ) -> Result<(), InvalidGripper> {
        if ok { Ok(()) } else { Err(self.error(what, value, range)) }
    }

    fn error(
        &self,
        what: &'static str,
        value: impl ToString,
        range: &'static str,
    ) -> InvalidGripper {
        InvalidGripper { name: self.name.clone(), what, value: value.to_string(), range }
    }
}
