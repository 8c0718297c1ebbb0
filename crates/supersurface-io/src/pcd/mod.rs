//! PCD 0.5 to 0.7: ascii, binary and binary_compressed.

mod ascii;
mod binary;
mod header;
mod lzf;

use supersurface::cloud::PointCloud;
use supersurface::nalgebra::{Quaternion, UnitQuaternion};
use supersurface::{Point, Pose, Vector};

use crate::bytes::room;
use crate::error::Fault;
use crate::read::{Read, ReadOptions, label, no_field};
use header::{Encoding, Header};

pub(crate) fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Read, Fault> {
    let (header, body) = Header::parse(bytes)?;
    let wanted = Wanted::of(&header, options)?;
    let mut warnings = Vec::new();
    let mut rows = Rows::new(&header, &wanted, body.len())?;
    match header.encoding {
        Encoding::Ascii => ascii::read(&header, body, &wanted, &mut rows, &mut warnings)?,
        Encoding::Binary => binary::read(&header, body, &wanted, &mut rows)?,
        Encoding::Compressed => binary::read_compressed(&header, body, &wanted, &mut rows)?,
    }
    let world = world(&header.viewpoint);
    if world.is_none() {
        warnings.push("VIEWPOINT is no pose (a length of its quaternion is 0, or a number not finite): not used".into());
    }
    let world = world.filter(|pose| *pose != Pose::identity());
    let organised = header.height > 1 && header.width > 1;
    let cloud = PointCloud {
        points: rows.points,
        colours: rows.colours,
        labels: rows.labels,
        grid: organised.then_some([header.width, header.height]),
        world,
        ..PointCloud::default()
    };
    Ok(Read { cloud, warnings })
}

/// Which of the header's fields are read.
struct Wanted {
    position: [usize; 3],
    colour: Option<usize>,
    label: Option<usize>,
}

impl Wanted {
    fn of(header: &Header, options: &ReadOptions) -> Result<Self, Fault> {
        let find = |name: &str| header.fields.iter().position(|f| f.name == name);
        let need = |name: &str| {
            find(name).ok_or_else(|| {
                Fault::new("FIELDS", format!("no field {name}: x, y and z (xyz) are needed"))
            })
        };
        let label = options.instances.as_deref().map(|wanted| {
            let known = header.fields.iter().map(|f| f.name.as_str());
            find(wanted).ok_or_else(|| no_field(wanted, known))
        });
        Ok(Self {
            position: [need("x")?, need("y")?, need("z")?],
            colour: find("rgb").or_else(|| find("rgba")),
            label: label.transpose()?,
        })
    }
}

/// What is read, a row a point.
struct Rows {
    points: Vec<Point>,
    colours: Vec<[u8; 3]>,
    labels: Vec<u32>,
}

impl Rows {
    /// Room for what the header promises, as far as the body can hold it.
    fn new(header: &Header, wanted: &Wanted, available: usize) -> Result<Self, Fault> {
        let count = header.points.min(available.saturating_mul(100));
        let short = || {
            let problem =
                format!("{} points do not fit into memory: thin the cloud out", header.points);
            Fault::new("POINTS", problem)
        };
        let some = |wanted: bool| if wanted { count } else { 0 };
        Ok(Self {
            points: room(count.min(1 << 22)).ok_or_else(short)?,
            colours: room(some(wanted.colour.is_some()).min(1 << 22)).ok_or_else(short)?,
            labels: room(some(wanted.label.is_some()).min(1 << 22)).ok_or_else(short)?,
        })
    }

    fn push(&mut self, position: [f64; 3], colour: Option<u32>, instance: Option<f64>) {
        self.points.push(Point::from(position));
        if let Some(bits) = colour {
            let [_, r, g, b] = bits.to_be_bytes();
            self.colours.push([r, g, b]);
        }
        if let Some(value) = instance {
            self.labels.push(label(value));
        }
    }
}

/// The pose that VIEWPOINT gives; `None` for what is no pose.
fn world(viewpoint: &[f64; 7]) -> Option<Pose> {
    let [x, y, z, qw, qx, qy, qz] = *viewpoint;
    let q = UnitQuaternion::try_new(Quaternion::new(qw, qx, qy, qz), 1e-6)?;
    let pose = Pose::from_parts(Vector::new(x, y, z).into(), q);
    let finite = viewpoint.iter().all(|v| v.is_finite());
    finite.then_some(pose)
}
