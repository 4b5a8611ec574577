//! The firing methods that are compared, and the schedules that each of them fires by.

use core::fmt;
use core::str::FromStr;

use eeruf_core::{MAX_SENSORS, Micros, Phase, Schedule, ScheduleError};
use serde::{Serialize, Serializer};

use crate::robot::Robot;

/// A way to fire a ring and to decide what to believe.
///
/// The first five and [`Median`](Self::Median) come from practice, the others are the paper's and what follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Method {
    /// All sensors at once, once a period. Every echo is believed.
    Simultaneous,
    /// One by one, each listening for the whole window before the next one fires. Every echo is believed.
    Sequential,
    /// As sequential, but sensors as far apart as the ring's `neighbours` fire together. Every echo is believed.
    FarGroups,
    /// The conventional lags plus a wait drawn anew for each sensor in each period, from as wide a range as the paper's waits
    /// span. Consecutive readings are compared.
    Dither,
    /// Constant lags (Table I-a): neighbours fire `T_p / n` apart, every period alike. Every echo is believed.
    Conventional,
    /// As conventional, but consecutive readings are compared: the negative control, the filter without alternation.
    Comparison,
    /// As conventional, but the median of a sensor's last readings is believed.
    Median,
    /// Immediate refiring with alternating waits (Figs. 2a, 2b): those of the paper's table, each longer by the robot's
    /// `min_refire`. Consecutive readings are compared.
    EerufImmediate,
    /// Scheduled firing (Fig. 3) by the robot's own schedule, or else by the paper's table at the robot's period (see
    /// [`table_i_d_for`]). Consecutive readings are compared.
    Eeruf,
    /// As [`Eeruf`](Self::Eeruf), by the best schedule that is known for the ring: what the caller puts in
    /// [`Options::best`](crate::Options::best).
    EerufBest,
    /// As [`Eeruf`](Self::Eeruf), moving along a ladder of scaled schedules as the rejection rate asks for (end of Sec. 3.1).
    Adaptive,
    /// As [`Eeruf`](Self::Eeruf), with sensors that report up to eight echoes of a firing: the earliest that repeats is
    /// believed.
    MultiEcho,
}

impl Method {
    /// Every method, in the order in which tables list them.
    pub const ALL: [Self; 12] = [
        Self::Simultaneous,
        Self::Sequential,
        Self::FarGroups,
        Self::Dither,
        Self::Conventional,
        Self::Comparison,
        Self::Median,
        Self::EerufImmediate,
        Self::Eeruf,
        Self::EerufBest,
        Self::Adaptive,
        Self::MultiEcho,
    ];

    /// Its name in files, in `--json` and in Python.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Simultaneous => "simultaneous",
            Self::Sequential => "sequential",
            Self::FarGroups => "far_groups",
            Self::Dither => "dither",
            Self::Conventional => "conventional",
            Self::Comparison => "comparison",
            Self::Median => "median",
            Self::EerufImmediate => "eeruf_immediate",
            Self::Eeruf => "eeruf",
            Self::EerufBest => "eeruf_best",
            Self::Adaptive => "adaptive",
            Self::MultiEcho => "multi_echo",
        }
    }

    /// What decides which reading is believed.
    pub(crate) const fn belief(self) -> Belief {
        match self {
            Self::Simultaneous | Self::Sequential | Self::FarGroups | Self::Conventional => Belief::All,
            Self::Median => Belief::Median,
            _ => Belief::Repeated,
        }
    }
}

/// Which readings a method believes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Belief {
    /// Every one.
    All,
    /// The median of the last few.
    Median,
    /// What the ring's own filter accepts.
    Repeated,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl FromStr for Method {
    type Err = UnknownMethod;

    /// ```
    /// use eeruf_sim::Method;
    /// assert_eq!("far_groups".parse(), Ok(Method::FarGroups));
    /// assert!("eruf".parse::<Method>().unwrap_err().to_string().starts_with("no method `eruf`; expected simultaneous, "));
    /// ```
    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Self::ALL.into_iter().find(|method| method.as_str() == name).ok_or_else(|| UnknownMethod(name.to_owned()))
    }
}

/// A name that no method has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownMethod(pub String);

impl fmt::Display for UnknownMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Method::ALL.map(Method::as_str).join(", ");
        write!(f, "no method `{}`; expected {names}", self.0)
    }
}

impl core::error::Error for UnknownMethod {}

/// A schedule whose number of sensors is known only at run time.
pub type AnySchedule = Schedule<MAX_SENSORS>;

