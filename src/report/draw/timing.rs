//! The timing diagram of a schedule (Fig. 3).

use eeruf_core::{Phase, Requirements};
use eeruf_sim::AnySchedule;
use plotters::style::Color;

use super::picture::Picture;
use super::style::{INK, LISTENING, REJECTED, TITLE};

/// Draws the firings of two periods and the listening windows: one lane for each sensor, as Fig. 3
/// of the paper.
pub(crate) fn timing_diagram(schedule: &AnySchedule, requirements: &Requirements<'_>) -> Picture {
    const LANE: f64 = 26.0;
    const LEFT: f64 = 48.0;
    const TOP: f64 = 76.0;
    const WIDTH: f64 = 900.0;
    let period = f64::from(schedule.period().as_micros());
    let x_of = |us: f64| LEFT + (us / (2.0 * period) * WIDTH).round();
    let bottom = TOP + LANE * schedule.sensors() as f64;
    let mut picture = Picture::new(LEFT + WIDTH + 24.0, bottom + 50.0);
    let title = format!("{} sensors, T_p = {}: firing and listening", schedule.sensors(), schedule.period());
    picture.text(title, (LEFT, 19.0), TITLE);
    for (phase, start) in [(Phase::A, 0.0), (Phase::B, period)] {
        picture.text(format!("phase {phase}"), (x_of(start) + 6.0, 52.0), 14.0);
    }
    for start in [0.0, period, 2.0 * period] {
        picture.line((x_of(start), 44.0), (x_of(start), bottom), 1.0, INK.mix(0.5));
    }
    picture.time_grid(2.0 * period, x_of, TOP, bottom);
    for x in 0..schedule.sensors() {
        let top = TOP + LANE * x as f64 + 3.0;
        picture.text(format!("{}", x + 1), (16.0, top + 8.0), 14.0);
        for (phase, start) in [(Phase::A, 0.0), (Phase::B, period)] {
            let Some(t_fire) = schedule.t_fire(phase, x) else { continue };
            let fire = start + f64::from(t_fire.as_micros());
            let end = fire + f64::from(requirements.window_of(x).as_micros());
            // A window that lasts beyond the second period goes on in the first.
            for (from, to) in [(fire, end.min(2.0 * period)), (0.0, end - 2.0 * period)] {
                if to > from {
                    picture.rect([(x_of(from), top + 4.0), (x_of(to), top + LANE - 10.0)], LISTENING);
                }
            }
            picture.rect([(x_of(fire) - 1.0, top), (x_of(fire) + 2.0, top + LANE - 6.0)], REJECTED);
        }
    }
    picture
}
