//! One run of a board in its simulated world, compared with the reference and the control.

use core::fmt;

use eeruf_core::{Edge, Instant, Micros, Reading, ReadingKind, Ring, RingEvent, judge::Judge, plan::Plan};
use eeruf_hc_sr04::Health;
use eeruf_hil::{CONFIG, Orders, SCHEDULE, SENSORS, Topic, flow_ring};
use eeruf_sim::{Readings, World};

use crate::control::Control;
use crate::emulator::Emulator;
use crate::lines::{FAULTY, LineFault, Lines};
use crate::played::PlayedLines;
use crate::reference::{Read, Reference, Session};

/// Number of periods in each run of the tables.
pub(crate) const PERIODS: u32 = 1000;

/// The fault in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    None,
    Line(LineFault),
    /// The main loop stalls for 50 ms after a period's end.
    Stall,
    /// The clock wraps in the middle of the run.
    Wrap,
}

const STALL_AFTER: u32 = PERIODS / 2;
const STALL: Micros = Micros::from_millis(50);

/// Largest change of an echo time between runs.
const MOST_MOVED: Micros = Micros::new(25);

impl Fault {
    /// All faults.
    pub(crate) const ALL: [Self; 6] = [
        Self::Line(LineFault::Missing),
        Self::Line(LineFault::StuckHigh),
        Self::Line(LineFault::Chatters),
        Self::Line(LineFault::InterruptsLost),
        Self::Stall,
        Self::Wrap,
    ];

    /// Returns the fault with this name on the command line.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "none" => Self::None,
            "missing" => Self::Line(LineFault::Missing),
            "stuck" => Self::Line(LineFault::StuckHigh),
            "chatters" => Self::Line(LineFault::Chatters),
            "interrupts-lost" => Self::Line(LineFault::InterruptsLost),
            "stall" => Self::Stall,
            "wrap" => Self::Wrap,
            _ => return None,
        })
    }

    /// Orders for this many periods of 100 ms; the clock wraps or the main loop stalls in the middle.
    fn orders(self, periods: u32) -> Orders {
        let start = if self == Self::Wrap { 0_u32.wrapping_sub(periods / 2 * 100_000) } else { 0 };
        let stall = if self == Self::Stall { STALL } else { Micros::ZERO };
        Orders { start: Instant::from_micros(start), periods, stall_after: periods / 2, stall }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Line(fault) => write!(f, "sensor {} {fault}", FAULTY + 1),
            Self::Stall => write!(f, "main loop stalls for {STALL}"),
            Self::Wrap => f.write_str("clock wraps"),
        }
    }
}

/// The outcome of a run.
pub(crate) struct Run {
    pub(crate) read: Read,
    /// The greatest delay until the board noticed an edge.
    pub(crate) latest_edge: Micros,
    /// The largest lateness of a firing.
    pub(crate) max_late: Micros,
    /// The last reported fault of each sensor that had one.
    named: [Health; SENSORS],
    /// The period at whose end the fault was first reported.
    named_after: Option<u32>,
}

/// Difference of the healthy sensors' readings from a run without a fault.
pub(crate) struct Change {
    /// Number of readings of another kind.
    pub(crate) kinds: usize,
    /// Changes of echo times.
    pub(crate) moved: Micros,
}

/// The speed of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// As fast as the emulation allows.
    Free,
    /// In real time, for programs that listen to the board's serial line.
    Wall,
}

/// Runs a board whose ring fires by the table of two phases. If a line has a fault, the readings of the other sensors
/// are compared with the control.
pub(crate) fn run(world: &World, fault: Fault, periods: u32, pace: Pace, emulator: &[String]) -> Result<Run, String> {
    let make = |now| Ring::new(&SCHEDULE, CONFIG, now).map_err(|error| error.to_string());
    run_ring(world, (fault, None), periods, pace, emulator, make, true)
}

/// Runs a board in real time, with these edges on its lines.
pub(crate) fn run_played(world: &World, lines: PlayedLines, periods: u32, emulator: &[String]) -> Result<Run, String> {
    let make = |now| Ring::new(&SCHEDULE, CONFIG, now).map_err(|error| error.to_string());
    run_ring(world, (Fault::None, Some(lines)), periods, Pace::Wall, emulator, make, false)
}

/// Runs a board whose ring fires by flow. There is no control: the firing times depend on what all sensors hear, so a
/// ring without the fault fires at other times.
pub(crate) fn run_flow(world: &World, fault: Fault, periods: u32, emulator: &[String]) -> Result<Run, String> {
    let make = |now| flow_ring(now).map_err(|error| error.to_string());
    run_ring(world, (fault, None), periods, Pace::Free, emulator, make, false)
}

