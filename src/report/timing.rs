//! The timing of two periods as text: when each sensor fires, and how long it listens.

use std::fmt::Write as _;

use eeruf_core::{Phase, Requirements};
use eeruf_sim::AnySchedule;

const COLUMNS: usize = 96;

/// One line for each sensor; time runs to the right through phases a and b. `#` fires, `-` listens.
pub(crate) fn diagram(schedule: &AnySchedule, requirements: &Requirements<'_>) -> String {
    let period = f64::from(schedule.period().as_micros());
    let column_us = 2.0 * period / COLUMNS as f64;
    let column = |us: f64| ((us / column_us) as usize).min(COLUMNS);
    let mut text = String::new();
    _ = writeln!(text, "Two periods, {:.1} ms a column: # fires, - listens", column_us / 1000.0);
    _ = writeln!(text, "      |{:<half$}|{:<half$}|", " phase a", " phase b", half = (COLUMNS - 1) / 2);
    for x in 0..schedule.sensors() {
        let mut line = [' '; COLUMNS];
        let fires = [(Phase::A, 0.0), (Phase::B, period)]
            .into_iter()
            .filter_map(|(phase, start)| Some(start + f64::from(schedule.t_fire(phase, x)?.as_micros())));
        let fires: Vec<f64> = fires.collect();
        for &fire in &fires {
            // A window that lasts beyond the second period goes on in the first.
            for start in [fire, fire - 2.0 * period] {
                let end = column(start + f64::from(requirements.window_of(x).as_micros())).max(column(start.max(0.0)));
                line[column(start.max(0.0))..end].fill('-');
            }
        }
        for &fire in &fires {
            if let Some(mark) = line.get_mut(column(fire)) {
                *mark = '#';
            }
        }
        _ = writeln!(text, "{:>5} |{}|", x + 1, String::from_iter(line));
    }
    text
}
