//! From the command line to a cloud: file, camera, units, frame, viewpoint, given objects.

use std::path::{Path, PathBuf};

use supersurface::cloud::{PointCloud, UnitHint, unit_hint};
use supersurface::nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion};
use supersurface::pipeline::Objects;
use supersurface::{Point, Pose, Vector};
use supersurface_io::{DepthCamera, Read, ReadOptions, read_camera, read_mask};

use crate::args::{InputArgs, Units};
use crate::exit::Failure;
use crate::outputs::Source;

impl InputArgs {
    /// The files that are read.
    pub(crate) fn files(&self) -> Vec<&Path> {
        let given = [Some(&self.input), self.camera.as_ref(), self.mask.as_ref()];
        given.into_iter().flatten().map(PathBuf::as_path).collect()
    }
}

/// Reads the input and puts it into metres and the frame that was asked for.
pub(crate) fn read(args: &InputArgs) -> Result<Source, Failure> {
    let options = ReadOptions { instances: args.instances.clone(), camera: camera(args)? };
    let Read { mut cloud, mut warnings, .. } =
        supersurface_io::read(&args.input, &options).map_err(Failure::input)?;
    let name = supersurface_io::shown_name(&args.input);
    if let Some(mask) = &args.mask {
        cloud.labels = read_mask(mask, cloud.grid).map_err(Failure::input)?;
    }
    let factor = args.units.metres();
    if factor != 1.0 {
        cloud = cloud.scaled(factor);
    }
    if let Some(text) = &args.viewpoint {
        cloud.viewpoint = viewpoint(text)?;
    } else if args.segmented && cloud.viewpoint.is_some_and(|eye| surrounds(&cloud, &eye)) {
        cloud.viewpoint = None;
        warnings.push(
            "the frame's origin lies within the object, so no sensor stood there: it is taken as seen from all \
             around; say --viewpoint X,Y,Z where it was not"
                .to_owned(),
        );
    }
    // after the viewpoint, as the distance from the sensor tells the unit too
    warnings.extend(units(&cloud, args.units));
    let mut frame = "cloud";
    if let Some(numbers) = &args.camera_pose {
        cloud = cloud.moved(&pose("--camera-pose", numbers)?);
        frame = "robot";
    }
    let objects = if args.segmented {
        Objects::Whole
    } else if args.instances.is_some() || args.mask.is_some() {
        Objects::Given
    } else {
        Objects::Find
    };
    check(&name, &cloud)?;
    Ok(Source { cloud, frame, warnings, objects })
}

/// What to say of a cloud whose size is unlikely in metres.
pub(crate) fn units(cloud: &PointCloud, said: Units) -> Option<String> {
    let hint = unit_hint(cloud)?;
    Some(match (said, hint) {
        (Units::M, UnitHint::Centimetres) => {
            "this looks like centimetres: pass --units cm (or --units mm for a small part)"
                .to_owned()
        }
        (Units::M, _) => format!("this looks like {hint}: pass --units {}", hint.sign()),
        _ => "the scene is of an unlikely size: check --units".to_owned(),
    })
}

/// Whether a place lies within the box of a cloud.
pub(crate) fn surrounds(cloud: &PointCloud, place: &Point) -> bool {
    let finite = cloud.points.iter().filter(|p| p.coords.iter().all(|v| v.is_finite()));
    let bounds = finite.fold(None, |b: Option<(Point, Point)>, p| {
        Some(b.map_or((*p, *p), |(low, high)| (low.inf(p), high.sup(p))))
    });
    bounds.is_some_and(|(low, high)| (0..3).all(|k| low[k] < place[k] && place[k] < high[k]))
}

fn check(name: &str, cloud: &PointCloud) -> Result<(), Failure> {
    if cloud.points.is_empty() {
        return Err(Failure::input(format!(
            "{name}: the cloud is empty: there are no points in it"
        )));
    }
    Ok(())
}

fn camera(args: &InputArgs) -> Result<Option<DepthCamera>, Failure> {
    if let Some(file) = &args.camera {
        let mut camera = read_camera(file).map_err(Failure::input)?;
        if let Some(scale) = args.depth_scale {
            camera.depth_scale = scale;
        }
        return Ok(Some(camera));
    }
    let Some(numbers) = &args.intrinsics else {
        return match args.depth_scale {
            Some(_) => Err(Failure::usage("--depth-scale needs --camera or --intrinsics")),
            None => Ok(None),
        };
    };
    let [fx, fy, cx, cy] = numbers[..] else {
        let problem =
            format!("--intrinsics needs FX,FY,CX,CY; {} numbers were given", numbers.len());
        return Err(Failure::usage(problem));
    };
    let Some(depth_scale) = args.depth_scale else {
        return Err(Failure::usage("--intrinsics needs --depth-scale (1000 for millimetres)"));
    };
    let mut distortion = [0.0; 8];
    let given = args.distortion.as_deref().unwrap_or_default();
    if given.len() > distortion.len() || given.iter().any(|v| !v.is_finite()) {
        return Err(Failure::usage("--distortion needs at most 8 finite numbers"));
    }
    for (to, from) in distortion.iter_mut().zip(given) {
        *to = *from;
    }
    let (focal, centre) = ([fx, fy], [cx, cy]);
    Ok(Some(DepthCamera { size: None, focal, centre, distortion, depth_scale }))
}

/// A place, or `None` for "none".
pub(crate) fn viewpoint(text: &str) -> Result<Option<Point>, Failure> {
    if text == "none" {
        return Ok(None);
    }
    let numbers: Option<Vec<f64>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([x, y, z]) if [x, y, z].iter().all(|v| v.is_finite()) => {
            Ok(Some(Point::new(*x, *y, *z)))
        }
        _ => Err(Failure::usage(format!("--viewpoint {text:?}: X,Y,Z, or none"))),
    }
}

/// A pose from X,Y,Z,QW,QX,QY,QZ or from the 16 numbers of a matrix, row by row.
pub(crate) fn pose(option: &str, numbers: &[f64]) -> Result<Pose, Failure> {
    let wrong = |problem: String| Failure::usage(format!("{option}: {problem}"));
    if !numbers.iter().all(|v| v.is_finite()) {
        return Err(wrong("a number is not finite".into()));
    }
    let (translation, rotation) = match numbers {
        [x, y, z, qw, qx, qy, qz] => {
            let q = Quaternion::new(*qw, *qx, *qy, *qz);
            if (q.norm() - 1.0).abs() > 1e-3 {
                return Err(wrong(format!("the quaternion's length is {:.4}, not 1", q.norm())));
            }
            (Vector::new(*x, *y, *z), UnitQuaternion::from_quaternion(q))
        }
        m if m.len() == 16 => {
            let r = Matrix3::from_fn(|i, j| m[4 * i + j]);
            let skew = (r.transpose() * r - Matrix3::identity()).amax();
            if skew > 1e-3 || r.determinant() < 0.0 || m[12..] != [0.0, 0.0, 0.0, 1.0] {
                return Err(wrong(
                    "the matrix is no rigid pose (rows of rotation and translation)".into(),
                ));
            }
            // without a limit the search may go on for ever
            let turn = Rotation3::from_matrix_eps(&r, f64::EPSILON, 100, Rotation3::identity());
            let turn = UnitQuaternion::from_rotation_matrix(&turn);
            (Vector::new(m[3], m[7], m[11]), turn)
        }
        _ => return Err(wrong(format!("{} numbers: 7 or 16 are needed", numbers.len()))),
    };
    Ok(Pose::from_parts(translation.into(), rotation))
}
