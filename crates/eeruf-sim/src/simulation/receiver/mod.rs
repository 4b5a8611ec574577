//! One sensor's receiver: the sound in flight to it, the sound that it hears, and the causes of its echoes.
//!
//! The receiver hears the first arrival above the detection floor between blanking and the end of the window. If the
//! sensor reports several echoes, it listens again after a dead time of one burst. Arrivals that may still matter to a
//! later firing are kept.

mod envelope;
#[cfg(test)]
mod tests;

use eeruf_core::Micros;

use crate::{
    acoustics::{GainProfile, gain_at},
    methods::MAX_ECHOES,
    world::{Robot, World},
};
pub(crate) use envelope::{Envelope, Rise, Wave};

/// A time later than any moment of a simulation.
pub(crate) const NEVER: u64 = u64::MAX;
/// Marker of a burst from outside in [`Arrival::path`].
pub(crate) const EXTERNAL: u32 = u32::MAX - 1;

/// Sound that reaches a sensor. Times are true nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arrival {
    /// Start; for a sum, the start of its first sound.
    pub(crate) onset: u64,
    /// Time when the sound is heard: at its onset, or later if the receiver needs time.
    pub(crate) at: u64,
    /// Time when the sound was sent.
    pub(crate) sent: u64,
    /// Path of the sound, or [`EXTERNAL`].
    pub(crate) path: u32,
    /// Level above the detection floor, fading included, without the receiver's gain.
    pub(crate) level_over_threshold_db: f32,
    /// The stretch of the envelope, for a sum of several sounds.
    pub(crate) rise: Option<Rise>,
}

/// An echo passed to the ring. It contains its cause, which the ring cannot read.
#[derive(Clone, Copy, Debug)]
pub struct Echo {
    /// Time since the firing, by the robot's clock.
    pub(crate) t_echo_us: u32,
    pub(crate) arrival: Arrival,
    /// True if the sound was sent when the sensor fired: by the sensor itself, or by another that fired together with
    /// it.
    pub(crate) of_this_firing: bool,
}

impl Echo {
    const NONE: Self = Self {
        t_echo_us: 0,
        arrival: Arrival { onset: 0, at: 0, sent: 0, path: EXTERNAL, level_over_threshold_db: 0.0, rise: None },
        of_this_firing: false,
    };

    /// Returns the time since the firing, by the robot's clock.
    pub const fn t_echo(&self) -> Micros {
        Micros::new(self.t_echo_us)
    }

    /// Returns the level over the receiver's threshold at full gain, in dB, which is the amplitude that a module
    /// reports.
    pub const fn level_db(&self) -> f32 {
        self.arrival.level_over_threshold_db
    }

    /// Returns the echo with another time, for filters that smooth.
    #[must_use]
    pub const fn at(self, t_echo: Micros) -> Self {
        Self { t_echo_us: t_echo.as_micros(), ..self }
    }
}

/// Hearing of a receiver. Times are true nanoseconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hearing {
    pub(crate) blanking: u64,
    pub(crate) window: u64,
    /// Time after a firing before which no later firing hears anything.
    pub(crate) refire: u64,
    /// Dead time after each echo of a sensor that reports several.
    pub(crate) dead_time: u64,
    pub(crate) echoes: usize,
    pub(crate) gain: GainProfile,
    /// Time when the gain is full, in seconds.
    pub(crate) gain_full_s: f64,
    /// Rise time of an echo over a burst, in nanoseconds; 0 for a receiver that hears every echo at its onset.
    pub(crate) rise_ns: f64,
}

