"""krepl mill: programs, messages, posts, and gouges by a ball computed here."""
import math
import re
import subprocess
import unittest

import support

# A block of 20 x 10 with a step and a wedge on it.
PART = """OFF
10 8 0
0 0 0
20 0 0
20 10 0
0 10 0
4 2 3
8 2 3
8 8 3
4 8 3
12 5 0
16 5 4
3 0 1 2
3 0 2 3
3 4 5 6
3 4 6 7
3 8 9 2
3 8 9 1
3 5 6 8
3 1 2 9
"""
OPTIONS = ["--tool", "ball:3", "--step-over", "1"]


def triangles():
    lines = PART.splitlines()[2:]
    points = [tuple(map(float, line.split())) for line in lines[:10]]
    return [[points[int(i)] for i in line.split()[1:]] for line in lines[10:]]


def nearest(p, tri):
    """Distance of a point from a triangle, by steps that halve: far less than what is checked."""
    a, b, c = tri
    best = math.inf
    n = 60
    for i in range(n + 1):
        for j in range(n + 1 - i):
            u, v = i / n, j / n
            q = [a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]) for k in range(3)]
            best = min(best, math.dist(p, q))
    return best


def interpret(text):
    """Places of the control point at the ends of all moves, with (kind, plane, centre)."""
    at, motion, plane, out = [0.0, 0.0, 0.0], None, "G17", []
    for line in text.splitlines():
        line = re.sub(r"\(.*?\)", "", line)
        words = re.findall(r"([A-Z])(-?[0-9.]+)", line)
        centre = list(at)
        moves = False
        new = list(at)
        for letter, value in words:
            if letter == "G" and value in ("0", "1", "2", "3"):
                motion = int(value)
            if letter == "G" and value in ("17", "18", "19"):
                plane = "G" + value
            if letter in "XYZ":
                new["XYZ".index(letter)] = float(value)
                moves = True
            if letter in "IJK":
                centre["IJK".index(letter)] += float(value)
        if moves:
            out.append((motion, plane, at, new, centre))
            at = new
    return out


