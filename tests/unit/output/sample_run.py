"""sample_run.py - a run directory without a run: water that sweeps over a bending flap and a round obstacle, written by h5py after the
specification of VTKHDF, so that pictures are tested without the solver and readers against two writers."""

import json
import os

import h5py
import numpy as np

SCENE = """# a sample
run: {end: 0.6, output_every: 0.1}
domain: {min: [0, 0, 0], max: [0.6, 0.16, 0.3], walls: [xmin, xmax, ymax, zmin]}
gravity: [0, 0, -9.81]
sph: {spacing: SPACING}   # m < 0.02 & fine
bodies: [flap]
"""


def write_series(path, times, frames, cells=None, kind="PolyData"):
    """frames: [(points, {field: values}), ...]; cells n x 3 (PolyData) or n x 4 (UnstructuredGrid), or None for points"""
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs["Version"] = np.array([2, 0])
        group.attrs.create("Type", kind.encode(), dtype=h5py.string_dtype("ascii", len(kind)))
        counts = np.array([len(x) for x, _ in frames])
        offsets = np.concatenate([[0], np.cumsum(counts)[:-1]])
        group["Points"] = np.concatenate([x for x, _ in frames]).astype("f4")
        for name in frames[0][1]:
            group["PointData/" + name] = np.concatenate([f[name] for _, f in frames]).astype("f4")
        group.require_group("PointData")
        shared = cells is not None
        parts = 1 if shared else len(frames)
        group["NumberOfPoints"] = counts[:1] if shared else counts
        steps = group.create_group("Steps")
        steps.attrs["NSteps"] = len(frames)
        steps["Values"] = np.asarray(times, float)
        steps["PartOffsets"] = np.zeros(len(frames), int) if shared else np.arange(len(frames))
        steps["NumberOfParts"] = np.ones(len(frames), int)
        steps["PointOffsets"] = offsets
        if kind == "UnstructuredGrid":
            group["NumberOfCells"], group["NumberOfConnectivityIds"] = [len(cells)], [cells.size]
            group["Connectivity"], group["Offsets"] = cells.ravel(), np.arange(0, cells.size + 1, 4)
            group["Types"] = np.full(len(cells), 10, "u1")
            steps["CellOffsets"] = steps["ConnectivityIdOffsets"] = np.zeros(len(frames), int)
            return
        used = "Polygons" if shared else "Vertices"
        for name in ("Vertices", "Lines", "Polygons", "Strips"):
            category = group.create_group(name)
            n = (np.array([len(cells)]) if shared else counts) if name == used else np.zeros(parts, int)
            nodes = 3 if shared else 1
            category["NumberOfCells"], category["NumberOfConnectivityIds"] = n, n * nodes
            category["Offsets"] = np.concatenate([np.arange(0, m * nodes + 1, nodes) for m in n])
            ids = (cells.ravel() if shared else np.concatenate([np.arange(m) for m in n])) if name == used else np.zeros(0, int)
            category["Connectivity"] = ids.astype("i8")
        start = np.zeros((len(frames), 4), int)
        if not shared:
            start[:, 0] = offsets
        steps["CellOffsets"] = steps["ConnectivityIdOffsets"] = start


def box_of_tetrahedra(n, low, high):
    """points and tetrahedra of a box of n[0] x n[1] x n[2] cubes, six tetrahedra each"""
    grids = [np.linspace(low[a], high[a], n[a] + 1) for a in range(3)]
    points = np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape([m + 1 for m in n])
    corner = [number[i : n[0] + i, j : n[1] + j, k : n[2] + k].ravel() for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    paths = [(0, 4, 6, 7), (0, 6, 2, 7), (0, 2, 3, 7), (0, 3, 1, 7), (0, 1, 5, 7), (0, 5, 4, 7)]
    return points, np.concatenate([np.stack([corner[v] for v in path], axis=1) for path in paths])


def ball_of_triangles(centre, radius, n=16):
    """points and triangles of a sphere"""
    theta, phi = np.meshgrid(np.linspace(0, np.pi, n + 1), np.arange(2 * n) * np.pi / n, indexing="ij")
    points = centre + radius * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(2 * n), indexing="ij")
    a, b = (i * 2 * n + j).ravel(), (i * 2 * n + (j + 1) % (2 * n)).ravel()
    return points, np.concatenate([np.stack([a, a + 2 * n, b], 1), np.stack([b, a + 2 * n, b + 2 * n], 1)])


