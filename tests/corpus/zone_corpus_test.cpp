// Runs every file of tests/corpus/zone, by all three engines: text with one defect each. Header lines:
//   # defect: what is special
//   # radius: R            (several: the file is run with each; `# rings` then belongs to the radius before it)
//   # rings: OUTER HOLES   (known by reasoning; may be left out)
//   # area: A              (closed form; may be left out)
#include <cmath>
#include <optional>
#include <sstream>

#include <gtest/gtest.h>

#include "krepl/sweep.hpp"
#include "krepl/voronoi.hpp"
#include "support/environment.hpp"
#include "support/wkt_file.hpp"
#include "support/zone_comparison.hpp"

namespace krepl::test {
namespace {

struct CorpusRun {
  double radius = 0;
  std::optional<RingCounts> rings;
  std::optional<double> area;
};

struct CorpusFile {
  std::string defect;
  std::vector<CorpusRun> runs;
  std::vector<InputPart> parts;
};

CorpusFile read(const std::filesystem::path& path) {
  CorpusFile file;
  std::istringstream lines(read_text(path));
  for (std::string text; std::getline(lines, text);) {
    if (text.rfind("# ", 0) != 0) continue;
    const auto colon = text.find(':');
    if (colon == std::string::npos) continue;
    const std::string key = text.substr(2, colon - 2);
    std::istringstream value(text.substr(colon + 1));
    if (key == "defect") std::getline(value >> std::ws, file.defect);
    if (key == "radius") file.runs.emplace_back(), value >> file.runs.back().radius;
    if (file.runs.empty()) continue;
    if (key == "rings") {
      file.runs.back().rings.emplace();
      value >> file.runs.back().rings->outer >> file.runs.back().rings->holes;
    }
    if (key == "area") file.runs.back().area.emplace(), value >> *file.runs.back().area;
    if (value.fail()) throw std::runtime_error("bad header: " + text);
  }
  file.parts = read_wkt_file(path);
  return file;
}

/// What the other engines make of the case, where they do not give the same zone.
std::optional<std::string> difference_of_engines(const Zone& zone, const ZoneCase& c) {
  const auto network = std::make_shared<const Network>(*network_of(c));
  const auto by_sweep = compute_zone_by_sweep(network, {c.radius});
  if (!by_sweep) return "sweep: " + by_sweep.error().text();
  if (auto differ = any_difference(zone, *by_sweep)) return "sweep: " + *differ;
  const auto diagram = VoronoiDiagram::build(network);
  if (!diagram) return "diagram: " + diagram.error().text();
  if (c.radius >= diagram->horizon()) return std::nullopt;
  const auto by_diagram = diagram->zone({c.radius});
  if (!by_diagram) return "diagram: " + by_diagram.error().text();
  if (auto wrong = by_diagram->validate()) return "diagram: " + *wrong;
  if (auto differ = difference(zone, *by_diagram)) return "diagram: " + *differ;
  return std::nullopt;
}

TEST(ZoneCorpus, EveryFile) {
  const auto folder = source_directory() / "tests" / "corpus" / "zone";
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".wkt") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  ASSERT_GE(paths.size(), 20u);
  for (const auto& path : paths) {
    const CorpusFile file = read(path);
    SCOPED_TRACE(path.filename().string() + ": " + file.defect);
    EXPECT_FALSE(file.defect.empty());
    EXPECT_FALSE(file.runs.empty());
    for (const CorpusRun& run : file.runs) {
      SCOPED_TRACE("R = " + std::to_string(run.radius));
      const ZoneCase c{file.parts, run.radius};
      const auto zone = zone_of(c);
      EXPECT_TRUE(zone.ok()) << zone.error().text();
      if (!zone.ok()) continue;
      EXPECT_EQ(fault_in(*zone, c, 0.1).value_or("sound"), "sound");
      EXPECT_EQ(difference_of_engines(*zone, c).value_or("none"), "none");
      if (run.rings) {
        EXPECT_EQ(counts(*zone), *run.rings);
      }
      if (run.area) {
        EXPECT_NEAR(zone->area(), *run.area, 1e-9 * *run.area);
      }
    }
  }
}

}  // namespace
}  // namespace krepl::test
