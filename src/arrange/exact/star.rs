//! Proofs that curves form a star in a box: all arms are functions of x, and can end only in one point.
//!
//! Over an interval of x without roots of discriminants, resultants and leading coefficients, the zeros of the polynomials are
//! disjoint graphs of functions (delineability; Collins 1975). With the top and the bottom of the box free of zeros, each
//! graph that is inside stays inside. At a root a of them nothing happens to the graphs if the zeros on the line x = a
//! within the box are simple and belong to one polynomial each: graphs pass. So if this is so for all roots but one, all
//! graphs over either side of that one end on its line, in zeros there; if it has one zero in the box, they all end in it.

use std::cmp::Ordering;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;

use crate::arrange::exact::algebra::Algebra;
use crate::arrange::exact::algebra::Missing;
use crate::arrange::exact::algebra::exact;
use crate::arrange::exact::fibre::Fibre;
use crate::arrange::exact::finding::Arcs;
use crate::arrange::exact::finding::Branch;
use crate::arrange::exact::finding::Contact;
use crate::arrange::exact::finding::Finding;
use crate::arrange::exact::finding::Star;
use crate::arrange::exact::polynomial::Polynomial;
use crate::arrange::exact::roots;
use crate::arrange::exact::roots::Place;
use crate::arrange::exact::subresultant::TooLarge;
use crate::arrange::exact::univariate::Univariate;
use crate::interval::Interval;

/// How often the box is made 4 times as high.
const MAX_ENLARGEMENTS: u32 = 12;

/// Numbers in the range of x that are looked at one by one.
const MAX_EVENTS: usize = 8;

/// By how much of its size the area is widened to each side: more, if an end is an event.
const MARGINS: [f64; 3] = [0.125, 0.171, 0.093];

/// Why a proof failed.
enum Failure {
    Several(&'static str),
    Unknown(&'static str),
    /// The same with a slightly different width may succeed.
    End,
}

impl From<TooLarge> for Failure {
    fn from(_: TooLarge) -> Self {
        Failure::Unknown("degrees or coefficients are too large")
    }
}

impl From<Missing> for Failure {
    fn from(missing: Missing) -> Self {
        match missing {
            Missing::Dependent => Failure::Unknown("a common or repeated factor"),
            Missing::TooLarge => TooLarge.into(),
        }
    }
}

/// See [`Algebra::settle`].
pub fn settle(algebra: &Algebra, indices: &[usize], area: [Interval; 2]) -> Finding {
    if !area.iter().all(|side| side.is_bounded()) {
        return Finding::Unknown("an unbounded area");
    }
    let mut last = Finding::Unknown("no curves");
    for exchange in 0..2 {
        let oriented = if exchange == 0 { area } else { [area[1], area[0]] };
        for margin in MARGINS {
            let question = Question { algebra, indices, exchange };
            match question.answer(oriented, margin) {
                Ok(finding) if exchange == 0 => return finding,
                Ok(finding) => return exchanged(finding),
                Err(Failure::End) => last = Finding::Unknown("events at the ends of the box"),
                Err(Failure::Several(reason)) => {
                    last = Finding::Several(reason);
                    break;
                }
                Err(Failure::Unknown(reason)) => {
                    last = Finding::Unknown(reason);
                    break;
                }
            }
        }
    }
    last
}

/// The same finding with x and y exchanged.
fn exchanged(finding: Finding) -> Finding {
    let swap = |[x, y]: [Interval; 2]| [y, x];
    match finding {
        Finding::Star(mut star) => {
            star.within = swap(star.within);
            star.point = swap(star.point);
            // The reflection reverses the order.
            star.around.reverse();
            Finding::Star(star)
        }
        Finding::Arcs(arcs) => Finding::Arcs(Arcs { within: swap(arcs.within), ..arcs }),
        Finding::Nothing(within) => Finding::Nothing(swap(within)),
        other => other,
    }
}

/// A side of the area, widened.
fn widened(side: Interval, margin: f64) -> Interval {
    let magnitude = side.lo().abs().max(side.hi().abs());
    let by = ((side.hi() - side.lo()) * margin).max(magnitude * 1e-14 * margin).max(f64::MIN_POSITIVE / f64::EPSILON);
    Interval::new((side.lo() - by).next_down(), (side.hi() + by).next_up()).unwrap_or(Interval::ENTIRE)
}

/// Polynomials in one of the two orientations.
struct Question<'a> {
    algebra: &'a Algebra,
    indices: &'a [usize],
    exchange: usize,
}

/// What is on a vertical line within a box.
#[derive(Default)]
struct Line {
    /// Positions of curves with a zero on it, and for each whether its derivative by y vanishes in one.
    through: Vec<usize>,
    steep: Vec<bool>,
    /// Two curves have a zero in common.
    meeting: bool,
    /// There are different zeros on it.
    several: bool,
    /// Positions of vertical lines that are this one.
    vertical: Vec<usize>,
}

impl Line {
    /// Whether it is more than a place that curves pass, each by itself and in the direction of x.
    fn is_event(&self) -> bool {
        self.meeting || self.steep.contains(&true) || !self.vertical.is_empty()
    }
}

/// A box with exact sides.
struct Frame {
    x: [BigRational; 2],
    y: [BigRational; 2],
    within: [Interval; 2],
}

impl Question<'_> {
    fn poly(&self, position: usize) -> &Polynomial {
        self.algebra.poly(self.indices[position], self.exchange)
    }

