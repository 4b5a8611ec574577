//! The colours and sizes of all pictures, and round numbers for their grids.

use plotters::style::{Color, RGBAColor, RGBColor};

pub(crate) const ACCEPTED: RGBColor = RGBColor(0x4c, 0x9f, 0x70);
pub(crate) const REJECTED: RGBColor = RGBColor(0xd1, 0x49, 0x5b);
pub(crate) const UNCOMPARED: RGBColor = RGBColor(0xed, 0xc7, 0x6a);
pub(crate) const SILENT: RGBColor = RGBColor(0xe4, 0xe6, 0xea);
pub(crate) const LISTENING: RGBColor = RGBColor(0xb9, 0xd0, 0xe8);
pub(crate) const INK: RGBColor = RGBColor(0x2b, 0x2d, 0x33);
/// Sizes of text: titles, captions, and numbers at axes.
pub(crate) const TITLE: f64 = 18.0;
pub(crate) const CAPTION: f64 = 15.0;
pub(crate) const SMALL: f64 = 13.0;

/// Ten colours that are easy to tell apart, none too pale for a thin line.
pub(crate) const SENSORS: [RGBColor; 10] = [
    RGBColor(0x1f, 0x6f, 0xb4),
    RGBColor(0xe6, 0x7e, 0x22),
    RGBColor(0x2c, 0x96, 0x4b),
    RGBColor(0xc0, 0x39, 0x9f),
    RGBColor(0x8c, 0x5a, 0x3c),
    RGBColor(0x17, 0xa9, 0xc0),
    RGBColor(0x6a, 0x4c, 0xb8),
    RGBColor(0xb5, 0x9b, 0x12),
    RGBColor(0xcf, 0x2e, 0x3f),
    RGBColor(0x5a, 0x60, 0x6b),
];

/// A sensor's colour; colours repeat after ten sensors.
pub(crate) fn sensor_colour(sensor: usize) -> RGBAColor {
    SENSORS[sensor % SENSORS.len()].to_rgba()
}

/// Returns a round distance between grid lines: about `lines` of them over this range.
pub(crate) fn grid_step(range: f64, lines: f64) -> f64 {
    let rough = range / lines;
    let magnitude = 10_f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|n| n * magnitude).find(|&step| step >= rough).unwrap_or(rough)
}

/// Formats a number at an axis, without rounding errors of added steps.
pub(crate) fn tick_label(value: f64, step: f64) -> String {
    let digits = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grid_lines_stand_at_round_numbers() {
        assert_eq!(grid_step(100.0, 10.0), 10.0);
        assert_eq!(grid_step(130_000.0, 10.0), 20_000.0);
        assert_eq!(tick_label(0.300_000_1, 0.1), "0.3");
        assert_eq!(tick_label(40.0, 20.0), "40");
    }
}
