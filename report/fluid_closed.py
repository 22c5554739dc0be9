"""fluid_closed.py - sections of the report on flows with pressure of either sign: decaying vortices, the lid-driven cavity, a rotating square."""

import math

import numpy as np

import draw
from flow import data, flow, order, percent, rms, shown, tank
from sections import claim
from program import table

LAYERS = 4  # spacings of a periodic slab's depth: two supports

VORTICES = """Taylor-Green vortices u = sin 2 pi x cos 2 pi y, v = -cos 2 pi x sin 2 pi y in a box periodic in all directions, side 1 m, four spacings deep,
`free_surface: false` and nothing else: the solver is `isph`. Exact: velocities fall as exp(-8 pi^2 t/Re). To 1 s, where they are 0.454 of the start at Re 100,
0.924 at Re 1000. Error: rms distance of the particles' velocities from the exact ones where they are, over the exact rms, at the end; energy: kinetic energy
over the exact one at the end. Even: rms of rho/rho0 - 1, what shifting leaves of the disorder."""

VORTEX_CELLS = (16, 32, 64)
VORTEX_END = 1.0


def vortices_at(x, reynolds, time):
    fall, k = np.exp(-8 * np.pi**2 * time / reynolds), 2 * np.pi
    return fall * np.stack([np.sin(k * x[:, 0]) * np.cos(k * x[:, 1]), -np.cos(k * x[:, 0]) * np.sin(k * x[:, 1]), 0 * x[:, 0]], axis=1)


def vortices_measure(cells, reynolds):
    dx = 1.0 / cells
    fill = {"min": [0, 0, 0], "max": [1, 1, LAYERS * dx], "field": "taylor_green", "amplitude": 1.0, "wavelength": 1.0}
    scene = tank((0, 0, 0), (1, 1, LAYERS * dx), walls=(), periodic=("x", "y", "z"), gravity=(0, 0, 0), fills={"vortices": fill}, spacing=dx, viscosity=1000.0 / reynolds,
                 free_surface=False)
    result = flow(f"vortices_{reynolds}_{cells}", scene, end=VORTEX_END, output_every=VORTEX_END / 20, fields_every=VORTEX_END)
    end = result.state(-1)
    exact = vortices_at(end.x, reynolds, end.time)
    energy = result.ledger["fluid_kinetic"]
    fall = np.exp(-16 * np.pi**2 * result.ledger["time"] / reynolds)
    return {"dx": dx, "n": result.n, "cpu": result.cpu, "steps": result.steps, "iterations": result.iterations, "reynolds": reynolds,
            "error": rms(end.v - exact) / rms(exact), "energy": energy[-1] / energy[0] / fall[-1], "t": result.ledger["time"], "kinetic": energy / energy[0],
            "even": rms(end.rho / 1000.0 - 1), "state": end}


def taylor_green():
    runs = {reynolds: [vortices_measure(cells, reynolds) for cells in VORTEX_CELLS] for reynolds in (100, 1000)}
    rows = []
    for reynolds, several in runs.items():
        for r in several:
            rows.append((reynolds, f"1/{round(1 / r['dx'])}", f"{r['n']:,}", percent(r["error"]), f"{r['energy']:.4f}", percent(r["even"]), r["steps"], f"{r['iterations']:.1f}", f"{r['cpu']:.0f}"))
        slope = order([r["dx"] for r in several], [r["error"] for r in several])
        rows.append((reynolds, "order", "", shown(slope), "", "", "", "", ""))
        claim(f"Taylor-Green vortices, Re {reynolds}, velocity", percent(several[-1]["error"]), shown(slope), "2 %", several[-1]["error"] < 0.02)
    drawn, axes = draw.figure(3, width=11.5, height=4.0)
    several = runs[100]
    t = np.linspace(0, VORTEX_END, 30)
    draw.curves(axes[0], [(f"dx 1/{round(1 / r['dx'])}", r["t"], r["kinetic"]) for r in several], known=[("exact", t[::2], np.exp(-16 * np.pi**2 * t[::2] / 100))], xlabel="time [s]",
                ylabel="kinetic energy / initial", title="decay, Re 100")
    axes[0].set_yscale("log")
    draw.convergence(axes[1], [r["dx"] for r in several], {f"Re {reynolds}": [r["error"] for r in s] for reynolds, s in runs.items()}, title="error of velocity")
    fine = runs[1000][-1]
    draw.particles(axes[2], fine["state"].x, np.linalg.norm(fine["state"].v, axis=1), fine["dx"], across=2, label="speed [m/s]", box=((0, 0, 0), (1, 1, 1)))
    axes[2].set_title("particles, Re 1000, 1 s")
    picture = draw.save(drawn, "taylor_green", "decay of the energy, error over spacing, particles at the end")
    return VORTICES + "\n\n" + table(["Re", "dx [m]", "particles", "error", "energy", "even", "steps", "applications", "CPU s"], rows) + picture


