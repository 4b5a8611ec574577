//! Schedules of many phases for a ring: the shortest period, and how long it must be at least.
//!
//! A code moves the firings, lags keep what pairs need between theirs. For a given code and a given order in which
//! sensors take turns, the lags are a system of difference constraints, which relaxation solves (Bellman-Ford) for each
//! period that bisection asks about. Orders are searched by moving one sensor at a time.

use eeruf_core::{
    Criterion, MAX_SENSORS, Micros, Requirements,
    hopping::{HoppingCode, HoppingListening, HoppingSchedule},
};

use crate::phase_file::PhaseSchedule;
use crate::ring::RingSpec;

/// The shortest period for a ring that hops in time.
#[derive(Clone, Debug)]
pub struct HoppingDesign {
    /// The schedule.
    pub schedule: HoppingSchedule<MAX_SENSORS>,
    /// Sets of sensors that fire together by it, bit x for sensor x.
    pub together: Vec<u64>,
    /// No schedule of many phases has a shorter period: with a congruence none that separates sound of every age, with
    /// Welch's sequence none that separates sound of the same period.
    pub period_bound: Micros,
    /// Nor a narrower code than this, the width of which is that of the waits.
    pub width_bound: Micros,
    /// Reason of the bound.
    pub reason: &'static str,
}

/// Firings may catch up with the timetable by so much, which sensors on one echo line must not listen into.
const CATCHES_UP: Micros = Micros::from_millis(1);

/// Orders that are tried for each code.
const ORDERS: u32 = 4_000;

impl HoppingDesign {
    /// Returns true if the period is the shortest that there is, for any schedule of this many phases or more.
    pub fn proven(&self) -> bool {
        self.schedule.period() == self.period_bound
    }

    /// The schedule with the sensors that fire together.
    pub fn phases(&self) -> PhaseSchedule {
        PhaseSchedule::hops(self.schedule, self.together.clone())
    }

    /// The shortest period with a code of at least this many phases, 2 to 67, and lags that keep what every sensor and
    /// pair needs.
    ///
    /// The code is a linear congruence. Where the robot `moves`, or a sensor's own echoes of earlier periods must be
    /// rejected, it is Welch's sequence: crosstalk of a congruence moves as what a robot drives towards, and a sensor's
    /// own sound by the same from each period to the next.
    ///
    /// # Errors
    /// Phases, step, window or period out of range.
    pub fn shortest(sensors: usize, phases: u8, requirements: &Requirements<'_>, moves: bool) -> Result<Self, String> {
        let (window, most) = (requirements.window, HoppingListening::MAX_WINDOW);
        if window > most {
            return Err(format!("a listening window of {window}; expected at most {most} with many phases"));
        }
        let pairs = || (0..sensors).flat_map(|x| (0..sensors).map(move |y| (x, y)));
        let step = pairs().filter_map(|(x, y)| requirements.separation_of(x, y)).max().unwrap_or_default();
        let new = if moves || requirements.stale_echo { HoppingCode::new } else { HoppingCode::shortest };
        let code = new(sensors, phases, step).map_err(|error| error.to_string())?;
        // Which multipliers the sensors have matters to neighbours; the first one lets a sensor fire again soonest.
        let all = if code.is_welch() { 0 } else { code.phases() };
        let others = (0..all).filter_map(|a| HoppingCode::of(sensors, code.phases(), a, step).ok());
        let codes = || std::iter::once(code).chain(others.clone());
        // Codes are compared by their first order, and the best three by all.
        let mut turns: Vec<_> = codes().map(|code| Turns::new(code, requirements)).collect();
        for turns in &mut turns {
            turns.shorten();
        }
        turns.sort_by_key(|turns| turns.period);
        turns.truncate(3);
        for turns in &mut turns {
            turns.search(ORDERS);
        }
        let found = turns.iter().min_by_key(|turns| turns.period).and_then(Turns::schedule);
        let schedule = found.ok_or_else(|| {
            format!("no period up to {}; expected fewer sensors or shorter times", eeruf_core::MAX_PERIOD)
        })?;
        let together = requirements.uneven.map_or(vec![], |uneven| uneven.together.to_vec());
        let units = sensors - together.iter().map(|set| set.count_ones() as usize - 1).sum::<usize>();
        let least = pairs().filter(|(x, y)| x != y).filter_map(|(x, y)| requirements.separation_of(x, y)).min();
        let apart = (units as u32 - 1).saturating_mul(least.unwrap_or_default().as_micros());
        let width_bound = Micros::new(if code.is_welch() { apart / 2 } else { apart });
        let (period_bound, reason) = period_bound(sensors, requirements, width_bound);
        Ok(Self { schedule, together, period_bound, width_bound, reason })
    }
}

