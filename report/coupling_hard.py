"""coupling_hard.py - section of the report on hard cases of coupling: small scenes, each with every scheme, and the longest step that each stands."""

import re

import numpy as np

from flow import flow
from program import WORK, Failure, mesh, say, table
from sections import claim

DX, SIDE = 0.02, 0.24
SCHEMES = ("explicit", "iterated", "mass")
FACTORS = (2.0, 1.0, 0.5, 0.25)                  # of the mean step that the program takes by itself
GAIN = 0.05                                  # energy that may appear, over the largest kinetic and elastic energy, in a run that counts as stable

HARD = """Each a small scene ({few} to {many} particles of {mm:g} mm, up to {nodes:,} nodes) with each scheme, run by the program's own step. **Outcome**: *yes* = ran to its end, no particle inside a
body, every number finite; *stopped* = the run ended with a message that names step, place and reason; *refused* = the program said so before anything ran. Then the longest fixed
step `sph.time_step` that still gives a run to the end without penetration whose energy never grows by more than {gain:g} % of its largest kinetic and elastic energy, of 1/4 to 2 of
the mean step that the program takes by itself (in brackets this factor; a free-surface flow has its own bound), and of the program's own run the energy that appeared and the work at the
interface that water and body disagree on, over the work exchanged, and the solves a step."""


def tank(depth, bodies=(), height=0.36, **more):
    scene = {"domain": {"min": [0, 0, 0], "max": [SIDE, SIDE, height], "walls": ["xmin", "xmax", "ymin", "ymax", "zmin"]}, "gravity": [0, 0, -9.81], "sph": {"spacing": DX, "fill": []}}
    if depth:
        scene["sph"] = {"spacing": DX, "fill": ["pool"], "pool": {"min": [0, 0, 0], "max": [SIDE, SIDE, depth]}}
    return dict(scene, **more)


def with_block(scene, name, low, **body):
    section = dict({"mesh": str(mesh(f"hard_{name}")), "density": 500, "young": 1e5, "poisson": 0.3, "translate": list(low), "contact": ["xmin", "xmax", "ymin", "ymax", "zmin"]}, **body)
    return dict(scene, bodies=["body"], body=section)


def drop(name="cube", scale=0.08, **body):
    """a block that falls at 1 m/s onto a pool"""
    low = [0.5 * (SIDE - scale) + 0.003, 0.5 * (SIDE - scale), 0.185]
    return with_block(tank(0.16), name, low, scale=scale, velocity=[0, 0, -1], **body)


def sheet(young, **scene):
    """a sheet of 0.24 dx across the tank, held at its rim"""
    return with_block(scene["tank"], "sheet", [0, 0, 0.1], scale=SIDE, young=young, density=1100, wetted=["top", "bottom"], fixed=["sides"], contact=[])


def on_sheet(young, pool, block, velocity):
    made = tank(pool)
    made["sph"]["fill"].append("block")
    made["sph"]["block"] = dict(block, velocity=[0, 0, -velocity])
    return sheet(young, tank=made)


def squeezed():
    """a soft block whose top is pressed down by a third in a pit that it nearly fills: it bulges against floor and four walls, and the water has to leave"""
    return with_block(tank(0.14), "cube", [0.02, 0.02, 0.004], scale=0.2, young=5e4, poisson=0.45, density=1000, contact_stiffness=4e7, constraints=["press"],
                      press={"kind": "motion", "groups": ["top"], "translation": [0, 0, -0.07], "course": "ramp", "duration": 0.25})


def three_faces():
    """an obstacle two of whose closed parts share a wall, so that edges have three triangles"""
    path = WORK / "three_faces.off"
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1), (0.5, 0.5, -1)]
    faces = [(1, 0, 4), (2, 1, 4), (3, 2, 4), (0, 3, 4), (0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 0, 5), (0, 1, 2), (0, 2, 3)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("%g %g %g\n" % tuple(0.08 * c + 0.08 for c in p) for p in points) + "".join("3 %d %d %d\n" % f for f in faces), encoding="utf-8")
    return dict(tank(0.12), obstacles=["rock"], rock={"surface": str(path)})


CASES = (  # name, scene, simulated time
    *((f"density {ratio:g} of the water's", drop(density=1000 * ratio), 0.4) for ratio in (10, 2, 1, 0.5, 0.1, 0.01)),
    *((f"Young's modulus {young:.0e} Pa".replace("e+0", "e").replace("e+", "e"), drop(density=1000, young=young), 0.4 if young < 1e8 else 0.2 if young < 1e10 else 0.12) for young in (1e3, 1e5, 1e7, 1e9, 1e11)),
    ("sheet of 0.24 dx between water and water", on_sheet(1e7, 0.08, {"min": [0, 0, 0.13], "max": [SIDE, SIDE, 0.21]}, 0), 0.4),
    ("jet of 30 m/s on a membrane of 0.24 dx", on_sheet(1e9, 0, {"min": [0.08, 0.08, 0.12], "max": [0.16, 0.16, 0.3]}, 30), 0.012),
    ("squeezed between five walls in water", squeezed(), 0.4),
    ("leaves the water and comes back", with_block(tank(0.2), "cube", [0.08, 0.08, 0.02], scale=0.08, density=100), 0.7),
    ("needle triangles, 100:1", drop("needles"), 0.4),
    ("triangles of 6 dx and 0.1 dx", drop("graded", scale=0.12), 0.4),
    ("three triangles at an edge", three_faces(), 0.1),
    ("spacing 4 times the mesh's", drop("slab"), 0.3),
    ("spacing an eighth of the mesh's", drop("brick", scale=0.16), 0.4),
)


