//! `supersurface gallery`: the figures that explain the family, drawn from the shapes themselves.

mod combinations;
mod distances;
mod grids;
mod members;
mod samples;
mod sheet;

use std::path::PathBuf;

use clap::Args;
use supersurface::picture::Image;

use crate::exit::{Failure, print};

/// Where the figures go.
#[derive(Debug, Args)]
pub(crate) struct GalleryArgs {
    /// Folder for the pictures; made where it is missing.
    folder: PathBuf,
    /// Draw these figures only.
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    only: Vec<u32>,
}

/// A figure: its number, the end of its file's name, and how it is drawn.
type Figure = (u32, &'static str, fn() -> Result<Image, Failure>);

/// Figure 6 is no figure of surfaces.
const FIGURES: [Figure; 10] = [
    (1, "superellipsoids", grids::superellipsoids),
    (2, "supertoroids", grids::supertoroids),
    (3, "seams", grids::seams),
    (4, "cusps", grids::cusps),
    (5, "deformations", members::deformations),
    (7, "members", members::members),
    (8, "radial-distance", distances::radial),
    (9, "meridian-distance", distances::meridian),
    (10, "samples", samples::samples),
    (11, "combinations", combinations::combinations),
];

/// Draws the figures.
pub(crate) fn run(args: &GalleryArgs) -> Result<(), Failure> {
    if let Some(unknown) = args.only.iter().find(|n| FIGURES.iter().all(|f| f.0 != **n)) {
        let known: Vec<String> = FIGURES.iter().map(|f| f.0.to_string()).collect();
        let known = known.join(", ");
        return Err(Failure::usage(format!("--only: there is no figure {unknown}, but {known}")));
    }
    std::fs::create_dir_all(&args.folder).map_err(|e| {
        Failure::output(format!(
            "{}: is no folder and cannot be made one: {e}",
            args.folder.display()
        ))
    })?;
    for (number, name, draw) in FIGURES {
        if !args.only.is_empty() && !args.only.contains(&number) {
            continue;
        }
        let file = args.folder.join(format!("figure-{number:02}-{name}.png"));
        let image = draw()?;
        supersurface_io::write_png(&file, [image.width, image.height], &image.pixels)
            .map_err(Failure::output)?;
        print(&format!("{}\n", file.display()))?;
    }
    Ok(())
}