impl RingSpec {
    /// Requirements on a schedule of many phases for this ring; sound is heard for as long as the window. `t_delta` is
    /// that of a robot that stands: tracks of echoes move with the robot, as odometry tells.
    pub fn phase_requirements(&self, criterion: Criterion) -> Requirements<'_> {
        let requirements = self.problem().requirements;
        let stale_echo = self.stale_echo && (self.hops_moving() || !self.stale_echo_by_module);
        Requirements { criterion, stale_echo, ..requirements }
    }

    /// Returns true if a ring that hops must tell crosstalk from what the robot drives towards.
    fn hops_moving(&self) -> bool {
        self.speed_mm_s.is_some_and(|speed| speed > 0)
    }

    /// As [`HoppingDesign::shortest`], for this ring.
    ///
    /// # Errors
    /// As there.
    pub fn hopping(&self, phases: u8, criterion: Criterion) -> Result<HoppingDesign, String> {
        if self.handling != Micros::ZERO {
            return Err("handling_us in a ring file for many phases; expected it for two phases only".to_owned());
        }
        if self.path_change.is_some() {
            let expected = "expected --margin-us, which is what a path may change by and lateness, less 1 us";
            return Err(format!("path_change_us in a ring file for many phases; {expected}"));
        }
        HoppingDesign::shortest(self.sensors, phases, &self.phase_requirements(criterion), self.hops_moving())
    }
}

/// No schedule of many phases is shorter that separates sound as the code of this width bound does (theory.md, section
/// 9.3).
fn period_bound(sensors: usize, requirements: &Requirements<'_>, width_bound: Micros) -> (Micros, &'static str) {
    let rests = || (0..sensors).map(|x| requirements.window_of(x).max(requirements.refire_of(x)));
    let code = rests().min().unwrap_or_default().saturating_add(width_bound);
    let bounds = [
        (code, "the window and the code: of K sensors one must fire (K - 1) D sooner again than a period later"),
        (rests().max().unwrap_or_default(), "the sensor that rests longest"),
        (
            spacing(sensors, requirements),
            "the neighbours: this many fire in each period, each this long after the one before",
        ),
    ];
    // The first of equal ones.
    bounds.into_iter().rev().max_by_key(|&(bound, _)| bound).unwrap_or_default()
}

/// The time that sensors need to fire one after the other: of each interval that pairs need, as often as there are
/// sensors all of whose pairs need it, by the cliques that are first found from each sensor on.
fn spacing(sensors: usize, requirements: &Requirements<'_>) -> Micros {
    let gap = |x, y| requirements.gap_after(sensors, x, y).min(requirements.gap_after(sensors, y, x));
    let pairs = || (0..sensors).flat_map(|x| (0..x).map(move |y| (x, y)));
    let mut gaps: Vec<Micros> = pairs().map(|(x, y)| gap(x, y)).collect();
    gaps.sort_unstable();
    gaps.dedup();
    let time = |least: Micros| {
        let grown = |from: usize| {
            let mut members = vec![from];
            for sensor in 0..sensors {
                if sensor != from && members.iter().all(|&member| gap(member, sensor) >= least) {
                    members.push(sensor);
                }
            }
            members.len() as u32
        };
        // A single sensor is no set of neighbours.
        let members = (0..sensors).map(grown).filter(|&members| members > 1).max().unwrap_or(0);
        Micros::new(members.saturating_mul(least.as_micros()))
    };
    gaps.into_iter().map(time).max().unwrap_or_default()
}

/// In a period of the second sensor's, the first one's firing must be at least `apart` later than the other's, give
/// and take `periods` of them.
struct Bound {
    from: usize,
    to: usize,
    apart: i64,
    periods: i64,
}

/// A code, the order in which sensors take turns, and the shortest period with it.
struct Turns<'r> {
    code: HoppingCode,
    requirements: &'r Requirements<'r>,
    /// The sensors by their turns, those that fire together by the first of them.
    order: Vec<usize>,
    /// In microseconds; more than allowed if there is none yet.
    period: i64,
}

impl<'r> Turns<'r> {
    /// Neighbours take turns in the order of the first free turn of each sensor.
    fn new(code: HoppingCode, requirements: &'r Requirements<'r>) -> Self {
        let sensors = code.sensors();
        let needs = |x, y| requirements.gap_after(sensors, x, y).max(requirements.gap_after(sensors, y, x));
        let mut order: Vec<usize> =
            (0..sensors).filter(|&x| (0..x).all(|before| !requirements.fire_together(before, x))).collect();
        let mut turns = vec![0; sensors];
        for (place, &sensor) in order.iter().enumerate() {
            let others = order.iter().take(place).filter(|&&x| needs(x, sensor) > Micros::ZERO);
            let taken: Vec<usize> = others.map(|&x| turns[x]).collect();
            turns[sensor] = (0..).find(|turn| !taken.contains(turn)).unwrap_or(0);
        }
        order.sort_by_key(|&sensor| (turns[sensor], sensor));
        Self { code, requirements, order, period: us(eeruf_core::MAX_PERIOD) + 1 }
    }

    /// The period that every order needs: each sensor rests, no path reads the same with two ages, and there is room
    /// for a lag and the code.
    fn least(&self) -> i64 {
        let requirements = self.requirements;
        let fires_after = |x: usize| {
            let leader = (0..x).find(|&other| requirements.fire_together(other, x)).unwrap_or(x);
            us(requirements.window_of(x).max(requirements.refire_of(x))) + us(self.code.drop_of(leader as u8))
        };
        let rests = (0..self.code.sensors()).map(fires_after).max().unwrap_or(0);
        rests.max(2 * us(self.code.width()) + us(self.code.step()))
    }

