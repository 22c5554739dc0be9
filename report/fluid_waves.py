"""fluid_waves.py - sections of the report on what moves by prescription: a piston in a wave tank, tanks that are accelerated or turn."""

import math

import numpy as np

import draw
from flow import flow, order, percent, shown, tank, with_probes
from program import table, verdict
from sections import claim

DEPTH, LENGTH, FREQUENCY, STROKE, GRAVITY, TOP = 0.2, 3.0, 1.0, 0.04, 9.81, 0.4
GAUGES = (0.8, 1.0, 1.2)
LAYERS = (8, 16, 24)
DAMPING = 3  # the default of sph.noise_damping
END = 5.0
WINDOW = (3.0, 5.0)  # after the piston's start has passed, before the far wall answers: (2 x 3 - 1.2) m at the group's 0.93 m/s is 5.2 s

WAVES = """A piston at the end of a tank {length:g} m long, {depth:g} m deep and four spacings wide (periodic) moves by a sine of stroke S = {stroke:g} cm at {frequency:g} Hz, faded
in over one period; the wall xmin of the domain moves (`domain.moving`). Theory, linear: waves of length {wave:.3f} m ((2 pi f)^2 = g k tanh kd, kd = {kd:.3f}) and
height H = S 2(cosh 2kd - 1)/(sinh 2kd + 2kd) = {height:.2f} cm [Dean & Dalrymple 1984, eq. 6.25]. Gauges of the water's height at 0.8, 1 and 1.2 m, from {first:g} to {last:g} s, before the far
wall answers; H is twice the amplitude of the first harmonic, mean of the gauges, speed that of its phase from gauge to gauge. The wave loses
height on its way: the loss in a metre is that between the first and the last gauge. Rows are without the noise filter (`noise_damping: 0`), which takes its part of a wave
near the surface, and one with its default."""


def theory():
    """wave number [1/m] and height [m] of linear theory"""
    deep = (2 * math.pi * FREQUENCY) ** 2 / GRAVITY
    k = deep
    for _ in range(200):
        k = 0.5 * (k + deep / math.tanh(k * DEPTH))
    kd = k * DEPTH
    return k, STROKE * 2 * (math.cosh(2 * kd) - 1) / (math.sinh(2 * kd) + 2 * kd)


def harmonic(time, value):
    """complex amplitude of the first harmonic in the window, by least squares beside a mean, a trend and the second"""
    w = 2 * math.pi * FREQUENCY
    columns = [np.ones_like(time), time - time.mean(), np.cos(w * time), np.sin(w * time), np.cos(2 * w * time), np.sin(2 * w * time)]
    fit = np.linalg.lstsq(np.stack(columns, axis=1), value, rcond=None)[0]
    return complex(fit[2], -fit[3]), math.hypot(fit[4], fit[5])


def measure(layers, damping=0):
    dx = DEPTH / layers
    scene = tank((0, 0, 0), (LENGTH, 4 * dx, TOP), walls=("xmin", "xmax", "zmin"), periodic=("y",), fills={"water": {"min": [0, 0, 0], "max": [LENGTH, 4 * dx, DEPTH]}}, spacing=dx, noise_damping=damping)
    scene["domain"].update(moving=["paddle"], paddle={"walls": ["xmin"], "translation": [STROKE / 2, 0, 0], "course": "sine", "frequency": FREQUENCY, "duration": 1 / FREQUENCY})
    gauges = {f"h{k}": {"at": [x, 2 * dx, 0], "quantity": "height"} for k, x in enumerate(GAUGES)}
    result = flow(f"wave_maker_{layers}_{damping}", with_probes(scene, **gauges), end=END, output_every=0.02, fields_every=0.5)
    time = result.probes["time"]
    window = (time >= WINDOW[0]) & (time <= WINDOW[1])
    series = [result.probes[f"h{k}"] for k in range(len(GAUGES))]
    fits = [harmonic(time[window], s[window]) for s in series]
    turned = np.unwrap([np.angle(first) for first, _ in fits])
    speed = 2 * math.pi * FREQUENCY / abs(np.polyfit(GAUGES, turned, 1)[0])
    height = 2 * float(np.mean([abs(first) for first, _ in fits]))
    loss = 1 - (abs(fits[-1][0]) / abs(fits[0][0])) ** (1 / (GAUGES[-1] - GAUGES[0]))
    return {"layers": layers, "damping": damping, "loss": loss, "dx": dx, "n": result.n, "cpu": result.cpu, "height": height, "speed": speed, "second": float(np.mean([s / abs(f) for f, s in fits])), "time": time, "series": series,
            "state": result.state(-1)}