CAVITY = """A cavity 1 x 1 m, four spacings deep and periodic in depth, full of fluid; its lid moves at 1 m/s. Velocity on the lines through the middle against Ghia,
Ghia & Shin 1982 (`report/data/ghia1982_*.csv`): at their points a linear fit to the particles within 2 dx, mean over the last ten outputs. Error: rms over all
points inside, over the lid's velocity; u: of the horizontal velocity on the vertical line, v: of the other."""

CAVITY_RUNS = {100: ((20, 40), 12.0), 1000: ((32, 48), 40.0)}  # cells a side, time


def fit(state, points, component, dx):
    """velocity at points (x, y) by a weighted linear fit, the same in all of the depth"""
    values = []
    for point in points:
        d = state.x[:, :2] - point
        weight = np.maximum(0.0, 1 - np.sum(d**2, axis=1) / (2 * dx) ** 2) ** 2
        near = weight > 0
        w = np.sqrt(weight[near])
        basis = np.stack([np.ones(np.sum(near)), d[near, 0], d[near, 1]], axis=1)
        values.append(np.linalg.lstsq(basis * w[:, None], state.v[near, component] * w, rcond=None)[0][0])
    return np.array(values)


def cavity_measure(cells, reynolds, end):
    dx = 1.0 / cells
    fill = {"min": [0, 0, 0], "max": [1, 1, LAYERS * dx]}
    scene = tank((0, 0, 0), (1, 1, LAYERS * dx), walls=("xmin", "xmax", "ymin", "ymax"), periodic=("z",), gravity=(0, 0, 0), fills={"water": fill}, spacing=dx, viscosity=1000.0 / reynolds,
                 free_surface=False)
    scene["domain"].update(moving=["lid"], lid={"walls": ["ymax"], "translation": [1, 0, 0], "course": "linear", "duration": 1})
    result = flow(f"cavity_{reynolds}_{cells}", scene, end=end, output_every=end / 100, fields_every=end / 50)
    u, v = data("ghia1982_u_vs_y"), data("ghia1982_v_vs_x")
    last = list(result.states())[-10:]
    ours_u = np.mean([fit(s, [(0.5, y) for y in u["y"][1:-1]], 0, dx) for s in last], axis=0)
    ours_v = np.mean([fit(s, [(x, 0.5) for x in v["x"][1:-1]], 1, dx) for s in last], axis=0)
    key = f"Re{reynolds}"
    return {"dx": dx, "n": result.n, "cpu": result.cpu, "steps": result.steps, "iterations": result.iterations, "y": u["y"][1:-1], "x": v["x"][1:-1], "u": ours_u, "v": ours_v,
            "known_u": u[key][1:-1], "known_v": v[key][1:-1], "error_u": rms(ours_u - u[key][1:-1]), "error_v": rms(ours_v - v[key][1:-1]),
            "least": np.min(ours_u), "known_least": np.min(u[key]), "even": rms(last[-1].rho / 1000.0 - 1), "state": last[-1]}


def cavity():
    runs = {reynolds: [cavity_measure(n, reynolds, end) for n in cells] for reynolds, (cells, end) in CAVITY_RUNS.items()}
    rows = []
    for reynolds, several in runs.items():
        for r in several:
            rows.append((reynolds, f"1/{round(1 / r['dx'])}", f"{r['n']:,}", percent(r["error_u"]), percent(r["error_v"]), f"{r['least']:.4f} ({r['known_least']:.4f})", percent(r["even"]), r["steps"],
                         f"{r['iterations']:.1f}", f"{r['cpu']:.0f}"))
        slope = order([r["dx"] for r in several], [r["error_u"] for r in several])
        rows.append((reynolds, "order", "", shown(slope), shown(order([r["dx"] for r in several], [r["error_v"] for r in several])), "", "", "", "", ""))
        worst = max(several[-1]["error_u"], several[-1]["error_v"])
        claim(f"lid-driven cavity, Re {reynolds}, profiles", percent(worst), shown(slope), "2 %", worst < 0.02)
    drawn, axes = draw.figure(3, width=11.5, height=4.0)
    for k, (reynolds, several) in enumerate(runs.items()):
        lines = [(f"u, dx 1/{round(1 / r['dx'])}", r["u"], r["y"]) for r in several] + [("v, finest", several[-1]["x"], several[-1]["v"])]
        draw.curves(axes[k], lines, known=[("Ghia u(y)", several[-1]["known_u"], several[-1]["y"]), ("Ghia v(x)", several[-1]["x"], several[-1]["known_v"])], xlabel="u, x", ylabel="y, v", title=f"Re {reynolds}")
    fine = runs[1000][-1]
    draw.particles(axes[2], fine["state"].x, np.linalg.norm(fine["state"].v, axis=1), fine["dx"], across=2, label="speed [m/s]", box=((0, 0, 0), (1, 1, 1)))
    axes[2].set_title("particles, Re 1000")
    picture = draw.save(drawn, "cavity", "profiles against Ghia's, particles at the end")
    return CAVITY + "\n\n" + table(["Re", "dx [m]", "particles", "error u", "error v", "least u (Ghia)", "even", "steps", "applications", "CPU s"], rows) + picture


