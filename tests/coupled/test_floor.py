"""The wetted surface is where the mesh is: volume offset of still water over a planar wall and over a proxied floor at most 0.1 dx, force on
the floor within 0.5 % of the weight."""
import pathlib
import sys
import tempfile

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402
from shapes import box, write_off  # noqa: E402

SPACING, AREA = 0.02, 0.32 * 0.32


def heights(run, after):
    """centre of mass of the water at the outputs later than `after`"""
    with h5py.File(run.directory / "fluid.vtkhdf") as f:
        g = f["VTKHDF"]
        times, offsets, counts = g["Steps/Values"][:], g["Steps/PointOffsets"][:], g["NumberOfPoints"][:]
        n = int(counts[0])
        return np.array([g["Points"][o:o + n, 2].mean() for t, o in zip(times, offsets) if t > after])


report = Report()
slab = pathlib.Path(tempfile.mkdtemp(prefix="byssus_")) / "slab.off"
write_off(slab, *box((0, 0, -0.08), (0.32, 0.32, 0), 8))
for name, keys in (
    ("planar wall", dict(domain_min="0,0,0", domain_walls="zmin", probes="floor", floor_body="zmin", floor_quantity="force")),
    ("proxied floor", dict(obstacles="slab", slab_surface=slab, probes="floor", floor_body="slab", floor_quantity="force")),
):
    run = Case("floor.yaml", **keys)
    particles = run.summary["fluid"]["particles"]
    depth = particles * SPACING**3 / AREA
    weight = particles * SPACING**3 * 1000 * 9.81
    force = -np.array(run.probes["floor_z"])[np.array(run.probes["time"]) > 1.0]
    report.below(f"{name}: volume offset in dx", (heights(run, 1.0).mean() - depth / 2) / SPACING, 0.1)
    report.below(f"{name}: force / weight - 1", force.mean() / weight - 1, 0.005)
    report.below(f"{name}: noise of the force (rms / mean)", force.std() / force.mean(), 0.01)
report.end()
