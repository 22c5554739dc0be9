"""Fields of the water on surfaces: `pressure` at the nodes of a held body and of an obstacle that stands out of the water is the hydrostatic one, dry nodes have
zeros, water at rest has no velocity, and nothing is nan. Means over 0.2 s; the pressure of a first layer that runs in rows differs by 10 % from place to place
(test_gauges.py); the proxies along an edge get 0.8 of their share, their neighbours the rest."""
import pathlib
import sys
import tempfile

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402
from shapes import box, write_off  # noqa: E402

pillar = pathlib.Path(tempfile.mkdtemp(prefix="byssus_")) / "pillar.off"
low, high = np.array([0.22, 0.05, 0.06]), np.array([0.3, 0.15, 0.38])
write_off(pillar, *box(low, high, 5))
run = Case("surface.yaml", pillar_surface=pillar)


def read(name):
    """positions, and each field as mean over the second half of the run"""
    with h5py.File(run.directory / (name + ".vtkhdf")) as file:
        data = file["VTKHDF"]
        steps = int(data["Steps"].attrs["NSteps"])
        mean = lambda values: np.array(values, float).reshape(steps, -1, *values.shape[1:])[10:].mean(axis=0)
        fields = {field: mean(data["PointData/" + field]) for field in data["PointData"]}
        return mean(data["Points"]), fields


report = Report()
volume = run.summary["fluid"]["particles"] * 0.02**3
depth = (volume + 0.001 - np.prod(high[:2] - low[:2]) * low[2]) / (0.36 * 0.2 - np.prod(high[:2] - low[:2]))
for name, corner in (("cube", (np.array([0.04, 0.05, 0.06]), np.array([0.14, 0.15, 0.16]))), ("pillar", (low, high))):
    x, field = read(name)
    outer = np.any((np.abs(x - corner[0]) < 1e-6) | (np.abs(x - corner[1]) < 1e-6), axis=1)
    inside = np.sum((x > corner[0] + 1e-6) & (x < corner[1] - 1e-6), axis=1) >= 2  # of a face, not on an edge
    wet = outer & (x[:, 2] < depth - 0.04)
    error = (field["pressure"] - 9810 * (depth - x[:, 2])) / (9810 * depth)
    report.below(f"{name}: pressure on wet nodes, mean error over rho g H", error[wet].mean(), 0.05)
    report.below(f"{name}: pressure inside of faces, rms", np.sqrt(np.mean(error[wet & inside] ** 2)), 0.12)
    report.below(f"{name}: pressure on edges, rms", np.sqrt(np.mean(error[wet & ~inside] ** 2)), 0.25)
    report.below(f"{name}: water in front of wet nodes - 1", field["water"][wet & inside].mean() - 1, 0.3)
    report.below(f"{name}: speed of the water over sqrt(g H)", np.linalg.norm(field["water_velocity"], axis=1).max() / (9.81 * depth) ** 0.5, 0.15)
    dry = ~outer | (x[:, 2] > depth + 0.1)  # sparse proxies: half a support
    report.true(f"{name}: {dry.sum()} dry and inner nodes are 0", all(np.all(field[f][dry] == 0) for f in ("pressure", "water", "water_pressure", "water_velocity")))
    report.true(f"{name}: all is finite", all(np.all(np.isfinite(values)) for values in field.values()))
    print(f"   Shepard mean of the particles' pressures over hydrostatic: {np.mean(field['water_pressure'][wet & inside] / (9810 * (depth - x[wet & inside, 2]))):.2f}")
    x, field = read(name + "_proxies")
    report.true(f"{name}: fields of proxies are finite", all(np.all(np.isfinite(values)) for values in field.values()))
report.end()
