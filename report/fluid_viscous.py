"""fluid_viscous.py - sections of the report on laminar flow: Poiseuille, Couette, a film down an incline, and implicit viscosity."""

import math

import numpy as np

import draw
from flow import flow, order, percent, rms, shown, tank, with_probes
from program import small, table, verdict
from sections import claim

DENSITY, HEIGHT, PEAK = 1000.0, 0.1, 0.05  # [kg/m^3], channel [m], peak or lid velocity [m/s]
REYNOLDS = 5.0
NU = PEAK * HEIGHT / REYNOLDS  # [m^2/s]
TIME = HEIGHT**2 / NU  # [s] of diffusion across the channel
LAYERS = (8, 16, 32)
MOMENTS = (0.02, 0.05, 0.1, 0.2, 0.6)  # of TIME
MODES = np.arange(1, 200)


def poiseuille_exact(s, t):
    """u/U of the channel s = z/H started from rest at t [H^2/nu]: the parabola less its decaying odd sine waves"""
    s, odd = np.asarray(s), MODES[::2]
    return 4 * s * (1 - s) - (32 / (odd * np.pi) ** 3 * np.sin(np.pi * np.outer(s, odd)) * np.exp(-((odd * np.pi) ** 2) * t)).sum(axis=1)


def film_exact(s, t):
    """u/U of a film s = z/H, half of a channel twice as high"""
    return poiseuille_exact(0.5 * np.asarray(s), 0.25 * t)


def couette_exact(s, t):
    """u/U below a lid that starts at once"""
    s = np.asarray(s)
    return s + (2 * (-1.0) ** MODES / (MODES * np.pi) * np.sin(np.pi * np.outer(s, MODES)) * np.exp(-((MODES * np.pi) ** 2) * t)).sum(axis=1)


def channel(layers, drive=0.0, lid=0.0, end=1.0, height=HEIGHT, **sph):
    """full from wall to wall, periodic along x and y; drive [m/s^2], or a lid that moves [m/s]"""
    dx = height / layers
    high = (5 * dx, 5 * dx, height)
    scene = tank((0, 0, 0), high, walls=("zmin", "zmax"), gravity=(drive, 0, 0), periodic=("x", "y"), fills={"water": {"min": [0, 0, 0], "max": list(high)}},
                 **{"spacing": dx, "density": DENSITY, "viscosity": DENSITY * NU, "free_surface": False, **sph})
    if lid:
        scene["domain"].update(moving=["lid"], lid={"walls": ["zmax"], "translation": [lid * end, 0, 0], "course": "linear", "duration": end})
    return with_probes(scene, low={"body": "zmin", "quantity": "force"}, high={"body": "zmax", "quantity": "force"})


def profile_error(state, exact, peak, height=HEIGHT):
    """rms over the particles of u - exact, over the peak"""
    return rms(state.v[:, 0] / peak - exact(state.x[:, 2] / height)) if len(state.x) else math.nan


def run(name, scene, time, exact, peak=PEAK, moments=MOMENTS, height=HEIGHT):
    """runs it for the moments (of `time` [s]) and measures the profile at each, its mean error, and the walls' drag"""
    result = flow(name, scene, end=moments[-1] * time, output_every=0.01 * time)
    states = [result.state_at(m * time) for m in moments]
    errors = [profile_error(s, lambda z, t=s.time / time: exact(z, t), peak, height) for s in states]
    late = result.probes["time"] > 0.75 * moments[-1] * time
    low = np.mean(result.probes["low_x"][late])
    return {"dx": height / round(height / scene["sph"]["spacing"]), "n": result.n, "steps": result.steps, "cpu": result.cpu, "states": states, "errors": errors, "start_up": max(errors[:-1]) if len(errors) > 1 else math.nan,
            "steady": errors[-1], "low": low, "high": np.mean(result.probes["high_x"][late]) if "high_x" in result.probes else 0.0, "result": result, "transverse": rms(states[-1].v[:, 1:]) / peak,
            "iterations": result.summary["fluid"].get("viscosity_iterations_mean", 0.0)}


def binned(state, dx, peak):
    """mean velocity of the particles of each layer: height, u/U"""
    layer = np.floor(state.x[:, 2] / dx).astype(int)
    found = np.unique(layer)
    return np.array([state.x[layer == k, 2].mean() for k in found]), np.array([state.v[layer == k, 0].mean() / peak for k in found])


