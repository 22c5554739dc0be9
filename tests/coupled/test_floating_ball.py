"""A free ball of density 500 and 900 floats at the depth of Archimedes, one of 1100 sinks to the floor."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

RADIUS, SPACING, AREA = 0.08, 0.016, 0.4 * 0.4


def cap(depth):
    """volume of the part of the ball below a level `depth` above its lowest point"""
    d = np.clip(depth, 0, 2 * RADIUS)
    return np.pi * d * d * (RADIUS - d / 3)


def center_height(density, water):
    """center of the ball above the floor when it floats: its displaced volume carries it, the level follows from the water's volume"""
    target = density / 1000 * cap(2 * RADIUS)
    low, high = 0.0, 2 * RADIUS
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if cap(middle) < target else (low, middle)
    return (water + target) / AREA - low + RADIUS


report = Report()
for density, start in ((500, 0.32), (900, 0.26)):
    run = Case("floating_ball.yaml", ball_density=density, ball_translate=f"0,0,{start}", center_at=f"0,0,{start}")
    late = np.array(run.probes["time"]) > 1.5
    height = start + np.array(run.probes["center_z"])[late].mean()
    exact = center_height(density, run.summary["fluid"]["particles"] * SPACING**3)
    report.below(f"density {density}: center is off its depth by (in dx)", (height - exact) / SPACING, 0.25)
    report.below(f"density {density}: particles inside", run.summary["coupling"]["penetrations"], 0.5)
run = Case("floating_ball.yaml", ball_density=1100, ball_translate="0,0,0.2", center_at="0,0,0.2", run_end=1.0)
drop = run.probes["center_z"]
report.true(f"density 1100: sinks, by {-drop[-1]:.3f} m in 1 s", drop[-1] < -0.05)
report.end()
