"""krepl simulate: reports, exit status, and what is left by brute force on the GeoTIFF."""
import json
import math
import unittest

import support

# A block with a step: 20 x 10, height 0 up to x = 10, then 4.
PART = """OFF
8 6 0
0 0 0
10 0 0
10 10 0
0 10 0
10 0 4
20 0 4
20 10 4
10 10 4
3 0 1 2
3 0 2 3
3 4 5 6
3 4 6 7
3 1 4 7
3 1 7 2
"""
HEAD = "%\n(by hand)\nG21 G90 G17\nT1 M6\nS9000 M3\nG0 Z20\nG0 X-5 Y5\n"
# Along the step at a distance, up over it, an arc back.
PATH = HEAD + "G0 Z1\nG1 X7 F600\nG0 Z20\nG0 X15 Y2\nG0 Z8\nG1 Z4 F100\nG1 Y5\nG3 X15 Y8 I0 J1.5\nG0 Z20\nM30\n"


class SimulateTest(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("part.off", PART)
        self.write("path.ngc", PATH)

    def simulate(self, *more, path="path.ngc", tool="flat:6"):
        return self.krepl("simulate", path, "--against", "part.off", "--tool", tool, *more)

    def heights(self, name):
        info = json.loads(self.ogr("gdalinfo", "-json", name))
        columns, rows = info["size"]
        x0, dx, _, y0, _, dy = info["geoTransform"]
        text = self.ogr("gdal_translate", "-q", "-of", "XYZ", "-b", "1", name, "/vsistdout/")
        values = [tuple(map(float, line.split())) for line in text.splitlines()]
        self.assertEqual(len(values), columns * rows)
        self.assertAlmostEqual(values[0][0], x0 + dx / 2)
        self.assertAlmostEqual(values[0][1], y0 + dy / 2)
        return values

    def test_what_is_left(self):
        done = self.simulate("--stock", "1,5", "--cell", "0.5", "-o", "left.tif")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("gouge     none", done.stderr + done.stdout)
        self.assertIn("rapids    none", done.stderr + done.stdout)
        # The tool's positions, densely.
        tips = [(-5 + 12 * k / 600, 5, 1) for k in range(601)] + [(15, 2 + 3 * k / 200, 4) for k in range(201)]
        tips += [(15 + 1.5 * math.cos(a), 6.5 + 1.5 * math.sin(a), 4)
                 for a in (-math.pi / 2 + math.pi * k / 300 for k in range(301))]
        for x, y, z in self.heights("left.tif"):
            near = [tip for tip in tips if math.hypot(tip[0] - x, tip[1] - y) <= 3]
            want = min([5] + [tip[2] for tip in near])
            edge = any(abs(math.hypot(tip[0] - x, tip[1] - y) - 3) < 0.03 for tip in tips)
            if not edge:
                self.assertAlmostEqual(z, want, places=9, msg=(x, y))

    def test_gouges_and_rapids_fail_the_run(self):
        self.write("deep.ngc", PATH.replace("G1 X7 F600", "G1 X7.5 F600"))
        done = self.simulate("--stock", "1,5", "--cell", "0.5", path="deep.ngc")
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: deep.ngc: cuts into the part, 0.5 deep, line 9, at 10 ", done.stderr)
        self.write("fast.ngc", PATH.replace("G1 X7 F600", "G0 X7"))
        done = self.simulate("--stock", "1,5", "--cell", "0.5", path="fast.ngc")
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: fast.ngc: a rapid move cuts into material, ", done.stderr)
        self.assertIn("line 9", done.stderr)
        done = self.simulate("--stock", "1,5", "--cell", "0.5", "--max-rest", "0.5")
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: path.ngc: leaves ", done.stderr)

    def test_one_path_after_another(self):
        """A rapid move through what the path before has taken away."""
        rest = ("--stock", "1,5", "--cell", "0.5")
        self.write("fast.ngc", PATH.replace("G1 X7 F600", "G0 X7"))
        done = self.simulate(*rest, "--before", "path.ngc,flat:6", path="fast.ngc")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("fast.ngc with flat:6", done.stderr + done.stdout)
        self.assertEqual(self.simulate(*rest, "--before", "path.ngc,flat:5", path="fast.ngc").returncode, 1)
        simulate = ("simulate", "path.ngc", "--against", "part.off", "--tool", "flat:6", "-o", "out.tif", "--before")
        self.fail_with(2, "--before 'path.ngc' is not PATH,TOOL; as rough.ngc,flat:10", *simulate, "path.ngc", output="out.tif")
        self.fail_with(1, "none.ngc: no such file; check the name", *simulate, "none.ngc,flat:6", output="out.tif")

    def test_control_points_of_a_ball(self):
        """A ball's centre at 3 is its tip at 0."""
        self.write("tip.ngc", HEAD + "G0 Z7\nG1 Z4 F60\nG1 Y8\nG0 Z20\n")
        self.write("centre.ngc", HEAD + "G0 Z10\nG1 Z7 F60\nG1 Y8\nG0 Z20\n")
        for path, point in (("tip.ngc", "tip"), ("centre.ngc", "centre")):
            done = self.simulate("--stock", "9,5", "--cell", "0.5", "--control-point", point, "-o", point + ".tif", path=path,
                                 tool="ball:6")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.heights("tip.tif"), self.heights("centre.tif"))
        self.assertAlmostEqual(min(z for _, _, z in self.heights("tip.tif")), 4, places=9)

    def test_verify(self):
        """A ball of radius 3 along the step's foot, 3 beside its wall; and over its edge."""
        ball = HEAD + "G0 Z1\nG1 Z0 F60\nG1 X7\nG1 Z4 F100\nG3 X10 Z7 I3 K0\nG0 Z20\n"
        self.write("ball.ngc", ball.replace("G17", "G18"))
        verify = ("verify", "ball.ngc", "--against", "part.off")
        self.assertEqual(self.krepl(*verify, "--tool", "ball:6").returncode, 0)
        done = self.krepl(*verify, "--tool", "ball:6", "--control-point", "centre")  # the centre in the floor
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: ball.ngc: is not the free path of radius 3: cutting moves stay out, near ", done.stderr)
        centre = HEAD + "G0 Z5\nG1 Z3 F60\nG1 X7\nG1 Z4\nG3 X10 Z7 I3 K0\nG1 X12\nG0 Z20\n"
        self.write("ball.ngc", centre.replace("G17", "G18"))
        done = self.krepl(*verify, "--tool", "ball:6", "--control-point", "centre")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("sound: every check passed", done.stderr + done.stdout)
        self.assertEqual(self.krepl(*verify, "--radius", "3", "--control-point", "centre").returncode, 0)
        done = self.krepl(*verify, "--tool", "ball:6.002", "--control-point", "centre")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(self.krepl(*verify, "--tool", "ball:6.002", "--control-point", "centre", "--max-error", "0.0011")
                         .returncode, 0)
        self.fail_with(2, "a tool path does not tell its tool; give --tool, as ball:D or flat:D", *verify, output="none")

    def test_pictures(self):
        done = self.simulate("--stock", "1,5", "-o", "left.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        info = json.loads(self.ogr("gdalinfo", "-json", "left.png"))
        self.assertGreaterEqual(info["size"][0], 800)
        self.assertEqual(len(info["bands"]), 3)

    def test_messages(self):
        simulate = ("simulate", "path.ngc", "--against", "part.off", "--tool", "flat:6")
        self.write("odd.ngc", HEAD + "G81 X1 Y1 Z-1 R2\n")
        self.fail_with(1, "odd.ngc: G81 is not read, line 8; have the program written with G0, G1, G2 and G3 only",
                       "simulate", "odd.ngc", *simulate[2:], "-o", "out.tif", output="out.tif")
        self.fail_with(2, "out.gif: 'gif' is no format of simulations; give a file that ends in .tif or .png",
                       *simulate, "-o", "out.gif", output="out.gif")
        self.fail_with(2, "--stock 'wide' is not MARGIN or MARGIN,TOP; as 5 or 5,30", *simulate, "--stock", "wide", "-o", "out.tif",
                       output="out.tif")
        self.fail_with(2, "--unit 'ell' is unknown; give mm, cm, m or inch", *simulate, "--unit", "ell", "-o", "out.tif",
                       output="out.tif")
        self.fail_with(2, "path.ngc: the stock's top is below the part; give a height in the part's coordinates",
                       *simulate, "--stock", "0,-3", "-o", "out.tif", output="out.tif")
        self.fail_with(2, "path.ngc: is an input, which would be lost; name another file for the result",
                       *simulate, "--format", "tif", "-o", "path.ngc", output="out.tif")


if __name__ == "__main__":
    support.main()
