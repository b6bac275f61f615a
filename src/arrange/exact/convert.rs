//! Polynomials from graphs and back.

use std::collections::HashMap;

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::One;
use num_traits::Signed;
use num_traits::Zero;

use crate::arrange::exact::polynomial::Polynomial;
use crate::arrange::exact::univariate::Univariate;
use crate::graph::Graph;
use crate::graph::Op;
use crate::graph::Value;

/// Polynomials of a higher total degree are left to interval tests.
const MAX_DEGREE: usize = 24;

/// So are those with larger coefficients.
const MAX_BITS: u64 = 2048;

/// A polynomial over a positive denominator.
#[derive(Clone)]
struct Fraction {
    numerator: Polynomial,
    denominator: BigInt,
}

impl Fraction {
    fn constant(number: &BigRational) -> Self {
        Self { numerator: Polynomial::constant(number.numer().clone()), denominator: number.denom().clone() }
    }

    fn variable(name: &str) -> Option<Self> {
        let term = match name {
            "x" => (1, 1, 0),
            "y" => (1, 0, 1),
            _ => return None,
        };
        Some(Self { numerator: Polynomial::from_terms(&[term]), denominator: BigInt::one() })
    }

    fn add(&self, other: &Self) -> Self {
        let common = self.denominator.lcm(&other.denominator);
        let scaled = |f: &Self| f.numerator.scale(&(&common / &f.denominator));
        Self { numerator: scaled(self).add(&scaled(other)), denominator: common }
    }

    fn mul(&self, other: &Self) -> Self {
        Self { numerator: self.numerator.mul(&other.numerator), denominator: &self.denominator * &other.denominator }
    }

    fn neg(&self) -> Self {
        Self { numerator: self.numerator.scale(&BigInt::from(-1)), denominator: self.denominator.clone() }
    }

    /// The inverse of a constant other than 0.
    fn inverse(&self) -> Option<Self> {
        if self.numerator.is_zero() || !self.numerator.is_constant() {
            return None;
        }
        let value = self.numerator.leading().leading()?.clone();
        Some(Self::constant(&BigRational::new(self.denominator.clone(), value)))
    }

    fn pow(&self, exponent: u32) -> Option<Self> {
        let size = self.numerator.degree().max(1).saturating_mul(exponent as usize);
        if size > MAX_DEGREE && !self.numerator.is_constant() || size > MAX_BITS as usize {
            return None;
        }
        let mut power = Self::constant(&BigRational::one());
        for _ in 0..exponent {
            power = power.mul(self).small()?;
        }
        Some(power)
    }

    /// Itself in lowest terms, unless it has grown too large.
    fn small(self) -> Option<Self> {
        let common = self.numerator.content().gcd(&self.denominator);
        let numerator = if common.is_one() { self.numerator } else { divided(&self.numerator, &common) };
        let denominator = self.denominator / common;
        let small = numerator.degree() <= MAX_DEGREE && numerator.bits() <= MAX_BITS && denominator.bits() <= MAX_BITS;
        small.then_some(Self { numerator, denominator })
    }
}

/// All coefficients divided by a number that divides them.
fn divided(poly: &Polynomial, by: &BigInt) -> Polynomial {
    let row = |row: &Univariate| Univariate::new(row.coefficients().iter().map(|c| c / by).collect());
    Polynomial::new(poly.rows().iter().map(row).collect())
}

impl Polynomial {
    /// The polynomial that a value of a graph is, up to a positive constant factor: built from the variables `x` and `y` and
    /// rational constants by sums, products, powers and division by constants. `None` if it is anything else, or its degree
    /// or coefficients are too large.
    pub fn from_graph(graph: &Graph, value: Value) -> Option<Polynomial> {
        let needed = graph.reachable(&[value]);
        let mut known: HashMap<Value, Fraction> = HashMap::new();
        for (v, node) in graph.iter().filter(|(v, _)| needed[v.index()]) {
            let operands: Vec<&Fraction> = node.operands().iter().filter_map(|v| known.get(v)).collect();
            let fraction = match (node.op, operands.as_slice()) {
                (Op::Const(_), []) => Fraction::constant(graph.as_constant(v)?),
                (Op::Var(id), []) => Fraction::variable(graph.variables().get(id as usize)?)?,
                (Op::Neg, [a]) => a.neg(),
                (Op::Sqr, [a]) => a.mul(a),
                (Op::PowInt(n), [a]) => a.pow(u32::try_from(n).ok()?)?,
                (Op::Add, [a, b]) => a.add(b),
                (Op::Sub, [a, b]) => a.add(&b.neg()),
                (Op::Mul, [a, b]) => a.mul(b),
                (Op::Div, [a, b]) => a.mul(&b.inverse()?),
                _ => return None,
            };
            known.insert(v, fraction.small()?);
        }
        let poly = known.remove(&value)?.numerator;
        let content = poly.content();
        Some(if content.is_zero() { poly } else { divided(&poly, &content) })
    }

