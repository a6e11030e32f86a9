//! Tables that keep to the width of the terminal.

use crate::screen::{bold, dim, one_line, width};
use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Width, presets};
use std::fmt;

/// A column may be made as narrow as this before a less important one is left out. [characters]
const LEAST_COLUMN: usize = 14;
/// Blanks around the text of a column. [characters]
const PADDING: usize = 2;

/// A cell: text of anybody's, on one line.
#[derive(Debug, Clone)]
pub struct Cell {
    text: String,
    right: bool,
}

impl Cell {
    /// A cell with text.
    pub fn new(value: impl ToString) -> Self {
        Self { text: one_line(&value.to_string()), right: false }
    }
}

/// A cell with a number, to the right.
pub fn number(value: impl ToString) -> Cell {
    Cell { right: true, ..Cell::new(value) }
}

/// A table with a header. One column, the first unless another is named, names the row: it is never left out, and wrapped at the
/// very last.
#[derive(Debug, Clone)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<Cell>>,
    /// Columns that may be left out, the least important first.
    spare: Vec<usize>,
    /// The column that names the row.
    name: usize,
    /// The column that is not wrapped while there is one that may be left out.
    whole: Option<usize>,
}

/// A table with a header.
pub fn table(header: &[&str]) -> Table {
    let header = header.iter().map(|name| one_line(name)).collect();
    Table { header, rows: Vec::new(), spare: Vec::new(), name: 0, whole: None }
}

impl Table {
    /// The same with columns that may be left out where the terminal is narrow, the least important first.
    #[must_use]
    pub fn without_first(mut self, names: &[&str]) -> Self {
        let position = |name: &&str| self.header.iter().position(|other| other == name);
        self.spare = names.iter().filter_map(position).collect();
        self
    }

    /// The same with this column to name the row.
    #[must_use]
    pub fn named_by(mut self, name: &str) -> Self {
        self.name = self.header.iter().position(|other| other == name).unwrap_or(0);
        self
    }

    /// The same with this column whole: others are left out before it is wrapped.
    #[must_use]
    pub fn whole(mut self, name: &str) -> Self {
        self.whole = self.header.iter().position(|other| other == name);
        self
    }

    /// Adds a row.
    pub fn add_row(&mut self, row: impl IntoIterator<Item = Cell>) {
        self.rows.push(row.into_iter().collect());
    }

    /// The widest cell of a column. [characters]
    fn widest(&self, at: usize) -> usize {
        self.rows.iter().filter_map(|row| row.get(at)).map(|cell| cell.text.chars().count()).max().unwrap_or(0)
    }

    /// Whether a column holds numbers, or nothing in their place.
    fn holds_numbers(&self, at: usize) -> bool {
        self.rows.iter().filter_map(|row| row.get(at)).all(|cell| cell.right || cell.text == "-")
    }

    /// The longest word of a header: it may be wrapped between words.
    fn word(&self, at: usize) -> usize {
        self.header[at].split(' ').map(|word| word.chars().count()).max().unwrap_or(0)
    }

    /// What columns take at least. [characters]
    fn least(&self, shown: &[usize]) -> usize {
        let of = |at: usize| match self.widest(at).max(self.header[at].chars().count()) {
            natural if at == self.name || Some(at) == self.whole => natural,
            // Headers of numbers are wrapped to make room for it.
            _ if self.whole.is_some() && self.holds_numbers(at) => self.widest(at).max(self.word(at)),
            natural => natural.min(LEAST_COLUMN),
        };
        // A blank between columns, and one at each end: what is to be whole has no room to give.
        let between = if self.whole.is_some() { shown.len() + 1 } else { 0 };
        between + shown.iter().map(|&at| PADDING + of(at)).sum::<usize>()
    }

    /// Columns that fit, and those left out.
    fn fitting(&self, width: usize) -> (Vec<usize>, Vec<usize>) {
        let mut shown: Vec<usize> = (0..self.header.len()).collect();
        let mut left_out = Vec::new();
        for &spare in &self.spare {
            if self.least(&shown) <= width {
                break;
            }
            shown.retain(|&at| at != spare);
            left_out.push(spare);
        }
        (shown, left_out)
    }

    /// Whether a column is shown in the terminal's width.
    pub fn shows(&self, name: &str) -> bool {
        self.fitting(width()).0.iter().any(|&at| self.header[at] == name)
    }

