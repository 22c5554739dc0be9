"""coupling_validation.py - sections of the report on coupled flows that others have measured or computed: a plate under a column of water, dam breaks through
an elastic gate and on an elastic obstacle."""

import csv

import numpy as np

import draw
from flow import DATA, flow, percent, rms, tank, with_probes
from program import ROOT, WORK, mesh, table, verify
from run import Series
from sections import claim

HELD = {"kind": "fixed", "components": ["y"]}  # the sides of a slab stay in their planes: plane strain


def curves(name):
    """the curves of report/data/NAME.csv, whose columns are curve, time, value: label -> array [n x 2]"""
    found = {}
    with open(DATA / (name + ".csv"), newline="", encoding="utf-8") as file:
        for label, time, value in list(csv.reader(line for line in file if not line.startswith("#")))[1:]:
            found.setdefault(label, []).append((float(time), float(value)))
    return {label: np.array(points) for label, points in found.items()}


def at(curve, times):
    return np.interp(times, curve[:, 0], curve[:, 1])


def sides(directory, body, moment):
    """nodes of a body at the output nearest to a time, and the triangles of its surface in the lowest plane across y"""
    series = Series(str(directory / (body + ".vtkhdf")))
    x, triangles = series.points(series.step_at(moment)), series.triangles()
    series.close()
    lowest = np.abs(x[:, 1] - x[:, 1].min()) < 1e-3 * np.ptp(x[:, 2])
    return x, triangles[np.all(lowest[triangles], axis=1)]


def moments(axes, result, body, times, spacing, box, limits):
    """the water of a slab, coloured by its speed, and the side of a body, at some times"""
    slab = (box[0][1], box[1][1])
    for k, (ax, moment) in enumerate(zip(np.ravel(axes), times)):
        state = result.state_at(moment)
        draw.particles(ax, state.x, np.linalg.norm(state.v, axis=1), spacing, label="speed [m/s]" if k == len(times) - 1 else "", limits=limits, box=box, slab=slab)
        x, triangles = sides(result.directory, body, moment)
        ax.tripcolor(x[:, 0], x[:, 2], triangles, facecolors=np.zeros(len(triangles)), cmap="gray", edgecolors="none", zorder=3)
        ax.set_title(f"{moment:g} s", fontsize=10)
        ax.set_xlabel("x [m]")
    np.ravel(axes)[0].set_ylabel("z [m]")


# the gate

GATE = """Water 100 x 140 mm behind a rubber gate, 5 mm thick and 79 mm high, held at its upper end; its lower end is free and opens (Antoci et al. 2007). E = 12 MPa, Poisson's ratio 0.4, density
1100 kg/m^3, neo-Hookean; a row with 7.8 MPa and 0.47, which others take. Slabs 10 mm deep between slipping walls, the gate filling them; its sides held in their planes (plane strain) or free
(plane stress), and once half of a gate as wide as the tank, 100 mm, with free edges. The rigid wall above is part of the mesh, 192 of its quadratic tetrahedra are the gate. Displacement of the
middle of the free end. dx of 5 to 2.5 mm is one to two particles a thickness of the gate. The experiment has one gate and its water also leaves beside it; the simulations are plane:
Yang 2012, Khayyer 2018, Ng 2020, peaks {low:.1f} to {high:.1f} mm. Differences: rms over the nine times of the experiment, to the experiment and to the mean of the three simulations."""

GATE_TIMES = (0.04, 0.08, 0.12, 0.16, 0.28, 0.4)
SIMULATIONS = ("yang_2012", "khayyer_2018", "ng_2020")


