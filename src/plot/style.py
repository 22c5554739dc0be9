"""style.py - how all pictures look."""

import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TEXT, MUTED, GRID = "#22303c", "#66727d", "#e3e7ea"
COLOURS = ["#1763a6", "#d2562f", "#2a9d8f", "#8a5fb0", "#c99a1e", "#5b6770", "#c2477f", "#5f9e3e"]  # apart also for the colour-blind

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 11, "text.color": TEXT, "axes.labelcolor": TEXT, "axes.edgecolor": "#9aa5ae",
    "axes.titlesize": 12.5, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.color": GRID, "grid.linewidth": 0.9, "axes.axisbelow": True, "xtick.color": MUTED, "ytick.color": MUTED,
    "lines.linewidth": 1.9, "legend.frameon": False, "legend.fontsize": 10, "figure.facecolor": "white",
    "axes.prop_cycle": matplotlib.cycler(color=COLOURS), "axes.formatter.limits": (-4, 5), "axes.formatter.useoffset": False,
})


class WriteError(Exception):
    """A picture or page could not be written; the message is the whole line."""


def save(figure, path):
    """write a figure under a new name, then rename"""
    write(path, lambda name: figure.savefig(name, format="png"))
    plt.close(figure)


def write(path, body):
    name = path + ".new"
    try:
        body(name)
        os.replace(name, path)
    except OSError as error:
        if os.path.exists(name):
            os.unlink(name)
        raise WriteError(f"cannot write {path}: {error.strerror or error}") from None
