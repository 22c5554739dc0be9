"""fluid_marin.py - section of the report on a dam break in space: a wave against a box, SPHERIC test 2."""

import numpy as np

import draw
from flow import curve_error, data, flow, order, percent, rms, shown, tank, with_probes
from program import WORK, table
from sections import claim

MARIN = """SPHERIC test 2 (MARIN; Kleefsman et al. 2005): tank 3.22 x 1 x 1 m, water 1.228 m long and 0.55 m deep at one end, a box 0.161 x 0.403 x 0.161 m with its front
2.3955 m from that end; 6 s. Water heights at H4 (0.582 m from that end, in the reservoir), H3 (1.732 m), H2 (2.228 m) and H1 (2.724 m, behind the box); pressures on the box's front
0.021, 0.061, 0.101, 0.141 m above the floor (P1 to P4) and on its top 0.021 to 0.141 m behind the front edge (P5 to P8), here at mid-width. {gauge}
Errors: rms over 6 s over the rms of the experiment's record, means over 20 ms (heights) and 5 ms (pressures)."""

LENGTH, WIDTH, DEPTH, RESERVOIR = 3.22, 1.0, 0.55, 1.228
FRONT, BOX = 2.3955, (0.161, 0.403, 0.161)
LAYERS = (10, 14, 18)  # spacings a depth
END = 6.0
HEIGHTS = {"H1": 2.724, "H2": 2.228, "H3": 1.732, "H4": 0.582}  # from the reservoir's end; in the document from the other: 0.496, 0.992, 1.488, 2.638
SHOWN = ("P1", "P3", "P5", "P7")


def write_box(path, low, high):
    """a closed box of triangles, seen from outside, as OFF"""
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    lines = [f"OFF\n{len(corners)} {len(triangles)} 0"] + [" ".join(f"{v:g}" for v in c) for c in corners] + ["3 " + " ".join(map(str, t)) for t in triangles]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


def sensor(name):
    """place of a pressure sensor"""
    k = int(name[1]) - 1
    along = 0.021 + 0.04 * (k % 4)
    return (FRONT, WIDTH / 2, along) if k < 4 else (FRONT + along, WIDTH / 2, BOX[2])


def patch(name, dx):
    """box that cuts a sensor's patch out of the face: a spacing and a half along the height (P1 to P4) or the flow (P5 to P8), four spacings across"""
    at = sensor(name)
    half = [0.75 * dx, 2 * dx, 0.75 * dx]
    half[0 if name < "P5" else 2] = 1e-3
    low = [max(a - h, f) for a, h, f in zip(at, half, (0, 0, 0))]
    return {"min": low, "max": [a + h for a, h in zip(at, half)]}


def scene(layers):
    dx = DEPTH / layers
    low = (FRONT, 0.5 * (WIDTH - BOX[1]), 0.0)
    box = write_box(WORK / "meshes" / "marin_box.off", low, (low[0] + BOX[0], low[1] + BOX[1], BOX[2]))
    base = tank((0, 0, 0), (LENGTH, WIDTH, 2.0), fills={"water": {"min": [0, 0, 0], "max": [RESERVOIR, WIDTH, DEPTH]}}, spacing=dx, density=1000)
    base = dict(base, obstacles=["box"], box={"surface": box, "proxy": {"adaptive": False}})
    gauges = {name: {"at": [x, WIDTH / 2, 0], "quantity": "height"} for name, x in HEIGHTS.items()}
    for k in range(1, 9):
        gauges[f"P{k}"] = {"body": "box", "quantity": "pressure", "mean": True, **patch(f"P{k}", dx)}
    return with_probes(base, push={"body": "box", "quantity": "force", "mean": True}, **gauges)


