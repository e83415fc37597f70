"""krepl info: what results are like, of every kind that krepl writes."""
import json
import math

import support

TENT = "OFF\n6 4 0\n-9 0 9\n0 0 0\n9 0 9\n-9 20 9\n0 20 0\n9 20 9\n3 0 1 4\n3 0 4 3\n3 1 2 5\n3 1 5 4\n"


class InfoTest(support.CliTest):
    def info(self, name):
        return json.loads(self.succeed("info", name, "--json").stdout)

    def test_surface(self):
        """Two slopes that meet in an inner edge: two planes of length 9 sqrt 2 less what the ball does not reach."""
        self.write("tent.off", TENT)
        for name in ("out.json", "out.gpkg"):
            self.succeed("terrain", "tent.off", name, "--radius", 2)
            found = self.info(name)
            self.assertEqual((found["of"], found["radius"], found["holes"]), ("surface", 2, 0))
            planes = found["faces_by_kind"]["planes"]
            self.assertEqual(planes["count"], 4)
            self.assertAlmostEqual(planes["area"], 2 * 20 * (9 * math.sqrt(2) - 2), places=8)
            self.assertAlmostEqual(planes["projected_area"], planes["area"] / math.sqrt(2), places=8)
            self.assertAlmostEqual(found["inner_edges"]["sharpest_turn_degrees"]["value"], 90, places=6)
            self.assertAlmostEqual(found["inner_edges"]["most_left"]["value"], 2 * (math.sqrt(2) - 1), places=8)
            self.assertEqual(found["bridges"]["count"], 0)
            self.assertIsNone(found["bridges"]["narrowest_radius"])
            self.assertLess(found["accuracy"]["found"]["value"], found["accuracy"]["promised"])
            self.assertEqual(found["edges"], sum(k["count"] for k in found["edges_by_kind"].values()))
            self.assertEqual(found["edges"], sum(k["count"] for k in found["edges_by_curve"].values()))
            text = self.succeed("info", name).stdout
            self.assertIn("surface of radius 2", text)
            self.assertIn("most left in the edge: 0.828427", text)

    def test_zone(self):
        self.write("in.wkt", "LINESTRING (0 0, 10 0)\n")
        for name in ("out.wkt", "out.gpkg"):
            self.succeed("buffer", "in.wkt", name, "--radius", 3)
            (zone,) = self.info(name)["zones"]
            self.assertAlmostEqual(zone["area"], 60 + 9 * math.pi, places=9)
            self.assertAlmostEqual(zone["arcs"]["length"], 6 * math.pi, places=9)
            self.assertEqual((zone["polygons"], zone["holes"], zone["segments"]["count"]), (1, 0, 2))
        self.assertIn("zone of radius 3: 1 polygons, 0 holes", self.succeed("info", "out.gpkg").stdout)

    def test_profile(self):
        self.write("in.csv", "x,z\n0,0\n4,0\n")
        self.succeed("profile", "in.csv", "out.csv", "--radius", 1)
        found = self.info("out.csv")
        self.assertAlmostEqual(found["arcs"]["length"], math.pi, places=12)
        self.assertEqual(found["segments"], {"count": 1, "length": 4})
        self.assertIn("profile: 5 pieces", self.succeed("info", "out.csv").stdout)

    def test_refusals(self):
        self.write("bad.json", '{"krepl":"subdivision","version":1,"radius":1,"features":[],"vertices":[],"edges":[],'
                               '"half_edges":[],"faces":[]}')
        self.fail_with(1, "bad.json: has no vertices", "info", "bad.json")
        self.assertEqual(self.krepl("info", "none.gpkg").returncode, 1)
        self.assertEqual(self.krepl("info").returncode, 2)


if __name__ == "__main__":
    support.main()
