//! Pictures in grey: PGM, plain (`P2`) or binary (`P5`), as netpbm defines it.

/// Largest number of pixels that are read: a choice, a file of 400 MB at one byte each.
const MOST: usize = 400_000_000;

/// A picture, its rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Brightness of each pixel, 0 to 1.
    pub(super) pixels: Vec<f32>,
}

/// Reads a picture.
pub(super) fn read(bytes: &[u8]) -> Result<Picture, String> {
    let mut words = Words { bytes, at: 2 };
    let binary = match bytes.get(..2) {
        Some(b"P5") => true,
        Some(b"P2") => false,
        Some(b"\x89P") => return Err("a PNG; expected a PGM (P2 or P5): convert it".to_owned()),
        _ => return Err("no PGM; expected P2 or P5 in the first two bytes".to_owned()),
    };
    let [width, height] = [words.number("width", usize::MAX)?, words.number("height", usize::MAX)?];
    let most = words.number("maxval", 65_535)?;
    let pixels = width.checked_mul(height).filter(|&pixels| pixels <= MOST);
    let Some(count) = pixels.filter(|&pixels| pixels > 0) else {
        return Err(format!("{width} x {height} pixels; expected 1 to {MOST} in all"));
    };
    if most == 0 {
        return Err("maxval = 0; expected 1 to 65535".to_owned());
    }
    let bright = |value: usize| if value > most { None } else { Some(value as f32 / most as f32) };
    let mut pixels = Vec::new();
    if binary {
        let wide = 1 + usize::from(most > 255);
        // A single white space ends the head.
        let data = bytes.get(words.at + 1..).unwrap_or_default();
        if data.len() < count * wide {
            return Err(format!("{} bytes of pixels; {width} x {height} need {}", data.len(), count * wide));
        }
        let values = data.chunks_exact(wide).map(|of| of.iter().fold(0, |sum, &byte| 256 * sum + usize::from(byte)));
        pixels.extend(values.take(count).map_while(bright));
    } else {
        for _ in 0..count {
            pixels.extend(bright(words.number("pixel", 65_535)?));
        }
    }
    if pixels.len() < count {
        return Err(format!("a pixel is brighter than maxval = {most}"));
    }
    Ok(Picture { width, height, pixels })
}

/// Numbers of the head and of a plain picture, separated by white space and comments.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Words<'_> {
    fn number(&mut self, what: &str, most: usize) -> Result<usize, String> {
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                b'#' => {
                    let line = self.bytes[self.at..].iter().position(|&byte| byte == b'\n');
                    self.at = line.map_or(self.bytes.len(), |end| self.at + end + 1);
                }
                _ if byte.is_ascii_whitespace() => self.at += 1,
                _ => break,
            }
        }
        let digits =
            self.bytes[self.at.min(self.bytes.len())..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let text = String::from_utf8_lossy(self.bytes.get(self.at..self.at + digits).unwrap_or_default());
        let number = text.parse().ok().filter(|&number| number <= most);
        self.at += digits;
        number.ok_or_else(|| format!("{what} at byte {} is no number up to {most}", self.at - digits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_and_binary_pictures_with_comments_are_read_alike() {
        let plain = read(b"P2 # made by hand\n3 2\n# white is 4\n4\n0 1 2\n3 4 4\n").unwrap();
        assert_eq!((plain.width, plain.height), (3, 2));
        assert_eq!(plain.pixels, [0.0, 0.25, 0.5, 0.75, 1.0, 1.0]);
        assert_eq!(read(b"P5 3 2 4\n\x00\x01\x02\x03\x04\x04").unwrap(), plain);
        let wide = read(b"P5 1 2 1000\n\x00\xfa\x03\xe8").unwrap();
        assert_eq!(wide.pixels, [0.25, 1.0]);
    }

    #[test]
    fn what_is_no_picture_is_refused_by_name() {
        for (bytes, says) in [
            (&b"\x89PNG"[..], "a PNG; expected a PGM"),
            (b"", "no PGM"),
            (b"P5 3", "height at byte 4"),
            (b"P5 0 2 255\n", "0 x 2 pixels"),
            (b"P5 99999999 99999999 255\n", "99999999 x 99999999 pixels"),
            (b"P5 2 2 0\n", "maxval = 0"),
            (b"P5 2 2 70000\n", "maxval at byte 7"),
            (b"P5 2 2 255\nab", "2 bytes of pixels; 2 x 2 need 4"),
            (b"P2 2 1 9 3 12", "brighter than maxval = 9"),
            (b"P2 2 1 9 3 x", "pixel at byte 11"),
        ] {
            let error = read(bytes).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
    }
}
