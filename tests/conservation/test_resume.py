"""Half a run, resumed, is the whole run; a run is the same to the last bit on one and on two threads, in single and in double precision."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()


def table(run, name):
    return (run.directory / name).read_text()


for precision in ("single", "double"):
    whole = Case("resume.yaml", threads=2, sph_precision=precision)
    one = Case("resume.yaml", threads=1, sph_precision=precision)
    for name in ("ledger.csv", "probes.csv"):
        report.true(f"{precision}: {name} is the same on one and on two threads", table(whole, name) == table(one, name))
    report.true(f"{precision}: water and ball push each other", abs(whole.ledger["work_solid"][2]) > 1e-6)
    half = Case("resume.yaml", threads=2, sph_precision=precision, run_end=0.03)
    rest = Case("resume.yaml", threads=2, sph_precision=precision, resume=half.directory, directory=half.directory)
    for name, columns in (("ledger.csv", whole.ledger), ("probes.csv", whole.probes)):
        again = rest.ledger if name == "ledger.csv" else rest.probes
        report.true(f"{precision}: {name} of the resumed run has as many rows", len(again["time"]) == len(columns["time"]))
        worst = max(abs(a - b) / max(1e-30, max(map(abs, columns[key]))) for key in columns for a, b in zip(columns[key], again[key]))
        report.below(f"{precision}: {name} of the resumed run differs from the whole run by, of each column's size", worst, 1e-9)
report.end()
