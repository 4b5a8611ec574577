//! One line of a text log: one firing.

use std::fmt::Display;

/// The columns of a firing's row; a log may have more.
pub const FIRING_COLUMNS: &str = "sensor,fired_us,period,phase,t_echo_us,reading";

/// Returns the row of a firing, with the ring's verdict. Sensors, periods and phases are counted from 0.
///
/// ```
/// assert_eq!(eeruf_files::firing_row(4, 15_000, 0, 1, Some(5872), "rejected"), "4,15000,0,1,5872,rejected");
/// assert_eq!(eeruf_files::firing_row(4, 15_000, 0, 1, None, "no_echo"), "4,15000,0,1,,no_echo");
/// ```
pub fn firing_row(
    sensor: u8,
    fired_us: impl Display,
    period: u32,
    phase: u8,
    t_echo_us: Option<u32>,
    reading: impl Display,
) -> String {
    let echo = t_echo_us.map(|us| us.to_string()).unwrap_or_default();
    format!("{sensor},{fired_us},{period},{phase},{echo},{reading}")
}
