"""The program as a user runs it: exit status and text, for every way of ending. The simulation is tests/cli/sample.c."""
import os
import subprocess
import sys
import tempfile

PROGRAM = os.environ["BYSSUS"]

# name, arguments ("@" is the scene's path), scene, exit status, fragments of stdout, fragments of stderr
GOOD = "sph:\n  spacing: 0.01\n"
CASES = [
    ("no argument", [], None, 2, [], ["usage: byssus"]),
    ("no scene", ["run"], None, 2, [], ["usage: byssus"]),
    ("an option where the scene belongs", ["run", "-sph_spacing", "1"], None, 2, [], ["usage: byssus"]),
    ("unknown command", ["rum", "@"], GOOD, 2, [], ["usage: byssus"]),
    ("help", ["-help"], None, 0, ["byssus run", "-sph_spacing <required>", "a finite number > 0 [m]", "Exit status"], []),
    ("help of a command", ["run", "@", "--help"], GOOD, 0, ["-sph_ends <done>"], []),
    ("info", ["info"], None, 0, ["Byssus ", "PETSc ", "HDF5 ", "METIS ", "gmsh ", "libyaml ", "openmp", "threads ", "CUDA devices"], []),
    ("keys as markdown", ["info", "-keys"], None, 0, ["| `spacing` | a finite number > 0 [m] | required | particle spacing |"], []),
    ("run", ["run", "@"], GOOD, 0, ["spacing 0.01\n"], []),
    ("check", ["check", "@"], GOOD, 0, ["plan\n"], []),
    ("override", ["run", "@", "-sph_spacing", "0.005"], GOOD, 0, ["spacing 0.005\n"], []),
    ("resume", ["run", "@", "-resume", "runs/a", "-sph_spacing", "0.02"], GOOD, 0, ["spacing 0.02\n", "resumed from runs/a\n"], []),
    ("resume without a directory", ["run", "@", "-resume"], GOOD, 2, [], ["resume: names no directory"]),
    ("failure", ["run", "@", "-sph_ends", "failure"], GOOD, 1, [], []),
    ("breakdown", ["run", "@", "-sph_ends", "breakdown"], GOOD, 3, [], []),
    ("interrupted", ["run", "@", "-sph_ends", "interrupted"], GOOD, 130, [], []),
    ("bad input behind the reader", ["run", "@", "-sph_ends", "input"], GOOD, 2, [],
     ["@:2: sph.spacing = 0.01 is too coarse for this body\n  expected at most 0.01\n1 error in @; nothing was run\n"]),
    ("unknown key", ["run", "@"], GOOD + "  spacin: 1\n", 2, [], ["@:3: sph.spacin is not a known key\n  did you mean sph.spacing"]),
    ("misspelt section", ["run", "@"], GOOD.replace("sph", "shp"), 2, [], ["@:1: shp is not a known section\n  did you mean sph?"]),
    ("negative spacing", ["run", "@"], "sph: {spacing: -0.01}\n", 2, [], ["@:1: sph.spacing = -0.01 is out of range"]),
    ("nan", ["check", "@"], "sph: {spacing: nan}\n", 2, [], ["@:1: sph.spacing = nan is not a finite number"]),
    ("two errors", ["check", "@", "-sph_end", "x"], "sph: {spacing: nan}\n", 2, [], ["2 errors in @; nothing was run\n"]),
    ("no such scene", ["run", "/no/such.yaml"], None, 2, [], ["/no/such.yaml: the scene cannot be read: No such file or directory"]),
    ("an option of PETSc's that is used", ["run", "@", "-ksp_rtol", "1e-3"], GOOD, 0, [], []),
    ("an option of PETSc's that nothing uses", ["run", "@", "-snes_rtol", "1e-3"], GOOD, 0, [],
     ["warning: nothing in this run uses the option -snes_rtol\n"]),
    ("an option of nobody's", ["run", "@", "-snow", "1"], GOOD, 2, [], ["command line: -snow is not a known option"]),
    ("log view", ["run", "@", "-log_view", ":/dev/null"], GOOD, 0, [], []),
]

# no output at all where none is due: a warning of a library's would be noise on every run
QUIET = {"run", "check", "override", "resume", "an option of PETSc's that is used", "log view"}


def main():
    failures = 0
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, "scene.yaml")
        for name, arguments, scene, status, out, err in CASES:
            if scene is not None:
                with open(path, "w") as file:
                    file.write(scene)
            done = subprocess.run([PROGRAM] + [path if a == "@" else a for a in arguments], capture_output=True, text=True, cwd=directory)
            wrong = []
            if done.returncode != status:
                wrong.append(f"status {done.returncode}, expected {status}")
            wrong += [f"stdout lacks {f!r}" for f in out if f not in done.stdout]
            wrong += [f"stderr lacks {f!r}" for f in err if f.replace("@", path) not in done.stderr]
            if name in QUIET and done.stderr:
                wrong.append("stderr is not empty")
            if status == 2 and "PETSC ERROR" in done.stderr:
                wrong.append("a traceback for bad input")
            if not arguments and len(done.stderr.splitlines()) != 2:
                wrong.append("usage is not two lines")
            if wrong:
                failures += 1
                print(f"{name}: {'; '.join(wrong)}\n--- stdout\n{done.stdout}--- stderr\n{done.stderr}---")
    print(f"{len(CASES) - failures} of {len(CASES)} cases pass")
    return 1 if failures else 0


sys.exit(main())
