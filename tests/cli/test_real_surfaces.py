"""krepl terrain on real elevation models and parts, checked by krepl verify; skipped where the data are absent."""
import os

import support

DATA = os.environ.get("KREPL_DATA", "")
# Pockets with vertical walls, engraved text, walls vertical but for single precision, a mould with its walls upwards, elevation
# models with and without holes as wide as the ball.
CASES = [("mesh/failedinpycam.off", ("1.23", "41")), ("mesh/pycam-textbox.off", ("0.9", "9")),
         ("mesh/featuretype.off", ("0.085", "0.85", "8.5")), ("mesh/ktoolcav.off", ("0.017", "0.169", "0.564")),
         ("dem/hugo_site.asc", ("3", "10", "300")), ("dem/volcano.asc", ("10", "100"))]


class RealSurfaces(support.CliTest):
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
