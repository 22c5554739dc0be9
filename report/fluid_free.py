"""fluid_free.py - sections of the report on free surfaces in a plane: the stretching drop, the collapse of a column."""

import numpy as np

import draw
from flow import curve_error, data, flow, order, percent, rms, shown, tank, with_probes
from sections import claim
from program import table

SLAB = 6  # spacings of a periodic slab's depth

DROP = """A disc of radius 1 m, density 1, in a plane strain u = -100 x, v = 100 y, no gravity: it becomes an ellipse whose half axes follow an ordinary
differential equation (Monaghan 1994; `report/data/elliptical_drop_exact.csv`), to 0.008 s when it is four times as long as wide. A slab periodic in depth,
six spacings thick. Half axes from second moments of the particles, a = 2 sqrt(mean of x^2), which no single particle decides. Errors: rms over time over the
radius. Pressure in the middle: exact p = rho A^2 a^2 b^2/(a^2 + b^2), rms error over its start, 5 kPa; momentum equations of u = -A x, v = A y give it."""

RADIUS, STRAIN, DROP_END = 1.0, 100.0, 0.008
DROP_CELLS = (8, 12, 20)  # spacings a radius
# name -> keys of the fluid; the last one is shown in full
DROP_WAYS = {
    "iisph, cubic spline, h = 2 dx (defaults)": {},
    "iisph, cubic spline, h = 3 dx": {"support": 3},
    "isph, Wendland C2, h = 3 dx": {"solver": "isph", "kernel": "wendland_c2", "support": 3},
}


def drop_scene(cells, **sph):
    dx = RADIUS / cells
    half = 0.5 * SLAB * dx
    fill = {"shape": "cylinder", "axis": "z", "center": [0, 0, 0], "radius": RADIUS, "field": "strain", "rate": -STRAIN}
    scene = tank((-2, -2.6, -half), (2, 2.6, half), walls=(), periodic=("z",), gravity=(0, 0, 0), fills={"drop": fill}, spacing=dx, density=1.0, **sph)
    return with_probes(scene, middle={"at": [0, 0, 0], "quantity": "pressure"})


def drop_exact():
    """time, half axes, pressure in the middle"""
    known = data("elliptical_drop_exact")
    rate, a, b = known["A_1_per_s"], known["a_m"], known["b_m"]
    return known["t_s"], a, b, (rate * a * b) ** 2 / (a**2 + b**2)


def drop_measure(cells, way):
    dx = RADIUS / cells
    result = flow(f"drop_{list(DROP_WAYS).index(way)}_{cells}", drop_scene(cells, **DROP_WAYS[way]), end=DROP_END, output_every=DROP_END / 40, fields_every=DROP_END / 8)
    times, a, b, pressure = drop_exact()
    moments = [(s.time, *(2 * np.sqrt(np.mean(s.x[:, k] ** 2)) for k in (0, 1))) for s in result.states()]
    t, short, long = np.array(moments).T
    probe = result.probes["middle"][1:]
    energy = result.ledger["fluid_kinetic"]
    return {
        "dx": dx, "way": way, "n": result.n, "cpu": result.cpu, "steps": result.steps, "t": t, "area": short[-1] * long[-1] / RADIUS**2, "short": short, "long": long, "middle_t": result.probes["time"][1:], "middle": probe,
        "axes": max(rms(short - np.interp(t, times, a)), rms(long - np.interp(t, times, b))), "last": abs(long[-1] / np.interp(t[-1], times, b) - 1),
        "pressure": rms(probe - np.interp(result.probes["time"][1:], times, pressure)) / pressure[0], "kept": energy[-1] / energy[0], "state": result.state(-1)}


def drop_picture(ways):
    times, a, b, pressure = drop_exact()
    drawn, axes = draw.figure(4, width=13, height=4.2)
    inside = times <= DROP_END
    lines = [(way.split(" (")[0], runs[-1]) for way, runs in ways.items()]
    draw.curves(axes[0], [(name, 1000 * r["t"], r["long"]) for name, r in lines], known=[("exact", 1000 * times[inside][::4], b[inside][::4])], xlabel="time [ms]", ylabel="half axis [m]", title=f"long half axis, dx 1/{DROP_CELLS[-1]}")
    draw.curves(axes[1], [(name, 1000 * r["middle_t"], r["middle"] / 1000) for name, r in lines], known=[("exact", 1000 * times[inside][::2], pressure[inside][::2] / 1000)], xlabel="time [ms]", ylabel="pressure [kPa]",
                title="pressure in the middle", legend=False)
    angle = np.linspace(0, 2 * np.pi, 200)
    for ax, (name, r) in zip(axes[2:], (lines[0], lines[-1])):
        state = r["state"]
        draw.particles(ax, state.x, state.p / 1000, r["dx"], across=2, label="pressure [kPa]", limits=(0, 1.2))
        ax.plot(np.interp(state.time, times, a) * np.cos(angle), np.interp(state.time, times, b) * np.sin(angle), color=draw.style.COLOURS[1], linewidth=1.2)
        ax.set_title(name.replace(", ", ", 8 ms\n", 1), fontsize=8, loc="center")
    return draw.save(drawn, "drop", "half axis and pressure over time against the exact solution; particles and the exact outline at the end")


