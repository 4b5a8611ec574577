//! The lines on which named readings lie: paths, each for as long as its rate is constant.

use std::collections::BTreeMap;

use super::super::statistics::groups;
use super::super::timeline::{Heard, Timeline};
use super::super::{FoundPath, Named, Settings};
use super::prior::MOST_RATE;

/// Pause after which a line ends, in microseconds.
const ENDS_US: i64 = 500_000;
/// Least number of readings of a line.
const FEWEST: usize = 3;

/// A reading that came along a line.
#[derive(Clone, Copy)]
struct Point {
    heard: Heard,
    at_us: i64,
    travel_us: f64,
    sure: f64,
}

/// A line, with the sums for its fit, counted from its first point.
struct Line {
    points: Vec<Point>,
    /// Sums of the times and of the travel times, of their squares, and of their products.
    sums: [f64; 5],
}

impl Line {
    fn new(point: Point) -> Self {
        Self { points: vec![point], sums: [0.0; 5] }
    }

    fn since_first(&self, point: &Point) -> (f64, f64) {
        let first = self.points.first().unwrap_or(point);
        ((point.at_us - first.at_us) as f64, point.travel_us - first.travel_us)
    }

    /// Rate, travel time at the first point, and scatter, rms.
    fn fit(&self) -> (f64, f64, f64) {
        let n = self.points.len() as f64;
        let [t, l, tt, ll, tl] = self.sums;
        let (spread, product) = (tt - t * t / n, tl - t * l / n);
        let rate = if spread > 0.0 { product / spread } else { 0.0 };
        let scatter_us = ((ll - l * l / n - rate * product).max(0.0) / n).sqrt();
        let first = self.points.first().map_or(0.0, |first| first.travel_us);
        (rate, first + (l - rate * t) / n, scatter_us)
    }

    /// Difference of a point from the line, if it may be the next one.
    fn off_us(&self, point: &Point, tolerance_us: f64) -> Option<f64> {
        let last = self.points.last()?;
        let since_us = point.at_us - last.at_us;
        let (t, _) = self.since_first(point);
        let off_us = if self.points.len() > 1 {
            let (rate, at_first, _) = self.fit();
            (point.travel_us - at_first - rate * t).abs()
        } else {
            let changes_us = (point.travel_us - last.travel_us).abs();
            if changes_us > 1e-3 * MOST_RATE * since_us as f64 + tolerance_us {
                return None;
            }
            // A line of one point is the last choice.
            tolerance_us
        };
        (since_us <= ENDS_US && off_us <= tolerance_us).then_some(off_us)
    }

    fn add(&mut self, point: Point) {
        let (t, l) = self.since_first(&point);
        for (sum, by) in self.sums.iter_mut().zip([t, l, t * t, l * l, t * l]) {
            *sum += by;
        }
        self.points.push(point);
    }
}

/// The lines of named readings, by receiver, those with most readings first.
pub(super) fn lines(timeline: &Timeline, settings: &Settings, named: &[Option<Named>]) -> Vec<FoundPath> {
    let tolerance_us = f64::from(settings.tolerance_us);
    let mut paths = Vec::new();
    for receiver in 0..timeline.sensors() as u8 {
        let mut by_sender = BTreeMap::<u8, Vec<Line>>::new();
        for heard in timeline.heard_by(receiver) {
            let (Some(echo_us), Some(named)) = (heard.echo_us, named[heard.firing]) else { continue };
            let (at_us, travel_us, sure) = (heard.fired_us + echo_us, named.travel_us, named.sure);
            let point = Point { heard: *heard, at_us, travel_us, sure };
            let lines = by_sender.entry(named.sender).or_default();
            // Lines that have ended are not looked through again.
            let open = lines.iter_mut().rev().take(MOST_OPEN);
            let next = open.filter_map(|line| line.off_us(&point, tolerance_us).map(|off_us| (off_us, line)));
            match next.min_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((_, line)) => line.add(point),
                None => lines.push(Line::new(point)),
            }
        }
        let lines = by_sender.into_iter().flat_map(|(sender, lines)| lines.into_iter().map(move |line| (sender, line)));
        let lines = lines.filter(|(_, line)| line.points.len() >= FEWEST);
        let mut found: Vec<_> =
            lines.filter_map(|(sender, line)| path((sender, receiver), &line, timeline, settings)).collect();
        found.sort_by_key(|path| core::cmp::Reverse(path.readings));
        paths.extend(found);
    }
    paths
}

/// Number of lines from one sender to one receiver that are followed at a time.
const MOST_OPEN: usize = 16;

fn path((sender, receiver): (u8, u8), line: &Line, timeline: &Timeline, settings: &Settings) -> Option<FoundPath> {
    let tolerance_us = i64::from(settings.tolerance_us.max(1));
    let (first, last) = (line.points.first()?, line.points.last()?);
    let (rate, at_first_us, scatter_us) = line.fit();
    let readings = line.points.len() as u32;
    let mut path = FoundPath {
        sender,
        receiver,
        travel_us: at_first_us + 0.5 * rate * (last.at_us - first.at_us) as f64,
        travel_error_us: scatter_us.max(1.0) / f64::from(readings).sqrt(),
        scatter_us: scatter_us.max(1.0),
        offsets: (0, 0),
        accidents: line.points.iter().map(|point| 1.0 - point.sure).fold(1.0, f64::min).max(f64::EPSILON),
        readings,
        heard: 0.0,
        periods: (first.heard.firing as u32, last.heard.firing as u32),
        rate_us_s: Some(1e6 * rate),
    };
    // Offsets at which it was heard, and at which it could be heard, and the readings that could hear it.
    let (mut supporting, mut possible, mut could_hear) = (Vec::new(), Vec::new(), 0);
    let heard = timeline.heard_by(receiver);
    let from = heard.partition_point(|of| of.fired_us < first.heard.fired_us);
    let sent = timeline.heard_by(sender);
    for of in heard[from..].iter().take_while(|of| of.fired_us <= last.heard.fired_us) {
        let earliest = sent.partition_point(|sent| (sent.fired_us as f64) < of.fired_us as f64 - path.travel_us);
        for sent in sent[earliest..].iter().take_while(|sent| sent.fired_us <= of.fired_us + timeline.window_us) {
            let since_us = (sent.fired_us - first.at_us) as f64 + path.travel_us;
            if !(0.0..=(last.at_us - first.at_us) as f64).contains(&since_us) {
                continue;
            }
            let travel_us = at_first_us + rate * since_us;
            let offset_us = sent.fired_us - of.fired_us;
            let predicted_us = offset_us + travel_us as i64;
            if predicted_us > timeline.window_us || of.echo_us.is_some_and(|echo| echo < predicted_us - tolerance_us) {
                continue;
            }
            could_hear += 1;
            possible.push(offset_us);
            if of.echo_us.is_some_and(|echo| echo <= predicted_us + tolerance_us) {
                supporting.push(offset_us);
            }
        }
    }
    path.heard = supporting.len() as f64 / f64::from(could_hear.max(1));
    let count = |mut offsets: Vec<i64>| {
        offsets.sort_unstable();
        groups(&offsets, 2 * tolerance_us).len() as u32
    };
    path.offsets = (count(supporting), count(possible));
    Some(path)
}
