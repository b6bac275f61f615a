//! The scene's settings: camera, lights, materials, background. Each is a statement that looks like a call, with constant
//! arguments.

use std::collections::HashMap;

use crate::diagnostic::Span;
use crate::diagnostic::did_you_mean;
use crate::interval::Interval;
use crate::syntax::ast::Argument;
use crate::syntax::ast::Expr;
use crate::syntax::ast::ExprKind;
use crate::syntax::ast::Name;
use crate::syntax::ast::Statement;
use crate::syntax::ast::StatementKind;

use super::enclose::Enclosures;
use super::enclose::inputs_of;
use super::errors;
use super::lower::Lowerer;
use super::scene::Light;
use super::scene::LightPlacement;
use super::scene::Material;
use super::scene::Projection;
use super::scene::View;
use super::values::Meaning;

/// A setting of the scene and its arguments in their order.
#[derive(Debug)]
pub struct Setting {
    pub name: &'static str,
    pub arguments: &'static [&'static str],
    /// One line on what it does and in which units.
    pub help: &'static str,
}

/// Every setting.
pub static SETTINGS: &[Setting] = &[
    Setting {
        name: "camera",
        arguments: &["position", "target", "up", "fov", "projection"],
        help: "Where the picture is taken from: points in the scene, the vertical field of view in degrees, and \"perspective\" or \"orthographic\".",
    },
    Setting {
        name: "light",
        arguments: &["direction", "position", "color"],
        help: "A light: the direction towards it or its position, and its colour. Several are added up; light(\"none\") means none at all.",
    },
    Setting {
        name: "material",
        arguments: &["color", "ambient", "diffuse", "specular", "shininess"],
        help: "How surfaces reflect: a colour, three shares of 0 or more, and the exponent of the highlight. A shape's name in front, as in material(s, color = \"red\"), sets it for that shape alone.",
    },
    Setting { name: "background", arguments: &["color"], help: "The colour behind everything." },
];

/// Colours that have a name, as RGB in 0..1.
const COLORS: &[(&str, [f64; 3])] = &[
    ("black", [0.0, 0.0, 0.0]),
    ("white", [1.0, 1.0, 1.0]),
    ("gray", [0.5, 0.5, 0.5]),
    ("grey", [0.5, 0.5, 0.5]),
    ("silver", [0.75, 0.75, 0.75]),
    ("red", [0.85, 0.1, 0.1]),
    ("orange", [0.95, 0.5, 0.1]),
    ("gold", [0.9, 0.7, 0.2]),
    ("yellow", [0.95, 0.85, 0.1]),
    ("green", [0.15, 0.65, 0.2]),
    ("teal", [0.1, 0.6, 0.6]),
    ("cyan", [0.1, 0.8, 0.85]),
    ("blue", [0.15, 0.3, 0.85]),
    ("purple", [0.5, 0.2, 0.7]),
    ("magenta", [0.85, 0.15, 0.7]),
    ("pink", [0.95, 0.6, 0.7]),
    ("brown", [0.5, 0.3, 0.15]),
    ("copper", [0.8, 0.45, 0.25]),
    ("ivory", [0.95, 0.93, 0.85]),
];

/// The setting that a statement is, with its name and arguments as written.
pub(super) fn as_setting(statement: &Statement) -> Option<(&'static Setting, &Name, &[Argument])> {
    let StatementKind::Shape { keyword: None, name: None, relation, condition: None } = &statement.kind else {
        return None;
    };
    let ExprKind::Apply { callee, args } = &relation.kind else { return None };
    let setting = SETTINGS.iter().find(|setting| setting.name == callee.text)?;
    Some((setting, callee, args))
}

/// What the settings of a file have said so far.
#[derive(Debug, Default)]
pub(super) struct Settings {
    pub view: View,
    /// What can be set once and where it was.
    set: HashMap<String, Span>,
}

