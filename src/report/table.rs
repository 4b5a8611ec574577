//! Tables in Markdown and without lines, and the mark for a missing figure.

use comfy_table::{CellAlignment, Table, presets};

/// Formats a table in Markdown: text columns at the left, numbers at the right.
pub(crate) fn markdown<S: AsRef<str>>(header: &[S], rows: impl IntoIterator<Item = Vec<String>>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_header(header.iter().map(AsRef::as_ref));
    table.add_rows(rows);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// A column: its header, and its cell in a row.
pub(crate) type Column<R> = (&'static str, fn(&R) -> String);

/// Formats a row for each name: columns that only need the name, then those of its figures.
pub(crate) fn by_name<R>(named: &[Column<str>], columns: &[Column<R>], rows: &[(String, R)]) -> Table {
    let headers = named.iter().map(|(header, _)| *header).chain(columns.iter().map(|(header, _)| *header));
    let cells = |(name, row): &(String, R)| {
        named.iter().map(|(_, cell)| cell(name)).chain(columns.iter().map(|(_, cell)| cell(row))).collect()
    };
    markdown(&headers.collect::<Vec<_>>(), rows.iter().map(cells))
}

/// A table without lines.
pub(crate) fn plain() -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table
}

/// Formats a count of things.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Formats a figure, or a dash if there is none.
pub(crate) fn or_dash<T>(figure: Option<T>, in_words: impl FnOnce(T) -> String) -> String {
    figure.map_or_else(|| "-".to_owned(), in_words)
}