def gate_scene(spacing, depth, path, young=12e6, poisson=0.4, constraint=None):
    base = tank((0, 0, 0), (0.8, depth, 0.2), fills={"column": {"min": [0, 0, 0], "max": [0.1, depth, 0.14]}}, spacing=spacing, density=1000)
    body = {"mesh": str(path), "density": 1100, "young": young, "poisson": poisson, "fixed": ["wall"], "wetted": ["skin"]}
    if constraint:
        body = dict(body, constraints=["plane"], plane=constraint)
    tip = {"body": "gate", "at": [0.1025, 0 if depth > 0.02 else 0.5 * depth, 0], "quantity": "displacement"}
    return with_probes(dict(base, bodies=["gate"], gate=body), tip=tip, level={"at": [0.05, 0.5 * depth, 0], "quantity": "height"})


def gate_runs():
    slab, held = ROOT / "meshes" / "gate.msh", dict(HELD, groups=["near", "far"])
    cases = [(f"plane strain, dx {1000 * dx:.1f} mm", f"gate_{k}", dx, gate_scene(dx, 0.01, slab, constraint=held)) for k, dx in enumerate((0.005, 0.01 / 3, 0.0025))]
    cases.append(("plane stress, dx 2.5 mm", "gate_free", 0.0025, gate_scene(0.0025, 0.01, slab)))
    cases.append(("100 mm wide, dx 5.0 mm", "gate_wide", 0.005, gate_scene(0.005, 0.05, mesh("gate_wide", 2), constraint={"kind": "symmetry", "groups": ["near"]})))
    cases.append(("plane strain, 7.8 MPa and 0.47, dx 3.3 mm", "gate_soft", 0.01 / 3, gate_scene(0.01 / 3, 0.01, slab, 7.8e6, 0.47, held)))
    return [{"label": label, "dx": dx, "result": flow(name, scene, end=0.4, output_every=0.002, fields_every=0.02)} for label, name, dx, scene in cases]


def gate_differences(run, known):
    """of one run: displacements over time, their peaks, and the differences to experiment and simulations [m]"""
    probes, times = run["result"].probes, known["experiment_x"][:, 0]
    for axis in "xz":
        ours = np.stack([probes["time"], probes["tip_" + axis]], axis=1)
        others = np.mean([at(known[f"{name}_{axis}"], times) for name in SIMULATIONS], axis=0)
        run[axis], run["peak_" + axis] = ours, ours[np.argmax(ours[:, 1])]
        run["experiment_" + axis] = rms(at(ours, times) - at(known["experiment_" + axis], times))
        run["simulations_" + axis] = rms(at(ours, times) - others)
    return run


def gate_pictures(runs, known):
    drawn, axes = draw.figure(2, 1, width=12, height=4.4)
    for ax, axis, word in zip(axes, "xz", ("horizontal", "vertical")):
        lines = [(r["label"], r[axis][:, 0], 1000 * r[axis][:, 1]) for r in runs]
        draw.curves(ax, lines[:2] + lines[3:] + lines[2:3], xlabel="time [s]", ylabel="displacement [mm]", title=f"free end, {word}", legend=False)
        for k, name in enumerate(SIMULATIONS):
            curve = known[f"{name}_{axis}"]
            ax.plot(curve[:, 0], 1000 * curve[:, 1], color=draw.style.TEXT, linewidth=1, linestyle=("-", "--", ":")[k], label=name.replace("_", " "))
        draw.curves(ax, [], [("experiment", known["experiment_" + axis][:, 0], 1000 * known["experiment_" + axis][:, 1])], xlabel="time [s]", ylabel="displacement [mm]", title=f"free end, {word}", legend=False)
        ax.set_xlim(0, 0.4)
    axes[0].legend(fontsize=7.5, ncol=2, loc="lower right")
    text = draw.save(drawn, "gate", "displacement of the gate's free end against experiment and simulations")
    fine = runs[2]
    drawn, axes = draw.figure(3, 2, width=11, height=6)
    moments(axes, fine["result"], "gate", GATE_TIMES, fine["dx"], ((0, 0, 0), (0.25, 0.01, 0.15)), (0, 1.6))
    return text + draw.save(drawn, "gate_moments", "the gate opens: plane strain, dx 2.5 mm")


