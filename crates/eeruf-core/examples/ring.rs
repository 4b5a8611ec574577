//! A ring of four sensors, each facing its own wall, in a main loop like that of firmware: poll, trigger, report edges,
//! sleep until the next deadline. `cargo run -p eeruf-core --example ring`

use std::error::Error;

use eeruf_core::{
    Instant, Layout, Micros, ReadingKind, Requirements, Ring, RingConfig, RingEvent, SpeedOfSound, VerifiedSchedule,
    schedule, watch::SensorWatch,
};

/// Checked at compile time. `eeruf design RING.toml --period-only --emit rust` writes such a table.
static FRONT: VerifiedSchedule<4> = schedule! {
    period_us: 60_000,
    t_fire_a_us: [0, 15_000, 30_000, 45_000],
    t_fire_b_us: [0, 17_000, 34_000, 51_000],
    meets: Requirements {
        layout: Layout::Line(4),
        min_interval: Micros::from_millis(9),
        window: Micros::from_millis(36),
        ..Requirements::new(Micros::new(999))
    },
};

/// Distance of each wall, in millimetres; the last sensor sees nothing.
const WALLS_MM: [Option<u32>; 4] = [Some(800), Some(1_200), Some(2_500), None];

fn main() -> Result<(), Box<dyn Error>> {
    let sound = SpeedOfSound::at_celsius_tenths(200);
    let start = Instant::from_micros(0);
    let mut ring = Ring::new(&FRONT, RingConfig::new(), start)?;
    let mut watch = SensorWatch::<4>::new(16, start);
    for _ in 0..60 {
        let now = ring.next_deadline(); // firmware sleeps until then
        while let Some(event) = ring.poll(now) {
            if let Some(blind) = watch.observe(&event, now) {
                println!("sensor {} is blind", blind + 1);
            }
            match event {
                // Firmware pulses the trigger line; the interrupt of the echo line calls `echo` at its edge.
                RingEvent::Fire { sensor, .. } => {
                    if let Some(wall) = WALLS_MM[usize::from(sensor)] {
                        ring.echo(sensor, now + sound.echo_time(wall))?;
                    }
                }
                RingEvent::Reading(reading) if reading.kind == ReadingKind::Accepted => {
                    let distance = reading.t_echo.map(|t_echo| sound.distance_mm(t_echo));
                    println!("{:7.1} ms  sensor {}: {distance:?} mm", ms(now), reading.sensor + 1);
                }
                _ => {}
            }
        }
    }
    for sensor in 0..4 {
        println!("sensor {}: {:?}", sensor + 1, watch.state(sensor, ring.next_deadline()));
    }
    Ok(())
}

fn ms(now: Instant) -> f64 {
    f64::from(now.as_micros()) / 1e3
}
