"""fluid_speed.py - section of the report on cost: what error each pressure solver buys for its seconds, on still water and on a breaking dam."""

import concurrent.futures
import json
import math
import os
import subprocess

import numpy as np

import draw
from draw import style
from program import BUILD, ROOT, WORK, execute, options, say, table
from sections import claim

BENCH = BUILD / "bench.sph"
GRAVITY = 9.81

# solver -> what is tried besides its defaults, each alone: label -> options
CHOICES = {
    "iisph": {"tolerance 1e-3": ["-sph_tolerance", 1e-3], "tolerance 1e-4": ["-sph_tolerance", 1e-4], "tolerance 1e-6": ["-sph_tolerance", 1e-6], "mprgp": ["-sph_bounded", "mprgp"]},
    "iisph_jacobi": {"tolerance 1e-2": ["-sph_tolerance", 1e-2], "tolerance 1e-4": ["-sph_tolerance", 1e-4]},
    "dfsph": {"tolerance 1e-3": ["-sph_tolerance", 1e-3], "tolerance 1e-5": ["-sph_tolerance", 1e-5]},
    "pcisph": {"tolerance 1e-3": ["-sph_tolerance", 1e-3], "mean below 1e-3": ["-sph_tolerance", 1e-3, "-sph_tolerance_norm", "mean"]},
    "pbf": {"tolerance 1e-2": ["-sph_tolerance", 1e-2], "tolerance 1e-4": ["-sph_tolerance", 1e-4], "4 iterations from nothing": ["-sph_pbf_iterations", 4, "-sph_pbf_warm_start", 0]},
    "wcsph": {"half the speed of sound": ["-sph_sound_speed", 14], "twice the speed of sound": ["-sph_sound_speed", 56], "gamma 1": ["-sph_gamma", 1]},
    "isph": {"tolerance 1e-3": ["-sph_tolerance", 1e-3]},
}
STEPS = (0.5, 2, 4)  # times the step that the default takes


def build():
    execute(["cmake", "--build", BUILD, "--target", "bench.sph"])


def bench(name, arguments, timeout=1200):
    """bench.sph on one thread, with the processor's time; what it wrote as a dictionary, `stopped` with the reason if it did not come to its end"""
    path = WORK / "speed" / (name + ".json")
    mark = path.with_suffix(".arguments")
    arguments = [str(a) for a in arguments]
    if not (options["keep"] and path.exists() and mark.exists() and mark.read_text(encoding="utf-8") == " ".join(arguments)):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        try:
            subprocess.run([BENCH, "-quiet", "-cpu", *arguments, "-json", path], cwd=ROOT, env=environment, capture_output=True, timeout=timeout, check=False)
        except subprocess.TimeoutExpired:
            pass
        mark.write_text(" ".join(arguments), encoding="utf-8")
    if not path.exists():
        return {"stopped": f"not through in {timeout} s"}
    found = json.loads(path.read_text(encoding="utf-8"))
    say(f"{name}: {found['seconds']:.1f} s {found['stopped']}")
    return found


def together(jobs):
    """runs of one thread each, as many at a time as there are processors: name -> arguments"""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        waiting = {name: pool.submit(bench, name, arguments) for name, arguments in jobs.items()}
        return {name: job.result() for name, job in waiting.items()}


def refused(solver):
    return bench(f"probe_{solver}", ["-n", "4,4,4", "-end", "0.01", "-sph_solver", solver]).get("stopped") == "refused"


class Point:
    """One solver with one choice of options on one case."""

    def __init__(self, case, solver, label, arguments):
        self.name, self.solver, self.label = f"{case}_{solver}_{label}".replace(" ", "_"), solver, label
        self.arguments = ["-sph_solver", solver, *arguments]
        self.found, self.error, self.best = None, math.inf, False

    @property
    def seconds(self):
        return self.found.get("seconds", math.inf)

    @property
    def through(self):
        return not self.found["stopped"]


def points(case, step):
    """all choices; `step`: the fixed step that others are multiples of"""
    chosen = []
    for solver, variants in CHOICES.items():
        if refused(solver):
            continue
        chosen.append(Point(case, solver, "default", []))
        chosen += [Point(case, solver, label, arguments) for label, arguments in variants.items()]
        if solver != "wcsph":
            chosen += [Point(case, solver, f"step x {factor:g}", ["-sph_time_step", f"{factor * step:.6g}"]) for factor in STEPS]
        chosen.append(Point(case, solver, "double", ["-sph_precision", "double"]))
    return chosen


def front(chosen):
    """marks the points that no other beats in both error and seconds"""
    for p in chosen:
        p.best = p.through and math.isfinite(p.error) and not any(q is not p and q.through and q.seconds <= p.seconds and q.error <= p.error for q in chosen)
    return sorted((p for p in chosen if p.best), key=lambda p: p.seconds)


