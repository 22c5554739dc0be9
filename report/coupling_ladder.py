"""coupling_ladder.py - sections of the report on added mass: a piston under a water column, and a clamped plate under one, whose frequencies are known."""

import math

import numpy as np

import draw
from draw import style
from flow import flow, percent, rms, with_probes
from program import mesh, run, table
from sections import claim

GRAVITY, DENSITY = 9.81, 1000.0
TIGHT = {"tolerance": 1e-6, "precision": "double"}  # of the fluid: what is compared are schemes, not what a pressure solve leaves

# name -> section coupler
SCHEMES = {
    "explicit": {"scheme": "explicit"},
    "mass": {"scheme": "mass"},
    "mass, beta 1/12": {"scheme": "mass", "response_beta": 1 / 12},
    "iterated": {"scheme": "iterated"},
    "iterated, no response": {"scheme": "iterated", "response": False},
    "iterated, no response, Aitken": {"scheme": "iterated", "response": False, "relaxation": "aitken"},
}

# an oscillation that fades: y = c0 + exp(-g t)(c1 cos w t + c2 sin w t)


def remainder(t, y, w, g):
    fade = np.exp(-g * t)
    basis = np.stack([np.ones_like(t), fade * np.cos(w * t), fade * np.sin(w * t)], 1)
    part = np.linalg.lstsq(basis, y, rcond=None)[0]
    return part, y - basis @ part


class Swing:
    """The least-squares oscillation through y(t), from a first guess of w [rad/s]: w, rate of decay g [1/s], mean, amplitude, rms remainder."""

    def __init__(self, t, y, w):
        g = 0.0
        for _ in range(60):
            left = remainder(t, y, w, g)[1]
            small_change = 1e-6 * w
            slope = np.stack([(remainder(t, y, w + small_change, g)[1] - left) / small_change, (remainder(t, y, w, g + small_change)[1] - left) / small_change], 1)
            change = np.clip(np.linalg.lstsq(slope, -left, rcond=None)[0], -0.05 * w, 0.05 * w)
            w, g = w + change[0], g + change[1]
            if np.max(np.abs(change)) < 1e-9 * w:
                break
        part, left = remainder(t, y, w, g)
        self.w, self.g, self.mean, self.amplitude, self.rest = w, g, part[0], math.hypot(part[1], part[2]), rms(left)


class Rung:
    """One run of a ladder: what came of it. `stable`: ran to its end, no penetration, an oscillation that does not grow and leaves less than a tenth of
    its amplitude unexplained."""

    def __init__(self, result, column, exact, amplitude, period):
        self.result, self.cpu, self.steps = result, result.cpu, result.steps
        self.applications, self.solves = result.iterations, float(result.summary["coupling"]["solves_mean"])
        self.unsettled = int(result.summary["coupling"]["unsettled_steps"])
        self.t, self.y = result.probes["time"], result.probes[column]
        self.whole = result.status == "done" and np.max(result.ledger["penetrations"]) == 0
        late = self.t > 0.5 * period
        self.swing = Swing(self.t[late], self.y[late], exact) if np.count_nonzero(late) > 20 else None
        self.stable = bool(self.whole and self.swing and self.swing.rest < 0.1 * amplitude and self.swing.g * period > -0.02 and self.swing.amplitude < 1.5 * amplitude)
        self.error = self.swing.w / exact - 1 if self.swing else math.nan
        self.fade = 1 - math.exp(-self.swing.g * period) if self.swing else math.nan

    def cell(self, *parts):
        """of a table: the parts of a stable run, else how it failed"""
        if self.stable:
            return ", ".join(parts)
        return "stopped" if self.result.status != "done" else "water inside" if not self.whole else "unstable"


def water_mass(result):
    """[kg] from the ledger's potential energy and the particles' heights"""
    return result.ledger["fluid_potential"][0] / (GRAVITY * np.mean(result.state(0).x[:, 2]))


# --- piston

WIDTH, SPRING, BLOCK, DX, LAYERS = 0.1, 1.0, 0.05, 0.025, 15
SPRING_DENSITY, STIFFER = 0.5, 20.0  # [kg/m^3] of the spring; Young's modulus of the block over that of the spring
LIFTED = 0.6                         # part of the weight that a load carries: the rest sets it off
STEPS_DEFAULT = 40                   # period over the longest step that the program takes by itself, 0.05 sqrt(h/g)
PERIODS = 4
RATIOS = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
STEPS = (20, 40, 80, 160)            # a period

