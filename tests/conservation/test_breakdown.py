"""A body whose step is beyond the critical one ends the run with status 3: the message names body, time, steps and element, and the run
directory holds the state at the breakdown, which is not garbage."""
import math
import pathlib
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()
run = Case("free_body.yaml", status=3, ball_young=1e7, ball_step=2e-4)
message = next((line for line in run.errors.splitlines() if "broke down" in line), run.errors)
print(message)
for words in ("body ball: the motion is unstable at time ", "the step is ", "the critical one was ", "element ", " of the mesh file at ("):
    report.true(f"the message has: {words}", words in message)
report.true("it is said where the state is", f"the state at the breakdown is the last of the results in {run.directory}" in run.errors)
report.true("the summary says breakdown", run.summary["status"] == "breakdown")
report.true("the run ended early", run.ledger["time"][-1] < 0.06)
report.true("the ledger is finite", all(math.isfinite(v) for column in run.ledger.values() for v in column))
files = sorted(run.directory.glob("ball.vtkhdf"))
report.true("the body's results are there", len(files) == 1)
with h5py.File(files[0]) as file:
    steps = file["VTKHDF/Steps/Values"][:]
    points = file["VTKHDF/Points"][:]
    count = len(points) // len(steps)
    last = points[-count:]
report.true("their last time is that of the breakdown", abs(steps[-1] - run.ledger["time"][-1]) < 1e-12)
report.true("all places are finite", bool(np.isfinite(points).all()))
size = np.ptp(points[:count], axis=0).max()
report.below("size of the body at the breakdown over its first, minus 1", np.ptp(last, axis=0).max() / size - 1.0, 0.5)
report.end()
