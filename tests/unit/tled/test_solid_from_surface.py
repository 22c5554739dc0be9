"""meshes/solid_from_surface.py as a user calls it: every kind of file gives a mesh with both groups and the size asked for; surfaces that
cannot be filled are refused with a reason and status 2.   /usr/bin/python3 tests/unit/tled/test_solid_from_surface.py"""
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = SOURCE / "meshes" / "solid_from_surface.py"


def ball(n=2, radius=0.5):
    """octahedron, each triangle cut in four n times, points on the sphere"""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(n):
        number, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in number:
                m = [points[a][k] + points[b][k] for k in range(3)]
                size = sum(x * x for x in m) ** 0.5
                number[key] = len(points)
                points.append(tuple(x / size for x in m))
            return number[key]
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return [tuple(radius * x for x in p) for p in points], triangles


def write(path, points, triangles):
    kind = path.suffix
    if kind == ".off":
        text = "OFF\n# a comment\n{} {} 0\n".format(len(points), len(triangles))
        text += "".join("{} {} {}\n".format(*p) for p in points) + "".join("3 {} {} {}\n".format(*t) for t in triangles)
    elif kind == ".obj":
        text = "".join("v {} {} {}\n".format(*p) for p in points) + "".join("f {} {} {}\n".format(*(a + 1 for a in t)) for t in triangles)
    elif kind == ".ply":
        text = "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n".format(len(points))
        text += "element face {}\nproperty list uchar int vertex_indices\nend_header\n".format(len(triangles))
        text += "".join("{} {} {}\n".format(*p) for p in points) + "".join("3 {} {} {}\n".format(*t) for t in triangles)
    else:
        data = b" " * 80 + struct.pack("<I", len(triangles))
        for t in triangles:
            data += struct.pack("<12fH", 0, 0, 0, *(x for a in t for x in points[a]), 0)
        path.write_bytes(data)
        return
    path.write_text(text)


class SolidFromSurface(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name) / "out.msh"

    def call(self, name, *words):
        return subprocess.run([sys.executable, PROGRAM, os.path.join(self.folder.name, name), "-o", self.out, *words], capture_output=True, text=True)

    def refused(self, name, reason, *words):
        done = self.call(name, *(words or ("--size", "0.3")))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(reason, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertFalse(self.out.exists())

    def test_every_kind_of_file_gives_a_solid_with_its_skin(self):
        for kind in ("stl", "off", "obj", "ply"):
            write(pathlib.Path(self.folder.name) / f"ball.{kind}", *ball())
            done = self.call(f"ball.{kind}", "--size", "0.3", "--scale", "2")
            self.assertEqual(done.returncode, 0, done.stderr)
            text = self.out.read_text()
            self.assertIn('"solid"', text)
            self.assertIn('"skin"', text)
            volume = float(done.stdout.split("volume")[1].split()[0])
            self.assertAlmostEqual(volume, 3.8182, delta=0.002)  # of the polyhedron with 128 faces in the unit sphere; four digits printed
            self.out.unlink()

    def test_the_number_asked_for_is_met(self):
        write(pathlib.Path(self.folder.name) / "ball.off", *ball())
        done = self.call("ball.off", "--tets", "700")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLessEqual(abs(int(done.stdout.split(": ")[1].split()[0]) - 700), 70)

    def test_an_open_surface_is_refused(self):
        points, triangles = ball()
        write(pathlib.Path(self.folder.name) / "open.off", points, triangles[1:])
        self.refused("open.off", "the surface is not closed: 3 open edges, the first is (")

    def test_a_turned_triangle_is_refused(self):
        points, triangles = ball()
        write(pathlib.Path(self.folder.name) / "turned.off", points, [triangles[0][::-1]] + triangles[1:])
        self.refused("turned.off", "not all turned the same way")

    def test_what_is_not_a_surface_is_refused(self):
        (pathlib.Path(self.folder.name) / "text.off").write_text("a letter, not a surface\n")
        (pathlib.Path(self.folder.name) / "text.stl").write_text("a letter, not a surface\n")
        (pathlib.Path(self.folder.name) / "short.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n")
        self.refused("text.off", "it does not begin with OFF")
        self.refused("text.stl", "no triangles")
        self.refused("short.off", "it ends within its points")
        self.refused("none.off", "no such file")
        self.refused("picture.png", "expected .stl, .off, .obj or .ply")

    def test_a_size_that_is_none_is_refused(self):
        write(pathlib.Path(self.folder.name) / "ball.off", *ball(0))
        self.refused("ball.off", "--size -1.0: expected a finite number > 0", "--size", "-1")


if __name__ == "__main__":
    unittest.main()
