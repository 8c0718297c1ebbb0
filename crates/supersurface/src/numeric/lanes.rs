//! Hot loops over many points at once: the same plain code compiled three times, for every x86-64, for those
//! with AVX2 and FMA and for those with AVX-512, and chosen at run time.
//!
//! A loop over a block of [`WIDTH`] numbers without branches and calls becomes vector instructions. What
//! stands in its way are logarithms and exponentials, so they are here as polynomials. Where the machine can,
//! products and sums are fused, so that two machines may differ in the last bit; one machine never does.

/// Numbers in a block: two AVX2 registers, so that latencies overlap.
pub const WIDTH: usize = 8;
/// Numbers in the widest block, of the narrowest numbers.
pub const WIDEST: usize = 2 * WIDTH;

/// Work that is worth compiling for wider registers. `run` must be `#[inline(always)]`.
pub trait Job {
    /// Does it; `FUSED` is what [`fused`], [`ln`], [`exp`] and [`dot`] are to be called with.
    fn run<const FUSED: bool>(self);
}

/// Runs a job with the widest registers that this machine has.
#[inline]
pub fn dispatch<J: Job>(job: J) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::is_x86_feature_detected as has;
        let fused = has!("avx2") && has!("fma");
        // SAFETY: the features that a function is compiled for are detected before it is called.
        #[allow(unsafe_code)]
        unsafe {
            if fused && has!("avx512f") && has!("avx512dq") && has!("avx512vl") {
                return with_avx512(job);
            }
            if fused {
                return with_avx2(job);
            }
        }
    }
    job.run::<false>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
