"""krepl axis: edges, clearances and formats, by shapes whose axis is known; krepl buffer by the same diagram."""
import json
import math
import re
import xml.etree.ElementTree as ElementTree

import support
from support import measure


class Axis(support.CliTest):
    def features(self, wkt, *options):
        done = self.succeed("axis", "-", "-", "--format", "geojson", *options, stdin=wkt)
        return json.loads(done.stdout)["features"]

    @staticmethod
    def length(feature):
        points = feature["geometry"]["coordinates"]
        return sum(math.dist(a, b) for a, b in zip(points, points[1:]))

    def test_rectangle(self):
        """Inside 20 x 10: a ridge of length 10 at clearance 5, four diagonals; nothing outside but the perpendiculars."""
        found = self.features("LINESTRING (0 0, 20 0, 20 10, 0 10, 0 0)")
        self.assertAlmostEqual(sum(map(self.length, found)), 10 + 20 * math.sqrt(2), places=9)
        self.assertEqual(max(f["properties"]["end_clearance"] for f in found), 5)
        self.assertEqual({f["properties"]["kind"] for f in found}, {"line"})
        self.assertEqual(len(self.features("LINESTRING (0 0, 20 0, 20 10, 0 10, 0 0)", "--all")), len(found) + 8)

    def test_parabola_within_max_error(self):
        for error in (1, 0.01):
            found = [f for f in self.features("LINESTRING (-10 0, 10 0)\nPOINT (0 4)", "--max-error", error, "--max-clearance", 6)
                     if f["properties"]["kind"] == "parabola"]
            self.assertTrue(found)
            for f in found:
                self.assertEqual(f["properties"]["min_clearance"], 2)
                self.assertEqual({f["properties"]["left_feature"], f["properties"]["right_feature"]}, {1, 2})
                points = f["geometry"]["coordinates"]
                for x, y in points:
                    self.assertAlmostEqual(y, (x * x + 16) / 8, places=9)
                    self.assertLessEqual(y, 6 + 1e-9)
                for (x0, y0), (x1, y1) in zip(points, points[1:]):
                    x, y = (x0 + x1) / 2, (y0 + y1) / 2
                    self.assertLessEqual(abs(y - (x * x + 16) / 8), 1.0001 * error)

    def test_other_formats(self):
        self.write("in.wkt", "LINESTRING (0 0, 20 0, 20 10, 0 10, 0 0)")
        self.succeed("axis", "in.wkt", "out.gpkg")
        self.succeed("axis", "in.wkt", "out.shp")
        text = self.succeed("axis", "in.wkt", "-").stdout
        self.assertTrue(all(line.startswith("LINESTRING (") for line in text.splitlines()))
        self.fail_with(2, "out.dxf: an axis cannot go to format dxf; choose gpkg, fgb, wkt, geojson, svg, shp or the name of a GDAL vector driver",
                       "axis", "in.wkt", "out.dxf", output="out.dxf")

    def test_svg_has_true_parabolas(self):
        """y = (x^2 + 16) / 8: every point of the Bezier curve lies on it, and y points down."""
        done = self.succeed("axis", "-", "-", "--format", "svg", "--max-clearance", 6, stdin="LINESTRING (-10 0, 10 0)\nPOINT (0 4)")
        root = ElementTree.fromstring(done.stdout)
        ox, oy = map(float, root.get("data-origin").split())
        found = [p for p in root if p.get("class") == "parabola"]
        self.assertTrue(found)
        for path in found:
            numbers = list(map(float, re.findall(r"[-+0-9.e]+", path.get("d"))))
            self.assertEqual(len(numbers), 6)
            points = [(x + ox, oy - y) for x, y in zip(numbers[::2], numbers[1::2])]
            for i in range(11):
                t = i / 10
                x, y = (sum(w * p[k] for w, p in zip(((1 - t) ** 2, 2 * t * (1 - t), t * t), points)) for k in (0, 1))
                self.assertAlmostEqual(y, (x * x + 16) / 8, places=9)
        self.assertEqual(len([p for p in root if p.get("class") == "input"]), 2)

    def test_the_same_bytes_for_any_number_of_threads(self):
        self.write("in.wkt", "".join(f"LINESTRING ({i} {i * i % 17}, {i + 3} {i * 7 % 13})\n" for i in range(200)))
        for threads in (1, 3):
            self.succeed("axis", "in.wkt", f"out{threads}.wkt", "--threads", threads)
        self.assertEqual(self.text("out1.wkt"), self.text("out3.wkt"))


class Engine(support.CliTest):
    def test_engines_agree_over_a_range_of_radii(self):
        wkt = "LINESTRING (0 0, 10 0, 10 10, 0 10, 0 0)\nLINESTRING (5 5, 20 5)\nPOLYGON ((30 0, 40 0, 40 9, 30 0))\nPOINT (-3 4)"
        for engine in ("intervals", "voronoi", "sweep", "auto"):
            done = self.succeed("buffer", "-", "-", "--radius", "0.5:10:0.5,30", "--engine", engine, stdin=wkt)
            zones = [measure(line) for line in done.stdout.splitlines()]
            self.assertEqual(len(zones), 21)
            if engine == "intervals":
                expected = zones
                continue
            for zone, right in zip(zones, expected):
                self.assertEqual((zone.polygons, zone.holes), (right.polygons, right.holes))
                self.assertAlmostEqual(zone.area / right.area, 1, delta=1e-12)

    def test_ranges(self):
        for text, wrong in (("1:5", "is not a range"), ("1:5:1:2", "is not a range"), ("5:1:1", "ends before it begins"),
                            ("1:1e9:1", "is more than 100000 radii")):
            done = self.krepl("buffer", "-", "-", "--radius", text, stdin="POINT (0 0)")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"--radius '{text}' {wrong}", done.stderr)
        done = self.succeed("buffer", "-", "-", "--radius", "0.1:0.3:0.1", stdin="POINT (0 0)")
        self.assertEqual(len(done.stdout.splitlines()), 3)

    def test_beyond_the_horizon(self):
        done = self.krepl("buffer", "-", "-", "--radius", "1e8", "--engine", "voronoi", stdin="LINESTRING (0 0, 1 0)")
        self.assertEqual(done.returncode, 2)
        self.assertIn("the radius 1e+08 is beyond the horizon of the Voronoi diagram; take the engine intervals", done.stderr)


if __name__ == "__main__":
    support.main()
