//! Neighbours: pairs of sensors that must not fire shortly after one another (Sec. 3.1, constraint c).

use core::fmt;

use crate::requirements_error::RequirementsError;
use crate::schedule::MAX_SENSORS;

/// The arrangement of the sensors, and the number of adjacent ones that count as neighbours.
///
/// The paper asks that any *four* adjacent sensors fire at least 15 ms apart (Sec. 3.1 c). Sensors are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Layout<'a> {
    /// A row with two ends (the paper's half ring): neighbours differ by less than this number.
    Line(u8),
    /// A closed ring: like a line, but the last sensor stands next to the first.
    Ring(u8),
    /// Groups of this many adjacent sensors; only members of one group are neighbours.
    Blocks(u8),
    /// Any graph: bit `y` of word `x` says that `x` and `y` are neighbours. A pair counts if either word names it;
    /// missing words are empty.
    Graph(&'a [u64]),
}

/// Makes the rows of a [`Layout::Graph`] from pairs of neighbouring sensors, counted from 0.
///
/// # Errors
/// [`RequirementsError`] for the first pair that names one sensor twice, or one out of range: a layout meant for
/// another ring would keep too few sensors apart.
///
/// ```
/// use eeruf_core::{Layout, conditions::neighbour_rows};
/// let rows = neighbour_rows([(0, 1), (1, 2)], 3)?;
/// assert!(Layout::Graph(&rows).neighbours(3, 2, 1));
/// let error = neighbour_rows([(1, 2), (2, 3)], 3).unwrap_err();
/// assert_eq!(error.to_string(), "sensors 3 and 4 as neighbours; expected two different ones of 3");
/// # Ok::<(), eeruf_core::conditions::RequirementsError>(())
/// ```
pub fn neighbour_rows(
    pairs: impl IntoIterator<Item = (usize, usize)>,
    sensors: usize,
) -> Result<[u64; MAX_SENSORS], RequirementsError> {
    let mut rows = [0_u64; MAX_SENSORS];
    let there = rows.get_mut(..sensors).unwrap_or(&mut []);
    for (x, y) in pairs {
        for (one, other) in [(x, y), (y, x)] {
            match there.get_mut(one) {
                Some(row) if one != other && other < sensors => *row |= 1 << other,
                _ => return Err(RequirementsError::Neighbours { pair: (x, y), sensors }),
            }
        }
    }
    Ok(rows)
}

impl Layout<'_> {
    /// Checks that all neighbours that a graph names are among `sensors`.
    ///
    /// # Errors
    /// [`RequirementsError`] for the first sensor out of range.
    pub fn check(&self, sensors: usize) -> Result<(), RequirementsError> {
        let Layout::Graph(rows) = *self else { return Ok(()) };
        for (x, &row) in rows.iter().enumerate() {
            let strange = (0..MAX_SENSORS).find(|&y| row >> y & 1 == 1 && (x >= sensors || y >= sensors));
            if let Some(y) = strange {
                return Err(RequirementsError::Neighbours { pair: (x, y), sensors });
            }
        }
        Ok(())
    }

    /// Returns true if `x` and `y` (from 0) of `sensors` are neighbours; a sensor is not its own neighbour.
    pub const fn neighbours(&self, sensors: usize, x: usize, y: usize) -> bool {
        if x == y || x >= sensors || y >= sensors {
            return false;
        }
        let apart = x.abs_diff(y);
        match *self {
            Layout::Line(n) => apart < n as usize,
            Layout::Ring(n) => apart < n as usize || sensors - apart < n as usize,
            Layout::Blocks(n) => n > 0 && x / n as usize == y / n as usize,
            Layout::Graph(rows) => bit(rows, x, y) || bit(rows, y, x),
        }
    }

    /// The neighbours of each sensor as bit sets; words beyond `sensors` are zero.
    pub const fn rows(&self, sensors: usize) -> [u64; MAX_SENSORS] {
        let mut rows = [0; MAX_SENSORS];
        let mut x = 0;
        while x < MAX_SENSORS {
            let mut y = 0;
            while y < MAX_SENSORS {
                if self.neighbours(sensors, x, y) {
                    rows[x] |= 1 << y;
                }
                y += 1;
            }
            x += 1;
        }
        rows
    }
}

impl fmt::Display for Layout<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(n) => write!(f, "{n} adjacent sensors of a line"),
            Self::Ring(n) => write!(f, "{n} adjacent sensors of a ring"),
            Self::Blocks(n) => write!(f, "sensors of a block of {n}"),
            Self::Graph(_) => f.write_str("the given neighbours"),
        }
    }
}

const fn bit(rows: &[u64], x: usize, y: usize) -> bool {
    x < rows.len() && y < MAX_SENSORS && rows[x] >> y & 1 == 1
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    #[test]
    fn a_line_has_ends_and_a_ring_has_none() {
        assert!(Layout::Line(4).neighbours(12, 0, 3) && !Layout::Line(4).neighbours(12, 0, 4));
        assert!(!Layout::Line(4).neighbours(12, 0, 11));
        assert!(Layout::Ring(4).neighbours(12, 0, 9) && !Layout::Ring(4).neighbours(12, 0, 8));
        assert!(Layout::Blocks(4).neighbours(12, 4, 7) && !Layout::Blocks(4).neighbours(12, 3, 4));
    }

    #[test]
    fn graph_is_symmetric_and_without_loops() {
        let graph = Layout::Graph(&[0b011, 0, 0b001]);
        assert!(!graph.neighbours(3, 0, 0));
        assert!(graph.neighbours(3, 0, 1) && graph.neighbours(3, 1, 0));
        assert!(graph.neighbours(3, 0, 2) && graph.neighbours(3, 2, 0));
        assert!(!graph.neighbours(3, 1, 2) && !graph.neighbours(2, 0, 2));
    }

    #[test]
    fn a_graph_that_names_a_sensor_which_is_not_there_is_refused() {
        assert_eq!(neighbour_rows([(0, 1), (2, 0)], 3).unwrap()[..4], [0b110, 0b001, 0b001, 0]);
        for (pair, sensors) in [((2, 3), 3), ((3, 2), 3), ((1, 1), 3), ((0, 64), 64), ((usize::MAX, 0), 64)] {
            assert_eq!(neighbour_rows([(0, 1), pair], sensors), Err(RequirementsError::Neighbours { pair, sensors }));
        }
        let rows = neighbour_rows([(0, 1), (2, 5)], 6).unwrap();
        assert_eq!(Layout::Graph(&rows).check(6), Ok(()));
        assert_eq!(Layout::Graph(&rows).check(5), Err(RequirementsError::Neighbours { pair: (2, 5), sensors: 5 }));
        assert_eq!(Layout::Ring(9).check(2), Ok(()));
    }

    #[test]
    fn an_error_names_the_pair_and_how_many_sensors_there_are() {
        let error = neighbour_rows([(2, 3)], 3).unwrap_err();
        assert_eq!(std::format!("{error}"), "sensors 3 and 4 as neighbours; expected two different ones of 3");
        assert_eq!(std::format!("{error:#}"), "sensors 2 and 3 as neighbours; expected two different ones of 3");
    }

    #[test]
    fn rows_repeat_the_pairwise_answer() {
        for layout in [Layout::Line(4), Layout::Ring(3), Layout::Blocks(5), Layout::Ring(0)] {
            let rows = layout.rows(13);
            for x in 0..64 {
                for y in 0..64 {
                    assert_eq!(rows[x] >> y & 1 == 1, layout.neighbours(13, x, y), "{layout:?} {x} {y}");
                }
            }
        }
    }
}
