//! Text that fits the terminal: tables get wrapped cells, or become lists of each row's figures on a narrow terminal;
//! sentences are wrapped.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};

/// The least width of a column with its frame; a table with narrower columns becomes lists.
const LEAST_COLUMN: usize = 8;

/// Returns the text with no line longer than `width`.
pub(super) fn fit(text: &str, width: usize) -> String {
    let mut out = String::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        if !line.starts_with('|') {
            wrap_line(&mut out, line, width);
            continue;
        }
        let mut block = vec![line];
        while let Some(line) = lines.next_if(|line| line.starts_with('|')) {
            block.push(line);
        }
        if block.iter().all(|line| length(line) <= width) {
            block.iter().for_each(|line| push_line(&mut out, line));
        } else {
            fit_table(&mut out, &block, width);
        }
    }
    out
}

/// Fits a table in Markdown: header, rule and rows.
fn fit_table(out: &mut String, block: &[&str], width: usize) {
    let cells = |line: &&str| -> Vec<String> {
        line.trim().trim_matches('|').split('|').map(|cell| cell.trim_end().to_owned()).collect()
    };
    let (header, rows) = (cells(&block[0]), block.iter().skip(2).map(cells).collect::<Vec<_>>());
    if header.len() * LEAST_COLUMN > width {
        for row in rows {
            for (index, (name, cell)) in header.iter().zip(&row).enumerate() {
                let indent = if index == 0 { "" } else { "  " };
                wrap_line(out, &format!("{indent}{}: {}", name.trim(), cell.trim()), width);
            }
        }
        return;
    }
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width.try_into().unwrap_or(u16::MAX));
    table.set_header(header.iter().map(|cell| cell.trim()));
    for (index, column) in table.column_iter_mut().enumerate() {
        // Padded cells are right-aligned.
        if rows.iter().any(|row| row.get(index).is_some_and(|cell| cell.starts_with("  "))) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.add_rows(rows.iter().map(|row| row.iter().map(|cell| cell.trim()).collect::<Vec<_>>()));
    table.lines().for_each(|line| push_line(out, line.trim_end()));
}

/// Wraps one line; further lines are indented by two more.
pub(super) fn wrap_line(out: &mut String, line: &str, width: usize) {
    if length(line) <= width {
        return push_line(out, line);
    }
    let own = line.len() - line.trim_start().len();
    let indent = if own + 2 < width / 2 { own + 2 } else { 0 };
    let mut rest = line;
    let mut room = width;
    let mut before = 0;
    loop {
        let (head, tail) = cut(rest, room);
        push_line(out, &format!("{}{}", " ".repeat(before), head.trim_end()));
        rest = tail.trim_start();
        if rest.is_empty() {
            return;
        }
        (before, room) = (indent, width - indent);
    }
}

fn push_line(out: &mut String, line: &str) {
    out.push_str(line);
    out.push('\n');
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// Splits a text after at most `room` characters: at the last space, or within a longer word.
fn cut(text: &str, room: usize) -> (&str, &str) {
    let room = room.max(1);
    let Some((end, next)) = text.char_indices().nth(room) else { return (text, "") };
    if next == ' ' {
        return text.split_at(end);
    }
    let own = text.len() - text.trim_start().len();
    match text.get(..end).and_then(|head| head.rfind(' ')).filter(|&space| space > own) {
        Some(space) => text.split_at(space),
        None => text.split_at(end),
    }
}

#[cfg(test)]
mod tests {
    use super::fit;

    const TABLE: &str = "Three methods:\n\
        | method | wrong of all | wrong of accepted | a reason in words               |\n\
        |--------|--------------|-------------------|---------------------------------|\n\
        | eeruf  |        0.1 % |             0.0 % | crosstalk of 2 moves by 2000 us |\n";

    fn longest(text: &str) -> usize {
        text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
    }

    #[test]
    fn table_that_fits_stays_as_it_is() {
        assert_eq!(fit(TABLE, 80), TABLE);
    }

    #[test]
    fn every_width_holds_and_nothing_is_left_out() {
        for width in 20..80 {
            let narrow = fit(TABLE, width);
            assert!(longest(&narrow) <= width, "{width}\n{narrow}");
            // Words may be split in narrow columns.
            let letters = |text: &str| text.chars().filter(|c| c.is_alphanumeric()).count();
            assert!(letters(&narrow) >= letters(TABLE), "{width}\n{narrow}");
        }
        assert!(fit(TABLE, 30).contains("method: eeruf\n  wrong of all: 0.1 %\n"), "{}", fit(TABLE, 30));
    }

    #[test]
    fn words_longer_than_the_line_are_parted() {
        let narrow = fit(&"x".repeat(100), 40);
        assert_eq!((longest(&narrow), narrow.replace(['\n', ' '], "").len()), (40, 100));
    }
}
