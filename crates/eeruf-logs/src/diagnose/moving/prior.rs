//! Prior knowledge about readings of a log: which sensors hear each other, after what time, and how fast the robot
//! drives at each time.

use super::super::Settings;

/// The fastest change of a path's travel time, in microseconds per millisecond: both ends move at 2 m/s.
pub(super) const MOST_RATE: f64 = 12.0;
/// Bins of rates, and their number.
const BIN_RATE: f64 = 0.5;
const BINS: usize = 48;
/// Share of rates that may have any value, since objects may move by themselves.
const ANY_RATE: f64 = 0.1;
/// Number of periods for which rates are learned together; they are smoothed over neighbouring times and bins.
const PERIODS: usize = 4;
const AROUND: usize = 2;
const SMOOTH: [f64; 5] = [0.1, 0.2, 0.4, 0.2, 0.1];
/// Bins of travel times.
const TRAVELS: i64 = 10;
/// Initial share of readings that heard nothing of the ring, and initial counts.
const NONE: f64 = 0.1;
const COUNT: f64 = 0.3;

/// The distribution of rates at a time: cumulative sums at the end of each bin.
pub(super) struct Rates([f64; BINS + 1]);

impl Rates {
    fn any() -> Self {
        Self(core::array::from_fn(|bin| bin as f64 / BINS as f64))
    }

    /// The share below a rate.
    pub(super) fn below(&self, rate: f64) -> f64 {
        let at = ((rate + MOST_RATE) / BIN_RATE).clamp(0.0, BINS as f64 - 1e-9);
        let bin = at as usize;
        self.0[bin] + (at - bin as f64) * (self.0[bin + 1] - self.0[bin])
    }
}

/// Counts while learning, shares afterwards.
pub(super) struct Prior {
    sensors: usize,
    /// By receiver: the senders, and the receiver itself by an earlier firing.
    sources: Vec<f64>,
    travels: Vec<f64>,
    travel_us: i64,
    none: f64,
    readings: f64,
    /// Counts of the rates at each time; `rates` holds their distribution.
    counts: Vec<[f64; BINS]>,
    rates: Vec<Rates>,
}

impl Prior {
    pub(super) fn new(sensors: usize, firings: usize, settings: &Settings) -> Self {
        let times = firings / (PERIODS * sensors.max(1)) + 1;
        Self {
            sensors,
            sources: vec![1.0 / (sensors + 1) as f64; sensors * (sensors + 1)],
            travels: vec![1.0; TRAVELS as usize],
            travel_us: i64::from(settings.max_travel_us) / TRAVELS + 1,
            none: NONE,
            readings: 0.0,
            counts: vec![[0.0; BINS]; times],
            rates: (0..times).map(|_| Rates::any()).collect(),
        }
    }

    /// Initial counts of a pass.
    pub(super) fn learning(before: &Self) -> Self {
        Self {
            sources: vec![COUNT; before.sources.len()],
            travels: vec![1.0; before.travels.len()],
            none: 1.0,
            readings: before.sensors as f64,
            counts: vec![[0.0; BINS]; before.counts.len()],
            rates: Vec::new(),
            ..*before
        }
    }

    fn source(&self, receiver: u8, sender: u8, is_before: bool) -> usize {
        let source = if is_before { self.sensors } else { usize::from(sender) };
        usize::from(receiver) * (self.sensors + 1) + source
    }

    fn travel(&self, travel_us: i64) -> usize {
        (travel_us / self.travel_us).clamp(0, TRAVELS - 1) as usize
    }

    fn time(&self, firing: usize) -> usize {
        firing / (PERIODS * self.sensors.max(1))
    }

    pub(super) fn add(&mut self, receiver: u8, sender: u8, is_before: bool, travel_us: i64, weight: f64) {
        let (source, travel) = (self.source(receiver, sender, is_before), self.travel(travel_us));
        self.sources[source] += weight;
        self.travels[travel] += weight;
        self.readings += weight;
    }

    pub(super) fn add_none(&mut self, weight: f64) {
        self.none += weight;
        self.readings += weight;
    }

    pub(super) fn add_rate(&mut self, firing: usize, rate: f64, weight: f64) {
        let (time, bin) = (self.time(firing), ((rate + MOST_RATE) / BIN_RATE) as usize);
        self.counts[time][bin.min(BINS - 1)] += weight;
    }

    /// Turns counts into shares.
    pub(super) fn normalized(mut self) -> Self {
        self.none /= self.readings;
        for sources in self.sources.chunks_mut(self.sensors + 1) {
            let all: f64 = sources.iter().sum();
            sources.iter_mut().for_each(|source| *source /= all);
        }
        let all: f64 = self.travels.iter().sum();
        self.travels.iter_mut().for_each(|travel| *travel *= TRAVELS as f64 / all);
        self.rates = (0..self.counts.len()).map(|time| self.rates_at(time)).collect();
        self
    }

    fn rates_at(&self, time: usize) -> Rates {
        let mut smooth = [0.0; BINS];
        let last = self.counts.len() - 1;
        for counts in &self.counts[time.saturating_sub(AROUND)..=last.min(time + AROUND)] {
            for (bin, count) in counts.iter().enumerate() {
                for (k, share) in SMOOTH.iter().enumerate() {
                    smooth[(bin + k).saturating_sub(SMOOTH.len() / 2).min(BINS - 1)] += share * count;
                }
            }
        }
        let all: f64 = smooth.iter().sum();
        if all <= 0.0 {
            return Rates::any();
        }
        let mut below = [0.0; BINS + 1];
        for bin in 0..BINS {
            below[bin + 1] = below[bin] + ANY_RATE / BINS as f64 + (1.0 - ANY_RATE) * smooth[bin] / all;
        }
        Rates(below)
    }

    /// The share of readings that heard nothing of the ring.
    pub(super) fn none(&self) -> f64 {
        self.none
    }

    /// Probability that a reading heard a firing of this sender after this time.
    pub(super) fn of(&self, receiver: u8, sender: u8, is_before: bool, travel_us: i64) -> f64 {
        let source = self.sources[self.source(receiver, sender, is_before)];
        (1.0 - self.none) * source * self.travels[self.travel(travel_us)]
    }

    /// The distribution of rates at the time of a firing.
    pub(super) fn rates(&self, firing: usize) -> &Rates {
        &self.rates[self.time(firing)]
    }
}
