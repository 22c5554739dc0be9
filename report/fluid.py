#!/usr/bin/python3
"""fluid.py - ./dev report fluid [-keep] [-only SECTION ...]: run everything that docs/verification/fluid.md shows, and write it.

Each section is kept in build/report/fluid/SECTION.md, its scenes and runs beside it (run one by itself: byssus run build/report/fluid/NAME.yaml). With
-only the others are taken from there; with -keep runs whose scene is unchanged are read again instead of run again, to work on tables and pictures.
Status 0 when every row is within what is allowed, 3 when one is not, 1 when something could not be run.

A section is a function without arguments that returns markdown: what is asked, a table (resolution, error, order, seconds), a picture. It says its
finest error for the table at the head by sections.claim. Runs: flow.py; pictures: draw.py; tables: program.table. To add one: its module below, its line here.
"""

import sys

sys.dont_write_bytecode = True

import fluid_claims
import fluid_flows
import fluid_closed
import fluid_free
import fluid_hard
import fluid_krylov
import fluid_marin
import fluid_sloshing
import fluid_speed
import fluid_still
import fluid_viscous
import fluid_waves
from sections import main

SECTIONS = (
    ("still", "Still water in a tank", fluid_still.still),
    ("poiseuille", "Laminar flow: Poiseuille, a film down an incline", fluid_viscous.poiseuille),
    ("couette", "Laminar flow: Couette", fluid_viscous.couette),
    ("implicit", "Implicit viscosity", fluid_viscous.implicit),
    ("settle", "Start from rest", fluid_flows.settle),
    ("open_channel", "Channels with inflow and outflow", fluid_flows.open_channel),
    ("source", "A tap that fills a tank", fluid_flows.source),
    ("wave_maker", "Waves of a piston", fluid_waves.wave_maker),
    ("moving_tank", "Water in tanks that move", fluid_waves.moving_tank),
    ("drop", "A stretching drop", fluid_free.drop),
    ("column", "A collapsing column", fluid_free.column),
    ("krylov", "The pressure system, solved in many ways", fluid_krylov.krylov),
    ("taylor_green", "Decaying vortices", fluid_closed.taylor_green),
    ("cavity", "A cavity with a moving lid", fluid_closed.cavity),
    ("patch", "A rotating square", fluid_closed.patch),
    ("marin", "A dam break against a box", fluid_marin.marin),
    ("sloshing", "Sloshing: the first impact", fluid_sloshing.sloshing),
    ("volume", "Sloshing: volume", fluid_sloshing.volume),
    ("hard", "Hard cases", fluid_hard.hard),
    ("speed", "Speed against error", fluid_speed.speed),
    ("claims", "What the sources say of speed", fluid_claims.claims),
)

HEAD = """# The fluid against what is known

Made by `./dev report fluid` ({seconds:.0f} s on {machine}, often shared with other work: cpu seconds count); sections by `./dev report fluid -only NAME`, NAME given with each.
Scenes and results are in `build/report/fluid`, reference numbers with their sources in `report/data`. Unless a section says otherwise: solver `iisph`, cubic spline, support
2 dx, single precision, no viscosity. Orders: slope of the least-squares line of log error over log spacing. How walls, filter and loops were chosen: [fluid-slice.md](fluid-slice.md);
formulas and their exact properties: the README's table and `ctest -R unit.sph`.

## What is asked, and what was reached
Each case is asked for its error over resolution, its order and a picture; bars are those of the method's page or of the order. Rows that miss a bar say **no**; there are {failures}.

{summary}"""

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], SECTIONS, HEAD))
