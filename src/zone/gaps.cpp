#include "zone/gaps.hpp"

#include <algorithm>

namespace krepl::zone {

template <class Real>
void Gaps<Real>::start(Index element, Real end, Real error, Index start_label, Index end_label) {
  element_ = element;
  const Real far = 16 * end + 16;
  covers_.clear();
  covers_.push_back({{-far, Real(0), none, true}, {Real(0), error, start_label, true}, none});
  covers_.push_back({{end, error, end_label, true}, {end + far, Real(0), none, true}, none});
  open_.assign(1, {-error, end + error});
}

template <class Real>
bool Gaps<Real>::subtract(const Cover<Real>& cover) {
  covers_.push_back(cover);
  const Real low = cover.low.at + cover.low.error, high = cover.high.at - cover.high.error;
  if (!(low < high)) return false;  // also when an error is not a number
  for (std::size_t i = 0; i < open_.size();) {
    const Stretch g = open_[i];
    if (high <= g.low || low >= g.high) {
      ++i;
    } else if (low <= g.low && high >= g.high) {
      open_.erase(open_.begin() + std::ptrdiff_t(i));
    } else if (low <= g.low) {
      open_[i++].low = high;
    } else if (high >= g.high) {
      open_[i++].high = low;
    } else {
      open_[i].high = low;
      open_.insert(open_.begin() + std::ptrdiff_t(i) + 1, {high, g.high});
      i += 2;
    }
  }
  return open_.empty();
}

namespace {

/// Whether a boundary element met by the cigar of `site` lies behind another one, `label`, met at the same place as far as the
/// numbers tell, for reasons of incidence alone: there the two differ by less than any precision can see.
bool hides(const Instance& in, Index by, Index site, Index label) {
  if (by == none || label == none || site == none || by == label) return false;
  if (!in.is_side(label)) {
    // A cigar contains the disks at its ends, and touches them from outside where it meets the element by its side.
    const auto s = in.site(site);
    const Index vertex = in.vertex_of(label);
    return s.a == vertex || s.b == vertex;
  }
  if (!in.is_side(by)) return false;
  // Two segments folded onto each other at a common vertex: the outer one in the order around the vertex.
  const auto p = in.ends(by), q = in.ends(label);
  if (p.from == q.from) return in.turns_left(p.from, p.to, q.to);
  if (p.to == q.to) return in.turns_left(p.to, q.from, p.from);
  return false;
}

}  // namespace

template <class Real>
Index Gaps<Real>::boundary_label(const Instance& instance, Side side) const {
  const auto& met = side == Side::left ? left_ : right_;
  const auto end = [&](const Cover<Real>* c) -> const CoverEnd<Real>& { return side == Side::left ? c->high : c->low; };
  const auto hidden = [&](const Cover<Real>* c) {
    return std::any_of(met.begin(), met.end(), [&](const Cover<Real>* o) {
      return end(o).label_certain && hides(instance, end(o).label, o->site, end(c).label);
    });
  };
  Index found = none;
  for (const Cover<Real>* c : met) {
    if (!end(c).label_certain) return none;
    if (end(c).label == found || hidden(c)) continue;
    if (found != none || end(c).label == none) return none;
    found = end(c).label;
  }
  return found;
}

template <class Real>
typename Gaps<Real>::Outcome Gaps<Real>::find(const Instance& instance, std::vector<Piece>& out) const {
  if (open_.empty()) return Outcome::covered;
  const std::size_t before = out.size();
  for (const Stretch& g : open_) {
    left_.clear();
    right_.clear();
    Real left_end = g.low, right_end = g.high;
    bool certain = true;
    for (const Cover<Real>& c : covers_) {
      const Real low = c.low.at - c.low.error, high = c.high.at + c.high.error;
      if (high < g.low || low > g.high) continue;
      if (low <= g.low && high < g.high) {
        left_.push_back(&c);
        left_end = std::max(left_end, high);
      } else if (high >= g.high && low > g.low) {
        right_.push_back(&c);
        right_end = std::min(right_end, low);
      } else {
        certain = false;  // may cover all of the gap, or a part in its midst, or its errors are not numbers
      }
    }
    const Index from = certain && left_end < right_end ? boundary_label(instance, Side::left) : none;
    const Index to = from != none ? boundary_label(instance, Side::right) : none;
    if (to == none) {
      out.resize(before);
      return Outcome::uncertain;
    }
    out.push_back({element_, from, to});
  }
  return Outcome::found;
}

template <class Real>
void Gaps<Real>::find_by_value(const Instance& instance, std::vector<Piece>& out) const {
  std::vector<const Cover<Real>*> order;
  for (const Cover<Real>& c : covers_) {
    if (c.low.at < c.high.at) order.push_back(&c);
  }
  std::sort(order.begin(), order.end(), [](const Cover<Real>* c, const Cover<Real>* d) {
    return c->low.at != d->low.at ? c->low.at < d->low.at : c->low.label < d->low.label;
  });
  const Cover<Real>* reached = nullptr;
  for (const Cover<Real>* c : order) {
    if (reached != nullptr && c->low.at > reached->high.at && reached->high.label != none && c->low.label != none) {
      out.push_back({element_, reached->high.label, c->low.label});
    }
    if (reached == nullptr || c->high.at > reached->high.at ||
        (c->high.at == reached->high.at && hides(instance, c->high.label, c->site, reached->high.label))) {
      reached = c;
    }
  }
}

template <class Real>
Real Gaps<Real>::margin() const {
  Real smallest = covers_[1].high.at;
  for (const Stretch& g : open_) {
    smallest = std::min<Real>(smallest, g.high - g.low);
    for (const Cover<Real>& c : covers_) {
      for (const Real end : {c.low.at, c.high.at}) {
        for (const Real edge : {g.low, g.high}) {
          const Real d = kernel::absolute<Real>(end - edge);
          if (d > 4 * (c.low.error + c.high.error)) smallest = std::min<Real>(smallest, d);
        }
      }
    }
  }
  return smallest;
}

template class Gaps<double>;
template class Gaps<quad>;

}  // namespace krepl::zone
