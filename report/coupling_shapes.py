"""coupling_shapes.py - sections of the report on what a sampling costs: the affine property, and hydrostatic force on known shapes over density, kernel and measure."""

import sys

import numpy as np

import draw
from draw import style
from flow import flow, tank, with_probes
from program import BUILD, ROOT, WORK, Failure, attempt, execute, options, say, small, table
from run import Series
from sections import claim

sys.path.append(str(ROOT / "tests"))
from shapes import box, icosphere, volume, write_off  # noqa: E402: surfaces made in place

KERNELS, MEASURES = ("half_space", "ellipsoid", "sphere"), ("uniform", "gaussian", "principal")
SHAPES = {"plane": "plane", "ball": "ball, R 2.5", "cylinder": "cylinder, R 2.5, length 8", "box": "box, 6 x 4 x 5", "ellipsoid": "ellipsoid, half axes 6, 4, 2.5", "slim": "ellipsoid, half axes 8, 4, 2",
          "waves": "waves, height +-0.5, length 6"}

AFFINE = """A square on a plane, and the same stretched by 1/kappa-bar in the plane and sampled at kappa-bar; 500 particles above it, stretched alike. Largest difference of density and
normal force from those of kappa-bar = 1 over the largest value; the tangential force, which the stretch makes kappa-bar times as large, after division by that. The whole way is
measured: sampling, thinning, areas, volumes, contacts. The usual spheres of radius h do not stretch: beside them stands what sparse sampling costs them."""

SHAPES_TEXT = """**Proxies alone.** Water fills the space around a body as a low-discrepancy set of points; with hydrostatic pressure p its force on the body is the integral of p grad phi over the points within
h, phi the part of a particle's kernel that lies in the body. That part is known for these shapes (integrals along rays), so that the same points give the exact force (phi is exact to 3e-4 in the mean of squares), and the difference is the
proxies' alone: no particle noise, no packing. Lengths in h = 2 dx, bodies tilted against gravity, surfaces meshed at h/4 in the body's volume and thinned to the wanted density.
Cells: proxies, error of the force over the exact one, and *load*: the integral of p |error of grad phi| over that of p |grad phi|, what a soft body sees of it; both in percent. `uniform`: one kappa-bar
everywhere, spacing h/(2 kappa-bar); `gaussian` and `principal`: kappa-bar from eta_min where the surface is flat to 1 where it is curved. Half-space proxies without calibrated inset and factor, which the exact
part does not have; ellipsoids and spheres as they are calibrated, their force scaled to that of the exact one at kappa-bar = 1, so that the force tells what sparse
sampling changes; their load tells also what the profile is worth. Last columns: fewest proxies for 2 % of force by each measure (a denser sampling of its series is within 2 % too)."""

PHI = """
Error of phi itself for the default, half-space with the Gaussian measure from 0.4 (the plane: uniform, 0.4); 1e-3 of phi is about 1e-3 of h in the place of the wetted surface:

"""

SETTLED_TEXT = """**Settled water.** What a user gets: bodies held in still water, 1 s from a packed lattice, means over the second half; calibrated inset and factor, all else at its default. Lift over
rho g V of the mesh less 1; force sideways over it; swing: rms of the lift about its mean, over it; `pressure` of the surface's fields at the nodes: rms distance of its mean from
rho g (H - z), over that at the body's middle; water in the body: most particles inside at an output. A mean over half a second is good to about 0.01."""

DX, WIDE, DEEP, G = 0.02, 0.34, 0.36, 9.81
SAMPLINGS = (("half_space", {"kappa": 1}), ("half_space", {}), ("half_space", {"measure": "principal"}), ("half_space", {"kappa": 0.4}), ("ellipsoid", {"kappa": 1}), ("ellipsoid", {}),
             ("sphere", {"kappa": 1}), ("sphere", {}))


