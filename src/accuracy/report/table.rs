//! Tables: columns with their meaning, rows of cells; as text for a terminal and as CSV. The page shows the same.

use crate::accuracy::number::brief;
use crate::interval::decimal;

/// Where a column is shown. CSV has all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shown {
    File,
    Page,
    Terminal,
}

/// One column of rows of type `R`.
pub struct Field<R> {
    /// Its name in CSV.
    pub key: &'static str,
    /// Its heading for people.
    pub head: &'static str,
    pub shown: Shown,
    /// What it means, with its unit.
    pub about: &'static str,
    pub value: fn(&R) -> Cell,
}

/// What stands in one place of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    Text(String),
    Count(u64),
    Number(f64),
    /// A number of which every digit counts.
    Exact(f64),
    /// Marked or not.
    Mark(bool),
    /// No such number, or none that means anything here.
    Missing,
}

impl From<Option<f64>> for Cell {
    fn from(number: Option<f64>) -> Self {
        number.map_or(Cell::Missing, Cell::Number)
    }
}

impl Cell {
    /// As people read it.
    pub fn brief(&self) -> String {
        match self {
            Cell::Text(text) => text.clone(),
            Cell::Count(count) => count.to_string(),
            Cell::Number(number) => brief(*number),
            Cell::Exact(number) => decimal(*number),
            Cell::Mark(marked) => if *marked { "*" } else { "" }.to_owned(),
            Cell::Missing => "-".to_owned(),
        }
    }

    /// As programs read it: exactly.
    fn exact(&self) -> String {
        match self {
            Cell::Text(text) => text.clone(),
            Cell::Count(count) => count.to_string(),
            Cell::Number(number) | Cell::Exact(number) => decimal(*number),
            Cell::Mark(marked) => u8::from(*marked).to_string(),
            Cell::Missing => String::new(),
        }
    }

    /// What rows are sorted by; texts by their letters.
    pub fn key(&self) -> Option<f64> {
        match self {
            Cell::Text(_) | Cell::Missing => None,
            Cell::Count(count) => Some(*count as f64),
            Cell::Number(number) | Cell::Exact(number) => Some(*number),
            Cell::Mark(marked) => Some(f64::from(u8::from(*marked))),
        }
    }
}

/// One column, without the rows' type.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    pub key: &'static str,
    pub head: &'static str,
    pub shown: Shown,
    pub about: &'static str,
}

/// One row; with a failure, only the cells that name it mean something.
#[derive(Debug, Clone)]
pub struct Line {
    pub cells: Vec<Cell>,
    pub failure: Option<String>,
    /// On the Pareto front.
    pub marked: bool,
}

#[derive(Debug, Clone)]
pub struct Table {
    pub columns: Vec<Column>,
    pub lines: Vec<Line>,
}

impl Table {
    /// The table of some rows; `standing` says of each whether it failed, and why, and whether it is marked.
    pub fn new<'a, R>(fields: &[Field<R>], rows: &'a [R], standing: fn(&'a R) -> (Option<&'a str>, bool)) -> Self {
        let column = |field: &Field<R>| {
            let Field { key, head, shown, about, .. } = *field;
            Column { key, head, shown, about }
        };
        let line = |row: &'a R| {
            let (failure, marked) = standing(row);
            let cells = fields.iter().map(|field| (field.value)(row)).collect();
            Line { cells, failure: failure.map(str::to_owned), marked }
        };
        Self { columns: fields.iter().map(column).collect(), lines: rows.iter().map(line).collect() }
    }

    /// The places of the columns that are shown somewhere.
    pub fn shown(&self, place: Shown) -> Vec<usize> {
        (0..self.columns.len()).filter(|&index| self.columns[index].shown >= place).collect()
    }

    /// Aligned columns: texts to the left, numbers to the right. A row that failed ends with the reason.
    pub fn text(&self) -> String {
        let shown = self.shown(Shown::Terminal);
        let mut texts: Vec<Vec<String>> = vec![shown.iter().map(|&c| self.columns[c].head.to_owned()).collect()];
        for line in &self.lines {
            texts.push(shown.iter().map(|&c| line.cells[c].brief()).collect());
        }
        // A failure takes the place of all cells behind the last text.
        let named =
            |line: &Line| shown.iter().rposition(|&c| matches!(line.cells[c], Cell::Text(_))).map_or(0, |c| c + 1);
        let mut widths = vec![0; shown.len()];
        for (row, text) in texts.iter().enumerate() {
            let failed = row.checked_sub(1).map(|row| &self.lines[row]).filter(|line| line.failure.is_some());
            let cells = failed.map_or(shown.len(), named);
            for (width, text) in widths.iter_mut().zip(text).take(cells) {
                *width = (*width).max(text.chars().count());
            }
        }
        let left: Vec<bool> =
            shown.iter().map(|&c| self.lines.iter().any(|line| matches!(line.cells[c], Cell::Text(_)))).collect();
        let mut out = String::new();
        for (row, text) in texts.iter().enumerate() {
            let line = row.checked_sub(1).map(|row| &self.lines[row]);
            let failure = line.and_then(|line| line.failure.as_ref());
            let cells = line.filter(|line| line.failure.is_some()).map_or(shown.len(), named);
            let mut written = String::new();
            for ((text, &width), left) in text.iter().zip(&widths).zip(&left).take(cells) {
                let gap = if written.is_empty() { "" } else { "  " };
                written += gap;
                written += &if *left { format!("{text:<width$}") } else { format!("{text:>width$}") };
            }
            if let Some(failure) = failure {
                written += &format!("  {failure}");
            }
            out += written.trim_end();
            out += "\n";
        }
        out
    }

    /// Comma-separated values, the reason of a failure in the last column.
    pub fn csv(&self) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|column| column.key).chain(["failure"]))?;
        for line in &self.lines {
            let cells = line.cells.iter().map(Cell::exact);
            writer.write_record(cells.chain([line.failure.clone().unwrap_or_default()]))?;
        }
        Ok(writer.into_inner()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let fields: &[Field<(&str, f64, bool)>] = &[
            Field { key: "name", head: "level", shown: Shown::Terminal, about: "", value: |r| Cell::Text(r.0.into()) },
            Field { key: "ms", head: "ms", shown: Shown::Terminal, about: "", value: |r| Cell::Number(r.1) },
            Field { key: "rest", head: "rest", shown: Shown::File, about: "", value: |_| Cell::Missing },
        ];
        static ROWS: [(&str, f64, bool); 3] = [("a", 0.1, true), ("long, \"name\"", 120.0, true), ("b", 0.0, false)];
        Table::new(fields, &ROWS, |row| ((!row.2).then_some("it broke"), row.2))
    }

    #[test]
    fn columns_are_aligned_and_failures_explained() {
        let lines = ["level            ms", "a             0.100", "long, \"name\"    120", "b             it broke"];
        assert_eq!(table().text(), lines.map(|line| line.to_owned() + "\n").concat());
    }

    #[test]
    fn csv_is_exact_and_quoted() {
        let text = String::from_utf8(table().csv().unwrap()).unwrap();
        let lines = ["name,ms,rest,failure", "a,0.1,,", "\"long, \"\"name\"\"\",120,,", "b,0,,it broke"];
        assert_eq!(text.lines().collect::<Vec<_>>(), lines);
    }
}
