"""krepl buffer: what goes in by every door, and that the zone is the right one (areas and counts from formulas)."""
import gzip
import json
import math

import support
from support import measure

PI = math.pi


class Buffer(support.CliTest):
    def zones(self, *arguments, stdin=""):
        done = self.succeed("buffer", *arguments, stdin=stdin)
        return [measure(line) for line in done.stdout.splitlines()]

    def zone(self, wkt, radius=1, *options):
        zones = self.zones("-", "-", "--radius", radius, *options, stdin=wkt)
        self.assertEqual(len(zones), 1)
        return zones[0]

    def check(self, zone, area, polygons=1, holes=0, length=None):
        self.assertEqual((zone.polygons, zone.holes), (polygons, holes))
        self.assertAlmostEqual(zone.area / area, 1, delta=1e-12)
        if length is not None:
            self.assertAlmostEqual(zone.length / length, 1, delta=1e-12)

    def test_point_is_a_full_circle(self):
        self.check(self.zone("POINT (3 4)", 5), 25 * PI, length=10 * PI)

    def test_segment(self):
        self.check(self.zone("LINESTRING (0 0, 10 0)"), 20 + PI, length=20 + 2 * PI)

    def test_closed_line_has_a_hole(self):
        zone = self.zone("LINESTRING (0 0, 10 0, 10 10, 0 10, 0 0)")
        self.check(zone, 144 - (4 - PI) - 64, holes=1, length=40 + 2 * PI + 32)

    def test_polygon_is_filled(self):
        self.check(self.zone("POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0))"), 144 - (4 - PI))

    def test_polygon_with_a_hole(self):
        wkt = "POLYGON ((0 0, 20 0, 20 20, 0 20, 0 0), (5 5, 15 5, 15 15, 5 15, 5 5))"
        self.check(self.zone(wkt), 22 * 22 - (4 - PI) - 64, holes=1)

    def test_multi_types_and_collections(self):
        three = "MULTIPOINT ((0 0), (10 0), (20 0))"
        self.check(self.zone(three), 3 * PI, polygons=3)
        self.check(self.zone("MULTILINESTRING ((0 0, 5 0), (20 0, 25 0))"), 2 * (10 + PI), polygons=2)
        self.check(self.zone("MULTIPOLYGON (((0 0, 1 0, 1 1, 0 1, 0 0)), ((9 0, 10 0, 10 1, 9 1, 9 0)))"), 2 * (5 + PI),
                   polygons=2)
        self.check(self.zone("GEOMETRYCOLLECTION (POINT (0 0), LINESTRING (10 0, 15 0))"), PI + 10 + PI, polygons=2)

    def test_curve_types_with_straight_parts_only(self):
        self.check(self.zone("COMPOUNDCURVE ((0 0, 5 0), (5 0, 10 0))"), 20 + PI)

    def test_lines_dissolve(self):
        zone = self.zone("LINESTRING (0 0, 10 0)\nLINESTRING (5 0, 15 0)\n\n# twice\nLINESTRING (0 0, 10 0)\n")
        self.check(zone, 30 + PI)

    def test_several_radii_are_several_zones(self):
        zones = self.zones("-", "-", "--radius", "1,2.5,1e1", stdin="POINT (0 0)")
        self.assertEqual(len(zones), 3)
        for zone, radius in zip(zones, (1, 2.5, 10)):
            self.check(zone, radius * radius * PI)

    def test_bands_are_what_each_zone_adds(self):
        bands = self.zones("-", "-", "--radius", "10,1,2.5", "--bands", stdin="POINT (0 0)")
        self.assertEqual(len(bands), 3)
        self.check(bands[0], PI)
        for band, inner, outer in zip(bands[1:], (1, 2.5), (2.5, 10)):
            self.check(band, (outer * outer - inner * inner) * PI, holes=1, length=2 * PI * (inner + outer))

    def test_bands_tell_their_radii_and_verify(self):
        self.write("in.wkt", "LINESTRING (0 0, 10 0, 13 9)\nPOLYGON ((20 0, 30 0, 30 10, 20 10, 20 0))\nPOINT (8 4)\n")
        total = self.zones("in.wkt", "-", "--radius", "4")[0].area
        for extension, layer in (("gpkg", "zone"), ("fgb", "zone"), ("geojson", "zone"), ("shp", "out")):
            name = f"out.{extension}"
            allowed = () if extension in ("gpkg", "fgb") else ("--max-error", "1e-6")
            self.succeed("buffer", "in.wkt", name, "--radius", "1,2,4", "--bands", *allowed)
            rows = json.loads(self.ogr("ogr2ogr", "-f", "GeoJSON", "/vsistdout/", name, layer))["features"]
            told = [(row["properties"]["inner"], row["properties"]["radius"]) for row in rows]
            self.assertEqual(told, [(0, 1), (1, 2), (2, 4)])
            self.assertAlmostEqual(sum(row["properties"]["area"] for row in rows), total, delta=1e-9 * total)
            done = self.succeed("verify", name, "--against", "in.wkt", *allowed)
            self.assertIn("band of radius 1 to 2", done.stdout)
        pieces = json.loads(self.ogr("ogr2ogr", "-f", "GeoJSON", "/vsistdout/", "out.gpkg", "pieces"))["features"]
        self.assertEqual({row["properties"]["radius"] for row in pieces}, {1, 2, 4})
        self.succeed("buffer", "in.wkt", "out.wkt", "--radius", "1,2,4", "--bands")
        self.succeed("verify", "out.wkt", "--against", "in.wkt", "--radius", "1,2,4", "--bands")
        wrong = self.krepl("verify", "out.wkt", "--against", "in.wkt", "--radius", "1,2.001,4", "--bands")
        self.assertEqual(wrong.returncode, 1)
        self.succeed("buffer", "in.wkt", "out.svg", "--radius", "1,2", "--bands")
        self.assertIn('data-radius="2" data-inner="1"', self.text("out.svg"))
        self.succeed("buffer", "in.wkt", "out.dxf", "--radius", "1,2", "--bands")
        self.assertIn("BAND_1_2", self.text("out.dxf"))

    def test_bands_out_of_a_diagram(self):
        self.write("in.wkt", "LINESTRING (0 0, 10 0, 13 9, 40 9)")
        self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", "0.25:5:0.25", "--bands")
        done = self.succeed("verify", "out.gpkg", "--against", "in.wkt")
        self.assertIn("band of radius 4.75 to 5", done.stdout)

    def test_bands_go_with_round_zones_only(self):
        line = "LINESTRING (0 0, 10 0)"
        message = "bands have round caps and joins, both sides and positive radii; leave the other options out"
        for options in (("--cap", "flat"), ("--side", "left"), ("--ring",), ("--join", "mitre")):
            self.fail_with(2, message, "buffer", "-", "out.gpkg", "--radius", "1,2", "--bands", *options, stdin=line)
        self.fail_with(2, "--bands does not go with radii or zones of single features; leave one of them out", "buffer", "-",
                       "out.gpkg", "--radius", "1,2", "--bands", "--per-feature", stdin=line)
        self.fail_with(2, "standard input: the radii 1 and 1 are too close for a band, or not in ascending order; "
                          "let them differ by more than 1.45519152284e-10", "buffer", "-", "out.gpkg", "--radius", "1,1", "--bands", stdin=line)

    def test_auto_takes_the_sweep_inside_a_digitised_circle(self):
        corners = [(1000 * math.cos(2 * PI * i / 3000), 1000 * math.sin(2 * PI * i / 3000)) for i in range(3000)]
        self.write("in.wkt", "LINESTRING (" + ", ".join(f"{x:.3f} {y:.3f}" for x, y in corners + corners[:1]) + ")")
        done = self.succeed("buffer", "in.wkt", "auto.wkb", "--radius", "999.9", "--verbose")
        self.assertIn("intervals  given up: more than 40 cigars", done.stderr)
        self.assertIn("sweep ", done.stderr)
        self.succeed("buffer", "in.wkt", "intervals.wkb", "--radius", "999.9", "--engine", "intervals")
        self.assertEqual((self.directory / "auto.wkb").read_bytes(), (self.directory / "intervals.wkb").read_bytes())
        done = self.succeed("buffer", "in.wkt", "auto.wkb", "--radius", "10", "--verbose")
        self.assertNotIn("given up", done.stderr)

    def test_separate(self):
        zones = self.zones("-", "-", "--radius", "1", "--separate", stdin="MULTIPOINT ((0 0), (10 0), (20 0))")
        self.assertEqual(len(zones), 3)
        for zone in zones:
            self.check(zone, PI)

    def test_same_bytes_for_any_number_of_threads(self):
        lines = "\n".join(f"LINESTRING ({i % 37} {i * i % 53}, {i * 7 % 41} {i * 5 % 43})" for i in range(500))
        self.write("in.wkt", lines)
        for threads in (1, 2, 7):
            for extension in ("gpkg", "wkt", "fgb", "svg", "dxf", "geojson", "shp"):
                self.succeed("buffer", "in.wkt", f"out{threads}.{extension}", "--radius", "0.3", "--threads", threads)
        for extension in ("gpkg", "wkt", "fgb", "svg", "dxf", "geojson", "shp", "dbf", "shx"):
            one, two, seven = ((self.directory / f"out{n}.{extension}").read_bytes() for n in (1, 2, 7))
            self.assertTrue(one == two == seven, extension)
            self.assertGreater(len(one), 99)

    # --- doors ---

    def test_compressed_text(self):
        (self.directory / "in.wkt.gz").write_bytes(gzip.compress(b"POINT (0 0)\r\nPOINT (9 0)\r\n"))
        zones = self.zones("in.wkt.gz", "-", "--radius", "1")
        self.check(zones[0], 2 * PI, polygons=2)

    def test_geojson_on_standard_input(self):
        geojson = {"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}},
                   "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1, 2]}}]}
        self.check(self.zone(json.dumps(geojson)), PI)

    def test_byte_order_mark_and_blank_lines(self):
        self.check(self.zone("\ufeffPOINT (0 0)\n\n"), PI)

    def test_wkb(self):
        self.write("in.wkt", "LINESTRING (0 0, 10 0)\nPOINT (20 0)\n")
        little = "0102000000" "02000000" "0000000000000000" "0000000000000000" "0000000000002440" "0000000000000000"
        big = "0000000001" "4034000000000000" "0000000000000000"
        (self.directory / "in.wkb").write_bytes(bytes.fromhex(little + big))
        self.check(self.zones("in.wkb", "-", "--radius", "1")[0], 20 + 2 * PI, polygons=2)

    def test_ogr_formats_layers_and_conditions(self):
        self.need("ogr2ogr")
        self.write("in.csv", 'name,WKT\na,"LINESTRING (0 0, 10 0)"\nb,"POINT (100 0)"\nc,"LINESTRING (200 0, 210 0)"\n')
        self.ogr("ogr2ogr", "in.gpkg", "in.csv", "-nln", "things", "-nlt", "GEOMETRY", "-a_srs", "EPSG:25832")
        self.ogr("ogr2ogr", "in.geojson", "in.gpkg")
        for name in ("in.gpkg", "in.geojson"):
            self.check(self.zones(name, "-", "--radius", "1")[0], 40 + 3 * PI, polygons=3)
            self.check(self.zones(name, "-", "--radius", "1", "--where", "name <> 'b'")[0], 40 + 2 * PI, polygons=2)
        self.check(self.zones("in.gpkg", "-", "--radius", "1", "--layer", "things")[0], 40 + 3 * PI, polygons=3)

    def test_zipped_shapefile(self):
        self.need("ogr2ogr")
        self.write("in.csv", 'name,WKT\na,"LINESTRING (0 0, 10 0)"\n')
        self.ogr("ogr2ogr", "in.shp.zip", "in.csv", "-f", "ESRI Shapefile", "-nln", "in", "-nlt", "LINESTRING")
        self.check(self.zones("in.shp.zip", "-", "--radius", "1")[0], 20 + PI)

    def test_height_is_left_out_with_a_note(self):
        self.write("in.wkt", "LINESTRING Z (0 0 5, 10 0 6)\n")
        done = self.succeed("buffer", "in.wkt", "-", "--radius", "1")
        self.assertTrue(done.stderr.startswith("krepl: in.wkt: note: Z and M values are left out\n"), done.stderr)
        self.check(measure(done.stdout), 20 + PI)

    # --- coordinate systems ---

    def test_automatic_utm(self):
        self.write("in.wkt", "LINESTRING (9 50, 9.1 50.1)\n")
        done = self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", "100", "--crs", "EPSG:4326", "--to-crs", "auto")
        self.assertEqual(done.stderr, "krepl: in.wkt: note: coordinates projected to WGS 84 / UTM zone 32N (EPSG:32632)\n")
        self.need("ogrinfo", "ogr2ogr")
        self.assertIn('ID["EPSG",32632]', self.ogr("ogrinfo", "-so", "-al", "out.gpkg"))
        # Where the first vertex must lie, by GDAL's own transformation.
        text = self.ogr("ogr2ogr", "-f", "CSV", "/vsistdout/", "out.gpkg", "zone", "-lco", "GEOMETRY=AS_WKT")
        self.assertAlmostEqual(measure(text.split('"')[1]).area, PI * 1e4 + 200 * math.dist(*self.ends_in_utm()), delta=1e-3)

    def ends_in_utm(self):
        self.write("ends.csv", 'id,WKT\n1,"LINESTRING (9 50, 9.1 50.1)"\n')
        text = self.ogr("ogr2ogr", "-f", "CSV", "/vsistdout/", "ends.csv", "-s_srs", "OGC:CRS84", "-t_srs", "EPSG:32632",
                        "-lco", "GEOMETRY=AS_WKT")
        numbers = text.split("(")[1].split(")")[0].replace(",", " ").split()
        x0, y0, x1, y1 = map(float, numbers)
        return (x0, y0), (x1, y1)

    def test_automatic_projection_of_wide_data(self):
        self.write("in.wkt", "LINESTRING (0 40, 30 60)\n")
        done = self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", "1000", "--crs", "OGC:CRS84", "--to-crs", "auto")
        self.assertEqual(done.stderr, "krepl: in.wkt: note: coordinates projected to Azimuthal equidistant around 15 50\n")

    def test_automatic_projection_across_the_date_line(self):
        self.write("in.wkt", "LINESTRING (179.9 -17, 179.95 -17)\nPOINT (-179.9 -17)\n")
        done = self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", "1000", "--crs", "EPSG:4326", "--to-crs", "auto")
        self.assertRegex(done.stderr, r"WGS 84 / UTM zone (60S \(EPSG:32760\)|1S \(EPSG:32701\))\n$")

    def test_named_projection_and_srid(self):
        self.write("in.wkt", "SRID=4258;POINT (9 50)\n")
        self.succeed("buffer", "in.wkt", "out.wkt", "--radius", "10", "--to-crs", "EPSG:25832")
        numbers = [float(t) for t in support.tokens(self.text("out.wkt")) if t[0] in "-0123456789"]
        self.assertAlmostEqual(numbers[0], 500010, delta=1e-3)  # the central meridian of zone 32
        self.assertAlmostEqual(numbers[1], 5538630.70, delta=0.01)

    def test_assigned_system_reaches_the_output(self):
        self.need("ogrinfo")
        self.write("in.wkt", "POINT (500000 5500000)\n")
        for extension in ("gpkg", "fgb", "shp", "geojson"):
            self.succeed("buffer", "in.wkt", f"out.{extension}", "--radius", "10", "--crs", "EPSG:25832")
            text = self.ogr("ogrinfo", "-so", "-al", f"out.{extension}")
            self.assertIn("ETRS89 / UTM zone 32N", text, extension)


if __name__ == "__main__":
    support.main()