def scatter(axes, chosen, title, xlabel):
    solvers, best = list(dict.fromkeys(p.solver for p in chosen)), front(chosen)
    for k, solver in enumerate(solvers):
        these = [p for p in chosen if p.solver == solver and p.through and math.isfinite(p.error)]
        axes.loglog([p.seconds for p in these], [p.error for p in these], marker="osD^vP*X"[k % 8], linestyle="none", markersize=5.5, color=style.COLOURS[k % 8], label=solver)
        for p in these:
            if p.label == "default":
                axes.loglog(p.seconds, p.error, marker="o", markersize=12, markerfacecolor="none", color=style.COLOURS[k % 8])
            if p.best or p.label == "default":
                axes.annotate(p.label, (p.seconds, p.error), textcoords="offset points", xytext=(6, 4), fontsize=7, color=style.MUTED)
    axes.plot([p.seconds for p in best], [p.error for p in best], color=style.TEXT, linewidth=6, alpha=0.12, zorder=0, label="none faster and nearer")
    axes.set_title(title)
    axes.set_xlabel(xlabel)
    axes.legend(fontsize=8)


def conclusion(chosen, bars):
    """cheapest that is within each bar, and where the default stands: text from the numbers"""
    text = []
    through = [p for p in chosen if p.through]
    for bar in bars:
        within = [p for p in through if p.error <= bar]
        if within:
            cheapest = min(within, key=lambda p: p.seconds)
            text.append(f"Cheapest within {100 * bar:g} %: {cheapest.solver}, {cheapest.label} ({cheapest.seconds:.2f} s, {100 * cheapest.error:.2f} %).")
        else:
            text.append(f"None is within {100 * bar:g} %.")
    default = next(p for p in chosen if p.solver == "iisph" and p.label == "default")
    better = [p for p in through if p.seconds < default.seconds and p.error < default.error]
    text.append(f"The default (iisph) takes {default.seconds:.2f} s for {100 * default.error:.2f} %; "
                + ("none is both faster and nearer." if not better else "faster and nearer: " + ", ".join(f"{p.solver}, {p.label} ({p.seconds:.2f} s, {100 * p.error:.2f} %)" for p in sorted(better, key=lambda p: p.seconds)) + "."))
    return " ".join(text)


STILL = """**Still water.** 12 x 12 x 20 = 2,880 particles, 0.4 m deep, from a packed lattice, 1.5 s; measured over the last 0.5 s. Error: root of the sum of squares of the three
gauges' rms distance from rho g z (mean of the three, over rho g z) and of the rms swing of the floor's force over the weight."""

STILL_CASE = ["-pack", "-n", "12,12,20", "-end", "1.5", "-from", "1"]


def still():
    step = 0.05 * math.sqrt(2 * 0.02 / GRAVITY)
    chosen = points("still", step)
    for p, found in zip(chosen, together({p.name: STILL_CASE + p.arguments for p in chosen}).values()):
        p.found = found
        if p.through:
            gauges = float(np.mean(found["gauge_error"]))
            p.error = math.hypot(gauges, found["force_noise"])
    return chosen


DAM = """**Dam break.** 16 x 8 x 24 = 3,072 particles, 0.4 m high, in a tank 1 m long, 0.45 s: the front reaches the far wall at about {impact:.2f} s. Errors against iisph on half the
spacing (24,576 particles), rms over time: of the front over the column's height; of kinetic and potential energy, over the first energy; of the far
wall's impulse over its last value; mean of the mean compression. Noise: rms swing of the force on the floor about its mean over seven samples 4.5 ms apart,
before the impact, over the weight: coupled bodies feel it. Error: root of the sum of the squares of all five."""

DAM_CASE = ["-pack", "-length", "1", "-end", "0.45"]


def dam_errors(found, reference):
    """of one run, by name"""
    t, known = np.array(found["times"]), np.array(reference["times"])

    def at(run, times, key, of):
        return np.interp(of, times, np.array(run[key]))

    grid = np.linspace(0.01, 0.44, 200)
    front_error = at(found, t, "front", grid) - at(reference, known, "front", grid)
    energies = [at(found, t, key, grid) / found["energy"] - at(reference, known, key, grid) / reference["energy"] for key in ("kinetic", "potential")]

    def impulse(run, times):
        force = np.array(run["far_force"]) / run["weight"]
        return np.interp(grid, times, np.concatenate([[0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(times))]))

    ours, best = impulse(found, t), impulse(reference, known)
    floor = np.array(found["floor_force"])[t < 0.3] / found["weight"]
    smooth = np.convolve(floor, np.ones(7) / 7, mode="valid")
    return {"noise": float(np.std(floor[3:-3] - smooth)), "front": float(np.sqrt(np.mean(front_error**2))) / 0.4, "energy": float(np.sqrt(np.mean(energies[0] ** 2 + energies[1] ** 2))),
            "impulse": float(np.sqrt(np.mean((ours - best) ** 2))) / max(1e-12, abs(best[-1])), "compression": float(np.mean(found["compression_mean"]))}


