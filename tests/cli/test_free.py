"""krepl free: rows, messages, and clearances by brute force."""
import csv
import io
import json
import math
import random
import subprocess
import unittest

import support
from test_height import FLAT, WALL
from test_terrain import ROWS, grid, triangles

DISK = "x,y,free,clearance,kind,px,py,feature"
BALL = "x,y,z,free,clearance,kind,px,py,pz"
YARD = ("POLYGON ((0 0, 20 0, 20 20, 0 20, 0 0), (5 5, 15 5, 15 15, 5 15, 5 5))\n"
        "LINESTRING (30 0, 30 10)\nPOINT (40 5)\n")


def nearest(p, t):
    """Distance of p from a triangle, by search: it is convex, and ternary search may be nested."""
    def at(u, v):
        if u + v > 1:
            u, v = 1 - u, 1 - v
        return math.dist(p, [a + u * (b - a) + v * (c - a) for a, b, c in zip(*t)])

    def best(f, high):
        low = 0.0
        for _ in range(45):
            left, right = low + (high - low) / 3, high - (high - low) / 3
            low, high = (low, right) if f(left) < f(right) else (left, high)
        return f((low + high) / 2)
    return best(lambda u: best(lambda v: at(u, v), 1 - u), 1.0)


class Free(support.CliTest):
    def rows(self, text, header):
        table = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual(text.splitlines()[0], header)
        return table

    def test_among_polygons_lines_and_points(self):
        self.write("yard.wkt", YARD)
        self.write("at.csv", "name,y,x\na,10,10\nb,10,2\nc,5,27\nd,8,44\ne,5,42\nf,5,28\n")
        done = self.succeed("free", "yard.wkt", "--radius", "2", "--at", "at.csv", "-o", "out.csv")
        self.assertRegex(done.stdout, r"^6 places: 5 free, 0 cut in, 1 inside; \d+\.\d{3} s\n$")
        self.assertEqual(self.text("out.csv"), DISK + "\n10,10,1,3,edge,10,5,1\n2,10,0,-4,edge,0,10,1\n"
                         "27,5,1,1,edge,30,5,2\n44,8,1,3,vertex,40,5,3\n42,5,1,0,vertex,40,5,3\n28,5,1,0,edge,30,5,2\n")

    def test_over_a_plate(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y,z\n1.75,2.625,8\n2,2.5,5.75\n2,2.5,5.25\n2.25,2.125,4\n6.5,3.5,1\n")
        done = self.succeed("free", "flat.asc", "--radius", "0.75", "--at", "at.csv", "-o", "out.csv")
        self.assertRegex(done.stdout, r"^5 places: 3 free, 1 cut in, 1 inside; ")
        self.assertEqual(self.text("out.csv"), BALL + "\n1.75,2.625,8,1,2.25,face,1.75,2.625,5\n"
                         "2,2.5,5.75,1,0,edge,2,2.5,5\n2,2.5,5.25,0,-0.5,edge,2,2.5,5\n"
                         "2.25,2.125,4,0,-1.75,face,2.25,2.125,5\n6.5,3.5,1,1,2.25,vertex,3.5,3.5,1\n")

    def test_terrain_by_brute_force(self):
        self.write("t.asc", grid(ROWS, corner=(0, 0)))
        parts = triangles(ROWS, (0, 0))
        low, high = [[f(q[k] for t in parts for q in t) for k in range(3)] for f in (min, max)]
        rng = random.Random(20060401)
        places = [[rng.uniform(a, b) for a, b in zip(low, high)] for _ in range(4)]
        for p in places:
            p[2] = high[2] + rng.uniform(0, 2)  # above everything, where no wall counts
        self.write("at.csv", "x,y,z\n" + "".join(",".join(map(repr, p)) + "\n" for p in places))
        self.succeed("free", "t.asc", "--radius", "1.5", "--at", "at.csv", "-o", "out.csv")
        for p, row in zip(places, self.rows(self.text("out.csv"), BALL)):
            self.assertAlmostEqual(float(row["clearance"]), min(nearest(p, t) for t in parts) - 1.5, delta=1e-7)
            self.assertEqual(row["free"], str(int(float(row["clearance"]) >= 0)))

    def test_streams_and_threads(self):
        """Far more rows than are read at a time, through pipes; the same bytes for any number of threads."""
        self.write("wall.off", WALL)
        rng = random.Random(1)
        text = "# a comment\nx;y;z\n" + "".join(f"{rng.uniform(-9, 9)};{rng.uniform(-9, 9)};{rng.uniform(-2, 6)}\n"
                                                for _ in range(40000))
        free = ("free", "wall.off", "--radius", "0.5")
        one = self.succeed(*free, "--at", "-", "-o", "-", "--threads", "1", stdin=text)
        self.assertRegex(one.stderr, r"^40000 places: \d+ free")
        self.assertEqual(len(one.stdout.splitlines()), 40001)
        self.write("at.csv", text)
        self.succeed(*free, "--at", "at.csv", "-o", "out.csv", "--threads", "3")
        self.assertEqual(self.text("out.csv"), one.stdout)

    def test_rows_come_as_they_are_asked_for(self):
        self.write("yard.wkt", YARD)
        done = subprocess.run(["sh", "-c", '(echo "# wait"; sleep 0.2; echo x,y; sleep 0.2; printf "10,1"; sleep 0.2; echo 0) | "$@"',
                               "sh", *self.command("free", "yard.wkt", "--radius", "2", "--at", "-", "-o", "-")],
                              cwd=self.directory, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.stdout, DISK + "\n10,10,1,3,edge,10,5,1\n", done.stderr)

    def test_motions_in_the_plane(self):
        self.write("yard.wkt", YARD)
        self.write("ways.csv", "motion,x,y\na,25,-5\na,25,30\nb,25,5\nb,35,5\nc,-9,30\nc,-9,10\nc,9,10\nd,2,2\nd,2,3\ne,22,-9\ne,22,29\n")
        done = self.succeed("free", "yard.wkt", "--radius", "2", "--motion", "ways.csv", "-o", "out.csv")
        self.assertRegex(done.stdout, r"^5 motions: 2 free, 3 cut in; ")
        self.assertEqual(self.text("out.csv"), "motion,free,leg,t,x,y,kind,px,py,feature\na,1,,,,,,,,\n"
                         "b,0,0,0.3,28,5,edge,30,5,2\n" f"c,0,1,{7 / 18!r},-2,10,edge,0,10,1\n"
                         "d,0,0,0,2,2,edge,2,0,1\ne,1,,,,,,,,\n")

    def test_motions_from_vector_files_are_those_of_the_csv(self):
        """More of them than one portion holds; also as a pipe, and on any number of threads."""
        self.write("yard.wkt", YARD)
        rng = random.Random(8)
        ways = [[(rng.uniform(-9, 49), rng.uniform(-9, 29)) for _ in range(45)] for _ in range(3000)]
        rows = "".join(f"{m},{x!r},{y!r}\n" for m, way in enumerate(ways, 1) for x, y in way)
        self.write("ways.csv", "motion,x,y\n" + rows)
        self.write("ways.wkt", "".join("LINESTRING (" + ", ".join(f"{x!r} {y!r}" for x, y in way) + ")\n" for way in ways))
        done = self.succeed("free", "yard.wkt", "--radius", "2", "--motion", "ways.csv", "-o", "csv.csv", "--threads", "1")
        self.assertRegex(done.stdout, r"^3000 motions: \d+ free, \d+ cut in; ")
        self.succeed("free", "yard.wkt", "--radius", "2", "--motion", "ways.wkt", "-o", "wkt.csv", "--threads", "3")
        self.assertEqual(len(self.text("csv.csv").splitlines()), 3001)
        self.assertEqual(self.text("csv.csv"), self.text("wkt.csv"))
        piped = subprocess.run(self.command("free", "yard.wkt", "--radius", "2", "--motion", "-", "-o", "-"), input="motion,x,y\n" + rows,
                               cwd=self.directory, capture_output=True, text=True, timeout=60)
        self.assertEqual(piped.stdout, self.text("csv.csv"))

    def test_motions_of_layers(self):
        self.write("yard.wkt", YARD)
        self.write("ways.geojson", """{"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:25832"}}, "features": [
          {"type": "Feature", "id": 7, "properties": {"kind": "a"}, "geometry": {"type": "MultiLineString",
            "coordinates": [[[25, -5], [25, 30]], [[25, 5], [35, 5]]]}},
          {"type": "Feature", "id": 9, "properties": {"kind": "b"}, "geometry": {"type": "LineString", "coordinates": [[2, 2], [2, 3]]}}]}""")
        free = ("free", "yard.wkt", "--radius", "2", "--motion", "ways.geojson", "-o", "out.csv")
        self.succeed(*free)
        self.assertEqual(self.text("out.csv"), "motion,free,leg,t,x,y,kind,px,py,feature\n7.1,1,,,,,,,,\n"
                         "7.2,0,0,0.3,28,5,edge,30,5,2\n9,0,0,0,2,2,edge,2,0,1\n")
        self.succeed(*free, "--motion-where", "kind = 'b'")
        self.assertEqual(len(self.text("out.csv").splitlines()), 2)

    def test_motions_that_are_wrong(self):
        self.write("yard.wkt", YARD)
        self.write("flat.asc", FLAT)
        self.write("area.wkt", "LINESTRING (0 0, 1 1)\nPOLYGON ((0 0, 1 0, 1 1, 0 0))\n")
        self.write("flat.wkt", "LINESTRING (0 0, 1 1)\n")
        self.write("degrees.geojson", '{"type": "LineString", "coordinates": [[9, 48], [9.1, 48]]}')
        for file, message in {"area.wkt": "area.wkt: geometry of type POLYGON is not a motion, line 2; give lines of straight pieces",
                              "degrees.geojson": "degrees.geojson: has coordinates in degrees"}.items():
            done = self.krepl("free", "yard.wkt", "--radius", "1", "--motion", file, "-o", "out.csv")
            self.assertEqual(done.returncode, 1)
            self.assertIn("krepl: " + message, done.stderr)
        self.fail_with(1, "flat.wkt: the motion has no heights, line 1; over a terrain give lines with Z",
                       "free", "flat.asc", "--radius", "1", "--motion", "flat.wkt", "-o", "out.csv", output="out.csv")

    def test_components(self):
        self.write("yard.wkt", YARD)
        self.write("at.csv", "x,y\n10,10\n2,10\n27,5\n8,8\n44,8\n")
        self.succeed("free", "yard.wkt", "--radius", "2", "--components", "--at", "at.csv", "-o", "out.csv", "--threads", "2")
        rows = self.rows(self.text("out.csv"), DISK + ",component")
        self.assertEqual([row["component"] for row in rows], ["1", "", "0", "1", "0"])
        done = self.succeed("free", "yard.wkt", "--radius", "2", "--components", "-o", "parts.wkt")
        self.assertRegex(done.stdout, r"^2 components of free space, one of them unbounded; ")
        outside, inside = self.text("parts.wkt").splitlines()
        self.assertIn("MULTISURFACE", inside)
        done = self.succeed("free", "yard.wkt", "--radius", "2", "--components", "-o", "parts.geojson")
        features = json.loads(self.text("parts.geojson"))["features"]
        self.assertEqual([f["properties"]["component"] for f in features], [0, 1])
        self.assertAlmostEqual(features[1]["properties"]["area"], 36, 6)  # the court of 10 x 10, less 2 on each side
        (ring,) = features[1]["geometry"]["coordinates"][0]
        self.assertEqual(sorted(tuple(round(c, 6) for c in p) for p in ring[:-1]), [(7, 7), (7, 13), (13, 7), (13, 13)])
        self.assertEqual(len(features[0]["geometry"]["coordinates"][0]), 4, "a rectangle and three islands")
        shoelace = lambda ring: sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:])) / 2
        self.assertAlmostEqual(features[0]["properties"]["area"] / sum(map(shoelace, features[0]["geometry"]["coordinates"][0])), 1, 3)
        usage = {"--components says nothing of motions": ("--motion", "at.csv"), "--format and --max-error": ("--at", "at.csv", "--format", "wkt")}
        for message, rest in usage.items():
            done = self.krepl("free", "yard.wkt", "--radius", "2", "--components", *rest, "-o", "o.csv")
            self.assertEqual(done.returncode, 2)
            self.assertIn(message, done.stderr)
        self.write("flat.asc", FLAT)
        self.fail_with(2, "--components is for vector files, but IN is a terrain; leave it out",
                       "free", "flat.asc", "--radius", "1", "--components", "-o", "out.gpkg", output="out.gpkg")

    def test_motions_over_a_terrain(self):
        self.write("flat.asc", FLAT)
        self.write("ways.csv", "x,y,z\n2.25,2.125,9.75\n2.25,2.125,1.75\n")
        self.succeed("free", "flat.asc", "--radius", "0.75", "--motion", "ways.csv", "-o", "out.csv")
        self.assertEqual(self.text("out.csv"), "motion,free,leg,t,x,y,z,kind,px,py,pz\n"
                         "1,0,0,0.5,2.25,2.125,5.75,face,2.25,2.125,5\n")

    def test_places_that_are_wrong(self):
        self.write("flat.asc", FLAT)
        self.write("yard.wkt", YARD)
        for text, message in {
                "": "is empty",
                "x,y,z\n": "has no places; give at least one row below the header",
                "x,y\n1,2\n": "has no column 'z', line 1; name it in the header; there are: x, y",
                "x,y,z\n1,2,3\n1,nan,3\n": "y is not finite, line 3; correct or remove the line",
                "x,y,z\n1,2\n": "z is missing, line 2; correct or remove the line",
                "x,y,z\n1,2,up\n": "z 'up' is not a number, line 2; correct or remove the line"}.items():
            self.write("at.csv", text)
            with self.subTest(text=text):
                self.fail_with(1, "at.csv: " + message, "free", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "out.csv",
                               output="out.csv")
        self.write("at.csv", "x,z\n1,2\n")
        self.fail_with(1, "at.csv: has no column 'y', line 1; name it in the header; there are: x, z",
                       "free", "yard.wkt", "--radius", "1", "--at", "at.csv", "-o", "out.csv", output="out.csv")
        self.fail_with(1, "at.csv: has no column 'y', line 1; name it in the header; there are: x, z",
                       "free", "yard.wkt", "--radius", "1", "--motion", "at.csv", "-o", "out.csv", output="out.csv")

    def test_usage(self):
        self.write("flat.asc", FLAT)
        self.write("yard.wkt", YARD)
        self.write("at.csv", "x,y,z\n1,2,3\n")
        rest = ("--at", "at.csv", "-o", "out.csv")
        for radius in ("0", "-1", "nan", "inf", "one"):
            done = self.krepl("free", "flat.asc", "--radius", radius, *rest)
            self.assertEqual(done.returncode, 2, radius)
            self.assertIn("radius", done.stderr)
        either = "give either --at or --motion; placements, or polylines of them"
        self.fail_with(2, "give --at, --motion or --components; placements, polylines of them, or neither for the parts of free space",
                       "free", "flat.asc", "--radius", "1", "-o", "out.csv", output="out.csv")
        self.fail_with(2, either, "free", "flat.asc", "--radius", "1", "--motion", "at.csv", *rest, output="out.csv")
        self.fail_with(2, "--z-scale is for terrains, but IN is neither a raster nor a mesh; leave it out",
                       "free", "yard.wkt", "--radius", "1", "--z-scale", "2", *rest, output="out.csv")
        self.fail_with(2, "--layer is for vector files, but IN is a terrain; leave it out",
                       "free", "flat.asc", "--radius", "1", "--layer", "a", *rest, output="out.csv")
        self.fail_with(2, "IN and the places are both standard input; name a file for one of them",
                       "free", "-", "--radius", "1", "--at", "-", "-o", "out.csv", output="out.csv")
        done = self.krepl("free", "none.wkt", "--radius", "1", *rest)
        self.assertEqual(done.returncode, 1)
        self.assertIn("krepl: none.wkt: ", done.stderr)

    def test_a_failed_run_keeps_the_old_file(self):
        self.write("flat.asc", FLAT)
        self.write("at.csv", "x,y,z\n1,1,oops\n")
        self.write("out.csv", "old\n")
        self.assertEqual(self.krepl("free", "flat.asc", "--radius", "1", "--at", "at.csv", "-o", "out.csv").returncode, 1)
        self.assertEqual(self.text("out.csv"), "old\n")


if __name__ == "__main__":
    support.main()
