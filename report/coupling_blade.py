"""coupling_blade.py - section of the report on a flexible blade in a current, in space: deflected height and drag over the Cauchy number."""

import numpy as np

import draw
from coupling_validation import HELD, sides
from flow import data, flow, percent, tank, with_probes
from program import mesh, table
from sections import claim

BLADE = """A blade l = 200 mm high, b = 40 mm wide and 5 mm thick, as heavy as water, stands clamped on the floor in a current of 0.4 m/s, 0.27 m deep, that enters and leaves freely; half of it, y > 0, in a channel
60 x 12 cm between slipping walls. Thickness over dx: 0.38, 0.5 and 0.75, a sheet with water on both sides. {n} quadratic tetrahedra, Poisson's ratio 0. Pressure tolerance 1e-4. Means over {low} < t < {high} s.

Reference: the steady model of Luhar & Nepf 2011 (report/data/luhar_nepf.csv) without buoyancy. Its Cauchy number is Ca = rho C_D b U^2 l^3/(2 E I). C_D is not put in: it is that of the same blade held rigid in the
same water, F_0 = rho C_D b l U^2/2, so Ca = F_0 l^2/(E I), and the reduction of drag F/F_0 is the model's effective length over l. {drag}

The model takes drag from the velocity's part normal to the blade, C_D the same everywhere, U uniform, as for a slender blade far from walls. This one is 5 times as long as wide, fills {blocked} of the channel's
section, and the water's own numerical friction is that of {across} particles a width. A load that goes with the first power of cos(angle), as of a plate at incidence or in slow viscous flow, is shown beside."""

HEIGHT, WIDTH, THICKNESS, SPEED, DEPTH, HALF = 0.2, 0.04, 0.005, 0.4, 0.27, 0.12
INERTIA = WIDTH * THICKNESS**3 / 12
WINDOW = (0.8, 1.4)
STIFFNESS = (6.7e7, 2e7, 6.7e6)  # Young's moduli [Pa]
AGAIN = 2e7  # at the coarser spacing too


def scene(spacing, young=None):
    """half a blade and its channel; without young: held rigid"""
    base = tank((-0.2, 0, 0), (0.4, HALF, 0.45), ("ymin", "ymax", "zmin"), fills={"stream": {"min": [-0.2, 0, 0], "max": [0.4, HALF, DEPTH], "velocity": [SPEED, 0, 0]}}, spacing=spacing, density=1000, tolerance=1e-4,
                inflow=["inlet"], inlet={"side": "xmin", "max": [1, 1, DEPTH], "velocity": SPEED}, outflow=["outlet"], outlet={"side": "xmax", "level": DEPTH})
    blade = {"mesh": str(mesh("blade", 2)), "density": 1000, "young": young or 1e7, "poisson": 0, "fixed": ["root"] if young else ["solid"], "wetted": ["skin"], "constraints": ["plane"], "plane": dict(HELD, groups=["middle"])}
    return with_probes(dict(base, bodies=["blade"], blade=blade), tip={"body": "blade", "at": [0, 0, HEIGHT], "quantity": "displacement", "mean": True}, drag={"body": "blade", "quantity": "force", "mean": True})


def measure(name, spacing, young=None):
    result = flow(name, scene(spacing, young), end=WINDOW[1], output_every=0.02, fields_every=0.1)
    t, probes = result.probes["time"], result.probes
    rest = t > WINDOW[0]
    found = {key: float(np.mean(probes[key][rest])) for key in ("tip_x", "tip_z", "drag_x")}
    return dict(found, result=result, dx=spacing, young=young, force=2 * found["drag_x"], shake=float(np.std(probes["drag_x"][rest])) / abs(found["drag_x"]))


def steady(cauchy, power=2, n=400):
    """the steady model without buoyancy, load normal to the blade ~ cos(angle from upright)^power, 2 in the source: deflected height, tip across, effective length, over the blade's.
    theta' = the integral over the rest of the blade of the shear force R.n, R that of the loads beyond; iterated with rising load"""

    def rest(values):
        return np.concatenate([np.cumsum((0.5 * (values[1:] + values[:-1]) / n)[::-1])[::-1], [0]])

    theta = np.zeros(n + 1)
    for load in np.geomspace(min(0.5, cauchy), cauchy, 40):
        for _ in range(3000):
            normal = load * np.cos(theta) ** power
            bend = rest(rest(normal * np.cos(theta)) * np.cos(theta) + rest(normal * np.sin(theta)) * np.sin(theta))
            change = np.concatenate([[0], np.cumsum(0.5 * (bend[1:] + bend[:-1]) / n)]) - theta
            theta += 0.15 * change
            if np.max(np.abs(change)) < 1e-7:
                break
    return tuple(float(np.trapezoid(values, dx=1 / n)) if hasattr(np, "trapezoid") else float(np.trapz(values, dx=1 / n)) for values in (np.cos(theta), np.sin(theta), np.cos(theta) ** (power + 1)))


def against(run, rigid):
    """Cauchy number of a run, and what the model says there: deflected height, tip, drag"""
    run["Ca"] = rigid["force"] * HEIGHT**2 / (run["young"] * INERTIA)
    run["model"], run["linear"] = steady(run["Ca"]), steady(run["Ca"], 1)
    run["ours"] = (1 + run["tip_z"] / HEIGHT, run["tip_x"] / HEIGHT, run["force"] / rigid["force"])
    return run


