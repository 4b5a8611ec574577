//! Raw frames of the serial line: readings for [`read_log`](crate::read_log), and firings.

use std::io::{self, Read};
use std::path::Path;

use eeruf_serial::{Decoder, FiringMessage, FrameError, Message};

use crate::firings::{Firing, FiringLog};
use crate::options::{Parts, RangeUnit};
use crate::reading::{LogReading, Sensor};
use crate::sink::Sink;
use eeruf_files::FileError;

/// Returns true if there are two whole frames with correct check sums, and more such frames than damaged ones.
pub(crate) fn is_serial(first: &[u8]) -> bool {
    let mut decoder = Decoder::default();
    let (mut whole, mut damaged) = (0, 0);
    for &byte in first {
        match decoder.push(byte) {
            Some(Ok(_) | Err(FrameError::Content(_))) => whole += 1,
            Some(Err(_)) => damaged += 1,
            None => {}
        }
    }
    whole >= 2 && whole > damaged
}

/// Contents of a recording besides its firings.
#[derive(Default)]
struct Line {
    clock: String,
    damaged: u64,
    lost: u64,
}

impl Line {
    fn damage(&self) -> Option<String> {
        let parts = [(self.damaged, "damaged"), (self.lost, "missing by their numbers")];
        let parts: Vec<_> =
            parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        (!parts.is_empty()).then(|| format!("frames: {}", parts.join(", ")))
    }
}

/// Passes each firing with its time, in microseconds of a clock that does not wrap.
fn frames(mut input: impl Read, mut each: impl FnMut(FiringMessage, i64)) -> io::Result<Line> {
    let (mut decoder, mut line) = (Decoder::default(), Line::default());
    let (mut next, mut last, mut is_first) = (None, None::<(u32, i64)>, true);
    let mut buffer = vec![0; 1 << 14];
    loop {
        let read = match input.read(&mut buffer) {
            Ok(0) => return Ok(line),
            Ok(read) => read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        for &byte in &buffer[..read] {
            let Some(frame) = decoder.push(byte) else { continue };
            let received = match frame {
                Ok(received) => received,
                Err(_) => {
                    // A recording may begin in the middle of a frame.
                    line.damaged += u64::from(!std::mem::take(&mut is_first));
                    continue;
                }
            };
            is_first = false;
            // A large step means that the board restarted.
            let skipped = next.map_or(0, |next: u16| received.sequence.wrapping_sub(next));
            line.lost += u64::from(if skipped < 1 << 12 { skipped } else { 0 });
            next = Some(received.sequence.wrapping_add(1));
            match received.message {
                Message::Hello { clock, .. } if line.clock.is_empty() => line.clock = clock,
                Message::Firing(firing) => {
                    let us = firing.fired.as_micros();
                    let at = last
                        .map_or(i64::from(us), |(before, at)| at + i64::from(us.wrapping_sub(before).cast_signed()));
                    last = Some((us, at));
                    each(firing, at);
                }
                _ => {}
            }
        }
    }
}

/// Reads ranges; `file` is used in errors.
pub(crate) fn read(input: impl Read, file: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    sink.has(Parts::Frames);
    let options = sink.options;
    let metres = RangeUnit::Us.metres(options.speed_of_sound);
    let mut sensors = [None; 256];
    let line = frames(input, |firing, at_us| {
        let known = sink.report.sensors.len();
        let sensor = *sensors[usize::from(firing.sensor)].get_or_insert(known);
        if sensor == known {
            let topic = format!("sonar_{}", firing.sensor + 1);
            sink.report.sensors.push(Sensor { topic, frame: String::new(), beam: None });
        }
        sink.report.messages += 1;
        let at_ns = u64::try_from(at_us).ok().map(|us| 1000 * us);
        let range_m = firing.t_echo.map_or(f64::INFINITY, |us| f64::from(us.as_micros()) * metres);
        sink.reading(&LogReading::new(sensor, at_ns, range_m, options.no_echo_m));
    });
    let line = line.map_err(|error| FileError::reading(file, &error))?;
    if let Some(damage) = line.damage() {
        sink.damage(file, None, damage);
    }
    Ok(())
}

/// Reads firings; `file` is used in errors.
pub(crate) fn firings(input: impl Read, file: &Path) -> Result<FiringLog, FileError> {
    let mut firings = vec![];
    let line = frames(input, |firing, at| {
        firings.push(Firing {
            sensor: firing.sensor,
            fired_us: at,
            period: firing.period,
            phase: firing.phase,
            t_echo_us: firing.t_echo.map(eeruf_core::Micros::as_micros),
            reading: Some(firing.kind),
            g_us_ms: None,
        });
    });
    let line = line.map_err(|error| FileError::reading(file, &error))?;
    if firings.is_empty() {
        return Err(FileError::new(file, "frames of the serial line, and no firing among them"));
    }
    let damage = line.damage();
    let clock = if line.clock.is_empty() { "unnamed" } else { &line.clock };
    Ok(FiringLog { damage, ..FiringLog::new(clock, firings) })
}
