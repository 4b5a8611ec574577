//! Answer of a command, and with it the exit code.

pub(crate) enum Answer {
    /// Exit code 0.
    Yes,
    /// Not verified, or infeasible: exit code 1.
    No,
    /// Budget or time ended the search before its answer: exit code 3.
    NotDecided,
}