SQUARE = """A square patch of inviscid fluid, side L = 1 m, rotating at omega = 1 rad/s, no gravity, surfaces free on all sides: tension inside, four arms grow from its
corners [Le Touze et al. 2013]. `solver: isph`, a periodic slab. To 2 s. Exact: the pressure in the middle at the start, from the series of laplace p = 2 rho omega^2
with p = 0 on the square, -0.1473 rho (omega L)^2; energy and angular momentum stay. p = 0 stands at the outermost particles, half a spacing inside: a first-order
error of the pressure, 0.147 (1 - dx/L)^2. Reach: distance of the farthest particle from the middle."""

SQUARE_CELLS = (20, 40)
SQUARE_END = 2.0


def square_pressure():
    """p in the middle over rho (omega L)^2: double sine series of laplace p = 2 on the unit square"""
    odd = np.arange(1, 400, 2)
    m, n = np.meshgrid(odd, odd)
    return float(np.sum(-2 * 16 / np.pi**2 / (m * n) / (np.pi**2 * (m**2 + n**2)) * np.sin(m * np.pi / 2) * np.sin(n * np.pi / 2)))


def square_measure(cells):
    dx = 1.0 / cells
    fill = {"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, LAYERS * dx], "center": [0, 0, 0], "field": "rotation", "rate": 1.0}
    scene = tank((-3, -3, 0), (3, 3, LAYERS * dx), walls=(), periodic=("z",), gravity=(0, 0, 0), fills={"square": fill}, spacing=dx, solver="isph")
    result = flow(f"square_{cells}", scene, end=SQUARE_END, output_every=0.02, fields_every=0.02)
    middle, t, reach, spin = [], [], [], []
    for s in result.states():
        r = np.hypot(s.x[:, 0], s.x[:, 1])
        w = np.maximum(0.0, 1 - (r / (1.5 * dx)) ** 2)
        t.append(s.time)
        middle.append(np.sum(w * s.p) / np.sum(w) / 1000.0)
        reach.append(r.max())
        spin.append(np.mean(s.x[:, 0] * s.v[:, 1] - s.x[:, 1] * s.v[:, 0]))
    energy = result.ledger["fluid_kinetic"]
    half = result.state_at(SQUARE_END)
    return {"dx": dx, "n": result.n, "cpu": result.cpu, "steps": result.steps, "iterations": result.iterations, "t": np.array(t), "middle": np.array(middle), "reach": reach[-1],
            "spin": spin[-1] / spin[0] - 1, "energy": energy[-1] / energy[0] - 1, "ledger_t": result.ledger["time"], "kinetic": energy / energy[0], "state": half}


def patch():
    runs, exact = [square_measure(cells) for cells in SQUARE_CELLS], square_pressure()
    rows = [(f"1/{round(1 / r['dx'])}", f"{r['n']:,}", f"{r['middle'][1]:.4f}", percent(abs(r["middle"][1] / exact - 1)), percent(r["energy"]), percent(r["spin"]), f"{r['reach']:.3f}", r["steps"],
             f"{r['iterations']:.1f}", f"{r['cpu']:.0f}") for r in runs]
    errors = [abs(r["middle"][1] / exact - 1) for r in runs]
    slope = order([r["dx"] for r in runs], errors)
    rows.append(("order", "", "", shown(slope), "", "", "", "", "", ""))
    worst = max(abs(runs[-1]["energy"]), abs(runs[-1]["spin"]))
    claim("rotating square, pressure in the middle at the start", percent(errors[-1]), shown(slope), "10 %", errors[-1] < 0.10)
    claim("rotating square, energy and angular momentum after 2 s", percent(worst), "", "2 %", worst < 0.02)
    drawn, axes = draw.figure(3, width=11.5, height=4.0)
    draw.curves(axes[0], [(f"dx 1/{round(1 / r['dx'])}", r["t"][1:], r["middle"][1:]) for r in runs], known=[("exact at 0", [0.0], [exact])], xlabel="omega t", ylabel="p / rho (omega L)^2", title="pressure in the middle")
    draw.curves(axes[1], [(f"dx 1/{round(1 / r['dx'])}", r["ledger_t"], r["kinetic"]) for r in runs], xlabel="omega t", ylabel="over initial", title="kinetic energy")
    fine = runs[-1]
    draw.particles(axes[2], fine["state"].x, fine["state"].p, fine["dx"], across=2, label="pressure [Pa]")
    axes[2].set_title(f"particles, {SQUARE_END:g} s")
    picture = draw.save(drawn, "patch", "pressure in the middle, energy, particles at the end")
    assert math.isclose(exact, -0.1473, abs_tol=2e-4)
    return SQUARE + "\n\n" + table(["dx [m]", "particles", "middle at the start", "error", "energy", "angular momentum", "reach [m]", "steps", "applications", "CPU s"], rows) + picture
