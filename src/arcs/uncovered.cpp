#include "arcs/uncovered.hpp"

#include <algorithm>
#include <array>

#include "arcs/intervals.hpp"
#include "kernel/parallel.hpp"

namespace krepl::arcs {
namespace {

using kernel::Box;

Body<double> rounded(const Body<quad>& body, double scale) {
  Body<double> out;
  const auto round = [](Vector<quad> v) { return Vector<double>{double(v.x), double(v.y)}; };
  for (int k = 0; k < body.count; ++k) {
    const auto& b = body.border[std::size_t(k)];
    const bool fine = body.count > 1 && double(length(b.q - b.p)) < 0x1p-40 * scale;
    out.add({b.arc, b.clockwise, b.key, round(b.p), round(b.q), round(b.c), double(b.radius), fine});
  }
  return out;
}

/// The same for covering others, where only lines and circles count: those that are short beside the body would be
/// turned by rounding, and are made longer.
Body<double> lengthened(Body<quad> body, double scale) {
  double extent = 0;
  for (int k = 0; k < body.count; ++k)
    extent = std::max(extent, double(length(body.border[std::size_t(k)].p - body.border[0].p)));
  for (int k = 0; k < body.count; ++k) {
    auto& b = body.border[std::size_t(k)];
    const Vector<quad> d = b.q - b.p;
    const double l = double(length(d));
    if (b.arc || !(l > 0) || l > extent / 8) continue;
    const quad more = extent / l;
    b.p = b.p - more * d, b.q = b.q + more * d;
  }
  return rounded(body, scale);
}

/// Holds the places of a border between two parameters.
template <class Real>
Box box_of(const Border<Real>& b, const Path<Real>& path, double from, double to, double margin) {
  Box box;
  const auto add = [&](Vector<Real> v) { box.add(Point{double(v.x), double(v.y)}); };
  if (b.arc && to - from > 0.5) {  // long stretches: the whole circle
    add({b.c.x - b.radius, b.c.y - b.radius});
    add({b.c.x + b.radius, b.c.y + b.radius});
  } else {
    const auto p = path.at(from), q = path.at(to);
    add(p), add(q);
    if (b.arc) margin += double(dot(q - p, q - p) / b.radius);  // more than the arc's height
  }
  return {box.min_x - margin, box.min_y - margin, box.max_x + margin, box.max_y + margin};
}

class Worker {
 public:
  Worker(const Bodies& bodies, const std::vector<Body<double>>& own, const std::vector<Body<double>>& rounded,
         const kernel::BoxTree& tree)
      : bodies_(bodies), own_(own), rounded_(rounded), tree_(tree), error_(0x1p-44 * bodies.scale()) {}

  void examine(Index body, std::vector<Uncovered>& out, ZoneCounters& counters) {
    const int count = rounded_[body].count;
    for (int k = 0; k < count; ++k) {
      ++counters.elements;
      if (is_covered(body, k, counters)) {
        ++counters.elements_in_double;
        continue;
      }
      ++counters.elements_in_quadruple;
      examine_closely(body, k, out);
    }
  }

 private:
  struct Open {
    double low, high;
  };

