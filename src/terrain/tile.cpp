#include "terrain/tile.hpp"

#include <algorithm>
#include <numeric>

#include "terrain/curve.hpp"

namespace krepl::terrain {
namespace {

/// Triangles in a tile, about: enough to make the margin of width R around it cheap, few enough for the cache.
constexpr double triangles_a_tile = 4096;

double distance(Point3 p, Point3 q) {
  const double dx = p.x - q.x, dy = p.y - q.y, dz = p.z - q.z;
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

Surface::EdgeKind edge_kind(Meeting meeting) {
  switch (meeting) {
    case Meeting::seam: return Surface::EdgeKind::seam;
    case Meeting::valley: return Surface::EdgeKind::valley;
    case Meeting::rim: break;
  }
  return Surface::EdgeKind::rim;
}

/// Follows the links of a subdivided tile from cell to cell and writes chains.
class ChainWriter {
 public:
  ChainWriter(CellMap& cells, const Envelope<double>& envelope, const Terrain& terrain, Tile& tile)
      : cells_(cells), envelope_(envelope), terrain_(terrain), tile_(tile) {
    line_of_.resize(cells.crossings().size());
    for (Index l = 0; l < cells.lines().size(); ++l) {
      const CellLine& line = cells.lines()[l];
      std::fill_n(line_of_.begin() + line.first_crossing, line.crossing_count, l);
    }
    passed_.assign(line_of_.size(), false);
    region_number_.assign(cells.piece_count(), none);
  }

  void write() {
    leave_out_closed_slivers();
    tile_.vertices.reserve(cells_.vertices().size());
    tile_.arm_begin.reserve(cells_.vertices().size() + 1);
    for (const auto& v : cells_.vertices()) {
      tile_.vertices.push_back(v.at);
      tile_.arm_begin.push_back(v.first_arm);
    }
    tile_.arm_begin.push_back(Index(cells_.arms().size()));
    arm_taken_.assign(cells_.arms().size(), false);
    write_sides();
    for (Index a = 0; a < cells_.arms().size(); ++a) {
      if (arm_taken_[a]) continue;
      const Link arm = cells_.arms()[a];
      follow({ChainEnd::Kind::arm, 0, a}, arm.index(), arm.side());
    }
    for (std::uint8_t s = 0; s < 4; ++s) {
      const CellLine& line = cells_.lines()[s];
      for (Index k = 0; k < line.crossing_count; ++k) {
        if (!passed_[line.first_crossing + k]) follow({ChainEnd::Kind::side, s, k}, line.first_crossing + k, outside(s));
      }
    }
    for (Index c = 0; c < line_of_.size(); ++c) {
      if (!passed_[c]) follow({ChainEnd::Kind::closed, 0, c}, c, 0);
    }
    tile_.chains.shrink_to_fit();
    tile_.guides.shrink_to_fit();
    tile_.region_feature.shrink_to_fit();
  }

 private:
  /// A straight edge cannot cross a line, turn round and come back: where it seems to, rounding made a patch of nothing.
  void leave_out_closed_slivers() {
    const auto& crossings = cells_.crossings();
    for (Index l = 4; l < cells_.lines().size(); ++l) {
      const CellLine& line = cells_.lines()[l];
      for (Index k = 0; k + 1 < line.crossing_count; ++k) {
        const Index c = line.first_crossing + k, d = c + 1;
        const auto &in = crossings[c], &out = crossings[d];
        const auto are_linked = [&](int side) {
          return in.link[side].word == Link::crossing(d, side).word && out.link[side].word == Link::crossing(c, side).word;
        };
        if (out.after != label_before(c) || out.t - in.t > envelope_.tolerance() || !are_linked(0) || !are_linked(1) ||
            !is_straight(c) || !is_straight(d))
          continue;
        passed_[c] = passed_[d] = true;
        cells_.unite(cells_.piece(l, k), cells_.piece(l, k + 1));
      }
    }
  }

  bool is_straight(Index c) const {
    const auto& crossing = cells_.crossings()[c];
    if (crossing.meeting == Meeting::rim) return false;
    const Surface::Edge edge{
        edge_kind(crossing.meeting), Surface::Curve::line, {feature(label_before(c)), feature(crossing.after)}};
    return curve_kind(terrain_, edge) == Surface::Curve::line;
  }

  /// The side of the tile's own side lines that lies outside.
  static int outside(int tile_side) { return tile_side == 1 || tile_side == 2 ? 1 : 0; }

  Index region(Index piece, Index label) {
    Index& number = region_number_[cells_.region(piece)];
    if (number == none) {
      number = Index(tile_.region_feature.size());
      tile_.region_feature.push_back(feature(label));
    }
    return number;
  }
  Index feature(Index label) const { return label == none ? none : envelope_.patches()[label].feature; }
  Index label_before(Index c) const {
    const CellLine& line = cells_.lines()[line_of_[c]];
    return c == line.first_crossing ? line.start_label : cells_.crossings()[c - 1].after;
  }

  void write_sides() {
    for (Index s = 0; s < 4; ++s) {
      const CellLine& line = cells_.lines()[s];
      for (Index k = 0; k <= line.crossing_count; ++k) {
        const Index label = k == 0 ? line.start_label : cells_.crossings()[line.first_crossing + k - 1].after;
        tile_.side_region[s].push_back(region(cells_.piece(s, k), label));
        if (k > 0) tile_.side_crossing[s].push_back(cells_.crossings()[line.first_crossing + k - 1].t);
      }
    }
  }

  /// From crossing c, coming from the cell on the given side of its line.
  void follow(ChainEnd start, Index c, int from) {
    Chain chain{};
    chain.end[0] = start;
    describe(chain, c, from);
    points_.clear();
    const Index first = c;
    while (true) {
      passed_[c] = true;
      const Index line = line_of_[c];
      add_point(c, chain);
      if (line < 4 && from != outside(int(line))) {  // leaves the tile
        chain.end[1] = {ChainEnd::Kind::side, std::uint8_t(line), c - cells_.lines()[line].first_crossing};
        break;
      }
      const Link link = cells_.crossings()[c].link[1 - from];
      if (link.is_vertex()) {
        chain.end[1] = {ChainEnd::Kind::arm, 0, arm_at(link.index(), c, 1 - from)};
        break;
      }
      c = link.index();
      from = link.side();
      if (c == first) {
        chain.end[1] = chain.end[0];
        break;
      }
    }
    for (const ChainEnd& end : chain.end) {
      if (end.kind == ChainEnd::Kind::arm) arm_taken_[end.index] = true;
    }
    keep_guides(chain);
    tile_.chains.push_back(chain);
  }

  /// Labels and regions left and right of the way over crossing c.
  void describe(Chain& chain, Index c, int from) {
    const Index line = line_of_[c], k = c - cells_.lines()[line].first_crossing;
    const auto& crossing = cells_.crossings()[c];
    const Index label[2] = {label_before(c), crossing.after};
    const Index region_of[2] = {region(cells_.piece(line, k), label[0]), region(cells_.piece(line, k + 1), label[1])};
    const int left = cells_.lines()[line].vertical == (from == 0) ? 1 : 0;
    chain.region[0] = region_of[left];
    chain.region[1] = region_of[1 - left];
    chain.lower = 2;
    chain.kind = edge_kind(crossing.meeting);
    upper_ = label[0] == none ? label[1] : label[0];
    Index other = label[0] == none ? label[0] : label[1];
    if (crossing.meeting == Meeting::rim) {
      const Point p = cells_.place(line, crossing);
      if (other != none && envelope_.upper_at_wall(upper_, other, p) == other) std::swap(upper_, other);
      chain.lower = label[left] == upper_ ? 1 : 0;
      other = none;
    }
    // Where edges overlap in one line, their patches are one cylinder, which the end of one of them divides.
    if (chain.kind == Surface::EdgeKind::valley && are_in_one_line(terrain_, feature(upper_), feature(other)))
      chain.kind = Surface::EdgeKind::seam;
    edge_ = {chain.kind, Surface::Curve::line, {feature(upper_), feature(other)}};
    chain.curve = edge_.curve = curve_kind(terrain_, edge_);
  }

  void add_point(Index c, const Chain& chain) {
    const Point p = cells_.place(line_of_[c], cells_.crossings()[c]);
    const bool rim = chain.kind == Surface::EdgeKind::rim;
    const double z = rim ? envelope_.wall_height(upper_, p) : envelope_.clamped_height(upper_, p);
    points_.push_back({p.x, p.y, z});
  }

  Index arm_at(Index vertex, Index crossing, int side) const {
    const auto& v = cells_.vertices()[vertex];
    for (Index a = v.first_arm; a < v.first_arm + v.arm_count; ++a) {
      if (cells_.arms()[a].word == Link::crossing(crossing, side).word) return a;
    }
    return none;
  }

  /// True if the chord between the two ends of an edge tells which part of its curve is meant: the way from the chord's
  /// middle to the curve is short.
  bool chord_tells(Point3 a, Point3 b, double length) const {
    const double radius = envelope_.patches().radius(), chord = distance(a, b);
    if (!(chord > 0) || length > bent * chord) return false;
    if (edge_.kind == Surface::EdgeKind::seam) return chord < radius;  // a circle of that radius, projected from its centre
    const Point3 mid{(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
    return distance(project_to_curve(terrain_, radius, edge_, mid, radius), mid) < 0.05 * chord;
  }

  /// Keeps a few points, if it takes any to tell which part of the curve is meant.
  void keep_guides(Chain& chain) {
    chain.first_guide = Index(tile_.guides.size());
    chain.guide_count = 0;
    const bool open = chain.end[0].kind != ChainEnd::Kind::closed;
    if (open && chain.curve == Surface::Curve::line) return;
    const std::size_t n = points_.size();
    double whole = 0;
    for (std::size_t i = 1; i < n; ++i) whole += distance(points_[i - 1], points_[i]);
    double straight = distance(points_.front(), points_.back());
    if (chain.end[0].kind == ChainEnd::Kind::arm && chain.end[1].kind == ChainEnd::Kind::arm) {
      const Point3 a = vertex_at(chain.end[0].index), b = vertex_at(chain.end[1].index);
      if (goes_nowhere(a, b)) return;
      const double length = distance(a, points_.front()) + whole + distance(points_.back(), b);
      if (chord_tells(a, b, length)) return;
      if (length > bent * distance(a, b)) straight = 0;
    }
    const std::size_t wanted = !open ? 16 : whole > bent * straight ? 5 : 1;
    if (n <= wanted) {
      tile_.guides.insert(tile_.guides.end(), points_.begin(), points_.end());
    } else {
      double run = 0;
      std::size_t next = 0;
      for (std::size_t i = 0; i < n && next < wanted; ++i) {
        if (i > 0) run += distance(points_[i - 1], points_[i]);
        if (run * double(wanted + 1) < whole * double(next + 1) && n - i > wanted - next) continue;
        tile_.guides.push_back(points_[i]);
        ++next;
      }
    }
    chain.guide_count = std::uint8_t(tile_.guides.size() - chain.first_guide);
  }

  /// True if nothing of an edge is told apart from its two ends in the plane, and these not from each other. Beside a
  /// wall heights are known to a root of rounding only, by which it would seem to go up and back.
  bool goes_nowhere(Point3 a, Point3 b) const {
    const double told_apart = 16 * envelope_.thickness();  // 2^-30 S
    return distance(a, b) <= told_apart && std::all_of(points_.begin(), points_.end(), [&](Point3 p) {
             return std::hypot(p.x - a.x, p.y - a.y) <= told_apart;
           });
  }

  Point3 vertex_at(Index arm) const {
    const auto after = std::upper_bound(tile_.arm_begin.begin(), tile_.arm_begin.end(), arm);
    return tile_.vertices[std::size_t(after - tile_.arm_begin.begin()) - 1];
  }

  /// A curve so much longer than its chord needs several guides.
  static constexpr double bent = 1.02;

  CellMap& cells_;
  const Envelope<double>& envelope_;
  const Terrain& terrain_;
  Tile& tile_;
  std::vector<Index> line_of_, region_number_;
  std::vector<bool> passed_, arm_taken_;
  std::vector<Point3> points_;
  Index upper_ = none;     // label of the chain's patch, at a rim the upper one
  Surface::Edge edge_{};   // what the chain is part of; which of the two features is left of it does not matter here
};

}  // namespace

Tiling tiling_for(const Terrain& terrain, double radius) {
  // Odd parts of the margin, so that tile and cell sides run along no line of samples.
  const Point3 low = terrain.lowest(), high = terrain.highest();
  Tiling t;
  t.low = {low.x - 1.0371 * radius, low.y - 1.0439 * radius};
  t.high = {high.x + 1.0391 * radius, high.y + 1.0313 * radius};
  const double width = t.high.x - t.low.x, height = t.high.y - t.low.y;
  const double area = std::max(high.x - low.x, radius) * std::max(high.y - low.y, radius);
  const double size = std::max(std::sqrt(area * triangles_a_tile / double(terrain.triangle_count())), 2 * radius);
  const auto number = [&](double extent) { return Index(std::clamp(std::floor(extent / size + 0.5), 1.0, 4096.0)); };
  t.columns = number(width);
  t.rows = number(height);
  return t;
}

Tile TileWorker::compute(const Terrain& terrain, const Tiling& tiling, Index column, Index row, double radius,
                         double scale, const Context& context) {
  Tile tile;
  const Box box = tiling.box(column, row);
  const double margin = radius * (1 + 1e-9);
  window_.fill(terrain, {box.low.x - margin, box.low.y - margin}, {box.high.x + margin, box.high.y + margin});
  patches_.build(window_, radius);
  tile.counters.patches = patches_.size();
  fine_patches_.refine(window_, patches_);
  Envelope<DoubleDouble> fine_envelope(fine_patches_, scale, tile.counters);
  Envelope<double> envelope(patches_, scale, tile.counters, &fine_envelope);
  CellMap map;
  Cells<DoubleDouble> fine_cells(map, fine_envelope, tile.counters, context);
  Cells<double> cells(map, envelope, tile.counters, context, &fine_cells);
  std::vector<Index> all(patches_.size());
  std::iota(all.begin(), all.end(), Index{0});

  const std::array<Point, 4> corner = box.corners();
  Index label[4];
  for (int i = 0; i < 4; ++i) label[i] = envelope.winner(corner[i], all);
  std::vector<LineCrossing> crossings;
  Cells<double>::Cell whole{box, {}};
  const auto add_side = [&](Index side, bool vertical, double at, double from, double to, Index start, Index end) {
    crossings.clear();
    envelope.section(vertical, at, from, to, start, end, all, crossings);
    map.add_line(vertical, at, start, crossings);
    const Index first = map.lines()[side].first_crossing;
    whole.side[side] = {side, first, first + Index(crossings.size()), start};
  };
  add_side(0, false, box.low.y, box.low.x, box.high.x, label[0], label[1]);
  add_side(1, true, box.high.x, box.low.y, box.high.y, label[1], label[2]);
  add_side(2, false, box.high.y, box.low.x, box.high.x, label[3], label[2]);
  add_side(3, true, box.low.x, box.low.y, box.high.y, label[0], label[3]);
  if (!cells.run(whole, all)) {
    tile.failed_at = map.failed_at;
    return tile;
  }
  ChainWriter(map, envelope, terrain, tile).write();
  return tile;
}

}  // namespace krepl::terrain
