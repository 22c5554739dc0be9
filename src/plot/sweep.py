"""sweep.py - the picture and page of `byssus sweep`: speed against error, one point a run."""

import csv
import html
import os
import urllib.parse

import numpy as np

import charts
import page
import style
from run import PlotError, parse_header
from style import COLOURS

MARKERS = "osD^vP*Xh"
RESULTS = "particles"  # the first column behind axes and status


def is_sweep(directory):
    return os.path.exists(os.path.join(directory, "sweep.csv"))


class Sweep:
    """sweep.csv: `axes` name -> texts, `columns` name -> numbers (nan: empty), a row each run"""

    def __init__(self, directory):
        path = os.path.join(directory, "sweep.csv")
        try:
            with open(path, newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise PlotError(f"{path} cannot be read: {error}") from None
        names = [parse_header(cell)[0] for cell in rows[0]] if rows else []
        if names[:1] != ["run"] or RESULTS not in names or "status" not in names or any(len(row) != len(names) for row in rows):
            raise PlotError(f"{path} is not a table of a sweep, or is damaged")
        self.directory, self.name = directory, os.path.basename(os.path.normpath(directory))
        first = names.index(RESULTS)
        text = {name: [row[k] for row in rows[1:]] for k, name in enumerate(names[:first])}
        self.runs, self.status = text.pop("run"), text.pop("status")
        self.axes = text
        try:
            self.columns = {name: np.array([float(row[k + first] or "nan") for row in rows[1:]]) for k, name in enumerate(names[first:])}
        except ValueError as error:
            raise PlotError(f"{path} is damaged: {error}") from None

    def varied(self):
        """axes along which the runs differ, the reference left out"""
        used = [k for k, status in enumerate(self.status) if status != "reference" or self.runs[k] != "reference"]
        return [name for name, texts in self.axes.items() if len({texts[k] for k in used}) > 1]

    def errors(self):
        """columns that are an error, with a title"""
        found = [(name, name[: -len("_rms")]) for name in self.columns if name.endswith("_rms")]
        found += [("energy_difference", "all energies")]
        return [(name, title) for name, title in found if np.any(self.columns[name] > 0)]


def draw_points(ax, sweep, x, y):
    """points coloured by the first axis, marked by the second; runs that differ in the last axis only are joined"""
    axes = sweep.varied() or list(sweep.axes)[:1]
    first, second = sweep.axes[axes[0]], sweep.axes[axes[1]] if len(axes) > 1 else None
    colours, marks = list(dict.fromkeys(first)), list(dict.fromkeys(second)) if second else [None]
    shown = np.isfinite(x) & np.isfinite(y) & (y > 0)
    groups = {}
    for k in np.flatnonzero(shown):
        groups.setdefault(tuple(sweep.axes[a][k] for a in axes[:-1]), []).append(k)
    for members in groups.values():
        order = sorted(members, key=lambda k: x[k])
        ax.plot(x[order], y[order], color=style.MUTED, linewidth=0.9, alpha=0.7, zorder=1)
    said = set()
    for k in np.flatnonzero(shown):
        colour, mark = colours.index(first[k]), marks.index(second[k]) if second else 0
        label = f"{axes[0]} {first[k]}" + (f", {axes[1]} {second[k]}" if second else "")
        ax.plot(x[k], y[k], MARKERS[mark % len(MARKERS)], color=COLOURS[colour % len(COLOURS)], markersize=6.5, zorder=3, label=None if label in said else label)
        said.add(label)
    for k in np.flatnonzero(shown):
        rest = ", ".join(sweep.axes[a][k] for a in axes[2:])
        if rest:
            ax.annotate(rest, (x[k], y[k]), xytext=(5, 4), textcoords="offset points", fontsize=7.5, color=style.MUTED)
    return np.any(shown)


def scale_of(values, others):
    """decades when the values that are shown span them"""
    values = values[np.isfinite(values) & np.isfinite(others) & (values > 0) & (others > 0)]
    return "log" if len(values) > 1 and values.max() > 4 * values.min() else "linear"


def draw_sweep(sweep, path):
    """error of each probe over seconds a step, and over the number of proxies where that is varied; False when there is nothing to show"""
    errors = sweep.errors()
    over = [("step_cpu", "cpu seconds a step")]
    proxies = sweep.columns["proxies"]
    if np.nanmax(proxies, initial=0) > 1.01 * np.nanmin(proxies, initial=np.inf):
        over.append(("proxies", "proxies"))
    plots = [(*x, *y) for y in errors[:6] for x in over]
    if not plots:
        return False
    figure, axes = charts.panels(len(plots), f"{sweep.name}: speed against error", columns=2, height=3.6)
    for ax, (column, label, error, title) in zip(axes, plots):
        x, y = sweep.columns[column], 100 * sweep.columns[error]
        draw_points(ax, sweep, x, y)
        ax.set_xscale(scale_of(x, y))
        ax.set_yscale(scale_of(y, x))
        ax.set_title(f"{title}: difference from the reference")
        ax.set_xlabel(label)
        ax.set_ylabel("%")
    handles, labels = axes[0].get_legend_handles_labels()
    if len(labels) <= 16:
        axes[0].legend(fontsize=8, loc="best")
    style.save(figure, path)
    return True


def table_of(sweep):
    """the table in HTML, each run a link to its directory"""
    names = [name for name, values in sweep.columns.items() if np.any(np.isfinite(values))]
    head = "".join(f"<th>{html.escape(name)}</th>" for name in ["run", "status", *names])
    rows = []
    for k, run in enumerate(sweep.runs):
        cells = [f'<td><a href="../{urllib.parse.quote(run)}/">{html.escape(run)}</a></td>', f"<td>{html.escape(sweep.status[k])}</td>"]
        cells += [f"<td>{sweep.columns[name][k]:.4g}</td>" if np.isfinite(sweep.columns[name][k]) else "<td></td>" for name in names]
        rows.append("<tr>" + "".join(cells) + "</tr>")
    return f"<table>\n<tr>{head}</tr>\n" + "\n".join(rows) + "\n</table>\n"


def write_page(sweep, pictures, path):
    finished = sum(status in ("done", "reference") for status in sweep.status)
    parts = [page.head(sweep.name), f"<h1>{html.escape(sweep.name)}</h1>\n<p class=\"lead\">{finished} of {len(sweep.runs)} runs done; {html.escape(os.path.abspath(sweep.directory))}</p>\n"]
    parts += [page.figure(p) for p in pictures] + [f"<h2>Runs</h2>\n{table_of(sweep)}", page.TAIL]
    page.write(parts, path)


def draw(directory):
    """plots/sweep.png and plots/index.html; returns the path of the page"""
    sweep = Sweep(directory)
    folder = os.path.join(directory, "plots")
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise style.WriteError(f"cannot write {folder}: {error.strerror}") from None
    picture = os.path.join(folder, "sweep.png")
    pictures = [picture] if draw_sweep(sweep, picture) else []
    path = os.path.join(folder, "index.html")
    write_page(sweep, pictures, path)
    return path
