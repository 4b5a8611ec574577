//! The bytes of a log, and a reader of numbers and texts from a slice of them, which never reads beyond its end.

use std::io::{Read, Seek};

/// The bytes of a log, readable at any place.
pub(crate) trait Input: Read + Seek {}

impl<T: Read + Seek> Input for T {}

/// Byte order of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    Little,
    Big,
}

/// Kind of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    Unsigned,
    Signed,
    Float,
}

/// The rest of a slice.
#[derive(Clone, Copy)]
pub(crate) struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
    order: Order,
}

impl<'a> Bytes<'a> {
    pub(crate) const fn new(all: &'a [u8], order: Order) -> Self {
        Self { all, at: 0, order }
    }

    pub(crate) const fn left(&self) -> usize {
        self.all.len() - self.at
    }

    pub(crate) fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let taken = self.all.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        Some(taken)
    }

    /// Skips to the next multiple of `size`, counted from the slice's start.
    pub(crate) fn align(&mut self, size: usize) -> Option<()> {
        self.take(self.at.next_multiple_of(size) - self.at).map(drop)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = self.take(N)?.try_into().ok()?;
        if self.order == Order::Big {
            bytes.reverse();
        }
        Some(bytes)
    }

    pub(crate) fn u8(&mut self) -> Option<u8> {
        self.array::<1>().map(u8::from_le_bytes)
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// A number of up to 8 bytes.
    pub(crate) fn number(&mut self, kind: Number, size: usize) -> Option<f64> {
        let mut bytes = [0; 8];
        let number = bytes.get_mut(..size)?;
        number.copy_from_slice(self.take(size)?);
        if self.order == Order::Big {
            number.reverse();
        }
        let (unsigned, unused) = (u64::from_le_bytes(bytes), 64 - 8 * size.max(1));
        Some(match kind {
            Number::Unsigned => unsigned as f64,
            Number::Signed => ((unsigned << unused).cast_signed() >> unused) as f64,
            Number::Float if size == 4 => f32::from_bits(unsigned as u32).into(),
            Number::Float => f64::from_bits(unsigned),
        })
    }

    /// Bytes that follow their number, a `u32`.
    pub(crate) fn counted(&mut self) -> Option<&'a [u8]> {
        let length = self.u32()?;
        self.take(usize::try_from(length).ok()?)
    }

    /// A text that follows its length in bytes, a `u32`; invalid bytes are replaced.
    pub(crate) fn text(&mut self) -> Option<String> {
        self.counted().map(|bytes| String::from_utf8_lossy(bytes).into_owned())
    }
}
