#include "zone/assembly.hpp"

#include <cmath>
#include <cstdio>
#include <string>

#include "kernel/pages.hpp"
#include "kernel/parallel.hpp"
#include "krepl/curve_network.hpp"
#include "zone/precision.hpp"

namespace krepl {

using zone::Index;
using zone::none;

Result<Zone> ZoneAssembly::finish(std::shared_ptr<const Network> network, const zone::Instance& instance,
                                  zone::Rings rings, double resolution, ZoneCounters counters, const Context& context,
                                  std::shared_ptr<const zone::VariedSites> varied) {
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};
  if (context.cancelled()) return cancelled;
  rings = zone::contract(instance, std::move(rings), resolution, context, counters);
  if (network->has_polygons()) rings = zone::drop_rings_inside_polygons(*network, std::move(rings));
  if (context.cancelled()) return cancelled;
  const auto nesting = zone::nest(instance, rings, context);
  if (!nesting) return nesting.error();
  Zone zone = assemble(std::move(network), instance.nominal_radius(), std::move(rings), *nesting, counters, context);
  if (varied) zone.least_radius_ = varied->least;
  zone.varied_ = std::move(varied);
  return zone;
}

Result<Zone> ZoneAssembly::finish(std::shared_ptr<const Network> network, double distance, zone::ShapedRings rings,
                                  double slack, const ZoneCounters& counters, const Context& context) {
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  const auto nesting = zone::nest(rings, std::abs(distance), slack, context);
  if (!nesting) return nesting.error();
  Zone zone;
  zone.radius_ = zone.least_radius_ = std::abs(distance);
  zone.inward_ = distance < 0;
  zone.network_ = std::move(network);
  for (Zone::Piece& p : rings.piece) {
    if (p.radius == 0) p.radius = zone.radius_;
    zone.vertex_.push_back(p.start);
  }
  zone.shaped_ = std::move(rings.piece);
  zone.ring_begin_ = std::move(rings.begin);
  zone.ring_is_hole_ = nesting->is_hole;
  zone.counters_ = counters;
  add_polygons(zone, *nesting);
  add_subdivision(zone, *nesting, context);
  return zone;
}

Result<Zone> ZoneAssembly::finish(std::shared_ptr<const CurveNetwork> curves, double distance, zone::ShapedRings rings,
                                  double slack, const ZoneCounters& counters, const Context& context, double least) {
  auto zone = finish(curves->share_straight(), distance, std::move(rings), slack, counters, context);
  if (!zone) return zone;
  zone->curves_ = std::move(curves);
  if (least > 0) zone->least_radius_ = least;
  return zone;
}

zone::ShapedRings ZoneAssembly::shaped(const Zone& zone) {
  zone::ShapedRings rings;
  rings.begin = zone.ring_begin_;
  rings.piece.reserve(zone.piece_count());
  for (Index e = 0; e < zone.piece_count(); ++e) rings.piece.push_back(zone.local_piece(e));
  return rings;
}

namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", x);
  return text;
}

/// What keeps two zones from having a band between them.
Status check_band(const Zone& inner, const Zone& outer) {
  const auto usage = [](std::string what, std::string remedy) {
    return Error{ErrorCode::usage, std::move(what), "", std::move(remedy)};
  };
  for (const Zone* zone : {&inner, &outer}) {
    if (zone->signed_radius() < 0 || zone->least_radius() < zone->radius() || zone->inner_radius() > 0)
      return usage("a band lies between whole zones of one positive radius each", "compute them so");
    for (Index e = 0; e < zone->piece_count(); ++e) {
      const Zone::Role role = zone->piece(e).role;
      if (role != Zone::Role::offset && role != Zone::Role::bevel)  // there the two borders would run along each other
        return usage("a band lies between zones that go round the ends of lines", "leave out other caps, sides and rings");
    }
  }
  if (&inner.network() != &outer.network() || inner.curves() != outer.curves())
    return usage("a band lies between zones of one network", "compute both of the same one");
  const double least = 0x1p-36 * outer.scale();
  if (!(outer.radius() - inner.radius() > least)) {
    return usage("the radii " + number(inner.radius()) + " and " + number(outer.radius()) +
                     " are too close for a band, or not in ascending order",
                 "let them differ by more than " + number(least));
  }
  return std::monostate{};
}

}  // namespace

Result<Zone> ZoneAssembly::band(const Zone& inner, const Zone& outer, const Context& context) {
  if (Status possible = check_band(inner, outer); !possible) return possible.error();
  const double extent = outer.curves_ ? outer.curves_->extent() : outer.network_->extent();
  const auto precision = zone::precision_for(extent, outer.network_->resolution(), inner.radius_, outer.radius_);
  if (!precision) return precision.error();
  zone::ShapedRings rings = shaped(outer);
  const Index outer_pieces = rings.begin.back();
  const zone::ShapedRings hollow = zone::reversed(shaped(inner));
  rings.piece.insert(rings.piece.end(), hollow.piece.begin(), hollow.piece.end());
  for (std::size_t r = 1; r < hollow.begin.size(); ++r) rings.begin.push_back(hollow.begin[r] + outer_pieces);
  rings.clockwise = outer.ring_is_hole_;
  for (const bool is_hole : inner.ring_is_hole_) rings.clockwise.push_back(!is_hole);
  const double slack = 2 * (precision->effective_radius - outer.radius_);
  auto band = finish(outer.network_, outer.radius_, std::move(rings), slack, outer.counters_, context);
  if (!band) return band.error();
  band->curves_ = outer.curves_;
  band->inner_radius_ = inner.radius_;
  band->outer_pieces_ = outer_pieces;
  return band;
}

