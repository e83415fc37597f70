"""krepl lab: constructions as files that other verbs take, tables, pictures, messages."""
import csv
import io
import json
import xml.etree.ElementTree as xml

import support


class Lab(support.CliTest):
    def rows(self, name):
        return list(csv.DictReader(io.StringIO(self.text(name))))

    def test_list_names_every_experiment(self):
        text = self.succeed("lab", "list").stdout
        for name in ("lower-bound", "profiles", "sweep", "pseudospheres", "components", "conjecture", "search", "real"):
            self.assertIn(name, text)
            self.assertIn("--output", self.succeed("lab", name, "--help").stdout)

    def test_lower_bound_stands_the_check_by_brute_force(self):
        """The terrain that was written, through the other verbs, has the vertices that the table says."""
        done = self.succeed("lab", "lower-bound", "--n", "4,8,32", "-o", "out")
        self.assertIn("vertices grow as triangles^", done.stdout)
        rows = self.rows("out/lower-bound.csv")
        self.assertEqual([(r["kind"], r["n"]) for r in rows],
                         [(kind, n) for n in ("4", "8", "32") for kind in ("lower-bound", "islands")])
        for row in rows[:4]:
            obj = f"out/{row['kind']}-{row['n']}.obj"
            self.succeed("terrain", obj, "surface.json", "--radius", 1)
            self.assertIn("sound: every check passed",
                          self.succeed("verify", "surface.json", "--against", obj, "--radius", 1).stdout)
            found = json.loads(self.succeed("info", "surface.json", "--json").stdout)
            self.assertEqual((found["vertices"], found["edges"], found["faces"] + 1),  # the table counts the outside
                             tuple(int(row[k]) for k in ("vertices", "edges", "faces")))

    def test_profiles_stand_the_check_by_brute_force(self):
        self.succeed("lab", "profiles", "--n", "5,20", "-o", "out")
        for row in self.rows("out/profiles.csv"):
            terrain = f"out/{row['kind']}-{row['n']}.csv"
            self.succeed("profile", terrain, "path.csv", "--radius", row["radius"])
            self.succeed("verify", "path.csv", "--against", terrain, "--radius", row["radius"])
            self.assertEqual(len(self.rows("path.csv")) - 1, int(row["vertices"]))

    def test_sweep(self):
        """The river that was written has the zone that the table says, by another engine."""
        self.succeed("lab", "sweep", "--n", "6,20", "-o", "out")
        for row in self.rows("out/sweep.csv"):
            river = f"out/{row['kind']}-{row['n']}.wkt"
            done = self.succeed("buffer", river, "zone.wkt", "--radius", 1, "--engine", "voronoi", "--verbose")
            self.assertIn(f"{row['pieces']} pieces, ", done.stderr)
        xml.parse(self.directory / "out/sweep.svg")
        xml.parse(self.directory / "out/bundle-6.svg")

    def test_files(self):
        """JSON says what CSV says, pictures are XML, and nothing depends on the number of threads."""
        self.succeed("lab", "conjecture", "--count", 30, "--n", "5,8", "--seed", 3, "--threads", 1, "-o", "one")
        self.succeed("lab", "conjecture", "--count", 30, "--n", "5,8", "--seed", 3, "--threads", 2, "-o", "two")
        names = sorted(p.name for p in (self.directory / "one").iterdir())
        self.assertEqual(names, sorted(p.name for p in (self.directory / "two").iterdir()))
        for name in names:
            self.assertEqual(self.text(f"one/{name}"), self.text(f"two/{name}"))
        told = json.loads(self.text("one/conjecture.json"))
        self.assertEqual([str(r["most_vertices"]) for r in told["rows"]],
                         [r["most_vertices"] for r in self.rows("one/conjecture.csv")])
        self.assertEqual(sum(r["terrains"] for r in told["rows"]), 30)
        self.assertTrue(xml.parse(self.directory / "one/conjecture.svg").getroot().tag.endswith("svg"))

    def test_figures(self):
        text = self.succeed("lab", "pseudospheres", "-o", "out").stdout
        self.assertIn("crossing-blades: four balls touch all three triangles", text)
        self.assertIn("a closed curve and an arc", self.succeed("lab", "components", "-o", "out").stdout)
        for name in ("crossing-needles", "crossing-blades", "components"):
            xml.parse(self.directory / f"out/{name}.svg")

    def test_real(self):
        heights = "\n".join(" ".join(str((7 * i * i + 5 * j + i * j) % 11) for i in range(40)) for j in range(40))
        self.write("hills.asc", f"ncols 40\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 10\n{heights}\n")
        self.succeed("lab", "real", "hills.asc", "--radius", "10,40", "-o", "out")
        self.assertEqual([r["columns"] for r in self.rows("out/real.csv")], ["20", "40"] * 2)

    def test_search(self):
        self.succeed("lab", "search", "--n", 3, "--steps", 5, "--restarts", 1, "-o", "out")
        for row in self.rows("out/search.csv"):
            self.assertGreaterEqual(int(row["vertices"]), int(row["start_vertices"]))

    def test_refusals(self):
        self.fail_with(2, "n = 6 gives no n/2 grooves, half of them on each side of n/2 needles; "
                          "give multiples of 4 from 4 to 1024", "lab", "lower-bound", "--n", 6, "-o", "out", output="out")
        self.fail_with(1, "nowhere/out: cannot be written: No such file or directory; create the directory first",
                       "lab", "components", "-o", "nowhere/out", output="nowhere")
        self.write("file", "")
        self.fail_with(1, "file: not a directory; give the name of a directory for the files", "lab", "components", "-o", "file",
                       output="out")
        self.assertEqual(self.krepl("lab").returncode, 2)
        self.assertEqual(self.krepl("lab", "nothing").returncode, 2)
        self.assertEqual(self.krepl("lab", "real", "none.asc").returncode, 2)


if __name__ == "__main__":
    support.main()
