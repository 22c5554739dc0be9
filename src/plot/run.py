"""run.py - what a run directory holds: summary, scene, tables and time series, read and checked."""

import json
import os
import re

import h5py
import numpy as np

try:
    import yaml
except ImportError:  # then pictures do without the tank
    yaml = None


class PlotError(Exception):
    """What the user gave cannot be used; the message says which file and why."""


class Table:
    """A CSV file: `columns` name -> values, `units` name -> text. The time is not among the columns."""

    def __init__(self, path):
        try:
            with open(path, encoding="utf-8") as file:
                lines = file.read().splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise PlotError(f"{path} cannot be read: {error}") from None
        headers = [parse_header(cell) for cell in split_row(lines[0])] if lines else []
        if not headers or headers[0][0] != "time":
            raise PlotError(f"{path} is not a table of this program: its first column is not the time")
        rows = []
        for number, line in enumerate(lines[1:], 2):
            try:
                row = [float(cell) for cell in line.split(",")]
            except ValueError:
                row = []
            if len(row) == len(headers):
                rows.append(row)
            elif number < len(lines):  # a broken last row is a run that was stopped while writing
                raise PlotError(f"{path}:{number} is not a row of {len(headers)} numbers")
        data = np.array(rows, dtype=float).reshape(len(rows), len(headers))
        self.time = data[:, 0]
        self.columns = {name: data[:, c] for c, (name, _) in enumerate(headers) if c}
        self.units = {name: unit for name, unit in headers[1:]}

    def get(self, name):
        return self.columns.get(name)

    def label(self, name):
        unit = self.units.get(name, "")
        return f"{name} [{unit}]" if unit and unit != "1" else name


def split_row(line):
    """cells of a CSV header, quotes taken off"""
    cells = re.findall(r'(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))', line)
    return [quoted.replace('""', '"') if quoted else plain for quoted, plain in cells]


def parse_header(cell):
    """'tip_x [m]' -> ('tip_x', 'm')"""
    match = re.fullmatch(r"\s*(.*?)\s*(?:\[(.*)\])?\s*", cell)
    return match.group(1), match.group(2) or ""


class Series:
    """A .vtkhdf time series. kind: 'points', 'triangles' or 'tetrahedra'."""

    def __init__(self, path):
        self.path = path
        self.name = os.path.basename(path)[: -len(".vtkhdf")]
        try:
            self.file = h5py.File(path, "r", locking=False)
            group = self.file["VTKHDF"]
            steps = group["Steps"]
            self.n_steps = int(steps.attrs["NSteps"])
            self.times = steps["Values"][: self.n_steps]
            self.part = steps["PartOffsets"][: self.n_steps]
            self.point_offset = steps["PointOffsets"][: self.n_steps]
            self.n_points = group["NumberOfPoints"][:]
            self.fields = sorted(group["PointData"].keys())
            if group.attrs["Type"] in (b"UnstructuredGrid", "UnstructuredGrid"):
                self.kind = "tetrahedra"
            else:
                self.kind = "triangles" if np.sum(group["Polygons/NumberOfCells"][:]) else "points"
            self.group = group
        except (OSError, KeyError, ValueError, TypeError) as error:
            raise PlotError(f"{path} is not a series of this program or is damaged: {first_line(error)}") from None

    def _rows(self, name, step):
        try:
            start = int(self.point_offset[step])
            data = self.group[name][start : start + int(self.n_points[self.part[step]])]
        except (OSError, KeyError, ValueError, IndexError) as error:
            raise PlotError(f"{self.path} is damaged at {name}: {first_line(error)}") from None
        return np.asarray(data, dtype=float)

    def points(self, step):
        return self._rows("Points", step)

    def field(self, name, step):
        return self._rows("PointData/" + name, step)

    def unit(self, name):
        unit = self.group["PointData/" + name].attrs.get("units", b"")
        return unit.decode() if isinstance(unit, bytes) else str(unit)

    def cells(self):
        """of the first topology: triangles n x 3, tetrahedra n x 4 or, of second order, n x 10"""
        where = "" if self.kind == "tetrahedra" else "Polygons/"
        n = int(self.group[where + "NumberOfCells"][0])
        nodes = 3 if where else int(self.group["NumberOfConnectivityIds"][0]) // max(n, 1)
        return self.group[where + "Connectivity"][: n * nodes].reshape(-1, nodes)

    def triangles(self):
        """the surface: the triangles themselves, or the faces that belong to one tetrahedron only, seen from outside; a quadratic face is four"""
        cells = self.cells()
        if self.kind == "triangles":
            return cells
        faces = cells[:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]].reshape(-1, 3)
        order = np.sort(faces, axis=1)
        _, index, count = np.unique(order, axis=0, return_index=True, return_counts=True)
        outer = np.sort(index[count == 1])
        if cells.shape[1] == 4:
            return faces[outer]
        # nodes in the middle of the edges 01 12 02 03 13 23 are 4 ... 9; of each face those behind its first, second and third corner
        middle = cells[:, [[6, 5, 4], [4, 8, 7], [5, 9, 8], [7, 9, 6]]].reshape(-1, 3)[outer]
        (a, b, c), (ab, bc, ca) = faces[outer].T, middle.T
        return np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])

    def step_at(self, time):
        return int(np.argmin(np.abs(self.times - time)))

    def close(self):
        self.file.close()