Result<Zone> zone_band(const Zone& inner, const Zone& outer, const Context& context) {
  return ZoneAssembly::band(inner, outer, context);
}

Zone ZoneAssembly::assemble(std::shared_ptr<const Network> network, double radius, zone::Rings rings,
                            const zone::Nesting& nesting, const ZoneCounters& counters, const Context& context) {
  Zone zone;
  zone.radius_ = zone.least_radius_ = radius;
  zone.network_ = std::move(network);
  zone.vertex_ = std::move(rings.vertex);
  zone.element_ = std::move(rings.element);
  zone.ring_begin_ = std::move(rings.begin);
  zone.ring_is_hole_ = nesting.is_hole;
  zone.counters_ = counters;
  add_polygons(zone, nesting);
  add_subdivision(zone, nesting, context);
  return zone;
}

/// Polygons in the order of their outer rings, holes in ring order.
void ZoneAssembly::add_polygons(Zone& zone, const zone::Nesting& nesting) {
  const Index rings = Index(zone.ring_count());
  std::vector<Index> polygon_of(rings, none);
  for (Index r = 0; r < rings; ++r) {
    if (nesting.is_hole[r]) continue;
    polygon_of[r] = Index(zone.polygon_outer_.size());
    zone.polygon_outer_.push_back(r);
  }
  auto& begin = zone.polygon_hole_begin_;
  begin.assign(zone.polygon_outer_.size() + 1, 0);
  for (Index r = 0; r < rings; ++r) {
    if (nesting.is_hole[r]) ++begin[polygon_of[nesting.parent[r]] + 1];
  }
  for (std::size_t p = 0; p + 1 < begin.size(); ++p) begin[p + 1] += begin[p];
  zone.polygon_hole_.resize(begin.back());
  std::vector<Index> place(begin.begin(), begin.end() - 1);
  for (Index r = 0; r < rings; ++r) {
    if (nesting.is_hole[r]) zone.polygon_hole_[place[polygon_of[nesting.parent[r]]]++] = r;
  }
}

/// Faces: 0 the unbounded one, then one per ring, the one on the ring's inner side: the polygon itself for an outer ring, the
/// open space for a hole.
void ZoneAssembly::add_subdivision(Zone& zone, const zone::Nesting& nesting, const Context& context) {
  Subdivision& s = zone.subdivision_;
  const std::size_t pieces = zone.piece_count();
  const Index rings = Index(zone.ring_count());
  s.vertex_count = pieces;
  for (std::vector<Index>* array : {&s.origin, &s.next, &s.face}) kernel::resize_pages(context, *array, 2 * pieces);
  s.face_outer.assign(rings + 1, none);

  // The face on the far side of a ring: for a hole its polygon, for an outer ring the hole around it or face 0.
  const auto around = [&](Index r) { return nesting.parent[r] == none ? 0 : nesting.parent[r] + 1; };
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, rings, 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t r = from; r < to; ++r) {
      const Index first = zone.ring_begin_[r], last = zone.ring_begin_[r + 1];
      const bool hole = nesting.is_hole[r];
      const Index inner = Index(r) + 1, outer = around(Index(r));
      for (Index e = first; e < last; ++e) {
        const Index following = e + 1 < last ? e + 1 : first, previous = e > first ? e - 1 : last - 1;
        s.origin[2 * e] = e;
        s.origin[2 * e + 1] = following;
        s.next[2 * e] = 2 * following;
        s.next[2 * e + 1] = 2 * previous + 1;
        s.face[2 * e] = hole ? outer : inner;  // the zone
        s.face[2 * e + 1] = hole ? inner : outer;
      }
      s.face_outer[inner] = 2 * first + (hole ? 1 : 0);
    }
  });
  s.face_inner_begin.assign(rings + 2, 0);
  for (Index r = 0; r < rings; ++r) ++s.face_inner_begin[around(r) + 1];
  for (Index f = 0; f <= rings; ++f) s.face_inner_begin[f + 1] += s.face_inner_begin[f];
  s.face_inner.resize(rings);
  std::vector<Index> place(s.face_inner_begin.begin(), s.face_inner_begin.end() - 1);
  for (Index r = 0; r < rings; ++r) {
    s.face_inner[place[around(r)]++] = 2 * zone.ring_begin_[r] + (nesting.is_hole[r] ? 0 : 1);
  }
}

}  // namespace krepl
