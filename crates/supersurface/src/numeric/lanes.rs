//! Hot loops over many points at once: the same plain code compiled twice, for every x86-64 and for those
//! with AVX2 and FMA, and chosen at run time.
//!
//! A loop over a block of [`WIDTH`] numbers without branches and calls becomes vector instructions. What
//! stands in its way are logarithms and exponentials, so they are here as polynomials. Where the machine can,
//! products and sums are fused, so that two machines may differ in the last bit; one machine never does.

/// Numbers in a block: two AVX2 registers, so that latencies overlap.
pub const WIDTH: usize = 8;

/// Work that is worth compiling for wider registers. `run` must be `#[inline(always)]`.
pub trait Job {
    /// Does it; `FUSED` is what [`fused`], [`ln`], [`exp`] and [`dot`] are to be called with.
    fn run<const FUSED: bool>(self);
}

/// Runs a job with the widest registers that this machine has.
#[inline]
pub fn dispatch<J: Job>(job: J) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        // SAFETY: the features were detected in the line above.
        #[allow(unsafe_code)]
        unsafe {
            return with_avx2(job);
        }
    }
    job.run::<false>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2<J: Job>(job: J) {
    job.run::<true>();
}

/// `a b + c`, in one step where the machine has an instruction for it.
#[inline(always)]
pub fn fused<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Natural logarithm of a positive normal number, within 2e-16 of its magnitude or 4e-16.
///
/// `x = 2^k m` with `m` in [1/√2, √2), `ln m = 2 artanh((m - 1)/(m + 1))` by its series.
#[inline(always)]
pub fn ln<const FUSED: bool>(x: f64) -> f64 {
    const TWO_52: u64 = 0x4330_0000_0000_0000;
    let bits = x.to_bits();
    // the biased exponent as a number, without a conversion that has no vector instruction
    let biased = f64::from_bits((bits >> 52) | TWO_52) - f64::from_bits(TWO_52);
    let mantissa = f64::from_bits((bits & 0x000F_FFFF_FFFF_FFFF) | 0x3FF0_0000_0000_0000);
    let high = mantissa > std::f64::consts::SQRT_2;
    let m = if high { 0.5 * mantissa } else { mantissa };
    let k = if high { biased - 1022.0 } else { biased - 1023.0 };
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let mut series = 1.0 / 21.0;
    for n in [19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0] {
        series = fused::<FUSED>(series, q, 1.0 / n);
    }
    fused::<FUSED>(k, std::f64::consts::LN_2, 2.0 * s * series)
}

/// Exponential function, within 4e-16 relative; the argument is clamped to ±700.
///
/// `x = k ln 2 + r` with `|r| <= ln 2 / 2`; `e^r` by its series, `2^k` by shifting bits.
#[inline(always)]
pub fn exp<const FUSED: bool>(x: f64) -> f64 {
    // adding 1.5 2^52 rounds to an integer and leaves it in the low bits
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
    const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    let x = if x > 700.0 { 700.0 } else { x };
    let x = if x < -700.0 { -700.0 } else { x };
    let shifted = fused::<FUSED>(x, std::f64::consts::LOG2_E, ROUND);
    let k = shifted - ROUND;
    let r = fused::<FUSED>(k, -LN_2_LOW, fused::<FUSED>(k, -LN_2_HIGH, x));
    let mut series = 1.0 / 479_001_600.0;
    for factorial in [
        39_916_800.0,
        3_628_800.0,
        362_880.0,
        40_320.0,
        5_040.0,
        720.0,
        120.0,
        24.0,
        6.0,
        2.0,
        1.0,
        1.0,
    ] {
        series = fused::<FUSED>(series, r, 1.0 / factorial);
    }
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(0x3FF0_0000_0000_0000));
    series * power
}

/// Sum of products of two slices of the same length, a multiple of [`WIDTH`]; the rest is left out.
#[inline(always)]
pub fn dot<const FUSED: bool>(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; WIDTH];
    for (x, y) in a.as_chunks::<WIDTH>().0.iter().zip(b.as_chunks::<WIDTH>().0) {
        for i in 0..WIDTH {
            sums[i] = fused::<FUSED>(x[i], y[i], sums[i]);
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn logarithm_and_exponential_are_those_of_the_standard_library() {
        struct Both<'a>([f64; WIDTH], &'a mut [[f64; WIDTH]; 2]);
        impl Job for Both<'_> {
            #[inline(always)]
            fn run<const FUSED: bool>(self) {
                for i in 0..WIDTH {
                    self.1[0][i] = ln::<FUSED>(exp::<FUSED>(0.5 * self.0[i]));
                    self.1[1][i] = exp::<FUSED>(self.0[i]);
                }
            }
        }
        let mut random = Stream::new(11, 0);
        for _ in 0..20_000 {
            let x: [f64; WIDTH] = std::array::from_fn(|_| random.between(-690.0, 690.0));
            let (mut wide, mut plain) = ([[0.0; WIDTH]; 2], [[0.0; WIDTH]; 2]);
            dispatch(Both(x, &mut wide));
            Both(x, &mut plain).run::<false>();
            for found in [wide, plain] {
                for ((x, half), power) in x.iter().zip(found[0]).zip(found[1]) {
                    assert!((half - 0.5 * x).abs() <= 1e-15 + 4e-16 * x.abs(), "{x}: {half}");
                    assert!((power / x.exp() - 1.0).abs() < 1e-15, "{x}: {power}");
                }
            }
        }
        assert_eq!((ln::<false>(1.0), exp::<false>(0.0)), (0.0, 1.0));
    }
}
