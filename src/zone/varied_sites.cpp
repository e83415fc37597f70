#include "zone/varied_sites.hpp"

#include <algorithm>

#include "model/part_segments.hpp"

namespace krepl::zone {
namespace {

struct Widths {
  std::vector<double> segment;  // the largest radius of the parts that have it
  std::vector<double> point;    // per vertex: the largest of the parts that are nothing but this vertex; 0: none
};

Widths widths(const Network& network, std::span<const double> part_radii) {
  Widths w{std::vector<double>(network.segments().size(), 0), std::vector<double>(network.vertices().size(), 0)};
  for (Index p = 0; p < network.part_count(); ++p) {
    const double r = part_radii[p];
    bool is_point = true;
    for_each_segment_of(network, p, [&](Index u, Index v) {
      is_point = false;
      double& width = w.segment[find_segment(network, u, v)];
      width = std::max(width, r);
    });
    double& width = w.point[network.part(p)[0]];
    if (is_point) width = std::max(width, r);
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
