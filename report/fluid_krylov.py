"""fluid_krylov.py - section of the report on the pressure system itself: relaxed Jacobi, our bounded solvers, PETSc's KSP and TAO, from the same states."""

import os

import draw
from draw import style
from program import BUILD, WORK, Failure, attempt, execute, options, say, table
from sections import claim

TYPES = "cg,minres,cr,blmvm,gpcg"
TOLERANCES = (1e-3, 1e-4, 1e-5)
JACOBI, OURS, OTHER = "relaxed Jacobi", "Newton-CR (default)", "MPRGP"

# name, title, particles along the axes, further options
CASES = (
    ("dam_2000", "breaking dam", "16,6,24", ("-length", 0.7)),
    ("dam_11000", "breaking dam", "28,10,40", ("-length", 0.7)),
    ("dam_36000", "breaking dam", "40,15,60", ("-length", 0.7, "-samples", 3)),
    ("still_11000", "still water", "18,18,34", ("-from", 0.5, "-every", 0.02)),
    ("stills_double", "still water, double precision", "10,10,18", ("-from", 0.5, "-every", 0.02, "-sph_precision", "double", "-tolerances", "1e-5,1e-6,1e-7")),
)

KRYLOV = """One system: dt^2 D D^T p~ >= b, p~ >= 0 with equality where p~ > 0. A run under the default solver is stopped at six moments (the largest dam: three),
and each method solves the step's system from the same last pressure until the mean of |projected b - A p~| over particles with pressure or wanting it is below
the tolerance times rest density. Relaxed Jacobi stops at another measure, the mean compression; its own tolerance is lowered until it meets this one, and
its last solve alone is counted. Cells: operator applications a solve (two pair loops each), processor milliseconds on one thread. KSP and TAO
work on the system as a shell matrix (`-sph_ksp_type`, `-sph_tao_type`), TAO's `gpcg` with `-sph_tao_subset_type matrixfree`."""


def measure(name, n, extra):
    """rows (particles, method, tolerance, applications, most, ms, residual, failed) of one case"""
    path = WORK / "krylov" / (name + ".txt")
    if not (options["keep"] and path.exists()):
        os.environ["OMP_NUM_THREADS"] = "1"
        done = attempt([BUILD / "bench.krylov", "-n", n, "-types", TYPES, "-sph_tao_subset_type", "matrixfree", *extra])
        if done.returncode != 0:
            raise Failure(f"bench.krylov {name}: status {done.returncode}\n{done.stderr[-1500:]}")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(done.stdout, encoding="utf-8")
        say(f"krylov {name}")
    rows = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("krylov: "):
            cells = [cell.strip() for cell in line[len("krylov: "):].split("|")]
            rows.append((int(cells[0]), cells[1], float(cells[2]), float(cells[3]), int(cells[4]), float(cells[5]), float(cells[6]), int(cells[7])))
    return rows


def columns(rows):
    """tolerances of a case, its methods, and (method, tolerance) -> row"""
    return list(dict.fromkeys(r[2] for r in rows)), list(dict.fromkeys(r[1] for r in rows)), {(r[1], r[2]): r for r in rows}


def cell(row):
    return f"{row[3]:.1f} ({row[5]:.1f} ms)" + (f", {row[7]} not met" if row[7] else "")


def tables(found):
    text = ""
    for name, title, _, _ in CASES:
        rows = found[name]
        tolerances, methods, at = columns(rows)
        text += f"\n**{title[0].upper() + title[1:]}, {rows[0][0]:,} particles**\n\n"
        text += table(["method"] + [f"{t:.0e}" for t in tolerances], [[m] + [cell(at[m, t]) for t in tolerances] for m in methods])
    return text


def verdicts(found):
    """when a Krylov method beats relaxed Jacobi, from the numbers"""
    lines = []
    for name, title, _, _ in CASES:
        tolerances, methods, at = columns(found[name])
        krylov = [m for m in methods if m != JACOBI]
        parts = []
        for t in tolerances:
            best = min(krylov, key=lambda m: at[m, t][5])
            gain = at[JACOBI, t][5] / at[best, t][5]
            parts.append(f"at {t:.0e} {best} takes 1/{gain:.1f} of relaxed Jacobi's time" if gain > 1.15 else f"at {t:.0e} it is a tie ({gain:.2f})" if gain > 0.87 else f"at {t:.0e} relaxed Jacobi is {1 / gain:.1f} times faster")
        lines.append(f"- {title}, {found[name][0][0]:,} particles: " + "; ".join(parts) + ".")
    return "\n" + "\n".join(lines) + "\n"


def picture(found):
    drawn, axes = draw.figure(2, width=10.5, height=4.2)
    for ax, name in zip(axes, ("dam_11000", "still_11000")):
        tolerances, methods, at = columns(found[name])
        for k, method in enumerate(methods):
            ax.loglog(tolerances, [at[method, t][5] for t in tolerances], marker="osD^vP*X"[k % 8], color=style.COLOURS[k % 8], label=method)
        ax.invert_xaxis()
        ax.set_xlabel("tolerance")
        ax.set_ylabel("processor time of a solve [ms]")
        ax.set_title(f"{dict((c[0], c[1]) for c in CASES)[name]}, {found[name][0][0]:,} particles")
        ax.legend(fontsize=8)
    return draw.save(drawn, "krylov", "processor time of a solve over its tolerance")


def krylov():
    execute(["cmake", "--build", BUILD, "--target", "bench.krylov"])
    found = {name: measure(name, n, extra) for name, _, n, extra in CASES}
    _, methods, at = columns(found["dam_11000"])
    ours, jacobi, other = (at[m, 1e-5] for m in (OURS, JACOBI, OTHER))
    best = min((at[m, 1e-5] for m in methods), key=lambda r: r[5])
    claim("pressure solve, breaking dam, 11,000 particles, 1e-5", f"{ours[3]:.1f} applications, {ours[5]:.1f} ms", "", "fastest of all", ours[5] < 1.1 * best[5])
    claim("the same by relaxed Jacobi, by MPRGP", f"{jacobi[3]:.0f} ({jacobi[5]:.0f} ms), {other[3]:.1f} ({other[5]:.1f} ms)")
    return KRYLOV + "\n" + tables(found) + verdicts(found) + picture(found)
