//! The schedules of the firing methods, made for a robot's ring.

use eeruf_core::{Micros, Phase, ScheduleError};

use crate::world::{AnySchedule, Robot};

/// Makes a schedule that fires all sensors at once.
pub(super) fn together(robot: &Robot, _: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
    constant(robot.period, &vec![Micros::ZERO; robot.sensors.len()])
}

/// Makes a schedule that fires one sensor after the other, each when the sound of the previous one has faded.
pub(super) fn one_by_one(robot: &Robot, _: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
    in_turns(robot, robot.sensors.len())
}

/// Makes a schedule that fires sensors far apart together, group after group.
pub(super) fn far_groups(robot: &Robot, _: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
    in_turns(robot, robot.sensors.len().min(usize::from(robot.neighbours)))
}

/// Makes a schedule of the conventional lags, every period alike (Table I-a).
pub(super) fn conventional(robot: &Robot, _: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
    let Robot { ref sensors, period, neighbours, .. } = *robot;
    constant(period, &lags(sensors.len(), period, neighbours))
}

/// Returns the robot's own schedule, or else the paper's table at its period.
pub(super) fn own(robot: &Robot, _: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
    let Robot { ref sensors, period, neighbours, schedule, .. } = *robot;
    schedule.map_or_else(|| table_i_d_for(sensors.len(), period, neighbours), Ok)
}

/// Returns the best known schedule, if it has the ring's number of sensors.
pub(super) fn best(robot: &Robot, best: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
    match best {
        Some(best) if best.sensors() == robot.sensors.len() => Ok(*best),
        _ => own(robot, None),
    }
}

/// Makes a schedule of the paper's waits for immediate refiring, each longer by the shortest refire time. Delaying a
/// sensor just until that time has passed would make waits equal, so that nothing alternates.
pub(super) fn refiring(robot: &Robot, _: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
    let Robot { ref sensors, period, neighbours, min_refire, .. } = *robot;
    let table = table_i_d_for(sensors.len(), period, neighbours)?;
    let longer = |phase| table.t_wait(phase).iter().map(|wait| wait.saturating_add(min_refire)).collect::<Vec<_>>();
    AnySchedule::from_slices(period.saturating_add(min_refire), table.t_lag(), [&longer(Phase::A), &longer(Phase::B)])
}

/// Returns the shortest time between two firings of a sensor under a schedule.
pub(super) fn soonest_refire(schedule: &AnySchedule, sensor: usize) -> Micros {
    let after = [Phase::A, Phase::B].map(|phase| schedule.refire_after(phase, sensor));
    after.into_iter().flatten().min().unwrap_or(schedule.min_refire())
}

/// Makes a schedule in which sensors take turns. A turn lasts as long as they listen or, if their modules are known, as
/// long as they hear; a round lasts at least as long as the modules rest.
fn in_turns(robot: &Robot, turns: usize) -> Result<AnySchedule, ScheduleError> {
    // A window that ends just when the next one begins still counts an echo at its very end.
    let turn = robot.window.max(robot.audible).saturating_add(Micros::new(1)).as_micros();
    let sensors = 0..robot.sensors.len();
    let times: Vec<_> = sensors.map(|i| Micros::new(turn.saturating_mul((i % turns) as u32))).collect();
    let round = Micros::new(turn.saturating_mul(turns as u32));
    let rest = if robot.audible == Micros::ZERO { Micros::ZERO } else { robot.module_rest() };
    constant(round.max(rest), &times)
}

/// Makes a schedule with the same lags in both phases.
fn constant(period: Micros, lags: &[Micros]) -> Result<AnySchedule, ScheduleError> {
    let none = vec![Micros::ZERO; lags.len()];
    AnySchedule::from_slices(period, lags, [&none, &none])
}

