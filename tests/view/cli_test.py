#!/usr/bin/env python3
"""`krepl view` on the command line: exit status, messages, and that a failed run leaves the old page alone.

    cli_test.py KREPL
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

KREPL = sys.argv[1]
ZONE = "CURVEPOLYGON(CIRCULARSTRING(-1 0, 0 -1, 1 0, 0 1, -1 0))\n"


class ViewTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.write("zone.wkt", ZONE)

    def tearDown(self):
        self.directory.cleanup()

    def path(self, name):
        return os.path.join(self.directory.name, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as out:
            out.write(text)

    def view(self, *arguments):
        return subprocess.run([KREPL, "view", *arguments], capture_output=True, text=True, cwd=self.directory.name)

    def fails(self, status, message, *arguments):
        self.write("old.html", "old")
        run = self.view(*arguments, *([] if "-o" in arguments else ["-o", "old.html"]))
        self.assertEqual(run.returncode, status, run.stderr)
        self.assertTrue(run.stderr.startswith("krepl: "), run.stderr)
        self.assertIn(message, run.stderr)
        with open(self.path("old.html"), encoding="utf-8") as page:
            self.assertEqual(page.read(), "old")
        self.assertEqual([n for n in os.listdir(self.directory.name) if n.startswith(".")], [], "temporary files")

    def test_page_and_summary(self):
        run = self.view("zone.wkt", "-o", "page.html", "--title", "Größe <1>")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertIn("page.html: 1 layers, 2 pieces", run.stdout)
        with open(self.path("page.html"), encoding="utf-8") as page:
            text = page.read()
        self.assertIn("<title>Größe &lt;1&gt;</title>", text)
        data = json.loads(re.search(r'id="page">(.*?)</script>', text)[1])
        self.assertEqual(data["title"], "Größe <1>")
        self.assertAlmostEqual(data["layers"][0]["area"], 3.141592653589793, 15)

    def surface(self, name):
        self.write("roof.off",
                   "OFF\n6 4 0\n0 0 0\n9 0 0\n9 5 4\n0 5 4\n0 9 0\n9 9 0\n3 0 1 2\n3 0 2 3\n3 3 2 5\n3 3 5 4\n")
        subprocess.run([KREPL, "terrain", self.path("roof.off"), self.path(name), "--radius", "2", "--quiet"], check=True)

    def view_surface(self, *arguments):
        run = self.view(*arguments)
        if "was built without the page" in run.stderr:
            self.skipTest(run.stderr)
        return run

    def test_surface_from_json_and_geopackage(self):
        for name in ("roof.json", "roof.gpkg"):
            self.surface(name)
            run = self.view_surface(name, "-o", "page.html", "--input", "roof.off", "--max-error", "0.05")
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertRegex(run.stdout, r"^page\.html: \d+ faces, \d+ triangles in \d+ tiles, [\d.]+ MB; open it in a browser$")
            with open(self.path("page.html"), encoding="utf-8") as page:
                data = json.loads(re.search(r'id="page">(.*?)</script>', page.read())[1])
            self.assertAlmostEqual(data["radius"], 2, 12)
            self.assertEqual([layer["role"] for layer in data["layers"]], ["surface", "terrain"])
            self.assertEqual(data["faces"]["plane"], 4)
            self.assertEqual(data["layers"][1]["triangles"], 4)

    def test_tool_path(self):
        self.write("path.ngc", "G21 G90\nG0 X0 Y4 Z9\nG1 X9 Z6 F100\nG2 X0 Y4 I-4.5 J0\n")
        self.surface("roof.json")
        run = self.view_surface("path.ngc", "-o", "page.html", "--tool", "flat:2")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertRegex(run.stdout, r"^page\.html: 2 moves, 0\.\d+ minutes, [\d.]+ MB; open it in a browser$")
        cut = ("path.ngc", "--tool", "ball:2", "--input", "roof.off", "--stock", "1,7", "--cell", "0.5")
        run = self.view(*cut, "-o", "page.html", "--before", "path.ngc,flat:1")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertRegex(run.stdout, r"2 moves, 0\.\d+ minutes, 529 dexels, gouge 0, rest \d")
        with open(self.path("page.html"), encoding="utf-8") as page:
            data = json.loads(re.search(r'id="page">(.*?)</script>', page.read())[1])
        self.assertEqual((data["tool"]["text"], data["material"]["columns"], data["path"]["moves"]), ("ball:2", 23, 2))
        self.assertEqual(self.view(*cut, "-o", "-", "--threads", "1").stdout, self.view(*cut, "-o", "-", "--threads", "2").stdout)
        self.fails(2, "does not tell its tool", "path.ngc")
        self.fails(2, "give the part with --input", "path.ngc", "--tool", "ball:2", "--cell", "1")
        self.fails(2, "belong to tool paths", "zone.wkt", "--tool", "ball:2")
        self.fails(1, "nosuch.off", "path.ngc", "--tool", "ball:2", "--input", "nosuch.off")
        self.write("bad.ngc", "G21 G90\nG0 X0 Y4 Z9\nG81 X9\n")
        self.fails(1, "line 3", "bad.ngc", "--tool", "ball:2")

    def test_options_of_the_other_kind(self):
        self.surface("roof.json")
        self.fails(2, "belong to zones", "roof.json", "--layer", "x")
        self.fails(2, "belong to surfaces", "zone.wkt", "--max-error", "1")
        self.fails(2, "--max-error", "roof.json", "--max-error", "-1")

    def test_spoilt_surface(self):
        self.surface("roof.json")
        with open(self.path("roof.json"), encoding="utf-8") as source:
            text = source.read()
        half = text.index('"half_edges":[') + len('"half_edges":[\n[')
        self.write("roof.json", text[:half] + "123456" + text[text.index(",", half):])
        self.fails(1, "half_edges[0]", "roof.json")

    def test_standard_output_is_the_page_alone(self):
        run = self.view("zone.wkt", "-o", "-")
        self.assertEqual(run.returncode, 0)
        self.assertTrue(run.stdout.startswith("<!DOCTYPE html>"))
        self.assertTrue(run.stdout.endswith("</html>\n"))
        self.assertEqual(self.view("zone.wkt", "-o", "-", "--quiet").stderr, "")

    def test_the_same_bytes_twice(self):
        self.assertEqual(self.view("zone.wkt", "-o", "-").stdout, self.view("zone.wkt", "-o", "-").stdout)

    def test_wrong_usage_is_2(self):
        self.assertEqual(self.view("zone.wkt").returncode, 2)
        self.assertEqual(self.view("-o", "page.html").returncode, 2)
        self.assertEqual(self.view("zone.wkt", "-o", "page.html", "--no-such-option").returncode, 2)

    def test_bad_input_is_1_and_says_where(self):
        self.write("line.wkt", "LINESTRING(0 0, 1 1)\n")
        self.write("empty.wkt", "")
        self.write("bad.csv", "kind,x0,y0,x1,y1,cx,cy,segment\nhalf_line,0,-inf,0,1,,,v0\nsegment,5,1,6,1,,,s0\n")
        self.write("terrain.csv", "x,z\n0,0\n1,high\n")
        self.fails(1, "nosuch.gpkg", "nosuch.gpkg")
        self.fails(1, "directory", ".")
        self.fails(1, "empty.wkt", "empty.wkt")
        self.fails(1, "give polygons", "line.wkt")
        self.fails(1, "line 3", "bad.csv")
        self.fails(1, "nosuch.wkt", "zone.wkt", "--input", "nosuch.wkt")
        self.fails(1, "terrain.csv", "zone.wkt", "--input", "terrain.csv")
        self.fails(1, "line 3", "zone.wkt", "--input", "terrain.csv")

    def test_unwritable_target_is_1(self):
        self.fails(1, "nosuch/page.html", "zone.wkt", "-o", "nosuch/page.html")
        if os.path.exists("/dev/full"):
            self.fails(1, "/dev/full", "zone.wkt", "-o", "/dev/full")

    def test_input_in_degrees_goes_where_the_result_lies(self):
        self.write("rivers.geojson", json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": [[9, 48], [9.1, 48.1]]}}]}))
        subprocess.run([KREPL, "buffer", "rivers.geojson", "zone.gpkg", "--to-crs", "EPSG:25832", "--radius", "100", "--quiet"],
                       check=True, cwd=self.directory.name)
        run = self.view("zone.gpkg", "-o", "page.html", "--input", "rivers.geojson")
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(self.path("page.html"), encoding="utf-8") as page:
            data = json.loads(re.search(r'id="page">(.*?)</script>', page.read())[1])
        self.assertIn("EPSG:25832", data["crs"])
        self.assertEqual(data["unit"], "m")
        zone, line = data["layers"]
        # A stadium: its area tells the length of the line that it is about.
        self.assertAlmostEqual(zone["area"], 200 * line["perimeter"] + 31415.926535897932, 3)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
