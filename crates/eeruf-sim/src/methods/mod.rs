//! The firing methods that are compared: one table of them, their schedules, and core's ring behind each. It uses
//! `world` for the robots that fire.
//!
//! To add a method, add a row to the table below. A new way of firing is a `Way` of `ring_runner` in a file of its own,
//! named in the row: `Gap = "gap" in gap { firing: gap::WAY, }`. Help, Python's types, the page and the tests take the
//! names from here.

mod adaptive;
mod best_schedule;
mod dither;
mod firing;
mod flow;
mod judges;
mod method;
mod ring_runner;
mod schedules;
mod sketch;

pub use best_schedule::{TICK, best_schedule_for, requirements_of, shortest_schedule_for};
pub use firing::{FiringMethod, FiringPeriod, OwnError};
pub use flow::FlowOptions;
pub(crate) use judges::{Judging, MAX_MEDIAN};
pub(crate) use method::MAX_ECHOES;
pub use method::UnknownMethod;
pub(crate) use ring_runner::{ChangeError, FiringPlan, RingRunner, RingStart, StartError, planned};
pub use schedules::table_i_d_for;

use judges::JudgeKind::{self, Agreement, AsSketched, Belief, EveryEcho, TwoOfThree};
use method::{DEFAULT, MethodRow, methods};
use ring_runner::Way;

methods! {
    /// All sensors at once, once a period. Every echo is believed.
    Simultaneous = "simultaneous" { firing: Way::by_table(schedules::together), judge: EveryEcho, }
    /// One by one, each sensor listening for the whole window before the next one fires. Every echo is believed.
    Sequential = "sequential" { firing: Way::by_table(schedules::one_by_one), judge: EveryEcho, }
    /// Like sequential, but an echo is believed if one of the sensor's two previous readings agrees with it: two of
    /// three votes.
    SequentialVotes = "sequential_votes" { firing: Way::by_table(schedules::one_by_one), judge: TwoOfThree, }
    /// Like sequential, but the median of a sensor's last three readings is believed.
    SequentialMedian = "sequential_median" {
        firing: Way::by_table(schedules::one_by_one), judge: JudgeKind::Median,
    }
    /// Like sequential, but sensors as far apart as the ring's `neighbours` fire together. Every echo is believed.
    FarGroups = "far_groups" { firing: Way::by_table(schedules::far_groups), judge: EveryEcho, }
    /// The conventional lags plus a wait redrawn for each sensor in each period, from as wide a range as the paper's
    /// waits span. Consecutive readings are compared.
    Dither = "dither" { firing: dither::WAY, judge: Agreement, }
    /// Constant lags (Table I-a): neighbours fire `T_p / n` apart, every period alike. Every echo is believed.
    Conventional = "conventional" { firing: Way::by_table(schedules::conventional), judge: EveryEcho, }
    /// Like conventional, but consecutive readings are compared: the negative control, the filter without alternation.
    Comparison = "comparison" { firing: Way::by_table(schedules::conventional), judge: Agreement, }
    /// Like conventional, but the median of a sensor's last readings is believed.
    Median = "median" { firing: Way::by_table(schedules::conventional), judge: JudgeKind::Median, }
    /// Immediate refiring with alternating waits (Figs. 2a, 2b): those of the paper's table, each longer by the robot's
    /// `min_refire`. Consecutive readings are compared.
    EerufImmediate = "eeruf_immediate" { firing: Way::IMMEDIATE, }
    /// Scheduled firing (Fig. 3) by the robot's own schedule, or else by the paper's table at the robot's period (see
    /// [`table_i_d_for`]). Consecutive readings are compared.
    Eeruf = "eeruf" { }
    /// Like [`eeruf`](Self::Eeruf), by the best schedule that is known for the ring. The caller puts it in
    /// [`Options::best`](crate::Options::best).
    EerufBest = "eeruf_best" { firing: Way::by_table(schedules::best), }
    /// Like [`eeruf`](Self::Eeruf), moving along a ladder of scaled schedules as the rejection rate asks for (end of
    /// Sec. 3.1).
    Adaptive = "adaptive" { adapts: true, }
    /// Flow: one sensor after the other, with as much quiet around each firing as it has needed, and a random time in
    /// every gap; an echo is believed if it fits the belief, or if two readings agree and nothing foreign explains both
    /// ([`InTurn`](eeruf_core::flow::InTurn), [`Belief`](eeruf_core::flow::Belief)).
    Flow = "flow" { firing: flow::WAY, judge: Belief, }
    /// Like [`eeruf`](Self::Eeruf), with sensors that report up to eight echoes of a firing: the earliest that repeats
    /// is believed.
    MultiEcho = "multi_echo" { echoes: MAX_ECHOES, }
    /// Like [`adaptive`](Self::Adaptive), with sensors that report up to eight echoes of a firing.
    AdaptiveMultiEcho = "adaptive_multi_echo" { echoes: MAX_ECHOES, adapts: true, on_demand: true, }
    /// Like [`flow`](Self::Flow), with sensors that report up to eight echoes of a firing.
    FlowMultiEcho = "flow_multi_echo" { firing: flow::WAY, judge: Belief, echoes: MAX_ECHOES, on_demand: true, }
    /// One by one, each as soon as the previous one has answered or timed out, like the loop of a sketch or a ping
    /// timer; see [`Sketch`](crate::Sketch). Every echo is believed unless the sketch says otherwise.
    InTurn = "in_turn" { firing: sketch::way(sketch::in_turn), judge: AsSketched, }
    /// Arrays side by side, each like [`in_turn`](Self::InTurn).
    Arrays = "arrays" { firing: sketch::way(sketch::arrays), judge: AsSketched, }
    /// Like [`in_turn`](Self::InTurn), with groups of sensors that fire together.
    Groups = "groups" { firing: sketch::way(sketch::groups), judge: AsSketched, }
    /// Modules that share a trigger: all at once, again when the slowest has answered and rested.
    SyncLine = "sync_line" { firing: sketch::way(sketch::sync_line), judge: AsSketched, }
    /// Modules that fire themselves, each by a clock of its own.
    FreeRunning = "free_running" { firing: sketch::way(sketch::free_running), judge: AsSketched, }
    /// One by one in a blocking loop: fire, wait for the echo or for 38 ms, pause for 10 ms, go on to the next. Every
    /// echo is believed.
    Blocking = "blocking" { firing: sketch::way(sketch::blocking), judge: EveryEcho, on_demand: true, }
    /// By a table of any number of phases, the robot's own schedule unless the sketch has one.
    Table = "table" { firing: sketch::TABLE, judge: AsSketched, }
}
