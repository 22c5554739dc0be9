"""Half a run, resumed, is the whole run, and a run is the same on one and on two threads, to the last bit: in single and in double precision, with every scheme."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()


def table(run, name):
    return (run.directory / name).read_text()


CASES = (("single", dict(sph_precision="single")), ("double", dict(sph_precision="double")),
         ("explicit", dict(coupler_scheme="explicit", ball_density=6000)),
         ("iterated", dict(coupler_scheme="iterated", coupler_tolerance=1e-4)),
         ("Aitken", dict(coupler_scheme="iterated", coupler_relaxation="aitken", coupler_forces="interpolated")),
         ("mass, three passes", dict(coupler_scheme="mass", coupler_passes=3)))

for what, keys in CASES:
    whole = Case("resume.yaml", threads=2, **keys)
    one = Case("resume.yaml", threads=1, **keys)
    for name in ("ledger.csv", "probes.csv"):
        report.true(f"{what}: {name} is the same on one and on two threads", table(whole, name) == table(one, name))
    report.true(f"{what}: water and ball push each other", abs(whole.ledger["work_solid"][2]) > 1e-6)
    half = Case("resume.yaml", threads=2, run_end=0.03, **keys)
    rest = Case("resume.yaml", threads=2, resume=half.directory, directory=half.directory, **keys)
    for name in ("ledger.csv", "probes.csv"):
        report.true(f"{what}: {name} of the resumed run is that of the whole run", table(rest, name) == table(whole, name))
report.end()
