//! The search along one ray as a state machine: it asks, and is told what the kernel says.
//!
//! All methods keep a stack of intervals of the ray parameter, the nearest on top, and drop an interval over which 0 is
//! refuted. They differ in what else they ask before they halve it. Against the printed algorithms (Flórez 2008,
//! section 4.3), these repairs:
//!
//! - the midpoint is (t1 + t2) / 2, where figures 4.7 and 4.8 print t1 + (t1 + t2) / 2;
//! - an interval narrower than the threshold is a root only if 0 was not refuted on it, which figures 4.7 and 4.8 do not ask;
//! - an interval that the Newton operator hardly shrinks is halved, so that the search ends whatever the slope's
//!   enclosure does;
//! - the slope and the Newton operator are believed only where the field is continuous: a pole has slopes of one sign;
//! - an interval over which the field is unbounded is no hit, but something that was passed over (Hijazi 2008, section
//!   7.2.6);
//! - where rounding leaves the sign of a point open, signs to both sides of it are sought.
//!
//! MRF rejects the half behind a change of sign. A search that looks at the nearer half first never opens the other one
//! unless the nearer one was empty after all, so there is nothing to reject here.

use crate::accuracy::finder::Finder;
use crate::accuracy::finder::Found;
use crate::accuracy::finder::drive::Pursuit;
use crate::accuracy::finder::drive::length;
use crate::interval::Interval;
use crate::kernel::verdict;
use crate::render::Ray;

/// An interval of the ray parameter.
pub type Span = [f64; 2];

/// What a search wants to know.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The field over an interval of the ray.
    Field,
    /// The slope along the ray over an interval.
    Slope,
    /// The field at a point of the ray.
    Point,
    /// The field over the box of coordinates that a ray crosses during an interval.
    Boxes,
}

/// A question about `N` rays: an interval each, or a point as an interval of no width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question<const N: usize> {
    pub kind: Kind,
    pub spans: [Span; N],
}

/// What a kernel says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The enclosure; NaN stands for an infinite end.
    pub lo: f64,
    pub hi: f64,
    /// Verdict bits of the enclosure.
    pub bits: u32,
    /// The field is defined and continuous on all of the interval.
    pub continuous: bool,
    /// Verdict bits of the condition; those of a true one if there is none.
    pub condition: u32,
}

impl Answer {
    fn interval(&self) -> Interval {
        let lo = if self.lo.is_nan() { f64::NEG_INFINITY } else { self.lo };
        let hi = if self.hi.is_nan() { f64::INFINITY } else { self.hi };
        Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
    }

    fn is_bounded(&self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// The proved sign: 1, -1, or 0 if there is none.
    pub fn sign(&self) -> i8 {
        const BOTH: u32 = verdict::POSITIVE | verdict::NEGATIVE;
        match self.bits & (BOTH | verdict::EMPTY) {
            verdict::POSITIVE => 1,
            verdict::NEGATIVE => -1,
            _ => 0,
        }
    }
}

/// What all searches of a shape have in common.
#[derive(Debug, Clone, Copy)]
pub struct Rules {
    pub finder: Finder,
    /// A solid, which is where the field is negative.
    pub region: bool,
    pub condition: bool,
}

impl Rules {
    /// Whether the answer of the field's kernel rules the shape out.
    pub fn excludes(self, answer: &Answer) -> bool {
        let refuting = if self.region { verdict::POSITIVE | verdict::EMPTY } else { verdict::REFUTED };
        answer.bits & refuting != 0 || answer.condition & (verdict::NEGATIVE | verdict::EMPTY) != 0
    }

    /// Whether what could not be ruled out counts as a hit: it does not at a pole.
    pub fn accepts(self, answer: &Answer) -> bool {
        answer.is_bounded() || self.region && answer.sign() < 0
    }
}

/// An interval to be searched, with the signs at its ends where they are known.
#[derive(Debug, Clone, Copy)]
struct Item {
    span: Span,
    signs: [Option<i8>; 2],
}

#[derive(Debug, Clone, Copy)]
enum State {
    /// The field over the item was asked for.
    Field,
    Slope,
    /// The field at the start or the end of the item.
    End(usize),
    /// The field in the middle of the item, to give signs to its halves.
    Halves,
    /// The field in the middle, for the Newton operator with this slope.
    Newton(Interval),
    /// The field at the start or the end of an item on which it is monotone with slopes of this sign.
    Monotone(i8, usize),
    /// The field at a point of a bracket on which it is monotone.
    Refine(Refinement, f64),
    /// The field over a bracket that is about to be claimed.
    Confirm(Span),
}

/// A bracket of the one zero of a monotone field, found by signs.
#[derive(Debug, Clone, Copy)]
pub struct Refinement {
    growth: i8,
    span: Span,
    /// Points between which the sign stayed open.
    open: Option<Span>,
}

/// What a refinement needs next.
pub enum Probe {
    /// The sign at this point.
    At(f64),
    /// Nothing: this is the bracket.
    Done(Span),
}

impl Refinement {
    /// The bracket of a zero in `span`, on which the field has slopes of the sign `growth`.
    pub fn new(growth: i8, span: Span) -> Self {
        Self { growth, span, open: None }
    }

