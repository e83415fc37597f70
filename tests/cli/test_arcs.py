"""Arcs of the input: kept where zones have both sides and are not shared out, else refused, or chords within --arc-error in their place."""
import math
import re

import support

PI = math.pi
R, ERROR = 2.0, 1e-6
ROOT = math.sqrt(0.5)
HALF = "CIRCULARSTRING (0 0, 10 10, 20 0)"
CIRCLE = "CIRCULARSTRING (0 0, 20 0, 0 0)"
# A stadium: half circles of radius 5 at both ends of a rectangle.
STADIUM = "COMPOUNDCURVE ((0 0, 20 0), CIRCULARSTRING (20 0, 25 5, 20 10), (20 10, 0 10), CIRCULARSTRING (0 10, -5 5, 0 0))"


class Arcs(support.CliTest):
    def zone(self, wkt, *options, error=ERROR):
        self.write("in.wkt", wkt + "\n")
        done = self.succeed("buffer", "in.wkt", "out.wkt", "--radius", R, "--arc-error", error, *options)
        return support.measure(self.text("out.wkt")), done.stderr

    def expect_area(self, wkt, area, length, arcs, error=ERROR):
        """Chords lie on the inner side of an arc, so that the zone is off by `error` times its boundary at most."""
        zone, note = self.zone(wkt, error=error)
        self.assertAlmostEqual(zone.area, area, delta=error * length)
        told = re.search(r"note: chords stand for (\d+) arcs and deviate by (\S+) at most", note)
        self.assertEqual(int(told[1]), arcs)
        self.assertLessEqual(float(told[2]), error)
        self.assertGreater(float(told[2]), error / 4)
        return zone

    def test_every_type(self):
        half, stadium = PI * (144 - 64) / 2 + PI * R * R, 200 + 25 * PI + (40 + 10 * PI) * R + PI * R * R
        ring, disk = PI * (144 - 64), PI * 144
        for wkt, area, arcs in (
                (HALF, half, 1),
                (f"MULTICURVE ({HALF}, (100 0, 110 0))", half + 10 * 2 * R + PI * R * R, 1),
                (CIRCLE, ring, 1),
                (f"CURVEPOLYGON ({CIRCLE})", disk, 1),
                (f"CURVEPOLYGON ({STADIUM})", stadium, 2),
                (f"CURVEPOLYGON ({CIRCLE}, CIRCULARSTRING (5 0, 15 0, 5 0))", disk - PI * 9, 2),
                (f"MULTISURFACE (CURVEPOLYGON ({CIRCLE}), ((100 0, 101 0, 101 1, 100 0)))", disk + 0.5 + (2 + 2 * ROOT) * R + PI * R * R, 1),
                (f"GEOMETRYCOLLECTION ({HALF}, POINT (100 0))", half + PI * R * R, 1),
                ("COMPOUNDCURVE ((-10 0, 0 0), CIRCULARSTRING (0 0, 10 10, 20 0, 30 -10, 40 0))", None, 2)):
            with self.subTest(wkt=wkt):
                if area is None:
                    self.assertEqual(self.zone(wkt)[0].polygons, 1)
                else:
                    self.expect_area(wkt, area, 400, arcs)

    def test_finer_and_coarser(self):
        half = PI * (144 - 64) / 2 + PI * R * R
        for error in (0.5, 1e-2, 1e-4, 1e-7):
            with self.subTest(error=error):
                self.expect_area(HALF, half, 100, 1, error)

    def test_arcs_run_both_ways_share_their_chords(self):
        left = "CURVEPOLYGON (COMPOUNDCURVE ((0 10, -20 0, 0 -10), CIRCULARSTRING (0 -10, 3 0, 0 10)))"
        right = "CURVEPOLYGON (COMPOUNDCURVE (CIRCULARSTRING (0 10, 3 0, 0 -10), (0 -10, 20 0, 0 10)))"
        zone, text = self.zone(left + "\n" + right, "--verbose")
        self.assertEqual((zone.polygons, zone.holes), (1, 0))
        self.assertAlmostEqual(zone.area, 400 + 4 * math.hypot(20, 10) * R + PI * R * R, places=6)
        segments = int(re.search(r"(\d+) segments", text)[1])
        dropped = int(re.search(r"(\d+) duplicate segments dropped", text)[1])
        self.assertEqual(segments, dropped + 4)

    def test_three_points_on_a_line_are_no_arc(self):
        zone, note = self.zone("CIRCULARSTRING (0 0, 5 0, 10 0)")
        self.assertAlmostEqual(zone.area, 10 * 2 * R + PI * R * R, places=9)
        self.assertNotIn("chords", note)

    def test_straight_curve_types_need_no_option(self):
        self.write("in.wkt", "CURVEPOLYGON ((0 0, 10 0, 10 10, 0 0))\nCOMPOUNDCURVE ((0 0, 10 0), (10 0, 20 5))\n")
        self.succeed("buffer", "in.wkt", "out.wkt", "--radius", R)

    def test_geopackage(self):
        self.need("ogr2ogr")
        self.write("in.csv", f'id,wkt\n1,"CURVEPOLYGON ({STADIUM})"\n')
        self.ogr("ogr2ogr", "in.gpkg", "in.csv", "-oo", "GEOM_POSSIBLE_NAMES=wkt", "-oo", "KEEP_GEOM_COLUMNS=NO",
                 "-nlt", "CURVEPOLYGON", "-a_srs", "EPSG:25832")
        self.fail_with(1, "in.gpkg: arcs of the input cannot stay arcs here, feature 1; give "
                       "--arc-error LENGTH for chords in their place that deviate by no more",
                       "buffer", "in.gpkg", "out.wkt", "--radius", R, "--engine", "intervals", output="out.wkt")
        self.succeed("buffer", "in.gpkg", "out.wkt", "--radius", R, "--arc-error", ERROR)
        self.assertAlmostEqual(support.measure(self.text("out.wkt")).area,
                               200 + 25 * PI + (40 + 10 * PI) * R + PI * R * R, delta=ERROR * 100)

    def test_verify(self):
        self.zone(HALF, error=1e-3)
        self.succeed("verify", "out.wkt", "--against", "in.wkt", "--radius", R, "--arc-error", 1e-3)
        # The chords deviate from the true arc.
        done = self.krepl("verify", "out.wkt", "--against", "in.wkt", "--radius", R)
        self.assertEqual(done.returncode, 1)
        self.assertIn("is not the zone of radius 2", done.stderr)

    def test_other_verbs(self):
        self.write("in.wkt", HALF + "\n")
        self.succeed("offset", "in.wkt", "out.wkt", "--distance", "-3", "--arc-error", 1e-4)
        length = sum(math.dist(*p) if len(p) == 2 else support.piece_measure(p)[0]
                     for p in support.Parser(self.text("out.wkt")).curve())
        self.assertIn(round(length, 1), (round(7 * PI, 1), round(13 * PI, 1)))

    def kept(self, wkt, *options, radius=R):
        self.write("in.wkt", wkt + "\n")
        done = self.succeed("buffer", "in.wkt", "out.wkt", "--radius", radius, *options)
        self.assertNotIn("chords", done.stderr)
        self.succeed("verify", "out.wkt", "--against", "in.wkt", "--radius", radius, *options)
        return support.measure(self.text("out.wkt"))

    def test_kept_as_arcs(self):
        half, stadium = PI * (144 - 64) / 2 + PI * R * R, 200 + 25 * PI + (40 + 10 * PI) * R + PI * R * R
        for wkt, area, arcs in (
                (HALF, half, 4),
                (f"MULTICURVE ({HALF}, (100 0, 110 0))", half + 10 * 2 * R + PI * R * R, 6),
                (CIRCLE, PI * (144 - 64), 4),  # a full circle is written as two arcs
                (f"CURVEPOLYGON ({CIRCLE})", PI * 144, 2),
                (f"CURVEPOLYGON ({STADIUM})", stadium, 2),
                (f"CURVEPOLYGON ({CIRCLE}, CIRCULARSTRING (5 0, 15 0, 5 0))", PI * 144 - PI * 9, 4),
                (f"MULTISURFACE (CURVEPOLYGON ({CIRCLE}), ((100 0, 101 0, 101 1, 100 0)))",
                 PI * 144 + 0.5 + (2 + 2 * ROOT) * R + PI * R * R, 5),
                (f"GEOMETRYCOLLECTION ({HALF}, POINT (100 0))", half + PI * R * R, 6)):
            with self.subTest(wkt=wkt):
                zone = self.kept(wkt)
                self.assertAlmostEqual(zone.area, area, delta=1e-10 * area)
                self.assertGreaterEqual(zone.arcs, arcs)  # half circles may be written as two

    def test_shrunk_and_rings(self):
        stadium, around = 200 + 25 * PI, 40 + 10 * PI
        for radius, options, area in (
                (-R, (), stadium - around * R + PI * R * R),
                (-R, ("--ring",), around * R - PI * R * R),
                (R, ("--ring",), around * R + PI * R * R)):
            with self.subTest(radius=radius, options=options):
                zone = self.kept(f"CURVEPOLYGON ({STADIUM})", *options, radius=radius)
                self.assertAlmostEqual(zone.area, area, delta=1e-9 * area)
        self.write("in.wkt", f"CURVEPOLYGON ({STADIUM})\n")
        done = self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", -6)
        self.assertIn("note: nothing is left at radius -6", done.stderr)

    def test_caps_and_joins(self):
        side = 2 * R * 10 * PI
        for options, area in ((("--cap", "flat"), side), (("--cap", "square"), side + 4 * R * R),
                              (("--join", "mitre"), side + PI * R * R)):
            with self.subTest(options=options):
                self.assertAlmostEqual(self.kept(HALF, *options).area, area, delta=1e-9 * area)

    def test_faults_of_rings(self):
        self.write("in.wkt", f"MULTISURFACE (CURVEPOLYGON ({CIRCLE}), CURVEPOLYGON (CIRCULARSTRING (5 0, 35 0, 5 0)))\n")
        done = self.succeed("buffer", "in.wkt", "out.wkt", "--radius", -1)
        self.assertIn("sides cross, first at", done.stderr)

    def test_zone_of_a_zone(self):
        self.kept("COMPOUNDCURVE ((-10 0, 0 0), CIRCULARSTRING (0 0, 10 10, 20 0, 30 -10, 40 0))", radius=1)
        self.succeed("buffer", "out.wkt", "twice.wkt", "--radius", 2)
        self.succeed("buffer", "in.wkt", "once.wkt", "--radius", 3)
        self.succeed("verify", "twice.wkt", "--against", "in.wkt", "--radius", 3)
        once, twice = (support.measure(self.text(name)) for name in ("once.wkt", "twice.wkt"))
        self.assertAlmostEqual(once.area, twice.area, delta=1e-9 * once.length)

    def test_threads_and_formats(self):
        self.write("in.wkt", f"{HALF}\nCURVEPOLYGON ({STADIUM})\n{CIRCLE}\n")
        for name in ("out.wkt", "out.svg", "out.dxf", "out.geojson"):
            texts = []
            for threads in (1, 2):
                self.succeed("buffer", "in.wkt", name, "--radius", R, "--threads", threads)
                texts.append(self.text(name))
            self.assertEqual(*texts)
        self.succeed("verify", "out.geojson", "--against", "in.wkt", "--radius", R, "--max-error", R / 1000)
        svg = self.text("out.svg")
        self.assertGreater(svg[svg.index('class="input"'):].count("A"), 3)  # the input's own arcs

    def test_pieces_name_their_arc(self):
        self.need("ogrinfo")
        self.write("in.wkt", f"POINT (100 100)\n{HALF}\n")
        self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", R)
        told = self.ogr("ogrinfo", "-al", "-geom=NO", "out.gpkg", "pieces")
        self.assertEqual(told.count("source_feature (Integer64) = 2"), 4)
        self.assertEqual(told.count("radius (Real) = 2\n"), 5)

    def test_zones_of_features(self):
        """Features and groups of them keep their arcs, beside others without any; all options of shapes are taken."""
        self.need("ogr2ogr")
        self.write("in.csv", f'name,w,wkt\na,2,"{HALF}"\nb,1,"CURVEPOLYGON ({STADIUM})"\na,3,"LINESTRING (40 0, 50 0)"\n')
        self.ogr("ogr2ogr", "in.gpkg", "in.csv", "-oo", "GEOM_POSSIBLE_NAMES=wkt", "-oo", "KEEP_GEOM_COLUMNS=NO",
                 "-oo", "AUTODETECT_TYPE=YES", "-a_srs", "EPSG:25832")
        half, line = lambda r: 20 * PI * r + PI * r * r, lambda r: 20 * r + PI * r * r
        stadium = lambda r: 200 + 25 * PI + (40 + 10 * PI) * r + PI * r * r
        for options, areas in (
                (("--per-feature", "--radius", R), (half(R), stadium(R), line(R))),
                (("--dissolve-by", "name", "--radius", R), (half(R) + line(R), stadium(R))),
                (("--per-feature", "--radius-field", "w"), (half(2), stadium(1), line(3))),
                (("--per-feature", "--radius", "2*w+1"), (half(5), stadium(3), line(7))),
                (("--per-feature", "--radius", "1,3"), (half(1), half(3), stadium(1), stadium(3), line(1), line(3))),
                (("--dissolve-by", "name", "--radius-field", "w"), (half(2) + line(3), stadium(1))),
                (("--per-feature", "--radius", R, "--cap", "flat", "--join", "bevel"), (20 * PI * R, stadium(R), 20 * R))):
            with self.subTest(options=options):
                done = self.succeed("buffer", "in.gpkg", "out.gpkg", *options)
                self.assertNotIn("chords", done.stderr)
                self.succeed("verify", "out.gpkg", "--against", "in.gpkg", *options)
                told = self.ogr("ogrinfo", "-al", "-q", "out.gpkg")
                found = [float(area) for area in re.findall(r"area \(Real\) = (\S+)", told)]
                self.assertEqual(len(found), len(areas))
                for area, expected in zip(found, areas):
                    self.assertAlmostEqual(area, expected, delta=1e-9 * expected)
                self.assertGreater(told.count("CIRCULARSTRING"), len(areas))
        # One zone of several radii: the half circle of 2 and the stadium of 1 overlap.
        self.succeed("buffer", "in.gpkg", "out.wkt", "--radius-field", "w")
        self.succeed("verify", "out.wkt", "--against", "in.gpkg", "--radius-field", "w")
        zone = support.measure(self.text("out.wkt"))
        self.assertEqual(zone.polygons, 2)
        self.assertLess(zone.area, half(2) + stadium(1) + line(3))
        # What shares places out takes chords.
        options = ("--owner", "nearest", "--radius", R)
        self.fail_with(1, "in.gpkg: arcs of the input cannot stay arcs here, feature 1; give --arc-error LENGTH for chords in "
                       "their place that deviate by no more", "buffer", "in.gpkg", "none.gpkg", *options, output="none.gpkg")
        self.succeed("buffer", "in.gpkg", "out.gpkg", *options, "--arc-error", ERROR)
        self.succeed("verify", "out.gpkg", "--against", "in.gpkg", *options, "--arc-error", ERROR)

    def test_no_projection(self):
        self.write("in.wkt", "SRID=25832;" + HALF + "\n")
        self.fail_with(1, "in.wkt: arcs cannot be projected, line 1; give --arc-error LENGTH for chords in their place that "
                       "deviate by no more", "buffer", "in.wkt", "out.wkt", "--radius", R, "--to-crs", "EPSG:25833", output="out.wkt")

    def test_bad_lengths(self):
        self.write("in.wkt", HALF + "\n")
        for text, wrong in (("0", "is zero"), ("-1", "is negative"), ("fine", "is not a number")):
            done = self.krepl("buffer", "in.wkt", "out.wkt", "--radius", R, f"--arc-error={text}")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"--arc-error '{text}' {wrong}", done.stderr)
            self.assertEqual(self.files(), ["in.wkt"])

    def test_too_many_chords(self):
        self.write("in.wkt", HALF + "\n")
        self.fail_with(1, "in.wkt: the arcs need more than 2^28 chords, line 1; give a larger --arc-error", "buffer", "in.wkt",
                       "out.wkt", "--radius", R, "--arc-error", "1e-18", output="out.wkt")


if __name__ == "__main__":
    support.main()
