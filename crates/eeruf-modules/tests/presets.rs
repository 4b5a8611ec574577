//! The presets are complete: every figure has one source, and the figures agree with each other.

use eeruf_modules::{Gain, HC_SR04, KEYS, Module, NoEcho, PRESETS, Source, Value, find};

#[test]
fn every_figure_has_exactly_one_source() {
    for preset in &PRESETS {
        for key in &KEYS {
            let times = preset.sources.iter().filter(|(keys, _)| keys.contains(&key.name)).count();
            assert_eq!(times, 1, "{}: {}", preset.title, key.name);
        }
        let known = |name: &&str| KEYS.iter().any(|key| key.name == *name);
        assert!(preset.sources.iter().all(|(keys, _)| keys.iter().all(known)), "{}", preset.title);
        assert!(preset.sources.iter().any(|(_, source)| matches!(source, Source::Document(_))), "{}", preset.title);
        assert_eq!(preset.source("size"), None, "{}", preset.title);
    }
}

#[test]
fn figures_of_each_preset_agree_with_each_other() {
    for preset in &PRESETS {
        let module = preset.module;
        assert_eq!(module.check(), Ok(()), "{}", preset.title);
        assert_eq!(find(module.name), Some(module));
        assert!(module.hears_to_mm > module.sees_to_mm, "{}", preset.title);
        // A band is as wide as the burst's spectrum, rounded.
        let width = f64::from(module.frequency_hz) / f64::from(module.burst_cycles);
        assert!((f64::from(module.bandwidth_hz) - width).abs() <= 0.5, "{}", preset.title);
        // A held line stays high for longer than any echo takes, at least in slightly warmer air, and is free before
        // the next trigger.
        if let NoEcho::Holds { us } = module.no_echo {
            assert!(100 * us > 99 * module.range_us() && us < module.rest_us, "{}", preset.title);
        }
        assert!(module.report_us <= module.rest_us, "{}", preset.title);
    }
}

#[test]
fn a_figure_that_is_set_is_the_figure_that_is_read() {
    for preset in &PRESETS {
        let mut other = Module { gain: Gain::Stepped, no_echo: NoEcho::Holds { us: 1 }, ..HC_SR04 };
        for key in &KEYS {
            let value = key.of(preset.module);
            // A module without a line has none to hold.
            if (key.name, value) != ("hold_us", Value::Number(0.0)) {
                other.set(key.name, value).unwrap();
            }
            assert_eq!(key.of(&other), value, "{}: {}", preset.title, key.name);
        }
        assert_eq!(Module { name: preset.module.name, ..other }, *preset.module);
    }
}
