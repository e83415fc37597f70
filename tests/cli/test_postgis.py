"""Results read by PostGIS: a server of its own in a temporary directory, on a socket only."""
import getpass
import math
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import support

PI = math.pi
ACCOUNT = "postgres"  # the server refuses to run as the superuser
CASES = [  # network, radius, area, holes
    ("POINT (3 4)", 5, 25 * PI, 0),
    ("LINESTRING (0 0, 10 0)", 1, 20 + PI, 0),
    ("LINESTRING (0 0, 10 0, 10 10, 0 10, 0 0)", 1, 80 - (4 - PI), 1),
    ("MULTIPOINT ((500000 5500000), (500100 5500000))", 30, 1800 * PI, 0),
]


def programs():
    """Directory of initdb and pg_ctl, newest version; None if PostgreSQL is not installed."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/pg_ctl"), key=lambda p: int(p.parts[-3]))
    return found[-1].parent if found and shutil.which("psql") else None


class Server:
    def __init__(self, bin_directory):
        self.bin = bin_directory
        self.directory = Path(tempfile.mkdtemp(prefix="krepl-postgis-"))
        self.user = ACCOUNT if os.geteuid() == 0 else getpass.getuser()
        if os.geteuid() == 0:
            shutil.chown(self.directory, ACCOUNT)

    def run(self, *command, **options):
        prefix = ["runuser", "-u", ACCOUNT, "--"] if os.geteuid() == 0 else []
        return subprocess.run([*prefix, *map(str, command)], cwd=self.directory, capture_output=True, text=True, timeout=120,
                              **options)

    def start(self):
        made = self.run(self.bin / "initdb", "-D", self.directory / "data", "-A", "trust", "-E", "UTF8", "--no-sync")
        if made.returncode != 0:
            return made.stderr
        started = self.run(self.bin / "pg_ctl", "-D", self.directory / "data", "-w", "-l", self.directory / "log", "-o",
                           f"-c listen_addresses='' -c fsync=off -k {self.directory}", "start")
        if started.returncode != 0:
            return started.stderr
        extended = self.sql("CREATE EXTENSION postgis")
        return extended.stderr if extended.returncode != 0 else None

    def sql(self, query):
        return self.run("psql", "-h", self.directory, "-d", "postgres", "-XAtq", "-v", "ON_ERROR_STOP=1", "-F", "|",
                        input=query)

    def stop(self):
        self.run(self.bin / "pg_ctl", "-D", self.directory / "data", "-m", "immediate", "stop")
        shutil.rmtree(self.directory, ignore_errors=True)


class PostGis(support.CliTest):
    @classmethod
    def setUpClass(cls):
        bin_directory = programs()
        if bin_directory is None:
            raise support.unittest.SkipTest("PostgreSQL is not installed")
        if os.geteuid() == 0 and shutil.which("runuser") is None:
            raise support.unittest.SkipTest("a server cannot be started as the superuser, and runuser is not installed")
        cls.server = Server(bin_directory)
        cls.addClassCleanup(cls.server.stop)
        failure = cls.server.start()
        if failure is not None:
            raise support.unittest.SkipTest("no PostGIS server can be started here: " + failure.strip().splitlines()[-1])

    def query(self, sql):
        done = self.server.sql(sql)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip().split("|")

    def check(self, geometry, area, holes, polygons, max_error):
        """`geometry` is an SQL expression. Tolerance type 1 is the largest deviation of the chords."""
        sql = (f"WITH g AS (SELECT {geometry} AS g), l AS (SELECT ST_CurveToLine(g, {max_error}, 1) AS l FROM g) "
               "SELECT ST_IsValid(l), ST_Area(l), ST_NumGeometries(ST_Multi(l)), "
               "(SELECT sum(ST_NumInteriorRings((d).geom)) FROM ST_Dump(l) d), ST_IsClosed(ST_Boundary(l)) FROM l")
        valid, found, parts, interior, closed = self.query(sql)
        self.assertEqual((valid, closed), ("t", "t"))
        self.assertEqual((int(parts), int(interior)), (polygons, holes))
        self.assertAlmostEqual(float(found) / area, 1, delta=1e-5)

    def test_text_and_binary(self):
        for network, radius, area, holes in CASES:
            with self.subTest(network=network):
                self.write("in.wkt", network + "\n")
                self.succeed("buffer", "in.wkt", "out.wkt", "--radius", radius)
                self.succeed("buffer", "in.wkt", "out.wkb", "--radius", radius)
                text = self.text("out.wkt").strip()
                blob = (self.directory / "out.wkb").read_bytes().hex()
                polygons = 2 if network.startswith("MULTI") else 1
                from_text, from_binary = f"ST_GeomFromText('{text}')", f"ST_GeomFromWKB(decode('{blob}', 'hex'))"
                for geometry in (from_text, from_binary):
                    self.check(geometry, area, holes, polygons, radius * 1e-6)
                self.assertEqual(self.query(f"SELECT ST_OrderingEquals({from_text}, {from_binary}), ST_HasArc({from_text})"),
                                 ["t", "t"])

    def test_full_circle(self):
        """One ring, one curve: start and end agree, and PostGIS takes it for the circle, not for a point."""
        self.write("in.wkt", "POINT (10 20)\n")
        self.succeed("buffer", "in.wkt", "out.wkt", "--radius", "2")
        geometry = f"ST_GeomFromText('{self.text('out.wkt').strip()}')"
        kind, xmin, ymin, xmax, ymax = self.query(
            f"SELECT ST_GeometryType({geometry}), ST_XMin(b), ST_YMin(b), ST_XMax(b), ST_YMax(b) FROM "
            f"(SELECT Box2D({geometry}) AS b) AS boxed")
        self.assertEqual(kind, "ST_CurvePolygon")
        for found, expected in zip(map(float, (xmin, ymin, xmax, ymax)), (8, 18, 12, 22)):
            self.assertAlmostEqual(found, expected, delta=1e-6)  # Box2D is in single precision

    def test_crossing_lines_in_large_coordinates(self):
        lines = [f"LINESTRING ({4e6 + 97 * i} {3e6 + 10 * (i * i % 71)}, {4e6 + 31 * (i * 13 % 67)} {3e6 + 53 * (i * 7 % 61)})"
                 for i in range(60)]
        self.write("in.wkt", "\n".join(lines) + "\n")
        done = self.succeed("buffer", "in.wkt", "out.wkt", "--radius", "20")
        found = support.measure(self.text("out.wkt"))
        self.assertGreater(found.holes, 20, done.stdout)
        self.check(f"ST_GeomFromText('{self.text('out.wkt').strip()}')", found.area, found.holes, found.polygons, 1e-4)


class RealData(PostGis):
    """The files of KREPL_DATA (see tests/support/environment.hpp), at a fine and a coarse radius."""
    FILES = {"river_new_hope_epsg32617_mm.wkt": (20, 400), "river_walker_epsg32610_mm.wkt": (20, 400),
             "roads_roxel_epsg32632_mm.wkt": (3, 40), "streets_tempe.wkt": (30, 400), "Methow_Network.shp": (50, 1000),
             "lakes_new_hope_epsg32617_mm.wkt": (20, 400)}

    def setUp(self):
        super().setUp()
        default = Path(__file__).resolve().parents[2].parent / "shared" / "data"
        self.data = Path(os.environ.get("KREPL_DATA") or default) / "vector"
        if not self.data.is_dir():
            self.skipTest("no real data; set KREPL_DATA to their directory")

    def test_zones_are_valid(self):
        # What the extent of the file is measured in decides on the radii: metres, millimetres or feet.
        for name, radii in self.FILES.items():
            scale = 1000 if name.endswith("_mm.wkt") else 1
            for radius in radii:
                with self.subTest(file=name, radius=radius):
                    self.succeed("buffer", self.data / name, "out.wkt", "--radius", radius * scale)
                    text = self.text("out.wkt").strip()
                    found = support.measure(text)
                    self.check(f"ST_GeomFromText('{text}')", found.area, found.holes, found.polygons, radius * scale * 1e-5)


# The cases of the base class are not run a second time.
for name in [n for n in dir(PostGis) if n.startswith("test_")]:
    setattr(RealData, name, None)


if __name__ == "__main__":
    support.main()
