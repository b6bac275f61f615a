//! Views of an expression's enclosures.

use maud::html;

use crate::accuracy::expression::Enclosed;
use crate::accuracy::expression::ExpressionCost;
use crate::accuracy::expression::Measured;
use crate::accuracy::expression::Outcome;
use crate::accuracy::report::Report;
use crate::accuracy::report::chart::Chart;
use crate::accuracy::report::chart::Front;
use crate::accuracy::report::chart::Marker;
use crate::accuracy::report::chart::Point;
use crate::accuracy::report::chart::Series;
use crate::accuracy::report::page;
use crate::accuracy::report::table::Cell;
use crate::accuracy::report::table::Field;
use crate::accuracy::report::table::Shown;
use crate::accuracy::report::table::Shown::File;
use crate::accuracy::report::table::Shown::Page;
use crate::accuracy::report::table::Shown::Terminal;
use crate::accuracy::report::table::Table;
use crate::diagnostic::Diagnostic;
use crate::interval::decimal;

fn number(row: &Enclosed, of: impl Fn(&Measured) -> Option<f64>) -> Cell {
    row.measured().and_then(of).into()
}

fn end(row: &Enclosed, of: impl Fn(&Measured) -> f64) -> Cell {
    row.measured().map_or(Cell::Missing, |measured| Cell::Exact(of(measured)))
}

const fn field(
    key: &'static str,
    head: &'static str,
    shown: Shown,
    about: &'static str,
    value: fn(&Enclosed) -> Cell,
) -> Field<Enclosed> {
    Field { key, head, shown, about, value }
}

const FIELDS: &[Field<Enclosed>] = &[
    field("number", "#", Terminal, "the place in the order of excess, then time; charts use the same numbers", |row| {
        Cell::Count(row.number as u64)
    }),
    field(
        "pareto",
        "front",
        Terminal,
        "marked if, of what is rounded outward, nothing else has both a smaller excess and a smaller time",
        |row| Cell::Mark(row.measured().is_some_and(|m| m.pareto)),
    ),
    field(
        "name",
        "way",
        Terminal,
        "the extension, or the compiled kernel, and into how many parts each input is cut",
        |row| Cell::Text(row.name.clone()),
    ),
    field("engine", "engine", File, "reference arithmetic, or a compiled kernel", |row| {
        Cell::Text(row.engine.to_owned())
    }),
    field("arithmetic", "arithmetic", File, "the extension", |row| Cell::Text(row.arithmetic.to_owned())),
    field("precision", "precision", File, "the format", |row| Cell::Text(row.precision.to_owned())),
    field("rounding", "rounding", File, "with `nearest` values may be lost", |row| Cell::Text(row.rounding.to_owned())),
    field("parts", "parts", File, "parts into which each input is cut", |row| Cell::Count(row.parts.into())),
    field("boxes", "boxes", Terminal, "boxes that are evaluated", |row| Cell::Count(row.boxes)),
    field("lo", "lower end", Page, "of the hull of all boxes' enclosures", |row| end(row, |m| m.lo)),
    field("hi", "upper end", Page, "of the hull of all boxes' enclosures", |row| end(row, |m| m.hi)),
    field("width", "width", Terminal, "of that hull", |row| number(row, |m| Some(m.width))),
    field(
        "excess_least",
        "excess, least",
        Page,
        "the width less the greatest width that the true range may have",
        |row| number(row, |m| Some(m.excess[0])),
    ),
    field("excess_most", "excess", Terminal, "the width less the least width that the true range may have", |row| {
        number(row, |m| Some(m.excess[1]))
    }),
    field(
        "holds",
        "holds",
        Terminal,
        "`yes` if all values that are known to be taken lie inside; only rounding to nearest may say no",
        |row| row.measured().map_or(Cell::Missing, |m| Cell::Text(if m.holds { "yes" } else { "NO" }.to_owned())),
    ),
    field(
        "decoration",
        "decoration",
        Page,
        "what the extension proves of the function on the box (IEEE 1788)",
        |row| row.measured().and_then(|m| m.decoration.clone()).map_or(Cell::Missing, Cell::Text),
    ),
    field(
        "operations",
        "ops/box",
        Terminal,
        "operations for one box, counted: on numbers for the reference, lane operations for compiled code",
        |row| row.measured().map_or(Cell::Missing, |m| Cell::Count(m.operations)),
    ),
    field(
        "ns_per_box",
        "ns/box",
        Terminal,
        "time for one box in nanoseconds on one thread, the median of the repeats; of compiled kernels with all lanes full",
        |row| number(row, |m| Some(m.ns_per_box)),
    ),
    field("us", "us", Terminal, "time for all boxes in microseconds", |row| number(row, |m| Some(m.us))),
    field("ratio", "ratio", Terminal, "that time over the baseline's", |row| number(row, |m| m.ratio)),
];

