#!/usr/bin/env python3
"""The page of `krepl view` for surfaces in headless Chromium with software WebGL: what is drawn, the ball, sections,
hands and keys.

    surface_browser_test.py KREPL DIRECTORY        pages and screenshots go to DIRECTORY
"""
import base64
import os
import random
import sys
import unittest

sys.dont_write_bytecode = True  # no __pycache__ among the sources
from browser import BrowserCase, first_pixel, program
from surface_pages import Pages

KREPL, DIRECTORY = sys.argv[1:3]
PAGES = Pages(KREPL, DIRECTORY)
AT = (412000, 5312000)  # far from zero, as real coordinates are


def hue(color):
    """'sand', 'blue', 'red' or 'grey', as the legend has them."""
    r, g, b = color
    if max(color) - min(color) < 16:
        return "grey"
    if b > r:
        return "blue"
    return "red" if r > 1.35 * g else "sand"


class SurfacePageTest(BrowserCase):
    size = (1000, 700)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.hills = PAGES.hills("hills", 40, first=AT)
        cls.page, cls.said = PAGES.page("hills", cls.hills, 1.5, "--title", "Hills & <valleys>")
        roof = [(0, 0, 0), (10, 0, 0), (10, 5, 4), (0, 5, 4), (0, 10, 0), (10, 10, 0)]
        cls.roof = PAGES.mesh("roof", roof, [(0, 1, 2), (0, 2, 3), (3, 2, 5), (3, 5, 4)])
        cls.roof_page, _ = PAGES.page("roof", cls.roof, 2)

    def shot(self, name):
        path = os.path.join(DIRECTORY, name + ".png")
        self.browser.screenshot(path)
        return path

    def settle(self):
        self.browser.wait("!kreplView.frame().stale")
        self.browser.settle()

    def color_at(self, place):
        """Of the picture, at a place of the world."""
        x, y = self.browser.evaluate(f"kreplView.toScreen(...{list(place)})")
        return self.pixel(round(x), round(y))

    def pixel(self, x, y):
        clip = {"x": x, "y": y, "width": 1, "height": 1, "scale": 1}
        return first_pixel(base64.b64decode(self.browser.call("Page.captureScreenshot", format="png", clip=clip)["data"]))

    def test_summary_and_legend(self):
        self.assertRegex(self.said, r"hills\.html: \d+ faces, \d+ triangles in \d+ tiles, [\d.]+ MB; open it in a browser")
        self.browser.open(self.page)
        self.assertEqual(self.browser.evaluate("document.querySelector('h1').textContent"), "Hills & <valleys>")
        text = self.browser.evaluate("document.getElementById('panel').innerText")
        faces = self.browser.evaluate("kreplView.page.faces")
        self.assertEqual(sum(faces.values()), int(self.said.split(": ")[1].split(" faces")[0]))
        for word in ("Planes", "Cylinders", "Spheres", "Seams", "Valleys", "Rims", "Terrain", "Cut"):
            self.assertIn(word, text)
        self.shot("surface_whole")

    def test_patches_have_the_colours_of_their_kinds(self):
        """A roof: its two sides are planes, its ridge a cylinder, its corners spheres."""
        self.browser.open(self.roof_page, "hide=seam,valley,rim")
        self.browser.evaluate("kreplView.setView([5, 5], [0, -0.05, 1, 40])")
        self.settle()
        for place, wanted in (((5, 2), "sand"), ((5, 8), "sand"), ((5, 5), "blue"), ((-1, 5), "red"), ((-1, 2), "blue"),
                              ((-0.6, -1.8), "red")):
            contact = self.browser.evaluate(f"kreplView.contact({place[0]}, {place[1]})")
            self.assertEqual(["red", "blue", "sand"][contact["touches"][0]["kind"]], wanted, place)
            self.assertEqual(hue(self.color_at((*place, contact["height"]))), wanted, place)
        self.shot("surface_roof")
        self.browser.evaluate("document.getElementById('kinds').click()")
        self.settle()
        height = self.browser.evaluate("kreplView.contact(5, 5).height")
        self.assertNotEqual(hue(self.color_at((5, 5, height))), "blue")
        self.browser.evaluate("document.getElementById('surface').click()")
        self.settle()
        below = self.color_at((5, 5, 4))
        self.assertGreater(below[1], below[2] + 10, "the terrain is greenish")

    def test_ball_is_exact_where_the_mouse_is(self):
        self.browser.open(self.page)
        rng = random.Random(3)
        for _ in range(6):
            x, y = rng.uniform(420, 800), rng.uniform(300, 450)
            self.browser.mouse("mouseMoved", x, y)
            self.browser.wait("Boolean(kreplView.ball())")
            self.browser.evaluate("new Promise(done => setTimeout(() => requestAnimationFrame(done), 60))")
            ball = self.browser.evaluate("kreplView.ball()")
            sx, sy = self.browser.evaluate(f"kreplView.toScreen({ball['x']}, {ball['y']}, {ball['height']})")
            self.assertLess(abs(sx - x) + abs(sy - y), 0.01, "its centre is under the mouse")
            row = PAGES.heights(self.hills, 1.5, [(ball["x"], ball["y"])])[0]
            self.assertAlmostEqual(float(row[2]), ball["height"], 7)
            self.assertIn(row[3], [["vertex", "edge", "face"][t["kind"]] for t in ball["touches"]])
        text = self.browser.evaluate("document.getElementById('inspector').innerText")
        kind = ["vertex", "edge", "face"][ball["touches"][0]["kind"]]
        self.assertRegex(text, rf"The ball touches {kind} \d+")
        self.shot("surface_ball")

    def test_click_holds_the_ball_and_escape_removes_it(self):
        self.browser.open(self.page)
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.mouse(kind, 600, 400, button="left", buttons=1, clickCount=1)
        held = self.browser.evaluate("kreplView.ball()")
        self.browser.mouse("mouseMoved", 700, 420)
        self.browser.evaluate("new Promise(done => setTimeout(() => requestAnimationFrame(done), 60))")
        self.assertEqual(self.browser.evaluate("kreplView.ball()"), held)
        self.browser.evaluate("document.getElementById('map').focus()")
        self.browser.key("Escape")
        self.assertIsNone(self.browser.evaluate("kreplView.ball()"))
        self.assertTrue(self.browser.evaluate("document.getElementById('inspector').hidden"))

    def test_keys(self):
        self.browser.open(self.page)
        self.browser.evaluate("document.getElementById('map').focus()")
        where = f"kreplView.toScreen({AT[0] + 20}, {AT[1] + 20}, 5)"
        seen = [self.browser.evaluate(where)]
        for key in ("ArrowLeft", "+", "t", "ArrowUp", "0"):
            self.browser.key(key)
            self.settle()
            seen.append(self.browser.evaluate(where))
            self.assertNotEqual(seen[-1], seen[-2], key)
        for a, b in zip(seen[-1], seen[0]):
            self.assertAlmostEqual(a, b, 6, "0 shows all again")
        self.browser.key("d")
        first = self.browser.evaluate("kreplView.ball()")
        self.browser.key("d")
        second = self.browser.evaluate("kreplView.ball()")
        step = ((second["x"] - first["x"]) ** 2 + (second["y"] - first["y"]) ** 2) ** 0.5
        self.assertAlmostEqual(step, 0.15, 9)
        self.browser.key("x")
        self.assertFalse(self.browser.evaluate("document.getElementById('profile').hidden"))
        self.browser.key("]")
        self.assertFalse(self.browser.evaluate("document.getElementById('follow').checked"))
        self.browser.key("x")
        self.assertTrue(self.browser.evaluate("document.getElementById('profile').hidden"))

    def test_fingers_turn_and_put_the_ball_down(self):
        self.browser.open(self.page)
        touch = lambda kind, *points: self.browser.call("Input.dispatchTouchEvent", type=kind,
                                                        touchPoints=[{"x": x, "y": y} for x, y in points])
        touch("touchStart", (600, 400))
        touch("touchEnd")
        self.browser.wait("Boolean(kreplView.ball())")
        where = f"kreplView.toScreen({AT[0]}, {AT[1]}, 5)"
        before = self.browser.evaluate(where)
        touch("touchStart", (600, 400))
        for k in range(1, 6):
            touch("touchMove", (600 + 20 * k, 400))
        touch("touchEnd")
        self.settle()
        self.assertNotEqual(self.browser.evaluate(where), before)

    def test_wheel_zooms_to_the_pointer(self):
        self.browser.open(self.page)
        self.browser.mouse("mouseMoved", 640, 420)
        self.browser.wait("Boolean(kreplView.ball())")
        ball = self.browser.evaluate("kreplView.ball()")
        size = f"(() => {{ const a = kreplView.toScreen({ball['x']}, {ball['y']}, {ball['height']}), " \
               f"b = kreplView.toScreen({ball['x'] + 1}, {ball['y']}, {ball['height']}); " \
               "return Math.hypot(a[0]-b[0], a[1]-b[1]); })()"
        before = self.browser.evaluate(size)
        self.browser.mouse("mouseWheel", 640, 420, deltaX=0, deltaY=-600)
        self.browser.wait(f"{size} > 1.05 * {before}")

    def test_section_is_exact_and_drawn(self):
        self.browser.open(self.page, f"ball={AT[0] + 19.3},{AT[1] + 20.7}&cut=25")
        self.settle()
        self.shot("surface_section")
        section = self.browser.evaluate("kreplView.section(1500)")
        points = [p for piece in section["surface"] for p in piece["points"][::7]]
        self.assertGreater(len(points), 200)
        rows = PAGES.heights(self.hills, 1.5, [p[:2] for p in points])
        # At both ends the surface is upright.
        off = [abs(float(row[2]) - p[2]) for row, p in zip(rows, points) if row[2]][5:-5]
        self.assertLess(max(off), 1e-6)
        ball = self.browser.evaluate("kreplView.ball()")
        nearest = min((p[0] - ball["x"]) ** 2 + (p[1] - ball["y"]) ** 2 for piece in section["surface"] for p in piece["points"])
        self.assertLess(nearest, 0.05 ** 2, "it goes through the ball")
        self.assertGreater(len(section["ground"]), 30)
        flat = self.browser.evaluate("""(() => { const c = document.getElementById('flat'), g = c.getContext('2d');
          const d = g.getImageData(0, 0, c.width, c.height).data; let n = 0;
          for (let i = 0; i < d.length; i += 4) if (d[i + 3] > 200) ++n; return n; })()""")
        self.assertGreater(flat, 2000, "lines in the flat drawing")

    def test_cut_hides_the_near_half(self):
        self.browser.open(self.roof_page, "hide=seam,valley,rim")
        self.browser.evaluate("kreplView.setView([5, 5], [0, -0.6, 1, 40]); kreplView.cut(true, {angle: 0, offset: 0})")
        self.settle()
        height = self.browser.evaluate("kreplView.contact(5, 8).height")
        self.assertEqual(hue(self.color_at((5, 8, height))), "sand", "beyond the plane")
        self.shot("surface_cut")
        near = self.color_at((5, 2, 1.6))
        self.assertGreater(near[1], near[2] + 10, "before it the terrain shows")
        self.assertLess(near[0], near[1] + 12)

    def test_large_page_has_levels(self):
        mesh = PAGES.hills("levels", 140, 5)
        page, _ = PAGES.page("levels", mesh, 1)
        self.browser.open(page)
        whole = self.browser.evaluate("kreplView.frame()")
        total = self.browser.evaluate("kreplView.page.layers[0].triangles")
        self.assertGreater(total, 100000)
        self.shot("surface_levels")
        self.browser.evaluate("kreplView.setView([70, 70], [-0.3, -0.8, 0.6, 1000])")
        self.settle()
        far = self.browser.evaluate("kreplView.frame()")
        self.assertLess(far["triangles"], 0.5 * total)
        self.assertLess(far["triangles"], whole["triangles"] + 1)
        self.browser.evaluate("kreplView.setView([70, 70], [-0.3, -0.8, 0.6, 15])")
        self.settle()
        near = self.browser.evaluate("kreplView.frame()")
        self.assertGreater(near["segments"], 500, "edges of patches")
        self.assertLess(near["tiles"], 60)
        times = sorted(self.browser.evaluate("kreplView.measure(10)"))
        print(f"frame time with {total} triangles in the page: median {times[5]:.0f} ms", file=sys.stderr)
        self.shot("surface_levels_near")

    def test_geopackage_and_dark(self):
        page, _ = PAGES.page("packed", self.hills, 1.5, result="gpkg")
        self.browser.open(page, "theme=dark&figure")
        self.assertAlmostEqual(self.browser.evaluate("kreplView.page.radius"), 1.5, 8)
        self.shot("surface_dark")
        self.assertLess(sum(self.pixel(10, 690)), 150)
        self.assertEqual(self.browser.evaluate("getComputedStyle(document.getElementById('tools')).display"), "none")

    def test_controls_have_names(self):
        self.browser.open(self.page)
        nameless = self.browser.evaluate("""[...document.querySelectorAll('button, input, canvas')].filter(e =>
          !(e.getAttribute('aria-label') || (e.labels && e.labels.length && e.labels[0].textContent.trim()))).length""")
        self.assertEqual(nameless, 0)


if __name__ == "__main__":
    if program() is None:
        print("skipped: no chromium found (Debian package chromium, or set KREPL_BROWSER)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0]], verbosity=2)
