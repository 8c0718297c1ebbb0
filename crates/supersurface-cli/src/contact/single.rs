//! One pair: its contact in words or JSON, and a picture.

use std::path::Path;

use supersurface::contact::common_point;
use supersurface_io::{contact_json, write_png};

use super::args::ContactArgs;
use super::body::body;
use super::picture::picture;
use super::query::Query;
use super::text::text;
use crate::exit::{Failure, print};
use crate::places::Places;
use crate::shape::{is_json, named, read};

/// Reads both bodies and tells their contact.
pub(super) fn run(args: &ContactArgs, given: [&str; 2], query: &Query) -> Result<(), Failure> {
    if given == ["-", "-"] {
        return Err(Failure::usage("only one of the bodies can come from standard input"));
    }
    if let Some(png) = &args.png {
        Places::read(given.into_iter().filter(|g| !is_json(g)).map(Path::new))
            .take("--png", png)?;
    }
    let names = given.map(named);
    let [a, b] = [0, 1].map(|k| body(&names[k], &read(given[k])?));
    let bodies = [a?, b?];
    let [first, second] = &names;
    let contact =
        query.ask(&bodies).map_err(|e| Failure::input(format!("{first} and {second}: {e}")))?;
    let drawn = args.png.as_ref().map_or(Ok(()), |png| {
        let image = picture(&bodies, &contact);
        write_png(png, [image.width, image.height], &image.pixels).map_err(Failure::output)
    });
    let told = print(&match args.json {
        true => {
            let convex = bodies[0].as_convex().zip(bodies[1].as_convex());
            let common = convex.and_then(|(a, b)| common_point(&a, &b, &contact));
            contact_json(&contact, common, [first, second]) + "\n"
        }
        false => text([first, second], &bodies, &contact),
    });
    match (drawn, told) {
        (Err(first), told) => Err(first.and(told.err())),
        (Ok(()), told) => told,
    }
}