    /// The table in so many columns of characters.
    fn render(&self, width: usize) -> String {
        let (shown, left_out) = self.fitting(width);
        let mut table = comfy_table::Table::new();
        // A line under the header and none between rows: a table of 20 scenarios fits on a screen.
        table.load_style(presets::NOTHING.header_separator(LineStyle::new(' ', '\u{2500}', '\u{2500}', ' ')));
        table.set_content_arrangement(ContentArrangement::Dynamic).set_width(u16::try_from(width).unwrap_or(u16::MAX));
        table.set_header(shown.iter().map(|&at| self.header[at].clone()));
        for row in &self.rows {
            let cells = shown.iter().filter_map(|&at| row.get(at)).map(|cell| {
                let alignment = if cell.right { CellAlignment::Right } else { CellAlignment::Left };
                comfy_table::Cell::new(&cell.text).set_alignment(alignment)
            });
            table.add_row(cells);
        }
        self.keep_name_whole(&mut table, &shown, width);
        self.keep_numbers_whole(&mut table, &shown, width);
        self.keep_one_whole(&mut table, &shown, width);
        let mut text = with_bold_header(&table.trim_fmt());
        if !left_out.is_empty() {
            let names: Vec<&str> = left_out.iter().map(|&at| self.header[at].as_str()).collect();
            text += &format!("\n{}", dim(format!("  not shown in {width} columns: {}", names.join(", "))));
        }
        text
    }

    /// One column names the row: the others are wrapped before it is, while it leaves them a quarter of the width.
    fn keep_name_whole(&self, table: &mut comfy_table::Table, shown: &[usize], width: usize) {
        let place = shown.iter().position(|&at| at == self.name).unwrap_or(0);
        let names = self.rows.iter().filter_map(|row| row.get(self.name)).map(|cell| cell.text.chars().count());
        let wanted = names.max().unwrap_or(0) + PADDING;
        // A word before the name, such as a verdict, takes room from what stands behind it.
        let most = if self.name == 0 { width * 3 / 4 } else { width * 3 / 5 };
        if wanted <= most
            && let (Some(first), Ok(wanted)) = (table.column_mut(place), u16::try_from(wanted))
        {
            first.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(wanted)));
        }
    }

    /// The column that is to be whole is, where the others still have what they need.
    fn keep_one_whole(&self, table: &mut comfy_table::Table, shown: &[usize], width: usize) {
        let Some(place) = shown.iter().position(|&at| Some(at) == self.whole) else { return };
        let bound = u16::try_from(self.widest(shown[place]).max(self.word(shown[place])) + PADDING);
        if self.least(shown) <= width
            && let (Some(column), Ok(bound)) = (table.column_mut(place), bound)
        {
            column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(bound)));
        }
    }

    /// Columns of numbers are wrapped no more than the names of the rows are, where all of them have room; names that leave none are
    /// wrapped, where half of the width is theirs.
    fn keep_numbers_whole(&self, table: &mut comfy_table::Table, shown: &[usize], width: usize) {
        let numbers = |at: usize| self.holds_numbers(at);
        let with_names = |at: usize| at == 0 || at == self.name || numbers(at);
        let cells = |at: usize| self.widest(at) + PADDING;
        let with_header = |at: usize| cells(at).max(self.word(at) + PADDING);
        let room = if self.name == 0 { PADDING + 1 } else { LEAST_COLUMN };
        // A blank between columns, and one at each end: what is narrow gives them away.
        let spare = width.saturating_sub(shown.len() + 1);
        let bounds = bounds(shown, with_names, with_header, (room, spare))
            .or_else(|| bounds(shown, numbers, with_header, (width / 2, spare)))
            .or_else(|| bounds(shown, with_names, cells, (room, width)));
        for (place, bound) in bounds.into_iter().flatten() {
            if let (Some(column), Ok(bound)) = (table.column_mut(place), u16::try_from(bound)) {
                column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(bound)));
            }
        }
    }
}

/// What such columns take at least, by place; nothing where that leaves the others less than this room each of this width.
fn bounds(
    shown: &[usize],
    such: impl Fn(usize) -> bool,
    least: impl Fn(usize) -> usize,
    (room, width): (usize, usize),
) -> Option<Vec<(usize, usize)>> {
    let kept = shown.iter().enumerate().filter(|(_, at)| such(**at));
    let bounds: Vec<(usize, usize)> = kept.map(|(place, at)| (place, least(*at))).collect();
    let others = (shown.len() - bounds.len()) * room;
    (bounds.iter().map(|(_, bound)| bound).sum::<usize>() + others <= width).then_some(bounds)
}

