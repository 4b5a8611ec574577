//! Figures of ways under conditions, their settings and costs, and the recommended way.

use serde::Serialize;

use super::bootstrap::{Bootstrap, Estimate, Latencies};
use super::run::{Measured, Under};
use super::sight::Sight;
use super::trial::Condition;
use super::votes::Setting;
use super::ways::Family;

/// Largest rate of false stops, per minute, at which ways are compared.
pub const ONE_A_MINUTE: f64 = 1.0;
/// Number of rooms from which on a difference above [`NO_DRAW`] is not a draw.
const MANY_ROOMS: usize = 400;
const NO_DRAW: f64 = 0.2;

/// A way with its votes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// The index of the way.
    pub way: usize,
    /// The votes.
    pub setting: Setting,
}

/// The setting at which a family is used under a condition, chosen in rooms that are not reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operating {
    /// The setting with the least mean time until a thing is seen, of those with no more false stops than asked for.
    At(Point),
    /// No setting has few enough false stops; this setting has the fewest.
    None(Point),
}

impl Operating {
    /// Returns the setting, whether or not it has few enough false stops.
    pub fn point(self) -> Point {
        let (Self::At(point) | Self::None(point)) = self;
        point
    }
}

/// Figures of a way and setting under a condition.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Number of things.
    pub things: usize,
    /// The times in which 50 % and 90 % of the things are seen, in ms.
    pub t50_t90_ms: [f64; 2],
    /// The time in which 95 % of the things are seen, in ms; infinite if fewer are.
    pub t95_ms: Estimate,
    /// The mean time until a thing is seen, at most a second each, in ms.
    pub mean_ms: Estimate,
    /// The share of things that are never seen.
    pub never: f64,
    /// Number of false stops.
    pub false_stops: u32,
    /// The time over which false stops were counted, in minutes.
    pub minutes: f64,
    /// False stops per minute.
    pub false_stops_per_min: Estimate,
    /// Share of time in which foreign sound is believed and wrong.
    pub foreign: Estimate,
    /// Share of time with an echo in which the belief is right.
    pub right: Estimate,
    /// Right echoes that are believed, per second.
    pub right_echoes_per_s: Estimate,
    /// Number of blind sensors.
    pub blind: Estimate,
}

impl Under {
    /// The figures of each room at a point.
    pub fn sights(&self, Point { way, setting }: Point) -> &[Sight] {
        let index = Setting::ALL.iter().position(|&it| it == setting).unwrap_or(0);
        self.sights[way].as_ref().map_or(&[], |by_setting| &by_setting[index])
    }

    /// Returns true if the ring can be fired this way. Only ways of one by one use the median.
    fn fires(&self, measured: &Measured, Point { way, setting }: Point) -> bool {
        let fits = setting != Setting::Median || measured.ways[way].family == Family::OneByOne;
        fits && self.sights[way].is_ok()
    }

    fn mean_and_rate(&self, point: Point) -> (f64, f64) {
        let sights = self.sights(point);
        let latencies = Latencies::new(sights.iter().map(|sight| sight.latency_ms));
        (latencies.mean_ms(&vec![1; sights.len()]), rate(sights, &vec![1; sights.len()]))
    }

    /// The point at which a group is used with at most this many false stops a minute. For each way it is the most
    /// eager setting if that has few enough, else the quickest of those that do; of these it is the quickest, by the
    /// mean time until a thing is seen. `None` if no way can fire the ring.
    pub fn operating(&self, measured: &Measured, group: &[Point], most_per_min: f64) -> Option<Operating> {
        let points = group.iter().filter(|&&point| self.fires(measured, point));
        let figures: Vec<_> = points.map(|&point| (point, self.mean_and_rate(point))).collect();
        let eager = |way: usize| {
            figures
                .iter()
                .any(|&(point, (_, rate))| point == Point { way, setting: Setting::ALL[0] } && rate <= most_per_min)
        };
        let keeps = |&&(point, (_, rate)): &&(Point, (f64, f64))| {
            rate <= most_per_min && (point.setting == Setting::ALL[0] || !eager(point.way))
        };
        let quickest = figures.iter().filter(keeps).min_by(|one, other| one.1.0.total_cmp(&other.1.0));
        let fewest = || figures.iter().min_by(|one, other| one.1.1.total_cmp(&other.1.1));
        quickest.map(|of| Operating::At(of.0)).or_else(|| fewest().map(|of| Operating::None(of.0)))
    }

