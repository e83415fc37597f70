"""krepl buffer on features: attributes, a radius each, groups, owners; read back by GDAL, areas from formulas."""
import json
import math
import os
import sqlite3
from pathlib import Path

import support
from support import measure

PI = math.pi


def feature(geometry, **properties):
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def line(*points):
    return {"type": "LineString", "coordinates": points}


def point(x, y):
    return {"type": "Point", "coordinates": [x, y]}


class Features(support.CliTest):
    def layer(self, *features, name="in.geojson"):
        collection = {"type": "FeatureCollection", "features": list(features),
                      "crs": {"type": "name", "properties": {"name": "EPSG:32632"}}}
        return self.write(name, json.dumps(collection))

    def three(self):
        return self.layer(feature(line([0, 0], [10, 0]), name="a", width=1, kind="x"),
                          feature(line([30, 0], [40, 0]), name="b", width=2, kind="y"),
                          feature(point(60, 0), name="c", width=3, kind="x"))

    def rows(self, name, columns, where="1"):
        with sqlite3.connect(self.directory / name) as data:
            return data.execute(f"SELECT {columns} FROM zone WHERE {where} ORDER BY rowid").fetchall()

    # --- per feature

    def test_a_zone_for_each_feature_with_its_attributes(self):
        self.succeed("buffer", self.three(), "out.gpkg", "--radius", 1, "--per-feature")
        rows = self.rows("out.gpkg", "name, width, kind, radius, area")
        self.assertEqual([row[:4] for row in rows], [("a", 1, "x", 1.0), ("b", 2, "y", 1.0), ("c", 3, "x", 1.0)])
        for row, area in zip(rows, (20 + PI, 20 + PI, PI)):
            self.assertAlmostEqual(row[4] / area, 1, delta=1e-12)

    def test_several_radii_repeat_the_feature(self):
        self.succeed("buffer", self.three(), "out.gpkg", "--radius", "1,2", "--per-feature")
        rows = self.rows("out.gpkg", "name, radius")
        self.assertEqual(rows, [("a", 1), ("a", 2), ("b", 1), ("b", 2), ("c", 1), ("c", 2)])

    def test_types_are_kept(self):
        self.need("ogrinfo", "ogr2ogr")
        self.write("in.csvt", '"WKT","Integer","Integer64","Real","String","Date","DateTime"\n')
        self.write("in.csv", "WKT,i,l,r,s,d,t\n\"POINT (1 2)\",7,12345678901,0.125,text,2020/02/29,2020/02/29 12:34:56\n"
                             "\"POINT (9 2)\",,,,,,\n")
        for extension in ("gpkg", "geojson", "fgb"):
            with self.subTest(extension):
                self.succeed("buffer", "in.csv", f"out.{extension}", "--radius", 1, "--per-feature")
                text = self.ogr("ogrinfo", "-al", f"out.{extension}")
                date = "d: DateTime" if extension == "fgb" else "d: Date ("  # FlatGeobuf has no dates without time
                for kind in ("i: Integer (", "l: Integer64", "r: Real", "s: String", date, "t: DateTime"):
                    self.assertIn(kind, text)
                for value in ("= 7\n", "= 12345678901\n", "= 0.125\n", "= text\n", "= 2020/02/29", "2020/02/29 12:34:56\n"):
                    self.assertIn(value, text)
                self.assertIn("Feature Count: 2", text)

    def test_fields_called_like_those_added(self):
        name = self.layer(feature(point(0, 0), radius=77, area="large", fid=5, geom="g"))
        self.succeed("buffer", name, "out.gpkg", "--radius", 2, "--per-feature")
        rows = self.rows("out.gpkg", "radius, area, fid, geom, zone_radius, perimeter")
        self.assertEqual(rows[0][:5], (77, "large", 5, "g", 2.0))
        self.succeed("verify", "out.gpkg", "--against", name, "--per-feature")

    def test_text_without_attributes(self):
        done = self.succeed("buffer", "-", "-", "--radius", 1, "--per-feature", stdin="POINT (0 0)\nLINESTRING (5 0, 9 0)\n")
        areas = [measure(text).area for text in done.stdout.splitlines()]
        self.assertEqual(len(areas), 2)
        self.assertAlmostEqual(areas[0], PI, delta=1e-12)
        self.assertAlmostEqual(areas[1], PI + 8, delta=1e-12)

    def test_same_bytes_for_any_number_of_threads(self):
        name = self.layer(*(feature(line([i * 7 % 211, i * i % 197], [i * 7 % 211 + i % 5, i * i % 197 + i % 3]), n=i,
                                    width=1 + i % 5 / 4, kind=i % 7) for i in range(600)))
        for options in (["--per-feature", "--radius", "1"], ["--radius-field", "width"],
                        ["--dissolve-by", "kind", "--radius", "width / 2 + 1"], ["--owner", "nearest", "--radius", "1"]):
            with self.subTest(options=options):
                for threads in (1, 3):
                    self.succeed("buffer", name, f"out{threads}.gpkg", *options, "--threads", threads)
                one, three = ((self.directory / f"out{n}.gpkg").read_bytes() for n in (1, 3))
                self.assertTrue(one == three)

    # --- a radius for each feature

    def test_radius_from_a_field(self):
        self.succeed("buffer", self.three(), "out.wkt", "--radius-field", "width")
        zone = measure(self.text("out.wkt"))
        self.assertEqual(zone.polygons, 3)
        self.assertAlmostEqual(zone.area / (20 + PI + 40 + 4 * PI + 9 * PI), 1, delta=1e-12)

    def test_radius_from_an_expression(self):
        done = self.succeed("buffer", self.three(), "out.gpkg", "--radius", "width / 2 + 1", "--per-feature")
        self.assertEqual(done.stderr, "")
        self.assertEqual(self.rows("out.gpkg", "radius"), [(1.5,), (2.0,), (2.5,)])
        self.succeed("buffer", self.three(), "out.gpkg", "--radius", "CASE kind WHEN 'x' THEN 1 ELSE (width) END", "--per-feature")
        self.assertEqual(self.rows("out.gpkg", "radius"), [(1.0,), (2.0,), (1.0,)])

    def test_zones_of_different_radii_dissolve(self):
        name = self.layer(feature(point(0, 0), width=5), feature(line([-20, 0], [20, 0]), width=1))
        self.succeed("buffer", name, "out.wkt", "--radius-field", "width")
        zone = measure(self.text("out.wkt"))
        half = math.asin(0.2)
        self.assertEqual((zone.polygons, zone.arcs), (1, 4))
        self.assertAlmostEqual(zone.area, 25 * PI + 80 + PI - (50 * half + 10 * math.cos(half)), delta=1e-9)
        for extension in ("gpkg", "svg", "dxf", "geojson", "shp"):
            self.succeed("buffer", name, f"out.{extension}", "--radius-field", "width")
        self.assertEqual(self.rows("out.gpkg", "radius"), [(None,)])

    def test_verify_tells_right_from_wrong_radii(self):
        name = self.layer(*(feature(line([i * i % 53, i % 37], [i * 5 % 43, i * 7 % 41]), width=0.5 + i % 5 / 4, other=1 + i % 3)
                            for i in range(60)))
        self.succeed("buffer", name, "out.gpkg", "--radius-field", "width")
        self.succeed("verify", "out.gpkg", "--against", name, "--radius-field", "width", "--samples", 2000)
        self.succeed("verify", "out.gpkg", "--against", name, "--radius", "width * 1", "--samples", 2000)
        wrong = self.krepl("verify", "out.gpkg", "--against", name, "--radius", "width * 1.0001", "--samples", 2000)
        self.assertEqual(wrong.returncode, 1)
        self.succeed("buffer", name, "each.gpkg", "--radius-field", "width", "--per-feature")
        self.succeed("verify", "each.gpkg", "--against", name, "--radius-field", "width", "--per-feature")
        wrong = self.krepl("verify", "each.gpkg", "--against", name, "--radius-field", "other", "--per-feature")
        self.assertEqual(wrong.returncode, 1)

    def test_bad_radii_name_the_feature(self):
        remedy = "give a finite number greater than zero, or leave the feature out with --where"
        for value, fault in ((None, "is null"), (0, "is zero"), (-2.5, "is negative"), ("wide", "is 'wide', not a number"),
                             ("nan", "is not finite")):
            with self.subTest(value=value):
                name = self.layer(feature(point(0, 0), width=1 if not isinstance(value, str) else "1"),
                                  feature(point(9, 0), width=value))
                self.fail_with(1, f"{name}: the radius in field 'width' {fault}, feature 1; {remedy}", "buffer", name,
                               "out.gpkg", "--radius-field", "width")

    def test_unknown_fields(self):
        name = self.three()
        self.fail_with(1, f"{name}: there is no field 'depth'; the fields are: name, width, kind", "buffer", name,
                       "out.gpkg", "--radius-field", "depth")
        self.fail_with(1, f"{name}: there is no field 'depth'; the fields are: name, width, kind", "buffer", name,
                       "out.gpkg", "--radius", 1, "--dissolve-by", "depth")
        done = self.krepl("buffer", name, "out.gpkg", "--radius", "depth * 2")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"--radius 'depth \* 2' cannot be used .*no such column: depth.*; the fields are: name")
        done = self.krepl("buffer", name, "out.gpkg", "--radius", "max(width)")
        self.assertIn("is not a value for each feature", done.stderr)
        self.write("in.wkt", "POINT (1 2)\n")
        done = self.krepl("buffer", "in.wkt", "out.gpkg", "--radius-field", "width")
        self.assertEqual((done.returncode, done.stderr), (1, "krepl: in.wkt: has no fields for the radius in field 'width'; "
                                                             "give a format with attributes\n"))

    def test_options_that_exclude_each_other(self):
        name = self.three()
        for options, message in (
                (["--radius", 1, "--radius-field", "width"], "--radius and --radius-field exclude each other; give one of them"),
                (["--radius", 1, "--per-feature", "--dissolve-by", "kind"],
                 "--per-feature and --dissolve-by exclude each other; give one of them"),
                (["--radius", 1, "--owner", "oldest"], "--owner 'oldest' is unknown; give --owner nearest"),
                (["--radius-field", "width", "--owner", "nearest"],
                 "--owner nearest needs one radius for all features; give a number with --radius"),
                (["--radius", 1, "--per-feature", "--separate"],
                 "--separate does not go with a zone for each feature or group; leave it out")):
            with self.subTest(options=options):
                self.fail_with(2, message, "buffer", name, "out.gpkg", *options)
        self.fail_with(2, "format svg holds no features; choose gpkg, fgb, geojson, shp, wkt or wkb", "buffer", name, "out.svg",
                       "--radius", 1, "--per-feature", output="out.svg")

    # --- shapes of features

    def square(self, x, size, **properties):
        ring = [[x, 0], [x + size, 0], [x + size, size], [x, size], [x, 0]]
        return feature({"type": "Polygon", "coordinates": [ring]}, **properties)

    def test_caps_joins_and_sides_of_each_feature(self):
        name = self.layer(feature(line([0, 0], [10, 0]), name="a"), feature(line([5, 1], [5, 11], [15, 11]), name="b"),
                          feature(point(60, 0), name="c"))
        for options, areas in ((["--cap", "flat"], (20, 39 + PI / 4, 0)), (["--cap", "square"], (24, 43 + PI / 4, 4)),
                               (["--cap", "flat", "--join", "mitre"], (20, 40, 0)),
                               (["--cap", "flat", "--join", "bevel"], (20, 39.5, 0)), (["--side", "left"], (10, 20 + PI / 4, 0))):
            with self.subTest(options=options):
                self.succeed("buffer", name, "out.gpkg", "--radius", 1, "--per-feature", *options)
                rows = self.rows("out.gpkg", "name, radius, area")
                self.assertEqual([row[:2] for row in rows], [("a", 1), ("b", 1), ("c", 1)])
                for row, area in zip(rows, areas):
                    self.assertAlmostEqual(row[2], area, delta=1e-11 * 40)
                self.succeed("verify", "out.gpkg", "--against", name, "--per-feature", *options)
        wrong = self.krepl("verify", "out.gpkg", "--against", name, "--per-feature", "--cap", "square")
        self.assertEqual(wrong.returncode, 1)

    def test_polygons_shrink_one_by_one(self):
        name = self.layer(self.square(0, 10, name="a"), self.square(5, 3, name="b"))  # they overlap
        for extension in ("gpkg", "geojson", "shp", "wkt"):
            with self.subTest(extension):
                done = self.succeed("buffer", name, f"out.{extension}", "--radius", "-2,1", "--per-feature")
                self.assertIn(f"out.{extension}: note: nothing is left of 1 zones: their geometry is empty", done.stderr)
                error = [] if extension in ("gpkg", "wkt") else ["--max-error", 1e-3]
                self.succeed("verify", f"out.{extension}", "--against", name, "--per-feature", "--radius", "-2,1", *error)
        self.succeed("buffer", name, "out.gpkg", "--radius", "-2,1", "--per-feature")
        rows = self.rows("out.gpkg", "name, radius, area")
        self.assertEqual([row[:2] for row in rows], [("a", -2), ("a", 1), ("b", -2), ("b", 1)])
        for row, area in zip(rows, (36, 140 + PI, 0, 21 + PI)):
            self.assertAlmostEqual(row[2], area, delta=1e-9)
        self.succeed("buffer", name, "ring.gpkg", "--radius", 1, "--per-feature", "--ring")
        for row, area in zip(self.rows("ring.gpkg", "area"), (40 + PI, 12 + PI)):
            self.assertAlmostEqual(row[0], area, delta=1e-9)

    def test_shapes_by_radii_of_features(self):
        name = self.three()
        self.succeed("buffer", name, "out.gpkg", "--radius-field", "width", "--per-feature", "--cap", "flat")
        for row, area in zip(self.rows("out.gpkg", "area"), (20, 40, 0)):
            self.assertAlmostEqual(row[0], area, delta=1e-10)
        self.succeed("verify", "out.gpkg", "--against", name, "--radius-field", "width", "--per-feature", "--cap", "flat")
        self.succeed("buffer", name, "out.gpkg", "--radius", 1, "--dissolve-by", "kind", "--cap", "flat")
        for row, area in zip(self.rows("out.gpkg", "area"), (20, 20)):
            self.assertAlmostEqual(row[0], area, delta=1e-10)
        self.fail_with(2, "zones of features with radii of their own are round where they share one; give --per-feature, or one "
                          "radius", "buffer", name, "none.gpkg", "--radius-field", "width", "--cap", "flat", output="none.gpkg")
        self.fail_with(2, "owners share round zones of positive radii only; leave caps, joins, sides and rings out",
                       "buffer", name, "none.gpkg", "--radius", 1, "--owner", "nearest", "--join", "bevel", output="none.gpkg")

    # --- groups

    def test_dissolve_by_a_field(self):
        name = self.layer(feature(line([0, 0], [10, 0]), kind="x"), feature(line([5, 0], [15, 0]), kind=None),
                          feature(line([10, 0], [20, 0]), kind="x"), feature(point(50, 0), kind=None),
                          feature(point(70, 0), kind=""))
        self.succeed("buffer", name, "out.gpkg", "--radius", 1, "--dissolve-by", "kind")
        rows = self.rows("out.gpkg", "kind, count, area")
        self.assertEqual([row[:2] for row in rows], [("x", 2), (None, 2), ("", 1)])
        for row, area in zip(rows, (40 + PI, 20 + 2 * PI, PI)):
            self.assertAlmostEqual(row[2] / area, 1, delta=1e-12)
        self.succeed("verify", "out.gpkg", "--against", name, "--dissolve-by", "kind")

    # --- owners

    def test_owners_share_the_zone(self):
        name = self.layer(feature(line([0, 0], [10, 0]), n=1), feature(line([5, -5], [5, 5]), n=2), feature(point(2, 2), n=3),
                          feature({"type": "Polygon", "coordinates": [[[8, -1], [14, -1], [14, 4], [8, 4], [8, -1]]]}, n=4))
        for radius in (0.5, 2, 7):
            self.succeed("buffer", name, "all.wkt", "--radius", radius)
            self.succeed("buffer", name, "out.gpkg", "--radius", radius, "--owner", "nearest")
            rows = self.rows("out.gpkg", "n, area")
            self.assertEqual([row[0] for row in rows], [1, 2, 3, 4])
            self.assertAlmostEqual(sum(row[1] for row in rows) / measure(self.text("all.wkt")).area, 1, delta=1e-9)
            self.succeed("verify", "out.gpkg", "--against", name, "--owner", "nearest", "--samples", 3000)
        # What is not shared out overlaps, and is told from what is.
        self.succeed("buffer", name, "each.gpkg", "--radius", 2, "--per-feature")
        wrong = self.krepl("verify", "each.gpkg", "--against", name, "--owner", "nearest", "--samples", 3000)
        self.assertEqual(wrong.returncode, 1)
        self.assertIn("places with the nearest owner", wrong.stderr)

    def test_owners_by_group_in_other_software(self):
        self.need("ogrinfo")
        name = self.layer(*(feature(line([i * i % 53, i % 37], [i * 5 % 43, i * 7 % 41]), kind=i % 5) for i in range(60)))
        self.succeed("buffer", name, "all.wkt", "--radius", 2)
        self.succeed("buffer", name, "out.shp", "--radius", 2, "--owner", "nearest", "--dissolve-by", "kind", "--max-error", 1e-4)
        text = self.ogr("ogrinfo", "-q", "out.shp", "-dialect", "SQLite", "-sql",
                        "SELECT sum(ST_IsValid(geometry)) AS valid, sum(ST_Area(geometry)) AS area, sum(area) AS own FROM out")
        values = {row.split()[0]: float(row.split()[-1]) for row in text.splitlines() if " = " in row}
        self.assertEqual(values["valid"], 5)
        self.assertAlmostEqual(values["own"] / measure(self.text("all.wkt")).area, 1, delta=1e-9)
        self.assertAlmostEqual(values["area"] / values["own"], 1, delta=1e-3)
        overlap = self.ogr("ogrinfo", "-q", "out.shp", "-dialect", "SQLite", "-sql",
                           "SELECT sum(ST_Area(ST_Intersection(a.geometry, b.geometry))) AS overlap FROM out a, out b "
                           "WHERE a.kind < b.kind")
        self.assertAlmostEqual(float(overlap.split("=")[-1]), 0, delta=1e-6)

    def test_a_feature_without_a_place_of_its_own(self):
        name = self.layer(feature(point(0, 0), n=1), feature(point(0, 0), n=2))
        done = self.succeed("buffer", name, "out.gpkg", "--radius", 1, "--owner", "nearest")
        self.assertEqual(self.rows("out.gpkg", "n"), [(1,)])
        self.assertIn("1 zones are left out, for another feature is as near to all of their places", done.stderr)

    def test_real_roads(self):
        data = Path(os.environ.get("KREPL_DATA", "")) / "vector" / "roads_roxel_epsg32632_mm.wkt"
        if not data.is_file():
            self.skipTest("KREPL_DATA is not set")
        self.succeed("buffer", data, "all.wkt", "--radius", 20000)
        self.succeed("buffer", data, "out.gpkg", "--radius", 20000, "--owner", "nearest")
        area = sum(row[0] for row in self.rows("out.gpkg", "area"))
        self.assertAlmostEqual(area / measure(self.text("all.wkt")).area, 1, delta=1e-9)
        self.succeed("verify", "out.gpkg", "--against", data, "--owner", "nearest", "--samples", 5000)


if __name__ == "__main__":
    support.main()