def dam():
    dx = 0.4 / 24
    chosen = points("dam", 0.4 * dx / (2 * math.sqrt(GRAVITY * 0.4)))
    jobs = {"dam_fine": [*DAM_CASE, "-n", "32,16,48", "-sph_solver", "iisph"], "dam_converged": [*DAM_CASE, "-n", "16,8,24", "-sph_solver", "iisph", "-sph_tolerance", "1e-7", "-sph_precision", "double", "-sph_max_time_step", "4e-4"]}
    jobs.update({p.name: [*DAM_CASE, "-n", "16,8,24", *p.arguments] for p in chosen})
    found = together(jobs)
    fine = found["dam_fine"]
    for p in chosen:
        p.found = found[p.name]
        if p.through:
            p.parts = dam_errors(p.found, fine)
            p.error = math.sqrt(sum(value**2 for value in p.parts.values()))
    converged = dam_errors(found["dam_converged"], fine)
    length = np.array(fine["front"])
    reached = np.array(fine["times"])[length > 0.97]
    return chosen, converged, float(reached[0]) if len(reached) else 0.45, fine


def outcome(p):
    return p.found["stopped"][:60] + " ..." if len(p.found["stopped"]) > 60 else p.found["stopped"]


def speed():
    build()
    water = still()
    breaking, converged, impact, fine = dam()
    drawn, axes = draw.figure(2, width=11, height=5.2)
    scatter(axes[0], water, "still water, 2,880 particles, 1.5 s", "seconds of one thread")
    scatter(axes[1], breaking, "dam break, 3,072 particles, 0.45 s", "seconds of one thread")
    axes[0].set_ylabel("error")
    picture = draw.save(drawn, "speed", "error against seconds")
    rows = []
    for p in sorted(water, key=lambda p: (list(CHOICES).index(p.solver), p.seconds)):
        f = p.found
        rows.append((p.solver, p.label, f"{p.seconds:.2f}", f"{f['steps']}", f"{f['iterations']:.1f}", *(f"{100 * g:.2f} %" for g in (float(np.mean(f['gauge_error'])), f["force_noise"])), f"{f['compression']:.1e}",
                     f"{100 * f['speed_rms']:.2f} %", f"{100 * p.error:.2f} %", "best" if p.best else "") if p.through else (p.solver, p.label, "", "", "", "", "", "", "", "", outcome(p)))
    text = [f"Processor seconds of one thread; the machine has {os.cpu_count()}, so many runs at a time. Each solver at its defaults (ringed), then with one option changed. `best`: none is "
            "faster and nearer.\n", picture, "\n" + STILL + " " + conclusion(water, (0.02, 0.01)) + "\n\n",
            table(["solver", "choice", "s", "steps", "applied a step", "gauges", "floor's noise", "mean compression", "rms speed / sqrt(gH)", "error", ""], rows)]
    rows = []
    for p in sorted(breaking, key=lambda p: (list(CHOICES).index(p.solver), p.seconds)):
        f = p.found
        rows.append((p.solver, p.label, f"{p.seconds:.2f}", f"{f['steps']}", f"{f['iterations']:.1f}", *(f"{100 * p.parts[key]:.2f} %" for key in ("front", "energy", "impulse", "noise")), f"{p.parts['compression']:.1e}",
                     f"{100 * f['compression_peak']:.1f} %", f"{100 * p.error:.2f} %", "best" if p.best else "") if p.through else (p.solver, p.label, *[""] * 9, outcome(p)))
    text += ["\n" + DAM.format(impact=impact) + f" The same resolution converged in tolerance and step (iisph, 1e-7, an eighth of the step, double) stands at "
             + ", ".join(f"{key} {100 * value:.2f} %" for key, value in converged.items()) + f": what is below that is spacing, not solver. The fine run took {fine['seconds']:.0f} s. "
             + conclusion(breaking, (0.1, 0.05)) + "\n\n",
             table(["solver", "choice", "s", "steps", "applied a step", "front", "energy", "impulse", "noise", "mean compression", "largest", "error", ""], rows)]
    for chosen, case in ((water, "still water, speed against error"), (breaking, "dam break, speed against error")):
        default = next(p for p in chosen if p.solver == "iisph" and p.label == "default")
        claim(case, f"{100 * default.error:.1f} % in {default.seconds:.1f} s", "", "on the front" if default.best else "off the front")
    return "".join(text)