    /// Computes the figures at a point.
    pub fn cell(&self, point: Point, measured: &Measured) -> Cell {
        let sights = self.sights(point);
        let latencies = Latencies::new(sights.iter().map(|sight| sight.latency_ms));
        let bootstrap = measured.bootstrap(self.condition);
        let mean = |of: fn(&Sight) -> f64| {
            Estimate::of(&bootstrap.figures(|counts| {
                let known = || sights.iter().zip(counts).filter(|(sight, _)| !of(sight).is_nan());
                let all: f64 = known().map(|(_, &count)| f64::from(count)).sum();
                known().map(|(sight, &count)| f64::from(count) * of(sight)).sum::<f64>() / all
            }))
        };
        Cell {
            things: latencies.len(),
            t50_t90_ms: [0.5, 0.9].map(|share| latencies.within_ms(share, &vec![1; sights.len()])),
            t95_ms: Estimate::of(&bootstrap.figures(|counts| latencies.t95_ms(counts))),
            mean_ms: Estimate::of(&bootstrap.figures(|counts| latencies.mean_ms(counts))),
            never: latencies.never(),
            false_stops: sights.iter().map(|sight| sight.false_stops).sum(),
            minutes: sights.iter().map(|sight| sight.watched_s).sum::<f64>() / 60.0,
            false_stops_per_min: Estimate::of(&bootstrap.figures(|counts| rate(sights, counts))),
            foreign: mean(|sight| sight.foreign),
            right: mean(|sight| sight.right),
            right_echoes_per_s: mean(|sight| sight.right_echoes_per_s),
            blind: mean(|sight| f64::from(sight.blind)),
        }
    }
}

/// Returns the false stops per minute with these weights of rooms.
fn rate(sights: &[Sight], counts: &[u16]) -> f64 {
    let sum = |of: fn(&Sight) -> f64| -> f64 {
        sights.iter().zip(counts).map(|(sight, &count)| of(sight) * f64::from(count)).sum()
    };
    60.0 * sum(|sight| f64::from(sight.false_stops)) / sum(|sight| sight.watched_s)
}

/// The cost of a group of ways; under each condition the best way of the group counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Operating points under each condition; fewer if no way of the group can fire the ring.
    pub operating: Vec<Operating>,
    /// The geometric mean over the conditions of its mean time until a thing is seen, at most a second each, relative
    /// to the base's, which may have more false stops; `None` without an operating point under a condition.
    pub cost: Option<Estimate>,
}

/// Costs of groups of ways, simplest first, and the recommended group, given by its index.
#[derive(Clone, Debug, PartialEq)]
pub struct Costs {
    /// The cost of each group.
    pub costs: Vec<Cost>,
    /// The recommended group; `None` if no group has a point under each condition.
    pub recommended: Option<usize>,
    /// A group of lower cost that does not differ significantly from the recommended one.
    pub draw: Option<usize>,
    /// A group that does not differ significantly from the recommended one, whether it costs less or more.
    pub rival: Option<usize>,
}

impl Measured {
    /// Returns bootstrap samples, the same for all conditions of a set of rooms.
    pub(super) fn bootstrap(&self, condition: Condition) -> Bootstrap {
        let rooms = self.under.iter().find(|under| under.condition == condition).map_or(0, |under| under.places.len());
        Bootstrap::new(rooms, u64::from(condition.others))
    }

