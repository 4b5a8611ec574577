//! The echo lines of eight HC-SR04 sensors in a simulated world, and the fault of one of them.

use core::fmt;

use eeruf_core::{Edge, Instant, Micros};
use eeruf_hc_sr04::Health;
use eeruf_hil::{Ahead, MOST_AHEAD, SENSORS};
use eeruf_sim::modules::HC_SR04;
use eeruf_sim::{Fault, FaultKind, LockStep, World, line_edges};

use crate::played::PlayedLines;

/// The sensor with the fault, from 0.
pub(crate) const FAULTY: u8 = 2;
/// Time from the trigger's fall to the rise of the line, after the burst.
const RISE_US: u64 = 450;
/// The module's own time-out, after which its line falls without an echo.
const TIME_OUT_US: u64 = HC_SR04.no_echo.hold_us() as u64;
/// The firing from which on a line is stuck.
const STUCK_FROM: u32 = 20;
/// Greatest delay of an interrupt: some instructions at 64 ns each, and other interrupts before it.
const LATEST_US: u64 = 200;

/// The fault on the line of [`FAULTY`], one of those that scenes can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineFault {
    None,
    /// There is no sensor: neither sound nor edges.
    Missing,
    /// The line stays high from the twentieth firing on.
    StuckHigh,
    /// Each rise comes twice, and another pulse follows the true one.
    Chatters,
    /// Every fifth rise and every seventh fall cause no interrupt.
    InterruptsLost,
}

impl LineFault {
    /// Returns the faults of [`FAULTY`] from this time on.
    pub(crate) fn faults(self, from_s: f64) -> Vec<Fault> {
        let kinds = match self {
            Self::None => vec![],
            Self::Missing => vec![FaultKind::Missing],
            Self::StuckHigh => vec![FaultKind::Stuck],
            Self::Chatters => vec![
                FaultKind::GlitchLow { after_us: 30, width_us: 30 },
                FaultKind::GlitchHigh { after_us: 500, width_us: 1000 },
            ],
            Self::InterruptsLost => vec![FaultKind::LostRises { every: 5 }, FaultKind::LostFalls { every: 7 }],
        };
        let fault = |kind| Fault::new(kind).of_sensors(&[FAULTY]).between(from_s, f64::INFINITY);
        kinds.into_iter().map(fault).collect()
    }

    /// Returns the name that the driver should report.
    pub(crate) fn name(self) -> Health {
        match self {
            Self::None => Health::Well,
            Self::Missing => Health::Missing,
            Self::StuckHigh => Health::StuckHigh,
            Self::Chatters => Health::Chatters,
            Self::InterruptsLost => Health::LosesEdges,
        }
    }
}

impl fmt::Display for LineFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "well",
            Self::Missing => "missing",
            Self::StuckHigh => "stuck high",
            Self::Chatters => "chattering",
            Self::InterruptsLost => "losing interrupts",
        })
    }
}

/// One line since its sensor was triggered.
#[derive(Clone, Copy, Default)]
struct Line {
    triggered_us: Option<u64>,
    firings: u32,
    /// Number of edges of this firing that the board has noticed.
    noticed: usize,
}

/// All lines, in the board's time.
pub(crate) struct Lines<'w> {
    world: LockStep<'w>,
    fault: LineFault,
    faults: Vec<Fault>,
    /// Edges that replace those of the world.
    played: Option<PlayedLines>,
    /// The lines, indexed by pin.
    lines: [Line; SENSORS],
    /// A reading of the board's clock, and the microseconds from the start until then.
    clock: (Instant, u64),
    /// The greatest delay until the board noticed an edge.
    pub(crate) latest: Micros,
}

impl<'w> Lines<'w> {
    pub(crate) fn new(world: &'w World, fault: LineFault, start: Instant) -> Result<Self, String> {
        let world = LockStep::new(world).map_err(|error| error.to_string())?;
        let faults = if fault == LineFault::StuckHigh { vec![] } else { fault.faults(0.0) };
        let (lines, clock) = (Default::default(), (start, 0));
        Ok(Self { world, fault, faults, played: None, lines, clock, latest: Micros::ZERO })
    }

    /// Plays these edges instead of those that the world gives.
    pub(crate) fn with_played(self, played: Option<PlayedLines>) -> Self {
        Self { played, ..self }
    }

    /// Microseconds since the start, with wraps of the clock counted; `at` is less than half an hour from the instant
    /// of the last call.
    fn since_start(&mut self, at: Instant) -> u64 {
        let (known, us) = self.clock;
        let ahead = at.since(known).as_micros().cast_signed();
        self.clock = (at, us.saturating_add_signed(ahead.into()));
        self.clock.1
    }

