#!/usr/bin/python3
"""solid.py - ./dev report solid [-only SECTION ...]: run everything that docs/verification/solid.md shows, and write it.

Each section is kept in build/report/solid/SECTION.md, its scenes beside it (run one by itself: byssus verify build/report/solid/NAME.yaml). With
-only the others are taken from there. Status 0 when every row is within what is allowed, 3 when one is not, 1 when something could not be run.
"""

import os
import platform
import sys
import time

sys.dont_write_bytecode = True

import dynamic
import speed
import static
from program import BUILD, ROOT, WORK, Failure, execute, say

PAGE = ROOT / "docs" / "verification" / "solid.md"

SECTIONS = (
    ("same_mesh", "Explicit and implicit, same mesh", static.same_mesh),
    ("t4", "The same discrete problem by an independent code", static.t4),
    ("locking", "Near incompressibility: what locks and what does not", static.locking),
    ("quadratic", "Quadratic tetrahedra", static.quadratic),
    ("materials", "Five laws, point by point", static.materials),
    ("critical", "The critical step", dynamic.critical),
    ("order", "Order in the step", dynamic.order),
    ("energy", "Energy over ten periods", dynamic.energy),
    ("frequencies", "Frequencies", dynamic.frequencies),
    ("release", "Release under gravity", dynamic.release),
    ("hard", "Hard cases", static.hard),
    ("speed", "Speed against error", speed.speed),
    ("cost", "Cost of an element and step", speed.cost),
)

HEAD = """# The solid against what is known

Made by `./dev report solid` ({seconds:.0f} s on {machine}); sections by `./dev report solid -only NAME`, NAME given with each. The scenes that were run are
in `build/report/solid`. The independent code is DOLFINx 0.5.2 with PETSc 3.18.5 and SLEPc 3.18.2, its numbers are copied into `report/reference.py`; a second one,
CalculiX, is compared with in `tests/convergence/test_tled_calculix.c`. Meshes are made by gmsh from `tests/meshes/geo`, the same bytes every time. Relative errors
unless a unit is given. Rows that are not within what is allowed say **no**; there are {failures}.
"""


def machine():
    name = platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            name = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), name)
    except OSError:
        pass
    return f"{os.cpu_count()} cores of an {name}" if name[0] in "AEIOU" else f"{os.cpu_count()} cores of a {name}"


def note(name):
    """what a reader should know of a section, written by hand"""
    path = ROOT / "report" / "notes" / (name + ".md")
    return "\n" + path.read_text(encoding="utf-8") if path.exists() else ""


def make(name, section):
    """one section, kept in a file"""
    start = time.time()
    print(f"== {name}", file=sys.stderr, flush=True)
    text = section()
    (WORK / (name + ".md")).write_text(text, encoding="utf-8")
    (WORK / (name + ".seconds")).write_text(f"{time.time() - start:.1f}", encoding="utf-8")


def write_page():
    parts, seconds, failures = [], 0.0, 0
    for name, title, _ in SECTIONS:
        path = WORK / (name + ".md")
        if not path.exists():
            continue
        text = path.read_text(encoding="utf-8")
        seconds += float((WORK / (name + ".seconds")).read_text(encoding="utf-8"))
        failures += text.count("**no**")
        parts.append(f"\n## {title}\n`-only {name}`. {text}{note(name)}")
    PAGE.write_text(HEAD.format(seconds=seconds, machine=machine(), failures=failures or "none") + "".join(parts), encoding="utf-8")
    say(f"{PAGE}: {failures} rows not within, {seconds:.0f} s")
    return failures


def main(arguments):
    only = arguments[1:] if arguments[:1] == ["-only"] else []
    known = [name for name, _, _ in SECTIONS]
    if (arguments and not only) or any(name not in known for name in only):
        print(f"usage: ./dev report solid [-only SECTION ...]; sections: {' '.join(known)}", file=sys.stderr)
        return 2
    WORK.mkdir(parents=True, exist_ok=True)
    try:
        execute([BUILD / "byssus", "info"])
        for name, _, section in SECTIONS:
            if not only or name in only:
                make(name, section)
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    return 3 if write_page() else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
