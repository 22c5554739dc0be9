#!/usr/bin/python3
"""coupling.py - ./dev report coupling [-keep] [-only SECTION ...]: run everything that docs/verification/coupling.md shows, and write it.

Works as fluid.py: a section is a function without arguments that returns markdown; it is kept in build/report/coupling/SECTION.md with its scenes and runs
beside it. Status 0 when every row is within what is allowed, 3 when one is not, 1 when something could not be run.
"""

import sys

sys.dont_write_bytecode = True

from coupling_blade import blade
from coupling_hard import hard
from coupling_ladder import piston, plate_ladder
from coupling_paper import convergence, fewest, octopus, paper
from coupling_proxies import resample, resting
from coupling_schemes import conservation, work
from coupling_shapes import affine, shapes
from coupling_validation import gate, hydrostatic_plate, obstacle
from sections import main

SECTIONS = (
    ("paper", "The paper's scene: water on a bunny", paper),
    ("octopus", "The same on an octopus", octopus),
    ("fewest", "The fewest proxies for the bunny", fewest),
    ("convergence", "The paper's convergence study", convergence),
    ("affine", "Sparse proxies on a plane", affine),
    ("shapes", "Hydrostatic force on known shapes over the density of proxies", shapes),
    ("resample", "Sampling afresh: when, and what it costs", resample),
    ("resting", "Bodies on walls, on obstacles, beside each other", resting),
    ("hydrostatic_plate", "A column of water on an elastic plate", hydrostatic_plate),
    ("gate", "A dam breaks through an elastic gate", gate),
    ("obstacle", "A dam breaks on an elastic obstacle", obstacle),
    ("blade", "A flexible blade in a current", blade),
    ("conservation", "Momentum of a closed system", conservation),
    ("work", "Work at the interface", work),
    ("piston", "Added mass: a piston under a column", piston),
    ("plate_ladder", "Added mass: a clamped plate under a column", plate_ladder),
    ("hard", "Hard cases", hard),
)

HEAD = """# Water and bodies against what is known

Made by `./dev report coupling` ({seconds:.0f} s on {machine}, often shared with other work: cpu seconds count); sections by `./dev report coupling -only NAME`, NAME given with each.
Scenes and results are in `build/report/coupling`, reference numbers with their sources in `report/data`. Unless a section says otherwise: defaults, support 2 dx, single precision,
no viscosity. The fluid by itself: [fluid.md](fluid.md), the solid: [solid.md](solid.md).

## What is asked, and what was reached
Rows that miss a bar say **no**; there are {failures}.

{summary}"""

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], SECTIONS, HEAD))
