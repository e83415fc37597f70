"""Input that cannot be taken: exit status 1, one line that says what, where and what to do, nothing written."""
import gzip
import json
import os
import unittest

import support


class BadInput(support.CliTest):
    def buffer(self, message, name, *options, **keywords):
        self.fail_with(1, message, "buffer", name, "out.gpkg", "--radius", "1", *options, **keywords)

    def bad_wkt(self, text, message):
        self.buffer("bad.wkt: " + message, self.write("bad.wkt", text))

    def geojson(self, *features, name="in.geojson", crs="urn:ogc:def:crs:EPSG::25832"):
        collection = {"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": crs}},
                      "features": list(features)}
        return self.write(name, json.dumps(collection))

    @staticmethod
    def feature(geometry, **properties):
        return {"type": "Feature", "properties": properties, "geometry": geometry}

    LINE = {"type": "LineString", "coordinates": [[0, 0], [10, 0]]}

    def test_missing_file(self):
        self.buffer("nowhere.gpkg: no such file; check the name", "nowhere.gpkg")
        self.buffer("nowhere.wkt: no such file; check the name", "nowhere.wkt")

    def test_directory(self):
        (self.directory / "folder").mkdir()
        self.buffer("folder: is a directory; name a file in it", "folder")

    def test_empty_files(self):
        for name in ("in.wkt", "in.geojson", "in.gpkg", "in.shp", "in.wkb"):
            with self.subTest(name=name):
                self.buffer(f"{name}: is empty", self.write(name, ""))

    def test_empty_compressed_file(self):
        (self.directory / "in.wkt.gz").write_bytes(gzip.compress(b""))
        self.buffer("in.wkt.gz: has no features; give lines, polygons or points", "in.wkt.gz")

    def test_truncated_compressed_file(self):
        whole = gzip.compress(os.urandom(30000).hex().encode())
        (self.directory / "in.wkt.gz").write_bytes(whole[:len(whole) // 2])
        done = self.krepl("buffer", "in.wkt.gz", "out.gpkg", "--radius", "1")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(self.files(), ["in.wkt.gz"])

    def test_nothing_but_comments(self):
        self.bad_wkt("# nothing\n\n", "has no features; give lines, polygons or points")

    def test_empty_geometries_only(self):
        self.bad_wkt("LINESTRING EMPTY\nPOLYGON EMPTY\n",
                     "all features have an empty geometry; give lines, polygons or points")

    def test_empty_standard_input(self):
        self.buffer("standard input: is empty; give WKT or GeoJSON text", "-")

    def test_not_wkt(self):
        self.bad_wkt("LINESTRING (0 0, 1 1)\nPOINT (5)\n",
                     "not a geometry in WKT, line 2: 'POINT (5)'; give one geometry a line")
        self.bad_wkt("# comment\nhello world, this is not what you are looking for\n",
                     "not a geometry in WKT, line 2: 'hello world, this is not what you are lo...'; "
                     "give one geometry a line")
        self.bad_wkt("POINT (1 2) POINT (3 4)\n", "text after the geometry, line 1: 'POINT (3 4)'; give one geometry a line")

    def test_binary_garbage(self):
        (self.directory / "in.gpkg").write_bytes(bytes(range(256)) * 20)
        done = self.krepl("buffer", "in.gpkg", "out.gpkg", "--radius", "1")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^krepl: in.gpkg: is not a vector file that can be read .*; convert it to GeoPackage "
                                      r"with ogr2ogr\n$")

    def test_nan_and_infinity(self):
        self.bad_wkt("POINT (0 0)\nLINESTRING (0 0, nan 1)\n",
                     "a coordinate is not a finite number, line 2; correct or remove it")
        self.bad_wkt("POINT (0 -inf)\n", "a coordinate is not a finite number, line 1, vertex 0; correct or remove it")
        self.bad_wkt("LINESTRING (0 0, 1 1, 1e999 2)\n",
                     "a coordinate is not a finite number, line 1, vertex 2; correct or remove it")

    def test_nan_in_geojson_names_the_feature(self):
        text = self.text(self.geojson(self.feature(self.LINE), self.feature(self.LINE))).replace("[10, 0]", "[NaN, 0]", 1)
        self.buffer("nan.geojson: a coordinate is not a finite number, feature 0, vertex 1; correct or remove it",
                    self.write("nan.geojson", text))

    def test_arcs(self):
        self.write("arcs.wkt", "POINT (0 0)\nCIRCULARSTRING (0 0, 1 1, 2 0)\n")
        self.fail_with(1, "arcs.wkt: arcs of the input cannot stay arcs here, line 2; give "
                       "--arc-error LENGTH for chords in their place that deviate by no more",
                       "buffer", "arcs.wkt", "out.wkt", "--radius", "1", "--side", "left", output="out.wkt")

    def test_surfaces_in_space(self):
        self.bad_wkt("TIN (((0 0 0, 0 0 1, 0 1 0, 0 0 0)))\n",
                     "geometry of type TIN cannot be used, line 1; give lines, polygons or points")

    def test_table_without_geometry(self):
        self.buffer("in.csv: has no geometry; give lines, polygons or points", self.write("in.csv", "a,b\n1,2\n"))

    def test_unknown_layer(self):
        self.need("ogr2ogr")
        self.geojson(self.feature(self.LINE, name="a"))
        self.ogr("ogr2ogr", "two.gpkg", "in.geojson", "-nln", "rivers")
        self.ogr("ogr2ogr", "-update", "two.gpkg", "in.geojson", "-nln", "roads")
        self.buffer("two.gpkg: there is no layer 'lakes'; the layers are: rivers, roads", "two.gpkg", "--layer", "lakes")
        self.buffer("two.gpkg: has more than one layer; choose with --layer one of: rivers, roads", "two.gpkg")
        self.succeed("buffer", "two.gpkg", "out.gpkg", "--radius", "1", "--layer", "roads")

    def test_unknown_field(self):
        name = self.geojson(self.feature(self.LINE, name="a", width=3))
        done = self.krepl("buffer", name, "out.gpkg", "--radius", "1", "--where", "depth = 3")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^krepl: in.geojson: --where 'depth = 3' cannot be used \(.*depth.*\); "
                                      r"the fields are: name, width\n$")
        self.assertEqual(self.files(), ["in.geojson"])

    def test_condition_that_nothing_satisfies(self):
        self.buffer("in.geojson: no feature satisfies --where 'width > 5'; check the condition",
                    self.geojson(self.feature(self.LINE, width=3)), "--where", "width > 5")

    def test_layers_and_fields_of_text(self):
        name = self.write("in.wkt", "POINT (0 0)\n")
        self.fail_with(2, "in.wkt: a .wkt file has no layers; leave out --layer",
                       "buffer", name, "out.gpkg", "--radius", "1", "--layer", "a")
        self.fail_with(2, "in.wkt: a .wkt file has no fields; leave out --where",
                       "buffer", name, "out.gpkg", "--radius", "1", "--where", "a = 1")

    def test_degrees(self):
        remedy = "project them with --to-crs EPSG:n, or with --to-crs auto"
        self.buffer(f"in.geojson: coordinates are in degrees (WGS 84 (EPSG:4326)), not in a plane; {remedy}",
                    self.geojson(self.feature(self.LINE), crs="urn:ogc:def:crs:EPSG::4326"))
        self.buffer(f"in.wkt: coordinates are in degrees (ETRS89 (EPSG:4258)), not in a plane; {remedy}",
                    self.write("in.wkt", "POINT (5 5)\n"), "--crs", "EPSG:4258")

    def test_projection_of_an_unknown_system(self):
        self.buffer("in.wkt: --to-crs needs to know the coordinate system of the data, and the file does not say; "
                    "name it with --crs EPSG:n", self.write("in.wkt", "POINT (5 5)\n"), "--to-crs", "auto")

    def test_unknown_coordinate_system(self):
        name = self.write("in.wkt", "POINT (5 5)\n")
        done = self.krepl("buffer", name, "out.gpkg", "--radius", "1", "--crs", "EPSG:999999")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^krepl: in.wkt: 'EPSG:999999' is not a coordinate system .*; give for example "
                                      r"EPSG:25832, WKT or a PROJ string\n$")

    def test_target_system_in_degrees(self):
        self.fail_with(2, "in.wkt: --to-crs EPSG:4326 is not a plane coordinate system; name a projected one, or auto",
                       "buffer", self.write("in.wkt", "POINT (5 5)\n"), "out.gpkg", "--radius", "1", "--crs", "EPSG:25832",
                       "--to-crs", "EPSG:4326")

    def test_place_that_cannot_be_projected(self):
        name = self.write("in.wkt", "POINT (9 50)\nLINESTRING (9 50, 9 95)\n")
        self.buffer("in.wkt: cannot be projected to ETRS89 / UTM zone 32N (EPSG:25832), line 2, vertex 1 (9 95); "
                    "choose another --to-crs or leave the feature out with --where", name, "--crs", "EPSG:4258",
                    "--to-crs", "EPSG:25832")
        self.buffer("in.wkt: is not a place on earth, line 2, vertex 1 (9 95); check the coordinate system, or name it "
                    "with --crs", name, "--crs", "EPSG:4258", "--to-crs", "auto")

    def test_differing_srid(self):
        self.bad_wkt("SRID=25832;POINT (0 0)\nSRID=25833;POINT (1 1)\n",
                     "SRID 25833 differs from 25832 on an earlier line, line 2; bring all lines into one coordinate system")

    def test_radius_finer_than_the_coordinates(self):
        name = self.write("in.wkt", "LINESTRING (4e15 4e15, 4000000000000010 4e15)\n")
        done = self.krepl("buffer", name, "out.gpkg", "--radius", "1e-9")
        self.assertIn(done.returncode, (1, 2))
        self.assertTrue(done.stderr.startswith("krepl: in.wkt: "), done.stderr)
        self.assertEqual(self.files(), ["in.wkt"])

    @unittest.skipIf(os.geteuid() == 0, "the superuser may read everything")
    def test_unreadable_file(self):
        name = self.write("in.wkt", "POINT (0 0)\n")
        os.chmod(self.directory / name, 0)
        self.buffer("in.wkt: cannot be read: Permission denied", name)


if __name__ == "__main__":
    support.main()
