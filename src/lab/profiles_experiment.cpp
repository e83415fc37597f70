// Section 2.3: the extremal terrains of the plane.
#include <fmt/format.h>

#include "krepl/profile.hpp"
#include "lab/chart.hpp"
#include "lab/drawing.hpp"
#include "lab/experiments.hpp"
#include "lab/profiles.hpp"

namespace krepl::lab {

namespace {

constexpr std::size_t largest_drawing = 200;  // segments
constexpr ProfileConstruction (*makers[])(std::size_t) = {convex_chain, bowl, pit};

std::string csv_of(const std::vector<Point>& terrain) {
  std::string text = "x,z\n";
  for (const Point& p : terrain) text += fmt::format("{},{}\n", p.x, p.y);
  return text;
}

}  // namespace

Result<Report> profiles_experiment(const std::vector<std::size_t>& n, const Context& context) {
  Report report;
  report.name = "profiles";
  report.table.columns = {"kind", "n", "radius", "vertices", "expected", "explicit", "expected_explicit"};
  Chart chart{"2D terrains of n segments", "n", "vertices", {}};
  for (const auto make : makers) {
    Chart::Series series;
    for (const std::size_t segments : n) {
      if (segments < 2 || segments > 10'000'000)
        return Error{ErrorCode::usage, fmt::format("n = {} is out of range", segments), "",
                     "give numbers of segments from 2 to 10000000"};
      const ProfileConstruction c = make(segments);
      const Result<Profile> profile = compute_profile(c.terrain, c.radius, context);
      if (!profile) return profile.error();
      const ProfileVertexCounts counts = count_profile_vertices(c.terrain, profile->pieces);
      if (counts.all != c.vertices || counts.explicit_ones != c.explicit_ones)
        return Error{ErrorCode::computation,
                     fmt::format("{} of {} segments has {} vertices, {} of them explicit; expected {} and {}", c.name,
                                 segments, counts.all, counts.explicit_ones, c.vertices, c.explicit_ones),
                     "", "report this with the version of krepl"};
      report.table.rows.push_back({std::string(c.name), whole(segments), c.radius, whole(counts.all), whole(c.vertices),
                                   whole(counts.explicit_ones), whole(c.explicit_ones)});
      report.exhibits.push_back({fmt::format("{}-{}.csv", c.name, segments), csv_of(c.terrain)});
      if (segments == n.front() && segments <= largest_drawing) {
        const std::string title =
            fmt::format("{}, n = {}: {} vertices, {} explicit", c.name, segments, counts.all, counts.explicit_ones);
        report.exhibits.push_back({fmt::format("{}-{}.svg", c.name, segments), svg_of(*profile, title)});
      }
      series.name = c.name;
      series.points.push_back({double(segments), double(counts.all)});
    }
    report.findings.push_back(fmt::format("{}: {}, at every n", series.name, make(2).what));
    chart.series.push_back(std::move(series));
  }
  report.exhibits.push_back({"profiles.svg", svg_of(chart)});
  return report;
}

}  // namespace krepl::lab