fn with_avx512<J: Job>(job: J) {
    job.run::<true>();
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

/// `Σ c_k x^k` for up to sixteen coefficients, pairs first (Estrin): a chain of four steps instead of one of fifteen, as
/// the loops wait for results rather than for units.
#[inline(always)]
fn polynomial<const FUSED: bool, L: Lane, const N: usize>(x: L, c: [f64; N]) -> L {
    let at = |k: usize| L::of(if k < N { c[k] } else { 0.0 });
    let pair = |x: L, low: L, high: L, used: bool| {
        if used { x.times_plus::<FUSED>(high, low) } else { low }
    };
    let (x2, x4, x8) = (x * x, x * x * (x * x), x * x * (x * x) * (x * x * (x * x)));
    let two = |k: usize| pair(x, at(k), at(k + 1), k + 1 < N);
    let four = |k: usize| pair(x2, two(k), two(k + 2), k + 2 < N);
    let eight = |k: usize| pair(x4, four(k), four(k + 4), k + 4 < N);
    pair(x8, eight(0), eight(8), 8 < N)
}

/// A number that a kernel can be written for once: `f64`, or `f32` where twice as many at a time matter more than the
/// last digits.
pub trait Lane:
    Copy
    + Default
    + PartialOrd
    + std::ops::Add<Output = Self>
    + std::ops::Sub<Output = Self>
    + std::ops::Mul<Output = Self>
    + std::ops::Div<Output = Self>
    + std::ops::Neg<Output = Self>
    + std::ops::AddAssign
{
    /// The smallest number that a kernel takes logarithms of.
    const TINY: Self;
    /// `e^-LOST` is lost beside 1, and its square is a normal number: smaller ones would stall the units.
    const LOST: Self;
    /// What the last digit of 1 is worth.
    const EPSILON: f64;
    /// Numbers in a block: as many as fill the widest register, or two of the next.
    const WIDTH: usize;
    /// The nearest number.
    fn of(value: f64) -> Self;
    /// As an `f64`, exactly.
    fn wide(self) -> f64;
    /// `self · b + c` as [`fused`].
    fn times_plus<const FUSED: bool>(self, b: Self, c: Self) -> Self;
    /// A positive normal number as `2^k m` with `m` in [1/√2, √2): `(m, k)`.
    fn log_parts(self) -> (Self, Self);
    /// `2 artanh s` for `|s| <= 3 - 2√2`.
    fn log_series<const FUSED: bool>(self) -> Self;
    /// As [`ln`]; `f32`: within 2e-7 of its magnitude or 2e-7.
    #[inline(always)]
    fn ln<const FUSED: bool>(self) -> Self {
        let (m, k) = self.log_parts();
        let s = (m - Self::of(1.0)) / (m + Self::of(1.0));
        k.times_plus::<FUSED>(Self::of(std::f64::consts::LN_2), s.log_series::<FUSED>())
    }
    /// Sine and cosine as [`sin_cos`]; `f32`: within 2e-6 for arguments up to 70.
    fn sin_cos<const FUSED: bool>(self) -> (Self, Self);
    /// `1/√x` of a positive normal number, within a few units of the last place: without a division, for which kernels
    /// wait longest.
    fn inverse_sqrt<const FUSED: bool>(self) -> Self;
    /// As [`exp`]; `f32`: within 3e-7 relative, the argument clamped to ±87.
    fn exp<const FUSED: bool>(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// With the sign of another.
    fn copysign(self, sign: Self) -> Self;
    /// The smaller one; neither may be NaN.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// The larger one; neither may be NaN.
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
}

impl Lane for f64 {
    const TINY: Self = 1e-300;
    const LOST: Self = 40.0;
    const EPSILON: f64 = f64::EPSILON;
    const WIDTH: usize = WIDTH;
    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        self
    }
    #[inline(always)]
    fn times_plus<const FUSED: bool>(self, b: Self, c: Self) -> Self {
        fused::<FUSED>(self, b, c)
    }
    #[inline(always)]
    fn log_parts(self) -> (Self, Self) {
        const TWO_52: u64 = 0x4330_0000_0000_0000;
        let bits = self.to_bits();
        // the biased exponent as a number, without a conversion that has no vector instruction
        let biased = f64::from_bits((bits >> 52) | TWO_52) - f64::from_bits(TWO_52);
        let mantissa = f64::from_bits((bits & 0x000F_FFFF_FFFF_FFFF) | 0x3FF0_0000_0000_0000);
        let high = mantissa > std::f64::consts::SQRT_2;
        let m = if high { 0.5 * mantissa } else { mantissa };
        (m, if high { biased - 1022.0 } else { biased - 1023.0 })
    }
    #[inline(always)]
    fn log_series<const FUSED: bool>(self) -> Self {
        const SERIES: [f64; 11] = [
            1.0,
            1.0 / 3.0,
            1.0 / 5.0,
            1.0 / 7.0,
            1.0 / 9.0,
            1.0 / 11.0,
            1.0 / 13.0,
            1.0 / 15.0,
            1.0 / 17.0,
            1.0 / 19.0,
            1.0 / 21.0,
        ];
        2.0 * self * polynomial::<FUSED, Self, 11>(self * self, SERIES)
    }
    #[inline(always)]
    fn exp<const FUSED: bool>(self) -> Self {
        exp::<FUSED>(self)
    }
    #[inline(always)]
    fn sin_cos<const FUSED: bool>(self) -> (Self, Self) {
        sin_cos::<FUSED>(self)
    }
    #[inline(always)]
    fn inverse_sqrt<const FUSED: bool>(self) -> Self {
        let guess = f64::from_bits(0x5FE6_EB50_C7B5_37A9_u64.wrapping_sub(self.to_bits() >> 1));
        let y = sharper_inverse_sqrt::<FUSED, Self>(self, guess);
        let y = sharper_inverse_sqrt::<FUSED, Self>(self, y);
        let y = sharper_inverse_sqrt::<FUSED, Self>(self, y);
        sharper_inverse_sqrt::<FUSED, Self>(self, y)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.copysign(sign)
    }
}

impl Lane for f32 {
    const TINY: Self = 1e-30;
    const LOST: Self = 20.0;
    const EPSILON: f64 = f32::EPSILON as f64;
    const WIDTH: usize = WIDEST;
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn wide(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn times_plus<const FUSED: bool>(self, b: Self, c: Self) -> Self {
        if FUSED { self.mul_add(b, c) } else { self * b + c }
    }
    #[inline(always)]
    fn log_parts(self) -> (Self, Self) {
        const TWO_23: u32 = 0x4B00_0000;
        let bits = self.to_bits();
        let biased = f32::from_bits((bits >> 23) | TWO_23) - f32::from_bits(TWO_23);
        let mantissa = f32::from_bits((bits & 0x007F_FFFF) | 0x3F80_0000);
        let high = mantissa > std::f32::consts::SQRT_2;
        let m = if high { 0.5 * mantissa } else { mantissa };
        (m, if high { biased - 126.0 } else { biased - 127.0 })
    }
    #[inline(always)]
    fn log_series<const FUSED: bool>(self) -> Self {
        let q = self * self;
        let low = q.times_plus::<FUSED>(1.0 / 3.0, 1.0);
        let high = q.times_plus::<FUSED>(1.0 / 7.0, 1.0 / 5.0);
        2.0 * self * (q * q).times_plus::<FUSED>(high, low)
    }
    #[inline(always)]
    fn exp<const FUSED: bool>(self) -> Self {
        // adding 1.5 2^23 rounds to an integer and leaves it in the low bits
        const ROUND: f32 = 12_582_912.0;
        const LN_2_HIGH: f32 = 0.693_145_75;
        const LN_2_LOW: f32 = 1.428_606_8e-6;
        let x = self.least(87.0).most(-87.0);
        let shifted = x.times_plus::<FUSED>(std::f32::consts::LOG2_E, ROUND);
        let k = shifted - ROUND;
        let r = k.times_plus::<FUSED>(-LN_2_LOW, k.times_plus::<FUSED>(-LN_2_HIGH, x));
        let (square, low) = (r * r, 1.0 + r);
        let middle = r.times_plus::<FUSED>(1.0 / 6.0, 0.5);
        let high = r.times_plus::<FUSED>(1.0 / 120.0, 1.0 / 24.0);
        let highest = r.times_plus::<FUSED>(1.0 / 5_040.0, 1.0 / 720.0);
        let high = square.times_plus::<FUSED>(highest, high);
        let middle = square.times_plus::<FUSED>(high, middle);
        let series = square.times_plus::<FUSED>(middle, low);
        series * f32::from_bits((shifted.to_bits() << 23).wrapping_add(0x3F80_0000))
    }
    #[inline(always)]
    fn sin_cos<const FUSED: bool>(self) -> (Self, Self) {
        const ROUND: f32 = 12_582_912.0;
        const HALF_PI_HIGH: f32 = 1.570_312_5;
        const HALF_PI_LOW: f32 = 4.838_268e-4;
        let shifted = self.times_plus::<FUSED>(std::f32::consts::FRAC_2_PI, ROUND);
        let k = shifted - ROUND;
        let r = k.times_plus::<FUSED>(-HALF_PI_LOW, k.times_plus::<FUSED>(-HALF_PI_HIGH, self));
        let q = r * r;
        let sine = [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5_040.0];
        let cosine = [1.0, -1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0];
        let s = polynomial::<FUSED, Self, 4>(q, sine) * r;
        let c = polynomial::<FUSED, Self, 5>(q, cosine);
        let quadrant = shifted.to_bits();
        let (odd, half) = (quadrant & 1 != 0, quadrant & 2 != 0);
        let (sin, cos) = if odd { (c, -s) } else { (s, c) };
        if half { (-sin, -cos) } else { (sin, cos) }
    }
    #[inline(always)]
    fn inverse_sqrt<const FUSED: bool>(self) -> Self {
        let guess = f32::from_bits(0x5F37_59DF_u32.wrapping_sub(self.to_bits() >> 1));
        let y = sharper_inverse_sqrt::<FUSED, Self>(self, guess);
        let y = sharper_inverse_sqrt::<FUSED, Self>(self, y);
        sharper_inverse_sqrt::<FUSED, Self>(self, y)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.copysign(sign)
    }
}

/// A Newton step towards `1/√x`, `y (3 - x y²)/2`.
#[inline(always)]
fn sharper_inverse_sqrt<const FUSED: bool, L: Lane>(x: L, y: L) -> L {
    let half = L::of(-0.5) * x * y;
    y * half.times_plus::<FUSED>(y, L::of(1.5))
}

/// Inverses of three numbers whose product neither overflows nor vanishes, by one division.
#[inline(always)]
pub fn inverses<L: Lane>([a, b, c]: [L; 3]) -> [L; 3] {
    let ab = a * b;
    let both = L::of(1.0) / (ab * c);
    let of_ab = both * c;
    [of_ab * b, of_ab * a, both * ab]
}

/// Natural logarithms of three positive normal numbers, by one division.
#[inline(always)]
pub fn logarithms<const FUSED: bool, L: Lane>(x: [L; 3]) -> [L; 3] {
    let (one, ln_2) = (L::of(1.0), L::of(std::f64::consts::LN_2));
    let ((m0, k0), (m1, k1), (m2, k2)) = (x[0].log_parts(), x[1].log_parts(), x[2].log_parts());
    let [i0, i1, i2] = inverses([m0 + one, m1 + one, m2 + one]);
    [
        k0.times_plus::<FUSED>(ln_2, ((m0 - one) * i0).log_series::<FUSED>()),
        k1.times_plus::<FUSED>(ln_2, ((m1 - one) * i1).log_series::<FUSED>()),
        k2.times_plus::<FUSED>(ln_2, ((m2 - one) * i2).log_series::<FUSED>()),
    ]
}

/// `ln(1 + t)` and `1/(1 + t)` for `t` in [0, 1], by one division.
#[inline(always)]
pub fn log_and_inverse<const FUSED: bool, L: Lane>(t: L) -> (L, L) {
    let one = L::of(1.0);
    // (m - 1)/(m + 1) for m = 1 + t or half of it
    let high = t > L::of(std::f64::consts::SQRT_2 - 1.0);
    let (above, below) = if high { (t - one, t + L::of(3.0)) } else { (t, t + L::of(2.0)) };
    let base = L::of(if high { std::f64::consts::LN_2 } else { 0.0 });
    let sum = one + t;
    let both = one / (sum * below);
    (base + (above * both * sum).log_series::<FUSED>(), both * below)
}

/// Natural logarithm of a positive normal number, within 2e-16 of its magnitude or 4e-16.
///
/// `x = 2^k m` with `m` in [1/√2, √2), `ln m = 2 artanh((m - 1)/(m + 1))` by its series.
#[inline(always)]
pub fn ln<const FUSED: bool>(x: f64) -> f64 {
    Lane::ln::<FUSED>(x)
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
    let series = polynomial::<FUSED, f64, 13>(
        r,
        [
            1.0,
            1.0,
            1.0 / 2.0,
            1.0 / 6.0,
            1.0 / 24.0,
            1.0 / 120.0,
            1.0 / 720.0,
            1.0 / 5_040.0,
            1.0 / 40_320.0,
            1.0 / 362_880.0,
            1.0 / 3_628_800.0,
            1.0 / 39_916_800.0,
            1.0 / 479_001_600.0,
        ],
    );
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(0x3FF0_0000_0000_0000));
    series * power
}

/// Sine and cosine, within 1e-15 for arguments up to 1e5.
///
/// Reduced to [-π/4, π/4] by the nearest multiple of π/2; the series there, exchanged and signed by the quadrant.
#[inline(always)]
pub fn sin_cos<const FUSED: bool>(x: f64) -> (f64, f64) {
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const HALF_PI_HIGH: f64 = 1.570_796_326_734_125_6;
    const HALF_PI_LOW: f64 = 6.077_100_506_506_192e-11;
    let shifted = fused::<FUSED>(x, std::f64::consts::FRAC_2_PI, ROUND);
    let k = shifted - ROUND;
    let r = fused::<FUSED>(k, -HALF_PI_LOW, fused::<FUSED>(k, -HALF_PI_HIGH, x));
    let q = r * r;
    let s = polynomial::<FUSED, f64, 8>(
        q,
        [
            1.0,
            -1.0 / 6.0,
            1.0 / 120.0,
            -1.0 / 5_040.0,
            1.0 / 362_880.0,
            -1.0 / 39_916_800.0,
            1.0 / 6_227_020_800.0,
            -1.0 / 1_307_674_368_000.0,
        ],
    ) * r;
    let c = polynomial::<FUSED, f64, 9>(
        q,
        [
            1.0,
            -1.0 / 2.0,
            1.0 / 24.0,
            -1.0 / 720.0,
            1.0 / 40_320.0,
            -1.0 / 3_628_800.0,
            1.0 / 479_001_600.0,
            -1.0 / 87_178_291_200.0,
            1.0 / 20_922_789_888_000.0,
        ],
    );
    let quadrant = shifted.to_bits();
    let (odd, half) = (quadrant & 1 != 0, quadrant & 2 != 0);
    let (sin, cos) = if odd { (c, -s) } else { (s, c) };
    if half { (-sin, -cos) } else { (sin, cos) }
}

/// `atan(m)/m` of `m = √square`, within 4e-14 of `1/m` (`f32`: 2e-6): the angle halved twice, then the series.
#[inline(always)]
pub fn arc_tangent_ratio<const FUSED: bool, L: Lane>(square: L) -> L {
    let one = L::of(1.0);
    // tan(θ/2)/tan θ = 1/(1 + √(1 + tan² θ))
    let first = one / (one + (one + square).sqrt());
    let halved = square * first * first;
    let second = one / (one + (one + halved).sqrt());
    let q = halved * second * second;
    let series: [f64; 16] = std::array::from_fn(|k| {
        let term = 1.0 / (2 * k + 1) as f64;
        if k % 2 == 0 { term } else { -term }
    });
    L::of(4.0) * first * second * polynomial::<FUSED, L, 16>(q, series)
}

/// Sum of products of two slices of the same length, a multiple of [`Lane::WIDTH`]; the rest is left out.
#[inline(always)]
pub fn dot<const FUSED: bool, L: Lane>(a: &[L], b: &[L]) -> f64 {
    let mut sums = [L::of(0.0); WIDEST];
    for (x, y) in a.chunks_exact(L::WIDTH).zip(b.chunks_exact(L::WIDTH)) {
        for i in 0..L::WIDTH {
            sums[i] = x[i].times_plus::<FUSED>(y[i], sums[i]);
        }
    }
    sums[..L::WIDTH].iter().map(|s| s.wide()).sum()
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

    #[test]
    fn single_precision_has_six_digits() {
        struct Both<'a>([f32; WIDTH], &'a mut [[f32; WIDTH]; 2]);
        impl Job for Both<'_> {
            #[inline(always)]
            fn run<const FUSED: bool>(self) {
                for i in 0..WIDTH {
                    self.1[0][i] = Lane::exp::<FUSED>(self.0[i]);
                    self.1[1][i] = Lane::ln::<FUSED>(self.1[0][i]);
                }
            }
        }
        let mut random = Stream::new(13, 0);
        for _ in 0..20_000 {
            let x: [f32; WIDTH] = std::array::from_fn(|_| random.between(-86.0, 86.0) as f32);
            let (mut wide, mut plain) = ([[0.0; WIDTH]; 2], [[0.0; WIDTH]; 2]);
            dispatch(Both(x, &mut wide));
            Both(x, &mut plain).run::<false>();
            for found in [wide, plain] {
                for ((x, power), log) in x.iter().zip(found[0]).zip(found[1]) {
                    let (exact, power) = (f64::from(*x).exp(), f64::from(power));
                    assert!((power / exact - 1.0).abs() < 3e-7, "{x}: {power}");
                    let exact = power.ln();
                    let error = (f64::from(log) - exact).abs();
                    assert!(error < 2e-7 * exact.abs().max(1.0), "{x}: {log}");
                }
            }
        }
    }

    #[test]
    fn what_goes_without_divisions_is_the_same() {
        fn check<L: Lane + std::fmt::Debug>(x: [f64; 3], error: f64) {
            let near = |found: L, exact: f64, what: &str| {
                let off = (found.wide() - exact).abs();
                assert!(off < error * exact.abs().max(1.0), "{what} {x:?}: {found:?} {exact}");
            };
            let [a, b, c] = x;
            let lanes = x.map(L::of);
            let wide = lanes.map(Lane::wide);
            for (i, (log, inverse)) in
                logarithms::<true, L>(lanes).into_iter().zip(inverses(lanes)).enumerate()
            {
                near(log, wide[i].ln(), "logarithm");
                near(inverse, wide[i].recip(), "inverse");
            }
            near(lanes[0].inverse_sqrt::<true>(), wide[0].sqrt().recip(), "root");
            let t = L::of((a / (a + b)).min(1.0));
            let (log, inverse) = log_and_inverse::<true, L>(t);
            near(log, t.wide().ln_1p(), "logarithm of the sum");
            near(inverse, (1.0 + t.wide()).recip(), "inverse of the sum");
            let angle = L::of(10.0 * (c - b));
            let (sin, cos) = angle.sin_cos::<true>();
            near(sin, angle.wide().sin(), "sine");
            near(cos, angle.wide().cos(), "cosine");
            let square = lanes[1];
            let exact = wide[1].sqrt().atan() / wide[1].sqrt();
            near(arc_tangent_ratio::<true, L>(square), exact, "arc tangent");
        }
        let mut random = Stream::new(14, 0);
        for _ in 0..20_000 {
            let x = std::array::from_fn(|_| random.between(-3.0, 2.0).exp());
            check::<f64>(x, 4e-15);
            check::<f32>(x, 2e-6);
        }
    }

    #[test]
    fn circular_functions_are_those_of_the_standard_library() {
        let mut random = Stream::new(12, 0);
        for _ in 0..20_000 {
            let x = random.between(-40.0, 40.0);
            for (sin, cos) in [sin_cos::<false>(x), sin_cos::<true>(x)] {
                assert!((sin - x.sin()).abs() < 1e-15 && (cos - x.cos()).abs() < 1e-15, "{x}");
            }
            let m = (x - 30.0).exp();
            for ratio in
                [arc_tangent_ratio::<false, f64>(m * m), arc_tangent_ratio::<true, f64>(m * m)]
            {
                assert!((ratio * m - m.atan()).abs() < 4e-14, "{m}");
            }
        }
        assert_eq!(
            (arc_tangent_ratio::<false, f64>(0.0), sin_cos::<false>(0.0)),
            (1.0, (0.0, 1.0))
        );
    }
}