impl Hearing {
    /// Computes the hearing of a robot's sensor; `ns` converts the robot's clock to true time.
    pub(crate) fn new(
        world: &World,
        robot: &Robot,
        sensor: usize,
        echoes: usize,
        refire: u64,
        ns: impl Fn(Micros) -> u64,
    ) -> Self {
        let transducer = robot.transducer_of(sensor);
        let burst_ns = transducer.burst_s() * 1e9;
        Self {
            blanking: ns(robot.blanking_of(sensor)),
            window: ns(robot.window),
            refire,
            dead_time: burst_ns as u64,
            echoes,
            gain: transducer.gain,
            gain_full_s: 2.0 * transducer.max_range_m / world.scene().air().speed_of_sound(),
            rise_ns: if world.physics().rises() { burst_ns } else { 0.0 },
        }
    }

    /// Returns the time from the onset of a sound until it is heard, for an onset at a time after the firing; `None` if
    /// it is too faint.
    ///
    /// The envelope of an echo rises evenly over its burst, and a threshold detector hears the echo when the envelope
    /// reaches the threshold: `10^(-L / 20)` of a burst after the onset, for a level of `L` dB over the threshold.
    #[inline]
    pub(crate) fn lateness(&self, level_over_threshold_db: f32, after: u64) -> Option<u64> {
        let level_db = match self.gain {
            GainProfile::Constant => f64::from(level_over_threshold_db),
            gain => {
                f64::from(level_over_threshold_db)
                    + 20.0 * libm::log10(gain_at(gain, after as f64 * 1e-9, self.gain_full_s))
            }
        };
        if !(level_db >= 0.0) {
            return None;
        }
        Some(if self.rise_ns > 0.0 { (self.rise_ns * libm::exp10(-0.05 * level_db)) as u64 } else { 0 })
    }

    /// Returns the lateness of an arrival, for a receiver that fired at this time.
    #[inline]
    pub(crate) fn late(&self, arrival: &Arrival, fired: u64) -> Option<u64> {
        let after = arrival.onset.saturating_sub(fired);
        match arrival.rise {
            None => self.lateness(arrival.level_over_threshold_db, after),
            Some(rise) => rise.crosses(1.0 / gain_at(self.gain, after as f64 * 1e-9, self.gain_full_s)),
        }
    }
}

/// One sensor's receiver.
#[derive(Clone, Debug)]
pub(crate) struct Receiver {
    /// Time from which an arrival would be heard; [`NEVER`] while the sensor does not listen.
    open: u64,
    /// Time until which the sensor listens: the end of the window, or the next arrival if it reports one echo.
    until: u64,
    /// Time up to which arrivals matter only to the current firing.
    own_until: u64,
    /// Time of the last firing.
    pub(crate) fired: u64,
    /// Number of the sensor's firings.
    pub(crate) firings: u32,
    /// The next arrival that the receiver will hear.
    next: Option<Arrival>,
    /// Later arrivals, in no order.
    pending: Vec<Arrival>,
    heard: [Echo; MAX_ECHOES],
    heard_count: usize,
}

impl Receiver {
    pub(crate) const NEW: Self = Self {
        open: NEVER,
        until: 0,
        own_until: 0,
        fired: 0,
        firings: 0,
        next: None,
        pending: Vec::new(),
        heard: [Echo::NONE; MAX_ECHOES],
        heard_count: 0,
    };

    /// Returns the time of the next arrival that the sensor will hear, as known so far.
    #[inline]
    pub(crate) fn next_at(&self) -> u64 {
        self.next.map_or(NEVER, |next| next.at)
    }

    /// Returns true if an arrival within `slack` of this time can matter. Most cannot, and need no random numbers.
    #[inline]
    pub(crate) fn cares(&self, at: u64, slack: u64) -> bool {
        let latest = at + slack;
        latest > self.own_until || (latest >= self.open && at <= self.until.saturating_add(slack))
    }

    /// Forgets the echoes, for a new firing of the line.
    pub(crate) fn forget(&mut self) {
        self.heard_count = 0;
    }

    /// Begins to listen for a new firing.
    pub(crate) fn fire(&mut self, now: u64, hearing: &Hearing) {
        self.forget();
        self.listen(now, hearing);
    }

