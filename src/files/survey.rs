//! A simulated survey: its log, as firmware would write it, and the true paths.

use eeruf_core::{
    Instant, Micros,
    survey::{Survey, SurveyEvent, SurveyPlan},
};
use eeruf_logs::{Firing, FiringLog, KeepGoing};
use eeruf_sim::{LockStep, PathsError, World};

use super::firings::CLOCK;

/// A path loud enough to be heard, or one that would be heard if it were 6 dB louder.
pub(crate) struct TruePath {
    pub(crate) sender: u8,
    pub(crate) receiver: u8,
    pub(crate) travel_us: f64,
    /// Level above the threshold of hearing; negative below it.
    pub(crate) level_db: f64,
}

/// Surveys the first robot of a world, until `keep_going` returns `false`.
pub(crate) fn simulate(world: &World, plan: SurveyPlan, keep_going: KeepGoing<'_>) -> Result<FiringLog, PathsError> {
    const BLOCK: u64 = 1 << 30;
    let mut outside = LockStep::new(world)?;
    let mut survey = Survey::new(plan, Instant::from_micros(0));
    let (mut now_us, mut firings, mut fired_us) = (0_u64, Vec::new(), [0_u64; 256]);
    while let Some(due) = survey.next_deadline().filter(|_| keep_going()) {
        // Deadlines are less than 2^30 us ahead.
        let ahead = due.since(Instant::from_wide(now_us)).as_micros();
        now_us += if u64::from(ahead) < BLOCK { ahead.into() } else { 0 };
        while let Some(event) = survey.poll(Instant::from_wide(now_us)) {
            match event {
                SurveyEvent::Fire { sensor } => {
                    outside.fire(sensor.into(), now_us * 1000)?;
                    fired_us[usize::from(sensor)] = now_us;
                }
                // The edges heard cannot change any more: the window is over.
                SurveyEvent::Row { sensor, slot, .. } => {
                    let fired = fired_us[usize::from(sensor)];
                    let heard = outside.hears_at_ns(sensor.into()).map(|at| Micros::new((at / 1000 - fired) as u32));
                    firings.push(Firing {
                        sensor,
                        fired_us: fired as i64,
                        period: slot,
                        phase: 0,
                        t_echo_us: heard.filter(|&heard| heard < plan.window()).map(Micros::as_micros),
                        reading: None,
                        g_us_ms: None,
                    });
                }
            }
        }
    }
    Ok(FiringLog::new(CLOCK, firings))
}

/// The paths between the sensors of the first robot, each sensor's own echoes included.
pub(crate) fn true_paths(world: &World) -> Result<Vec<TruePath>, PathsError> {
    let Some(robot) = world.robots().first() else { return Ok(vec![]) };
    let air = world.scene().air();
    let matrix = world.ring_paths_above(0, world.max_order(), 0.5)?;
    let c = air.speed_of_sound();
    let path = |path: &eeruf_sim::CriticalPath| TruePath {
        sender: path.emitter as u8,
        receiver: path.receiver as u8,
        travel_us: 1e6 * path.length_m / c,
        level_db: robot.transducer_of(path.receiver as usize).level_db(path.amplitude, path.length_m, air),
    };
    Ok(matrix.paths().iter().map(path).collect())
}
