"""CGAL and Imp on the same curves, by turns: figures and times.

CGAL arranges the plane, and once more with the box's sides as lines; its time includes no start of a program and no reading.
Imp's is the `ms` of its summary: without start and reading, with the compilation of kernels. Each run is a process of
its own, since CGAL keeps what it knows of a curve.
"""

import json
import random
import statistics
import subprocess
import sys
import tempfile

import scenes

RUNS = 5
# The source's: below about 1e-8 of the box, double points drown in rounding.
EPSILON = "1e-6"
PATIENCE = 60
NAMES = [
    "circles crossing",
    "circles touching aslant",
    "overlap 1e-9",
    "three circles through one point",
    "six lines in general position",
    "folium and a line through its double point",
    "two lobes with a tacnode",
    "acnodal cubic",
    "rose of 8 petals",
    "ampersand curve",
    "trott",
    "trott and lemniscate",
    "trott and lemniscate touching",
    "quartic of four ovals",
    "Chebyshev T5 T4",
    "Chebyshev T7 T6",
    "dyadic powers",
]


def made():
    """Scenes that are too long for the table: seeded, so that they are the same every time."""
    t12 = "2048x^12 - 6144x^10 + 6912x^8 - 3584x^6 + 840x^4 - 72x^2 + 1"
    yield "Chebyshev T12 + T12", f"curve a: ({t12}) + ({t12.replace('x', 'y')}) = 0; domain [-1.3, 1.4] x [-1.2, 1.3]"
    rng = random.Random(5)
    for count, degree in [(20, 1), (10, 2), (5, 3), (10, 3), (3, 5)]:
        curves = []
        for k in range(count):
            terms = [
                f"{rng.randint(-99, 99)} x^{i} y^{j}".replace(" x^0", "").replace(" y^0", "")
                for i in range(degree + 1)
                for j in range(degree + 1 - i)
            ]
            curves.append(f"curve c{k}: " + " + ".join(terms).replace("+ -", "- ") + " = 0")
        yield f"{count} random curves of degree {degree}", "; ".join(curves) + "; domain [-4, 4.1] x [-4.2, 4.3]"


def run(command, text=None):
    out = subprocess.run(command, input=text, capture_output=True, text=True, timeout=PATIENCE)
    return json.loads(out.stdout)


def main():
    cgal, imp = sys.argv[1:3]
    wanted = sys.argv[3:]
    table = [(name, scene) for name, scene, _ in scenes.cases() if name in NAMES]
    table.sort(key=lambda row: NAMES.index(row[0]))
    print("| scene | faces | crossings and other vertices by degree | CGAL ms | with box ms | Imp ms | CGAL / Imp | same |")
    print("|---|---|---|---|---|---|---|---|")
    ratios = []
    for name, scene in table + list(made()):
        if wanted and name not in wanted:
            continue
        text = scenes.program(scene)
        with tempfile.NamedTemporaryFile("w", suffix=".imp") as file:
            file.write(scene + "\n")
            file.flush()
            plane, boxed, own = [], [], []
            try:
                for _ in range(RUNS):
                    plane.append(run([cgal, "plane"], text))
                    boxed.append(run([cgal, "box"], text))
                    own.append(run([imp, "arrange", file.name, "--json", "--epsilon", EPSILON]))
            except subprocess.TimeoutExpired as late:
                print(f"| {name} | {late.cmd[0].rsplit('/', 1)[-1]} takes more than {PATIENCE} s |||||||")
                continue
        ms = [statistics.median(found["ms"] for found in runs) for runs in (plane, boxed, own)]
        found, kinds = own[0], own[0]["vertices"]
        same = found["faces"] == boxed[0]["faces"] and kinds["boundary"] == boxed[0]["boundary"]
        degrees = ", ".join(f"{n} of {d}" for d, n in boxed[0]["degrees"].items()) or "none"
        if found["proved"]:
            ratios.append(ms[0] / ms[2])
        verdict = ("yes" if same else "NO") + ("" if found["proved"] else ", not all proved")
        print(f"| {name} | {boxed[0]['faces']} | {degrees} | {ms[0]:.1f} | {ms[1]:.1f} | {ms[2]:.1f} | {ms[0] / ms[2]:.2f} | {verdict} |")
        sys.stdout.flush()
    if ratios:
        print(f"\nmedian ratio of the {len(ratios)} fully proved: {statistics.median(ratios):.2f}")


main()
