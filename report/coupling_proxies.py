"""coupling_proxies.py - sections of the report on proxies: what sampling afresh costs and gains; bodies that lie on walls, on obstacles, beside each other."""

import sys

import numpy as np

import draw
from flow import flow, percent, rms, tank, with_probes
from program import BUILD, ROOT, WORK, Failure, attempt, say, small, table
from sections import claim

sys.path.append(str(ROOT / "tests"))
from shapes import box, icosphere, write_off  # noqa: E402: a module of tests

RHO, G = 1000.0, 9.81
DX = 0.02
TOLERANCES = (0, 0.02, 0.1, 0.3)

RESAMPLE = """Proxies move with their triangles; the surface is sampled afresh when an edge or an area has changed by more than `resample_tolerance` since the last sampling, 0 = every
step, as published. First without a fluid: a ball of radius 5 dx (mesh of h/5) becomes an ellipsoid of the same volume, 1.8 times as long, in 60 steps; errors of phi at 300 points within h
off the surface over all steps, against the kernel's part in the ellipsoid (`bench.contacts -stretch`); milliseconds of an update, samplings included, on one thread."""

FLAP = """Then `examples/flap` with a spacing of 20 mm and a flap four times as soft (0.5 MPa), 1 s: its tip against that of the run that samples every step, rms over the largest way, as far as its first peak (0.4 s) and in all; share of the
phase `proxies` (update and contacts) in the run's time. A splash is chaotic: the last row is the run that samples every step with water that starts at a micrometre a second."""

RESTING = """Still water (`sph.settle`), dx = 20 mm, mean of the last 0.5 s of 0.8. A cube of 5 dx, an obstacle, hangs over the floor. As long as the gap is narrower than particles, no water is
between: it carries the water above it. Proxies that look at a wall from less than 0.5 dx stop acting, smoothly, altogether from 0.15 dx on (`src/proxy/proxy_wall.c`). With faces that
went on acting, as they did before, the same cube carried -0.08 and -3.3 of that weight at gaps of 0.05 and 0.2 dx: the water at its foot lifted it."""

SINKING = """A soft block (5 x 5 x 4 dx, 0.2 MPa, density 1500, `contact`) starts a spacing above the floor, or above a plate that is an obstacle, drives the water from under it, and rests. Before, the
water at its foot held it 0.3 dx above the floor for good."""

BESIDE = """Two cubes (obstacles of 5 dx) stand on the floor beside each other with a slot between. Sideways force on each, towards the other, over that of the water on its outer face alone (1: the slot is
dry; 0: it is full), and force down over the weight of the water above. The union of both bodies, 1 - (1 - phi)(1 - phi'), is low by lambda^2/4 right at a joint, a dent of 0.06 dx
(`unit.proxy.pair` has it against the exact part). Faces of the slot keep acting on the water at its three open edges, which presses them apart as though it reached half a spacing into
a dry joint: a quarter of the force for cubes of 5 dx, in proportion to dx over their size. Hiding them as on a wall would make the water stand 0.3 dx off the joint."""


def mean_of(result, name, start):
    late = result.probes["time"] > start
    return float(np.mean(result.probes[name][late]))


def surface(name, points, triangles):
    path = WORK / "meshes" / (name + ".off")
    path.parent.mkdir(parents=True, exist_ok=True)
    write_off(path, points, triangles)
    return str(path)


def bench(arguments, mark):
    """rows of numbers that bench.contacts prints behind `mark`"""
    program = BUILD / "bench.contacts"
    if not program.exists():
        built = attempt(["cmake", "--build", BUILD, "--target", "bench.contacts"])
        if built.returncode:
            raise Failure(f"bench.contacts cannot be built\n{built.stdout[-1500:]}")
    done = attempt([program, *arguments])
    if done.returncode:
        raise Failure(f"bench.contacts: status {done.returncode}\n{done.stderr[-1500:]}")
    say(f"bench.contacts {' '.join(arguments)}")
    return [[cell.strip() for cell in line[len(mark):].split("|")] for line in done.stdout.splitlines() if line.startswith(mark)]


def flap(tolerance, velocity=0.0, name=""):
    scene = tank((0, 0, 0), (1.0, 0.24, 0.5), fills={"column": {"min": [0, 0, 0], "max": [0.3, 0.24, 0.35], "velocity": [velocity, 0, 0]}}, spacing=DX)
    scene["bodies"] = ["flap"]
    scene["flap"] = {"mesh": str(ROOT / "meshes" / "flap.msh"), "density": 1100, "young": 5e5, "poisson": 0.45, "fixed": ["root"], "wetted": ["skin"],
                     "proxy": {"resample_tolerance": tolerance}}
    scene = with_probes(scene, tip={"body": "flap", "at": [0.55, 0.12, 0.2], "quantity": "displacement"})
    return flow(f"resample_flap_{tolerance}{name}", scene, end=1.0, output_every=0.01, fields_every=0.5)


