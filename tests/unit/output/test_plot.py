"""byssus plot as a user runs it, on a directory that sample_run.py makes: all pictures and the page appear and show something, several
runs are compared, and a directory that is not a run or is damaged is one line and status 2. Needs no display."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import matplotlib.image
import numpy as np

import sample_run

PLOT = os.path.join(os.environ["BYSSUS_SOURCE"], "src", "plot", "plot.py")
PICTURES = ["final.png", "moments.png", "probes.png", "energies.png", "solver.png"]


def plot(*arguments):
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run([sys.executable, PLOT, "-width", "560", *arguments], env=environment, capture_output=True, text=True, check=False)


class Plot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.good = os.path.join(cls.folder.name, "good")
        sample_run.make_run(cls.good, spacing=0.02)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def copy(self, name):
        path = os.path.join(self.folder.name, name)
        shutil.copytree(self.good, path, ignore=shutil.ignore_patterns("plots"))
        self.addCleanup(shutil.rmtree, path)
        return path

    def assert_shows_something(self, path, least=0.02):
        image = matplotlib.image.imread(path)[..., :3]
        self.assertGreaterEqual(min(image.shape[:2]), 300)
        self.assertGreater(image.std(), least, path)
        corner = image[:4, :4].reshape(-1, 3)
        self.assertGreater(np.mean(np.any(np.abs(image - corner.mean(axis=0)) > 0.1, axis=2)), 0.02, path)

    def test_verification(self):
        run = os.path.join(self.folder.name, "verification")
        sample_run.make_verification(run)
        result = plot(run)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        plots = os.path.join(run, "plots")
        self.assertEqual(sorted(os.listdir(plots)), ["index.html", "verification.png"])
        self.assert_shows_something(os.path.join(plots, "verification.png"))

    def test_pictures_and_page(self):
        result = plot(self.good)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        plots = os.path.join(self.good, "plots")
        self.assertEqual(sorted(os.listdir(plots)), sorted(PICTURES + ["index.html"]))
        for name in PICTURES:
            self.assert_shows_something(os.path.join(plots, name))
        final = matplotlib.image.imread(os.path.join(plots, "final.png"))[..., :3]
        blue = np.mean((final[..., 2] > final[..., 0] + 0.15) & (final[..., 2] > 0.4))
        red = np.mean((final[..., 0] > final[..., 2] + 0.2) & (final[..., 0] > 0.4))
        self.assertGreater(blue, 0.05)  # the water
        self.assertGreater(red, 0.005)  # the bent flap
        with open(os.path.join(plots, "index.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertEqual(len(re.findall(r'src="data:image/png;base64,', page)), len(PICTURES))
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:)', page), [])  # nothing from elsewhere
        self.assertIn("# m &lt; 0.02 &amp; fine", page)  # the scene, escaped
        self.assertIn("<td>phases.pressure</td><td>8.25</td>", page)
        self.assertIn("prefers-color-scheme: dark", page)

    def test_two_runs_are_compared(self):
        a, b = self.copy("a"), self.copy("b")
        for path in (a, b):  # only tables: quick
            for name in os.listdir(path):
                if name.endswith(".vtkhdf"):
                    os.unlink(os.path.join(path, name))
        result = plot(a, b)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for path in (a, b):
            self.assert_shows_something(os.path.join(path, "plots", "compare.png"), 0.01)
            self.assertEqual(sorted(os.listdir(os.path.join(path, "plots"))), ["compare.png", "energies.png", "index.html", "probes.png", "solver.png"])

    def test_a_solid_alone_and_a_run_that_has_just_begun(self):
        path = self.copy("solid")
        for name in ("fluid.vtkhdf", "post.vtkhdf", "flap_proxies.vtkhdf", "probes.csv", "summary.json", "scene.yaml"):
            os.unlink(os.path.join(path, name))
        with open(os.path.join(path, "ledger.csv"), encoding="utf-8") as file:
            lines = file.readlines()
        with open(os.path.join(path, "ledger.csv"), "w", encoding="utf-8") as file:
            file.write("".join(lines[:2]) + "0.1,2")  # one row, and one that was cut
        result = plot(path)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assert_shows_something(os.path.join(path, "plots", "final.png"))

    def test_a_run_that_broke_down(self):
        path = self.copy("broken")
        os.unlink(os.path.join(path, "ledger.csv"))
        with h5py.File(os.path.join(path, "fluid.vtkhdf"), "r+") as file:
            file["VTKHDF/Points"][-40:-20] = np.nan
            file["VTKHDF/Points"][-20:] = 1e12
            file["VTKHDF/PointData/velocity"][-60:] = np.inf
        with h5py.File(os.path.join(path, "flap.vtkhdf"), "r+") as file:
            file["VTKHDF/Points"][-5:] = np.nan
            file["VTKHDF/PointData/displacement"][-5:] = np.nan
        result = plot(path)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assert_shows_something(os.path.join(path, "plots", "final.png"), 0.1)

    def assert_refused(self, path, *words):
        result = plot(path)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for word in ("byssus plot: ", *words):
            self.assertIn(word, result.stderr)

    def test_what_is_not_a_run_is_refused(self):
        self.assert_refused(os.path.join(self.folder.name, "nowhere"), "nowhere is not a directory")
        empty = os.path.join(self.folder.name, "empty")
        os.makedirs(empty, exist_ok=True)
        self.assert_refused(empty, "not a run directory", "summary.json")
        self.assertEqual(plot().returncode, 2)
        self.assert_refused("-width", "expected a number of pixels")
        self.assert_refused("-colour", "-colour is not an option")

    def test_damaged_files_are_named(self):
        def damage(name, change):
            path = self.copy("damaged_" + name)
            with open(os.path.join(path, name), "rb") as file:
                data = file.read()
            with open(os.path.join(path, name), "wb") as file:
                file.write(change(data))
            return path

        self.assert_refused(damage("summary.json", lambda d: d[:50]), "summary.json cannot be read")
        self.assert_refused(damage("fluid.vtkhdf", lambda d: d[: len(d) // 2]), "fluid.vtkhdf is not a series")
        self.assert_refused(damage("flap.vtkhdf", lambda d: b"mesh"), "flap.vtkhdf is not a series")
        self.assert_refused(damage("ledger.csv", lambda d: re.sub(rb"(\n.*\n)[^,]*,", rb"\1zero,", d, count=1)), "ledger.csv:3")
        self.assert_refused(damage("probes.csv", lambda d: b"x,y\n1,2\n"), "probes.csv is not a table")
        self.assert_refused(damage("scene.yaml", lambda d: b"run: {end: [\n"), "scene.yaml is not YAML")

    def test_a_page_that_cannot_be_written(self):
        path = self.copy("blocked")
        with open(os.path.join(path, "plots"), "w", encoding="utf-8"):
            pass
        result = plot(path)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, f"cannot write {path}/plots: File exists\n")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