def measure(layers):
    result = flow(f"marin_{layers}", scene(layers), end=END, output_every=0.005, fields_every=0.2)
    heights, pressures = data("spheric2_heights"), data("spheric2_pressures")
    t = result.probes["time"]
    found = {"dx": DEPTH / layers, "layers": layers, "n": result.n, "cpu": result.cpu, "t": t, "probes": result.probes, "result": result, "iterations": result.iterations,
             "through": int(np.max(result.ledger["penetrations"]))}
    for name in HEIGHTS:
        found[name] = curve_error(t, smooth(result.probes[name], 4), heights["t_s"], heights[name + "_m"])
    for k in range(1, 9):
        found[f"P{k}"] = curve_error(t, result.probes[f"P{k}"], pressures["t_s"], pressures[f"P{k}_Pa"])
    early = t < 0.6
    found["peak"], found["peak_time"] = float(np.max(result.probes["P1"][early])), float(t[early][np.argmax(result.probes["P1"][early])])
    return found


def smooth(values, n):
    """running mean over n outputs, as the records' means"""
    return np.convolve(np.pad(values, (n // 2, n - 1 - n // 2), mode="edge"), np.ones(n) / n, mode="valid")


def picture(runs):
    heights, pressures = data("spheric2_heights"), data("spheric2_pressures")
    drawn, axes = draw.figure(4, 2, width=13, height=6.2)
    for ax, name in zip(axes[0], ("H4", "H3", "H2", "H1")):
        draw.curves(ax, [(f"dx H/{r['layers']}", r["t"], smooth(r["probes"][name], 4)) for r in runs], known=[("experiment", heights["t_s"], heights[name + "_m"])],
                    xlabel="time [s]", ylabel="height [m]", title=name, legend=name == "H4")
    for ax, name in zip(axes[1], SHOWN):
        draw.curves(ax, [(f"dx H/{r['layers']}", r["t"], r["probes"][name] / 1000) for r in runs], known=[("experiment", pressures["t_s"], pressures[name + "_Pa"] / 1000)],
                    xlabel="time [s]", ylabel="pressure [kPa]", title=name, legend=False)
    text = draw.save(drawn, "marin", "heights and pressures over time against the experiment")
    drawn, axes = draw.figure(rows=2, columns=2, width=10.5, height=4.4)
    fine = runs[-1]
    for ax, moment in zip(axes.ravel(), (0.4, 0.6, 1.0, 2.0)):
        state = fine["result"].state_at(moment)
        draw.particles(ax, state.x, np.linalg.norm(state.v, axis=1), fine["dx"], label="speed [m/s]", limits=(0, 3), box=((0, 0, 0), (LENGTH, 0, 1)))
        ax.add_patch(draw.plt.Rectangle((FRONT, 0), BOX[0], BOX[2], color="0.62"))
        ax.set_title(f"t = {moment} s", fontsize=10)
    return text + draw.save(drawn, "marin_particles", "particles of the middle slice at four times")


def marin():
    runs = [measure(layers) for layers in LAYERS]
    sizes, fine = [r["dx"] for r in runs], runs[-1]
    columns = ["H1", "H2", "H3", "H4", *(f"P{k}" for k in range(1, 9))]
    slopes = {name: order(sizes, [r[name] for r in runs]) for name in columns}
    rows = [(f"{1000 * r['dx']:.1f}", f"{r['n']:,}", *(percent(r[name], 0) for name in columns), f"{r['peak'] / 1000:.1f} at {r['peak_time']:.3f}", f"{r['iterations']:.0f}", r["through"], f"{r['cpu']:.0f}") for r in runs]
    rows.append(("order", "", *(shown(slopes[name]) for name in columns), "", "", "", ""))
    mean = {key: [rms([r[name] for name in columns if name[0] == key]) for r in runs] for key in "HP"}
    claim("3D dam break with box, heights (rms of four)", percent(mean["H"][-1], 0), shown(order(sizes, mean["H"])))
    claim("3D dam break with box, pressures (rms of eight)", percent(mean["P"][-1], 0), shown(order(sizes, mean["P"])))
    claim("3D dam break with box, first peak at P1 (11.24 kPa)", percent(abs(fine["peak"] / 11239 - 1), 0))
    gauge = "Pressure: force on a patch of the box's surface, 1.5 spacings by four, over its area, mean over 5 ms. P1's patch reaches into the corner of box and floor, P5's over the edge of the top, where a particle's force is shared between both faces."
    return (MARIN.format(gauge=gauge) + "\n\n" + table(["dx, mm", "particles", *columns, "peak of P1, kPa at s", "applications a step", "particles in the box", "cpu, s"], rows) + picture(runs))