class Mill(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("part.off", PART)

    def program(self, *options):
        self.succeed("mill", "part.off", "out.ngc", *OPTIONS, *options)
        return self.text("out.ngc")

    def test_summary_counts_the_lines(self):
        done = self.succeed("mill", "part.off", "out.ngc", *OPTIONS)
        lines = len(self.text("out.ngc").splitlines())
        self.assertIn(f"{lines} lines of G-code", done.stdout)

    def test_ends_of_moves_are_not_in_the_part(self):
        for post, point in (("linuxcnc", "tip"), ("grbl", "centre")):
            moves = interpret(self.program("--post", post, "--control-point", point))
            self.assertGreater(len(moves), 50)
            up = 1.5 if point == "tip" else 0
            for motion, _, _, (x, y, z), _ in moves[::7]:
                centre = (x, y, z + up)
                near = [t for t in triangles() if min(p[0] for p in t) - 2 < x < max(p[0] for p in t) + 2]
                for tri in near:
                    self.assertGreaterEqual(nearest(centre, tri), 1.5 - 1e-9, f"at {centre} of {tri}")

    def test_arcs_turn_about_their_centres(self):
        moves = interpret(self.program())
        arcs = [m for m in moves if m[0] in (2, 3)]
        self.assertGreater(len(arcs), 5)
        for _, plane, start, end, centre in arcs:
            self.assertEqual(plane, "G18")
            r0 = math.hypot(start[0] - centre[0], start[2] - centre[2])
            r1 = math.hypot(end[0] - centre[0], end[2] - centre[2])
            self.assertLess(abs(r0 - r1), 2e-4)

    def test_numbers_have_the_decimals_asked_for(self):
        text = self.program("--decimals", "3", "--tolerance", "0.05")
        self.assertFalse(re.search(r"\.[0-9]{4}", re.sub(r"\(.*?\)", "", text)))

    def test_posts(self):
        linuxcnc, grbl = self.program("--spindle", "12000"), self.program("--post", "grbl")
        self.assertIn("T1 M6\nG43 H1\nS12000 M3\n", linuxcnc)
        for word in ("M6", "G43", "G91.1", "M3"):
            self.assertNotIn(word, grbl)
        self.assertTrue(linuxcnc.endswith("M5\nM2\n") and grbl.endswith("M2\n"))
        self.assertIn("G20", self.program("--unit", "in").splitlines()[2])

    def test_safe_height_and_links(self):
        moves = interpret(self.program("--safe-height", "20", "--direction", "one-way"))
        self.assertEqual(moves[0][3][2], 20)
        self.assertEqual(moves[-1][3][2], 20)
        for motion, _, start, end, _ in moves:  # rapid moves go up, down or level
            if motion == 0 and start != [0, 0, 0]:
                self.assertTrue(start[2] == end[2] or start[:2] == end[:2])

    def test_same_bytes_for_any_number_of_threads(self):
        programs = []
        for threads in (1, 3):
            self.succeed("mill", "part.off", "out.ngc", "--tool", "ball:3", "--scallop", "0.05", "--threads", threads)
            programs.append(self.text("out.ngc"))
        self.assertEqual(*programs)

    def test_scallop_and_no_arcs_and_angle(self):
        self.succeed("mill", "part.off", "out.ngc", "--tool", "ball:3", "--scallop", "0.05", "--no-arcs", "--angle", "30", "--verbose")
        self.assertFalse(re.search(r"G[23]\b", self.text("out.ngc")))

    def test_rough(self):
        self.succeed("mill", "part.off", "out.ngc", *OPTIONS, "--strategy", "rough", "--step-down", "1", "--allowance", "0.3",
                     "--stock-top", "5")
        moves = interpret(self.text("out.ngc"))
        levels = {m[3][2] for m in moves if m[0] == 1 and m[2][2] == m[3][2]}
        self.assertGreaterEqual(len(levels), 5)
        for z in levels:
            self.assertGreaterEqual(z, 0.3)

    def test_rough_patterns_and_cutters(self):
        rough = ("--strategy", "rough", "--step-over", "1", "--step-down", "1")
        programs = []
        for tool in ("ball:3", "flat:3", "bull:3:0.5"):
            for pattern in ((), ("--pattern", "zigzag", "--angle", "90")):
                done = self.succeed("mill", "part.off", "out.ngc", "--tool", tool, *rough, *pattern, "--verbose")
                if pattern:
                    self.assertIn("0 moves left out", done.stdout + done.stderr)
                programs.append(self.text("out.ngc"))
                self.succeed("verify", "out.ngc", "--against", "part.off", "--tool", tool)
                self.succeed("simulate", "out.ngc", "--against", "part.off", "--tool", tool, "--cell", "0.2")  # rapid moves do not cut
        self.assertEqual(len(set(programs)), 6)
        self.assertEqual([bool(re.search(r"^G[23] ", p, re.MULTILINE)) for p in programs], [True, False] * 3)
        mill = ("mill", "part.off", "none.ngc", "--tool", "ball:3")
        self.fail_with(2, "--pattern has no meaning for strategy parallel; it belongs to rough", *mill, "--step-over", "1", "--pattern", "offsets",
                       output="none.ngc")
        self.fail_with(2, "--angle has no meaning for strategy rough; it belongs to parallel, rough with --pattern zigzag", *mill, *rough, "--angle", "5",
                       output="none.ngc")
        self.fail_with(2, "--pattern 'spiral' is unknown; give one of offsets, zigzag", *mill, *rough, "--pattern", "spiral", output="none.ngc")

    def test_scallops_of_parallel_passes_are_proven(self):
        done = self.succeed("mill", "part.off", "out.ngc", "--tool", "ball:3", "--scallop", "0.05", "--verbose")
        self.assertIn("0 places where the scallop is not proven", done.stdout + done.stderr)

    def test_waterlines(self):
        options = ("--tool", "ball:3", "--strategy", "waterline", "--step-down", "0.5")
        done = self.succeed("mill", "part.off", "out.ngc", *options, "--verbose")
        self.assertIn("0 moves are not proven free", done.stdout + done.stderr)
        moves = interpret(self.text("out.ngc"))
        arcs = [m for m in moves if m[0] in (2, 3)]
        self.assertGreater(len(arcs), 5)
        for _, plane, start, end, centre in arcs:
            self.assertEqual(plane, "G17")
            self.assertEqual(start[2], end[2])
            self.assertLess(abs(math.dist(start[:2], centre[:2]) - math.dist(end[:2], centre[:2])), 2e-4)
        for motion, _, _, (x, y, z), _ in moves[::5]:
            for tri in triangles():
                self.assertGreaterEqual(nearest((x, y, z + 1.5), tri), 1.5 - 1e-9)
        self.succeed("verify", "out.ngc", "--against", "part.off", "--tool", "ball:3")
        steep = self.succeed("mill", "part.off", "steep.ngc", *options, "--steep", "80", "--direction", "conventional")
        self.assertLess(len(self.text("steep.ngc")), len(self.text("out.ngc")), steep.stdout)

    def test_pencil(self):
        done = self.succeed("mill", "part.off", "out.ngc", "--tool", "ball:1", "--strategy", "pencil", "--verbose")
        self.assertIn("0 moves are not proven free", done.stdout + done.stderr)
        for motion, _, _, (x, y, z), _ in interpret(self.text("out.ngc")):
            for tri in triangles():
                self.assertGreaterEqual(nearest((x, y, z + 0.5), tri), 0.5 - 1e-9)
        self.succeed("verify", "out.ngc", "--against", "part.off", "--tool", "ball:1")

    def test_other_cutters(self):
        """The verifier follows every kind; the simulation and the interpreter agree."""
        for tool in ("flat:3", "bull:3:0.5", "cone:3:90", "taper:3:40:0.5"):
            for strategy in (("--step-over", "1"), ("--strategy", "waterline", "--step-down", "1")):
                self.succeed("mill", "part.off", "out.ngc", "--tool", tool, *strategy)
                text = self.text("out.ngc")
                self.assertIn(tool + ", lengths in mm, Z is that of the tool's tip", text)
                done = self.succeed("verify", "out.ngc", "--against", "part.off", "--tool", tool, "--samples", "5000")
                self.assertIn("tool path of " + tool, done.stdout + done.stderr)
                self.succeed("simulate", "out.ngc", "--against", "part.off", "--tool", tool, "--stock", "0,3.9", "--cell", "0.4") \
                    if strategy[0] == "--step-over" else None
        # A wider tool on the same way cuts into the part.
        done = self.krepl("verify", "out.ngc", "--against", "part.off", "--tool", "taper:3.2:40:0.6", "--samples", "5000")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.fail_with(2, "tool 'flat:3' has no centre; give --control-point tip", "verify", "out.ngc", "--against", "part.off", "--tool", "flat:3",
                       "--control-point", "centre", output="none")

    def test_moves_that_lead_away_are_told(self):
        text = self.program()
        first = re.search(r"^G1.*$", text, re.M)
        self.write("away.ngc", text[:first.start()] + "G1 Z-1000000000 F100\n" + text[first.start():])
        done = self.krepl("verify", "away.ngc", "--against", "part.off", "--tool", "ball:3")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, r"moves stay near the part +\d+ +[1-9]")

    def test_cutters_that_a_strategy_cannot_take(self):
        for strategy in (("--strategy", "scallop", "--scallop", "0.1"), ("--strategy", "pencil")):
            self.fail_with(2, "paths of tool 'flat:3' are made by strategies parallel, waterline and rough only; use one of them, or --tool "
                              "ball:DIAMETER",
                           "mill", "part.off", "out.ngc", "--tool", "flat:3", *strategy, output="out.ngc")
        self.fail_with(2, "heights of scallops are known of ball-nose cutters only, not of tool 'flat:3'; give the step-over",
                       "mill", "part.off", "out.ngc", "--tool", "flat:3", "--scallop", "0.05", output="out.ngc")

    def test_boundary_and_shallow_ground(self):
        self.write("inside.wkt", "POLYGON ((3 1.5, 17 1.5, 17 8.5, 3 8.5, 3 1.5), (9 4, 11 4, 11 6, 9 6, 9 4))\n")
        program = self.program("--boundary", "inside.wkt", "--safe-height", "20")
        for motion, _, start, (x, y, z), _ in interpret(program)[1:]:
            self.assertTrue(3 <= x <= 17 and 1.5 <= y <= 8.5, (x, y))
            self.assertFalse(9 < x < 11 and 4 < y < 6, (x, y))
        self.succeed("mill", "part.off", "out.ngc", "--tool", "ball:3", "--strategy", "waterline", "--step-down", "1",
                     "--boundary", "inside.wkt")
        lengths = [float(re.search(r"([0-9.]+) mm cut", self.succeed("mill", "part.off", "out.ngc", "--tool", "ball:1", "--step-over", "0.2",
                                                                     *shallow).stdout).group(1)) for shallow in ((), ("--shallow", "30"))]
        self.assertLess(lengths[1], 0.95 * lengths[0])
        self.fail_with(2, "--shallow has no meaning for strategy waterline; it belongs to parallel", "mill", "part.off", "none.ngc", "--tool", "ball:3",
                       "--strategy", "waterline", "--step-down", "1", "--shallow", "30", output="none.ngc")
        self.write("line.wkt", "LINESTRING (3 1, 17 1)\n")
        self.fail_with(1, "line.wkt: a boundary consists of polygons, feature 1; leave out lines and points", "mill", "part.off", "none.ngc", *OPTIONS, "--boundary", "line.wkt",
                       output="none.ngc")

    def test_scallop_passes(self):
        options = ("--tool", "ball:3", "--strategy", "scallop", "--scallop", "0.3")
        done = self.succeed("mill", "part.off", "out.ngc", *options, "--verbose")
        self.assertIn("0 places where the scallop is not proven", done.stdout + done.stderr)
        for motion, _, _, (x, y, z), _ in interpret(self.text("out.ngc"))[::7]:
            for tri in triangles():
                self.assertGreaterEqual(nearest((x, y, z + 1.5), tri), 1.5 - 1e-9)
        self.succeed("verify", "out.ngc", "--against", "part.off", "--tool", "ball:3")

    def test_rest_passes(self):
        self.succeed("mill", "part.off", "out.ngc", "--tool", "ball:1", "--strategy", "rest", "--after", "ball:3", "--scallop", "0.1",
                     "--threshold", "0.05")
        self.succeed("verify", "out.ngc", "--against", "part.off", "--tool", "ball:1")

    def test_standard_output(self):
        done = self.succeed("mill", "part.off", "-", *OPTIONS)
        self.assertTrue(done.stdout.startswith("(part.off, parallel by krepl)\n"))
        self.assertIn("lines of G-code", done.stderr)

    def test_the_simulation_finds_no_gouge(self):
        self.succeed("mill", "part.off", "rough.ngc", *OPTIONS, "--strategy", "rough", "--step-down", "1", "--stock-top", "5")
        self.succeed("simulate", "rough.ngc", "--against", "part.off", "--tool", "ball:3", "--stock", "0,5")
        self.program()
        self.succeed("verify", "out.ngc", "--against", "part.off", "--tool", "ball:3")

    def interpreted(self):
        self.write("tool.tbl", "T1 P1 D3 Z0\n")
        self.write("rs274.var", "5161 0\n5162 0\n5163 0\n5220 1\n")
        done = subprocess.run(["rs274", "-g", "-t", "tool.tbl", "-v", "rs274.var", "out.ngc"], cwd=self.directory,
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("PROGRAM_END", done.stdout)
        return done.stdout

    def test_the_interpreter_accepts_it(self):
        self.need("rs274")
        self.program()
        self.assertIn("ARC_FEED", self.interpreted())

    def test_arcs_too_small_for_the_interpreter_are_lines(self):
        self.need("rs274")
        lines = PART.splitlines()
        small = [" ".join(repr(float(x) / 1000) for x in line.split()) for line in lines[2:12]]
        self.write("small.off", "\n".join(lines[:2] + small + lines[12:]) + "\n")
        for options in (("--step-over", 0.0005), ("--strategy", "waterline", "--step-down", 0.0005)):
            with self.subTest(options=options):
                self.succeed("mill", "small.off", "out.ngc", "--tool", "ball:0.0025", "--tolerance", 4e-6, "--decimals", 7, *options)
                self.interpreted()
                self.succeed("verify", "out.ngc", "--against", "small.off", "--tool", "ball:0.0025")


class Messages(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("part.off", PART)

    def refuse(self, message, *options, tool=("--tool", "ball:3")):
        self.fail_with(2, message, "mill", "part.off", "out.ngc", *tool, *options, output="out.ngc")

    def test_usage(self):
        step = ("--step-over", "1")
        self.refuse("neither --step-over nor --scallop is given; give one of them")
        self.refuse("both --step-over and --scallop are given; give one of them", *step, "--scallop", "0.1")
        self.refuse("--strategy 'spiral' is unknown; give one of parallel, rough, waterline, pencil, scallop, rest", *step, "--strategy", "spiral")
        self.refuse("--post 'fanuc' is unknown; give one of linuxcnc, grbl", *step, "--post", "fanuc")
        self.refuse("--angle 'north' is not a finite number; give one", *step, "--angle", "north")
        self.refuse("the safe height 2 is below the highest place of the tool over the part; use at least 4.0002", *step,
                    "--safe-height", "2")
        self.refuse("the tolerance 0.001 is too small for numbers that are multiples of 0.0001; use at least 0.0016, or more decimals",
                    *step, "--tolerance", "0.001")
        self.refuse("the scallop height 0.01 leaves no room for the tolerance 0.01; use a tolerance of at most 0.008", "--scallop", "0.01")

    def test_options_of_other_strategies(self):
        step = ("--step-over", "1")
        self.refuse("--step-down has no meaning for strategy parallel; it belongs to rough, waterline", *step, "--step-down", "1")
        self.refuse("--scallop has no meaning for strategy rough; it belongs to parallel, scallop, rest", "--scallop", "1", "--strategy", "rough")
        self.refuse("--step-over has no meaning for strategy waterline; it belongs to parallel, rough", *step, "--strategy", "waterline")
        self.refuse("--direction 'zigzag' is unknown; give one of climb, conventional", "--strategy", "waterline", "--step-down", "1", "--direction", "zigzag")
        self.refuse("the valleys' angle is not between 0 and 180 degrees", "--strategy", "pencil", "--valley-angle", "180")
        self.refuse("--bottom has no meaning for strategy pencil; it belongs to parallel, rough, waterline", "--strategy", "pencil", "--bottom", "1")
        self.refuse("the steep angle is not between 0 and 90 degrees", "--strategy", "waterline", "--step-down", "1", "--steep", "90")
        self.refuse("--step-down is not given; give the distance of levels", *step, "--strategy", "rough")
        self.refuse("--scallop is not given; give the greatest height of what may be left", "--strategy", "scallop")
        self.refuse("the scallop height 0.01 leaves no room for the tolerance 0.01; use a tolerance of at most 0.005", "--strategy", "scallop", "--scallop", "0.01")
        self.refuse("--after has no meaning for strategy scallop; it belongs to rest", "--strategy", "scallop", "--scallop", "0.1", "--after", "ball:6")
        self.refuse("--after is not given; give the larger tool, as ball:DIAMETER", "--strategy", "rest", "--scallop", "0.1")
        self.refuse("--after 'flat:6' is not a ball-nose cutter; give ball:DIAMETER", "--strategy", "rest", "--scallop", "0.1", "--after", "flat:6")
        self.refuse("the radius of the tool before is not a finite number greater than that of the tool", "--strategy", "rest", "--scallop", "0.1", "--after", "ball:3")
        self.refuse("the threshold 2 is not between the tolerance and the tool's radius", "--strategy", "rest", "--scallop", "0.1", "--after", "ball:6", "--threshold", "2")

    def test_bad_input(self):
        self.write("empty.off", "OFF\n0 0 0\n")
        done = self.krepl("mill", "empty.off", "out.ngc", *OPTIONS)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith("krepl: empty.off: "))
        self.assertFalse((self.directory / "out.ngc").exists())


if __name__ == "__main__":
    support.main()
