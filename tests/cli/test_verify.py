"""byssus verify as a user runs it: equilibrium both ways, motion, what it writes, statuses, two ranks."""
import json
import os
import subprocess
import sys
import tempfile

PROGRAM = os.environ["BYSSUS"]
SOURCE = os.environ["BYSSUS_SOURCE"]
SCENE = os.path.join(SOURCE, "examples", "verify_beam", "scene.yaml")
MOTION = os.path.join(SOURCE, "examples", "verify_motion", "scene.yaml")
# uz of the tip's centre and strain energy of the same discrete problem by an independent code: DOLFINx 0.5.2, P1, beam_h1, nu 0.3
TIP, ENERGY = -0.2709548025632535, 5.317299312167156

failures = []


def claim(what, good, detail=""):
    print(f"{'ok  ' if good else 'FAIL'} {what} {detail}")
    if not good:
        failures.append(what)


def verify(directory, *options, scene=SCENE, ranks=0):
    command = (["mpiexec", "--oversubscribe", "-n", str(ranks)] if ranks else []) + [PROGRAM, "verify", scene, "-verify_directory", directory, "-verify_picture", "false", *options]
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return subprocess.run(command, capture_output=True, text=True, env=environment, timeout=250)


def summary(directory):
    with open(os.path.join(directory, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def test_static(folder):
    directory = os.path.join(folder, "static")
    done = verify(directory)
    claim("equilibria agree: status 0", done.returncode == 0, done.stderr[-500:])
    claim("the table is printed", all(word in done.stdout for word in ("explicit, relaxed", "strain energy [J]", "force of clamp, z [N]", "tip_z [m]", "passed")))
    table = summary(directory)["bodies"]["beam"]["static"]
    claim("explicit and implicit agree to 1e-6", table["difference_max"] <= 1e-6, table["difference_max"])
    # Newton's method to round-off, relaxation to 1e-9 of the forces
    claim("implicit: the independent code's tip to 1e-8", abs(table["probes"]["tip_z"]["implicit"] / TIP - 1) < 1e-8)
    claim("explicit: the independent code's tip to 1e-6", abs(table["probes"]["tip_z"]["explicit"] / TIP - 1) < 1e-6)
    claim("implicit: the independent code's energy to 1e-8", abs(table["energy"]["implicit"] / ENERGY - 1) < 1e-8)
    claim("the clamp bears the weight", abs(table["reactions"]["clamp"]["force_z"]["implicit"] / 98.1 - 1) < 1e-8)
    for name in ("summary.json", "scene.yaml", "beam_static_explicit.vtkhdf", "beam_static_implicit.vtkhdf", "beam_static_explicit.xmf"):
        claim(f"{name} is written", os.path.exists(os.path.join(directory, name)))


def test_tolerance(folder):
    directory = os.path.join(folder, "strict")
    done = verify(directory, "-verify_tolerance", "1e-16")
    claim("over the tolerance: status 3", done.returncode == 3, done.returncode)
    claim("and says so", "FAILED: largest nodal difference" in done.stdout and summary(directory)["status"] == "failed")


def test_input(folder):
    directory = os.path.join(folder, "input")
    for what, options, fragment in (
            ("motion without a duration", ["-verify_kind", "dynamic"], "verify.duration"),
            ("steps that rise", ["-verify_steps", "0.2,0.4"], "must fall"),
            ("no such group", ["-beam_fixed", "clmp"], "clmp")):
        done = verify(directory, *options)
        claim(f"{what}: status 2 and the key", done.returncode == 2 and fragment in done.stderr and "PETSC ERROR" not in done.stderr, done.stderr[-300:])
    claim("bad input writes nothing", not os.path.exists(directory))


def test_motion(folder):
    """a short piece: the full one, with its order, is in docs/verification/solid.md"""
    directory = os.path.join(folder, "motion")
    done = verify(directory, "-verify_duration", "0.01", "-verify_samples", "2", "-verify_order", "0", "-verify_dynamic_tolerance", "0.1", scene=MOTION)
    claim("motion: status 0", done.returncode == 0, done.stdout[-300:] + done.stderr[-300:])
    table = summary(directory)["bodies"]["beam"]["dynamic"]
    claim("three explicit runs, each at half the step", abs(table["explicit_1"]["step"] / table["explicit_3"]["step"] / 4 - 1) < 0.1)
    claim("the difference falls", table["explicit_1"]["difference_max"] > table["explicit_2"]["difference_max"])
    claim("history and series are written", all(os.path.exists(os.path.join(directory, n)) for n in ("beam_dynamic.csv", "beam_dynamic_explicit.vtkhdf")))


def test_modes(folder):
    """lumped P1 frequencies of the independent code (SLEPc, shift and invert): 1e-6; the ringing solid is off by its step, (omega dt)^2/24"""
    directory = os.path.join(folder, "modes")
    done = verify(directory, "-verify_kind", "none", "-verify_modes", "4", "-verify_modes_tolerance", "1e-4")
    if "needs SLEPc" in done.stderr:
        print("without SLEPc: frequencies not tested")
        return
    claim("frequencies: status 0", done.returncode == 0, done.stdout[-300:] + done.stderr[-300:])
    modes = summary(directory)["bodies"]["beam"]["modes"]
    known = (1.1501146641734612, 1.158987861426809, 6.829834214157479, 6.997053030623273)
    worst = max(abs(modes[str(k + 1)]["eigenvalue"] / f - 1) for k, f in enumerate(known))
    claim("the independent code's lumped frequencies to 1e-6", worst < 1e-6, worst)


def test_quadratic(folder):
    """the command takes meshes of second order; at rest both ways agree as for the others"""
    directory = os.path.join(folder, "quadratic")
    done = verify(directory, "-beam_mesh", os.path.join(SOURCE, "tests", "meshes", "beam_h1_order2.msh"), "-beam_element", "t10", "-gravity", "0,0,-1")
    claim("quadratic tetrahedra: status 0", done.returncode == 0, done.stdout[-300:] + done.stderr[-300:])
    claim("their results have ten nodes a cell", 'Tetrahedron_10' in open(os.path.join(directory, "beam_static_explicit.xmf"), encoding="utf-8").read())


def test_ranks(folder):
    one, two = os.path.join(folder, "one"), os.path.join(folder, "two")
    alone, both = verify(one), verify(two, ranks=2)
    claim("two ranks: status 0", both.returncode == 0, both.stderr[-500:])
    claim("one of them prints", both.stdout.count("strain energy") == alone.stdout.count("strain energy") == 1)
    a, b = (summary(d)["bodies"]["beam"]["static"] for d in (one, two))
    claim("the same tip to 1e-10", abs(a["probes"]["tip_z"]["implicit"] / b["probes"]["tip_z"]["implicit"] - 1) < 1e-10)
    claim("the same explicit bits", a["probes"]["tip_z"]["explicit"] == b["probes"]["tip_z"]["explicit"])


def main():
    with tempfile.TemporaryDirectory() as folder:
        for test in (test_static, test_tolerance, test_input, test_motion, test_modes, test_quadratic, test_ranks):
            test(folder)
    print(f"{len(failures)} failures")
    return 1 if failures else 0


sys.exit(main())