def bench(name, *arguments):
    """rows (lists of cells) that bench.proxy prints behind `name: `"""
    path = WORK / (name + ".txt")
    if not (options["keep"] and path.exists()):
        execute(["cmake", "--build", BUILD, "--target", "bench.proxy"])
        done = attempt([BUILD / "bench.proxy", *arguments])
        if done.returncode != 0:
            raise Failure(f"bench.proxy: status {done.returncode}\n{done.stderr[-1500:]}")
        path.write_text(done.stdout, encoding="utf-8")
        say(f"bench.proxy {' '.join(arguments)}")
    lines = path.read_text(encoding="utf-8").splitlines()
    return [[cell.strip() for cell in line[len(name) + 2:].split("|")] for line in lines if line.startswith(name + ": ")]


def affine():
    rows = bench("affine", "-affine")
    worst = max(max(float(c) for c in row[3:]) for row in rows if row[0] != "sphere")
    claim("affine property, half-space and ellipsoid, kappa-bar 0.8 to 0.2", small(worst), "", "1e-13", worst <= 1e-13)
    return AFFINE + "\n\n" + table(["kernel", "kappa-bar", "proxies", "density", "normal force", "tangential"], rows)


class Row:
    """One sampling of one shape."""

    def __init__(self, cells):
        self.shape, self.kernel, self.measure = cells[:3]
        self.eta, self.n = float(cells[3]), int(cells[4])
        self.force, self.moment, self.load, self.mean, self.rms, self.largest, self.seconds = map(float, cells[5:])


def series(rows, shape, kernel, measure):
    """samplings of a shape from dense to sparse; those of a measure begin with the uniform one of kappa-bar 1"""
    found = [r for r in rows if (r.shape, r.kernel) == (shape, kernel) and (r.measure == measure or (r.measure, r.eta) == ("uniform", 1))]
    return sorted(found, key=lambda r: -r.n) if any(r.measure == measure for r in found) else []


def fewest(found, bar, quantity="force"):
    """proxies of the sparsest sampling that is within the bar with all denser ones; None: not even the densest"""
    count = None
    for row in found:
        if getattr(row, quantity) > bar:
            break
        count = row.n
    return count


def cell(rows, shape, kernel, measure, eta):
    row = next((r for r in rows if (r.shape, r.kernel, r.measure, r.eta) == (shape, kernel, measure, eta)), None)
    return "" if row is None else f"{row.n}: {100 * row.force:.2g}, *{100 * row.load:.2g}*"


def panel(axes, rows, shape):
    styles = {"half_space": "-", "ellipsoid": "--", "sphere": ":"}
    for kernel in KERNELS:
        for k, measure in enumerate(MEASURES):
            found = series(rows, shape, kernel, measure)
            if found and (kernel == "half_space" or measure != "principal"):
                axes.loglog([r.n for r in found], [max(100 * r.force, 2e-3) for r in found], linestyle=styles[kernel], color=style.COLOURS[k], marker="os^"[k], markersize=3.5,
                            linewidth=1.7 if kernel == "half_space" else 1.1, label=f"{kernel}, {measure}")
    axes.axhline(2, color=style.MUTED, linewidth=0.8)
    axes.set_title(SHAPES[shape].split(",")[0] if shape != "slim" else "slim ellipsoid")
    axes.set_ylim(1e-3, 400)


def picture(rows):
    drawn, axes = draw.figure(4, 2, width=13, height=6.6)
    axes = axes.ravel()
    for k, shape in enumerate(SHAPES):
        panel(axes[k], rows, shape)
        axes[k].set_xlabel("proxies" if k > 2 else "")
        axes[k].set_ylabel("error of the force [%]" if k % 4 == 0 else "")
    handles, labels = axes[1].get_legend_handles_labels()
    axes[-1].axis("off")
    axes[-1].legend(handles, labels, loc="center", fontsize=9, title="kernel, measure (line: 2 %)")
    return draw.save(drawn, "shapes", "error of the hydrostatic force over the number of proxies, seven shapes")


