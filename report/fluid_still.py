"""fluid_still.py - section of the report on water at rest: the hydrostatic tank at three resolutions."""

import numpy as np

import draw
from flow import flow, order, percent, rms, shown, tank, with_probes
from sections import claim
from program import small, table

DEPTH, WIDTH, GRAVITY, DENSITY = 0.4, 0.2, 9.81, 1000.0
LAYERS = (10, 20, 40)
END = 4.0

STILL = """A tank 0.2 x 0.2 m of five walls, filled 0.4 m deep, 4 s from a packed lattice; means over the last 2 s. Profile: pressure at nine gauges
on the axis, between 0.1 and 0.9 of the depth, mean over time, rms of its distance from rho g (H - z), over rho g H. Floor: its mean force over the
weight of the water, and the rms of what it swings about its mean. Compression: largest mean value of max(0, rho/rho0 - 1). Offset: height of the
centre of mass less half the depth, in spacings: where the wetted surface lies by volume. Noise is what the pressure solve leaves at its tolerance (a mean residual of 1e-5 of the density,
which deeper layers add up): the last row is the same water with a tolerance of 1e-6, in double precision."""


def scene(layers, **sph):
    dx = DEPTH / layers
    still = tank((0, 0, 0), (WIDTH, WIDTH, 1.5 * DEPTH), fills={"water": {"min": [0, 0, 0], "max": [WIDTH, WIDTH, DEPTH]}}, spacing=dx, density=DENSITY, **sph)
    gauges = {f"p{k}": {"at": [WIDTH / 2, WIDTH / 2, 0.1 * k * DEPTH], "quantity": "pressure"} for k in range(1, 10)}
    return with_probes(still, floor={"body": "zmin", "quantity": "force"}, **gauges)


def measure(layers, name="", **sph):
    """what one resolution gives, as a dictionary; sph: further keys of the fluid"""
    dx = DEPTH / layers
    result = flow(f"still_{layers}{name}", scene(layers, **sph), end=END, output_every=0.01, fields_every=END / 2)
    late = result.probes["time"] > END / 2
    z = np.array([0.1 * k * DEPTH for k in range(1, 10)])
    series = np.array([result.probes[f"p{k}"][late] for k in range(1, 10)])
    exact = DENSITY * GRAVITY * (DEPTH - z)
    weight = DENSITY * GRAVITY * DEPTH * WIDTH**2
    force = -result.probes["floor_z"][late]
    mass = DENSITY * DEPTH * WIDTH**2
    middle = np.mean(result.ledger["fluid_potential"][result.ledger["time"] > END / 2]) / (mass * GRAVITY)
    return {
        "dx": dx, "n": result.n, "z": z, "mean": series.mean(axis=1), "cpu": result.cpu, "iterations": result.iterations,
        "profile": rms(series.mean(axis=1) - exact) / (DENSITY * GRAVITY * DEPTH),
        "gauge_noise": rms(series - series.mean(axis=1)[:, None]) / (DENSITY * GRAVITY * DEPTH),
        "floor": abs(np.mean(force) / weight - 1), "noise": float(np.std(force)) / weight,
        "compression": float(np.max(result.ledger["compression_mean"][late])),
        "speed": float(result.ledger["fluid_speed_rms"][-1]) / np.sqrt(GRAVITY * DEPTH), "offset": (middle - DEPTH / 2) / dx, "state": result.state(-1)}


def picture(runs):
    fine = runs[-1]
    drawn, axes = draw.figure(3, width=10.5, height=3.9)
    draw.curves(axes[0], [(f"dx {1000 * r['dx']:.0f} mm", r["mean"] / 1000, r["z"]) for r in runs], known=[("rho g (H - z)", np.linspace(0, DEPTH * GRAVITY, 100), np.linspace(DEPTH, 0, 100))],
                xlabel="pressure [kPa]", ylabel="height [m]", title="gauges, mean of 2 s")
    draw.convergence(axes[1], [r["dx"] for r in runs], {"profile": [r["profile"] for r in runs], "floor's noise": [r["noise"] for r in runs], "offset / H": [max(1e-5, abs(r["offset"]) * r["dx"] / DEPTH) for r in runs]})
    state = fine["state"]
    draw.particles(axes[2], state.x, state.p / 1000, fine["dx"], label="pressure [kPa]", limits=(0, DENSITY * GRAVITY * DEPTH / 1000), box=((0, 0, 0), (WIDTH, WIDTH, 1.1 * DEPTH)))
    axes[2].set_title("particles, 4 s")
    return draw.save(drawn, "still", "pressure over height, errors over spacing, particles")


def row(r, note=""):
    return (f"{1000 * r['dx']:.0f}{note}", f"{r['n']:,}", percent(r["profile"]), percent(r["gauge_noise"]), small(r["floor"]), percent(r["noise"]), small(r["compression"]), percent(r["speed"]),
            f"{r['offset']:+.3f}", f"{r['iterations']:.1f}", f"{r['cpu']:.0f}")


def still():
    runs = [measure(layers) for layers in LAYERS]
    fine, sizes = runs[-1], [r["dx"] for r in runs]
    slope = {key: order(sizes, [r[key] for r in runs]) for key in ("profile", "noise", "gauge_noise")}
    rows = [row(r) for r in runs]
    rows.append(("order", "", shown(slope["profile"]), shown(slope["gauge_noise"]), "", shown(slope["noise"]), "", "", "", "", ""))
    tight = measure(LAYERS[1], "_tight", tolerance=1e-6, precision="double")
    rows.append(row(tight, ", 1e-6"))
    claim("still water, pressure profile", percent(fine["profile"]), shown(slope["profile"]), "2 %", fine["profile"] < 0.02)
    claim("still water, floor force over weight", small(fine["floor"]), "", "0.5 %", fine["floor"] < 0.005)
    claim("still water, noise of the floor force", percent(fine["noise"]), shown(slope["noise"]), "1 %", fine["noise"] < 0.01)
    claim("still water, mean compression", small(fine["compression"]), "", "1e-3", fine["compression"] < 1e-3)
    claim("still water, wetted surface", f"{fine['offset']:+.3f} dx", "", "0.1 dx", abs(fine["offset"]) < 0.1)
    return (STILL + "\n\n" + table(["dx, mm", "particles", "profile", "noise of a gauge", "floor force off by", "its noise", "compression", "rms speed / sqrt(gH)", "offset, dx", "applications a step", "cpu, s"], rows)
            + picture(runs))
