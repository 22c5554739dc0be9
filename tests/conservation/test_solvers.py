"""Every pressure solver on the free ball of test_free_body.py: momentum of fluid and body is constant to 1e-10 in double, whatever scheme the solver
can take (angular momentum of pbf to 1e-3: its XSPH acts along the difference of velocities, not along the pair's line). A light body is coupled by iterations; scheme
mass is refused, with the reason, with a solver that cannot answer to it."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()
# solver, takes the response of light bodies
for solver, responds in (("iisph_jacobi", True), ("dfsph", True), ("pcisph", False), ("pbf", False), ("wcsph", False)):
    keys = dict(sph_solver=solver, run_end=0.03)
    run = Case("free_body.yaml", **keys)
    report.true(f"{solver}: a light body is coupled by iterations", run.summary["coupling"]["scheme"] == "iterated")
    if not responds:
        bad = Case("free_body.yaml", status=2, coupler_scheme="mass", **keys)
        report.true(f"{solver}: scheme mass is refused by name", "coupler_scheme = mass" in bad.errors and f"sph.solver {solver}" in bad.errors and "iisph does" in bad.errors and "PETSC ERROR" not in bad.errors)
    work = max(abs(w) for w in run.ledger["work_solid"])
    report.true(f"{solver}: water and ball exchange energy ({work:.3g} J)", work > 1e-4)
    for what in ("momentum", "angular"):
        start = [run.ledger[f"{what}_{k}"][0] for k in "xyz"]
        scale = sum(s * s for s in start) ** 0.5
        drift = max(abs(v - start[k]) for k, axis in enumerate("xyz") for v in run.ledger[f"{what}_{axis}"])
        report.below(f"{solver}: drift of {what} over its size", drift / scale, 1e-3 if (solver, what) == ("pbf", "angular") else 1e-10)
report.end()
