#!/usr/bin/env python3
"""Running error analysis of the elementary functions' cores (src/derive/elementary), operation by operation.

Usage: python3 tests/elementary/rounding.py

Every quantity is (lo, hi, err): over one small cell of the reduced argument its exact value lies in [lo, hi] and the
computed one misses it by at most err. An operation adds epsilon times its largest result, which bounds its rounding in
any mode (second-order terms are inside, as results are enlarged by their errors). The printed figure is the largest
error over all cells divided by the scale by which the code multiplies its bound, in epsilon, certified approximation
error included; the constants in the sources are at least 5 % above it. Python's own rounding is irrelevant at this
margin. Below the smallest cell the figures have converged: corrections vanish relative to the argument.

Coefficients are read from tables.rs, so that the analysis speaks of the code as it is.
"""
import math
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLES = (ROOT / "src/derive/elementary/tables.rs").read_text()


def table(name, precision):
    body = re.search(r"pub const %s: \w+ =\s+\w+ \{(.*?)\};" % name, TABLES, re.S).group(1)
    numbers = re.search(r"%s: &\[(.*?)\]" % precision, body, re.S).group(1)
    return [float(x) for x in numbers.replace("\n", " ").split(",") if x.strip()]


class Precision:
    def __init__(self, name):
        self.name, self.eps = name, {"single": 2.0**-23, "double": 2.0**-52}[name]


class V:
    """A value with its error; `p` is the precision whose epsilon operations add."""

    def __init__(self, p, lo, hi, err=0.0):
        self.p, self.lo, self.hi, self.err = p, min(lo, hi), max(lo, hi), err

    @property
    def mag(self):
        return max(abs(self.lo), abs(self.hi)) + self.err

    def rounded(self):
        return V(self.p, self.lo, self.hi, self.err + self.p.eps * self.mag)

    def exact(self, lo, hi, err):
        return V(self.p, lo, hi, err)

    def __neg__(self):
        return V(self.p, -self.hi, -self.lo, self.err)

    def known(self, f):
        """The same quantity with its exact range given by a monotone function of the cell."""
        return V(self.p, f[0], f[1], self.err)


def lift(p, x):
    return x if isinstance(x, V) else V(p, x, x)


def add(a, b, exact=False):
    p = a.p if isinstance(a, V) else b.p
    a, b = lift(p, a), lift(p, b)
    v = V(p, a.lo + b.lo, a.hi + b.hi, a.err + b.err)
    return v if exact else v.rounded()


def sub(a, b, exact=False):
    return add(a, -b if isinstance(b, V) else -b, exact)


def product(a, b):
    p = a.p if isinstance(a, V) else b.p
    a, b = lift(p, a), lift(p, b)
    corners = [x * y for x in (a.lo, a.hi) for y in (b.lo, b.hi)]
    if a is b:
        corners = [a.lo * a.lo, a.hi * a.hi]
    ma, mb = max(abs(a.lo), abs(a.hi)), max(abs(b.lo), abs(b.hi))
    return V(p, min(corners), max(corners), a.err * mb + b.err * ma + a.err * b.err)


def mul(a, b, exact=False):
    v = product(a, b)
    return v if exact else v.rounded()


def fma(a, b, c):
    p = product(a, b)
    return add(p, c, exact=True).rounded()


def div(a, b):
    p = a.p if isinstance(a, V) else b.p
    a, b = lift(p, a), lift(p, b)
    assert b.lo - b.err > 0
    corners = [x / y for x in (a.lo, a.hi) for y in (b.lo, b.hi)]
    err = a.err / (b.lo - b.err) + max(abs(a.lo), abs(a.hi)) * b.err / (b.lo * (b.lo - b.err))
    return V(p, min(corners), max(corners), err).rounded()


def sqrt(a):
    assert a.lo >= 0
    if a.lo == 0:
        return V(a.p, 0, math.sqrt(a.hi), math.sqrt(a.err)).rounded()
    return V(a.p, math.sqrt(a.lo), math.sqrt(a.hi), a.err / (2 * math.sqrt(a.lo - a.err))).rounded()