    /// The next point of a bracket, or the bracket itself if it is narrow or rounding does not let it shrink.
    pub fn probe(&self, width: f64) -> Probe {
        let Self { span, open, .. } = *self;
        let (gap, enough) = match open {
            None => (span, width),
            Some([a, b]) => (if a - span[0] > span[1] - b { [span[0], a] } else { [b, span[1]] }, 0.25 * width),
        };
        let narrow = span[1] - span[0] < width || gap[1] - gap[0] < enough;
        if narrow { Probe::Done(span) } else { Probe::At(midpoint(gap)) }
    }

    /// Takes the sign at a point.
    pub fn take(&mut self, t: f64, sign: i8) {
        match sign {
            0 => self.open = Some(self.open.map_or([t, t], |[a, b]| [a.min(t), b.max(t)])),
            sign if sign == self.growth => self.span[1] = t,
            _ => self.span[0] = t,
        }
        self.open = self.open.filter(|[a, b]| self.span[0] < *a && *b < self.span[1]);
    }
}

/// The search along one ray.
#[derive(Debug)]
pub struct Search {
    rules: Rules,
    pixel: usize,
    ray: Ray,
    /// The stretch of the ray inside the domain.
    whole: Span,
    /// Intervals of the ray parameter that are not divided any more.
    width: f64,
    stack: Vec<Item>,
    item: Item,
    state: State,
    found: Found,
}

impl Search {
    /// The search along the ray of a pixel, with its first question; `None` if the ray misses the domain.
    pub fn new(rules: Rules, pixel: usize, ray: Ray, domain: &[Interval], epsilon: f64) -> Option<(Self, Question<1>)> {
        let (entry, exit) = ray.clip(domain)?;
        let whole = [entry[0], exit[1]];
        // Intervals of a few neighbouring numbers cannot be halved.
        let width = (epsilon / length(&ray)).max(whole[1] * 2.0f64.powi(-50)).max(f64::MIN_POSITIVE);
        let item = Item { span: whole, signs: [None; 2] };
        let (stack, state, found) = (Vec::new(), State::Field, Found::MISS);
        let mut search = Self { rules, pixel, ray, whole, width, stack, item, state, found };
        let question = search.open(item);
        Some((search, question))
    }

    fn ask(&mut self, state: State, kind: Kind, span: Span) -> Question<1> {
        self.state = state;
        Question { kind, spans: [span] }
    }

    fn ask_point(&mut self, state: State, t: f64) -> Question<1> {
        self.ask(state, Kind::Point, [t, t])
    }

    fn ask_field(&mut self) -> Question<1> {
        self.ask(State::Field, Kind::Field, self.item.span)
    }

    fn confirm(&mut self, bracket: Span) -> Question<1> {
        self.ask(State::Confirm(bracket), Kind::Field, bracket)
    }

    /// Goes on with the nearest interval that is left.
    fn next(&mut self) -> Option<Question<1>> {
        let item = self.stack.pop()?;
        Some(self.open(item))
    }

    /// The first question about an interval.
    fn open(&mut self, item: Item) -> Question<1> {
        self.item = item;
        if !matches!(self.rules.finder, Finder::MrfRo | Finder::MrfNewton) {
            return self.ask_field();
        }
        match item.signs {
            [None, _] => self.ask_point(State::End(0), item.span[0]),
            [_, None] => self.ask_point(State::End(1), item.span[1]),
            [Some(a), Some(b)] if a * b > 0 => self.ask_field(),
            // Ends of different signs, or of open ones: the interval would not be refuted.
            _ if self.is_narrow() => self.confirm(item.span),
            _ => self.divide(),
        }
    }

    fn is_narrow(&self) -> bool {
        self.item.span[1] - self.item.span[0] < self.width
    }

    fn middle(&self) -> f64 {
        midpoint(self.item.span)
    }

    fn field(&mut self, answer: &Answer) -> Option<Question<1>> {
        if self.rules.excludes(answer) {
            self.next()
        } else if self.is_narrow() {
            self.claim(self.item.span, answer)
        } else if self.rules.finder == Finder::Bisection {
            self.halve(None)
        } else {
            Some(self.divide())
        }
    }

    /// The question that decides how an interval is divided.
    fn divide(&mut self) -> Question<1> {
        match self.rules.finder {
            Finder::Mrf | Finder::MrfRo => self.ask_point(State::Halves, self.middle()),
            _ => self.ask(State::Slope, Kind::Slope, self.item.span),
        }
    }