def picture(runs, exact, time, name, title, height=HEIGHT, peak=PEAK):
    """profiles of the finest run at the moments, errors over spacing, its particles"""
    fine, z = runs[-1], np.linspace(0, 1, 120)
    drawn, axes = draw.figure(3, width=10.5, height=3.9, gridspec_kw={"width_ratios": [2, 2, 0.7]})
    lines = [(f"{s.time / time:.2g}", *binned(s, fine["dx"], peak)[::-1]) for s in fine["states"]]
    for k, (label, u, at) in enumerate(lines):
        axes[0].plot(u, at / height, marker="o", markersize=3, linestyle="none", color=draw.style.COLOURS[k % 8], label=label)
        axes[0].plot(exact(z, fine["states"][k].time / time), z, color=draw.style.TEXT, linewidth=0.9)
    axes[0].set_xlabel("u / U")
    axes[0].set_ylabel("z / H")
    axes[0].set_title("layers (dots), exact (lines)")
    axes[0].legend(fontsize=8, title="t nu/H²")
    draw.convergence(axes[1], [r["dx"] for r in runs], {"steady": [r["steady"] for r in runs], "start-up": [r["start_up"] for r in runs]}, title="rms error / U")
    s = fine["states"][-1]
    draw.particles(axes[2], s.x, s.v[:, 0], fine["dx"], label="u [m/s]", limits=(0, peak), box=((0, 0, 0), (5 * fine["dx"], 5 * fine["dx"], height)))
    axes[2].set_title("finest")
    axes[2].set_xticks([])
    return draw.save(drawn, name, f"{title}: profiles, errors over spacing, particles")


HEADERS = ["flow", "layers", "particles", "steady", "order", "start-up, worst", "drag of the walls", "transverse motion", "steps", "CG a step", "cpu, s"]


def rows_of(label, runs, drag):
    """drag: run -> what the walls carry over what drives"""
    slope = shown(order([r["dx"] for r in runs], [r["steady"] for r in runs]))
    return [(label, round(HEIGHT / r["dx"]), f"{r['n']:,}", percent(r["steady"]), slope if k == len(runs) - 1 else "", percent(r["start_up"]), f"{drag(r):.4f}", small(r["transverse"]), r["steps"], f"{r['iterations']:.0f}", f"{r['cpu']:.1f}")
            for k, r in enumerate(runs)]


POISEUILLE = f"""A channel {HEIGHT} m high between no-slip planes, periodic along x and y (5 spacings each), full of fluid, solver `isph`; Reynolds number {REYNOLDS:g} of the peak
velocity U = g H^2/(8 nu). From rest; the start-up's exact series. Errors: rms over all particles of u - exact, over U, at t = 0.6 H^2/nu (steady: what is left of the start-up is 0.3 %
of U and in the series) and the worst of t = 0.02, 0.05, 0.1, 0.2 H^2/nu. Drag: force of both walls over what drives, the mean of the last quarter. Bar: 2 % at 16 layers. Film: the same
down an incline of 30 degrees with gravity, a no-slip floor and a free surface (zero shear: half a parabola), solver `iisph`, time in its own H^2/nu."""


def film(layers, nu, name, **sph):
    """H high, U = g sin(30) H^2/(2 nu)"""
    dx = HEIGHT / layers
    drive, press = 9.81 * math.sin(math.pi / 6), 9.81 * math.cos(math.pi / 6)
    peak = drive * HEIGHT**2 / (2 * nu)
    side = 5 * dx
    scene = tank((0, 0, 0), (side, side, 1.5 * HEIGHT), walls=("zmin",), gravity=(drive, 0, -press), periodic=("x", "y"), fills={"water": {"min": [0, 0, 0], "max": [side, side, HEIGHT]}},
                 spacing=dx, density=DENSITY, viscosity=DENSITY * nu, **sph)
    scene = with_probes(scene, low={"body": "zmin", "quantity": "force"})
    found = run(name, scene, HEIGHT**2 / nu, film_exact, peak, moments=(0.1, 0.3, 0.6, 2.0))
    found["drag"] = found["low"] / (DENSITY * side**2 * HEIGHT * drive)
    return found


def poiseuille():
    drive, rows, finest = 8 * NU * PEAK / HEIGHT**2, [], []
    carried = lambda r: (r["low"] + r["high"]) / (DENSITY * 25 * r["dx"] ** 2 * HEIGHT * drive)
    runs = [run(f"poiseuille_{n}", channel(n, drive), TIME, poiseuille_exact) for n in LAYERS]
    rows += rows_of("channel, morris", runs, carried)
    central = [run(f"poiseuille_monaghan_{n}", channel(n, drive, viscous_form="monaghan"), TIME, poiseuille_exact) for n in LAYERS[:2]]
    rows += rows_of("channel, monaghan", central, carried)
    nu = math.sqrt(9.81 * 0.5 * HEIGHT**3 / (2 * REYNOLDS))
    films = [film(n, nu, f"film_{n}") for n in LAYERS]
    rows += rows_of("film, morris", films, lambda r: r["drag"])
    finest = [runs[1]["steady"], films[1]["steady"]]
    claim("Poiseuille, 16 layers, of the peak", percent(runs[1]["steady"]), shown(order([r["dx"] for r in runs], [r["steady"] for r in runs])), "2 %", finest[0] < 0.02)
    claim("film down an incline, 16 layers", percent(films[1]["steady"]), shown(order([r["dx"] for r in films], [r["steady"] for r in films])), "2 %", finest[1] < 0.02)
    return (POISEUILLE + "\n\n" + table(HEADERS, rows) + f"\nWithin 2 % at 16 layers, channel and film: {verdict(max(finest) < 0.02)}.\n" + picture(runs, poiseuille_exact, TIME, "poiseuille", "Poiseuille")
            + picture(films, film_exact, HEIGHT**2 / nu, "film", "film", peak=9.81 * 0.5 * HEIGHT**2 / (2 * nu)))


