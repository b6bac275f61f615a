//! How fine and how far an arrangement is computed.

/// Choices of the solver.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Cells are not quartered below this side; what is open there becomes a cluster. `None`: 2^-30 of the domain's side.
    pub epsilon: Option<f64>,
    /// Cells of one connected open region beyond which it is given up as a cluster of the size it has then.
    pub region: usize,
    /// Whether exact arithmetic may settle clusters of polynomial curves.
    pub exact: bool,
    /// Worker threads; `None` for one per processor. The result does not depend on them.
    pub threads: Option<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self { epsilon: None, region: 4096, exact: true, threads: None }
    }
}
