"""program.py - run the program and its tests for the report; meshes by gmsh; tables in markdown."""

import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BYSSUS_BUILD", "build/release")
NAME = pathlib.Path(sys.argv[0]).stem  # the report: report/NAME.py is what was started
WORK = ROOT / "build" / "report" / NAME
PROGRAM = BUILD / "byssus"
options = {"keep": False}


def program_options(arguments):
    """-keep is taken off: runs whose scene is unchanged and whose results are there are not run again, to work on a page"""
    options["keep"] = "-keep" in arguments
    return [a for a in arguments if a != "-keep"]


class Failure(Exception):
    """Something could not be run; the message says what."""


class Missing(Failure):
    """Something that is not in the repository is not here; the section stays as it stands on the page."""


def say(text):
    print(f"   {text}", file=sys.stderr, flush=True)


def attempt(command, timeout=900):
    """run a command from the source tree"""
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_WAIT_POLICY="passive", BYSSUS_SOURCE=str(ROOT))
    return subprocess.run([str(c) for c in command], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=timeout, check=False)


def execute(command, timeout=900, allowed=(0,)):
    """run a command that must end well; its output"""
    done = attempt(command, timeout)
    if done.returncode not in allowed:
        raise Failure(f"{' '.join(str(c) for c in command)}: status {done.returncode}\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return done.stdout


def mesh(name, order=1):
    """path of a mesh made by gmsh from tests/meshes/geo, the same every time; of second order from that of first"""
    path = WORK / "meshes" / (name + ("" if order == 1 else "_order2") + ".msh")
    source = ROOT / "tests" / "meshes" / "geo" / (name + ".geo") if order == 1 else mesh(name)
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        execute(["gmsh", source, "-3", "-nt", "1", "-order", order, "-format", "msh41", "-o", path])
    return path


def write_scene(name, scene):
    path = WORK / (name + ".yaml")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(f"{key}: {json.dumps(value)}\n" for key, value in scene.items()), encoding="utf-8")
    return path


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def verify(name, scene, **keys):
    """`byssus verify` on a scene (a dictionary); what it found of the body, with its status; keys: of the section verify"""
    directory = WORK / name
    scene = dict(scene, verify={"picture": False, "directory": str(directory), **keys})
    start = time.time()
    execute([PROGRAM, "verify", write_scene(name, scene)], allowed=(0, 3))
    summary = read_json(directory / "summary.json")
    say(f"{name}: {summary['status']}, {time.time() - start:.1f} s")
    if summary["status"] == "breakdown":
        raise Failure(f"{name}: broke down")
    body = summary["bodies"][scene["bodies"][0]]
    return dict(body, status=summary["status"])


def run(name, scene, end, output_every):
    """`byssus run`; columns of probes.csv and ledger.csv"""
    directory = WORK / name
    scene = dict(scene, run={"end": end, "output_every": output_every, "directory": str(directory)})
    start = time.time()
    execute([PROGRAM, "run", write_scene(name, scene)])
    say(f"{name}: {time.time() - start:.1f} s")
    return tuple(read_table(directory / (table + ".csv")) for table in ("probes", "ledger"))


def read_table(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    names = [cell.split(" [")[0].strip('"') for cell in lines[0].split(",")]
    rows = [[float(cell) for cell in line.split(",")] for line in lines[1:]]
    return {name: [row[k] for row in rows] for k, name in enumerate(names)}


def test_lines(prefix):
    """what the tests print after `prefix`, of all test programs whose source prints it: (name of the test, whether it passed, cells)"""
    found = []
    for source in sorted((ROOT / "tests").rglob("test_*.c")):
        if f'"{prefix}' not in source.read_text(encoding="utf-8"):
            continue
        name = ".".join(source.relative_to(ROOT / "tests").with_suffix("").parts).replace(".test_", ".")
        program = BUILD / "tests" / ("test." + name)
        if not program.exists():
            raise Failure(f"{program} is not built: ./dev build")
        done = attempt([program])
        for line in done.stdout.splitlines():
            if line.startswith(prefix):
                found.append((name, done.returncode == 0, [cell.strip() for cell in line[len(prefix):].split("|")]))
        say(name)
    return found


def table(headers, rows):
    """markdown"""
    lines = ["| " + " | ".join(headers) + " |", "|" + " --- |" * len(headers)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def small(value):
    """an error: two digits"""
    return f"{value:.1e}"


def verdict(good):
    return "yes" if good else "**no**"
