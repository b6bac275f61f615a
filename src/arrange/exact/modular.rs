//! Arithmetic modulo primes just below 2^62, and polynomials over those fields.

use std::sync::Mutex;

use num_bigint::BigInt;
use num_bigint::Sign;

/// The integers modulo an odd prime below 2^62, in Montgomery's form (Montgomery 1985): `a` stands for `a / 2^64`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    prime: u64,
    /// `-1 / prime` modulo 2^64.
    inverse: u64,
    /// 2^128 modulo the prime.
    square: u64,
    /// One.
    pub one: u64,
}

impl Field {
    fn new(prime: u64) -> Self {
        let mut inverse = prime;
        for _ in 0..5 {
            inverse = inverse.wrapping_mul(2u64.wrapping_sub(prime.wrapping_mul(inverse)));
        }
        let one = ((1u128 << 64) % u128::from(prime)) as u64;
        let square = (u128::from(one) * u128::from(one) % u128::from(prime)) as u64;
        Self { prime, inverse: inverse.wrapping_neg(), square, one }
    }

    pub fn prime(self) -> u64 {
        self.prime
    }

    fn reduce(self, t: u128) -> u64 {
        let m = (t as u64).wrapping_mul(self.inverse);
        let u = ((t + u128::from(m) * u128::from(self.prime)) >> 64) as u64;
        if u >= self.prime { u - self.prime } else { u }
    }

    pub fn mul(self, a: u64, b: u64) -> u64 {
        self.reduce(u128::from(a) * u128::from(b))
    }

    pub fn add(self, a: u64, b: u64) -> u64 {
        let sum = a + b;
        if sum >= self.prime { sum - self.prime } else { sum }
    }

    pub fn sub(self, a: u64, b: u64) -> u64 {
        if a >= b { a - b } else { a + self.prime - b }
    }

    pub fn neg(self, a: u64) -> u64 {
        self.sub(0, a)
    }

    pub fn pow(self, a: u64, mut n: u64) -> u64 {
        let (mut result, mut power) = (self.one, a);
        while n > 0 {
            if n & 1 == 1 {
                result = self.mul(result, power);
            }
            power = self.mul(power, power);
            n >>= 1;
        }
        result
    }

    /// The inverse of a number other than 0.
    pub fn inv(self, a: u64) -> u64 {
        self.pow(a, self.prime - 2)
    }

    /// The element of a residue below 2^62.
    pub fn element(self, residue: u64) -> u64 {
        self.mul(residue % self.prime, self.square)
    }

    /// The residue of an element.
    pub fn residue(self, element: u64) -> u64 {
        self.reduce(u128::from(element))
    }

    /// The element of an integer.
    pub fn of(self, number: &BigInt) -> u64 {
        let prime = u128::from(self.prime);
        let digits = number.iter_u64_digits().rev();
        let residue = digits.fold(0u64, |sum, digit| (((u128::from(sum) << 64) | u128::from(digit)) % prime) as u64);
        let element = self.element(residue);
        if number.sign() == Sign::Minus { self.neg(element) } else { element }
    }

    /// Evaluates a polynomial, coefficients by rising power.
    pub fn evaluate(self, poly: &[u64], x: u64) -> u64 {
        poly.iter().rev().fold(0, |sum, &c| self.add(self.mul(sum, x), c))
    }

    /// The remainder by a polynomial other than 0; leading coefficients of both are not 0.
    fn remainder(self, mut a: Vec<u64>, b: &[u64]) -> Vec<u64> {
        let m = b.len() - 1;
        let inverse = self.inv(b[m]);
        while a.len() > m {
            let top = a.len() - 1 - m;
            let factor = self.mul(a[a.len() - 1], inverse);
            for (x, &y) in a[top..].iter_mut().zip(&b[..m]) {
                *x = self.sub(*x, self.mul(factor, y));
            }
            a.pop();
            trim(&mut a);
        }
        a
    }

    /// The monic greatest common divisor.
    pub fn gcd(self, a: &[u64], b: &[u64]) -> Vec<u64> {
        let (mut a, mut b) = (a.to_vec(), b.to_vec());
        while !b.is_empty() {
            let r = self.remainder(a, &b);
            (a, b) = (b, r);
        }
        if let Some(&lead) = a.last() {
            let inverse = self.inv(lead);
            a.iter_mut().for_each(|c| *c = self.mul(*c, inverse));
        }
        a
    }

    /// Whether two polynomials, whose leading coefficients are not 0, have no common root; without inverses.
    pub fn is_coprime(self, a: &[u64], b: &[u64]) -> bool {
        let (mut a, mut b) = (a.to_vec(), b.to_vec());
        while !b.is_empty() {
            let m = b.len() - 1;
            let lead = b[m];
            while a.len() > m {
                let Some(top) = a.pop() else { break };
                let offset = a.len() - m;
                a.iter_mut().for_each(|c| *c = self.mul(*c, lead));
                for (x, &y) in a[offset..].iter_mut().zip(&b[..m]) {
                    *x = self.sub(*x, self.mul(top, y));
                }
                trim(&mut a);
            }
            (a, b) = (b, a);
        }
        a.len() == 1
    }

