"""fluid_sloshing.py - sections of the report on a tank in roll: impact pressure (SPHERIC test 10), volume over 10 s."""

import numpy as np

import draw
from flow import data, flow, order, percent, shown, tank, with_probes
from program import table
from sections import claim
from volume import occupied

LENGTH, HEIGHT, FILL = 0.9, 0.508, 0.093
ROLL, PERIOD, DENSITY = 4.0, 1.63, 998.0
LAYERS = (6, 9, 12)  # spacings a depth of water
SLAB = 6
END = 4.5

IMPACT = """SPHERIC test 10, lateral impact of water (Botia-Vera et al. 2010): tank 0.9 x 0.508 m, filled 93 mm, rolls by 4 degrees with a period of 1.63 s about the middle
of its floor; the water's first wave hits the wall where sensor 1 is, 93 mm above the floor. The experiment's first peak, over 100 runs: {mean:.0f} ± {sd:.0f} Pa. Its record of the
roll is not among the references: here the roll is 4 sin(2 pi t/1.63 s) degrees, fading in over 0.2 s, so that times of impact are not compared.
A slab periodic in depth, six spacings thick. Pressure: force on a patch of the wall 93 mm above the floor, a spacing high or a sensor's 9 mm if that is more, over its
area, mean over 2 ms. First peaks on either wall, of the first wave that exceeds 2 kPa; error: of their mean. Roll builds up differently from the experiment's, so the first impacts are not of quite the same wave."""

VOLUME = """The same tank for {end:.0f} s, {periods:.1f} periods of roll. By density: volume of all particles at the mean density of those in the bulk, a support and a quarter and more from walls
and below the surface, mass over mean density, over the volume at rest density. By hull: the set where the particles' volumes, smoothed by the kernel (support 2 dx, mirrored in the walls), are above one half, summed over cells of half
a spacing (`report/volume.py`); drops that fly alone are less than half anywhere and do not count, so that a splash shows as a loss while it flies, and a lattice reads 2 to 3 % large; so periods are compared: its mean
over the last period against that over the second (the first begins at rest), and both are given over the true volume. Bar 0.5 %,
for means over a period: for moments, as a wave hits a wall, the few particles that are deep enough there are thinner than the rest."""


FADE = 0.2  # [s] over which the roll sets in


def scene(layers):
    dx = FILL / layers
    patch = max(dx, 0.009)
    base = tank((0, 0, 0), (LENGTH, SLAB * dx, 1.5 * HEIGHT), walls=("xmin", "xmax", "zmin"), periodic=("y",), fills={"water": {"min": [0, 0, 0], "max": [LENGTH, SLAB * dx, FILL]}},
                spacing=dx, density=DENSITY)
    frame = {"angle": ROLL, "axis": [0, 1, 0], "point": [LENGTH / 2, 0, 0], "course": "sine", "frequency": 1 / PERIOD, "duration": FADE}
    gauges = {name: {"body": wall, "quantity": "pressure", "mean": True, "min": [x, 0, FILL - patch / 2], "max": [x, SLAB * dx, FILL + patch / 2]}
              for name, wall, x in (("left", "xmin", 0), ("right", "xmax", LENGTH))}
    return with_probes(dict(base, frame=frame), **gauges)


def first_peak(t, p):
    """largest pressure within 0.2 s of the first time it is above 2 kPa: of the first impact"""
    hit = np.nonzero(p > 2000)[0]
    if not hit.size:
        return float("nan"), float("nan")
    near = (t >= t[hit[0]]) & (t <= t[hit[0]] + 0.2)
    k = int(np.argmax(np.where(near, p, 0)))
    return float(t[k]), float(p[k])


def measure(layers, name="sloshing", end=END):
    dx = FILL / layers
    result = flow(f"{name}_{layers}", scene(layers), end=end, output_every=0.002, fields_every=0.1)
    t = result.probes["time"]
    peaks = {name: first_peak(t, result.probes[name]) for name in ("left", "right")}
    return {"dx": dx, "layers": layers, "n": result.n, "cpu": result.cpu, "t": t, "probes": result.probes, "result": result, "peaks": peaks, "iterations": result.iterations,
            "peak": 0.5 * (peaks["left"][1] + peaks["right"][1])}


