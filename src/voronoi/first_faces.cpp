#include "voronoi/first_faces.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "kernel/budget.hpp"
#include "kernel/pages.hpp"
#include "kernel/parallel.hpp"

namespace krepl::voronoi {
namespace {

constexpr std::size_t block = 1 << 11;  // sites; what a face tells is lost at a block's rim

/// What finished faces of a block tell the others of it.
class Hints {
 public:
  /// `heads`: none for every element of the instance; blocks may share it.
  explicit Hints(std::vector<Index>& heads) : heads_(heads) {}

  void add(Index element, const Hint& hint) {
    entries_.push_back({hint, heads_[element]});
    heads_[element] = Index(entries_.size() - 1);
  }
  std::span<const Hint> of(Index element) {
    told_.clear();
    for (Index i = heads_[element]; i != none; i = entries_[i].next) told_.push_back(entries_[i].hint);
    if (told_.size() > few_hints) std::ranges::stable_sort(told_, {}, &Hint::face);
    return told_;
  }

 private:
  struct Entry {
    Hint hint;
    Index next;
  };
  std::vector<Index>& heads_;
  std::vector<Entry> entries_;
  std::vector<Hint> told_;
};

/// The faces that sites bring along, in double precision, a block of neighbouring sites after the other.
class FirstFaces {
 public:
  FirstFaces(const Sites& sites, const SiteBoxes& boxes, std::uint64_t most_candidates, Borders& borders,
             std::vector<char>& again)
      : budget_(most_candidates),
        sites_(sites),
        in_(sites.instance()),
        boxes_(boxes),
        borders_(borders),
        again_(again),
        heads_(again.size(), none),
        done_(again.size(), 0),
        parts_((in_.site_count() + block - 1) / block) {}

  Status build(const Context& context, DiagramCounters& counters) {
    kernel::Progress progress(context, in_.site_count());
    const bool done = kernel::parallel_blocks(context, in_.site_count(), block, [&](std::size_t from, std::size_t to) {
      build_block(Index(from), Index(to), context);
      progress.add(to - from);
    });
    if (!done || context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    if (budget_.is_exceeded()) {
      return Error{ErrorCode::computation, "too many sites come near the same places of the Voronoi diagram", "",
                   "take another engine, or allow more candidates"};
    }
    std::vector<Index> flat;
    for (Index v = 0; v < in_.vertices().size(); ++v) {
      if (is_flat(v)) flat.push_back(v);
    }
    std::size_t total = 2 * flat.size();
    for (const Part& part : parts_) total += part.links.size();
    kernel::reserve_large(borders_.links, total + total / 4);  // room for faces done again, untouched until it is needed
    kernel::reserve_pages(context, borders_.links, total);
    for (Part& part : parts_) {
      for (const Index e : part.elements) borders_.first[e] += Index(borders_.links.size());
      borders_.links.insert(borders_.links.end(), part.links.begin(), part.links.end());
      counters.candidates += part.counters.candidates;
      counters.searched += part.counters.searched;
      counters.faces += part.elements.size();
      links_.release(part.links);
      part.elements = {};
    }
    for (const Index v : flat) build_flat(v);
    counters.faces += flat.size();
    return std::monostate{};
  }

 private:
  struct Part {
    std::span<const Link> links;
    std::vector<Index> elements;
    FaceCounters counters;
  };

  void build_block(Index from, Index to, const Context& context) {
    Part& part = parts_[from / block];
    std::vector<Link> links;
    FaceBuilder builder(sites_, boxes_);
    Hints hints(heads_);
    std::uint64_t spent = 0;
    const auto build_face = [&](Index e) {
      const std::size_t start = links.size();
      again_[e] = !builder.build(e, hints.of(e), links);
      done_[e] = 1;
      borders_.first[e] = Index(start);
      borders_.count[e] = Index(links.size() - start);
      part.elements.push_back(e);
      if (!again_[e]) tell(e, {links.data() + start, links.size() - start}, from, to, hints);
      budget_.spend(builder.counters.candidates - spent);
      spent = builder.counters.candidates;
    };
    const auto stops = [&] { return context.cancelled() || budget_.is_exceeded(); };
    // Along the lines: a side's neighbours are nearly those of the side before it.
    for (Index s = from; s < to && !stops(); ++s) {
      if (in_.site(s).a == in_.site(s).b) continue;
      for (Index e = 2 * s; e != none && (e >> 1) >= from && (e >> 1) < to && !done_[e]; e = side_after(e))
        build_face(e), build_face(e ^ 1u);
    }
    // Vertices last: sides tell nearly all about them.
    for (Index s = from; s < to && !stops(); ++s) {
      const auto site = in_.site(s);
      for (const Index v : {site.a, site.b}) {
        if (sites_.owner(v) == s && !done_[in_.circle(v)] && !is_flat(v)) build_face(in_.circle(v));
      }
    }
    part.links = links_.keep(links);
    part.counters = builder.counters;
  }

  /// The side that starts where this one ends, on the same side of their line.
  Index side_after(Index side) const {
    const Index corner = sites_.corner(side, 1);
    return corner == none || in_.is_side(corner) ? corner : in_.sector(in_.vertex_of(corner)).after;
  }

  /// Tells the faces of the block that are not yet done what the border of face e says about them.
  void tell(Index e, std::span<const Link> border, Index from, Index to, Hints& hints) const {
    const bool closed = in_.is_side(e) ? false : in_.sector(in_.vertex_of(e)).before == e;
    const std::size_t n = border.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Index label = border[i].label;
      if (label == none || done_[label] || sites_.site_of(label) < from || sites_.site_of(label) >= to) continue;
      const Index before = i > 0 ? border[i - 1].label : closed && n > 1 ? border[n - 1].label : site_itself;
      const Index after = i + 1 < n ? border[i + 1].label : closed && n > 1 ? border[0].label : site_itself;
      hints.add(label, {e, after, before});
    }
  }

