"""What test_series.c leaves on disk, read by others: the layout of the VTKHDF specification checked with h5py, every time of the XDMF put
together from its pieces, and where VTK has the temporal reader (9.3 and later) that reader itself. BYSSUS_SERIES is the C test."""

import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np

CELLS = {"fluid": ("PolyData", "Vertices", 1), "cylinder": ("PolyData", "Polygons", 3), "flap": ("UnstructuredGrid", None, 4), "cut": ("UnstructuredGrid", None, 4), "curved": ("UnstructuredGrid", None, 10)}
FLUID_COUNTS = [5, 5, 7, 5]


def water(step, n):
    """the values of WriteWater() in test_series.c"""
    time, i, c = 0.1 * step, np.arange(n), np.arange(3)
    return 0.01 * i[:, None] + c + time, 100 * time + i[:, None] + 0.25 * c, 1000 * time + i


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        environment = dict(os.environ, BYSSUS_TEST_DIRECTORY=cls.folder.name)
        subprocess.run([os.environ["BYSSUS_SERIES"]], env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def open(self, name):
        file = h5py.File(os.path.join(self.folder.name, name + ".vtkhdf"), "r")
        self.addCleanup(file.close)
        return file["VTKHDF"]

    def test_layout_is_that_of_the_specification(self):
        for name, (kind, category, nodes) in CELLS.items():
            with self.subTest(name):
                root = self.open(name)
                self.assertEqual(list(root.attrs["Version"]), [2, 0])
                kind_id = root.attrs.get_id("Type").get_type()
                self.assertFalse(kind_id.is_variable_str())  # older readers know fixed-length text only
                self.assertEqual(kind_id.get_cset(), h5py.h5t.CSET_ASCII)
                self.assertEqual(root.attrs["Type"], kind.encode())
                steps = root["Steps"]
                n = int(steps.attrs["NSteps"])
                self.assertEqual([len(steps[s]) for s in ("Values", "PartOffsets", "NumberOfParts", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets")], [n] * 6)
                self.assertTrue(np.all(np.diff(steps["Values"]) > 0))
                self.assertTrue(np.all(steps["NumberOfParts"][:] == 1))
                categories = ["Vertices", "Lines", "Polygons", "Strips"] if kind == "PolyData" else [None]
                self.assertEqual(steps["CellOffsets"].shape, (n, 4) if category else (n,))
                for c, group in enumerate(categories):
                    cells = root[group] if group else root
                    counts, ids = cells["NumberOfCells"][:], cells["NumberOfConnectivityIds"][:]
                    self.assertEqual(len(counts), len(root["NumberOfPoints"]))
                    self.assertEqual(len(cells["Offsets"]), np.sum(counts + 1))
                    self.assertEqual(len(cells["Connectivity"]), np.sum(ids))
                    if group != category:
                        self.assertFalse(np.any(counts))
                        continue
                    self.assertTrue(np.array_equal(ids, nodes * counts))
                    for s in range(n):  # as a reader finds the cells of a step
                        part = steps["PartOffsets"][s]
                        first = np.atleast_1d(steps["CellOffsets"][s])[c] + part
                        offsets = cells["Offsets"][first : first + counts[part] + 1]
                        self.assertTrue(np.array_equal(offsets, nodes * np.arange(counts[part] + 1)))
                        start = np.atleast_1d(steps["ConnectivityIdOffsets"][s])[c]
                        connectivity = cells["Connectivity"][start : start + ids[part]]
                        self.assertTrue(np.all((connectivity >= 0) & (connectivity < root["NumberOfPoints"][part])))
                        self.assertLessEqual(steps["PointOffsets"][s] + root["NumberOfPoints"][part], len(root["Points"]))
                for field in root["PointData"]:
                    self.assertEqual(len(root["PointData"][field]), len(root["Points"]))
                    self.assertTrue(np.array_equal(steps["PointDataOffsets"][field][:], steps["PointOffsets"][:]))

    def test_values_units_and_scene_are_there(self):
        root = self.open("fluid")
        self.assertEqual(root["PointData/velocity"].attrs["units"], b"m/s")
        self.assertEqual(root["PointData/pressure"].attrs["units"], b"Pa")
        self.assertEqual(root["Points"].attrs["units"], b"m")
        self.assertEqual(root.file["byssus/scene"][()].decode(), "run: {end: 1}  # Höhe\n")
        self.assertRegex(root.file["byssus"].attrs["version"].decode(), r"^\d+\.\d+")
        self.assertEqual(root["Points"].dtype, np.float32)
        self.assertEqual(self.open("flap")["Points"].dtype, np.float64)
        for s, n in enumerate(FLUID_COUNTS):
            start = root["Steps/PointOffsets"][s]
            for expected, name in zip(water(s, n), ("Points", "PointData/velocity", "PointData/pressure")):
                np.testing.assert_allclose(root[name][start : start + n], expected, rtol=2e-7, atol=1e-9)  # single

    def slab(self, item):
        """the values of an XDMF hyperslab"""
        selection, source = list(item)
        start, stride, count = np.array(selection.text.split(), int).reshape(3, -1)
        self.assertTrue(np.all(stride == 1))
        name, path = source.text.strip().split(":")
        with h5py.File(os.path.join(self.folder.name, name), "r") as file:
            self.assertEqual(tuple(map(int, source.get("Dimensions").split())), file[path].shape)
            self.assertEqual(int(source.get("Precision")), file[path].dtype.itemsize)
            values = file[path][tuple(slice(a, a + c) for a, c in zip(start, count))]
        self.assertEqual(tuple(map(int, item.get("Dimensions").split())), values.shape)
        return values

    def test_every_time_of_the_xdmf_has_the_values(self):
        for name, shape in (("fluid", "Polyvertex"), ("flap", "Tetrahedron"), ("cylinder", "Triangle"), ("curved", "Tetrahedron_10")):
            root = self.open(name)
            series = ElementTree.parse(os.path.join(self.folder.name, name + ".xmf")).find("Domain/Grid")
            self.assertEqual(series.get("CollectionType"), "Temporal")
            grids = series.findall("Grid")
            self.assertEqual([float(g.find("Time").get("Value")) for g in grids], list(root["Steps/Values"]))
            for s, grid in enumerate(grids):
                topology = grid.find("Topology")
                self.assertEqual(topology.get("TopologyType"), shape)
                points = self.slab(grid.find("Geometry/DataItem"))
                cells = self.slab(topology.find("DataItem"))
                self.assertEqual(len(cells), int(topology.get("NumberOfElements")) * CELLS[name][2])
                self.assertLess(cells.max(), len(points))
                fields = {a.get("Name"): self.slab(a.find("DataItem")) for a in grid.findall("Attribute")}
                self.assertEqual(sorted(fields), sorted(root["PointData"]))
                if name == "fluid":
                    for expected, values in zip(water(s, FLUID_COUNTS[s]), (points, fields["velocity"], fields["pressure"])):
                        np.testing.assert_allclose(values, expected, rtol=2e-7, atol=1e-9)

    def test_vtk_reads_quadratic_cells_in_their_order(self):
        try:
            from vtkmodules.vtkCommonCore import reference, vtkObject
            from vtkmodules.vtkIOHDF import vtkHDFReader
        except ImportError:
            self.skipTest("no VTK for Python")
        vtkObject.GlobalWarningDisplayOff()  # readers before 9.2 say that version 2.0 is newer than they are, and read it
        reader = vtkHDFReader()
        reader.SetFileName(os.path.join(self.folder.name, "curved.vtkhdf"))
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual((grid.GetNumberOfCells(), grid.GetCell(0).GetCellType()), (1, 24))
        for place in ((0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0), (0, 0, 0.5), (0.5, 0, 0.5), (0, 0.5, 0.5)):
            x, weights = [0.0] * 3, [0.0] * 10
            grid.GetCell(0).EvaluateLocation(reference(0), place, x, weights)
            self.assertEqual(tuple(x), place)

    def test_vtk_reads_every_time(self):
        try:
            from vtkmodules.vtkCommonCore import vtkVersion
            from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
            from vtkmodules.vtkIOHDF import vtkHDFReader
            from vtkmodules.util.numpy_support import vtk_to_numpy
        except ImportError:
            self.skipTest("no VTK for Python")
        if (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) < (9, 3):
            self.skipTest("VTK before 9.3 reads no temporal VTKHDF")
        reader = vtkHDFReader()
        reader.SetFileName(os.path.join(self.folder.name, "fluid.vtkhdf"))
        reader.UpdateInformation()
        times = reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS())
        np.testing.assert_allclose(times, [0, 0.1, 0.2, 0.3], rtol=1e-15)
        for s, time in enumerate(times):
            reader.UpdateTimeStep(time)
            data = reader.GetOutput()
            self.assertEqual((data.GetNumberOfPoints(), data.GetNumberOfVerts()), (FLUID_COUNTS[s],) * 2)
            np.testing.assert_allclose(vtk_to_numpy(data.GetPointData().GetArray("velocity")), water(s, FLUID_COUNTS[s])[1], rtol=2e-7)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
