"""flow.py - fluid scenes for the report: run one, read what it left; error norms and observed orders; reference data.

    result = flow("still_16", scene, end=4, output_every=0.02)
    result.probes["floor_z"], result.ledger["compression_mean"], result.cpu, result.n, result.state(-1).x
"""

import csv
import json
import math
import os
import sys
import time

import numpy as np

from program import PROGRAM, ROOT, WORK, Failure, attempt, options, read_json, read_table, say, write_scene

sys.path.append(str(ROOT / "src" / "plot"))
from run import Series  # noqa: E402: a module of src/plot

DATA = ROOT / "report" / "data"


class State:
    """The particles at one output: x, v [n x 3], p, rho [n], time [s]."""

    def __init__(self, series, step):
        self.time = float(series.times[step])
        self.x, self.v = series.points(step), series.field("velocity", step)
        self.p, self.rho = series.field("pressure", step), series.field("density", step)


class Flow:
    """What a run left: tables `probes` and `ledger` (name -> array), `summary`, `status` (done, breakdown), particles at its outputs."""

    def __init__(self, name, directory):
        self.name, self.directory = name, directory
        self.summary = read_json(directory / "summary.json")
        self.status = self.summary["status"]
        self.ledger = as_arrays(directory / "ledger.csv")
        self.probes = as_arrays(directory / "probes.csv") if (directory / "probes.csv").exists() else {}
        self.n = int(self.summary["fluid"]["particles"])
        self.steps = int(self.summary["steps"])
        self.cpu = float(self.summary["cpu_seconds"])  # [s] of all threads
        self.iterations = float(self.summary["fluid"]["iterations_mean"])  # operator applications a step

    def times(self):
        series = Series(str(self.directory / "fluid.vtkhdf"))
        times = np.array(series.times)
        series.close()
        return times

    def state(self, step):
        """the particles at output number `step` (-1: the last)"""
        series = Series(str(self.directory / "fluid.vtkhdf"))
        state = State(series, step % series.n_steps)
        series.close()
        return state

    def state_at(self, moment):
        """the particles at the output nearest to a time"""
        return self.state(int(np.argmin(np.abs(self.times() - moment))))

    def states(self):
        """all outputs, one after another"""
        series = Series(str(self.directory / "fluid.vtkhdf"))
        for step in range(series.n_steps):
            yield State(series, step)
        series.close()


def as_arrays(path):
    return {name: np.array(column) for name, column in read_table(path).items()}


def flow(name, scene, end, output_every, timeout=3600, allowed=("done",), arguments=(), **run):
    """`byssus run` on a scene (a dictionary without the section run) into build/report/NAME/name. run: further keys of the section run;
    allowed: how it may end (done, breakdown); arguments: options of the command line that are not keys of the scene, -sph_ksp_type cg"""
    directory = WORK / name
    scene = dict(scene, run={"end": end, "output_every": output_every, "directory": str(directory), **run})
    text = "".join(f"{key}: {json.dumps(value)}\n" for key, value in scene.items()) + " ".join(str(a) for a in arguments)
    mark = directory / "scene.kept"
    if not (options["keep"] and mark.exists() and mark.read_text(encoding="utf-8") == text):
        start = time.time()
        if mark.exists():
            os.unlink(mark)
        done = attempt([PROGRAM, "run", write_scene(name, scene), *arguments], timeout)
        if done.returncode not in (0, 3):
            raise Failure(f"{name}: status {done.returncode}\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
        mark.write_text(text, encoding="utf-8")
        say(f"{name}: {time.time() - start:.1f} s")
    result = Flow(name, directory)
    if result.status not in allowed:
        raise Failure(f"{name}: {result.status} at {result.summary['time_end']:.4g} s")
    return result


def tank(low, high, walls=("xmin", "xmax", "ymin", "ymax", "zmin"), gravity=(0, 0, -9.81), periodic=(), fills=None, **sph):
    """a scene: box, gravity, fluid. fills: name -> section (min, max, velocity, ...); sph: keys of the section sph"""
    fluid = dict(sph, fill=list(fills or {}), **(fills or {}))
    domain = {"min": list(low), "max": list(high), "walls": list(walls)}
    if periodic:
        domain["periodic"] = list(periodic)
    return {"domain": domain, "gravity": list(gravity), "sph": fluid}


def with_probes(scene, **probes):
    """the scene with gauges: name -> section"""
    return dict(scene, probes=list(scene.get("probes", [])) + list(probes), **probes)


def data(name):
    """columns of report/data/NAME.csv; its first lines, behind #, say where they are from"""
    with open(DATA / (name + ".csv"), newline="", encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    rows = list(csv.reader(lines))
    return {header: np.array([float(row[k]) for row in rows[1:]]) for k, header in enumerate(rows[0])}


def source(name):
    """the first line of report/data/NAME.csv: where its numbers are from"""
    with open(DATA / (name + ".csv"), encoding="utf-8") as file:
        return file.readline().lstrip("# ").strip()


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def order(sizes, errors):
    """observed order: slope of the least-squares line of log error over log size; nan for fewer than two or an error of zero"""
    sizes, errors = np.log(np.asarray(sizes, float)), np.asarray(errors, float)
    if len(errors) < 2 or np.any(~np.isfinite(errors)) or np.any(errors <= 0):
        return math.nan
    return float(np.polyfit(sizes, np.log(errors), 1)[0])


def curve_error(time, value, known_time, known_value, scale=None):
    """rms difference of a curve at the times of the known points that it covers, over `scale` (none: rms of the known values)"""
    known_time, known_value = np.asarray(known_time), np.asarray(known_value)
    inside = (known_time >= time[0]) & (known_time <= time[-1])
    difference = np.interp(known_time[inside], time, value) - known_value[inside]
    return rms(difference) / (scale if scale else rms(known_value[inside]))


def percent(value, digits=2):
    return f"{100 * value:.{digits}f} %"


def shown(slope):
    """an observed order as text"""
    return "" if not math.isfinite(slope) else f"{slope:.1f}"
