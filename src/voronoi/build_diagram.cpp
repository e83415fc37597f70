#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "kernel/pages.hpp"
#include "kernel/parallel.hpp"
#include "voronoi/first_faces.hpp"

namespace krepl::voronoi {
namespace {

constexpr std::size_t block = 1 << 11;
constexpr int most_rounds = 64;

/// Marks, among the given faces, those that disagree with a neighbour, and the neighbour.
void mark_disagreeing(Borders& borders, const std::vector<Index>& faces, const Context& context,
                      std::vector<char>& marked) {
  Context quiet;
  quiet.threads = context.threads;
  borders.remember_twins();
  std::vector<std::vector<Index>> parts((faces.size() + block - 1) / block);
  kernel::parallel_blocks(quiet, faces.size(), block, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const Index face = faces[k];
      for (Index i = borders.first[face]; i < borders.first[face] + borders.count[face]; ++i) {
        if (borders.is_sound(face, i)) continue;
        for (const Index f : {face, borders.links[i].label, borders.before(face, i), borders.after(face, i)}) {
          if (f < site_itself) parts[from / block].push_back(f);
        }
      }
    }
  });
  for (const auto& part : parts) {
    for (const Index face : part) marked[face] = 1;
  }
}

/// Which elements a face borders on, as far as its neighbours know: those on its border, what these say stands beside it
/// on theirs, and what faces that disagree say.
class Neighbours {
 public:
  Neighbours(const Sites& sites, const Borders& borders, std::span<const Index> disagreeing)
      : sites_(sites), borders_(borders) {
    for (const Index f : disagreeing) {
      for (Index i = borders.first[f]; i < borders.first[f] + borders.count[f]; ++i) {
        if (borders.links[i].label != none && borders.twin(f, i) == none) told_.push_back({borders.links[i].label, f, i});
      }
    }
    std::sort(told_.begin(), told_.end());
  }

  void find(Index face, std::vector<Index>& labels) const {
    labels.clear();
    const auto add = [&](Index label) {
      if (label < site_itself && label != face && std::find(labels.begin(), labels.end(), label) == labels.end())
        labels.push_back(label);
    };
    const auto add_around = [&](Index other, Index link) {
      add(other), add(borders_.before(other, link)), add(borders_.after(other, link));
    };
    if (sites_.is_side(face)) add(sites_.corner(face, 0)), add(sites_.corner(face, 1));
    for (const Link& l : borders_.border(face)) {
      if (l.label == none) continue;
      add(l.label);
      for (Index i = borders_.first[l.label]; i < borders_.first[l.label] + borders_.count[l.label]; ++i) {
        if (borders_.links[i].label == face) add_around(l.label, i);
      }
    }
    for (auto t = std::lower_bound(told_.begin(), told_.end(), Told{face, 0, 0}); t != told_.end() && t->face == face; ++t)
      add_around(t->by, t->link);
  }

 private:
  struct Told {
    Index face, by, link;
    friend auto operator<=>(const Told&, const Told&) = default;
  };
  const Sites& sites_;
  const Borders& borders_;
  std::vector<Told> told_;
};

/// How a face is done again: more and more precisely; among the elements that its neighbours tell first, several times,
/// as they may have to be told themselves.
struct Rung {
  FaceBuilder::Precision precision;
  bool searching;
};
constexpr Rung rungs[] = {{FaceBuilder::Precision::plain, true},       {FaceBuilder::Precision::twofold, false},
                          {FaceBuilder::Precision::twofold, false},    {FaceBuilder::Precision::twofold, false},
                          {FaceBuilder::Precision::twofold, true},     {FaceBuilder::Precision::quadruple, true},
                          {FaceBuilder::Precision::widest, true}};
constexpr int first_search = 4;  // in pairs of doubles
constexpr int last_rung = int(std::size(rungs)) - 1;