def picture(runs, k, height):
    fine = runs[-1]
    drawn, axes = draw.figure(1, rows=2, width=10.0, height=6.0)
    axes = np.ravel(axes)
    time = np.linspace(WINDOW[0], WINDOW[1], 200)
    window = (fine["time"] >= WINDOW[0]) & (fine["time"] <= WINDOW[1])
    angle = np.angle(harmonic(fine["time"][window], fine["series"][-1][window])[0])
    theory_curve = ("linear theory, phase fitted", time, 50 * height * np.cos(2 * math.pi * FREQUENCY * time + angle))
    mean = [r["series"][-1][(r["time"] >= WINDOW[0])].mean() for r in runs]
    draw.curves(axes[0], [(f"dx {1000 * r['dx']:.1f} mm", r["time"], 100 * (r["series"][-1] - m)) for r, m in zip(runs, mean)], known=[theory_curve],
                xlabel="time [s]", ylabel="height less its mean [cm]", title=f"gauge at {GAUGES[-1]:g} m")
    state = fine["state"]
    draw.particles(axes[1], state.x, state.p / 1000, fine["dx"], label="pressure [kPa]", limits=(0, 1000 * GRAVITY * DEPTH / 1000), box=((0, 0, 0), (LENGTH, 4 * fine["dx"], 1.5 * DEPTH)))
    axes[1].set_title(f"particles, {END:g} s")
    return draw.save(drawn, "wave_maker", "the water's height at a gauge against linear theory; particles coloured by pressure")


def wave_maker():
    k, height = theory()
    runs, filtered = [measure(layers) for layers in LAYERS], measure(LAYERS[-2], DAMPING)
    sizes, fine = [r["dx"] for r in runs], runs[-1]
    off = [abs(r["height"] / height - 1) for r in runs]
    speed = 2 * math.pi * FREQUENCY / k
    rows = [(f"{1000 * r['dx']:.1f}" + (", filter" if r["damping"] else ""), f"{height / r['dx']:.1f}", f"{r['n']:,}", f"{100 * r['height']:.2f}", f"{100 * (r['height'] / height - 1):+.1f} %", f"{r['speed']:.3f}",
             f"{100 * (r['speed'] / speed - 1):+.1f} %", f"{100 * r['loss']:.0f} %", f"{r['second']:.2f}", f"{r['cpu']:.0f}") for r in (*runs, filtered)]
    rows.append(("order", "", "", "", shown(order(sizes, off)), "", "", "", "", ""))
    claim("waves of a piston, height against linear theory", percent(off[-1]), shown(order(sizes, off)), "10 %", off[-1] < 0.1)
    claim("waves of a piston, speed", percent(abs(fine["speed"] / speed - 1)), "", "3 %", abs(fine["speed"] / speed - 1) < 0.03)
    text = WAVES.format(length=LENGTH, depth=DEPTH, stroke=100 * STROKE, frequency=FREQUENCY, wave=2 * math.pi / k, kd=k * DEPTH, height=100 * height, first=WINDOW[0], last=WINDOW[1])
    within = verdict(off[-1] < 0.1 and abs(fine["speed"] / speed - 1) < 0.03)
    return (text + "\n\n" + table(["dx, mm", "H / dx", "particles", "H, cm", "off by", "speed, m/s", "off by", "loss in a metre", "second harmonic over first", "cpu, s"], rows)
            + f"\nHeight within 10 % and speed within 3 % at the finest spacing: {within}.\n" + picture(runs, k, height))


TANKS = """Two tanks that have been moving for ever (section `frame`), the water starts level and at rest in them, its viscosity (5 Pa s, walls slip) brings it to rest; gauges and
forces are means of the last second of five. Accelerated: 0.4 m long, 0.15 m of water, a = {a:g} m/s^2 along x: the surface tilts by atan(a/g), the walls push with m a, the
right wall carries (rho g/2) h^2 of its own depth h. Turning: a box 0.3 x 0.3 m, 0.12 m of water, {omega:g} rad/s about its middle: the surface is a paraboloid, at r = 0.1 m
omega^2 r^2/2g above the middle. Errors of heights are in spacings."""
ACCELERATION, OMEGA = 2.0, 6.0
TANK_SPACINGS = (0.02, 0.0125, 0.01)


def late(result, name):
    time = result.probes["time"]
    return float(np.mean(result.probes[name][time > time[-1] - 1]))


def accelerated(dx):
    length, depth = 0.4, 0.15
    scene = tank((0, 0, 0), (length, 4 * dx, 0.35), walls=("xmin", "xmax", "zmin"), periodic=("y",), fills={"water": {"min": [0, 0, 0], "max": [length, 4 * dx, depth]}}, spacing=dx, viscosity=5)
    scene["domain"]["slip"] = ["xmin", "xmax", "zmin"]
    scene["frame"] = {"translation": [0.5 * ACCELERATION, 0, 0], "course": "quadratic", "duration": 1, "start": -1}
    at = np.linspace(0.06, length - 0.06, 5)
    gauges = {f"h{k}": {"at": [x, 2 * dx, 0], "quantity": "height"} for k, x in enumerate(at)}
    result = flow(f"tank_accelerated_{1000 * dx:.0f}", with_probes(scene, left={"body": "xmin", "quantity": "force"}, right={"body": "xmax", "quantity": "force"}, **gauges), end=5, output_every=0.02, fields_every=1)
    slope = np.polyfit(at, [late(result, f"h{k}") for k in range(5)], 1)[0]
    mass = result.n * 1000 * dx**3  # the lattice has not always the depth that was asked for
    low = mass / (1000 * length * 4 * dx) - 0.5 * length * ACCELERATION / GRAVITY
    right = 0.5 * 1000 * GRAVITY * low**2 * 4 * dx
    return {"n": result.n, "cpu": result.cpu, "tilt": math.degrees(math.atan(-slope)), "push": -(late(result, "left_x") + late(result, "right_x")) / (mass * ACCELERATION) - 1,
            "right": late(result, "right_x") / right - 1, "state": result.state(-1)}


