//! Reads MCAP files (mcap.dev/spec) record by record, in the order in which they were recorded.
//!
//! The readers of the crate `mcap`, with which this crate writes, end at the first record that is damaged. Recordings
//! often end when the battery is empty, so this module parses records itself and loses only damaged chunks.

use std::collections::HashMap;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use crate::bytes::{Bytes, Input, Order};
use crate::chunks::Chunks;
use crate::schema::Encoding;
use crate::sink::Sink;
use crate::topics::Topic;
use crate::unzstd::{LARGEST_MESSAGE, Unzstd};
use eeruf_files::FileError;

pub(crate) const MAGIC: [u8; 8] = [0x89, b'M', b'C', b'A', b'P', 0x30, b'\r', b'\n'];

const FOOTER: u8 = 0x02;
const SCHEMA: u8 = 0x03;
const CHANNEL: u8 = 0x04;
const MESSAGE: u8 = 0x05;
const CHUNK: u8 = 0x06;
const CHUNK_INDEX: u8 = 0x08;
const STATISTICS: u8 = 0x0b;
const DATA_END: u8 = 0x0f;
/// Length of a record's head: a letter and a length.
const RECORD_HEAD: usize = 9;
/// The largest chunk that is unpacked, and the largest record that is read.
const LARGEST_CHUNK: u64 = 1 << 30;

/// State after reading some records.
#[derive(Default)]
struct State {
    /// Name and text of each schema.
    schemas: HashMap<u16, (String, Option<String>)>,
    topics: HashMap<u16, Topic>,
    /// Number of messages, if the file says so.
    counted: u64,
    /// Positions of the chunks, from the summary.
    chunks: Chunks,
    /// True if messages are packed one by one, as rosbag2 can do.
    packed: bool,
    zstd: Unzstd,
    unpacked: Vec<u8>,
}

/// Reads a file to its end, or as far as it can be read; `file` is used in errors.
pub(crate) fn read(opened: &mut dyn Input, file: &Path, packed: bool, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let failed = |error: io::Error| FileError::reading(file, &error);
    let size = opened.seek(SeekFrom::End(0)).map_err(failed)?;
    let mut state = State { packed, ..State::default() };
    let found_before = sink.of_topics.found;
    // Topics are found in the chunks too, so a missing summary is not damage.
    match summary(opened, size) {
        Ok(Some(summary)) => _ = state.topics_of(&summary, sink),
        Ok(None) => sink.damage(file, None, "the check sum of the summary at its end is wrong; it is not used"),
        Err(_) => {}
    }
    opened.rewind().map_err(failed)?;
    let mut input = BufReader::with_capacity(1 << 18, opened);
    let (mut at, mut body, mut chunk) = (0, Vec::new(), Vec::new());
    let mut magic = [0; 8];
    if input.read_exact(&mut magic).is_err() || magic != MAGIC {
        sink.damage(file, Some(0), "the first bytes are not those of MCAP");
    }
    at += MAGIC.len() as u64;
    let ended = loop {
        // No record reaches into the next chunk.
        let known = state.chunks.after(at, size);
        let room = known.unwrap_or(size).checked_sub(at + RECORD_HEAD as u64);
        if room.is_none() && known.is_none() {
            break false;
        }
        let (letter, length) = if room.is_some() { record_head(&mut input).map_err(failed)? } else { (0, u64::MAX) };
        if let Some(start) = known.filter(|_| room.is_none_or(|room| length > room)) {
            if !is_chunk(&mut input, start, size).map_err(failed)? {
                state.chunks.forget(start);
                input.seek(SeekFrom::Start(at)).map_err(failed)?;
                continue;
            }
            let message = format!("what stands from here to the chunk at byte {start} is lost: its records do not fit");
            sink.damage(file, Some(at), message);
            input.seek(SeekFrom::Start(start)).map_err(failed)?;
            at = start;
            continue;
        }
        if room.is_none_or(|room| length > room) {
            sink.damage(file, Some(at), format!("a record of {length} bytes, which the file does not have"));
            if letter == CHUNK {
                body.clear();
                (&mut input).take(LARGEST_CHUNK).read_to_end(&mut body).map_err(failed)?;
                // Reads the part of the chunk before the cut.
                _ = unpack_chunk(&body, &mut state.zstd, &mut chunk, false);
                state.records(&chunk, sink);
            }
            break false;
        }
        // All messages come before the end of the data; what follows is a summary of them.
        if matches!(letter, FOOTER | DATA_END) && known.is_none() {
            break true;
        }
        let next = at + RECORD_HEAD as u64 + length;
        let is_read = matches!(letter, SCHEMA | CHANNEL | MESSAGE | CHUNK);
        if is_read && length > LARGEST_CHUNK {
            sink.damage(
                file,
                Some(at),
                format!("a record of {length} bytes is lost; expected at most {LARGEST_CHUNK}"),
            );
        }
        if !is_read || length > LARGEST_CHUNK {
            input.seek_relative(length.cast_signed()).map_err(failed)?;
            at = next;
            continue;
        }
        body.clear();
        (&mut input).take(length).read_to_end(&mut body).map_err(failed)?;
        if letter == CHUNK {
            match unpack_chunk(&body, &mut state.zstd, &mut chunk, true) {
                Err(why) => sink.damage(file, Some(at), format!("a chunk is lost: {why}")),
                Ok(()) => match state.records(&chunk, sink) {
                    None => sink.damage(file, Some(at), "the rest of a chunk is lost: its records do not fit"),
                    Some(0) => {}
                    Some(lost) => sink.damage(file, Some(at), format!("{lost} records of a chunk cannot be read")),
                },
            }
        } else if state.record(letter, &body, sink).is_none() {
            sink.damage(file, Some(at), "a record does not have the fields of its kind");
        }
        at = next;
    };
    if !ended {
        let message = "the file is cut: it ends without an end of data; what stands before was read";
        sink.damage(file, Some(at.min(size)), message);
    }
    sink.counted(file, state.counted, found_before);
    for (_, topic) in state.topics {
        sink.close(&topic);
    }
    Ok(())
}

