#include "river/river_case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kernel/orientation.hpp"

namespace krepl::test {
namespace {

using Index = RiverNetwork::Index;

struct Before {
  bool operator()(Point p, Point q) const { return p.x != q.x ? p.x < q.x : p.y < q.y; }
};

struct Segment {
  Point a, b;
};

double distance(Point p, Point q) { return std::hypot(p.x - q.x, p.y - q.y); }

/// In long double: what is measured is as small as the rounding of coordinates.
double distance_to(Point p, const Segment& s) {
  using Long = long double;
  const Long dx = Long(s.b.x) - s.a.x, dy = Long(s.b.y) - s.a.y, x = Long(p.x) - s.a.x, y = Long(p.y) - s.a.y;
  const Long square = dx * dx + dy * dy, t = square == 0 ? 0 : std::clamp((x * dx + y * dy) / square, Long(0), Long(1));
  return double(std::hypot(x - t * dx, y - t * dy));
}

bool meet_wrongly(const Segment& s, const Segment& t) {
  using kernel::orientation;
  if (orientation(s.a, s.b, t.a) * orientation(s.a, s.b, t.b) < 0 &&
      orientation(t.a, t.b, s.a) * orientation(t.a, t.b, s.b) < 0) {
    return true;
  }
  const auto inside = [](const Segment& u, Point p) {
    return p != u.a && p != u.b && orientation(u.a, u.b, p) == 0 && std::min(u.a.x, u.b.x) <= p.x &&
           p.x <= std::max(u.a.x, u.b.x) && std::min(u.a.y, u.b.y) <= p.y && p.y <= std::max(u.a.y, u.b.y);
  };
  return inside(s, t.a) || inside(s, t.b) || inside(t, s.a) || inside(t, s.b) || (s.a == t.a && s.b == t.b) ||
         (s.a == t.b && s.b == t.a);
}

std::vector<Segment> segments_of(std::span<const Point> line) {
  std::vector<Segment> result;
  for (std::size_t i = 1; i < line.size(); ++i) result.push_back({line[i - 1], line[i]});
  return result;
}

/// Components of the graph of all segments, and its faces as cycles of half-edges: V - E + F = 2 for each component
/// that is drawn without crossings.
void check_euler(const std::vector<Segment>& segments) {
  std::map<Point, std::vector<Point>, Before> around;
  for (const Segment& s : segments) {
    around[s.a].push_back(s.b);
    around[s.b].push_back(s.a);
  }
  for (auto& [at, others] : around) {
    const Point center = at;
    std::sort(others.begin(), others.end(), [center](Point p, Point q) {
      const auto upper = [&](Point r) { return r.y > center.y || (r.y == center.y && r.x > center.x); };
      return upper(p) != upper(q) ? upper(p) : kernel::orientation(center, p, q) > 0;
    });
  }
  std::set<std::pair<std::pair<double, double>, std::pair<double, double>>> seen;
  const auto key = [](Point p, Point q) { return std::pair{std::pair{p.x, p.y}, std::pair{q.x, q.y}}; };
  long faces = 0, components = 0;
  for (const auto& [start, others] : around) {
    for (Point first : others) {
      Point p = start, q = first;
      if (!seen.insert(key(p, q)).second) continue;
      ++faces;
      do {  // turn to the next neighbour clockwise: the face on the left
        const auto& next = around.at(q);
        const auto back = std::find(next.begin(), next.end(), p);
        const Point r = back == next.begin() ? next.back() : *(back - 1);
        p = q, q = r;
      } while (seen.insert(key(p, q)).second);
    }
  }
  std::set<Point, Before> visited;
  for (const auto& [start, others] : around) {
    if (!visited.insert(start).second) continue;
    ++components;
    std::vector<Point> open{start};
    while (!open.empty()) {
      const Point p = open.back();
      open.pop_back();
      for (Point q : around.at(p)) {
        if (visited.insert(q).second) open.push_back(q);
      }
    }
  }
  EXPECT_EQ(long(around.size()) - long(segments.size()) + faces, 2 * components);
}

void check_sub_river(const RiverNetwork& rivers, Index s, double error) {
  const RiverNetwork::SubRiver& river = rivers.sub_rivers()[s];
  const std::vector<Point> line = rivers.sub_river_line(s);
  EXPECT_EQ(line.front(), rivers.nodes()[river.from].at);
  EXPECT_EQ(line.back(), rivers.nodes()[river.to].at);
  double length = 0;
  for (const Segment& segment : segments_of(line)) length += distance(segment.a, segment.b);
  EXPECT_NEAR(length, river.length, error + 1e-12 * length);
  const std::set<Point, Before> distinct(line.begin(), line.end());
  EXPECT_EQ(distinct.size(), line.size() - (river.from == river.to ? 1 : 0));
  Index node = river.from;  // downstream from reach to reach
  for (Index r : rivers.reaches_of(s)) {
    EXPECT_EQ(rivers.reaches()[r].from, node);
    EXPECT_EQ(rivers.reaches()[r].sub_river, s);
    node = rivers.reaches()[r].to;
  }
  EXPECT_EQ(node, river.to);
  const RiverNetwork::Node &start = rivers.nodes()[river.from], &end = rivers.nodes()[river.to];
  const bool closes = rivers.reaches()[rivers.reaches_of(s).front()].closes_cycle;
  EXPECT_TRUE(start.in == 0 || start.out > 1 || closes || rivers.report().cycle_reaches > 0);
  EXPECT_TRUE(end.out == 0 || end.in > 1 || closes || rivers.report().cycle_reaches > 0);
}

}  // namespace

Network network_of(const RiverLines& lines) {
  Network::Builder builder;
  for (std::size_t i = 0; i < lines.size(); ++i) builder.add_line(lines[i], std::int64_t(i));
  auto network = std::move(builder).build();
  EXPECT_TRUE(network.ok());
  return std::move(*network);
}

RiverLines grid_lines(std::mt19937_64& random) {
  RiverLines lines(1 + random() % 6);
  const unsigned size = 2 + unsigned(random() % 6);
  for (auto& line : lines) {
    const std::size_t count = 2 + random() % 5;
    for (std::size_t i = 0; i < count; ++i) line.push_back({double(random() % size), double(random() % size)});
    if (random() % 5 == 0) line.push_back(line.front());
    if (random() % 8 == 0) lines.front() = line;
  }
  return lines;
}

RiverLines free_lines(std::mt19937_64& random) {
  const Point offset = random() % 2 == 0 ? Point{} : Point{500000, 5000000};
  RiverLines lines(2 + random() % 6);
  for (auto& line : lines) {
    const std::size_t count = 2 + random() % 5;
    for (std::size_t i = 0; i < count; ++i) {
      line.push_back({offset.x + double(random() % 100000) / 1000, offset.y + double(random() % 100000) / 1000});
    }
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {  // confluences
    if (random() % 2 == 0) lines[i].back() = lines[i - 1][random() % lines[i - 1].size()];
  }
  return lines;
}

void check_rivers(const RiverNetwork& rivers, const RiverLines& lines, bool digitised, double error) {
  std::vector<Segment> input, pieces;
  for (const auto& line : lines) {
    const auto part = segments_of(line);
    input.insert(input.end(), part.begin(), part.end());
  }
  std::vector<std::uint32_t> in(rivers.nodes().size(), 0), out(rivers.nodes().size(), 0);
  double total = 0;
  for (Index r = 0; r < rivers.reaches().size(); ++r) {
    const RiverNetwork::Reach& reach = rivers.reaches()[r];
    const auto line = rivers.reach_line(r);
    ASSERT_GE(line.size(), 2u);
    EXPECT_EQ(line.front(), rivers.nodes()[reach.from].at);
    EXPECT_EQ(line.back(), rivers.nodes()[reach.to].at);
    ++out[reach.from], ++in[reach.to];
    total += reach.length;
    const auto part = segments_of(line);
    pieces.insert(pieces.end(), part.begin(), part.end());
  }
  for (Index n = 0; n < rivers.nodes().size(); ++n) {
    EXPECT_EQ(rivers.nodes()[n].in, in[n]);
    EXPECT_EQ(rivers.nodes()[n].out, out[n]);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size(); ++j) EXPECT_FALSE(meet_wrongly(pieces[i], pieces[j]));
    // Each piece is on an input segment, and the input is on the pieces: no piece is longer than what it comes from.
    const auto carries = [&](const Segment& s) {
      const double along =
          (s.b.x - s.a.x) * (pieces[i].b.x - pieces[i].a.x) + (s.b.y - s.a.y) * (pieces[i].b.y - pieces[i].a.y);
      return distance_to(pieces[i].a, s) <= error && distance_to(pieces[i].b, s) <= error && (!digitised || along > 0);
    };
    EXPECT_TRUE(std::any_of(input.begin(), input.end(), carries));
  }
  for (const Segment& s : input) {
    if (s.a == s.b) continue;
    for (int k = 0; k <= 16; ++k) {
      const Point p{s.a.x + (s.b.x - s.a.x) * k / 16, s.a.y + (s.b.y - s.a.y) * k / 16};
      EXPECT_TRUE(
          std::any_of(pieces.begin(), pieces.end(), [&](const Segment& t) { return distance_to(p, t) <= error; }));
    }
  }
  check_euler(pieces);
  const RiverReport& report = rivers.report();
  if (report.ends_to_lines + report.ends_to_vertices == 0 && error < 1e-6) {
    EXPECT_NEAR(total, report.input_length - report.duplicate_length, 1e-9 * report.input_length);
  }
  std::size_t members = 0;
  for (Index s = 0; s < rivers.sub_rivers().size(); ++s) {
    check_sub_river(rivers, s, error);
    members += rivers.reaches_of(s).size();
  }
  EXPECT_EQ(members, rivers.reaches().size());
}

}  // namespace krepl::test
