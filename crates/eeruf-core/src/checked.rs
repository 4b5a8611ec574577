//! [`schedule!`](crate::schedule!): schedules that the compiler verifies.

use crate::own_limits::EachSensor;
use crate::requirements::Requirements;
use crate::schedule::{Schedule, ScheduleError};
use crate::time::Micros;
use crate::verified::VerifiedSchedule;
use crate::verify::{Violation, ViolationKind};

/// Makes a [`VerifiedSchedule`] at compile time: a table that violates a condition does not compile.
///
/// Times are whole microseconds. Give the table as lags and waits or as firing times, and the [`Requirements`] to check
/// as `meets`; `eeruf design --period-only --emit rust` writes the whole call.
///
/// ```
/// use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};
///
/// const FRONT: VerifiedSchedule<4> = schedule! {
///     period_us: 60_000,
///     t_fire_a_us: [0, 15_000, 30_000, 45_000],
///     t_fire_b_us: [0, 17_000, 34_000, 51_000],
///     meets: Requirements { min_interval: Micros::from_millis(9), ..Requirements::new(Micros::new(999)) },
/// };
/// assert_eq!(FRONT.sensors(), 4);
/// ```
///
/// The same table does not compile if `meets` requires 15 ms between neighbours, since sensor 4 in phase b and sensor 1
/// in phase a fire 9 ms apart:
///
/// ```compile_fail
/// use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};
///
/// const FRONT: VerifiedSchedule<4> = schedule! {
///     period_us: 60_000,
///     t_fire_a_us: [0, 15_000, 30_000, 45_000],
///     t_fire_b_us: [0, 17_000, 34_000, 51_000],
///     meets: Requirements { min_interval: Micros::from_millis(15), ..Requirements::new(Micros::new(999)) },
/// };
/// # assert_eq!(FRONT.sensors(), 4);
/// ```
///
/// If sensors differ, `each_meets` keeps the limits that each one was verified for:
///
/// ```
/// use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};
///
/// const CORNER: VerifiedSchedule<2, 2, EachSensor<2>> = schedule! {
///     period_us: 60_000,
///     t_fire_a_us: [0, 20_000],
///     t_fire_b_us: [0, 23_000],
///     each_meets: Requirements {
///         layout: Layout::Line(2),
///         min_interval: Micros::from_millis(15),
///         uneven: Some(Uneven {
///             window: &[Micros::from_millis(50), Micros::from_millis(12)],
///             t_delta: &[Micros::new(999), Micros::new(1_400)],
///             ..Uneven::NONE
///         }),
///         ..Requirements::new(Micros::new(999))
///     },
/// };
/// assert_eq!(CORNER.limits_of(1).map(|limits| limits.window), Some(Micros::from_millis(12)));
/// ```
#[macro_export]
macro_rules! schedule {
    (
        period_us: $period:expr,
        t_lag_us: $t_lag:expr,
        t_wait_a_us: $t_wait_a:expr,
        t_wait_b_us: $t_wait_b:expr,
        meets: $requirements:expr $(,)?
    ) => {
        const {
            let waits = [$crate::__micros($t_wait_a), $crate::__micros($t_wait_b)];
            let schedule = $crate::Schedule::new($crate::Micros::new($period), $crate::__micros($t_lag), waits);
            $crate::__checked(schedule, &$requirements)
        }
    };
    (period_us: $period:expr, t_fire_a_us: $a:expr, t_fire_b_us: $b:expr, meets: $requirements:expr $(,)?) => {
        const { $crate::__checked($crate::__fired($period, $a, $b), &$requirements) }
    };
    (period_us: $period:expr, t_fire_a_us: $a:expr, t_fire_b_us: $b:expr, each_meets: $requirements:expr $(,)?) => {
        const { $crate::__checked_each($crate::__fired($period, $a, $b), &$requirements) }
    };
}

/// Implementation of `schedule!` with firing times.
#[doc(hidden)]
pub const fn __fired<const K: usize>(period_us: u32, a: [u32; K], b: [u32; K]) -> Result<Schedule<K>, ScheduleError> {
    Schedule::from_firing(Micros::new(period_us), [__micros(a), __micros(b)])
}

/// Implementation of `schedule!` with `each_meets`.
#[doc(hidden)]
pub const fn __checked_each<const K: usize>(
    schedule: Result<Schedule<K>, ScheduleError>,
    requirements: &Requirements<'_>,
) -> VerifiedSchedule<K, 2, EachSensor<K>> {
    let schedule = *__checked(schedule, requirements).schedule();
    match schedule.verified_each(requirements) {
        Ok(verified) => verified,
        // Unreachable: the schedule has just been verified.
        Err(_) => panic!("a schedule that does not meet its requirements"),
    }
}

/// Implementation of `schedule!`, evaluated when the program is compiled: its panics are compile errors.
#[doc(hidden)]
pub const fn __checked<const K: usize>(
    schedule: Result<Schedule<K>, ScheduleError>,
    requirements: &Requirements<'_>,
) -> VerifiedSchedule<K> {
    match schedule {
        Ok(schedule) => match schedule.verified(requirements) {
            Ok(verified) => verified,
            Err(violation) => refuse(violation),
        },
        Err(error) => panic!("{}", error.as_str()),
    }
}

/// Panics with the violated condition: a compile error.
const fn refuse(violation: Violation) -> ! {
    match violation.kind {
        ViolationKind::CrosstalkA => panic!("two sensors' crosstalk would be accepted, Eq. (13a)"),
        ViolationKind::CrosstalkB => panic!("two sensors' crosstalk would be accepted, Eq. (13b)"),
        ViolationKind::StaleEcho => panic!("a sensor's stale echo would be accepted, Eq. (13b) with x = y"),
        ViolationKind::Interval => panic!("two neighbours fire closer together than min_interval, Sec. 3.1 c"),
        ViolationKind::Window => panic!("a sensor fires again while it still listens, T_wind"),
        ViolationKind::SharedLine => panic!("a sensor fires while another one listens on the same echo line"),
        ViolationKind::Refire => panic!("a sensor is triggered again sooner than it may be"),
        ViolationKind::Together => panic!("two sensors that must fire together do not"),
    }
}

/// Converts whole microseconds in an expansion of `schedule!`.
#[doc(hidden)]
pub const fn __micros<const K: usize>(us: [u32; K]) -> [Micros; K] {
    let mut times = [Micros::ZERO; K];
    let mut i = 0;
    while i < K {
        times[i] = Micros::new(us[i]);
        i += 1;
    }
    times
}