def alone():
    """part (a)"""
    rows = [Row(cells) for cells in bench("shape", "-shapes", "-points", "4000")]
    lines = []
    for shape, title in SHAPES.items():
        for kernel in KERNELS:
            least = [fewest(series(rows, shape, kernel, m), 0.02) if series(rows, shape, kernel, m) else "" for m in MEASURES]
            lines.append([title if kernel == KERNELS[0] else "", kernel, cell(rows, shape, kernel, "uniform", 1), *(cell(rows, shape, kernel, m, 0.4) for m in MEASURES), *("-" if n is None else n for n in least)])
    usual = [next(r for r in rows if (r.shape, r.kernel, r.measure, r.eta) == (shape, "half_space", "gaussian" if shape != "plane" else "uniform", 0.4)) for shape in SHAPES if shape != "slim"]
    worst = max(usual, key=lambda r: r.force)
    claim("force on plane, ball, cylinder, box, ellipsoid, waves with default proxies, the largest error", f"{100 * worst.force:.2f} % ({worst.shape})", "", "2 %", worst.force < 0.02)
    parts = [[SHAPES[r.shape], r.n, f"{r.mean:+.1e}", small(r.rms), small(r.largest)] for r in (next(r for r in rows if (r.shape, r.kernel, r.measure, r.eta) == (shape, "half_space", "gaussian" if shape != "plane" else "uniform", 0.4)) for shape in SHAPES)]
    head = ["shape", "kernel", "uniform, 1", "uniform, 0.4", "gaussian, 0.4", "principal, 0.4", "2 %: uniform", "gaussian", "principal"]
    return SHAPES_TEXT + "\n\n" + table(head, lines) + picture(rows) + PHI + table(["shape", "proxies", "mean", "rms", "largest"], parts)


def turned(x):
    """turned about an axis that is none of the lattice's, into the middle of the water"""
    axis, angle = np.array([1, 2, 0.5]) / np.linalg.norm([1, 2, 0.5]), 0.6
    cross = np.cross(np.eye(3), axis)
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return x @ turn.T + [WIDE / 2, WIDE / 2, 0.5 * DEEP]


def surface(name):
    """nodes and triangles of a held body"""
    if name == "box":
        x, triangles = box((-5 * DX, -4 * DX, -4 * DX), (5 * DX, 4 * DX, 4 * DX), 8)
    else:
        x, triangles = icosphere(1.0, levels=3)
        x = x * DX * np.array([5, 5, 5] if name == "ball" else [7, 5, 4])
    return turned(x), triangles


def hold(name, kernel, keys):
    """one run: a body held in still water; a row of the table, and its lift's error"""
    x, triangles = surface(name)
    path = WORK / "meshes" / (name + ".off")
    path.parent.mkdir(parents=True, exist_ok=True)
    write_off(path, x, triangles)
    water = tank((0, 0, 0), (WIDE, WIDE, 1.3 * DEEP), walls=("zmin",), periodic=("x", "y"), fills={"pool": {"min": [0, 0, 0], "max": [WIDE, WIDE, DEEP]}}, spacing=DX)
    water.update(obstacles=["body"], body={"surface": str(path), "proxy": {"kernel": kernel, **keys}})
    label = "_".join([name, kernel, *(f"{k}_{v}" for k, v in keys.items())])
    result = flow("shapes_" + label, with_probes(water, lift={"body": "body", "quantity": "force"}), end=1.0, output_every=0.02, fields_every=0.1)
    late = result.probes["time"] > 0.5
    weight = 1000 * G * volume(x, triangles)
    lift, side = result.probes["lift_z"][late], np.hypot(result.probes["lift_x"][late].mean(), result.probes["lift_y"][late].mean())
    nodes = Series(str(result.directory / "body.vtkhdf"))
    steps = [k for k in range(nodes.n_steps) if nodes.times[k] > 0.5]
    pressure, at = np.mean([nodes.field("pressure", k) for k in steps], axis=0), nodes.points(0)
    nodes.close()
    level = (result.n * DX**3 + volume(x, triangles)) / WIDE**2
    wrong = np.sqrt(np.mean((pressure - 1000 * G * (level - at[:, 2])) ** 2)) / (1000 * G * (level - 0.5 * DEEP))
    error = lift.mean() / weight - 1
    sampling = f"uniform, {keys['kappa']}" if "kappa" in keys else f"{keys.get('measure', 'gaussian')}, 0.4"
    return error, [name, kernel, sampling, f"{result.ledger['proxies'][-1]:.0f}", f"{error:+.3f}", f"{side / weight:.3f}", f"{lift.std() / lift.mean():.3f}", f"{wrong:.3f}",
                   int(max(result.ledger["penetrations"])), f"{result.cpu:.0f}"]


