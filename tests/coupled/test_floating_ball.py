"""A free ball of density 500 and 900 floats at the depth of Archimedes, one of 1100 sinks to the floor."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

SPACING, AREA = 0.016, 0.4 * 0.4


def cap(radius, depth):
    """volume of the part of a ball below a level `depth` above its lowest point"""
    d = np.clip(depth, 0, 2 * radius)
    return np.pi * d * d * (radius - d / 3)


def center_height(density, water, volume):
    """center above the floor of a floating ball that has the mesh's volume: what it displaces carries it, the level follows from the water"""
    radius = (0.75 * volume / np.pi) ** (1 / 3)
    target = density / 1000 * volume
    low, high = 0.0, 2 * radius
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if cap(radius, middle) < target else (low, middle)
    return (water + target) / AREA - low + radius


report = Report()
for density, start in ((500, 0.32), (900, 0.26)):
    run = Case("floating_ball.yaml", ball_density=density, ball_translate=f"0,0,{start}", center_at=f"0,0,{start}", run_end=2.0)
    late = np.array(run.probes["time"]) > 1.0
    height = start + np.array(run.probes["center_z"])[late].mean()
    exact = center_height(density, run.summary["fluid"]["particles"] * SPACING**3, run.ledger["solid_volume"][0])
    report.below(f"density {density}: center is off its depth by (in dx)", (height - exact) / SPACING, 0.3)
    report.below(f"density {density}: particles inside", run.summary["coupling"]["penetrations"], 0.5)
run = Case("floating_ball.yaml", ball_density=1100, ball_translate="0,0,0.2", center_at="0,0,0.2", run_end=0.5)
drop = run.probes["center_z"]
report.true(f"density 1100: sinks, by {-drop[-1]:.3f} m in 0.5 s", drop[-1] < -0.03)
report.end()