    /// Begins to listen; earlier echoes remain to be read.
    pub(crate) fn listen(&mut self, now: u64, hearing: &Hearing) {
        self.fired = now;
        self.firings += 1;
        self.open = now + hearing.blanking;
        self.until = now + hearing.window;
        self.own_until = now + hearing.refire;
        self.next = None;
        // Waiting arrivals are inserted again, behind the old entries.
        let held = self.pending.len();
        for index in 0..held {
            let arrival = self.pending[index];
            self.insert(arrival, hearing);
        }
        self.pending.drain(..held);
    }

    /// Inserts an arrival, which is never before the current time.
    #[inline]
    pub(crate) fn insert(&mut self, arrival: Arrival, hearing: &Hearing) {
        let late = hearing.late(&arrival, self.fired);
        let begins = arrival.rise.map_or(0, |rise| rise.after.into());
        let arrival = Arrival { at: arrival.onset + late.unwrap_or(begins), ..arrival };
        let in_window = arrival.at >= self.open && arrival.at <= self.until;
        if !in_window || late.is_none() {
            // A later firing decides if it hears the arrival.
            if arrival.at > self.own_until {
                self.pending.push(arrival);
            }
            return;
        }
        let later = match self.next {
            Some(next) if next.at <= arrival.at => Some(arrival),
            _ => self.next.replace(arrival),
        };
        if hearing.echoes == 1 {
            self.until = self.next_at();
        }
        if let Some(later) = later.filter(|later| hearing.echoes > 1 || later.at > self.own_until) {
            self.pending.push(later);
        }
    }

    /// Hears the next arrival, `t_echo_us` after the firing by the robot's clock.
    pub(crate) fn hear(&mut self, t_echo_us: u32, hearing: &Hearing) {
        let Some(arrival) = self.next.take() else { return };
        if let Some(entry) = self.heard.get_mut(self.heard_count) {
            *entry = Echo { t_echo_us, arrival, of_this_firing: arrival.sent == self.fired };
            self.heard_count += 1;
        }
        if self.heard_count >= hearing.echoes {
            self.stop();
            return;
        }
        self.open = arrival.at + hearing.dead_time;
        let mut soonest: Option<usize> = None;
        let mut index = 0;
        while let Some(&waiting) = self.pending.get(index) {
            if waiting.at < self.open && waiting.at <= self.own_until {
                self.pending.swap_remove(index);
                continue;
            }
            let in_window = waiting.at >= self.open && waiting.at <= self.until;
            // Of two simultaneous arrivals the one with the lower path number is heard, so that the order in `pending`
            // does not matter.
            let key = |arrival: &Arrival| (arrival.at, arrival.path, arrival.sent);
            let sooner = soonest.is_none_or(|soonest| key(&waiting) < key(&self.pending[soonest]));
            if in_window && sooner && hearing.late(&waiting, self.fired).is_some() {
                soonest = Some(index);
            }
            index += 1;
        }
        self.next = soonest.map(|index| self.pending.swap_remove(index));
    }

    /// Removes the next arrival and stops listening, since the sensor's own line does not report it.
    pub(crate) fn lose(&mut self) -> Option<Arrival> {
        let lost = self.next.take();
        self.stop();
        lost
    }

    /// Reports an echo of another sensor on this line, if there is room for it.
    pub(crate) fn report(&mut self, t_echo_us: u32, arrival: Arrival, hearing: &Hearing) {
        if self.heard_count < hearing.echoes.min(MAX_ECHOES) {
            self.heard[self.heard_count] = Echo { t_echo_us, arrival, of_this_firing: false };
            self.heard_count += 1;
        }
    }

    /// Stops listening.
    pub(crate) fn stop(&mut self) {
        self.open = NEVER;
        self.until = 0;
        if let Some(missed) = self.next.take().filter(|missed| missed.at > self.own_until) {
            self.pending.push(missed);
        }
    }

    /// Returns the echoes since the last firing, earliest first.
    pub(crate) fn heard(&self) -> &[Echo] {
        self.heard.get(..self.heard_count).unwrap_or(&[])
    }
}