def fields(name):
    """height [m], `pressure` and `water_pressure` [Pa] at the nodes of a run of the default, means over its second half, and the water's level"""
    x, triangles = surface(name)
    directory = WORK / f"shapes_{name}_half_space"
    nodes = Series(str(directory / "body.vtkhdf"))
    steps = [k for k in range(nodes.n_steps) if nodes.times[k] > 0.5]
    found = [np.mean([nodes.field(f, k) for k in steps], axis=0) for f in ("pressure", "water_pressure")]
    z = nodes.points(0)[:, 2]
    nodes.close()
    fluid = Series(str(directory / "fluid.vtkhdf"))
    level = (fluid.n_points[0] * DX**3 + volume(x, triangles)) / WIDE**2
    fluid.close()
    return z, *found, level


def surface_picture(names):
    """what the fields of a surface tell, against the hydrostatic pressure"""
    drawn, axes = draw.figure(len(names), width=11, height=3.8, sharey=True)
    ratios = []
    for k, name in enumerate(names):
        z, pressure, mean, level = fields(name)
        exact = 1000 * G * (level - z)
        ratios.append(np.mean(mean / exact))
        axes[k].plot(mean / 1000, z, ".", markersize=3, color=style.COLOURS[1], label="water_pressure (Shepard mean)")
        axes[k].plot(pressure / 1000, z, ".", markersize=3, color=style.COLOURS[0], label="pressure (force over area)")
        heights = np.array([z.min(), z.max()])
        axes[k].plot(G * (level - heights), heights, color=style.TEXT, linewidth=1.2, label="rho g (H - z)")
        axes[k].set_title(name)
        axes[k].set_xlabel("[kPa]")
    axes[0].set_ylabel("height of the node [m]")
    axes[0].legend(fontsize=8)
    text = draw.save(drawn, "surface", "fields at the nodes of held bodies over height, default proxies")
    return text + f"\nThe Shepard mean of the particles' own pressures is {min(ratios):.2f} to {max(ratios):.2f} times the hydrostatic one, the same everywhere on a body; `pressure` is what loads it.\n"


def settled():
    """part (b)"""
    rows, worst = [], 0.0
    for name in ("ball", "ellipsoid", "box"):
        for kernel, keys in SAMPLINGS:
            error, row = hold(name, kernel, keys)
            rows.append(row)
            worst = max(worst, abs(error)) if (kernel, keys) == ("half_space", {}) else worst
    claim("lift of held ball, ellipsoid, box of 8 to 14 dx with default proxies, the largest error", f"{100 * worst:.1f} %", "", "2 %", worst < 0.02)
    return "\n" + SETTLED_TEXT + "\n\n" + table(["body", "kernel", "density", "proxies", "lift", "sideways", "swing", "pressure", "water in it", "cpu, s"], rows) + surface_picture(("ball", "ellipsoid", "box"))


def shapes():
    return alone() + settled()
