//! The page: charts, table, pictures and what every number means, in one HTML file without anything from elsewhere.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::DOCTYPE;
use maud::Markup;
use maud::PreEscaped;
use maud::html;

use crate::accuracy::number::brief;
use crate::accuracy::picture::LEGEND;
use crate::accuracy::report::Report;
use crate::accuracy::report::failed;
use crate::accuracy::report::scene::kind;
use crate::accuracy::report::table::Cell;
use crate::accuracy::report::table::Shown;
use crate::accuracy::report::table::Table;
use crate::accuracy::scene::Measured;
use crate::accuracy::scene::Row;
use crate::accuracy::scene::SceneCost;
use crate::diagnostic::Diagnostic;

/// Colours by the reader's preference for dark or light; charts and pictures stay on white.
const STYLE: &str = include_str!("page.css");

/// Sorts a table by the column whose heading is clicked, and shows the rows that contain what is typed.
const SCRIPT: &str = include_str!("page.js");

/// The page of a scene.
pub fn of_scene(cost: &SceneCost) -> Result<String, Diagnostic> {
    let [width, height] = cost.size;
    let reference = &cost.reference;
    let failed = cost.levels.iter().filter(|row| row.measured().is_none()).count();
    let contradicted: u64 = cost.levels.iter().filter_map(Row::measured).map(|m| m.errors.contradicted).sum();
    let body = html! {
        p.lead {
            "One picture of " (width) " by " (height) " pixels at " (cost.levels.len() - failed) " levels of accuracy"
            @if failed > 0 { " (" (failed) " more gave none and say why)" }
            ", each compared with a reference of much higher accuracy."
        }
        (facts(&[
            ("Reference", format!(
                "{}: {} hits and {} misses proved in {} ms. {} pixels that it leaves undecided are left out of all comparisons.",
                reference.name, reference.hits, reference.misses, brief(reference.ms), reference.unknown
            )),
            ("Baseline", format!("{}, the defaults of imp render; ratios of time refer to it.", cost.baseline)),
            ("Time", format!(
                "wall clock, the median of up to {} runs on {} threads, without compiling and shading. The machine may do other \
                 work: the table has the shortest and the longest run.",
                cost.repeats, cost.threads
            )),
            ("Proofs", format!(
                "claims of proof that the reference contradicts, over all levels: {contradicted}. {}",
                if contradicted == 0 { "So it must be." } else { "This is a bug in Imp; please report it." }
            )),
            ("Domain", match cost.dimension {
                2 => "of a plane scene: the error is the share of wrong pixels.".to_owned(),
                _ => format!("its longest side has {} units; a depth error of that length is an error of 1.", brief(cost.side)),
            }),
        ]))
        (charts(cost)?)
        (table(&cost.table()))
        h2 { "Pictures" }
        p {
            "On the left what the level draws, on the right its errors against the reference. A level that draws a wrong pixel as "
            "it should and says that it does not know is not lying: only rounding outward makes claims."
        }
        ul.legend {
            @for (color, meaning) in LEGEND {
                li { span style=(format!("background:rgb({},{},{})", color[0], color[1], color[2])) {} (meaning) }
            }
        }
        div.cards {
            figure.card {
                figcaption { b { "reference" } " " (reference.name) }
                div.pair { (image(&reference.color, "the reference")) }
            }
        }
        h3 { "Pareto fronts" }
        (cards(cost.levels.iter().filter(|row| row.measured().is_some_and(|m| m.pareto || m.pareto_finders))))
        @for name in cost.kinds() {
            details {
                summary { (name) }
                (cards(cost.levels.iter().filter(|row| kind(row) == name)))
            }
        }
    };
    Ok(page(&format!("The cost of accuracy: {}", cost.scene), cost.version, &body))
}

/// The frame of every page.
pub fn page(title: &str, version: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (title) }
                (body)
                footer { "Measured and written by imp " (version) ": the same numbers come as JSON and CSV." }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string()
}

/// Names and what they stand for.
pub fn facts(facts: &[(&str, String)]) -> Markup {
    html! {
        dl.facts { @for (name, text) in facts { dt { (name) } dd { (text) } } }
    }
}

/// All charts of a report.
pub fn charts(report: &impl Report) -> Result<Markup, Diagnostic> {
    let mut figures = Vec::new();
    for chart in report.charts() {
        figures.push(chart.svg().map_err(|error| failed("SVG", &error))?);
    }
    Ok(html! {
        h2 { "Time against error" }
        p {
            "Towards the left is closer, towards the bottom is faster. Of two points the one further to the left and below is the "
            "better level; the ringed ones, joined by a line, are beaten by none: a Pareto front. Their labels begin with the row's "
            "number in the table. Hollow points are rounded to nearest and prove nothing."
        }
        @for svg in figures { figure.chart { (PreEscaped(svg)) } }
    })
}

/// A table that can be sorted, with the meaning of its columns.
pub fn table(table: &Table) -> Markup {
    let shown = table.shown(Shown::Page);
    let text = |c: usize| table.lines.iter().any(|line| matches!(line.cells[c], Cell::Text(_)));
    html! {
        h2 { "All levels" }
        p { "A click on a heading sorts by it, a second click turns the order round. "
            label { "Show rows with " input #filter type="search" placeholder="for example: f64 outward"; } }
        div.scroll {
            table #levels {
                thead { tr {
                    @for &c in &shown { th.text[text(c)] title=(table.columns[c].about) { button type="button" { (table.columns[c].head) } } }
                } }
                tbody {
                    @for line in &table.lines {
                        tr.front[line.marked] {
                            @for &c in &shown {
                                @if let Some(failure) = line.failure.as_ref().filter(|_| table.columns[c].key == "ms") {
                                    td.failure { (failure) }
                                } @else {
                                    td.text[text(c)] data-key=[line.cells[c].key()] {
                                        @if line.failure.is_none() || line.cells[c].key().is_some() || text(c) { (line.cells[c].brief()) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
        details {
            summary { "What the columns mean" }
            dl.facts { @for &c in &shown { dt { (table.columns[c].head) } dd { (table.columns[c].about) } } }
        }
    }
}

fn cards<'a>(rows: impl Iterator<Item = &'a Row>) -> Markup {
    html! {
        div.cards { @for (row, measured) in rows.filter_map(|row| Some((row, row.measured()?))) { (card(row, measured)) } }
    }
}

fn card(row: &Row, measured: &Measured) -> Markup {
    let errors = &measured.errors;
    html! {
        figure.card {
            figcaption {
                b { (row.number) } " " (row.name) @if measured.pareto { " " span.badge { "front" } }
                br;
                (brief(measured.ms)) " ms, " (errors.wrong) " wrong, " (measured.unknown) " unknown"
                @if let Some(depth) = errors.depth_max { ", depth error up to " (brief(depth)) }
            }
            div.pair {
                (image(&measured.pictures.color, "what is drawn"))
                (image(&measured.pictures.errors, "map of errors"))
            }
        }
    }
}

/// A PNG file inside the page.
fn image(png: &[u8], what: &str) -> Markup {
    html! { img alt=(what) loading="lazy" src=(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png))); }
}
