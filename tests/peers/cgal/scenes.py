"""Reads the scenes of tests/arrange/*.rs and turns polynomial ones into what arrangement.cpp reads."""

import pathlib
import re

import sympy
from sympy.parsing.sympy_parser import (
    convert_xor,
    implicit_multiplication,
    parse_expr,
    rationalize,
    standard_transformations,
)

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "arrange"
X, Y = sympy.symbols("x y")
RULES = standard_transformations + (convert_xor, rationalize, implicit_multiplication)
TABLE = (
    r'case\(\s*"([^"]*)",\s*"([^"]*)",\s*(?:"[^"]*"|\w+),'
    r"\s*\[(\d+), (\d+), (\d+), (\d+)\],\s*&\[([^\]]*)\],?\s*\)"
)
CASE = re.compile(TABLE)


def cases():
    """(name, scene, figures) of each case."""
    for file in sorted(FOLDER.glob("*.rs")):
        for name, scene, faces, components, isolated, boundary, degrees in CASE.findall(file.read_text()):
            degrees = dict((int(d), int(n)) for d, n in re.findall(r"\((\d+), (\d+)\)", degrees))
            truth = {
                "faces": int(faces),
                "components": int(components),
                "isolated": int(isolated),
                "degrees": degrees,
                "boundary": int(boundary),
            }
            yield name, scene, truth


def expression(text):
    # A number directly before a letter, as in 3x, is a product; a letter is never a call.
    text = re.sub(r"(\d)\s*([xy])", r"\1*\2", text)
    return parse_expr(text, local_dict={"x": X, "y": Y}, transformations=RULES)


def polynomials(scene):
    """The squarefree integer polynomials of a scene's curves, or None if one is none."""
    found = []
    for statement in scene.replace("\n", ";").split(";"):
        statement = statement.strip()
        if not statement.startswith("curve"):
            continue
        formula = statement.split(":", 1)[1]
        if re.search(r"where|\||[a-wz]\w*\s*\(|\(.*/\s*\(|/ *[xy(]", formula):
            return None
        left, right = formula.split("=")
        p = sympy.Poly(expression(left) - expression(right), X, Y)
        p = sympy.Poly(sympy.prod(f for f, _ in sympy.factor_list(p.as_expr(), X, Y)[1]), X, Y) if p.total_degree() > 0 else p
        p = p.clear_denoms(convert=True)[1].primitive()[1]
        found.append(p)
    return found


def box(scene):
    """The sides left, right, bottom, top as rationals."""
    text = re.search(r"domain (.*)", scene).group(1)
    sides = [sympy.Rational(s) for s in re.findall(r"-?[\d.]+", text.replace("]^2", "]"))]
    return sides if len(sides) == 4 else sides * 2


def program(scene):
    """The input of arrangement.cpp."""
    curves = polynomials(scene)
    if curves is None:
        return None
    lines = [" ".join(str(s) for s in box(scene))]
    for p in curves:
        terms = [f"{i} {j} {c}" for (i, j), c in p.terms()]
        lines.append(" ".join([str(len(terms))] + terms))
    return "\n".join(lines) + "\n"
