//! The functions whose zeros make an arrangement, with their gradients, on many boxes at once.

use crate::diagnostic::Diagnostic;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::program::scene::Scene;

/// An index into the functions of [`Fields`].
pub type Function = u32;

/// A function on a box: enclosures of its value and of its partial derivatives, and the verdict bits of the value
/// ([`crate::kernel::verdict`]). The derivatives say something only where the value is proved `CONTINUOUS`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    pub value: Interval,
    pub slope: [Interval; 2],
    pub bits: u32,
}

/// A zero set that no other component shares: the scene's curves are unions of components.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    pub function: Function,
    pub uses: Vec<Use>,
}

/// A curve that a component belongs to, where a condition holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Use {
    /// Index of the scene's shape.
    pub curve: u16,
    /// A truth value (0 or 1) that must be 1; `None` if there is no condition.
    pub condition: Option<Function>,
    /// Functions at whose zeros the condition may change.
    pub atoms: Vec<Function>,
}

/// All functions of an arrangement, compiled.
pub struct Fields {
    pub domain: [Interval; 2],
    pub curves: Vec<String>,
    /// The fields of the scene's shapes as written, by shape: their signs are those of faces.
    pub shapes: Vec<Function>,
    pub components: Vec<Component>,
}

impl Fields {
    /// Compiles what an arrangement of the scene needs.
    ///
    /// # Errors
    /// If the scene is not one of plane curves, or the backend fails.
    pub fn new(_scene: &Scene, _backend: &dyn Backend) -> Result<Self, Diagnostic> {
        todo!()
    }

    /// Samples of functions on boxes, in the order asked. A point is a box of width 0.
    pub fn evaluate(&self, _queries: &[(Function, [Interval; 2])]) -> Vec<Sample> {
        todo!()
    }
}
