"""krepl contour and krepl section: what is written, read by other software, and messages."""
import csv
import io
import json
import math
import unittest
import xml.etree.ElementTree as ElementTree

import support
from test_terrain import grid

# Samples at 0.5 .. 4.5: a peak of 3 on flat ground.
PEAK = grid([[3 if (i, j) == (2, 2) else 0 for i in range(5)] for j in range(5)], corner=(0, 0))


class Cuts(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("peak.asc", PEAK)

    def test_contour_of_a_peak_is_a_circle(self):
        done = self.succeed("contour", "peak.asc", "-", "--radius", "0.5", "--level", "3.3,9")
        rows = list(csv.DictReader(io.StringIO(done.stdout)))
        self.assertEqual(len(rows), 1)
        row = rows[0]
        self.assertEqual((row["kind"], row["level"], row["hole"], row["parent"], row["wall"]), ("circle", "3.3", "0", "", "0"))
        self.assertAlmostEqual(float(row["cx"]), 2.5)
        self.assertAlmostEqual(float(row["ux"]), 0.4)
        self.assertAlmostEqual(float(row["to"]) - float(row["from"]), 2 * math.pi)

    def test_contours_in_all_formats(self):
        for name in ("c.csv", "c.gpkg", "c.fgb", "c.wkt", "c.geojson", "c.svg", "c.dxf"):
            done = self.succeed("contour", "peak.asc", name, "--radius", "0.5", "--step", "1")
            self.assertRegex(done.stdout, r"^32 triangles; 4 levels: 4 rings, 0 of them holes, of \d+ pieces", name)
        self.assertEqual(ElementTree.parse(self.directory / "c.svg").getroot().tag, "{http://www.w3.org/2000/svg}svg")
        features = json.loads(self.text("c.geojson"))["features"]
        self.assertEqual([f["properties"]["level"] for f in features], [0, 1, 2, 3])
        for f in features:
            points = f["geometry"]["coordinates"]
            self.assertEqual(points[0], points[-1])
            self.assertEqual({p[2] for p in points}, {f["properties"]["level"]})
        self.assertIn("CIRCULARSTRING Z", self.text("c.wkt"))

    def test_section(self):
        done = self.succeed("section", "peak.asc", "-", "--radius", "0.5", "--from=-1,1", "--to", "6,1")
        rows = list(csv.DictReader(io.StringIO(done.stdout)))
        self.assertAlmostEqual(float(rows[0]["x0"]), 0)
        self.assertAlmostEqual(float(rows[-1]["x1"]), 5)
        self.assertEqual([r["kind"] for r in rows if float(r["x1"]) <= 0.5 + 1e-9], ["circle"])
        for before, after in zip(rows, rows[1:]):
            self.assertEqual([before[c] for c in ("x1", "y1", "z1")], [after[c] for c in ("x0", "y0", "z0")])
        for name in ("s.gpkg", "s.svg", "s.dxf", "s.geojson"):
            self.succeed("section", "peak.asc", name, "--radius", "0.5", "--from", "0,0", "--to", "5,5", "--from", "1,0", "--to", "1,5")
        self.assertEqual(len(json.loads(self.text("s.geojson"))["features"]), 2)

    def test_wrong_usage(self):
        for options, message in (
                (["contour", "peak.asc", "o.svg", "--radius", "1"], "give either --level or --step"),
                (["contour", "peak.asc", "o.svg", "--radius", "1", "--level", "1,x"], "is not a list of finite numbers"),
                (["contour", "peak.asc", "o.wkb", "--radius", "1", "--level", "1"], "lines cannot go to format wkb"),
                (["contour", "peak.asc", "o.svg", "--radius", "1", "--step", "1e-9"], "would give"),
                (["section", "peak.asc", "o.svg", "--radius", "1", "--from", "1,2", "--to", "1,2"], "the ends of a line are equal"),
                (["section", "peak.asc", "o.svg", "--radius", "1", "--from", "1", "--to", "1,2"], "is not a place")):
            done = self.krepl(*options)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(message, done.stderr)
            self.assertFalse((self.directory / options[2]).exists())


if __name__ == "__main__":
    support.main()
