"""dynamic.py - sections of the report about motion."""

import cases
import reference
from program import run, small, table, verdict, verify

ORDER = """Explicit runs at 0.8, 0.4, 0.2 of the critical step against an implicit run (trapezoidal rule at two steps, extrapolated) on the same mesh; the body's
support is moved smoothly, by a tenth of its size or more. Differences: of all nodes at 20 times, over the largest displacement. Where the difference
comes near the reference's own error the order says nothing any more. A load that starts suddenly excites modes of the mesh's highest frequencies, which no
step resolves; their part falls from first to second order only at steps far below the critical one."""


def order():
    rows = []
    beam = cases.beam("h1", "t4", gravity=[0, 0, 0], fixed=[])
    beam["beam"].update(constraints=["shake"], shake={"groups": ["clamp"], "kind": "motion", "translation": [0, 0, 0.3], "course": "ramp", "duration": 0.4})
    for name, scene, duration in (
            ("order_cube_t4", cases.shaken_cube("t4", 0.3), 0.3), ("order_cube_anp", cases.shaken_cube("anp", 0.45), 0.3),
            ("order_cube_t10", cases.shaken_cube("t10", 0.3), 0.3), ("order_beam_t4", beam, 0.4)):
        found = verify(name, scene, kind="dynamic", duration=duration, implicit_step=0.5)
        d = found["dynamic"]
        runs = [d[f"explicit_{k}"] for k in (1, 2, 3)]
        rows.append((name[6:10], found["element"], f"{runs[0]['step']:.2e} s", *(small(r["difference_max"]) for r in runs), f"{runs[1]['order']:.2f}", f"{runs[2]['order']:.2f}",
                     small(d["implicit"]["difference_max"]), verdict(runs[2]["order"] > 1.8)))
    return ORDER + "\n\n" + table(["body", "element", "largest step", "difference", "at 1/2", "at 1/4", "order", "order", "implicit run before extrapolation", "second order"], rows)


ENERGY = """The beam h1 let go under its weight (first peak half its length), no damping, ten periods, 0.9 of the critical step: worst imbalance of kinetic +
strain + potential energy over the largest kinetic + strain energy; drift: slope of a line through the imbalance times the time, the same way.
Allowed 1e-3."""


def slope(times, values):
    """of the straight line through points"""
    n = len(times)
    t, v = sum(times) / n, sum(values) / n
    return sum((a - t) * (b - v) for a, b in zip(times, values)) / sum((a - t) ** 2 for a in times)


def energy():
    rows = []
    for element, law, poisson in (("t4", "neo_hookean", 0.3), ("t4", "st_venant_kirchhoff", 0.3), ("anp", "neo_hookean", 0.45), ("t10", "neo_hookean", 0.3)):
        period = 1 / (reference.FREQUENCIES_P2 if element == "t10" else reference.FREQUENCIES)["beam_h1"][0]
        if element == "anp":
            period = 1 / verify("energy_anp_period", cases.beam("h1", "anp", law, poisson), kind="none", modes=1, modes_tolerance=0.1)["modes"]["1"]["eigenvalue"]
        end = 10 * period
        probes, ledger = run(f"energy_{element}_{law}", cases.beam("h1", element, law, poisson), end, end / 400)
        moving = max(k + s for k, s in zip(ledger["solid_kinetic"], ledger["solid_strain"]))
        balance = [k + s + p for k, s, p in zip(ledger["solid_kinetic"], ledger["solid_strain"], ledger["solid_potential"])]
        balance = [b - balance[0] for b in balance]
        worst, drift = max(abs(b) for b in balance) / moving, slope(ledger["time"], balance) * end / moving
        rows.append((element, f"{law}, nu {poisson}", f"{end:.2f} s", f"{-min(probes['tip_z']):.3f} m", f"{moving:.2f} J", small(worst), f"{drift:+.1e}", verdict(worst < 1e-3 and abs(drift) < 1e-3)))
    return ENERGY + "\n\n" + table(["element", "law", "time", "peak", "energy", "worst imbalance", "drift", "within"], rows)


