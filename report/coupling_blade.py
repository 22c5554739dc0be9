"""coupling_blade.py - section of the report on a flexible blade in a current, in space: deflected height and drag over the Cauchy number."""

import numpy as np

import draw
from coupling_validation import HELD, sides
from flow import data, flow, percent, source, tank, with_probes
from program import mesh, table
from sections import claim

BLADE = """A blade l = 200 mm high, b = 40 mm wide and 5 mm thick, as heavy as water, stands clamped on the floor in a current of 0.4 m/s, 0.27 m deep, that enters and leaves freely; half of it, y > 0, in a channel
60 x 12 cm between slipping walls. Thickness over dx: 0.5 and 0.67, a sheet with water on both sides. {n} quadratic tetrahedra, Poisson's ratio 0. Pressure tolerance 1e-4. Means over {low} < t < {high} s.

Reference: the steady model of Luhar & Nepf 2011 (report/data: {source}) without buoyancy. Its Cauchy number is Ca = rho C_D b U^2 l^3/(2 E I). C_D is not put in: it is that of the same blade held rigid in the
same water, F_0 = rho C_D b l U^2/2, so Ca = F_0 l^2/(E I), and the reduction of drag F/F_0 is the model's effective length over l. {drag}

The model takes drag from the velocity's part normal to the blade, C_D the same everywhere, U uniform, as for a slender blade far from walls. This one is 5 times as long as wide, fills {blocked} of the channel's
section, and the surface drops behind it."""

HEIGHT, WIDTH, THICKNESS, SPEED, DEPTH, HALF = 0.2, 0.04, 0.005, 0.4, 0.27, 0.12
INERTIA = WIDTH * THICKNESS**3 / 12
WINDOW = (0.9, 1.6)
STIFFNESS = (6.7e7, 2e7, 6.7e6)  # Young's moduli [Pa]
FINE = 2e7


def scene(spacing, young=None):
    """half a blade and its channel; without young: held rigid"""
    base = tank((-0.2, 0, 0), (0.4, HALF, 0.45), ("ymin", "ymax", "zmin"), fills={"stream": {"min": [-0.2, 0, 0], "max": [0.4, HALF, DEPTH], "velocity": [SPEED, 0, 0]}}, spacing=spacing, density=1000, tolerance=1e-4,
                inflow=["inlet"], inlet={"side": "xmin", "max": [1, 1, DEPTH], "velocity": SPEED}, outflow=["outlet"], outlet={"side": "xmax", "level": DEPTH})
    blade = {"mesh": str(mesh("blade", 2)), "density": 1000, "young": young or 1e7, "poisson": 0, "fixed": ["root"] if young else ["solid"], "wetted": ["skin"], "constraints": ["plane"], "plane": dict(HELD, groups=["middle"])}
    return with_probes(dict(base, bodies=["blade"], blade=blade), tip={"body": "blade", "at": [0, 0, HEIGHT], "quantity": "displacement", "mean": True}, drag={"body": "blade", "quantity": "force", "mean": True},
                       ahead={"at": [-0.1, 0.06, 0], "quantity": "surface"}, behind={"at": [0.2, 0.06, 0], "quantity": "surface"})


def measure(name, spacing, young=None):
    result = flow(name, scene(spacing, young), end=WINDOW[1], output_every=0.02, fields_every=0.1)
    t, probes = result.probes["time"], result.probes
    rest = t > WINDOW[0]
    found = {key: float(np.mean(probes[key][rest])) for key in ("tip_x", "tip_z", "drag_x", "ahead", "behind")}
    return dict(found, result=result, dx=spacing, young=young, force=2 * found["drag_x"], shake=float(np.std(probes["drag_x"][rest])) / abs(found["drag_x"]))


