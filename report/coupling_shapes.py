"""coupling_shapes.py - sections of the report on what a sampling costs: the affine property, and hydrostatic force on known shapes over density, kernel and measure."""

import numpy as np

import draw
from draw import style
from flow import flow, tank, with_probes
from program import BUILD, WORK, Failure, attempt, execute, options, say, small, table
from sections import claim

KERNELS, MEASURES = ("half_space", "ellipsoid", "sphere"), ("uniform", "gaussian", "principal")
SHAPES = {"plane": "plane", "ball": "ball, R 2.5", "cylinder": "cylinder, R 2.5, length 8", "box": "box, 6 x 4 x 5", "ellipsoid": "ellipsoid, half axes 6, 4, 2.5", "slim": "ellipsoid, half axes 8, 4, 2",
          "waves": "waves, height +-0.5, length 6"}

AFFINE = """A square on a plane, and the same stretched by 1/kappa-bar in the plane and sampled at kappa-bar; 500 particles above it, stretched alike. Largest difference of density and
normal force from those of kappa-bar = 1 over the largest value; the tangential force, which the stretch makes kappa-bar times as large, after division by that. The whole way is
measured: sampling, thinning, areas, volumes, contacts. The usual spheres of radius h do not stretch: beside them stands what sparse sampling costs them."""

SHAPES_TEXT = """**Proxies alone.** Water fills the space around a body as a low-discrepancy set of points; with hydrostatic pressure p its force on the body is the integral of p grad phi over the points within
h, phi the part of a particle's kernel that lies in the body. That part is known for these shapes (integrals along rays), so that the same points give the exact force, and the difference is the
proxies' alone: no particle noise, no packing. Lengths in h = 2 dx, bodies tilted against gravity, surfaces meshed at h/4 in the body's volume and thinned to the wanted density.
Cells: proxies, error of the force over the exact one, and *load*: the integral of p |error of grad phi| over that of p |grad phi|, what a soft body sees of it; both in percent. `uniform`: one kappa-bar
everywhere, spacing h/(2 kappa-bar); `gaussian` and `principal`: kappa-bar from eta_min where the surface is flat to 1 where it is curved. Half-space proxies without calibrated inset and factor, which the exact
part does not have; ellipsoids and spheres as they are calibrated, their force scaled to that of the exact one at kappa-bar = 1, so that the force tells what sparse
sampling changes; their load tells also what the profile is worth. Last columns: fewest proxies for 2 % of force by each measure (a denser sampling of its series is within 2 % too)."""

SETTLED_TEXT = """**Settled water.** What a user gets: bodies held in still water, 1 s from a packed lattice, means over the second half, defaults but for what the table names (calibrated inset and factor, all kernels). Lift over
rho g V of the mesh less 1; force sideways over the lift; swing: rms of the lift about its mean, over it; water in the body: particles. A mean over half a second is good to about 0.01."""


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
        self.force, self.moment, self.load, self.mean, self.rms, self.seconds = map(float, cells[5:])


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
    head = ["shape", "kernel", "uniform, 1", "uniform, 0.4", "gaussian, 0.4", "principal, 0.4", "2 %: uniform", "gaussian", "principal"]
    return SHAPES_TEXT + "\n\n" + table(head, lines) + picture(rows)


def shapes():
    return alone()