fn run_ring<P: Plan, J: Judge, const H: usize>(
    world: &World,
    (fault, played): (Fault, Option<PlayedLines>),
    periods: u32,
    pace: Pace,
    emulator: &[String],
    make: impl Fn(Instant) -> Result<Ring<P, J, SENSORS, 1, H>, String>,
    has_control: bool,
) -> Result<Run, String> {
    let orders = fault.orders(periods);
    let line_fault = if let Fault::Line(fault) = fault { fault } else { LineFault::None };
    let pace = (pace == Pace::Wall).then_some(orders.start);
    let lines = Lines::new(world, line_fault, orders.start)?.with_played(played);
    let session = Session::new(Emulator::start(emulator, orders)?, lines, pace);
    let outcome = (|| {
        // The first record of a board says when it set up its ring.
        let now = session.borrow_mut().expect(Topic::Deadline, 0)?.instant();
        let mut reference = Reference::new(&session, make(now)?)?;
        let mut control = if has_control { Some(Control::new(now, FAULTY)?) } else { None };
        let mut run = Run {
            read: Default::default(),
            latest_edge: Micros::ZERO,
            max_late: Micros::ZERO,
            named: [Health::Well; SENSORS],
            named_after: None,
        };
        let mut ended = 0;
        loop {
            let record = session.borrow_mut().board.next()?;
            let Some(record) = record else { break };
            match record.topic() {
                Some(Topic::Edge) => {
                    let edge = Edge { sensor: record.sensor(), high: record.flag() != 0, at: record.instant() };
                    reference.edge(edge)?;
                    if let Some(control) = &mut control {
                        control.edge(edge)?;
                    }
                }
                Some(Topic::Poll) => {
                    let event = reference.poll(record.instant())?;
                    if let Some(control) = &mut control {
                        control.after_poll(record.instant(), event.as_ref())?;
                    }
                    match event {
                        Some(RingEvent::Reading(reading)) => run.take(reading),
                        Some(RingEvent::PeriodEnded(stats)) => {
                            run.max_late = run.max_late.max(stats.max_late);
                            ended += 1;
                        }
                        _ => {}
                    }
                }
                Some(Topic::State) => {
                    reference.compare(record)?;
                    if record.flag() > 0 {
                        return Err(format!("{} edges found the queue full", record.flag()));
                    }
                    run.name(reference.health(), ended);
                }
                Some(Topic::Deadline) => reference.compare(record)?,
                _ => return Err(format!("the board said {record:?} out of turn")),
            }
        }
        if ended != periods {
            return Err(format!("the board ended after {ended} periods of {periods}"));
        }
        if let (Fault::Line(_), Some(control)) = (fault, &control) {
            run.others_are(&control.read)?;
        }
        run.latest_edge = session.borrow().lines.latest;
        Ok(run)
    })();
    let Ok(session) = std::rc::Rc::try_unwrap(session) else { return Err("pins outlive their ring".to_owned()) };
    let (run, outcome) = match outcome {
        Ok(run) => (Some(run), Ok(())),
        Err(error) => (None, Err(error)),
    };
    session.into_inner().board.finish(outcome)?;
    run.ok_or_else(|| "nothing came of the run".to_owned())
}

impl Run {
    fn take(&mut self, reading: Reading) {
        if let Some(read) = self.read.get_mut(usize::from(reading.sensor)) {
            read.push(reading);
        }
    }

