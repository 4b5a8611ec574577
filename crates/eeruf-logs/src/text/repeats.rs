//! Columns that repeat a range: in another unit, filtered, or as the voltage from which it was computed.

use super::column::{Column, Role};
use super::plan::{Plan, guess};
use super::shape::{self, Shape};
use crate::names;
use crate::options::{Options, RangeUnit};
use crate::value::{self, Value};

/// Speeds of sound by which sketches divide, in m/s.
const SPEEDS: (f64, f64) = (325.0, 360.0);
/// Ratios of units of length, for columns whose name and cells do not give the unit.
const RATIOS: [f64; 8] = [10.0, 100.0, 1000.0, 2.54, 25.4, 39.37, 30.48, 12.0];
/// Number of columns above which they are not sensors with copies.
const MOST: usize = 64;

/// A row, and its number, or `None` for no echo.
type Cell = (usize, Option<f64>);

/// A column's numbers in its rows, with its resolution.
struct Series {
    /// Cells of the column; rows without the column have none.
    cells: Vec<Cell>,
    resolution: f64,
    unit: Option<RangeUnit>,
    distinct: usize,
}

impl Plan {
    /// Omits columns that repeat another.
    pub(super) fn repetitions(&mut self, lines: &[(u64, &str)], options: &Options) {
        let found = self.places(Role::Range);
        let is_asked = !options.table.ranges.is_empty() || !options.table.columns.is_empty();
        if is_asked || !(1..=MOST).contains(&found.len()) {
            return;
        }
        let mut said = vec![];
        let rows = self.split(lines);
        for &index in &found {
            if let Some((kept, left)) = self.twice(index, &rows) {
                said.push(format!(
                    "each {} of `{}` is its {} again",
                    left.name(),
                    self.columns[index].name,
                    kept.name()
                ));
                self.columns[index].repeated_unit = Some(left);
                self.columns[index].has_unit_in_cells = Some(kept);
            }
        }
        self.further_echoes(&found, &rows, &mut said);
        // By their names.
        for &index in &found {
            let name = &self.columns[index].name;
            let stem = names::stem(name);
            let beside = |is_one: &dyn Fn(&str) -> bool| {
                let others = found.iter().filter(|&&other| other != index).map(|&other| &self.columns[other].name);
                others.filter(|other| is_one(other)).any(|other| names::stem(other) == stem)
            };
            let is_extreme = names::extreme(name).is_some_and(|(stem, is_least)| {
                found.iter().any(|&other| match names::extreme(&self.columns[other].name) {
                    Some((of, is_better)) => of == stem && is_better && !is_least,
                    None => names::stem(&self.columns[other].name) == stem,
                })
            });
            let is_pin = names::is_analogue_pin(name)
                && found.iter().any(|&other| !names::is_analogue_pin(&self.columns[other].name));
            let why = if is_pin {
                "an analogue converter's"
            } else if names::is_filtered(name) && beside(&|other| !names::is_filtered(other)) {
                "what a filter made of another column"
            } else if is_extreme {
                "the least or the greatest of readings beside it"
            } else {
                continue;
            };
            said.push(format!("`{name}` is {why}"));
            self.columns[index].role = Role::Other;
        }
        // By their values.
        let found: Vec<_> =
            self.places(Role::Range).into_iter().map(|index| (index, self.series(index, &rows))).collect();
        for (n, (one, series)) in found.iter().enumerate() {
            for (other, repeated) in &found[n + 1..] {
                let both = [*one, *other].map(|index| &self.columns[index]);
                if both.iter().any(|column| column.role != Role::Range) || !series.is_repeated_by(repeated, both) {
                    continue;
                }
                let (kept, left) = if repeated.is_better_than(series) { (*other, *one) } else { (*one, *other) };
                said.push(format!("`{}` repeats `{}`", self.columns[left].name, self.columns[kept].name));
                self.columns[left].role = Role::Other;
            }
        }
        if !said.is_empty() {
            self.guesses.push(guess("no sensors", said.join(", "), "--range, --columns"));
        }
    }