    /// The geometric mean over the conditions of one way's mean time until a thing is seen relative to another's, with
    /// its interval.
    fn ratio(&self, ones: &[Point], others: &[Point]) -> Estimate {
        let mut logs: Vec<f64> = vec![];
        for ((under, &one), &other) in self.under.iter().zip(ones).zip(others) {
            let of = |point| Latencies::new(under.sights(point).iter().map(|sight| sight.latency_ms));
            let (one, other) = (of(one), of(other));
            let log = |counts: &[u16]| libm::log(one.mean_ms(counts) / other.mean_ms(counts));
            let of_condition = self.bootstrap(under.condition).figures(log);
            logs.resize(of_condition.len(), 0.0);
            logs.iter_mut().zip(of_condition).for_each(|(sum, log)| *sum += log);
        }
        let conditions = self.under.len().max(1) as f64;
        Estimate::of(&logs.iter().map(|sum| libm::exp(sum / conditions)).collect::<Vec<_>>())
    }

    /// Returns true if there are surely more false stops than one a minute, whatever was chosen.
    fn surely_stops(&self, under: &Under, point: Point) -> bool {
        let sights = under.sights(point);
        let rates = self.bootstrap(under.condition).figures(|counts| rate(sights, counts));
        Estimate::of(&rates).interval_95[0] > ONE_A_MINUTE
    }

    /// The costs of groups of points, each chosen in other rooms of the same conditions, relative to a base, and the
    /// group to recommend: the one of the least cost, or a simpler one if the difference is not significant. A group
    /// that significantly exceeds one false stop a minute here is left out.
    pub fn costs(&self, chosen: &Self, base: &[Point], groups: &[Vec<Point>]) -> Costs {
        let operating = |group: &[Point]| -> Vec<Operating> {
            chosen.under.iter().filter_map(|under| under.operating(chosen, group, ONE_A_MINUTE)).collect()
        };
        let keeping = |operating: &Vec<Operating>| -> Option<Vec<Point>> {
            let at = |(operating, under): (&Operating, &Under)| match operating {
                Operating::At(point) if !self.surely_stops(under, *point) => Some(*point),
                _ => None,
            };
            let points = operating.iter().zip(&self.under).map(at).collect::<Option<Vec<_>>>();
            points.filter(|points| points.len() == self.under.len())
        };
        // Others are measured by the base even where it has more false stops than one a minute.
        let base: Vec<Point> = operating(base).iter().map(|it| it.point()).collect();
        let operating: Vec<_> = groups.iter().map(|group| operating(group)).collect();
        let points: Vec<_> = operating.iter().map(keeping).collect();
        let has_base = base.len() == self.under.len();
        let against_base = |points: &Option<Vec<Point>>| Some(self.ratio(points.as_ref().filter(|_| has_base)?, &base));
        let costs = operating.into_iter().zip(&points);
        let costs = costs.map(|(operating, points)| Cost { operating, cost: against_base(points) }).collect();
        let usable: Vec<(usize, &Vec<Point>)> =
            points.iter().enumerate().filter_map(|(group, points)| Some((group, points.as_ref()?))).collect();
        let [recommended, draw, rival] = self.recommend(&usable);
        Costs { costs, recommended, draw, rival }
    }

    /// Recommends one of several groups, given with their points under each condition, simplest first. Also returns a
    /// group of lower cost, and one of any cost, that do not differ significantly from the recommended one.
    fn recommend(&self, usable: &[(usize, &Vec<Point>)]) -> [Option<usize>; 3] {
        let Some((_, first)) = usable.first() else { return [None; 3] };
        let values: Vec<f64> = usable.iter().map(|(_, points)| self.ratio(points, first).value).collect();
        let best = (1..usable.len()).fold(0, |best, next| if values[next] < values[best] { next } else { best });
        let rooms = self.under.iter().map(|under| under.places.len()).min().unwrap_or(0);
        let is_draw = |&simpler: &usize| {
            let ratio = self.ratio(usable[simpler].1, usable[best].1);
            ratio.holds(1.0) && (rooms < MANY_ROOMS || ratio.value <= 1.0 + NO_DRAW)
        };
        match (0..best).find(is_draw) {
            Some(simpler) => [simpler, best, best].map(|index| Some(usable[index].0)),
            None => {
                let rival =
                    (best + 1..usable.len()).find(|&next| self.ratio(usable[next].1, usable[best].1).holds(1.0));
                [Some(usable[best].0), None, rival.map(|index| usable[index].0)]
            }
        }
    }
}