/// Returns the paper's Table I-d at another period, continued for more sensors or another number `n` of neighbours:
///
/// ```text
/// T_lag = (i mod n) T_p / n                                      T_wait,a = W = 0.96 T_p / n
/// T_wait,b = D (L (n - 1 - i mod n) + floor(i / n))              D = W / (L n),  L = max(3, ceil(K / n))
/// ```
///
/// For up to twelve sensors and four neighbours these are the table's own waits of sensors 1 to K, times
/// `T_p / 100 ms`; the separation `D` is 2 % of the period. More sensors share the same range of waits, so `D` shrinks.
///
/// # Errors
/// [`ScheduleError`] for no sensors, more than 64, or no period.
///
/// ```
/// use eeruf_core::{Micros, Phase, tables::TABLE_I_D};
/// let schedule = eeruf_sim::table_i_d_for(12, Micros::from_millis(100), 4)?;
/// for phase in [Phase::A, Phase::B] {
///     assert_eq!(schedule.t_wait(phase), TABLE_I_D.t_wait(phase));
/// }
/// # Ok::<(), eeruf_core::ScheduleError>(())
/// ```
pub fn table_i_d_for(sensors: usize, period: Micros, neighbours: u8) -> Result<AnySchedule, ScheduleError> {
    let n = usize::from(neighbours.max(1));
    let rows = sensors.div_ceil(n).max(3);
    let widest = widest_wait(period, neighbours);
    // A whole multiple of `D`, rounded once.
    let wait_b = |i: usize| {
        let steps = (rows * (n - 1 - i % n) + i / n) as u64;
        Micros::new((steps * u64::from(widest.as_micros()) / (rows * n) as u64) as u32)
    };
    let waits: Vec<_> = (0..sensors).map(wait_b).collect();
    AnySchedule::from_slices(period, &lags(sensors, period, neighbours), [&vec![widest; sensors], &waits])
}

/// Returns the widest range of waits that leaves every firing in its period: 24 ms of 100 ms with four neighbours.
fn widest_wait(period: Micros, neighbours: u8) -> Micros {
    Micros::new((u64::from(period.as_micros()) * 96 / (100 * u64::from(neighbours.max(1)))) as u32)
}

/// `T_lag = (i mod n) T_p / n` (Table I-a).
fn lags(sensors: usize, period: Micros, neighbours: u8) -> Vec<Micros> {
    let n = u64::from(neighbours.max(1));
    let lag = |i: usize| Micros::new((u64::from(period.as_micros()) * (i as u64 % n) / n) as u32);
    (0..sensors).map(lag).collect()
}

/// Returns the largest shift of a firing by dither: as large as the paper's waits, but small enough that no sensor
/// fires again while it listens.
pub(super) fn widest_dither(robot: &Robot) -> Micros {
    widest_wait(robot.period, robot.neighbours).min(robot.period.saturating_sub(robot.window))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::{Criterion, Requirements, tables::TABLE_I_D};

    // The table continues to any number of sensors, and all pairs stay apart.
    #[test]
    fn table_continues_to_any_number_of_sensors() {
        for (sensors, n) in [(1, 4), (8, 4), (12, 4), (24, 4), (64, 4), (16, 8), (5, 1), (9, 2)] {
            let schedule = table_i_d_for(sensors, Micros::from_millis(100), n).unwrap();
            let Some(separation) = schedule.separation(Criterion::Exact) else {
                assert_eq!(sensors, 1);
                continue;
            };
            let rows = sensors.div_ceil(usize::from(n)).max(3) as u32;
            let step = 96_000 / u32::from(n) / (rows * u32::from(n));
            assert!(separation.value.as_micros() >= step, "{sensors} {n}: {}", separation.value);
        }
    }

    // Set I fires by the first eight rows of Table I-d, times 0.6.
    #[test]
    fn set_one_fires_by_scaled_table_i_d() {
        let schedule = table_i_d_for(8, Micros::from_millis(60), 4).unwrap();
        let table = TABLE_I_D.scaled(3, 5).unwrap();
        for phase in [Phase::A, Phase::B] {
            assert_eq!(schedule.t_wait(phase), &table.t_wait(phase)[..8]);
        }
        assert_eq!(schedule.t_lag(), &table.t_lag()[..8]);
        assert!(schedule.verify(&Requirements::new(Micros::new(500))).ok());
    }
}
