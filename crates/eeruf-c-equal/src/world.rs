//! Events around a ring: polls and echoes.

use crate::core_side::status_of;
use crate::{Between, C, Do, Random};
use eeruf_core::{Instant, Micros, Ring, Silence, judge::Judge, plan::Plan};

/// A clock that is late, jumps and wraps, with the echoes to come.
pub struct World {
    /// The source of random numbers.
    pub random: Random,
    /// The clock.
    pub now: u32,
    /// Largest lateness of polls in this run.
    late: u32,
    /// Echo time of the obstacle in front of each sensor.
    distance_us: Vec<u32>,
    window_us: u32,
    echoes: Vec<(u32, u8)>,
}

impl World {
    /// Draws a start time, and an obstacle in front of each sensor.
    pub fn new(random: Random, sensors: u8, window_us: u32) -> Self {
        // Clocks wrap in many runs.
        let now = if random.once_in(2) { 0_u32.wrapping_sub(random.duration(5_000_000)) } else { random.any() as u32 };
        let late = random.one_of(&[0, 0, 30, 300, 3_000, 100_000]);
        let distance_us = (0..sensors).map(|_| random.within(1, window_us)).collect();
        Self { random, now, late, distance_us, window_us, echoes: vec![] }
    }

    /// Advances the clock, mostly to the deadline or somewhat past it.
    pub fn turn_clock(&mut self, deadline: u32) {
        let ahead = deadline.wrapping_sub(self.now);
        let ahead = if ahead < 1 << 31 { ahead } else { 0 };
        let r = &self.random;
        self.now = match r.within(0, 999) {
            0 => r.any() as u32,
            1 => self.now.wrapping_sub(r.duration(10_000_000)),
            2..20 => self.now.wrapping_sub(r.duration(40)),
            20..100 => self.now.wrapping_add(r.duration(5_000)),
            100..110 => self.now.wrapping_add(ahead).wrapping_add(r.duration(1_000_000)),
            110..500 => self.now.wrapping_add(ahead).wrapping_add(r.duration(self.late)),
            _ => self.now.wrapping_add(ahead),
        };
        if r.once_in(200) {
            let sensor = r.within(0, self.distance_us.len() as u32 - 1) as usize;
            self.distance_us[sensor] = r.within(1, self.window_us);
        }
    }

    /// Adds the echo of a sensor that has fired.
    pub fn fired(&mut self, sensor: u8) {
        let (r, distance) = (&self.random, self.distance_us[usize::from(sensor)]);
        let own = distance.saturating_add(r.duration(300));
        let mut hear = |after: u32| self.echoes.push((self.now.wrapping_add(after), sensor));
        match r.within(0, 99) {
            0..70 => hear(own),
            70..80 => hear(r.within(0, self.window_us)),
            80..85 => hear(r.duration(2_000)),
            85..88 => hear(self.window_us.saturating_add(r.duration(50_000))),
            _ => {}
        }
        if r.once_in(8) {
            hear(r.within(0, self.window_us + self.window_us / 8));
        }
    }

    /// Returns the echoes due by now, sometimes with one that is early, out of order, or of no sensor.
    pub fn heard(&mut self) -> Vec<(u32, u8)> {
        let now = self.now;
        let mut heard: Vec<_> = self.echoes.extract_if(.., |(at, _)| now.wrapping_sub(*at) < 1 << 31).collect();
        if self.random.once_in(100) {
            let sensor = self.random.within(0, self.distance_us.len() as u32 + 2) as u8;
            heard.push((now.wrapping_sub(self.random.duration(50_000)), sensor));
        }
        if self.random.once_in(4) {
            heard.reverse();
        }
        if self.echoes.len() > 200 {
            // They belong to the time before the jump.
            self.echoes.clear();
        }
        heard
    }
}

/// Makes the same call in C, and checks that both sides accept or refuse the sensor.
///
/// # Panics
/// If they differ.
pub fn same<E>(c: &mut C, what: Do, sensor: u8, value: u32, rust: Result<(), E>) {
    let expected = if rust.is_ok() { 0 } else { -5 };
    assert_eq!(c.call(what, sensor, value), expected, "{what:?} of sensor {sensor}, {value}");
}

/// Returns two numbers with `at` between them, mostly close ones. Now and then they are swapped.
pub(crate) fn between(r: &Random, at: u32) -> [u32; 2] {
    let width = r.one_of(&[0, 16, r.duration(300), r.within(900, 1_100), r.duration(100_000), r.duration(u32::MAX)]);
    let earliest = at.wrapping_sub(r.within(0, width));
    [earliest, earliest.wrapping_add(width)]
}

/// Reports an echo of a sensor at an instant or, if times are uncertain, between two.
pub(crate) fn hear<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
    (r, uncertain): (&Random, bool),
    c: &mut C,
    ring: &mut Ring<P, J, K, E, H>,
    (at, sensor): (u32, u8),
) {
    if !uncertain || usize::from(sensor) >= ring.sensors() {
        return same(c, Do::Echo, sensor, at, ring.echo(sensor, Instant::from_micros(at)));
    }
    let [earliest, latest] = between(r, at);
    let rust = ring.echo_between(sensor, Instant::from_micros(earliest), Instant::from_micros(latest));
    let expected = rust.map_or_else(|error| status_of(&error), |()| 0);
    assert_eq!(c.between(Between::Echo, sensor, earliest, latest), expected, "{earliest} {latest}");
}

/// Reports a measured echo time, silence or, if times are uncertain, an echo time between two.
pub(crate) fn measure<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
    (r, uncertain): (&Random, bool),
    c: &mut C,
    ring: &mut Ring<P, J, K, E, H>,
    sensor: u8,
) {
    let echo = (!r.once_in(3)).then(|| r.duration(30_000));
    if let Some(echo) = echo.filter(|_| uncertain) {
        let [least, most] = between(r, echo);
        let rust = ring.measured_between(sensor, Micros::new(least), Micros::new(most));
        let expected = rust.map_or_else(|error| status_of(&error), |()| 0);
        assert_eq!(c.between(Between::Measured, sensor, least, most), expected, "{least} {most}");
        return;
    }
    same(c, Do::Measured, sensor, echo.unwrap_or(crate::NO_ECHO), ring.measured(sensor, echo.map(Micros::new)));
}

/// Sets the meaning of silence.
pub(crate) fn set_silence<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
    r: &Random,
    c: &mut C,
    ring: &mut Ring<P, J, K, E, H>,
) {
    let silence = r.within(0, 2);
    ring.set_silence([Silence::NeverFree, Silence::NeedsAnswer, Silence::Trusted][silence as usize]);
    same::<()>(c, Do::SetSilence, 0, silence, Ok(()));
}