    /// Sets the shortest period of the present order, if it is shorter. Returns true if so.
    fn shorten(&mut self) -> bool {
        let bounds = self.bounds();
        let (mut low, mut high) = (self.least(), self.period - 1);
        if low > high || self.lags(&bounds, high).is_none() {
            return false;
        }
        while low < high {
            let middle = i64::midpoint(low, high);
            if self.lags(&bounds, middle).is_some() {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        self.period = high;
        true
    }

    /// Moves one sensor to another place, again and again, and keeps each order that is shorter.
    fn search(&mut self, orders: u32) {
        // Of xorshift; any seed but 0 does.
        let mut random = 0x9e37_79b9_u32;
        let mut below = |bound: usize| {
            random ^= random << 13;
            random ^= random >> 17;
            random ^= random << 5;
            random as usize % bound.max(1)
        };
        for _ in 0..orders {
            if self.period <= self.least() {
                return;
            }
            let before = self.order.clone();
            for _ in 0..=below(2) {
                let sensor = self.order.remove(below(before.len()));
                self.order.insert(below(before.len()), sensor);
            }
            if !self.shorten() {
                self.order = before;
            }
        }
    }

    /// Bounds on the lags of sensors that need time between their firings.
    fn bounds(&self) -> Vec<Bound> {
        let (code, requirements, sensors) = (&self.code, self.requirements, self.code.sensors());
        // A unit is a sensor with those that fire together with it.
        let units: Vec<Vec<usize>> = self
            .order
            .iter()
            .map(|&first| (0..sensors).filter(|&x| x == first || requirements.fire_together(first, x)).collect())
            .collect();
        let mut turns = vec![0; units.len()];
        let mut before = 0;
        for (turn, unit) in turns.iter_mut().zip(&units) {
            *turn = if code.is_welch() { before } else { unit[0] };
            before += unit.len();
        }
        let wait = |unit: usize, phase: u8| us(code.wait(turns[unit], phase));
        let mut bounds = vec![];
        for (x, y) in (0..units.len()).flat_map(|y| (0..y).map(move |x| (x, y))) {
            let gap = |from: usize, to: usize| {
                let all = units[from].iter().flat_map(|&a| units[to].iter().map(move |&b| (a, b)));
                let more = |a, b| if requirements.share_a_line(a, b) { CATCHES_UP } else { Micros::ZERO };
                let gaps = all.map(|(a, b)| requirements.gap_after(sensors, a, b).saturating_add(more(a, b)));
                us(gaps.max().unwrap_or_default())
            };
            let (first, second) = (gap(x, y), gap(y, x));
            let most = |difference: &dyn Fn(u8) -> i64| (0..code.phases()).map(difference).max().unwrap_or(0);
            let (from, to) = (self.order[x], self.order[y]);
            if first > 0 || second > 0 {
                // y after x in each period, and x after y in the next.
                let within = most(&|phase| wait(x, phase) - wait(y, phase));
                let across = most(&|phase| wait(y, phase) - wait(x, phase + 1));
                bounds.push(Bound { from, to, apart: first + within, periods: 0 });
                bounds.push(Bound { from: to, to: from, apart: second + across, periods: 1 });
            }
            if code.is_welch() && y == x + 1 {
                // Its places are those of the order of lags.
                bounds.push(Bound { from, to, apart: 1, periods: 0 });
            }
        }
        bounds
    }

    /// The lags of a period, if it is long enough.
    fn lags(&self, bounds: &[Bound], period: i64) -> Option<[i64; MAX_SENSORS]> {
        let room = period - us(self.code.width()) - 1;
        let mut lags = [0; MAX_SENSORS];
        // With more rounds than sensors there is a circle of constraints that this period does not satisfy.
        for _ in 0..=self.order.len() {
            let mut changed = false;
            for &Bound { from, to, apart, periods } in bounds {
                let later = lags[from] + apart - periods * period;
                if later > lags[to] {
                    if later > room {
                        return None;
                    }
                    (lags[to], changed) = (later, true);
                }
            }
            if !changed {
                return Some(lags);
            }
        }
        None
    }

    fn schedule(&self) -> Option<HoppingSchedule<MAX_SENSORS>> {
        let lags = self.lags(&self.bounds(), self.period)?;
        let mut all = [Micros::ZERO; MAX_SENSORS];
        for &first in &self.order {
            for (sensor, lag) in all.iter_mut().enumerate().take(self.code.sensors()) {
                if sensor == first || self.requirements.fire_together(first, sensor) {
                    *lag = Micros::new(lags[first] as u32);
                }
            }
        }
        HoppingSchedule::new(self.code, Micros::new(self.period as u32), all).ok()
    }
}

fn us(time: Micros) -> i64 {
    i64::from(time.as_micros())
}
