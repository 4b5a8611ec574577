//! The timing diagram of a schedule of many phases: how each sensor's firing moves from period to period.

use eeruf_core::{Micros, Phase, Requirements};
use eeruf_design::PhaseSchedule;

use super::picture::Picture;
use super::style::{LISTENING, REJECTED, TITLE};

/// One lane for each sensor, and in it one line for each phase, the first on top: when it fires, and how long it
/// listens.
pub(crate) fn hopping_diagram(schedule: &PhaseSchedule, requirements: &Requirements<'_>) -> Picture {
    const LINE: f64 = 4.0;
    const LEFT: f64 = 48.0;
    const TOP: f64 = 46.0;
    const WIDTH: f64 = 900.0;
    let us = |time: Micros| f64::from(time.as_micros());
    let (sensors, phases) = (schedule.sensors(), schedule.phases());
    let period = us(schedule.period());
    let x_of = |us: f64| LEFT + (us / period * WIDTH).round();
    let lane = LINE * phases as f64 + 8.0;
    let bottom = TOP + lane * sensors as f64;
    let mut picture = Picture::new(LEFT + WIDTH + 24.0, bottom + 50.0);
    let title = format!("{sensors} sensors, {phases} phases, T_p = {}: firing and listening", schedule.period());
    picture.text(title, (LEFT, 19.0), TITLE);
    picture.time_grid(period, x_of, TOP, bottom);
    for sensor in 0..sensors {
        let top = TOP + lane * sensor as f64 + 4.0;
        picture.text(format!("{}", sensor + 1), (16.0, top + lane / 2.0 - 8.0), 14.0);
        for phase in 0..phases {
            let at = top + LINE * phase as f64;
            let t_fire = |phase| schedule.t_fire(Phase(phase as u8), sensor).map(us);
            let window = us(requirements.window_of(sensor));
            let line = |from: f64, to: f64| [(x_of(from), at), (x_of(to), at + LINE - 1.0)];
            let Some(fire) = t_fire(phase) else { continue };
            let end = fire + window;
            picture.rect(line(fire, end.min(period)), LISTENING);
            if phase > 0 {
                // What the period before leaves over is heard in this one.
                let before = t_fire(phase - 1).unwrap_or(0.0) + window - period;
                if before > 0.0 {
                    picture.rect(line(0.0, before), LISTENING);
                }
            }
            picture.rect([(x_of(fire) - 1.0, at), (x_of(fire) + 2.0, at + LINE - 1.0)], REJECTED);
        }
    }
    picture
}
