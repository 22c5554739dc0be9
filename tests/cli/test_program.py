"""The real program: bad scenes end with status 2, the place and no traceback; check writes nothing; plot hands over to Python."""
import os
import subprocess
import sys
import tempfile

PROGRAM = os.environ["BYSSUS"]

TANK = """\
run: {end: 0.01, directory: out}
domain: {min: [0, 0, 0], max: [0.4, 0.2, 0.4], walls: [xmin, xmax, ymin, ymax, zmin]}
gravity: [0, 0, -9.81]
sph:
  spacing: 0.05
  fill: [water]
  water: {min: [0, 0, 0], max: [0.4, 0.2, 0.2]}
"""

# name, command, text to replace, by what, options, status, fragments of stderr ("@" is the scene's path)
CASES = [
    ("good scene", "check", "", "", [], 0, []),
    ("unknown key", "check", "spacing:", "spacin:", [], 2, ["@:5: sph.spacin is not a known key\n  did you mean sph.spacing (line 4 has the section)?"]),
    ("misspelt section", "check", "sph:", "shp:", [], 2, ["@:4: shp is not a known section\n  did you mean sph?"]),
    ("negative spacing", "run", "0.05", "-0.05", [], 2, ["@:5: sph.spacing = -0.05 is out of range"]),
    ("nan", "run", "-9.81", "nan", [], 2, ["@:3: gravity = [0, 0, nan] is not a finite number"]),
    ("missing block", "run", "[water]", "[water, more]", [], 2, ["@:6: sph.fill names more, but there is no section sph.more"]),
    ("doubled key", "run", "run:", "gravity: [0, 0, 0]\nrun:", [], 2, ["@:4: gravity is given twice\n  first in line 1"]),
    ("wall that is none", "run", "zmin]", "zmni]", [], 2, ["zmni", "did you mean zmin?"]),
    ("missing mesh", "run", "sph:", "bodies: [flap]\nflap: {mesh: flap.msh}\nsph:", [], 2,
     ["@:5: flap.mesh = flap.msh cannot be read: No such file or directory"]),
    ("option out of range", "run", "", "", ["-sph_spacing", "0"], 2, ["command line: -sph_spacing = 0 is out of range"]),
    ("all at once", "run", "0.05", "x", ["-gravity", "0,0"], 2, ["2 errors in @; nothing was run"]),
]


def main():
    failures = 0
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, "scene.yaml")
        for name, command, old, new, options, status, fragments in CASES:
            with open(path, "w") as file:
                file.write(TANK.replace(old, new, 1) if old else TANK)
            done = subprocess.run([PROGRAM, command, path] + options, capture_output=True, text=True, cwd=directory)
            wrong = [f"stderr lacks {f!r}" for f in fragments if f.replace("@", path) not in done.stderr]
            if done.returncode != status:
                wrong.append(f"status {done.returncode}, expected {status}")
            if status == 2 and "PETSC ERROR" in done.stderr:
                wrong.append("a traceback for bad input")
            if sorted(os.listdir(directory)) != ["scene.yaml"]:
                wrong.append(f"files were written: {os.listdir(directory)}")
            if wrong:
                failures += 1
                print(f"{name}: {'; '.join(wrong)}\n--- stdout\n{done.stdout}--- stderr\n{done.stderr}---")

        # a run that is not there is the plot program's error, and comes through
        done = subprocess.run([PROGRAM, "plot", os.path.join(directory, "none")], capture_output=True, text=True)
        if done.returncode == 0 or "none" not in done.stderr:
            failures += 1
            print(f"plot of nothing: status {done.returncode}\n{done.stderr}")
    print(f"{failures} failures")
    return 1 if failures else 0


sys.exit(main())
