//! Runs the crate of `eeruf design --program rust` with each module before a wall of its own: number of readings after
//! the first of each, of accepted ones, and of wrong ones.

use std::{array, convert::Infallible};

use NAME::eeruf_core::{Edge, Instant, Micros, ReadingKind, RingEvent};
use NAME::{EDGES, SENSORS, sonar};
use eeruf_hc_sr04::Pins;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

struct Line;

impl ErrorType for Line {
    type Error = Infallible;
}

impl OutputPin for Line {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl InputPin for Line {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(false)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(true)
    }
}

struct Wait;

impl DelayNs for Wait {
    fn delay_ns(&mut self, _: u32) {}
}

const fn wall_us(sensor: u8) -> u32 {
    2000 + sensor as u32 * 618 % 1000 * 20
}

#[test]
fn walls() {
    let mut now = Instant::from_micros(u32::MAX - 1_000_000);
    let (end, mut edges) = (now + Micros::from_millis(20_000), Vec::<Edge>::new());
    let mut ring = sonar(array::from_fn(|_| Pins { trigger: Line, echo: Line }), Wait, 7, now).unwrap();
    ring.moving(0, 0, now);
    let (mut begun, mut readings, mut accepted, mut wrong) = ([false; SENSORS], 0, 0, 0);
    while !now.has_reached(end) {
        now += Micros::new(200);
        edges.sort_by_key(|edge| end.since(edge.at));
        while edges.last().is_some_and(|edge| now.has_reached(edge.at)) {
            EDGES.push(edges.pop().unwrap());
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let rises = now + Micros::new(450);
                    edges.push(Edge { sensor, at: rises, high: true });
                    edges.push(Edge { sensor, at: rises + Micros::new(wall_us(sensor)), high: false });
                }
                RingEvent::Reading(reading) if std::mem::replace(&mut begun[usize::from(reading.sensor)], true) => {
                    readings += 1;
                    accepted += u32::from(reading.kind == ReadingKind::Accepted);
                    let right = reading.t_echo == Some(Micros::new(wall_us(reading.sensor)));
                    wrong += u32::from(reading.kind == ReadingKind::Accepted && !right);
                }
                _ => {}
            }
        }
    }
    println!("\n{readings} {accepted} {wrong}");
}
