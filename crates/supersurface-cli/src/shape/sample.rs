//! `supersurface sample`: points on a shape, as a scanner might give them.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::json;
use supersurface::measure::first_hit;
use supersurface::mesh::{
    MeshSampler, Spacing, SurfaceSampler, superellipsoid_grid, supertoroid_grid,
};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Ray};
use supersurface::surface::Solid;
use supersurface::{Direction, Point, Vector};
use supersurface_io::{Model, check_points_file, write_points};

use super::args::{ShapeArgs, triple};
use super::meshed::{Fineness, meshed};
use crate::exit::{Failure, print};

/// Most points: 2 GB in memory.
const MOST: u64 = 10_000_000;
/// Cells along the longest side of what is marched.
const CELLS: usize = 128;

/// What to sample, how, and where to.
#[derive(Debug, Args)]
pub(crate) struct SampleArgs {
    #[command(flatten)]
    which: ShapeArgs,
    /// Where to: .pcd, .ply, .xyz, .txt or .csv. Lengths are metres.
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// How points are spread; all but `area` lie on a grid of a superellipsoid or supertoroid and need --distance.
    #[arg(long, value_enum, default_value_t = Spread::Area, requires_if("angle", "distance"), requires_if("pilu-fisher", "distance"), requires_if("equal-arc", "distance"))]
    spread: Spread,
    /// About how far apart points of a grid are, in metres.
    #[arg(long, value_name = "M")]
    distance: Option<f64>,
    /// Points that are drawn, uniform over the area; cuts leave fewer.
    #[arg(long, short = 'n', value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(1..=MOST))]
    count: u64,
    /// Which points are drawn.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Standard deviation in metres of noise in each coordinate. Normals stay those of the surface.
    #[arg(long, value_name = "M", default_value_t = 0.0)]
    noise: f64,
    /// Keep only points with NX x + NY y + NZ z <= D, before noise.
    #[arg(
        long,
        value_name = "NX,NY,NZ,D",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true
    )]
    cut: Option<Vec<f64>>,
    /// Keep only points that can be seen from here, not hidden by the shape itself.
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true
    )]
    seen_from: Option<Vec<f64>>,
    /// Write points alone.
    #[arg(long)]
    no_normals: bool,
    /// Print what was made as JSON.
    #[arg(long)]
    json: bool,
}

/// How points are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Spread {
    /// At random, uniform over the area.
    Area,
    /// By equal steps of the two angles.
    Angle,
    /// About evenly along section and meridians, by Pilu and Fisher's steps.
    PiluFisher,
    /// By equal arcs of section and meridians.
    EqualArc,
}

/// Draws and writes the points.
pub(crate) fn run(args: &SampleArgs) -> Result<(), Failure> {
    if !(args.noise >= 0.0 && args.noise.is_finite()) {
        let given = args.noise;
        return Err(Failure::usage(format!("--noise: {given} is negative or not finite")));
    }
    let cut = args.cut.as_deref().map(plane).transpose()?;
    let eye = match &args.seen_from {
        Some(v) => Some(Point::from(triple("--seen-from", v)?)),
        None => None,
    };
    args.which.is_not(&args.output)?;
    check_points_file(&args.output).map_err(Failure::output)?;
    let model = args.which.model()?;
    let spacing = match args.spread {
        Spread::Area => None,
        Spread::Angle => Some(Spacing::Angle),
        Spread::PiluFisher => Some(Spacing::PiluFisher),
        Spread::EqualArc => Some(Spacing::EqualArc),
    };
    let mut points = match spacing.zip(args.distance) {
        Some((spacing, distance)) => grid(&args.which.name(), &model, spacing, distance)?,
        None => drawn(&args.which.name(), &model, args.count, args.seed)?,
    };
    let all = points.len();
    if let Some((normal, offset)) = cut {
        points.retain(|(p, _)| normal.dot(&p.coords) <= offset);
    }
    if let Some(eye) = eye {
        let seen = visible(&model, &eye).ok_or_else(|| {
            Failure::usage("--seen-from: this type of shape does not say what hides what")
        })?;
        points.retain(|(p, n)| n.dot(&(eye - p)) > 0.0 && seen(p));
    }
    if points.is_empty() {
        return Err(Failure::nothing("no point is left: see --cut and --seen-from"));
    }
    for (i, (p, _)) in points.iter_mut().enumerate() {
        let mut stream = Stream::new(!args.seed, i as u64);
        *p += Vector::from_fn(|_, _| args.noise * stream.normal());
    }
    let kept = points.len();
    let (points, normals): (Vec<Point>, Vec<Direction>) = points.into_iter().unzip();
    let normals = if args.no_normals { &[][..] } else { &normals };
    write_points(&args.output, &points, normals).map_err(Failure::output)?;
    print(&match args.json {
        true => format!("{}\n", json!({"points": kept, "drawn": all})),
        false => format!("{}: {kept} of {all} points\n", args.output.display()),
    })
}

