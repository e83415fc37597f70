"""krepl terrain on real elevation models and parts, checked by krepl verify; skipped where the data are absent."""
import os

import support

DATA = os.environ.get("KREPL_DATA", "")
# Pockets with vertical walls, engraved text, walls vertical but for single precision, a mould with its walls upwards, elevation
# models with and without holes as wide as the ball.
CASES = [("mesh/failedinpycam.off", ("1.23", "41")), ("mesh/pycam-textbox.off", ("0.9", "9")),
         ("mesh/featuretype.off", ("0.085", "0.85", "8.5")), ("mesh/ktoolcav.off", ("0.017", "0.169", "0.564")),
         ("dem/hugo_site.asc", ("3", "10", "300")), ("dem/volcano.asc", ("10", "100"))]

# Part of a scan (mount_rush): two edges of its border follow each other with a bend of 1e-7, so that their walls all but coincide, and the
# patches between them are 1e-12 wide in the plane where they are 1e-5 tall. The triangle far off makes the scale that of the scan.
WALLS_IN_LINE = """OFF
10 6 0
36.2346076965332 16.01190948486328 -12.591113090515137
30.95541763305664 10.378201484680176 -8.376542091369629
33.098026275634766 15.975724220275879 -14.99297046661377
30.41204071044922 10.550802230834961 -8.822412490844727
29.86867904663086 10.723396301269531 -9.268282890319824
28.96249008178711 10.88761043548584 -10.069653511047363
29.215930938720703 15.930938720703125 -17.9657039642334
-31 -40 -15
-31.5 -40 -15
-31 -40.5 -15.2
3 1 0 2
3 1 2 3
3 4 3 2
3 4 2 5
3 5 2 6
3 7 8 9
"""


class RealSurfaces(support.CliTest):
    def test_walls_in_line(self):
        self.write("walls.off", WALLS_IN_LINE)
        for radius in ("0.249", "0.830421", "2.491263", "8.30421", "24.91263"):
            with self.subTest(radius=radius):
                for arguments in (["terrain", "walls.off", "surface.json", "--radius", radius, "--quiet"],
                                  ["verify", "surface.json", "--against", "walls.off", "--radius", radius, "--samples", "5000"]):
                    done = self.krepl(*arguments)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_walls_that_lean_by_rounding(self):
        """A mould with its walls upright but for 1e-9: seams of what is that steep, and holes whose rims all but meet in a point."""
        path = os.path.join(DATA, "mesh/ktoolcav.off")
        if not os.path.exists(path):
            self.skipTest("KREPL_DATA has no mesh/ktoolcav.off")
        for radius in ("0.098019", "0.98019", "3.2673"):
            with self.subTest(radius=radius):
                self.succeed("terrain", path, "surface.json", "--up", "y", "--radius", radius, "--quiet")
                self.succeed("verify", "surface.json", "--against", path, "--up", "y", "--radius", radius)

    def test_sound(self):
        if not os.path.isdir(DATA):
            self.skipTest("KREPL_DATA names no directory")
        present = [(os.path.join(DATA, name), radii) for name, radii in CASES if os.path.exists(os.path.join(DATA, name))]
        if not present:
            self.skipTest("none of the files is there")
        for path, radii in present:
            for radius in radii:
                with self.subTest(file=path, radius=radius):
                    for arguments in (["terrain", path, "surface.json", "--radius", radius, "--quiet"],
                                      ["verify", "surface.json", "--against", path, "--radius", radius, "--samples", "5000"]):
                        done = self.krepl(*arguments)
                        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    support.main()
