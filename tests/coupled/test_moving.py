"""What moves by prescription, through the whole program: a slab with proxies pushes water as a wall of the domain does; what it does is in the
ledger; no water gets inside; a restart gives the same bits; what does not go together is refused with its key."""
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402
from shapes import box, write_off  # noqa: E402

report = Report()
slab = pathlib.Path(tempfile.mkdtemp(prefix="byssus_")) / "slab.off"
write_off(slab, *box((-0.06, 0, 0), (0, 0.08, 0.2), 4))
motion = dict(translation="0.01,0,0", course="sine", frequency=1.5, duration=0.3)
wall = dict(domain_min="0,0,0", domain_walls="xmin,xmax,ymin,ymax,zmin", domain_moving="paddle", domain_paddle_walls="xmin", **{f"domain_paddle_{k}": v for k, v in motion.items()},
            probes="push,end,power", power_body="xmin", power_quantity="power", push_body="xmin", push_quantity="force", end_body="xmax", end_quantity="force")
plate = dict(obstacles="plate", plate_surface=slab, **{f"plate_motion_{k}": v for k, v in motion.items()},
             probes="push,end,power", power_body="plate", power_quantity="power", push_body="plate", push_quantity="force", end_body="xmax", end_quantity="force")
runs = {"wall": Case("moving.yaml", **wall), "slab": Case("moving.yaml", **plate)}
for name, run in runs.items():
    energy = sum(np.array(run.ledger[k]) for k in ("fluid_kinetic", "fluid_potential", "fluid_viscous_loss"))
    work = np.array(run.ledger["work_motion"])
    report.true(f"{name}: it does work ({np.ptp(work):.3g} J)", np.ptp(work) > 1e-3)
    # water loses energy of its own, by settling, to the noise filter and where it is stopped; it must not gain any
    lost = work - (energy - energy[0])
    report.below(f"{name}: energy out of nothing, over the work's range", max(0.0, np.max(np.maximum.accumulate(lost) - lost)) / np.ptp(work), 0.02)
    power = np.array(run.probes["power"])
    report.below(f"{name}: power over time is the work, over its range", np.abs(-np.cumsum(power) * 0.01 - work).max() / np.ptp(work), 0.05)
    report.below(f"{name}: particles inside", max(run.ledger["penetrations"]), 0.5)
late = np.array(runs["wall"].probes["time"]) > 0.1
for probe in ("push_x", "end_x"):
    a, b = (np.array(runs[k].probes[probe])[late] for k in ("wall", "slab"))
    report.below(f"{probe}: slab against wall, rms over mean", np.sqrt(np.mean((a - b) ** 2)) / abs(a.mean()), 0.05)

# a restart in the middle: the same rows
half = Case("moving.yaml", run_end=0.25, **plate)
rest = Case("moving.yaml", resume=half.directory, run_end=0.5, **plate)
for key in ("fluid_kinetic", "work_motion", "angular_y"):
    report.true(f"restart: {key} to the same bits", rest.ledger[key][-1] == runs["slab"].ledger[key][-1])

refused = (("domain.paddle.walls", dict(wall, domain_walls="xmax,ymin,ymax,zmin"), "not a wall"), ("domain.paddle.course", dict(wall, domain_paddle_course="constant"), "would jump"),
           ("domain.slip", dict(wall, domain_slip="zmax"), "not a wall"), ("frame.axis", dict(wall, frame_angle=3, frame_course="sine", frame_frequency=1), "no direction"),
           ("domain.periodic", dict(wall, domain_walls="xmin,xmax,zmin", domain_periodic="y", frame_angle=3, frame_axis="1,0,0", frame_course="sine", frame_frequency=1), "turns"))
for key, keys, text in refused:
    errors = Case("moving.yaml", status=2, **keys).errors
    report.true(f"refused: {key}", (key in errors or key.replace(".", "_") in errors) and text in errors)
report.end()
