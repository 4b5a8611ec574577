//! ROS 1 bags, format 2.0 (wiki.ros.org/Bags/Format/2.0).

use std::io::{self, Read, SeekFrom};

use super::bag::{Chunk, Form, Head, Kind, Known, LARGEST};
use super::bytes::{Bytes, Input, Order};
use super::schema::Encoding;
use crate::sink::Sink;

const MESSAGE: u8 = 0x02;
const BAG: u8 = 0x03;
const INDEX: u8 = 0x04;
const CHUNK: u8 = 0x05;
const CHUNK_INFO: u8 = 0x06;
const CONNECTION: u8 = 0x07;

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

/// The form of ROS 1 bags.
pub(crate) struct Ros1;

impl Form for Ros1 {
    const MAGIC: &'static [u8] = b"#ROSBAG V2.0\n";
    const NAME: &'static str = "a ROS 1 bag of format 2.0";

    fn head(mut input: &mut dyn Read, room: u64) -> io::Result<Option<Head>> {
        let number = |input: &mut dyn Read| {
            let mut bytes = [0; 4];
            input.read_exact(&mut bytes).map(|()| u64::from(u32::from_le_bytes(bytes)))
        };
        if room < 8 {
            return Ok(None);
        }
        let length = number(input)?;
        if length > (room - 8).min(LARGEST) {
            return Ok(None);
        }
        let mut header = vec![];
        (&mut input).take(length).read_to_end(&mut header)?;
        let kind = match Header::of(&header).map(|header| header.op) {
            Some(CHUNK) => Kind::Chunk,
            Some(INDEX | CHUNK_INFO) => Kind::Skipped,
            _ => Kind::Content,
        };
        Ok(Some(Head { kind, header, size: 8 + length, length: number(input)? }))
    }

    fn split<'a>(rest: &mut Bytes<'a>) -> Option<(&'a [u8], &'a [u8])> {
        Some((rest.counted()?, rest.counted()?))
    }

    fn chunk<'a>(header: &'a [u8], packed: &'a [u8], _: bool) -> Option<Chunk<'a>> {
        let Header { size, compression, .. } = Header::of(header)?;
        Some(Chunk { length: size.into(), sum: 0, compression, packed })
    }

    fn index(file: &mut dyn Input, size: u64) -> io::Result<Option<Vec<u8>>> {
        // The bag's own record is padded to 4096 bytes.
        let mut first = Vec::new();
        file.rewind()?;
        (&mut *file).take(Self::MAGIC.len() as u64 + 8192).read_to_end(&mut first)?;
        let header = first.get(Self::MAGIC.len()..).and_then(|first| Bytes::new(first, Order::Little).counted());
        let at = header.and_then(Header::of).filter(|header| header.op == BAG).map_or(0, |header| header.index_at);
        let mut index = Vec::new();
        if at > 0 && at < size && size - at < LARGEST {
            file.seek(SeekFrom::Start(at))?;
            file.read_to_end(&mut index)?;
        }
        Ok(Some(index))
    }

    fn record(&mut self, header: &[u8], body: &[u8], known: &mut Known, sink: &mut Sink<'_>) -> Option<()> {
        let text = |bytes| String::from_utf8_lossy(bytes);
        let header = Header::of(header)?;
        match header.op {
            BAG => known.is_closed = header.index_at != 0,
            MESSAGE => {
                sink.of_topics.found += 1;
                // A message whose connection is lost cannot be read.
                let topic = known.topics.get_mut(&header.connection?)?;
                sink.message(topic, header.time_ns, body);
            }
            CONNECTION => {
                let about = Header::of(body)?;
                let definition = (!about.definition.is_empty()).then(|| text(about.definition));
                let (name, type_name) = (text(header.topic), text(about.type_name));
                let topic = || sink.topic(&name, &type_name, definition.as_deref(), Some(Encoding::Ros1));
                // A bag repeats its connections.
                known.topics.entry(header.connection?).or_insert_with(topic);
            }
            CHUNK_INFO => {
                known.chunks.push(header.chunk_at);
                let mut counts = Bytes::new(body, Order::Little);
                while counts.left() > 0 {
                    counts.u32()?; // The connection.
                    known.counted += u64::from(counts.u32()?);
                }
            }
            // A chunk has no other records.
            _ => return None,
        }
        Some(())
    }
}
