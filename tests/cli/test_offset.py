"""krepl offset: parallel curves of lines and polygons in every format, arcs in their right sense."""
import csv
import io
import math
import re

import support
from support import Parser, piece_measure

PI = math.pi
CORNER = "LINESTRING (0 0, 10 0, 10 10)\n"
BACK = "LINESTRING (10 10, 10 0, 0 0)\n"
SQUARE = "POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0))\n"


def length(wkt):
    return sum(piece_measure(piece)[0] for piece in Parser(wkt).curve())


class Offset(support.CliTest):
    def curves(self, wkt, distance, *options):
        return self.succeed("offset", "-", "-", "--distance", distance, *options, stdin=wkt).stdout.splitlines()

    def rows(self, name, layer):
        self.need("ogr2ogr")
        text = self.ogr("ogr2ogr", "-f", "CSV", "/vsistdout/", name, layer, "-lco", "GEOMETRY=AS_WKT")
        return list(csv.DictReader(io.StringIO(text)))

    def test_both_sides_of_a_corner(self):
        self.assertEqual(self.curves(CORNER, 1), ["LINESTRING (0 1, 9 1, 9 10)"])
        right, = self.curves(CORNER, -1)
        self.assertRegex(right, r"^COMPOUNDCURVE \(\(0 -1, 10 -1\), CIRCULARSTRING \(10 -1, 10.707\d+ -0.707\d+, 11 0\), \(11 0, 11 10\)\)$")
        self.assertAlmostEqual(length(right), 20 + PI / 2)
        back, = self.curves(BACK, 1)
        self.assertRegex(back, r"^COMPOUNDCURVE \(\(11 10, 11 0\), CIRCULARSTRING \(11 0, 10.707\d+ -0.707\d+, 10 -1\), \(10 -1, 0 -1\)\)$")

    def test_polygons(self):
        for distance, expected in (("1", 40 + 2 * PI), ("-1", 32)):
            curve, = self.curves(SQUARE, distance)
            self.assertAlmostEqual(length(curve), expected)
        self.assertEqual(self.curves(SQUARE, "-5.5"), [])

    def test_several_distances_and_their_attributes(self):
        self.write("in.wkt", CORNER + SQUARE)
        done = self.succeed("offset", "in.wkt", "out.gpkg", "--distance", "1,-2,+0.5")
        self.assertRegex(done.stdout, r"^distance 1: 2 curves, length \S+; distance -2: 2 curves, length \S+; distance 0.5: 2 curves, ")
        rows = self.rows("out.gpkg", "offset")
        self.assertEqual([row["distance"] for row in rows], ["1", "1", "-2", "-2", "0.5", "0.5"])
        self.assertEqual([row["feature"] for row in rows], ["1", "2"] * 3)
        self.assertEqual([row["closed"] for row in rows], ["0", "1"] * 3)
        lengths = (18, 40 + 2 * PI, 20 + PI, 24, 19, 40 + PI)
        for row, expected in zip(rows, lengths):
            self.assertAlmostEqual(float(row["length"]), expected)
            self.assertAlmostEqual(length(row["WKT"]), expected)

    def test_every_format(self):
        self.need("ogrinfo")
        self.write("in.wkt", CORNER + BACK + SQUARE)
        for name in ("out.gpkg", "out.fgb", "out.geojson", "out.shp", "out.dxf"):
            done = self.succeed("offset", "in.wkt", name, "--distance", "1", "--max-error", "0.001")
            layer = {"out.shp": "out", "out.dxf": "entities"}.get(name, "offset")
            self.assertIn("Feature Count: 3", self.ogr("ogrinfo", "-ro", "-so", name, layer), name)
            chords = name in ("out.geojson", "out.shp")
            self.assertEqual("has no arcs; the lines deviate from the true curves by 0.000" in done.stderr, chords, name)
        for row, expected in zip(self.rows("out.shp", "out"), (18, 20 + PI / 2, 40 + 2 * PI)):
            found = length(row["WKT"])
            self.assertLess(found, expected + 1e-9)
            self.assertGreater(found, expected - 0.01)
        self.succeed("offset", "in.wkt", "out.wkb", "--distance", "1")
        self.assertIn(b"\x01\x09\x00\x00\x00", (self.directory / "out.wkb").read_bytes())  # compound curves, little-endian

    def test_arcs_of_dxf_and_svg(self):
        self.write("in.wkt", CORNER + BACK)
        self.succeed("offset", "in.wkt", "out.dxf", "--distance", "-1,1")
        pairs = self.text("out.dxf").splitlines()
        pairs = list(zip((int(code) for code in pairs[::2]), pairs[1::2]))
        start = max(i for i, pair in enumerate(pairs) if pair == (2, "ENTITIES"))
        bulges = [float(value) for code, value in pairs[start:] if code == 42]
        # The right side of the corner counter-clockwise, the left side of its reverse clockwise.
        self.assertEqual(len(bulges), 2)
        self.assertAlmostEqual(bulges[0], math.tan(PI / 8))
        self.assertAlmostEqual(bulges[1], -math.tan(PI / 8))
        self.assertEqual({value for code, value in pairs[start:] if code == 8}, {"OFFSET_-1", "OFFSET_1"})
        self.succeed("offset", "in.wkt", "out.svg", "--distance", "-1,1")
        self.assertEqual(re.findall(r"A1 1 0 0 ([01]) ", self.text("out.svg")), ["0", "1"])

    def test_same_bytes_for_any_number_of_threads(self):
        self.write("in.wkt", "\n".join(f"LINESTRING ({i % 37} {i * i % 53}, {i * 7 % 41} {i * 5 % 43}, {i % 11} {i % 7})" for i in range(100)))
        for name in ("gpkg", "fgb", "wkt", "dxf", "svg", "geojson"):
            for threads in (1, 7):
                self.succeed("offset", "in.wkt", f"out{threads}.{name}", "--distance", "0.7,-0.3", "--threads", threads)
            one, seven = ((self.directory / f"out{n}.{name}").read_bytes() for n in (1, 7))
            self.assertTrue(one == seven, name)

    def test_wrong_usage(self):
        self.write("in.wkt", CORNER)
        remedy = "give numbers above zero (left, outwards) or below (right, inwards), in the unit of the coordinates"
        self.fail_with(2, f"--distance '0' is zero; {remedy}", "offset", "in.wkt", "out.gpkg", "--distance", "0")
        self.fail_with(2, f"--distance 'x' is not a finite number; {remedy}", "offset", "in.wkt", "out.gpkg", "--distance", "1,x")
        self.fail_with(2, f"--distance 'inf' is not a finite number; {remedy}", "offset", "in.wkt", "out.gpkg", "--distance", "inf")
        self.fail_with(2, "out.shp: --max-error is too small for the distance; give at least 1e-12 of the distance", "offset",
                       "in.wkt", "out.shp", "--distance", "1", "--max-error", "1e-13", output="out.shp")


if __name__ == "__main__":
    support.main()