impl Settings {
    /// Carries out one setting. `shapes` are the names of the scene's shapes in order.
    pub fn apply(
        &mut self,
        lowerer: &mut Lowerer,
        (setting, callee, args): (&'static Setting, &Name, &[Argument]),
        shapes: &[String],
    ) {
        let (shape, args) = match args {
            [Argument { name: None, value: Expr { kind: ExprKind::Name(name), .. } }, rest @ ..]
                if setting.name == "material" && shapes.contains(name) =>
            {
                (Some(name), rest)
            }
            _ => (None, args),
        };
        if setting.name == "light" {
            return self.light(lowerer, setting, callee, args);
        }
        let what = match shape {
            Some(name) => format!("the material of `{name}`"),
            None => format!("the {}", setting.name),
        };
        if let Some(&first) = self.set.get(&what) {
            return lowerer.report(errors::set_twice(&what, callee.span, first));
        }
        self.set.insert(what, callee.span);
        let given = arguments(lowerer, setting, callee, args);
        let get = |name: &str| given.iter().find(|(argument, _)| *argument == name).map(|(_, expr)| *expr);
        match setting.name {
            "camera" => self.camera(lowerer, &get),
            "background" => self.view.background = get("color").and_then(|expr| lowerer.color(expr)),
            _ => {
                let material = lowerer.material(&get);
                match shape.and_then(|name| shapes.iter().position(|shape| shape == name)) {
                    Some(index) => self.view.materials.push((index, material)),
                    None => self.view.material = Some(material),
                }
            }
        }
    }

    fn camera<'e>(&mut self, lowerer: &mut Lowerer, get: &dyn Fn(&str) -> Option<&'e Expr>) {
        let camera = &mut self.view.camera;
        camera.position = get("position").and_then(|expr| lowerer.point(expr, "a position"));
        camera.target = get("target").and_then(|expr| lowerer.point(expr, "a target"));
        camera.up = get("up").and_then(|expr| lowerer.direction(expr));
        if let (Some(position), Some(target), Some(expr)) = (camera.position, camera.target, get("target"))
            && position == target
        {
            let title = "the camera looks at the place where it stands".to_owned();
            lowerer.report(errors::unknown_setting_value(title, expr.span).help("move its position or its target"));
        }
        if let Some(expr) = get("fov") {
            camera.fov = lowerer.number_in(
                expr,
                "the field of view",
                |fov| 0.0 < fov && fov < 180.0,
                "between 0 and 180 degrees",
            );
        }
        if let Some(expr) = get("projection") {
            camera.projection = lowerer.text(expr, "a projection").and_then(|text| match &*text {
                "perspective" => Some(Projection::Perspective),
                "orthographic" => Some(Projection::Orthographic),
                _ => {
                    let diagnostic =
                        errors::unknown_setting_value(format!("there is no projection \"{text}\""), expr.span);
                    lowerer.report(diagnostic.help("write \"perspective\" or \"orthographic\""));
                    None
                }
            });
        }
    }

    fn light(&mut self, lowerer: &mut Lowerer, setting: &'static Setting, callee: &Name, args: &[Argument]) {
        let none = match args {
            [Argument { name: None, value: Expr { kind: ExprKind::Text(text), .. } }] => text == "none",
            _ => false,
        };
        if none {
            match self.view.lights {
                None => self.view.lights = Some(Vec::new()),
                Some(_) => {
                    let first = self.set.get("a light").copied().unwrap_or(callee.span);
                    lowerer.report(errors::light_and_none(callee.span, first));
                }
            }
            self.set.insert("no light".to_owned(), callee.span);
            return;
        }
        if let Some(&first) = self.set.get("no light") {
            return lowerer.report(errors::light_and_none(callee.span, first));
        }
        self.set.insert("a light".to_owned(), callee.span);
        let given = arguments(lowerer, setting, callee, args);
        let get = |name: &str| given.iter().find(|(argument, _)| *argument == name).map(|(_, expr)| *expr);
        let color = match get("color") {
            Some(expr) => lowerer.color(expr),
            None => Some([1.0; 3]),
        };
        let placement = match (get("direction"), get("position")) {
            (Some(expr), None) => lowerer.direction(expr).map(LightPlacement::Direction),
            (None, Some(expr)) => lowerer.point(expr, "a position").map(LightPlacement::Position),
            (direction, _) => {
                let title = match direction {
                    Some(_) => "a light has a direction or a position, not both",
                    None => "a light needs a direction or a position",
                };
                let diagnostic = errors::unknown_setting_value(title.to_owned(), callee.span);
                lowerer.report(
                    diagnostic.help("for example `light(direction = [1, 2, 3])`, which points towards the light"),
                );
                None
            }
        };
        if let (Some(placement), Some(color)) = (placement, color) {
            self.view.lights.get_or_insert_default().push(Light { placement, color });
        }
    }
}

