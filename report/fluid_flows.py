"""fluid_flows.py - sections of the report on water that enters and leaves: an open channel, a viscous channel, a tap, and the start from rest."""

import numpy as np

import draw
from flow import flow, percent, rms, shown, order, tank, with_probes
from sections import claim
from program import table, verdict

GRAVITY, DENSITY = 9.81, 1000.0

OPEN = """Open: a channel 1.2 m long and 0.24 m deep without friction, water entering at 0.5 m/s and leaving against still water's pressure up to
0.24 m, ten times its own volume long. In and out: volume that has entered and left over the second half of the run, out over in less 1.
Particles: their drift over that half, over their number. Level: mean height at three gauges over the last quarter. Viscous: a plane channel 2 m
long between two walls, Reynolds number 10 with its mean speed and height, a parabola prescribed at its entry, pressure 0 at its exit. Profile: rms distance
of u(z) between 0.8 and 1.6 m from that parabola, over its peak, in the second half of the run."""

CHANNEL = {"length": 1.2, "depth": 0.24, "speed": 0.5}
END = 10 * CHANNEL["length"] / CHANNEL["speed"]


def channel(layers):
    """open channel with a free surface at one resolution"""
    dx, length, depth, speed = CHANNEL["depth"] / layers, CHANNEL["length"], CHANNEL["depth"], CHANNEL["speed"]
    width = max(4.0 * dx, 0.12)
    scene = tank((0, 0, 0), (length, width, 0.5), walls=("zmin",), periodic=("y",), spacing=dx, density=DENSITY,
                 fills={"water": {"min": [0, 0, 0], "max": [length, width, depth], "velocity": [speed, 0, 0]}})
    scene["sph"].update(inflow=["entry"], entry={"side": "xmin", "max": [0, 1, depth], "velocity": speed}, outflow=["exit"], exit={"side": "xmax", "level": depth})
    gauges = {f"h{k}": {"at": [(0.25 + 0.25 * k) * length, width / 2, 0], "quantity": "height"} for k in range(3)}
    result = flow(f"open_channel_{layers}", with_probes(scene, **gauges), end=END, output_every=0.12, fields_every=END / 10)
    late = result.ledger["time"] >= END / 2
    entered, left, count, when = (result.ledger[name][late] for name in ("fluid_entered", "fluid_left", "fluid_particles", "time"))
    last = result.probes["time"] > 0.75 * END
    return {
        "dx": dx, "n": int(count.mean()), "balance": (left[-1] - left[0]) / (entered[-1] - entered[0]) - 1.0, "drift": np.polyfit(when, count, 1)[0] * (when[-1] - when[0]) / count.mean(),
        "asked": (entered[-1] - entered[0]) / (speed * depth * width * (when[-1] - when[0])) - 1.0, "level": float(np.mean([result.probes[f"h{k}"][last].mean() for k in range(3)])),
        "cpu": result.cpu, "ledger": result.ledger, "state": result.state(-1), "width": width}


def viscous(layers):
    """plane Poiseuille flow from an inflow to an outflow at one resolution"""
    height, length, speed = 0.4, 2.0, 0.5
    dx, width, end = height / layers, max(0.2, 4.0 * height / layers), 6.0
    scene = tank((0, 0, 0), (length, width, height), walls=("zmin", "zmax"), periodic=("y",), gravity=(0, 0, 0), spacing=dx, density=DENSITY, viscosity=DENSITY * speed * height / 10.0,
                 fills={"water": {"min": [0, 0, 0], "max": [length, width, height], "velocity": [speed, 0, 0]}})
    scene["sph"].update(inflow=["entry"], entry={"side": "xmin", "velocity": speed, "profile": "parabolic"}, outflow=["exit"], exit={"side": "xmax"})
    result = flow(f"viscous_channel_{layers}", scene, end=end, output_every=end / 20)
    z, u = [], []
    for state in result.states():
        inside = (state.x[:, 0] > 0.8) & (state.x[:, 0] < 1.6)
        if state.time < end / 2:
            continue
        z += list(state.x[inside, 2])
        u += list(state.v[inside, 0])
    z, u = np.array(z), np.array(u)
    exact = 6.0 * speed * z / height * (1.0 - z / height)
    late = result.ledger["time"] >= end / 2
    entered, left = (result.ledger[name][late] for name in ("fluid_entered", "fluid_left"))
    return {"dx": dx, "n": result.n, "profile": rms(u - exact) / (1.5 * speed), "z": z, "u": u, "balance": (left[-1] - left[0]) / (entered[-1] - entered[0]) - 1.0, "cpu": result.cpu,
            "height": height, "speed": speed}


