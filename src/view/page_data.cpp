#include "view/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "kernel/vectors.hpp"

namespace krepl::view {

namespace {

constexpr std::size_t most_pieces = std::size_t{1} << 31;

using namespace vectors;

bool finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

struct Arc {
  Point center;
  bool left = true;  ///< counter-clockwise
  double sweep = 0;  ///< angle, (0, 2 pi]
  double radius = 0;
};

/// The circle through three points of an arc. `hole` decides the sense of a full circle, which the points leave open.
Arc arc_through(const input::ResultPiece& piece, bool hole) {
  if (piece.start == piece.end) {
    const Point center{(piece.start.x + piece.middle.x) / 2, (piece.start.y + piece.middle.y) / 2};
    return {center, !hole, 2 * std::numbers::pi, distance(center, piece.start)};
  }
  // Relative to the middle point, where both chords start, so that coordinates far from zero cost no digits.
  const Point a = piece.start - piece.middle, b = piece.end - piece.middle;
  const double area = 2 * cross(b, a);  // > 0: the path start, middle, end turns left
  const double aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y;
  Arc arc;
  arc.left = area > 0;
  const Point offset{(bb * a.y - aa * b.y) / area, (aa * b.x - bb * a.x) / area};
  arc.center = {piece.middle.x + offset.x, piece.middle.y + offset.y};
  arc.radius = std::hypot(offset.x, offset.y);
  // Twice the angle that the chord subtends at the middle point, seen from the other side of the circle.
  arc.sweep = 2 * std::numbers::pi - 2 * std::atan2(std::abs(area) / 2, a.x * b.x + a.y * b.y);
  return arc;
}

bool degenerate(const input::ResultPiece& piece) {
  return piece.start != piece.end && cross(piece.start - piece.middle, piece.end - piece.middle) == 0;
}

/// Adds chains to a layer and keeps its sums.
class LayerBuilder {
 public:
  explicit LayerBuilder(Layer& layer) : layer_(layer) {}

  Status add_ring(const input::ResultRing& ring, bool hole) {
    if (ring.pieces.empty()) return std::monostate{};
    const Point base = ring.pieces.front().start;
    double area = 0;
    for (const input::ResultPiece& piece : ring.pieces) {
      if (!finite(piece.start) || !finite(piece.end) || (piece.arc && !finite(piece.middle)))
        return Error{ErrorCode::input, "a coordinate is not finite", fmt::format("ring {}", layer_.chain_count()), ""};
      layer_.vertices.push_back(piece.start);
      area += cross(piece.start - base, piece.end - base) / 2 + add_piece(piece, hole);
      add_source(piece);
    }
    layer_.vertices.push_back(ring.pieces.back().end);
    close(hole ? ChainKind::hole : ChainKind::outer);
    layer_.area += hole ? -std::abs(area) : std::abs(area);
    if (layer_.kind.size() > most_pieces)
      return Error{ErrorCode::input, "has too many pieces for a page", "", "show a part of it"};
    return std::monostate{};
  }

  void close(ChainKind kind) {
    layer_.chain_kind.push_back(kind);
    layer_.vertex_begin.push_back(static_cast<std::uint32_t>(layer_.vertices.size()));
  }

  void source(Layer::Part part, std::uint32_t vertex) {
    if (layer_.source_part.empty()) layer_.source_part.assign(layer_.kind.size() - 1, Layer::unknown);
    if (layer_.source_vertex.empty()) layer_.source_vertex.assign(layer_.kind.size() - 1, Layer::unknown);
    auto [place, fresh] =
        part_index_.try_emplace({part.feature, part.part}, static_cast<std::uint32_t>(layer_.parts.size()));
    if (fresh) layer_.parts.push_back(part);
    layer_.source_part.push_back(place->second);
    layer_.source_vertex.push_back(vertex);
  }

 private:
  /// Returns the area between the chord and the piece, positive to the chord's right.
  double add_piece(const input::ResultPiece& piece, bool hole) {
    if (!piece.arc || degenerate(piece)) {
      layer_.kind.push_back(PieceKind::segment);
      layer_.perimeter += distance(piece.start, piece.end);
      return 0;
    }
    const Arc arc = arc_through(piece, hole);
    layer_.kind.push_back(arc.left ? PieceKind::arc_left : PieceKind::arc_right);
    layer_.centers.push_back(arc.center);
    layer_.perimeter += arc.radius * arc.sweep;
    const double lens = arc.radius * arc.radius * (arc.sweep - std::sin(arc.sweep)) / 2;
    return arc.left ? lens : -lens;
  }

  void add_source(const input::ResultPiece& piece) {
    const bool known = piece.source_part >= 0 && piece.source_vertex >= 0 && piece.source_vertex < Layer::unknown;
    if (known) {
      source({piece.source_feature, piece.source_part}, static_cast<std::uint32_t>(piece.source_vertex));
    } else if (!layer_.source_part.empty()) {
      layer_.source_part.push_back(Layer::unknown);
      layer_.source_vertex.push_back(Layer::unknown);
    }
  }

