"""krepl rivers: sub-rivers with their attributes in every format, the ways to tell the flow, and zones of the parts."""
import csv
import io
import math

import support
from support import measure

PI = math.pi

# A river along x with two tributaries, the second with one of its own.
BASIN = """LINESTRING (0 0, 10 0, 20 0, 30 0)
LINESTRING (8 4, 10 0)
LINESTRING (14 9, 18 3, 20 0)
LINESTRING (22 8, 18 3)
"""
BACKWARDS = """LINESTRING (30 0, 20 0, 10 0, 0 0)
LINESTRING (10 0, 8 4)
LINESTRING (20 0, 18 3, 14 9)
LINESTRING (18 3, 22 8)
"""


class Rivers(support.CliTest):
    def rows(self, name, layer):
        self.need("ogr2ogr")
        text = self.ogr("ogr2ogr", "-f", "CSV", "/vsistdout/", name, layer, "-lco", "GEOMETRY=AS_WKT")
        return list(csv.DictReader(io.StringIO(text)))

    def lines(self, *arguments, stdin=BASIN):
        return self.succeed("rivers", "-", "-", *arguments, stdin=stdin).stdout.splitlines()

    def column(self, rows, name):
        return [row[name] for row in rows]

    # --- what comes out ---

    def test_sub_rivers_and_their_attributes(self):
        self.write("in.wkt", BASIN)
        done = self.succeed("rivers", "in.wkt", "out.gpkg")
        self.assertEqual(done.stderr, "")
        self.assertRegex(done.stdout, r"^7 reaches, 4 sub-rivers, 1 main stems, 1 connected parts; length \S+, order 3; ")
        rows = self.rows("out.gpkg", "sub_rivers")
        self.assertEqual(self.column(rows, "id"), ["1", "2", "3", "4"])
        self.assertEqual(self.column(rows, "feature"), ["1", "3", "4", "2"])  # lines of the text, by length
        self.assertEqual(self.column(rows, "strahler"), ["3", "2", "1", "1"])
        self.assertEqual(self.column(rows, "main"), ["1", "0", "0", "0"])
        self.assertEqual(self.column(rows, "downstream"), ["", "1", "2", "1"])
        self.assertEqual(self.column(rows, "stem"), ["1"] * 4)
        for row, length in zip(rows, (30, math.hypot(4, 6) + math.hypot(2, 3), math.hypot(4, 5), math.hypot(2, 4))):
            self.assertAlmostEqual(float(row["length"]), length)
        self.assertEqual(rows[0]["WKT"], "LINESTRING (0 0,10 0,20 0,30 0)")

        reaches = self.rows("out.gpkg", "reaches")
        self.assertEqual(len(reaches), 7)
        self.assertEqual(sorted(self.column(reaches, "sub_river")), ["1", "1", "1", "2", "2", "3", "4"])
        nodes = {row["id"]: row for row in self.rows("out.gpkg", "nodes")}
        self.assertEqual(sorted(row["kind"] for row in nodes.values()), ["drain"] + ["fusion"] * 3 + ["source"] * 4)
        for row in rows:  # from and to lead to nodes that lie at the ends
            ends = row["WKT"][len("LINESTRING ("):-1].split(",")
            for end, node in ((ends[0], row["from_node"]), (ends[-1], row["to_node"])):
                self.assertEqual(nodes[node]["WKT"], f"POINT ({end})")

    def test_every_format(self):
        self.need("ogrinfo")
        self.write("in.wkt", BASIN)
        for name in ("out.gpkg", "out.fgb", "out.geojson", "out.shp", "out.csv", "out.kml", "out.dxf"):
            done = self.succeed("rivers", "in.wkt", name)
            layer = {"out.gpkg": "sub_rivers", "out.fgb": "sub_rivers", "out.geojson": "sub_rivers", "out.kml": "sub_rivers",
                     "out.dxf": "entities"}.get(name, "out")
            self.assertIn("Feature Count: 4", self.ogr("ogrinfo", "-ro", "-so", name, layer), name)
            note = "krepl: out.dxf: note: DXF holds no attributes; there are geometries only\n"
            self.assertEqual(done.stderr, note if name == "out.dxf" else "")
        self.assertEqual(self.column(self.rows("out.shp", "out"), "downstream"), ["", "1", "2", "1"])
        self.succeed("rivers", "in.wkt", "reaches.fgb", "--reaches")
        self.assertIn("Feature Count: 7", self.ogr("ogrinfo", "-ro", "-so", "reaches.fgb", "reaches"))
        self.succeed("rivers", "in.wkt", "out.wkb")
        self.assertEqual(self.succeed("rivers", "out.wkb", "-").stdout, self.succeed("rivers", "in.wkt", "-").stdout)
        self.succeed("rivers", "in.wkt", "out.svg")
        self.assertEqual(self.text("out.svg").count("<path"), 7)
        self.assertEqual(self.text("out.svg").count("<circle"), 3)

    def test_same_bytes_for_any_number_of_threads(self):
        self.write("in.wkt", "\n".join(f"LINESTRING ({i % 37} {i * i % 53}, {i * 7 % 41} {i * 5 % 43})" for i in range(300)))
        for name in ("gpkg", "fgb", "wkt", "shp", "svg", "geojson"):
            for threads in (1, 2, 7):
                self.succeed("rivers", "in.wkt", f"out{threads}.{name}", "--threads", threads)
            one, two, seven = ((self.directory / f"out{n}.{name}").read_bytes() for n in (1, 2, 7))
            self.assertTrue(one == two == seven, name)

    def test_what_was_changed_is_told(self):
        self.write("in.wkt", "LINESTRING (0 0, 10 0, 20 0)\nLINESTRING (20 0, 10 0)\nLINESTRING (5 5, 5 0.25)\n"
                             "LINESTRING (15 5, 15 -5)\nPOINT (1 1)\nLINESTRING (3 3, 3 3, 4 4)\n")
        done = self.succeed("rivers", "in.wkt", "out.wkt", "--snap", "0.5")
        self.assertEqual(done.stderr, "".join(f"krepl: in.wkt: note: {text}\n" for text in (
            "1 points and lines without length are left out",
            "1 repeated vertices are dropped",
            "0 free ends are moved to a vertex and 1 to a line, by 0.25 at most",
            "1 vertices are added where lines cross",
            "2 segments that others cover are dropped (length 10); 2 of them ran the other way")))
        self.assertEqual(self.succeed("rivers", "in.wkt", "out.wkt", "--snap", "0.5", "--quiet").stderr, "")

    # --- which way water runs ---

    def test_outlet(self):
        forwards = self.lines()
        self.assertNotEqual(self.lines(stdin=BACKWARDS), forwards)
        self.assertEqual(self.lines("--outlet", "30,0", stdin=BACKWARDS), forwards)
        self.assertEqual(self.lines("--outlet", "guess", stdin=BACKWARDS), forwards)
        self.assertEqual(self.lines("--outlet", "31,1", stdin=BACKWARDS), forwards)
        two = self.lines("--outlet", "0,0", "--outlet", "30,0", stdin=BASIN)
        self.assertEqual(sum(line.endswith((", 0 0)", ", 30 0)")) for line in two), 2)
        self.assertEqual(self.lines("--outlet", "-5,0")[0].split(", ")[-1], "0 0)")

    def test_outlet_in_degrees(self):
        self.write("in.wkt", "LINESTRING (9.1 50.1, 9 50)\nLINESTRING (9.2 50, 9.1 50.1)\n")
        done = self.succeed("rivers", "in.wkt", "out.gpkg", "--crs", "EPSG:4326", "--to-crs", "auto", "--outlet", "9.2,50")
        self.assertNotIn("from their vertex", done.stderr)
        self.need("ogr2ogr")
        end = self.rows("out.gpkg", "sub_rivers")[0]["WKT"].rsplit(",", 1)[1].rstrip(")").split()
        back = self.ogr("ogr2ogr", "-f", "CSV", "/vsistdout/", "-t_srs", "OGC:CRS84", "out.gpkg", "nodes", "-lco", "GEOMETRY=AS_XY",
                        "-where", "kind = 'drain'").splitlines()
        self.assertEqual(len(back), 2)
        x, y = map(float, back[1].split(",")[:2])
        self.assertAlmostEqual(x, 9.2, places=9)
        self.assertAlmostEqual(y, 50, places=9)
        self.assertEqual(len(end), 2)

    def test_attributes_of_the_input_are_kept(self):
        self.need("ogr2ogr", "ogrinfo")
        lines = BASIN.splitlines()
        self.write("in.csv", "name,length,WKT\n" + "".join(f'r{i},{i}.5,"{line}"\n' for i, line in enumerate(lines)))
        self.write("in.csvt", '"String","Real","WKT"\n')
        done = self.succeed("rivers", "in.csv", "out.gpkg")
        self.assertEqual(done.stderr, "")
        for layer in ("sub_rivers", "reaches"):
            rows = self.rows("out.gpkg", layer)
            for row in rows:
                number = int(row["feature"]) - 1  # OGR counts the rows of CSV from 1
                self.assertEqual((row["name"], float(row["input_length"])), (f"r{number}", number + 0.5))
                self.assertGreater(float(row["length"]), 0)
        self.succeed("rivers", "in.csv", "zones.gpkg", "--radius", "0.1")
        self.assertIn("  name (String) = r", self.ogr("ogrinfo", "-q", "-al", "zones.gpkg"))

    def test_field_that_tells_the_flow(self):
        self.need("ogr2ogr")
        flows = ("against", "1", "With_Digitized", "")
        lines = [BACKWARDS.splitlines()[0], *BASIN.splitlines()[1:]]
        self.write("in.csv", "flow,WKT\n" + "".join(f'{flow},"{line}"\n' for flow, line in zip(flows, lines)))
        self.ogr("ogr2ogr", "in.gpkg", "in.csv", "-nln", "in", "-nlt", "LINESTRING", "-a_srs", "EPSG:25832")
        done = self.succeed("rivers", "in.gpkg", "out.wkt", "--flow-field", "flow")
        self.assertEqual(done.stderr, "krepl: in.gpkg: note: 1 features do not say which way water runs and are taken as digitised\n")
        self.assertEqual(self.text("out.wkt").splitlines(), self.lines())
        self.fail_with(1, "in.gpkg: there is no field 'way'; the fields are: flow, WKT", "rivers", "in.gpkg", "out.gpkg",
                       "--flow-field", "way")
        self.write("bad.csv", 'flow,WKT\nsideways,"LINESTRING (0 0, 1 0)"\n')
        self.fail_with(1, "bad.csv: field 'flow' says 'sideways', feature 1; use 1 or 'with', -1 or 'against', 0 or nothing",
                       "rivers", "bad.csv", "out.gpkg", "--flow-field", "flow")

    # --- zones ---

    def test_zone_of_each_sub_river(self):
        self.write("in.wkt", "LINESTRING (0 0, 30 0)\nLINESTRING (10 9, 10 0)\nLINESTRING (100 0, 110 0)\n")
        self.succeed("rivers", "in.wkt", "out.gpkg", "--radius", "2")
        rows = self.rows("out.gpkg", "zones")
        self.assertEqual(self.column(rows, "id"), ["1", "2", "3"])
        self.assertEqual(self.column(rows, "stem"), ["1", "2", "1"])
        for row, length in zip(rows, (30, 10, 9)):
            area = 4 * length + 4 * PI
            self.assertAlmostEqual(float(row["length"]), length)
            self.assertAlmostEqual(float(row["area"]), area)
            self.assertAlmostEqual(measure(row["WKT"]).area, area)

    def test_zone_of_each_stem_and_of_all(self):
        self.write("in.wkt", "LINESTRING (0 0, 30 0)\nLINESTRING (10 9, 10 0)\nLINESTRING (100 0, 110 0)\n")
        both = 4 * 30 + 4 * PI + 4 * 7 + 2 * PI  # the tributary's own part starts at the river's side
        stems = self.succeed("rivers", "in.wkt", "-", "--radius", "2", "--zones", "stem").stdout.splitlines()
        whole = self.succeed("rivers", "in.wkt", "-", "--radius", "2", "--zones", "whole").stdout.splitlines()
        buffer = self.succeed("buffer", "in.wkt", "-", "--radius", "2").stdout.splitlines()
        self.assertEqual([len(stems), len(whole)], [2, 1])
        self.assertAlmostEqual(measure(stems[0]).area, both)
        self.assertAlmostEqual(measure(stems[1]).area, 40 + 4 * PI)
        self.assertAlmostEqual(measure(whole[0]).area, both + 40 + 4 * PI)
        self.assertAlmostEqual(measure(whole[0]).area, measure(buffer[0]).area)
        done = self.succeed("rivers", "in.wkt", "out.shp", "--radius", "2", "--max-error", "0.01")
        self.assertRegex(done.stderr, r"krepl: out.shp: note: shp has no arcs; the polygons deviate from the true zone by 0\.00\d+ at most\n$")
        self.succeed("rivers", "in.wkt", "out.svg", "--radius", "2")
        self.assertEqual(self.text("out.svg").count('class="zone"'), 3)
        self.assertEqual(self.text("out.svg").count('class="input"'), 3)

    # --- refusals ---

    def test_wrong_usage(self):
        self.write("in.wkt", BASIN)
        for message, *options in (
                ("--zones is about zones; give --radius too", "--zones", "stem"),
                ("--max-error is about zones; give --radius too", "--max-error", "1"),
                ("--zones 'river' is unknown; give sub-river, stem or whole", "--zones", "river", "--radius", "1"),
                ("--reaches is about lines; leave out --reaches or --radius", "--reaches", "--radius", "1"),
                ("--outlet and --flow-field both say which way water runs; leave out one of them", "--outlet", "guess",
                 "--flow-field", "flow"),
                ("--outlet '3' is not a place; give X,Y in the coordinates of the file, or guess", "--outlet", "3"),
                ("--snap '-1' is negative; give a finite number greater than zero, in the unit of the coordinates", "--snap", "-1"),
                ("--grid 'x' is not a number; give a finite number greater than zero, in the unit of the coordinates", "--grid", "x")):
            self.fail_with(2, message, "rivers", "in.wkt", "out.gpkg", *options)
        self.fail_with(2, "in.wkt: a file of plain geometries has no fields; leave out --flow-field", "rivers", "in.wkt",
                       "out.gpkg", "--flow-field", "flow")

    def test_no_lines(self):
        self.write("in.wkt", "POINT (1 2)\n")
        self.fail_with(1, "in.wkt: there is no line in the input; give lines with two different vertices at least", "rivers",
                       "in.wkt", "out.gpkg")


if __name__ == "__main__":
    support.main()