  /// By bodies shrunk by what rounding and the moves may amount to. Leaves in candidates_ what may cover the rest.
  bool is_covered(Index body, int k, ZoneCounters& counters) {
    candidates_.clear(), used_.clear();
    if (bodies_.is_vast(body) || own_[body].border[std::size_t(k)].fine) {
      const Body<quad> own = bodies_.moved(body);
      const Border<quad>& border = own.border[std::size_t(k)];
      const Path<quad> path(border);
      // Long as its radius is, a border of a vast circle is short in angle; a fine one is short anyhow.
      collect(body, box_of(border, path, 0, double(path.end()), 4 * error_));
      counters.candidates += candidates_.size();
      return false;
    }
    const Border<double>& border = own_[body].border[std::size_t(k)];
    const Path<double> path(border);
    open_.assign(1, {0, path.end()});
    for (const Index other : recent_)
      if (other != none && other != body && subtract(path, other)) return true;
    for (int look = 0; look < 6; ++look) {  // what covers the middle of the largest stretch left
      const auto widest = std::max_element(
          open_.begin(), open_.end(), [](const Open& a, const Open& b) { return a.high - a.low < b.high - b.low; });
      const auto p = path.at((widest->low + widest->high) / 2);
      const Open before = *widest;
      bool progress = false, all = false;
      tree_.visit_meeting({p.x, p.y, p.x, p.y}, [&](std::size_t other) {
        if (all || progress || other == body) return;
        ++counters.candidates;
        all = subtract(path, Index(other));
        progress = all || std::none_of(open_.begin(), open_.end(),
                                       [&](const Open& o) { return o.low == before.low && o.high == before.high; });
        if (progress) remember(Index(other));
      });
      if (all) return true;
      if (!progress) break;
    }
    for (const Open o : open_) collect(body, box_of(border, path, o.low, o.high, 4 * error_));
    sort_unique(candidates_);
    for (const Index other : candidates_) {
      ++counters.candidates;
      if (subtract(path, other)) return true;
    }
    leave_out_far(path);
    return false;
  }
  void collect(Index body, const Box& box) {
    tree_.visit_meeting(box, [&](std::size_t other) {
      if (other != body) candidates_.push_back(Index(other));
    });
  }
  /// What stays is looked at in quadruple precision; bodies that certainly miss it are left out.
  void leave_out_far(const Path<double>& path) {
    std::size_t kept = 0;
    for (const Index other : candidates_) {
      bool meets = bodies_.is_vast(other);
      if (!meets) {
        stretches_.clear();
        path.covered_by(rounded_[other], 2 * error_, stretches_);
        meets = std::any_of(stretches_.begin(), stretches_.end(), [&](const Stretch<double>& s) {
          return std::any_of(open_.begin(), open_.end(),
                             [&](const Open& o) { return s.high >= o.low && s.low <= o.high; });
        });
      }
      if (meets) candidates_[kept++] = other;
    }
    candidates_.resize(kept);
    candidates_.insert(candidates_.end(), used_.begin(), used_.end());
    sort_unique(candidates_);
  }
  static void sort_unique(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  bool subtract(const Path<double>& path, Index other) {
    if (bodies_.is_vast(other)) return false;
    stretches_.clear();
    path.covered_by(rounded_[other], -2 * error_, stretches_);
    for (const Stretch<double>& s : stretches_) {
      for (std::size_t i = 0; i < open_.size();) {
        const Open o = open_[i];
        if (s.high <= o.low || s.low >= o.high) {
          ++i;
          continue;
        }
        if (used_.empty() || used_.back() != other) used_.push_back(other);
        if (s.low <= o.low && s.high >= o.high) {
          open_.erase(open_.begin() + std::ptrdiff_t(i));
        } else if (s.low <= o.low) {
          open_[i++].low = s.high;
        } else if (s.high >= o.high) {
          open_[i++].high = s.low;
        } else {
          open_[i].high = s.low;
          open_.insert(open_.begin() + std::ptrdiff_t(i) + 1, {s.high, o.high});
          i += 2;
        }
      }
    }
    return open_.empty();
  }

  void remember(Index body) {
    if (std::find(recent_.begin(), recent_.end(), body) != recent_.end()) return;
    std::rotate(recent_.begin(), recent_.end() - 1, recent_.end());
    recent_[0] = body;
  }

  struct Cover {
    quad low, high;
    BorderId low_border, high_border;
  };

  void examine_closely(Index body, int k, std::vector<Uncovered>& out) {
    const Body<quad> own = bodies_.moved(body);
    const Border<quad>& border = own.border[std::size_t(k)];
    const Path<quad> path(border);
    const bool closed = border.arc && own.count == 1;
    const BorderId self = border_id(body, k);
    const BorderId before = closed ? self : border_id(body, (k + own.count - 1) % own.count);
    const BorderId after = closed ? self : border_id(body, (k + 1) % own.count);
    covers_.clear();
    for (const Index other : candidates_) {
      precise_.clear();
      path.covered_by(bodies_.moved(other), quad(0), precise_);
      for (const Stretch<quad>& s : precise_) {
        // -1: the border's own end lies in the other body.
        covers_.push_back({s.low_border < 0 ? quad(-1) : s.low, s.high_border < 0 ? path.end() + 1 : s.high,
                           s.low_border < 0 ? before : border_id(other, s.low_border),
                           s.high_border < 0 ? after : border_id(other, s.high_border)});
      }
    }
    std::sort(covers_.begin(), covers_.end(), [](const Cover& a, const Cover& b) {
      return a.low != b.low ? a.low < b.low : a.low_border < b.low_border;
    });
    quad reached = 0;
    BorderId from = before;
    const auto add = [&](quad high, BorderId to) {
      out.push_back({self, from, to, path.at(reached), path.at(high), border.arc ? double(high - reached) : 0});
    };
    for (const Cover& c : covers_) {
      if (c.low > reached) add(c.low, c.low_border);
      if (c.high > reached) reached = c.high, from = c.high_border;
    }
    if (reached < path.end()) add(path.end(), after);
  }

  const Bodies& bodies_;
  const std::vector<Body<double>>& own_;      // as paths
  const std::vector<Body<double>>& rounded_;  // as what covers
  const kernel::BoxTree& tree_;
  double error_;
  std::array<Index, 8> recent_{none, none, none, none, none, none, none, none};
  std::vector<Open> open_;
  std::vector<Index> candidates_, used_;
  std::vector<Stretch<double>> stretches_;
  std::vector<Stretch<quad>> precise_;
  std::vector<Cover> covers_;
};

}  // namespace

std::vector<Uncovered> uncovered_stretches(const Bodies& bodies, const Context& context, ZoneCounters& counters) {
  constexpr std::size_t block = 1 << 8;
  const std::size_t n = bodies.count();
  std::vector<Body<double>> own(n), all(n);
  std::vector<Box> boxes(n);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, n, block, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Body<quad> body = bodies.moved(Index(i));
      own[i] = rounded(body, bodies.scale());
      all[i] = lengthened(body, bodies.scale());
      boxes[i] = bodies.box(Index(i));
    }
  });
  const kernel::BoxTree tree(std::move(boxes));
  struct Part {
    std::vector<Uncovered> stretches;
    ZoneCounters counters;
  };
  std::vector<Part> parts((n + block - 1) / block);
  kernel::Progress progress(context, n);
  const bool done = kernel::parallel_blocks(context, n, block, [&](std::size_t first, std::size_t last) {
    Part& part = parts[first / block];
    Worker worker(bodies, own, all, tree);
    for (std::size_t i = first; i < last && !context.cancelled(); ++i)
      worker.examine(Index(i), part.stretches, part.counters);
    progress.add(last - first);
  });
  std::vector<Uncovered> result;
  if (!done || context.cancelled()) return result;
  for (Part& p : parts) {
    result.insert(result.end(), p.stretches.begin(), p.stretches.end());
    counters.elements += p.counters.elements;
    counters.candidates += p.counters.candidates;
    counters.elements_in_double += p.counters.elements_in_double;
    counters.elements_in_quadruple += p.counters.elements_in_quadruple;
  }
  return result;
}

}  // namespace krepl::arcs
