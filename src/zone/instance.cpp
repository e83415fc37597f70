#include "zone/instance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernel/parallel.hpp"

namespace krepl::zone {
namespace {

/// A fixed hash of the coordinates (the finaliser of MurmurHash3), so that equal vertices move alike in every tile.
std::uint64_t mix(std::uint64_t h) {
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}

/// In [-1, 1).
double fraction(std::uint64_t h) { return double(std::int64_t(h)) * 0x1p-63; }

}  // namespace

Instance::Instance(const Network& network, double nominal_radius, double radius, double resolution,
                   const Context& context)
    : vertices_(network.vertices()),
      segments_(network.segments()),
      nominal_radius_(nominal_radius),
      radius_(radius),
      least_radius_(radius),
      enlargement_(radius - nominal_radius),
      nominal_condition_(4 * (radius - nominal_radius) / resolution),
      extent_(network.extent()),
      jitter_(std::max(0x1p-72 * network.extent(), 0x1p-88 * radius)) {  // well above what 113 bits resolve
  find_shape(context);
}

Instance::Instance(const Network& network, const VariedSites& sites, double enlargement, double resolution,
                   const Context& context)
    : vertices_(sites.vertices),
      segments_(sites.segments),
      radii_(sites.radius),
      nominal_radius_(sites.most),
      radius_(sites.most + enlargement),
      least_radius_(sites.least + enlargement),
      enlargement_(enlargement),
      nominal_condition_(4 * enlargement / resolution),
      extent_(network.extent()),
      jitter_(std::max(0x1p-72 * network.extent(), 0x1p-88 * sites.most)) {
  find_shape(context);
}

Instance::Instance(const Instance& other, double nominal_radius, double radius, double resolution)
    : vertices_(other.vertices_),
      segments_(other.segments_),
      nominal_radius_(nominal_radius),
      radius_(radius),
      least_radius_(radius),
      enlargement_(radius - nominal_radius),
      nominal_condition_(4 * (radius - nominal_radius) / resolution),
      extent_(other.extent_),
      jitter_(other.jitter_),
      shape_(other.shape_) {}

Vector<double> Instance::move(Index vertex) const {
  const Point p = vertices_[vertex];
  // + 0.0 turns -0 into 0: equal coordinates must have equal bits.
  const std::uint64_t h = mix(std::bit_cast<std::uint64_t>(p.x + 0.0) +
                              0x9e3779b97f4a7c15ULL * mix(std::bit_cast<std::uint64_t>(p.y + 0.0)));
  return {jitter_ * fraction(h), jitter_ * fraction(mix(h + 1))};
}

Vector<quad> Instance::moved(Index vertex) const {
  const Point p = vertices_[vertex];
  const Vector<double> by = move(vertex);
  return {quad(p.x) + quad(by.x), quad(p.y) + quad(by.y)};
}

bool Instance::turns_left(Index at, Index from, Index to) const {
  const auto d = difference<double>(from, at), e = difference<double>(to, at);
  const double cross = d.x * e.y - d.y * e.x;
  const double span_d = std::abs(d.x) + std::abs(d.y), span_e = std::abs(e.x) + std::abs(e.y);
  const double error = 0x1p-50 * span_d * span_e + 4 * jitter_ * (span_d + span_e) + 4 * jitter_ * jitter_;
  if (std::abs(cross) > error) return cross > 0;
  const auto dq = difference<quad>(from, at), eq = difference<quad>(to, at);
  const quad cross_q = dq.x * eq.y - dq.y * eq.x;
  return cross_q != 0 ? cross_q > 0 : from < to;
}

/// All directions lie in an open half-plane iff there is a last one, counter-clockwise of all others, and a first one;
/// then the gap from the last to the first is above 180 degrees. O(degree).
Instance::Sector Instance::find_sector(Index v, std::span<const Index> outgoing) const {
  const auto head = [&](Index side) { return ends(side).to; };
  Index last = outgoing[0], first = outgoing[0];
  for (const Index side : outgoing.subspan(1)) {
    if (turns_left(v, head(last), head(side))) last = side;
    if (turns_left(v, head(side), head(first))) first = side;
  }
  for (const Index side : outgoing) {
    if (side != last && !turns_left(v, head(side), head(last))) return {none, none};
    if (side != first && !turns_left(v, head(first), head(side))) return {none, none};
  }
  return {last ^ 1u, first};
}

void Instance::find_shape(const Context& context) {
  const std::size_t n = vertices_.size();
  auto shape = std::make_shared<Shape>();
  shape->sectors.assign(n, Sector{none, none});
  std::vector<Index> begin(n + 1, 0), outgoing(2 * segments_.size());
  for (const auto s : segments_) ++begin[s.a], ++begin[s.b];
  Index total = 0;
  for (Index& b : begin) total += b, b = total;  // ends of the buckets; filling moves them to the starts
  for (Index s = Index(segments_.size()); s-- > 0;) {
    outgoing[--begin[segments_[s].a]] = 2 * s;
    outgoing[--begin[segments_[s].b]] = 2 * s + 1;
  }
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, n, 1 << 14, [&](std::size_t from, std::size_t to) {
    for (std::size_t v = from; v < to; ++v) {
      const std::span<const Index> around(outgoing.data() + begin[v], begin[v + 1] - begin[v]);
      shape->sectors[v] = around.empty() ? Sector{circle(Index(v)), circle(Index(v))} : find_sector(Index(v), around);
    }
  });
  for (std::size_t v = 0; v < n; ++v) {
    if (begin[v] == begin[v + 1]) shape->isolated.push_back(Index(v));
  }
  shape_ = std::move(shape);
}

}  // namespace krepl::zone
