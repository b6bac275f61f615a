//! Drawings as SVG: layers are groups with the layer's name as `id`, which viewers and style sheets can switch.

use std::fmt::Write;

use maud::Markup;
use maud::html;

use crate::arrange::export::drawing::Anchor;
use crate::arrange::export::drawing::Color;
use crate::arrange::export::drawing::Drawing;
use crate::arrange::export::drawing::Mark;
use crate::arrange::export::drawing::Point;
use crate::arrange::export::drawing::Shape;

/// The drawing as an SVG document.
pub fn svg(drawing: &Drawing) -> String {
    let Drawing { width, height, layers } = drawing;
    let view = format!("0 0 {width} {height}");
    // Every element has an end tag: without one, markup meant for HTML is no XML.
    let markup = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox=(view)
            font-family="DejaVu Sans, Verdana, sans-serif" stroke-linejoin="round" stroke-linecap="round" {
            rect width=(width) height=(height) fill="#ffffff" {}
            @for layer in layers {
                g id=(layer.name) {
                    @for mark in &layer.marks { (element(mark)) "\n" }
                }
                "\n"
            }
        }
    };
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n", markup.into_string())
}

fn element(mark: &Mark) -> Markup {
    let fill = mark.fill.map_or("none".to_owned(), hex);
    let stroke = mark.stroke.map(|stroke| hex(stroke.color));
    let width = mark.stroke.map(|stroke| number(stroke.width));
    let dash = mark.stroke.and_then(|stroke| stroke.dash).map(|[on, off]| format!("{} {}", number(on), number(off)));
    let title = html! { @if let Some(title) = &mark.title { title { (title) } } };
    match &mark.shape {
        Shape::Area(rings) => html! {
            path d=(path(rings, true)) fill=(fill) fill-rule="evenodd" stroke=[stroke] stroke-width=[width]
                stroke-dasharray=[dash] { (title) }
        },
        Shape::Lines(lines) => html! {
            path d=(path(lines, false)) fill="none" stroke=[stroke] stroke-width=[width] stroke-dasharray=[dash] { (title) }
        },
        Shape::Disc { centre: [x, y], radius } => html! {
            circle cx=(number(*x)) cy=(number(*y)) r=(number(*radius)) fill=(fill) stroke=[stroke] stroke-width=[width] {
                (title)
            }
        },
        Shape::Text { at: [x, y], anchor, size, text } => html! {
            text x=(number(*x)) y=(number(*y)) text-anchor=(anchor_name(*anchor)) font-size=(number(*size)) fill=(fill) {
                (title) (text)
            }
        },
    }
}

fn anchor_name(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    }
}

fn path(lines: &[Vec<Point>], closed: bool) -> String {
    let mut text = String::new();
    for line in lines {
        for (index, [x, y]) in line.iter().enumerate() {
            let command = if index == 0 { 'M' } else { 'L' };
            write!(text, "{command}{} {}", number(*x), number(*y)).expect("a string takes all text");
        }
        if closed {
            text.push('Z');
        }
    }
    text
}

/// Hundredths of a pixel, without zeros at the end.
fn number(value: f64) -> String {
    let rounded = (100.0 * value).round() / 100.0;
    // Adding zero turns -0 into 0.
    format!("{}", rounded + 0.0)
}

fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrange::export::canvas::Style;
    use crate::arrange::export::picture;
    use crate::arrange::export::samples::sample;

    #[test]
    fn layers_are_groups_and_texts_are_escaped() {
        let text = svg(&picture::draw(sample().traced(), &Style { boxes: true, ..Style::default() }));
        let groups: Vec<&str> = text.split("<g id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        assert_eq!(groups, ["faces", "boxes", "edges", "unresolved", "vertices", "frame", "labels"]);
        // Six faces, nine edges of which one belongs to two curves, eight vertices; two marks of the cluster.
        let group =
            |name: &str| text.split(&format!("<g id=\"{name}\">")).nth(1).unwrap().split("</g>").next().unwrap();
        let count = |name: &str| group(name).matches("<title>").count();
        assert_eq!([count("faces"), count("edges"), count("vertices")], [6, 10, 8]);
        assert_eq!(group("unresolved").matches("#d55e00").count(), 2);
        assert!(text.contains("circle &lt;1&gt;") && text.contains("arc &amp; co"));
        assert!(!text.contains("NaN") && !text.contains("inf"));
        // Whatever is opened is closed: it is XML, not only HTML.
        for name in ["svg", "g", "rect", "path", "circle", "text", "title"] {
            let opened = text.matches(&format!("<{name}>")).count() + text.matches(&format!("<{name} ")).count();
            assert_eq!(opened, text.matches(&format!("</{name}>")).count(), "{name}");
        }
    }
}