    /// Positions of polynomials that are no vertical lines.
    fn curves(&self) -> impl Iterator<Item = usize> {
        (0..self.indices.len()).filter(|&i| self.poly(i).degree_y() > 0)
    }

    fn answer(&self, area: [Interval; 2], margin: f64) -> Result<Finding, Failure> {
        let x = widened(area[0], margin);
        if !x.is_bounded() {
            return Err(Failure::Unknown("an unbounded area"));
        }
        let sides = [exact(x.lo()), exact(x.hi())];
        let events = self.events(&sides)?;
        let frame = self.frame(x, sides, widened(area[1], margin))?;
        let mut found = None;
        for mut fibre in events {
            let line = self.line(&frame, &mut fibre)?;
            if !line.is_event() {
                continue;
            }
            if found.is_some() {
                return Err(Failure::Several("several events"));
            }
            found = Some((fibre, line));
        }
        match found {
            Some((mut fibre, line)) => self.star(&frame, &mut fibre, &line),
            None => self.arcs(&frame),
        }
    }

    /// The numbers in an interval of x where something may happen.
    fn events(&self, [lo, hi]: &[BigRational; 2]) -> Result<Vec<Fibre>, Failure> {
        let mut factors: Vec<Univariate> = Vec::new();
        for i in 0..self.indices.len() {
            for j in i..self.indices.len() {
                for factor in self.algebra.events(self.exchange, self.indices[i], self.indices[j])?.iter() {
                    if factor.is_constant() {
                        continue;
                    }
                    if factor.sign_at(lo).is_eq() || factor.sign_at(hi).is_eq() {
                        return Err(Failure::End);
                    }
                    if !roots::isolate(factor, lo, hi).ok_or(TooLarge)?.is_empty() {
                        insert(&mut factors, factor);
                    }
                }
            }
        }
        // The factors are coprime now, so different roots are different numbers.
        let mut fibres = Vec::new();
        for factor in &factors {
            let places = roots::isolate(factor, lo, hi).ok_or(TooLarge)?;
            if fibres.len() + places.len() > MAX_EVENTS {
                return Err(Failure::Several("many events above one another or side by side"));
            }
            fibres.extend(places.into_iter().map(|place| Fibre::new(factor, place)));
        }
        Ok(fibres)
    }

    /// The area, enlarged in y until its top and bottom are free of zeros.
    fn frame(&self, x: Interval, sides: [BigRational; 2], mut y: Interval) -> Result<Frame, Failure> {
        for _ in 0..=MAX_ENLARGEMENTS {
            if !y.is_bounded() {
                break;
            }
            let ends = [exact(y.lo()), exact(y.hi())];
            let mut free = true;
            for (i, end) in self.curves().flat_map(|i| ends.iter().map(move |end| (i, end))) {
                free = free && self.is_free(&self.poly(i).at_y(end), &sides)?;
            }
            if free {
                return Ok(Frame { x: sides, y: ends, within: [x, y] });
            }
            let by = (y.hi() - y.lo()) * 1.5;
            y = Interval::new(y.lo() - by, y.hi() + by).unwrap_or(Interval::ENTIRE);
        }
        Err(Failure::Unknown("curves leave through the top or the bottom"))
    }

