//! MCAP files (mcap.dev/spec).

use std::collections::HashMap;
use std::io::{self, Read, SeekFrom};

use super::bag::{Chunk, Form, Head, Kind, Known, LARGEST};
use super::bytes::{Bytes, Input, Order};
use super::schema::Encoding;
use super::unzstd::LARGEST_MESSAGE;
use crate::sink::Sink;

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

/// MCAP, with its schemas so far.
pub(crate) struct Mcap {
    packed: bool,
    /// Name and text of each schema.
    schemas: HashMap<u16, (String, Option<String>)>,
    unpacked: Vec<u8>,
}

impl Mcap {
    /// A file whose messages are `packed` one by one, as rosbag2 can do, or not.
    pub(crate) fn new(packed: bool) -> Self {
        Self { packed, schemas: HashMap::new(), unpacked: vec![] }
    }
}

impl Form for Mcap {
    const MAGIC: &'static [u8] = b"\x89MCAP0\r\n";
    const NAME: &'static str = "MCAP";

    fn head(input: &mut dyn Read, room: u64) -> io::Result<Option<Head>> {
        if room < RECORD_HEAD as u64 {
            return Ok(None);
        }
        let (mut letter, mut length) = ([0], [0; 8]);
        input.read_exact(&mut letter)?;
        input.read_exact(&mut length)?;
        let kind = match letter[0] {
            CHUNK => Kind::Chunk,
            SCHEMA | CHANNEL | MESSAGE => Kind::Content,
            FOOTER | DATA_END => Kind::End,
            _ => Kind::Skipped,
        };
        let (size, length) = (RECORD_HEAD as u64, u64::from_le_bytes(length));
        Ok(Some(Head { kind, header: letter.to_vec(), size, length }))
    }

    fn split<'a>(rest: &mut Bytes<'a>) -> Option<(&'a [u8], &'a [u8])> {
        let letter = rest.take(1)?;
        let length = usize::try_from(rest.u64()?).ok()?;
        Some((letter, rest.take(length)?))
    }

    fn chunk<'a>(_: &'a [u8], body: &'a [u8], whole: bool) -> Option<Chunk<'a>> {
        let mut fields = Bytes::new(body, Order::Little);
        fields.take(16)?; // When its first and its last message were recorded.
        let (length, sum, compression) = (fields.u64()?, fields.u32()?, fields.counted()?);
        let packed = usize::try_from(fields.u64()?).ok()?;
        let packed = fields.take(if whole { packed } else { packed.min(fields.left()) })?;
        Some(Chunk { length, sum, compression, packed })
    }

    fn index(file: &mut dyn Input, size: u64) -> io::Result<Option<Vec<u8>>> {
        // The places of the summary and of its offsets, and its check sum.
        const FIELDS: usize = 8 + 8 + 4;
        let end = size.saturating_sub((RECORD_HEAD + FIELDS + Self::MAGIC.len()) as u64);
        file.seek(SeekFrom::Start(end))?;
        let mut footer = [0; RECORD_HEAD + FIELDS];
        file.read_exact(&mut footer)?;
        let mut fields = Bytes::new(&footer[RECORD_HEAD..], Order::Little);
        let (Some(at), Some(_), Some(sum)) = (fields.u64(), fields.u64(), fields.u32()) else { return Ok(None) };
        let mut summary = Vec::new();
        if footer[0] == FOOTER && at > 0 && at < end && end - at < LARGEST {
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

    fn record(&mut self, header: &[u8], body: &[u8], known: &mut Known, sink: &mut Sink<'_>) -> Option<()> {
        let mut fields = Bytes::new(body, Order::Little);
        match *header.first()? {
            MESSAGE => {
                sink.of_topics.found += 1;
                let channel = fields.u16()?;
                fields.u32()?; // A running number.
                let recorded_ns = fields.u64()?;
                fields.u64()?; // When it was published.
                let message = fields.take(fields.left())?;
                // A message whose channel is lost cannot be read.
                let topic = known.topics.get_mut(&channel.into())?;
                if !self.packed {
                    sink.message(topic, recorded_ns, message);
                } else if topic.has_readings() {
                    known.zstd.unpack(message, LARGEST_MESSAGE, &mut self.unpacked).ok()?;
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
                let encoding = match &*encoding {
                    "cdr" => Some(Encoding::Cdr),
                    "ros1" => Some(Encoding::Ros1),
                    _ => None,
                };
                let (name, text) = match self.schemas.get(&schema) {
                    Some((name, text)) => (&**name, text.as_deref()),
                    None => ("a type without a schema", None),
                };
                known.topics.entry(id.into()).or_insert_with(|| sink.topic(&topic, name, text, encoding));
            }
            CHUNK_INDEX => {
                fields.take(16)?; // When its first and its last message were recorded.
                known.chunks.push(fields.u64()?);
            }
            STATISTICS => known.counted = fields.u64()?,
            _ => {}
        }
        Some(())
    }
}
