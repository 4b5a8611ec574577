//! [`Line`]: from the edges of one echo line to the width of a pulse, and to the health of the sensor.

use eeruf_core::{Edge, Instant, Micros};

use crate::health::Health;
use crate::settings::Settings;

/// Where a sensor is between trigger and echo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pulse {
    /// Nothing is expected: before the first trigger, and after one that could not be given.
    Idle,
    /// Triggered; the line has not risen.
    Awaited,
    /// The line rose at this instant.
    Rose(Instant),
    /// The pulse is over.
    Over,
}

/// One echo line and the state of its sensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) pulse: Pulse,
    /// Firings in a row without a pulse.
    silent: u8,
    /// What is wrong with this firing: more than one pulse or one too short, or an edge without its counterpart.
    flaw: Health,
    pub(crate) health: Health,
}

impl Line {
    /// Before the first trigger.
    pub(crate) const NEW: Self = Self { pulse: Pulse::Idle, silent: 0, flaw: Health::Well, health: Health::Well };

    /// The width of the pulse that an edge ends, if that is an echo of what was `fired` then.
    pub(crate) fn edge(&mut self, edge: Edge, fired: Instant, settings: &Settings) -> Option<Micros> {
        if !edge.at.has_reached(fired) || edge.at.since(fired) < settings.deaf {
            return None;
        }
        match (self.pulse, edge.high) {
            (Pulse::Awaited, true) => {
                self.pulse = Pulse::Rose(edge.at);
                self.silent = 0;
                None
            }
            (Pulse::Rose(rose), false) => {
                let width = edge.at.since(rose);
                if width < settings.shortest {
                    self.pulse = Pulse::Awaited;
                    self.flaw = Health::Chatters;
                    return None;
                }
                self.pulse = Pulse::Over;
                (width < settings.longest).then_some(width)
            }
            (Pulse::Over, true) => {
                self.flaw = Health::Chatters;
                None
            }
            (Pulse::Awaited, false) => {
                if self.flaw == Health::Well {
                    self.flaw = Health::LosesEdges;
                }
                self.silent = 0;
                None
            }
            _ => None,
        }
    }

    /// Sets the health by the last firing, before the next trigger.
    pub(crate) fn end_firing(&mut self, missing_after: u8) {
        match self.pulse {
            Pulse::Awaited if self.flaw == Health::Well => {
                self.silent = self.silent.saturating_add(1);
                if self.silent >= missing_after {
                    self.health = Health::Missing;
                }
            }
            // A pulse may follow what was taken for the end of one whose beginning was too soon after the trigger.
            Pulse::Over if self.flaw == Health::LosesEdges => self.health = Health::Well,
            Pulse::Awaited | Pulse::Over => self.health = self.flaw,
            // If the line is still high it is stuck, as will be seen.
            Pulse::Rose(_) => self.health = Health::LosesEdges,
            Pulse::Idle => {}
        }
        self.flaw = Health::Well;
    }
}
