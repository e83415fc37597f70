"""What the command line tests share: running krepl in an empty directory, and measuring results without krepl's code.

usage of each test file: test_NAME.py PROGRAM [unittest arguments]
"""
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SKIPPED = 77  # what CTest takes for "skipped"
PROGRAM = ""


def main():
    global PROGRAM
    # Tests import this file as `support`; that module, not __main__, must know the program.
    sys.modules["support"].PROGRAM = os.path.abspath(sys.argv.pop(1))
    program = unittest.main(module="__main__", exit=False)
    result = program.result
    if result.wasSuccessful() and result.testsRun > 0 and len(result.skipped) == result.testsRun:
        sys.exit(SKIPPED)
    sys.exit(0 if result.wasSuccessful() else 1)


class CliTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.directory = Path(tempfile.mkdtemp(prefix="krepl-cli-"))
        self.addCleanup(shutil.rmtree, self.directory, ignore_errors=True)

    def write(self, name, text):
        (self.directory / name).write_text(text)
        return name

    def command(self, *arguments):
        return [PROGRAM, *map(str, arguments)]

    def krepl(self, *arguments, stdin="", **options):
        return subprocess.run(self.command(*arguments), cwd=self.directory, input=stdin, capture_output=True, text=True,
                              timeout=120, **options)

    def succeed(self, *arguments, **options):
        done = self.krepl(*arguments, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def fail_with(self, status, message, *arguments, output="out.gpkg", **options):
        """The run fails with exactly this message on standard error, and leaves nothing behind."""
        before = self.files()
        done = self.krepl(*arguments, **options)
        self.assertEqual(done.stderr, f"krepl: {message}\n")
        self.assertEqual(done.returncode, status)
        self.assertEqual(done.stdout, "")
        self.assertEqual(self.files(), before, "a failed run must leave no file")
        self.assertFalse((self.directory / output).exists())

    def start(self, *arguments, **options):
        """krepl running in the test's directory."""
        return subprocess.Popen(self.command(*arguments), cwd=self.directory, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, **options)

    def wait_until(self, run, ready, what):
        """Returns when `ready()` holds for the process `run`, however slow the machine is."""
        until = time.monotonic() + 600
        while not ready():
            self.assertIsNone(run.poll(), f"finished before {what}: the test needs more data")
            self.assertLess(time.monotonic(), until, f"not yet {what}")
            time.sleep(0.01)

    def wait_until_interruptible(self, run):
        """Returns when the process `run` catches SIGINT (proc(5), SigCgt)."""
        def caught():
            status = Path(f"/proc/{run.pid}/status").read_text()
            mask = re.search(r"^SigCgt:\s*([0-9a-f]+)", status, re.MULTILINE)
            return mask is not None and int(mask[1], 16) >> (signal.SIGINT - 1) & 1 == 1
        self.wait_until(run, caught, "it catches SIGINT")

    def files(self):
        return sorted(p.name for p in self.directory.iterdir())

    def text(self, name):
        return (self.directory / name).read_text()

    def ogr(self, *command):
        """Output of a GDAL program run in the test's directory."""
        done = subprocess.run(command, cwd=self.directory, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def need(self, *programs):
        for program in programs:
            if shutil.which(program) is None:
                self.skipTest(f"{program} is not installed")


# --- measuring -------------------------------------------------------------------------------------------------------

class Measure:
    """Polygons, holes, area and length of (multi)surfaces in WKT, arcs taken as arcs."""

    def __init__(self):
        self.polygons = self.holes = self.arcs = 0
        self.area = self.length = 0.0


def tokens(wkt):
    return re.findall(r"[A-Za-z]+|[(),]|[^\s(),]+", wkt)


class Parser:
    def __init__(self, wkt):
        self.tokens, self.at = tokens(wkt), 0

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, expected=None):
        token = self.peek()
        if expected is not None and token != expected:
            raise ValueError(f"expected {expected}, found {token} at {self.at}")
        self.at += 1
        return token

    def items(self, item):
        """( item, item, ... )"""
        self.take("(")
        result = [item()]
        while self.peek() == ",":
            self.take()
            result.append(item())
        self.take(")")
        return result

    def point(self):
        x, y = float(self.take()), float(self.take())
        return x, y

    def curve(self):
        """Pieces: (start, end) or (start, middle, end)."""
        word = self.take().upper() if self.peek().isalpha() else "LINESTRING"
        if word == "COMPOUNDCURVE":
            return [piece for part in self.items(self.curve) for piece in part]
        points = self.items(self.point)
        if word == "CIRCULARSTRING":
            return [tuple(points[i:i + 3]) for i in range(0, len(points) - 2, 2)]
        return list(zip(points, points[1:]))

    def surface(self):
        """Polygons as lists of rings."""
        word = self.take().upper() if self.peek().isalpha() else "POLYGON"
        if word in ("MULTISURFACE", "MULTIPOLYGON"):
            return [polygon for part in self.items(self.surface) for polygon in part]
        return [self.items(self.curve)]


def circle_through(a, b, c):
    ax, ay, bx, by = a[0] - c[0], a[1] - c[1], b[0] - c[0], b[1] - c[1]
    d = 2 * (ax * by - ay * bx)
    x = (by * (ax * ax + ay * ay) - ay * (bx * bx + by * by)) / d
    y = (ax * (bx * bx + by * by) - bx * (ax * ax + ay * ay)) / d
    return (c[0] + x, c[1] + y), math.hypot(x, y)


def piece_measure(piece):
    """Length of a piece, and the area between it and its chord (positive if it bulges to the right)."""
    if len(piece) == 2:
        return math.dist(*piece), 0.0
    a, b, c = piece
    if a == c:  # full circle, b opposite to a
        r = math.dist(a, b) / 2
        return 2 * math.pi * r, math.pi * r * r
    if (a[0] - c[0]) * (b[1] - c[1]) == (a[1] - c[1]) * (b[0] - c[0]):  # flatter than its coordinates can tell
        return math.dist(a, c), 0.0
    center, r = circle_through(a, b, c)
    turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    angle = [math.atan2(p[1] - center[1], p[0] - center[0]) for p in (a, c)]
    span = (angle[1] - angle[0] if turn > 0 else angle[0] - angle[1]) % (2 * math.pi)
    segment = r * r * (span - math.sin(span)) / 2
    return r * span, segment if turn > 0 else -segment


def measure(wkt):
    result = Measure()
    parser = Parser(wkt)
    for polygon in parser.surface():
        result.polygons += 1
        result.holes += len(polygon) - 1
        for number, ring in enumerate(polygon):
            if ring[0][0] != ring[-1][-1]:
                raise ValueError("ring is not closed")
            for piece, following in zip(ring, ring[1:]):
                if piece[-1] != following[0]:
                    raise ValueError("ring is not connected")
            x, y = ring[0][0]
            area = 0.0
            for piece in ring:
                length, segment = piece_measure(piece)
                (x0, y0), (x1, y1) = piece[0], piece[-1]
                area += ((x0 - x) * (y1 - y) - (x1 - x) * (y0 - y)) / 2 + segment
                result.length += length
                result.arcs += len(piece) == 3
            result.area += abs(area) if number == 0 else -abs(area)
    return result
