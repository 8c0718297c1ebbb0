//! Is the cloud in metres? Notices files that hold millimetres or the like.
//!
//! The size of a cloud is taken robustly: the diagonal of the box between its 5 % and 95 % quantiles,
//! and where the sensor is known the median distance from it. What depth cameras see of tables, rooms
//! and single objects is between a centimetre and some tens of metres; outside that range the
//! power of ten is named that brings it back to the size of a table scene (about 1 m).

use crate::Point;
use crate::cloud::PointCloud;

/// Which unit a cloud seems to be in, when it is hardly metres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UnitHint {
    /// The cloud looks like micrometres.
    Micrometres,
    /// The cloud looks like tenths of millimetres (a depth scale of 10,000).
    TenthsOfMillimetres,
    /// The cloud looks like millimetres.
    Millimetres,
    /// The cloud looks like centimetres; a part of some decimetres in millimetres has the same numbers.
    Centimetres,
    /// The cloud is so small that its metres seem to have been divided by 1,000 once more.
    Kilometres,
}

impl UnitHint {
    /// Length of the unit in metres: the factor for [`PointCloud::scaled`].
    pub const fn metres(self) -> f64 {
        match self {
            Self::Micrometres => 1e-6,
            Self::TenthsOfMillimetres => 1e-4,
            Self::Millimetres => 1e-3,
            Self::Centimetres => 1e-2,
            Self::Kilometres => 1e3,
        }
    }

    /// The unit's usual sign.
    pub const fn sign(self) -> &'static str {
        match self {
            Self::Micrometres => "um",
            Self::TenthsOfMillimetres => "0.1mm",
            Self::Millimetres => "mm",
            Self::Centimetres => "cm",
            Self::Kilometres => "km",
        }
    }
}

impl std::fmt::Display for UnitHint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Micrometres => "micrometres",
            Self::TenthsOfMillimetres => "tenths of millimetres",
            Self::Millimetres => "millimetres",
            Self::Centimetres => "centimetres",
            Self::Kilometres => "kilometres",
        })
    }
}

/// Largest size that passes for metres: a hall.
const LARGEST: f64 = 60.0;
/// Smallest size that passes for metres: a small screw.
const SMALLEST: f64 = 0.004;

/// The unit that the cloud seems to be in; `None` when metres are plausible, or when no unit is.
///
/// ```
/// use supersurface::{Point, cloud::{PointCloud, UnitHint, unit_hint}};
/// let table = (0..100).map(|i| Point::new(0.1 * f64::from(i % 10), 0.1 * f64::from(i / 10), 0.7));
/// let table = PointCloud::from_points(table.collect());
/// assert_eq!(unit_hint(&table), None);
/// assert_eq!(unit_hint(&table.scaled(1000.0)), Some(UnitHint::Millimetres));
/// ```
pub fn unit_hint(cloud: &PointCloud) -> Option<UnitHint> {
    let count = cloud.finite_count();
    if count < 10 {
        return None;
    }
    let step = (count / 4096).max(1);
    let finite = cloud.points.iter().filter(|p| p.coords.iter().all(|c| c.is_finite()));
    let sample: Vec<Point> = finite.step_by(step).copied().collect();
    let mut column = Vec::with_capacity(sample.len());
    let mut diagonal = 0.0f64;
    for axis in 0..3 {
        column.clear();
        column.extend(sample.iter().map(|p| p[axis]));
        diagonal = diagonal.hypot(quantile(&mut column, 0.95) - quantile(&mut column, 0.05));
    }
    // A sensor that stands metres away from a small object says more than the object's size.
    let size = cloud.viewpoint.map_or(diagonal, |eye| {
        column.clear();
        column.extend(sample.iter().map(|p| (p - eye).norm()));
        diagonal.max(quantile(&mut column, 0.5))
    });
    // scenes of more metres are hardly kept in centimetres
    let hints = [
        (UnitHint::Centimetres, 3.2),
        (UnitHint::Millimetres, 8.0),
        (UnitHint::TenthsOfMillimetres, 8.0),
        (UnitHint::Micrometres, 8.0),
    ];
    if size > LARGEST {
        let fits = |(h, most): &(UnitHint, f64)| (0.02..=*most).contains(&(size * h.metres()));
        return hints.into_iter().find(fits).map(|(h, _)| h);
    }
    let kilometres = size < SMALLEST && (0.05..=8.0).contains(&(size * 1e3));
    kilometres.then_some(UnitHint::Kilometres)
}

fn quantile(column: &mut [f64], q: f64) -> f64 {
    let at = ((column.len() as f64 * q) as usize).min(column.len().saturating_sub(1));
    column.select_nth_unstable_by(at, f64::total_cmp).1.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat patch with the given side, seen from `away`.
    fn patch(side: f64, away: f64) -> PointCloud {
        let points = (0..400).map(|i| {
            let (x, y) = (f64::from(i % 20) / 19.0 - 0.5, f64::from(i / 20) / 19.0 - 0.5);
            Point::new(side * x, side * y, away)
        });
        PointCloud { viewpoint: Some(Point::origin()), ..PointCloud::from_points(points.collect()) }
    }

    #[test]
    fn plausible_sizes_are_metres() {
        for (side, away) in [(0.02, 0.4), (0.02, 0.0), (1.0, 0.7), (8.0, 5.0), (25.0, 12.0)] {
            assert_eq!(unit_hint(&patch(side, away)), None, "{side} {away}");
        }
    }

    #[test]
    fn mixed_up_units_are_named() {
        assert_eq!(unit_hint(&patch(80.0, 60.0)), Some(UnitHint::Centimetres));
        assert_eq!(unit_hint(&patch(150.0, 200.0)), Some(UnitHint::Centimetres));
        assert_eq!(unit_hint(&patch(400.0, 0.0)), Some(UnitHint::Millimetres));
        assert_eq!(unit_hint(&patch(900.0, 700.0)), Some(UnitHint::Millimetres));
        assert_eq!(unit_hint(&patch(9e3, 1.2e4)), Some(UnitHint::TenthsOfMillimetres));
        assert_eq!(unit_hint(&patch(9e5, 7e5)), Some(UnitHint::Micrometres));
        assert_eq!(unit_hint(&patch(4e-4, 7e-4)), Some(UnitHint::Kilometres));
        assert_eq!(unit_hint(&patch(1e12, 1e12)), None);
        assert_eq!(unit_hint(&PointCloud::default()), None);
    }
}
