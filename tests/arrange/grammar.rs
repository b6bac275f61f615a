//! Random curves: formulas with their values, so that what an arrangement says of signs can be asked of plain numbers.

use std::fmt;

use fastrand::Rng;

/// A formula in x and y.
#[derive(Debug, Clone)]
pub enum Formula {
    X,
    Y,
    /// Sixteenths, which both sides read exactly.
    Number(i32),
    Sum(Box<Formula>, Box<Formula>),
    Difference(Box<Formula>, Box<Formula>),
    Product(Box<Formula>, Box<Formula>),
    Quotient(Box<Formula>, Box<Formula>),
    Power(Box<Formula>, u32),
    Call(&'static str, Vec<Formula>),
}

use Formula::*;

impl Formula {
    /// A random one.
    pub fn random(rng: &mut Rng, depth: u32) -> Self {
        if depth == 0 {
            return match rng.u8(..5) {
                0 | 1 => X,
                2 | 3 => Y,
                _ => Number(rng.i32(-40..=40)),
            };
        }
        let part = |rng: &mut Rng| Box::new(Self::random(rng, depth - 1));
        match rng.u8(..20) {
            0..=3 => Sum(part(rng), part(rng)),
            4..=6 => Difference(part(rng), part(rng)),
            7..=10 => Product(part(rng), part(rng)),
            11 => Quotient(part(rng), part(rng)),
            12 | 13 => Power(part(rng), rng.u32(2..4)),
            14..=16 => Call(["sin", "cos", "exp", "sqrt", "floor", "atan"][rng.usize(..6)], vec![*part(rng)]),
            17 => Call("abs", vec![*part(rng)]),
            18 => Call("min", vec![*part(rng), *part(rng)]),
            _ => Call("max", vec![*part(rng), *part(rng)]),
        }
    }

    /// A polynomial of a degree with small coefficients.
    pub fn polynomial(rng: &mut Rng, degree: u32) -> Self {
        let mut sum = Number(rng.i32(-24..=24));
        for i in 0..=degree {
            for j in u32::from(i == 0)..=degree - i {
                if rng.u8(..3) > 0 {
                    let power = |base, n| if n == 0 { Number(16) } else { Power(Box::new(base), n) };
                    let term = Product(Box::new(power(X, i)), Box::new(power(Y, j)));
                    let term = Product(Box::new(Number(rng.i32(-32..=32))), Box::new(term));
                    sum = Sum(Box::new(sum), Box::new(term));
                }
            }
        }
        sum
    }

    /// The value at a point, rounded; NaN where it is undefined.
    pub fn value(&self, at: [f64; 2]) -> f64 {
        match self {
            X => at[0],
            Y => at[1],
            Number(n) => f64::from(*n) / 16.0,
            Sum(a, b) => a.value(at) + b.value(at),
            Difference(a, b) => a.value(at) - b.value(at),
            Product(a, b) => a.value(at) * b.value(at),
            Quotient(a, b) => a.value(at) / b.value(at),
            Power(a, n) => a.value(at).powi(*n as i32),
            Call(name, parts) => {
                let a = parts[0].value(at);
                match *name {
                    "sin" => a.sin(),
                    "cos" => a.cos(),
                    "exp" => a.exp(),
                    "sqrt" => a.sqrt(),
                    "floor" => a.floor(),
                    "atan" => a.atan(),
                    "abs" => a.abs(),
                    "min" => a.min(parts[1].value(at)),
                    _ => a.max(parts[1].value(at)),
                }
            }
        }
    }

    /// Whether it is continuous everywhere by its make: then it changes sign at its zeros alone.
    pub fn is_continuous(&self) -> bool {
        match self {
            X | Y | Number(_) => true,
            Sum(a, b) | Difference(a, b) | Product(a, b) => a.is_continuous() && b.is_continuous(),
            Quotient(..) => false,
            Power(a, _) => a.is_continuous(),
            Call(name, parts) => !["sqrt", "floor"].contains(name) && parts.iter().all(Self::is_continuous),
        }
    }

    /// The sign, where rounding cannot have made it and near points agree.
    pub fn sign(&self, at: [f64; 2]) -> Option<bool> {
        const NEAR: f64 = 1e-7;
        let middle = self.value(at);
        let near = [[NEAR, 0.0], [-NEAR, 0.0], [0.0, NEAR], [0.0, -NEAR]];
        let agree = |d: [f64; 2]| {
            let value = self.value([at[0] + d[0], at[1] + d[1]]);
            value.is_finite() && value.abs() > 1e-6 && (value > 0.0) == (middle > 0.0)
        };
        (middle.is_finite() && middle.abs() > 1e-6 && near.into_iter().all(agree)).then_some(middle > 0.0)
    }

