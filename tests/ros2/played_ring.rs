//! `played_ring PERIODS STALL_AFTER LINE ..`: a ring of eight HC-SR04 modules whose echo lines play given edges, for
//! tests of the node. In real time it writes the frames of the serial line to standard output, and its readings as CSV
//! to standard error.
//!
//! Each `LINE` is the pin that a sensor's echo wire leads to, counted from 0, and the edges after its triggers in us,
//! such as `2 +450 -6280* / +450`: a rise, a fall without an interrupt; at the next trigger a rise; then again from the
//! first. After the period `STALL_AFTER` the main loop stalls for 50 ms.

use std::cell::RefCell;
use std::convert::Infallible;
use std::error::Error;
use std::io::Write as _;
use std::rc::Rc;
use std::thread::sleep;
use std::time::Duration;

use eeruf_core::{Edge, Instant, Micros, Requirements, Ring, RingConfig, RingEvent, Schedule, VerifiedSchedule};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use eeruf_serial::Recorder;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

const SENSORS: usize = 8;
/// Sensors 1 to 4 fire 20 and 17 ms apart, and each of sensors 5 to 8 comes 1 and 1.5 ms after one of them.
const SCHEDULE: VerifiedSchedule<SENSORS> = {
    let us = Micros::new;
    let a = [us(24_000), us(44_000), us(64_000), us(84_000), us(25_000), us(45_000), us(65_000), us(85_000)];
    let b = [us(20_000), us(37_000), us(54_000), us(71_000), us(21_500), us(38_500), us(55_500), us(72_500)];
    let Ok(schedule) = Schedule::from_firing(Micros::from_millis(100), [a, b]) else { panic!("not a schedule") };
    match schedule.verified(&Requirements::new(us(240))) {
        Ok(verified) => verified,
        Err(_) => panic!("not a schedule for 240 us"),
    }
};
/// The module's window, and the echo time of something 2 cm away.
const CONFIG: RingConfig = RingConfig::new().with_window(Micros::from_millis(40)).with_blanking(Micros::new(116));
/// The clock at the start. It wraps after 3 s.
const BEGIN: Instant = Instant::from_micros(3_000_000_u32.wrapping_neg());
const STALL_US: u32 = 50_000;

/// An edge of a line, in us after the trigger or after the start.
#[derive(Clone, Copy)]
struct Played {
    us: u32,
    pin: u8,
    high: bool,
    is_lost: bool,
}

/// All lines, and the time since the start.
#[derive(Default)]
struct Lines {
    /// The edges after each trigger of each sensor.
    played: Vec<(u8, Vec<Vec<Played>>)>,
    triggers: [usize; SENSORS],
    high: [bool; SENSORS],
    /// The next edges, the soonest first.
    coming: Vec<Played>,
    now_us: u32,
}

impl Lines {
    fn trigger(&mut self, sensor: u8) {
        let x = usize::from(sensor);
        let Some((pin, played)) = self.played.get(x) else { return };
        // A module whose line is high ignores its trigger.
        if !self.high[usize::from(*pin)] {
            let edges = played[self.triggers[x] % played.len()].iter();
            self.coming.extend(edges.map(|edge| Played { us: self.now_us + edge.us, ..*edge }));
            self.coming.sort_by_key(|edge| edge.us);
            self.triggers[x] += 1;
        }
    }

    /// Returns the next edge that has come, and sets its line.
    fn edge(&mut self) -> Option<Played> {
        let edge = *self.coming.first().filter(|edge| edge.us <= self.now_us)?;
        self.coming.remove(0);
        self.high[usize::from(edge.pin)] = edge.high;
        Some(edge)
    }
}

fn line(text: &str) -> Option<(u8, Vec<Vec<Played>>)> {
    let (pin, edges) = text.split_once(' ').unwrap_or((text, ""));
    let pin = pin.parse().ok().filter(|&pin| usize::from(pin) < SENSORS)?;
    let edge = |word: &str| {
        let us = word.strip_prefix(['+', '-'])?.trim_end_matches('*').parse().ok()?;
        Some(Played { us, pin, high: word.starts_with('+'), is_lost: word.ends_with('*') })
    };
    let edges = edges.split('/').map(|edges| edges.split_whitespace().map(edge).collect());
    Some((pin, edges.collect::<Option<_>>()?))
}

/// The trigger or the echo pin of a sensor.
struct Pin(Rc<RefCell<Lines>>, u8);

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().trigger(self.1);
        Ok(())
    }
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.borrow().high[usize::from(self.1)])
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

/// A delay that takes no time.
struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [periods, stall_after, played @ ..] = &arguments[..] else { return Err("PERIODS STALL_AFTER LINE ..".into()) };
    let (periods, stall_after): (u32, u32) = (periods.parse()?, stall_after.parse()?);
    let played = played.iter().map(|text| line(text).ok_or_else(|| format!("{text:?}; expected as 2 +450 -6280*")));
    let lines = Rc::new(RefCell::new(Lines { played: played.collect::<Result<_, _>>()?, ..Lines::default() }));
    let pin = |x| Pin(Rc::clone(&lines), x as u8);
    let pins = std::array::from_fn(|x| Pins { trigger: pin(x), echo: pin(x) });
    let mut ring = HcSr04Ring::new(Ring::new(&SCHEDULE, CONFIG, BEGIN)?, pins, NoDelay, Settings::default())?;
    let mut recorder = Recorder::<SENSORS>::new("played");
    let (start, mut stdout) = (std::time::Instant::now(), std::io::stdout());
    eprintln!("sensor,period,reading,t_echo_us");
    loop {
        while let Some(Played { us, pin, high, is_lost }) = { lines.borrow_mut().edge() } {
            if !is_lost {
                ring.edge(Edge { sensor: pin, high, at: BEGIN + Micros::new(us) })?;
            }
        }
        let now_us = lines.borrow().now_us;
        let now = BEGIN + Micros::new(now_us);
        let event = ring.poll(now);
        let frame = event.and_then(|event| recorder.event(&event, now, |sensor| ring.health(sensor) as u8, 0));
        stdout.write_all(frame.as_ref().map_or(&[], |frame| frame.as_bytes()))?;
        match event {
            Some(RingEvent::Reading(reading)) => {
                let t_echo = reading.t_echo.map(|t_echo| t_echo.as_micros().to_string()).unwrap_or_default();
                eprintln!("{},{},{},{t_echo}", reading.sensor, reading.period, reading.kind);
            }
            Some(RingEvent::PeriodEnded(stats)) if stats.period + 1 == periods => break,
            Some(RingEvent::PeriodEnded(stats)) if stats.period == stall_after => lines.borrow_mut().now_us += STALL_US,
            Some(RingEvent::Fire { .. } | RingEvent::PeriodEnded(_)) => {}
            None => {
                stdout.flush()?;
                let mut lines = lines.borrow_mut();
                let deadline_us = ring.next_deadline().since(BEGIN).as_micros();
                let edge_us = lines.coming.first().map_or(u32::MAX, |edge| edge.us);
                lines.now_us = deadline_us.min(edge_us).max(now_us);
                sleep(Duration::from_micros(lines.now_us.into()).saturating_sub(start.elapsed()));
            }
        }
    }
    Ok(stdout.flush()?)
}
