"""Every example that ships starts, takes a few steps, and has no water inside a body; the command is that of its README."""
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

source = pathlib.Path(os.environ["BYSSUS_SOURCE"])
report = Report()
for scene in sorted(source.glob("examples/*/scene.yaml")):
    name = scene.parent.name
    if name.startswith("verify_"):  # run by cli.verify
        report.true(f"{name}: its README says how to run it", f"byssus verify examples/{name}/scene.yaml" in (scene.parent / "README.md").read_text())
        continue
    run = Case(scene, run_max_steps=4, run_output_every=1e-3)
    report.true(f"{name}: takes steps ({run.summary['steps']})", run.summary["steps"] >= 4)
    report.below(f"{name}: particles inside bodies", max(run.ledger["penetrations"]), 0.5)
    readme = (scene.parent / "README.md").read_text()
    report.true(f"{name}: its README says how to run it", f"byssus run examples/{name}/scene.yaml" in readme)
report.end()