/// The arguments of a setting by name; those without one count in the order of the table.
fn arguments<'e>(
    lowerer: &mut Lowerer,
    setting: &'static Setting,
    callee: &Name,
    args: &'e [Argument],
) -> Vec<(&'static str, &'e Expr)> {
    let mut given: Vec<(&'static str, &'e Expr)> = Vec::new();
    let known = setting.arguments.join(", ");
    if args.is_empty() {
        let diagnostic = errors::argument_count(setting.name, "at least 1 argument", 0, callee.span, "nothing is set");
        lowerer.report(diagnostic.help(format!("arguments of `{}`: {known}", setting.name)));
    }
    for (position, argument) in args.iter().enumerate() {
        let name = match &argument.name {
            Some(name) => setting.arguments.iter().find(|known| **known == name.text).copied(),
            None => setting.arguments.get(position).copied(),
        };
        match (name, &argument.name) {
            (Some(name), _) if given.iter().any(|(other, _)| *other == name) => {
                lowerer.report(errors::argument_twice(setting.name, name, argument.value.span));
            }
            (Some(name), _) => given.push((name, &argument.value)),
            (None, Some(name)) => {
                let mut diagnostic = errors::unknown_argument(setting.name, &name.text, name.span, &known);
                if let Some(near) = did_you_mean(&name.text, setting.arguments.iter().copied()) {
                    diagnostic = diagnostic.help(format!("did you mean `{near}`?"));
                }
                lowerer.report(diagnostic);
            }
            (None, None) => {
                let takes = format!("at most {} arguments", setting.arguments.len());
                let label = "one argument too many";
                lowerer.report(errors::argument_count(setting.name, &takes, args.len(), argument.value.span, label));
                break;
            }
        }
    }
    given
}

