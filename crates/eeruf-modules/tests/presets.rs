//! The figures of the presets agree with each other.

use eeruf_modules::{Gain, HC_SR04, KEYS, Module, NoEcho, PRESETS, Value, find};

#[test]
fn figures_of_each_preset_agree_with_each_other() {
    for module in PRESETS {
        assert_eq!(module.check(), Ok(()), "{}", module.name);
        assert_eq!(find(module.name), Some(module));
        assert!(module.hears_to_mm > module.sees_to_mm, "{}", module.name);
        // A band is as wide as the burst's spectrum, rounded.
        let width = f64::from(module.frequency_hz) / f64::from(module.burst_cycles);
        assert!((f64::from(module.bandwidth_hz) - width).abs() <= 0.5, "{}", module.name);
        // A held line stays high for longer than any echo takes, at least in slightly warmer air, and is free before
        // the next trigger.
        if let NoEcho::Holds { us } = module.no_echo {
            assert!(100 * us > 99 * module.range_us() && us < module.rest_us, "{}", module.name);
        }
        assert!(module.report_us <= module.rest_us, "{}", module.name);
    }
}

#[test]
fn a_figure_that_is_set_is_the_figure_that_is_read() {
    for module in PRESETS {
        let mut other = Module { gain: Gain::Stepped, no_echo: NoEcho::Holds { us: 1 }, ..HC_SR04 };
        for key in &KEYS {
            let value = key.of(module);
            // A module without a line has none to hold.
            if (key.name, value) != ("hold_us", Value::Number(0.0)) {
                other.set(key.name, value).unwrap();
            }
            assert_eq!(key.of(&other), value, "{}: {}", module.name, key.name);
        }
        assert_eq!(Module { name: module.name, ..other }, *module);
    }
}
