//! A ring of four modules that measure by themselves and take 100 ms each.

use eeruf_core::{Instant, Layout, Micros, Requirements, Ring, RingConfig, ScheduledRing, VerifiedSchedule, schedule};

pub(crate) const K: usize = 4;
/// Start of a run, shortly before the clock wraps.
pub(crate) const BEGIN: Instant = Instant::from_micros(u32::MAX - 700_000);

/// A table from `eeruf design` that leaves each module 115 ms.
static TABLE: VerifiedSchedule<K> = schedule! {
    period_us: 124_000,
    t_fire_a_us: [9_000, 37_000, 68_000, 96_000],
    t_fire_b_us: [0, 37_000, 65_000, 102_000],
    meets: Requirements {
        min_interval: Micros::new(8_000),
        layout: Layout::Line(4),
        window: Micros::new(115_000),
        stale_echo: false,
        ..Requirements::new(Micros::new(1_000))
    },
};

/// The ring, with a window of 33 ms.
pub(crate) fn ring() -> ScheduledRing<'static, K> {
    Ring::new(&TABLE, RingConfig::new().with_window(Micros::from_millis(33)), BEGIN).unwrap()
}
