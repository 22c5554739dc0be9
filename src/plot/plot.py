#!/usr/bin/python3
"""plot.py - pictures (PNG) and one self-contained HTML page of runs: plot.py RUN... [-width PIXELS]

Writes RUN/plots/final.png, moments.png, probes.png, profile_<probe>.png, energies.png, solver.png (those for which the run has data) and index.html; of several
runs also compare.png, into each; of `byssus verify` verification.png, of `byssus sweep` sweep.png. Needs no display. Status 0 done, 1 a picture could not be written, 2 a directory is not a run or is damaged.
"""

import os
import sys

sys.dont_write_bytecode = True

try:
    from run import PlotError, Run
    import style
    import charts
    import page
    import picture
    import sweep
    import verification
except ImportError as error:
    sys.exit(f"byssus plot: {error} (Debian: apt install python3-numpy python3-h5py python3-matplotlib python3-yaml)")


def draw_run(run, width):
    """all pictures of one run but the comparison; returns their paths"""
    folder = os.path.join(run.directory, "plots")
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise style.WriteError(f"cannot write {folder}: {error.strerror}") from None
    done = []

    def add(name, draw, *arguments):
        path = os.path.join(folder, name)
        if draw(*arguments, path) is not False:
            done.append(path)

    if verification.is_verification(run):
        add("verification.png", verification.draw_verification, run)
        return done
    if len(run.times()):
        view = picture.View(run)
        add("final.png", picture.draw_final, run, view, width)
        add("moments.png", picture.draw_moments, run, view, width)
    if run.probes and len(run.probes.time) and run.probes.columns:
        add("probes.png", charts.draw_probes, run)
    for name in run.profiles:
        add(f"profile_{name}.png", charts.draw_profile, run, name)
    if run.ledger and len(run.ledger.time):
        add("energies.png", charts.draw_energies, run)
        add("solver.png", charts.draw_solver, run)
    return done


def read_arguments(arguments):
    """directories and the width of the 3D views"""
    directories, width, rest = [], 1600, list(arguments)
    while rest:
        word = rest.pop(0)
        if word in ("-width", "--width"):
            text = rest.pop(0) if rest else ""
            if not text.isdigit() or not 200 <= int(text) <= 8000:
                raise PlotError(f"-width {text}: expected a number of pixels from 200 to 8000")
            width = int(text)
        elif word.startswith("-"):
            raise PlotError(f"{word} is not an option; there is -width PIXELS")
        else:
            directories.append(word)
    if not directories:
        raise PlotError("name at least one run directory")
    return directories, width


def main(arguments):
    if not arguments or arguments[0] in ("-h", "-help", "--help"):
        print("usage: byssus plot RUN... [-width PIXELS]   pictures and a page of each run, into RUN/plots; 3D views 1600 pixels wide", file=sys.stdout if arguments else sys.stderr)
        return 0 if arguments else 2
    try:
        directories, width = read_arguments(arguments)
        sweeps = [directory for directory in directories if sweep.is_sweep(directory)]
        runs = [Run(directory) for directory in directories if directory not in sweeps]  # all are looked at before anything is drawn
        for directory in sweeps:
            print(sweep.draw(directory))
        pictures = [draw_run(run, width) for run in runs]
        if len(runs) > 1:
            for run, paths in zip(runs, pictures):
                paths.append(os.path.join(run.directory, "plots", "compare.png"))
                charts.draw_compare(runs, paths[-1])
        for run, paths in zip(runs, pictures):
            path = os.path.join(run.directory, "plots", "index.html")
            page.write_page(run, paths, path)
            print(path)
    except PlotError as error:
        print(f"byssus plot: {error}", file=sys.stderr)
        return 2
    except style.WriteError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
