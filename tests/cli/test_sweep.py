"""`byssus sweep` as a user runs it: the grid, the reference, errors against it by hand, what breaks down, Ctrl-C and going on, wrong input."""
import csv
import math
import os
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.environ["BYSSUS"]

TANK = """\
run: {end: 0.02, output_every: 0.004, directory: out}
domain: {min: [0, 0, 0], max: [0.4, 0.2, 0.4], walls: [xmin, xmax, ymin, ymax, zmin]}
gravity: [0, 0, -9.81]
sph:
  spacing: 0.05
  fill: [water]
  water: {min: [0, 0, 0], max: [0.4, 0.2, 0.2]}
probes: [bed, level]
bed: {body: zmin, quantity: force}
level: {at: [0.2, 0.1, 0], quantity: height}
"""

SECTION = """\
sweep:
  over: [size, how]
  size: {keys: [sph.spacing], values: [0.05, 0.04]}
  how: {keys: [sph.solver, sph.xsph], values: [iisph:0, dfsph:0.01]}
  reference: [sph.spacing=0.04, sph.solver=iisph, sph.xsph=0]
  probes: [bed]
  directory: study
"""

# name, what is added to the scene, words behind the scene, fragments of stderr; all end with 2, no traceback and no directory
BAD = [
    ("nothing to vary", "", [], ["scene.yaml: sweep.over: names nothing to vary", "-over key=value,value"]),
    ("unknown key", "", ["-over", "sph.spacin=0.05,0.04"], ["-sph_spacin is not a known option\n  did you mean -sph_spacing?"]),
    ("values out of range", "", ["-over", "sph.spacing=0.05,-1", "-reference", "sph.solver=abc"], ["-sph_spacing = -1 is out of range", "-sph_solver = abc is not known", "2 errors in this sweep"]),
    ("no values", "", ["-over", "sph.spacing="], ["has the value ''"]),
    ("too few parts", "", ["-over", "sph.spacing,sph.solver=0.05:iisph,0.04"], ["'0.04' for 2 keys"]),
    ("a value twice", "", ["-over", "sph.spacing=0.05,0.05"], ["has the value 0.05 twice"]),
    ("no such probe", "", ["-over", "sph.spacing=0.05,0.04", "-probe", "bed", "top"], ["has top, which is not a probe of the scene"]),
    ("no jobs", "", ["-over", "sph.spacing=0.05,0.04", "-jobs", "0"], ["-sweep_jobs = 0 is out of range"]),
    ("a word too many", "", ["-over", "sph.spacing=0.05,0.04", "-directory", "out", "more"], ["more is not an option"]),
    ("key both varied and set", "", ["-over", "sph.spacing=0.05,0.04", "-sph_spacing", "0.1"], ["-sph_spacing is given twice"]),
    ("what only a check finds", "", ["-over", "water.max=0.4"], ["-water_max is not a known option"]),
    ("a domain inside out", "", ["-over", "domain.max=[1,1,1],[0.4,0.2,-1]"], ["is not above domain.min in z", "cannot be run with max="]),
    ("axis without values", "sweep: {over: [a], a: {keys: [sph.spacing]}}\n", [], ["scene.yaml:11: sweep.a.values is missing"]),
    ("axis without a section", "sweep: {over: [a]}\n", [], ["sweep.over names a, but there is no section sweep.a"]),
    ("reference that sets nothing", "sweep: {over: [a], a: {keys: [sph.spacing], values: [0.1]}, reference: [sph.spacing]}\n", [], ["sweep.reference", "is not key=value"]),
]

failures = 0


def claim(what, good, more=""):
    global failures
    failures += not good
    if not good:
        print(f"{what}: false\n{more}")


def write(directory, text):
    with open(os.path.join(directory, "scene.yaml"), "w") as file:
        file.write(text)


def sweep(directory, *words):
    return subprocess.run([PROGRAM, "sweep", "scene.yaml", *words], cwd=directory, capture_output=True, text=True, timeout=250)