def resample():
    rows, worst = [], 0.0
    stretched = bench(["-stretch"], "stretch:")
    for row in stretched:
        tolerance = "every step" if row[0] == "0" else "never" if float(row[0]) >= 10 else row[0]
        rows.append([tolerance, *row[1:]])
    first = table(["tolerance", "kappa-bar", "samplings", "proxies", "update, ms", "mean error", "rms", "largest"], rows)
    runs = {tolerance: flap(tolerance) for tolerance in TOLERANCES}
    stirred = flap(0, 1e-6, "_stirred")
    way = {name: np.stack([r.probes[f"tip_{a}"] for a in "xyz"]) for name, r in (*runs.items(), ("stirred", stirred))}
    largest, early, rows = np.max(np.linalg.norm(way[0], axis=0)), runs[0].probes["time"] < 0.4, []
    for name, r in (*runs.items(), ("stirred", stirred)):
        apart = np.linalg.norm(way[name] - way[0], axis=0) / largest
        body, spent = r.summary["bodies"]["flap"], r.summary["phases"]["proxies"] / sum(r.summary["phases"].values())
        rows.append(["every step" if name == 0 else "every step, stirred" if name == "stirred" else name, body["samplings"], f"{body['proxies_mean']:.0f}", percent(spent, 1),
                     percent(rms(apart[early])), percent(rms(apart))])
        worst = max(worst, rms(apart[early]) if name in (0.02, 0.1) else 0.0)
    steps = runs[0].steps
    drawn, axes = draw.figure(1, width=6.5, height=3.6)
    draw.curves(axes, [("every step" if k == 0 else f"tolerance {k}", r.probes["time"], 1000 * r.probes["tip_x"]) for k, r in reversed(runs.items())], xlabel="time [s]", ylabel="tip, along the stream [mm]")
    by = {(row[0], row[1]): row for row in stretched}
    ratio = float(by["0", "1"][4]) / float(by["0.1", "1"][4])
    more = max(abs(float(by["0.1", eta][6]) / float(by["0", eta][6]) - 1) for eta in ("1", "0.4"))
    claim("sampling afresh at 0.1 against every step: error of phi, rms", f"{percent(more, 0)} apart, {ratio:.1f} times cheaper", "", "10 %", more < 0.1)
    claim("the same: tip of a flap as far as its peak", percent(worst), "", "2 %", worst < 0.02)
    return (RESAMPLE + "\n\n" + first + "\n" + FLAP + f" The run takes {steps} steps.\n\n"
            + table(["tolerance", "samplings", "proxies in use, mean", "phase proxies of the run", "tip, off by, to its peak", "in all"], rows) + draw.save(drawn, "resample", "tip of the flap over time by tolerance"))


def over_floor(name, points, triangles, low, size, depth=0.2):
    """force on an obstacle in still water: (up, sideways) [N], depth of the water [m], run"""
    still = tank((0, 0, 0), (size, size, depth + 0.15), fills={"water": {"min": [0, 0, 0], "max": [size, size, depth]}}, spacing=DX, settle=True)
    still["obstacles"] = ["thing"]
    still["thing"] = {"surface": surface(name, points, triangles)}
    r = flow(name, with_probes(still, load={"body": "thing", "quantity": "force"}), end=0.8, output_every=0.01, fields_every=0.8)
    volume = abs(float(np.einsum("ij,ij->i", points[triangles[:, 0]], np.cross(points[triangles[:, 1]], points[triangles[:, 2]])).sum() / 6))
    return mean_of(r, "load_z", 0.3), volume, (r.n * DX**3 + volume) / size**2, r


def hanging():
    rows, errors = [], []
    for gap in (0.0, 0.05, 0.15, 0.5, 1.5):
        points, triangles = box((0.1, 0.1, gap * DX), (0.2, 0.2, 0.1 + gap * DX), 4)
        up, volume, depth, _ = over_floor(f"resting_cube_{gap}", points, triangles, gap * DX, 0.3)
        above, buoyancy = RHO * G * 0.01 * (depth - 0.1 - gap * DX), RHO * G * volume
        rows.append([gap, f"{-up / above:.3f}", f"{up / buoyancy:.3f}"])
        if gap <= 0.15:
            errors.append(abs(-up / above - 1))
    points, triangles = icosphere(0.1, (0.17, 0.17, 0.1 + 0.02 * DX), 3)
    up, volume, _, _ = over_floor("resting_ball", points, triangles, 0.0, 0.34, 0.3)
    claim("cube on the floor or up to 0.15 dx above it: water that it carries", percent(max(errors)), "", "5 %", max(errors) < 0.05)
    return table(["gap, dx", "force down over the water above", "force up over Archimedes'"], rows) + f"\nA ball of radius 5 dx that touches the floor in a point is lifted by {up / (RHO * G * volume):.2f} of Archimedes' force: the wedge around its foot is narrower than particles.\n"


