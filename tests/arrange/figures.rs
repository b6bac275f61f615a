//! Counts an arrangement by its halfedges alone, to set beside what is known.

use std::collections::BTreeMap;
use std::collections::BTreeSet;

use imp::arrange::Arrangement;
use imp::arrange::Options;
use imp::arrange::check;
use imp::arrange::complex::VertexKind;
use imp::arrange::structure::EdgeKind;
use imp::control::Control;
use imp::diagnostic;
use imp::session;
use imp::session::Source;

use super::cases::Truth;

/// The arrangement of a scene, or what is said instead.
pub fn arranged(scene: &str, options: &Options) -> Result<Arrangement, String> {
    let artefact = session::compile(Source::Text { name: "case.imp", text: scene }, &[]);
    let Some(compiled) = &artefact.scene else {
        return Err(diagnostic::render(&artefact.sources, &artefact.diagnostics, false));
    };
    imp::arrange::arrange(compiled, options, session::backend(), &Control::default()).map_err(|said| said.title)
}

/// The figures of an arrangement, those of its proved parts apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figures {
    pub proved: bool,
    pub faces: usize,
    pub components: usize,
    pub all: Vertices,
    pub certain: Vertices,
}

/// Vertices by what they have.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Vertices {
    pub isolated: usize,
    pub boundary: usize,
    /// Of those inside by the number of arms, without 0 and 2.
    pub degrees: BTreeMap<usize, usize>,
}

impl Vertices {
    fn add(&mut self, kind: VertexKind, arms: usize) {
        match (kind, arms) {
            (VertexKind::Boundary, _) => self.boundary += 1,
            (_, 0) => self.isolated += 1,
            (_, 2) => {}
            _ => *self.degrees.entry(arms).or_default() += 1,
        }
    }
}

impl Figures {
    /// Counts, after a check of the arrangement; an error if the two disagree.
    pub fn of(arrangement: &Arrangement) -> Result<Self, String> {
        let counts = check::check(arrangement).map_err(|fault| fault.to_string())?;
        let mut figures = Self {
            proved: arrangement.proved,
            faces: arrangement.faces.len() - 1,
            components: 0,
            all: Vertices::default(),
            certain: Vertices::default(),
        };
        let mut arms = vec![0; arrangement.vertices.len()];
        let mut part: Vec<usize> = (0..arms.len()).collect();
        for (edge, sides) in arrangement.edges.iter().zip(arrangement.halfedges.chunks_exact(2)) {
            if edge.kind == EdgeKind::Frame {
                continue;
            }
            let [a, b] = [sides[0].origin as usize, sides[1].origin as usize];
            arms[a] += 1;
            arms[b] += 1;
            let (from, to) = (part[a], part[b]);
            part.iter_mut().filter(|p| **p == from).for_each(|p| *p = to);
        }
        let mut parts = BTreeSet::new();
        for (v, arranged) in arrangement.vertices.iter().enumerate() {
            if arranged.vertex.kind == VertexKind::Corner && arms[v] == 0 {
                continue;
            }
            parts.insert(part[v]);
            figures.all.add(arranged.vertex.kind, arms[v]);
            if arranged.vertex.proved {
                figures.certain.add(arranged.vertex.kind, arms[v]);
            }
        }
        figures.components = parts.len();
        let told = (counts.faces as usize, counts.components as usize, counts.isolated as usize, counts.proved);
        let seen = (figures.faces, figures.components, figures.all.isolated, figures.proved);
        if told == seen { Ok(figures) } else { Err(format!("told {told:?}, counted {seen:?}")) }
    }

    /// What contradicts the truth: all of it if everything is proved, else what the proved vertices say.
    pub fn against(&self, truth: &Truth) -> Option<String> {
        let degrees: BTreeMap<usize, usize> = truth.degrees.iter().copied().collect();
        let right = if self.proved {
            let told = (self.faces, self.components, self.all.isolated, self.all.boundary, &self.all.degrees);
            told == (truth.faces, truth.components, truth.isolated, truth.boundary, &degrees)
        } else {
            self.certain.isolated <= truth.isolated
                && self.certain.boundary <= truth.boundary
                && self.certain.degrees.iter().all(|(d, n)| degrees.get(d).is_some_and(|most| n <= most))
        };
        (!right).then(|| format!("known {truth:?}, found {self:?}"))
    }
}