def sloshing():
    known = data("spheric10_first_peak")
    mean, sd = float(known["mean_Pa"][0]), float(known["sd_Pa"][0])
    runs = [measure(layers) for layers in LAYERS]
    fine, sizes = runs[-1], [r["dx"] for r in runs]
    errors = [abs(r["peak"] / mean - 1) for r in runs]
    slope = order(sizes, errors)
    rows = [(f"{1000 * r['dx']:.1f}", f"{r['n']:,}", *(f"{r['peaks'][k][1]:.0f} at {r['peaks'][k][0]:.2f} s" for k in ("left", "right")), percent(e, 0), "yes" if abs(r["peak"] - mean) < sd else "no", f"{r['iterations']:.1f}", f"{r['cpu']:.0f}")
            for r, e in zip(runs, errors)]
    rows.append(("order", "", "", "", shown(slope), "", "", ""))
    claim("sloshing impact, first peak", percent(errors[-1], 0), shown(slope), f"{percent(sd / mean, 0)}, the experiment's spread", errors[-1] < sd / mean)
    drawn, axes = draw.figure(2, width=11.5, height=3.8)
    for ax, side in zip(axes, ("left", "right")):
        draw.curves(ax, [(f"dx {1000 * r['dx']:.1f} mm", r["t"], r["probes"][side] / 1000) for r in runs], xlabel="time [s]", ylabel="pressure [kPa]", title=f"{side} wall, 93 mm above the floor")
        ax.axhspan((mean - sd) / 1000, (mean + sd) / 1000, color=draw.style.COLOURS[4], alpha=0.25, linewidth=0, label="first peaks of the experiment")
        ax.legend(fontsize=9)
    text = draw.save(drawn, "sloshing", "pressure on both walls over time; band: the experiment's first peaks")
    drawn, axes = draw.figure(rows=2, columns=2, width=10.5, height=3.6)
    times = [fine["peaks"][side][0] + shift for side in ("left", "right") for shift in (-0.1, 0.1)]
    for ax, moment in zip(axes.ravel(), sorted(times)):
        state = fine["result"].state_at(moment)
        draw.particles(ax, state.x, np.linalg.norm(state.v, axis=1), fine["dx"], label="speed [m/s]", limits=(0, 1.5), box=((0, 0, 0), (LENGTH, 0, 0.3)))
        ax.set_title(f"t = {state.time:.2f} s", fontsize=10)
    text += draw.save(drawn, "sloshing_particles", "particles of a slice around the first impacts, seen from the tank")
    return (IMPACT.format(mean=mean, sd=sd) + "\n\n" + table(["dx, mm", "particles", "first peak left, Pa", "right, Pa", "mean's error", "within the spread", "applications a step", "cpu, s"], rows) + text)


def bulk_density(state, layers):
    """mean density [kg/m^3] of particles a support and a quarter and more from walls and surface; nan without any"""
    reach = 1.25 * 2 * FILL / layers
    x = state.x
    deep = (x[:, 0] > reach) & (x[:, 0] < LENGTH - reach) & (x[:, 2] > reach)
    columns = (x[:, 0] / (LENGTH / 60)).astype(int).clip(0, 59)
    top = np.array([x[columns == k, 2].max(initial=0) for k in range(60)])
    lowest = np.minimum(np.minimum(np.roll(top, 1), np.roll(top, -1)), top)
    deep &= x[:, 2] < lowest[columns] - reach
    return float(np.mean(state.rho[deep])) if np.any(deep) else float("nan")


VOLUME_LAYERS, VOLUME_END = (6,), 10.0


def volume():
    rows, curves = [], []
    for layers in VOLUME_LAYERS:
        r = measure(layers, "volume", VOLUME_END)
        dx = r["dx"]
        found = []
        for k, state in enumerate(r["result"].states()):
            if k % 2 == 0 or state.time > VOLUME_END - 1e-6:
                found.append((state.time, DENSITY / bulk_density(state, layers), occupied(state.x, dx, (0, 0, 0), (LENGTH, SLAB * dx, 1.5 * HEIGHT), ("xmin", "xmax", "zmin"), ("y",))))
        t, by_density, hull = np.array(found).T
        hull = hull / (r["n"] * dx**3)
        early, late = (t > PERIOD) & (t <= 2 * PERIOD), t > VOLUME_END - PERIOD
        periods = [by_density[(t > k * PERIOD) & (t <= (k + 1) * PERIOD)] - 1 for k in range(int(VOLUME_END / PERIOD))]
        change = {"density": max(abs(float(np.nanmean(p))) for p in periods), "hull": float(abs(np.mean(hull[late]) / np.mean(hull[early]) - 1))}
        curves.append((dx, t, by_density, hull))
        rows.append((f"{1000 * dx:.1f}", f"{r['n']:,}", f"{100 * np.nanmin(by_density - 1):+.3f} to {100 * np.nanmax(by_density - 1):+.3f} %", f"{100 * change['density']:.3f} %", f"{100 * np.mean(hull[early] - 1):+.2f} %", f"{100 * np.mean(hull[late] - 1):+.2f} %",
                     f"{100 * np.min(hull[t > PERIOD] - 1):+.2f} to {100 * np.max(hull[t > PERIOD] - 1):+.2f} %", "yes" if max(change.values()) < 0.005 else "no", f"{r['cpu']:.0f}"))
    claim("sloshing for 10 s, volume by density, largest mean over a period", percent(change["density"]), "", "0.5 %", change["density"] < 0.005)
    claim("sloshing for 10 s, volume by hull, last period against second", percent(change["hull"]), "", "0.5 %", change["hull"] < 0.005)
    drawn, axes = draw.figure(2, width=11.5, height=3.4, sharey=True)
    for ax, title, k in zip(axes, ("by density in the bulk", "hull of the particles"), (2, 3)):
        draw.curves(ax, [(f"dx {1000 * c[0]:.1f} mm", c[1], 100 * (c[k] - 1)) for c in curves], xlabel="time [s]", ylabel="change of volume [%]", title=title)
        ax.axhspan(-0.5, 0.5, color=draw.style.COLOURS[4], alpha=0.2, linewidth=0)
    return (VOLUME.format(end=VOLUME_END, periods=VOLUME_END / PERIOD) + "\n\n"
            + table(["dx, mm", "particles", "by density, range", "its largest mean over a period", "hull, second period", "hull, last period", "hull, range after the first period", "within 0.5 %", "cpu, s"], rows) + draw.save(drawn, "volume", "change of volume over time"))