    /// Triggers a sensor.
    pub(crate) fn trigger(&mut self, sensor: u8, at: Instant) -> Result<(), String> {
        let at = self.since_start(at);
        let pin = self.played.as_ref().map_or(sensor, |played| played.pin_of(sensor));
        if self.played.is_some() && self.is_high(pin, at) {
            // A module whose line is high ignores its trigger.
            return Ok(());
        }
        self.all_noticed(pin)?;
        let x = usize::from(pin);
        let time_s = (at + RISE_US) as f64 * 1e-6;
        let missing = |fault: &Fault| fault.kind == FaultKind::Missing && fault.is_of(0, sensor) && fault.is_at(time_s);
        if self.played.is_none() && !self.faults.iter().any(missing) {
            self.world.fire(x, (at + RISE_US) * 1000).map_err(|error| error.to_string())?;
        }
        let line = self.lines.get_mut(x).ok_or_else(|| format!("there is no sensor {}", sensor + 1))?;
        *line = Line { triggered_us: Some(at), firings: line.firings + 1, noticed: 0 };
        if self.fault == LineFault::StuckHigh && sensor == FAULTY && line.firings == STUCK_FROM {
            self.faults = self.fault.faults(at as f64 * 1e-6);
        }
        Ok(())
    }

    /// Returns true if the line at a pin is high.
    fn is_high(&self, pin: u8, at: u64) -> bool {
        self.edges(pin).iter().rev().find(|&&(edge_at, ..)| edge_at <= at).is_some_and(|&(_, high, _)| high)
    }

    /// The known edges of a line after its last trigger: time, true if the line rises, true if the interrupt is lost.
    fn edges(&self, sensor: u8) -> Vec<(u64, bool, bool)> {
        let Some(&line) = self.lines.get(usize::from(sensor)) else { return Vec::new() };
        let Some(triggered) = line.triggered_us else { return Vec::new() };
        if let Some(played) = &self.played {
            return played.at_pin(sensor).iter().map(|&(after, high, lost)| (triggered + after, high, lost)).collect();
        }
        let rise = triggered + RISE_US;
        let fall = self.world.hears_at_ns(sensor.into()).map_or(rise + TIME_OUT_US, |ns| ns / 1000);
        let edges = line_edges(&self.faults, 0, sensor, line.firings, rise, fall);
        edges.map(|edge| (edge.at_us, edge.high, edge.lost)).collect()
    }

    /// Edges to come on all lines, for a board whose clock reads `now`, including edges that it may just have noticed.
    pub(crate) fn ahead(&mut self, now: Instant) -> Result<Vec<Ahead>, String> {
        let now = self.since_start(now);
        let mut ahead = Vec::new();
        for sensor in 0..SENSORS as u8 {
            ahead.extend(self.edges(sensor).into_iter().map(|(at, high, lost)| (at, sensor, high, lost)));
        }
        ahead.retain(|&(at, ..)| at + LATEST_US >= now);
        ahead.sort_unstable();
        if ahead.len() > MOST_AHEAD {
            return Err(format!("{} edges to come; an answer holds {MOST_AHEAD}", ahead.len()));
        }
        let (known, us) = self.clock;
        let ahead = ahead.into_iter().map(|(at, sensor, high, lost)| {
            let at = Instant::from_micros(known.as_micros().wrapping_add(at.wrapping_sub(us) as u32));
            Ahead { edge: Edge { sensor, high, at }, lost }
        });
        Ok(ahead.collect())
    }

    /// Checks an edge that the board has noticed: it must be the next one of its line, at its time or a little later.
    pub(crate) fn notice(&mut self, edge: Edge) -> Result<(), String> {
        let noticed_at = self.since_start(edge.at);
        let expected = self.edges(edge.sensor);
        let line = self.lines.get_mut(usize::from(edge.sensor));
        let line = line.ok_or_else(|| format!("an edge of sensor {}, which does not exist", edge.sensor + 1))?;
        let next = expected.iter().filter(|&&(_, _, lost)| !lost).nth(line.noticed);
        let Some(&(at, ..)) =
            next.filter(|&&(at, high, _)| high == edge.high && (at..=at + LATEST_US).contains(&noticed_at))
        else {
            return Err(format!(
                "sensor {}: the board noticed an edge {noticed_at} us after the start that does not follow from \
                 {expected:?}",
                edge.sensor + 1
            ));
        };
        line.noticed += 1;
        self.latest = self.latest.max(Micros::new((noticed_at - at) as u32));
        Ok(())
    }