    /// Whether a polynomial has no roots in a closed interval.
    fn is_free(&self, poly: &Univariate, [lo, hi]: &[BigRational; 2]) -> Result<bool, Failure> {
        if poly.is_zero() {
            return Ok(false);
        }
        if !poly.is_constant() && poly.sign_at(lo) != poly.sign_at(hi) {
            return Ok(false);
        }
        let free = poly.divide(&poly.gcd(&poly.derivative()));
        Ok(roots::isolate(&free.unwrap_or_else(|| poly.clone()), lo, hi).ok_or(TooLarge)?.is_empty())
    }

    /// All zeros on a vertical side, from the bottom to the top, each with the position of its polynomial.
    fn side(&self, frame: &Frame, x: &BigRational) -> Result<Vec<usize>, Failure> {
        let mut zeros: Vec<(Place, usize, Univariate)> = Vec::new();
        for i in self.curves() {
            let poly = self.poly(i).at_x(x);
            for place in roots::isolate(&poly, &frame.y[0], &frame.y[1]).ok_or(TooLarge)? {
                zeros.push((place, i, poly.clone()));
            }
        }
        // There are no events on this side, so all zeros are simple and different: refined enough, their places are disjoint.
        for _ in 0..MAX_SEPARATIONS {
            zeros.sort_by(|a, b| a.0.lo.cmp(&b.0.lo).then(a.0.hi.cmp(&b.0.hi)));
            let mut separate = true;
            for k in 1..zeros.len() {
                let (before, after) = zeros.split_at_mut(k);
                let (a, b) = (&mut before[k - 1], &mut after[0]);
                if a.0.hi > b.0.lo || (a.0.hi == b.0.lo && a.0.is_exact() && b.0.is_exact()) {
                    separate = false;
                    a.0.bisect(&a.2);
                    b.0.bisect(&b.2);
                }
            }
            if separate {
                return Ok(zeros.into_iter().map(|(_, i, _)| i).collect());
            }
        }
        Err(Failure::Unknown("arms too close to one another"))
    }

    /// Without events.
    fn arcs(&self, frame: &Frame) -> Result<Finding, Failure> {
        let side = self.side(frame, &frame.x[0])?;
        if side.is_empty() {
            return Ok(Finding::Nothing(frame.within));
        }
        let mut counts = vec![0; self.indices.len()];
        side.iter().for_each(|&i| counts[i] += 1);
        Ok(Finding::Arcs(Arcs { within: frame.within, counts }))
    }

    /// What is on a vertical line.
    fn line(&self, frame: &Frame, fibre: &mut Fibre) -> Result<Line, Failure> {
        let [lo, hi] = &frame.y;
        let mut line = Line::default();
        for i in self.curves() {
            let poly = self.poly(i);
            if fibre.reduce(poly).is_zero() {
                return Err(Failure::Unknown("a curve contains a vertical line"));
            }
            let zeros = fibre.roots(poly, lo, hi, None)?.len();
            if zeros > 0 {
                line.through.push(i);
                line.several |= zeros > 1;
                let steep = self.meet(fibre, poly, &poly.derivative_y(), frame)?;
                line.steep.push(steep);
            }
        }
        let through = line.through.as_slice();
        let mut partners = 0;
        for &i in through.iter().skip(1) {
            partners += usize::from(self.meet(fibre, self.poly(through[0]), self.poly(i), frame)?);
        }
        // With one zero of each, all are one point if each is that of the first.
        line.several |= partners + 1 < through.len();
        line.meeting = partners > 0;
        for (k, &i) in through.iter().enumerate().skip(2) {
            for &j in &through[1..k] {
                line.meeting = line.meeting || self.meet(fibre, self.poly(i), self.poly(j), frame)?;
            }
        }
        let vertical: Vec<usize> = (0..self.indices.len()).filter(|&i| self.poly(i).degree_y() == 0).collect();
        line.vertical = vertical.into_iter().filter(|&i| fibre.is_zero(&self.poly(i).leading())).collect();
        Ok(line)
    }

