"""charts.py - quantities over time: probes, energies, how the solver did, and runs beside each other."""

import matplotlib.pyplot as plt
import numpy as np

import style
from style import COLOURS

COMPONENTS = ("_x", "_y", "_z")


def panels(n, title, columns=2, height=2.9):
    """n axes in a grid under a title; returns figure and axes"""
    columns = min(columns, max(n, 1))
    rows = -(-n // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(6.6 * columns if columns > 1 else 9.5, height * rows + 0.7), dpi=110, squeeze=False, layout="constrained")
    figure.suptitle(title, x=0.01, ha="left", fontsize=16, fontweight="bold")
    for extra in axes.ravel()[n:]:
        extra.set_visible(False)
    return figure, list(axes.ravel()[:n])


def groups(table):
    """columns that are components of one quantity together: [(name, unit, [(label, column), ...]), ...]"""
    result, done = [], set()
    for name in table.columns:
        if name in done:
            continue
        stem = name[:-2] if name.endswith(COMPONENTS) else None
        members = [stem + c for c in COMPONENTS if stem and stem + c in table.columns]
        if len(members) > 1 and len({table.units[m] for m in members}) == 1:
            result.append((stem, table.units[name], [(m[-1], m) for m in members]))
        else:
            members = [name]
            result.append((name, table.units[name], [("", name)]))
        done.update(members)
    return result


def curve(axes, time, values, **options):
    """a line; dots when there are few points, so that a single one is seen"""
    axes.plot(time, values, marker="o" if len(time) < 3 else None, markersize=4, **options)


def finish(axes, title, unit, legend=True):
    axes.set_title(title)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(unit)
    if legend and len(axes.get_legend_handles_labels()[0]) > 0:
        axes.legend(loc="best", ncols=min(3, len(axes.get_legend_handles_labels()[0])))
    axes.margins(x=0.01)


def draw_probes(run, path):
    probes = groups(run.probes)
    figure, axes = panels(len(probes), f"{run.name}: probes")
    for ax, (name, unit, members) in zip(axes, probes):
        for label, column in members:
            curve(ax, run.probes.time, run.probes.columns[column], label=label or None)
        finish(ax, name, "" if unit == "1" else unit)
    style.save(figure, path)


def draw_energies(run, path):
    """what exists of: the water's, the bodies', the work at the interface, all together"""
    table = run.ledger
    sets = [
        ("water", [("fluid_kinetic", "kinetic", False), ("fluid_potential", "potential, from its start", True), ("fluid_viscous_loss", "lost to viscosity", False)]),
        ("bodies", [("solid_kinetic", "kinetic", False), ("solid_strain", "strain", False), ("solid_potential", "potential, from its start", True), ("solid_damping_loss", "lost to damping", False)]),
        ("work at the interface", [("work_fluid", "done on the water", False), ("work_solid", "done on the bodies", False)]),
    ]
    sets = [(title, [m for m in members if table.get(m[0]) is not None and np.any(table.get(m[0]))]) for title, members in sets]
    sets = [(title, members) for title, members in sets if members]
    energies = [n for n in ("fluid_kinetic", "fluid_potential", "solid_kinetic", "solid_strain", "solid_potential") if table.get(n) is not None]
    figure, axes = panels(len(sets) + bool(energies), f"{run.name}: energies")
    for ax, (title, members) in zip(axes, sets):
        for name, label, relative in members:
            values = table.get(name)
            curve(ax, table.time, values - values[0] if relative else values, label=label)
        if title.startswith("work") and len(members) == 2:
            total = table.get("work_fluid") + table.get("work_solid")
            curve(ax, table.time, total, label="sum", color=style.MUTED, linestyle="--", linewidth=1.4)
        finish(ax, title, "J")
    if energies:
        total = sum(table.get(n) for n in energies)
        curve(axes[-1], table.time, total - total[0], label="all energies, from their start", color=COLOURS[5])
        if has(table, "work_motion"):
            curve(axes[-1], table.time, table.get("work_motion"), label="work of what is moved", color=style.MUTED, linestyle="--", linewidth=1.4)
        finish(axes[-1], "together", "J")
    style.save(figure, path)


def has(table, *names):
    return [n for n in names if table.get(n) is not None and np.any(np.isfinite(table.get(n))) and np.any(table.get(n))]


def draw_solver(run, path):
    table = run.ledger
    plots = []
    if has(table, "iterations"):
        plots.append(("pressure iterations of a step", "", [("iterations", "", 1)]))
    if has(table, "dt"):
        plots.append(("time step", "ms", [("dt", "", 1e3)]))
    if has(table, "compression_mean", "compression_max"):
        plots.append(("compression of the water", "%", [(n, n[12:], 100) for n in has(table, "compression_mean", "compression_max")]))
    if has(table, "substeps"):
        plots.append(("solid steps to one of the water", "", [("substeps", "", 1)]))
    if has(table, "proxies"):
        plots.append(("surface proxies", "", [("proxies", "", 1)]))
    momentum = has(table, "momentum_x", "momentum_y", "momentum_z")
    if momentum:
        plots.append(("momentum", "kg m/s", [(n, n[-1], 1) for n in momentum]))
    if has(table, "penetrations"):
        plots.append(("particles inside a body", "", [("penetrations", "", 1)]))
    if not plots:
        return False
    figure, axes = panels(len(plots), f"{run.name}: solver")
    for ax, (title, unit, members) in zip(axes, plots):
        for name, label, factor in members:
            values = factor * table.get(name)
            curve(ax, table.time, np.where(values > 0, values, np.nan) if name == "dt" else values, label=label or None)  # no step at the start
        if not unit and np.all(table.get(members[0][0]) >= 0):
            ax.set_ylim(bottom=0)
        if title.startswith("compression") and len(members) == 2:
            positive = np.concatenate([table.get(n) for n, _, _ in members])
            if np.any(positive > 0):
                ax.set_yscale("log")
                ax.yaxis.set_major_formatter("{x:g}")
        finish(ax, title, unit)
    style.save(figure, path)
    return True


def labels(runs):
    """short names that tell the runs apart"""
    names = [run.name for run in runs]
    return names if len(set(names)) == len(names) else [run.directory for run in runs]


def draw_compare(runs, path):
    """probes that the runs share, energies, and what each cost beside its error"""
    names = labels(runs)
    with_probes = [run for run in runs if run.probes]
    shared = []
    if len(with_probes) > 1:
        common = set.intersection(*(set(run.probes.columns) for run in with_probes))
        shared = [n for n in with_probes[0].probes.columns if n in common]
        still = [n for n in shared if not any(np.any(run.probes.get(n)) for run in with_probes)]
        shared = [n for n in shared if n not in still][:8]
    with_ledger = [run for run in runs if run.ledger]
    energies = [n for n in ("fluid_kinetic", "solid_strain") if len([r for r in with_ledger if has(r.ledger, n)]) > 1]
    cost = [(name, run.summary["wall_seconds"]) for name, run in zip(names, runs) if number(run.summary.get("wall_seconds"))]
    figure, axes = panels(len(shared) + len(energies) + bool(cost), "runs beside each other")
    for ax, name in zip(axes, shared):
        for n, run in enumerate(runs):
            if run.probes and run.probes.get(name) is not None:
                curve(ax, run.probes.time, run.probes.get(name), label=names[n], color=COLOURS[n % len(COLOURS)])
        finish(ax, name, with_probes[0].probes.units[name])
    for ax, name in zip(axes[len(shared):], energies):
        for n, run in enumerate(runs):
            if run.ledger and run.ledger.get(name) is not None:
                curve(ax, run.ledger.time, run.ledger.get(name), label=names[n], color=COLOURS[n % len(COLOURS)])
        finish(ax, {"fluid_kinetic": "kinetic energy of the water", "solid_strain": "strain energy of the bodies"}[name], "J")
    if cost:
        draw_cost(axes[-1], runs, names)
    style.save(figure, path)


def number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def draw_cost(ax, runs, names):
    """time taken, with the error that it bought written beside"""
    for n, (name, run) in enumerate(zip(names, runs)):
        seconds = run.summary.get("wall_seconds")
        if not number(seconds):
            continue
        ax.barh(n, seconds, color=COLOURS[n % len(COLOURS)], height=0.62)
        fluid = run.summary.get("fluid")
        error = fluid.get("density_error_mean") if isinstance(fluid, dict) else None
        text = f" {seconds:.4g} s" + (f", density error {100 * error:.2g} %" if number(error) else "")
        ax.text(seconds, n, text, va="center", fontsize=9.5)
    ax.set_yticks(range(len(names)), names)
    ax.invert_yaxis()
    ax.grid(axis="y", visible=False)
    ax.set_title("wall time")
    ax.set_xlabel("s")
    ax.margins(x=0.7)