impl Lowerer<'_> {
    /// The enclosure of a constant expression; `needs` completes "... must be a constant".
    pub fn constant_interval(&mut self, expr: &Expr, needs: &str) -> Option<Interval> {
        let meaning = self.lower(expr);
        let value = self.scalar(&format!("{needs} must be a number"), &meaning, expr.span)?;
        if let Some(name) = inputs_of(&self.graph, &[value]).first() {
            self.report(errors::not_constant(needs, expr.span, name));
            return None;
        }
        let mut enclosures = Enclosures::new(&self.graph, &[value]);
        enclosures.evaluate(&[]);
        let number = enclosures.root(0);
        if number.is_bounded() {
            return Some(number);
        }
        self.report(errors::not_finite(needs, expr.span));
        None
    }

    /// A constant rounded to `f64`.
    fn number(&mut self, expr: &Expr, needs: &str) -> Option<f64> {
        self.constant_interval(expr, needs).map(Interval::mid)
    }

    fn number_in(&mut self, expr: &Expr, what: &str, accept: fn(f64) -> bool, range: &str) -> Option<f64> {
        let number = self.number(expr, what)?;
        if accept(number) {
            return Some(number);
        }
        self.report(errors::out_of_range(what, number, range, expr.span));
        None
    }

    fn text(&mut self, expr: &Expr, needs: &str) -> Option<std::rc::Rc<str>> {
        match self.lower(expr) {
            Meaning::Text(text) => Some(text),
            other => {
                self.report_kind(&format!("{needs} is a text in quotes"), &other, expr.span);
                None
            }
        }
    }

    /// Three constants written as a list.
    fn point(&mut self, expr: &Expr, needs: &str) -> Option<[f64; 3]> {
        let values = match self.lower(expr) {
            Meaning::Vector(values) if values.len() == 3 => values,
            Meaning::Vector(values) => {
                let found = format!("a list of {}", values.len());
                self.report(errors::wrong_kind(&format!("{needs} is a list of three numbers"), &found, expr.span));
                return None;
            }
            other => {
                self.report_kind(&format!("{needs} is a list of three numbers"), &other, expr.span);
                return None;
            }
        };
        if let Some(name) = inputs_of(&self.graph, &values).first() {
            self.report(errors::not_constant(needs, expr.span, name));
            return None;
        }
        let mut enclosures = Enclosures::new(&self.graph, &values);
        enclosures.evaluate(&[]);
        let numbers = [0, 1, 2].map(|i| enclosures.root(i));
        if numbers.iter().all(|number| number.is_bounded()) {
            return Some(numbers.map(Interval::mid));
        }
        self.report(errors::not_finite(needs, expr.span));
        None
    }

    fn direction(&mut self, expr: &Expr) -> Option<[f64; 3]> {
        let vector = self.point(expr, "a direction")?;
        if vector == [0.0; 3] {
            let title = "a direction of length 0 points nowhere".to_owned();
            self.report(errors::unknown_setting_value(title, expr.span));
            return None;
        }
        Some(vector)
    }

    /// `[r, g, b]` in 0..1, a name, or "#rrggbb".
    fn color(&mut self, expr: &Expr) -> Option<[f64; 3]> {
        if let ExprKind::Text(text) = &expr.kind {
            if let Some(color) = hexadecimal(text) {
                return Some(color);
            }
            if let Some((_, color)) = COLORS.iter().find(|(name, _)| name.eq_ignore_ascii_case(text)) {
                return Some(*color);
            }
            let diagnostic = errors::unknown_setting_value(format!("there is no colour named \"{text}\""), expr.span);
            let help = match did_you_mean(text, COLORS.iter().map(|(name, _)| *name)) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "write [r, g, b] with numbers from 0 to 1, or \"#rrggbb\"".to_owned(),
            };
            self.report(diagnostic.help(help));
            return None;
        }
        let color = self.point(expr, "a colour")?;
        match color.iter().find(|share| !(0.0..=1.0).contains(*share)) {
            None => Some(color),
            Some(&share) => {
                let diagnostic = errors::out_of_range("a share of a colour", share, "from 0 to 1", expr.span);
                self.report(diagnostic.help("[1, 1, 1] is white; divide numbers up to 255 by 255"));
                None
            }
        }
    }

    fn material<'e>(&mut self, get: &dyn Fn(&str) -> Option<&'e Expr>) -> Material {
        let mut material = Material::default();
        if let Some(color) = get("color").and_then(|expr| self.color(expr)) {
            material.color = color;
        }
        let shares = [
            ("ambient", &mut material.ambient),
            ("diffuse", &mut material.diffuse),
            ("specular", &mut material.specular),
            ("shininess", &mut material.shininess),
        ];
        for (name, place) in shares {
            let Some(expr) = get(name) else { continue };
            if let Some(number) = self.number_in(expr, &format!("`{name}`"), |number| number >= 0.0, "0 or more") {
                *place = number;
            }
        }
        material
    }
}

/// `#rrggbb`
fn hexadecimal(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let mut color = [0.0; 3];
    for (i, share) in color.iter_mut().enumerate() {
        *share = f64::from(u8::from_str_radix(&digits[2 * i..2 * i + 2], 16).ok()?) / 255.0;
    }
    Some(color)
}
