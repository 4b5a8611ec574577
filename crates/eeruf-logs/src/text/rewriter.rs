//! Logs in which each line wraps readings in a form of its own, rewritten into lines that are read anyway.
//!
//! A line that seems to hold a reading and does not fit the form is damaged.

use super::esphome::EspHome;
use super::groups::Groups;
use super::lines::Rewritten;

pub(super) enum Rewriter {
    EspHome(EspHome),
    Groups(Groups),
}

impl Rewriter {
    /// The form of a text by its beginning, if it is one of these.
    pub(super) fn of(start: &str) -> Option<Self> {
        // The last one may not be whole, and the first may be cut.
        let whole = start.rsplit_once('\n').map_or(start, |(whole, _)| whole);
        let lines = whole.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        let lines: Vec<_> = lines.take(50).collect();
        let esphome = || EspHome::is_in(start).then(|| Self::EspHome(EspHome::default()));
        Groups::of(&lines).map(Self::Groups).or_else(esphome)
    }

    pub(super) const fn form(&self) -> &'static str {
        match self {
            Self::EspHome(_) => "ESPHome's log",
            Self::Groups(_) => "a table of many measurements a row",
        }
    }

    pub(super) fn rewrite(&mut self, line: &str) -> Rewritten {
        match self {
            Self::EspHome(log) => log.rewrite(line),
            Self::Groups(groups) => groups.rewrite(line),
        }
    }
}
