//! Two modules of different range whose echo lines share one multiplexer.

use core::convert::Infallible;

use eeruf_core::{
    EachSensor, EchoFilter, Edge, Instant, Layout, Micros, ReadingKind, Requirements, Ring, RingConfig, RingEvent,
    Uneven, VerifiedSchedule, plan::ScheduledFiring, schedule,
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings, SetupError};
use embedded_hal_mock::eh1::delay::NoopDelay;

/// The first sees 5 m, the second 2 m; neither fires while the other listens.
const RING: VerifiedSchedule<2, 2, EachSensor<2>> = schedule! {
    period_us: 60_000,
    t_fire_a_us: [0, 32_000],
    t_fire_b_us: [0, 36_000],
    each_meets: Requirements {
        layout: Layout::Line(1),
        uneven: Some(Uneven {
            window: &[Micros::from_millis(30), Micros::from_millis(13)],
            t_delta: &[Micros::new(1_500), Micros::new(200)],
            refire: &[Micros::from_millis(40), Micros::from_millis(40)],
            shared_lines: &[0b11],
            ..Uneven::NONE
        }),
        ..Requirements::new(Micros::new(99))
    },
};

/// A pin that is low and accepts every call.
struct Pin;

impl embedded_hal::digital::ErrorType for Pin {
    type Error = Infallible;
}

impl embedded_hal::digital::OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl embedded_hal::digital::InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(false)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(true)
    }
}

type Driver =
    HcSr04Ring<Ring<ScheduledFiring<'static, 2, 2, &'static EachSensor<2>>, EchoFilter<2>, 2>, Pin, Pin, NoopDelay, 2>;

fn driver(min_retrigger_ms: u32) -> Result<Driver, SetupError> {
    let mut settings = Settings::default();
    settings.min_retrigger = Micros::from_millis(min_retrigger_ms);
    static SCHEDULE: VerifiedSchedule<2, 2, EachSensor<2>> = RING;
    let ring = Ring::new(&SCHEDULE, RingConfig::new(), Instant::default())?;
    HcSr04Ring::new(ring, [0, 1].map(|_| Pin).map(|trigger| Pins { trigger, echo: Pin }), NoopDelay, settings)
}

/// The kinds of at least 20 readings of each module, with a wall this many microseconds away.
fn readings(echo_us: [u32; 2]) -> [Vec<ReadingKind>; 2] {
    let mut driver = driver(40).unwrap();
    let mut kinds = [vec![], vec![]];
    // The line of the module to which the multiplexer is switched: the last that fired.
    let mut line: Vec<Edge> = Vec::new();
    while kinds[0].len() < 20 || kinds[1].len() < 20 {
        let deadline = driver.next_deadline();
        let edge = line.first().copied().filter(|edge| deadline.has_reached(edge.at));
        let now = edge.map_or(deadline, |edge| edge.at);
        if edge.is_some() {
            driver.edge(line.remove(0)).unwrap();
        }
        while let Some(event) = driver.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let at = |us| now + Micros::new(us);
                    let echo = echo_us[usize::from(sensor)];
                    assert!(line.is_empty(), "the other module still holds the line");
                    line = vec![
                        Edge { sensor, high: true, at: at(450) },
                        Edge { sensor, high: false, at: at(450 + echo) },
                    ];
                }
                RingEvent::Reading(reading) => kinds[usize::from(reading.sensor)].push(reading.kind),
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    kinds
}

#[test]
fn each_module_on_a_shared_line_is_heard_as_far_as_it_sees() {
    use ReadingKind::Accepted;
    let [far, near] = readings([25_000, 12_000]);
    assert!(far[2..].iter().chain(&near[2..]).all(|&kind| kind == Accepted), "{far:?} {near:?}");
    // When the far one still hears, the near one has stopped listening.
    let [far, near] = readings([25_000, 14_000]);
    assert!(far[2..].iter().all(|&kind| kind == Accepted), "{far:?}");
    assert!(near.iter().all(|&kind| kind != Accepted), "{near:?}");
}

// A module that needs longer between triggers than the schedule gives is refused.
#[test]
fn module_slower_than_the_schedule_is_refused() {
    assert!(driver(56).is_ok());
    assert!(matches!(driver(57), Err(SetupError::Retrigger { .. })));
}