def gate():
    known, runs = curves("elastic_gate"), gate_runs()
    runs = [gate_differences(run, known) for run in runs]
    peaks = [1000 * known[name + "_x"][:, 1].max() for name in SIMULATIONS]
    wanted = np.mean(peaks)
    rows = [(r["label"], f"{r['result'].n:,}", f"{1000 * r['peak_x'][1]:.1f} at {r['peak_x'][0]:.3f}", f"{1000 * r['peak_z'][1]:.1f}", f"{1000 * r['simulations_x']:.1f} / {1000 * r['simulations_z']:.1f}",
             f"{1000 * r['experiment_x']:.1f} / {1000 * r['experiment_z']:.1f}", int(np.max(r["result"].ledger["penetrations"])), f"{r['result'].cpu:.0f}") for r in runs]
    rows += [(name.replace("_", " "), "", f"{1000 * known[name + '_x'][:, 1].max():.1f} at {known[name + '_x'][np.argmax(known[name + '_x'][:, 1]), 0]:.3f}", f"{1000 * known[name + '_z'][:, 1].max():.1f}", "", "", "", "")
             for name in (*SIMULATIONS, "experiment")]
    for r, word in ((runs[2], "plane strain"), (runs[3], "plane stress")):
        error = 1000 * r["peak_x"][1] / wanted - 1
        claim(f"elastic gate, {word}: peak of the free end against the simulations' mean, {wanted:.1f} mm", percent(error, 1), "", "their spread, 10 %", abs(error) <= 0.1)
    claim("elastic gate, plane strain: rms difference to the experiment, mm of 46.4, across and up", f"{1000 * runs[2]['experiment_x']:.1f}, {1000 * runs[2]['experiment_z']:.1f}")
    heads = ["case", "particles", "peak, mm at s", "highest, mm", "to the simulations, mm, x / z", "to the experiment, mm, x / z", "particles in the gate", "cpu, s"]
    return GATE.format(low=min(peaks), high=max(peaks)) + "\n\n" + table(heads, rows) + gate_pictures(runs, known)


# the obstacle

OBSTACLE = """Water 146 x 292 mm falls in a tank of 584 mm on an elastic obstacle, 12 x 80 mm, 292 mm from the wall behind the water (Walhorn et al. 2005, Idelsohn et al. 2008). E = 1 MPa, Poisson's ratio 0,
density 2500 kg/m^3, neo-Hookean, 60 quadratic tetrahedra; a slab 14.6 mm deep between slipping walls, 1 s. Displacement of the middle of the tip. Later than the first peak the
authors differ by more than half; difference: rms over the first 0.4 s to the mean of the six."""

OBSTACLE_TIMES = (0.14, 0.18, 0.22, 0.26, 0.34, 0.5)
DEPTH = 0.0146


def obstacle_scene(spacing):
    base = tank((0, 0, 0), (0.584, DEPTH, 0.7), fills={"column": {"min": [0, 0, 0], "max": [0.146, DEPTH, 0.292]}}, spacing=spacing, density=1000)
    plate = {"mesh": str(mesh("obstacle", 2)), "density": 2500, "young": 1e6, "poisson": 0, "fixed": ["root"], "wetted": ["skin"], "constraints": ["plane"], "plane": dict(HELD, groups=["sides"])}
    return with_probes(dict(base, bodies=["plate"], plate=plate), tip={"body": "plate", "at": [0.298, 0.5 * DEPTH, 0.08], "quantity": "displacement"}, load={"body": "plate", "quantity": "force", "mean": True})


def first_peak(curve):
    """time and height of the first peak, before 0.35 s"""
    early = curve[curve[:, 0] < 0.35]
    return early[np.argmax(early[:, 1])]


