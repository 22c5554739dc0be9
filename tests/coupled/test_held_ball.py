"""Lift of a held submerged ball is within 2 % of rho g V at radius 5 and 10 spacings, and no water is in it."""
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402
from shapes import icosphere, volume, write_off  # noqa: E402

report = Report()
scratch = tempfile.mkdtemp(prefix="byssus_")
for radius, width, depth in ((0.1, 0.6, 0.6), (0.2, 0.72, 0.72)):
    x, triangles = icosphere(radius, (0, 0, depth / 2))
    write_off(f"{scratch}/ball.off", x, triangles)
    half = width / 2
    run = Case("held_ball.yaml", ball_surface=f"{scratch}/ball.off", domain_min=f"{-half},{-half},0", domain_max=f"{half},{half},{depth + 0.2}",
               sph_pool_min=f"{-half},{-half},0", sph_pool_max=f"{half},{half},{depth}")
    exact = 1000 * 9.81 * volume(x, triangles)
    lift = np.array(run.probes["lift_z"])[np.array(run.probes["time"]) > 0.6]
    name = f"R = {radius / 0.02:.0f} dx, {run.ledger['proxies'][-1]:.0f} proxies"
    report.below(f"{name}: lift / rho g V - 1", lift.mean() / exact - 1, 0.02)
    report.below(f"{name}: noise of the lift (rms / mean)", lift.std() / lift.mean(), 0.05)
    report.below(f"{name}: particles inside", run.summary["coupling"]["penetrations"], 0.5)
report.end()