def make_run(directory, n_times=7, spacing=0.012):
    os.makedirs(directory, exist_ok=True)
    times = np.linspace(0, 0.6, n_times)
    axes = [np.arange(spacing / 2, top, spacing) for top in (0.24, 0.16, 0.18)]
    water = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    water = water + np.random.default_rng(1).uniform(-0.3, 0.3, water.shape) * spacing
    rest, tets = box_of_tetrahedra((2, 8, 12), (0.34, 0.02, 0.0), (0.36, 0.14, 0.15))
    ball, triangles = ball_of_triangles(np.array([0.5, 0.08, 0.05]), 0.04)

    fluid, flap = [], []
    for t in times:
        stretch = 1 + 2.2 * t
        x = water * [stretch, 1, 1 / stretch] + 0.15 * spacing * np.sin(40 * water[:, [1, 2, 0]] * (1 + t))
        v = np.stack([2.2 * water[:, 0], 0 * x[:, 0], -2.2 * water[:, 2] / stretch**2], axis=1)
        inside = np.all((x > rest.min(axis=0) - 0.01) & (x < rest.max(axis=0) + 0.01), axis=1)
        x, v = x[~inside], v[~inside]
        fluid.append((x, {"velocity": v, "pressure": 9810 * np.maximum(0.18 / stretch - x[:, 2], 0), "density": np.full(len(x), 1000.0)}))
        u = np.stack([0.35 * t * (rest[:, 2] / 0.15) ** 2 * 0.15, 0 * rest[:, 0], -0.06 * t * (rest[:, 2] / 0.15) ** 2 * 0.15], axis=1)
        flap.append((rest + u, {"displacement": u, "velocity": 0 * u}))
    write_series(os.path.join(directory, "fluid.vtkhdf"), times, fluid)
    write_series(os.path.join(directory, "flap.vtkhdf"), times, flap, tets, "UnstructuredGrid")
    write_series(os.path.join(directory, "post.vtkhdf"), times[:1], [(ball, {})], triangles)
    proxies = [(x[::3], {"normal": 0 * x[::3], "kappa": np.ones(len(x[::3])), "area": np.ones(len(x[::3]))}) for x, _ in flap]
    write_series(os.path.join(directory, "flap_proxies.vtkhdf"), times, proxies)

    tip = np.stack([f["displacement"][-1] for _, f in flap])
    rows = [[t, *u, 9810 * 0.1 * (1 - t)] for t, u in zip(times, tip)]
    write_table(os.path.join(directory, "probes.csv"), ["time [s]", "tip_x [m]", "tip_y [m]", "tip_z [m]", '"gauge, low [Pa]"'], rows)
    kinetic = [float(0.5 * 1000 * spacing**3 * np.sum(f["velocity"] ** 2)) for _, f in fluid]
    names = ["time [s]", "step [1]", "dt [s]", "iterations [1]", "fluid_kinetic [J]", "fluid_potential [J]", "solid_kinetic [J]", "solid_strain [J]", "work_fluid [J]", "work_solid [J]", "compression_mean [1]", "compression_max [1]", "proxies [1]", "penetrations [1]", "momentum_x [kg m/s]"]
    rows = [[t, 100 * i, 1e-3 - 5e-4 * t, 5 + i % 3, k, 12 - k, 0.01 * k, 0.02 * t, -0.02 * t, 0.02 * t, 5e-4 * (1 + t), 8e-3 * (1 + t), len(proxies[0][0]), 0, k] for i, (t, k) in enumerate(zip(times, kinetic))]
    write_table(os.path.join(directory, "ledger.csv"), names, rows)
    with open(os.path.join(directory, "summary.json"), "w", encoding="utf-8") as file:
        json.dump({"status": "done", "steps": 600, "time_end": 0.6, "wall_seconds": 12.5, "phases": {"pressure": 8.25}, "fluid": {"particles": len(fluid[0][0]), "solver": "iisph", "iterations_mean": 6.0, "density_error_mean": 7e-4}, "bodies": {"flap": {"tets": len(tets)}}, "backend": "openmp", "threads": 2, "device": None}, file)
    with open(os.path.join(directory, "scene.yaml"), "w", encoding="utf-8") as file:
        file.write(SCENE.replace("SPACING", str(spacing)))