/// The letter and the length of the record that begins here.
fn record_head(input: &mut impl Read) -> io::Result<(u8, u64)> {
    let (mut letter, mut length) = ([0], [0; 8]);
    input.read_exact(&mut letter)?;
    input.read_exact(&mut length)?;
    Ok((letter[0], u64::from_le_bytes(length)))
}

/// Returns true if a chunk begins at a place that the summary names.
fn is_chunk(input: &mut BufReader<&mut dyn Input>, start: u64, size: u64) -> io::Result<bool> {
    let Some(room) = size.checked_sub(start.saturating_add(RECORD_HEAD as u64)) else { return Ok(false) };
    input.seek(SeekFrom::Start(start))?;
    let (letter, length) = record_head(input)?;
    Ok(letter == CHUNK && length <= room)
}

/// The summary at the end of a file, which repeats schemas and channels and counts messages: empty if there is none,
/// `None` if its check sum is wrong.
fn summary(file: &mut dyn Input, size: u64) -> io::Result<Option<Vec<u8>>> {
    // The positions of the summary and of its offsets, and its check sum.
    const FIELDS: usize = 8 + 8 + 4;
    let end = size.saturating_sub((RECORD_HEAD + FIELDS + MAGIC.len()) as u64);
    file.seek(SeekFrom::Start(end))?;
    let mut footer = [0; RECORD_HEAD + FIELDS];
    file.read_exact(&mut footer)?;
    let mut fields = Bytes::new(&footer[RECORD_HEAD..], Order::Little);
    let (Some(at), Some(_), Some(sum)) = (fields.u64(), fields.u64(), fields.u32()) else { return Ok(None) };
    let mut summary = Vec::new();
    if footer[0] == FOOTER && at > 0 && at < end && end - at < LARGEST_CHUNK {
        file.seek(SeekFrom::Start(at))?;
        file.take(end - at).read_to_end(&mut summary)?;
        let mut found = crc32fast::Hasher::new();
        found.update(&summary);
        // The footer too, but for the sum itself.
        found.update(&footer[..footer.len() - 4]);
        if sum != 0 && found.finalize() != sum {
            return Ok(None);
        }
    }
    Ok(Some(summary))
}

