"""krepl route: lengths by hand, every format read back, messages; over a terrain, limits kept."""
import csv
import io
import json
import math
import re

import support
from support import Parser, piece_measure
from test_terrain import grid

POINT = "POINT (0 0)\n"
AROUND = 2 * math.sqrt(24) + math.pi - 2 * math.acos(1 / 5)  # from -5,0 to 5,0 about it, radius 1
ENDS = ("--radius", "1", "--from=-5,0", "--to", "5,0")
HILL = grid([[0] * 9] * 4 + [[0, 0, 0, 20, 20, 20, 20, 20, 20]] + [[0] * 9] * 4, corner=(0, 0))


class Route(support.CliTest):
    def test_around_a_point(self):
        done = self.succeed("route", "-", "-", *ENDS, stdin=POINT)
        self.assertTrue(done.stdout.startswith("COMPOUNDCURVE ("), done.stdout)
        self.assertAlmostEqual(sum(piece_measure(p)[0] for p in Parser(done.stdout).curve()), AROUND)
        self.assertRegex(done.stderr, r"^length 10.2\d*, clearance 1; 2 lines, 1 arcs; ")

    def test_pieces_as_rows(self):
        self.write("in.wkt", POINT)
        self.succeed("route", "in.wkt", "out.csv", *ENDS)
        rows = list(csv.DictReader(io.StringIO(self.text("out.csv"))))
        self.assertEqual([r["kind"] for r in rows], ["line", "arc", "line"])
        self.assertEqual([r["cx"] for r in rows], ["", "0", ""])
        self.assertIn(rows[1]["sense"], ("cw", "ccw"))
        self.assertEqual(rows[1]["feature"], "1")
        self.assertAlmostEqual(sum(float(r["length"]) for r in rows), AROUND)

    def test_every_format(self):
        self.need("ogrinfo")
        self.write("in.wkt", POINT)
        for name in ("out.gpkg", "out.fgb", "out.geojson", "out.shp", "out.dxf", "out.svg", "out.wkb"):
            done = self.succeed("route", "in.wkt", name, *ENDS, "--max-error", "0.001")
            self.assertEqual("chords deviate" in done.stderr, name in ("out.geojson", "out.shp"), done.stderr)
            if name not in ("out.svg", "out.wkb"):
                self.assertIn("Feature Count: 1", self.ogr("ogrinfo", "-so", "-al", name).split("Layer name: pieces")[0])
        self.assertIn("Feature Count: 3", self.ogr("ogrinfo", "-so", "out.gpkg", "pieces"))
        self.assertIn("Compound Curve", self.ogr("ogrinfo", "-so", "out.gpkg", "route"))
        line, = json.loads(self.text("out.geojson"))["features"]
        self.assertAlmostEqual(line["properties"]["length"], AROUND)
        points = line["geometry"]["coordinates"]
        self.assertGreater(min(math.hypot(*p) for p in points), 1 - 1e-12)
        self.assertRegex(self.text("out.svg"), r'class="route"[^>]*>\n<path d="M-5 0L[^"]*A1 1 ')

    def test_preferences(self):
        # Two gates: one 4 wide on the way, one 6 wide far off.
        room = "LINESTRING (-20 -20, 20 -20, 20 40, -20 40, -20 -20)\nLINESTRING (0 2, 0 10)\nLINESTRING (0 16, 0 40)\nLINESTRING (0 -2, 0 -20)\n"
        self.write("in.wkt", room)
        ends = ("--radius", "1", "--from=-8,0", "--to", "8,0")
        for prefer, pattern in (("length", "length 16, clearance 2;"), ("clearance", r"clearance 3 \(widest 3\);.* parabolas"),
                                ("1", r"clearance 3 \(widest 3\)"), ("0.5", r"length 16, clearance 2 \(widest 3\)")):
            done = self.succeed("route", "in.wkt", "out.svg", *ends, "--prefer", prefer)
            self.assertRegex(done.stdout, pattern)
        self.succeed("route", "in.wkt", "out.csv", *ends, "--prefer", "clearance")
        self.assertIn("parabola", self.text("out.csv"))

    def test_errors(self):
        self.write("in.wkt", "POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0))\n")
        run = lambda *options: ("route", "in.wkt", "out.gpkg", *options)
        self.fail_with(1, "in.wkt: --from is inside the polygon of feature 1, 4 from its border: the disk overlaps it, 5 deep, at 4 4; "
                          "move it to a free place, or use a smaller radius", *run("--radius", "1", "--from", "4,4", "--to", "20,20"))
        self.fail_with(2, "--from '4' is not a place; give two coordinates, x,y, or over a terrain three, x,y,z",
                       *run("--radius", "1", "--from", "4", "--to", "20,20"))
        self.fail_with(2, "--to '4,4,4' has three coordinates, but IN is flat; give x,y",
                       *run("--radius", "1", "--from", "20,20", "--to", "4,4,4"))
        self.fail_with(2, "--prefer 'speed' is neither length, nor clearance, nor a number in 0 .. 1; 0 is the shortest route, "
                          "1 the shortest of the widest", *run("--radius", "1", "--from", "20,20", "--to", "4,4", "--prefer", "speed"))
        self.fail_with(2, "--ceiling is for terrains, but IN is neither a raster nor a mesh; leave it out",
                       *run("--radius", "1", "--from", "20,20", "--to", "4,4", "--ceiling", "5"))
        self.write("in.wkt", "LINESTRING (0 0, 10 0, 10 10, 0 10, 0 0)\n")
        self.fail_with(1, "in.wkt: no route: a disk of radius 1 cannot get from 4 4 to 20 20, which are in different parts of free "
                          "space (--from lies in a pocket of it); choose both ends in one part, or use a smaller radius",
                       *run("--radius", "1", "--from", "4,4", "--to", "20,20"))


