//! Selection and concatenation of [`Readings`].

use std::collections::HashMap;

use super::readings::{HeardPath, NO_PATH, Readings};

/// Applies an operation to every column.
macro_rules! each_column {
    ($do:ident!($($given:tt)*)) => {
        $do!($($given)*; robot sensor period phase fired_s x_m y_m heading_rad kind t_echo_us earliest_us reference_us
            cause path emitted_s expected_change_us)
    };
}

impl Readings {
    /// Returns the readings at these places, in this order, with the same duration and number of sensors.
    ///
    /// # Panics
    /// If a place is not below [`len`](Self::len).
    #[must_use]
    pub fn select(&self, places: &[usize]) -> Self {
        let mut some = Self::new(self.method, self.duration_s, self.sensors);
        macro_rules! take {
            ($some:ident; $($column:ident)*) => {
                $($some.$column = places.iter().map(|&place| self.$column[place]).collect();)*
            };
        }
        each_column!(take!(some));
        some.paths = self.paths.clone();
        some.keep_used_paths();
        some
    }

    /// Returns the readings of consecutive parts as one; durations add up. `None` without parts. Method and number of
    /// sensors come from the first part.
    #[must_use]
    pub fn concat(parts: &[&Self]) -> Option<Self> {
        let (first, others) = parts.split_first()?;
        let mut all = (*first).clone();
        let key = |path: &HeardPath| {
            let length = path.length_m.to_bits();
            (path.emitter, path.receiver, length, path.departure_rad.to_bits(), path.bounces.clone())
        };
        let mut known: HashMap<_, u32> = all.paths.iter().map(key).zip(0..).collect();
        for part in others {
            all.duration_s += part.duration_s;
            let begin = all.len();
            macro_rules! append {
                ($all:ident; $($column:ident)*) => { $($all.$column.extend_from_slice(&part.$column);)* };
            }
            each_column!(append!(all));
            let mut numbers = Vec::with_capacity(part.paths.len());
            for path in &part.paths {
                let next = all.paths.len() as u32;
                let number = *known.entry(key(path)).or_insert(next);
                if number == next {
                    all.paths.push(path.clone());
                }
                numbers.push(number);
            }
            for path in &mut all.path[begin..] {
                *path = numbers.get(*path as usize).copied().unwrap_or(NO_PATH);
            }
        }
        Some(all)
    }

    /// Drops the paths that no reading used.
    fn keep_used_paths(&mut self) {
        let mut numbers = vec![NO_PATH; self.paths.len()];
        for path in self.path.iter().filter(|&&path| path != NO_PATH) {
            numbers[*path as usize] = 0;
        }
        for (used, number) in (0..).zip(numbers.iter_mut().filter(|number| **number == 0)) {
            *number = used;
        }
        for path in self.path.iter_mut().filter(|path| **path != NO_PATH) {
            *path = numbers[*path as usize];
        }
        let mut numbers = numbers.iter();
        self.paths.retain(|_| numbers.next() != Some(&NO_PATH));
    }
}
