//! What a picture consists of, for whatever draws it: layers of marks in pixels, y downwards.

/// sRGB.
pub type Color = [u8; 3];

pub type Point = [f64; 2];

#[derive(Debug, Clone)]
pub struct Drawing {
    pub width: u32,
    pub height: u32,
    pub layers: Vec<Layer>,
}

/// Marks that are shown or hidden together.
#[derive(Debug, Clone)]
pub struct Layer {
    pub name: &'static str,
    pub marks: Vec<Mark>,
}

#[derive(Debug, Clone)]
pub struct Mark {
    pub shape: Shape,
    pub fill: Option<Color>,
    pub stroke: Option<Stroke>,
    /// Shown to who points at it.
    pub title: Option<String>,
}

#[derive(Debug, Clone, Copy)]
pub struct Stroke {
    pub color: Color,
    pub width: f64,
    /// Lengths of dash and gap.
    pub dash: Option<[f64; 2]>,
}

#[derive(Debug, Clone)]
pub enum Shape {
    /// Closed rings, filled where an odd number of them goes around.
    Area(Vec<Vec<Point>>),
    /// Open lines.
    Lines(Vec<Vec<Point>>),
    Disc {
        centre: Point,
        radius: f64,
    },
    Text {
        at: Point,
        anchor: Anchor,
        size: f64,
        text: String,
    },
}

/// Which part of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

impl Mark {
    pub fn filled(shape: Shape, color: Color) -> Self {
        Self { shape, fill: Some(color), stroke: None, title: None }
    }

    pub fn stroked(shape: Shape, color: Color, width: f64) -> Self {
        Self { shape, fill: None, stroke: Some(Stroke { color, width, dash: None }), title: None }
    }

    /// Filled with one colour and outlined with another.
    pub fn outlined(shape: Shape, fill: Color, color: Color, width: f64) -> Self {
        Self { fill: Some(fill), ..Self::stroked(shape, color, width) }
    }

    pub fn dashed(mut self, dash: [f64; 2]) -> Self {
        if let Some(stroke) = &mut self.stroke {
            stroke.dash = Some(dash);
        }
        self
    }

    pub fn titled(self, title: String) -> Self {
        Self { title: Some(title), ..self }
    }
}
