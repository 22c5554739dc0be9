"""Linear and angular momentum of fluid and free body are constant: 1e-10 relative in double, 1e-5 in single precision."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()
# the explicit scheme is for heavy bodies: added mass (method 5.3)
for precision, scheme, density, limit in (("double", "mass", 700, 1e-10), ("double", "explicit", 6000, 1e-10), ("single", "mass", 700, 1e-5)):
    run = Case("free_body.yaml", sph_precision=precision, coupler_scheme=scheme, ball_density=density)
    work = max(abs(w) for w in run.ledger["work_solid"])
    report.true(f"{precision} {scheme}: water and ball exchange energy ({work:.3g} J)", work > 1e-4)
    for what in ("momentum", "angular"):
        start = [run.ledger[f"{what}_{k}"][0] for k in "xyz"]
        scale = sum(s * s for s in start) ** 0.5
        drift = max(abs(v - start[k]) for k, axis in enumerate("xyz") for v in run.ledger[f"{what}_{axis}"])
        report.below(f"{precision} {scheme}: drift of {what} over its size", drift / scale, limit)
    report.below(f"{precision} {scheme}: particles inside the ball", run.summary["coupling"]["penetrations"], 0.5)
report.end()
