//! A custom judge that accepts what the filter accepts and reports near, unconfirmed echoes as *tentative*, so that a
//! robot slows down early. `cargo run -p eeruf-core --example own_judge`

use std::error::Error;

use eeruf_core::judge::{Heard, Judge, Sounds, Verdict};
use eeruf_core::plan::ScheduledFiring;
use eeruf_core::{EchoFilter, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, tables::PAPER_12};

/// Echo times below this count as near: about one metre.
const NEAR: Micros = Micros::from_millis(6);

/// The filter, with a warning for near echoes that it has not confirmed.
struct Wary(EchoFilter<12>);

impl Judge for Wary {
    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict {
        let verdict = self.0.judge(heard, sounds);
        let is_near = verdict.t_echo.is_some_and(|t_echo| t_echo < NEAR);
        match verdict.kind {
            ReadingKind::First | ReadingKind::Rejected if is_near => {
                Verdict { kind: ReadingKind::Tentative, ..verdict }
            }
            _ => verdict,
        }
    }

    fn t_delta(&self) -> Micros {
        self.0.t_delta()
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        self.0.skip(heard, kind)
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.0.age(sensor)
    }

    fn is_clear(&self, sensor: u8) -> bool {
        self.0.is_clear(sensor)
    }

    fn forget(&mut self, sensor: u8) {
        Judge::forget(&mut self.0, sensor);
    }

    fn restart(&mut self) {
        self.0.restart();
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let start = Instant::from_micros(0);
    let judge = Wary(EchoFilter::new(Micros::new(999), 2)?);
    let plan = ScheduledFiring::verified(&PAPER_12, start);
    let mut ring: Ring<_, _, 12> = Ring::judged_by(plan, judge, RingConfig::new(), start)?;
    let mut firings = 0;
    while firings < 60 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                // After two periods a person steps in front of the first sensor.
                RingEvent::Fire { sensor, .. } => {
                    let near = sensor == 0 && firings >= 24;
                    ring.echo(sensor, now + Micros::from_millis(if near { 4 } else { 12 }))?;
                    firings += 1;
                }
                RingEvent::Reading(reading) if reading.sensor == 0 => {
                    println!("sensor 1: {:?}, {:?}", reading.kind, reading.t_echo);
                }
                _ => {}
            }
        }
    }
    Ok(())
}