    /// Omits the further echoes of each firing: `Value`, `Value1`, `Value2`, .., each later than the one before in all
    /// rows, with none after the last.
    fn further_echoes(&mut self, found: &[usize], rows: &[Vec<(usize, String)>], said: &mut Vec<String>) {
        let name = |index: usize| self.columns[index].name.as_str();
        let stem = |index: usize| name(index).trim_end_matches(|letter: char| letter.is_ascii_digit());
        let mut left = vec![];
        for &first in found.iter().filter(|&&index| stem(index) == name(index)) {
            let of: Vec<_> =
                found.iter().copied().filter(|&index| index != first && stem(index) == name(first)).collect();
            let echo = |row: &[(usize, String)], index: usize| {
                let text = &row.iter().find(|cell| cell.0 == index)?.1;
                value::number(text, self.decimal_comma).filter(|&number| number > 0.0)
            };
            let rises = |row: &Vec<(usize, String)>| {
                let echoes: Vec<_> = [first].iter().chain(&of).map(|&index| echo(row, index)).collect();
                echoes.windows(2).all(|two| match two {
                    [Some(one), Some(other)] => one < other,
                    [None, Some(_)] => false,
                    _ => true,
                })
            };
            if of.len() > 1 && rows.len() > 2 && rows.iter().all(rises) {
                let [one, last] = [of[0], of[of.len() - 1]].map(name);
                said.push(format!("`{one}` to `{last}` are further echoes of `{}`", name(first)));
                left.extend(of);
            }
        }
        self.leave_out(left);
    }

    /// The units to keep and to drop for a column whose cells alternately repeat each range in two units.
    fn twice(&self, index: usize, rows: &[Vec<(usize, String)>]) -> Option<(RangeUnit, RangeUnit)> {
        let cells = rows.iter().flatten().filter(|cell| cell.0 == index);
        let cells = cells.filter_map(|(_, text)| match value::range(text, self.decimal_comma)? {
            (Value::Number(number), Some(unit)) => Some((number, unit)),
            _ => None,
        });
        let cells: Vec<_> = cells.collect();
        let [(_, first), (_, second), ..] = cells[..] else { return None };
        let is_again = |pair: &[(f64, RangeUnit)]| match pair {
            [(a, of_a), (b, of_b)] => {
                let (one, two) = (of_a.metres(SPEEDS.0), of_b.metres(SPEEDS.0));
                (*of_a, *of_b) == (first, second) && (a * one - b * two).abs() <= 1.01 * (one + two) + 0.05 * a * one
            }
            _ => true,
        };
        let odd = cells.chunks(2).filter(|pair| !is_again(pair)).count();
        let is_twice = first != second && cells.len() >= 4 && odd * 40 <= cells.len();
        let is_metric = |unit: RangeUnit| !matches!(unit, RangeUnit::In | RangeUnit::Ft);
        is_twice.then_some(if is_metric(first) || !is_metric(second) { (first, second) } else { (second, first) })
    }

    /// The cells of each row by column.
    pub(super) fn split(&self, lines: &[(u64, &str)]) -> Vec<Vec<(usize, String)>> {
        let index = |name: &String| self.columns.iter().position(|column| column.name == *name);
        let named = |pairs: Vec<(String, String)>| {
            pairs.into_iter().filter_map(|(name, text)| Some((index(&name)?, text))).collect()
        };
        let row = |&(number, text): &(u64, &str)| -> Option<Vec<(usize, String)>> {
            match self.shape {
                Shape::Json => shape::object(text).map(named),
                Shape::Keyed => shape::keyed(text).map(named),
                Shape::Separated(separator) => shape::separated(text, separator)
                    .filter(|row| row.len() == self.columns.len() && number >= self.rows_from)
                    .map(|row| row.into_iter().enumerate().collect()),
            }
        };
        lines.iter().filter_map(row).collect()
    }

    fn series(&self, index: usize, rows: &[Vec<(usize, String)>]) -> Series {
        let column = &self.columns[index];
        let (mut cells, mut decimals) = (vec![], 0);
        for (n, row) in rows.iter().enumerate() {
            let Some((_, text)) = row.iter().find(|cell| cell.0 == index) else { continue };
            let number = match value::range(text, self.decimal_comma) {
                Some((Value::Number(number), _)) => Some(number).filter(|&number| number > 0.0),
                _ => None,
            };
            if number.is_some() {
                let fraction = text.split_once(['.', ',']).map_or("", |(_, fraction)| fraction);
                decimals = decimals.max(fraction.bytes().take_while(u8::is_ascii_digit).count());
            }
            cells.push((n, number));
        }
        let name = names::range_unit(&column.name).filter(|(_, is_sure)| *is_sure).map(|(unit, _)| unit);
        let mut numbers: Vec<_> = cells.iter().filter_map(|cell| cell.1).map(f64::to_bits).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let resolution = 10f64.powi(-i32::try_from(decimals.min(15)).unwrap_or(0));
        Series { cells, resolution, unit: column.has_unit_in_cells.or(name), distinct: numbers.len() }
    }
}