    /// With x and y exchanged.
    pub fn exchanged(&self) -> Self {
        let both = |a: &Formula, b: &Formula| (Box::new(a.exchanged()), Box::new(b.exchanged()));
        match self {
            X => Y,
            Y => X,
            Number(n) => Number(*n),
            Sum(a, b) => {
                let (a, b) = both(a, b);
                Sum(a, b)
            }
            Difference(a, b) => {
                let (a, b) = both(a, b);
                Difference(a, b)
            }
            Product(a, b) => {
                let (a, b) = both(a, b);
                Product(a, b)
            }
            Quotient(a, b) => {
                let (a, b) = both(a, b);
                Quotient(a, b)
            }
            Power(a, n) => Power(Box::new(a.exchanged()), *n),
            Call(name, parts) => Call(name, parts.iter().map(Self::exchanged).collect()),
        }
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            X => write!(f, "x"),
            Y => write!(f, "y"),
            Number(n) => write!(f, "({n} / 16)"),
            Sum(a, b) => write!(f, "({a} + {b})"),
            Difference(a, b) => write!(f, "({a} - {b})"),
            Product(a, b) => write!(f, "({a} * {b})"),
            Quotient(a, b) => write!(f, "({a} / {b})"),
            Power(a, n) => write!(f, "({a})^{n}"),
            Call(name, parts) => {
                write!(f, "{name}({}", parts[0])?;
                parts[1..].iter().try_for_each(|part| write!(f, ", {part}"))?;
                write!(f, ")")
            }
        }
    }
}

/// Curves in a box.
#[derive(Debug, Clone)]
pub struct Scene {
    pub curves: Vec<Curve>,
    pub domain: [[f64; 2]; 2],
}

/// The zeros of a formula, perhaps only where another is positive.
#[derive(Debug, Clone)]
pub struct Curve {
    pub field: Formula,
    pub condition: Option<Formula>,
}

impl Scene {
    pub fn random(rng: &mut Rng) -> Self {
        let mut curves = Vec::new();
        for _ in 0..rng.usize(1..=4) {
            let field = match rng.u8(..10) {
                0..=3 => {
                    let degree = rng.u32(1..=3);
                    Formula::polynomial(rng, degree)
                }
                4 => Product(Box::new(Formula::polynomial(rng, 1)), Box::new(Formula::polynomial(rng, 2))),
                5 => Power(Box::new(Formula::polynomial(rng, 2)), 2),
                6 => Difference(Box::new(Y), Box::new(Formula::random(rng, 2))),
                _ => {
                    let depth = rng.u32(1..=3);
                    Formula::random(rng, depth)
                }
            };
            let condition = (rng.u8(..6) == 0).then(|| Formula::polynomial(rng, 2));
            curves.push(Curve { field, condition });
        }
        // The same curve once more, as it happens to people.
        if rng.u8(..12) == 0 {
            curves.push(curves[0].clone());
        }
        let side = |rng: &mut Rng| [f64::from(rng.i32(-40..-8)) / 16.0, f64::from(rng.i32(8..40)) / 16.0];
        Self { curves, domain: [side(rng), side(rng)] }
    }

    pub fn exchanged(&self) -> Self {
        let curves = self.curves.iter().map(|curve| Curve {
            field: curve.field.exchanged(),
            condition: curve.condition.as_ref().map(Formula::exchanged),
        });
        Self { curves: curves.collect(), domain: [self.domain[1], self.domain[0]] }
    }

    /// In a domain that is a little larger.
    pub fn widened(&self, by: f64) -> Self {
        Self { curves: self.curves.clone(), domain: self.domain.map(|[low, high]| [low - by, high + by]) }
    }
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, Curve { field, condition }) in self.curves.iter().enumerate() {
            write!(f, "curve c{number}: {field} = 0")?;
            match condition {
                Some(condition) => writeln!(f, " where {condition} > 0")?,
                None => writeln!(f)?,
            }
        }
        let [[a, b], [c, d]] = self.domain;
        writeln!(f, "domain [{a}, {b}] x [{c}, {d}]")
    }
}