/// Does the given faces again more precisely; the new borders stand at the end. `disagreeing`: these faces among others.
void build_again(const Sites& sites, const SiteBoxes& boxes, const std::vector<Index>& faces,
                 std::span<const Index> disagreeing, Rung rung, const Context& context, Borders& borders) {
  constexpr std::size_t few = 8;
  struct Part {
    std::vector<Link> links;
    std::vector<Index> count;
  };
  std::vector<Part> parts((faces.size() + few - 1) / few);
  Context quiet;
  quiet.threads = context.threads;
  quiet.cancel = context.cancel;
  std::optional<Neighbours> neighbours;
  if (!rung.searching) neighbours.emplace(sites, borders, disagreeing);
  kernel::parallel_blocks(quiet, faces.size(), few, [&](std::size_t from, std::size_t to) {
    Part& part = parts[from / few];
    FaceBuilder builder(sites, boxes);
    std::vector<Index> labels;
    for (std::size_t k = from; k < to; ++k) {
      const std::size_t start = part.links.size();
      if (rung.searching) {
        builder.build_precisely(faces[k], rung.precision, part.links);
      } else {
        neighbours->find(faces[k], labels);
        builder.build_among(faces[k], labels, rung.precision, part.links);
      }
      part.count.push_back(Index(part.links.size() - start));
    }
  });
  if (context.cancelled()) return;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < parts[p].count.size(); ++k) {
      const Index face = faces[p * few + k];
      borders.first[face] = Index(borders.links.size());
      borders.count[face] = parts[p].count[k];
      borders.links.insert(borders.links.end(), parts[p].links.begin() + std::ptrdiff_t(at),
                           parts[p].links.begin() + std::ptrdiff_t(at + parts[p].count[k]));
      at += parts[p].count[k];
    }
  }
}

Error disagreement(const Sites& sites, Index face) {
  const Instance& in = sites.instance();
  const Point p = in.vertices()[in.is_side(face) ? in.ends(face).from : in.vertex_of(face)];
  return {ErrorCode::computation,
          "the Voronoi diagram could not be certified: face " + std::to_string(face) +
              " and one of its neighbours disagree",
          "near x " + std::to_string(p.x) + ", y " + std::to_string(p.y) + " relative to the data's origin",
          "take the engine intervals"};
}

class Settling {
 public:
  Settling(const Sites& sites, const SiteBoxes& boxes, const Context& context, Borders& borders,
           std::vector<char>& again, DiagramCounters& counters)
      : sites_(sites),
        boxes_(boxes),
        context_(context),
        borders_(borders),
        again_(again),
        counters_(counters),
        rung_(borders.count.size(), 0) {}

  /// Brings all faces to agree. Faces done more precisely are true ones of the moved instance, so they agree
  /// with each other but for links that are too short even for that; what grows from round to round is only the rim
  /// where they meet faces in double precision.
  Status run() {
    std::vector<Index> all(borders_.count.size());
    std::iota(all.begin(), all.end(), 0);
    // What is certainly wrong is searched for again: it may fit together with itself alone.
    const std::vector<Index> wrong = marked([&](Index e) { return again_[e] != 0; });
    look_.assign(rung_.size(), 0);
    if (!wrong.empty()) do_again(wrong, {}, first_search);
    if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    again_.assign(rung_.size(), 0);
    mark_disagreeing(borders_, all, context_, again_);
    for (int round = 0;; ++round) {
      const std::vector<Index> all_marked = marked([&](Index e) { return again_[e] != 0; });
      if (all_marked.empty()) return std::monostate{};
      if (round == most_rounds) return disagreement(sites_, all_marked[0]);
      look_.assign(rung_.size(), 0);
      for (const Index e : all_marked) look_[e] = 1;
      // The least precise first: the others may then agree.
      int rung = 0;
      std::vector<Index> faces;
      for (; rung < last_rung && faces.empty(); ++rung)
        faces = marked([&](Index e) { return again_[e] && rung_[e] == rung; });
      if (faces.empty()) {
        if (!reconcile(all_marked)) return disagreement(sites_, all_marked[0]);
      } else {
        do_again(faces, all_marked, rung);
        if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
      }
      again_.assign(rung_.size(), 0);
      mark_disagreeing(borders_, marked([&](Index e) { return look_[e] != 0; }), context_, again_);
    }
  }

