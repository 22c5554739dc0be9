"""Water enters and leaves a channel whose number of particles stays, a resumed run ends with the same bits though particles came and went, and a tap
fills a tank to the level that its volume says."""
import pathlib
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

DX = 0.05
report = Report()


def checkpoint(run):
    with h5py.File(run.directory / "checkpoint.h5") as file:
        return {name: np.array(file["fluid"][name]) for name in ("id", "position", "velocity", "flows")}


whole = Case("flows.yaml")
ledger = whole.ledger
asked = 0.5 * 0.2 * 0.2 * np.array(ledger["time"])
report.below("volume entered against velocity times area times time, in layers", np.max(np.abs(np.array(ledger["fluid_entered"]) - asked)) / (0.2 * 0.2 * DX), 0.55)
report.below("change of the number of particles over a flow-through", ledger["fluid_particles"][-1] / ledger["fluid_particles"][1] - 1, 0.2)
report.below("mean compression", max(ledger["compression_mean"]), 2e-3)

half = Case("flows.yaml", run_end=0.5)
rest = Case("flows.yaml", resume=half.directory, directory=half.directory)
a, b = checkpoint(whole), checkpoint(rest)
report.true(f"particles have left ({len(set(range(240)) - set(a['id'].tolist()))} of the first 240)", len(set(range(240)) - set(a["id"].tolist())) > 100)
report.true("resume gives the same particles", len(a["id"]) == len(b["id"]) and np.array_equal(a["id"], b["id"]) and np.array_equal(a["flows"], b["flows"]))
report.true("to the bit", np.array_equal(a["position"], b["position"]) and np.array_equal(a["velocity"], b["velocity"]))

tap = Case("tap.yaml")
dx = 0.0375
report.below("particles of the tap over its volume, less one", tap.summary["fluid"]["particles"] - int(0.018 / dx**3), 0)
late = np.array(tap.probes["time"]) > 2.0
level = np.mean([np.array(tap.probes[k])[late].mean() for k in ("a", "b")])
report.below("level of the tank over 0.2 m, off in spacings", (level - 0.2) / dx, 0.5)
report.below("outlets of a scene that has none", tap.ledger["fluid_left"][-1], 0)
report.end()
