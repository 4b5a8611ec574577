//! Tables that other programs write in forms of their own: Weka's ARFF, `LabVIEW`'s measurements, rows of SQL.

use std::collections::BTreeMap;

use super::rewriter::Rewritten;

/// A name or a text as a cell of a table parted by commas.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// A name without quotes around it, and the rest.
fn first_name(text: &str) -> Option<(String, &str)> {
    let text = text.trim_start();
    let quote = text.chars().next().filter(|letter| "'\"`[".contains(*letter));
    let (name, rest) = match quote {
        Some('[') => text[1..].split_once(']')?,
        Some(quote) => text[1..].split_once(quote)?,
        None => text.split_at(text.find([' ', '\t', '(', ',']).unwrap_or(text.len())),
    };
    (!name.is_empty()).then(|| (name.to_owned(), rest))
}

/// Weka's form: names as `@attribute front numeric`, then rows.
#[derive(Default)]
pub(super) struct Arff {
    names: Vec<String>,
    is_data: bool,
}

impl Arff {
    pub(super) fn is_in(start: &str) -> bool {
        let mut lines = start.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('%'));
        lines.next().is_some_and(|line| line.get(..9).is_some_and(|word| word.eq_ignore_ascii_case("@relation")))
    }

    pub(super) fn rewrite(&mut self, line: &str) -> Vec<String> {
        let text = line.trim();
        let (word, rest) = text.split_once([' ', '\t']).unwrap_or((text, ""));
        if self.is_data {
            let is_comment = text.is_empty() || text.starts_with('%');
            let cell = |cell: &str| if cell.trim() == "?" { "none".to_owned() } else { cell.replace('\'', "\"") };
            return (!is_comment)
                .then(|| text.split(',').map(cell).collect::<Vec<_>>().join(","))
                .into_iter()
                .collect();
        }
        if word.eq_ignore_ascii_case("@attribute") {
            self.names.extend(first_name(rest).map(|(name, _)| name));
        }
        self.is_data = word.eq_ignore_ascii_case("@data");
        let header = self.names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(",");
        self.is_data.then_some(header).into_iter().collect()
    }
}

/// `LabVIEW`'s text: two headers, each with its end, and a table.
#[derive(Default)]
pub(super) struct LabView {
    is_table: bool,
    has_names: bool,
}

impl LabView {
    pub(super) fn rewrite(&mut self, line: &str) -> Option<String> {
        let text = line.trim_end();
        if text == "***End_of_Header***" || (self.is_table && text.starts_with("X_Value\t")) {
            self.is_table = true;
            self.has_names = text.starts_with("X_Value\t");
            let names = text.strip_prefix("X_Value\t")?;
            return Some(format!("time\t{}", names.strip_suffix("\tComment").unwrap_or(names)));
        }
        (self.has_names && !text.is_empty()).then(|| text.to_owned())
    }
}

/// Rows of one table as `SQLite`'s `.dump` and `mysqldump` write them.
pub(super) struct SqlDump {
    /// The names of each table's columns.
    tables: Vec<(String, Vec<String>)>,
    /// A table is being described, a column a line.
    is_open: bool,
    /// The table whose rows are read: the one with most of them in the beginning.
    own: String,
    has_header: bool,
}

const INSERT: &str = "INSERT INTO ";

impl SqlDump {
    pub(super) fn of(start: &str) -> Option<Self> {
        let mut counts = BTreeMap::new();
        for line in start.lines() {
            if line.starts_with(['{', '[']) {
                return None;
            }
            let row = line.trim().strip_prefix(INSERT).filter(|row| row.contains("VALUES"));
            if let Some((table, _)) = row.and_then(first_name).filter(|(table, _)| !table.starts_with("sqlite_")) {
                *counts.entry(table).or_insert(0) += 1;
            }
        }
        let (own, _) = counts.into_iter().max_by_key(|(_, count)| *count)?;
        Some(Self { tables: vec![], is_open: false, own, has_header: false })
    }