def rows_of(directory, folder):
    with open(os.path.join(directory, folder, "sweep.csv"), newline="") as file:
        rows = list(csv.reader(file))
    names = [name.split(" [")[0] for name in rows[0]]
    return {row[0]: dict(zip(names, row)) for row in rows[1:]}


def table_of(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return [name.split(" [")[0] for name in rows[0]], [[float(cell) for cell in row] for row in rows[1:]]


def error_by_hand(run, reference):
    """rms of the difference of the force at the same times over the largest force, and of the means"""
    names, ours = table_of(os.path.join(run, "probes.csv"))
    _, known = table_of(os.path.join(reference, "probes.csv"))
    columns = [names.index("bed_" + c) for c in "xyz"]
    differences = [[a[c] - b[c] for c in columns] for a, b in zip(ours, known)]
    largest = max(math.sqrt(sum(b[c] ** 2 for c in columns)) for b in known)
    rms = math.sqrt(sum(sum(d * d for d in row) for row in differences) / len(known)) / largest
    means = [sum(row[k] for row in differences) / len(known) for k in range(3)]
    return rms, math.sqrt(sum(m * m for m in means)) / largest


def check_grid():
    """the section of the scene: four runs, one of them the reference; the same again runs nothing; another value runs that alone"""
    with tempfile.TemporaryDirectory() as directory:
        write(directory, TANK + SECTION)
        done = sweep(directory)
        claim("a sweep ends with 0", done.returncode == 0, done.stderr)
        if done.returncode:
            return
        rows = rows_of(directory, "study")
        names = [f"size={size}+how={how}" for size in ("0.05", "0.04") for how in ("iisph:0", "dfsph:0.01")]
        claim("a row for each combination, in the order of the grid", list(rows) == names, str(list(rows)))
        claim("the run that is the reference is not run twice", [r["status"] for r in rows.values()] == ["done", "done", "reference", "done"], str(rows))
        run, reference = rows[names[0]], os.path.join(directory, "study", names[2])
        rms, mean = error_by_hand(os.path.join(directory, "study", names[0]), reference)
        claim("the error is the rms over the largest value", abs(float(run["bed_rms"]) - rms) < 1e-12 * rms, f"{run['bed_rms']} {rms}")  # round-off of sums
        claim("the other is that of the means", abs(float(run["bed_mean"]) - mean) < 1e-12, f"{run['bed_mean']} {mean}")
        claim("only the probe that was asked for", "level_rms" not in run, str(run))
        claim("particles, steps and cost are there", run["particles"] == "128" and float(run["steps"]) > 0 and float(run["step_cpu"]) > 0, str(run))
        for file in ("sweep.md", "plots/sweep.png", "plots/index.html"):
            claim(f"{file} is there", os.path.exists(os.path.join(directory, "study", file)), done.stdout + done.stderr)
        claim("the table is shown", "| 0.05 | iisph:0 | done | 128 |" in done.stdout, done.stdout)

        stamps = {name: os.stat(os.path.join(directory, "study", name, "summary.json")).st_mtime_ns for name in names}
        write(directory, TANK + SECTION.replace("dfsph:0.01]", "dfsph:0.01, pcisph:0]"))
        done = sweep(directory, "-sweep_picture", "false", "-jobs", "2")
        again = rows_of(directory, "study")
        claim("one more value is one more run for each size", "6 runs in study, 4 of them done before" in done.stderr and len(again) == 6, done.stderr)
        claim("what was done is not touched", all(os.stat(os.path.join(directory, "study", n, "summary.json")).st_mtime_ns == stamps[n] for n in names))
        claim("rows of before are the same", all(again[n] == rows[n] for n in names), str(again))


def check_breakdown():
    """a run that breaks down is a row with its reason, and the sweep goes on; a file beside the scene is found from elsewhere"""
    with tempfile.TemporaryDirectory() as directory:
        block = os.path.join(os.environ["BYSSUS_SOURCE"], "meshes", "block.msh")
        os.mkdir(os.path.join(directory, "scenes"))
        os.symlink(block, os.path.join(directory, "scenes", "block.msh"))
        text = """\
run: {end: 0.2, output_every: 0.02, directory: out}
gravity: [0, 0, -9.81]
bodies: [block]
block: {mesh: block.msh, density: 1000, young: 1e6, fixed: [bottom]}
sweep: {over: [mesh, step], mesh: {keys: [block.mesh], values: [block.msh]}, step: {keys: [block.step], values: [0, 1e-3]}}
"""
        with open(os.path.join(directory, "scenes", "scene.yaml"), "w") as file:
            file.write(text)
        done = subprocess.run([PROGRAM, "sweep", "scenes/scene.yaml", "-sweep_picture", "false"], cwd=directory, capture_output=True, text=True, timeout=250)
        claim("a sweep with a breakdown ends with 0", done.returncode == 0, done.stderr)
        if done.returncode:
            return
        rows = rows_of(directory, "out_sweep")
        claim("one run is done, the other broke down", [r["status"] for r in rows.values()] == ["done", "breakdown"], str(rows))
        with open(os.path.join(directory, "out_sweep", "sweep.md")) as file:
            claim("the reason is in the table", "broke down at" in file.read())


def check_interruption():
    """Ctrl-C in the second of two runs: 130, states saved; the same command goes on, and gives the results of a run that was not interrupted"""
    words = ["-over", "sph.spacing=0.05,0.025", "-reference", "sph.spacing=0.025", "-run_end", "0.4", "-sweep_picture", "false", "-directory", "cut"]
    with tempfile.TemporaryDirectory() as directory:
        write(directory, TANK)
        process = subprocess.Popen([PROGRAM, "sweep", "scene.yaml", *words], cwd=directory, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        said = ""
        for line in process.stderr:
            said += line
            if line.startswith("[1/2]"):
                break
        ledger = os.path.join(directory, "cut", "spacing=0.025", "ledger.csv")
        while process.poll() is None and not (os.path.exists(ledger) and open(ledger).read().count("\n") > 3):
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        said += process.communicate(timeout=100)[1]
        claim("Ctrl-C ends with 130", process.returncode == 130, said)
        claim("it says how to go on", "interrupted with 1 of 2 runs finished; the same command goes on" in said, said)
        claim("the table so far is there", rows_of(directory, "cut")["spacing=0.025"]["status"] == "interrupted")
        done = sweep(directory, *words)
        claim("the same command goes on", done.returncode == 0 and "1 of them done before" in done.stderr, done.stderr)
        with open(os.path.join(directory, "cut", "spacing=0.025", "log.txt")) as file:
            claim("from the saved state", "interrupted at" in file.read())
        whole = subprocess.run([PROGRAM, "run", "scene.yaml", "-sph_spacing", "0.025", "-run_end", "0.4", "-run_directory", "whole"], cwd=directory, capture_output=True, timeout=250)
        claim("one run by itself", whole.returncode == 0, whole.stderr)
        tables = [open(os.path.join(directory, folder, "probes.csv")).read() for folder in ("cut/spacing=0.025", "whole")]
        claim("interrupted in a sweep or not, the same results to the bit", tables[0] == tables[1])


def check_bad_input():
    for name, more, words, fragments in BAD:
        with tempfile.TemporaryDirectory() as directory:
            write(directory, TANK + more)
            done = sweep(directory, *words)
            claim(f"{name} ends with 2", done.returncode == 2, f"{done.returncode}\n{done.stderr}")
            for fragment in fragments:
                claim(f"{name} says {fragment!r}", fragment in done.stderr, done.stderr)
            claim(f"{name}: nothing was run", "nothing was run" in done.stderr and "PETSC ERROR" not in done.stderr and os.listdir(directory) == ["scene.yaml"], done.stderr)


for part in (check_grid, check_breakdown, check_interruption, check_bad_input):
    part()
print(f"{failures} failures")
sys.exit(1 if failures else 0)
