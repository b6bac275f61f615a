//! Views of a scene's levels.

use crate::accuracy::level::OWN_ENGINE;
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
use crate::accuracy::report::table::Table;
use crate::accuracy::scene::Measured;
use crate::accuracy::scene::Outcome;
use crate::accuracy::scene::Row;
use crate::accuracy::scene::SceneCost;
use crate::diagnostic::Diagnostic;

fn number(row: &Row, of: impl Fn(&Measured) -> Option<f64>) -> Cell {
    row.measured().and_then(of).into()
}

fn count(row: &Row, of: impl Fn(&Measured) -> u64) -> Cell {
    row.measured().map_or(Cell::Missing, |measured| Cell::Count(of(measured)))
}

fn text(text: &str) -> Cell {
    Cell::Text(text.to_owned())
}

const fn field(
    key: &'static str,
    head: &'static str,
    shown: Shown,
    about: &'static str,
    value: fn(&Row) -> Cell,
) -> Field<Row> {
    Field { key, head, shown, about, value }
}

use Shown::File;
use Shown::Page;
use Shown::Terminal;

const FIELDS: &[Field<Row>] = &[
    field("number", "#", Terminal, "the place in the order of error, then time; charts use the same numbers", |row| {
        Cell::Count(row.number as u64)
    }),
    field("pareto", "front", Terminal, "marked if no other level has both a smaller error and a smaller time", |row| {
        row.measured().map_or(Cell::Mark(false), |m| Cell::Mark(m.pareto))
    }),
    field("pareto_finders", "finders' front", Page, "the same among the root finders of the literature alone", |row| {
        row.measured().map_or(Cell::Mark(false), |m| Cell::Mark(m.pareto_finders))
    }),
    field(
        "name",
        "level",
        Terminal,
        "engine, arithmetic, format, rounding, and the wanted length of brackets as a part of the domain's longest side",
        |row| text(&row.name),
    ),
    field("engine", "engine", File, "`imp`, or the name of a root finder of the literature", |row| text(row.engine)),
    field("arithmetic", "arithmetic", File, "what encloses the field", |row| text(row.arithmetic)),
    field("precision", "precision", File, "the format in which enclosures are computed", |row| text(row.precision)),
    field("rounding", "rounding", File, "with `nearest` nothing is proved", |row| text(row.rounding)),
    field("depth", "depth", File, "wanted brackets are 2^-depth of the domain's longest side", |row| {
        row.depth.map_or(Cell::Missing, |depth| Cell::Count(depth.into()))
    }),
    field("width", "width", File, "pixels across", |row| Cell::Count(row.size[0].into())),
    field("height", "height", File, "pixels down", |row| Cell::Count(row.size[1].into())),
    field(
        "ms",
        "ms",
        Terminal,
        "time to find what every pixel sees, in milliseconds of wall clock: the median of the repeats; without compiling and \
         shading",
        |row| number(row, |m| Some(m.ms)),
    ),
    field("ms_least", "least", Page, "the shortest of the repeats", |row| number(row, |m| Some(m.ms_least))),
    field("ms_most", "most", Page, "the longest of the repeats: what the machine's noise did", |row| {
        number(row, |m| Some(m.ms_most))
    }),
    field("repeats", "repeats", File, "how often it was measured", |row| count(row, |m| m.repeats.into())),
    field("ratio", "ratio", Terminal, "time over that of the baseline, the defaults of `imp render`", |row| {
        number(row, |m| m.ratio)
    }),
    field("compile_ms", "compile", Page, "time to compile the kernels, in milliseconds; not known of finders", |row| {
        number(row, |m| m.compile_ms)
    }),
    field("evaluations", "evaluations", File, "kernel evaluations of all kinds", |row| count(row, |m| m.evaluations)),
    field(
        "evaluations_per_pixel",
        "evals/px",
        Terminal,
        "kernel evaluations for one pixel: boxes, slopes and points alike; one evaluation of a beam serves many pixels",
        |row| number(row, |m| Some(m.evaluations_per_pixel)),
    ),
    field("hits", "hits", Page, "pixels in which something is drawn, proved or not", |row| count(row, |m| m.hits)),
    field(
        "proved_hits",
        "proved",
        Terminal,
        "proved hits: the ray is refuted up to a bracket on which the field is continuous and has proved opposite signs",
        |row| count(row, |m| m.proved_hits),
    ),
    field("proved_misses", "proved misses", Page, "pixels whose whole ray is refuted", |row| {
        count(row, |m| m.proved_misses)
    }),
    field(
        "unknown",
        "unknown",
        Terminal,
        "pixels of which nothing is claimed; with rounding to nearest all of them",
        |row| count(row, |m| m.unknown),
    ),
    field("compared", "compared", File, "pixels that the reference decides", |row| count(row, |m| m.errors.compared)),
    field(
        "wrong",
        "wrong",
        Terminal,
        "pixels drawn as a hit where the reference proves a miss, or the reverse",
        |row| count(row, |m| m.errors.wrong),
    ),
    field("missed", "missed", Page, "of these: hits of the reference that are not drawn", |row| {
        count(row, |m| m.errors.missed)
    }),
    field("invented", "invented", Page, "of these: drawn where the reference proves a miss", |row| {
        count(row, |m| m.errors.invented)
    }),
    field(
        "wrong_at_silhouette",
        "at silhouette",
        Page,
        "of these: with another answer of the reference among the eight neighbours",
        |row| count(row, |m| m.errors.wrong_at_silhouette),
    ),
    field(
        "contradicted",
        "contradicted",
        Page,
        "claims of proof that the reference's proof contradicts, places included: 0, or Imp has a bug",
        |row| count(row, |m| m.errors.contradicted),
    ),
    field("thin_parts", "thin parts", File, "thin parts of the reference", |row| count(row, |m| m.errors.thin_parts)),
    field(
        "thin_parts_missed",
        "thin lost",
        Terminal,
        "thin parts of which no pixel is hit; a thin part is a connected group of the reference's hits that no square of 3x3 \
         hits covers: where the picture is at most two pixels wide, and tips of its outline",
        |row| count(row, |m| m.errors.thin_parts_missed),
    ),
    field(
        "depth_median",
        "median depth error",
        Page,
        "distance along the ray from the drawn hit to the reference's, in the scene's units, where both hit",
        |row| number(row, |m| m.errors.depth_median),
    ),
    field("depth_max", "max depth err", Terminal, "the largest of these distances", |row| {
        number(row, |m| m.errors.depth_max)
    }),
    field("depth_median_cells", "median, cells", Page, "the median distance in wanted cells", |row| {
        number(row, |m| m.errors.depth_median_cells)
    }),
    field("depth_max_cells", "max, cells", Terminal, "the largest distance in wanted cells", |row| {
        number(row, |m| m.errors.depth_max_cells)
    }),
    field(
        "astray",
        "astray",
        Page,
        "hits more than 16 wanted cells from the reference's: on another sheet, most likely",
        |row| count(row, |m| m.errors.astray),
    ),
    field(
        "bracket_median",
        "bracket",
        Terminal,
        "median length of the bracket that is given for a hit, in the scene's units: what is proved of the place, where hits \
         are proved; what is drawn lies inside and may be closer",
        |row| number(row, |m| m.errors.bracket_median),
    ),
    field(
        "error",
        "error",
        Terminal,
        "mean over the compared pixels of the depth error, in sides of the domain; a wrong pixel counts as 1",
        |row| number(row, |m| Some(m.errors.error)),
    ),
];

