//! Text that fits the terminal: tables by wrapped headers, then as several tables, then by fewer columns; sentences by
//! wrapping.

/// The least width at which a table that does not fit becomes several; below it, columns are left out.
const SPLIT_FROM: usize = 60;

/// A table in Markdown, taken apart.
struct Table<'a> {
    header: Vec<&'a str>,
    rows: Vec<Vec<&'a str>>,
    /// Columns whose cells stand at the right.
    is_right: Vec<bool>,
}

/// Returns the text with no line longer than `width`. A table that does not fit becomes several; on a narrow
/// terminal it loses columns instead, and a line after it names them.
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
        } else if let Some(table) = Table::parse(&block) {
            table.write(&mut out, width);
        } else {
            block.iter().for_each(|line| wrap_line(&mut out, line, width));
        }
    }
    out
}

/// Wraps one line; what follows the first is indented by two more.
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

/// Parts a text after at most `room` characters: at the last space, or within a word that is longer.
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

fn longest_word(text: &str) -> usize {
    text.split(' ').map(length).max().unwrap_or(0)
}

impl<'a> Table<'a> {
    fn parse(block: &[&'a str]) -> Option<Self> {
        let cells = |line: &'a str| -> Vec<&'a str> {
            line.trim().trim_start_matches('|').trim_end_matches('|').split('|').collect()
        };
        let [header, rule, rows @ ..] = block else { return None };
        if !rule.chars().all(|mark| "|-: ".contains(mark)) {
            return None;
        }
        let header = cells(header);
        let rows: Vec<_> = rows.iter().map(|row| cells(row)).collect();
        if rows.iter().any(|row| row.len() != header.len()) {
            return None;
        }
        let is_padded = |cell: &&str| cell.starts_with("  ") && !cell.trim().is_empty();
        let is_right = (0..header.len()).map(|k| rows.iter().map(|row| &row[k]).any(is_padded)).collect();
        let trimmed = |row: Vec<&'a str>| row.into_iter().map(str::trim).collect();
        Some(Self { header: trimmed(header), rows: rows.into_iter().map(trimmed).collect(), is_right })
    }

    fn natural(&self, column: usize) -> usize {
        self.longest_cell(column).max(length(self.header[column]))
    }

    fn longest_cell(&self, column: usize) -> usize {
        self.rows.iter().map(|row| length(row[column])).max().unwrap_or(0)
    }

    /// The frame, and the columns of each table that is written, with their widths: one table if it fits with wrapped
    /// headers, else several, each with the first column.
    fn arranged(&self, width: usize) -> (Frame, Vec<Vec<(usize, usize)>>) {
        // A column that is wider than the rest of the line gets wrapped cells.
        let least = |k: usize| self.longest_cell(k).max(longest_word(self.header[k])).max(3);
        let first = least(0).min(width / 2);
        let all: Vec<_> = (0..self.header.len()).map(|k| (k, least(k))).collect();
        let fits = |frame: &Frame| frame.total(&all) <= width;
        if let Some(frame) = [Frame::Bars, Frame::Gaps(2), Frame::Gaps(1)].into_iter().find(fits) {
            return (frame, vec![all]);
        }
        let frame = Frame::Gaps(2);
        let mut groups = vec![vec![(0, first)]];
        for (k, least) in all.into_iter().skip(1) {
            let column = (k, least.min(width - first - 2));
            match groups.last_mut() {
                Some(group) if frame.total(group) + 2 + column.1 <= width => group.push(column),
                _ => groups.push(vec![(0, first), column]),
            }
        }
        (frame, groups)
    }

    fn write(&self, out: &mut String, width: usize) {
        let (frame, mut groups) = self.arranged(width);
        let left_out = if width < SPLIT_FROM { groups.split_off(1) } else { vec![] };
        for (number, group) in groups.iter_mut().enumerate() {
            self.widen(frame, group, width);
            if number > 0 {
                out.push('\n');
            }
            self.write_row(out, &self.header, frame, group);
            let rule: Vec<_> = group.iter().map(|(_, width)| "-".repeat(*width)).collect();
            let rule = frame.line(&rule);
            push_line(out, &if frame == Frame::Bars { rule.replace(' ', "-") } else { rule });
            for row in &self.rows {
                self.write_row(out, row, frame, group);
            }
        }
        let names: Vec<_> = left_out.iter().flat_map(|group| &group[1..]).map(|&(k, _)| self.header[k]).collect();
        if !names.is_empty() {
            wrap_line(out, &format!("Left out at {width} columns: {}; --wide prints all", names.join(", ")), width);
        }
    }

    /// Gives the columns what the line has left.
    fn widen(&self, frame: Frame, group: &mut [(usize, usize)], width: usize) {
        while frame.total(group) < width {
            let lacks = |(k, width): &(usize, usize)| self.natural(*k).saturating_sub(*width);
            let Some(column) = group.iter_mut().max_by_key(|column| lacks(column)).filter(|column| lacks(column) > 0)
            else {
                break;
            };
            column.1 += 1;
        }
    }

    fn write_row(&self, out: &mut String, row: &[&str], frame: Frame, group: &[(usize, usize)]) {
        let wrap = |&(k, width): &(usize, usize)| {
            let mut lines = vec![];
            let mut rest: &str = row[k];
            while !rest.is_empty() {
                let (head, tail) = cut(rest, width);
                lines.push(head.trim_end().to_owned());
                rest = tail.trim_start();
            }
            lines
        };
        let cells: Vec<Vec<String>> = group.iter().map(wrap).collect();
        let height = cells.iter().map(Vec::len).max().unwrap_or(0).max(1);
        for line in 0..height {
            let padded = |(cell, &(k, width)): (&Vec<String>, &(usize, usize))| {
                let text = cell.get(line).map_or("", String::as_str);
                if self.is_right[k] { format!("{text:>width$}") } else { format!("{text:<width$}") }
            };
            let row: Vec<_> = cells.iter().zip(group).map(padded).collect();
            push_line(out, &frame.line(&row));
        }
    }
}

/// The space between columns.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Frame {
    /// Bars, as in Markdown.
    Bars,
    /// A number of spaces.
    Gaps(usize),
}