    fn name(&mut self, health: [Health; SENSORS], period: u32) {
        for (named, health) in self.named.iter_mut().zip(health) {
            if health != Health::Well {
                *named = health;
                self.named_after.get_or_insert(period);
            }
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.read.iter().map(Vec::len).sum()
    }

    /// Returns the number of readings of a kind, over all sensors or all but one.
    pub(crate) fn of(&self, kind: ReadingKind, but: Option<u8>) -> usize {
        let sensors = self.read.iter().enumerate().filter(|&(sensor, _)| Some(sensor) != but.map(usize::from));
        sensors.flat_map(|(_, read)| read).filter(|reading| reading.kind == kind).count()
    }

    /// The least share of believed readings, tentative or confirmed, among all sensors but one.
    pub(crate) fn least_believed(&self, but: Option<u8>) -> f64 {
        let sensors = self.read.iter().enumerate().filter(|&(sensor, _)| Some(sensor) != but.map(usize::from));
        let share = |read: &[Reading]| {
            let believed = [ReadingKind::Accepted, ReadingKind::Tentative, ReadingKind::Clear];
            let count = read.iter().filter(|reading| believed.contains(&reading.kind)).count();
            count as f64 / read.len().max(1) as f64
        };
        sensors.map(|(_, read)| share(read)).fold(1.0, f64::min)
    }

    /// Checks that all other sensors read what they would have read without the fault.
    fn others_are(&self, control: &Read) -> Result<(), String> {
        for (sensor, (read, without)) in self.read.iter().zip(control).enumerate() {
            if sensor != usize::from(FAULTY) && read != without {
                return Err(format!(
                    "sensor {} reads other than it would without the fault of sensor {}",
                    sensor + 1,
                    FAULTY + 1
                ));
            }
        }
        Ok(())
    }

    /// Number of readings of the same kind as in the simulator's own run of the world, and the greatest difference
    /// between their echo times, in microseconds.
    pub(crate) fn as_simulated(&self, simulated: &Readings) -> Result<(usize, f64), String> {
        let (mut same, mut most) = (0, 0.0_f64);
        for k in 0..simulated.len() {
            let (sensor, period) = (usize::from(simulated.sensor[k]), simulated.period[k] as usize);
            let reading = self.read.get(sensor).and_then(|read| read.get(period));
            let Some(reading) = reading.filter(|reading| reading.kind == simulated.kind[k]) else { continue };
            same += 1;
            if let Some(t_echo) = reading.t_echo {
                most = most.max((f64::from(t_echo.as_micros()) - simulated.earliest_us[k]).abs());
            }
        }
        // Kinds may differ where two readings are just about T_delta apart.
        if 1000 * same < 999 * simulated.len() {
            return Err(format!("{same} of {} readings are of the kind that was simulated", simulated.len()));
        }
        Ok((same, most))
    }

    /// Describes how the fault was reported, which must be this fault and no other.
    pub(crate) fn report(&self, fault: Fault) -> Result<String, String> {
        // The next firing is due up to 24 ms after the stall began.
        self.report_late(fault, Some(Micros::from_millis(26)))
    }

    /// Reports like [`report`](Self::report), for a flow ring: its lateness does not reveal a stall, since an echo that
    /// ends the quiet makes the next firing due at once or earlier.
    pub(crate) fn report_flow(&self, fault: Fault) -> Result<String, String> {
        self.report_late(fault, None)
    }

    fn report_late(&self, fault: Fault, least: Option<Micros>) -> Result<String, String> {
        let mut expected = [Health::Well; SENSORS];
        if let (Fault::Line(fault), Some(expected)) = (fault, expected.get_mut(usize::from(FAULTY))) {
            *expected = fault.name();
        }
        if self.named != expected {
            return Err(format!("sensors are called {:?}; expected {expected:?}", self.named));
        }
        let late = fault == Fault::Stall;
        if least.is_some_and(|least| late != (self.max_late >= least)) {
            return Err(format!("the latest firing came {}", self.max_late));
        }
        Ok(match (fault, self.named_after) {
            (Fault::Line(fault), Some(period)) => format!("{} after {period} periods", fault.name()),
            (Fault::Stall, _) => format!("a firing {} late", self.max_late),
            _ => "nothing to name".to_owned(),
        })
    }

    /// The difference of the other sensors' readings from a run without a fault. Firings and interrupts shift by some
    /// microseconds with the load, so echo times move by as much, but no kind of reading may change. After a stall the
    /// ring compares some readings with nothing: those not yet emitted when it ended, and those of three periods.
    pub(crate) fn change_from(&self, fault_free: &Self, fault: Fault) -> Result<Change, String> {
        let mut change = Change { kinds: 0, moved: Micros::ZERO };
        for (sensor, (mine, without)) in self.read.iter().zip(&fault_free.read).enumerate() {
            if sensor == usize::from(FAULTY) && matches!(fault, Fault::Line(_)) {
                continue;
            }
            for (mine, without) in mine.iter().zip(without) {
                if mine.kind != without.kind {
                    change.kinds += 1;
                    let compared = [ReadingKind::Accepted, ReadingKind::Rejected].contains(&mine.kind);
                    if fault != Fault::Stall || compared || !(STALL_AFTER..=STALL_AFTER + 4).contains(&mine.period) {
                        return Err(format!("{mine:?} would be {without:?} without the fault"));
                    }
                }
                if let (Some(mine), Some(without)) = (mine.t_echo, without.t_echo) {
                    change.moved = change.moved.max(mine.abs_diff(without));
                }
            }
        }
        if change.moved > MOST_MOVED {
            return Err(format!("echo times moved by {}; expected at most {MOST_MOVED}", change.moved));
        }
        Ok(change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // Faults of the board are not in scenes: sound and lines are then without fault.
    #[test]
    fn each_fault_is_of_a_line_or_of_the_board() {
        let well = Fault::None.orders(PERIODS);
        for fault in Fault::ALL {
            if let Fault::Line(line) = fault {
                assert!(!line.faults(0.0).is_empty(), "{fault}");
                assert_eq!(fault.orders(PERIODS), well, "{fault}");
            } else {
                assert_ne!(fault.orders(PERIODS), well, "{fault}");
            }
        }
        assert_eq!(Fault::Stall.orders(PERIODS).stall, STALL);
        // 50 s before its end, of 100 s.
        assert_eq!(Fault::Wrap.orders(PERIODS).start, Instant::from_micros(50_000_000_u32.wrapping_neg()));
    }
}
