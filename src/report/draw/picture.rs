//! A picture as a list of shapes in pixels, saved as SVG or PNG by the file's extension.
//!
//! Plotters' two backends draw the shapes: SVG as they are, bitmaps four times as large and then halved, which smooths
//! edges and leaves two pixels for each of the picture's. Text in bitmaps is set in a part of DejaVu Sans (see
//! `font/`), which is built into the program: the look of a PNG does not depend on the machine. Rendering the SVG
//! instead would need a parser for it, a text shaper and a second rasteriser (`resvg`); this way a glyph outliner
//! (`ab_glyph`) and `png` are enough.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::style::{INK, SMALL, grid_step};
use crate::files::error::InputError;
use crate::files::write::write;

const FONT: &str = "sans-serif";
/// The font of text in bitmaps.
const FONT_FILE: &[u8] = include_bytes!("font/DejaVuSans-part.ttf");
/// Ratio of the size of a text in SVG to that in a bitmap by plotters, with this font.
const SVG_TEXT_SCALE: f64 = 0.939;
/// Distance of the baseline of a text in SVG below that in a bitmap, in sizes of the text.
const SVG_TEXT_DROP: f64 = 0.129;

/// Pixels of a PNG per pixel of the picture.
const DENSITY: usize = 2;
/// Ratio in which a picture is drawn larger than the PNG, which [`shrunk`] halves.
const OVERSAMPLING: usize = 2;

/// A picture not yet tied to a file format.
pub(crate) struct Picture {
    width: f64,
    height: f64,
    shapes: Vec<Shape>,
}

pub(crate) type At = (f64, f64);

enum Shape {
    Line { from: At, to: At, width: f64, colour: RGBAColor },
    Area { corners: Vec<At>, colour: RGBAColor },
    Rect { corners: [At; 2], colour: RGBAColor },
    Dot { centre: At, radius: f64, colour: RGBAColor },
    Text { text: String, at: At, size: f64, side: HPos, colour: RGBAColor },
}