    fn slope(&mut self, answer: &Answer) -> Option<Question<1>> {
        let growth = if answer.continuous { answer.sign() } else { 0 };
        let (start, middle) = (self.item.span[0], self.middle());
        match self.rules.finder {
            Finder::Mitchell if growth != 0 => Some(self.ask_point(State::Monotone(growth, 0), start)),
            Finder::AlefeldHansen if growth != 0 || answer.continuous => {
                Some(self.ask_point(State::Newton(answer.interval()), middle))
            }
            Finder::IntervalNewton | Finder::MrfNewton if growth != 0 => {
                Some(self.ask_point(State::Newton(answer.interval()), middle))
            }
            Finder::MrfNewton => Some(self.ask_point(State::Halves, middle)),
            _ => self.halve(None),
        }
    }

    /// Searches the nearer half first.
    fn halve(&mut self, sign: Option<i8>) -> Option<Question<1>> {
        let Item { span: [a, b], signs } = self.item;
        let middle = self.middle();
        self.stack.push(Item { span: [middle, b], signs: [sign, signs[1]] });
        Some(self.open(Item { span: [a, middle], signs: [signs[0], sign] }))
    }

    /// The Newton operator m - f(m) / F' with the slope's enclosure F', by extended division where it holds 0 (Flórez 2008,
    /// eq. 4.2): what it leaves of the interval holds every zero.
    fn newton(&mut self, answer: &Answer, slope: Interval) -> Option<Question<1>> {
        let Item { span: [a, b], .. } = self.item;
        let (m, value) = (self.middle(), answer.interval());
        let whole = Interval::new(a, b).unwrap_or(Interval::ENTIRE);
        let step = |slope: Interval| (Interval::point(m) - value / slope).intersect(whole);
        let pieces = if !slope.contains(0.0) {
            [step(slope), Interval::EMPTY]
        } else if answer.sign() == 0 {
            return self.halve(None);
        } else {
            let falling = slope.intersect(Interval::new(f64::NEG_INFINITY, 0.0).unwrap_or(slope));
            let rising = slope.intersect(Interval::new(0.0, f64::INFINITY).unwrap_or(slope));
            [step(falling), step(rising)]
        };
        let [mut near, mut far] = pieces;
        if near.is_empty() || !far.is_empty() && far.lo() < near.lo() {
            (near, far) = (far, near);
        }
        if near.is_empty() {
            return self.next();
        }
        let item = |piece: Interval| Item { span: [piece.lo(), piece.hi()], signs: [None; 2] };
        if far.is_empty() && near.width() > 0.9 * (b - a) {
            self.item = item(near);
            return if self.is_narrow() { Some(self.confirm(self.item.span)) } else { self.halve(None) };
        }
        if !far.is_empty() {
            self.stack.push(item(far));
        }
        Some(self.open(item(near)))
    }

    fn monotone(&mut self, answer: &Answer, growth: i8, end: usize) -> Option<Question<1>> {
        let sign = answer.sign();
        // Moving away from 0 at the start, or not yet there at the end, a monotone field has no zero between.
        if sign != 0 && (end == 0) == (sign == growth) {
            return self.next();
        }
        if end == 0 {
            return Some(self.ask_point(State::Monotone(growth, 1), self.item.span[1]));
        }
        Some(self.probe(Refinement::new(growth, self.item.span)))
    }

    /// The next point of a bracket, or the bracket itself.
    fn probe(&mut self, refinement: Refinement) -> Question<1> {
        match refinement.probe(self.width) {
            Probe::At(t) => self.ask_point(State::Refine(refinement, t), t),
            Probe::Done(bracket) => self.confirm(bracket),
        }
    }

    /// Ends the search at a bracket, unless the field is unbounded there.
    fn claim(&mut self, bracket: Span, answer: &Answer) -> Option<Question<1>> {
        if !self.rules.accepts(answer) {
            self.found.clear = false;
            return self.next();
        }
        // The Newton operator's bracket may be narrower than any proof by signs can be.
        let missing = self.width - (bracket[1] - bracket[0]);
        let grow = if missing > 0.5 * self.width { 0.5 * missing } else { 0.0 };
        self.found.hit = Some([(bracket[0] - grow).max(self.whole[0]), (bracket[1] + grow).min(self.whole[1])]);
        None
    }
}

impl Pursuit<1> for Search {
    fn rays(&self) -> [Ray; 1] {
        [self.ray]
    }

    fn answer(&mut self, [answer]: &[Answer; 1]) -> Option<Question<1>> {
        match self.state {
            State::Field => self.field(answer),
            State::Slope => self.slope(answer),
            State::End(end) => {
                self.item.signs[end] = Some(answer.sign());
                Some(self.open(self.item))
            }
            State::Halves => self.halve(Some(answer.sign())),
            State::Newton(slope) => self.newton(answer, slope),
            State::Monotone(growth, end) => self.monotone(answer, growth, end),
            State::Refine(mut refinement, t) => {
                refinement.take(t, answer.sign());
                Some(self.probe(refinement))
            }
            State::Confirm(_) if self.rules.excludes(answer) => self.next(),
            State::Confirm(bracket) => self.claim(bracket, answer),
        }
    }

    fn report(&self, found: &mut [Found]) {
        found[self.pixel] = self.found;
    }
}

fn midpoint([a, b]: Span) -> f64 {
    a + 0.5 * (b - a)
}
