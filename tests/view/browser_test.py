#!/usr/bin/env python3
"""The page of `krepl view` in headless Chromium: what is drawn, what the pointer finds, how zooming works.

    browser_test.py KREPL DIRECTORY        pages and screenshots go to DIRECTORY
"""
import math
import os
import random
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True  # no __pycache__ among the sources
from browser import BrowserCase, program

KREPL, DIRECTORY = sys.argv[1:3]
H = math.sqrt(0.5)


def krepl(*arguments):
    return subprocess.run([KREPL, *arguments], check=True, capture_output=True, text=True)


def page_of(name, wkt, *arguments):
    """A page of zones given as text: one line each."""
    source, target = os.path.join(DIRECTORY, name + ".wkt"), os.path.join(DIRECTORY, name + ".html")
    with open(source, "w", encoding="ascii") as out:
        out.write(wkt + "\n")
    krepl("view", source, "-o", target, *arguments)
    return target


def arcs(cx, cy, r, left=True):
    """A circle as two half-circles."""
    s = 1 if left else -1
    return (f"CIRCULARSTRING({cx - r} {cy}, {cx} {cy - s * r}, {cx + r} {cy}, {cx} {cy + s * r}, {cx - r} {cy})")


RING = f"CURVEPOLYGON({arcs(0, 0, 10)}, {arcs(2, 0, 3, False)})"


