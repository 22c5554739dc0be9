"""fluid_hard.py - section of the report on hard cases: what becomes of each with every solver, and a million steps of still water."""

import concurrent.futures
import os
import re

import draw
from draw import style
from fluid_speed import bench, build
from program import BUILD, Failure, attempt, execute, say, table, verdict
from sections import claim

TEST = BUILD / "tests" / "test.hard.fluid"
PREFIX = "hard fluid:"

HARD = """Each case with each solver at its defaults (`tests/hard/test_fluid.c`; `build/release/tests/test.hard.fluid -solver NAME`): **yes** = ran to its end, no
particle outside a wall at the end of any step, every number finite, and what the case asks besides (below); stopped = the run ended with a message that
names step, particle and reason; refused = the program said at the start that it does not do this. `no` would be anything else."""

ASKED = """Asked besides: jet and viscosity: energy at most 1.02 of the first, at 1e3 Pa s speed below 0.6 m/s; jet: momentum what walls and weight gave within 1e-3;
drops: path of the centre exact but for the integrator's half step, no burst; on a floor, where they slide without friction, flat and below 0.5 m/s in the end; density: within 50 % at the end; steps up
to the limit: energy at most 1.3 of the first (iisph: 1.02). What the default solver showed:"""

MILLION = """**A million steps.** `bench.sph -pack -n 6,6,8 -end {end:g}`: 288 particles in a tank of five walls, {steps:,} steps of {dt:.1f} ms on one thread ({seconds:.0f} s). Kinetic
energy and height of the centre of mass, mean of the first and the last tenth of the second half:"""


def solvers():
    """names of the key sph.solver, without auto"""
    found = re.search(r"`solver` \| one of ([^|]*iisph[^|]*) \|", execute([BUILD / "byssus", "info", "-keys"]))
    return [name.strip() for name in found.group(1).split(",") if name.strip() != "auto"]


def rows_of(solver):
    done = attempt(["env", "OMP_NUM_THREADS=1", TEST, "-solver", solver], timeout=900)
    found = [[cell.strip() for cell in line[len(PREFIX):].split("|")] for line in done.stdout.splitlines() if line.startswith(PREFIX)]
    if not found:
        raise Failure(f"{TEST} -solver {solver}: said nothing\n{done.stderr[-1500:]}")
    say(f"hard cases, {solver}: {sum(float(row[4]) for row in found):.1f} s")
    return found


def word(outcome, within):
    if within != "yes":
        return "**no**"
    return "refused" if outcome.startswith("refused") else "stopped" if outcome.startswith("stopped") else "yes"


def cases():
    names = solvers()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        found = dict(zip(names, pool.map(rows_of, names)))
    names = [name for name in names if any(not row[2].startswith("refused") for row in found[name])]
    outcomes = {(row[0], name): row for name in names for row in found[name]}
    order = list(dict.fromkeys(row[0] for row in found[names[0]]))
    rows = [[case] + [word(outcomes[case, name][2], outcomes[case, name][5]) for name in names] for case in order]
    rows.append(["seconds of one thread, all cases"] + [f"{sum(float(row[4]) for row in found[name]):.1f}" for name in names])
    stopped = {case: [name for name in names if outcomes[case, name][2].startswith("stopped")] for case in order}
    stops = [(case, who[0], outcomes[case, who[0]][2].removeprefix("stopped: ")) for case, who in stopped.items() if who]
    wrong = [(case, name, outcomes[case, name][2], outcomes[case, name][3]) for case in order for name in names if outcomes[case, name][5] != "yes"]
    default = [(case, outcomes[case, "iisph"][2], outcomes[case, "iisph"][3]) for case in order if not outcomes[case, "iisph"][2].startswith("stopped")]
    claim("hard cases that run through or stop with a reason", f"{sum(len(found[name]) for name in names) - len(wrong)} of {sum(len(found[name]) for name in names)}", "", "all", not wrong)
    text = HARD + "\n\n" + table(["case"] + names, rows)
    if stops:
        text += "\nReasons of those that stopped, one of each case:\n\n" + table(["case", "solver", "reason"], stops)
    if wrong:
        text += "\nThose not within:\n\n" + table(["case", "solver", "outcome", "figures"], wrong)
    return text + "\n" + ASKED + "\n\n" + table(["case", "outcome", "figures"], default)


def million(found):
    if found["stopped"]:
        claim("a million steps of still water", found["stopped"][:60], "", "through", False)
        return found["stopped"] + "\n"
    t, kinetic, potential = (found[key] for key in ("times", "kinetic", "potential"))
    centre = [p / found["weight"] for p in potential]
    dx = 0.4 / 8

    def mean(values, part):
        return sum(values[part]) / len(values[part])

    first, last = slice(50, 60), slice(90, 100)
    creep, heat = (mean(centre, last) - mean(centre, first)) / dx, [mean(kinetic, part) / found["energy"] for part in (first, last)]
    good = abs(creep) < 1e-3 and heat[1] < 2 * max(heat[0], 1e-12) and found["deepest"] > 0 and found["steps"] >= 1_000_000
    claim("a million steps of still water", f"creep {creep:+.1e} dx, kinetic / first energy {heat[1]:.1e}", "", "1e-3 dx, no heating", good)
    drawn, axes = draw.figure(2, width=10, height=3.2)
    axes[0].semilogy(t[1:], [k / found["energy"] for k in kinetic[1:]], color=style.COLOURS[0])
    axes[0].set_title("kinetic energy over the first energy")
    axes[1].plot(t[1:], [(c - centre[-1]) / dx for c in centre[1:]], color=style.COLOURS[0])
    axes[1].set_title("centre of mass, height over its last [dx]")
    for ax in axes:
        ax.set_xlabel("time [s]")
    rows = [("kinetic energy over the first energy", f"{heat[0]:.1e}", f"{heat[1]:.1e}"), ("centre of mass, height [m]", f"{mean(centre, first):.7f}", f"{mean(centre, last):.7f}")]
    return (MILLION.format(end=5050, steps=found["steps"], dt=1e3 * found["time"] / found["steps"], seconds=found["seconds"]) + "\n\n" + table(["", "first tenth", "last tenth"], rows)
            + f"\nThe centre moved by {creep:+.1e} dx; nearest to a wall {found['deepest']:.3f} dx. No creep, no heating: {verdict(good)}.\n" + draw.save(drawn, "million", "kinetic energy and centre of mass over a million steps"))


def hard():
    build()
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        long = pool.submit(bench, "million", ["-pack", "-n", "6,6,8", "-end", "5050"], 900)
        text = cases()
    return text + "\n" + million(long.result())