def make_verification(directory):
    """what `byssus verify` writes of one body: static, dynamic and modes"""
    os.makedirs(directory, exist_ok=True)
    rest, tets = box_of_tetrahedra((12, 2, 2), (0.0, 0.0, 0.0), (1.0, 0.1, 0.1))
    u = np.stack([-0.1 * rest[:, 0] ** 2, 0 * rest[:, 0], -0.4 * rest[:, 0] ** 2], axis=1)
    difference = 1e-7 * u * rest[:, [0]]
    for kind in ("static", "dynamic"):
        write_series(os.path.join(directory, f"beam_{kind}_explicit.vtkhdf"), [0.5], [(rest + u, {"displacement": u, "difference": difference})], tets, "UnstructuredGrid")
        write_series(os.path.join(directory, f"beam_{kind}_implicit.vtkhdf"), [0.5], [(rest + u, {"displacement": u})], tets, "UnstructuredGrid")
    times = np.linspace(0, 0.5, 21)[1:]
    tip = [[-0.1 * t, 0.0, -0.4 * t] for t in times]
    write_table(os.path.join(directory, "beam_dynamic.csv"), ["time [s]", *(f"{s}_{c} [m]" for s in ("implicit", "explicit") for c in "xyz"), '"difference, step 1.000e-04 s [m]"'],
                [[t, *x, *x, 1e-6] for t, x in zip(times, tip)])
    ring = np.arange(400) * 0.02
    write_table(os.path.join(directory, "beam_ringdown.csv"), ["time [s]", "node_x [m]", "node_y [m]", "node_z [m]", "mode_1 [kg^0.5 m]"],
                [[t, 0.0, np.sin(2 * np.pi * 1.15 * t), 0.2 * np.sin(2 * np.pi * 6.8 * t), 1.0] for t in ring])
    run = lambda step, d: {"step": step, "steps": int(0.5 / step), "difference_max": d, "difference_rms": d / 3, "energy_drift": 1e-6, "seconds": 0.1}
    body = {"nodes": len(rest), "static": {"difference_max": 1e-7}, "dynamic": {"order": 2.0, "implicit": run(1e-4, 1e-8), "explicit_1": run(2e-4, 4e-5), "explicit_2": run(1e-4, 1e-5)},
            "modes": {"1": {"eigenvalue": 1.15, "ringing": 1.15}, "2": {"eigenvalue": 6.8, "ringing": 6.8}, "tolerance": 1e-3}}
    with open(os.path.join(directory, "summary.json"), "w", encoding="utf-8") as file:
        json.dump({"command": "verify", "status": "passed", "bodies": {"beam": body}}, file)


def write_table(path, headers, rows):
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(headers) + "\n")
        for row in rows:
            file.write(",".join(repr(float(v)) for v in row) + "\n")


if __name__ == "__main__":
    import sys

    make_run(sys.argv[1], spacing=float(sys.argv[2]) if len(sys.argv) > 2 else 0.012)
