"""Checks the figures of tests/arrange against CGAL: the sides of the domain are four more lines."""

import json
import subprocess
import sys

import scenes

program = sys.argv[1]
names = sys.argv[2:]
checked = wrong = 0
for name, scene, truth in scenes.cases():
    if names and name not in names:
        continue
    text = scenes.program(scene)
    if text is None:
        continue
    try:
        out = subprocess.run([program, "box"], input=text, capture_output=True, text=True, timeout=120)
        found = json.loads(out.stdout)
    except (subprocess.TimeoutExpired, json.JSONDecodeError) as error:
        print(f"{name}: CGAL gives no answer ({type(error).__name__}) {out.stderr[-200:] if isinstance(error, json.JSONDecodeError) else ''}")
        continue
    found["degrees"] = {int(d): n for d, n in found["degrees"].items()}
    found = {key: found[key] for key in truth}
    checked += 1
    if found != truth:
        wrong += 1
        print(f"{name}:\n  table {truth}\n  CGAL  {found}")
print(f"{checked} cases compared, {wrong} differ")
sys.exit(wrong > 0)
