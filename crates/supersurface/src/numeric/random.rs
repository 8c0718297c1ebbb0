//! Random numbers with a stream for each (seed, index), so that results do not depend on threads.

use super::lanes;

/// Of the Weyl sequence.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// A small counter-seeded generator (SplitMix64 mixing of a Weyl sequence).
///
/// The stream is a function of `seed` and `index` alone: two items of a batch never share one, and
/// the order in which they are computed does not matter.
///
/// ```
/// use supersurface::numeric::random::Stream;
/// let (mut a, mut b) = (Stream::new(7, 0), Stream::new(7, 0));
/// assert_eq!(a.uniform(), b.uniform());
/// ```
#[derive(Clone, Debug)]
pub struct Stream {
    state: u64,
}

impl Stream {
    /// The stream number `index` of `seed`.
    pub fn new(seed: u64, index: u64) -> Self {
        let mut s = Self { state: seeded(seed, index) };
        s.state = s.bits();
        s
    }

    /// The next 64 random bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(STEP);
        mixed(self.state)
    }

    /// A uniform number in [0, 1).
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        uniform(self.bits())
    }

    /// A uniform number in [low, high).
    #[inline]
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A uniform index in [0, n); 0 for `n = 0`.
    #[inline]
    pub fn index(&mut self, n: usize) -> usize {
        ((self.uniform() * n as f64) as usize).min(n.saturating_sub(1))
    }

    /// A standard normal number (Box-Muller).
    #[inline]
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

#[inline(always)]
const fn seeded(seed: u64, index: u64) -> u64 {
    seed ^ index.wrapping_mul(0xD1B5_4A32_D192_ED03)
}

#[inline(always)]
const fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[inline(always)]
const fn uniform(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// Standard normal numbers of many streams at once, those of `index` and the next: `out[i]` is what [`Stream::normal`] gives
/// after `skip` other numbers, up to rounding.
pub(crate) fn normals(seed: u64, index: u64, skip: u64, out: &mut [f64]) {
    lanes::dispatch(Normals { seed, index, skip, out });
}

struct Normals<'a> {
    seed: u64,
    index: u64,
    skip: u64,
    out: &'a mut [f64],
}

impl lanes::Job for Normals<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let (mut index, drawn) = (self.index, STEP.wrapping_mul(self.skip));
        for block in self.out.chunks_mut(lanes::WIDTH) {
            let mut normal = [0.0; lanes::WIDTH];
            for (i, normal) in normal.iter_mut().enumerate() {
                let start = seeded(self.seed, index.wrapping_add(i as u64));
                let first = mixed(start.wrapping_add(STEP)).wrapping_add(drawn).wrapping_add(STEP);
                let [u, v] = [first, first.wrapping_add(STEP)].map(|state| uniform(mixed(state)));
                let radius = (-2.0 * lanes::ln::<FUSED>(1.0 - u)).sqrt();
                *normal = radius * lanes::sin_cos::<FUSED>(std::f64::consts::TAU * v).1;
            }
            block.iter_mut().zip(normal).for_each(|(out, normal)| *out = normal);
            index = index.wrapping_add(lanes::WIDTH as u64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_normal_numbers_are_those_of_their_streams() {
        let mut out = [0.0; 100];
        for skip in [0, 1, 2] {
            normals(7, 40, skip, &mut out);
            for (i, found) in out.iter().enumerate() {
                let mut stream = Stream::new(7, 40 + i as u64);
                for _ in 0..skip {
                    stream.bits();
                }
                assert!((found - stream.normal()).abs() < 1e-13);
            }
        }
    }
}
