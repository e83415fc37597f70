"""Every format that krepl writes, read back by GDAL (and by twenty lines of Python where GDAL has no reader for arcs)."""
import csv
import io
import math
import re
import xml.etree.ElementTree

import support
from support import measure

PI = math.pi
# A closed square, a cross over one side, and a far point: arcs, straight holes, full circle, two polygons.
NETWORK = "LINESTRING (0 0, 10 0, 10 10, 0 10, 0 0)\nLINESTRING (5 -5, 5 5)\nPOINT (100 50)\n"
# The square's zone, then what the cross adds outside and inside of it.
AREA = (144 - (4 - PI) - 64) + (4 * 2 + PI / 2) + (4 * 2 + PI / 2) + PI


class Formats(support.CliTest):
    def setUp(self):
        super().setUp()
        self.need("ogrinfo", "ogr2ogr")
        self.write("in.wkt", NETWORK)

    def buffer(self, output, *options):
        return self.succeed("buffer", "in.wkt", output, "--radius", "1", "--crs", "EPSG:25832", *options)

    def rows(self, name, layer="zone", *options):
        """Features as dictionaries, geometry in WKT under `WKT`, numbers with all their digits."""
        text = self.ogr("ogr2ogr", "-f", "CSV", "/vsistdout/", name, layer, "-lco", "GEOMETRY=AS_WKT", *options)
        csv.field_size_limit(1 << 28)
        return list(csv.DictReader(io.StringIO(text)))

    def check_attributes(self, row):
        self.assertEqual(float(row["radius"]), 1)
        self.assertAlmostEqual(float(row["area"]), AREA, delta=1e-10)
        self.assertEqual((int(row["polygons"]), int(row["holes"])), (2, 1))

    def check_curves(self, wkt):
        found = measure(wkt)
        self.assertEqual((found.polygons, found.holes), (2, 1))
        self.assertAlmostEqual(found.area, AREA, delta=1e-9)
        self.assertGreaterEqual(found.arcs, 8)

    def check_chords(self, wkt, max_error):
        found = measure(wkt)
        self.assertEqual((found.polygons, found.holes, found.arcs), (2, 1, 0))
        self.assertLess(found.area, AREA)
        # Chords cut at most two thirds of the deviation times the length of the arcs, here three full circles' worth.
        self.assertGreater(found.area, AREA - 3 * 2 * PI * max_error)

    # --- true curves ---

    def test_geopackage(self):
        self.buffer("out.gpkg")
        info = self.ogr("ogrinfo", "-so", "-al", "out.gpkg")
        self.assertIn("Geometry: Multi Surface", info)
        self.assertIn("ETRS89 / UTM zone 32N", info)
        (row,) = self.rows("out.gpkg")
        self.check_attributes(row)
        self.check_curves(row["WKT"])

    def test_geopackage_pieces_name_their_origin(self):
        self.buffer("out.gpkg")
        pieces = self.rows("out.gpkg", "pieces")
        (zone,) = self.rows("out.gpkg")
        self.assertAlmostEqual(sum(float(p["length"]) for p in pieces), float(zone["perimeter"]), delta=1e-9)
        self.assertEqual({p["kind"] for p in pieces}, {"segment", "arc"})
        circle = [p for p in pieces if p["source_feature"] == "3"]  # the line of the point
        self.assertEqual([(p["kind"], p["source_part"], p["source_vertex"]) for p in circle], [("arc", "2", "0")])
        self.assertAlmostEqual(float(circle[0]["length"]), 2 * PI, delta=1e-12)
        # The left side of the square is segment 3 of the first line.
        left = [p for p in pieces if (p["source_feature"], p["source_vertex"], p["kind"]) == ("1", "3", "segment")]
        self.assertEqual(sorted(float(p["length"]) for p in left), [8, 10])
        for piece in pieces:
            self.assertTrue(piece["WKT"].startswith("COMPOUNDCURVE ("), piece["WKT"])
            self.assertEqual("CIRCULARSTRING" in piece["WKT"], piece["kind"] == "arc")

    def test_geopackage_without_pieces(self):
        self.buffer("out.gpkg", "--no-pieces")
        self.assertNotIn("pieces", self.ogr("ogrinfo", "out.gpkg"))

    def test_geopackage_separate(self):
        self.buffer("out.gpkg", "--separate")
        self.assertIn("Geometry: Curve Polygon", self.ogr("ogrinfo", "-so", "-al", "out.gpkg"))
        rows = self.rows("out.gpkg")
        self.assertEqual(len(rows), 2)
        self.assertAlmostEqual(sum(float(r["area"]) for r in rows), AREA, delta=1e-10)
        for row in rows:
            self.assertAlmostEqual(measure(row["WKT"]).area, float(row["area"]), delta=1e-9)
            self.assertAlmostEqual(measure(row["WKT"]).length, float(row["perimeter"]), delta=1e-9)
            self.assertEqual((row["polygons"], measure(row["WKT"]).holes), ("1", int(row["holes"])))

    def test_geopackage_without_coordinate_system(self):
        self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", "1")
        self.assertIn("Undefined Cartesian SRS", self.ogr("ogrinfo", "-so", "-al", "out.gpkg"))

    def test_flatgeobuf(self):
        self.buffer("out.fgb")
        (row,) = self.rows("out.fgb")
        self.check_attributes(row)
        self.check_curves(row["WKT"])

    def test_nested_zones_keep_their_order(self):
        for extension in ("gpkg", "fgb"):
            self.succeed("buffer", "in.wkt", f"out.{extension}", "--radius", "2,1,3")
            self.assertEqual([float(r["radius"]) for r in self.rows(f"out.{extension}")], [2, 1, 3])

    def test_wkt_is_read_by_ogr(self):
        self.buffer("out.wkt")
        self.check_curves(self.text("out.wkt"))
        self.write("wrapped.csv", 'id,WKT\n1,"' + self.text("out.wkt").strip() + '"\n')
        (row,) = self.rows("wrapped.csv", "wrapped")
        self.check_curves(row["WKT"])

    def test_wkb_is_read_by_ogr(self):
        self.buffer("out.wkb")
        blob = (self.directory / "out.wkb").read_bytes()
        self.assertEqual(blob[:5], bytes.fromhex("010c000000"))  # little-endian MULTISURFACE of ISO
        self.write("wrapped.csv", "id,geom\n1," + blob.hex().upper() + "\n")
        (row,) = self.rows("wrapped.csv", "wrapped", "-oo", "GEOM_POSSIBLE_NAMES=geom")
        self.check_curves(row["WKT"])

    def test_full_circle_is_round_for_ogr(self):
        self.write("in.wkt", "POINT (10 20)\n")
        self.buffer("out.gpkg")
        (row,) = self.rows("out.gpkg", "zone", "-nlt", "CONVERT_TO_LINEAR", "--config", "OGR_ARC_STEPSIZE", "0.1")
        self.assertAlmostEqual(measure(row["WKT"]).area, PI, delta=1e-5)

    def test_gml_keeps_arcs(self):
        done = self.buffer("out.gml", "--format", "GML")
        self.assertNotIn("deviate", done.stderr)
        (row,) = self.rows("out.gml")
        self.check_curves(row["WKT"])

    # --- chords ---

    def test_shapefile_and_geojson_within_the_default_error(self):
        for name, layer in (("out.shp", "out"), ("out.geojson", "zone")):
            done = self.buffer(name)
            self.assertRegex(done.stderr, rf"^krepl: {name}: note: \w+ has no arcs; the polygons deviate from the true zone "
                                          r"by 0\.000\d+ at most\n$")
            (row,) = self.rows(name, layer)
            self.check_attributes(row)
            self.check_chords(row["WKT"], 1e-3)

    def test_max_error(self):
        for max_error in (0.3, 0.01, 1e-6):
            done = self.buffer("out.geojson", "--max-error", max_error)
            reached = float(re.search(r"by (\S+) at most", done.stderr)[1])
            self.assertLessEqual(reached, max_error)
            self.assertGreater(reached, max_error / 5)
            self.check_chords(self.rows("out.geojson")[0]["WKT"], max_error)

    def test_coarsest_polygon_is_still_one(self):
        self.buffer("out.geojson", "--max-error", "1000")
        found = measure(self.rows("out.geojson")[0]["WKT"])
        self.assertEqual((found.polygons, found.holes), (2, 1))

    def test_other_ogr_formats(self):
        self.buffer("out.kml")
        self.assertTrue((self.directory / "out.kml").exists())
        self.buffer("out.tab")
        self.assertEqual([n for n in self.files() if n.startswith("out.")],
                         ["out.dat", "out.id", "out.kml", "out.map", "out.tab"])

    def test_format_overrides_the_extension(self):
        self.buffer("out.txt", "--format", "wkt")
        self.check_curves(self.text("out.txt"))
        self.buffer("data.bin", "--format", "GPKG", "--no-pieces")
        self.check_curves(self.rows("data.bin")[0]["WKT"])

    # --- drawings ---

    def test_dxf_has_bulges_that_ogr_reads(self):
        self.buffer("out.dxf")
        rows = self.rows("out.dxf", "entities", "--config", "OGR_ARC_STEPSIZE", "0.1")
        area = {"ZONE_1": 0.0, "ZONE_1_HOLES": 0.0}
        for row in rows:
            points = [tuple(map(float, p.split()[:2])) for p in re.findall(r"[^(),]+", row["WKT"])[1:] if p.strip()]
            self.assertEqual(points[0], points[-1])
            area[row["Layer"]] += sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:])) / 2
        self.assertEqual(len(rows), 3)
        self.assertLess(area["ZONE_1_HOLES"], 0)
        self.assertAlmostEqual(area["ZONE_1"] + area["ZONE_1_HOLES"], AREA, delta=1e-4)
        self.check_bulges(self.text("out.dxf"))

    def check_bulges(self, text):
        """The true area from vertices and bulges, as a CAD program sees them."""
        lines = [line.strip() for line in text.splitlines()]
        pairs = list(zip(lines[::2], lines[1::2]))
        total, ring = 0.0, None
        rings = []
        for code, value in pairs:
            if code == "0":
                ring = [] if value == "LWPOLYLINE" else None
                if ring is not None:
                    rings.append(ring)
            elif ring is not None and code == "10":
                ring.append([float(value), None, 0.0])
            elif ring is not None and code == "20":
                ring[-1][1] = float(value)
            elif ring is not None and code == "42":
                ring[-1][2] = float(value)
        for ring in rings:
            for (x0, y0, bulge), (x1, y1, _) in zip(ring, ring[1:] + ring[:1]):
                total += (x0 * y1 - x1 * y0) / 2
                if bulge:
                    angle = 4 * math.atan(bulge)
                    r = math.hypot(x1 - x0, y1 - y0) / 2 / math.sin(angle / 2)
                    self.assertAlmostEqual(r, 1, delta=1e-12)
                    total += r * r * (angle - math.sin(angle)) / 2
        self.assertAlmostEqual(total, AREA, delta=1e-10)

    def test_svg_has_arcs_and_the_network(self):
        self.buffer("out.svg")
        root = xml.etree.ElementTree.parse(self.directory / "out.svg").getroot()
        space = "{http://www.w3.org/2000/svg}"
        groups = {g.get("class"): g for g in root.iter(f"{space}g")}
        self.assertEqual(groups["zone"].get("data-radius"), "1")
        self.assertEqual(len(groups["input"].findall(f"{space}path")), 3)
        area = sum(self.path_area(p.get("d")) for p in groups["zone"].findall(f"{space}path"))
        self.assertAlmostEqual(-area, AREA, delta=1e-10)  # y points down: outer rings run the other way
        x, y, width, height = map(float, root.get("viewBox").split())
        ox, oy = map(float, root.get("data-origin").split())
        self.assertLess(x + ox, -1)  # the zone of the square's left side
        self.assertGreater(x + width + ox, 101)
        self.assertLess(oy - (y + height), -6)
        self.assertGreater(oy - y, 51)

    def path_area(self, path):
        total, at, start = 0.0, None, None
        for command, numbers in re.findall(r"([MLAZ])([^MLAZ]*)", path):
            values = [float(v) for v in numbers.split()]
            end = tuple(values[-2:]) if values else start
            if command == "M":
                start = end
            else:
                total += (at[0] * end[1] - end[0] * at[1]) / 2
            if command == "A":
                radius, _, _, large, sweep = values[:5]
                self.assertEqual((radius, large), (1, 0))
                angle = 2 * math.asin(math.dist(at, end) / 2 / radius)
                total += (1 if sweep else -1) * radius * radius * (angle - math.sin(angle)) / 2
            at = end
        return total


if __name__ == "__main__":
    support.main()
