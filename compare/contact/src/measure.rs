//! All contenders on all pairs of one regime.

use crate::contender::Contender;
use crate::ours::Ours;
use crate::pairs::{Pair, Regime};
use crate::parry32::Parry32;
use crate::parry64::Parry64;
use crate::timing;
use crate::trusted::{Trusted, WIDTH};

/// Errors up to this share of size are right.
pub const RIGHT: f64 = 1e-9;

/// What was found in one regime.
pub struct RegimeResult {
    /// Which.
    pub regime: Regime,
    /// Ours first.
    pub figures: [Figures; 3],
    /// Pairs whose trusted value is known.
    pub known: usize,
    /// Pairs whose certified bounds stayed wider than asked for.
    pub wide: usize,
    /// Pairs whose certified bounds contradict the construction.
    pub disputed: usize,
}

/// One contender's figures. Times in microseconds, errors relative to size, shares in percent.
#[derive(Debug)]
pub struct Figures {
    /// Who.
    pub name: &'static str,
    /// Median of a cold query of the same pair again and again.
    pub cold: f64,
    /// Median of a warm query.
    pub warm: f64,
    /// Mean of a cold query over distinct pairs.
    pub streaming: f64,
    /// Cold errors: median, 99th percentile, largest.
    pub errors: [f64; 3],
    /// Cold answers within [`RIGHT`].
    pub right: f64,
    /// Warm answers within [`RIGHT`].
    pub right_warm: f64,
    /// Cold answers of the wrong sign, among all pairs that are not touching within [`RIGHT`].
    pub wrong_sign: f64,
    /// Pairs without an answer; they are not among the errors, and are wrong in the shares.
    pub unanswered: f64,
    /// Pairs whose bounds leave out the trusted value; `None` where there are no bounds.
    pub bounds_wrong: Option<f64>,
}

/// Measures a regime.
pub fn regime(regime: Regime, pairs: &[Pair], trusted: &[Trusted]) -> RegimeResult {
    let mut ours = Entry::<Ours>::new(pairs);
    let mut parry64 = Entry::<Parry64>::new(pairs);
    let mut parry32 = Entry::<Parry32>::new(pairs);
    // They take turns on each pair, so that a slow minute of the machine hits all.
    for k in 0..pairs.len() {
        ours.time(k);
        parry64.time(k);
        parry32.time(k);
    }
    RegimeResult {
        regime,
        figures: [
            ours.figures(pairs, trusted),
            parry64.figures(pairs, trusted),
            parry32.figures(pairs, trusted),
        ],
        known: trusted.iter().filter(|t| t.distance.is_finite()).count(),
        // twice, as the bounds' own rounding adds to their width
        wide: pairs.iter().zip(trusted).filter(|(p, t)| t.width > 2.0 * WIDTH * p.size).count(),
        disputed: trusted.iter().filter(|t| t.disputed).count(),
    }
}

/// A contender with all pairs of a regime, and its times so far.
struct Entry<C> {
    contenders: Vec<C>,
    cold: Vec<f64>,
    warm: Vec<f64>,
}

impl<C: Contender> Entry<C> {
    fn new(pairs: &[Pair]) -> Self {
        Self { contenders: pairs.iter().map(C::new).collect(), cold: vec![], warm: vec![] }
    }

    fn time(&mut self, k: usize) {
        let contender = &mut self.contenders[k];
        self.cold.push(timing::cold(contender));
        self.warm.push(timing::warm(contender));
    }

    fn figures(mut self, pairs: &[Pair], trusted: &[Trusted]) -> Figures {
        let streaming = timing::streaming(&self.contenders);
        let mut errors = vec![];
        let mut count = Count::default();
        for ((contender, pair), truth) in self.contenders.iter_mut().zip(pairs).zip(trusted) {
            let contact = contender.cold();
            let distance = C::distance(&contact);
            count.unanswered += usize::from(distance.is_nan());
            if truth.distance.is_nan() {
                continue;
            }
            count.known += 1;
            let error = |distance: f64| (distance - truth.distance).abs() / pair.size;
            if !distance.is_nan() {
                errors.push(error(distance));
            }
            count.right += usize::from(error(distance) <= RIGHT);
            let touching = truth.distance.abs() <= RIGHT * pair.size;
            count.wrong_sign += usize::from(!touching && distance * truth.distance <= 0.0);

            contender.warm(true);
            count.right_warm += usize::from(error(C::distance(&contender.warm(false))) <= RIGHT);

            if let Some([low, high]) = C::bounds(&contact) {
                let slack = 1e-13 * pair.size + truth.width;
                let holds = (low - slack..=high + slack).contains(&truth.distance);
                *count.bounds_wrong.get_or_insert(0) += usize::from(!holds);
            }
        }
        let percent = |n: usize, of: usize| 100.0 * n as f64 / of as f64;
        Figures {
            name: C::NAME,
            cold: quantile(&mut self.cold, 0.5),
            warm: quantile(&mut self.warm, 0.5),
            streaming,
            errors: [0.5, 0.99, 1.0].map(|q| quantile(&mut errors, q)),
            right: percent(count.right, count.known),
            right_warm: percent(count.right_warm, count.known),
            wrong_sign: percent(count.wrong_sign, count.known),
            unanswered: percent(count.unanswered, pairs.len()),
            bounds_wrong: count.bounds_wrong.map(|n| percent(n, count.known)),
        }
    }
}

#[derive(Default)]
struct Count {
    known: usize,
    right: usize,
    right_warm: usize,
    wrong_sign: usize,
    unanswered: usize,
    bounds_wrong: Option<usize>,
}

/// The value below which a share `q` of the values lies; NaN of none.
fn quantile(values: &mut [f64], q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1) as f64;
    values.get((q * last).round() as usize).copied().unwrap_or(f64::NAN)
}
