"""Edges and corners: a cube that stands on the floor carries the water above it and no more, the floor the rest; the floor's pressure is that of the
depth in a corner of the tank, at an edge and inside. Means over the last second of two; the swing of one patch is 3 %, of its mean a tenth of that."""
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402
from shapes import box, write_off  # noqa: E402

cube = pathlib.Path(tempfile.mkdtemp(prefix="byssus_")) / "cube.off"
write_off(cube, *box((0.1, 0.1, 0), (0.2, 0.2, 0.1), 4))
run = Case("standing.yaml", cube_surface=cube)
late = np.array(run.probes["time"]) > 1.0
mean = {name: np.array(values)[late].mean() for name, values in run.probes.items()}
volume = run.summary["fluid"]["particles"] * 0.02**3
depth = (volume + 0.1**3) / 0.3**2
above = 9810 * 0.1**2 * (depth - 0.1)
report = Report()
report.below("cube: force down over the weight of the water above, less 1", -mean["cube_force_z"] / above - 1, 0.03)
report.below("cube: force sideways over that on one side", np.hypot(mean["cube_force_x"], mean["cube_force_y"]) / (9810 * 0.1**2 * (depth - 0.05)), 0.03)
report.below("floor: force over the weight less that on the cube, less 1", -mean["floor_z"] / (9810 * volume - above) - 1, 0.01)
for patch in ("corner", "edge", "inner"):
    report.below(f"{patch}: pressure over rho g H, less 1", mean[patch] / (9810 * depth) - 1, 0.02)
report.below("particles inside the cube", max(run.ledger["penetrations"]), 0.5)
report.end()
