"""Water fills boxes and closed surfaces, once where they overlap, leaves room for bodies, and starts at rest density. Ctrl-C saves and a resume ends
the run."""
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import PROGRAM, Case, Report  # noqa: E402
from shapes import icosphere, volume, write_off  # noqa: E402

DX = 0.0125
report = Report()
scratch = pathlib.Path(tempfile.mkdtemp(prefix="byssus_"))
x, triangles = icosphere(0.08, (0.05, 0.0, 0.04))
write_off(scratch / "drop.off", x, triangles)
run = Case("fill.yaml", sph_drop_surface=scratch / "drop.off")

d = 0.04  # the drop reaches this far into the pool
dipped = np.pi * d * d * (0.08 - d / 3)
wanted = 0.4 * 0.4 * 0.2 + volume(x, triangles) - dipped - run.ledger["solid_volume"][0]
report.below("water of all blocks over its volume - 1", run.summary["fluid"]["particles"] * DX**3 / wanted - 1, 0.02)
report.below("mean compression at the start", run.ledger["compression_mean"][0], 1e-3)
report.below("largest compression at the start", run.ledger["compression_max"][0], 0.02)
report.below("particles in the body at the start", run.ledger["penetrations"][0], 0.5)

scene = pathlib.Path(__file__).resolve().parent / "fill.yaml"
keys = ["-sph_drop_surface", str(scratch / "drop.off"), "-run_end", "5"]
process = subprocess.Popen([PROGRAM, "run", str(scene), "-run_directory", str(scratch / "run"), *keys], stderr=subprocess.PIPE, text=True)
while not (scratch / "run" / "ledger.csv").exists() and process.poll() is None:
    time.sleep(0.1)
time.sleep(1.0)
process.send_signal(signal.SIGINT)
_, errors = process.communicate(timeout=60)
report.true("Ctrl-C ends with status 130", process.returncode == 130)
report.true("and says how to go on", "-resume" in errors)
report.true("and has saved", (scratch / "run" / "checkpoint.h5").exists())
again = Case("fill.yaml", resume=scratch / "run", directory=scratch / "run", sph_drop_surface=scratch / "drop.off", run_end=5, run_max_steps=1)
report.true("a resume takes it up", again.summary["status"] in ("stopped", "done"))
report.end()
