//! The output options, and the width of the terminal.

use std::cell::Cell;
use std::io::IsTerminal;

use ::console::Term;

/// The least width to which lines are fitted.
const MIN_WIDTH: usize = 20;

thread_local! {
    /// The output options of the program on this thread: the Python package may run several.
    static SETTINGS: Cell<Settings> = Cell::default();
}

/// The options of output, the same for every command.
#[derive(Clone, Copy, Default)]
pub(crate) struct Settings {
    /// No warnings.
    pub(crate) quiet: bool,
    /// A warning is an error.
    pub(crate) deny_warnings: bool,
    /// Lines of any length.
    pub(crate) wide: bool,
    /// Errors quote lines of files; they always do on a terminal.
    pub(crate) explain: bool,
    /// Colours always or never; by default on a terminal unless `NO_COLOR` is set.
    pub(crate) colour: Option<bool>,
}

impl Settings {
    /// The width of lines on a stream: `COLUMNS` if it is set, or the terminal's. `None` for lines of any length.
    fn width(self, term: &Term, is_terminal: bool) -> Option<usize> {
        if self.wide {
            return None;
        }
        let set = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok()).filter(|&columns| columns > 0);
        let measured = || term.size_checked().filter(|_| is_terminal).map(|(_, columns)| usize::from(columns));
        set.or_else(measured).map(|width: usize| width.max(MIN_WIDTH))
    }

    pub(super) fn out_width(self) -> Option<usize> {
        self.width(&Term::stdout(), std::io::stdout().is_terminal())
    }

    pub(super) fn err_width(self) -> Option<usize> {
        self.width(&Term::stderr(), std::io::stderr().is_terminal())
    }

    /// Returns true if errors quote lines of files.
    pub(crate) fn explains(self) -> bool {
        self.explain || std::io::stderr().is_terminal()
    }

    /// Returns true if standard error takes colours.
    pub(super) fn is_err_coloured(self) -> bool {
        let is_refused = || std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let is_dumb = || std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        self.colour.unwrap_or_else(|| std::io::stderr().is_terminal() && !is_refused() && !is_dumb())
    }
}

/// Sets the options of this thread's output from here on.
pub(crate) fn set(settings: Settings) {
    SETTINGS.set(settings);
}

/// Returns the options of this thread's output.
pub(crate) fn settings() -> Settings {
    SETTINGS.get()
}
