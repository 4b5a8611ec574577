//! Unpacking of zstd with one context for all messages and chunks of a file, since making one takes longer than
//! unpacking a message.

use zstd::zstd_safe::{DCtx, InBuffer, OutBuffer, ResetDirective, get_error_name};

/// The largest message that is unpacked, in bytes.
pub(crate) const LARGEST_MESSAGE: usize = 1 << 26;
/// The least buffer for unpacked bytes.
const ROOM: usize = 1 << 12;

/// A context, made on first use.
#[derive(Default)]
pub(crate) struct Unzstd(Option<DCtx<'static>>);

impl Unzstd {
    /// Unpacks one or more frames. If one is damaged or cut, `unpacked` has the bytes before that. The buffer grows
    /// with the output, not with the size that a frame claims.
    pub(crate) fn unpack(&mut self, packed: &[u8], limit: usize, unpacked: &mut Vec<u8>) -> Result<(), String> {
        unpacked.clear();
        if self.0.is_none() {
            self.0 = DCtx::try_create();
        }
        let no_memory = || "there is not enough memory".to_owned();
        let context = self.0.as_mut().ok_or_else(no_memory)?;
        let failed = |code| get_error_name(code).to_owned();
        // The frame before this may have been cut.
        context.reset(ResetDirective::SessionOnly).map_err(failed)?;
        let mut input = InBuffer::around(packed);
        loop {
            let length = unpacked.len();
            if length == unpacked.capacity() {
                let more = length.max(ROOM).min(limit.saturating_add(1) - length);
                unpacked.try_reserve_exact(more).map_err(|_| no_memory())?;
            }
            let mut output = OutBuffer::around_pos(unpacked, length);
            let expected = context.decompress_stream(&mut output, &mut input).map_err(failed)?;
            if unpacked.len() > limit {
                unpacked.truncate(limit);
                return Err(format!("it holds more than {limit} bytes"));
            }
            if input.pos() == packed.len() {
                if expected == 0 {
                    return Ok(());
                }
                // Else more may come out once there is room for it.
                if unpacked.len() < unpacked.capacity() {
                    return Err("it is cut".to_owned());
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    /// A frame as rosbag2 writes it, which states its size.
    fn frame(bytes: &[u8]) -> Vec<u8> {
        zstd::bulk::compress(bytes, 1).unwrap()
    }

    /// A frame that does not state its size.
    fn stream(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = zstd::stream::Encoder::new(vec![], 1).unwrap();
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    /// A frame of three bytes that claims to hold 4 GiB; as a single segment it also asks for that much memory.
    fn boast(one_segment: bool) -> Vec<u8> {
        let mut frame = vec![0x28, 0xb5, 0x2f, 0xfd];
        // The length as eight bytes, and before it a window of 2 MiB if it is not all in one segment.
        frame.extend(if one_segment { &[0xe0][..] } else { &[0xc0, 0x58] });
        frame.extend((1_u64 << 32).to_le_bytes());
        // The last block, raw, of three bytes.
        frame.extend([3 << 3 | 1, 0, 0, b'a', b'b', b'c']);
        frame
    }

    fn noise(length: u32) -> Vec<u8> {
        (0..length).map(|n| (n.wrapping_mul(2_654_435_761) >> 24) as u8).collect()
    }

    #[test]
    fn zstd_context_unpacks_frames_of_any_kind() {
        let (mut zstd, mut out) = (Unzstd::default(), vec![]);
        for length in [0, 1, 64, 4096, 4097, 300_000, 5] {
            let bytes = noise(length);
            for packed in [frame(&bytes), stream(&bytes), [frame(&bytes), stream(b"more")].concat()] {
                let more = if packed.ends_with(&stream(b"more")) { &b"more"[..] } else { &[] };
                zstd.unpack(&packed, 1 << 20, &mut out).unwrap();
                assert!(out == [&bytes, more].concat(), "{length}");
                // Cut, and with something else behind it.
                assert!(zstd.unpack(&packed[..packed.len() - 1], 1 << 20, &mut out).is_err());
                assert!(zstd.unpack(&[&packed[..], b"no zstd"].concat(), 1 << 20, &mut out).is_err());
            }
        }
        assert_eq!(zstd.unpack(&[], 9, &mut out).unwrap_err(), "it is cut");
        assert_eq!(zstd.unpack(b"no zstd at all", 9, &mut out).unwrap_err(), "Unknown frame descriptor");
    }

    #[test]
    fn of_a_frame_that_is_cut_what_came_before_is_there() {
        let (mut zstd, mut out) = (Unzstd::default(), vec![]);
        let bytes = noise(1_000_000);
        for packed in [frame(&bytes), stream(&bytes)] {
            assert_eq!(zstd.unpack(&packed[..packed.len() / 2], 1 << 20, &mut out).unwrap_err(), "it is cut");
            assert!(out.len() > 100_000 && bytes.starts_with(&out), "{}", out.len());
        }
    }

    #[test]
    fn more_than_the_limit_is_refused_and_exactly_that_much_is_not() {
        let (mut zstd, mut out) = (Unzstd::default(), vec![]);
        let bytes = vec![7; 100_000];
        for packed in [frame(&bytes), stream(&bytes)] {
            zstd.unpack(&packed, 100_000, &mut out).unwrap();
            // Also where there is room from before.
            for mut out in [vec![], out.clone()] {
                let why = zstd.unpack(&packed, 99_999, &mut out).unwrap_err();
                assert_eq!((&*why, out.len()), ("it holds more than 99999 bytes", 99_999));
            }
        }
    }

    // A frame that says that it holds four gigabytes is given no room for them.
    #[test]
    fn frame_of_claimed_gigabytes_gets_no_room() {
        for one_segment in [false, true] {
            let (mut zstd, mut out) = (Unzstd::default(), vec![]);
            assert!(zstd.unpack(&boast(one_segment), usize::MAX, &mut out).is_err());
            assert!(out.capacity() <= ROOM, "{}", out.capacity());
            let context = zstd.0.as_ref().unwrap().sizeof();
            assert!(context < 4 << 20, "{context}");
            zstd.unpack(&frame(b"after it"), 9, &mut out).unwrap();
            assert_eq!(out, b"after it");
        }
    }
}
