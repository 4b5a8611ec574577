//! Prints docs/reference/modules.md's tables: modules by interface, limits, and the source of each figure.

use eeruf_modules::{Interface, KEYS, Module, NoEcho, PRESETS, Preset, Source, Value};

/// Formats a value for a table.
fn shown(value: Value<'_>) -> String {
    match value {
        Value::Number(number) => format!("{number}"),
        Value::Word(word) => format!("`{word}`"),
    }
}

fn without_echo(module: &Module) -> String {
    match module.no_echo {
        NoEcho::Holds { us } => format!("holds its line for {} ms", f64::from(us) / 1e3),
        NoEcho::Silent => "no edge".to_owned(),
        NoEcho::Reports => "reports none".to_owned(),
    }
}

fn modules_of(interface: Interface) -> impl Iterator<Item = &'static Preset> {
    PRESETS.iter().filter(move |preset| preset.module.interface == interface)
}

pub(crate) fn main(_: &[String]) -> crate::Answer {
    println!("| interface | module | sees, m | rest, ms | without an echo |");
    println!("|---|---|---:|---:|---|");
    for (word, interface) in Interface::NAMES {
        for preset in modules_of(interface) {
            let Preset { module, title, .. } = preset;
            let (sees_m, rest_ms) = (f64::from(module.sees_to_mm) / 1e3, f64::from(module.rest_us) / 1e3);
            let what = without_echo(module);
            println!("| `{word}` | `{}`, {title} | {sees_m} | {rest_ms} | {what} |", module.name);
        }
    }
    println!("\n| key | meaning |");
    println!("|---|---|");
    println!("| `like` | the module that a table differs from |");
    for key in &KEYS {
        println!("| `{}` | {} |", key.name, key.about);
    }
    for preset in &PRESETS {
        println!("\n### {}: `{}`\n", preset.title, preset.module.name);
        println!("| figure | value | source |");
        println!("|---|---:|---|");
        for key in &KEYS {
            let source = match preset.source(key.name) {
                Some(Source::Document(text)) => text.to_owned(),
                Some(Source::Choice(why)) => format!("*choice*: {why}"),
                None => "none".to_owned(),
            };
            println!("| `{}` | {} | {source} |", key.name, shown(key.of(preset.module)));
        }
    }
    Ok(())
}
