#!/usr/bin/env python3
"""Kernels of ../himmelblau.imp called from Python through ctypes, on NumPy arrays, checked against NumPy itself.

    python3 himmelblau.py          builds the shared library with `cargo run` and `cc`, then runs
    IMP=/usr/local/bin/imp python3 himmelblau.py

ctypes releases the interpreter's lock during a call, so threads compute at the same time.
"""

import ctypes
import os
import pathlib
import re
import shlex
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
OUT = ROOT / "target" / "embedding" / "python"
DOUBLES = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")
WORDS = np.ctypeslib.ndpointer(np.uint32, flags="C_CONTIGUOUS")


def build():
    """Compiles the formulas to a shared library; its path and the symbol of its interface."""
    OUT.mkdir(parents=True, exist_ok=True)
    manifest = ROOT / "Cargo.toml"
    imp = shlex.split(os.environ.get("IMP", f"cargo run --quiet --manifest-path '{manifest}' --bin imp --"))
    source, code, header = HERE.parent / "himmelblau.imp", OUT / "himmelblau.o", OUT / "himmelblau.h"
    subprocess.run([*imp, "build", source, "-o", code, "--header", header], check=True)
    library = OUT / "himmelblau.so"
    subprocess.run([os.environ.get("CC", "cc"), "-shared", "-o", library, code, "-lm"], check=True)
    return library, re.search(r'himmelblau_ABI_SYMBOL "(\w+)"', header.read_text())[1]


def load(path, interface):
    """The library with the types of its functions; fails if it was built from another interface."""
    library = ctypes.CDLL(str(path))
    ctypes.c_uint32.in_dll(library, interface)
    assert library.himmelblau_level() > 0, "no kernel runs on this processor"
    optional = ctypes.c_void_p
    for name in ["value", "gradient"]:
        for way in ["", "_columns"]:
            function = getattr(library, f"himmelblau_f_{name}{way}")
            function.restype, function.argtypes = None, [DOUBLES, optional, DOUBLES, ctypes.c_size_t]
    for name in ["interval", "interval_gradient"]:
        for way in ["", "_columns"]:
            function = getattr(library, f"himmelblau_f_{name}{way}")
            function.restype, function.argtypes = None, [DOUBLES, optional, DOUBLES, WORDS, ctypes.c_size_t]
    return library


def plain_gradient(x, y):
    """The function and its partial derivatives by NumPy."""
    u, v = x**2 + y - 11, x + y**2 - 7
    return np.stack([u**2 + v**2, 4 * x * u + 2 * v, 2 * u + 4 * y * v])


def fastest(work):
    """The shortest of five times in seconds."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def main():
    library = load(*build())
    random = np.random.default_rng(1)
    count = 1_000_003
    x, y = random.uniform(-5, 5, (2, count))

    # Values and gradients at points, in rows and in columns.
    rows = np.empty((count, 3))
    library.himmelblau_f_gradient(np.column_stack([x, y]), None, rows, count)
    columns = np.empty((3, count))
    points = np.stack([x, y])
    compiled = fastest(lambda: library.himmelblau_f_gradient_columns(points, None, columns, count))
    expected = plain_gradient(x, y)
    plain = fastest(lambda: plain_gradient(x, y))
    assert np.array_equal(rows.T, columns)
    assert np.allclose(columns, expected, rtol=1e-12, atol=1e-10)
    print(f"value and gradient: {1e9 * compiled / count:.1f} ns a point, NumPy {1e9 * plain / count:.1f} ns")

    # Enclosures over boxes: every value at a point of the box lies inside.
    width = random.uniform(0, 0.5, (2, count))
    boxes = np.stack([np.stack([x, x + width[0]]), np.stack([y, y + width[1]])])
    ends, verdicts = np.empty((1, 2, count)), np.empty((1, count), np.uint32)
    library.himmelblau_f_interval_columns(boxes, None, ends, verdicts, count)
    share = random.uniform(0, 1, (2, count))
    px, py = x + share[0] * width[0], y + share[1] * width[1]
    inside = (px**2 + py - 11) ** 2 + (px + py**2 - 7) ** 2
    slack = 1e-12 * np.maximum(1, inside)  # NumPy's own rounding
    assert np.all(ends[0, 0] <= inside + slack) and np.all(inside - slack <= ends[0, 1])
    proved = (verdicts[0] & 1) != 0
    assert np.array_equal(proved, ends[0, 0] > 0) and 0 < proved.sum() < count
    assert np.all(verdicts & 8), "a polynomial is continuous"
    print(f"proved positive on {100 * proved.mean():.1f} % of the boxes")

    # Parameters as intervals: a in [10.9, 11.1] encloses what the default gives.
    wide = np.empty((1, 2, count))
    parameters = np.array([[10.9, 11.1], [7.0, 7.0]])
    library.himmelblau_f_interval_columns(boxes, parameters.ctypes.data, wide, verdicts, count)
    assert np.all(wide[0, 0] <= ends[0, 0]) and np.all(ends[0, 1] <= wide[0, 1])

    # Threads on slices of the same arrays.
    box_rows = np.ascontiguousarray(boxes.transpose(2, 0, 1))
    one, many = np.empty((count, 1, 2)), np.empty((count, 1, 2))
    words = np.empty((count, 1), np.uint32)
    library.himmelblau_f_interval(box_rows, None, one, words, count)

    def part(piece):
        library.himmelblau_f_interval(box_rows[piece], None, many[piece], words[piece], len(box_rows[piece]))

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(part, [slice(i, i + 10_007) for i in range(0, count, 10_007)]))
    assert np.array_equal(one, many) and np.array_equal(one[:, 0, :].T, ends[0])
    print("eight threads compute the same bits")


if __name__ == "__main__":
    main()
