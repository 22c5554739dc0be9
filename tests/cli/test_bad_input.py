"""What the reader of scenes cannot see: meshes, water and bodies that do not fit, places that cannot be written, broken checkpoints.
Each ends with its status and a message that names the key and what is wrong, never with a traceback."""
import os
import resource
import subprocess
import sys
import tempfile

PROGRAM = os.environ["BYSSUS"]

SCENE = """\
run: {end: 0.01, directory: out}
domain: {min: [0, 0, 0], max: [0.4, 0.2, 0.4], walls: [xmin, xmax, ymin, ymax, zmin]}
gravity: [0, 0, -9.81]
sph:
  spacing: 0.05
  fill: [water]
  water: {min: [0, 0, 0], max: [0.2, 0.2, 0.2]}
bodies: [block]
block: {mesh: block.msh, density: 1000, young: 1e5, fixed: [root], translate: [0.3, 0.1, 0.2]}
"""

# one tetrahedron; its first face is the group root, the others are the group skin
NODES = [(0, 0, 0), (0.05, 0, 0), (0, 0.05, 0), (0, 0, 0.05)]
TRIANGLES = [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)]


def mesh(tetrahedra):
    """gmsh 2.2 text with one tetrahedron or none"""
    elements = [f"2 2 {1 if i == 0 else 2} {1 if i == 0 else 2} {a} {b} {c}" for i, (a, b, c) in enumerate(TRIANGLES)] + [f"4 2 3 3 {a} {b} {c} {d}" for a, b, c, d in tetrahedra]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 1 "root"', '2 2 "skin"', '3 3 "volume"', "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(NODES))] + [f"{i + 1} {x} {y} {z}" for i, (x, y, z) in enumerate(NODES)] + ["$EndNodes"]
    lines += ["$Elements", str(len(elements))] + [f"{i + 1} {e}" for i, e in enumerate(elements)] + ["$EndElements", ""]
    return "\n".join(lines)


GOOD, INVERTED, SURFACE = mesh([(1, 2, 3, 4)]), mesh([(1, 3, 2, 4)]), mesh([])