def open_channel():
    runs, tubes = [channel(layers) for layers in (6, 8)], [viscous(layers) for layers in (8, 12)]
    rows = [("open", f"{1000 * r['dx']:.0f}", f"{r['n']:,}", percent(r["asked"]), percent(r["balance"]), percent(r["drift"]), f"{r['level']:.3f}", "", f"{r['cpu']:.0f}") for r in runs]
    rows += [("viscous", f"{1000 * r['dx']:.0f}", f"{r['n']:,}", "", percent(r["balance"]), "", "", percent(r["profile"]), f"{r['cpu']:.0f}") for r in tubes]
    fine, tube = runs[-1], tubes[-1]
    slope = order([r["dx"] for r in tubes], [r["profile"] for r in tubes])
    claim("open channel, volume out over in", percent(fine["balance"]), "", "2 %", abs(fine["balance"]) < 0.02)
    claim("open channel, drift of the number of particles over five flow-throughs", percent(fine["drift"]), "", "2 %", abs(fine["drift"]) < 0.02)
    claim("open channel, level", f"{(fine['level'] - CHANNEL['depth']) / fine['dx']:+.2f} dx", "", "0.5 dx", abs(fine["level"] - CHANNEL["depth"]) < 0.5 * fine["dx"])
    claim("channel flow from inflow to outflow, profile", percent(tube["profile"]), shown(slope))
    drawn, axes = draw.figure(3, width=11, height=3.8)
    ledger = fine["ledger"]
    draw.curves(axes[0], [("left", ledger["time"], 1000 * ledger["fluid_left"]), ("entered", ledger["time"], 1000 * ledger["fluid_entered"])], xlabel="time [s]", ylabel="volume [l]", title="open channel")
    at = np.linspace(0, tube["height"], 100)
    axes[1].plot(tube["u"][::7], tube["z"][::7], ".", markersize=2, alpha=0.5)
    axes[1].plot(6.0 * tube["speed"] * at / tube["height"] * (1.0 - at / tube["height"]), at, color="black", linewidth=1)
    axes[1].set(xlabel="u [m/s]", ylabel="z [m]", title="viscous channel: particles, parabola")
    draw.particles(axes[2], fine["state"].x, np.linalg.norm(fine["state"].v, axis=1), fine["dx"], label="speed [m/s]")
    axes[2].set_title(f"open channel after {END:.0f} s")
    return (OPEN + "\n\n" + table(["channel", "dx, mm", "particles", "in over what is asked", "out over in", "drift of particles", "level, m", "profile", "cpu, s"], rows)
            + draw.save(drawn, "open_channel", "volumes over time, profile of the viscous channel, particles of the open one"))


SETTLE = """A tank 0.24 x 0.24 m filled 0.4 m deep from the lattice (packed to rest density, as every run), and the same with `sph.settle: true`. Speed: largest
of any particle in the first 0.2 s, over sqrt(gH). Force: largest distance of the floor's force from the weight in that time. Late: rms speed over
sqrt(gH) and rms of the floor force's noise between 1 and 2 s. Weaker noise filters are tried from the settled start; the default is 3."""


def start(name, settled, damping):
    dx, depth, width = 0.02, 0.4, 0.24
    scene = tank((0, 0, 0), (width, width, 0.6), spacing=dx, density=DENSITY, settle=settled, noise_damping=damping, fills={"water": {"min": [0, 0, 0], "max": [width, width, depth]}})
    result = flow(f"settle_{name}", with_probes(scene, floor={"body": "zmin", "quantity": "force"}), end=2.0, output_every=0.005, fields_every=2.0)
    time, scale = result.ledger["time"], np.sqrt(GRAVITY * depth)
    force = -result.probes["floor_z"] / (DENSITY * GRAVITY * depth * width**2)
    mass = force[time > 1].mean()  # a particle weighs what the kernel's sum says, not rho dx^3
    early, late = (time > 0) & (time <= 0.2), time > 1
    return {"name": name, "time": time, "speed_curve": result.ledger["fluid_speed_max"] / scale, "force_curve": force / mass, "speed": (result.ledger["fluid_speed_max"] / scale)[early].max(),
            "force": np.abs(force[early] / mass - 1).max(), "late": rms(result.ledger["fluid_speed_rms"][late]) / scale, "noise": np.std(force[late]) / mass, "iterations": result.iterations, "cpu": result.cpu}


