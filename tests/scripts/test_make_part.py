"""scripts/make-part: a closed mesh without vertices inside of sides, of the shape that was wanted, the same every time.

usage: test_make_part.py DIRECTORY_OF_SCRIPTS [unittest arguments]
"""
import math
import struct
import subprocess
import sys
import tempfile
import unittest
from bisect import bisect_left, bisect_right
from collections import Counter
from pathlib import Path

SCRIPTS = Path(sys.argv.pop(1)).resolve()


def read_stl(path):
    data = path.read_bytes()
    (count,) = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * count
    return [tuple(struct.unpack_from("<3f", data, 84 + 50 * t + 12 * k) for k in (1, 2, 3)) for t in range(count)]


def read_off(path):
    lines = path.read_text().split("\n")
    vertices, faces, _ = map(int, lines[1].split())
    points = [tuple(map(float, line.split())) for line in lines[2:2 + vertices]]
    corners = [list(map(int, line.split())) for line in lines[2 + vertices:2 + vertices + faces]]
    return [tuple(points[v] for v in c[1:]) for c in corners]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


class MakePart(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.path = Path(cls.directory.name) / "part.stl"
        subprocess.run([SCRIPTS / "make-part", cls.path], check=True, capture_output=True)
        cls.mesh = read_stl(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def test_every_side_runs_once_each_way(self):
        sides = Counter((t[i - 1], t[i]) for t in self.mesh for i in range(3))
        self.assertEqual(set(sides.values()), {1})
        self.assertEqual([s for s in sides if s[::-1] not in sides], [])

    def test_is_one_body_without_handles(self):
        vertices = {p for t in self.mesh for p in t}
        self.assertEqual(len(vertices) - 3 * len(self.mesh) // 2 + len(self.mesh), 2)

    def test_no_triangle_is_without_area_and_no_vertex_inside_of_a_side(self):
        # Exact: coordinates are whole numbers of 1/1024 mm.
        whole = lambda p: tuple(int(1024 * c) for c in p)
        self.assertTrue(all(whole(p) == tuple(1024 * c for c in p) for t in self.mesh for p in t))
        vertices = sorted({whole(p) for t in self.mesh for p in t})
        for t in self.mesh:
            a, b, c = map(whole, t)
            self.assertNotEqual(cross(sub(b, a), sub(c, a)), (0, 0, 0))
            for p, q in ((a, b), (b, c), (c, a)):
                if p > q:
                    continue
                d = sub(q, p)
                length = sum(x * x for x in d)
                for v in vertices[bisect_left(vertices, p):bisect_right(vertices, q)]:  # in order of x first
                    e = sub(v, p)
                    along = sum(x * y for x, y in zip(d, e))
                    if 0 < along < length:
                        self.assertNotEqual(cross(d, e), (0, 0, 0), (p, v, q))

    def heights(self, x, y):
        """Where the vertical through x, y enters and leaves the part."""
        found = []
        for a, b, c in self.mesh:
            area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            if area == 0:
                continue
            u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area
            v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area
            if u > 0 and v > 0 and u + v < 1:
                found.append((u * a[2] + v * b[2] + (1 - u - v) * c[2], area > 0))
        return sorted(found)

    def test_features_have_their_heights(self):
        for what, x, y, height in (("top", 48.3, 28.7, 25), ("floor of the pocket", 12.1, 33.3, 11), ("boss", 26.3, 40.1, 21),
                                   ("slot", 60.2, 19.1, 17), ("rib", 60.2, 8.3, 28), ("stem of the K", 7.3, 9.1, 23.75),
                                   ("counter of the R", 18.2, 14.6, 25), ("bowl of the P", 36.9, 14.9, 23.75),
                                   ("between letters", 13.6, 12.1, 25),
                                   ("chamfer", 0.75, 30.1, 24.25), ("counter of the P", 34.7, 14.9, 25)):
            crossed = self.heights(x, y)
            self.assertEqual([up for _, up in crossed], [False, True], what)
            self.assertAlmostEqual(crossed[0][0], 0, delta=1e-9)
            self.assertAlmostEqual(crossed[1][0], height, delta=0.01, msg=what)
        for x, y in ((62.3, 41.1), (55.2, 45.1), (70.1, 36.2)):  # the dome: a sphere of radius 15 mm, cut off flat by facets
            expected = 31 - 15 + math.sqrt(225 - (x - 62) ** 2 - (y - 41) ** 2)
            self.assertAlmostEqual(self.heights(x, y)[1][0], expected, delta=0.06)

    def test_same_bytes_again_and_the_same_mesh_in_both_formats(self):
        again, off = (Path(self.directory.name) / name for name in ("again.stl", "part.off"))
        for path in (again, off):
            subprocess.run([SCRIPTS / "make-part", path], check=True, capture_output=True)
        self.assertEqual(again.read_bytes(), self.path.read_bytes())
        self.assertEqual(read_off(off), self.mesh)

    def test_wrong_usage(self):
        for arguments in ([], ["part.dwg"], ["a.stl", "b.stl"]):
            done = subprocess.run([SCRIPTS / "make-part", *arguments], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (1, "usage: make-part OUT.stl|OUT.off\n"))


if __name__ == "__main__":
    unittest.main()
