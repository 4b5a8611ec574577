//! Python's file objects, for a thread that never calls Python: the thread that waits for its results reads for it.

use std::{
    io::{self, Read, Seek, SeekFrom},
    sync::mpsc::{self, Receiver, RecvTimeoutError, Sender, SyncSender},
    thread,
    time::Duration,
};

use pyo3::{
    exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyTypeError},
    prelude::*,
    types::PyBytes,
};

use crate::watch::Watch;

/// Largest number of bytes per read.
const MOST_BYTES: usize = 1 << 20;
/// Interval at which Python is asked whether work must stop.
const EVERY: Duration = Duration::from_millis(20);

/// A request of the working thread to the thread that waits for it.
enum Ask<T> {
    Read(usize),
    Seek(SeekFrom),
    /// A result.
    Take(T),
}

enum Answer {
    Bytes(Vec<u8>),
    Place(u64),
}

/// Work on a thread of its own, as seen from the waiting thread. Dropping it ends the work early.
pub(crate) struct Work<T> {
    asks: Receiver<Ask<T>>,
    answers: Sender<Answer>,
    file: Option<Py<PyAny>>,
    /// Position of the file when it was given, at which the work begins.
    base: u64,
}

/// Channel for the work's results; sending returns false once no thread waits.
pub(crate) struct Results<T>(SyncSender<Ask<T>>);

impl<T> Results<T> {
    pub(crate) fn hand_in(&self, result: T) -> bool {
        self.0.send(Ask::Take(result)).is_ok()
    }
}

/// A file object, as seen from the work.
pub(crate) struct FileObject<T> {
    asks: SyncSender<Ask<T>>,
    answers: Receiver<Answer>,
    at: u64,
    /// Bytes that were read but not used yet.
    rest: io::Cursor<Vec<u8>>,
}

impl<T: Send + 'static> Work<T> {
    /// Starts work; the file object, if any, is read from its current position.
    pub(crate) fn begin(
        py: Python<'_>,
        file: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(Option<FileObject<T>>, Results<T>) + Send + 'static,
    ) -> PyResult<Self> {
        // One result may wait, so that the work is at most that far ahead.
        let (ask, asks) = mpsc::sync_channel(1);
        let (answer, answers) = mpsc::channel();
        let base = match file.map(|file| file.call_method0("tell")) {
            Some(Ok(place)) => place.extract().unwrap_or(0),
            // A stream has no position.
            Some(Err(_)) | None => 0,
        };
        let results = Results(ask.clone());
        let theirs = file.map(|_| FileObject { asks: ask, answers, at: 0, rest: io::Cursor::default() });
        let spawned = py.detach(|| thread::Builder::new().spawn(move || work(theirs, results)));
        spawned.map_err(|error| PyRuntimeError::new_err(format!("no thread to work on: {error}")))?;
        Ok(Self { asks, answers: answer, file: file.map(|file| file.clone().unbind()), base })
    }

    /// Waits for the next result, and meanwhile reads the file for the work. An exception of the file object is raised
    /// unchanged.
    pub(crate) fn next(&mut self, py: Python<'_>) -> PyResult<T> {
        let mut watch = Watch::new(None)?;
        loop {
            if !watch.go_on(None, String::new) {
                return watch.outcome(Err(PyKeyboardInterrupt::new_err(())));
            }
            let asks = &mut self.asks;
            let answer = match py.detach(move || asks.recv_timeout(EVERY)) {
                Err(RecvTimeoutError::Timeout) => continue,
                Err(RecvTimeoutError::Disconnected) => return Err(PyRuntimeError::new_err("the work ended early")),
                Ok(Ask::Take(result)) => return Ok(result),
                Ok(Ask::Read(most)) => Answer::Bytes(self.read(py, most)?),
                Ok(Ask::Seek(to)) => Answer::Place(self.seek(py, to)?),
            };
            // If sending fails, the work has ended, and its result follows.
            _ = self.answers.send(answer);
        }
    }

    fn read(&self, py: Python<'_>, most: usize) -> PyResult<Vec<u8>> {
        let Some(file) = &self.file else { return Ok(Vec::new()) };
        let read = file.bind(py).call_method1("read", (most,))?;
        if let Ok(bytes) = read.cast::<PyBytes>() {
            return Ok(bytes.as_bytes().to_vec());
        }
        let bytes: Result<Vec<u8>, _> = read.extract();
        bytes.map_err(|_| {
            PyTypeError::new_err(format!("{file}.read({most}) gave a {}; expected bytes", read.get_type()))
        })
    }

    fn seek(&self, py: Python<'_>, to: SeekFrom) -> PyResult<u64> {
        let Some(file) = &self.file else { return Ok(0) };
        let (offset, whence) = match to {
            SeekFrom::Start(offset) => (i128::from(offset) + i128::from(self.base), 0),
            SeekFrom::Current(offset) => (offset.into(), 1),
            SeekFrom::End(offset) => (offset.into(), 2),
        };
        let file = file.bind(py);
        file.call_method1("seek", (offset, whence))?;
        let place: u64 = file.call_method0("tell")?.extract()?;
        Ok(place.saturating_sub(self.base))
    }
}

impl<T> FileObject<T> {
    fn ask(&self, ask: Ask<T>) -> io::Result<Answer> {
        let ended = || io::Error::new(io::ErrorKind::BrokenPipe, "nobody waits for it");
        self.asks.send(ask).map_err(|_| ended())?;
        self.answers.recv().map_err(|_| ended())
    }
}

impl<T> Read for FileObject<T> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if into.is_empty() {
            return Ok(0);
        }
        if self.rest.position() == self.rest.get_ref().len() as u64
            && let Answer::Bytes(bytes) = self.ask(Ask::Read(into.len().min(MOST_BYTES)))?
        {
            self.rest = io::Cursor::new(bytes);
        }
        let read = self.rest.read(into)?;
        self.at += read as u64;
        Ok(read)
    }
}

impl<T> Seek for FileObject<T> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let to = match to {
            // The object's own position is after the bytes that were not used yet.
            SeekFrom::Current(offset) => match self.at.checked_add_signed(offset) {
                Some(place) => SeekFrom::Start(place),
                None => return Err(io::ErrorKind::InvalidInput.into()),
            },
            other => other,
        };
        self.rest = io::Cursor::default();
        if let Answer::Place(place) = self.ask(Ask::Seek(to))? {
            self.at = place;
        }
        Ok(self.at)
    }
}