def settle():
    runs = [start("lattice", False, 3), start("settled", True, 3), start("settled, filter 1", True, 1), start("settled, filter 0", True, 0)]
    rows = [(r["name"], percent(r["speed"], 1), percent(r["force"]), percent(r["late"]), percent(r["noise"]), f"{r['iterations']:.1f}", f"{r['cpu']:.0f}") for r in runs]
    raw, quiet = runs[0], runs[1]
    claim("settled start, largest speed in the first 0.2 s over sqrt(gH)", f"{percent(quiet['speed'], 1)} (lattice {percent(raw['speed'], 1)})")
    claim("settled start, floor force in the first 0.2 s", f"{percent(quiet['force'])} (lattice {percent(raw['force'], 0)})", "", "2 %", quiet["force"] < 0.02)
    drawn, axes = draw.figure(2, width=9, height=3.6)
    draw.curves(axes[0], [(r["name"], r["time"], r["speed_curve"]) for r in (raw, quiet)], xlabel="time [s]", ylabel="largest speed / sqrt(gH)")
    draw.curves(axes[1], [(r["name"], r["time"], r["force_curve"]) for r in (raw, quiet)], xlabel="time [s]", ylabel="floor force / weight")
    for a in axes:
        a.set_xlim(0, 0.5)
    return SETTLE + "\n\n" + table(["start", "speed", "floor force off by", "late rms speed", "late noise of the force", "applications a step", "cpu, s"], rows) + draw.save(drawn, "settle", "speed and floor force in the first half second")


SOURCE = """A tap of 0.1 m diameter fills a tank 0.4 x 0.4 m with 0.032 m^3, 0.2 m, at 0.016 m^3/s. Entered: largest difference of the volume that has come
out from flow rate times time, in layers of the tap's columns (they all cross at once: half a layer is exact). Volume: that of all particles made, over what
was asked. Level: mean height at four gauges in the last half second."""


def source():
    rows, worst = [], []
    for dx in (0.04, 0.025):
        scene = tank((0, 0, 0), (0.4, 0.4, 0.7), spacing=dx, density=DENSITY, fills={})
        scene["sph"].update(sources=["tap"], tap={"center": [0.2, 0.2, 0.45], "direction": [0, 0, -1], "radius": 0.05, "flow_rate": 0.016, "volume": 0.032})
        del scene["sph"]["fill"]
        gauges = {f"h{k}": {"at": [0.1 + 0.2 * (k % 2), 0.1 + 0.2 * (k // 2), 0], "quantity": "height"} for k in range(4)}
        result = flow(f"source_{1000 * dx:.0f}", with_probes(scene, **gauges), end=4.0, output_every=0.02, fields_every=1.0)
        time, entered = result.ledger["time"], result.ledger["fluid_entered"]
        layer = np.max(np.diff(np.unique(entered)))
        running = time < 1.8
        off = np.max(np.abs(entered[running] - 0.016 * time[running])) / layer
        level = np.mean([result.probes[f"h{k}"][time > 3.5].mean() for k in range(4)])
        volume = result.n * dx**3
        worst.append((off, volume / 0.032 - 1, (level - 0.2) / dx))
        rows.append((f"{1000 * dx:.0f}", f"{result.n:,}", f"{off:.2f}", percent(volume / 0.032 - 1), f"{level:.4f}", f"{(level - 0.2) / dx:+.2f}", f"{result.cpu:.0f}"))
    off, volume, level = worst[-1]
    claim("tap, volume entered against flow rate times time", f"{off:.2f} layers", "", "0.55", off < 0.55)
    claim("tap, level of the tank", f"{level:+.2f} dx", "", "0.5 dx", abs(level) < 0.5)
    return SOURCE + "\n\n" + table(["dx, mm", "particles", "entered, layers", "volume", "level, m", "off, dx", "cpu, s"], rows) + f"\nAll bars held at the finer spacing: {verdict(off < 0.55 and abs(level) < 0.5)}.\n"