    pub(super) fn rewrite(&mut self, line: &str) -> Rewritten {
        let text = line.trim();
        if text.starts_with(INSERT) {
            return inserted(text).map_or(Rewritten::Misfit, |(table, names, rows)| self.rows(&table, names, rows));
        }
        if let Some((_, rest)) = text.split_once("CREATE TABLE ") {
            let rest = rest.strip_prefix("IF NOT EXISTS ").unwrap_or(rest);
            let described =
                first_name(rest).and_then(|(name, rest)| Some((name, rest.trim_start().strip_prefix('(')?)));
            let Some((name, columns)) = described else { return Rewritten::Nothing };
            let whole = columns.trim_end().strip_suffix(");");
            self.is_open = whole.is_none();
            self.tables.push((name, vec![]));
            whole.unwrap_or(columns).split(',').for_each(|column| self.column(column));
        } else if self.is_open {
            self.is_open = !text.starts_with(')');
            if self.is_open {
                self.column(text);
            }
        } else if text.contains("VALUES") || text.ends_with(");") {
            return Rewritten::Misfit;
        }
        Rewritten::Nothing
    }

    /// Notes a column by its description.
    fn column(&mut self, text: &str) {
        const OTHERS: [&str; 7] = ["PRIMARY", "KEY", "UNIQUE", "CONSTRAINT", "FOREIGN", "CHECK", "INDEX"];
        let name =
            first_name(text).map(|(name, _)| name).filter(|name| !OTHERS.contains(&name.to_uppercase().as_str()));
        // The second part of a type, as of `DECIMAL(5, 2)`.
        let name = name.filter(|name| !name.starts_with(|letter: char| letter.is_ascii_digit()));
        if let Some((_, names)) = self.tables.last_mut() {
            names.extend(name);
        }
    }

    fn rows(&mut self, table: &str, names: Vec<String>, rows: Vec<String>) -> Rewritten {
        if table != self.own {
            // One that was described, or SQLite's own; else its name is damaged.
            let is_other = table.starts_with("sqlite_") || self.tables.iter().any(|(known, _)| known == table);
            return if is_other { Rewritten::Nothing } else { Rewritten::Misfit };
        }
        let mut lines = vec![];
        if !self.has_header {
            let known = self.tables.iter().find(|known| known.0 == table).map(|known| known.1.clone());
            let names = if names.is_empty() { known.unwrap_or_default() } else { names };
            let header = names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(",");
            lines.extend((!names.is_empty()).then_some(header));
            self.has_header = true;
        }
        lines.extend(rows);
        Rewritten::Lines(lines)
    }
}

/// The table, the names of columns if they are given, and the rows of `INSERT INTO readings VALUES(0.1,'front',40);`.
fn inserted(text: &str) -> Option<(String, Vec<String>, Vec<String>)> {
    let (table, rest) = first_name(text.strip_prefix(INSERT)?)?;
    let (names, rest) = rest.split_once("VALUES")?;
    let names: Vec<_> = match names.trim().strip_prefix('(') {
        Some(inner) => {
            inner.strip_suffix(')')?.split(',').map(|name| Some(first_name(name)?.0)).collect::<Option<_>>()?
        }
        None if names.trim().is_empty() => vec![],
        None => return None,
    };
    let (mut rows, mut cells, mut cell) = (vec![], vec![], String::new());
    let (mut is_text, mut is_open) = (false, false);
    let mut letters = rest.trim().strip_suffix(';')?.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '\'' if is_text && letters.peek() == Some(&'\'') => cell.extend(letters.next()),
            '\'' => is_text = !is_text,
            _ if is_text => cell.push(letter),
            '(' if !is_open => is_open = true,
            ',' | ')' if is_open => {
                cells.push(std::mem::take(&mut cell));
                if letter == ')' {
                    let row: Vec<_> = cells.drain(..).map(|cell| quoted(cell.trim())).collect();
                    rows.push(row.join(","));
                    is_open = false;
                }
            }
            ',' | ' ' if !is_open => {}
            _ if is_open => cell.push(letter),
            _ => return None,
        }
    }
    (!is_text && !is_open && !rows.is_empty()).then_some((table, names, rows))
}
