//! `supersurface fit`: one surface for each cloud of one object.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use cpu_time::ThreadTime;
use supersurface::Point;
use supersurface::cloud::PointCloud;
use supersurface::fit::{Fit, FitError, FitOptions, View, fit};
use supersurface::shape::Plane;
use supersurface_io::{FitHead, ReadOptions, fit_json, shown_name, write_text};

use crate::args::{Model, Units};
use crate::exit::{Failure, print};
use crate::input::{units, viewpoint};
use crate::threads::{self, MOST};

/// Which clouds, and what is known of them.
#[derive(Debug, Args)]
pub(crate) struct FitArgs {
    /// Clouds of one object each (.pcd, .ply, .xyz, .csv); - reads standard input.
    #[arg(required = true, value_name = "CLOUD")]
    clouds: Vec<PathBuf>,
    /// Write the JSON here: a file, or for several clouds a folder, in which each gets NAME.json.
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Family of surfaces.
    #[arg(long, value_enum, default_value_t = Model::Auto)]
    model: Model,
    /// The cloud is one view from this place (in the cloud's frame and unit); without it the object was seen from all
    /// around.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    viewpoint: Option<String>,
    /// The plane on which the object stands: A,B,C,D of Ax + By + Cz + D = 0 in the cloud's frame and unit, (A, B, C)
    /// towards the object.
    #[arg(
        long,
        value_name = "A,B,C,D",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true
    )]
    plane: Option<Vec<f64>>,
    /// Unit of the clouds' coordinates.
    #[arg(long, value_enum, default_value_t = Units::M)]
    units: Units,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
    /// Number of threads for several clouds; results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST)))]
    threads: Option<u16>,
}

/// What is known of the clouds, in metres.
struct Known {
    viewpoint: Option<Point>,
    support: Option<Plane>,
    options: FitOptions,
}

/// One cloud's fit.
struct Fitted {
    name: String,
    points: usize,
    result: Result<Fit, FitError>,
    cpu_seconds: f64,
    seconds: f64,
    warnings: Vec<String>,
}

impl Fitted {
    fn json(&self) -> String {
        let head = FitHead {
            source: &self.name,
            points: self.points,
            cpu_seconds: self.cpu_seconds,
            seconds: self.seconds,
            warnings: &self.warnings,
        };
        fit_json(self.result.as_ref(), &head) + "\n"
    }
}

/// Fits all clouds; one that fails keeps no other from being fitted.
pub(crate) fn run(args: &FitArgs) -> Result<(), Failure> {
    let known = known(args)?;
    let several = args.clouds.len() > 1;
    if let (true, Some(folder)) = (several, &args.output) {
        std::fs::create_dir_all(folder)
            .map_err(|e| Failure::output(format!("{}: {e}", folder.display())))?;
    }
    let (pool, fewer) = threads::pool(args.threads)?;
    if let Some(warning) = fewer {
        eprintln_once(&warning);
    }
    let one = |cloud: &PathBuf| -> Result<String, Failure> {
        let fitted = fitted(cloud, args, &known)?;
        let json = fitted.json();
        if let Some(out) = &args.output {
            let file = if several { out.join(file_name(cloud)) } else { out.clone() };
            write_text(&file, &json).map_err(Failure::output)?;
        }
        for warning in &fitted.warnings {
            eprintln_once(&format!("{}: {warning}", fitted.name));
        }
        if let Err(error) = &fitted.result {
            if args.json {
                print(&json)?;
            }
            return Err(Failure::nothing(format!("{}: {error}", fitted.name)));
        }
        Ok(match (args.json, args.output.is_some()) {
            (true, _) => json,
            (false, true) => String::new(),
            (false, false) => as_text(&fitted),
        })
    };
    let results: Vec<Result<String, Failure>> = pool.install(|| {
        use rayon::prelude::*;
        args.clouds.par_iter().map(one).collect()
    });
    let mut failures = Vec::new();
    for result in results {
        match result {
            Ok(text) => failures.extend(print(&text).err()),
            Err(failure) => failures.push(failure),
        }
    }
    let mut failures = failures.into_iter();
    failures.next().map_or(Ok(()), |first| Err(first.and(failures)))
}

