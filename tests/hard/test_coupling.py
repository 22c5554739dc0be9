"""Hard coupling: a piston whose water is 3 to 100 times as heavy as it is keeps its exact frequency (measured 0.01 to 0.1 %; the reference is exact but for the
square of the spring's strain, 1e-5) in the fixed steps that it is told; a block that crumples takes no particle in, and when it breaks down its books are
numbers and say why; an edge that three triangles share is refused with its place."""
import math
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

GRAVITY, BLOCK, WATER, STEP = 9.81, 0.05, 375.0, 0.00356960781


def frequency(y, step, stride):
    """[rad/s] of y = c + exp(-g t) cos(w t + a), by linear prediction over `stride` samples"""
    a, b, c = y[:-2 * stride], y[stride:-stride], y[2 * stride:]
    p, q, _ = np.linalg.lstsq(np.stack([b, a, np.ones_like(a)], 1), c, rcond=None)[0]
    return abs(np.angle(np.roots([1.0, -p, -q])[0])) / (stride * step)


def piston(report, ratio, scheme):
    mass = WATER / ratio
    young = (2 * math.pi / (40 * STEP)) ** 2 * (mass + WATER)  # of the spring, 1 m long: a period is about 40 steps
    run = Case("piston.yaml", coupler_scheme=scheme, bar_density=mass / BLOCK, bar_young=20 * young, bar_soft_young=young,
               bar_lift_traction=f"0,0,{0.6 * (mass + WATER) * GRAVITY}")
    F = 1 - 0.4 * (mass + WATER) * GRAVITY / young
    spring, block = young * (1 + 1 / F**2), 20 * young / BLOCK
    M = np.array([0.25, 0.125 + 0.5 * mass, 0.5 * mass + WATER])
    K = np.array([[2 * spring, -spring, 0], [-spring, spring + block, -block], [0, -block, block]])
    exact = math.sqrt(np.min(np.linalg.eigvals(K / M[:, None]).real))
    y = np.array(run.probes["top_z"])[20:]
    name = f"{scheme}, water {ratio:g} times the piston's mass"
    report.below(f"{name}: frequency over the exact one, less 1", frequency(y, STEP, 5) / exact - 1, 0.005)
    report.below(f"{name}: steps less 160", run.summary["steps"] - 160, 0.5)
    report.below(f"{name}: pressure solves a step", run.summary["coupling"]["solves_mean"], 4)


def crumple(report):
    run = Case("crumple.yaml", status=(0, 3))
    report.true("crumpling block: every number of the ledger is one", all(np.all(np.isfinite(column)) for column in run.ledger.values()))
    report.below("crumpling block: particles inside", max(run.ledger["penetrations"]), 0.5)
    report.true("crumpling block: ran through, or said why not", run.summary["status"] == "done" or "body block" in run.summary["reason"])


def three_triangles(report):
    rock = pathlib.Path(tempfile.mkdtemp(prefix="byssus_")) / "rock.off"
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1), (0.5, 0.5, -1)]
    faces = [(1, 0, 4), (2, 1, 4), (3, 2, 4), (0, 3, 4), (0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 0, 5), (0, 1, 2), (0, 2, 3)]
    rock.write_text(f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("%g %g %g\n" % p for p in points) + "".join("3 %d %d %d\n" % f for f in faces))
    run = Case("crumple.yaml", status=2, obstacles="rock", rock_surface=rock, rock_scale=0.05, rock_translate="0.1,0.1,0.1")
    report.true("an edge of three triangles is refused with its place", "edge shared by 3 triangles: from (" in run.errors)


report = Report()
piston(report, 3, "mass")
piston(report, 10, "iterated")
piston(report, 100, "iterated")
crumple(report)
three_triangles(report)
report.end()