def drop():
    rows, ways = [], {}
    for way in DROP_WAYS:
        runs = ways[way] = [drop_measure(cells, way) for cells in DROP_CELLS]
        sizes, fine = [r["dx"] for r in runs], runs[-1]
        slopes = {key: order(sizes, [r[key] for r in runs]) for key in ("axes", "last", "pressure")}
        rows += [(way if r is runs[0] else "", f"1/{round(1 / r['dx'])}", f"{r['n']:,}", r["steps"], percent(r["axes"]), percent(r["last"]), f"{100 * (r['area'] - 1):+.1f} %", percent(r["pressure"], 0), f"{r['kept']:.4f}", f"{r['cpu']:.1f}")
                 for r in runs]
        rows.append(("", "order", "", "", shown(slopes["axes"]), shown(slopes["last"]), "", shown(slopes["pressure"]), "", ""))
        claim(f"stretching drop, half axes; {way}", percent(fine["axes"]), shown(slopes["axes"]))
        claim(f"stretching drop, pressure in its middle; {way}", percent(fine["pressure"], 0), shown(slopes["pressure"]))
    return (DROP + "\n\n" + table(["solver, kernel", "dx, m", "particles", "steps", "half axes, rms", "long half axis at the end", "area", "pressure, rms", "kinetic energy, end/start", "cpu, s"], rows) + drop_picture(ways))


COLUMN = """A column of water, a = 57.15 mm wide and 2a high, a slab periodic in depth, collapses on a dry floor (Martin & Moyce 1952; both of their columns, a = 1.125 and
2.25 inch, are twice as high as wide; without viscosity and surface tension they are one problem in a, g). Front: end of the farthest stretch of one spacing that
holds at least half a layer of particles. Height: volume of the particles within 0.3 a of the back wall over the floor beneath them. Errors: rms over the experiment's points, over the rms of the
experiment's values. The order against the data says little, as the experiment has its own errors (its two columns lie {spread} apart) and water and floor that rub; so there is also
the difference of each run's front from the finest one's, and its order. The experiment's gate takes time to open: `late by` is the shift of its times, 2.25 inch, that
fits best, in sqrt(a/2g), and what then remains. The finer the run, the farther ahead of the experiment: without friction the front is bound to 2 sqrt(g 2a) only, 2 in this picture's slope,
and the finest run has {slope:.2f} at its end, the experiment {known_slope:.2f}."""

WIDE, GRAVITY = 0.05715, 9.81
COLUMN_CELLS = (10, 20, 40)


def column_scene(cells):
    dx = WIDE / cells
    fill = {"min": [0, 0, 0], "max": [WIDE, SLAB * dx, 2 * WIDE]}
    return tank((0, 0, 0), (16 * WIDE, SLAB * dx, 3 * WIDE), walls=("xmin", "xmax", "zmin"), periodic=("y",), fills={"column": fill}, spacing=dx, density=1000)


def front(state, dx):
    """end of the farthest stretch of a spacing with half a layer of particles"""
    count = np.bincount((state.x[:, 0] / dx).astype(int))
    return dx * (1 + int(np.max(np.nonzero(count >= SLAB / 2))))


def column_measure(cells):
    dx, scale = WIDE / cells, np.sqrt(2 * GRAVITY / WIDE)
    end = 9.4 / scale
    result = flow(f"column_{cells}", column_scene(cells), end=end, output_every=end / 94)
    near = 0.3 * WIDE
    states = [(s.time * scale, front(s, dx) / WIDE, np.sum(s.x[:, 0] < near) * dx**3 / (near * SLAB * dx) / (2 * WIDE)) for s in result.states()]
    t, z, height = np.array(states).T
    height_t = t / np.sqrt(2)
    energy = result.ledger["fluid_kinetic"] + result.ledger["fluid_potential"]
    found = {"dx": dx, "cells": cells, "n": result.n, "cpu": result.cpu, "t": t, "z": z, "height_t": height_t, "height": height, "iterations": result.iterations,
             "lost": 1 - energy[-1] / energy[0], "compression": float(np.max(result.ledger["compression_mean"])), "result": result}
    for name, key in (("martin_moyce_front_1.125in", "small"), ("martin_moyce_front_2.25in", "large")):
        known = data(name)
        found[key] = curve_error(t, z, known["t*sqrt(2g/a)"], known["z/a"])
        found[key + "_late"] = late_by(t, z, known["t*sqrt(2g/a)"], known["z/a"])
    known = data("martin_moyce_height_2.25in")
    found["height_error"] = curve_error(height_t, height, known["t*sqrt(g/a)"], known["height/2a"])
    return found


