"""Gauges on a film that runs down an incline, over a planar wall and over a proxied floor: what they read is what is known, the same on both. Wall drag carries what
drives; pressure on a patch is the water's weight; flow rate is depth, width and mean velocity; the profile is half a parabola."""
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402
from shapes import box, write_off  # noqa: E402

SPACING, SIDE, G, NU = 0.02, 0.16, 9.81, 0.02

report = Report()
slab = pathlib.Path(tempfile.mkdtemp(prefix="byssus_")) / "slab.off"
write_off(slab, *box((0, 0, -0.08), (SIDE, SIDE, 0), 8))
drag, profiles = [], []
for name, bottom, keys in (
    ("planar wall", 0.0, dict(domain_min="0,0,0", domain_walls="zmin", floor_body="zmin", patch_body="zmin", patch_min="0.04,0.04,-0.01", patch_max="0.12,0.12,0.01")),
    ("proxied floor", 0.08, dict(obstacles="slab", slab_surface=slab, floor_body="slab", patch_body="slab", patch_min="0.041,0.041,-0.01", patch_max="0.121,0.121,0.01")),
):
    run = Case("gauges.yaml", floor_quantity="force", patch_quantity="pressure", **keys)
    late = np.array(run.probes["time"]) > 1.8
    mean = lambda column: np.array(run.probes[column])[late].mean()
    mass = run.summary["fluid"]["particles"] * SPACING**3 * 1000
    depth = mass / 1000 / SIDE**2
    peak = depth**2 / (2 * NU)
    drag.append(mean("floor_x") / mass)
    report.below(f"{name}: drag / driving force - 1", drag[-1] - 1, 0.03)  # the film is not quite at its speed
    report.below(f"{name}: pressure on the patch / rho g H - 1", mean("patch") / (1000 * G * depth) - 1, 0.12)  # particles run in rows: four of them on the patch
    report.below(f"{name}: surface above the floor / depth - 1", (mean("top") - bottom) / depth - 1, 0.03)
    report.below(f"{name}: flow rate / (2/3 U H b) - 1", mean("flow") / (2 / 3 * peak * depth * SIDE) - 1, 0.08)  # 8 layers
    t, x, y, z, u, v, w = np.loadtxt(run.directory / "profile.csv", delimiter=",", skiprows=1, unpack=True).reshape(7, -1, 7)
    profiles.append(u[t[:, 0] > 1.8].mean(axis=0) / peak)
    exact = 2 * z[0] / depth - (z[0] / depth) ** 2
    report.below(f"{name}: profile on the line, rms of U", np.sqrt(np.mean((profiles[-1] - exact) ** 2)), 0.08)
    t, x, y, z, p = np.loadtxt(run.directory / "cut.csv", delimiter=",", skiprows=1, unpack=True).reshape(5, -1, 3, 4)
    p = p[t[:, 0, 0] > 1.8].mean(axis=0)
    report.below(f"{name}: pressure on the rectangle, mean error / rho g H", np.abs(p - 1000 * G * (depth - z[0])).mean() / (1000 * G * depth), 0.08)  # one-sided at the surface
report.below("drag of both", drag[0] / drag[1] - 1, 0.02)
report.below("profiles of both, rms of U", np.sqrt(np.mean((profiles[0] - profiles[1]) ** 2)), 0.03)
report.end()
