"""Random polynomial curves by Imp and by CGAL: what Imp says is proved must be what CGAL finds.

    fuzz.py ARRANGEMENT IMP [COUNT [SEED]]
"""

import collections
import json
import random
import subprocess
import sys
import tempfile

import scenes


def polynomial(rng, degree, size):
    terms = [
        f"({rng.choice([-1, 1]) * rng.randint(1, size)}) x^{i} y^{j}".replace(" x^0", "").replace(" y^0", "")
        for i in range(degree + 1)
        for j in range(degree + 1 - i)
        if rng.random() < 0.7
    ]
    if not any("x" in term or "y" in term for term in terms):
        terms.append("x")
    return "(" + " + ".join(terms) + ")"


def curve(rng):
    """Small coefficients make contacts, double points and common parts likely."""
    kind = rng.randrange(8)
    small = rng.choice([1, 2, 5])
    if kind == 0:
        return polynomial(rng, 1, small) + polynomial(rng, 2, small)
    if kind == 1:
        return polynomial(rng, 2, small) + "^2"
    if kind == 2:
        return polynomial(rng, 1, small) + "^2 + " + polynomial(rng, 1, small) + "^2"
    if kind == 3:
        return "x^2 " + polynomial(rng, 1, small) + " + y^2 " + polynomial(rng, 1, small)
    return polynomial(rng, rng.randint(1, 4), small)


def scene(rng):
    curves = [curve(rng) for _ in range(rng.randint(1, 3))]
    if rng.random() < 0.1:
        curves.append(curves[0])
    text = "; ".join(f"curve c{k}: {c} = 0" for k, c in enumerate(curves))
    # Odd sides, so that little happens on the frame.
    return text + "; domain [-2.17, 2.39] x [-2.29, 2.11]"


def figures(structure):
    """Of Imp's file, what scenes.cases() has of a case."""
    vertices, halfedges, edges = structure["vertices"], structure["halfedges"], structure["edges"]
    arms = collections.Counter()
    part = list(range(len(vertices)))

    def find(v):
        while part[v] != v:
            v = part[v]
        return v

    for k, edge in enumerate(edges):
        if edge["kind"] == "frame":
            continue
        a, b = halfedges[2 * k]["origin"], halfedges[2 * k + 1]["origin"]
        arms[a] += 1
        arms[b] += 1
        part[find(a)] = find(b)
    inner = [v for v, vertex in enumerate(vertices) if vertex["kind"] != "corner"]
    within = [v for v in inner if vertices[v]["kind"] != "boundary"]
    degrees = collections.Counter(arms[v] for v in within)
    return {
        "faces": structure["summary"]["faces"],
        "components": len({find(v) for v in inner}),
        "isolated": degrees[0],
        "degrees": {d: n for d, n in sorted(degrees.items()) if d not in (0, 2)},
        "boundary": len(inner) - len(within),
    }


def imp_figures(imp, text):
    """What Imp finds, and whether it is proved."""
    with tempfile.NamedTemporaryFile("w", suffix=".imp") as file, tempfile.NamedTemporaryFile(suffix=".json") as out:
        file.write(text + "\n")
        file.flush()
        command = [imp, "arrange", file.name, "-o", out.name]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60)
        if done.returncode:
            raise ValueError(done.stderr)
        structure = json.load(open(out.name))
        return figures(structure), structure["summary"]["proved"]


def cgal_figures(cgal, text):
    out = subprocess.run([cgal, "box"], input=scenes.program(text), capture_output=True, text=True, timeout=60)
    found = json.loads(out.stdout)
    found["degrees"] = {int(d): n for d, n in found["degrees"].items()}
    return {key: found[key] for key in ("faces", "components", "isolated", "degrees", "boundary")}


def compare(cgal, imp, texts):
    proved = wrong = count = 0
    for name, text in texts:
        try:
            truth = cgal_figures(cgal, text)
        except (subprocess.TimeoutExpired, json.JSONDecodeError, TypeError, AttributeError):
            continue
        count += 1
        try:
            found, sure = imp_figures(imp, text)
        except (subprocess.TimeoutExpired, ValueError) as said:
            print(f"{name}: {text}\n  {type(said).__name__} {str(said)[:400]}", flush=True)
            continue
        proved += sure
        if found != truth and sure:
            wrong += 1
            print(f"{name}: {text}\n  CGAL {truth}\n  Imp  {found}", flush=True)
        elif not sure:
            print(f"{name} is open: {text}", flush=True)
    print(f"{count} compared, {proved} fully proved, {wrong} of them wrong")
    return wrong


if __name__ == "__main__":
    cgal, imp = sys.argv[1:3]
    count, seed = [int(a) for a in sys.argv[3:5] + ["100", "0"][len(sys.argv) - 3 :]]
    sys.exit(compare(cgal, imp, ((s, scene(random.Random(s))) for s in range(seed, seed + count))) > 0)