def first_line(error):
    return str(error).splitlines()[0] if str(error) else type(error).__name__


class Run:
    """A run directory."""

    def __init__(self, directory):
        self.directory = directory
        self.name = os.path.basename(os.path.normpath(directory)) or directory
        if not os.path.isdir(directory):
            raise PlotError(f"{directory} is not a directory")
        names = sorted(os.listdir(directory))
        results = [n for n in names if n.endswith(".vtkhdf")]
        if "summary.json" not in names and "ledger.csv" not in names and not results:
            raise PlotError(f"{directory} is not a run directory: it has no summary.json, ledger.csv or *.vtkhdf")
        self.summary = self._read_summary() if "summary.json" in names else {}
        self.scene_text, self.scene = self._read_scene() if "scene.yaml" in names else ("", {})
        self.ledger = Table(os.path.join(directory, "ledger.csv")) if "ledger.csv" in names else None
        self.probes = Table(os.path.join(directory, "probes.csv")) if "probes.csv" in names else None
        self.profiles = self._read_profiles([n for n in names if n.endswith(".csv") and n not in ("ledger.csv", "probes.csv")])
        series = [Series(os.path.join(directory, n)) for n in results]
        series = [s for s in series if s.n_steps]
        self.fluid = next((s for s in series if s.name == "fluid" and s.kind == "points"), None)
        self.proxies = {s.name[: -len("_proxies")]: s for s in series if s.name.endswith("_proxies")}
        self.bodies = [s for s in series if s.kind != "points"]

    def _read_profiles(self, names):
        """probes on lines and rectangles: tables with a row for every time and point"""
        tables = {}
        for name in names:
            with open(os.path.join(self.directory, name), encoding="utf-8", errors="replace") as file:
                if file.readline().startswith("time [s],x [m],y [m],z [m],"):
                    tables[name[:-4]] = Table(os.path.join(self.directory, name))
        return {name: table for name, table in tables.items() if len(table.time)}

    def _read_summary(self):
        path = os.path.join(self.directory, "summary.json")
        try:
            with open(path, encoding="utf-8") as file:
                summary = json.load(file)
        except (OSError, ValueError) as error:
            raise PlotError(f"{path} cannot be read: {first_line(error)}") from None
        if not isinstance(summary, dict):
            raise PlotError(f"{path} is not a summary: it holds no object")
        return summary

    def _read_scene(self):
        path = os.path.join(self.directory, "scene.yaml")
        try:
            with open(path, encoding="utf-8", errors="replace") as file:
                text = file.read()
            scene = yaml.safe_load(text) if yaml else {}
        except OSError as error:
            raise PlotError(f"{path} cannot be read: {error}") from None
        except yaml.YAMLError as error:
            raise PlotError(f"{path} is not YAML: {first_line(error)}") from None
        return text, scene if isinstance(scene, dict) else {}

    def section(self, name):
        value = self.scene.get(name)
        return value if isinstance(value, dict) else {}

    def vector(self, section, key):
        """three numbers of the scene, or None"""
        value = self.section(section).get(key) if section else self.scene.get(key)
        try:
            vector = np.array([float(v) for v in value])
        except (TypeError, ValueError):
            return None
        return vector if vector.shape == (3,) else None

    def spacing(self):
        """particle spacing of the scene, or the median distance of near particles [m]"""
        try:
            return float(self.section("sph")["spacing"])
        except (KeyError, TypeError, ValueError):
            pass
        points = self.fluid.points(0)
        sample = points[:: max(1, len(points) // 100)][:100]
        nearest = [np.partition(np.sum((points - x) ** 2, axis=1), min(1, len(points) - 1))[min(1, len(points) - 1)] for x in sample]
        return float(np.sqrt(np.median(nearest))) or 1e-2

    def times(self):
        series = self.fluid or (self.bodies[0] if self.bodies else None)
        return series.times if series else np.array([])

    def close(self):
        for series in [self.fluid, *self.bodies, *self.proxies.values()]:
            if series:
                series.close()
