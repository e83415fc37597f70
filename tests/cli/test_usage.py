"""Options, help and messages for wrong usage: exit status 2, nothing written."""
import support


class Usage(support.CliTest):
    def setUp(self):
        super().setUp()
        self.write("line.wkt", "LINESTRING (0 0, 10 0)\n")

    def test_version(self):
        done = self.succeed("--version")
        self.assertRegex(done.stdout, r"^krepl \d+\.\d+\.\d+\n$")

    def test_help_names_the_verbs_and_their_options(self):
        self.assertIn("buffer", self.succeed("--help").stdout)
        text = self.succeed("buffer", "--help").stdout
        for option in ("--radius", "--layer", "--where", "--crs", "--to-crs", "--max-error", "--threads", "--format",
                       "--no-pieces", "--separate", "--quiet", "--verbose", "--engine"):
            self.assertIn(option, text)

    def test_no_verb(self):
        self.fail_with(2, "no verb given; see `krepl --help`")

    def test_unknown_verb(self):
        done = self.krepl("bufer", "line.wkt", "out.gpkg")
        self.assertEqual(done.returncode, 2)
        self.assertIn("see `krepl --help`", done.stderr)

    def test_unknown_option(self):
        done = self.krepl("buffer", "line.wkt", "out.gpkg", "--radius", "1", "--colour")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--colour", done.stderr)
        self.assertEqual(self.files(), ["line.wkt"])

    def test_missing_radius(self):
        self.fail_with(2, "--radius is required; see `krepl buffer --help`", "buffer", "line.wkt", "out.gpkg")

    def test_missing_output(self):
        self.fail_with(2, "OUT is required; see `krepl buffer --help`", "buffer", "line.wkt", "--radius", "1")

    def test_radii_that_are_none(self):
        remedy = "give a finite number greater than zero, in the unit of the coordinates"
        for text, wrong in (("0", "is zero"), ("-0.0", "is zero"), ("nan", "is not finite"),
                            ("inf", "is not finite"), ("five", "is not a number"), ("5m", "is not a number"),
                            (" ", "is not a number"), ("1e999", "is out of the range of numbers")):
            with self.subTest(radius=text):
                self.fail_with(2, f"--radius '{text}' {wrong}; {remedy}", "buffer", "line.wkt", "out.gpkg",
                               f"--radius={text}")

    def test_negative_radius_as_a_separate_word(self):
        done = self.krepl("buffer", "line.wkt", "out.gpkg", "--radius", "-5")
        self.assertEqual(done.returncode, 2)
        self.assertIn("a negative radius shrinks polygons, but there is a line, feature 1", done.stderr)

    def test_one_bad_radius_among_good_ones(self):
        done = self.krepl("buffer", "line.wkt", "out.gpkg", "--radius", "1,,2")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--radius '' is not a number", done.stderr)

    def test_max_error(self):
        self.fail_with(2, "--max-error '0' is zero; give a finite number greater than zero, in the unit of the coordinates",
                       "buffer", "line.wkt", "out.geojson", "--radius", "1", "--max-error", "0", output="out.geojson")

    def test_max_error_below_rounding(self):
        self.fail_with(2, "out.geojson: --max-error is too small for the radius; give at least 1e-12 of the radius",
                       "buffer", "line.wkt", "out.geojson", "--radius", "1", "--max-error", "1e-14", output="out.geojson")

    def test_unknown_format(self):
        formats = "give --format gpkg, fgb, wkt, wkb, geojson, shp, svg, dxf or the name of a GDAL vector driver"
        self.fail_with(2, f"out.gpkg: unknown format 'docx'; {formats}",
                       "buffer", "line.wkt", "out.gpkg", "--radius", "1", "--format", "docx")
        self.fail_with(2, f"out.docx: the extension .docx belongs to no known format; {formats}",
                       "buffer", "line.wkt", "out.docx", "--radius", "1", output="out.docx")
        self.fail_with(2, f"out: the format of a file without extension is not known; {formats}",
                       "buffer", "line.wkt", "out", "--radius", "1", output="out")

    def test_binary_format_to_standard_output(self):
        self.fail_with(2, "-: format gpkg cannot go to standard output; choose wkt, geojson, svg or dxf, or name a file",
                       "buffer", "line.wkt", "-", "--radius", "1", "--format", "gpkg")

    def test_unknown_engine(self):
        self.fail_with(2, "engine 'magic' is unknown; give --engine auto, intervals, voronoi or sweep",
                       "buffer", "line.wkt", "out.gpkg", "--radius", "1", "--engine", "magic")

    def test_threads(self):
        for count in ("0", "-1", "many"):
            done = self.krepl("buffer", "line.wkt", "out.gpkg", "--radius", "1", "--threads", count)
            self.assertEqual(done.returncode, 2, count)
            self.assertIn("--threads", done.stderr)

    def test_quiet_and_verbose_exclude_each_other(self):
        self.assertEqual(self.krepl("buffer", "line.wkt", "out.gpkg", "--radius", "1", "--quiet", "--verbose").returncode, 2)

    def test_quiet_prints_nothing(self):
        done = self.succeed("buffer", "line.wkt", "out.geojson", "--radius", "1", "--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_summary_and_verbose(self):
        done = self.succeed("buffer", "line.wkt", "out.gpkg", "--radius", "1")
        self.assertRegex(done.stdout, r"^1 segments; radius 1: 1 rings, 0 holes, 2 arcs, area 23\.14159265; \d+\.\d{3} s\n$")
        self.assertEqual(done.stderr, "")
        done = self.succeed("buffer", "line.wkt", "out.gpkg", "--radius", "1", "--verbose")
        for word in ("read ", "cleaning ", "zone ", "predicates ", "write "):
            self.assertIn(word, done.stderr)


if __name__ == "__main__":
    support.main()