  /// The sector of a vertex in a straight line: none in double precision, and its face has no width.
  bool is_flat(Index v) const {
    const auto sector = in_.sector(v);
    if (sector.before == none || !in_.is_side(sector.before)) return false;
    const Vector<double> a = sites_.normal<double>(sector.before), b = sites_.normal<double>(sector.after);
    return dot(a, b) > 0 && std::abs(cross(a, b)) <= 0x1p-50;
  }
  /// Such a face is a perpendicular, up to where that of the side before it ends.
  void build_flat(Index v) {
    const Index e = in_.circle(v);
    const auto sector = in_.sector(v);
    const auto before = borders_.border(sector.before);
    borders_.first[e] = Index(borders_.links.size());
    if (again_[sector.before] || again_[sector.after] || before.size() < 2) {
      borders_.count[e] = 0, again_[e] = 1;
      return;
    }
    const Link top = before[before.size() - 2];
    borders_.count[e] = 2;
    borders_.links.push_back({sector.before, top.clearance, 0, top.end});
    borders_.links.push_back({sector.after, 0, 0, in_.vertices()[v]});
  }

  kernel::Budget budget_;
  const Sites& sites_;
  const Instance& in_;
  const SiteBoxes& boxes_;
  Borders& borders_;
  std::vector<char>& again_;
  std::vector<Index> heads_;
  std::vector<char> done_;
  kernel::Store<Link> links_;
  std::vector<Part> parts_;
};

}  // namespace

Status build_first_faces(const Sites& sites, const SiteBoxes& boxes, std::uint64_t most_candidates, const Context& context,
                         Borders& borders, std::vector<char>& again, DiagramCounters& counters) {
  return FirstFaces(sites, boxes, most_candidates, borders, again).build(context, counters);
}

}  // namespace krepl::voronoi
