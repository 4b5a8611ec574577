//! The rule of docs/explanation/theory.md section 2.1, implemented from that text and applied to all firings in true
//! time.

use eeruf_core::Reading;

/// Firings and sounds of one sensor.
#[derive(Clone, Default)]
struct Sensor {
    /// All instants of firings, in true time.
    fired: Vec<u64>,
    /// The last reading with an echo: the firing and when the echo was heard.
    last: Option<(u64, u64)>,
}

/// All firings, and the last reading of each sensor.
pub(super) struct Model {
    sensors: Vec<Sensor>,
}

/// The model's finding on a reading that agrees with the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compared {
    /// Some firings explain both.
    Explained,
    /// Nothing foreign explains both.
    Unexplained,
}

/// Limits of sound, in microseconds.
#[derive(Clone, Copy)]
pub(super) struct Sound {
    pub(super) t_delta: u64,
    pub(super) path_change: u64,
    pub(super) audible: u64,
}

impl Model {
    pub(super) fn new(sensors: usize) -> Self {
        Self { sensors: vec![Sensor::default(); sensors] }
    }

    /// Records a firing of a sensor at this instant.
    pub(super) fn fired(&mut self, sensor: u8, at: u64) {
        self.sensors[usize::from(sensor)].fired.push(at);
    }

    /// Forgets a sensor's last reading.
    pub(super) fn forget(&mut self, sensor: u8) {
        self.sensors[usize::from(sensor)].last = None;
    }

    /// Records the reading of the sensor's last firing, and the change that odometry expects. Returns `None` if it has
    /// no echo, no reading before it, or does not agree.
    pub(super) fn read(&mut self, reading: &Reading, sound: Sound, change: i32) -> Option<Compared> {
        let y = usize::from(reading.sensor);
        let f2 = *self.sensors[y].fired.last()?;
        let now = reading.t_echo.map(|echo| (f2, f2 + u64::from(echo.as_micros())));
        let before = std::mem::replace(&mut self.sensors[y].last, now);
        let ((f1, h1), (f2, h2)) = (before?, now?);
        if ((h2 - f2) as i64).abs_diff((h1 - f1) as i64 + i64::from(change)) > sound.t_delta {
            return None;
        }
        let audible = |at: u64, heard: u64| at <= heard && heard - at <= sound.audible;
        let explains = |x: usize| {
            self.sensors[x].fired.iter().rev().take_while(|&&a| a + sound.audible >= h1).any(|&a| {
                let fired = self.sensors[x].fired.iter().rev().take_while(|&&b| b + sound.audible >= h1);
                audible(a, h1)
                    && (x != y || a != f1)
                    && fired
                        .filter(|&&b| audible(b, h2) && (x != y || b != f2))
                        .any(|&b| (h2 - b).abs_diff(h1 - a) <= sound.path_change)
            })
        };
        Some(if (0..self.sensors.len()).any(explains) { Compared::Explained } else { Compared::Unexplained })
    }
}
