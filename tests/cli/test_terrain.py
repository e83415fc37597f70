"""krepl terrain: every format read back without krepl's code, and heights by brute force."""
import json
import math
import os
import re
import signal
import struct
import subprocess
from collections import Counter

import support

R = 2.0
# Seven columns, six rows, north first: a ridge, a needle, a flat lake, a pit.
ROWS = [[0, 0, 1, 2, 1, 0, 0], [0, 1, 3, 4, 2, 0, 0], [0, 0, 2, 9, 1, 0, 0], [1, 0, 0, 1, 0, 0, 0], [2, 1, -3, 0, 1, 2, 3],
        [0, 0, 0, 0, 1, 1, 2]]
CORNER = (500000.0, 5600000.0)


def grid(rows, cell=1, corner=CORNER):
    head = (f"ncols {len(rows[0])}\nnrows {len(rows)}\nxllcorner {corner[0]}\nyllcorner {corner[1]}\ncellsize {cell}\n"
            "NODATA_value -9999\n")
    return head + "\n".join(" ".join(map(str, row)) for row in rows) + "\n"


def triangles(rows, corner=CORNER):
    """Cells split by the diagonal from (min x, min y) to (max x, max y); samples at the centres of pixels."""
    def at(column, row):
        return (corner[0] + 0.5 + column, corner[1] + len(rows) - 0.5 - row, rows[row][column])
    result = []
    for row in range(len(rows) - 1):
        for column in range(len(rows[0]) - 1):
            low, high = at(column, row + 1), at(column + 1, row)
            result += [(low, at(column + 1, row + 1), high), (low, high, at(column, row))]
    return [t for t in result if all(p[2] != -9999 for p in t)]


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def distance_to_triangle(p, triangle):
    """Brute force [Ericson 2005, section 5.1.5, by cases of the plane and the three sides]."""
    a, b, c = triangle
    n = cross(sub(b, a), sub(c, a))
    inside = all(dot(cross(sub(v, u), sub(p, u)), n) >= 0 for u, v in ((a, b), (b, c), (c, a)))
    if inside:
        return abs(dot(sub(p, a), n)) / math.sqrt(dot(n, n))
    best = math.inf
    for u, v in ((a, b), (b, c), (c, a)):
        d = sub(v, u)
        t = min(1, max(0, dot(sub(p, u), d) / dot(d, d)))
        best = min(best, math.dist(p, tuple(x + t * y for x, y in zip(u, d))))
    return best


