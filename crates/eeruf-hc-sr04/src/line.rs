//! [`Line`]: turns the edges of one echo line into the width of a pulse and the health of the sensor.

use eeruf_core::{Edge, Instant, Micros};

use crate::health::Health;
use crate::settings::Settings;

/// The state of a sensor between trigger and echo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pulse {
    /// No pulse is expected: before the first trigger, and after a trigger that failed.
    Idle,
    /// The sensor was triggered, and the line has not risen.
    Awaited,
    /// The line rose at this instant.
    Rose(Instant),
    /// The pulse is over: the instant of its rise, and its width in microseconds.
    Over(Instant, u16),
}

/// Marker of a pulse that no further edge can continue: hardware measured it, or it is too long.
const ENDED: u16 = u16::MAX;

/// The meaning of an edge for a firing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// Nothing new.
    Nothing,
    /// The line rose, so the sensor listens.
    Answer,
    /// The line rose, and the end of a pulse from before this firing was lost: that silence may have been an echo.
    AnswerAfterLoss,
    /// The pulse was too short for an echo: the line's rise was no answer.
    Disturbance,
    /// The pulse ended with the sensor's own time-out: the sensor listened and heard nothing.
    Silence,
    /// The pulse continues after a short gap: its apparent end was noise.
    GoesOn,
    /// The echo arrived at least this long after the sound was sent, and at most this much later.
    Echo(Micros, Micros),
}

/// One echo line and the state of its sensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) pulse: Pulse,
    /// True if the line was high when the sensor was to be triggered again, so that it was not triggered.
    pub(crate) is_held: bool,
    /// Greatest delay, in microseconds, between the rise of the line and its detection.
    rose_before: u16,
    /// Number of consecutive firings without a pulse.
    silent: u8,
    /// The flaw of this firing: more than one pulse, one too short, or an edge without its counterpart.
    flaw: Health,
    pub(crate) health: Health,
}

impl Line {
    /// A line before the first trigger.
    pub(crate) const NEW: Self = Self {
        pulse: Pulse::Idle,
        is_held: false,
        rose_before: 0,
        silent: 0,
        flaw: Health::Well,
        health: Health::Well,
    };

    /// Returns the meaning of an edge for the firing at `fired`; it occurred up to `before` before it was detected.
    pub(crate) fn edge(&mut self, edge: Edge, before: Micros, fired: Instant, settings: &Settings) -> Shown {
        // Without a trigger there is no crosstalk in the cable.
        let deaf = if self.is_held { Micros::ZERO } else { settings.deaf };
        if !edge.at.has_reached(fired) || edge.at.since(fired) < deaf {
            return Shown::Nothing;
        }
        match (self.pulse, edge.high) {
            (Pulse::Awaited, true) if edge.at.since(fired) > settings.latest_rise.saturating_add(before) => {
                self.silent = 0;
                self.flaw = Health::Chatters;
                Shown::Nothing
            }
            (Pulse::Awaited, true) => {
                self.rises(edge.at, before.min(edge.at.since(fired)));
                self.silent = 0;
                Shown::Answer
            }
            (Pulse::Rose(rose), false) => {
                let (width, rose_before) = (edge.at.since(rose), Micros::new(self.rose_before.into()));
                let least = width.saturating_sub(before);
                if width.saturating_add(rose_before) < settings.shortest {
                    self.pulse = Pulse::Awaited;
                    self.flaw = Health::Chatters;
                    return Shown::Disturbance;
                }
                // The module's own time-out only if certainly as long. With an Option an AVR hears nothing.
                let is_echo = least < settings.longest;
                let known = if is_echo { width.as_micros().min(ENDED.into()) as u16 } else { ENDED };
                self.pulse = Pulse::Over(rose, known);
                // A fall and a rise may have been lost since the previous trigger, unless the line was seen high.
                match is_echo {
                    true => Shown::Echo(least, rose_before.saturating_add(before.min(width))),
                    false if self.is_held || rose.has_reached(fired) => Shown::Silence,
                    false => Shown::Nothing,
                }
            }
            (Pulse::Rose(rose), true) if !rose.has_reached(fired) => {
                self.rises(edge.at, before.min(edge.at.since(fired)));
                self.health = Health::LosesEdges;
                Shown::AnswerAfterLoss
            }
            // So short a gap is noise: the pulse goes on. But its silence counts once.
            (Pulse::Over(rose, width), true)
                if width != ENDED && edge.at.since(rose + Micros::new(width.into())) < settings.shortest =>
            {
                self.pulse = Pulse::Rose(rose);
                self.flaw = Health::Chatters;
                Shown::GoesOn
            }
            (Pulse::Over(..), true) => {
                self.flaw = Health::Chatters;
                Shown::Nothing
            }
            (Pulse::Awaited, false) => {
                if self.flaw == Health::Well {
                    self.flaw = Health::LosesEdges;
                }
                self.silent = 0;
                Shown::Nothing
            }
            _ => Shown::Nothing,
        }
    }

    fn rises(&mut self, at: Instant, before: Micros) {
        self.pulse = Pulse::Rose(at);
        self.rose_before = u16::try_from(before.as_micros()).unwrap_or(u16::MAX);
    }

    /// Returns the meaning of a pulse measured by hardware.
    pub(crate) fn pulse(&mut self, width: Micros, settings: &Settings) -> Shown {
        if self.pulse == Pulse::Idle {
            return Shown::Nothing;
        }
        self.silent = 0;
        if width < settings.shortest || matches!(self.pulse, Pulse::Over(..)) {
            self.flaw = Health::Chatters;
            return Shown::Nothing;
        }
        (self.pulse, self.flaw) = (Pulse::Over(Instant::from_micros(0), ENDED), Health::Well);
        if width < settings.longest { Shown::Echo(width, Micros::ZERO) } else { Shown::Silence }
    }

    /// Returns true if the line rose after its trigger and has been high no longer than a healthy sensor holds it.
    pub(crate) fn listens_still(&self, now: Instant, longest_hold: Micros) -> bool {
        matches!(self.pulse, Pulse::Rose(rose) if now.since(rose) <= longest_hold)
    }

    /// Sets the health by the last firing, before the next trigger. Returns true if the line rose and never fell: an
    /// edge was lost, and the silence may have been an echo.
    pub(crate) fn end_firing(&mut self, missing_after: u8) -> bool {
        match self.pulse {
            Pulse::Awaited if self.flaw == Health::Well => {
                self.silent = self.silent.saturating_add(1);
                if self.silent >= missing_after {
                    self.health = Health::Missing;
                }
            }
            // A pulse may follow the apparent end of a pulse that began within the deaf time.
            Pulse::Over(..) if self.flaw == Health::LosesEdges => self.health = Health::Well,
            Pulse::Awaited | Pulse::Over(..) => self.health = self.flaw,
            // If the line is still high, the next trigger finds it stuck.
            Pulse::Rose(_) => self.health = Health::LosesEdges,
            Pulse::Idle => {}
        }
        (self.flaw, self.is_held) = (Health::Well, false);
        matches!(self.pulse, Pulse::Rose(_))
    }
}