class Outcome:
    """What became of a case: `word` (yes, stopped, refused, no), `reason`; of runs that the program took up: step [s], energy that appeared, work that does not
    agree, solves a step."""

    def __init__(self, name, scene, end):
        self.word, self.reason, self.step, self.gain, self.mismatch, self.solves, self.result = "no", "", 0, np.nan, np.nan, np.nan, None
        try:
            self.result = flow(name, scene, end=end, output_every=end / 100, fields_every=end / 5, allowed=("done", "breakdown"), timeout=300)
        except Failure as failure:
            refused = re.search(r"status 2\n(.*)", str(failure), re.DOTALL)
            self.word, self.reason = ("refused", refused.group(1).replace(f"{WORK}/", "")) if refused else ("no", str(failure))
            return
        self.read()

    def read(self):
        result = self.result
        ledger, books = result.ledger, result.summary.get("coupling", {})
        finite = all(np.all(np.isfinite(column)) for column in ledger.values())
        inside = int(np.max(ledger["penetrations"]))
        self.word = "no" if not finite or inside else "yes" if result.status == "done" else "stopped"
        self.reason = f"{inside} particles inside" if inside else "not a number" if not finite else result.summary.get("reason", "")
        self.step = float(result.summary["time_end"]) / max(1, result.steps)
        live = ledger["fluid_kinetic"] + ledger["solid_kinetic"] + ledger["solid_strain"]
        given = ledger["work_motion"] + ledger["solid_external_work"] - ledger["work_solid"]  # by walls that move, and by loads
        energy = live + ledger["fluid_potential"] + ledger["solid_potential"] + ledger["solid_contact_energy"] - given
        self.gain = float(np.max(energy - energy[0]) / max(np.max(live), 1e-30))
        self.mismatch = abs(books["work_fluid"] - books["work_solid"]) / max(books["work_exchanged"], 1e-30) if "work_exchanged" in books else np.nan
        self.solves = books.get("solves_mean", 1.0)

    def stable(self):
        return self.word == "yes" and self.gain < GAIN


def with_scheme(scene, scheme, step=0.0):
    made = dict(scene, coupler={"scheme": scheme})
    if step:
        made["sph"] = dict(scene["sph"], time_step=step)
    return made


def longest_step(name, scene, end, scheme, own):
    """(factor, step [s]) of the longest stable step; (0, 0) when none is"""
    for start, way in ((1.0, 1), (0.5, -1)):
        best = 0.0
        for factor in sorted((f for f in FACTORS if (f >= start if way > 0 else f <= start)), reverse=way < 0):
            good = Outcome(f"hard/{name}_{scheme}_{factor:g}", with_scheme(scene, scheme, factor * own), end).stable()
            if good:
                best = factor
            if good != (way > 0):
                break
        if best:
            return best, best * own
    return 0.0, 0.0


def cell(outcome, longest):
    if outcome.word == "refused":
        return "refused"
    word = "**no**" if outcome.word == "no" else outcome.word
    bound = f"{1000 * longest[1]:.2g} ms ({longest[0]:g})" if longest[0] else "none"
    return f"{word}; {bound}; {100 * outcome.gain:+.1f} %; {100 * outcome.mismatch:.1f} %; {outcome.solves:.1f}"


def file_name(case):
    return re.sub(r"[^a-z0-9.]+", "_", case.lower()).strip("_")


def hard():
    found, bounds = {}, {}
    for case, scene, end in CASES:
        for scheme in SCHEMES:
            outcome = found[case, scheme] = Outcome(f"hard/{file_name(case)}_{scheme}", with_scheme(scene, scheme), end)
            bounds[case, scheme] = longest_step(file_name(case), scene, end, scheme, outcome.step) if outcome.step else (0, 0)
            say(f"{case}, {scheme}: {outcome.word} {outcome.reason[:200]}; {bounds[case, scheme]}; gain {outcome.gain:.3f}, mismatch {outcome.mismatch:.3f}")
    rows = [[case] + [cell(found[case, scheme], bounds[case, scheme]) for scheme in SCHEMES] for case, _, _ in CASES]
    sizes = [o.result for o in found.values() if o.result]
    few, many = min(r.n for r in sizes), max(r.n for r in sizes)
    nodes = max(int(r.summary["bodies"]["body"]["nodes"]) for r in sizes)
    text = HARD.format(few=few, many=many, mm=1000 * DX, nodes=nodes, gain=100 * GAIN) + "\n\n" + table(["case: outcome; longest step; energy; work; solves"] + list(SCHEMES), rows)
    reasons = [(case, scheme, o.reason.strip().replace("\n", " ")[:300]) for (case, scheme), o in found.items() if o.reason and (o.word != "refused" or scheme == SCHEMES[0])]
    if reasons:
        text += "\n" + table(["case", "scheme", "what was said"], reasons)
    for scheme in SCHEMES:
        outcomes = [found[case, scheme] for case, _, _ in CASES]
        good = sum(o.word != "no" for o in outcomes)
        steady = sum(o.word == "refused" or o.stable() for o in outcomes)
        claim(f"hard cases, scheme {scheme}: through, or a clean stop with its reason", f"{good} of {len(outcomes)}; {steady} with energy within {100 * GAIN:g} %", "", "all", good == len(outcomes))
    return text
