//! The log of `ESPHome`: each measurement once, from the sensor's own line or from its state.
//!
//! ```text
//! [14:49:46][D][ultrasonic.sensor:040]: 'Front' - Got distance: 1.52 m
//! [14:49:46][D][sensor:126]: 'Front': Sending state 1.52258 m with 2 decimals of accuracy
//! [14:49:56][D][ultrasonic.sensor:065]: 'Front' - Measurement start timed out after 60012us
//! ```

use std::collections::HashSet;

use super::lines::Rewritten;
use crate::value;

#[derive(Default)]
pub(super) struct EspHome {
    /// Sensors whose measurements are in the log, so that their states are repetitions.
    measured: HashSet<String>,
    /// True after a timeout in a version that does not name the sensor; its state follows.
    has_timed_out: bool,
}

const STATE: &str = "': Sending state ";
const DISTANCE: &str = "' - Got distance: ";

impl EspHome {
    pub(super) fn is_in(start: &str) -> bool {
        let is_of_sensor = |line: &str| {
            split(line)
                .is_some_and(|(_, said)| said.starts_with('\'') && (said.contains(STATE) || said.contains(DISTANCE)))
        };
        start.lines().any(is_of_sensor)
    }

    /// A pair of name and range after the line's time; nothing for a line that repeats another line's reading.
    pub(super) fn rewrite(&mut self, line: &str) -> Rewritten {
        use Rewritten::{Lines, Misfit, Nothing};
        let may_be_cut =
            ["Got distance", "Sending state", "Distance measurement"].iter().any(|part| line.contains(part));
        let Some((before, said)) = split(line) else {
            // Lines of ESPHome's program on the computer.
            let is_other = ["INFO ", "WARNING ", "ERROR "].iter().any(|level| line.trim_start().starts_with(level));
            let has_digit = line.contains(|letter: char| letter.is_ascii_digit());
            return if may_be_cut || (has_digit && !is_other) { Misfit } else { Nothing };
        };
        let other = if may_be_cut { Misfit } else { Nothing };
        let pair = |name: &str, own: &str| {
            let name: String = name.chars().map(|letter| if ":=".contains(letter) { ' ' } else { letter }).collect();
            Lines(vec![format!("{before}{}: {own}", name.chars().take(40).collect::<String>())])
        };
        if let Some((name, rest)) = said.strip_prefix('\'').and_then(|rest| rest.split_once("' - ")) {
            let lower = rest.to_lowercase();
            if lower.contains("timed out") || lower.contains("timeout") {
                self.measured.insert(name.to_owned());
                return pair(name, "nan");
            }
            let range = rest.strip_prefix("Got distance: ");
            let range = range.map(|range| range.split_once(" (echo").map_or(range, |(range, _)| range));
            if let Some(range) = range.filter(|range| is_length(range)) {
                self.measured.insert(name.to_owned());
                return pair(name, range);
            }
            return other;
        }
        if said.starts_with("Distance measurement timed out") {
            self.has_timed_out = true;
            return Nothing;
        }
        let state = said.strip_prefix('\'').and_then(|rest| rest.split_once(STATE));
        let state = state.and_then(|(name, rest)| Some((name, rest.strip_suffix(" decimals of accuracy")?)));
        let state = state.and_then(|(name, rest)| Some((name, rest.rsplit_once(" with ")?)));
        let state = state.filter(|(_, (_, decimals))| decimals.parse::<u8>().is_ok());
        let Some((name, (own, _))) = state else { return other };
        let (number, unit) = own.split_once(' ').unwrap_or((own, ""));
        let is_nan = number.eq_ignore_ascii_case("nan");
        if !is_nan && value::number(number, false).is_none() {
            return Misfit;
        }
        if value::unit(unit).is_none() {
            return Nothing;
        }
        let is_timeout = is_nan && std::mem::take(&mut self.has_timed_out);
        if !is_timeout && self.measured.contains(name) {
            return Nothing;
        }
        pair(name, if is_nan { "nan" } else { own })
    }
}

fn is_length(text: &str) -> bool {
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    value::number(number, false).is_some() && value::unit(unit).is_some()
}

/// The text before a line's level and tag, and the message after them.
fn split(line: &str) -> Option<(&str, &str)> {
    let is_level = |inner: &str| matches!(inner.as_bytes(), [b'E' | b'W' | b'I' | b'C' | b'D' | b'V']) || inner == "VV";
    let (at, _) = line
        .match_indices('[')
        .find(|(at, _)| line[at + 1..].split_once("][").is_some_and(|(inner, _)| is_level(inner)))?;
    let (_, rest) = line[at..].split_once("][")?;
    let (tag, said) = rest.split_once("]: ").or_else(|| Some((rest.strip_suffix("]:")?, "")))?;
    let (tag, number) = tag.split_once("][").map_or(tag, |(tag, _)| tag).rsplit_once(':')?;
    let is_tag = !tag.is_empty() && !tag.contains(' ') && number.parse::<u32>().is_ok();
    is_tag.then_some((&line[..at], said.trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damaged_reading_is_a_misfit() {
        let mut log = EspHome::default();
        for line in [
            "[D][ultrasonic.sensor:040]: 'Front' - Got distance: 1.5",
            "[D][ultrasonic.sensor:040]: 'Front' - Got distance: 1.x2 m",
            "[D][ultrasonic.sensor:0x0]: 'Front' - Got distance: 1.52 m",
            "[D][sensor:126]: 'Front': Sending state 1.52 m with 2 decimals",
            "[D][sensor:126]: 'Front': Sending state 1.5x m with 2 decimals of accuracy",
            "1.52 m",
        ] {
            assert_eq!(log.rewrite(line), Rewritten::Misfit, "{line}");
        }
        for line in [
            "INFO Reading configuration 7.yaml",
            "[C][wifi:443]:   IP: 192.168.1.7",
            "[C][wifi:443]:",
            "[D][sensor:126]: 'WiFi': Sending state -64.00000 dBm with 0 decimals of accuracy",
            "[V][sensor:083][loopTask]: 'Front': Received new state 1.483475",
        ] {
            assert_eq!(log.rewrite(line), Rewritten::Nothing, "{line}");
        }
    }
}
