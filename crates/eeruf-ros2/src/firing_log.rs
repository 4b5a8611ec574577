//! The log that `eeruf diagnose` reads, and of a hopping ring `eeruf replay --hopping`: a row for each firing, in the
//! order in which the ring gave its readings.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use eeruf_core::judge::Explanation;
use eeruf_serial::{Firing, Weighed};

pub(crate) struct FiringLog {
    file: BufWriter<File>,
    begun: bool,
    /// True if the ring's first firing said how it was weighed.
    hops: bool,
}

impl FiringLog {
    pub(crate) fn create(path: &Path) -> Result<Self, String> {
        let file = File::create(path).map_err(|error| format!("log: {}: {error}", path.display()))?;
        Ok(Self { file: BufWriter::new(file), begun: false, hops: false })
    }

    /// Writes a firing, by a clock of this name.
    pub(crate) fn write(&mut self, clock: &str, firing: &Firing) -> io::Result<()> {
        if !self.begun {
            (self.begun, self.hops) = (true, firing.weighed.is_some());
            let weighed = if self.hops { ",solo,steady,changes,expected_us" } else { "" };
            writeln!(self.file, "# clock: {clock}, 32 bits")?;
            writeln!(self.file, "sensor,fired_us,period,phase,t_echo_us,reading,explained_by,late_us{weighed}")?;
        }
        let Firing { sensor, period, phase, kind, explained_by, weighed, .. } = firing;
        let echo = firing.t_echo.map(|t_echo| t_echo.as_micros().to_string()).unwrap_or_default();
        let (fired, late) = (firing.fired.as_micros(), firing.late.as_micros());
        let by = match explained_by {
            None => String::new(),
            Some(Explanation::Sensor(sensor)) => sensor.to_string(),
            Some(Explanation::History) => "history".to_owned(),
        };
        write!(self.file, "{sensor},{fired},{period},{phase},{echo},{kind},{by},{late}")?;
        match weighed.filter(|_| self.hops) {
            Some(Weighed { solo, steady, changes, expected_change_us }) => {
                let [solo, steady] = [solo, steady].map(u8::from);
                writeln!(self.file, ",{solo},{steady},{changes},{expected_change_us}")
            }
            None => writeln!(self.file, "{}", if self.hops { ",,,," } else { "" }),
        }
    }

