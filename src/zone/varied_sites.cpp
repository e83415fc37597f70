#include "zone/varied_sites.hpp"

#include <algorithm>

namespace krepl::zone {
namespace {

/// The segment between two different vertices of the network.
Index find_segment(const Network& network, Index u, Index v) {
  const auto segments = network.segments();
  const Network::Segment wanted{std::min(u, v), std::max(u, v)};
  const auto found = std::lower_bound(segments.begin(), segments.end(), wanted, [](const auto& s, const auto& t) {
    return s.a != t.a ? s.a < t.a : s.b < t.b;
  });
  return Index(found - segments.begin());
}

struct Widths {
  std::vector<double> segment;  // the largest radius of the parts that have it
  std::vector<double> point;    // per vertex: the largest of the parts that are nothing but this vertex; 0: none
};

Widths widths(const Network& network, std::span<const double> part_radii) {
  Widths w{std::vector<double>(network.segments().size(), 0), std::vector<double>(network.vertices().size(), 0)};
  for (Index p = 0; p < network.part_count(); ++p) {
    const auto chain = network.part(p);
    const double r = part_radii[p];
    bool is_point = true;
    const auto widen = [&](Index u, Index v) {
      if (u == v) return;
      is_point = false;
      double& width = w.segment[find_segment(network, u, v)];
      width = std::max(width, r);
    };
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) widen(chain[i], chain[i + 1]);
    if (network.part_is_ring(p) && chain.size() > 2) widen(chain.back(), chain.front());
    if (is_point) w.point[chain[0]] = std::max(w.point[chain[0]], r);
  }
  return w;
}

}  // namespace

std::shared_ptr<const VariedSites> vary_sites(const Network& network, std::span<const double> part_radii) {
  const Widths w = widths(network, part_radii);
  const auto segments = network.segments();
  const std::size_t n = network.vertices().size();
  // The radii at each vertex, ascending: its copies.
  std::vector<std::pair<Index, double>> copies;
  copies.reserve(2 * segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    copies.emplace_back(segments[s].a, w.segment[s]);
    copies.emplace_back(segments[s].b, w.segment[s]);
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (w.point[v] > 0) copies.emplace_back(Index(v), w.point[v]);
  }
  std::sort(copies.begin(), copies.end());
  copies.erase(std::unique(copies.begin(), copies.end()), copies.end());

  auto sites = std::make_shared<VariedSites>();
  sites->least = part_radii.front();
  for (const auto& [v, r] : copies) {
    sites->vertices.push_back(network.vertices()[v]);
    sites->radius.push_back(r);
    sites->vertex.push_back(v);
    sites->least = std::min(sites->least, r);
    sites->most = std::max(sites->most, r);
  }
  const auto copy_of = [&](Index v, double r) {
    return Index(std::lower_bound(copies.begin(), copies.end(), std::pair<Index, double>(v, r)) - copies.begin());
  };
  sites->segments.reserve(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    sites->segments.push_back({copy_of(segments[s].a, w.segment[s]), copy_of(segments[s].b, w.segment[s])});
  }
  return sites;
}

}  // namespace krepl::zone