# name, mesh, text to replace, by what, status, fragments of stderr
CASES = [
    ("good", GOOD, "", "", 0, []),
    ("no such group", GOOD, "[root]", "[rot]", 2, [":9: block.fixed", "rot", "root"]),
    ("a mesh of triangles only", SURFACE, "", "", 2, [":9: block.mesh", "tetrahedra"]),
    ("an inverted element", INVERTED, "", "", 2, [":9: block.mesh", "block.msh"]),
    ("not a mesh", "hello\n", "", "", 2, [":9: block.mesh"]),
    ("a mesh that ends early", GOOD[:len(GOOD) // 2], "", "", 2, [":9: block.mesh"]),
    ("no water in the box", GOOD, "max: [0.2, 0.2, 0.2]", "max: [0.0, 0.2, 0.2]", 2, ["sph"]),
    ("water outside of the domain", GOOD, "{min: [0, 0, 0], max: [0.2, 0.2, 0.2]}", "{min: [2, 0, 0], max: [3, 0.2, 0.2]}", 2, ["sph"]),
    ("body outside of the domain", GOOD, "translate: [0.3, ", "translate: [3, ", 2, [":9: block"]),
    ("domain inside out", GOOD, "max: [0.4, 0.2, 0.4]", "max: [-0.4, 0.2, 0.4]", 2, [":2: domain"]),
    ("wall and periodic", GOOD, "walls:", "periodic: [x], walls:", 2, [":2: domain."]),
    ("probe of an unknown body", GOOD, "bodies:", "probes: [tip]\ntip: {body: blok, quantity: displacement}\nbodies:", 2, [":9: tip.body = blok"]),
    ("pressure on a wall without a patch", GOOD, "bodies:", "probes: [g]\ng: {body: zmin, quantity: pressure}\nbodies:", 2, ["g.min", "averaged over the part of it in the box"]),
    ("patch beside its wall", GOOD, "bodies:", "probes: [g]\ng: {body: zmin, min: [1, 0, 0], max: [2, 1, 1], quantity: pressure}\nbodies:", 2, [":9: g.max", "without area"]),
    ("patch on an open side", GOOD, "bodies:", "probes: [g]\ng: {body: zmax, min: [0, 0, 0], max: [1, 1, 1], quantity: pressure}\nbodies:", 2, [":9: g.body = zmax", "open side"]),
    ("flow through a box", GOOD, "bodies:", "probes: [g]\ng: {min: [0, 0, 0], max: [1, 1, 1], quantity: flow_rate}\nbodies:", 2, [":9: g.max", "normal of the rectangle"]),
    ("height in a box", GOOD, "bodies:", "probes: [g]\ng: {min: [0, 0, 0], max: [1, 1, 1], quantity: height}\nbodies:", 2, [":9: g.min", "flow_rate"]),
    ("line without samples", GOOD, "bodies:", "probes: [g]\ng: {to: [0, 0, 1], quantity: velocity}\nbodies:", 2, ["g.samples", "n on a line"]),
    ("samples without a line", GOOD, "bodies:", "probes: [g]\ng: {samples: 5, quantity: velocity}\nbodies:", 2, [":9: g.samples", "needs `to`"]),
    ("rectangle askew", GOOD, "bodies:", "probes: [g]\ng: {to: [1, 1, 1], samples: [3, 3], quantity: velocity}\nbodies:", 2, [":9: g.samples", "along two axes"]),
    ("line of heights", GOOD, "bodies:", "probes: [g]\ng: {to: [1, 1, 1], samples: 3, quantity: height}\nbodies:", 2, [":9: g.to", "belongs to `velocity` or `pressure`"]),
    ("support of an unknown group", GOOD, "fixed: [root]", "constraints: [hand], hand: {groups: [skn]}", 2, [":9: block.hand.groups", "skn", "did you mean skin"]),
    ("support of a direction that is none", GOOD, "fixed: [root]", "constraints: [hand], hand: {groups: [root], components: [w]}", 2, [":9: block.hand.components", "x, y, z"]),
    ("motion without a course", GOOD, "fixed: [root]", "constraints: [hand], hand: {kind: motion, groups: [root], translation: [0, 0, 1]}", 2, [":9: block.hand.course", "linear, quadratic, ramp"]),
    ("motion that moves nothing", GOOD, "fixed: [root]", "constraints: [hand], hand: {kind: motion, groups: [root], course: ramp, duration: 1}", 2, [":9: block.hand.translation"]),
    ("rotation without an axis", GOOD, "fixed: [root]", "constraints: [hand], hand: {kind: motion, groups: [root], angle: 90, course: ramp, duration: 1}", 2, [":9: block.hand.axis"]),
    ("ramp without a duration", GOOD, "fixed: [root]", "constraints: [hand], hand: {kind: motion, groups: [root], angle: 90, axis: [0, 0, 1], course: ramp}", 2, [":9: block.hand.duration"]),
    ("table that is not there", GOOD, "fixed: [root]", "loads: [push], push: {groups: [skin], pressure: 1, course: table, table: none.csv}", 2, [":9: block.push.table", "none.csv"]),
    ("table that does not ascend", GOOD, "fixed: [root]", "loads: [push], push: {groups: [skin], pressure: 1, course: table, table: table.csv}", 2, [":9: block.push.table", "does not ascend", "line 3"]),
    ("symmetry plane that is none", GOOD, "fixed: [root]", "constraints: [mirror], mirror: {kind: symmetry, groups: [skin]}", 2, [":9: block.mirror.groups", "not plane"]),
    ("node both held and moved", GOOD, "fixed: [root]", "fixed: [root], constraints: [hand], hand: {kind: motion, groups: [skin], translation: [0, 0, 1], course: linear, duration: 1}", 2, [":9: block.hand.groups", "of which node", "block.fixed"]),
    ("load of nothing", GOOD, "fixed: [root]", "loads: [push], push: {groups: [skin]}", 2, [":9: block.push.pressure", "zero"]),
    ("pressure on a volume", GOOD, "fixed: [root]", "loads: [push], push: {groups: [volume], pressure: 1}", 2, [":9: block.push.groups", "not a surface"]),
    ("force beside the body", GOOD, "fixed: [root]", "loads: [push], push: {at: [1, 1, 1], force: [0, 0, 1]}", 2, [":9: block.push.at", "outside"]),
    ("contact with what is not there", GOOD, "fixed: [root]", "contact: [zmin, rok]", 2, [":9: block.contact", "rok", "zmin"]),
    ("contact with a side that is no wall", GOOD, "fixed: [root]", "contact: [zmax]", 2, [":9: block.contact", "zmax"]),
    ("a support, a load and contact", GOOD, "fixed: [root]", "contact: [zmin], constraints: [hand], hand: {groups: [root], components: [z]}, loads: [push], push: {groups: [skin], pressure: 1}", 0, []),
    ("directory that cannot be made", GOOD, "directory: out", "directory: scene.yaml/out", 2, ["scene.yaml/out"]),
    ("resume from nothing", GOOD, "", "", 2, ["resume", "none"]),
]


def run(directory, options=(), limit=None, good=False):
    def restrict():
        if limit:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    # as everywhere in PETSc, what was built before an error is left to the end of the process: leaks count in good runs only
    environment = os.environ if good else dict(os.environ, ASAN_OPTIONS="detect_leaks=0")
    return subprocess.run([PROGRAM, "run", "scene.yaml", *options], capture_output=True, text=True, cwd=directory, preexec_fn=restrict,
                          env=environment)


def write(directory, scene, text):
    with open(os.path.join(directory, "block.msh"), "w") as file:
        file.write(text)
    with open(os.path.join(directory, "scene.yaml"), "w") as file:
        file.write(scene)
    with open(os.path.join(directory, "table.csv"), "w") as file:
        file.write("0, 0\n1, 1\n0.5, 2\n")


def report(name, done, wrong):
    if wrong:
        print(f"{name}: {'; '.join(wrong)}\n--- stdout\n{done.stdout[-2000:]}--- stderr\n{done.stderr[-4000:]}---")
    return len(wrong) > 0


def check_cases():
    failures = 0
    for name, text, old, new, status, fragments in CASES:
        with tempfile.TemporaryDirectory() as directory:
            write(directory, SCENE.replace(old, new, 1) if old else SCENE, text)
            done = run(directory, ["-resume", "none"] if name.startswith("resume") else [], good=status == 0)
            wrong = [f"stderr lacks {f!r}" for f in fragments if f not in done.stderr]
            if done.returncode != status:
                wrong.append(f"status {done.returncode}, expected {status}")
            if "PETSC ERROR" in done.stderr:
                wrong.append("a traceback")
            if status == 2 and "nothing was run" not in done.stderr:
                wrong.append("no closing line")
            failures += report(name, done, wrong)
    return failures


def check_broken_checkpoints():
    """a checkpoint that is cut off, or is something else, names the file and ends with 2"""
    failures = 0
    with tempfile.TemporaryDirectory() as directory:
        write(directory, SCENE, GOOD)
        done = run(directory, good=True)
        checkpoint = os.path.join(directory, "out", "checkpoint.h5")
        if done.returncode or not os.path.exists(checkpoint):
            return report("run to its end", done, ["no checkpoint"])
        with open(checkpoint, "rb") as file:
            whole = file.read()
        for name, data in (("truncated", whole[:len(whole) // 2]), ("empty", b""), ("foreign", b"hello\n" * 100)):
            with open(checkpoint, "wb") as file:
                file.write(data)
            done = run(directory, ["-resume", "out"])
            wrong = [] if done.returncode == 2 else [f"status {done.returncode}, expected 2"]
            if "checkpoint.h5" not in done.stderr or "PETSC ERROR" in done.stderr:
                wrong.append("the file is not named, or a traceback")
            failures += report(f"{name} checkpoint", done, wrong)
    return failures


def check_full_disk():
    """files may grow to 16 kB only: the run ends with 1, says so, and leaves no half checkpoint"""
    with tempfile.TemporaryDirectory() as directory:
        write(directory, SCENE, GOOD)
        done = run(directory, limit=16384)
        wrong = [] if done.returncode == 1 else [f"status {done.returncode}, expected 1"]
        if "out/" not in done.stderr or "PETSC ERROR" in done.stderr:
            wrong.append("the file is not named, or a traceback")
        out = os.path.join(directory, "out")
        if not os.path.isdir(out) or [f for f in os.listdir(out) if f.startswith("checkpoint")]:
            wrong.append("part of a checkpoint was left")
        return report("full disk", done, wrong)


failed = check_cases() + check_broken_checkpoints() + check_full_disk()
print(f"{failed} failures")
sys.exit(1 if failed else 0)