impl Frame {
    fn total(self, columns: &[(usize, usize)]) -> usize {
        let cells: usize = columns.iter().map(|(_, width)| width).sum();
        match self {
            Self::Bars => cells + 3 * columns.len() + 1,
            Self::Gaps(gap) => cells + gap * columns.len().saturating_sub(1),
        }
    }

    fn line(self, cells: &[String]) -> String {
        match self {
            Self::Bars => format!("| {} |", cells.join(" | ")),
            Self::Gaps(gap) => cells.join(&" ".repeat(gap)).trim_end().to_owned(),
        }
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
    fn header_wraps_before_cells_do() {
        let narrow = fit(TABLE, 66);
        assert!(longest(&narrow) <= 66 && narrow.contains("| crosstalk of 2 moves by 2000 us |"), "{narrow}");
        assert!(!narrow.contains("Left out"), "{narrow}");
    }

    #[test]
    fn every_width_holds_and_names_what_it_leaves_out() {
        for width in 20..80 {
            let narrow = fit(TABLE, width);
            assert!(longest(&narrow) <= width, "{width}\n{narrow}");
            let joined = narrow.split_whitespace().collect::<Vec<_>>().join(" ");
            for name in ["method", "accepted", "reason"] {
                assert!(joined.contains(name), "{width}: {name}\n{narrow}");
            }
        }
        assert!(fit(TABLE, 30).contains("Left out at 30 columns"), "{}", fit(TABLE, 30));
    }

    #[test]
    fn words_longer_than_the_line_are_parted() {
        let narrow = fit(&"x".repeat(100), 40);
        assert_eq!((longest(&narrow), narrow.replace(['\n', ' '], "").len()), (40, 100));
    }
}
