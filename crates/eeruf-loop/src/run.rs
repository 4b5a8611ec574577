//! One run of a board in its world, held against the twin.

use eeruf_core::{Event, Instant, Micros, Reading};
use eeruf_hc_sr04::{Edge, Health};
use eeruf_loop::{Orders, SENSORS, Topic};
use eeruf_sim::{Method, Options, World, simulate};

use crate::emulator::Emulator;
use crate::lines::{FAULTY, LineFault, Lines};
use crate::twin::{Read, Session, Twin};
use crate::unharmed::Unharmed;

/// For how many periods each run lasts.
pub(crate) const PERIODS: u32 = 1000;

/// What goes wrong in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    None,
    Line(LineFault),
    /// The main loop is held up for 50 ms in the 500th period.
    Stall,
    /// The clock wraps in the middle.
    Wrap,
}

pub(crate) const STALL_IN: u32 = 500;
pub(crate) const STALL: Micros = Micros::from_millis(50);

impl Fault {
    /// All but none.
    pub(crate) const ALL: [Self; 6] = [
        Self::Line(LineFault::Missing),
        Self::Line(LineFault::StuckHigh),
        Self::Line(LineFault::Chatters),
        Self::Line(LineFault::InterruptsLost),
        Self::Stall,
        Self::Wrap,
    ];

    fn orders(self) -> Orders {
        // Half of 1,000 periods of 100 ms before the wrap.
        let start = if self == Self::Wrap { 0_u32.wrapping_sub(50_000_000) } else { 0 };
        let stall = if self == Self::Stall { STALL } else { Micros::ZERO };
        Orders { start: Instant::from_micros(start), periods: PERIODS, stall_in: STALL_IN, stall }
    }
}

/// What came of a run.
pub(crate) struct Run {
    pub(crate) read: Read,
    /// The latest that an edge was noticed.
    pub(crate) latest: Micros,
    /// The latest firing.
    pub(crate) max_late: Micros,
    /// What the driver called each sensor that it did not call well, and in which period first.
    pub(crate) named: [Health; SENSORS],
    pub(crate) named_in: Option<u32>,
}

pub(crate) fn run(world: &World, fault: Fault, emulator: &[String]) -> Result<Run, String> {
    let orders = fault.orders();
    let line_fault = if let Fault::Line(fault) = fault { fault } else { LineFault::None };
    let session = Session::new(Emulator::start(emulator, orders)?, Lines::new(world, line_fault, orders.start)?);
    let outcome = (|| {
        // The first thing that a board says is when it set up its ring.
        let now = session.borrow_mut().expect(Topic::Deadline, 0)?.instant();
        let mut twin = Twin::new(&session, now)?;
        let mut unharmed = Unharmed::new(now, FAULTY)?;
        let mut run = Run {
            read: Default::default(),
            latest: Micros::ZERO,
            max_late: Micros::ZERO,
            named: [Health::Well; SENSORS],
            named_in: None,
        };
        let mut periods = 0;
        loop {
            let record = session.borrow_mut().board.next()?;
            let Some(record) = record else { break };
            match record.topic() {
                Some(Topic::Edge) => {
                    let edge = Edge { sensor: record.sensor(), high: record.flag() != 0, at: record.instant() };
                    twin.edge(edge)?;
                    unharmed.edge(edge);
                }
                Some(Topic::Poll) => {
                    let event = twin.poll(record.instant())?;
                    unharmed.follow(record.instant(), event.as_ref())?;
                    match event {
                        Some(Event::Reading(reading)) => run.take(reading),
                        Some(Event::PeriodEnded(stats)) => {
                            run.max_late = run.max_late.max(stats.max_late);
                            periods += 1;
                        }
                        _ => {}
                    }
                }
                Some(Topic::State) => {
                    twin.compare(record)?;
                    if record.flag() > 0 {
                        return Err(format!("{} edges found the queue full", record.flag()));
                    }
                    run.name(twin.health(), periods);
                }
                Some(Topic::Deadline) => twin.compare(record)?,
                _ => return Err(format!("the board said {record:?} out of turn")),
            }
        }
        if periods != PERIODS {
            return Err(format!("the board ended after {periods} periods of {PERIODS}"));
        }
        if matches!(fault, Fault::Line(_)) {
            run.others_are(&unharmed.read)?;
        }
        run.latest = session.borrow().lines.latest;
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
                self.named_in.get_or_insert(period);
            }
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.read.iter().map(Vec::len).sum()
    }

    /// Whether all other sensors read what they would have read without the fault.
    fn others_are(&self, unharmed: &Read) -> Result<(), String> {
        for (sensor, (read, without)) in self.read.iter().zip(unharmed).enumerate() {
            if sensor != usize::from(FAULTY) && read != without {
                return Err(format!("sensor {} reads other than it would without the fault of sensor {}", sensor + 1, FAULTY + 1));
            }
        }
        Ok(())
    }

    /// How many readings are of the same kind as the simulator's own run of the same world has them, and by how much echo
    /// times differ at most.
    pub(crate) fn as_simulated(&self, world: &World) -> Result<(usize, f64), String> {
        let simulated = simulate(world, Method::Eeruf, &Options::periods(PERIODS)).map_err(|error| error.to_string())?;
        let (mut same, mut most) = (0, 0.0_f64);
        for k in 0..simulated.len() {
            let reading = &self.read[usize::from(simulated.sensor[k])].get(simulated.period[k] as usize);
            let Some(reading) = reading else { continue };
            if reading.kind == simulated.kind[k] {
                same += 1;
                if let Some(t_echo) = reading.t_echo {
                    most = most.max((f64::from(t_echo.as_micros()) - simulated.earliest_us[k]).abs());
                }
            }
        }
        Ok((same, most))
    }

    pub(crate) fn compare(&self, whole: &Self) -> String {
        let (mut kinds, mut times, mut most, mut n) = (0, 0, 0, 0);
        for (sensor, (mine, theirs)) in self.read.iter().zip(&whole.read).enumerate() {
            if sensor == usize::from(FAULTY) {
                continue;
            }
            for (mine, theirs) in mine.iter().zip(theirs) {
                n += 1;
                kinds += usize::from(mine.kind != theirs.kind);
                if let (Some(a), Some(b)) = (mine.t_echo, theirs.t_echo) {
                    times += usize::from(a != b);
                    most = most.max(a.abs_diff(b).as_micros());
                }
            }
        }
        format!("of {n} others {kinds} of another kind, {times} of another time, by up to {most} us")
    }
}
