#!/usr/bin/python3
"""solid.py - ./dev report solid [-only SECTION ...]: run everything that docs/verification/solid.md shows, and write it.

Each section is kept in build/report/solid/SECTION.md, its scenes beside it (run one by itself: byssus verify build/report/solid/NAME.yaml). With
-only the others are taken from there. Status 0 when every row is within what is allowed, 3 when one is not, 1 when something could not be run.
"""

import sys

sys.dont_write_bytecode = True

import dynamic
import speed
import static
from sections import main

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


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], SECTIONS, HEAD))
