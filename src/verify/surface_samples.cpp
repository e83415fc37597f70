// Checks at random places: the ball is let down there by brute force, and what it touches is compared with the face
// above.
#include <algorithm>
#include <unordered_map>

#include "verify/edge_map.hpp"

namespace krepl::verify {

namespace {

using Index = SurfaceCase::Index;

struct SampleTallies {
  Tally label, height;
  std::uint64_t near_curves = 0, undecided = 0, nothing = 0;
  void add(const SampleTallies& t) {
    label.add(t.label), height.add(t.height);
    near_curves += t.near_curves, undecided += t.undecided, nothing += t.nothing;
  }
};

class Sampler {
 public:
  Sampler(const SurfaceCase& surface, const EdgeMap& map) : surface_(surface), map_(map), box_(surface.solid.box()) {
    box_.grow(1.05 * surface.radius);
    order_.resize(surface.key.size());
    for (Index f = 0; f < order_.size(); ++f) order_[f] = f;
    std::sort(order_.begin(), order_.end(), [&](Index a, Index b) { return surface.key[a] < surface.key[b]; });
  }

  void sample(std::size_t i, SampleTallies& sum) const {
    const Space<double> q = place(i);
    const double tie = 1e-12 * surface_.scale;
    std::vector<Solid::Touch> touches;
    std::vector<Index> faces;
    surface_.solid.lower(q.x, q.y, surface_.radius, tie, touches);
    map_.locate(q.x, q.y, faces);
    sum.nothing += touches.empty();
    sum.near_curves += faces.size() > 1;
    const Vec where(q.x, q.y);
    Index label = SurfaceCase::none;
    bool known = touches.empty();
    for (const Solid::Touch& touch : touches) {
      label = number_of(touch.feature);
      if (label == SurfaceCase::none) continue;
      known = true;
      if (located(label, faces)) break;
    }
    if (known && located(label, faces)) {
      sum.label.add(0, surface_.tolerance, where);
      if (!touches.empty()) sum.height.add(off_height(label, q, touches[0].height), tie, where);
      return;
    }
    // What is nearer to a boundary than the tolerance may be on either side, and a face that is as thin may be missing.
    double off = map_.distance(q.x, q.y, surface_.radius, [](Index) { return true; });
    if (off > surface_.tolerance) off = known ? distance_to_label(q, label) : surface_.radius;
    sum.undecided += off <= surface_.tolerance;
    sum.label.add(off, surface_.tolerance, where);
  }

 private:
  /// Half of the places anywhere, half beside edges, as far from them as they are long, so that small faces are met
  /// too.
  Space<double> place(std::size_t i) const {
    Random random(surface_.seed + 3, i);
    const auto unit = [&] { return double(random.unit()); };
    if (i % 2 == 0 || surface_.file.edges.empty())
      return {box_.low[0] + unit() * (box_.high[0] - box_.low[0]), box_.low[1] + unit() * (box_.high[1] - box_.low[1]),
              0};
    const std::size_t e = random.below(surface_.file.edges.size());
    const std::uint64_t first = surface_.file.edges[e].first, count = surface_.file.points_end(e) - first;
    const Space<double> p = surface_.point(first + random.below(count));
    const double size =
        length(surface_.point(first + count - 1) - surface_.point(first + count / 2)) * std::pow(2, -8 * unit());
    return {p.x + size * (2 * unit() - 1), p.y + size * (2 * unit() - 1), 0};
  }

  Index number_of(const FeatureKey& key) const {
    const auto at = std::lower_bound(order_.begin(), order_.end(), key,
                                     [&](Index f, const FeatureKey& k) { return surface_.key[f] < k; });
    return at != order_.end() && surface_.key[*at] == key ? *at : SurfaceCase::none;
  }

  bool located(Index label, const std::vector<Index>& faces) const {
    return std::any_of(faces.begin(), faces.end(), [&](Index f) { return surface_.label(f) == label; });
  }

  double distance_to_label(Space<double> q, Index label) const {
    return map_.distance(q.x, q.y, surface_.radius,
                         [&](Index e) { return surface_.left_label(e) == label || surface_.right_label(e) == label; });
  }

  /// How far the ball at the brute-force height is from touching the face's feature.
  double off_height(Index label, Space<double> q, long double height) const {
    const Space<Quad> c(Quad(q.x), Quad(q.y), Quad(height));
    return std::abs(double(length(c - foot_on(surface_.shape[label], c).at) - Quad(surface_.radius)));
  }

  const SurfaceCase& surface_;
  const EdgeMap& map_;
  Box3 box_;
  std::vector<Index> order_;  ///< features by their keys
};

}  // namespace

std::vector<Check> check_samples(const SurfaceCase& surface) {
  const EdgeMap map(surface);
  const Sampler sampler(surface, map);
  const auto sum = tally_all<SampleTallies>(surface.context, surface.samples,
                                            [&](std::size_t i, SampleTallies& t) { sampler.sample(i, t); });
  Check label = sum.label.check("what the ball touches", surface.tolerance);
  label.note = std::to_string(sum.near_curves) + " between chord and curve, " + std::to_string(sum.undecided) +
               " undecided, " + std::to_string(sum.nothing) + " touch nothing";
  return {label, sum.height.check("height where it touches", 1e-12L * Real(surface.scale))};
}

}  // namespace krepl::verify