    /// Adds it to a graph, over the variables `x` and `y`: Horner's scheme in y over Horner's scheme in x, with powers where
    /// terms are missing, so that even powers keep their sign in interval arithmetic.
    pub fn to_graph(&self, graph: &mut Graph) -> Value {
        let x = graph.var("x");
        let y = graph.var("y");
        let rows: Vec<Option<Value>> = self
            .rows()
            .iter()
            .map(|row| {
                let constant = |c: &BigInt| (!c.is_zero()).then(|| BigRational::from_integer(c.clone()));
                let terms: Vec<Option<BigRational>> = row.coefficients().iter().map(constant).collect();
                let terms = terms.into_iter().map(|term| term.map(|c| graph.constant(c))).collect::<Vec<_>>();
                horner(graph, x, &terms)
            })
            .collect();
        match horner(graph, y, &rows) {
            Some(value) => value,
            None => graph.int(0),
        }
    }
}

/// The sum of `terms[i] base^i`; `None` stands for 0.
fn horner(graph: &mut Graph, base: Value, terms: &[Option<Value>]) -> Option<Value> {
    let mut sum: Option<Value> = None;
    let mut gap = 0;
    for (i, term) in terms.iter().enumerate().rev() {
        if let Some(term) = *term {
            sum = Some(match sum {
                None => term,
                Some(sum) => {
                    let product = times_power(graph, sum, base, gap);
                    graph.add(product, term)
                }
            });
            gap = 0;
        }
        gap += usize::from(sum.is_some() && i > 0);
    }
    sum.map(|sum| times_power(graph, sum, base, gap))
}

fn times_power(graph: &mut Graph, value: Value, base: Value, exponent: usize) -> Value {
    let power = match exponent {
        0 => return value,
        1 => base,
        2 => graph.sqr(base),
        n => graph.unary(Op::PowInt(n as i32), base),
    };
    let constant = graph.as_constant(value).cloned();
    match constant {
        Some(c) if c.is_one() => power,
        Some(c) if c.is_negative() && c.abs().is_one() => graph.neg(power),
        _ => graph.mul(value, power),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Polynomial> {
        let mut graph = Graph::new();
        let (x, y) = (graph.var("x"), graph.var("y"));
        let value = match text {
            "folium" => {
                let (cube_x, cube_y) = (graph.unary(Op::PowInt(3), x), graph.unary(Op::PowInt(3), y));
                let (sum, three) = (graph.add(cube_x, cube_y), graph.int(3));
                let product = graph.mul(x, y);
                let product = graph.mul(three, product);
                graph.sub(sum, product)
            }
            "half" => {
                let (square, two) = (graph.sqr(x), graph.int(-4));
                let half = graph.div(square, two);
                graph.add(half, y)
            }
            "sine" => graph.unary(Op::Sin, x),
            "parameter" => graph.var("a"),
            "quotient" => graph.div(x, y),
            "high" => {
                let sum = graph.add(x, y);
                graph.unary(Op::PowInt(25), sum)
            }
            _ => graph.unary(Op::PowInt(-2), x),
        };
        Polynomial::from_graph(&graph, value)
    }

    #[test]
    fn graphs_become_polynomials_or_are_refused() {
        assert_eq!(read("folium").unwrap().to_string(), "y^3 - 3 x y + x^3");
        assert_eq!(read("half").unwrap().to_string(), "4 y - x^2");
        for refused in ["sine", "parameter", "quotient", "high", "pole"] {
            assert_eq!(read(refused), None, "{refused}");
        }
    }

    #[test]
    fn polynomials_return_from_graphs_unchanged() {
        let polys = [
            Polynomial::from_terms(&[(1, 2, 0), (1, 0, 2), (-1, 0, 0)]),
            Polynomial::from_terms(&[(-3, 5, 2), (7, 1, 2), (1, 0, 4), (-1, 3, 0)]),
            Polynomial::from_terms(&[(5, 0, 0)]),
            Polynomial::default(),
        ];
        for poly in polys {
            let mut graph = Graph::new();
            let value = poly.to_graph(&mut graph);
            let content = poly.content().max(BigInt::one());
            assert_eq!(Polynomial::from_graph(&graph, value), Some(divided(&poly, &content)));
        }
    }

    #[test]
    fn signs_at_points_are_exact() {
        use std::cmp::Ordering;
        let line = Polynomial::from_terms(&[(10, 1, 0), (-1, 0, 0)]);
        // The number nearest to 1 / 10 is above it.
        assert_eq!(line.sign_at([0.1, 0.0]), Some(Ordering::Greater));
        assert_eq!(line.sign_at([0.1f64.next_down(), 5.0]), Some(Ordering::Less));
        assert_eq!(Polynomial::from_terms(&[(1, 1, 1)]).sign_at([0.0, 1e300]), Some(Ordering::Equal));
        assert_eq!(line.sign_at([f64::NAN, 0.0]), None);
    }
}
