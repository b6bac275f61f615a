//! Common factors: square-free polynomials, pairwise coprime, that make up given ones.

use crate::arrange::exact::polynomial::Polynomial;
use crate::arrange::exact::subresultant;
use crate::arrange::exact::subresultant::Shadow;
use crate::arrange::exact::univariate::Univariate;

/// A square-free factor, and which of the given polynomials it divides, how often.
pub type Factor = (Polynomial, Vec<(usize, u32)>);

/// Square-free polynomials, pairwise coprime, such that each given polynomial is the product of powers of them up to a
/// constant. Factors in x alone or in y alone are apart from the others. They need not be irreducible. Zero polynomials have
/// no factors. A greatest common divisor that is out of reach leaves two factors as they are; `false` says so.
pub fn coprime_base(polys: &[Polynomial]) -> (Vec<Factor>, bool) {
    let mut bases = [X, Y, BOTH].map(|class| Base { class, ..Base::default() });
    let mut complete = true;
    for (index, poly) in polys.iter().enumerate().filter(|(_, poly)| !poly.is_zero()) {
        for (class, part) in parts(poly).into_iter().enumerate() {
            for (factor, multiplicity) in square_free(&part, class, &mut complete) {
                bases[class].insert(factor, (index, multiplicity), &mut complete);
            }
        }
    }
    let factors = bases.into_iter().flat_map(|base| base.factors).map(|(factor, mut uses)| {
        uses.sort_unstable();
        (factor.primitive(), uses)
    });
    (factors.collect(), complete)
}

/// The classes of factors, in the order of [`parts`].
const X: usize = 0;
const Y: usize = 1;
const BOTH: usize = 2;

/// The factor in x alone, that in y alone, and the rest, all primitive.
fn parts(poly: &Polynomial) -> [Polynomial; 3] {
    let poly = poly.primitive();
    let x = Polynomial::new(vec![poly.content_x()]);
    let rest = poly.divide(&x).unwrap_or_default();
    let y = Polynomial::new(vec![rest.exchanged().content_x()]).exchanged();
    let rest = rest.divide(&y).unwrap_or_default();
    [x, y, rest]
}

/// A factor of one variable as such.
fn univariate(poly: &Polynomial, class: usize) -> Univariate {
    if class == X { poly.leading() } else { poly.exchanged().leading() }
}

fn bivariate(poly: Univariate, class: usize) -> Polynomial {
    let poly = Polynomial::new(vec![poly]);
    if class == X { poly } else { poly.exchanged() }
}

/// The greatest common divisor within a class; `None` if it is a constant.
fn common(f: &Polynomial, g: &Polynomial, class: usize, complete: &mut bool) -> Option<Polynomial> {
    if class == X || class == Y {
        let gcd = univariate(f, class).gcd(&univariate(g, class));
        return (!gcd.is_constant()).then(|| bivariate(gcd, class));
    }
    subresultant::gcd(f, g).unwrap_or_else(|_| {
        *complete = false;
        None
    })
}

/// Square-free coprime factors with their multiplicities.
fn square_free(poly: &Polynomial, class: usize, complete: &mut bool) -> Vec<(Polynomial, u32)> {
    if poly.is_constant() || poly.is_zero() {
        return Vec::new();
    }
    if class == X || class == Y {
        let factors = univariate(poly, class).square_free();
        return factors.into_iter().map(|(factor, m)| (bivariate(factor, class), m)).collect();
    }
    // The radical r of f = r c, then the factors of multiplicity 1, and the rest from c. No factor is free of y.
    let (mut rest, mut factors, mut multiplicity) = (poly.clone(), Vec::new(), 1);
    let mut radical = radical(&rest, complete);
    while radical.degree_y() > 0 {
        rest = rest.divide(&radical).unwrap_or_default();
        let next = if rest.degree_y() > 0 { common(&radical, &rest, class, complete) } else { None };
        let next = next.unwrap_or_else(|| Polynomial::constant(1.into()));
        let single = radical.divide(&next).unwrap_or_default();
        if single.degree_y() > 0 {
            factors.push((single, multiplicity));
        }
        radical = next;
        multiplicity += 1;
    }
    factors
}

