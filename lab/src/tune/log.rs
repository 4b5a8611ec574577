//! Record of scores in a file: a stopped search continues from it.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::Path;

use eeruf_sim::Method;

use super::score::{Round, Score};

/// Key of a score: method, round, number of the candidate.
type Key = (String, usize, usize);

/// All scores so far.
pub(crate) struct Log {
    scores: HashMap<Key, Score>,
    file: File,
}

impl Log {
    /// Opens the log of a search with these rounds, in a folder that is created if necessary. A truncated line is tried
    /// again.
    pub(crate) fn open(folder: &Path, rounds: &[Round]) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let rounds: Vec<_> = rounds.iter().map(|round| format!("{}x{}", round.pilots, round.courses)).collect();
        let path = folder.join(format!("set-two-{}.tsv", rounds.join("-")));
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            read => read?,
        };
        let scores = text.lines().filter_map(read).collect();
        let mut file = OpenOptions::new().create(true).append(true).open(path)?;
        if !text.is_empty() && !text.ends_with('\n') {
            writeln!(file)?;
        }
        Ok(Self { scores, file })
    }

    /// Returns the score of a candidate from the log, or else from a run, which is then stored.
    pub(crate) fn score<E: From<io::Error>>(
        &mut self,
        (method, round, number): (Method, usize, usize),
        run: impl FnOnce() -> Result<Score, E>,
    ) -> Result<Score, E> {
        let key = (method.to_string(), round, number);
        if let Some(score) = self.scores.get(&key) {
            return Ok(*score);
        }
        let score = run()?;
        let Score { finished: [alone, behind, ahead], time_s } = score;
        writeln!(self.file, "{method}\t{round}\t{number}\t{alone}\t{behind}\t{ahead}\t{time_s}\tend")?;
        self.scores.insert(key, score);
        Ok(score)
    }
}

fn read(line: &str) -> Option<(Key, Score)> {
    let [method, round, number, alone, behind, ahead, time_s, "end"] = line.split('\t').collect::<Vec<_>>()[..] else {
        return None;
    };
    let finished = [alone.parse().ok()?, behind.parse().ok()?, ahead.parse().ok()?];
    let score = Score { finished, time_s: time_s.parse().ok()? };
    Some(((method.to_owned(), round.parse().ok()?, number.parse().ok()?), score))
}