class TerrainRoute(support.CliTest):
    ends = ("--radius", "0.5", "--from", "4.5,1.5", "--to", "4.5,7.5")

    def rows(self):
        return [{k: float(v) for k, v in r.items()} for r in csv.DictReader(io.StringIO(self.text("out.csv")))]

    def test_round_the_wall_and_over_it(self):
        self.write("in.asc", HILL)
        done = self.succeed("route", "in.asc", "out.csv", *self.ends, "--ceiling", "5", "--step", "0.5")
        self.assertRegex(done.stdout, r"clearance 0.5 proven")
        rows = self.rows()
        self.assertLess(max(r["z"] for r in rows), 5 + 1e-9)
        self.assertLess(min(r["x"] for r in rows), 3)
        for r in rows:
            self.assertGreaterEqual(r["z"], r["rest"] - 1e-8)
        self.assertAlmostEqual(rows[-1]["along"], float(re.search(r"length ([\d.]+)", done.stdout).group(1)), places=6)

    def test_slope_and_formats(self):
        self.need("ogrinfo")
        self.write("in.asc", HILL)
        for name in ("out.gpkg", "out.geojson", "out.wkt", "out.svg", "out.csv"):
            self.succeed("route", "in.asc", name, *self.ends, "--max-slope", "0.5", "--step", "0.5")
        self.assertIn("3D Line String", self.ogr("ogrinfo", "-so", "out.gpkg", "route"))
        self.assertTrue(self.text("out.wkt").startswith("LINESTRING Z (4.5 1.5 "))
        rows = self.rows()
        for a, b in zip(rows, rows[1:]):
            way = math.hypot(b["x"] - a["x"], b["y"] - a["y"])
            if way > 0:
                self.assertLessEqual(abs(b["z"] - a["z"]), 0.5 * way * (1 + 1e-9) + 1e-9)

    def test_errors(self):
        self.write("in.asc", HILL)
        run = lambda *options: ("route", "in.asc", "out.gpkg", "--radius", "0.5", *options)
        self.fail_with(2, "--prefer is for lines, polygons and points, but IN is a terrain; leave it out",
                       *run("--from", "4.5,1.5", "--to", "4.5,7.5", "--prefer", "length"))
        self.fail_with(1, "in.asc: --to is not over the terrain: the ball touches nothing there, at 40 7; choose a place over the terrain",
                       *run("--from", "4.5,1.5", "--to", "40,7"))
        self.fail_with(1, "in.asc: --from: the ball overlaps the terrain: its centre at 0.2 is 0.3 below where it rests, 0.5, "
                          "at 4.5 1.5; raise it, or leave out the height", *run("--from", "4.5,1.5,0.2", "--to", "4.5,7.5"))
        self.fail_with(2, "out.dxf: a route over a terrain cannot go to format dxf; choose gpkg, geojson, fgb, wkt, csv or svg",
                       "route", "in.asc", "out.dxf", *self.ends, "--step", "0.5", output="out.dxf")


if __name__ == "__main__":
    support.main()