FREQUENCIES = """Lowest frequencies of the beam by SLEPc from the solid's own tangent and lumped mass, against the independent code's lumped P1 (allowed 1e-6), and
beside the peaks in the spectrum of the explicit solid ringing for ten periods at a ten-millionth of its length: those are off by the step, (omega dt)^2/24.
`t10` has a lumped mass, the reference P2 a consistent one: the difference is what lumping does."""


def frequencies():
    rows = []
    for name, known in reference.FREQUENCIES.items():
        found = verify("modes_" + name, cases.beam(name[5:], "t4"), kind="none", modes=6)["modes"]
        for k, f in enumerate(known):
            mode = found[str(k + 1)]
            error = abs(mode["eigenvalue"] / f - 1)
            rows.append((name, "t4", k + 1, f"{mode['eigenvalue']:.9f}", f"{f:.9f}", small(error), f"{mode['ringing']:.6f}", small(abs(mode["ringing"] / mode["eigenvalue"] - 1)), verdict(error < 1e-6)))
    found = verify("modes_t10", cases.beam("h1", "t10"), kind="none", modes=4)["modes"]
    for k, f in enumerate(reference.FREQUENCIES_P2["beam_h1"][:4]):
        mode = found[str(k + 1)]
        rows.append(("beam_h1", "t10", k + 1, f"{mode['eigenvalue']:.9f}", f"{f:.9f}", small(abs(mode["eigenvalue"] / f - 1)), f"{mode['ringing']:.6f}", small(abs(mode["ringing"] / mode["eigenvalue"] - 1)), ""))
    return FREQUENCIES + "\n\n" + table(["mesh", "element", "mode", "here, Hz", "reference, Hz", "difference", "ringing, Hz", "from the eigenvalue", "1e-6"], rows)


RELEASE = """The beam at rest, gravity switched on: first peak of the free end, from a cubic through ±0.08 s of samples every 0.01 s as the reference has it (implicit, lumped
mass, extrapolated to no step). Axial waves ride on the peak. Allowed 1e-4."""


def cubic_peak(times, values):
    """maximum of the cubic that fits best: time and value"""
    import numpy as np

    middle, half = 0.5 * (times[0] + times[-1]), 0.5 * (times[-1] - times[0])
    fit = np.polynomial.Polynomial.fit((np.array(times) - middle) / half, values, 3, domain=[-1, 1])
    roots = [r.real for r in fit.deriv().roots() if abs(r.imag) < 1e-12 and fit.deriv(2)(r.real) < 0]
    best = min(roots, key=abs)
    return middle + half * best, fit(best)


def release():
    rows = []
    for name, (peak, time) in reference.RELEASE.items():
        for step in ("", 5e-5):
            scene = cases.beam(name[5:], "t4", **({"step": step} if step else {}))
            probes, _ = run(f"release_{name}_{step}", scene, 0.6, 0.001)
            window = [(t, -z) for t, z in zip(probes["time"], probes["tip_z"]) if abs(t - time) <= 0.08 + 1e-9]
            found_time, found = cubic_peak([t for t, _ in window], [z for _, z in window])
            error = abs(found / peak - 1)
            rows.append((name, f"{step:g} s" if step else "0.9 of the critical", f"{found:.6f} m", f"{peak:.6f} m", small(error), f"{found_time:.5f} s", f"{time:.5f} s", verdict(error < 1e-4)))
    return RELEASE + "\n\n" + table(["mesh", "step", "peak", "reference", "difference", "at", "reference", "within"], rows)


CRITICAL = """2/omega_max by power iteration against the independent code's largest eigenvalue of the assembled system; beside it what is often used: smallest altitude
over wave speed, and the bound by the stiffest element. Allowed 2 %."""


def critical():
    rows = []
    for name, (step, altitude, element) in reference.STABLE_STEP.items():
        found = verify("critical_" + name, cases.beam(name[5:], "t4"), kind="implicit")["critical_step"]
        rows.append((name, f"{found:.6e} s", f"{step:.6e} s", f"{100 * (found / step - 1):+.3f} %", f"{altitude:.2e} s", f"{element:.2e} s", verdict(abs(found / step - 1) < 0.02)))
    return CRITICAL + "\n\n" + table(["mesh", "power iteration", "reference", "difference", "altitude / wave speed", "element bound", "within"], rows)
