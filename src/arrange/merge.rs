//! Two scenes as one, for the arrangement of all their curves.
//!
//! Tilings are not merged: a leaf of one knows nothing of the other's curves, so that starting from the leaves of both
//! would ask every curve everywhere, where the way down from the whole domain excludes most of them early.

use std::collections::HashMap;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::program::scene::Scene;
use crate::program::scene::Shape;

/// The scene of all curves of two scenes over the same domain, those of the first one first: [`crate::arrange::arrange`] makes
/// the overlay of their arrangements of it. Curves of equal names get numbers; parameters of equal names are one.
///
/// # Errors
/// If the domains differ, or a parameter of both has different values.
pub fn merge(a: &Scene, b: &Scene) -> Result<Scene, Diagnostic> {
    if a.domain != b.domain {
        let title = "arrangements over different domains cannot be merged";
        return Err(Diagnostic::error(code::BAD_OPTION, title).help("give both scenes the same `domain`"));
    }
    let mut scene = a.clone();
    for parameter in &b.parameters {
        match a.parameters.iter().find(|known| known.name == parameter.name) {
            None => scene.parameters.push(parameter.clone()),
            Some(known) if known.value == parameter.value => {}
            Some(_) => {
                let title = format!("the parameter `{}` has two values", parameter.name);
                return Err(
                    Diagnostic::error(code::BAD_OPTION, title).help("give it another name in one of the scenes")
                );
            }
        }
    }
    for shape in &b.shapes {
        let roots: Vec<_> = [Some(shape.field), shape.condition].into_iter().flatten().collect();
        let images = scene.graph.import(&b.graph, &roots, &HashMap::new());
        let taken = |name: &str| scene.shapes.iter().any(|shape| shape.name == name);
        let numbered = (2..).map(|number| format!("{}{number}", shape.name)).find(|name| !taken(name));
        let name = if taken(&shape.name) { numbered.unwrap_or_default() } else { shape.name.clone() };
        scene.shapes.push(Shape { name, field: images[0], condition: images.get(1).copied(), ..shape.clone() });
    }
    Ok(scene)
}