def picture(runs):
    drawn, axes = draw.figure(2, 1, width=9, height=4)
    numbers = np.geomspace(0.5, 60, 30)
    lines = {power: np.array([steady(number, power) for number in numbers]) for power in (2, 1)}
    for ax, key, word in zip(axes, (0, 2), ("deflected height h/l", "drag F/F_0, effective length l_e/l")):
        ax.semilogx(numbers, lines[2][:, key], color=draw.style.TEXT, linewidth=1.1, label="Luhar & Nepf, B = 0")
        ax.semilogx(numbers, lines[1][:, key], color=draw.style.TEXT, linewidth=1, linestyle="--", label="its load with the first power of cos")
        for k, dx in enumerate(sorted({r["dx"] for r in runs}, reverse=True)):
            chosen = [r for r in runs if r["dx"] == dx]
            ax.plot([r["Ca"] for r in chosen], [r["ours"][key] for r in chosen], marker="os^"[k], linestyle="none", color=draw.style.COLOURS[k], label=f"dx {1000 * dx:.1f} mm")
        ax.set_xlabel("Cauchy number")
        ax.set_title(word)
    axes[0].legend(fontsize=9)
    text = draw.save(drawn, "blade", "deflected height and drag over the Cauchy number")
    shown = [r for r in runs if r["dx"] == runs[0]["dx"]]
    drawn, axes = draw.figure(len(shown), 1, width=11, height=2.9)
    for ax, run in zip(np.ravel(axes), shown):
        state = run["result"].state(-1)
        draw.particles(ax, state.x, np.linalg.norm(state.v, axis=1), run["dx"], limits=(0, 0.8), box=((-0.2, 0, 0), (0.4, HALF, 0.3)), slab=(0, run["dx"]), label="speed [m/s]" if run is shown[-1] else "")
        x, triangles = sides(run["result"].directory, "blade", WINDOW[1])
        ax.tripcolor(x[:, 0], x[:, 2], triangles, facecolors=np.zeros(len(triangles)), cmap="gray", edgecolors="none", zorder=3)
        ax.set_title(f"Ca {run['Ca']:.1f}", fontsize=10)
        ax.set_xlabel("x [m]")
    np.ravel(axes)[0].set_ylabel("z [m]")
    return text + draw.save(drawn, "blade_moments", f"the plane of symmetry after {WINDOW[1]} s")


def blade():
    table_of = data("luhar_nepf")
    plain = table_of["B"] == 0
    apart = max(abs(steady(number)[0] - height) for number, height in zip(table_of["Ca"][plain], table_of["h_over_l"][plain]))
    coarse, fine, finest = 0.04 / 3, 0.01, 0.02 / 3
    rigid = {dx: measure(f"blade_rigid_{10000 * dx:.0f}", dx) for dx in (coarse, fine, finest)}
    chosen = [(fine, young) for young in STIFFNESS] + [(coarse, AGAIN), (finest, AGAIN)]
    runs = [against(measure(f"blade_{young:.0e}_{10000 * dx:.0f}", dx, young), rigid[dx]) for dx, young in chosen]
    rows = [(f"{1000 * r['dx']:.1f}", f"{r['result'].n:,}", f"{r['young'] / 1e6:g}", f"{r['Ca']:.1f}", *(f"{r['ours'][k]:.3f} / {r['model'][k]:.3f} / {r['linear'][k]:.3f}" for k in range(3)),
             percent(r["shake"], 0), int(np.max(r["result"].ledger["penetrations"])), f"{r['result'].cpu:.0f}") for r in runs]
    for dx, r in rigid.items():
        rows.append((f"{1000 * dx:.1f}", f"{r['result'].n:,}", "rigid", "0", "", "", f"F_0 = {r['force']:.2f} N", percent(r["shake"], 0), int(np.max(r["result"].ledger["penetrations"])), f"{r['result'].cpu:.0f}"))
    drags = {dx: r["force"] / (0.5 * 1000 * WIDTH * HEIGHT * SPEED**2) for dx, r in rigid.items()}
    coefficients = ", ".join(f"{value:.1f} (dx {1000 * dx:.1f} mm)" for dx, value in drags.items())
    again = {r["dx"]: r["ours"][0] - r["model"][0] for r in runs if r["young"] == AGAIN}
    limit = {name: np.polyfit(list(found), list(found.values()), 1)[1] for name, found in (("drag", drags), ("height", again))}
    drag = f"Measured C_D: {coefficients}; a line through them ends at {limit['drag']:.1f} at dx = 0. The model is solved here for each Ca; its h/l is that of the table to {apart:.0e}."
    worst = max(runs, key=lambda r: abs(r["ours"][0] - r["model"][0]))
    small = min(runs, key=lambda r: r["Ca"])
    for r in (small, worst):
        claim(f"blade in a current, Ca {r['Ca']:.1f}: deflected height h/l, less the model's", f"{r['ours'][0] - r['model'][0]:+.3f} of {r['model'][0]:.3f}")
    text = BLADE.format(n=240, low=WINDOW[0], high=WINDOW[1], drag=drag, across="3 to 6", blocked=percent(0.5 * WIDTH * HEIGHT / (HALF * DEPTH), 0))
    text += f"\n\nThe height of the blade of {AGAIN / 1e6:g} MPa is off by " + ", ".join(f"{value:+.3f} (dx {1000 * dx:.1f} mm)" for dx, value in sorted(again.items(), reverse=True)) + f"; a line through these ends at {limit['height']:+.3f}."
    heads = ["dx, mm", "particles", "E, MPa", "Ca", "h/l, model, first power", "tip across/l, model, first power", "F/F_0, model, first power", "drag's rms in time", "particles in the blade", "cpu, s"]
    return text + "\n\n" + table(heads, rows) + picture(runs)