def end_slope(t, z):
    """of the last quarter of a curve, least squares"""
    late = t > 0.75 * t[-1]
    return float(np.polyfit(t[late], z[late], 1)[0])


def late_by(t, z, known_t, known_z):
    """shift of the known times that fits a curve best, and the error it leaves"""
    shifts = np.linspace(0, 1, 101)
    errors = [curve_error(t, z, known_t - s, known_z) for s in shifts]
    k = int(np.argmin(errors))
    return shifts[k], errors[k]


def column_picture(runs):
    drawn, axes = draw.figure(2, width=11.5, height=4.0)
    fronts = [(f"Martin & Moyce, a = {inches} in", *data(f"martin_moyce_front_{inches}in").values()) for inches in ("1.125", "2.25")]
    draw.curves(axes[0], [(f"dx a/{r['cells']}", r["t"], r["z"]) for r in runs], known=fronts, xlabel="t sqrt(2 g/a)", ylabel="front / a", title="front")
    draw.curves(axes[1], [(f"dx a/{r['cells']}", r["height_t"], r["height"]) for r in runs], known=[("Martin & Moyce, a = 2.25 in", *data("martin_moyce_height_2.25in").values())],
                xlabel="t sqrt(g/a)", ylabel="height / 2a", title="height at the back wall")
    text = draw.save(drawn, "column", "front and height over time against the experiment")
    drawn, axes = draw.figure(rows=3, width=7.8, height=5.4)
    fine = runs[-1]
    for ax, moment in zip(axes, (1.2, 3.3, 6.3)):
        state = fine["result"].state_at(moment / np.sqrt(2 * GRAVITY / WIDE))
        draw.particles(ax, state.x / WIDE, np.linalg.norm(state.v, axis=1), fine["dx"] / WIDE, label="speed [m/s]", limits=(0, 2.5), box=((0, 0, 0), (10, 0, 2.1)))
        ax.set_title(f"t sqrt(2 g/a) = {moment}", fontsize=10)
    return text + draw.save(drawn, "column_particles", "particles of a slice at three times")


def column():
    runs = [column_measure(cells) for cells in COLUMN_CELLS]
    fine = runs[-1]
    small, large = data("martin_moyce_front_1.125in"), data("martin_moyce_front_2.25in")
    spread = curve_error(large["t*sqrt(2g/a)"], large["z/a"], small["t*sqrt(2g/a)"], small["z/a"])
    apart = [rms(np.interp(fine["t"], r["t"], r["z"]) - fine["z"]) / rms(fine["z"]) for r in runs[:-1]]
    sizes = [r["dx"] for r in runs]
    slopes = {key: order(sizes, [r[key] for r in runs]) for key in ("small", "large", "height_error")}
    between = order(sizes[:-1], apart)
    rows = [(f"a/{r['cells']}", f"{r['n']:,}", percent(r["small"], 1), percent(r["large"], 1), f"{r['large_late'][0]:.2f}, {percent(r['large_late'][1], 1)}", percent(r["height_error"], 1), percent(apart[k], 1) if k < len(apart) else "", percent(r["lost"], 1), f"{r['iterations']:.1f}", f"{r['cpu']:.0f}")
            for k, r in enumerate(runs)]
    rows.append(("order", "", shown(slopes["small"]), shown(slopes["large"]), "", shown(slopes["height_error"]), shown(between), "", "", ""))
    claim("collapsing column, front, a = 1.125 in", percent(fine["small"], 1), shown(slopes["small"]))
    claim("collapsing column, front, a = 2.25 in", percent(fine["large"], 1), shown(slopes["large"]))
    claim("collapsing column, height", percent(fine["height_error"], 1), shown(slopes["height_error"]))
    return (COLUMN.format(spread=percent(spread, 1), slope=end_slope(fine["t"], fine["z"]), known_slope=end_slope(large["t*sqrt(2g/a)"], large["z/a"])) + "\n\n" + table(["dx", "particles", "front, 1.125 in", "front, 2.25 in", "late by, then", "height", "front from the finest run's", "energy lost by the end", "applications a step", "cpu, s"], rows)
            + column_picture(runs))