/// The records of a chunk. A cut chunk is unpacked as far as possible.
fn unpack_chunk(body: &[u8], zstd: &mut Unzstd, chunk: &mut Vec<u8>, whole: bool) -> Result<(), String> {
    let mut fields = Bytes::new(body, Order::Little);
    let head = (|| {
        fields.take(16)?; // When its first and its last message were recorded.
        let (length, sum) = (fields.u64()?, fields.u32()?);
        let compression = fields.counted()?;
        let packed = usize::try_from(fields.u64()?).ok()?;
        let packed = if whole { packed } else { packed.min(fields.left()) };
        Some((length, sum, compression, fields.take(packed)?))
    })();
    chunk.clear();
    let Some((length, sum, compression, packed)) = head else {
        return Err("it does not have the fields of a chunk".to_owned());
    };
    if length > LARGEST_CHUNK {
        return Err(format!("it says that it holds {length} bytes; expected at most {LARGEST_CHUNK}"));
    }
    let said = |error: io::Error| error.to_string();
    let unpacked = match compression {
        b"" => packed.take(length).read_to_end(chunk).map(drop).map_err(said),
        b"zstd" => zstd.unpack(packed, length as usize, chunk),
        b"lz4" => lz4_flex::frame::FrameDecoder::new(packed).take(length).read_to_end(chunk).map(drop).map_err(said),
        other => {
            let other = String::from_utf8_lossy(other);
            return Err(format!("it is compressed by `{other}`; expected zstd, lz4 or nothing"));
        }
    };
    unpacked.map_err(|why| format!("it cannot be unpacked: {why}"))?;
    if chunk.len() as u64 != length {
        return Err(format!("it holds {} bytes instead of {length}", chunk.len()));
    }
    if sum != 0 && crc32fast::hash(chunk) != sum {
        return Err("its check sum is wrong".to_owned());
    }
    Ok(())
}

impl State {
    /// The schemas and channels in a summary, its positions of chunks, and its number of messages.
    fn topics_of(&mut self, records: &[u8], sink: &mut Sink<'_>) -> Option<()> {
        let mut rest = Bytes::new(records, Order::Little);
        while rest.left() > 0 {
            let letter = rest.u8()?;
            let body = usize::try_from(rest.u64()?).ok().and_then(|length| rest.take(length))?;
            match letter {
                SCHEMA | CHANNEL => self.record(letter, body, sink)?,
                CHUNK_INDEX => {
                    let mut fields = Bytes::new(body, Order::Little);
                    fields.take(16)?; // When its first and its last message were recorded.
                    self.chunks.add(fields.u64()?);
                }
                STATISTICS => self.counted = Bytes::new(body, Order::Little).u64()?,
                _ => {}
            }
        }
        Some(())
    }

    /// All records of a chunk, and the number of unreadable ones; `None` if they do not fit into it.
    fn records(&mut self, chunk: &[u8], sink: &mut Sink<'_>) -> Option<u64> {
        let mut lost = 0;
        let mut rest = Bytes::new(chunk, Order::Little);
        while rest.left() > 0 {
            let letter = rest.u8()?;
            let length = usize::try_from(rest.u64()?).ok()?;
            lost += u64::from(self.record(letter, rest.take(length)?, sink).is_none());
        }
        Some(lost)
    }

    /// One record that is not a chunk; `None` if its fields do not fit.
    fn record(&mut self, letter: u8, body: &[u8], sink: &mut Sink<'_>) -> Option<()> {
        let mut fields = Bytes::new(body, Order::Little);
        match letter {
            MESSAGE => {
                sink.of_topics.found += 1;
                let channel = fields.u16()?;
                fields.u32()?; // A running number.
                let recorded_ns = fields.u64()?;
                fields.u64()?; // When it was published.
                let message = fields.take(fields.left())?;
                // A message whose channel is lost cannot be read.
                let topic = self.topics.get_mut(&channel)?;
                if !self.packed {
                    sink.message(topic, recorded_ns, message);
                } else if topic.has_readings() {
                    self.zstd.unpack(message, LARGEST_MESSAGE, &mut self.unpacked).ok()?;
                    sink.message(topic, recorded_ns, &self.unpacked);
                }
            }
            SCHEMA => {
                let id = fields.u16()?;
                let (name, _encoding) = (fields.text()?, fields.text()?);
                let text = fields.text()?;
                self.schemas.insert(id, (name, (!text.is_empty()).then_some(text)));
            }
            CHANNEL => {
                let (id, schema) = (fields.u16()?, fields.u16()?);
                let (topic, encoding) = (fields.text()?, fields.text()?);
                if self.topics.contains_key(&id) {
                    return Some(());
                }
                let encoding = match &*encoding {
                    "cdr" => Some(Encoding::Cdr),
                    "ros1" => Some(Encoding::Ros1),
                    _ => None,
                };
                let (name, text) = match self.schemas.get(&schema) {
                    Some((name, text)) => (&**name, text.as_deref()),
                    None => ("a type without a schema", None),
                };
                let topic = sink.topic(&topic, name, text, encoding);
                self.topics.insert(id, topic);
            }
            _ => {}
        }
        Some(())
    }
}