impl Report for SceneCost {
    fn table(&self) -> Table {
        Table::new(FIELDS, &self.levels, |row| match &row.outcome {
            Outcome::Measured(measured) => (None, measured.pareto),
            Outcome::Failed { failure } => (Some(failure), false),
        })
    }

    fn charts(&self) -> Vec<Chart> {
        let mut charts = vec![Chart {
            title: "Time against error".to_owned(),
            x: "error: mean depth error in sides of the domain, a wrong pixel counts as 1".to_owned(),
            y: "milliseconds".to_owned(),
            series: self.series(|m| Some(m.errors.error), |m| m.pareto, |m| m.pareto_finders),
            fronts: ["all levels", "finders alone"].map(str::to_owned).to_vec(),
        }];
        if self.dimension == 3 {
            charts.push(Chart {
                title: "Time against the length of the brackets that are given".to_owned(),
                x: "median bracket in the scene's units".to_owned(),
                y: "milliseconds".to_owned(),
                series: self.series(|m| m.errors.bracket_median, |m| m.pareto_bracket, |_| false),
                fronts: vec!["rounded outward".to_owned()],
            });
        } else {
            charts[0].x = "share of wrong pixels".to_owned();
        }
        charts
    }

    fn heading(&self) -> String {
        let Self { scene, size: [width, height], reference, threads, repeats, baseline, .. } = self;
        format!(
            "{scene}: {width}x{height} pixels, {threads} threads, median of up to {repeats} runs of wall clock on a machine \
             that may do other work\n\
             reference: {}: {} hits and {} misses proved, {} pixels undecided and left out, {} thin parts\n\
             ratio: time over that of `{baseline}`; front: * if nothing is both faster and closer\n",
            reference.name, reference.hits, reference.misses, reference.unknown, reference.thin_parts
        )
    }

