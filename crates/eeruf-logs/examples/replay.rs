//! A log of ranges, judged again: how many of each sensor's readings agree with the one before.
//! `cargo run -p eeruf-logs --example replay -- LOG [T_DELTA_US]`

use std::{error::Error, path::Path};

use eeruf_core::{EchoFilter, Micros};
use eeruf_logs::{Echo, Options, read_log};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let log = arguments.next().ok_or("usage: replay LOG [T_DELTA_US]")?;
    let t_delta = arguments.next().map_or(Ok(500), |text| text.parse())?;
    let mut filter = EchoFilter::<64>::new(Micros::new(t_delta), 2)?;
    let mut accepted = vec![(0_u32, 0_u32); 64];
    let report = read_log(Path::new(&log), &Options::default(), |_, reading| {
        // There and back at 343 m/s.
        let t_echo = match reading.echo() {
            Echo::At(metres) => Some(Micros::new((metres * 2e6 / 343.0) as u32)),
            _ => None,
        };
        let Some((of, all)) = accepted.get_mut(reading.sensor) else { return };
        if let Ok(verdict) = filter.push(reading.sensor as u8, t_echo) {
            *of += u32::from(verdict.kind.as_str() == "accepted");
            *all += 1;
        }
    })?;
    for (name, (of, all)) in report.names().iter().zip(accepted) {
        println!("{name}: {of} of {all} accepted");
    }
    for guess in &report.guesses {
        println!("guessed: {guess:?}");
    }
    Ok(())
}