def obstacle():
    known = curves("elastic_obstacle")
    grid = np.linspace(0, 0.4, 81)
    others = np.mean([at(curve, grid) for curve in known.values()], axis=0)
    runs = []
    for layers in (2, 3, 4):
        dx = DEPTH / layers
        result = flow(f"obstacle_{layers}", obstacle_scene(dx), end=1.0, output_every=0.002, fields_every=0.02)
        ours = np.stack([result.probes["time"], result.probes["tip_x"]], axis=1)
        runs.append({"dx": dx, "result": result, "curve": ours, "peak": first_peak(ours), "difference": rms(at(ours, grid) - others)})
    peaks = {name: first_peak(curve) for name, curve in known.items()}
    low, high = min(p[1] for p in peaks.values()), max(p[1] for p in peaks.values())
    rows = [(f"dx {1000 * r['dx']:.2f} mm", f"{r['result'].n:,}", f"{1000 * r['peak'][1]:.1f}", f"{r['peak'][0]:.3f}", f"{1000 * r['difference']:.1f}", int(np.max(r["result"].ledger["penetrations"])), f"{r['result'].cpu:.0f}") for r in runs]
    rows += [(name.replace("_", " "), "", f"{1000 * p[1]:.1f}", f"{p[0]:.3f}", f"{1000 * rms(at(known[name], grid) - others):.1f}", "", "") for name, p in peaks.items()]
    fine = runs[-1]
    claim(f"elastic obstacle: first peak of the tip, six authors {1000 * low:.1f} to {1000 * high:.1f} mm", f"{1000 * fine['peak'][1]:.1f} mm at {fine['peak'][0]:.3f} s", "", "within theirs", bool(low <= fine["peak"][1] <= high))
    drawn, axes = draw.figure(width=9, height=4.4)
    for k, (name, curve) in enumerate(known.items()):
        axes.plot(curve[:, 0], 1000 * curve[:, 1], color=draw.style.TEXT, alpha=0.7, linewidth=0.9, linestyle=("-", "--", ":", "-.", (0, (6, 2)), (0, (1, 3)))[k], label=name.replace("_", " "))
    draw.curves(axes, [(f"dx {1000 * r['dx']:.2f} mm", r["curve"][:, 0], 1000 * r["curve"][:, 1]) for r in runs], xlabel="time [s]", ylabel="displacement [mm]", title="tip of the obstacle, horizontal")
    axes.set_xlim(0, 1)
    text = draw.save(drawn, "obstacle", "displacement of the obstacle's tip against six authors")
    drawn, axes = draw.figure(3, 2, width=11, height=6.4)
    moments(axes, fine["result"], "plate", OBSTACLE_TIMES, fine["dx"], ((0, 0, 0), (0.584, DEPTH, 0.4)), (0, 3))
    text += draw.save(drawn, "obstacle_moments", "the dam breaks on the obstacle, dx 3.65 mm")
    return OBSTACLE + "\n\n" + table(["case", "particles", "first peak, mm", "at s", "rms difference, mm", "particles in the obstacle", "cpu, s"], rows) + text


# the plate under a column

PLATE = """A column of water 1 m wide and 2 m high at rest on a plate 1 x 0.05 m, clamped at both ends (Fourey et al. 2017): E = 67.5 GPa, Poisson's ratio 0.34, density 2700 kg/m^3, plane strain; with its own weight
the thin plate's middle goes down by q L^4/(384 D) = 6.85e-5 m (water alone: 6.43e-5). The moved water is 15 times the plate's mass. Slab 0.2 m deep, the sides of the plate held in their planes, 240 quadratic tetrahedra;
0.5 s from `sph.settle` with mass damping 1e4 /s, which the answer at rest does not depend on. Means over t > 0.1 s of the middle of the plate. The thin plate knows no shear; it adds {shear:.1f} % (Timoshenko), of
which the mesh shows part: under the exact pressure `byssus verify` finds {own:.3e} m on it, {fine:.3e} m with elements half as large. So the comparison that is the coupling's own is the one with the same mesh."""

PLATE_END, THIN = 0.5, -6.85e-5


def plate_body(**keys):
    return dict({"mesh": str(mesh("hydrostatic_plate", 2)), "density": 2700, "young": 67.5e9, "poisson": 0.34, "fixed": ["ends"], "constraints": ["plane"], "plane": dict(HELD, groups=["sides"])}, **keys)


