//! The columns with a row's time and its sensor.

use std::collections::BTreeSet;
use std::path::Path;

use crate::names::{self, Meaning};
use crate::options::TimeUnit;
use crate::sink::Skipped;
use eeruf_files::FileError;

use super::column::{Column, Role};
use super::plan::{Plan, guess};

impl Plan {
    /// Chooses one time column, or two that form one: seconds and nanoseconds, a date and a time of day.
    pub(super) fn time_columns(&mut self, asked: Option<usize>) {
        let times = self.places(Role::Time);
        let is_time = |index: &usize| !self.columns[*index].numbers.is_empty() || self.columns[*index].calendars > 0;
        let usable: Vec<_> = times.iter().copied().filter(is_time).collect();
        let chosen: Vec<usize> = if let Some(asked) = asked {
            vec![asked]
        } else if self.has_prefix {
            vec![]
        } else {
            let stem = |index: usize| {
                let name = self.columns[index].name.to_lowercase();
                name.trim_end_matches(|letter: char| letter != '.' && letter != '_').to_owned()
            };
            let unit = |index: usize| names::time_unit(&self.columns[index].name);
            let pair = usable.iter().find_map(|&one| {
                let other = usable.iter().copied().find(|&other| {
                    let is_calendar = |index: usize| self.columns[index].calendars > 0;
                    let of = |index: usize| self.columns[index].distinct.keys().next().cloned().unwrap_or_default();
                    // The smaller one is a part of a second.
                    let is_part = |unit: TimeUnit| {
                        let below = self.columns[other].numbers.iter().all(|n| n * unit.said().1 < 1e9);
                        unit == TimeUnit::Ns || (below && self.columns[one].numbers.iter().all(|n| n.fract() == 0.0))
                    };
                    let fits = unit(one) == Some(TimeUnit::S)
                        && unit(other).is_some_and(|unit| unit != TimeUnit::S && is_part(unit))
                        && stem(one) == stem(other);
                    let is_date =
                        is_calendar(one) && is_calendar(other) && !of(one).contains(':') && of(other).contains(':');
                    fits || (is_date && one != other)
                })?;
                Some(vec![one, other])
            });
            let clocks = usable.iter().copied().filter(|&index| !self.columns[index].falls_often());
            let best = clocks.max_by_key(|&index| {
                let column = &self.columns[index];
                (column.distinct.len() > 1, names::preference(&column.name), std::cmp::Reverse(index))
            });
            pair.unwrap_or_else(|| best.into_iter().collect())
        };
        for index in times {
            if !chosen.contains(&index) {
                self.columns[index].role = Role::Other;
            }
        }
        self.time = chosen.into_iter().map(|index| (index, TimeUnit::S)).collect();
    }

    /// The column whose texts distinguish rows with the same time, like the tags of series.
    fn tag(&self, lines: &[(u64, &str)]) -> Option<usize> {
        let &(time, _) = self.time.first()?;
        let rows = self.split(lines);
        let of = |index: usize| {
            rows.iter().filter_map(move |row| row.iter().find(|cell| cell.0 == index).map(|cell| &cell.1))
        };
        let times: BTreeSet<_> = of(time).collect();
        if times.len() * 3 > rows.len() * 2 {
            return None;
        }
        let is_tag = |column: &Column| {
            column.role == Role::Other && column.numbers.is_empty() && (2..=64).contains(&column.distinct.len())
        };
        let mut tags = (0..self.columns.len()).filter(|&index| is_tag(&self.columns[index]));
        tags.find(|&index| of(time).zip(of(index)).collect::<BTreeSet<_>>().len() == rows.len())
    }