/// The product of the distinct factors.
fn radical(poly: &Polynomial, complete: &mut bool) -> Polynomial {
    let derivative = poly.derivative_y();
    if derivative.degree_y() == 0 {
        return poly.clone();
    }
    // The derivative may have a content in x; common divisors do not.
    let content = Polynomial::new(vec![derivative.content_x()]);
    let derivative = derivative.divide(&content).unwrap_or(derivative);
    let repeated = common(poly, &derivative, BOTH, complete);
    repeated.and_then(|repeated| poly.divide(&repeated)).unwrap_or_else(|| poly.clone())
}

/// The factors of one class.
#[derive(Default)]
struct Base {
    class: usize,
    factors: Vec<Factor>,
    shadows: Vec<Shadow>,
}

impl Base {
    fn push(&mut self, poly: Polynomial, uses: Vec<(usize, u32)>) {
        self.shadows.push(Shadow::new(&poly));
        self.factors.push((poly, uses));
    }

    /// Takes a square-free factor in, with the index of its polynomial and its multiplicity there.
    fn insert(&mut self, factor: Polynomial, (index, times): (usize, u32), complete: &mut bool) {
        let mut rest = factor;
        let mut shadow = Shadow::new(&rest);
        for i in 0..self.factors.len() {
            if rest.is_constant() {
                return;
            }
            if self.class == BOTH && shadow.is_coprime(&self.shadows[i]) {
                continue;
            }
            let base = &self.factors[i].0;
            let shared = if rest == *base { Some(rest.clone()) } else { common(base, &rest, self.class, complete) };
            let Some(shared) = shared else { continue };
            let (Some(left), Some(right)) = (base.divide(&shared), rest.divide(&shared)) else { continue };
            let old = self.factors[i].1.clone();
            let mut uses = old.clone();
            add_use(&mut uses, index, times);
            self.shadows[i] = Shadow::new(&shared);
            self.factors[i] = (shared, uses);
            if !left.is_constant() {
                self.push(left.primitive(), old);
            }
            rest = right;
            shadow = Shadow::new(&rest);
        }
        if !rest.is_constant() {
            self.push(rest.primitive(), vec![(index, times)]);
        }
    }
}

fn add_use(uses: &mut Vec<(usize, u32)>, index: usize, times: u32) {
    match uses.iter_mut().find(|(i, _)| *i == index) {
        Some((_, m)) => *m += times,
        None => uses.push((index, times)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terms(terms: &[(i64, usize, usize)]) -> Polynomial {
        Polynomial::from_terms(terms)
    }

    #[test]
    fn a_base_splits_common_factors_and_keeps_multiplicities() {
        let circle = terms(&[(1, 2, 0), (1, 0, 2), (-1, 0, 0)]);
        let line = terms(&[(1, 0, 1), (-1, 1, 0)]);
        let parabola = terms(&[(1, 0, 1), (-1, 2, 0)]);
        let (x, y) = (terms(&[(1, 1, 0), (-2, 0, 0)]), terms(&[(1, 0, 2), (-3, 0, 0)]));
        let first = circle.mul(&circle).mul(&line).mul(&x);
        let second = line.mul(&line).mul(&line).mul(&parabola).mul(&y).scale(&(-6).into());
        let third = circle.mul(&parabola).mul(&x).mul(&x).mul(&y);
        let (factors, complete) = coprime_base(&[first, second, third]);
        assert!(complete);
        let mut expected = vec![
            (x, vec![(0, 1), (2, 2)]),
            (y, vec![(1, 1), (2, 1)]),
            (circle, vec![(0, 2), (2, 1)]),
            (line, vec![(0, 1), (1, 3)]),
            (parabola, vec![(1, 1), (2, 1)]),
        ];
        for factor in &factors {
            let place = expected.iter().position(|e| e == factor);
            expected.remove(place.unwrap_or_else(|| panic!("{factor:?} is not expected")));
        }
        assert!(expected.is_empty());
    }

    #[test]
    fn hundreds_of_curves_that_share_nothing_stay_as_they_are() {
        let circles: Vec<Polynomial> =
            (0..200).map(|i| terms(&[(1, 2, 0), (1, 0, 2), (-2 * i, 1, 0), (-1 - i * i % 7, 0, 0)])).collect();
        let (factors, _) = coprime_base(&circles);
        assert_eq!(factors.len(), 200);
        assert!(factors.iter().enumerate().all(|(i, (f, uses))| *f == circles[i] && *uses == [(i, 1)]));
    }
}