PISTON = """A bar of 0.1 x 0.1 m, held sideways, of two materials: a block of {block:g} mm on a light spring of 1 m, under {layers} layers of water of {mm:g} mm ({n} particles) in a domain
that is periodic sideways. A load carries 0.6 of the weight of water and block from the start; the rest sets the piston off, by {move:.2f} dx. r: mass of the water over that of the block. The spring is
made for each r so that the period is {default} of the longest steps that the program would take, 0.05 sqrt(h/g); steps are fixed at 1/20 to 1/160 of the period. Exact: lowest
frequency of the bar's own discrete equations (lumped masses, tangent at the mean compression, the spring's mass included) with the water's mass (of the particles, {water:.4f} of rho H A) on
its top. It would stay so for ever: what fades is the scheme's. Water with a tolerance of 1e-6 in double precision, {periods} periods, fitted from 0.5 on by an oscillation that fades."""


def piston_stiffness(ratio, water):
    """Young's modulus of the spring [Pa] for the wanted period; water: mass per area [kg/m^2]"""
    period = STEPS_DEFAULT * 0.05 * math.sqrt(2 * DX / GRAVITY)
    return SPRING * (2 * math.pi / period) ** 2 * (1 + 1 / ratio) * water


def piston_exact(ratio, nominal, water):
    """lowest frequency [rad/s] of the bar of four nodes, one held, with `water` on its top; nominal: mass per area by which the bar is made"""
    E, density = piston_stiffness(ratio, nominal), nominal / ratio / BLOCK
    # neo-Hookean at poisson 0: P = E/2 (F - 1/F), tangent E/2 (1 + 1/F^2)
    F = 1 - (1 - LIFTED) * (nominal / ratio + water) * GRAVITY / E
    spring, block = 0.5 * E * (1 + 1 / F**2) / (0.5 * SPRING), STIFFER * E / BLOCK
    mass = np.array([0.5 * SPRING * SPRING_DENSITY, 0.25 * SPRING * SPRING_DENSITY + 0.5 * BLOCK * density, 0.5 * BLOCK * density + water])
    K = np.array([[2 * spring, -spring, 0], [-spring, spring + block, -block], [0, -block, block]])
    return math.sqrt(np.min(np.linalg.eigvals(K / mass[:, None]).real))


def piston_scene(ratio, dt, scheme):
    nominal = DENSITY * LAYERS * DX
    E = piston_stiffness(ratio, nominal)
    bar = {
        "mesh": str(mesh("piston")), "element": "t4", "density": nominal / ratio / BLOCK, "young": STIFFER * E, "poisson": 0, "fixed": ["bottom"], "wetted": ["top"],
        "materials": ["soft"], "soft": {"volumes": ["spring"], "density": SPRING_DENSITY, "young": E, "poisson": 0},
        "constraints": ["guide"], "guide": {"kind": "fixed", "groups": ["spring", "block"], "components": ["x", "y"]},
        "loads": ["lift"], "lift": {"groups": ["top"], "traction": [0, 0, LIFTED * (nominal + nominal / ratio) * GRAVITY]}}
    scene = {
        "domain": {"min": [0, 0, -1.1], "max": [WIDTH, WIDTH, 1.5 * LAYERS * DX], "periodic": ["x", "y"]}, "gravity": [0, 0, -GRAVITY],
        "sph": {"spacing": DX, "time_step": dt, "settle": True, "fill": ["water"], "water": {"min": [0, 0, 0], "max": [WIDTH, WIDTH, LAYERS * DX]}, **TIGHT},
        "bodies": ["bar"], "bar": bar, "coupler": scheme}
    return with_probes(scene, top={"body": "bar", "at": [WIDTH / 2, WIDTH / 2, 0], "quantity": "displacement"}, load={"body": "bar", "quantity": "force"})


