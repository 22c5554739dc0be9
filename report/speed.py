"""speed.py - sections of the report about speed: error against seconds, and the cost of an element and step."""

import csv
import math
import sys

import cases
import reference
from program import ROOT, WORK, execute, say, table, verify

sys.path.insert(0, str(ROOT / "src" / "plot"))

PICTURE = ROOT / "docs" / "pictures" / "solid_speed.png"
# element -> meshes: refined all over (h), and towards the clamp (hg)
POINTS = {"t4": ("h1", "h2", "h3", "hg"), "anp": ("h1", "h2", "h3", "hg"), "t10": ("h1", "h2", "hg")}

SPEED = """The cantilever under its weight, neo-Hookean: distance of the tip's centre from the best P2 value over its displacement, against seconds of the solve (without
reading the mesh), wall clock. Explicit: relaxation to 1e-5; implicit: Newton to 1e-6, direct solver. `best`: no other point of the same nu is both faster and
nearer. The dashed line is the error bar of the best value; errors below it say nothing."""


def measure():
    """points: dictionaries"""
    points = []
    for poisson in (0.3, 0.45):
        best, bar, _, _ = reference.BEAM_BEST["neo_hookean", poisson]
        length = math.hypot(best[0], best[2])
        for element, sizes in POINTS.items():
            for size in sizes:
                scene = cases.beam(size, element, "neo_hookean", poisson, implicit={"tolerance": 1e-6, "direct_below": 100000})
                found = verify(f"speed_{element}_{size}_{poisson}", scene, relax_tolerance=1e-5, tolerance=1e-2)
                for solver in ("explicit", "implicit"):
                    s = found["static"]
                    tip = [s["probes"]["tip_" + c][solver] for c in "xyz"]
                    points.append({"nu": poisson, "element": element, "mesh": size, "elements": found["elements"], "solver": solver, "seconds": s["seconds"][solver], "cpu": s["cpu_seconds"][solver],
                                   "error": math.dist(tip, best) / length, "bar": math.hypot(bar[0], bar[2]) / length})
    for p in points:  # the same error both ways differs in its last digits
        p["best"] = not any(q["nu"] == p["nu"] and q["seconds"] < p["seconds"] and q["error"] <= 1.001 * p["error"] for q in points)
    return points


def draw(points):
    import matplotlib.pyplot as plt
    import style

    figure, axes = plt.subplots(1, 2, figsize=(13, 5.4), dpi=110, sharey=True, layout="constrained")
    for ax, poisson in zip(axes, (0.3, 0.45)):
        for k, element in enumerate(POINTS):
            for solver, marker, line in (("explicit", "o", "-"), ("implicit", "s", "--")):
                these = sorted((p for p in points if (p["nu"], p["element"], p["solver"]) == (poisson, element, solver)), key=lambda p: p["elements"])
                even = [p for p in these if p["mesh"] != "hg"]
                ax.loglog([p["seconds"] for p in even], [p["error"] for p in even], linestyle=line, color=style.COLOURS[k])
                ax.loglog([p["seconds"] for p in these], [p["error"] for p in these], marker=marker, linestyle="none", color=style.COLOURS[k], label=f"{element}, {solver}")
                for p in these:
                    ax.annotate(p["mesh"], (p["seconds"], p["error"]), textcoords="offset points", xytext=(5, 5), fontsize=8, color=style.MUTED)
        front = sorted((p for p in points if p["nu"] == poisson and p["best"]), key=lambda p: p["seconds"])
        ax.plot([p["seconds"] for p in front], [p["error"] for p in front], color=style.TEXT, linewidth=6, alpha=0.12, zorder=0, label="none faster and nearer")
        ax.axhline(next(p["bar"] for p in points if p["nu"] == poisson), color=style.MUTED, linewidth=1, linestyle=(0, (4, 4)))
        ax.set_title(f"cantilever, neo-Hookean, nu {poisson}")
        ax.set_xlabel("seconds of the solve")
    axes[0].set_ylabel("error of the tip / its displacement")
    axes[1].legend(fontsize=9)
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    style.save(figure, str(PICTURE))
    say(str(PICTURE))


def speed():
    points = measure()
    draw(points)
    rows = [(p["nu"], p["element"], p["mesh"], f"{p['elements']:,}", p["solver"], f"{p['seconds']:.3f}", f"{p['cpu']:.3f}", f"{100 * p['error']:.3f} %", "best" if p["best"] else "")
            for p in sorted(points, key=lambda p: (p["nu"], p["seconds"]))]
    return SPEED + "\n\n![error of the tip against seconds](../pictures/solid_speed.png)\n\n" + table(["nu", "element", "mesh", "elements", "solver", "wall, s", "cpu, s", "error", ""], rows)


COST = """`./dev bench solid`: nanoseconds per element and whole time step, median of five; flops and bytes counted by hand from the formulas (`bench/bench_solid.c`),
shares of what two probes reach in the same run. Bytes are those that must move when nothing stays in a cache: 3,840 and 60,000 elements do stay there."""


def cost():
    path = WORK / "cost.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    text = execute([ROOT / "dev", "bench", "solid", "0.2", "-csv", path])
    probes = [line.split() for line in text.splitlines() if len(line.split()) == 3 and line.split()[0].isdigit()]
    with open(path, newline="", encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    rows = [(r["element"], r["law"], f"{int(r['elements']):,}", r["threads"], f"{float(r['ns']):.1f}", f"{float(r['cpu_ns']):.1f}", f"{float(r['flops']):.0f}", f"{float(r['bytes']):.0f}",
             f"{100 * float(r['peak_share']):.0f} %", f"{100 * float(r['triad_share']):.0f} %", f"{float(r['energy_error']):.0e}") for r in lines]
    return (COST + "\n\n" + table(["threads", "multiply-adds, Gflop/s", "triad, GB/s"], probes) + "\n"
            + table(["element", "law", "elements", "threads", "ns", "cpu ns", "flops", "bytes", "of the arithmetic peak", "of the bandwidth", "energy error"], rows))
