//! Reads ROS 1 bags, format 2.0 (wiki.ros.org/Bags/Format/2.0), record by record, without their index.
//!
//! The only crate for such bags needs the index, which a cut recording lacks.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use crate::bytes::{Bytes, Input, Order};
use crate::chunks::Chunks;
use crate::schema::Encoding;
use crate::sink::Sink;
use crate::topics::Topic;
use eeruf_files::FileError;

pub(crate) const MAGIC: &[u8; 13] = b"#ROSBAG V2.0\n";

const MESSAGE: u8 = 0x02;
const BAG: u8 = 0x03;
const INDEX: u8 = 0x04;
const CHUNK: u8 = 0x05;
const CHUNK_INFO: u8 = 0x06;
const CONNECTION: u8 = 0x07;
/// The largest chunk that is unpacked.
const LARGEST_CHUNK: u32 = 1 << 30;

/// The fields of a record's header that are used here.
#[derive(Clone, Copy, Default)]
struct Header<'a> {
    op: u8,
    connection: Option<u32>,
    time_ns: u64,
    topic: &'a [u8],
    compression: &'a [u8],
    size: u32,
    /// Start of the index; 0 in a bag that was not closed.
    index_at: u64,
    /// Position of the chunk of an index record.
    chunk_at: u64,
    type_name: &'a [u8],
    definition: &'a [u8],
}

impl<'a> Header<'a> {
    /// Fields `NAME=VALUE`, each after its length; `None` if they do not fit.
    fn of(bytes: &'a [u8]) -> Option<Self> {
        let mut header = Self::default();
        let mut rest = Bytes::new(bytes, Order::Little);
        while rest.left() > 0 {
            let field = rest.counted()?;
            let equals = field.iter().position(|&byte| byte == b'=')?;
            let (name, value) = (&field[..equals], &field[equals + 1..]);
            let mut number = Bytes::new(value, Order::Little);
            match name {
                b"op" => header.op = number.u8()?,
                b"conn" => header.connection = Some(number.u32()?),
                b"time" => header.time_ns = u64::from(number.u32()?) * 1_000_000_000 + u64::from(number.u32()?),
                b"topic" => header.topic = value,
                b"compression" => header.compression = value,
                b"size" => header.size = number.u32()?,
                b"index_pos" => header.index_at = number.u64()?,
                b"chunk_pos" => header.chunk_at = number.u64()?,
                b"type" => header.type_name = value,
                b"message_definition" => header.definition = value,
                _ => {}
            }
        }
        Some(header)
    }
}

#[derive(Default)]
struct State {
    topics: HashMap<u32, Topic>,
    /// Number of messages, if the index says so.
    counted: u64,
    /// Positions of the chunks, from the index.
    chunks: Chunks,
}

/// Reads a bag to its end, or as far as it can be read; `file` is used in errors.
pub(crate) fn read(opened: &mut dyn Input, file: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let failed = |error: io::Error| FileError::reading(file, &error);
    let size = opened.seek(SeekFrom::End(0)).map_err(failed)?;
    let mut state = State::default();
    let found_before = sink.of_topics.found;
    // Connections are found in the chunks too, so a missing index is not damage.
    if let Ok(index) = index(opened, size) {
        state.connections_of(&index, sink);
    }
    opened.rewind().map_err(failed)?;
    let mut input = BufReader::with_capacity(1 << 18, opened);
    let mut magic = [0; MAGIC.len()];
    if input.read_exact(&mut magic).is_err() || magic != *MAGIC {
        sink.damage(file, Some(0), "the first bytes are not those of a ROS 1 bag of format 2.0");
    }
    let mut at = MAGIC.len() as u64;
    let (mut head, mut body, mut chunk) = (Vec::new(), Vec::new(), Vec::new());
    let mut closed = true;
    while at < size {
        // No record reaches into the next chunk.
        let (begin, known) = (at, state.chunks.after(at, size));
        let end = known.unwrap_or(size);
        let mut part = |into: &mut Vec<u8>| -> Result<bool, FileError> {
            into.clear();
            let mut length = [0; 4];
            if end - at < 4 {
                return Ok(false);
            }
            input.read_exact(&mut length).map_err(failed)?;
            let length = u32::from_le_bytes(length);
            at += 4;
            if u64::from(length) > end - at || length > LARGEST_CHUNK {
                return Ok(false);
            }
            (&mut input).take(length.into()).read_to_end(into).map_err(failed)?;
            at += u64::from(length);
            Ok(true)
        };
        let fits = part(&mut head)? && part(&mut body)?;
        if let Some(start) = known.filter(|_| !fits) {
            let is_chunk = is_chunk(&mut input, start).map_err(failed)?;
            if is_chunk {
                let message =
                    format!("what stands from here to the chunk at byte {start} is lost: its records do not fit");
                sink.damage(file, Some(begin), message);
            } else {
                state.chunks.forget(start);
            }
            at = if is_chunk { start } else { begin };
            input.seek(SeekFrom::Start(at)).map_err(failed)?;
            continue;
        }
        if !fits {
            body.clear();
            (&mut input).take(LARGEST_CHUNK.into()).read_to_end(&mut body).map_err(failed)?;
            if let Some(header) = Header::of(&head).filter(|header| header.op == CHUNK) {
                // Reads the part of the chunk before the cut.
                _ = unpack_chunk(&header, &body, &mut chunk);
                state.records(&chunk, sink);
            }
            let message =
                "the bag is cut, or a length in it is wrong: a record does not fit; what stands before was read";
            sink.damage(file, Some(at.min(size)), message);
            closed = true;
            break;
        }
        let Some(header) = Header::of(&head) else {
            sink.damage(file, Some(at), "a record is lost: its header cannot be read");
            continue;
        };
        match header.op {
            BAG => closed = header.index_at != 0,
            CHUNK => match unpack_chunk(&header, &body, &mut chunk) {
                Err(why) => sink.damage(file, Some(at), format!("a chunk is lost: {why}")),
                Ok(()) => match state.records(&chunk, sink) {
                    None => sink.damage(file, Some(at), "the rest of a chunk is lost: its records do not fit"),
                    Some(0) => {}
                    Some(lost) => sink.damage(file, Some(at), format!("{lost} records of a chunk cannot be read")),
                },
            },
            MESSAGE | CONNECTION => {
                if state.record(&header, &body, sink).is_none() {
                    sink.damage(file, Some(at), "a record does not have the fields of its kind");
                }
            }
            INDEX | CHUNK_INFO => {}
            other => sink.damage(file, Some(at), format!("a record of the unknown kind {other}")),
        }
    }
    if !closed {
        sink.damage(file, None, "the bag was not closed, or its end is cut off; all whole chunks were read");
    }
    sink.counted(file, state.counted, found_before);
    for (_, topic) in state.topics {
        sink.close(&topic);
    }
    Ok(())
}