    /// Checks before a new trigger that the board has noticed all edges of the sensor's last firing.
    fn all_noticed(&self, sensor: u8) -> Result<(), String> {
        let edges = self.edges(sensor).iter().filter(|&&(_, _, lost)| !lost).count();
        let noticed = self.lines.get(usize::from(sensor)).map_or(0, |line| line.noticed);
        if edges == noticed {
            Ok(())
        } else {
            Err(format!("sensor {}: the board noticed {noticed} of {edges} edges of a firing", sensor + 1))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn alcove() -> World {
        World::from_toml(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/alcove-hc-sr04.toml")).unwrap()
    }

    fn at(us: u32) -> Instant {
        Instant::from_micros(us)
    }

    // Every line rises when its sensor sends sound and falls when it hears something.
    #[test]
    fn line_rises_with_sound_and_falls_with_echo() {
        let world = alcove();
        let mut lines = Lines::new(&world, LineFault::None, at(0)).unwrap();
        lines.trigger(4, at(1_000)).unwrap();
        let ahead = lines.ahead(at(1_000)).unwrap();
        let [rise, fall] = ahead[..] else { panic!("{ahead:?}") };
        assert_eq!(rise.edge, Edge { sensor: 4, high: true, at: at(1_450) });
        assert!(fall.edge.sensor == 4 && !fall.edge.high && fall.edge.at.has_reached(at(2_000)));
    }

    #[test]
    fn each_fault_is_what_its_name_says() {
        let world = alcove();
        let edges = |fault: LineFault, firing: u32| -> Vec<(u64, bool, bool)> {
            let mut lines = Lines::new(&world, fault, at(0)).unwrap();
            for before in 1..=firing {
                let triggered = at(100_000 * before);
                lines.trigger(FAULTY, triggered).unwrap();
                lines.lines[usize::from(FAULTY)].noticed =
                    lines.edges(FAULTY).iter().filter(|&&(_, _, lost)| !lost).count();
            }
            lines.edges(FAULTY)
        };
        let well = edges(LineFault::None, 5);
        let &[(rise, true, false), (fall, false, false)] = &well[..] else { panic!("{well:?}") };
        assert_eq!(rise, 500_450);
        assert_eq!(edges(LineFault::Missing, 5), []);
        assert_eq!(edges(LineFault::StuckHigh, 5), well);
        assert_eq!(edges(LineFault::StuckHigh, 20).iter().map(|edge| edge.1).collect::<Vec<_>>(), [true]);
        let times = [rise, rise + 30, rise + 60, fall, fall + 500, fall + 1_500];
        let chatters: Vec<_> = (0..).zip(times).map(|(n, time)| (time, n % 2 == 0, false)).collect();
        assert_eq!(edges(LineFault::Chatters, 5), chatters);
        assert_eq!(edges(LineFault::InterruptsLost, 5), [(rise, true, true), (fall, false, false)]);
        assert!(!edges(LineFault::InterruptsLost, 6)[1].2 && edges(LineFault::InterruptsLost, 7)[1].2);
    }

    #[test]
    fn a_later_firing_amends_what_a_listening_sensor_will_hear() {
        let world = alcove();
        let amended = (0..8).flat_map(|x| (0..8).map(move |y| (x, y))).filter(|&(x, y)| {
            let mut lines = Lines::new(&world, LineFault::None, at(0)).unwrap();
            lines.trigger(y, at(0)).unwrap();
            let alone = lines.edges(y);
            x != y && {
                lines.trigger(x, at(300)).unwrap();
                lines.edges(y) != alone
            }
        });
        assert!(amended.count() > 3);
    }

    #[test]
    fn edges_that_do_not_follow_from_the_world_are_refused() {
        let world = alcove();
        let fresh = || {
            let mut lines = Lines::new(&world, LineFault::None, at(u32::MAX - 99)).unwrap();
            lines.trigger(0, at(u32::MAX - 99)).unwrap();
            lines
        };
        // 450 us later, through the wrap of the clock.
        let edge = |sensor, high, us| Edge { sensor, high, at: at(us) };
        assert_eq!(fresh().notice(edge(0, true, 353)), Ok(()));
        for wrong in
            [edge(0, false, 353), edge(0, true, 349), edge(0, true, 351 + LATEST_US as u32), edge(1, true, 353)]
        {
            assert!(fresh().notice(wrong).is_err(), "{wrong:?}");
        }
        let error = fresh().trigger(0, at(80_000)).unwrap_err();
        assert_eq!(error, "sensor 1: the board noticed 0 of 2 edges of a firing");
    }

    #[test]
    fn the_ring_fires_as_the_simulator_does_in_this_scene() {
        let world = alcove();
        let robot = &world.robots()[0];
        let simulated = eeruf_sim::table_i_d_for(robot.sensors.len(), robot.period, robot.neighbours).unwrap();
        for sensor in 0..SENSORS {
            for phase in [eeruf_core::Phase::A, eeruf_core::Phase::B] {
                assert_eq!(eeruf_hil::SCHEDULE.t_fire(phase, sensor), simulated.t_fire(phase, sensor));
            }
        }
        assert_eq!(eeruf_hil::CONFIG.t_delta, Some(robot.t_delta));
    }
}