    /// Brings to the disk what was written.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    use eeruf_core::{
        Instant, Micros, ReadingKind, RingEvent,
        hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    };
    use eeruf_serial::{Decoder, Message, Recorder};

    #[test]
    fn diagnose_reads_what_is_written_through_a_wrap_of_the_clock() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("log.csv");
        let mut log = FiringLog::create(&file).unwrap();
        let by = [None, None, None, Some(Explanation::Sensor(6)), Some(Explanation::History)];
        let kinds = [ReadingKind::Accepted, ReadingKind::Rejected, ReadingKind::NoEcho, ReadingKind::Ambiguous];
        for (n, (kind, explained_by)) in kinds.into_iter().chain([ReadingKind::Ambiguous]).zip(by).enumerate() {
            let firing = Firing {
                sensor: n as u8,
                phase: 1,
                kind,
                fired: Instant::from_micros(u32::MAX - 10) + Micros::new(10 * n as u32),
                period: 7,
                t_echo: (kind != ReadingKind::NoEcho).then_some(Micros::new(5_872)),
                late: Micros::ZERO,
                age: Micros::ZERO,
                explained_by,
                weighed: None,
            };
            log.write("board", &firing).unwrap();
        }
        log.flush().unwrap();
        let read = eeruf_logs::FiringLog::read(&file).unwrap();
        assert_eq!(read.clock, "board, 32 bits");
        let rows: Vec<_> =
            read.firings.iter().map(|firing| (firing.fired_us, firing.t_echo_us, firing.rejected)).collect();
        let first = i64::from(u32::MAX) - 10;
        let expected = [
            (first, Some(5_872), Some(false)),
            (first + 10, Some(5_872), Some(true)),
            (first + 20, None, Some(false)),
            (first + 30, Some(5_872), Some(true)),
            (first + 40, Some(5_872), Some(true)),
        ];
        assert_eq!(rows, expected);
        let text = std::fs::read_to_string(&file).unwrap();
        assert!(text.contains(",ambiguous,6,0\n") && text.contains(",ambiguous,history,0\n"), "{text}");
    }

    /// A ring of eight among its own sound and that of others; each path is as long as its two sensors say.
    fn hopping_ring() -> HoppingRing<8> {
        let code = HoppingCode::new(8, 2, Micros::new(240)).unwrap();
        let schedule = HoppingSchedule::<8>::spread(code, Micros::from_millis(60)).unwrap();
        let listening = HoppingListening::new(Micros::from_millis(36));
        HoppingRing::hopping(&schedule, HoppingSettings::BALANCED, listening, 1, Instant::from_micros(0)).unwrap()
    }

    // The log of a hopping ring is complete so that its tracker can be run again.
    #[test]
    fn hopping_log_is_complete_for_its_tracker() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("log.csv");
        let mut log = FiringLog::create(&file).unwrap();
        let (mut ring, mut recorder, mut decoder) = (hopping_ring(), Recorder::<8>::new("board"), Decoder::default());
        // Edges that are still to come, by their instant.
        let mut edges = BTreeSet::<(u32, u8)>::new();
        let (mut listens, mut made) = ([None; 8], vec![]);
        for turn in 0..30_000_u32 {
            // Now and then the main loop is late, and sometimes by more than the timetable bears.
            let late = if turn % 997 == 0 { 1_700 } else { turn % 13 * turn % 31 };
            let now = ring.next_deadline() + Micros::new(late);
            while let Some(&(at, sensor)) = edges.first().filter(|edge| edge.0 <= now.as_micros()) {
                edges.remove(&(at, sensor));
                // A module has one edge for each firing, and is deaf at first.
                if listens[usize::from(sensor)].take_if(|fired| at > *fired + 2_400).is_some() {
                    ring.echo(sensor, Instant::from_micros(at)).unwrap();
                }
            }
            let change = |sensor: u8| i32::from(sensor) * (turn / 50 % 3) as i32 - 4;
            while let Some(event) = ring.poll_expecting(now, change) {
                if let RingEvent::Fire { sensor, .. } = event {
                    listens[usize::from(sensor)] = Some(now.as_micros());
                    // Its own echo, and what of it the neighbours hear sooner than theirs.
                    edges.insert((now.as_micros() + 11_000 + 40 * (turn % 3), sensor));
                    for other in (0..8).filter(|other| sensor.abs_diff(*other) == 1) {
                        edges.insert((now.as_micros() + 15_000 + 500 * u32::from(sensor + other), other));
                    }
                }
                if let RingEvent::Reading(reading) = event {
                    made.push(reading.kind);
                }
                let frame = recorder.hopping_event(&event, now, (&ring, change), |_| 0, 0);
                for &byte in frame.as_ref().map_or(&[][..], |frame| frame.as_bytes()) {
                    match decoder.push(byte).transpose().unwrap().map(|received| received.message) {
                        Some(Message::Firing(firing)) => log.write("board", &firing).unwrap(),
                        Some(Message::Hello { .. } | Message::Period { .. }) | None => {}
                    }
                }
            }
        }
        log.flush().unwrap();
        let read = eeruf_logs::FiringLog::read(&file).unwrap();
        let verdicts = eeruf_logs::replay(&read, HoppingSettings::BALANCED.tracker).unwrap();
        let weighed = || read.firings.iter().map(|firing| firing.weighed.as_ref().unwrap());
        let mut again: Vec<_> = weighed().map(|weighed| weighed.given).zip(verdicts).collect();
        again.sort_by_key(|(given, _)| *given);
        assert_eq!(again.iter().map(|(_, verdict)| verdict.kind).collect::<Vec<_>>(), made);
        // All that matters has happened.
        let count = |kind| made.iter().filter(|&&made| made == kind).count();
        let few = [ReadingKind::Accepted, ReadingKind::Rejected, ReadingKind::Tentative].map(count);
        assert!(few[0] > 1_000 && few[1] > 1_000 && few[2] > 10, "{few:?}");
        assert!(weighed().any(|weighed| weighed.solo) && weighed().any(|weighed| !weighed.steady));
        assert!(weighed().any(|weighed| weighed.changes > 5 && weighed.expected_change_us < 0));
    }
}