def poly(cs, x):
    v = lift(x.p, cs[-1])
    for c in reversed(cs[:-1]):
        v = fma(v, x, c)
    return v


def cells(smallest, largest, ratio=1.004):
    """Cells from smallest to largest, of both signs unless largest is one-sided by the caller's choice."""
    x = smallest
    while x < largest:
        y = min(x * ratio, largest)
        yield x, y
        x = y


def both(smallest, largest):
    for lo, hi in cells(smallest, largest):
        yield lo, hi
        yield -hi, -lo


def approximation(name, precision):
    text = TABLES[: TABLES.index("pub const %s:" % name)].rsplit("///", 1)[1]
    single, double = re.findall(r"([\d.]+) epsilon \((?:single|double)\)", text)
    return float(single if precision == "single" else double)


def least(v):
    return min(abs(v.lo), abs(v.hi)) if v.lo * v.hi > 0 else 0.0


def report(section, figure):
    results = {}
    for name in ("single", "double"):
        p = Precision(name)
        results[name] = max(figure(p)) / p.eps
    print(f"{section:14} single {results['single']:.3f}  double {results['double']:.3f}")


# Exponentials: the error of s relative to |r|. The reduced argument enters everywhere as one and the same number, so its
# own error is counted once, through the derivative.
def exp_like(p, factor):
    cs = table("EXP", p.name)
    for lo, hi in both(2.0**-20, 0.3467):
        per_r = {None: 1.0, "LN_2": math.log(2), "LN_10": math.log(10)}[factor]
        scale = min(abs(lo), abs(hi)) / per_r
        if factor is None:
            r = V(p, lo, hi)
            s = fma(mul(r, r), poly(cs, r), r)
        else:
            l = table(factor, p.name)
            r = V(p, lo / l[0], hi / l[0])
            w = mul(r, l[0])
            curved = mul(mul(w, w), poly(cs, w))
            low = fma(r, l[1], curved)
            s = fma(r, l[0], low)
        reduction = 0.0 if factor == "LN_2" else 1.01 * p.eps * max(abs(lo), abs(hi)) * math.exp(hi)
        err = s.err + reduction + approximation("EXP", p.name) * p.eps * max(abs(math.expm1(lo)), abs(math.expm1(hi)))
        yield err / scale


# Logarithms: the error of head + tail relative to |head|, and absolute.
def log_rest(p, f):
    """ln(1 + f) - f, with the approximation error of its polynomial."""
    s = div(f, add(f, 2.0))
    # The quotient's range is known better than by dividing ranges.
    s = s.known(sorted((f.lo / (2 + f.lo), f.hi / (2 + f.hi))))
    z = mul(s, s)
    half_f = mul(f, 0.5, exact=True)
    half_square = mul(half_f, f)
    half_square = half_square.known(sorted((f.lo * f.lo / 2, f.hi * f.hi / 2)))
    inner = fma(z, poly(table("LN", p.name), z), half_square)
    t = mul(s, inner)
    rest = fma(-half_f, f, t)
    rest = rest.known((math.log1p(f.lo) - f.lo, math.log1p(f.hi) - f.hi))
    rest.err += approximation("LN", p.name) * p.eps * max(abs(math.log1p(f.lo)), abs(math.log1p(f.hi)))
    return rest