/// The paper's Table I-d at another period, continued for more sensors or another number `n` of neighbours:
///
/// ```text
/// T_lag = (i mod n) T_p / n                                      T_wait,a = W = 0.96 T_p / n
/// T_wait,b = D (L (n - 1 - i mod n) + floor(i / n))              D = W / (L n),  L = max(3, ceil(K / n))
/// ```
///
/// For up to twelve sensors and four neighbours these are the table's own waits, sensors 1 to K, times `T_p / 100 ms`; the
/// separation is `D`, 2 % of the period. More sensors share the same range of waits, so `D` shrinks.
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
    // D times a whole number, rounded once.
    let wait_b = |i: usize| {
        let steps = (rows * (n - 1 - i % n) + i / n) as u64;
        Micros::new((steps * u64::from(widest.as_micros()) / (rows * n) as u64) as u32)
    };
    let waits: Vec<_> = (0..sensors).map(wait_b).collect();
    AnySchedule::from_slices(period, &lags(sensors, period, neighbours), [&vec![widest; sensors], &waits])
}

/// The widest range of waits that leaves every firing in its period: 24 ms of 100 ms with four neighbours.
fn widest_wait(period: Micros, neighbours: u8) -> Micros {
    Micros::new((u64::from(period.as_micros()) * 96 / (100 * u64::from(neighbours.max(1)))) as u32)
}

/// `T_lag = (i mod n) T_p / n` (Table I-a).
fn lags(sensors: usize, period: Micros, neighbours: u8) -> Vec<Micros> {
    let n = u64::from(neighbours.max(1));
    let lag = |i: usize| Micros::new((u64::from(period.as_micros()) * (i as u64 % n) / n) as u32);
    (0..sensors).map(lag).collect()
}

/// The same lags in both phases.
fn constant(period: Micros, lags: &[Micros]) -> Result<AnySchedule, ScheduleError> {
    let none = vec![Micros::ZERO; lags.len()];
    AnySchedule::from_slices(period, lags, [&none, &none])
}

/// The paper's waits for immediate refiring, each longer by the shortest refire time. Holding a sensor back until that time
/// has passed would do as well for the transducer, but wherever it does so every wait is as good as any other, and nothing
/// alternates.
fn refiring(sensors: usize, period: Micros, neighbours: u8, soonest: Micros) -> Result<AnySchedule, ScheduleError> {
    let table = table_i_d_for(sensors, period, neighbours)?;
    let longer = |phase| table.t_wait(phase).iter().map(|wait| wait.saturating_add(soonest)).collect::<Vec<_>>();
    AnySchedule::from_slices(period.saturating_add(soonest), table.t_lag(), [&longer(Phase::A), &longer(Phase::B)])
}

/// The schedule that a robot's ring starts with under a method; for dither the lags alone.
pub(crate) fn schedule_for(
    method: Method,
    robot: &Robot,
    best: Option<&AnySchedule>,
) -> Result<AnySchedule, ScheduleError> {
    let (sensors, period, n) = (robot.sensors.len(), robot.period, robot.neighbours);
    let in_turn = |turns: usize| {
        // A window that ends just when the next one begins still counts an echo at its very end.
        let turn = robot.window.saturating_add(Micros::new(1)).as_micros();
        let times: Vec<_> = (0..sensors).map(|i| Micros::new(turn.saturating_mul((i % turns) as u32))).collect();
        constant(Micros::new(turn.saturating_mul(turns as u32)), &times)
    };
    match method {
        Method::EerufImmediate => refiring(sensors, period, n, robot.min_refire),
        Method::Simultaneous => constant(period, &vec![Micros::ZERO; sensors]),
        Method::Sequential => in_turn(sensors),
        Method::FarGroups => in_turn(sensors.min(usize::from(n))),
        Method::Dither | Method::Conventional | Method::Comparison | Method::Median => {
            constant(period, &lags(sensors, period, n))
        }
        Method::EerufBest if best.is_some_and(|best| best.sensors() == sensors) => match best {
            Some(best) => Ok(*best),
            None => table_i_d_for(sensors, period, n),
        },
        _ => match &robot.schedule {
            Some(schedule) => Ok(*schedule),
            None => table_i_d_for(sensors, period, n),
        },
    }
}

/// How far dither moves a firing at most: as far as the paper's waits do, but never so far that a sensor would fire again
/// while it listens.
pub(crate) fn widest_dither(robot: &Robot) -> Micros {
    widest_wait(robot.period, robot.neighbours).min(robot.period.saturating_sub(robot.window))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::{Criterion, Requirements, tables::TABLE_I_D};

    #[test]
    fn the_table_continues_to_any_number_of_sensors_with_all_pairs_apart() {
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

    #[test]
    fn set_one_fires_by_the_first_eight_rows_of_table_i_d_times_six_tenths() {
        let schedule = table_i_d_for(8, Micros::from_millis(60), 4).unwrap();
        let table = TABLE_I_D.scaled(3, 5).unwrap();
        for phase in [Phase::A, Phase::B] {
            assert_eq!(schedule.t_wait(phase), &table.t_wait(phase)[..8]);
        }
        assert_eq!(schedule.t_lag(), &table.t_lag()[..8]);
        assert!(schedule.verify(&Requirements::new(Micros::new(500))).ok());
    }
}