def many_circles(count):
    """A large square with `count` round holes in a grid."""
    side = math.ceil(math.sqrt(count))
    holes = ", ".join(arcs(10 * (k % side) + 5, 10 * (k // side) + 5, 4, False) for k in range(count))
    size = 10 * side
    return f"CURVEPOLYGON((-10 -10, {size + 10} -10, {size + 10} {size + 10}, -10 {size + 10}, -10 -10), {holes})"


def colors(browser, points):
    """Colours of the picture at places of the world, as 'r g b'."""
    return browser.evaluate(f"""(() => {{
      const map = document.getElementById('map'), copy = new OffscreenCanvas(map.width, map.height);
      const g = copy.getContext('2d', {{willReadFrequently: true}});
      g.drawImage(map, 0, 0);
      return {points}.map(([x, y]) => {{
        const [sx, sy] = kreplView.toScreen(x, y);
        return [...g.getImageData(Math.round(sx), Math.round(sy), 1, 1).data].slice(0, 3).join(' ');
      }});
    }})()""")


class PageTest(BrowserCase):
    def shot(self, name):
        self.browser.screenshot(os.path.join(DIRECTORY, name + ".png"))

    def view(self, x, y, scale):
        self.browser.evaluate(f"kreplView.setView({x}, {y}, {scale})")
        self.browser.settle()

    def hit(self, x, y):
        return self.browser.evaluate(f"kreplView.hitTest(...kreplView.toScreen({x}, {y}))")

    def test_inside_hole_and_outside_have_their_colours(self):
        self.browser.open(page_of("ring", RING))
        self.shot("ring")
        inside, hole, outside, other_inside = colors(self.browser, [[-5, 0], [2, 0], [0, 10.6], [0, -9]])
        self.assertEqual(outside, "247 245 240")
        self.assertEqual(hole, outside)
        self.assertNotEqual(inside, outside)
        self.assertEqual(inside, other_inside)

    def test_pointer_finds_the_arc_and_only_near_it(self):
        self.browser.open(page_of("ring", RING))
        found = self.hit(2 + 3 * H, 3 * H)
        self.assertEqual((found["kind"], found["hole"]), ("arc", True))
        self.assertAlmostEqual(found["radius"], 3, 12)
        self.assertAlmostEqual(found["length"], 3 * math.pi, 12)
        self.assertEqual([round(c, 12) for c in found["center"]], [2, 0])
        self.assertIsNone(self.hit(-5, 0))
        self.assertIsNone(self.hit(2, 0))
        # 12 pixels beside the outer circle is too far.
        self.assertIsNone(self.browser.evaluate(
            "(() => { const [x, y] = kreplView.toScreen(0, 10); return kreplView.hitTest(x, y - 12); })()"))

    def test_source_radius_and_length_of_a_krepl_result(self):
        line, result = os.path.join(DIRECTORY, "line.wkt"), os.path.join(DIRECTORY, "line.gpkg")
        with open(line, "w", encoding="ascii") as out:
            out.write("LINESTRING(0 0, 100 0, 100 80)\nLINESTRING(200 0, 300 0)\n")
        krepl("buffer", line, result, "--radius", "10,30")
        target = os.path.join(DIRECTORY, "line.html")
        krepl("view", result, "-o", target, "--input", line)
        self.browser.open(target)
        counts = self.browser.evaluate("kreplView.counts")
        self.assertEqual([c["role"] for c in counts], ["zone", "zone", "input"])
        self.assertEqual([c["radius"] for c in counts], [30, 10, None])
        x, y = self.browser.evaluate("kreplView.toScreen(50, -10)")
        self.browser.mouse("mouseMoved", x, y)
        self.browser.settle()
        text = self.browser.evaluate("document.getElementById('inspector').innerText")
        self.assertIn("Segment", text)
        self.assertIn("segment 0–1 of part 0", text)
        self.shot("line")
        low = self.hit(50, -10)
        self.assertEqual((low["kind"], low["source"]["part"], low["source"]["vertex"]), ("segment", 0, 0))
        self.assertAlmostEqual(low["length"], 100, 12)
        cap = self.hit(300 + 10 * math.cos(0.3), 10 * math.sin(0.3))
        self.assertEqual((cap["kind"], cap["source"]["part"], cap["source"]["vertex"]), ("arc", 1, 1))
        self.assertAlmostEqual(cap["radius"], 10, 9)
        far = self.hit(200 - 30 * math.cos(0.3), 30 * math.sin(0.3))
        self.assertEqual((far["zoneRadius"], far["source"]["part"], far["source"]["vertex"]), (30, 1, 0))
        river = self.hit(100, 40)
        self.assertEqual((river["role"], river["source"]["part"], river["source"]["vertex"]), ("input", 0, 1))

    def test_wheel_zooms_about_the_pointer_and_keys_work(self):
        self.browser.open(page_of("ring", RING))
        state = "({s: kreplView.camera.scale, x: kreplView.camera.toX(500), y: kreplView.camera.toY(300)})"
        before = self.browser.evaluate(state)
        self.browser.mouse("mouseWheel", 500, 300, deltaX=0, deltaY=-400)
        self.browser.wait(f"kreplView.camera.scale !== {before['s']}")
        after = self.browser.evaluate(state)
        self.assertGreater(after["s"], 1.5 * before["s"])
        self.assertAlmostEqual(after["x"], before["x"], 9)
        self.assertAlmostEqual(after["y"], before["y"], 9)
        self.browser.evaluate("document.getElementById('map').focus()")
        self.browser.key("+")
        self.assertAlmostEqual(self.browser.evaluate("kreplView.camera.scale") / after["s"], 1.5, 9)
        self.browser.key("0")
        self.assertAlmostEqual(self.browser.evaluate("kreplView.camera.scale") / before["s"], 1, 9)
        x = self.browser.evaluate("kreplView.camera.x")
        self.browser.key("ArrowLeft")
        self.assertAlmostEqual(self.browser.evaluate("kreplView.camera.x"), x - 80 / before["s"], 9)

    def test_dragging_moves_the_world_with_the_pointer(self):
        self.browser.open(page_of("ring", RING))
        x, y = self.browser.evaluate("[kreplView.camera.toX(600), kreplView.camera.toY(400)]")
        self.browser.mouse("mousePressed", 600, 400, button="left", buttons=1, clickCount=1)
        self.browser.mouse("mouseMoved", 650, 330, button="left", buttons=1)
        self.browser.mouse("mouseReleased", 650, 330, button="left", clickCount=1)
        self.assertAlmostEqual(self.browser.evaluate("kreplView.camera.toX(650)"), x, 9)
        self.assertAlmostEqual(self.browser.evaluate("kreplView.camera.toY(330)"), y, 9)

    def test_layers_can_be_switched_off(self):
        self.browser.open(page_of("nested", f"CURVEPOLYGON({arcs(0, 0, 10)})"))
        inside = colors(self.browser, [[0, 0]])[0]
        self.browser.evaluate("document.getElementById('layer-0').click()")
        self.browser.settle()
        self.assertEqual(colors(self.browser, [[0, 0]])[0], "247 245 240")
        self.assertIsNone(self.hit(10, 0))
        self.browser.evaluate("document.getElementById('layer-0').click()")
        self.browser.settle()
        self.assertEqual(colors(self.browser, [[0, 0]])[0], inside)
        self.browser.evaluate("document.getElementById('arcs').click()")
        self.browser.settle()
        self.assertIsNone(self.hit(10, 0), "arcs that are not shown are not found")

    def test_arcs_are_round_at_every_scale(self):
        """Both sides of the true circle, four pixels from it, from the whole circle to a billionth of it."""
        self.browser.open(page_of("round", f"CURVEPOLYGON({arcs(1000, -500, 700)})"))
        inside = colors(self.browser, [[1000, -500]])[0]
        rng = random.Random(7)
        for power in range(0, 10):
            scale = 0.4 * 10 ** power
            for _ in range(4):
                a = rng.uniform(0, 2 * math.pi)
                x, y = math.cos(a), math.sin(a)
                self.view(1000 + 700 * x, -500 + 700 * y, scale)
                step = 4 / scale
                got = colors(self.browser, [[1000 + (700 + k) * x, -500 + (700 + k) * y] for k in (-step, step)])
                self.assertEqual(got, [inside, "247 245 240"], f"scale {scale}, angle {a}")
        self.shot("round")

    def test_large_result_is_culled_and_merged(self):
        count = 60000
        self.browser.open(page_of("large", many_circles(count)))
        all_pieces = self.browser.evaluate("kreplView.counts[0].pieces")
        self.assertEqual(all_pieces, 2 * count + 4)
        whole = self.browser.evaluate("kreplView.frame()")
        self.assertLess(whole["drawn"], 2 * all_pieces)
        self.shot("large")
        self.view(605, 605, 20)
        near = self.browser.evaluate("kreplView.frame()")
        self.assertLess(near["drawn"], 400)
        self.assertGreater(near["drawn"], 20)
        self.assertEqual(colors(self.browser, [[605, 605], [609.9, 609.9]])[0], "247 245 240")
        self.assertNotEqual(colors(self.browser, [[609.9, 609.9]])[0], "247 245 240")
        found = self.hit(605 + 4 * H, 605 + 4 * H)
        self.assertEqual([round(c, 9) for c in found["center"]], [605, 605])
        self.shot("large_near")

    def test_profile(self):
        source, target = os.path.join(DIRECTORY, "profile.csv"), os.path.join(DIRECTORY, "profile.html")
        terrain = os.path.join(DIRECTORY, "terrain.csv")
        with open(source, "w", encoding="ascii") as out:
            out.write("kind,x0,y0,x1,y1,cx,cy,segment\nhalf_line,-2,-inf,-2,0,,,v0\narc,-2,0,0,2,0,0,v0\n"
                      "segment,0,2,10,2,,,s0\narc,10,2,12,0,10,0,v1\nhalf_line,12,0,12,-inf,,,v1\n")
        with open(terrain, "w", encoding="ascii") as out:
            out.write("x,z\n0,0\n10,0\n")
        krepl("view", source, "-o", target, "--input", terrain)
        self.browser.open(target)
        self.shot("profile")
        below, above, left = colors(self.browser, [[5, 1], [5, 3], [-3, -1]])
        self.assertNotEqual(below, above)
        self.assertEqual(above, left)
        top = self.hit(5, 2)
        self.assertEqual((top["kind"], top["source"]["vertex"]), ("segment", 0))
        self.assertEqual(self.hit(10 + 2 * H, 2 * H)["source"]["vertex"], 1)
        self.assertEqual(self.hit(12, -1)["kind"], "half-line")
        self.assertEqual(self.browser.evaluate("kreplView.counts[0].halfLines"), 2)

    def test_controls_have_names_and_dark_is_dark(self):
        self.browser.open(page_of("ring", RING), "theme=dark")
        nameless = self.browser.evaluate("""[...document.querySelectorAll('button, input, canvas')].filter(e =>
          !(e.getAttribute('aria-label') || (e.labels && e.labels.length && e.labels[0].innerText.trim()))).length""")
        self.assertEqual(nameless, 0)
        outside = colors(self.browser, [[0, 10.6]])[0]
        self.assertLess(sum(map(int, outside.split())), 150)
        self.shot("dark")
        self.browser.evaluate("document.getElementById('theme').click()")
        self.browser.settle()
        self.assertEqual(colors(self.browser, [[0, 10.6]])[0], "247 245 240")


if __name__ == "__main__":
    if program() is None:
        print("skipped: no chromium found (Debian package chromium, or set KREPL_BROWSER)")
        sys.exit(77)
    os.makedirs(DIRECTORY, exist_ok=True)
    unittest.main(argv=[sys.argv[0]], verbosity=2)
