//! Light on a cloud that has no normals, from its depths on the canvas.
//!
//! On a plane the inverse depth is linear in the image: `1/z = A x + B y + C` with image coordinates
//! x, y, and the plane's normal is along (A, B, C). So the gradient of the smoothed inverse depth
//! gives the normal. Smoothing takes pairs of pixels on opposite sides, both on the same surface,
//! which leaves planes as they are.

use super::draw::diffuse;
use crate::Vector;

/// Pixels to each side that are averaged.
const SMOOTH: usize = 6;
/// Pixels to each side between which the gradient is taken.
const BASE: usize = 3;
/// Relative difference of depth up to which pixels lie on the same surface.
const SAME: f32 = 0.012;

/// The brightness of each pixel, about 1 on surfaces that face the viewer. `inverse` is row by row and
/// 0 where there is nothing; `focal` in pixels.
pub(super) fn relief(inverse: &[f32], width: usize, focal: f64) -> Vec<f32> {
    let height = inverse.len() / width.max(1);
    let smooth = smoothed(&smoothed(inverse, [width, height], true), [width, height], false);
    let slope = |i: usize, at: usize, most: usize, stride: usize| {
        let here = smooth.get(i).copied().unwrap_or(0.0);
        let value = |inside: bool, j: usize| {
            let there = smooth.get(j).copied().filter(|_| inside)?;
            ((there - here).abs() < 2.0 * SAME * here).then_some(there)
        };
        let before = value(at >= BASE, i.wrapping_sub(BASE * stride));
        let after = value(at + BASE < most, i + BASE * stride);
        let base = BASE as f32;
        f64::from(match (before, after) {
            (Some(a), Some(b)) => (b - a) / (2.0 * base),
            (Some(a), None) => (here - a) / base,
            (None, Some(b)) => (b - here) / base,
            (None, None) => 0.0,
        })
    };
    let facing = diffuse(&-Vector::z());
    let light = |(i, value): (usize, &f32)| {
        if *value == 0.0 {
            return 1.0;
        }
        let (column, row) = (i % width, i / width);
        let (a, b) = (slope(i, column, width, 1) * focal, slope(i, row, height, width) * focal);
        let x = (column as f64 + 0.5 - 0.5 * width as f64) / focal;
        let y = (row as f64 + 0.5 - 0.5 * height as f64) / focal;
        let normal = Vector::new(a, b, f64::from(*value) - a * x - b * y);
        let normal = -normal.try_normalize(1e-12).unwrap_or(Vector::z());
        (diffuse(&normal) / facing).clamp(0.6, 1.12) as f32
    };
    smooth.iter().enumerate().map(light).collect()
}

/// Averages along rows or columns, over pairs that lie on the surface of their middle.
fn smoothed(values: &[f32], [width, height]: [usize; 2], along_rows: bool) -> Vec<f32> {
    let average = |(i, here): (usize, &f32)| {
        if *here == 0.0 {
            return 0.0;
        }
        let (at, most, stride) =
            if along_rows { (i % width, width, 1) } else { (i / width, height, width) };
        let (mut sum, mut count) = (*here, 1.0);
        for k in 1..=SMOOTH.min(at).min(most - 1 - at) {
            let (Some(a), Some(b)) = (values.get(i - k * stride), values.get(i + k * stride))
            else {
                break;
            };
            if (a - here).abs() < SAME * here && (b - here).abs() < SAME * here {
                sum += a + b;
                count += 2.0;
            }
        }
        sum / count
    };
    values.iter().enumerate().map(average).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_keeps_one_brightness_and_steps_do_not_smear() {
        let (width, focal) = (60, 80.0);
        // a plane tilted to the left beside one that faces the viewer
        let value = |i: usize| {
            let x = ((i % width) as f64 + 0.5 - 30.0) / focal;
            (if x < 0.0 { 1.0 + 0.4 * x } else { 0.5 }) as f32
        };
        let values: Vec<f32> = (0..width * 40).map(value).collect();
        let light = relief(&values, width, focal);
        for column in [8, 15, 25, 29] {
            assert!((light[20 * width + column] - light[20 * width + 15]).abs() < 1e-3);
        }
        assert!((light[20 * width + 45] - 1.0).abs() < 1e-3);
        assert!((light[20 * width + 15] - 1.0).abs() > 0.02);
    }
}
