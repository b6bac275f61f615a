//! Feeds the questions of many searches to the kernels: each kernel has a batch whose lanes hold the rays that wait for
//! its answer, and the fullest batch runs next.

use std::ops::AddAssign;

use crate::accuracy::finder::Found;
use crate::accuracy::finder::kernels::Lanes;
use crate::accuracy::finder::kernels::Programs;
use crate::accuracy::finder::search::Answer;
use crate::accuracy::finder::search::Kind;
use crate::accuracy::finder::search::Question;
use crate::kernel::Real;
use crate::render::Batch;
use crate::render::Program;
use crate::render::Ray;

/// Packets of a batch.
const GROUPS: usize = 16;

/// Lanes evaluated, by what was asked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Evaluations {
    /// The field over intervals.
    pub fields: u64,
    /// The slope over intervals.
    pub slopes: u64,
    /// The field at points.
    pub points: u64,
}

impl Evaluations {
    /// Each question is one evaluation a ray.
    fn count<const N: usize>(&mut self, question: &Question<N>) {
        match question.kind {
            Kind::Field | Kind::Boxes => self.fields += N as u64,
            Kind::Slope => self.slopes += N as u64,
            Kind::Point => self.points += N as u64,
        }
    }
}

impl AddAssign for Evaluations {
    fn add_assign(&mut self, other: Self) {
        self.fields += other.fields;
        self.slopes += other.slopes;
        self.points += other.points;
    }
}

/// A search along `N` rays at once: it asks, is answered, and asks again until it knows what each ray meets first.
pub trait Pursuit<const N: usize> {
    fn rays(&self) -> [Ray; N];

    /// Takes an answer a ray; the next question, or `None` when the search has ended.
    fn answer(&mut self, answers: &[Answer; N]) -> Option<Question<N>>;

    /// Writes what was found to the pixels of the rays.
    fn report(&self, found: &mut [Found]);
}

/// A kernel's batch and the searches in its lanes.
struct Desk<T: Real> {
    kind: Kind,
    batch: Batch<T>,
    /// The search in each `N` lanes, by its index.
    waiting: Vec<usize>,
}

impl<T: Real> Desk<T> {
    fn new(kind: Kind, program: &Program<T>) -> Self {
        Self { kind, batch: Batch::new(program, GROUPS), waiting: Vec::new() }
    }

    /// Puts a search behind the others.
    fn seat<const N: usize>(&mut self, lanes: &Lanes<'_>, search: usize, rays: &[Ray; N], question: &Question<N>) {
        let place = self.waiting.len();
        self.waiting.push(search);
        for (i, ray) in rays.iter().enumerate() {
            match self.kind {
                Kind::Point => lanes.set_point_ray(&mut self.batch, N * place + i, ray),
                Kind::Field | Kind::Slope => lanes.set_ray(&mut self.batch, N * place + i, ray),
                // Boxes are made from the ray with every question.
                Kind::Boxes => {}
            }
        }
        self.write(lanes, place, rays, question);
    }

    /// Another question by the search at a place.
    fn write<const N: usize>(&mut self, lanes: &Lanes<'_>, place: usize, rays: &[Ray; N], question: &Question<N>) {
        for (i, &span) in question.spans.iter().enumerate() {
            let lane = N * place + i;
            match self.kind {
                Kind::Point => lanes.set_point(&mut self.batch, lane, span[0]),
                Kind::Field | Kind::Slope => lanes.set_span(&mut self.batch, lane, span),
                Kind::Boxes => lanes.set_boxes(&mut self.batch, lane, &rays[i], span),
            }
        }
    }

    fn read<const N: usize>(&self, lanes: &Lanes<'_>, place: usize) -> [Answer; N] {
        std::array::from_fn(|i| match self.kind {
            Kind::Field | Kind::Boxes => lanes.field(&self.batch, N * place + i),
            Kind::Slope => lanes.slope(&self.batch, N * place + i),
            Kind::Point => lanes.point(&self.batch, N * place + i),
        })
    }

    /// Fills the hole that a search leaves with the last one.
    fn leave<const N: usize>(&mut self, place: usize) {
        let last = self.waiting.len() - 1;
        if place != last {
            for i in 0..N {
                self.batch.copy_lane(N * last + i, N * place + i);
            }
        }
        self.waiting.swap_remove(place);
    }
}

/// The searches of one worker.
pub struct Driver<'a, T: Real> {
    lanes: Lanes<'a>,
    desks: Vec<Desk<T>>,
}

impl<'a, T: Real> Driver<'a, T> {
    pub fn new(programs: &Programs<T>, lanes: Lanes<'a>) -> Self {
        let mut desks = vec![Desk::new(Kind::Field, &programs.field)];
        desks.extend(programs.slope.as_ref().map(|program| Desk::new(Kind::Slope, program)));
        desks.extend(programs.point.as_ref().map(|program| Desk::new(Kind::Point, program)));
        desks.extend(programs.boxes.as_ref().map(|program| Desk::new(Kind::Boxes, program)));
        Self { lanes, desks }
    }

    /// Runs searches, each given with its first question, to their end.
    pub fn run<const N: usize, P: Pursuit<N>>(
        mut self,
        mut starting: impl Iterator<Item = (P, Question<N>)>,
        found: &mut [Found],
    ) -> Evaluations {
        let capacity = GROUPS * T::LANES / N;
        let mut searches: Vec<P> = Vec::with_capacity(capacity);
        let mut free: Vec<usize> = Vec::new();
        let mut evaluations = Evaluations::default();
        loop {
            // No batch overflows: there are no more searches than places in each of them.
            while !free.is_empty() || searches.len() < capacity {
                let Some((search, question)) = starting.next() else { break };
                let index = free.pop().unwrap_or(searches.len());
                evaluations.count(&question);
                let desk = self.desk(question.kind);
                self.desks[desk].seat(&self.lanes, index, &search.rays(), &question);
                if index < searches.len() {
                    searches[index] = search;
                } else {
                    searches.push(search);
                }
            }
            let fullest = (0..self.desks.len()).max_by_key(|&desk| self.desks[desk].waiting.len()).unwrap_or(0);
            let count = self.desks[fullest].waiting.len();
            if count == 0 {
                return evaluations;
            }
            self.desks[fullest].batch.run(N * count);
            // Downwards, so that a hole is filled by a search that is dealt with already.
            for place in (0..count).rev() {
                let desk = &self.desks[fullest];
                let (answers, index) = (desk.read(&self.lanes, place), desk.waiting[place]);
                let search = &mut searches[index];
                let question = search.answer(&answers);
                if let Some(question) = &question {
                    evaluations.count(question);
                }
                match question.map(|question| (self.desk(question.kind), question)) {
                    Some((desk, question)) if desk == fullest => {
                        self.desks[fullest].write(&self.lanes, place, &search.rays(), &question);
                    }
                    Some((desk, question)) => {
                        self.desks[fullest].leave::<N>(place);
                        self.desks[desk].seat(&self.lanes, index, &search.rays(), &question);
                    }
                    None => {
                        self.desks[fullest].leave::<N>(place);
                        search.report(found);
                        free.push(index);
                    }
                }
            }
        }
    }

    /// The desk that answers a question; points without a kernel of their own are intervals of no width.
    fn desk(&self, kind: Kind) -> usize {
        self.desks.iter().position(|desk| desk.kind == kind).unwrap_or(0)
    }
}

/// The length of a ray's direction.
pub fn length(ray: &Ray) -> f64 {
    ray.direction.iter().map(|d| d * d).sum::<f64>().sqrt()
}