/// What stands above the line under the header, in bold.
fn with_bold_header(text: &str) -> String {
    let mut above = true;
    let lines = text.lines().map(|line| {
        above &= !line.contains('\u{2500}');
        if above { bold(line).to_string() } else { line.to_owned() }
    });
    lines.collect::<Vec<_>>().join("\n")
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(width()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        let mut table = table(&["scenario", "from", "tuned", "findings"]).without_first(&["findings", "from"]);
        let findings = "near miss, hard braking, phantom braking, oscillation";
        table.add_row([
            Cell::new("01-intersection-straight-straight"),
            Cell::new("record"),
            number("0.51 m"),
            Cell::new(findings),
        ]);
        table
    }

    #[test]
    fn a_table_keeps_to_its_width_and_tells_what_is_left_out() {
        for width in [40, 60, 80, 100, 120, 200] {
            let text = sample().render(width);
            let plain = crate::screen::plain(&text);
            for line in plain.lines().filter(|line| !line.contains("not shown")) {
                assert!(line.chars().count() <= width, "{width}: {line}");
            }
            assert_eq!(plain.contains("not shown in"), width < 80, "{width}:\n{plain}");
            assert_eq!(plain.contains("01-intersection-straight-straight"), width >= 60, "{width}:\n{plain}");
        }
    }

    #[test]
    fn numbers_stay_whole_where_they_have_room() {
        let mut table =
            table(&["", "pairs", "verdict %", "least gap %", "its time %", "arrival %", "failed", "confirmed %"]);
        let share = || number("100.0 %");
        let name = Cell::new("policy accel_then_brake");
        table.add_row([name, number(200), share(), share(), share(), share(), number(69), share()]);
        for width in [80, 100] {
            let plain = crate::screen::plain(&table.render(width));
            let row = plain.lines().last().unwrap_or_default();
            assert!(row.contains("accel_then_brake") && row.matches("100.0 %").count() == 5, "{width}:\n{plain}");
        }
    }

    #[test]
    fn numbers_stay_whole_beside_a_name_that_no_line_holds() {
        for length in [9, 80, 100, 101, 102, 103, 104, 105, 106, 107, 108, 110, 120, 300] {
            let mut table = table(&["reason", "incidents"]);
            table.add_row([Cell::new("signal, ".repeat(50)[..length].to_owned()), number("14")]);
            let plain = crate::screen::plain(&table.render(120));
            assert!(plain.lines().any(|line| line.trim_end().ends_with("incidents")), "{length}:\n{plain}");
        }
    }

    #[test]
    fn a_verdict_stands_whole_before_the_name_and_what_failed_is_never_left_out() {
        let mut table = table(&["verdict", "scenario", "what failed", "found", "as told"])
            .named_by("scenario")
            .without_first(&["as told", "found"]);
        let (name, what) = ("intersection-straight-departure-30270-6878", "did not react to crossing traffic");
        table.add_row(["STRUCK", name, what, "by tuning", "yes"].map(Cell::new));
        for width in [60, 80, 100, 120] {
            let plain = crate::screen::plain(&table.render(width));
            assert!(plain.contains("STRUCK") && plain.contains("react"), "{width}:\n{plain}");
            assert_eq!(plain.contains(name), width >= 80, "{width}:\n{plain}");
            for line in plain.lines().filter(|line| !line.contains("not shown")) {
                assert!(line.chars().count() <= width, "{width}: {line}");
            }
        }
    }

    #[test]
    fn what_failed_stands_on_one_line_at_100_columns_and_delta_v_beside_it_where_both_have_room() {
        let header = ["verdict", "scenario", "what failed", "found", "delta-v ego / partner [m/s]", "as told"];
        let spare = ["as told", "found", "delta-v ego / partner [m/s]"];
        let mut table = table(&header).named_by("scenario").whole("what failed").without_first(&spare);
        let rows = [
            ("intersection-straight-departure-30270-6878", "did not react to crossing traffic", "10.6 / 7.0"),
            ("highway-straight-straight-30530-9093", "was struck from behind or beside", "0.2 / 25.6"),
        ];
        for (name, what, delta_v) in rows {
            let [verdict, found, told] = ["FAIL", "by tuning", "yes"].map(Cell::new);
            table.add_row([verdict, Cell::new(name), Cell::new(what), found, number(delta_v), told]);
        }
        for (width, has_delta_v) in [(100, false), (106, true), (130, true)] {
            let plain = crate::screen::plain(&table.render(width));
            for (name, what, delta_v) in rows {
                let row = plain.lines().find(|line| line.contains(name)).unwrap_or_default();
                assert!(row.contains(what) && row.chars().count() <= width, "{width}:\n{plain}");
                assert_eq!(row.contains(delta_v), has_delta_v, "{width}:\n{plain}");
            }
        }
    }

    #[test]
    fn a_cell_is_one_line() {
        let mut table = table(&["a"]);
        table.add_row([Cell::new("x\n\u{1b}[2Jy")]);
        assert_eq!(table.render(80).lines().count(), 3);
        assert!(!table.render(80).contains('\u{1b}'));
    }
}
