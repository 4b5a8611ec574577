//! The log that `eeruf diagnose` reads: a row for each firing, in the order of the ring's readings.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use eeruf_core::{Micros, judge::Explanation};
use eeruf_files::{FIRING_COLUMNS, firing_row};
use eeruf_serial::FiringMessage;

pub(crate) struct FiringLog {
    file: BufWriter<File>,
    begun: bool,
}

impl FiringLog {
    pub(crate) fn create(path: &Path) -> Result<Self, String> {
        let file = File::create(path).map_err(|error| format!("log: {}: {error}", path.display()))?;
        Ok(Self { file: BufWriter::new(file), begun: false })
    }

    /// Writes a firing, timed by the clock of this name.
    pub(crate) fn write(&mut self, clock: &str, firing: &FiringMessage) -> io::Result<()> {
        if !self.begun {
            self.begun = true;
            writeln!(self.file, "# clock: {clock}, 32 bits")?;
            writeln!(self.file, "{FIRING_COLUMNS},explained_by,late_us")?;
        }
        let FiringMessage { sensor, period, phase, kind, explained_by, .. } = firing;
        let echo = firing.t_echo.map(Micros::as_micros);
        let (fired, late) = (firing.fired.as_micros(), firing.late.as_micros());
        let by = match explained_by {
            None => String::new(),
            Some(Explanation::Sensor(sensor)) => sensor.to_string(),
            Some(Explanation::History) => "history".to_owned(),
        };
        writeln!(self.file, "{},{by},{late}", firing_row(*sensor, fired, *period, *phase, echo, kind))
    }

    /// Writes buffered rows to the disk.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::{Instant, ReadingKind};

    #[test]
    fn diagnose_reads_what_is_written_through_a_wrap_of_the_clock() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("log.csv");
        let mut log = FiringLog::create(&file).unwrap();
        let by = [None, None, None, Some(Explanation::Sensor(6)), Some(Explanation::History)];
        let kinds = [ReadingKind::Accepted, ReadingKind::Rejected, ReadingKind::NoEcho, ReadingKind::Ambiguous];
        for (n, (kind, explained_by)) in kinds.into_iter().chain([ReadingKind::Ambiguous]).zip(by).enumerate() {
            let firing = FiringMessage {
                sensor: n as u8,
                phase: 1,
                kind,
                fired: Instant::from_micros(u32::MAX - 10) + Micros::new(10 * n as u32),
                period: 7,
                t_echo: (kind != ReadingKind::NoEcho).then_some(Micros::new(5_872)),
                late: Micros::ZERO,
                age: Micros::ZERO,
                explained_by,
            };
            log.write("board", &firing).unwrap();
        }
        log.flush().unwrap();
        let read = eeruf_logs::FiringLog::read(&file).unwrap();
        assert_eq!(read.clock, "board, 32 bits");
        let rows: Vec<_> =
            read.firings.iter().map(|firing| (firing.fired_us, firing.t_echo_us, firing.reading)).collect();
        let first = i64::from(u32::MAX) - 10;
        let expected = [
            (first, Some(5_872), Some(kinds[0])),
            (first + 10, Some(5_872), Some(kinds[1])),
            (first + 20, None, Some(kinds[2])),
            (first + 30, Some(5_872), Some(kinds[3])),
            (first + 40, Some(5_872), Some(kinds[3])),
        ];
        assert_eq!(rows, expected);
        let text = std::fs::read_to_string(&file).unwrap();
        assert!(text.contains(",ambiguous,6,0\n") && text.contains(",ambiguous,history,0\n"), "{text}");
    }
}
