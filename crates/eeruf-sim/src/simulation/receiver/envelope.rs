//! Sounds of one firing that reach a receiver within a burst of each other. They add as phasors, and the envelope of
//! their sum crosses the threshold.
//!
//! ```text
//! p(t) = | sum_i A_i exp(j phi_i) r((t - t_i) / T) |,    r(s) = s up to 1, then 2 - s up to 2, else 0
//! ```
//!
//! The sounds have onsets `t_i`, a burst of length `T`, and phases `phi_i` of the carrier, given by the paths'
//! travelling times. The envelope `r` of one sound rises evenly over the burst (see
//! [`Hearing::lateness`](super::Hearing::lateness)) and falls likewise: a burst through a receiver with a response of
//! the same length. Between the moments at which a sound begins, stops rising or ends, the phasor is linear. Its square
//! is a parabola that opens upwards, so each such stretch crosses a threshold upwards at most once.

use core::f64::consts::TAU;

use super::Arrival;

/// A single sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wave {
    /// The number of the receiver.
    pub(crate) receiver: usize,
    /// Start, in true nanoseconds.
    pub(crate) onset: u64,
    /// Length of the sound's burst in nanoseconds.
    pub(crate) burst: u64,
    /// The phase as a share of a turn.
    pub(crate) turn: f32,
    pub(crate) path: u32,
    /// Level above the detection floor, without the receiver's gain.
    pub(crate) level_over_threshold_db: f32,
}

/// A stretch in which the envelope of a sum rises. Amplitudes are relative to the threshold at full gain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rise {
    /// Time in nanoseconds from the onset of the first sound of the sum to the beginning of the stretch.
    pub(crate) after: u32,
    /// The squares of the envelope at both ends of the stretch. The next stretch begins with the last number, so that
    /// no threshold falls between two stretches.
    pub(crate) squares: [f32; 2],
    /// Duration in nanoseconds.
    lasts: f32,
    /// The parabola's first two derivatives at the beginning, halved, with time in stretches.
    linear: f32,
    curved: f32,
}

impl Rise {
    /// Returns the time in nanoseconds from the onset of the first sound until the envelope crosses a threshold; `None`
    /// if it does not cross it within this stretch.
    pub(super) fn crosses(&self, threshold: f64) -> Option<u64> {
        let ([from, to], wanted) = (self.squares.map(f64::from), threshold * threshold);
        if !(from < wanted && wanted <= to) {
            return None;
        }
        let (linear, curved) = (f64::from(self.linear), f64::from(self.curved));
        let root = (linear * linear + curved * (wanted - from)).max(0.0).sqrt();
        // Use the form of the root that contains no difference.
        let share = if linear > 0.0 { (wanted - from) / (root + linear) } else { (root - linear) / curved };
        Some(u64::from(self.after) + (share.clamp(0.0, 1.0) * f64::from(self.lasts)) as u64)
    }
}

/// The sounds of one firing, with buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Envelope {
    waves: Vec<Wave>,
    knots: Vec<u64>,
    /// The squares of the envelope at the knots.
    squares: Vec<f32>,
}

impl Envelope {
    pub(crate) fn push(&mut self, wave: Wave) {
        self.waves.push(wave);
    }

    /// Passes on each stretch in which the sum of the pushed sounds, sent at this time, rises over the threshold at
    /// full gain, with its receiver; then forgets the sounds.
    pub(crate) fn rises(&mut self, sent: u64, mut heard: impl FnMut(usize, Arrival)) {
        let mut waves = core::mem::take(&mut self.waves);
        waves.sort_unstable_by_key(|wave| (wave.receiver, wave.onset, wave.path));
        let mut rest = &waves[..];
        while let Some(&first) = rest.first() {
            let together = |a: &Wave, b: &Wave| a.receiver == b.receiver && b.onset - a.onset < 2 * first.burst;
            let count = 1 + rest.windows(2).take_while(|pair| together(&pair[0], &pair[1])).count();
            let (sum, others) = rest.split_at(count);
            self.sum(sum, first.burst, |arrival| heard(first.receiver, Arrival { sent, ..arrival }));
            rest = others;
        }
        waves.clear();
        self.waves = waves;
    }

    /// Sums overlapping sounds, given from first to last.
    fn sum(&mut self, waves: &[Wave], rise: u64, mut heard: impl FnMut(Arrival)) {
        self.knots.clear();
        self.knots.extend(waves.iter().flat_map(|wave| [0, rise, 2 * rise].map(|after| wave.onset + after)));
        self.knots.sort_unstable();
        self.knots.dedup();
        self.squares.clear();
        self.squares.extend(self.knots.iter().map(|&knot| {
            let [re, im] = phasor(waves, knot, rise).0;
            (re * re + im * im) as f32
        }));
        let onset = waves[0].onset;
        for (place, pair) in self.knots.windows(2).enumerate() {
            let (from, to) = (pair[0], pair[1]);
            let squares = [self.squares[place], self.squares[place + 1]];
            if squares[1] <= squares[0] || squares[1] < 1.0 {
                continue;
            }
            let (at, loudest) = phasor(waves, from, rise);
            let next = phasor(waves, to, rise).0;
            let grows = [next[0] - at[0], next[1] - at[1]];
            // The level that a module reports is the peak within the next burst.
            let peak = self.knots.iter().zip(&self.squares).skip(place + 1);
            let peak =
                peak.take_while(|(knot, _)| **knot <= from + rise).fold(squares[1], |peak, (_, it)| peak.max(*it));
            heard(Arrival {
                onset,
                at: onset,
                sent: 0,
                path: waves[loudest].path,
                level_over_threshold_db: 10.0 * libm::log10f(peak),
                rise: Some(Rise {
                    after: (from - onset) as u32,
                    squares,
                    lasts: (to - from) as f32,
                    linear: (at[0] * grows[0] + at[1] * grows[1]) as f32,
                    curved: (grows[0] * grows[0] + grows[1] * grows[1]) as f32,
                }),
            });
        }
    }
}

/// Returns the phasor of a sum at a time, and the loudest of the sounds that have begun and not ended.
fn phasor(waves: &[Wave], now: u64, rise: u64) -> ([f64; 2], usize) {
    let (mut sum, mut most, mut loudest) = ([0.0; 2], f32::NEG_INFINITY, 0);
    for (place, wave) in waves.iter().enumerate().take_while(|(_, wave)| wave.onset <= now) {
        let since = now - wave.onset;
        if since >= 2 * rise {
            continue;
        }
        let share = since.min(2 * rise - since) as f64 / rise as f64;
        let amplitude = share * libm::exp10(0.05 * f64::from(wave.level_over_threshold_db));
        let (sin, cos) = libm::sincos(TAU * f64::from(wave.turn));
        sum = [sum[0] + amplitude * cos, sum[1] + amplitude * sin];
        if wave.level_over_threshold_db > most {
            (most, loudest) = (wave.level_over_threshold_db, place);
        }
    }
    (sum, loudest)
}
