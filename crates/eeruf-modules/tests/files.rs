//! Modules in files: names, tables and lists, and errors in them.

use eeruf_modules::{HC_SR04, Interface, JSN_SR04T, MB1010, ModulesFile, NoEcho, PING};
use serde::Deserialize;

#[derive(Debug, Deserialize)]
struct File {
    module: ModulesFile,
}

fn read(text: &str) -> Result<ModulesFile, String> {
    toml::from_str::<File>(text).map(|file| file.module).map_err(|error| error.message().to_owned())
}

#[test]
fn names_tables_and_lists_give_modules() {
    assert_eq!(read("module = \"hc-sr04\""), Ok(ModulesFile::All(HC_SR04)));
    assert_eq!(read("module = \"HC_SR04\""), Ok(ModulesFile::All(HC_SR04)));
    let table =
        "[module]\nlike = \"ping\"\nsees_to_m = 2.5\nrest_us = 30_000\ninterface = \"edge\"\nno_echo = \"silent\"";
    let mine = eeruf_modules::Module {
        sees_to_mm: 2_500,
        rest_us: 30_000,
        interface: Interface::Edge,
        no_echo: NoEcho::Silent,
        ..PING
    };
    assert_eq!(read(table), Ok(ModulesFile::All(mine)));
    let list = read("module = [\"hc-sr04\", { like = \"hc-sr04\", hold_us = 130_000 }]").unwrap();
    let holds = eeruf_modules::Module { no_echo: NoEcho::Holds { us: 130_000 }, ..HC_SR04 };
    assert_eq!(list, ModulesFile::Of(vec![HC_SR04, holds]));
    assert_eq!(list.list(2), Ok(vec![HC_SR04, holds]));
    let error = list.list(3).unwrap_err();
    assert_eq!(error, "module: 2 modules; expected one for all, or one for each of 3 sensors");
}

#[test]
fn wrong_modules_are_refused_by_key_value_and_expectation() {
    for (text, expected) in [
        ("module = \"bat\"", "module: no preset \"bat\"; expected polaroid-6500, hc-sr04, "),
        ("[module]\nsees_to_m = 2", "module: no `like`; expected the name"),
        ("[module]\nlike = \"ping\"\nsees = 2", "module: no figure `sees`; expected like, sees_to_m, "),
        ("[module]\nlike = \"ping\"\nsees_to_m = -1", "module: sees_to_m = -1; expected a number from 0 to 100"),
        ("[module]\nlike = \"ping\"\nsees_to_m = nan", "module: sees_to_m = NaN; expected a number from 0 to 100"),
        ("[module]\nlike = \"ping\"\nbeam = \"round\"", "module: beam = round; expected cut_at_90, continuous"),
        ("[module]\nlike = \"ping\"\nfrequency_hz = 0", "module: frequency_hz = 0; expected a number"),
        ("[module]\nlike = \"ping\"\nblanking_us = 20000", "module: blanking_us = 20000; expected less than 17483"),
        ("module = [\"ping\", 3]", "invalid type: integer `3`, expected a module's name"),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.starts_with(expected), "{text}: {error}");
    }
    let many = format!("module = [{}]", "\"ping\", ".repeat(65));
    assert!(read(&many).unwrap_err().starts_with("module: more than 64 modules"));
}

#[test]
fn names_that_people_use_are_taken_as_a_preset_or_answered() {
    let of = |name: &str| read(&format!("module = \"{name}\""));
    for (name, preset) in [("hcsr04", HC_SR04), ("AJ_SR04M", JSN_SR04T), ("LV-EZ1", MB1010), ("PING)))", PING)] {
        assert_eq!(of(name), Ok(ModulesFile::All(preset)));
    }
    for (name, why) in
        [("me007ys", "fires by a clock of its own"), ("tfmini", "sends light"), ("srf10", "command on I2C")]
    {
        let error = of(name).unwrap_err();
        assert!(error.contains(why) && error.contains("; expected polaroid-6500, hc-sr04"), "{error}");
    }
}