/// Returns true if a chunk begins at a place that the index names.
fn is_chunk(input: &mut BufReader<&mut dyn Input>, start: u64) -> io::Result<bool> {
    /// Upper limit of the length of a chunk's header.
    const LONGEST: u64 = 4096;
    input.seek(SeekFrom::Start(start))?;
    let mut head = Vec::new();
    input.take(LONGEST).read_to_end(&mut head)?;
    let header = Bytes::new(&head, Order::Little).counted().and_then(Header::of);
    Ok(header.is_some_and(|header| header.op == CHUNK))
}

/// The index at the end of a bag, which repeats the connections.
fn index(file: &mut dyn Input, size: u64) -> io::Result<Vec<u8>> {
    // The bag's own record is padded to 4096 bytes.
    let mut first = Vec::new();
    file.rewind()?;
    (&mut *file).take(MAGIC.len() as u64 + 8192).read_to_end(&mut first)?;
    let header = first.get(MAGIC.len()..).and_then(|first| Bytes::new(first, Order::Little).counted());
    let at = header.and_then(Header::of).filter(|header| header.op == BAG).map_or(0, |header| header.index_at);
    let mut index = Vec::new();
    if at > 0 && at < size && size - at < u64::from(LARGEST_CHUNK) {
        file.seek(SeekFrom::Start(at))?;
        file.read_to_end(&mut index)?;
    }
    Ok(index)
}

/// Unpacks a chunk as far as possible.
fn unpack_chunk(header: &Header<'_>, body: &[u8], chunk: &mut Vec<u8>) -> Result<(), String> {
    if header.size > LARGEST_CHUNK {
        return Err(format!("it says that it holds {} bytes; expected at most {LARGEST_CHUNK}", header.size));
    }
    chunk.clear();
    let size = u64::from(header.size);
    let unpacked = match header.compression {
        b"none" => body.take(size).read_to_end(chunk),
        b"bz2" => bzip2::read::BzDecoder::new(body).take(size).read_to_end(chunk),
        b"lz4" => lz4_flex::frame::FrameDecoder::new(body).take(size).read_to_end(chunk),
        other => {
            let other = String::from_utf8_lossy(other);
            return Err(format!("it is compressed by `{other}`; expected bz2, lz4 or none"));
        }
    };
    unpacked.map_err(|error| format!("it cannot be unpacked: {error}"))?;
    if chunk.len() as u64 != size {
        return Err(format!("it holds {} bytes instead of {size}", chunk.len()));
    }
    Ok(())
}

impl State {
    /// The connections in the index, its positions of chunks, and its number of messages.
    fn connections_of(&mut self, records: &[u8], sink: &mut Sink<'_>) -> Option<()> {
        let mut rest = Bytes::new(records, Order::Little);
        while rest.left() > 0 {
            let (header, body) = (Header::of(rest.counted()?)?, rest.counted()?);
            match header.op {
                CONNECTION => self.record(&header, body, sink)?,
                CHUNK_INFO => {
                    self.chunks.add(header.chunk_at);
                    let mut counts = Bytes::new(body, Order::Little);
                    while counts.left() > 0 {
                        counts.u32()?; // The connection.
                        self.counted += u64::from(counts.u32()?);
                    }
                }
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
            let (header, body) = (rest.counted()?, rest.counted()?);
            let read = Header::of(header).and_then(|header| self.record(&header, body, sink));
            lost += u64::from(read.is_none());
        }
        Some(lost)
    }

    /// One record that is not a chunk; `None` if its fields do not fit.
    fn record(&mut self, header: &Header<'_>, body: &[u8], sink: &mut Sink<'_>) -> Option<()> {
        let text = |bytes| String::from_utf8_lossy(bytes);
        match header.op {
            MESSAGE => {
                sink.of_topics.found += 1;
                // A message whose connection is lost cannot be read.
                let topic = self.topics.get_mut(&header.connection?)?;
                sink.message(topic, header.time_ns, body);
            }
            CONNECTION => {
                // A bag repeats its connections.
                if let Entry::Vacant(entry) = self.topics.entry(header.connection?) {
                    let about = Header::of(body)?;
                    let definition = (!about.definition.is_empty()).then(|| text(about.definition));
                    let (name, type_name) = (text(header.topic), text(about.type_name));
                    entry.insert(sink.topic(&name, &type_name, definition.as_deref(), Some(Encoding::Ros1)));
                }
            }
            // A chunk has no other records.
            _ => return None,
        }
        Some(())
    }
}
