"""A soft block that sinks onto the floor drives the water from under it, comes to lie there, and carries the water above it, not a lift by the water at its
foot. Means over the last 0.6 s of 1.2; the swing of the force is 2 % of it, of its mean a tenth of that. The block, 4 layers of particles high, is pressed
into the floor by 0.01 dx and rises by the start's gap to a few hundredths of dx."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

run = Case("resting.yaml")
late = np.array(run.probes["time"]) > 0.6
mean = {name: np.array(values)[late].mean() for name, values in run.probes.items()}
volume = run.summary["fluid"]["particles"] * 0.02**3
above = 9810 * 0.1**2 * ((volume + 0.1**2 * 0.08) / 0.3**2 - 0.08)
report = Report()
report.below("force down over the weight of the water above, less 1", -mean["f_z"] / above - 1, 0.05)
report.below("force sideways over it", np.hypot(mean["f_x"], mean["f_y"]) / above, 0.03)
report.below("way down over the gap of one spacing, less 1", -mean["top_z"] / 0.02 - 1, 0.05)
report.below("particles inside the block", max(run.ledger["penetrations"]), 0.5)
report.end()
