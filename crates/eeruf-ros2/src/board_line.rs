//! The serial line to a board: a thread opens and reads it, and reopens it after the board was unplugged.

use std::io::ErrorKind;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use eeruf_serial::{Decoder, FrameError, Received};
use serial2::SerialPort;

/// Input from the line, or a change of its state.
pub(crate) enum FromLine {
    /// The port is open.
    Opened,
    /// The line cannot be opened or has disappeared; the thread retries each second.
    Lost(String),
    /// A frame, intact or damaged, and the time when its last byte was read, in nanoseconds since 1970.
    Frame(Result<Received, FrameError>, i64),
}

/// Interval between attempts to open the port.
const AGAIN: Duration = Duration::from_secs(1);
/// Longest time for which a read waits.
const PATIENCE: Duration = Duration::from_millis(200);

/// Listens until the receiver is gone.
pub(crate) fn listen(port: String, baud: u32, to: Sender<FromLine>) {
    thread::spawn(move || {
        loop {
            let error = match open(&port, baud) {
                Ok(line) => {
                    if to.send(FromLine::Opened).is_err() {
                        return;
                    }
                    match read(&line, &to) {
                        Ok(()) => return,
                        Err(error) => error,
                    }
                }
                Err(error) => error,
            };
            if to.send(FromLine::Lost(format!("{port}: {error}"))).is_err() {
                return;
            }
            thread::sleep(AGAIN);
        }
    });
}

fn open(port: &str, baud: u32) -> std::io::Result<SerialPort> {
    let mut line = SerialPort::open(port, baud)?;
    line.set_read_timeout(PATIENCE)?;
    Ok(line)
}

/// Reads until the line fails, or the receiver is gone.
fn read(line: &SerialPort, to: &Sender<FromLine>) -> std::io::Result<()> {
    let mut decoder = Decoder::default();
    let mut bytes = [0; 1024];
    // The first bytes are usually the rest of a frame.
    let mut begun = false;
    loop {
        let count = match line.read(&mut bytes) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::TimedOut || error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        let now = nanoseconds();
        for &byte in bytes.iter().take(count) {
            let frame = decoder.push(byte);
            let rest_of_a_frame = !begun;
            begun |= byte == 0;
            let frame = match frame {
                None => continue,
                Some(Err(FrameError::Damaged)) if rest_of_a_frame => continue,
                Some(frame) => frame,
            };
            if to.send(FromLine::Frame(frame, now)).is_err() {
                return Ok(());
            }
        }
    }
}

/// The host's clock, in nanoseconds since 1970.
pub(crate) fn nanoseconds() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_nanos()).unwrap_or(i64::MAX)
}
