"""Run the program on a scene as a user would and read what it wrote. Used by the tests of whole runs.

    from case import Case
    run = Case("floating.yaml", sph_spacing=0.02)      # runs byssus in a temporary directory
    run.ledger["momentum_x"], run.probes["tip_x"], run.summary["coupling"]["penetrations"]
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = os.environ.get("BYSSUS", "byssus")


def read_table(path):
    """CSV with headers `name [unit]` -> {name: [values]}"""
    with open(path, newline="") as f:
        rows = list(csv.reader(f))
    names = [h.split(" [")[0] for h in rows[0]]
    return {n: [float(r[k]) for r in rows[1:]] for k, n in enumerate(names)}


class Case:
    def __init__(self, scene, threads=None, resume=None, directory=None, status=0, **keys):
        scene = pathlib.Path(sys.argv[0]).resolve().parent / scene
        self.directory = pathlib.Path(directory or tempfile.mkdtemp(prefix="byssus_"))
        command = [PROGRAM, "run", str(scene), "-run_directory", str(self.directory)]
        for key, value in keys.items():
            command += [f"-{key}", str(value)]
        if resume:
            command += ["-resume", str(resume)]
        env = dict(os.environ)
        if threads:
            env["OMP_NUM_THREADS"] = str(threads)
        done = subprocess.run(command, env=env, capture_output=True, text=True)
        self.errors = done.stderr
        if done.returncode not in (status if isinstance(status, tuple) else (status,)):
            sys.exit(f"{' '.join(command)}\nexit status {done.returncode}, expected {status}\n{done.stderr[-4000:]}")
        if (self.directory / "summary.json").exists():
            self.summary = json.loads((self.directory / "summary.json").read_text())
            self.ledger = read_table(self.directory / "ledger.csv")
        if (self.directory / "probes.csv").exists():
            self.probes = read_table(self.directory / "probes.csv")


class Report:
    """Collects claims, prints each with its number, and fails at the end if one is false."""

    def __init__(self):
        self.failed = 0
        self.scale = float(os.environ.get("TOL_SCALE", "1"))

    def below(self, what, value, limit):
        good = abs(value) <= limit * self.scale
        self.failed += not good
        print(f"{'ok  ' if good else 'FAIL'} {what}: {value:.4g} (limit {limit:g})", flush=True)

    def true(self, what, good):
        self.failed += not good
        print(f"{'ok  ' if good else 'FAIL'} {what}", flush=True)

    def end(self):
        sys.exit(1 if self.failed else 0)
