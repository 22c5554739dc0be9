"""verification.py - the picture of `byssus verify`: where explicit and implicit solid differ, how the difference falls, what rings."""

import os

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm

import render
import style
from run import Series, Table
from style import COLOURS

DIFFERENCE = plt.get_cmap("viridis")


def is_verification(run):
    return run.summary.get("command") == "verify"


def read_series(run, name):
    path = os.path.join(run.directory, name + ".vtkhdf")
    return Series(path) if os.path.exists(path) else None


def read_table(run, name):
    path = os.path.join(run.directory, name + ".csv")
    return Table(path) if os.path.exists(path) else None


def view_of(points, up=np.array([0.0, 0.0, 1.0])):
    """direction of the view: along the shorter horizontal side, a little from the side and from above"""
    size = points.max(axis=0) - points.min(axis=0)
    along = np.eye(3)[int(np.argmax(size[:2]))]
    into = np.cross(up, along)
    turn, tilt = np.radians(24), np.radians(19)
    return np.cos(tilt) * (np.cos(turn) * into - np.sin(turn) * along) - np.sin(tilt) * up


def render_body(points, triangles, colours, width, height):
    """a shaded body that fills the picture"""
    low, high = points.min(axis=0), points.max(axis=0)
    corners = np.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    up = np.array([0.0, 0.0, 1.0])
    camera = render.Camera(corners, view_of(points), up, width, height)
    light = render.LIGHT @ camera.axes + 0.6 * up
    shadow = render.Shadow(corners, light / np.linalg.norm(light), up + 1e-3 * camera.axes[0])
    layer = render.Layer(camera)
    layer.triangles(points, triangles, colours, render.corner_normals(points, triangles), gloss=0.15, edges=0.13)
    size = float(np.linalg.norm(high - low))
    return render.compose(layer, None, size, shadow, 0.02 * size)


def draw_difference(axes, figure, series, title):
    """the deformed body, coloured by the distance of its nodes in the two solutions"""
    last = series.n_steps - 1
    points, triangles = series.points(last), series.triangles()
    size = np.linalg.norm(series.field("displacement", last), axis=1).max() or 1.0
    difference = np.linalg.norm(series.field("difference", last), axis=1) / size
    top = max(difference.max(), 1e-15)
    scale = LogNorm(1e-3 * top, top)
    colours = DIFFERENCE(scale(np.maximum(difference, 1e-3 * top)))[:, :3]
    axes.imshow(render_body(points, triangles, colours, 760, 520), interpolation="none")
    axes.axis("off")
    axes.set_title(title)
    bar = figure.colorbar(ScalarMappable(scale, DIFFERENCE), ax=axes, orientation="horizontal", shrink=0.7, pad=0.02)
    bar.outline.set_visible(False)
    bar.set_label("distance of a node in the two solutions / largest displacement")


def draw_order(axes, dynamic):
    """difference over step, with the line of second order"""
    runs = sorted((value for key, value in dynamic.items() if key.startswith("explicit_")), key=lambda r: r["step"])
    steps, differences = np.array([r["step"] for r in runs]), np.array([r["difference_max"] for r in runs])
    axes.loglog(steps, differences, "o-", label=f"explicit, order {dynamic['order']:.2f}")
    axes.loglog(steps, differences[-1] * (steps / steps[-1]) ** 2, "--", color=style.MUTED, linewidth=1.2, label="second order")
    axes.axhline(dynamic["implicit"]["difference_max"], color=COLOURS[1], linewidth=1.2, linestyle=":", label="error of the implicit reference")
    axes.set_xlabel("step [s]")
    axes.set_title("largest difference / largest displacement")
    axes.legend()


def draw_history(axes, table):
    for column, label in enumerate("xyz"):
        axes.plot(table.time, table.get("implicit_" + label), color=COLOURS[column], label=label + ", implicit")
        axes.plot(table.time, table.get("explicit_" + label), "o", markersize=4, color=COLOURS[column], markerfacecolor="none", label=label + ", explicit")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("m")
    axes.set_title("displacement of the node that moves most")
    axes.legend(ncols=3, fontsize=8.5)


def draw_spectrum(axes, table, modes):
    """spectrum of the ringing explicit solid, and the frequencies of the eigenvalue problem"""
    signal = np.array([table.get("node_" + c) for c in "xyz"])
    window = np.hanning(signal.shape[1])
    step = table.time[1] - table.time[0]
    n = 8 * signal.shape[1]
    amplitude = np.sqrt(np.sum(np.abs(np.fft.rfft((signal - signal.mean(axis=1, keepdims=True)) * window, n)) ** 2, axis=0))
    frequency = np.fft.rfftfreq(n, step)
    known = [value["eigenvalue"] for key, value in modes.items() if isinstance(value, dict)]
    axes.semilogy(frequency, amplitude / amplitude.max(), label="ringing explicit solid")
    for k, f in enumerate(known):
        axes.axvline(f, color=COLOURS[1], linewidth=1, linestyle="--", label=None if k else "eigenvalue problem")
    axes.set_xlim(0, 1.25 * max(known))
    axes.set_ylim(1e-7, 3)
    axes.set_xlabel("frequency [Hz]")
    axes.set_title("spectrum")
    axes.legend()


def panels_of(run, name, entry):
    """functions that draw one panel each; they take axes and figure"""
    result = []
    for kind in ("static", "dynamic"):
        series = read_series(run, f"{name}_{kind}_explicit")
        if series is not None and kind in entry:
            title = f"{name}: " + ("equilibrium" if kind == "static" else f"after {series.times[-1]:.4g} s")
            result.append(lambda axes, figure, series=series, title=title: draw_difference(axes, figure, series, title))
    if "dynamic" in entry:
        result.append(lambda axes, figure: draw_order(axes, entry["dynamic"]))
        table = read_table(run, f"{name}_dynamic")
        if table is not None:
            result.append(lambda axes, figure: draw_history(axes, table))
    ringing = read_table(run, f"{name}_ringdown")
    if ringing is not None and "modes" in entry:
        result.append(lambda axes, figure: draw_spectrum(axes, ringing, entry["modes"]))
    return result


def draw_verification(run, path):
    bodies = run.summary.get("bodies") or {}
    panels = [panel for name, entry in bodies.items() for panel in panels_of(run, name, entry)]
    if not panels:
        return False
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(6.6 * columns if columns > 1 else 8.5, 4.9 * rows + 0.6), dpi=110, squeeze=False, layout="constrained")
    figure.suptitle(f"{run.name}: {run.summary.get('status', '')}", x=0.01, ha="left", fontsize=16, fontweight="bold")
    for extra in axes.ravel()[len(panels):]:
        extra.set_visible(False)
    for ax, panel in zip(axes.ravel(), panels):
        panel(ax, figure)
    style.save(figure, path)
    return True