def turning(dx):
    width, depth = 0.3, 0.12
    scene = tank((0, 0, 0), (width, width, 0.35), fills={"water": {"min": [0, 0, 0], "max": [width, width, depth]}}, spacing=dx, viscosity=5)
    scene["domain"]["slip"] = ["xmin", "xmax", "ymin", "ymax", "zmin"]
    scene["frame"] = {"angle": math.degrees(OMEGA), "axis": [0, 0, 1], "point": [width / 2, width / 2, 0], "course": "linear", "duration": 1, "start": -1}
    places = {"middle": (0.15, 0.15), "east": (0.25, 0.15), "west": (0.05, 0.15), "north": (0.15, 0.25), "south": (0.15, 0.05)}
    result = flow(f"tank_turning_{1000 * dx:.0f}", with_probes(scene, **{k: {"at": [x, y, 0], "quantity": "height"} for k, (x, y) in places.items()}), end=5, output_every=0.02, fields_every=1)
    rise = float(np.mean([late(result, k) for k in ("east", "west", "north", "south")])) - late(result, "middle")
    return {"n": result.n, "cpu": result.cpu, "rise": rise, "state": result.state(-1)}


def tanks_picture(line, dish, dx):
    drawn, axes = draw.figure(2, width=10.0, height=3.4)
    for ax, run, title in ((axes[0], line, "accelerated"), (axes[1], dish, "turning, middle slice")):
        state = run["state"]
        draw.particles(ax, state.x, state.p / 1000, dx, label="pressure [kPa]", limits=(0, 2.5))
        ax.set_title(title)
    x = np.array([0, 0.4])
    axes[0].plot(x, 0.15 - (x - 0.2) * ACCELERATION / GRAVITY, color="black", linewidth=1)
    r = np.linspace(-0.15, 0.15, 50)
    bottom = 0.12 - OMEGA**2 / (2 * GRAVITY) * 2 * 0.15**2 / 3  # the mean of r^2 over the square is 2 (w/2)^2 / 3
    axes[1].plot(0.15 + r, bottom + OMEGA**2 * r**2 / (2 * GRAVITY), color="black", linewidth=1)
    return draw.save(drawn, "moving_tank", "water at rest in an accelerated and in a turning tank; lines: the exact surfaces")


def moving_tank():
    tilt, rise = math.degrees(math.atan(ACCELERATION / GRAVITY)), OMEGA**2 * 0.1**2 / (2 * GRAVITY)
    lines, dishes = [accelerated(dx) for dx in TANK_SPACINGS], [turning(dx) for dx in TANK_SPACINGS]
    rows = [(f"{1000 * dx:.1f}", f"{a['n']:,}", f"{a['tilt']:.2f}", f"{a['tilt'] - tilt:+.2f}", f"{100 * a['push']:+.2f} %", f"{100 * a['right']:+.2f} %", f"{d['n']:,}", f"{100 * d['rise']:.2f}",
             f"{(d['rise'] - rise) / dx:+.2f}", f"{a['cpu'] + d['cpu']:.0f}") for dx, a, d in zip(TANK_SPACINGS, lines, dishes)]
    rows.append(("exact", "", f"{tilt:.2f}", "", "", "", "", f"{100 * rise:.2f}", "", ""))
    fine, dish, dx = lines[-1], dishes[-1], TANK_SPACINGS[-1]
    bars = (abs(fine["tilt"] - tilt) < 0.5, abs(fine["push"]) < 0.01, abs(fine["right"]) < 0.05, abs(dish["rise"] - rise) < 0.25 * dx)
    claim("accelerated tank, tilt of the surface", f"{fine['tilt'] - tilt:+.2f} deg", "", "0.5 deg", bars[0])
    claim("accelerated tank, force of the walls over m a", percent(abs(fine["push"])), "", "1 %", bars[1])
    claim("turning tank, height of the paraboloid", f"{(dish['rise'] - rise) / dx:+.2f} dx", "", "0.25 dx", bars[3])
    return (TANKS.format(a=ACCELERATION, omega=OMEGA) + "\n\n"
            + table(["dx, mm", "particles", "tilt, deg", "off by", "walls' force, off by", "right wall, off by", "particles", "rise at 0.1 m, cm", "off by, dx", "cpu, s"], rows)
            + f"\nTilt within 0.5 degrees, walls' force within 1 %, right wall within 5 %, paraboloid within a quarter of a spacing, at the finest spacing: {verdict(all(bars))}.\n"
            + tanks_picture(fine, dish, dx))
