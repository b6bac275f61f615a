//! Values of arguments from their text. Messages complete clap's `invalid value '...' for '...': `.

use std::ops::Range;
use std::path::PathBuf;

use crate::cli::arguments::DrawingArgument;
use crate::cli::arguments::DrawingFormat;
use crate::cli::arguments::LayerArgument;
use crate::cli::arguments::ReportArgument;
use crate::cli::arguments::ReportFormat;
use crate::render::image::Layer;
use crate::session::Given;
use crate::session::Override;

/// Pixels along a side of the largest picture; its planes then take some gigabytes.
const MAX_SIDE: u32 = 16_384;

/// `640x480`, or `512` for a square.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let (width, height) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    match (width.trim().parse(), height.trim().parse()) {
        (Ok(width), Ok(height)) if (1..=MAX_SIDE).contains(&width) && (1..=MAX_SIDE).contains(&height) => {
            Ok((width, height))
        }
        (Ok(_), Ok(_)) => Err(format!("sides have 1 to {MAX_SIDE} pixels")),
        _ => Err("write pixels across and down, such as 640x480".to_owned()),
    }
}

/// A finite number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number < f64::INFINITY => Ok(number),
        _ => Err("write a number above 0, such as 1e-4".to_owned()),
    }
}

/// `NAME=VALUE`; the value is read later, where messages can point into it.
pub fn setting(text: &str) -> Result<Override, String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok(Override { name: name.trim().to_owned(), value: Given::Text(value.to_owned()) })
        }
        _ => Err("write a name and its value, such as a=0.5".to_owned()),
    }
}

/// `A..B` with A < B.
pub fn frames(text: &str) -> Result<Range<u64>, String> {
    let ends = text.split_once("..").map(|(first, end)| (first.trim().parse(), end.trim().parse()));
    match ends {
        Some((Ok(first), Ok(end))) if first < end => Ok(first..end),
        Some((Ok(_), Ok(_))) => Err("the first number must be the smaller one".to_owned()),
        _ => Err("write the first frame and the one behind the last, such as 0..100".to_owned()),
    }
}

/// `depth=FILE`, `normal=FILE` or `certainty=FILE`.
pub fn layer(text: &str) -> Result<LayerArgument, String> {
    let Some((name, path)) = text.split_once('=').filter(|(_, path)| !path.is_empty()) else {
        return Err("write a layer and its file, such as depth=depth.png".to_owned());
    };
    let layer = match name.trim() {
        "depth" => Layer::Depth,
        "normal" => Layer::Normal,
        "certainty" => Layer::Certainty,
        _ => return Err(format!("there is no layer `{name}`; layers are depth, normal and certainty")),
    };
    Ok(LayerArgument { layer, path: path.into() })
}

/// A file whose ending says what goes into it.
pub fn report(text: &str) -> Result<ReportArgument, String> {
    let path = PathBuf::from(text);
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let format = match ending.as_deref() {
        Some("html") => ReportFormat::Html,
        Some("svg") => ReportFormat::Svg,
        Some("json") => ReportFormat::Json,
        Some("csv") => ReportFormat::Csv,
        _ => return Err("name a file that ends in .html, .svg, .json or .csv".to_owned()),
    };
    Ok(ReportArgument { path, format })
}

/// A file whose ending says what of an arrangement goes into it.
pub fn drawing(text: &str) -> Result<DrawingArgument, String> {
    let path = PathBuf::from(text);
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let format = match ending.as_deref() {
        Some("svg") => DrawingFormat::Svg,
        Some("png") => DrawingFormat::Png,
        Some("json") => DrawingFormat::Json,
        Some("geojson") => DrawingFormat::GeoJson,
        Some("dot") => DrawingFormat::Dot,
        _ => return Err("name a file that ends in .svg, .png, .json, .geojson or .dot".to_owned()),
    };
    Ok(DrawingArgument { path, format })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("640x480"), Ok((640, 480)));
        assert_eq!(size("96"), Ok((96, 96)));
        for wrong in ["", "x", "0x1", "1x0", "-1x5", "1x2x3", "99999x1", "a"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn reports_by_ending() {
        assert_eq!(report("a/b.HTML").map(|report| report.format), Ok(ReportFormat::Html));
        assert_eq!(report("b.csv").map(|report| report.format), Ok(ReportFormat::Csv));
        for wrong in ["", "html", "a.png", "a.html.gz"] {
            assert!(report(wrong).is_err(), "{wrong}");
        }
        assert_eq!(drawing("b.GeoJSON").map(|drawing| drawing.format), Ok(DrawingFormat::GeoJson));
        for wrong in ["", "svg", "a.html", "a.svg.gz"] {
            assert!(drawing(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn ranges_of_frames() {
        assert_eq!(frames("0..25"), Ok(0..25));
        for wrong in ["", "5", "5..5", "5..1", "-1..4", "a..b", "1..2..3"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn assignments() {
        let given = setting("a=1/3").map(|s| (s.name, s.value));
        assert_eq!(given, Ok(("a".to_owned(), Given::Text("1/3".to_owned()))));
        for wrong in ["", "a", "a=", "=1"] {
            assert!(setting(wrong).is_err(), "{wrong}");
        }
        assert!(layer("depth=d.png").is_ok());
        for wrong in ["depth", "depth=", "color=c.png", "=d.png"] {
            assert!(layer(wrong).is_err(), "{wrong}");
        }
        for wrong in ["0", "-1", "inf", "nan", "x"] {
            assert!(positive(wrong).is_err(), "{wrong}");
        }
    }
}