def log_like(p, base, lost=False, absolute=False):
    per_f = {"e": 1.0, "2": 1 / math.log(2), "10": 1 / math.log(10)}[base]
    per_k = {"e": math.log(2), "2": 1.0, "10": math.log10(2)}[base]
    for lo, hi in both(2.0**-20, 0.4143):
        if lo < -0.293:
            continue
        f = V(p, lo, hi)
        rest = log_rest(p, f)
        # Figures for k = 0, where the head is f, and for k = -1, 1, 2 and 1000 (single: 120).
        for k in (0, -1, 1, 2, 120 if p.name == "single" else 1000):
            r = V(p, rest.lo, rest.hi, rest.err)
            if lost and k != 0:
                # c 2^-k / m: |c 2^-k| <= epsilon; the linear 1/m errs by 6 %, second-order terms are nothing.
                r.err += 0.07 * p.eps
                r = add(r, V(p, -p.eps, p.eps))
            if base == "e":
                product, tail = f, r
            else:
                product = V(p, lo * per_f, hi * per_f)
                # The product's error and the factor's second part: one epsilon at most, kept exactly but for a rounding.
                low = V(p, -p.eps * product.mag, p.eps * product.mag, p.eps * p.eps * product.mag)
                tail = fma(r, per_f, low)
            if k != 0:
                short = table("LN_2_SHORT" if base == "e" else "LOG10_2_SHORT", p.name)
                if base != "2":
                    tail = fma(V(p, k, k), short[1], tail)
            head = [k * per_k + x for x in (product.lo, product.hi)]
            magnitude = min(map(abs, head))
            if k != 0:
                # What the sum with k loses is kept, up to epsilon of it.
                ulp = p.eps * max(map(abs, head))
                tail = add(tail, V(p, -ulp, ulp, p.eps * ulp))
            yield tail.err / (1.0 if absolute else magnitude)


# Sine and cosine: the error relative to the head, r or 1, the reduction's one rounding included.
def sine(p):
    top = 0.80 if p.name == "single" else 0.7855
    for lo, hi in cells(2.0**-20, top):
        r = V(p, lo, hi)
        u = mul(r, r)
        tail = mul(r, mul(u, poly(table("SIN", p.name), u)))
        # The reduction's rounding is counted through the derivative.
        err = tail.err + 1.001 * p.eps * hi * math.cos(lo) + approximation("SIN", p.name) * p.eps * math.sin(hi)
        yield err / lo


def cosine(p):
    top = 0.80 if p.name == "single" else 0.7855
    for lo, hi in cells(2.0**-20, top):
        r = V(p, lo, hi)
        u = mul(r, r)
        tail = mul(u, poly(table("COS", p.name), u))
        yield tail.err + 1.001 * p.eps * hi * math.sin(hi) + approximation("COS", p.name) * p.eps * (1 - math.cos(hi))


def tangent(p):
    top = 0.80 if p.name == "single" else 0.7855
    for lo, hi in cells(2.0**-20, top):
        r = V(p, lo, hi)
        u = mul(r, r)
        tail = mul(r, mul(u, poly(table("SIN", p.name), u)))
        # The third part of the reduction goes into the tail: one rounding more, and nothing to speak of in size.
        s = add(r, tail.rounded())
        s = s.known((math.sin(lo), math.sin(hi)))
        s.err += approximation("SIN", p.name) * p.eps * math.sin(hi)
        c = fma(u, poly(table("COS", p.name), u), 1.0)
        c = c.known((math.cos(hi), math.cos(lo)))
        c.err += approximation("COS", p.name) * p.eps * (1 - math.cos(hi))
        # The reduction's rounding: d tan r / tan r = dr / (sin r cos r), and the same for the cotangent.
        reduction = 1.01 * p.eps * hi / (math.sin(lo) * math.cos(hi))
        yield s.err / math.sin(lo) + c.err / math.cos(hi) + p.eps * 1.001 + reduction


def arcsine(p, root):
    for lo, hi in cells(2.0**-20, 0.5):
        s = V(p, lo, hi)
        if root:
            # The root's argument is exact; the root rounds once.
            s.err = p.eps * hi
            z = V(p, lo * lo, hi * hi)
        else:
            z = mul(s, s)
        tail = mul(s, mul(z, poly(table("ASIN", p.name), z)))
        tail.err += approximation("ASIN", p.name) * p.eps * math.asin(hi)
        err = tail.err
        if root:
            # head 2 s, then pi/2 - 2 s - (2 tail - P2): two additions of that size and the sum's lost part.
            err = 2 * (err + s.err) + 2 * p.eps * (2 * tail.mag + p.eps * 1.58)
        yield err / lo


