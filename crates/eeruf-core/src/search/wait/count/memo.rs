//! A hash table, in lent memory, of the remainders that were already counted. It may forget entries but never confuses
//! them.

use crate::schedule::MAX_SENSORS;

/// Words of the longest key: the level, three masks and two for each sensor touched, each mask in two words.
const KEY_WORDS: usize = 1 + 2 * (3 + 2 * MAX_SENSORS);
/// Words of an entry besides its key: a serial number (0 when counted) and the count.
const ENTRY_WORDS: usize = 1 + 4;
/// Number of entries tried for a key.
const PROBES: usize = 4;
/// Number of entries used at first.
const FIRST_ENTRIES: usize = 512;
/// Factor by which the number of entries grows when they are half full.
const GROWTH: usize = 8;

/// A remainder as words.
pub(super) struct Key {
    words: [u32; KEY_WORDS],
    len: usize,
    wide: bool,
    hash: u64,
}

impl Key {
    /// An empty key; masks above 32 bits are `wide`.
    pub(super) const fn new(wide: bool) -> Self {
        Self { words: [0; KEY_WORDS], len: 0, wide, hash: 0 }
    }

    /// Starts the key of a level; the level is part of it.
    pub(super) fn start(&mut self, level: usize) {
        (self.len, self.hash) = (0, 0);
        // Not zero, which marks an empty entry.
        self.push_word(level as u32 + 1);
    }

    pub(super) fn push(&mut self, mask: u64) {
        self.push_word(mask as u32);
        if self.wide {
            self.push_word((mask >> 32) as u32);
        }
    }

    fn push_word(&mut self, word: u32) {
        if let Some(place) = self.words.get_mut(self.len) {
            *place = word;
            self.len += 1;
        }
        self.hash = (self.hash ^ u64::from(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.hash ^= self.hash >> 32;
    }
}

/// The place for the count of a key, valid until another key takes it.
#[derive(Clone, Copy)]
pub(super) struct Ticket {
    entry: usize,
    serial: u32,
}

/// The table: entries of `words` words, empty when the first is zero.
pub(super) struct Memo<'m> {
    slots: &'m mut [u32],
    words: usize,
    /// Number of entries that fit, and number in use.
    entries: usize,
    active: usize,
    /// Entries written since the part in use was cleared.
    written: usize,
    serial: u32,
}

impl<'m> Memo<'m> {
    /// A table for keys of the level and at most `masks` words.
    pub(super) fn new(slots: &'m mut [u32], masks: usize) -> Self {
        let words = 1 + masks + ENTRY_WORDS;
        let entries = slots.len() / words;
        let mut memo = Self { slots, words, entries, active: 0, written: 0, serial: 0 };
        memo.use_first(FIRST_ENTRIES);
        memo
    }

    /// Clears and uses the first `active` entries, so that a short count need not clear all the lent memory. Growing
    /// forgets entries, but happens rarely enough to cost little.
    fn use_first(&mut self, active: usize) {
        self.active = active.min(self.entries);
        self.written = 0;
        if let Some(slots) = self.slots.get_mut(..self.active * self.words) {
            slots.fill(0);
        }
    }

    pub(super) const fn is_useful(&self) -> bool {
        self.entries > 0
    }

    /// The stored count of a key, or the place for it.
    pub(super) fn look_up(&mut self, key: &Key) -> Result<u128, Ticket> {
        if self.written > self.active / 2 && self.active < self.entries {
            self.use_first(self.active.saturating_mul(GROWTH));
        }
        let home = ((u128::from(key.hash) * self.active as u128) >> 64) as usize;
        let mut place = home;
        for probe in 0..PROBES.min(self.active) {
            let entry = (home + probe) % self.active;
            let Some(words) = self.slots.get(entry * self.words..(entry + 1) * self.words) else {
                break;
            };
            let (own, rest) = words.split_at(key.len.min(words.len() - ENTRY_WORDS));
            if let (true, Some(&[0, w0, w1, w2, w3])) = (same(own, &key.words), rest.last_chunk()) {
                return Ok(u128::from(w0) | u128::from(w1) << 32 | u128::from(w2) << 64 | u128::from(w3) << 96);
            }
            if own.first() == Some(&0) {
                place = entry;
                break;
            }
        }
        self.serial = self.serial.wrapping_add(1).max(1);
        self.written += 1;
        let range = place * self.words..(place + 1) * self.words;
        if let Some(words) = self.slots.get_mut(range) {
            let (own, rest) = words.split_at_mut(words.len() - ENTRY_WORDS);
            for (own, &word) in own.iter_mut().zip(&key.words).take(key.len) {
                *own = word;
            }
            if let Some(serial) = rest.first_mut() {
                *serial = self.serial;
            }
        }
        Err(Ticket { entry: place, serial: self.serial })
    }

    /// Stores a count at the place of its ticket.
    pub(super) fn keep(&mut self, ticket: Ticket, count: u128) {
        let end = (ticket.entry + 1) * self.words;
        let Some([serial, w0, w1, w2, w3]) = self.slots.get_mut(end - ENTRY_WORDS..end) else {
            return;
        };
        if *serial == ticket.serial {
            *serial = 0;
            (*w0, *w1, *w2, *w3) = (count as u32, (count >> 32) as u32, (count >> 64) as u32, (count >> 96) as u32);
        }
    }
}

/// Returns true if an entry has the words of a key: a dozen or so, too few to be worth a call.
#[inline]
fn same(own: &[u32], key: &[u32; KEY_WORDS]) -> bool {
    own.iter().zip(key).fold(0, |differ, (x, y)| differ | (x ^ y)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_keys_differ_by_their_last_word() {
        let key = |last: u64| {
            let mut key = Key::new(true);
            key.start(MAX_SENSORS - 1);
            (0..2 + 2 * MAX_SENSORS).for_each(|_| key.push(u64::MAX));
            key.push(last << 32);
            key
        };
        let (one, other) = (key(1), key(2));
        assert_eq!(one.len, KEY_WORDS);
        assert!(same(&one.words, &one.words) && !same(&one.words, &other.words));
    }
}