    /// With all events on one line.
    fn star(&self, frame: &Frame, fibre: &mut Fibre, line: &Line) -> Result<Finding, Failure> {
        if line.several {
            return Err(Failure::Several("several points on a line"));
        }
        let count = self.indices.len();
        let [lo, hi] = &frame.y;
        let height = hi - lo;
        let lines = &line.vertical;
        let Some(&first) = line.through.first() else {
            // All other curves are functions of x from one side to the other, and none crosses the line: there are none.
            let mut counts = vec![0; count];
            lines.iter().for_each(|&i| counts[i] += 1);
            return Ok(Finding::Arcs(Arcs { within: frame.within, counts }));
        };
        let (left, right) = (self.side(frame, &frame.x[0])?, self.side(frame, &frame.x[1])?);
        let mut around = right;
        around.extend(lines);
        around.extend(left.iter().rev());
        around.extend(lines);
        let mut branches = vec![Branch::default(); count];
        around.iter().for_each(|&i| branches[i].arms += 1);
        let mut steep = vec![false; count];
        for (&i, &is_steep) in line.through.iter().zip(&line.steep) {
            let poly = self.poly(i);
            steep[i] = is_steep;
            branches[i].through = true;
            branches[i].singular = is_steep && self.meet(fibre, poly, &poly.derivative_x(), frame)?;
        }
        for &i in lines {
            branches[i].through = true;
            steep[i] = true;
        }
        let mut contacts = Vec::new();
        let regular: Vec<usize> = (0..count).filter(|&i| branches[i].through && !branches[i].singular).collect();
        for (k, &i) in regular.iter().enumerate() {
            for &j in &regular[k + 1..] {
                let parallel = steep[i] && steep[j] || steep[i] == steep[j] && self.parallel(fibre, i, j, frame)?;
                let contact = match (parallel, alternate(&around, i, j)) {
                    (false, _) => Contact::Transversal,
                    (true, true) => Contact::Crossing,
                    (true, false) => Contact::Touching,
                };
                contacts.push((i, j, contact));
            }
        }
        let passing = branches.iter().filter(|branch| branch.through).count();
        // To about the last place of floating-point numbers, or of the box.
        let width = &height * BigRational::new(BigInt::one(), BigInt::one() << 60);
        let y = fibre.roots(self.poly(first), lo, hi, Some(&width))?;
        let y = y.first().map_or(frame.within[1], Place::enclosure);
        let point = [fibre.x().enclosure(), y];
        let star = Star {
            within: frame.within,
            point,
            branches,
            around,
            contacts,
            regular: passing == 1 && regular.len() == 1,
        };
        Ok(Finding::Star(star))
    }

    /// Whether two polynomials have a zero on the line in the box in common.
    fn meet(&self, fibre: &mut Fibre, f: &Polynomial, g: &Polynomial, frame: &Frame) -> Result<bool, Failure> {
        let common = fibre.common(f, g)?;
        Ok(!fibre.roots(&common, &frame.y[0], &frame.y[1], None)?.is_empty())
    }

    /// Whether two regular curves have parallel gradients in the point.
    fn parallel(&self, fibre: &mut Fibre, i: usize, j: usize, frame: &Frame) -> Result<bool, Failure> {
        let (f, g) = (self.poly(i), self.poly(j));
        let jacobian = f.derivative_x().mul(&g.derivative_y()).sub(&f.derivative_y().mul(&g.derivative_x()));
        self.meet(fibre, f, &jacobian, frame)
    }
}

/// Adds a square-free polynomial to pairwise coprime ones.
fn insert(factors: &mut Vec<Univariate>, factor: &Univariate) {
    let mut rest = factor.clone();
    for i in 0..factors.len() {
        let common = factors[i].gcd(&rest);
        if common.is_constant() {
            continue;
        }
        let (Some(left), Some(right)) = (factors[i].divide(&common), rest.divide(&common)) else { continue };
        factors[i] = common;
        if !left.is_constant() {
            factors.push(left);
        }
        rest = right;
    }
    if !rest.is_constant() {
        factors.push(rest);
    }
}

/// Rounds of bisection before arms count as too close.
const MAX_SEPARATIONS: usize = 1000;

/// Whether the two arms of one curve lie on different sides of those of the other.
fn alternate(around: &[usize], i: usize, j: usize) -> bool {
    let arms: Vec<usize> = around.iter().copied().filter(|&k| k == i || k == j).collect();
    arms.windows(2).all(|pair| pair[0].cmp(&pair[1]) != Ordering::Equal) && arms.len() == 4
}
