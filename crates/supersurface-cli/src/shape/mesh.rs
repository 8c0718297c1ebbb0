//! `supersurface mesh`: a watertight triangle mesh of a shape.

use std::path::PathBuf;

use clap::Args;
use supersurface::mesh::Mesh;
use supersurface_io::write_mesh;

use super::args::ShapeArgs;
use super::meshed::{Fineness, meshed};
use crate::exit::{Failure, print};

/// What to mesh, how finely, and where to.
#[derive(Debug, Args)]
pub(crate) struct MeshArgs {
    #[command(flatten)]
    which: ShapeArgs,
    /// Where to: .obj, .ply or .stl (binary). Lengths are metres.
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Largest distance between mesh and surface in metres. The default keeps the volume to 0.1 %.
    #[arg(long, value_name = "M")]
    tolerance: Option<f64>,
    /// Cells along the longest side, for shapes with an implicit form alone.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(2..=500))]
    cells: u32,
    /// Print what was made as JSON.
    #[arg(long)]
    json: bool,
}

/// Makes and writes the mesh.
pub(crate) fn run(args: &MeshArgs) -> Result<(), Failure> {
    args.which.is_not(&args.output)?;
    let fine = Fineness { tolerance: args.tolerance, cells: args.cells as usize };
    let made = meshed(&args.which.name(), &args.which.model()?, fine)?;
    write_mesh(&args.output, &made.mesh).map_err(Failure::output)?;
    let file = args.output.display();
    print(&match args.json {
        true => json(&made.mesh, made.distance),
        false => {
            let near = match made.distance {
                Some(d) => format!("within {:.3e} m of the surface", d),
                None => "marched: edges are cut by up to a cell".into(),
            };
            format!(
                "{file}: {} vertices, {} triangles, volume {:.4e} m³, {near}\n",
                made.mesh.vertices().len(),
                made.mesh.triangles().len(),
                made.mesh.volume()
            )
        }
    })
}

fn json(mesh: &Mesh, distance: Option<f64>) -> String {
    let distance = distance.map_or("null".into(), |d| format!("{d:e}"));
    format!(
        "{{\"vertices\": {}, \"triangles\": {}, \"volume\": {:e}, \"area\": {:e}, \"watertight\": {}, \"euler_characteristic\": {}, \"distance\": {distance}}}\n",
        mesh.vertices().len(),
        mesh.triangles().len(),
        mesh.volume(),
        mesh.area(),
        mesh.is_watertight(),
        mesh.euler_characteristic(),
    )
}