def arctangent(p, quotient):
    for lo, hi in cells(2.0**-20, 1.0):
        t = V(p, lo, hi)
        z = mul(t, t)
        tail = mul(t, mul(z, poly(table("ATAN", p.name), z)))
        tail = tail.known((math.atan(hi) - hi, math.atan(lo) - lo))
        err = tail.err + approximation("ATAN", p.name) * p.eps * math.atan(hi)
        if quotient:
            err += p.eps * hi / (1 + lo * lo) + 2 * p.eps * (tail.mag + p.eps * 3.2)
        yield err / lo


# Hyperbolic functions: |x| = n ln 2 + r. The sine's error is relative to (p - q) + |S| (p + q), the cosine's to p + q.
def hyperbolic(p, what):
    for n in (0, 1, 2, 3, 5, 10, 12, 13, 24, 26, 27, 53):
        for lo, hi in both(2.0**-20, 0.3467):
            if n == 0 and lo < 0:
                continue
            r = V(p, lo, hi)
            reduction = 1.01 * p.eps * max(abs(lo), abs(hi)) if n else 0.0
            z = mul(r, r)
            curve = mul(z, poly(table("COSH", p.name), z))
            curve.err += approximation("COSH", p.name) * p.eps * (math.cosh(max(abs(lo), abs(hi))) - 1)
            slope = fma(r, mul(z, poly(table("SINH", p.name), z)), r)
            slope = slope.known((math.sinh(lo), math.sinh(hi)))
            slope.err += approximation("SINH", p.name) * p.eps * slope.mag
            big, small = 0.25 * 2.0**n, 0.25 * 2.0**-n
            exact = 2 * n < (22 if p.name == "single" else 51)
            total, difference = V(p, big + small, big + small), V(p, big - small, big - small)
            if not exact:
                total, difference = total.rounded(), difference.rounded()
            sine = add(fma(difference, curve, mul(slope, total)), difference, exact=True)
            cosine = add(fma(total, curve, mul(slope, difference)), total, exact=True)
            x_lo, x_hi = n * math.log(2) + lo, n * math.log(2) + hi
            if what == "sinh":
                scale = difference.lo + least(slope) * total.lo
                yield (sine.err + reduction * max(math.cosh(x_lo), math.cosh(x_hi)) / 2) / scale
            else:
                yield (cosine.err + reduction * max(math.sinh(x_lo), math.sinh(x_hi)) / 2) / total.lo


# tanh a = t / (t + 2), t = e^(2a) - 1 = 2 (p s + (p - 1/2)), 2a = n ln 2 + r.
def tanh_quotient(p):
    for n in range(0, 30):
        for lo, hi in both(2.0**-20, 0.3467):
            if n == 0 and lo < 0:
                continue
            r = V(p, lo, hi)
            s = fma(mul(r, r), poly(table("EXP", p.name), r), r)
            s = s.known((math.expm1(lo), math.expm1(hi)))
            s.err += approximation("EXP", p.name) * p.eps * s.mag
            half = V(p, 2.0 ** (n - 1) - 0.5, 2.0 ** (n - 1) - 0.5)
            t = fma(V(p, 2.0 ** (n - 1), 2.0 ** (n - 1)), s, half if n < 22 else half.rounded())
            x_lo, x_hi = n * math.log(2) + lo, n * math.log(2) + hi
            t = t.known((math.expm1(x_lo) / 2, math.expm1(x_hi) / 2))
            # t / (t + 2) depends on t twice: relative to it, dt / t 2 / (t + 2).
            relative = t.err / t.lo / (t.lo + 1)
            reduction = 1.01 * p.eps * max(abs(lo), abs(hi)) / math.sinh(x_lo) if n else 0.0
            yield relative + reduction + 2.01 * p.eps


