//! Table I of the paper: twelve sensors in a half ring, `T_p` = 100 ms.
//!
//! The lags of Table I-a put groups of four neighbours 25 ms apart. All waits are 24 ms in phase a; in phase b they are
//! 0, 2, .., 22 ms in some order, which makes the separation 2 ms (`T_delta` just below 1 ms). The order decides how
//! close together neighbours fire: in the plain order of Tables I-b and I-c, sensors 4 and 1 come within 1 ms; Table
//! I-d keeps 19 ms within the groups 1-4, 5-8 and 9-12, and 17 ms within any four adjacent sensors. Exactly one of the
//! 12! orders keeps 19 ms there too: [`THE_ONE_WITH_19_MS`].

use crate::requirements::Requirements;
use crate::schedule::{Schedule, ScheduleError};
use crate::time::Micros;
use crate::verified::VerifiedSchedule;

const PERIOD: Micros = Micros::from_millis(100);
const T_LAG: [u32; 12] = [0, 25, 50, 75, 0, 25, 50, 75, 0, 25, 50, 75];

const fn ms(times: [u32; 12]) -> [Micros; 12] {
    let mut micros = [Micros::ZERO; 12];
    let mut i = 0;
    while i < 12 {
        micros[i] = Micros::from_millis(times[i]);
        i += 1;
    }
    micros
}

const fn table<const M: usize>(schedule: Result<Schedule<12, M>, ScheduleError>) -> Schedule<12, M> {
    match schedule {
        Ok(schedule) => schedule,
        // Only ever evaluated when this crate is compiled.
        Err(error) => panic!("{}", error.as_str()),
    }
}

/// Table I-a: the lags alone, as in conventional firing. Nothing alternates, so crosstalk repeats exactly.
pub const TABLE_I_A: Schedule<12> = table(Schedule::new(PERIOD, ms(T_LAG), [ms([0; 12]); 2]));

/// Table I-b: waits in plain order. Separation 2 ms, but sensors 4 and 1 fire 1 ms apart.
pub const TABLE_I_B: Schedule<12> =
    table(Schedule::new(PERIOD, ms(T_LAG), [ms([24; 12]), ms([0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22])]));

/// Table I-c: the firing times that follow from Table I-b.
pub const TABLE_I_C: Schedule<12> = table(Schedule::from_firing(
    PERIOD,
    [ms([24, 49, 74, 99, 24, 49, 74, 99, 24, 49, 74, 99]), ms([0, 27, 54, 81, 8, 35, 62, 89, 16, 43, 70, 97])],
));

/// Table I-d: the same waits rearranged. Keeps 19 ms within the groups 1-4, 5-8, 9-12, as the paper says, but only 17
/// ms within any four adjacent sensors (sensors 2 and 5 in phase b).
pub const TABLE_I_D: Schedule<12> =
    table(Schedule::new(PERIOD, ms(T_LAG), [ms([24; 12]), ms([18, 12, 6, 0, 20, 14, 8, 2, 22, 16, 10, 4])]));

/// The only one of 479,001,600 rearrangements of the paper's waits in which any four adjacent sensors fire at least 19
/// ms apart.
pub const THE_ONE_WITH_19_MS: Schedule<12> =
    table(Schedule::new(PERIOD, ms(T_LAG), [ms([24; 12]), ms([22, 16, 10, 4, 20, 14, 8, 2, 18, 12, 6, 0])]));

/// Table I-d, verified for [`Ring::new`](crate::Ring::new): `t_delta` 999 us and window 76 ms, the largest that it
/// allows, with any four adjacent sensors 17 ms apart.
pub const PAPER_12: VerifiedSchedule<12> = {
    let requirements = Requirements { min_interval: Micros::from_millis(17), ..Requirements::new(Micros::new(999)) };
    match TABLE_I_D.verified(&requirements) {
        Ok(verified) => verified,
        // Only ever evaluated when this crate is compiled.
        Err(_) => panic!("Table I-d does not keep what the paper says"),
    }
};
