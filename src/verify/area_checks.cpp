// Checks by parallel lines: their lengths inside the zone, from the input's cigars and from the result's boundary.
#include <algorithm>
#include <cstdio>

#include "verify/zone_checks.hpp"

namespace krepl::verify {

namespace {

/// Strips across the lines' direction, with two random lines in each. Where cigars start and end is where lengths jump;
/// for few cigars the strips are cut there, so that nothing thin hides between two lines.
class Strips {
 public:
  explicit Strips(const ZoneCase& zone) : seed_(zone.seed + 2) {
    const auto input = zone.obstacle.heights(), result = zone.boundary.heights();
    const Real low = std::min(input.first - zone.radius, result.first);
    const Real high = std::max(input.second + zone.radius, result.second);
    const std::size_t cigars = zone.obstacle.segments().items().size();
    // A line meets about n 2R / height cigars.
    const Real cost = 50 + Real(cigars) * std::min(Real(1), 2 * zone.radius / (high - low) + 1e-3L);
    const Real count = std::clamp(zone.effort * 2e7L / cost, 100.0L, std::max(100.0L, zone.effort * 20'000.0L));
    std::vector<Real> cuts{low, high};
    if (cigars <= most_cigars_to_cut_at) {
      zone.obstacle.add_ends(zone.radius, cuts);
      if (zone.inner > 0) zone.obstacle.add_ends(zone.inner, cuts);
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    edges_.push_back(low);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const Real gap = cuts[i + 1] - cuts[i];
      const auto pieces = std::max<std::size_t>(1, std::size_t(count * gap / (high - low)));
      for (std::size_t k = 1; k <= pieces; ++k) edges_.push_back(cuts[i] + gap * Real(k) / Real(pieces));
    }
  }
  std::size_t count() const { return edges_.size() - 1; }
  Real height(std::size_t strip) const { return edges_[strip + 1] - edges_[strip]; }
  Real tallest() const {
    Real most = 0;
    for (std::size_t k = 0; k < count(); ++k) most = std::max(most, height(k));
    return most;
  }
  /// Line k = 0, 1 of a strip.
  Real line(std::size_t strip, std::size_t k) const {
    return edges_[strip] + height(strip) * Random(seed_, 2 * strip + k).unit();
  }

 private:
  static constexpr std::size_t most_cigars_to_cut_at = 2000;
  std::uint64_t seed_;
  std::vector<Real> edges_;
};

/// Lengths inside the zone on two lines of each strip, from the input alone.
std::vector<Real> input_lengths(const ZoneCase& zone, const Strips& strips) {
  std::vector<Real> lengths(2 * strips.count());
  tally_all(zone.context, lengths.size(), [&](std::size_t i, Tally&) {
    const Real y = strips.line(i / 2, i % 2);
    lengths[i] = zone.obstacle.section(y, zone.radius) - (zone.inner > 0 ? zone.obstacle.section(y, zone.inner) : 0);
  });
  return lengths;
}

// If the boundary is off by at most e everywhere, the integral of |difference| is at most e times its length in the
// mean; a line that grazes an arc adds sqrt(8 R e) of length over one strip.
Check compare_sections(const ZoneCase& zone, const Strips& strips, const std::vector<Real>& lengths) {
  std::vector<Real> off(lengths.size());
  Tally tally = tally_all(zone.context, off.size(), [&](std::size_t i, Tally& t) {
    off[i] = std::abs(lengths[i] - zone.boundary.section(strips.line(i / 2, i % 2)));
    t.add(off[i], HUGE_VALL, Vec());
  });
  Real integral = 0;
  for (std::size_t i = 0; i < off.size(); ++i) integral += off[i] * strips.height(i / 2) / 2;
  const Real grazing = std::sqrt(8 * zone.radius * zone.deviation) + std::sqrt(8 * zone.inner * zone.deviation);
  const Real limit = 4 * (zone.deviation * zone.boundary.perimeter() + strips.tallest() * grazing);
  char note[80];
  std::snprintf(note, sizeof note, "worst line differs by %.3Lg", tally.worst);
  tally.worst = integral;
  tally.violations = integral <= limit ? 0 : 1;
  Check check = tally.check("area between on lines", limit);
  check.note = note;
  return check;
}

Check compare_areas(const ZoneCase& zone, const Strips& strips, const std::vector<Real>& lengths) {
  // The error of one strip is at most its height times the range of lengths within it. The range is taken over the
  // strip and its neighbours: where the length jumps, two lines of one strip may well lie on the same side of the jump.
  Real area = 0, variance = 0;
  for (std::size_t k = 0; k < strips.count(); ++k) {
    area += (lengths[2 * k] + lengths[2 * k + 1]) / 2 * strips.height(k);
    const auto first = lengths.begin() + std::ptrdiff_t(2 * (k > 0 ? k - 1 : 0));
    const auto last = lengths.begin() + std::ptrdiff_t(2 * std::min(k + 2, strips.count()));
    const auto [least, most] = std::minmax_element(first, last);
    // Beyond the first and the last strip there is nothing.
    const Real range = (k == 0 || k + 1 == strips.count() ? *most : *most - *least) * strips.height(k);
    variance += range * range / 4;
  }
  const Real limit = 6 * std::sqrt(variance) + zone.deviation * zone.boundary.perimeter();
  Tally tally;
  tally.tested = lengths.size();
  tally.worst = std::abs(area - zone.boundary.area());
  tally.violations = tally.worst <= limit ? 0 : 1;
  Check check = tally.check("area by strips", limit);
  char note[80];
  std::snprintf(note, sizeof note, "%.12Lg, standard error %.2Lg", area, std::sqrt(variance));
  check.note = note;
  return check;
}

}  // namespace

std::array<Check, 2> check_areas(const ZoneCase& zone) {
  const Strips strips(zone);
  const std::vector<Real> lengths = input_lengths(zone, strips);
  return {compare_sections(zone, strips, lengths), compare_areas(zone, strips, lengths)};
}

}  // namespace krepl::verify
