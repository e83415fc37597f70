#!/usr/bin/env python3
"""The page of `krepl view` with half a million patches and with more than a million: size, time to open, frame times with
software WebGL.

    surface_scale_test.py KREPL DIRECTORY
"""
import gzip
import os
import statistics
import sys
import time
import unittest

sys.dont_write_bytecode = True  # no __pycache__ among the sources
from browser import Browser, program
from surface_pages import Pages

KREPL, DIRECTORY = sys.argv[1:3]
PAGES = Pages(KREPL, DIRECTORY)
DATA = os.path.join(os.environ.get("KREPL_DATA", ""), "dem")
# Milliseconds between two pictures while the eye moves. The machine may be busy with other tests: a hand still sees it move.
SLOWEST = 200


def raster(name, columns, rows, cell):
    """A part of an elevation model, at the origin, in whole metres as they are."""
    with gzip.open(os.path.join(DATA, name + ".asc.gz"), "rt") as source:
        width = int(next(source).split()[1])
        for _ in range(5):
            next(source)
        values = source.read().split()
    path = PAGES.path(name + ".asc")
    with open(path, "w", encoding="ascii") as out:
        out.write(f"ncols {columns}\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize {cell}\nNODATA_value -9999\n")
        for row in range(rows):
            out.write(" ".join(values[row * width:row * width + columns]) + "\n")
    return path


class ScaleTest(unittest.TestCase):
    def show(self, name, mesh, radius, least_faces):
        page, said = PAGES.page(name, mesh, radius)
        os.remove(PAGES.path(name + ".json"))
        print(said.strip(), file=sys.stderr)
        self.assertGreater(int(said.split(": ")[1].split(" faces")[0]), least_faces)
        with Browser(1280, 800, timeout=120) as browser:
            begin = time.monotonic()
            browser.open(page)
            print(f"open and complete after {time.monotonic() - begin:.1f} s", file=sys.stderr)
            self.look(browser, name, radius)
            self.assertEqual(browser.problems, [], "console")
        os.remove(page)

    def look(self, browser, name, radius):
        box = browser.evaluate("kreplView.page.layers[0]")
        origin = browser.evaluate("kreplView.page.origin")
        x, y = (origin[i] + box["low"][i] + 0.43 * box["side"] for i in (0, 1))
        for distance in (None, 400, 100, 30, 10):
            where = f"{distance} radii away" if distance else "the whole"
            if distance:
                browser.evaluate(f"kreplView.setView([{x}, {y}], [-0.3, -0.8, 0.6, {distance * radius}])")
                browser.settle()
            drawn = browser.evaluate("kreplView.frame()")
            browser.screenshot(PAGES.path(f"{name}_{distance or 'whole'}.png"))
            times = browser.evaluate("kreplView.measure(24)")[8:]  # the first ones find the pace
            moving = browser.evaluate("kreplView.frame()")
            print(f"{where}: {statistics.median(times):.0f} ms a picture (worst {max(times):.0f}) of {moving['triangles']} "
                  f"triangles; at rest {drawn['triangles']} triangles, {drawn['segments']} pieces of edges", file=sys.stderr)
            self.assertLess(statistics.median(times), SLOWEST, where)
        begin = time.monotonic()
        for k in range(50):
            self.assertIsNotNone(browser.evaluate(f"kreplView.contact({x} + {k} * {radius}, {y})"))
        print(f"a ball let down: {20 * (time.monotonic() - begin):.1f} ms", file=sys.stderr)

    def test_half_a_million_patches(self):
        self.show("jacksboro", raster("jacksboro", 403, 344, 92), 92, 500000)

    def test_more_than_a_million_patches(self):
        self.show("bigtujunga", raster("bigtujunga", 580, 580, 30), 30, 1000000)


if __name__ == "__main__":
    if program() is None:
        print("skipped: no chromium found (Debian package chromium, or set KREPL_BROWSER)")
        sys.exit(77)
    if not os.path.isdir(DATA):
        print("skipped: KREPL_DATA names no directory with dem/jacksboro.asc.gz")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0]], verbosity=2)