def sink(name, plate):
    """the block on the floor or on a plate; run, height of what it lies on [m], water above it [N]"""
    top = 0.04 if plate else 0.0
    scene = tank((0, 0, 0), (0.3, 0.3, 0.35), fills={"water": {"min": [0, 0, 0], "max": [0.3, 0.3, 0.22]}}, spacing=DX, settle=True)
    scene["bodies"] = ["block"]
    scene["block"] = {"mesh": str(ROOT / "meshes" / "block.msh"), "translate": [0.1, 0.1, top + DX], "density": 1500, "young": 2e5, "poisson": 0.3, "contact": ["plate" if plate else "zmin"]}
    if plate:
        scene["obstacles"] = ["plate"]
        scene["plate"] = {"surface": surface("resting_plate", *box((0.04, 0.04, 0), (0.26, 0.26, top), 8))}
    scene = with_probes(scene, load={"body": "block", "quantity": "force"}, way={"body": "block", "at": [0.15, 0.15, top + DX + 0.08], "quantity": "displacement"})
    r = flow(name, scene, end=1.4, output_every=0.02, fields_every=0.7)
    depth = (r.n * DX**3 + 0.1**2 * 0.08 + (0.22**2 * top if plate else 0.0)) / 0.3**2
    return r, top, RHO * G * 0.1**2 * (depth - 0.08 - top)


def sinking():
    rows, worst, runs = [], 0.0, []
    for label, plate in (("floor", False), ("plate", True)):
        r, top, above = sink(f"resting_block_{label}", plate)
        load, way = -mean_of(r, "load_z", 0.7) / above, -mean_of(r, "way_z", 0.7) / DX
        rows.append([label, f"{load:.3f}", f"{way:.3f}", int(max(r.ledger["penetrations"])), f"{r.cpu:.0f}"])
        worst = max(worst, abs(load - 1))
        runs.append((label, r, above))
    claim("soft block that sank onto the floor, and onto a plate: water that it carries", percent(worst), "", "5 %", worst < 0.05)
    drawn, axes = draw.figure(3, width=11, height=3.7)
    draw.curves(axes[0], [(f"on the {label}", r.probes["time"], -r.probes["load_z"] / above) for label, r, above in runs], xlabel="time [s]", ylabel="force down over the water above", title="load")
    draw.curves(axes[1], [(f"on the {label}", r.probes["time"], 1 + r.probes["way_z"] / DX) for label, r, above in runs], xlabel="time [s]", ylabel="gap beneath [dx]", title="way")
    state = runs[1][1].state(-1)
    draw.particles(axes[2], state.x, state.p / 1000, DX, label="pressure [kPa]", box=((0, 0, 0), (0.3, 0.3, 0.3)))
    for low, high, top in ((0.04, 0.26, (0, 0.04)), (0.1, 0.2, (0.04, 0.12))):
        axes[2].plot([low, high, high, low, low], [top[0], top[0], top[1], top[1], top[0]], color="black", linewidth=1)
    axes[2].set_title("on the plate, 1.4 s")
    return table(["lies on the", "force down over the water above", "way down, dx (gap of 1)", "particles inside", "cpu, s"], rows) + draw.save(drawn, "resting", "a soft block sinks: load, gap, particles")


def beside():
    rows = []
    for width in (0.0, 0.25, 0.5, 1.0, 2.0):
        half = 0.5 * width * DX
        still = tank((0, 0, 0), (0.4, 0.3, 0.35), fills={"water": {"min": [0, 0, 0], "max": [0.4, 0.3, 0.2]}}, spacing=DX, settle=True)
        still["obstacles"] = ["west", "east"]
        still["west"] = {"surface": surface(f"beside_left_{width}", *box((0.1 - half, 0.1, 0), (0.2 - half, 0.2, 0.1), 4))}
        still["east"] = {"surface": surface(f"beside_right_{width}", *box((0.2 + half, 0.1, 0), (0.3 + half, 0.2, 0.1), 4))}
        r = flow(f"resting_beside_{width}", with_probes(still, left={"body": "west", "quantity": "force"}, right={"body": "east", "quantity": "force"}), end=0.8, output_every=0.01, fields_every=0.8)
        depth = (r.n * DX**3 + 2e-3) / 0.12
        side, above = RHO * G * 0.01 * (depth - 0.05), RHO * G * 0.01 * (depth - 0.1)
        rows.append([width, f"{mean_of(r, 'left_x', 0.3) / side:.3f}", f"{-mean_of(r, 'right_x', 0.3) / side:.3f}", f"{-mean_of(r, 'left_z', 0.3) / above:.3f}", f"{-mean_of(r, 'right_z', 0.3) / above:.3f}"])
    off = float(rows[0][1]) - 1
    claim("cubes of 5 dx side by side: sideways force over that on one face, less 1", percent(off))
    return table(["slot, dx", "left: sideways", "right: sideways", "left: down", "right: down"], rows)


def resting():
    return RESTING + "\n\n" + hanging() + "\n" + SINKING + "\n\n" + sinking() + "\n" + BESIDE + "\n\n" + beside()