impl Report for ExpressionCost {
    fn table(&self) -> Table {
        Table::new(FIELDS, &self.enclosures, |row| match &row.outcome {
            Outcome::Measured(measured) => (None, measured.pareto),
            Outcome::Failed { failure } => (Some(failure), false),
        })
    }

    fn charts(&self) -> Vec<Chart> {
        let mut kinds: Vec<String> = Vec::new();
        for row in self.enclosures.iter().filter(|row| row.measured().is_some()) {
            let kind = kind(row);
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds.sort();
        let series = |(index, name): (usize, String)| {
            let rows = self.enclosures.iter().filter(|row| kind(row) == name);
            let finite = rows.filter_map(|row| Some((row, row.measured().filter(|m| m.width.is_finite())?)));
            let point = |(row, measured): (&Enclosed, &Measured)| Point {
                x: measured.excess[1],
                y: measured.us,
                filled: row.rounding == "outward",
                front: measured.pareto.then(|| Front { front: 0, label: format!("{} {}", row.number, row.name) }),
            };
            let marker = if name.starts_with("compiled") { Marker::Circle } else { Marker::of(index) };
            Series { points: finite.map(point).collect(), color: index, marker, name }
        };
        vec![Chart {
            title: "Time against excess width".to_owned(),
            x: "excess: width of the enclosure less that of the true range".to_owned(),
            y: "microseconds for all boxes".to_owned(),
            series: kinds.into_iter().enumerate().map(series).collect(),
            fronts: vec!["what is rounded outward".to_owned()],
        }]
    }

    fn heading(&self) -> String {
        format!(
            "{} with {}\ntrue range: {}\nmedian of {} runs of wall clock on a machine that may do other work; ratio: time over that \
             of `{}`; front: * if nothing rounded outward is both faster and tighter\n",
            self.expression,
            self.boxes(),
            self.range_text(),
            self.repeats,
            self.baseline
        )
    }

    fn html(&self) -> Result<String, Diagnostic> {
        let lost = self.enclosures.iter().filter_map(|row| Some((row, row.measured()?)));
        let lost: Vec<&str> = lost.filter(|(_, m)| !m.holds).map(|(row, _)| row.name.as_str()).collect();
        let body = html! {
            p.lead { "One expression over one box, enclosed in every way that Imp knows, the box whole and in parts." }
            (page::facts(&[
                ("Box", self.boxes()),
                ("True range", format!("{}. Excess is what an enclosure is wider than that.", self.range_text())),
                ("Baseline", format!("{}; ratios of time refer to it.", self.baseline)),
                ("Time", format!(
                    "wall clock on one thread, the median of {} runs, each long enough for the clock. Compiled kernels are timed with \
                     all lanes of their packets full. The machine may do other work.",
                    self.repeats
                )),
                ("Lost values", match lost.as_slice() {
                    [] => "none: every enclosure holds all values that are known to be taken.".to_owned(),
                    lost => format!("{} lost values that the expression takes.", lost.join(", ")),
                }),
            ]))
            (page::charts(self)?)
            (page::table(&self.table()))
        };
        Ok(page::page(&format!("The cost of accuracy: {}", self.expression), self.version, &body))
    }
}

impl ExpressionCost {
    /// Such as `x in [4, 6], y in [0, 1]`.
    fn boxes(&self) -> String {
        let text = |input: &crate::accuracy::expression::Input| {
            format!("{} in [{}, {}]", input.name, decimal(input.lo), decimal(input.hi))
        };
        let texts: Vec<String> = self.inputs.iter().map(text).collect();
        if texts.is_empty() { "no variables".to_owned() } else { texts.join(", ") }
    }

    fn range_text(&self) -> String {
        match &self.range {
            None => "not known: the expression was defined at no point that was tried".to_owned(),
            Some(range) => {
                let end = |[a, b]: [f64; 2]| match a == b {
                    true => decimal(a),
                    false => format!("a number in [{}, {}]", decimal(a), decimal(b)),
                };
                format!("from {} to {}", end(range.lo), end(range.hi))
            }
        }
    }
}

/// What a row has in common with the others of its series.
fn kind(row: &Enclosed) -> String {
    match row.engine {
        "compiled" => format!("compiled {} {}", row.arithmetic, row.precision),
        _ => row.arithmetic.to_owned(),
    }
}