# Relative errors of log1p's argument w; its logarithm's is no larger, as w / ((1 + w) ln(1 + w)) <= 1 for w >= 0.
def asinh_argument(p):
    for lo, hi in cells(2.0**-20, 2.0**20):
        a = V(p, lo, hi)
        square = mul(a, a)
        root = sqrt(add(square, 1.0))
        w = add(a, div(square, add(root, 1.0)))
        yield w.err / (lo + lo * lo / (1 + math.sqrt(1 + lo * lo)))


def acosh_argument(p):
    for lo, hi in cells(2.0**-22, 2.0**20):
        # x - 1 is exact up to x = 2.
        t = V(p, lo, hi, 0.0 if hi <= 1 else p.eps * hi)
        w = add(t, sqrt(mul(t, add(t, 2.0))))
        yield w.err / (lo + math.sqrt(lo * (lo + 2)))


def atanh_argument(p):
    for lo, hi in cells(2.0**-20, 1 - 2.0**-10, 1.0005):
        a = V(p, lo, hi)
        # 1 - a is exact from 1/2 on.
        below = sub(1.0, a, exact=lo >= 0.5)
        w = div(mul(a, 2.0, exact=True), below)
        yield w.err / (2 * lo / (1 - lo))


def nearest_multiples():
    """How near numbers of a format come to multiples of a constant: log2 of the smallest |r| / n and |r|."""
    from mpmath import mp, mpf, floor

    mp.prec = 400
    work = 300
    cases = [("pi/2", mp.pi / 2, 667545, 41723), ("ln 2", mp.log(2), 1080, 155), ("log10 2", mp.log10(2), 1080, 155)]
    for name, constant, double, single in cases:
        step = int(floor(constant * mpf(2) ** work))
        for label, bits, count in (("double", 53, double), ("single", 24, single)):
            value, nearest, ratio = 0, None, None
            for n in range(1, count + 1):
                value += step
                unit = 1 << (value.bit_length() - bits)
                rest = value % unit
                rest = min(rest, unit - rest)
                nearest = rest if nearest is None else min(nearest, rest)
                if ratio is None or rest * ratio[1] < ratio[0] * n:
                    ratio = (rest, n)
            print(f"  {name} {label}: |r| >= 2^{math.log2(nearest) - work:.2f}, |r|/n >= 2^{math.log2(ratio[0]) - work - math.log2(ratio[1]):.2f}")


if __name__ == "__main__":
    report("exp", lambda p: exp_like(p, None))
    report("exp2", lambda p: exp_like(p, "LN_2"))
    report("exp10", lambda p: exp_like(p, "LN_10"))
    report("ln", lambda p: log_like(p, "e"))
    report("log2", lambda p: log_like(p, "2"))
    report("log10", lambda p: log_like(p, "10"))
    report("log1p", lambda p: log_like(p, "e", lost=True))
    report("ln, absolute", lambda p: log_like(p, "e", absolute=True))
    report("log2, absolute", lambda p: log_like(p, "2", absolute=True))
    report("log10, absolute", lambda p: log_like(p, "10", absolute=True))
    report("log1p, absolute", lambda p: log_like(p, "e", lost=True, absolute=True))
    report("sin", sine)
    report("cos", cosine)
    report("tan", tangent)
    report("asin", lambda p: arcsine(p, False))
    report("asin, root", lambda p: arcsine(p, True))
    report("atan", lambda p: arctangent(p, False))
    report("atan, quotient", lambda p: arctangent(p, True))
    report("sinh", lambda p: hyperbolic(p, "sinh"))
    report("cosh", lambda p: hyperbolic(p, "cosh"))
    report("tanh", tanh_quotient)
    report("asinh", asinh_argument)
    report("acosh", acosh_argument)
    report("atanh", atanh_argument)
    print("nearest multiples")
    nearest_multiples()
