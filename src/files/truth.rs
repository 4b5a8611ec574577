//! Readings with their causes, as CSV: a log of firings that `diagnose` reads, with the ground truth beside it.

use std::fmt::Write as _;

use eeruf_files::FIRING_COLUMNS;
use eeruf_sim::experiments::set_two::TrackPoint;
use eeruf_sim::{Cause, Readings};

use super::firings::{CLOCK, firing};

/// The readings of the first robot. Sensors and robots from 0; times in whole microseconds, so that machines whose
/// sines differ in the last bit agree.
pub(crate) fn readings_csv(readings: &Readings) -> String {
    let mut text = format!("# clock: {CLOCK}\n{FIRING_COLUMNS},alone_us,cause,sender,sender_robot,length_mm,bounces\n");
    let mut order: Vec<_> = (0..readings.len()).filter(|&k| readings.robot[k] == 0).collect();
    order.sort_by(|&a, &b| readings.fired_s[a].total_cmp(&readings.fired_s[b]));
    let number = |value: f64| if value.is_nan() { String::new() } else { format!("{value:.0}") };
    for k in order {
        let path = readings.path_of(k).map_or_else(
            || ",,,".to_owned(),
            |path| {
                let (sender, length_mm) = (path.emitter, number(1000.0 * path.length_m));
                format!("{},{},{length_mm},{}", sender.sensor, sender.robot, path.order)
            },
        );
        let (alone, cause) = (number(readings.reference_us[k]), cause(readings.cause[k]));
        // Writing to a string does not fail.
        _ = writeln!(text, "{},{alone},{cause},{path}", firing(readings, k));
    }
    text
}

fn cause(cause: Cause) -> &'static str {
    match cause {
        Cause::Nothing => "nothing",
        Cause::Own => "own",
        Cause::Stale => "stale",
        Cause::Crosstalk => "crosstalk",
        Cause::External => "external",
    }
}

/// Writes the places of a robot as CSV.
pub(crate) fn track_csv(track: &[TrackPoint]) -> String {
    let mut text = "time_s,x_m,y_m,heading_rad,speed_m_s\n".to_owned();
    for TrackPoint { time_s, x_m, y_m, heading_rad, speed_m_s } in track {
        _ = writeln!(text, "{time_s:.3},{x_m:.4},{y_m:.4},{heading_rad:.4},{speed_m_s:.3}");
    }
    text
}