impl Picture {
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self { width, height, shapes: Vec::new() }
    }

    pub(crate) fn line(&mut self, from: At, to: At, width: f64, colour: impl Into<RGBAColor>) {
        self.shapes.push(Shape::Line { from, to, width, colour: colour.into() });
    }

    /// A line of dashes as long as the gaps between them.
    pub(crate) fn dashes(&mut self, from: At, to: At, width: f64, colour: impl Into<RGBAColor> + Copy) {
        const DASH: f64 = 4.0;
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let at = |way: f64| (from.0 + (to.0 - from.0) * way / length, from.1 + (to.1 - from.1) * way / length);
        let mut way = 0.0;
        while way < length {
            self.line(at(way), at((way + DASH).min(length)), width, colour);
            way += 2.0 * DASH;
        }
    }

    pub(crate) fn area(&mut self, corners: Vec<At>, colour: impl Into<RGBAColor>) {
        self.shapes.push(Shape::Area { corners, colour: colour.into() });
    }

    pub(crate) fn rect(&mut self, corners: [At; 2], colour: impl Into<RGBAColor>) {
        self.shapes.push(Shape::Rect { corners, colour: colour.into() });
    }

    pub(crate) fn dot(&mut self, centre: At, radius: f64, colour: impl Into<RGBAColor>) {
        self.shapes.push(Shape::Dot { centre, radius, colour: colour.into() });
    }

    pub(crate) fn cross(&mut self, (x, y): At, half: f64, colour: impl Into<RGBAColor> + Copy) {
        self.line((x - half, y - half), (x + half, y + half), 2.0, colour);
        self.line((x - half, y + half), (x + half, y - half), 2.0, colour);
    }

    /// An arrow head whose point is at `tip`.
    pub(crate) fn arrow_head(&mut self, from: At, tip: At, size: f64, colour: impl Into<RGBAColor>) {
        let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
        let length = dx.hypot(dy).max(1e-9);
        let (ux, uy) = (dx / length * size, dy / length * size);
        let back = (tip.0 - ux, tip.1 - uy);
        let corners = vec![tip, (back.0 - 0.45 * uy, back.1 + 0.45 * ux), (back.0 + 0.45 * uy, back.1 - 0.45 * ux)];
        self.area(corners, colour);
    }

    /// Text to the right of a point, vertically centred on it.
    pub(crate) fn text(&mut self, text: impl Into<String>, at: At, size: f64) {
        self.text_in(text, at, size, HPos::Left, INK);
    }

    pub(crate) fn text_in(
        &mut self,
        text: impl Into<String>,
        at: At,
        size: f64,
        side: HPos,
        colour: impl Into<RGBAColor>,
    ) {
        self.shapes.push(Shape::Text { text: text.into(), at, size, side, colour: colour.into() });
    }

    /// Grid lines at round numbers of milliseconds, up to a time in microseconds.
    pub(super) fn time_grid(&mut self, until_us: f64, x_of: impl Fn(f64) -> f64, top: f64, bottom: f64) {
        let step = grid_step(until_us, 10.0);
        let mut tick = 0.0;
        while tick <= until_us {
            self.line((x_of(tick), top), (x_of(tick), bottom + 4.0), 1.0, INK.mix(0.12));
            self.text(format!("{}", tick / 1000.0), (x_of(tick) - 8.0, bottom + 13.0), SMALL);
            tick += step;
        }
        self.text("ms", (x_of(until_us) - 18.0, bottom + 31.0), SMALL);
    }

    /// Puts another picture into this one.
    pub(crate) fn insert(&mut self, other: Self, (left, top): At) {
        let moved = |(x, y): At| (x + left, y + top);
        self.shapes.extend(other.shapes.into_iter().map(|shape| match shape {
            Shape::Line { from, to, width, colour } => Shape::Line { from: moved(from), to: moved(to), width, colour },
            Shape::Area { corners, colour } => {
                Shape::Area { corners: corners.into_iter().map(moved).collect(), colour }
            }
            Shape::Rect { corners, colour } => Shape::Rect { corners: corners.map(moved), colour },
            Shape::Dot { centre, radius, colour } => Shape::Dot { centre: moved(centre), radius, colour },
            Shape::Text { text, at, size, side, colour } => Shape::Text { text, at: moved(at), size, side, colour },
        }));
    }

    /// Saves the picture: PNG if the file's name ends in .png, else SVG.
    pub(crate) fn save(&self, file: &Path) -> Result<(), InputError> {
        if file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            let png = self.to_png().map_err(|error| InputError::new(file, error))?;
            return write(file, png);
        }
        write(file, self.to_svg())
    }

    pub(crate) fn to_svg(&self) -> String {
        let mut svg = String::new();
        let size = (self.width.round() as u32, self.height.round() as u32);
        self.draw(&SVGBackend::with_string(&mut svg, size).into_drawing_area(), 1.0, false);
        svg
    }

    fn to_png(&self) -> Result<Vec<u8>, png::EncodingError> {
        // A font that cannot be read leaves a picture without text; a test ensures that ours can be read.
        _ = plotters::style::register_font(FONT, FontStyle::Normal, FONT_FILE);
        let [width, height] = [self.width, self.height].map(|length| length.round() as usize * DENSITY);
        let mut large = vec![0; 3 * width * height * OVERSAMPLING * OVERSAMPLING];
        {
            let size = ((width * OVERSAMPLING) as u32, (height * OVERSAMPLING) as u32);
            let area = BitMapBackend::with_buffer(&mut large, size).into_drawing_area();
            self.draw(&area, (DENSITY * OVERSAMPLING) as f64, true);
        }
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder.write_header()?.write_image_data(&shrunk(&large, width))?;
        Ok(file)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64, bitmap: bool) {
        // Drawing to memory does not fail; even if it did, a picture would not be worth a panic.
        _ = area.fill(&WHITE);
        let px = |(x, y): At| ((x * scale).round() as i32, (y * scale).round() as i32);
        let thick = |width: f64| (width * scale).round().max(1.0) as u32;
        for shape in &self.shapes {
            match shape {
                Shape::Line { from, to, width, colour } => {
                    _ = area.draw(&PathElement::new([px(*from), px(*to)], colour.stroke_width(thick(*width))));
                }
                Shape::Area { corners, colour } => {
                    let corners: Vec<_> = corners.iter().map(|&corner| px(corner)).collect();
                    _ = area.draw(&Polygon::new(corners, *colour));
                }
                Shape::Rect { corners, colour } => {
                    let [from, mut to] = corners.map(px);
                    // Bitmaps include the last pixel, SVG does not.
                    if bitmap {
                        to = ((to.0 - 1).max(from.0), (to.1 - 1).max(from.1));
                    }
                    _ = area.draw(&Rectangle::new([from, to], colour.filled()));
                }
                Shape::Dot { centre, radius, colour } => {
                    _ = area.draw(&Circle::new(px(*centre), thick(*radius) as i32, colour.filled()));
                }
                Shape::Text { text, at, size, side, colour } => {
                    let (mut size, mut at) = (size * scale, *at);
                    if bitmap {
                        at.1 += SVG_TEXT_DROP * size / scale;
                        size *= SVG_TEXT_SCALE;
                    }
                    let style = (FONT, size).into_font().color(colour).pos(Pos::new(*side, VPos::Center));
                    _ = area.draw(&Text::new(text.as_str(), px(at), style));
                }
            }
        }
        _ = area.present();
    }
}

/// Halves a picture: each pixel becomes the mean of the four larger pixels that cover it. Plain loops, since tests draw
/// millions of pixels without optimisation.
fn shrunk(large: &[u8], width: usize) -> Vec<u8> {
    let mut small = Vec::with_capacity(large.len() / 4);
    for rows in large.chunks_exact(2 * 6 * width) {
        let (upper, lower) = rows.split_at(6 * width);
        for (upper, lower) in upper.chunks_exact(6).zip(lower.chunks_exact(6)) {
            for c in 0..3 {
                let sum = u16::from(upper[c]) + u16::from(upper[c + 3]) + u16::from(lower[c]) + u16::from(lower[c + 3]);
                small.push((sum / 4) as u8);
            }
        }
    }
    small
}

#[cfg(test)]
mod tests {
    use super::super::style::TITLE;
    use super::*;

    #[test]
    fn the_font_of_the_program_can_be_read_and_leaves_ink() {
        let mut blank = Picture::new(40.0, 20.0);
        let empty = blank.to_png().unwrap();
        blank.text("µ 8", (4.0, 10.0), TITLE);
        assert_ne!(blank.to_png().unwrap(), empty);
    }
}
