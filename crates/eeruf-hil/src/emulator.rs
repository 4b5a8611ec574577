//! An emulated board as a process: it writes records to standard output and reads answers from standard input.
//!
//! The firmware opens both as files through the debugger. Its text output goes to standard error.

use std::io::{BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use eeruf_hil::{Ahead, Orders, Record};

/// Time after which a board that hangs is ended; a run takes seconds.
const LONGEST: Duration = Duration::from_secs(120);

/// A running board.
pub(crate) struct Emulator {
    child: Arc<Mutex<Child>>,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    text: Option<JoinHandle<String>>,
    /// Channel that ends the watchdog, and its thread, which returns true if it had to end the board.
    watch: Option<(Sender<()>, JoinHandle<bool>)>,
}

impl Emulator {
    /// Starts a board by this command and gives it its orders.
    pub(crate) fn start(command: &[String], orders: Orders) -> Result<Self, String> {
        let [program, arguments @ ..] = command else { return Err("no emulator given".to_owned()) };
        let spawned = Command::new(program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let mut child = spawned.map_err(|error| format!("{program}: {error}"))?;
        let (Some(input), Some(output), Some(mut errors)) =
            (child.stdin.take(), child.stdout.take(), child.stderr.take())
        else {
            return Err(format!("{program}: no pipes"));
        };
        let text = thread::spawn(move || {
            let mut text = Vec::new();
            // Output before an error is still worth reporting.
            let _ = errors.read_to_end(&mut text);
            String::from_utf8_lossy(&text).into_owned()
        });
        let child = Arc::new(Mutex::new(child));
        let (done, ended) = channel();
        let watched = Arc::clone(&child);
        let watch = thread::spawn(move || {
            let late =
                ended.recv_timeout(LONGEST).is_err_and(|error| error == std::sync::mpsc::RecvTimeoutError::Timeout);
            if late {
                // The board may have ended at this very moment.
                let _ = watched.lock().unwrap_or_else(PoisonError::into_inner).kill();
            }
            late
        });
        let output = BufReader::new(output);
        let mut board = Self { child, input, output, text: Some(text), watch: Some((done, watch)) };
        board.send(&orders.to_words())?;
        Ok(board)
    }

    fn send(&mut self, words: &[u32]) -> Result<(), String> {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.input.write_all(&bytes).and_then(|()| self.input.flush()).map_err(|error| format!("to the board: {error}"))
    }

    /// Answers a trigger with the edges to come.
    pub(crate) fn answer(&mut self, ahead: &[Ahead]) -> Result<(), String> {
        let mut words = vec![ahead.len() as u32];
        words.extend(ahead.iter().flat_map(|ahead| ahead.to_words()));
        self.send(&words)
    }

    /// Returns the next record of the board; `None` when it has ended.
    pub(crate) fn next(&mut self) -> Result<Option<Record>, String> {
        let mut bytes = [0; Record::BYTES];
        match self.output.read(&mut bytes[..1]) {
            Ok(0) => return Ok(None),
            Ok(_) => {}
            Err(error) => return Err(format!("from the board: {error}")),
        }
        self.output.read_exact(&mut bytes[1..]).map_err(|error| format!("from the board: {error}"))?;
        let (words, _) = bytes.as_chunks::<4>();
        // As many words as a record has.
        Ok(Some(Record(core::array::from_fn(|n| u32::from_le_bytes(words[n])))))
    }

    /// Waits for a board that has sent its last record, or that has failed. Fails unless it exited with 0; its text is
    /// then part of the error.
    pub(crate) fn finish(mut self, outcome: Result<(), String>) -> Result<(), String> {
        let status = {
            let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
            if outcome.is_err() {
                // It may have ended already.
                let _ = child.kill();
            }
            child.wait()
        };
        let late = self.end_watch();
        let text = self.text.take().and_then(|text| text.join().ok()).unwrap_or_default();
        let why = match (outcome, status) {
            _ if late => format!("the board was not finished after {} s", LONGEST.as_secs()),
            (Err(error), _) => error,
            (Ok(()), Ok(status)) if status.success() => return Ok(()),
            (Ok(()), Ok(status)) => format!("the board left with {status}"),
            (Ok(()), Err(error)) => error.to_string(),
        };
        // QEMU complains about a timer that is not yet set; that is harmless.
        let text: Vec<&str> = text.lines().filter(|line| !line.contains("Timer with period zero")).collect();
        Err(format!("{why}\n{}", text.join("\n")))
    }

    fn end_watch(&mut self) -> bool {
        let Some((done, watch)) = self.watch.take() else { return false };
        drop(done);
        watch.join().unwrap_or(false)
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // The board has already ended, except after errors.
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = child.kill();
        let _ = child.wait();
    }
}
