//! How a depth camera errs.
//!
//! An active stereo camera measures disparity `d = f B / z` with an error that does not depend on
//! depth, so that depth errs by `σ_z = z² σ_d / (f B)` and comes in steps of `z² q / (f B)`. Steep
//! surfaces err more and give no reading at last; edges are ragged, since a reading belongs to a
//! patch of pixels.

/// The errors of a depth camera. The default is like a RealSense D435 or a Kinect: 0.7 mm of noise
/// and steps of 0.6 mm at 0.7 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthNoise {
    /// Focal length times baseline, in pixel metres.
    pub focal_baseline: f64,
    /// Standard deviation of the disparity, in pixels.
    pub disparity: f64,
    /// Step of the disparity, in pixels; 0 for none.
    pub step: f64,
    /// Side in pixels of the square over which errors of the disparity are averages, so that neighbours err alike; 1 where
    /// each errs alone.
    pub patch: usize,
    /// Standard deviation of a ray about the middle of its pixel, in pixels.
    pub lateral: f64,
    /// Cosine of incidence below which there is no reading; up to twice of it readings are lost at
    /// random.
    pub grazing: f64,
    /// Probability that a pixel beside a jump of depth has no reading.
    pub edge: f64,
    /// Probability that any pixel has no reading.
    pub dropout: f64,
    /// Standard deviation of the depth itself at depth z, `c0 + c1 z + c2 z²`, in metres.
    pub axial: [f64; 3],
}

impl Default for DepthNoise {
    fn default() -> Self {
        Self {
            focal_baseline: 31.0,
            disparity: 0.045,
            step: 1.0 / 28.0,
            patch: 1,
            lateral: 0.3,
            grazing: 0.09,
            edge: 0.35,
            dropout: 0.002,
            axial: [0.0; 3],
        }
    }
}

impl DepthNoise {
    /// A RealSense D415 at 640 x 480: focal length 502 pixels (a field of view of 65 degrees), baseline 55 mm, an error of the
    /// disparity of 0.08 pixels where things have texture and steps of 1/32 pixel (Grunnet-Jepsen et al., "Best-known-methods
    /// for tuning Intel RealSense D400 depth cameras", and "Subpixel linearity improvement"): 1.4 mm of noise at 0.7 m, alike
    /// in neighbours.
    pub fn realsense() -> Self {
        Self {
            focal_baseline: 27.6,
            disparity: 0.08,
            step: 1.0 / 32.0,
            patch: 3,
            ..Self::default()
        }
    }

    /// Depths that err by a normal number of a standard deviation in metres, and nothing else.
    pub fn gaussian(deviation: f64) -> Self {
        Self { axial: [deviation, 0.0, 0.0], ..Self::none() }
    }

    /// A Kinect v1: `σ_z = 1.2 mm + 1.9 mm (z - 0.4)²`, rays 0.8 pixels about their middles (Nguyen, Izadi, Lovell,
    /// "Modeling Kinect sensor noise", 2012), disparities of a focal length of 580 pixels and a baseline of 75 mm in steps of
    /// 1/8 pixel (Khoshelham, Elberink, "Accuracy and resolution of Kinect depth data", 2012).
    pub fn kinect_v1() -> Self {
        Self {
            focal_baseline: 43.5,
            disparity: 0.0,
            step: 0.125,
            lateral: 0.8,
            axial: [1.504e-3, -1.52e-3, 1.9e-3],
            ..Self::default()
        }
    }

    /// An Azure Kinect, which measures times: 0.5 mm at half a metre and 1 mm more a metre, edges ragged by a quarter of a
    /// pixel (as BlenderProc's model of it, Denninger et al. 2019), no steps.
    pub fn azure_kinect() -> Self {
        Self {
            disparity: 0.0,
            step: 0.0,
            lateral: 0.25,
            axial: [0.0, 1e-3, 0.0],
            ..Self::default()
        }
    }

    /// A camera without error.
    pub const fn none() -> Self {
        Self {
            focal_baseline: 1.0,
            disparity: 0.0,
            step: 0.0,
            patch: 1,
            lateral: 0.0,
            grazing: 0.0,
            edge: 0.0,
            dropout: 0.0,
            axial: [0.0; 3],
        }
    }

    /// The reading for the true depth `z` in metres on a surface seen under the cosine `incidence`;
    /// NaN when there is none. `kept` is uniform in [0, 1), `error` the disparity's in
    /// standard deviations.
    pub(super) fn reading(&self, z: f64, incidence: f64, edge: bool, kept: f64, error: f64) -> f64 {
        let faint =
            if self.grazing > 0.0 { (2.0 - incidence / self.grazing).clamp(0.0, 1.0) } else { 0.0 };
        let keep =
            (1.0 - self.dropout) * (1.0 - faint) * (1.0 - if edge { self.edge } else { 0.0 });
        if kept >= keep {
            return f64::NAN;
        }
        let [c0, c1, c2] = self.axial;
        let z = z + (c0 + z * (c1 + z * c2)) * error;
        if self.disparity == 0.0 && self.step == 0.0 {
            return z;
        }
        // a steep surface spreads the disparities within the matching window
        let slope = 1.0 / incidence.clamp(0.3, 1.0);
        let mut disparity = self.focal_baseline / z + self.disparity * slope.sqrt() * error;
        if self.step > 0.0 {
            disparity = (disparity / self.step).round() * self.step;
        }
        if disparity > 0.0 { self.focal_baseline / disparity } else { f64::NAN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn noise_grows_with_the_square_of_depth() {
        let noise = DepthNoise { step: 0.0, dropout: 0.0, ..DepthNoise::default() };
        let spread = |z: f64| {
            let errors = (0..4000).map(|i| {
                let mut stream = Stream::new(3, i);
                let (kept, error) = (stream.uniform(), stream.normal());
                noise.reading(z, 1.0, false, kept, error) - z
            });
            (errors.map(|e| e * e).sum::<f64>() / 4000.0).sqrt()
        };
        assert!((spread(0.7) - 0.7e-3).abs() < 0.1e-3, "{}", spread(0.7));
        assert!((spread(1.4) / spread(0.7) - 4.0).abs() < 0.3);
    }

    #[test]
    fn presets_err_by_what_they_say() {
        let spread = |noise: DepthNoise, z: f64| {
            let errors = (0..4000).map(|i| {
                let mut stream = Stream::new(4, i);
                let (kept, error) = (1e-9 * stream.uniform(), stream.normal());
                noise.reading(z, 1.0, false, kept, error) - z
            });
            (errors.map(|e| e * e).sum::<f64>() / 4000.0).sqrt()
        };
        let kinect = DepthNoise { step: 0.0, ..DepthNoise::kinect_v1() };
        for (noise, z, said) in [
            (DepthNoise::gaussian(2e-3), 0.7, 2e-3),
            (kinect, 1.0, 1.2e-3 + 1.9e-3 * 0.36),
            (DepthNoise::azure_kinect(), 0.5, 0.5e-3),
            (DepthNoise::azure_kinect(), 1.5, 1.5e-3),
        ] {
            assert!((spread(noise, z) / said - 1.0).abs() < 0.05, "{noise:?} {z}");
        }
    }

    #[test]
    fn nothing_is_read_at_grazing_angles_and_everything_without_noise() {
        assert!(DepthNoise::default().reading(0.7, 0.05, false, 0.5, 0.0).is_nan());
        assert_eq!(DepthNoise::none().reading(0.7, 0.01, true, 0.5, 0.0), 0.7);
    }
}