 private:
  template <class Test>
  std::vector<Index> marked(Test&& test) const {
    std::vector<Index> faces;
    for (Index e = 0; e < rung_.size(); ++e) {
      if (test(e)) faces.push_back(e);
    }
    return faces;
  }
  void look_around(Index face) {
    look_[face] = 1;
    for (const Link& l : borders_.border(face)) {
      if (l.label != none) look_[l.label] = 1;
    }
  }
  void do_again(const std::vector<Index>& faces, const std::vector<Index>& disagreeing, int rung) {
    ++counters_.rounds;
    using Precision = FaceBuilder::Precision;
    const Precision precision = rungs[rung].precision;
    if (precision != rungs[rung - 1].precision || disagreeing.empty()) {
      (precision == Precision::twofold     ? counters_.faces_in_pairs
       : precision == Precision::quadruple ? counters_.faces_in_quadruple
                                           : counters_.faces_in_widest) += faces.size();
    }
    for (const Index e : faces) look_around(e);  // those that were neighbours
    build_again(sites_, boxes_, faces, disagreeing, rungs[rung], context_, borders_);
    for (const Index e : faces) look_around(e), rung_[e] = char(rung);
  }
  /// Links far below the accuracy statement that only one of two faces sees are given to the other too, or taken from
  /// the one: the shortest first.
  bool reconcile(const std::vector<Index>& stuck) {
    const double extent = sites_.instance().extent();
    for (const double most : {0x1p-48, 0x1p-36}) {
      if (reconcile(stuck, most * extent, true)) return true;
      for (double size = 0x1p-96; size <= most; size *= 0x1p12) {
        if (reconcile(stuck, size * extent, false)) return true;
      }
    }
    return false;
  }
  bool reconcile(const std::vector<Index>& stuck, double tolerance, bool insert) {
    bool any = false;
    for (const Index face : stuck) {
      for (Index k = 0; k < borders_.count[face]; ++k) {
        const Index link = borders_.first[face] + k, other = borders_.links[link].label;
        if (borders_.is_sound(face, link)) continue;
        look_around(face);
        if (insert ? !borders_.insert_twin(face, link, tolerance) : !borders_.remove_short(face, link, tolerance))
          continue;
        ++counters_.links_reconciled;
        look_around(face);
        if (other != none) look_around(other);
        any = true;
      }
    }
    return any;
  }

  const Sites& sites_;
  const SiteBoxes& boxes_;
  const Context& context_;
  Borders& borders_;
  std::vector<char>& again_;
  DiagramCounters& counters_;
  std::vector<char> rung_, look_;
};

/// Lays the borders out face by face and finds the twins.
Diagram lay_out(const Borders& borders, const Context& context) {
  Diagram d;
  const Index n = Index(borders.count.size());
  d.begin.resize(n + 1);
  Index total = 0;
  for (Index e = 0; e < n; ++e) d.begin[e] = total, total += borders.count[e];
  d.begin[n] = total;
  kernel::resize_pages(context, d.label, total);
  kernel::resize_pages(context, d.twin, total, none);
  kernel::resize_pages(context, d.vertex, total, none);
  kernel::resize_pages(context, d.minimum, total);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, n, block, [&](std::size_t from, std::size_t to) {
    for (Index e = Index(from); e < to; ++e) {
      for (Index k = 0; k < borders.count[e]; ++k) {
        const Index old = borders.first[e] + k, i = d.begin[e] + k;
        d.label[i] = borders.links[old].label;
        const Index twin = borders.twin(e, old);
        if (twin != none) d.twin[i] = d.begin[d.label[i]] + (twin - borders.first[d.label[i]]);
      }
    }
  });
  return d;
}

/// Faces among too few sites that fit together cover the plane as often as they fall apart. O(links).
std::optional<Index> find_apart(const Diagram& d, const Instance& in) {
  std::vector<Index> parent(d.face_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Index f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  for (Index f = 0; f < d.face_count(); ++f) {
    if (in.is_side(f) && (f & 1u)) parent[root(f)] = root(f ^ 1u);  // across the segment
    for (Index i = d.begin[f]; i < d.begin[f + 1]; ++i) {
      if (d.label[i] != none && d.label[i] < f) parent[root(f)] = root(d.label[i]);
    }
  }
  Index first = none;
  for (Index f = 0; f < d.face_count(); ++f) {
    if (!in.is_side(f) && in.sector(in.vertex_of(f)).before == none) continue;  // has none
    if (first == none) first = root(f);
    if (root(f) != first) return f;
  }
  return std::nullopt;
}

}  // namespace

Result<Diagram> build_diagram(const Sites& sites, const SiteBoxes& boxes, std::uint64_t most_candidates,
                              const Context& context) {
  Borders borders(sites);
  DiagramCounters counters;
  std::vector<char> again;
  const Index n = sites.instance().element_count();
  again.assign(n, 0);
  kernel::resize_pages(context, borders.first, n);
  kernel::resize_pages(context, borders.count, n);
  if (Status built = build_first_faces(sites, boxes, most_candidates, context, borders, again, counters); !built)
    return built.error();
  if (Status agreed = Settling(sites, boxes, context, borders, again, counters).run(); !agreed) return agreed.error();
  Diagram d = lay_out(borders, context);
  d.counters = counters;
  if (const auto apart = find_apart(d, sites.instance())) return disagreement(sites, *apart);
  place_vertices(sites, borders, context, d);
  if (const auto wrong = validate(d, sites.instance().extent() > 0 ? sites.horizon() : 0)) {
    return Error{ErrorCode::computation, "the Voronoi diagram could not be certified: " + *wrong, "",
                 "take the engine intervals"};
  }
  return d;
}

}  // namespace krepl::voronoi
