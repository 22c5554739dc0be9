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


def draw_profile(run, name, path):
    """velocity or pressure on a line at up to six times, or on a rectangle at up to four"""
    table = run.profiles[name]
    times = np.unique(table.time)
    points = np.stack([table.columns[c][table.time == times[-1]] for c in "xyz"], axis=1)
    fields = [c for c in table.columns if c not in "xyz"]
    values = {t: np.stack([table.columns[f][table.time == t] for f in fields], axis=1) for t in times}
    values = {t: v for t, v in values.items() if len(v) == len(points)}  # a run that was stopped while writing leaves a part of a time
    axes_used = [k for k in range(3) if np.ptp(points[:, k]) > 0]
    grid = [len(np.unique(points[:, k])) for k in axes_used]
    if len(axes_used) == 2 and grid[0] * grid[1] == len(points) and len(points) > max(grid):
        draw_rectangle(run, name, axes_used, points, values, table.units[fields[0]], path)
        return
    far = np.linalg.norm(points - points[0], axis=1)
    chosen = list(values)[:: max(1, -(-len(values) // 6))] + [list(values)[-1]]
    shown = [f for f in range(len(fields)) if np.any(np.nan_to_num(np.array(list(values.values()))[:, :, f]))] or [0]
    figure, axes = panels(len(shown), f"{run.name}: {name}")
    for ax, f in zip(axes, shown):
        for n, time in enumerate(dict.fromkeys(chosen)):
            ax.plot(far, values[time][:, f], marker=".", label=f"{time:.4g} s", color=plt.cm.viridis(0.9 - 0.9 * n / max(1, len(set(chosen)) - 1)))
        finish(ax, fields[f], table.units[fields[f]])
        ax.set_xlabel("from the line's beginning [m]")
    style.save(figure, path)


def draw_rectangle(run, name, axes_used, points, values, unit, path):
    """speed with arrows, or pressure, at up to four times"""
    across, up = (points[:, k] for k in axes_used)
    shape = (len(np.unique(up)), len(np.unique(across)))
    times = [list(values)[k] for k in sorted({round(q * (len(values) - 1)) for q in (0.1, 0.4, 0.7, 1.0)})]
    figure, axes = panels(len(times), f"{run.name}: {name}", height=4.2)
    sizes = {t: np.linalg.norm(v, axis=1) if v.shape[1] == 3 else v[:, 0] for t, v in values.items()}
    finite = np.concatenate([sizes[t][np.isfinite(sizes[t])] for t in times])
    low, high = (0.0 if unit == "m/s" else finite.min(), finite.max()) if len(finite) else (0.0, 1.0)
    for ax, time in zip(axes, times):
        picture = ax.pcolormesh(across.reshape(shape), up.reshape(shape), sizes[time].reshape(shape), shading="nearest", cmap="viridis", vmin=low, vmax=max(high, low + 1e-12))
        if values[time].shape[1] == 3:
            ax.quiver(across, up, *(values[time][:, k] for k in axes_used), color="white", width=0.003)
        figure.colorbar(picture, ax=ax, label=unit)
        ax.set_aspect("equal")
        ax.set_title(f"{time:.4g} s")
        ax.set_xlabel("xyz"[axes_used[0]] + " [m]")
        ax.set_ylabel("xyz"[axes_used[1]] + " [m]")
        ax.grid(visible=False)
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