def plate_alone(name, path):
    """middle of the plate under the exact pressure, implicitly [m]"""
    scene = {"domain": {"min": [0, 0, -0.2], "max": [1, 0.2, 2.4]}, "gravity": [0, 0, -9.81], "bodies": ["plate"], "probes": ["middle"], "run": {"end": 1, "directory": str(WORK / name)},
             "plate": plate_body(mesh=str(path), loads=["water"], water={"groups": ["top"], "pressure": 9810 * 2.0}), "middle": {"body": "plate", "at": [0.5, 0.1, -0.025], "quantity": "displacement"}}
    return verify(name, scene, kind="implicit")["static"]["probes"]["middle_z"]["implicit"]


def hydrostatic_plate():
    own, fine = plate_alone("plate_alone", mesh("hydrostatic_plate", 2)), plate_alone("plate_alone_fine", mesh("hydrostatic_plate_fine", 2))
    rows, lines, last = [], [], None
    for dx in (0.05, 1 / 30):
        scene = tank((0, 0, -0.2), (1, 0.2, 2.4), ("xmin", "xmax", "ymin", "ymax"), fills={"column": {"min": [0, 0, 0], "max": [1, 0.2, 2]}}, spacing=dx, density=1000, settle=True)
        scene = with_probes(dict(scene, bodies=["plate"], plate=plate_body(wetted=["top"], damping=1e4)), middle={"body": "plate", "at": [0.5, 0.1, -0.025], "quantity": "displacement", "mean": True},
                            load={"body": "plate", "quantity": "force", "mean": True})
        result = flow(f"plate_{1000 * dx:.0f}", scene, end=PLATE_END, output_every=0.01, fields_every=0.1)
        t = result.probes["time"]
        rest = t > 0.1
        middle, load = result.probes["middle_z"][rest], np.mean(result.probes["load_z"][rest])
        last = np.mean(middle)
        rows.append((f"{1000 * dx:.1f}", f"{result.n:,}", f"{last:.3e}", percent(np.std(middle) / abs(last), 1), percent(last / THIN - 1, 1), percent(last / own - 1, 1), percent(-load / (9810 * 2 * 0.2) - 1, 2),
                     f"{np.mean(result.ledger['substeps']):.0f}", f"{result.cpu:.0f}"))
        lines.append((f"dx {1000 * dx:.0f} mm", t, 1e5 * result.probes["middle_z"]))
    claim("column on a plate, middle, against the thin plate with its weight, -6.85e-5 m", percent(last / THIN - 1, 1), "", "3 %", abs(last / THIN - 1) <= 0.03)
    claim("column on a plate, middle, against the same mesh under the exact pressure", percent(last / own - 1, 1), "", "3 %", abs(last / own - 1) <= 0.03)
    drawn, axes = draw.figure(width=9, height=3.6)
    draw.curves(axes, lines, xlabel="time [s]", ylabel="middle of the plate [1e-5 m]", title="a column of 2 m on a plate")
    axes.axhline(1e5 * THIN, color=draw.style.TEXT, linewidth=1, label="thin plate")
    axes.axhline(1e5 * own, color=draw.style.TEXT, linewidth=1, linestyle="--", label="same mesh, exact pressure")
    axes.set_ylim(-8, 0)
    axes.legend(fontsize=9)
    stiffness = 67.5e9 * 0.05**3 / 12 / (1 - 0.34**2)
    shear = 100 * 48 * stiffness / (5 / 6 * 67.5e9 / (2 * 1.34) * 0.05)
    text = PLATE.format(shear=shear, own=own, fine=fine) + "\n\n"
    heads = ["dx, mm", "particles", "middle, m", "its rms change in time", "to -6.85e-5 m", "to the same mesh", "load over the water's weight, less 1", "substeps a step", "cpu, s"]
    return text + table(heads, rows) + draw.save(drawn, "plate", "middle of the plate over time")