/// The normal and offset of a plane.
fn plane(numbers: &[f64]) -> Result<(Vector, f64), Failure> {
    let [x, y, z, d]: [f64; 4] = numbers
        .try_into()
        .map_err(|_| Failure::usage(format!("--cut: {} numbers, 4 needed", numbers.len())))?;
    let normal = Vector::new(x, y, z);
    match normal.norm() > 0.0 && normal.iter().all(|v| v.is_finite()) && !d.is_nan() {
        true => Ok((normal, d)),
        false => Err(Failure::usage("--cut: the normal must be finite and not zero")),
    }
}

/// Points with their normals, uniform over the area.
fn drawn(
    name: &str,
    model: &Model,
    count: u64,
    seed: u64,
) -> Result<Vec<(Point, Direction)>, Failure> {
    if let Model::Solid(solid) = model {
        let pose = solid.pose();
        let sampler = SurfaceSampler::new(solid.shape(), None)
            .map_err(|e| Failure::input(format!("{name}: {e}")))?;
        let points = sampler.points(count as usize, seed);
        let placed =
            points.into_iter().map(|s| (pose * s.point, pose * facing(&s.point, s.normal)));
        return Ok(placed.collect());
    }
    let mesh = meshed(name, model, Fineness { tolerance: None, cells: CELLS })?.mesh;
    let sampler = MeshSampler::new(mesh);
    let draw = |i: u64| {
        let mut stream = Stream::new(seed, i);
        sampler.sample_at(std::array::from_fn(|_| stream.uniform()))
    };
    Ok((0..count).filter_map(draw).collect())
}

/// A grid of points with their normals.
fn grid(
    name: &str,
    model: &Model,
    spacing: Spacing,
    distance: f64,
) -> Result<Vec<(Point, Direction)>, Failure> {
    let wrong = || {
        Failure::usage(format!(
            "{name}: only superellipsoids and supertoroids, not deformed, have such grids"
        ))
    };
    let Model::Solid(solid) = model else { return Err(wrong()) };
    let points = match solid.shape() {
        Solid::Superellipsoid(s) => superellipsoid_grid(s, spacing, distance),
        Solid::Supertoroid(s) => supertoroid_grid(s, spacing, distance),
        _ => return Err(wrong()),
    };
    let pose = solid.pose();
    let placed = |p: Point| {
        let normal = Direction::try_new(solid.shape().gradient(&p), 0.0);
        (pose * p, pose * facing(&p, normal))
    };
    Ok(points.map_err(Failure::usage)?.into_iter().map(placed).collect())
}

/// The normal; on a cusp, which has none, away from the centre.
fn facing(p: &Point, normal: Option<Direction>) -> Direction {
    normal.or(Direction::try_new(p.coords, 0.0)).unwrap_or(Vector::z_axis())
}

type Sight<'a> = Box<dyn Fn(&Point) -> bool + 'a>;

/// Whether nothing of the model is between a point of it and the eye.
fn visible<'a>(model: &'a Model, eye: &'a Point) -> Option<Sight<'a>> {
    let free = move |solid: &'a (dyn Implicit + 'a)| {
        let seen = move |p: &Point| {
            let Some(way) = Direction::try_new(p - eye, 0.0) else { return false };
            let far = (p - eye).norm();
            let hit = first_hit(solid, &Ray { origin: *eye, direction: way }, far);
            hit.is_none_or(|h| h.distance >= far * (1.0 - 1e-6))
        };
        Box::new(seen) as Sight<'a>
    };
    match model {
        Model::Solid(s) => Some(free(s)),
        Model::Implicit(_, s) => Some(free(s)),
        Model::Combined(s) => Some(free(s)),
        _ => None,
    }
}