    pub(super) fn sensor_column(
        &mut self,
        file: &Path,
        asked: Option<usize>,
        asked_ranges: &[usize],
        lines: &[(u64, &str)],
    ) -> Result<(), FileError> {
        let (ranges, named) = (self.places(Role::Range), self.places(Role::Sensor));
        let is_label = |index: &usize| {
            let column = &self.columns[*index];
            let counts = column.numbers.len() > 2 && column.numbers.windows(2).all(|two| two[1] == two[0] + 1.0);
            let is_key = column.name.eq_ignore_ascii_case("id") && (column.texts > 2 || counts);
            let is_key = is_key && column.distinct.values().all(|&count| count == 1);
            let is_whole = column.numbers.iter().all(|number| number.fract() == 0.0);
            is_whole && !is_key && (1..=64).contains(&column.distinct.len())
        };
        let chosen = asked.or_else(|| {
            let rows = |index: usize| self.columns[index].distinct.values().sum::<usize>();
            let repeats = |index: &usize| {
                rows(*index) >= 2 * self.columns[*index].distinct.len().min(rows(*index)) || rows(*index) < 8
            };
            let labels = named.iter().copied().filter(is_label).filter(repeats);
            let most = labels.max_by_key(|&index| self.columns[index].distinct.len());
            let most =
                most.filter(|&index| self.columns[index].distinct.len() > 1).or_else(|| self.tag(lines)).or(most);
            most.filter(|_| ranges.len() == 1)
        });
        if asked.is_some() && ranges.len() != 1 {
            let message = format!("{} columns with ranges; with a column of sensors expected is one", ranges.len());
            return Err(FileError::new(file, message));
        }
        let is_called =
            |&index: &usize| Self::is_called(&self.columns[index]) || self.columns[index].name.starts_with("column ");
        if let Some(&label) =
            named.iter().find(|&&index| self.columns[index].is_label() && self.columns[index].distinct.len() > 1)
            && chosen.is_none()
            && ranges.len() > 1
            && asked_ranges.is_empty()
            && !ranges.iter().any(is_called)
        {
            let names: Vec<_> = ranges.iter().map(|&index| self.columns[index].name.as_str()).collect();
            let message = format!(
                "{} beside `{}`, which names the sensor of a row; expected one of them: --range says which",
                names.join(", "),
                self.columns[label].name
            );
            return Err(FileError::new(file, message));
        }
        let is_alone = ranges.is_empty() && self.places(Role::Empty).is_empty() && asked_ranges.is_empty();
        for index in named {
            if chosen != Some(index) {
                let is_range = is_alone && self.columns[index].is_range();
                self.columns[index].role = if is_range { Role::Range } else { Role::Other };
            }
        }
        self.sensor = chosen;
        if let Some(index) = chosen {
            let column = &self.columns[index];
            let rows: usize = column.distinct.values().sum();
            let is_known = |(_, count): &(&String, &usize)| **count > 1 || rows < 3 * column.distinct.len();
            self.known = column.distinct.iter().filter(is_known).map(|(name, _)| name.clone()).collect();
            let is_of = |name: &String, meaning| names::meaning(name) == meaning;
            if self.known.iter().any(|name| is_of(name, Meaning::Range)) {
                let foreign = self.known.iter().filter(|name| is_of(name, Meaning::Other));
                self.foreign = foreign.cloned().collect();
                self.known.retain(|name| !self.foreign.contains(name));
                self.skipped.extend(self.foreign.iter().map(|name| Skipped::new(name, "no range, by its name")));
            }
        }
        let names: Vec<_> = match chosen {
            Some(_) => self.known.iter().cloned().collect(),
            None => self.ranges().map(|column| column.name.clone()).collect(),
        };
        let by = match chosen {
            Some(index) => format!(", by column `{}`", self.columns[index].name),
            None if names.is_empty() || asked_ranges.len() + usize::from(self.ranges().any(Self::is_called)) > 0 => {
                String::new()
            }
            None => ", which no name and no unit calls ranges".to_owned(),
        };
        self.guesses.push(guess("sensors", format!("{}: {}{by}", names.len(), names.join(", ")), "--range, --sensor"));
        Ok(())
    }
}
