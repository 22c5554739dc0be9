"""draw.py - pictures of the report: curves against data, particles of a slice. All in the look of `byssus plot`, saved small."""

import sys

import numpy as np

from program import NAME, ROOT, say

sys.path.append(str(ROOT / "src" / "plot"))
import style  # noqa: E402: a module of src/plot
from picture import WATER  # noqa: E402

import matplotlib.pyplot as plt  # noqa: E402: after style has chosen how to draw

PICTURES = ROOT / "docs" / "pictures"


def figure(columns=1, rows=1, width=9.0, height=4.2, **settings):
    """a figure with axes beside each other; axes as an array unless there is one"""
    return plt.subplots(rows, columns, figsize=(width, height), dpi=90, layout="constrained", **settings)


def save(drawn, name, text=""):
    """into docs/pictures/REPORT_NAME.png, in 128 colours; the markdown that shows it"""
    from PIL import Image

    path = PICTURES / f"{NAME}_{name}.png"
    PICTURES.mkdir(parents=True, exist_ok=True)
    style.save(drawn, str(path))
    with Image.open(path) as image:
        small = image.convert("RGB").quantize(128)
    small.save(path, optimize=True)
    say(f"{path}: {path.stat().st_size // 1024} kB")
    return f"\n![{text or name}](../pictures/{path.name})\n"


def curves(axes, lines, known=(), xlabel="", ylabel="", title="", legend=True):
    """lines: (label, x, y) ours, from coarse to fine, the finest darkest; known: (label, x, y) or (label, x, y, error) data, as points (many: a line)"""
    for k, (label, x, y) in enumerate(lines):
        last = k == len(lines) - 1
        axes.plot(x, y, color=style.COLOURS[0] if last else style.COLOURS[1 + k % 7], alpha=1 if last else 0.75, linewidth=1.9 if last else 1.3, label=label, zorder=2 + last)
    for k, (label, x, y, *error) in enumerate(known):
        if len(x) > 80:
            axes.plot(x, y, color=style.TEXT, linewidth=1.1, linestyle=("-", "--", ":")[k % 3], label=label, zorder=1.5)
        else:
            axes.errorbar(x, y, yerr=error[0] if error else None, color=style.TEXT, marker="os^Dv"[k % 5], markersize=4.5, markerfacecolor="white", linestyle="none", label=label, zorder=4)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    if title:
        axes.set_title(title)
    if legend and (lines or known):
        axes.legend(fontsize=9)


def convergence(axes, sizes, errors, xlabel="dx [m]", title="error", slopes=(1, 2)):
    """errors: label -> values; both axes logarithmic, with triangles of the named orders"""
    for k, (label, values) in enumerate(errors.items()):
        axes.loglog(sizes, values, marker="o", markersize=4, color=style.COLOURS[k % 8], label=label)
    low = min(v for values in errors.values() for v in values)
    for slope in slopes:
        axes.loglog(sizes, low * (np.asarray(sizes) / min(sizes)) ** slope, color=style.MUTED, linewidth=0.9, linestyle=(0, (4, 4)))
        axes.annotate(f"order {slope}", (max(sizes), low * (max(sizes) / min(sizes)) ** slope), fontsize=8, color=style.MUTED, ha="right")
    axes.set_xticks(sizes, [f"{size:.3g}" for size in sizes])
    axes.minorticks_off()
    axes.set_xlabel(xlabel)
    axes.set_title(title)
    axes.legend(fontsize=9)


def particles(axes, x, values, spacing, across=1, slab=None, label="", limits=None, box=None, marks=(), colours=WATER):
    """particles of a slice as dots of their size, coloured; across: axis seen along; slab: (from, to) on it, none: the middle 1.5 spacings;
    box: (low, high) corners of the tank to draw; limits: of the colours. The dots, for a colour bar"""
    x = np.asarray(x)
    u, w = [a for a in range(3) if a != across]
    if slab is None:
        middle = 0.5 * (x[:, across].min() + x[:, across].max())
        slab = (middle - 0.75 * spacing, middle + 0.75 * spacing)
    seen = (x[:, across] >= slab[0]) & (x[:, across] <= slab[1])
    if box is not None:
        (a, c), (b, d) = (box[0][u], box[0][w]), (box[1][u], box[1][w])
        axes.plot([a, b, b, a, a], [c, c, d, d, c], color=style.MUTED, linewidth=1)
        axes.set_xlim(a - 0.02 * (b - a), b + 0.02 * (b - a))
        axes.set_ylim(c - 0.02 * (d - c), d + 0.02 * (d - c))
    axes.set_aspect("equal")
    axes.grid(False)
    axes.figure.draw_without_rendering()
    size = 72 / axes.figure.dpi * 0.95 * spacing * abs(axes.transData.transform((1, 0))[0] - axes.transData.transform((0, 0))[0])
    low, high = limits if limits else (np.min(values[seen]), np.max(values[seen])) if np.any(seen) else (0, 1)
    dots = axes.scatter(x[seen, u], x[seen, w], s=max(0.3, size) ** 2, c=values[seen], cmap=colours, vmin=low, vmax=high, linewidths=0)
    for at in marks:
        axes.plot(at[u], at[w], marker="x", color=style.COLOURS[1], markersize=5)
    if label:
        bar = axes.figure.colorbar(dots, ax=axes, shrink=0.8, pad=0.01)
        bar.outline.set_visible(False)
        bar.set_label(label, fontsize=9)
        bar.ax.tick_params(labelsize=8, length=0)
    return dots
