#!/usr/bin/env python3
"""The page of `krepl view` for tool paths in headless Chromium: what is drawn at which time, playing, keys, controls.

    path_browser_test.py KREPL DIRECTORY        pages and screenshots go to DIRECTORY
"""
import base64
import os
import sys
import unittest

sys.dont_write_bytecode = True  # no __pycache__ among the sources
from browser import BrowserCase, first_pixel, program
from surface_pages import Pages

KREPL, DIRECTORY = sys.argv[1:3]
PAGES = Pages(KREPL, DIRECTORY)
AT = (2000, 300)  # far from zero, as real coordinates are

# A rapid move to the groove, a plunge, the groove from west to east, up, a rapid move back. All at 60, rapid 120 a minute.
GROOVE = f"""G21 G90
G0 X{AT[0]} Y{AT[1] + 5} Z8
G0 X{AT[0] + 2}
G1 Z2 F60
G1 X{AT[0] + 8}
G1 Z8
G0 X{AT[0]}
"""
PLUNGED, MIDDLE, THROUGH = 7 / 60, 10 / 60, 13 / 60  # minutes


class PathPageTest(BrowserCase):
    size = (760, 560)
    opened = None

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.part = PAGES.grid("flat", 11, 11, lambda x, y: 1 if 4 <= x <= 6 else 0, AT)
        cls.path = PAGES.path("groove.ngc")
        with open(cls.path, "w", encoding="ascii") as out:
            out.write(GROOVE)
        cls.page = PAGES.path("groove.html")
        cls.said = PAGES.run("view", cls.path, "-o", cls.page, "--input", cls.part, "--tool", "ball:2", "--stock", "0,4", "--cell", 0.2,
                             "--title", "A <groove>")

    def open(self, fragment="", page=None):
        """Opening takes most of the time without graphics hardware: a page that is there as it was opened goes on."""
        page = page or self.page
        if type(self).opened != page or fragment:
            self.browser.open(page, fragment)
        type(self).opened = None if fragment else page
        if not fragment:
            self.browser.evaluate("kreplView.setTime(0)")
        self.settle()

    def settle(self):
        self.browser.wait("!kreplView.frame().stale")
        self.browser.settle()

    def shot(self, name):
        self.browser.screenshot(os.path.join(DIRECTORY, name + ".png"))

    def switch(self, *names):
        for name in names:
            self.browser.evaluate(f"document.getElementById('{name}').click()")

    def material(self, x, y):
        return self.browser.evaluate(f"kreplView.material({AT[0] + x}, {AT[1] + y})")

    def tool(self):
        return self.browser.evaluate("kreplView.tool()")

    def set_time(self, time):
        self.browser.evaluate(f"kreplView.setTime({time})")
        self.settle()

    def colors(self, places):
        """Of the picture at places of the world, as (r, g, b)."""
        at = self.browser.evaluate(f"{[list(p) for p in places]}.map(p => kreplView.toScreen(...p))")
        clip = lambda x, y: {"x": round(x), "y": round(y), "width": 1, "height": 1, "scale": 1}
        shot = lambda x, y: self.browser.call("Page.captureScreenshot", format="png", clip=clip(x, y))["data"]
        return [first_pixel(base64.b64decode(shot(x, y))) for x, y in at]

    def test_summary_title_and_legend(self):
        self.assertRegex(self.said, r"groove\.html: 5 moves, 0\.3\d+ minutes, 2601 dexels, gouge 0, rest [\d.]+, [\d.]+ MB; open it")
        self.open()
        self.assertEqual(self.browser.evaluate("document.querySelector('h1').textContent"), "A <groove>")
        text = self.browser.evaluate("document.getElementById('panel').innerText")
        for word in ("ball:2", "Way behind", "Way ahead", "Rapid moves", "Tool", "Material", "Part", "Opacity"):
            self.assertIn(word, text)
        self.shot("path_start")

    def test_the_tool_is_where_it_is_at_that_time(self):
        self.open()
        self.set_time(MIDDLE)
        tool = self.tool()
        self.assertAlmostEqual(tool["x"], AT[0] + 5, 9)
        self.assertAlmostEqual(tool["z"], 2, 9)
        self.assertEqual((tool["line"], tool["kind"]), (5, 1))
        reading = self.browser.evaluate("document.getElementById('reading').textContent")
        self.assertIn("line 5", reading)
        self.assertIn("feed 60", reading)
        self.shot("path_middle")
        self.set_time(0.5 / 60)
        self.assertAlmostEqual(self.tool()["x"], AT[0] + 1, 9)
        self.assertEqual(self.tool()["kind"], 0)

    def test_material_goes_as_the_tool_passes(self):
        self.open()
        places = [(2, 5), (4, 5), (7, 5), (5, 8)]
        heights = lambda: [round(self.material(*p)["height"], 5) for p in places]
        self.assertEqual(heights(), [4, 4, 4, 4])
        self.set_time(PLUNGED)
        self.assertEqual(heights(), [2, 4, 4, 4])
        self.set_time(MIDDLE)
        self.assertEqual(heights(), [2, 2, 4, 4])
        self.set_time(THROUGH)
        self.assertEqual(heights(), [2, 2, 2, 4])
        self.set_time(PLUNGED)
        self.assertEqual(heights(), [2, 4, 4, 4], "and comes back with time")
        self.set_time(1)
        self.assertEqual(heights(), [2, 2, 2, 4])
        side = self.material(5, 5.6)
        self.assertAlmostEqual(side["height"], 3 - 0.8, 5)
        self.assertAlmostEqual(side["height"], side["finished"], 5)
        self.assertEqual(self.material(5, 5)["part"], 1)
        self.assertIsNone(self.material(20, 5))

    def test_what_is_drawn(self):
        self.open()
        self.switch("behind", "ahead", "rapid", "tool")
        self.browser.evaluate(f"kreplView.setView([{AT[0] + 5}, {AT[1] + 5}, 2], [0, -0.01, 1, 25])")
        self.set_time(PLUNGED)
        groove, block = (AT[0] + 5, AT[1] + 5, 2), (AT[0] + 5, AT[1] + 8, 4)
        before = self.colors([groove, block])
        self.assertEqual(before[0], before[1], "uncut, and seen from above")
        self.assertGreater(before[0][0], before[0][2] + 25, "the block is tan")
        self.set_time(THROUGH)
        after = self.colors([groove, block])
        self.assertEqual(after[1], before[1])
        self.assertGreater(after[0][2], after[0][0], "what is cut and still above the part is blue")
        self.switch("stock")
        self.settle()
        part = self.colors([(AT[0] + 7.5, AT[1] + 8, 0)])[0]
        self.assertGreater(part[1], part[2], "the part is greenish")
        self.assertNotEqual(part, before[1])
        self.shot("path_part")
        self.switch("behind", "ahead", "rapid", "tool", "stock")
        self.browser.evaluate("document.getElementById('fit').click()")

    def test_lines_behind_and_ahead(self):
        """From above, beside the material: colours along the groove's middle line."""
        page = PAGES.path("alone.html")
        PAGES.run("view", self.path, "-o", page, "--tool", "ball:2")
        self.open("hide=tool&theme=light", page)
        self.browser.evaluate(f"kreplView.setView([{AT[0] + 5}, {AT[1] + 5}, 2], [0, -1, 0.05, 12])")
        self.set_time(MIDDLE)
        self.shot("path_alone")
        paper, done, ahead = self.colors([(AT[0] + 5, AT[1] + 5, 5), (AT[0] + 4.2, AT[1] + 5, 2), (AT[0] + 6.7, AT[1] + 5, 2)])
        strong, faint = (sum(abs(a - b) for a, b in zip(color, paper)) for color in (done, ahead))
        self.assertGreater(strong, 150)
        self.assertGreater(faint, 25)
        self.assertGreater(strong, 1.8 * faint)
        self.assertIsNone(self.browser.evaluate(f"kreplView.material({AT[0]}, {AT[1]})"))

    def test_gouges_are_red(self):
        path, page = PAGES.path("deep.ngc"), PAGES.path("deep.html")
        with open(path, "w", encoding="ascii") as out:
            out.write(GROOVE.replace("Z2", "Z0.5"))
        said = PAGES.run("view", path, "-o", page, "--input", self.part, "--tool", "ball:2", "--stock", "0,4", "--cell", 0.2)
        self.assertIn("gouge 0.5", said)
        self.open("time=1&hide=behind,ahead,rapid,tool&theme=light", page)
        self.browser.evaluate(f"kreplView.setView([{AT[0] + 5}, {AT[1] + 5}, 2], [0, -0.01, 1, 25])")
        self.settle()
        self.shot("path_gouge")
        r, g, b = self.colors([(AT[0] + 5, AT[1] + 5, 0.5)])[0]
        self.assertGreater(r, g + 60)
        self.assertGreater(r, b + 60)

    def mill(self, name, part, tool, *options):
        """Path of a program of krepl mill and of its page."""
        path, page = PAGES.path(name + ".ngc"), PAGES.path(name + ".html")
        PAGES.run("mill", part, path, "--tool", tool, *options)
        said = PAGES.run("view", path, "-o", page, "--input", part, "--tool", tool, "--cell", 0.4)
        self.assertRegex(said, r"gouge 0, ", "nothing is cut into")
        return path, page

    def test_roughing_goes_down_helices(self):
        pocket = PAGES.grid("pocket", 21, 21, lambda x, y: 0 if max(abs(x - 10), abs(y - 10)) < 6 else 3, AT)
        path, page = self.mill("rough", pocket, "ball:3", "--strategy", "rough", "--step-over", 1, "--step-down", 1.5, "--ramp-angle", 5)
        with open(path, encoding="ascii") as text:
            lines = text.read().splitlines()
        number = next(k for k, line in enumerate(lines, 1) if line.startswith("G3") and "Z" in line)
        self.open("time=0", page)
        # Where the tool is at times during that half turn.
        seen = self.browser.evaluate(f"""(() => {{
          const seen = [], minutes = kreplView.page.path.minutes;
          for (let k = 0; k <= 4000; ++k) {{
            kreplView.setTime(minutes * k / 4000);
            const tool = kreplView.tool();
            if (tool.line === {number}) seen.push([tool.x, tool.y, tool.z]);
          }}
          return seen;
        }})()""")
        self.assertGreater(len(seen), 3)
        for a, b, c in zip(seen, seen[1:], seen[2:]):
            self.assertLess(b[2], a[2])
            self.assertAlmostEqual(b[2] - a[2], c[2] - b[2], 3, "evenly")
        middle = [10.0, 10.0]
        self.set_time(0)
        self.assertAlmostEqual(self.material(*middle)["height"], 3, 5)
        self.set_time(1e9)
        self.assertLess(self.material(*middle)["height"], 0.3)
        self.assertAlmostEqual(self.material(1.5, 1.5)["height"], 3, 2, "the rest of the block stays")
        self.shot("path_rough")

    def test_rest_passes_cut_the_corners_of_a_pocket(self):
        pocket = PAGES.grid("corners", 21, 21, lambda x, y: 0 if max(abs(x - 10), abs(y - 10)) < 6 else 3, AT)
        _, page = self.mill("rest", pocket, "ball:2", "--strategy", "rest", "--scallop", 0.1, "--after", "ball:6")
        self.open("time=0", page)
        self.set_time(1e9)
        self.assertLess(self.material(5.6, 5.6)["height"], 2, "a corner")
        self.assertAlmostEqual(self.material(10, 10)["height"], 3, 5, "the middle was for the larger ball")
        self.shot("path_rest")

    def test_playing(self):
        self.open()
        self.browser.evaluate("document.getElementById('speed').value = '60'")
        self.browser.evaluate("document.getElementById('play').click()")
        self.assertEqual(self.browser.evaluate("document.getElementById('play').getAttribute('aria-label')"), "Pause")
        self.browser.wait("kreplView.time() > 0.02")
        self.browser.wait("!kreplView.playing()")  # 20 seconds at sixty times the speed
        self.assertAlmostEqual(self.browser.evaluate("kreplView.time() - kreplView.page.path.minutes"), 0, 12)
        self.settle()
        self.assertAlmostEqual(self.material(7, 5)["height"], 2, 5)
        self.assertEqual(self.browser.evaluate("document.getElementById('clock').value"), "100000")

    def test_slider_and_keys(self):
        self.open()
        self.browser.evaluate("""(() => { const c = document.getElementById('clock'); c.value = 50000;
          c.dispatchEvent(new Event('input')); })()""")
        half = self.browser.evaluate("kreplView.page.path.minutes / 2")
        self.assertAlmostEqual(self.browser.evaluate("kreplView.time()"), half, 9)
        self.browser.evaluate("document.getElementById('map').focus()")
        time = lambda: self.browser.evaluate("kreplView.time()")
        self.browser.key("Home")
        self.assertEqual(time(), 0)
        self.browser.key(".")
        self.assertAlmostEqual(time(), 1 / 60, 9)
        self.browser.key(".")
        self.assertAlmostEqual(time(), PLUNGED, 9)
        self.browser.key(",")
        self.assertAlmostEqual(time(), 1 / 60, 9)
        self.browser.key(" ")
        self.assertTrue(self.browser.evaluate("kreplView.playing()"))
        self.browser.key(" ")
        self.assertFalse(self.browser.evaluate("kreplView.playing()"))
        self.browser.key("End")
        self.assertAlmostEqual(time(), 2 * half, 9)
        where = f"kreplView.toScreen({AT[0]}, {AT[1]}, 0)"
        before = self.browser.evaluate(where)
        for key in ("t", "+", "ArrowLeft", "b", "0"):
            self.browser.key(key)
            self.settle()
        for a, b in zip(self.browser.evaluate(where), before):
            self.assertAlmostEqual(a, b, 6)

    def test_controls_have_names_and_dark_is_dark(self):
        self.open(f"theme=dark&time={MIDDLE}&opacity=0.5&hide=ahead")
        self.assertAlmostEqual(self.browser.evaluate("kreplView.time()"), MIDDLE, 12)
        nameless = self.browser.evaluate("""[...document.querySelectorAll('button, input, canvas, select')].filter(e =>
          !(e.getAttribute('aria-label') || (e.labels && e.labels.length && e.labels[0].textContent.trim()))).length""")
        self.assertEqual(nameless, 0)
        self.shot("path_dark")
        self.assertLess(sum(map(int, self.browser.evaluate(
            "getComputedStyle(document.body).backgroundColor").strip("rgb()").split(","))), 150)


if __name__ == "__main__":
    if program() is None:
        print("skipped: no chromium found (Debian package chromium, or set KREPL_BROWSER)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0]], verbosity=2)
