//! Placeholder.
use crate::render::march::Refuted;
use crate::render::options::Options;
use crate::render::outcome::Outcome;
use crate::render::stats::Stats;

#[derive(Debug, Clone)]
pub struct Certificate {
    covers: Vec<Vec<(Vec<Refuted>, Vec<Outcome>)>>,
}
impl Certificate {
    pub fn new(_options: &Options, _stats: &Stats, covers: Vec<Vec<(Vec<Refuted>, Vec<Outcome>)>>) -> Self {
        Self { covers }
    }
}
