//! `library.properties` as the IDE and the Library Manager want it:
//! <https://arduino.github.io/arduino-cli/latest/library-specification/>.

/// The categories that there are.
const CATEGORIES: [&str; 9] = [
    "Display",
    "Communication",
    "Signal Input/Output",
    "Sensors",
    "Device Control",
    "Timing",
    "Data Storage",
    "Data Processing",
    "Other",
];
const REQUIRED: [&str; 9] =
    ["name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures"];

/// Looks at the properties; the version.
pub(super) fn check(properties: &str) -> Result<&str, String> {
    let value = |key: &str| {
        let found = properties.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
        found
            .filter(|value| !value.trim().is_empty())
            .ok_or_else(|| format!("library.properties: {key}: missing or empty"))
    };
    for key in REQUIRED {
        value(key)?;
    }
    let category = value("category")?;
    if !CATEGORIES.contains(&category) {
        return Err(format!("library.properties: category={category}; expected one of {}", CATEGORIES.join(", ")));
    }
    let maintainer = value("maintainer")?;
    if !(maintainer.contains('<') && maintainer.ends_with('>') && maintainer.contains('@')) {
        return Err(format!("library.properties: maintainer={maintainer}; expected a name and <address>"));
    }
    let version = value("version")?;
    let is_number = |part: &str| part.parse::<u32>().is_ok();
    if version.split('.').count() != 3 || !version.split('.').all(is_number) {
        return Err(format!("library.properties: version={version}; expected three numbers, as 0.1.0"));
    }
    Ok(version)
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn properties_are_complete_and_wrong_ones_named() {
        let properties = include_str!("../../../c/arduino/library.properties");
        assert!(check(properties).is_ok(), "{:?}", check(properties));
        for (from, to, expected) in [
            ("sentence=", "sentense=", "sentence: missing or empty"),
            ("category=Sensors", "category=Sonars", "category=Sonars; expected one of Display"),
            ("version=0.", "version=", "expected three numbers"),
            ("<", "", "expected a name and <address>"),
        ] {
            let error = check(&properties.replacen(from, to, 1)).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }
}
