//! Feeds the questions of many searches to the kernels: each kernel has a batch whose lanes hold the rays that wait for
//! its answer, and the fullest batch runs next.

use crate::accuracy::finder::Found;
use crate::accuracy::finder::kernels::Lanes;
use crate::accuracy::finder::kernels::Programs;
use crate::accuracy::finder::kernels::Reach;
use crate::accuracy::finder::search::Answer;
use crate::accuracy::finder::search::Question;
use crate::accuracy::finder::search::Rules;
use crate::accuracy::finder::search::Search;
use crate::interval::Interval;
use crate::kernel::Real;
use crate::render::Batch;
use crate::render::Program;
use crate::render::Ray;

/// Packets of a batch.
const GROUPS: usize = 16;

/// A search with its ray.
struct Task {
    pixel: usize,
    ray: Ray,
    search: Search,
}

/// What a kernel answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Field,
    Slope,
    Point,
}

/// A kernel's batch and the searches in its lanes.
struct Desk<T: Real> {
    kind: Kind,
    batch: Batch<T>,
    /// The task of each lane.
    waiting: Vec<usize>,
}

impl<T: Real> Desk<T> {
    fn new(kind: Kind, program: &Program<T>) -> Self {
        Self { kind, batch: Batch::new(program, GROUPS), waiting: Vec::with_capacity(GROUPS * T::LANES) }
    }

    /// Puts a search into the next lane.
    fn seat(&mut self, lanes: &Lanes<'_>, task: usize, ray: &Ray, question: &Question) {
        let lane = self.waiting.len();
        self.waiting.push(task);
        match self.kind {
            Kind::Point => lanes.set_point_ray(&mut self.batch, lane, ray),
            Kind::Field | Kind::Slope => lanes.set_ray(&mut self.batch, lane, ray),
        }
        self.write(lanes, lane, question);
    }

    /// Another question by the search in a lane.
    fn write(&mut self, lanes: &Lanes<'_>, lane: usize, question: &Question) {
        match (self.kind, *question) {
            (Kind::Point, Question::Point(t)) => lanes.set_point(&mut self.batch, lane, t),
            (_, Question::Point(t)) => lanes.set_span(&mut self.batch, lane, [t, t]),
            (_, Question::Field(span) | Question::Slope(span)) => lanes.set_span(&mut self.batch, lane, span),
        }
    }

    fn read(&self, lanes: &Lanes<'_>, lane: usize) -> Answer {
        match self.kind {
            Kind::Field => lanes.field(&self.batch, lane),
            Kind::Slope => lanes.slope(&self.batch, lane),
            Kind::Point => lanes.point(&self.batch, lane),
        }
    }

    /// Fills the hole that a search leaves with the last one.
    fn leave(&mut self, lane: usize) {
        let last = self.waiting.len() - 1;
        if lane != last {
            self.batch.copy_lane(last, lane);
        }
        self.waiting.swap_remove(lane);
    }
}

/// The searches of one worker.
pub struct Driver<'a, T: Real> {
    rules: Rules,
    lanes: Lanes<'a>,
    desks: Vec<Desk<T>>,
}

impl<'a, T: Real> Driver<'a, T> {
    pub fn new(programs: &Programs<T>, reach: &'a Reach, rules: Rules) -> Self {
        let mut desks = vec![Desk::new(Kind::Field, &programs.field)];
        desks.extend(programs.slope.as_ref().map(|program| Desk::new(Kind::Slope, program)));
        desks.extend(programs.point.as_ref().map(|program| Desk::new(Kind::Point, program)));
        Self { rules, lanes: Lanes { reach, condition: rules.condition }, desks }
    }

    /// What is found along each of the rays, and the number of evaluations.
    pub fn run(mut self, rays: &[Option<Ray>], domain: &[Interval], epsilon: f64) -> (Vec<Found>, u64) {
        let mut found = vec![Found::MISS; rays.len()];
        let rules = self.rules;
        let mut starting = rays.iter().enumerate().filter_map(|(pixel, ray)| {
            let ray = (*ray)?;
            let (entry, exit) = ray.clip(domain)?;
            let (search, question) = Search::new(rules, [entry[0], exit[1]], epsilon / length(&ray));
            Some((Task { pixel, ray, search }, question))
        });
        let mut tasks: Vec<Task> = Vec::with_capacity(GROUPS * T::LANES);
        let mut free: Vec<usize> = Vec::new();
        loop {
            // No batch overflows: there are no more tasks than lanes in each of them.
            while !free.is_empty() || tasks.len() < GROUPS * T::LANES {
                let Some((task, question)) = starting.next() else { break };
                let index = free.pop().unwrap_or(tasks.len());
                let desk = self.desk(&question);
                self.desks[desk].seat(&self.lanes, index, &task.ray, &question);
                if index < tasks.len() {
                    tasks[index] = task;
                } else {
                    tasks.push(task);
                }
            }
            let fullest = (0..self.desks.len()).max_by_key(|&desk| self.desks[desk].waiting.len()).unwrap_or(0);
            let count = self.desks[fullest].waiting.len();
            if count == 0 {
                break;
            }
            self.desks[fullest].batch.run(count);
            // Downwards, so that a hole is filled by a lane that is dealt with already.
            for lane in (0..count).rev() {
                let desk = &self.desks[fullest];
                let (answer, index) = (desk.read(&self.lanes, lane), desk.waiting[lane]);
                let task = &mut tasks[index];
                let question = task.search.answer(&answer);
                match question.map(|question| (self.desk(&question), question)) {
                    Some((desk, question)) if desk == fullest => {
                        self.desks[fullest].write(&self.lanes, lane, &question);
                    }
                    Some((desk, question)) => {
                        self.desks[fullest].leave(lane);
                        self.desks[desk].seat(&self.lanes, index, &task.ray, &question);
                    }
                    None => {
                        self.desks[fullest].leave(lane);
                        found[task.pixel] = Found { hit: task.search.hit, clear: task.search.clear, proved: false };
                        free.push(index);
                    }
                }
            }
        }
        (found, self.desks.iter().map(|desk| desk.batch.evaluations).sum())
    }

    /// The desk that answers a question; points without a kernel of their own are intervals of no width.
    fn desk(&self, question: &Question) -> usize {
        let kind = match question {
            Question::Field(_) => Kind::Field,
            Question::Slope(_) => Kind::Slope,
            Question::Point(_) => Kind::Point,
        };
        self.desks.iter().position(|desk| desk.kind == kind).unwrap_or(0)
    }
}

/// The length of a ray's direction.
pub fn length(ray: &Ray) -> f64 {
    ray.direction.iter().map(|d| d * d).sum::<f64>().sqrt()
}
