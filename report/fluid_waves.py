"""fluid_waves.py - section of the report on water that walls move: a piston in a wave tank."""

import math

import numpy as np

import draw
from flow import flow, order, percent, shown, tank, with_probes
from program import table, verdict
from sections import claim

DEPTH, LENGTH, FREQUENCY, STROKE, GRAVITY, TOP = 0.2, 3.0, 1.0, 0.04, 9.81, 0.4
GAUGES = (0.8, 1.0, 1.2)
LAYERS = (8, 12, 16)
END = 5.0
WINDOW = (3.0, 5.0)  # after the piston's start has passed, before the far wall answers: (2 x 3 - 1.2) m at the group's 0.93 m/s is 5.2 s

WAVES = """A piston at the end of a tank {length:g} m long, {depth:g} m deep and four spacings wide (periodic) moves by a sine of stroke S = {stroke:g} cm at {frequency:g} Hz, faded
in over one period; the wall xmin of the domain moves (`domain.moving`). Theory, linear: waves of length {wave:.3f} m ((2 pi f)^2 = g k tanh kd, kd = {kd:.3f}) and
height H = S 2(cosh 2kd - 1)/(sinh 2kd + 2kd) = {height:.2f} cm [Dean & Dalrymple 1984, eq. 6.25]. Gauges of the water's height at 0.8, 1 and 1.2 m, from {first:g} to {last:g} s, before the far
wall answers; H is twice the amplitude of the first harmonic, mean of the gauges, speed that of its phase from gauge to gauge. The second column is H in spacings: a wave
of two spacings is what a scene has that does not spend much on it."""


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


def measure(layers):
    dx = DEPTH / layers
    scene = tank((0, 0, 0), (LENGTH, 4 * dx, TOP), walls=("xmin", "xmax", "zmin"), periodic=("y",), fills={"water": {"min": [0, 0, 0], "max": [LENGTH, 4 * dx, DEPTH]}}, spacing=dx)
    scene["domain"].update(moving=["paddle"], paddle={"walls": ["xmin"], "translation": [STROKE / 2, 0, 0], "course": "sine", "frequency": FREQUENCY, "duration": 1 / FREQUENCY})
    gauges = {f"h{k}": {"at": [x, 2 * dx, 0], "quantity": "height"} for k, x in enumerate(GAUGES)}
    result = flow(f"wave_maker_{layers}", with_probes(scene, **gauges), end=END, output_every=0.02, fields_every=0.5)
    time = result.probes["time"]
    window = (time >= WINDOW[0]) & (time <= WINDOW[1])
    series = [result.probes[f"h{k}"] for k in range(len(GAUGES))]
    fits = [harmonic(time[window], s[window]) for s in series]
    turned = np.unwrap([np.angle(first) for first, _ in fits])
    speed = 2 * math.pi * FREQUENCY / abs(np.polyfit(GAUGES, turned, 1)[0])
    height = 2 * float(np.mean([abs(first) for first, _ in fits]))
    work = result.ledger["work_motion"]
    return {"dx": dx, "n": result.n, "cpu": result.cpu, "height": height, "speed": speed, "second": float(np.mean([s / abs(f) for f, s in fits])), "time": time, "series": series,
            "state": result.state(-1), "work": float(work[-1])}


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
    runs = [measure(layers) for layers in LAYERS]
    sizes, fine = [r["dx"] for r in runs], runs[-1]
    off = [abs(r["height"] / height - 1) for r in runs]
    speed = 2 * math.pi * FREQUENCY / k
    rows = [(f"{1000 * r['dx']:.1f}", f"{height / r['dx']:.1f}", f"{r['n']:,}", f"{100 * r['height']:.2f}", f"{100 * (r['height'] / height - 1):+.1f} %", f"{r['speed']:.3f}",
             f"{100 * (r['speed'] / speed - 1):+.1f} %", f"{r['second']:.2f}", f"{r['cpu']:.0f}") for r in runs]
    rows.append(("order", "", "", "", shown(order(sizes, off)), "", shown(order(sizes, [abs(r["speed"] / speed - 1) for r in runs])), "", ""))
    claim("waves of a piston, height against linear theory", percent(off[-1]), shown(order(sizes, off)), "10 %", off[-1] < 0.1)
    claim("waves of a piston, speed", percent(abs(fine["speed"] / speed - 1)), "", "3 %", abs(fine["speed"] / speed - 1) < 0.03)
    text = WAVES.format(length=LENGTH, depth=DEPTH, stroke=100 * STROKE, frequency=FREQUENCY, wave=2 * math.pi / k, kd=k * DEPTH, height=100 * height, first=WINDOW[0], last=WINDOW[1])
    within = verdict(off[-1] < 0.1 and abs(fine["speed"] / speed - 1) < 0.03)
    return (text + "\n\n" + table(["dx, mm", "H / dx", "particles", "H, cm", "off by", "speed, m/s", "off by", "second harmonic over first", "cpu, s"], rows)
            + f"\nHeight within 10 % and speed within 3 % at the finest spacing: {within}.\n" + picture(runs, k, height))
