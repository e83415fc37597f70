#include "voronoi/extract.hpp"

#include "kernel/parallel.hpp"
#include "zone/crossing.hpp"

namespace krepl::voronoi {
namespace {

/// Links over which the boundary comes into their face.
class Entrances {
 public:
  Entrances(const Diagram& d, const Instance& in) : d_(d), in_(in), radius_(in.radius()) {}

  std::vector<Entry> find(const Context& context) const {
    constexpr std::size_t block = 1 << 14;
    std::vector<std::vector<Entry>> parts((d_.face_count() + block - 1) / block);
    Context quiet;
    quiet.threads = context.threads;
    kernel::parallel_blocks(quiet, d_.face_count(), block, [&](std::size_t from, std::size_t to) {
      for (Index f = Index(from); f < to; ++f) find_entries(f, parts[from / block]);
    });
    std::vector<Entry> entries;
    for (const auto& part : parts) entries.insert(entries.end(), part.begin(), part.end());
    return entries;
  }

 private:
  double end_clearance(Index i) const { return d_.clearance[d_.vertex[i]]; }
  bool is_closed(Index f) const { return !in_.is_side(f) && in_.sector(in_.vertex_of(f)).before == f; }

  /// Along the border: outside the radius it is "above". A link is below somewhere if its minimum is.
  void find_entries(Index f, std::vector<Entry>& out) const {
    const Index first = d_.begin[f], last = d_.begin[f + 1];
    if (first == last) {  // a lonely vertex in an empty plane
      if (in_.is_side(f) || !is_closed(f)) return;
      out.push_back({f, none, none});
      return;
    }
    const std::size_t before = out.size();
    Index open = none;  // entered, not yet left
    Index early_exit = none;
    for (Index i = first; i < last; ++i) {
      if (d_.minimum[i] > radius_) continue;
      // It comes down to the radius or starts below it.
      if (open != none) {
        out.push_back({f, open, i});
        open = none;
      } else if (is_closed(f) && out.size() == before && early_exit == none && starts_above(f, i)) {
        early_exit = i;
      }
      if (end_clearance(i) > radius_) open = i;
    }
    if (open != none) out.push_back({f, open, early_exit});  // only around an isolated vertex
    if (open == none && out.size() == before && early_exit == none && is_closed(f) && !any_below(f))
      out.push_back({f, none, none});
  }
  bool starts_above(Index f, Index i) const {
    const Index previous = i > d_.begin[f] ? i - 1 : d_.begin[f + 1] - 1;
    return end_clearance(previous) > radius_;
  }
  bool any_below(Index f) const {
    for (Index i = d_.begin[f]; i < d_.begin[f + 1]; ++i) {
      if (d_.minimum[i] <= radius_) return true;
    }
    return false;
  }

  const Diagram& d_;
  const Instance& in_;
  double radius_;
};

class Tracer {
 public:
  Tracer(const Diagram& d, const Instance& in, std::vector<Entry> entries)
      : d_(d), in_(in), entries_(std::move(entries)) {}

  Result<zone::Rings> rings(const Context& context) {
    if (!is_sound())
      return Error{ErrorCode::computation, "the Voronoi diagram is not sound at this radius", "",
                   "please report this input"};
    zone::Rings rings;
    std::vector<char> done(entries_.size(), 0);
    std::vector<Index> from;  // per piece: the face it comes from
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      for (std::size_t k = i; !done[k]; k = following(k)) {
        done[k] = 1;
        rings.element.push_back(entries_[k].face);
        from.push_back(entries_[k].link == none ? entries_[k].face : d_.label[entries_[k].link]);
        if (entries_[k].link == none) break;
      }
      if (rings.element.size() > rings.begin.back()) rings.begin.push_back(Index(rings.element.size()));
    }
    rings.vertex.resize(from.size());
    Context quiet;
    quiet.threads = context.threads;
    kernel::parallel_blocks(quiet, from.size(), 1 << 12, [&](std::size_t first, std::size_t last) {
      for (std::size_t e = first; e < last; ++e) rings.vertex[e] = zone::crossing(in_, from[e], rings.element[e]);
    });
    return rings;
  }

 private:
  /// Every piece enters and leaves by a link that has a face behind it, where another piece continues.
  bool is_sound() const {
    for (std::size_t k = 0; k < entries_.size(); ++k) {
      const Entry& e = entries_[k];
      if (e.link == none) continue;
      if (e.exit == none || d_.twin[e.link] == none || d_.twin[e.exit] == none || following(k) == entries_.size())
        return false;
    }
    return true;
  }

  /// The piece that goes on in the face behind the link this one leaves by.
  std::size_t following(std::size_t k) const {
    const Index entered = d_.twin[entries_[k].exit], face = d_.label[entries_[k].exit];
    auto e =
        std::lower_bound(entries_.begin(), entries_.end(), face, [](const Entry& a, Index f) { return a.face < f; });
    while (e != entries_.end() && e->face == face && e->link != entered) ++e;
    if (e == entries_.end() || e->face != face) return entries_.size();
    return std::size_t(e - entries_.begin());
  }

  const Diagram& d_;
  const Instance& in_;
  std::vector<Entry> entries_;
};

}  // namespace

std::vector<Entry> find_entries(const Diagram& diagram, const Instance& instance, const Context& context) {
  return Entrances(diagram, instance).find(context);
}

Result<zone::Rings> extract_rings(const Diagram& diagram, const Instance& instance, const Context& context) {
  return Tracer(diagram, instance, find_entries(diagram, instance, context)).rings(context);
}

}  // namespace krepl::voronoi