def against(run, rigid, model):
    """Cauchy number of a run, and what the model says there: deflected height, tip, drag"""
    run["Ca"] = rigid["force"] * HEIGHT**2 / (run["young"] * INERTIA)
    for key, column in (("h", "h_over_l"), ("x", "tip_dx_over_l"), ("le", "le_over_l")):
        run["model_" + key] = float(np.interp(np.log(run["Ca"]), np.log(model["Ca"]), model[column]))
    run["h"], run["x"], run["le"] = 1 + run["tip_z"] / HEIGHT, run["tip_x"] / HEIGHT, run["force"] / rigid["force"]
    return run


def picture(runs, model):
    drawn, axes = draw.figure(2, 1, width=9, height=4)
    for ax, key, column, word in zip(axes, ("h", "le"), ("h_over_l", "le_over_l"), ("deflected height h/l", "drag F/F_0, effective length l_e/l")):
        ax.semilogx(model["Ca"], model[column], color=draw.style.TEXT, linewidth=1.1, label="Luhar & Nepf, B = 0")
        for k, dx in enumerate(sorted({r["dx"] for r in runs}, reverse=True)):
            chosen = [r for r in runs if r["dx"] == dx]
            ax.plot([r["Ca"] for r in chosen], [r[key] for r in chosen], marker="os"[k], linestyle="none", color=draw.style.COLOURS[k], label=f"dx {1000 * dx:.1f} mm")
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
    model = data("luhar_nepf")
    plain = model["B"] == 0
    model = {name: column[plain] for name, column in model.items()}
    coarse, fine = 0.01, 0.0075
    rigid = {dx: measure(f"blade_rigid_{10000 * dx:.0f}", dx) for dx in (coarse, fine)}
    chosen = [(coarse, young) for young in STIFFNESS] + [(fine, FINE)]
    runs = [against(measure(f"blade_{young:.0e}_{10000 * dx:.0f}", dx, young), rigid[dx], model) for dx, young in chosen]
    rows = [(f"{1000 * r['dx']:.1f}", f"{r['result'].n:,}", f"{r['young'] / 1e6:g}", f"{r['Ca']:.1f}", f"{r['h']:.3f} / {r['model_h']:.3f}", f"{r['x']:.3f} / {r['model_x']:.3f}", f"{r['le']:.3f} / {r['model_le']:.3f}",
             percent(r["shake"], 0), int(np.max(r["result"].ledger["penetrations"])), f"{r['result'].cpu:.0f}") for r in runs]
    for dx, r in rigid.items():
        rows.append((f"{1000 * dx:.1f}", f"{r['result'].n:,}", "rigid", "0", "", "", f"F_0 = {r['force']:.2f} N", percent(r["shake"], 0), int(np.max(r["result"].ledger["penetrations"])), f"{r['result'].cpu:.0f}"))
    coefficients = ", ".join(f"{r['force'] / (0.5 * 1000 * WIDTH * HEIGHT * SPEED**2):.1f} (dx {1000 * dx:.1f} mm)" for dx, r in rigid.items())
    drag = f"Measured C_D: {coefficients}; the surface stands {1000 * (rigid[fine]['ahead'] - rigid[fine]['behind']):.0f} mm higher ahead of the rigid blade than behind."
    worst = max(runs, key=lambda r: abs(r["h"] - r["model_h"]))
    claim("blade in a current, Ca {:.0f} to {:.0f}: largest difference of h/l to the model".format(min(r["Ca"] for r in runs), max(r["Ca"] for r in runs)), f"{worst['h'] - worst['model_h']:+.3f} at Ca {worst['Ca']:.0f}")
    text = BLADE.format(n=240, low=WINDOW[0], high=WINDOW[1], source=source("luhar_nepf").split(",")[0], drag=drag, blocked=percent(0.5 * WIDTH * HEIGHT / (HALF * DEPTH), 0))
    heads = ["dx, mm", "particles", "E, MPa", "Ca", "h/l, model", "tip across/l, model", "F/F_0, model", "drag's rms in time", "particles in the blade", "cpu, s"]
    return text + "\n\n" + table(heads, rows) + picture(runs, model)
