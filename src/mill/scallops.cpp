#include "mill/scallops.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::mill {
namespace {

constexpr int samples = 8;  // of a cross-section, for each pass distance of its length

class Gap {
 public:
  Gap(DriveCurve& curve, const PassLayout& layout, const PassLayout::Pass& a, const ScallopOptions& options)
      : curve_(curve), layout_(layout), a_(a), o_(options) {}

  /// Sections `sections` of the gap between the lines `low` and `high` lattice steps left of pass a.
  void refine(std::int64_t low, std::int64_t high, std::vector<std::int64_t> sections, int level, ExtraPasses& out) {
    std::vector<std::int64_t> bad;
    for (const std::int64_t i : sections)
      if (height(i, low, high) > o_.height) bad.push_back(i);
    out.sections += sections.size();
    if (bad.empty()) return;
    const std::int64_t middle = low + (high - low) / 2;
    if (level == o_.levels || middle == low) {
      out.remaining += bad.size();
      return;
    }
    refine(low, middle, bad, level + 1, out);
    add_passes(middle, bad, out);
    refine(middle, high, bad, level + 1, out);
  }

  std::int64_t spacing() const { return std::max<std::int64_t>(1, std::int64_t(o_.every / layout_.step)); }

 private:
  PassLayout::Pass at(std::int64_t n, std::int64_t first, std::int64_t last) const {
    return {a_.i0 - n * layout_.q, a_.j0 + n * layout_.p, first, last, false};
  }

  /// A pass over each run of neighbouring sections, and one section more on both sides.
  void add_passes(std::int64_t n, const std::vector<std::int64_t>& bad, ExtraPasses& out) const {
    for (std::size_t k = 0; k < bad.size();) {
      std::size_t end = k;
      while (end + 1 < bad.size() && bad[end + 1] - bad[end] <= 3 * spacing()) ++end;
      out.passes.push_back(at(n, std::max(a_.first, bad[k] - spacing()), std::min(a_.last, bad[end] + spacing())));
      k = end + 1;
    }
  }

  /// What is left at most in a cross-section.
  double height(std::int64_t i, std::int64_t low, std::int64_t high) {
    const PassLayout::Pass from = at(low, 0, 0);
    const double length = std::hypot(double(layout_.p), double(layout_.q));
    const Line line{layout_.lattice.place(from.i0 + i * layout_.p, from.j0 + i * layout_.q),
                    {-double(layout_.q) / length, double(layout_.p) / length}};
    runs_.clear();
    const double width = double(high - low) * layout_.step;
    curve_.trace(line, 0, width, true, runs_);
    if (runs_.empty()) return 0;
    const CurveRun& run = runs_.front();
    double worst = 0;
    for (std::size_t v = 0; v + 1 < run.size(); ++v) {
      const double dt = run[v + 1].t - run[v].t, dz = run[v + 1].z - run[v].z, piece = std::hypot(dt, dz);
      if (piece == 0) continue;
      const CurvePoint normal{-dz / piece, dt / piece};
      const int n = std::max(1, int(std::min(1e4, std::ceil(piece / width * samples))));
      for (int k = 0; k <= n; ++k) {
        const CurvePoint c{run[v].t + dt * k / n, run[v].z + dz * k / n};
        worst = std::max(worst, std::min(above(c, normal, run.front()), above(c, normal, run.back())));
      }
    }
    return worst;
  }

  /// Above the point touched from c, up to the ball at a.
  double above(CurvePoint c, CurvePoint normal, CurvePoint a) const {
    const double dt = a.t - c.t, dz = a.z - c.z;
    const double along = std::max(0.0, dt * normal.t + dz * normal.z);  // the true normal leans out of the section
    const double across = std::min(dt * dt + dz * dz, o_.radius * o_.radius);
    return along + o_.radius - std::sqrt(o_.radius * o_.radius - across);
  }

  DriveCurve& curve_;
  const PassLayout& layout_;
  const PassLayout::Pass& a_;
  const ScallopOptions& o_;
  std::vector<CurveRun> runs_;
};

}  // namespace

ExtraPasses find_extra_passes(DriveCurve& curve, const PassLayout& layout, const PassLayout::Pass& a,
                              const PassLayout::Pass& b, const ScallopOptions& options) {
  ExtraPasses out;
  // Lattice steps from a to b, to the left.
  const std::int64_t squared = layout.p * layout.p + layout.q * layout.q;
  const std::int64_t n = ((b.j0 - a.j0) * layout.p - (b.i0 - a.i0) * layout.q) / squared;
  Gap gap(curve, layout, a, options);
  std::vector<std::int64_t> sections;
  for (std::int64_t i = a.first; i <= a.last; i += gap.spacing()) sections.push_back(i);
  gap.refine(0, n, std::move(sections), 0, out);
  return out;
}

}  // namespace krepl::mill
