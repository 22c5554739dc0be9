"""The probe `moment`: what the forces in the results add up to, moved with the force to another place; not for walls."""
import pathlib
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()
run = Case("moment.yaml")
vector = lambda name: np.stack([run.probes[f"{name}_{c}"] for c in "xyz"], axis=1)
force, here, there = vector("push"), vector("here"), vector("there")
report.true("the water pushes", np.linalg.norm(force[-1]) > 1)  # a dam of 0.14 m on a face of 0.1 x 0.08 m: some 4 N
scale = np.linalg.norm(here, axis=1).max()
moved = here - np.cross([0.3, -0.2, 0.1], force)
report.below("moment about another place, over the largest", np.abs(there - moved).max() / scale, 1e-12)  # sums of a few hundred nodes, round-off

with h5py.File(run.directory / "block.vtkhdf") as file:
    group = file["VTKHDF"]
    n = len(group["PointData/force"]) // len(group["Steps/Values"])
    places, forces = group["Points"][-n:].astype(float), group["PointData/force"][-n:].astype(float)
# the field has no impulses of particles stopped at the surface, which are in the probes: they act on the block, at most 0.17 m from the origin
stopped = np.linalg.norm(forces.sum(axis=0) - force[-1])
off = np.linalg.norm(np.cross(places, forces).sum(axis=0) - here[-1])
report.below("sum of x cross f of the results, over the largest", max(0, off - 0.17 * stopped) / scale, 1e-5)  # stored single

refused = Case("moment.yaml", status=2, here_body="zmin")
report.true("refused for a wall, with the reason", "here_body = zmin must name what the moment acts on" in refused.errors)
report.end()
