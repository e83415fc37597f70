"""krepl height: rows, messages, and heights by brute force."""
import csv
import gzip
import io
import math
import os
import random
import subprocess
import unittest

import support
from test_terrain import CORNER, ROWS, cross, dot, grid, sub, triangles

HEADER = ["x", "y", "h", "kind", "px", "py", "pz"]
FLAT = grid([[5] * 4 for _ in range(4)], corner=(0, 0))  # samples at 0.5, 1.5, 2.5, 3.5
# A vertical wall over a floor, as two facets of text.
WALL = """OFF
7 3 0
0 0 0
8 0 0
8 0 3
0 0 3
-20 -20 0
20 -20 0
0 20 0
3 0 1 2
3 0 2 3
3 4 5 6
"""
HOLED = [[9 if z == 9 else z if (i + 2 * j) % 5 else -9999 for i, z in enumerate(row)] for j, row in enumerate(ROWS)]


def over(place, q, radius):
    """The centre's height of a ball over the place that touches the point q from above."""
    s = radius * radius - (q[0] - place[0]) ** 2 - (q[1] - place[1]) ** 2
    return q[2] + math.sqrt(s) if s >= 0 else -math.inf


def over_segment(place, a, b, radius):
    """The highest over all points of a segment, by search: the height is concave along it, where the ball reaches it."""
    d, e = sub(b, a), (a[0] - place[0], a[1] - place[1])
    flat, half = d[0] * d[0] + d[1] * d[1], d[0] * e[0] + d[1] * e[1]
    if flat == 0:
        return max(over(place, a, radius), over(place, b, radius))
    s = half * half - flat * (e[0] * e[0] + e[1] * e[1] - radius * radius)
    if s < 0:
        return -math.inf
    low, high = max(0, (-half - math.sqrt(s)) / flat), min(1, (-half + math.sqrt(s)) / flat)
    if low > high:
        return -math.inf

    def at(t):
        return max(over(place, tuple(x + t * y for x, y in zip(a, d)), radius), -1e300)
    best = max(at(low), at(high))
    for _ in range(90):
        left, right = low + (high - low) / 3, high - (high - low) / 3
        best = max(best, at(left), at(right))
        low, high = (left, high) if at(left) < at(right) else (low, right)
    return best if best > -1e300 else -math.inf


def brute_height(place, parts, radius):
    """The highest ball over the place that touches a point of some triangle from above."""
    best = -math.inf
    for t in parts:
        best = max([best] + [over_segment(place, t[i], t[(i + 1) % 3], radius) for i in range(3)])
        n = cross(sub(t[1], t[0]), sub(t[2], t[0]))
        if n[2] == 0:
            continue
        n = tuple(math.copysign(1, n[2]) * x / math.sqrt(dot(n, n)) for x in n)
        q = (place[0] - radius * n[0], place[1] - radius * n[1])
        turns = [(b[0] - a[0]) * (q[1] - a[1]) - (b[1] - a[1]) * (q[0] - a[0]) for a, b in zip(t, t[1:] + t[:1])]
        if min(turns) >= 0 or max(turns) <= 0:
            best = max(best, t[0][2] - ((q[0] - t[0][0]) * n[0] + (q[1] - t[0][1]) * n[1]) / n[2] + radius * n[2])
    return best


def kind_of(p, parts):
    """The kind of feature that a point of a terrain lies on."""
    if any(math.dist(p, q) < 1e-8 for t in parts for q in t):
        return "vertex"
    for t in parts:
        for a, b in zip(t, t[1:] + t[:1]):
            d = sub(b, a)
            s = min(1, max(0, dot(sub(p, a), d) / dot(d, d)))
            if math.dist(p, tuple(x + s * y for x, y in zip(a, d))) < 1e-8:
                return "edge"
    return "face"


