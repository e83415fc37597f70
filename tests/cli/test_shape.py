"""krepl buffer with caps, joins, sides, rings and negative radii; krepl verify with the same options."""
import math
import re

import support

PI = math.pi
CORNER = "LINESTRING (0 0, 100 0, 100 100)\n"
FRAME = "POLYGON ((0 0, 100 0, 100 100, 0 100, 0 0), (40 40, 40 60, 60 60, 60 40, 40 40))\n"


class Shape(support.CliTest):
    def area(self, wkt, *options):
        self.write("in.wkt", wkt)
        done = self.succeed("buffer", "in.wkt", "out.gpkg", *options)
        self.notes = done.stderr
        areas = [float(text) for text in re.findall(r"area ([\d.e+-]+)", done.stdout)]
        self.succeed("verify", "out.gpkg", "--against", "in.wkt", *options, "--samples", "2000")
        return areas

    def test_caps_and_joins(self):
        body, quarter = 2000 - 25, 25  # two strips of 10 by 100 that share a quarter square
        for cap, ends in (("flat", 0), ("square", 100), ("round", 25 * PI)):
            for join, outer in (("mitre", quarter), ("bevel", quarter / 2), ("round", quarter * PI / 4)):
                area, = self.area(CORNER, "--radius", "5", "--cap", cap, "--join", join)
                self.assertAlmostEqual(area, body + ends + outer, places=5)

    def test_mitre_limit(self):
        area, = self.area(CORNER, "--radius", "5", "--join", "mitre", "--mitre-limit", "1.4", "--cap", "flat")
        self.assertAlmostEqual(area, 1975 + 12.5, places=5)

    def test_sides(self):
        left, = self.area(CORNER, "--radius", "5", "--side", "left")
        right, = self.area(CORNER, "--radius", "5", "--side", "right")
        self.assertAlmostEqual(left, 1000 - 25, places=5)
        self.assertAlmostEqual(right, 1000 + 25 * PI / 4, places=5)
        for options, corner in ((("mitre",), 25), (("bevel",), 12.5), (("mitre", "--mitre-limit", "1.4"), 12.5)):
            right, = self.area(CORNER, "--radius", "5", "--side", "right", "--join", *options)
            self.assertAlmostEqual(right, 1000 + corner, places=5)

    def test_negative_radii(self):
        shrunk, gone = self.area(FRAME, "--radius=-5,-30")
        self.assertAlmostEqual(shrunk, 8100 - 400 - 400 - 25 * PI, places=5)
        self.assertEqual(gone, 0)
        self.assertIn("nothing is left at radius -30", self.notes)

    def test_rings(self):
        outside, = self.area(FRAME, "--radius", "5", "--ring")
        self.assertAlmostEqual(outside, 2000 + 25 * PI + 400 - 100, places=5)
        inside, = self.area(FRAME, "--radius=-5", "--ring")
        self.assertAlmostEqual(inside, 9600 - (8100 - 400 - 400 - 25 * PI), places=5)

    def test_faults_of_rings_are_told(self):
        self.area("POLYGON ((0 0, 100 100, 100 0, 0 100, 0 0))\n", "--radius=-5")
        self.assertIn("feature 1: sides cross, at 50 50", self.notes)

    def test_what_does_not_go_together(self):
        self.write("line.wkt", CORNER)
        self.write("frame.wkt", FRAME)
        for options, message in (
                (("line.wkt", "--radius=-5"), "a negative radius shrinks polygons, but there is a line, feature 1"),
                (("line.wkt", "--radius", "5", "--ring"), "there is no polygon to take out of its zone"),
                (("frame.wkt", "--radius", "5", "--side", "left"), "a polygon has no left or right side"),
                (("line.wkt", "--radius", "5", "--side", "left", "--cap", "round"), "ends straight across"),
                (("line.wkt", "--radius", "5", "--cap", "pointed"), "--cap 'pointed' is unknown"),
                (("line.wkt", "--radius", "5", "--mitre-limit", "3"), "--mitre-limit goes with --join mitre"),
                (("line.wkt", "--radius", "5", "--cap", "flat", "--engine", "voronoi"), "whole round zones only")):
            name, *rest = options
            done = self.krepl("buffer", name, "out.gpkg", *rest)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(message, done.stderr)

    def test_verify_finds_the_wrong_shape(self):
        self.write("in.wkt", CORNER)
        self.succeed("buffer", "in.wkt", "out.gpkg", "--radius", "5", "--cap", "flat")
        done = self.krepl("verify", "out.gpkg", "--against", "in.wkt", "--cap", "square", "--samples", "2000")
        self.assertEqual(done.returncode, 1, done.stdout)


if __name__ == "__main__":
    support.main()