impl Series {
    /// Pairs of numbers of the same rows, or consecutive ones if no row has both; `None` if only one of the two has an
    /// echo.
    fn pairs(&self, other: &Self) -> Vec<Option<(f64, f64)>> {
        let (one, two) = (&self.cells, &other.cells);
        let shares = one.iter().filter(|cell| two.binary_search_by_key(&cell.0, |other| other.0).is_ok()).count();
        if shares * 10 < one.len() * 9 && shares > 0 || one.len().abs_diff(two.len()) > 1 {
            return vec![None];
        }
        let pair = |(a, b): (&Cell, &Cell)| match (a.1, b.1) {
            (Some(a), Some(b)) => Some(Some((a, b))),
            // Nearer than the coarser unit can show.
            (None, Some(near)) if near < 3.0 * other.resolution => None,
            (Some(near), None) if near < 3.0 * self.resolution => None,
            (None, None) => None,
            _ => Some(None),
        };
        one.iter().zip(two).filter_map(pair).collect()
    }

    /// Returns true if the other column is this one in another unit, or its copy.
    fn is_repeated_by(&self, other: &Self, columns: [&Column; 2]) -> bool {
        let pairs = self.pairs(other);
        let distinct = self.distinct.min(other.distinct);
        let differ = pairs.iter().filter(|pair| pair.is_none_or(|(a, b)| a != b)).count();
        if self.unit == other.unit && differ * 100 <= pairs.len() {
            // Two sensors that face one wall may agree for a while.
            let [one, other] = columns.map(|column| names::stem(&column.name));
            return (one == other && pairs.len() >= 4 && distinct >= 3) || (pairs.len() >= 20 && distinct >= 8);
        }
        if let (Some(one), Some(two)) = (self.unit, other.unit) {
            let of = |speed: f64| two.metres(speed) / one.metres(speed);
            return one != two && distinct >= 2 && self.holds(other, &pairs, of(SPEEDS.0), of(SPEEDS.1)).is_some();
        }
        // Where nothing says the units, the ratio must be well known, and the numbers precise enough to show it.
        let of_echoes = |unit: RangeUnit| {
            let of = |speed: f64| unit.metres(speed) / RangeUnit::Us.metres(speed);
            (of(SPEEDS.0), of(SPEEDS.1))
        };
        let echoes = [RangeUnit::Cm, RangeUnit::Mm, RangeUnit::In].map(of_echoes);
        let mut ratios = RATIOS.iter().map(|&ratio| (ratio, ratio)).chain(echoes);
        let is_precise = |low: f64, high: f64| self.holds(other, &pairs, low, high).is_some_and(|width| width < 1.05);
        pairs.len() >= 3
            && distinct >= 3
            && ratios.any(|(low, high)| is_precise(low, high) || is_precise(1.0 / low, 1.0 / high))
    }

    /// The width of the interval that holds the ratios of at least 95 % of the pairs; `None` if there is none. Numbers
    /// may be rounded or cut.
    fn holds(&self, other: &Self, pairs: &[Option<(f64, f64)>], one: f64, two: f64) -> Option<f64> {
        let (low, high) = (one.min(two), one.max(two));
        let (mut fit, mut least, mut most) = (0, 0.0f64, f64::INFINITY);
        for (a, b) in pairs.iter().flatten() {
            let below = (a - self.resolution) / (b + other.resolution);
            let above = (a + self.resolution) / (b - other.resolution).max(1e-12);
            if below <= high && low <= above {
                (fit, least, most) = (fit + 1, least.max(below), most.min(above));
            }
        }
        (fit > 1 && fit * 20 >= pairs.len() * 19 && least > 0.0).then_some(most / least)
    }

    /// Returns true if this column is metric and the other is not, or if it is finer in the same measure.
    fn is_better_than(&self, other: &Self) -> bool {
        let is_metric = |series: &Self| !matches!(series.unit, Some(RangeUnit::In | RangeUnit::Ft));
        let share = |series: &Self| {
            let median = series.cells.iter().filter_map(|cell| cell.1).fold(0.0, f64::max);
            series.resolution / median
        };
        match (is_metric(self), is_metric(other)) {
            (true, false) => true,
            (false, true) => false,
            _ => share(self) * 1.5 < share(other),
        }
    }
}