    fn html(&self) -> Result<String, Diagnostic> {
        page::of_scene(self)
    }
}

impl SceneCost {
    /// Engines and arithmetics that have measurements, in a fixed order.
    pub(super) fn kinds(&self) -> Vec<String> {
        let mut kinds: Vec<(usize, String)> = Vec::new();
        for row in &self.levels {
            let kind = kind(row);
            if row.measured().is_some() && !kinds.iter().any(|(_, known)| *known == kind) {
                kinds.push((usize::from(row.engine != OWN_ENGINE), kind));
            }
        }
        kinds.sort();
        kinds.into_iter().map(|(_, kind)| kind).collect()
    }

    /// One series for each engine and arithmetic, filled where rounding is outward.
    fn series(
        &self,
        x: fn(&Measured) -> Option<f64>,
        on_front: fn(&Measured) -> bool,
        on_second: fn(&Measured) -> bool,
    ) -> Vec<Series> {
        let series = |(index, name): (usize, String)| {
            let rows = self.levels.iter().filter(|row| kind(row) == name);
            let points = rows.filter_map(|row| {
                let measured = row.measured()?;
                let front = if on_front(measured) { Some(0) } else { on_second(measured).then_some(1) };
                Some(Point {
                    x: x(measured)?,
                    y: measured.ms,
                    filled: row.rounding == "outward",
                    front: front.map(|front| Front { front, label: label(row) }),
                })
            });
            let marker = if name.starts_with(OWN_ENGINE) { Marker::Circle } else { Marker::of(index) };
            Series { points: points.collect(), name, color: index, marker }
        };
        self.kinds().into_iter().enumerate().map(series).collect()
    }
}

/// What a row has in common with the others of its series. Affine forms of a finder share its series.
pub(super) fn kind(row: &Row) -> String {
    if row.engine == OWN_ENGINE { format!("{OWN_ENGINE} {}", row.arithmetic) } else { row.engine.to_owned() }
}

/// The row's number and what sets it apart, as short as can be.
fn label(row: &Row) -> String {
    let kind = if row.engine == OWN_ENGINE { row.arithmetic } else { row.engine };
    let goal = match row.depth {
        Some(depth) => format!("2^-{depth}"),
        None => format!("{}x{}", row.size[0], row.size[1]),
    };
    format!("{} {kind} {} {goal}", row.number, row.precision)
}