fn known(args: &FitArgs) -> Result<Known, Failure> {
    let metres = args.units.metres();
    let seen_from = args.viewpoint.as_deref().map(viewpoint).transpose()?.flatten();
    let support = match args.plane.as_deref() {
        None => None,
        Some([a, b, c, d]) => {
            let plane = Plane::new(supersurface::Vector::new(*a, *b, *c), d * metres);
            Some(plane.map_err(|e| Failure::usage(format!("--plane: {e}")))?)
        }
        Some(_) => return Err(Failure::usage("--plane needs the four numbers A,B,C,D")),
    };
    let options = args.model.family().map_or_else(FitOptions::default, FitOptions::only);
    Ok(Known { viewpoint: seen_from.map(|p| p * metres), support, options })
}

fn fitted(file: &Path, args: &FitArgs, known: &Known) -> Result<Fitted, Failure> {
    let read = supersurface_io::read(file, &ReadOptions::default()).map_err(Failure::input)?;
    let mut warnings = read.warnings;
    let cloud: PointCloud = match args.units.metres() {
        1.0 => read.cloud,
        factor => read.cloud.scaled(factor),
    };
    warnings.extend(units(&cloud, args.units));
    let view = View {
        viewpoint: known.viewpoint,
        support: known.support,
        standing: known.support.is_some(),
        ..View::all_around(&cloud.points)
    };
    let (cpu, clock) = (ThreadTime::now(), Instant::now());
    let result = fit(&view, &known.options);
    Ok(Fitted {
        name: shown_name(file),
        points: cloud.points.len(),
        result,
        cpu_seconds: cpu.elapsed().as_secs_f64(),
        seconds: clock.elapsed().as_secs_f64(),
        warnings,
    })
}

/// `NAME.json` of a cloud's file.
fn file_name(cloud: &Path) -> PathBuf {
    let stem = cloud.file_stem().unwrap_or("standard_input".as_ref());
    Path::new(stem).with_added_extension("json")
}

fn eprintln_once(text: &str) {
    use std::io::Write;
    // where standard error is closed nobody reads it
    let _ = writeln!(std::io::stderr().lock(), "warning: {text}");
}

fn as_text(fitted: &Fitted) -> String {
    let mut out = String::new();
    let Ok(fit) = &fitted.result else { return out };
    let shape = fit.surface.shape();
    let mm = |v: f64| format!("{:.2}", 1e3 * v);
    let all = |v: &[f64]| v.iter().map(|v| mm(*v)).collect::<Vec<_>>().join(", ");
    let mut line = |what: &str, value: String| {
        // writing to a string does not fail
        let _ = writeln!(out, "  {what:<18} {value}");
    };
    line("family", format!("{} (margin {:.1} nats)", fit.family.name(), fit.margin));
    line("semi-axes", format!("{} mm", all(&shape.semi_axes())));
    if let Some(ratio) = shape.ring_ratio() {
        line("ring ratio", format!("{ratio:.3}"));
    }
    let [e1, e2] = shape.exponents();
    line("exponents", format!("{e1:.3}, {e2:.3}"));
    if let Some(taper) = shape.taper() {
        let [x, y] = taper.slopes();
        line("taper", format!("{x:.3}, {y:.3}"));
    }
    if let Some(twist) = shape.twist() {
        line("twist", format!("{:.3} turns", twist.turns()));
    }
    if let Some(bend) = shape.bend() {
        line(
            "bend",
            format!("{:.3} 1/m towards {:.1}°", bend.curvature(), bend.angle().to_degrees()),
        );
    }
    let pose = fit.surface.pose();
    line("position", format!("{} mm", all(pose.translation.vector.as_slice())));
    let q = pose.rotation;
    line("orientation wxyz", format!("{:.4}, {:.4}, {:.4}, {:.4}", q.w, q.i, q.j, q.k));
    line("residual", format!("{} mm (median)", mm(fit.residual)));
    line("noise", format!("{} mm", mm(fit.noise)));
    line("belonging", format!("{:.1} % of {} points", 100.0 * fit.inlier_share(), fitted.points));
    format!("{}\n{out}", fitted.name)
}