def piston_run(ratio, steps, name, tag="", **sph):
    """one rung; sph: further keys of the fluid"""
    period = STEPS_DEFAULT * 0.05 * math.sqrt(2 * DX / GRAVITY)
    scene = piston_scene(ratio, period / steps, SCHEMES[name])
    scene["sph"].update(sph)
    word = name.replace(",", "").replace(" ", "_").replace("/", "_")
    result = flow(f"piston_{word}_{ratio:g}_{steps}{tag}", scene, end=PERIODS * period, output_every=period / steps * max(1, steps // 80), fields_every=PERIODS * period, allowed=("done", "breakdown"))
    nominal, water = DENSITY * LAYERS * DX, water_mass(result) / WIDTH**2
    exact = piston_exact(ratio, nominal, water)
    rung = Rung(result, "top_z", exact, (1 - LIFTED) * GRAVITY / exact**2, period)
    rung.ratio, rung.per_period, rung.water, rung.exact = ratio, steps, water / nominal, exact
    return rung


def piston_ladder():
    """(scheme, ratio, steps a period) -> Rung; schemes that take many solves at one step only"""
    found = {}
    for name in SCHEMES:
        for ratio in RATIOS:
            for steps in STEPS if "no response" not in name else (STEPS_DEFAULT,):
                found[name, ratio, steps] = piston_run(ratio, steps, name)
    return found


def signed(value):
    return f"{100 * value:+.2f} %"


def piston_tables(found):
    text = "\nError of the frequency, at steps of 1/20, 1/40, 1/80, 1/160 of the period:\n\n"
    quick = [name for name in SCHEMES if "no response" not in name]
    rows = [[name, f"{ratio:g}"] + [found[name, ratio, steps].cell(signed(found[name, ratio, steps].error)) for steps in STEPS] for name in quick for ratio in RATIOS]
    text += table(["scheme", "r"] + [f"T/{steps}" for steps in STEPS], rows)
    text += f"\nPressure solves a step (operator applications a step; seconds of the run) at T/{STEPS_DEFAULT}; steps in which the iteration did not settle are said:\n\n"

    def cost(rung):
        lost = f"; {rung.unsettled} of {rung.steps} steps unsettled" if rung.unsettled else ""
        return f"{rung.solves:.1f} ({rung.applications:.0f}; {rung.cpu:.1f} s{lost})" + ("" if rung.stable else ", " + rung.cell())

    rows = [[name] + [cost(found[name, ratio, STEPS_DEFAULT]) for ratio in RATIOS] for name in SCHEMES]
    text += table(["scheme"] + [f"r = {ratio:g}" for ratio in RATIOS], rows)
    text += "\nAmplitude that a period takes, scheme `iterated`:\n\n"
    rows = [[f"{ratio:g}"] + [found["iterated", ratio, steps].cell(percent(found["iterated", ratio, steps].fade, 1)) for steps in STEPS] for ratio in RATIOS]
    return text + table(["r"] + [f"T/{steps}" for steps in STEPS], rows)


def piston_picture(found):
    drawn, axes = draw.figure(3, width=11.5, height=3.7)
    for k, name in enumerate(SCHEMES):
        points = [(ratio, abs(found[name, ratio, STEPS_DEFAULT].error)) for ratio in RATIOS if found[name, ratio, STEPS_DEFAULT].stable]
        if points:
            axes[0].loglog(*zip(*points), marker="o", markersize=4, color=style.COLOURS[k], label=name)
    axes[0].set_xlabel("water's mass over the block's")
    axes[0].set_title("error of the frequency")
    axes[0].legend(fontsize=8, loc="lower left")
    for k, ratio in enumerate((0.1, 1.0, 10.0, 100.0)):
        points = [(1 / steps, found["iterated", ratio, steps].fade) for steps in STEPS if found["iterated", ratio, steps].stable]
        if points:
            axes[1].loglog(*zip(*points), marker="o", markersize=4, color=style.COLOURS[k], label=f"iterated, r = {ratio:g}")
    axes[1].set_xticks([1 / steps for steps in STEPS], [f"1/{steps}" for steps in STEPS])
    axes[1].minorticks_off()
    axes[1].set_xlabel("step over period")
    axes[1].set_title("amplitude lost in a period")
    axes[1].legend(fontsize=8)
    move = (1 - LIFTED) * GRAVITY / found["iterated", 10.0, STEPS_DEFAULT].exact ** 2
    for name, colour in (("explicit", 1), ("mass", 2), ("iterated", 0)):
        rung = found[name, 10.0, STEPS_DEFAULT]
        axes[2].plot(rung.t * rung.exact / (2 * math.pi), rung.y / move, color=style.COLOURS[colour], label=name, linewidth=1.3)
    axes[2].set_ylim(-3, 1)
    axes[2].set_xlabel("time [periods]")
    axes[2].set_title("top, r = 10 [sag at rest]")
    axes[2].legend(fontsize=8, loc="lower right", frameon=True, framealpha=1)
    return draw.save(drawn, "piston", "error of the frequency over the mass ratio, loss of amplitude over the step, and what the top does at r = 10")


def piston():
    found = piston_ladder()
    some = found["iterated", 1.0, STEPS_DEFAULT]
    head = PISTON.format(block=1000 * BLOCK, layers=LAYERS, mm=1000 * DX, n=some.result.n, default=STEPS_DEFAULT, water=some.water, periods=PERIODS, move=2 * (1 - LIFTED) * GRAVITY / some.exact**2 / DX)
    quick = [name for name in SCHEMES if "no response" not in name]
    for name in quick:
        rungs = [found[name, ratio, steps] for ratio in RATIOS for steps in STEPS]
        good = [rung for rung in rungs if rung.stable]
        worst = max((abs(rung.error) for rung in good if rung.per_period >= STEPS_DEFAULT), default=math.nan)
        claim(f"piston, scheme {name}, r = 0.1 to 100, steps of T/20 to T/160", f"{len(good)} of {len(rungs)} stable, frequency within {percent(worst)} from T/40 on", "",
              "all stable, 1 %" if name == "iterated" else "", len(good) == len(rungs) and worst < 0.01 if name == "iterated" else None)
    return head + "\n" + piston_tables(found) + piston_picture(found)


# --- clamped plate

SPAN, DEPTH, THICK, COLUMN, POISSON = 1.0, 0.2, 0.1, 0.5, 0.3
PLATE_DX, PLATE_LIFTED = 0.05, 0.8
PLATE_RATIOS, PLATE_STEPS, FINE_RATIOS = (1.0, 3.0, 10.0, 30.0), (20, 40, 80), (1.0, 30.0)
PLATE_SCHEMES = ("explicit", "mass", "iterated")
CLAMPED = (4.730040745, 10.99560784, 17.27875966)  # roots of cos b cosh b = 1, symmetric modes of a clamped beam

PLATE = """A plate of 1 x 0.1 m (quadratic elements, plane strain, both ends clamped), under {layers} layers of water of {mm:g} mm
({n} particles), 0.5 m high, 0.2 m deep and periodic there. r: mass of the water over that of the plate. A load from below carries 0.8 of the weight; the plate swings about its equilibrium
with {move:.3f} dx at its middle. Young's modulus is made for each r so that the period is about {default} of the program's longest steps. Known: linear potential flow of the column above a beam
of the plate's own dry frequency (of a run without water on the same mesh), with three modes: a part W_n cos(n pi x/L) of the deflection moves rho tanh(k_n H)/k_n of water, n = 0 rho H.
The last rows: the same with {fine:g} mm, {fine_steps} steps a period and scheme `iterated`. All with a tolerance of 1e-6 in double precision."""


def plate_modes(x):
    """symmetric modes of a clamped beam over [0, SPAN], mean square 1: beta L, values"""
    values = []
    for beta in CLAMPED:
        s = (math.cosh(beta) - math.cos(beta)) / (math.sinh(beta) - math.sin(beta))
        z = beta * x / SPAN
        values.append(np.cosh(z) - np.cos(z) - s * (np.sinh(z) - np.sin(z)))
    return np.array(values)


def plate_wet(dry, ratio, water):
    """lowest frequency [rad/s] under a column; dry: without water; water: mass per area [kg/m^2]; by the modes' added-mass matrix, all over rho_s t L"""
    x = (np.arange(4000) + 0.5) / 4000 * SPAN
    modes = plate_modes(x)
    height = water / DENSITY
    added = np.zeros((3, 3))
    for n in range(60):
        k = n * math.pi / SPAN
        moved = water if n == 0 else DENSITY * math.tanh(k * height) / k
        part = (modes * np.cos(k * x)).mean(axis=1) * (1 if n == 0 else 2)
        added += moved * np.outer(part, part) * (1 if n == 0 else 0.5)
    stiff = np.diag([dry**2 * (beta / CLAMPED[0]) ** 4 for beta in CLAMPED])
    return math.sqrt(np.min(np.linalg.eigvals(np.linalg.solve(np.eye(3) + added / (DENSITY * COLUMN / ratio), stiff)).real))


def plate_young(ratio):
    """for about the wanted period: a beam whose first mode carries 0.8 of the water as added mass"""
    period = STEPS_DEFAULT * 0.05 * math.sqrt(2 * PLATE_DX / GRAVITY)
    stiffness = (2 * math.pi / period) ** 2 * DENSITY * COLUMN * (0.8 + 1 / ratio) * (SPAN / CLAMPED[0]) ** 4
    return 12 * (1 - POISSON**2) * stiffness / THICK**3


def plate_scene(ratio, dt, scheme, dx):
    weight = DENSITY * COLUMN * (1 + 1 / ratio) * GRAVITY
    body = {
        "mesh": str(mesh("clamped_plate", 2)), "density": DENSITY * COLUMN / ratio / THICK, "young": plate_young(ratio), "poisson": POISSON, "fixed": ["left", "right"], "wetted": ["top"],
        "constraints": ["plane"], "plane": {"kind": "fixed", "groups": ["plate"], "components": ["y"]},
        "loads": ["lift"], "lift": {"groups": ["bottom"], "traction": [0, 0, (PLATE_LIFTED if scheme else 0.01) * weight]}}
    scene = {"domain": {"min": [0, 0, -0.5], "max": [SPAN, DEPTH, 1.5 * COLUMN], "walls": ["xmin", "xmax"], "periodic": ["y"]}, "gravity": [0, 0, -GRAVITY], "bodies": ["plate"], "plate": body}
    if scheme:
        scene["sph"] = {"spacing": dx, "time_step": dt, "settle": True, "fill": ["water"], "water": {"min": [0, 0, 0], "max": [SPAN, DEPTH, COLUMN]}, **TIGHT}
        scene["coupler"] = scheme
    return with_probes(scene, middle={"body": "plate", "at": [0.5 * SPAN, 0.5 * DEPTH, 0], "quantity": "displacement"})


def plate_dry(ratio):
    """frequency [rad/s] of the plate without water, from a run; the damping of bodies in water is not in it"""
    guess = math.sqrt(plate_young(ratio) * THICK**2 / (12 * (1 - POISSON**2) * DENSITY * COLUMN / ratio / THICK)) * (CLAMPED[0] / SPAN) ** 2
    end = 4 * 2 * math.pi / guess
    result = flow_dry(f"plate_dry_{ratio:g}", plate_scene(ratio, 0, None, 0), end, end / 160)
    return Swing(result["time"], result["middle_z"], guess).w


def flow_dry(name, scene, end, output_every):
    """probes of a run without water"""
    return {column: np.array(values) for column, values in run(name, scene, end, output_every)[0].items()}


def plate_run(ratio, steps, name, dry, dx=PLATE_DX, periods=3):
    period = STEPS_DEFAULT * 0.05 * math.sqrt(2 * PLATE_DX / GRAVITY)
    tag = "" if dx == PLATE_DX else f"_{1000 * dx:.0f}"
    result = flow(f"plate_{name}_{ratio:g}_{steps}{tag}", plate_scene(ratio, period / steps, SCHEMES[name], dx), end=periods * period, output_every=period / steps * max(1, steps // 80),
                  fields_every=periods * period, allowed=("done", "breakdown"))
    water = water_mass(result) / (SPAN * DEPTH)
    exact = plate_wet(dry, ratio, water)
    # at rest a clamped beam under q bends by q L^4/(384 D) at its middle
    stiffness = plate_young(ratio) * THICK**3 / (12 * (1 - POISSON**2))
    rung = Rung(result, "middle_z", exact, (1 - PLATE_LIFTED) * (DENSITY * COLUMN / ratio + water) * GRAVITY * SPAN**4 / (384 * stiffness), period)
    rung.ratio, rung.per_period, rung.exact = ratio, steps, exact
    return rung


def plate_picture(found, fine):
    drawn, axes = draw.figure(2, width=10, height=3.7)
    for k, name in enumerate(PLATE_SCHEMES):
        points = [(ratio, abs(found[name, ratio, STEPS_DEFAULT].error)) for ratio in PLATE_RATIOS if found[name, ratio, STEPS_DEFAULT].stable]
        if points:
            axes[0].loglog(*zip(*points), marker="o", markersize=4, color=style.COLOURS[(1, 2, 0)[k]], label=name)
        rung = found[name, 30.0, STEPS_DEFAULT]
        axes[1].plot(rung.t, 1000 * rung.y, color=style.COLOURS[(1, 2, 0)[k]], label=name, linewidth=1.3)
    axes[0].loglog(FINE_RATIOS, [abs(rung.error) for rung in fine], marker="s", linestyle="none", color=style.TEXT, label="iterated, fine")
    axes[0].set_xlabel("water's mass over the plate's")
    axes[0].set_title(f"error of the frequency, T/{STEPS_DEFAULT}")
    axes[0].legend(fontsize=8)
    best = found["iterated", 30.0, STEPS_DEFAULT].y
    axes[1].set_ylim(1500 * np.min(best), 500 * abs(np.min(best)))
    axes[1].set_xlabel("time [s]")
    axes[1].set_title(f"middle [mm], r = 30, T/{STEPS_DEFAULT}")
    axes[1].legend(fontsize=8)
    return draw.save(drawn, "plate_ladder", "error of the frequency over the mass ratio, and the middle of the plate at r = 30")


def plate_ladder():
    dry = {ratio: plate_dry(ratio) for ratio in PLATE_RATIOS}
    found = {(name, ratio, steps): plate_run(ratio, steps, name, dry[ratio]) for name in PLATE_SCHEMES for ratio in PLATE_RATIOS for steps in PLATE_STEPS}
    fine_dx, fine_steps = PLATE_DX / 2, 120
    fine = [plate_run(ratio, fine_steps, "iterated", dry[ratio], fine_dx, 2) for ratio in FINE_RATIOS]
    some = found["iterated", 10.0, STEPS_DEFAULT]
    head = PLATE.format(layers=round(COLUMN / PLATE_DX), mm=1000 * PLATE_DX, n=some.result.n, move=some.swing.amplitude / PLATE_DX, default=STEPS_DEFAULT, fine=1000 * fine_dx, fine_steps=fine_steps)
    rows = []
    for name in PLATE_SCHEMES:
        for ratio in PLATE_RATIOS:
            rungs = [found[name, ratio, steps] for steps in PLATE_STEPS]
            middle = found[name, ratio, STEPS_DEFAULT]
            rows.append([name, f"{ratio:g}", f"{middle.exact / (2 * math.pi):.3f}"] + [rung.cell(signed(rung.error)) for rung in rungs]
                        + [middle.cell(percent(middle.fade, 1)), f"{middle.solves:.1f} ({middle.applications:.0f})", f"{middle.cpu:.1f}"])
    for rung in fine:
        rows.append([f"iterated, {1000 * fine_dx:g} mm, T/{fine_steps}", f"{rung.ratio:g}", f"{rung.exact / (2 * math.pi):.3f}", "", rung.cell(signed(rung.error)), "", rung.cell(percent(rung.fade, 1)), f"{rung.solves:.1f} ({rung.applications:.0f})", f"{rung.cpu:.1f}"])
    for name in PLATE_SCHEMES:
        rungs = [found[name, ratio, steps] for ratio in PLATE_RATIOS for steps in PLATE_STEPS]
        good = [rung for rung in rungs if rung.stable]
        worst = max((abs(rung.error) for rung in good if rung.per_period >= STEPS_DEFAULT), default=math.nan)
        claim(f"clamped plate, scheme {name}, r = 1 to 30, steps of T/20 to T/80", f"{len(good)} of {len(rungs)} stable, frequency within {percent(worst)} from T/40 on", "",
              "all stable, 3 %" if name == "iterated" else "", len(good) == len(rungs) and worst < 0.03 if name == "iterated" else None)
    headers = ["scheme", "r", "known, Hz"] + [f"off at T/{steps}" for steps in PLATE_STEPS] + [f"amplitude lost a period, T/{STEPS_DEFAULT}", "solves (applications) a step", "cpu, s"]
    return head + "\n\n" + table(headers, rows) + plate_picture(found, fine)