class Terrain(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("in.asc", grid(ROWS))
        self.triangles = triangles(ROWS)

    def terrain(self, output, *options, name="in.asc", radius=R):
        return self.succeed("terrain", name, output, "--radius", radius, *options)

    def distance(self, p, near=R + 1):
        """From a point to the terrain's triangles."""
        return min(distance_to_triangle(p, t) for t in self.triangles
                   if min(v[0] for v in t) - near <= p[0] <= max(v[0] for v in t) + near)

    # --- JSON ---

    def check_topology(self, s):
        half = s["half_edges"]
        for h, (origin, twin, following, face, edge) in enumerate(half):
            self.assertEqual((half[twin][1], twin != h, half[twin][4]), (h, True, edge))
            self.assertEqual(half[following][0], half[twin][0], "a loop is broken")
            self.assertEqual(half[following][3], face)
        self.assertEqual(sorted(h[2] for h in half), list(range(len(half))))
        listed = []
        for f, face in enumerate(s["faces"]):
            for start in ([] if face["outer"] is None else [face["outer"]]) + face["inner"]:
                h = start
                while True:
                    self.assertEqual(half[h][3], f)
                    listed.append(h)
                    h = half[h][2]
                    if h == start:
                        break
        self.assertEqual(sorted(listed), list(range(len(half))), "each loop is listed once")
        parent = list(range(len(s["vertices"])))
        def root(v):
            while parent[v] != v:
                parent[v] = parent[parent[v]]
                v = parent[v]
            return v
        for h in half:
            parent[root(h[0])] = root(half[h[1]][0])
        components = sum(root(v) == v for v in range(len(parent)))
        self.assertEqual(len(s["vertices"]) - len(s["edges"]) + len(s["faces"]), 1 + components, "Euler")

    def check_labels(self, s):
        self.assertEqual((s["krepl"], s["version"], s["radius"]), ("subdivision", 1, R))
        self.assertEqual((s["faces"][0]["feature"], s["faces"][0]["outer"]), (None, None))
        for h, (_, _, _, face, edge) in enumerate(s["half_edges"]):
            if s["half_edges"][h][1] > h:
                sides = [s["faces"][face]["feature"], s["faces"][s["half_edges"][s["half_edges"][h][1]][3]]["feature"]]
                for label, owner in zip(s["edges"][edge]["features"], sides):
                    self.assertTrue(label == owner or (label is None and s["edges"][edge]["kind"] == "rim"))
        for feature in s["features"]:
            self.assertEqual(len(feature["at"]), {"vertex": 1, "edge": 2, "face": 3}[feature["kind"]])

    def test_json_is_a_subdivision_and_lies_on_the_surface(self):
        done = self.terrain("out.json", "--curve-points", 4)
        s = json.loads(self.text("out.json"))
        self.check_topology(s)
        self.check_labels(s)
        kinds = Counter(e["kind"] for e in s["edges"])
        self.assertRegex(done.stdout, rf"^60 triangles; {len(s['vertices'])} vertices, {len(s['edges'])} edges "
                         rf"\({kinds['seam']} seams, {kinds['valley']} valleys, {kinds['rim']} rims\), "
                         rf"{len(s['faces'])} faces; \d+\.\d+ s\n$")
        for edge in s["edges"]:
            self.assertEqual(len(edge["points"]), 4)
            for p in edge["points"]:
                self.assertAlmostEqual(self.distance(p), R, delta=1e-8)
        half = s["half_edges"]
        for h in range(0, len(half), 2):
            points = s["edges"][half[h][4]]["points"]
            self.assertEqual((points[0], points[-1]), (s["vertices"][half[h][0]], s["vertices"][half[half[h][1]][0]]))

    def test_json_on_standard_output_and_same_bytes_for_any_number_of_threads(self):
        first = self.succeed("terrain", "in.asc", "-", "--radius", R, "--threads", 1)
        again = self.succeed("terrain", "in.asc", "-", "--radius", R, "--threads", 3)
        self.assertEqual(first.stdout, again.stdout)
        self.assertIn("60 triangles", first.stderr)
        self.assertEqual(len(json.loads(first.stdout)["edges"][0]["points"]), 5)

    def test_files_have_the_same_bytes_for_any_number_of_threads(self):
        for extension in ("gpkg", "tif", "stl", "ply", "glb", "png"):
            for threads in (1, 3):
                width = ["--width", 200] if extension == "png" else []
                self.terrain(f"out{threads}.{extension}", "--threads", threads, *width)
            one, three = ((self.directory / f"out{n}.{extension}").read_bytes() for n in (1, 3))
            self.assertTrue(one == three, extension)

    # --- triangles ---

    def read_stl(self, name):
        data = (self.directory / name).read_bytes()
        (count,) = struct.unpack_from("<I", data, 80)
        self.assertEqual(len(data), 84 + 50 * count)
        return [[struct.unpack_from("<3f", data, 84 + 50 * t + 12 * k) for k in (1, 2, 3)] for t in range(count)]

    def read_ply(self, name):
        data = (self.directory / name).read_bytes()
        head, body = data.split(b"end_header\n", 1)
        sizes = {line.split()[1]: int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element")}
        vertices = [struct.unpack_from("<3d3B", body, 27 * i) for i in range(sizes["vertex"])]
        start = 27 * sizes["vertex"]
        self.assertEqual(len(body), start + 21 * sizes["face"])
        corners = [struct.unpack_from("<B5I", body, start + 21 * t) for t in range(sizes["face"])]
        return [[vertices[v] for v in c[1:4]] for c in corners]

    def check_closed(self, mesh):
        """Sides run to and fro equally often, but for one closed border: the rim."""
        sides = Counter()
        for t in mesh:
            places = [p[:3] for p in t]
            for i in range(3):
                if places[i] != places[(i + 1) % 3]:
                    sides[(places[i], places[(i + 1) % 3])] += 1
        border = [side for side, count in sides.items() if count != sides[side[::-1]]]
        self.assertEqual(Counter(a for a, _ in border), Counter(b for _, b in border))
        following = dict(border)
        self.assertEqual(len(following), len(border))
        at = start = border[0][0]
        for _ in border:
            at = following[at]
        self.assertEqual(at, start)
        for p in following:  # at the rim the ball touches the border of the terrain beside it
            x, y = p[0] - CORNER[0], p[1] - CORNER[1]
            self.assertTrue(x < 0.5 + 1e-6 or x > 6.5 - 1e-6 or y < 0.5 + 1e-6 or y > 5.5 - 1e-6, (x, y))

    def check_deviation(self, mesh, max_error):
        """Corners are on the surface; points of triangles are nowhere farther from the terrain than R, or nearer than
        asked for."""
        for t in mesh[::7]:
            places = [p[:3] for p in t]
            for p in places:
                self.assertAlmostEqual(self.distance(p), R, delta=1e-8)
            for weights in ((1 / 3, 1 / 3, 1 / 3), (0.5, 0.5, 0), (0, 0.5, 0.5), (0.6, 0.2, 0.2)):
                p = tuple(sum(w * q[k] for w, q in zip(weights, places)) for k in range(3))
                self.assertGreater(self.distance(p), R - max_error)
                self.assertLess(self.distance(p), R + max_error)

    def test_ply(self):
        self.terrain("out.ply", "--max-error", 0.02)
        mesh = self.read_ply("out.ply")
        self.check_closed(mesh)
        self.check_deviation(mesh, 0.02)
        self.assertEqual(len({p[3:] for t in mesh for p in t}), 3, "a colour for each kind of patch")
        area = sum(((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2 for a, b, c in mesh)
        self.assertAlmostEqual(area, 6 * 5 + 2 * (6 + 5) * R + math.pi * R * R, delta=0.02 * 40)

    def test_stl(self):
        self.write("small.asc", grid(ROWS, corner=(0, 0)))
        done = self.terrain("out.stl", "--max-error", 0.02, name="small.asc")
        mesh = self.read_stl("out.stl")
        self.assertRegex(done.stdout, rf"; {len(mesh)} triangles written, within 0\.0\d+; ")
        self.assertEqual(done.stderr, "")
        self.triangles = triangles(ROWS, corner=(0, 0))
        for t in mesh[::7]:
            for p in t:
                self.assertAlmostEqual(self.distance(p), R, delta=1e-5)
        data = (self.directory / "out.stl").read_bytes()
        for t in range(len(mesh)):
            normal = struct.unpack_from("<3f", data, 84 + 50 * t)
            self.assertAlmostEqual(math.hypot(*normal), 1, delta=1e-6)
            self.assertGreaterEqual(normal[2], 0)

    def test_stl_far_from_the_origin_is_moved_with_a_note(self):
        done = self.terrain("out.stl")
        self.assertRegex(done.stderr, r"^krepl: out.stl: note: coordinates are relative to 500004 5600003 \d+: "
                         r"STL has single precision only\n$")
        self.assertTrue(all(abs(v) < 20 for t in self.read_stl("out.stl") for p in t for v in p))

    def test_meshes_are_the_same_through_a_pipe(self):
        for extension in ("stl", "ply", "glb"):
            self.terrain(f"out.{extension}")
            os.mkfifo(self.directory / f"pipe.{extension}")
            through = self.directory / f"through.{extension}"
            with open(through, "wb") as file, subprocess.Popen(["cat", f"pipe.{extension}"], cwd=self.directory, stdout=file):
                self.terrain(f"pipe.{extension}")
            self.assertTrue(through.read_bytes() == (self.directory / f"out.{extension}").read_bytes(), extension)

    def test_assimp_reads_the_meshes(self):
        self.need("assimp")
        self.write("small.asc", grid(ROWS, corner=(0, 0)))
        for extension in ("stl", "ply", "glb"):
            done = self.terrain(f"out.{extension}", "--max-error", 0.05, name="small.asc")
            count = int(done.stdout.split(" triangles written")[0].split()[-1])
            info = subprocess.run(["assimp", "info", f"out.{extension}"], cwd=self.directory, capture_output=True, text=True)
            self.assertEqual(info.returncode, 0, info.stdout)
            faces = next(line for line in info.stdout.splitlines() if line.startswith("Faces:"))
            # assimp leaves out triangles that single precision makes degenerate.
            self.assertAlmostEqual(int(faces.split()[1]), count, delta=0.01 * count)

    def test_glb(self):
        self.terrain("out.glb")
        data = (self.directory / "out.glb").read_bytes()
        magic, version, size, length, kind = struct.unpack_from("<4s2I1I4s", data)
        self.assertEqual((magic, version, size, kind), (b"glTF", 2, len(data), b"JSON"))
        head = json.loads(data[20:20 + length])
        self.assertEqual(head["nodes"][0]["translation"], [500004, head["nodes"][0]["translation"][1], -5600003])
        binary = data[28 + length:]
        self.assertEqual(len(binary), head["buffers"][0]["byteLength"])
        views = head["bufferViews"]
        def values(accessor, form):
            view = views[accessor]
            return list(struct.iter_unpack(form, binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]))
        positions, normals = values(0, "<3f"), values(1, "<3f")
        self.assertEqual(len(positions), head["accessors"][0]["count"])
        for p, n in zip(positions, normals):
            self.assertAlmostEqual(math.hypot(*n), 1, delta=1e-6)
            self.assertGreaterEqual(n[1], -1e-6)
        for k in range(3):
            for name, end in (("min", min), ("max", max)):
                told = struct.unpack("<f", struct.pack("<f", head["accessors"][0][name][k]))[0]
                self.assertEqual(told, end(p[k] for p in positions))
        self.assertLess(max(i for (i,) in values(3, "<I")), len(positions))

    # --- rasters ---

    def test_geotiff(self):
        self.need("gdalinfo", "gdallocationinfo")
        self.terrain("out.tif", "--crs", "EPSG:25832")
        info = json.loads(self.ogr("gdalinfo", "-json", "out.tif"))
        self.assertEqual(info["size"], [7 + 4, 6 + 4])
        self.assertEqual(info["geoTransform"], [CORNER[0] - 2, 1, 0, CORNER[1] + 8, 0, -1])
        self.assertIn("25832", info["coordinateSystem"]["wkt"])
        self.assertEqual(info["bands"][0]["type"], "Float64")
        for column in range(11):
            for row in range(10):
                value = float(self.ogr("gdallocationinfo", "-valonly", "out.tif", str(column), str(row)))
                x, y = CORNER[0] - 1.5 + column, CORNER[1] + 7.5 - row
                if not math.isnan(value):
                    self.assertAlmostEqual(self.distance((x, y, value)), R, delta=1e-8)
                beyond = math.hypot(max(0, 2 - column, column - 8), max(0, 2 - row, row - 7))
                self.assertEqual(math.isnan(value), beyond > R)

    def test_geotiff_cell(self):
        self.need("gdalinfo")
        self.terrain("out.tif", "--cell", "0.5")
        info = json.loads(self.ogr("gdalinfo", "-json", "out.tif"))
        self.assertEqual(info["size"], [20, 18])

    def test_png(self):
        self.need("gdalinfo")
        self.terrain("out.png", "--width", 300)
        info = json.loads(self.ogr("gdalinfo", "-json", "-mm", "out.png"))
        self.assertEqual((info["driverShortName"], info["size"], len(info["bands"])), ("PNG", [300, 270], 3))
        for band in info["bands"]:
            self.assertLess(band["computedMin"], 100)
            self.assertEqual(band["computedMax"], 255)
        self.assertEqual(self.files(), ["in.asc", "out.png"])

    # --- GeoPackage ---

    def test_geopackage(self):
        self.need("ogrinfo", "ogr2ogr")
        self.terrain("out.json")
        self.terrain("out.gpkg", "--crs", "EPSG:25832", "--max-error", 0.001)
        s = json.loads(self.text("out.json"))
        rows = {}
        for layer in ("faces", "edges", "vertices"):
            self.assertIn("25832", self.ogr("ogrinfo", "-so", "out.gpkg", layer))
            text = self.ogr("ogr2ogr", "-f", "GeoJSON", "/vsistdout/", "out.gpkg", layer, "-lco", "COORDINATE_PRECISION=15")
            rows[layer] = json.loads(text)["features"]
        self.assertEqual(len(rows["faces"]), len(s["faces"]) - 1)
        self.assertEqual(len(rows["edges"]), len(s["edges"]))
        self.assertEqual(len(rows["vertices"]), len(s["vertices"]))
        for row in rows["edges"]:
            p, half = row["properties"], s["half_edges"]
            left, right = half[2 * p["edge"]], half[2 * p["edge"] + 1]
            self.assertEqual([p["from_vertex"], p["left_next"], p["left_face"]], [left[0], left[2], left[3]])
            self.assertEqual([p["to_vertex"], p["right_next"], p["right_face"]], [right[0], right[2], right[3]])
            self.assertEqual([p["left_feature"], p["right_feature"]], s["edges"][p["edge"]]["features"])
            for written, true in zip(row["geometry"]["coordinates"][0], s["vertices"][left[0]]):
                self.assertAlmostEqual(written, true, delta=1e-14 * max(1, abs(true)))
        for row in rows["faces"]:
            face = s["faces"][row["properties"]["face"]]
            self.assertEqual((row["properties"]["feature"], row["properties"]["outer"]), (face["feature"], face["outer"]))
            self.assertEqual(row["properties"]["kind"], s["features"][face["feature"]]["kind"])

    # --- holes and walls ---

    def test_hole_of_the_domain(self):
        rows = [[0] * 12 for _ in range(12)]
        for row in range(3, 9):
            for column in range(3, 9):
                rows[row][column] = -9999
        self.write("hole.asc", grid(rows))
        self.terrain("out.json", name="hole.asc", radius=1)
        s = json.loads(self.text("out.json"))
        self.check_topology(s)
        holes = [f for f in s["faces"][1:] if f["feature"] is None]
        self.assertEqual(len(holes), 1)
        self.triangles = triangles(rows)
        self.terrain("out.ply", name="hole.asc", radius=1)
        mesh = self.read_ply("out.ply")
        area = sum(((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2 for a, b, c in mesh)
        # The square of 11 and its round border, less the square of 7 that the ball narrows by 1 on each side; two of its
        # corners are cut off by the triangles that have no missing sample.
        self.assertAlmostEqual(area, 121 + 44 + math.pi - 25 + (math.sqrt(2) - 1) ** 2, delta=0.01)

    def test_rim_above_a_lower_part(self):
        # A block of height 10 on a plate: below its rim there is the wall's foot.
        block = [((3, 3), (7, 7), 10.0), ((0, 0), (10, 10), 0.0)]
        facets = []
        for (x0, y0), (x1, y1), z in block:
            a, b, c, d = (x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)
            facets += [(a, b, c), (a, c, d)]
        corners = [p for f in facets for p in f]
        self.write("block.off", f"OFF\n{len(corners)} {len(facets)} 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in corners) +
                   "".join(f"3 {3 * i} {3 * i + 1} {3 * i + 2}\n" for i in range(len(facets))))
        self.terrain("out.ply", name="block.off", radius=1)
        self.triangles = facets
        mesh = self.read_ply("out.ply")
        area = sum(((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2 for a, b, c in mesh)
        self.assertAlmostEqual(area, 100 + 40 + math.pi, delta=0.05)
        foot = [p for t in mesh for p in t if math.dist(p[:2], (7, 7)) < 1 + 1e-6 and p[0] > 7 and p[1] > 7]
        self.assertEqual({round(p[2], 9) for p in foot if abs(math.dist(p[:2], (7, 7)) - 1) < 1e-6}, {1.0, 10.0})

    def test_verify_of_seams_that_end_below_walls_of_different_height(self):
        # Floors between a high wall and two low ones. The seams along the diagonals and borders of the floors end far below
        # their vertices, which have the heights of the walls.
        facets = []
        profile = [(0, 5), (2, 5), (2, 0), (8, 0), (8, 20), (10, 20), (10, 0), (16, 0), (16, 5), (18, 5)]
        for (x0, z0), (x1, z1) in zip(profile, profile[1:]):
            a, b, c, d = (x0, 0, z0), (x1, 0, z1), (x1, 6, z1), (x0, 6, z0)
            facets += [(a, b, c), (a, c, d)]
        self.write("walls.off", f"OFF\n{3 * len(facets)} {len(facets)} 0\n" +
                   "".join(f"{x} {y} {z}\n" for facet in facets for x, y, z in facet) +
                   "".join(f"3 {3 * i} {3 * i + 1} {3 * i + 2}\n" for i in range(len(facets))))
        self.terrain("out.json", name="walls.off", radius=1)
        s = json.loads(self.text("out.json"))
        ends = [[s["vertices"][s["half_edges"][h][0]][2] for h in (2 * e, 2 * e + 1)]
                for e, edge in enumerate(s["edges"]) if edge["kind"] == "seam" and all(p[2] == 1 for p in edge["points"])]
        self.assertEqual(list(map(sorted, ends)), [[5, 20]] * 6)
        self.succeed("verify", "out.json", "--against", "walls.off")

    # --- STEP ---

    def entities(self, name):
        """How many of each kind, without their numbers."""
        text = self.text(name)
        self.assertTrue(text.startswith("ISO-10303-21;") and text.endswith("END-ISO-10303-21;\n"))
        return Counter(line.split("=", 1)[1].split("(", 1)[0].strip() for line in text.splitlines() if "=" in line)

    def test_step_has_a_face_for_each_face(self):
        done = self.terrain("out.step")
        self.terrain("out.json")
        s = json.loads(self.text("out.json"))
        kinds = Counter(s["features"][f["feature"]]["kind"] for f in s["faces"] if f["feature"] is not None)
        found = self.entities("out.step")
        self.assertEqual(found["ADVANCED_FACE"], sum(kinds.values()))
        self.assertEqual((found["PLANE"], found["CYLINDRICAL_SURFACE"], found["SPHERICAL_SURFACE"]),
                         (kinds["face"], kinds["edge"], kinds["vertex"]))
        self.assertEqual(found["OPEN_SHELL"], 1)
        self.assertIn(f"{kinds['face']} planes, {kinds['edge']} cylinders and {kinds['vertex']} spheres written", done.stdout)
        self.assertIn("'1970-01-01T00:00:00'", self.text("out.step"))

    def test_step_as_a_solid_and_units(self):
        self.terrain("out.step", "--solid", "--unit", "cm")
        found = self.entities("out.step")
        self.assertEqual((found["MANIFOLD_SOLID_BREP"], found["CLOSED_SHELL"], found["OPEN_SHELL"]), (1, 1, 0))
        self.assertIn("SI_UNIT(.CENTI.,.METRE.)", self.text("out.step"))
        # Every edge of a closed shell has two faces.
        self.assertEqual(found["ORIENTED_EDGE"], 2 * found["EDGE_CURVE"])
        done = self.terrain("again.stp", "--solid")
        self.assertIn("a floor", done.stdout)

    # --- refusals ---

    def test_verify_where_adding_the_origin_rounds(self):
        rows = [[(3 * c + 5 * r) % 4 for c in range(7)] for r in range(6)]
        self.write("far.asc", grid(rows, 30.85, (794599.1076146346, 8931774.874602526)))
        self.succeed("terrain", "far.asc", "out.json", "--radius", "40")
        self.succeed("verify", "out.json", "--against", "far.asc")

    def test_refusals(self):
        formats = "give --format json, gpkg, tif, step, stl, ply, glb or png"
        for arguments, message in (
                (("out.json", "--solid"), "--solid has no meaning for format json; it belongs to step"),
                (("out.json", "--unit", "m"), "--unit has no meaning for format json; it belongs to step"),
                (("-", "--format", "step"), "format step cannot go to standard output; choose json, or name a file"),
                (("out.xyz",), f"out.xyz: the extension .xyz belongs to no format of surfaces; {formats}"),
                (("out",), f"out: the format of a file without extension is not known; {formats}"),
                (("out.json", "--format", "dwg"), f"unknown format 'dwg'; {formats}"),
                (("-", "--format", "stl"), "format stl cannot go to standard output; choose json, or name a file"),
                (("out.json", "--engine", "magic"), "engine 'magic' is unknown; give --engine auto or incremental"),
                (("out.tif", "--engine", "incremental"),
                 "--engine has no meaning for format tif; its heights come from the drop cutter; leave --engine out"),
                (("out.json", "--cell", "1"), "--cell has no meaning for format json; it belongs to tif"),
                (("out.stl", "--curve-points", "9"), "--curve-points has no meaning for format stl; it belongs to json"),
                (("out.tif", "--cell", "0"),
                 "--cell '0' is zero; give a finite number greater than zero, in the unit of the coordinates"),
                (("out.tif", "--cell", "1e-9"), None)):
            if message is not None:
                self.fail_with(2, message, "terrain", "in.asc", *arguments, "--radius", R)
            else:
                done = self.krepl("terrain", "in.asc", *arguments, "--radius", R)
                self.assertEqual(done.returncode, 2)
                self.assertTrue(done.stderr.endswith(" cells are too many; change --cell\n"), done.stderr)

    def test_incremental_engine(self):
        done = self.succeed("terrain", "in.asc", "out.json", "--radius", R, "--engine", "incremental", "--verbose")
        self.assertRegex(done.stderr, r"unions +[0-9]+ semi-kreplach added, [0-9]+ curves looked along")
        self.assertRegex(done.stderr, r"intersections [0-9]+ components, [0-9]+ of them closed; [0-9]+ unions had several")
        self.succeed("verify", "out.json", "--against", "in.asc")
        other = self.succeed("terrain", "in.asc", "other.json", "--radius", R)
        counts = [re.search(r"[0-9]+ vertices, .* faces", text).group() for text in (done.stdout, other.stdout)]
        self.assertEqual(*counts)

    def test_incremental_engine_refuses_much(self):
        self.write("big.asc", grid([[0] * 30 for _ in range(30)]))
        self.fail_with(2, "big.asc: the incremental engine takes at most 1000 triangles, these are 1682; use the engine auto, "
                          "or cut the input smaller", "terrain", "big.asc", "out.json", "--radius", 1, "--engine", "incremental")

    def test_interrupt_leaves_nothing(self):
        rows = [[(i * i * 7 + j * j * 5) % 13 for j in range(300)] for i in range(300)]
        self.write("big.asc", grid(rows))
        process = self.start("terrain", "big.asc", "out.json", "--radius", 3)
        self.wait_until_interruptible(process)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(self.files(), ["big.asc", "in.asc"])


if __name__ == "__main__":
    support.main()
