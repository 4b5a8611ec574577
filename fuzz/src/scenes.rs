//! World files: a world that is written and read back is unchanged, or the error takes one line.

use std::path::Path;

use eeruf_sim::{World, WorldParts};

use crate::one_line;

/// Reads a text; the schedules that it names do not exist.
pub fn check(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    let file = Path::new("/nowhere/world.toml");
    match WorldParts::from_text(file, text) {
        Ok(parts) => {
            let written = parts.to_toml();
            let again = WorldParts::from_text(file, &written).expect("what was written is a world");
            assert_eq!(again.to_toml(), written);
        }
        Err(error) => one_line(&error.to_string()),
    }
    match World::from_text(file, text) {
        Ok(world) => {
            let robots = world.robots();
            assert!(!robots.is_empty() && robots.iter().all(|robot| (1..=64).contains(&robot.sensors.len())));
        }
        Err(error) => {
            let lines = text.matches('\n').count() as u64 + 1;
            assert!(error.line().is_none_or(|line| (1..=lines).contains(&line)), "{error} of {lines} lines");
            one_line(&error.to_string());
        }
    }
}