COUETTE = f"""The same channel without a force, the lid set in motion at once with U = {PEAK} m/s (`domain.moving`). Steady: a straight line, mu U/H on both walls: the drag's column is the floor's
force over mu U A/H, and the lid's is its opposite."""


def couette():
    shear = DENSITY * NU * PEAK / HEIGHT
    runs = [run(f"couette_{n}", channel(n, lid=PEAK, end=MOMENTS[-1] * TIME), TIME, couette_exact) for n in LAYERS]
    rows = rows_of("lid, morris", runs, lambda r: r["low"] / (shear * 25 * r["dx"] ** 2))
    balance = max(abs(1 + r["high"] / r["low"]) for r in runs)
    claim("Couette, 16 layers, of the lid's velocity", percent(runs[1]["steady"]), shown(order([r["dx"] for r in runs], [r["steady"] for r in runs])), "2 %", runs[1]["steady"] < 0.02)
    return COUETTE + f" The two differ by at most {small(balance)} of it.\n\n" + table(HEADERS, rows) + picture(runs, couette_exact, TIME, "couette", "Couette")


IMPLICIT = """A film of 16 layers, 0.1 m, on the same incline, gravity on at t = 0: the physical time that is followed is the same, 0.1 s, while the viscosity grows, so that explicit steps shrink as
0.8/K_ii, about 0.045 h^2/nu, and implicit ones stay at what gravity allows. Error: rms of u at the end from the exact start-up, over its largest value there. The implicit step is first order in time, and momentum is kept to round-off whatever its tolerance (`unit.sph.viscosity`)."""


def slump(nu, solver):
    """the film for 0.1 s: steps, cpu, error"""
    layers, end = 16, 0.1
    dx = HEIGHT / layers
    side, drive, press = 5 * dx, 9.81 * 0.5, 9.81 * math.cos(math.pi / 6)
    scene = tank((0, 0, 0), (side, side, 1.5 * HEIGHT), walls=("zmin",), gravity=(drive, 0, -press), periodic=("x", "y"), fills={"water": {"min": [0, 0, 0], "max": [side, side, HEIGHT]}},
                 spacing=dx, density=DENSITY, viscosity=DENSITY * nu, viscosity_solver=solver)
    result = flow(f"slump_{nu:g}_{solver}", scene, end=end, output_every=end / 2)
    peak, time = drive * HEIGHT**2 / (2 * nu), HEIGHT**2 / nu
    state = result.state(-1)
    largest = film_exact([1.0], end / time)[0]
    return {"steps": result.steps, "cpu": result.cpu, "error": profile_error(state, lambda z: film_exact(z, end / time), peak) / largest, "iterations": result.summary["fluid"].get("viscosity_iterations_mean", 0.0)}


def implicit():
    rows, chosen = [], []
    for nu in (1e-3, 1e-2, 1e-1, 1.0):
        plain, with_cg = slump(nu, "explicit"), slump(nu, "implicit")
        rows.append((f"{DENSITY * nu:g}", plain["steps"], f"{plain['cpu']:.1f}", percent(plain["error"]), with_cg["steps"], f"{with_cg['iterations']:.0f}", f"{with_cg['cpu']:.1f}", percent(with_cg["error"])))
        chosen.append((plain, with_cg))
    gain = chosen[-1][0]["cpu"] / chosen[-1][1]["cpu"]
    claim("implicit viscosity, 1000 Pa s, film in 0.1 s", percent(chosen[-1][1]["error"]), "", "5 %", chosen[-1][1]["error"] < 0.05)
    return (IMPLICIT + "\n\n" + table(["viscosity, Pa s", "explicit: steps", "cpu, s", "error", "implicit: steps", "CG a step", "cpu, s", "error"], rows)
            + f"\nAt 1000 Pa s implicit took {gain:.1f} times less time.\n")
