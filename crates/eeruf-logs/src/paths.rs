//! The search for paths of sound to one receiver, from the times between firings and edges: the best supported path is
//! taken first; then its readings are removed. Surveys and diagnoses differ in what supports a path.

use std::cmp::Reverse;
use std::collections::HashMap;

use crate::statistics::median;

/// A function that is called from time to time; if it returns `false`, work ends with the results so far.
pub type KeepGoing<'a> = &'a dyn Fn() -> bool;

/// A path found in a log.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPath {
    /// The sensor that sends, from 0.
    pub sender: u8,
    /// The sensor that hears the sound, from 0.
    pub receiver: u8,
    /// Travel time of the sound, in microseconds.
    pub travel_us: f64,
    /// Standard error of the travel time.
    pub travel_error_us: f64,
    /// Scatter of single readings, rms, in microseconds.
    pub scatter_us: f64,
    /// Number of different offsets between the two firings that support the path, and of those at which it could be
    /// heard.
    pub offsets: (u32, u32),
    /// Number of paths with as much support that are expected by accident in the whole log.
    pub accidents: f64,
    /// Number of readings along the path.
    pub readings: u32,
    /// The share of readings that heard the path, among those in which nothing earlier hid it.
    pub heard: f64,
    /// The periods of the first and the last reading that came along it.
    pub periods: (u32, u32),
}

/// Support of a path.
pub(crate) struct Support {
    /// Number of offsets that support the path, and of those at which it could be heard.
    pub(crate) offsets: (u32, u32),
    /// The logarithm of the probability of as much support by accident.
    pub(crate) ln_accident: f64,
    /// The readings that came along it, among those of the receiver.
    pub(crate) readings: Vec<usize>,
    /// The share of the readings that heard it, among those in which nothing earlier hid it.
    pub(crate) heard: f64,
}

/// Readings of one receiver, as evidence for paths.
pub(crate) trait Evidence {
    /// A possible sender.
    type Source: Copy;
    /// The largest number of paths to one receiver.
    const MOST_PATHS: usize;
    /// Number of travel times of each sender that are examined closely before the best is taken.
    const LOOKED_AT: usize;

    fn tolerance(&self) -> i64;

    fn sources(&self) -> Vec<Self::Source>;

    /// Travel times from a source's firings to unexplained edges, each with its vote; equal votes count once.
    fn travels(&self, source: Self::Source) -> Vec<(i64, i64)>;

    /// Evidence for a path and against it.
    fn support(&self, source: Self::Source, travel_us: i64) -> Support;

    /// Marks a reading as explained by a path, and returns its travel time and the place that [`FoundPath::periods`]
    /// counts.
    fn explain(&mut self, source: Self::Source, travel_us: i64, reading: usize) -> (Option<i64>, u32);

    /// The sender and the receiver of a path from this source.
    fn ends(&self, source: Self::Source) -> (u8, u8);

    /// Prepares the search for the next path.
    fn refresh(&mut self) {}
}

/// Finds the best supported paths, until more than `most` accidents are expected among the places, given by the
/// logarithm of their number.
pub(crate) fn paths<E: Evidence>(of: &mut E, ln_places: f64, most: f64, keep_going: KeepGoing<'_>) -> Vec<FoundPath> {
    let mut found = Vec::new();
    while found.len() < E::MOST_PATHS {
        of.refresh();
        let sources = of.sources().into_iter().take_while(|_| keep_going());
        let best = sources.filter_map(|source| best_of(of, source));
        let Some((source, travel_us, support)) = best.min_by(|a, b| a.2.ln_accident.total_cmp(&b.2.ln_accident)) else {
            break;
        };
        let accidents = (support.ln_accident + ln_places).exp();
        if accidents > most {
            break;
        }
        let (mut travels, mut periods) = (vec![], (u32::MAX, 0));
        for &reading in &support.readings {
            let (travel, period) = of.explain(source, travel_us, reading);
            travels.extend(travel.map(|us| us as f64));
            periods = (periods.0.min(period), periods.1.max(period));
        }
        let travel_us = median(&mut travels);
        let mut off: Vec<_> = travels.iter().map(|travel| (travel - travel_us).abs()).collect();
        // The median of the distances of a normal distribution is 0.6745 of its standard deviation.
        let scatter_us = (median(&mut off) / 0.6745).max(1.0);
        let (sender, receiver) = of.ends(source);
        found.push(FoundPath {
            sender,
            receiver,
            travel_us,
            travel_error_us: scatter_us / (travels.len().max(1) as f64).sqrt(),
            scatter_us,
            offsets: support.offsets,
            accidents,
            readings: support.readings.len() as u32,
            heard: support.heard,
            periods,
        });
    }
    found
}

/// The best supported path of a source.
fn best_of<E: Evidence>(of: &E, source: E::Source) -> Option<(E::Source, i64, Support)> {
    let mut looked_at = Vec::<i64>::new();
    for (_, travel_us) in crowded(of.travels(source), 2 * of.tolerance()) {
        if looked_at.iter().all(|other| (other - travel_us).abs() > 2 * of.tolerance()) {
            looked_at.push(travel_us);
        }
        if looked_at.len() >= E::LOOKED_AT {
            break;
        }
    }
    let places = looked_at.into_iter().map(|travel_us| (source, travel_us, of.support(source, travel_us)));
    places.min_by(|a, b| a.2.ln_accident.total_cmp(&b.2.ln_accident))
}

/// Travel times within an interval of this width, with the number of their votes, the largest first.
fn crowded(mut travels: Vec<(i64, i64)>, width: i64) -> Vec<(usize, i64)> {
    travels.sort_unstable();
    let (mut votes, mut from) = (HashMap::<i64, u32>::new(), 0);
    let mut places = Vec::with_capacity(travels.len());
    for (to, &(travel_us, vote)) in travels.iter().enumerate() {
        *votes.entry(vote).or_default() += 1;
        while travel_us - travels[from].0 > width {
            let left = travels[from].1;
            if let Some(count) = votes.get_mut(&left) {
                *count -= 1;
                if *count == 0 {
                    votes.remove(&left);
                }
            }
            from += 1;
        }
        places.push((votes.len(), travels[from + (to - from) / 2].0));
    }
    places.sort_unstable_by_key(|&(votes, travel_us)| (Reverse(votes), travel_us));
    places
}
