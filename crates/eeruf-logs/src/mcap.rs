//! Reads MCAP files (mcap.dev/spec) record by record, in the order in which they were recorded.
//!
//! The readers of the crate `mcap`, with which this crate writes, end at the first record that is damaged. A robot's
//! battery ends recordings, so records are taken apart here: a damaged chunk loses only itself.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use crate::bytes::{Bytes, Order};
use crate::error::LogError;
use crate::message::Encoding;
use crate::sink::{Sink, Topic};

pub(crate) const MAGIC: [u8; 8] = [0x89, b'M', b'C', b'A', b'P', 0x30, b'\r', b'\n'];

const FOOTER: u8 = 0x02;
const SCHEMA: u8 = 0x03;
const CHANNEL: u8 = 0x04;
const MESSAGE: u8 = 0x05;
const CHUNK: u8 = 0x06;
const DATA_END: u8 = 0x0f;
/// A letter and a length.
const RECORD_HEAD: usize = 9;
/// The largest chunk that is unpacked.
const LARGEST_CHUNK: u64 = 1 << 30;

/// What is known from the records so far.
#[derive(Default)]
struct State {
    /// Name and text of each schema.
    schemas: HashMap<u16, (String, Option<String>)>,
    topics: HashMap<u16, Topic>,
    /// Whether messages are packed one by one, as rosbag2 may have it.
    packed: bool,
    unpacked: Vec<u8>,
}

/// Reads a file to its end, or to where it cannot be read any further.
pub(crate) fn read(file: &Path, packed: bool, sink: &mut Sink<'_>) -> Result<(), LogError> {
    let failed = |error| LogError::new(file, error);
    let mut opened = File::open(file).map_err(failed)?;
    let size = opened.metadata().map_err(failed)?.len();
    let mut state = State { packed, ..State::default() };
    // Topics are found in the chunks too; that there is no summary is no damage.
    if let Ok(summary) = summary(&mut opened, size) {
        state.topics_of(&summary, sink);
    }
    opened.rewind().map_err(failed)?;
    let mut input = BufReader::with_capacity(1 << 18, opened);
    let (mut at, mut head, mut body, mut chunk) = (0, [0; RECORD_HEAD], Vec::new(), Vec::new());
    let mut magic = [0; 8];
    if input.read_exact(&mut magic).is_err() || magic != MAGIC {
        sink.damage(file, Some(0), "the first bytes are not those of MCAP");
    }
    at += MAGIC.len() as u64;
    let ended = loop {
        if size.saturating_sub(at) < RECORD_HEAD as u64 {
            break false;
        }
        input.read_exact(&mut head).map_err(failed)?;
        let letter = head[0];
        let mut length = [0; 8];
        length.copy_from_slice(&head[1..]);
        let length = u64::from_le_bytes(length);
        if length > size - at - RECORD_HEAD as u64 {
            sink.damage(file, Some(at), format!("a record of {length} bytes, which the file does not have"));
            if letter == CHUNK {
                body.clear();
                input.read_to_end(&mut body).map_err(failed)?;
                // What stands in it before the cut.
                _ = unpack_chunk(&body, &mut chunk, false);
                state.records(&chunk, sink);
            }
            break false;
        }
        // All messages come before the end of the data; what follows is a summary of them.
        if matches!(letter, FOOTER | DATA_END) {
            break true;
        }
        body.clear();
        (&mut input).take(length).read_to_end(&mut body).map_err(failed)?;
        if letter == CHUNK {
            match unpack_chunk(&body, &mut chunk, true) {
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
        at += RECORD_HEAD as u64 + length;
    };
    if !ended {
        let message = "the file is cut: it ends without an end of data; what stands before was read";
        sink.damage(file, Some(at.min(size)), message);
    }
    for (_, topic) in state.topics {
        sink.close(&topic);
    }
    Ok(())
}

/// The summary at the end of a file, which repeats schemas and channels.
fn summary(file: &mut File, size: u64) -> io::Result<Vec<u8>> {
    const FOOTER_LENGTH: u64 = 20;
    let end = size.saturating_sub(RECORD_HEAD as u64 + FOOTER_LENGTH + MAGIC.len() as u64);
    file.seek(SeekFrom::Start(end))?;
    let mut footer = [0; RECORD_HEAD + 8];
    file.read_exact(&mut footer)?;
    let mut at = [0; 8];
    at.copy_from_slice(&footer[RECORD_HEAD..]);
    let at = u64::from_le_bytes(at);
    let mut summary = Vec::new();
    if footer[0] == FOOTER && at > 0 && at < end && end - at < LARGEST_CHUNK {
        file.seek(SeekFrom::Start(at))?;
        file.take(end - at).read_to_end(&mut summary)?;
    }
    Ok(summary)
}

/// The records of a chunk. One that is not whole is unpacked as far as it goes.
fn unpack_chunk(body: &[u8], chunk: &mut Vec<u8>, whole: bool) -> Result<(), String> {
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
    let unpacked = match compression {
        b"" => packed.take(length).read_to_end(chunk),
        b"zstd" => {
            zstd::stream::read::Decoder::with_buffer(packed).and_then(|decoder| decoder.take(length).read_to_end(chunk))
        }
        b"lz4" => lz4_flex::frame::FrameDecoder::new(packed).take(length).read_to_end(chunk),
        other => {
            let other = String::from_utf8_lossy(other);
            return Err(format!("it is compressed by `{other}`; expected zstd, lz4 or nothing"));
        }
    };
    unpacked.map_err(|error| format!("it cannot be unpacked: {error}"))?;
    if chunk.len() as u64 != length {
        return Err(format!("it holds {} bytes instead of {length}", chunk.len()));
    }
    if sum != 0 && crc32fast::hash(chunk) != sum {
        return Err("its check sum is wrong".to_owned());
    }
    Ok(())
}

impl State {
    /// The schemas and channels among records.
    fn topics_of(&mut self, records: &[u8], sink: &mut Sink<'_>) -> Option<()> {
        let mut rest = Bytes::new(records, Order::Little);
        while rest.left() > 0 {
            let letter = rest.u8()?;
            let body = usize::try_from(rest.u64()?).ok().and_then(|length| rest.take(length))?;
            if matches!(letter, SCHEMA | CHANNEL) {
                self.record(letter, body, sink)?;
            }
        }
        Some(())
    }

    /// All records of a chunk, and how many of them cannot be read; `None` if they do not fit into it.
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

    /// One record that is no chunk; `None` if its fields do not fit.
    fn record(&mut self, letter: u8, body: &[u8], sink: &mut Sink<'_>) -> Option<()> {
        let mut fields = Bytes::new(body, Order::Little);
        match letter {
            MESSAGE => {
                let channel = fields.u16()?;
                fields.u32()?; // A running number.
                let recorded_ns = fields.u64()?;
                fields.u64()?; // When it was published.
                let message = fields.take(fields.left())?;
                // A message whose channel is lost cannot be read.
                let topic = self.topics.get_mut(&channel)?;
                if self.packed {
                    self.unpacked.clear();
                    let unpacked = zstd::stream::read::Decoder::with_buffer(message)
                        .and_then(|decoder| decoder.take(LARGEST_CHUNK).read_to_end(&mut self.unpacked));
                    unpacked.ok()?;
                    sink.message(topic, recorded_ns, &self.unpacked);
                } else {
                    sink.message(topic, recorded_ns, message);
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