class Height(support.CliTest):
    def rows(self, text):
        table = list(csv.reader(io.StringIO(text)))
        self.assertEqual(table[0], HEADER)
        return table[1:]

    def height(self, terrain, places, radius, *options):
        return self.rows(self.succeed("height", terrain, "--radius", radius, "--at", places, "-o", "-", *options).stdout)

    def test_flat_ground(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n1.5,2.5\n2,2.5\n1.75,2.75\n2.25,2.125\n9,9\n")
        done = self.succeed("height", "flat.asc", "--radius", "0.75", "--at", "at.csv", "-o", "out.csv")
        self.assertRegex(done.stdout, r"^5 places: 1 on a face, 2 on an edge, 1 on a vertex, 1 touch nothing; \d+\.\d{3} s\n$")
        self.assertEqual(done.stderr, "")
        self.assertEqual(self.text("out.csv"), "x,y,h,kind,px,py,pz\n"
                         "1.5,2.5,5.75,vertex,1.5,2.5,5\n2,2.5,5.75,edge,2,2.5,5\n1.75,2.75,5.75,edge,1.75,2.75,5\n"
                         "2.25,2.125,5.75,face,2.25,2.125,5\n9,9,,,,,\n")

    def test_raster_by_brute_force(self):
        self.check_raster(ROWS)

    def test_raster_with_missing_samples_by_brute_force(self):
        self.check_raster(HOLED)

    def check_raster(self, samples):
        self.write("hills.asc", grid(samples))
        generator = random.Random(20060401)
        places = [(CORNER[0] + generator.uniform(-3, 10), CORNER[1] + generator.uniform(-3, 9)) for _ in range(60)]
        self.write("at.csv", "x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in places))
        kinds = set()
        for radius in (0.3, 2.0, 40.0):
            kinds |= self.check(self.height("hills.asc", "at.csv", radius), places, radius, triangles(samples, (0, 0)))
        self.assertEqual(kinds, {"", "face", "edge", "vertex"}, "the places are too few to show every kind")

    def check(self, rows, places, radius, parts):
        """All rows against brute force; returns the kinds that occur. S is 10 or the radius."""
        self.assertEqual(len(rows), len(places))
        for row, (x, y) in zip(rows, places):
            self.assertEqual((float(row[0]), float(row[1])), (x, y))
            place = (x - CORNER[0], y - CORNER[1])  # exact
            height = brute_height(place, parts, radius)
            if height == -math.inf:
                self.assertEqual(row[2:], [""] * 5)
                continue
            self.assertAlmostEqual(float(row[2]), height, delta=1e-12 * max(radius, 10))
            # The touched point is written with coordinates of a size of 5e6, so it is known to 1e-9.
            touched = (float(row[4]) - CORNER[0], float(row[5]) - CORNER[1], float(row[6]))
            self.assertAlmostEqual(math.dist((*place, height), touched), radius, delta=4e-9)
            self.assertEqual(row[3], kind_of(touched, parts))
        return {row[3] for row in rows}

    def test_mesh_with_a_wall(self):
        self.write("wall.off", WALL)
        self.write("at.csv", "x,y\n4,3\n11,0\n12,0\n4,8\n")
        rows = self.height("wall.off", "at.csv", 5)
        self.assertEqual([r[3] for r in rows], ["edge", "vertex", "vertex", "face"])
        for row, h in zip(rows, (7, 7, 6, 5)):
            self.assertAlmostEqual(float(row[2]), h, delta=1e-12)

    def test_columns_in_any_order_and_more_of_them(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "\ufeffname;Y;x\n# a comment\n\nhere;2.5;1.5\n")
        self.assertEqual(self.height("flat.asc", "at.csv", 1), [["1.5", "2.5", "6", "vertex", "1.5", "2.5", "5"]])

    def test_numbers_survive_the_round_trip(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n0.1,2.3000000000000003\n-0,1e-1\n")
        rows = self.height("flat.asc", "at.csv", 3)
        self.assertEqual([r[:2] for r in rows], [["0.1", "2.3000000000000003"], ["0", "0.1"]])

    def test_standard_input_and_output(self):
        self.write("flat.asc", FLAT)
        done = self.succeed("height", "flat.asc", "--radius", "1", "--at", "-", "-o", "-", stdin="x,y\n1.5,1.5\n")
        self.assertEqual(self.rows(done.stdout), [["1.5", "1.5", "6", "vertex", "1.5", "1.5", "5"]])
        self.assertIn("1 places", done.stderr)
        self.write("at.csv", "x,y\n4,3\n")
        done = self.succeed("height", "-", "--radius", "5", "--at", "at.csv", "-o", "-", "--quiet", stdin=WALL)
        self.assertEqual(done.stderr, "")
        self.assertEqual(self.rows(done.stdout)[0][3], "edge")
        self.fail_with(2, "IN and --at are both standard input; name a file for one of them",
                       "height", "-", "--radius", "1", "--at", "-", "-o", "out.csv", output="out.csv")

    def test_compressed_places(self):
        self.write("flat.asc", FLAT)
        (self.directory / "at.csv.gz").write_bytes(gzip.compress(b"x,y\n1.5,1.5\n"))
        self.assertEqual(self.height("flat.asc", "at.csv.gz", 1)[0][2], "6")

    def test_terrain_options(self):
        self.write("hills.asc", grid([[0, 3], [3, 0]], corner=(0, 0)))
        self.write("at.csv", "x,y\n1,1\n")
        # The middle of the cell is on a ridge of height 3 or in a valley of height 0 between two slopes.
        self.assertEqual(self.height("hills.asc", "at.csv", 0.01)[0][3], "edge")
        self.assertAlmostEqual(float(self.height("hills.asc", "at.csv", 0.01)[0][2]), 3.01, delta=1e-12)
        self.assertLess(float(self.height("hills.asc", "at.csv", 0.01, "--split", "falling")[0][2]), 0.1)
        self.assertAlmostEqual(float(self.height("hills.asc", "at.csv", 0.01, "--z-scale", "2")[0][2]), 6.01, delta=1e-12)

    def test_axis_that_points_upwards(self):
        """The same part lying on each of its sides."""
        corners = [(0, 0, 0), (10, 0, 1), (0, 9, 2), (11, 12, 5)]
        lying = {"x": lambda x, y, z: (z, y, -x), "y": lambda x, y, z: (x, z, -y), "z": lambda x, y, z: (x, y, z),
                 "-x": lambda x, y, z: (-z, y, x), "-y": lambda x, y, z: (x, -z, y), "-z": lambda x, y, z: (x, -y, -z)}
        self.write("at.csv", "x,y\n3,2\n7,9\n10.5,11.5\n")
        wanted = None
        for axis in ("z", "x", "y", "-x", "-y", "-z"):
            text = "".join("{} {} {}\n".format(*lying[axis](*corner)) for corner in corners)
            self.write("part.off", f"OFF\n4 2 0\n{text}3 0 1 2\n3 1 3 2\n")
            found = self.height("part.off", "at.csv", 0.5, *([] if axis == "z" else [f"--up={axis}"]))
            wanted = wanted or found
            self.assertEqual(found, wanted, axis)
        self.fail_with(2, "--up 'w' is unknown; give x, y, z, -x, -y or -z (as --up=-x)",
                       "height", "part.off", "--radius", "1", "--at", "at.csv", "-o", "out.csv", "--up", "w", output="out.csv")
        self.write("flat.asc", FLAT)
        self.fail_with(2, "flat.asc: --up is for meshes, not for rasters; leave it out",
                       "height", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "out.csv", "--up", "y", output="out.csv")

    def test_same_bytes_for_any_number_of_threads(self):
        self.write("hills.asc", grid(ROWS))
        generator = random.Random(7)
        places = [(CORNER[0] + generator.uniform(0, 7), CORNER[1] + generator.uniform(0, 6)) for _ in range(2000)]
        self.write("at.csv", "x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in places))
        for threads in (1, 2, 4):
            self.succeed("height", "hills.asc", "--radius", "2", "--at", "at.csv", "-o", f"{threads}.csv", "--threads", threads)
        self.assertEqual(self.text("1.csv"), self.text("2.csv"))
        self.assertEqual(self.text("1.csv"), self.text("4.csv"))

    def test_verbose(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n1,1\n")
        done = self.succeed("height", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "out.csv", "--verbose")
        for word in ("read ", "index ", "drop "):
            self.assertIn(word, done.stderr)

    def test_bad_places(self):
        self.write("flat.asc", FLAT)
        for text, message in (
                ("", "at.csv: is empty"),
                ("x,y\n", "at.csv: has no places; give at least one row below the header"),
                ("x,z\n1,2\n", "at.csv: has no column 'y', line 1; name it in the header; there are: x, z"),
                ("x,y\n1,2\n1,two\n", "at.csv: y 'two' is not a number, line 3; correct or remove the line"),
                ("x,y\n1\n", "at.csv: y is missing, line 2; correct or remove the line"),
                ("x,y\n1,2\nnan,2\n", "at.csv: x is not finite, line 3; correct or remove the line"),
                ("x,y\n1e999,2\n", "at.csv: x '1e999' is out of the range of numbers, line 2; correct or remove the line")):
            with self.subTest(text=text):
                self.write("at.csv", text)
                self.fail_with(1, message, "height", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "out.csv",
                               output="out.csv")

    def test_wrong_usage(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n1,1\n")
        self.fail_with(2, "--radius '0' is zero; give a finite number greater than zero, in the unit of the coordinates",
                       "height", "flat.asc", "--radius", "0", "--at", "at.csv", "-o", "out.csv", output="out.csv")
        for radius, why in (("-2", "is negative"), ("nan", "is not finite"), ("inf", "is not finite"),
                            ("two", "is not a number")):
            with self.subTest(radius=radius):
                self.fail_with(2, f"--radius '{radius}' {why}; give a finite number greater than zero, in the unit of the "
                                  "coordinates",
                               "height", "flat.asc", f"--radius={radius}", "--at", "at.csv", "-o", "out.csv", output="out.csv")
        self.fail_with(2, "--at is required; see `krepl height --help`", "height", "flat.asc", "--radius", "1", "-o", "out.csv",
                       output="out.csv")
        self.fail_with(2, "at.csv: is an input, which would be lost; name another file for the result",
                       "height", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "at.csv", output="out.csv")
        self.fail_with(2, "flat.asc: the radius is too large for the terrain's coordinates in double precision; "
                          "give one in the unit of the terrain",
                       "height", "flat.asc", "--radius", "1e200", "--at", "at.csv", "-o", "out.csv", output="out.csv")

    def test_other_cutters(self):
        """No sample of the triangles is inside the tool, and one of them is nearly touched."""
        slope = 1 / math.tan(math.radians(30))
        tools = {"ball:2": lambda r: 1 - math.sqrt(max(0, 1 - r * r)),
                 "flat:2": lambda r: 0,
                 "bull:2:0.25": lambda r: 0 if r < 0.75 else 0.25 - math.sqrt(max(0, 0.0625 - (r - 0.75) ** 2)),
                 "cone:2:60": lambda r: slope * r,
                 "taper:2:60:0.25": lambda r: (0.25 - math.sqrt(0.0625 - r * r) if r < 0.25 * math.cos(math.radians(30))
                                               else slope * r - 0.25)}
        self.write("t.asc", grid(ROWS, corner=(0, 0)))
        places = [(1.0 + 0.97 * i, 1.2 + 0.83 * j) for i in range(5) for j in range(5)]
        self.write("at.csv", "x,y\n" + "".join(f"{x},{y}\n" for x, y in places))
        n = 16
        samples = [tuple((a * i + b * j + c * (n - i - j)) / n for a, b, c in zip(*t))
                   for t in triangles(ROWS, (0, 0)) for i in range(n + 1) for j in range(n + 1 - i)]
        for tool, profile in tools.items():
            self.succeed("height", "t.asc", "--tool", tool, "--at", "at.csv", "-o", "out.csv")
            for (x, y), row in zip(places, csv.DictReader(io.StringIO(self.text("out.csv")))):
                near = [(q[2], math.hypot(q[0] - x, q[1] - y)) for q in samples]
                best = max(z - profile(r) for z, r in near if r <= 1)
                with self.subTest(tool=tool, at=(x, y)):
                    self.assertLessEqual(best, float(row["h"]) + 1e-9)
                    self.assertGreater(best, float(row["h"]) - 0.6)  # the summit falls by 8 a unit
                    q = (float(row["px"]), float(row["py"]), float(row["pz"]))
                    rise = profile(min(1, math.hypot(q[0] - x, q[1] - y)))
                    self.assertAlmostEqual(float(row["h"]), q[2] - rise, delta=1e-6)

    def test_tools_that_are_wrong(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n1,1\n")
        rest = ("--at", "at.csv", "-o", "out.csv")
        either = "give either --radius or --tool; --radius R is the ball --tool ball:2R"
        self.fail_with(2, either, "height", "flat.asc", *rest, output="out.csv")
        self.fail_with(2, either, "height", "flat.asc", "--radius", "1", "--tool", "ball:2", *rest, output="out.csv")
        self.fail_with(2, "the tool 'drill:3' is of no known kind; give ball:D, flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE or "
                          "taper:D:ANGLE:TIP_RADIUS (D a diameter, ANGLE included, in degrees)",
                       "height", "flat.asc", "--tool", "drill:3", *rest, output="out.csv")

    def test_missing_files(self):
        self.write("at.csv", "x,y\n1,1\n")
        done = self.krepl("height", "none.asc", "--radius", "1", "--at", "at.csv", "-o", "out.csv")
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: none.asc: ", done.stderr)
        self.write("flat.asc", FLAT)
        done = self.krepl("height", "flat.asc", "--radius", "1", "--at", "none.csv", "-o", "out.csv")
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: none.csv: ", done.stderr)
        self.assertEqual(self.files(), ["at.csv", "flat.asc"])

    def test_unwritable_output(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n1,1\n")
        height = ("height", "flat.asc", "--radius", "1", "--at", "at.csv", "-o")
        self.fail_with(1, "nowhere/out.csv: cannot be written: No such file or directory; create the directory first",
                       *height, "nowhere/out.csv", output="nowhere")
        (self.directory / "out.csv").mkdir()
        done = self.krepl(*height, "out.csv")
        self.assertEqual((done.returncode, done.stderr), (1, "krepl: out.csv: is a directory; name a file in it\n"))
        done = self.krepl(*height, "/dev/full")
        full_device = "cannot be written: No space left on device; free some space or choose another place"
        self.assertEqual((done.returncode, done.stderr.splitlines()[-1]), (1, f"krepl: /dev/full: {full_device}"))
        with open("/dev/full", "w") as full:
            done = subprocess.run(self.command(*height, "-"), cwd=self.directory, stdout=full, stderr=subprocess.PIPE,
                                  text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"krepl: standard output: {full_device}", done.stderr)

    @unittest.skipIf(os.geteuid() == 0, "the superuser may write everywhere")
    def test_output_without_permission(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n1,1\n")
        (self.directory / "closed").mkdir(mode=0o555)
        self.fail_with(1, "closed/out.csv: cannot be written: Permission denied",
                       "height", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "closed/out.csv", output="closed/out.csv")

    def test_a_failed_run_keeps_the_old_file(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y\n1,oops\n")
        self.write("out.csv", "old\n")
        self.assertEqual(self.krepl("height", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "out.csv").returncode, 1)
        self.assertEqual(self.text("out.csv"), "old\n")


if __name__ == "__main__":
    support.main()
