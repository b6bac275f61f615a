//! Views of what was measured: JSON, which is the data itself, CSV, tables, charts and a page.

mod chart;
mod expression;
mod page;
mod scene;
mod table;

use serde::Serialize;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

pub use chart::Chart;
pub use table::Table;

/// What every measurement can be shown as.
pub trait Report: Serialize {
    /// The measurements, row by row.
    fn table(&self) -> Table;

    /// The charts.
    fn charts(&self) -> Vec<Chart>;

    /// A heading, and the facts that the numbers depend on, for a terminal.
    fn heading(&self) -> String;

    /// One self-contained HTML page.
    ///
    /// # Errors
    /// As [`svg`].
    fn html(&self) -> Result<String, Diagnostic>;
}

/// The data as JSON.
///
/// # Errors
/// If it has no JSON form: our mistake.
pub fn json(report: &impl Report) -> Result<String, Diagnostic> {
    serde_json::to_string_pretty(report).map(|text| text + "\n").map_err(|error| failed("JSON", &error))
}

/// The table as comma-separated values (RFC 4180), with a line of column names.
///
/// # Errors
/// If it cannot be written: our mistake.
pub fn csv(report: &impl Report) -> Result<Vec<u8>, Diagnostic> {
    report.table().csv().map_err(|error| failed("CSV", &error))
}

/// All charts, one below the other.
///
/// # Errors
/// If they cannot be drawn: our mistake.
pub fn svg(report: &impl Report) -> Result<String, Diagnostic> {
    chart::stacked(&report.charts()).map_err(|error| failed("SVG", &error))
}

/// Heading and table for a terminal.
pub fn text(report: &impl Report) -> String {
    report.heading() + "\n" + &report.table().text()
}

fn failed(format: &str, error: &dyn std::fmt::Display) -> Diagnostic {
    Diagnostic::error(code::INTERNAL, format!("cannot write the measurements as {format}: {error}"))
}
