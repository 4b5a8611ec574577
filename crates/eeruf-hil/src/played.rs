//! Edges played on the lines after each trigger instead of the world's: faults that a test describes.

use eeruf_hil::SENSORS;

/// An edge: microseconds after the trigger, true if the line rises, true if the interrupt is lost.
type Played = (u64, bool, bool);

/// The edges of every sensor, and the pin of its line.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PlayedLines {
    edges: [Vec<Played>; SENSORS],
    pins: [u8; SENSORS],
}

impl PlayedLines {
    /// Reads one entry for each sensor, separated by commas: the pin, counted from 0, and edges such as `+450`, which
    /// rises, and `-6280*`, which falls without an interrupt.
    ///
    /// # Errors
    /// The first malformed entry, or a wrong number of entries.
    pub(crate) fn read(text: &str) -> Result<Self, String> {
        let entries: Vec<&str> = text.split(',').collect();
        let entries = <[&str; SENSORS]>::try_from(entries)
            .map_err(|entries| format!("lines of {} sensors; expected {SENSORS}", entries.len()))?;
        let mut lines = Self::default();
        for ((entry, edges), pin) in entries.iter().zip(&mut lines.edges).zip(&mut lines.pins) {
            let mut words = entry.split_whitespace();
            let wrong = || format!("line {entry:?}; expected a pin and edges, such as 2 +450 -6280*");
            *pin = words.next().and_then(|word| word.parse().ok()).ok_or_else(wrong)?;
            *edges = words.map(|word| edge(word).ok_or_else(wrong)).collect::<Result<_, _>>()?;
        }
        let mut pins = lines.pins;
        pins.sort_unstable();
        if pins.iter().zip(0..).all(|(&pin, sensor)| pin == sensor) {
            Ok(lines)
        } else {
            Err(format!("pins {:?}; expected each once", lines.pins))
        }
    }

    /// Returns the pin of this sensor's line.
    pub(crate) fn pin_of(&self, sensor: u8) -> u8 {
        self.pins.get(usize::from(sensor)).copied().unwrap_or(sensor)
    }

    /// Returns the edges after a trigger on the line at a pin.
    pub(crate) fn at_pin(&self, pin: u8) -> &[Played] {
        let edges = self.pins.iter().zip(&self.edges).find(|&(&of, _)| of == pin).map(|(_, edges)| &edges[..]);
        edges.unwrap_or_default()
    }
}

fn edge(word: &str) -> Option<Played> {
    let (word, is_lost) = word.strip_suffix('*').map_or((word, false), |word| (word, true));
    let us = word.strip_prefix(['+', '-'])?.parse().ok()?;
    Some((us, word.starts_with('+'), is_lost))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_pins_and_edges() {
        let lines = PlayedLines::read("0 +450 -6280*,2,1 +9*,3,4,5,6,7").unwrap();
        assert_eq!((lines.pin_of(1), lines.pin_of(2), lines.pin_of(3)), (2, 1, 3));
        assert_eq!(lines.at_pin(0), [(450, true, false), (6_280, false, true)]);
        assert_eq!((lines.at_pin(1), lines.at_pin(2)), (&[(9, true, true)][..], &[][..]));
    }

    #[test]
    fn entry_that_is_otherwise_is_named() {
        for (text, error) in [
            ("0,1", "lines of 2 sensors; expected 8"),
            ("0,1,2,3,4,5,6,6", "pins [0, 1, 2, 3, 4, 5, 6, 6]; expected each once"),
            ("0 450,1,2,3,4,5,6,7", "line \"0 450\"; expected a pin and edges, such as 2 +450 -6280*"),
            ("0,1,,3,4,5,6,7", "line \"\"; expected a pin and edges, such as 2 +450 -6280*"),
        ] {
            assert_eq!(PlayedLines::read(text), Err(error.to_owned()));
        }
    }
}
