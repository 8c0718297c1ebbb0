//! Shapes of the sizes and likeness of things at home.

use crate::numeric::random::Stream;
use crate::scene::SceneError;
use crate::shape::{InvalidShape, Superellipsoid, Supertoroid};
use crate::surface::Surface;

/// `count` things drawn by a seed: boxes (4 in 10), cans and jars (3), cups that narrow (1), fruit (1), and rings or soap (1),
/// 3 to 20 cm long.
///
/// ```
/// use supersurface::scene::household;
/// let things = household(5, 1)?;
/// assert_eq!(things, household(5, 1)?);
/// assert!(things.iter().all(|(_, s)| s.half_extents().iter().all(|h| (0.01..0.11).contains(h))));
/// # Ok::<(), supersurface::scene::SceneError>(())
/// ```
pub fn household(count: usize, seed: u64) -> Result<Vec<(String, Surface)>, SceneError> {
    (0..count as u64).map(|k| Ok(drawn(&mut Stream::new(seed, k))?)).collect()
}

fn drawn(stream: &mut Stream) -> Result<(String, Surface), InvalidShape> {
    let kind = stream.index(10);
    let mut draw = |low, high| stream.between(low, high);
    let (name, shape) = match kind {
        0..4 => {
            let axes = [draw(0.015, 0.05), draw(0.025, 0.07), draw(0.03, 0.1)];
            let edges = [draw(0.08, 0.25), draw(0.08, 0.25)];
            ("box", Surface::Superellipsoid(Superellipsoid::new(axes, edges)?))
        }
        4..7 => {
            let radius = draw(0.022, 0.045);
            let axes = [radius, radius, draw(0.03, 0.09)];
            ("can", Surface::Superellipsoid(Superellipsoid::new(axes, [draw(0.08, 0.25), 1.0])?))
        }
        7 => {
            let radius = draw(0.03, 0.042);
            let axes = [radius, radius, draw(0.04, 0.07)];
            let core = Superellipsoid::new(axes, [draw(0.08, 0.2), 1.0])?;
            let slope = draw(0.1, 0.3);
            ("cup", Surface::tapered(core, [slope, slope])?)
        }
        8 => {
            let radius = draw(0.025, 0.045);
            let axes = [radius, radius * draw(0.85, 1.0), radius * draw(0.9, 1.4)];
            ("fruit", Surface::Superellipsoid(Superellipsoid::new(axes, [1.0, 1.0])?))
        }
        _ if draw(0.0, 1.0) < 0.5 => {
            let tube = draw(0.01, 0.015);
            let axes = [tube, tube, tube * draw(1.0, 1.6)];
            let ring = Supertoroid::new(axes, draw(2.2, 3.5), [draw(0.4, 1.0), 1.0])?;
            ("ring", Surface::Supertoroid(ring))
        }
        _ => {
            let axes = [draw(0.035, 0.05), draw(0.022, 0.032), draw(0.013, 0.02)];
            ("soap", Surface::Superellipsoid(Superellipsoid::new(axes, [0.6, 0.5])?))
        }
    };
    Ok((name.to_owned(), shape))
}
