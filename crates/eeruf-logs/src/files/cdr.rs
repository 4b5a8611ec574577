//! Writes CDR, the encoding of ROS 2: little-endian, each number aligned to its size.

/// A message under construction.
pub(crate) struct Cdr(Vec<u8>);

/// The bytes that name the encoding; alignment counts from their end.
const HEAD: [u8; 4] = [0, 1, 0, 0];

impl Cdr {
    /// Begins a message in this buffer.
    pub(crate) fn begin(mut buffer: Vec<u8>) -> Self {
        buffer.clear();
        buffer.extend(HEAD);
        Self(buffer)
    }

    pub(crate) fn bytes(self) -> Vec<u8> {
        self.0
    }

    fn number<const SIZE: usize>(&mut self, bytes: [u8; SIZE]) {
        let aligned = (self.0.len() - HEAD.len()).next_multiple_of(SIZE) + HEAD.len();
        self.0.resize(aligned, 0);
        self.0.extend(bytes);
    }

    pub(crate) fn u8(&mut self, value: u8) {
        self.0.push(value);
    }

    pub(crate) fn bool(&mut self, value: bool) {
        self.u8(value.into());
    }

    pub(crate) fn u32(&mut self, value: u32) {
        self.number(value.to_le_bytes());
    }

    pub(crate) fn i32(&mut self, value: i32) {
        self.number(value.to_le_bytes());
    }

    pub(crate) fn i64(&mut self, value: i64) {
        self.number(value.to_le_bytes());
    }

    pub(crate) fn f32s<const COUNT: usize>(&mut self, values: [f32; COUNT]) {
        values.into_iter().for_each(|value| self.number(value.to_le_bytes()));
    }

    pub(crate) fn f64s<const COUNT: usize>(&mut self, values: [f64; COUNT]) {
        values.into_iter().for_each(|value| self.number(value.to_le_bytes()));
    }

    /// The length of a sequence, before its items.
    pub(crate) fn length(&mut self, length: usize) {
        self.u32(length as u32);
    }

    pub(crate) fn text(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    /// A time or a duration.
    pub(crate) fn time(&mut self, ns: u64) {
        self.u32((ns / 1_000_000_000) as u32);
        self.u32((ns % 1_000_000_000) as u32);
    }

    pub(crate) fn header(&mut self, at_ns: u64, frame: &str) {
        self.time(at_ns);
        self.text(frame);
    }
}
