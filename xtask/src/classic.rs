//! ES modules as one classic script, so that a page needs no server: browsers load no modules from a disk.
//!
//! No bundler is needed for how the page is written: each import stands on one line and takes names as they are from a
//! file beside it, exports are functions, classes and constants where they are made, and no two modules need each
//! other. Each module becomes a function that returns what it exports. Anything else is an error here.

/// A module and all that it imports, each before what needs it.
pub(crate) fn classic_script<'a>(entry: &str, source: &dyn Fn(&str) -> Option<&'a str>) -> Result<String, String> {
    let mut script = Script { source, begun: Vec::new(), done: Vec::new(), text: "\"use strict\";\n".to_owned() };
    script.add(entry)?;
    Ok(format!("(() => {{\n{}}})();\n", script.text))
}

struct Script<'s, 'a> {
    source: &'s dyn Fn(&str) -> Option<&'a str>,
    begun: Vec<String>,
    done: Vec<String>,
    text: String,
}

impl Script<'_, '_> {
    fn add(&mut self, name: &str) -> Result<(), String> {
        if self.done.iter().any(|done| done == name) {
            return Ok(());
        }
        if self.begun.iter().any(|begun| begun == name) {
            return Err(format!("{name} needs itself by way of {}", self.begun.join(", ")));
        }
        self.begun.push(name.to_owned());
        let source = (self.source)(name).ok_or_else(|| format!("no module {name}"))?;
        let (mut body, mut exports) = (String::new(), Vec::new());
        for line in source.lines() {
            if let Some(import) = line.strip_prefix("import ") {
                let parts = import.split_once(" from \"./").filter(|(names, _)| !names.contains(" as "));
                let from = parts.and_then(|(names, from)| Some((names, from.strip_suffix("\";")?)));
                let (names, from) = from.filter(|(names, _)| names.starts_with('{')).ok_or_else(|| {
                    format!("{name}: {line}; expected import {{ names }} from \"./file.js\"; on one line")
                })?;
                self.add(from)?;
                body += &format!("const {names} = {};\n", variable(from));
            } else if let Some(export) = line.strip_prefix("export ") {
                let given = given_name(export)
                    .ok_or_else(|| format!("{name}: {line}; expected to export a function, a class or a const"))?;
                exports.push(given);
                body += &format!("{export}\n");
            } else {
                body += &format!("{line}\n");
            }
        }
        let (variable, exports) = (variable(name), exports.join(", "));
        self.text += &format!("const {variable} = (() => {{\n{body}return {{ {exports} }};\n}})();\n");
        self.done.push(name.to_owned());
        Ok(())
    }
}

/// Name of a module in the script.
fn variable(module: &str) -> String {
    module.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_")
}

/// The name that a line at the margin gives to something.
fn given_name(line: &str) -> Option<&str> {
    let words = ["async function ", "function ", "class ", "const "];
    let rest = words.iter().find_map(|word| line.strip_prefix(word))?;
    let end = rest.find(|letter: char| !(letter.is_alphanumeric() || letter == '_')).unwrap_or(rest.len());
    rest.get(..end).filter(|name| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn script_of(files: &[(&str, &str)]) -> Result<String, String> {
        let source = |name: &str| files.iter().find(|file| file.0 == name).map(|file| file.1);
        classic_script("main.js", &source)
    }

    #[test]
    fn what_is_imported_comes_first_and_once() {
        let main = "import { a } from \"./a.js\";\nimport { b } from \"./b.js\";\na(b);";
        let b = "import { a } from \"./a.js\";\nexport const b = a;";
        let script = script_of(&[("main.js", main), ("a.js", "export function a() {}"), ("b.js", b)]).unwrap();
        let expected = "const a_js = (() => {\nfunction a() {}\nreturn { a };\n})();\n\
                        const b_js = (() => {\nconst { a } = a_js;\nconst b = a;\nreturn { b };\n})();\n\
                        const main_js = (() => {\nconst { a } = a_js;\nconst { b } = b_js;\na(b);\n\
                        return {  };\n})();\n";
        assert_eq!(script, format!("(() => {{\n\"use strict\";\n{expected}}})();\n"));
    }

    #[test]
    fn modules_that_need_each_other_are_an_error() {
        let a = "import { b } from \"./main.js\";";
        let error = script_of(&[("main.js", "import { a } from \"./a.js\";"), ("a.js", a)]).unwrap_err();
        assert_eq!(error, "main.js needs itself by way of main.js, a.js");
    }

    #[test]
    fn what_is_no_plain_import_or_export_is_an_error() {
        let lines =
            ["import { a as b } from \"./a.js\";", "import \"./a.js\";", "import a from \"./a.js\";", "export { a };"];
        for line in lines {
            assert!(script_of(&[("main.js", line), ("a.js", "")]).is_err(), "{line}");
        }
    }
}
