"""Mean forces between rows carry the whole impulse: momentum + impulse of gravity and floor = 0, to round-off; rows of single moments do not."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()
run = Case("impulse.yaml")
time, momentum = run.ledger["time"], run.ledger["momentum_z"]
mass = -momentum[1] / (9.81 * time[1])  # it falls freely at first
top = mass * 9.81 * time[-1]


def missing(force):
    """largest gap in the balance of momentum at a row, over the impulse of gravity; force: on the floor, downwards, in each interval"""
    gap, impulse = 0.0, 0.0
    for k in range(1, len(time)):
        impulse += (time[k] - time[k - 1]) * force[k]
        gap = max(gap, abs(momentum[k] - momentum[0] + impulse + mass * 9.81 * time[k]))
    return gap / top


report.below("mass in free fall beside that of its particles", mass / (run.summary["fluid"]["particles"] * 1000 * 0.0125**3) - 1, 1e-3)
report.true(f"steps ({run.summary['steps']}) are more than rows", run.summary["steps"] > 4 * len(time))
report.below("gap of momentum with mean forces on the floor", missing(run.probes["floor_z"]), 1e-9)
report.below("the same with the mean pressure on all of the floor", missing([-0.01 * p for p in run.probes["patch"]]), 1e-9)
report.true(f"single moments miss impulse ({missing(run.probes['moment_z']):.2g})", missing(run.probes["moment_z"]) > 1e-2)
report.end()