  Layer& layer_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::uint32_t> part_index_;
};

Result<Layer> zone_layer(const input::ResultZone& zone) {
  Layer layer;
  layer.role = "zone";
  layer.radius = zone.radius;
  layer.name = !zone.radius                  ? "Zone"
               : zone.inner.value_or(0) > 0 ? fmt::format("Band, R = {} to {}", *zone.inner, *zone.radius)
                                            : fmt::format("Zone, R = {}", *zone.radius);
  LayerBuilder builder(layer);
  for (const input::ResultPolygon& polygon : zone.polygons) {
    if (Status added = builder.add_ring(polygon.outer, false); !added) return added.error();
    for (const input::ResultRing& hole : polygon.holes)
      if (Status added = builder.add_ring(hole, true); !added) return added.error();
    ++layer.polygons;
  }
  return layer;
}

/// A finite y for the lower ends of half-lines, far below everything.
double depth_of(const std::vector<ProfileRow>& rows) {
  double low = INFINITY, high = -INFINITY, left = INFINITY, right = -INFINITY;
  for (const ProfileRow& row : rows)
    for (const Point p : {row.start, row.end}) {
      left = std::min(left, p.x);
      right = std::max(right, p.x);
      if (!std::isfinite(p.y)) continue;
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
  return low - 100 * std::max({right - left, high - low, 1e-300});
}

}  // namespace

std::size_t Layer::count(PieceKind wanted) const {
  return static_cast<std::size_t>(std::count(kind.begin(), kind.end(), wanted));
}
std::size_t Layer::hole_count() const {
  return static_cast<std::size_t>(std::count(chain_kind.begin(), chain_kind.end(), ChainKind::hole));
}

Result<std::vector<Layer>> zone_layers(const std::vector<input::ResultZone>& zones) {
  std::vector<std::size_t> order(zones.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return zones[a].radius.value_or(0) > zones[b].radius.value_or(0);
  });
  std::vector<Layer> layers;
  for (const std::size_t index : order) {
    Result<Layer> layer = zone_layer(zones[index]);
    if (!layer) return layer.error();
    if (layer->chain_count() > 0) layers.push_back(std::move(*layer));
  }
  if (layers.empty()) return Error{ErrorCode::input, "holds no zone", "", ""};
  return layers;
}

Result<Layer> profile_layer(const std::vector<ProfileRow>& rows) {
  if (rows.empty()) return Error{ErrorCode::input, "holds no piece", "", ""};
  if (rows.size() > most_pieces)
    return Error{ErrorCode::input, "has too many pieces for a page", "", "show a part of it"};
  Layer layer;
  layer.role = "profile";
  LayerBuilder builder(layer);
  const double depth = depth_of(rows);
  const auto place = [&](Point p) { return Point{p.x, std::isfinite(p.y) ? p.y : depth}; };
  for (const ProfileRow& row : rows) {
    layer.vertices.push_back(place(row.start));
    if (row.kind == ProfileRow::Kind::arc) {
      const double radius = distance(row.center, row.start);
      if (!layer.radius) layer.radius = radius;
      layer.centers.push_back(row.center);
      layer.kind.push_back(PieceKind::arc_right);
      // The chord's half angle: profiles have no arc beyond a half circle.
      layer.perimeter += 2 * radius * std::asin(std::min(1.0, distance(row.start, row.end) / (2 * radius)));
    } else if (row.kind == ProfileRow::Kind::segment) {
      layer.kind.push_back(PieceKind::segment);
      layer.perimeter += distance(row.start, row.end);
    } else {
      layer.kind.push_back(PieceKind::half_line);
    }
    builder.source({-1, 0}, row.cause < 0 ? Layer::unknown : static_cast<std::uint32_t>(row.cause));
  }
  layer.vertices.push_back(place(rows.back().end));
  builder.close(ChainKind::open);
  layer.name = layer.radius ? fmt::format("Profile, R = {:.10g}", *layer.radius) : "Profile";
  return layer;
}

Layer input_layer(const Network& network) {
  Layer layer;
  layer.role = "input";
  layer.name = "Input";
  LayerBuilder builder(layer);
  const Point origin = network.origin();
  for (std::uint32_t p = 0; p < network.part_count(); ++p) {
    const auto chain = network.part(p);
    Point before;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const Point v = network.vertices()[chain[i]];
      const Point place{origin.x + v.x, origin.y + v.y};
      if (i > 0) {
        layer.kind.push_back(PieceKind::segment);
        layer.perimeter += distance(before, place);
      }
      layer.vertices.push_back(place);
      before = place;
    }
    builder.close(ChainKind::open);
    layer.parts.push_back({network.part_feature(p), p});
  }
  return layer;
}

Layer terrain_layer(const std::vector<Point>& terrain) {
  Layer layer;
  layer.role = "input";
  layer.name = "Terrain";
  layer.vertices = terrain;
  for (std::size_t i = 1; i < terrain.size(); ++i) layer.perimeter += distance(terrain[i - 1], terrain[i]);
  layer.kind.assign(terrain.size() - 1, PieceKind::segment);
  LayerBuilder(layer).close(ChainKind::open);
  layer.parts.push_back({-1, 0});
  return layer;
}

}  // namespace krepl::view