    /// The k-th subresultant of polynomials of degrees above `k`, the determinant polynomial of the rows y^i f (i < deg g - k)
    /// over the rows y^i g (i < deg f - k); `None` if its degree is below k.
    ///
    /// By Euclid's algorithm: with r = f mod g of degree l >= k the determinant is (-1)^((n-k)(m-k)) lc(g)^(n-l) S_k(g, r), and
    /// S_l(g, r) = lc(r)^(m-l-1) r (Geddes, Czapor, Labahn, "Algorithms for computer algebra", 1992, section 7.3).
    pub fn subresultant(self, f: &[u64], g: &[u64], k: usize) -> Option<Vec<u64>> {
        let (mut a, mut b) = (f.to_vec(), g.to_vec());
        let mut scale = self.one;
        loop {
            let (n, m) = (a.len() - 1, b.len() - 1);
            if (n - k) * (m - k) % 2 == 1 {
                scale = self.neg(scale);
            }
            if n < m {
                (a, b) = (b, a);
                continue;
            }
            let mut r = self.remainder(a, &b);
            if r.len() <= k {
                return None;
            }
            let l = r.len() - 1;
            scale = self.mul(scale, self.pow(b[m], (n - l) as u64));
            if l == k {
                scale = self.mul(scale, self.pow(r[l], (m - l - 1) as u64));
                r.iter_mut().for_each(|c| *c = self.mul(*c, scale));
                return Some(r);
            }
            (a, b) = (b, r);
        }
    }

    /// The polynomial of degree below `points.len()` with these values at these integers, which rise.
    pub fn interpolate(self, points: &[u64], values: &[u64]) -> Vec<u64> {
        let n = points.len();
        let span = (points[n - 1] - points[0]) as usize;
        let inverses = self.inverses(span);
        let mut differences = values.to_vec();
        for step in 1..n {
            for i in (step..n).rev() {
                let gap = (points[i] - points[i - step]) as usize;
                differences[i] = self.mul(self.sub(differences[i], differences[i - 1]), inverses[gap]);
            }
        }
        let mut result: Vec<u64> = Vec::with_capacity(n);
        for i in (0..n).rev() {
            // result * (x - points[i]) + differences[i]
            let root = self.element(points[i]);
            result.insert(0, 0);
            for j in 0..result.len() - 1 {
                result[j] = self.sub(result[j], self.mul(root, result[j + 1]));
            }
            result[0] = self.add(result[0], differences[i]);
        }
        result
    }

    /// The inverses of 1, 2, ... `last`, at their own index.
    fn inverses(self, last: usize) -> Vec<u64> {
        let mut factorials = vec![self.one; last + 1];
        for i in 1..=last {
            factorials[i] = self.mul(factorials[i - 1], self.element(i as u64));
        }
        let mut inverses = vec![0; last + 1];
        let mut inverse = self.inv(factorials[last]);
        for i in (1..=last).rev() {
            inverses[i] = self.mul(inverse, factorials[i - 1]);
            inverse = self.mul(inverse, self.element(i as u64));
        }
        inverses
    }
}

/// Takes leading zeros away.
pub fn trim(poly: &mut Vec<u64>) {
    while poly.last() == Some(&0) {
        poly.pop();
    }
}

/// The field of the `index`-th prime below 2^62.
pub fn field(index: usize) -> Field {
    static FIELDS: Mutex<Vec<Field>> = Mutex::new(Vec::new());
    let mut fields = FIELDS.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    while fields.len() <= index {
        let mut candidate = fields.last().map_or((1 << 62) + 1, |last| last.prime) - 2;
        while !is_prime(candidate) {
            candidate -= 2;
        }
        fields.push(Field::new(candidate));
    }
    fields[index]
}

/// The first primes: as bases they make Miller and Rabin's test a proof below 2^64 (Sorenson and Webster 2017).
const BASES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

/// Whether an odd number above 37 is a prime.
fn is_prime(number: u64) -> bool {
    if BASES.iter().any(|base| number.is_multiple_of(*base)) {
        return false;
    }
    let field = Field::new(number);
    let minus = field.neg(field.one);
    let twos = (number - 1).trailing_zeros();
    BASES.iter().all(|&base| {
        let mut power = field.pow(field.element(base), (number - 1) >> twos);
        if power == field.one || power == minus {
            return true;
        }
        for _ in 1..twos {
            power = field.mul(power, power);
            if power == minus {
                return true;
            }
        }
        false
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_fields_are_those_of_the_primes_below_two_to_the_62() {
        // 2^62 - 57, - 87, - 117 are the largest primes below 2^62 (Caldwell's table of primes just below powers of two).
        let primes: Vec<u64> = (0..3).map(|i| (1 << 62) - field(i).prime()).collect();
        assert_eq!(primes, [57, 87, 117]);
    }

    #[test]
    fn subresultants_are_determinants() {
        let f = field(0);
        let int = |x: i64| f.of(&BigInt::from(x));
        let poly = |c: &[i64]| -> Vec<u64> { c.iter().map(|&x| int(x)).collect() };
        // det [[1, 2, 3], [4, 5, 0], [0, 4, 5]] = 33
        assert_eq!(f.subresultant(&poly(&[3, 2, 1]), &poly(&[5, 4]), 0), Some(poly(&[33])));
        // (y - 1)(y - 2)(y - 3) and (y - 1)(y - 2)(y + 5): S_2 = f's row - g's row in the order (f, g): det [[1, f], [1, g]]
        let (a, b) = (poly(&[-6, 11, -6, 1]), poly(&[10, -13, 2, 1]));
        assert_eq!(f.subresultant(&a, &b, 2), Some(poly(&[16, -24, 8])));
        assert_eq!(f.subresultant(&a, &b, 1), None);
    }

    #[test]
    fn interpolation_returns_the_polynomial() {
        let f = field(1);
        let poly: Vec<u64> = [7u64, 0, 3, 11].iter().map(|&c| f.element(c)).collect();
        let points = [1, 2, 4, 7];
        let values: Vec<u64> = points.iter().map(|&x| f.evaluate(&poly, f.element(x))).collect();
        assert_eq!(f.interpolate(&points, &values), poly);
    }
}
