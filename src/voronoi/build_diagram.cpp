#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "voronoi/glue.hpp"

namespace krepl::voronoi {
namespace {

constexpr std::size_t block = 1 << 11;
constexpr int most_rounds = 64;

bool has_face(const Instance& in, Index element) { return in.is_side(element) || in.sector(in.vertex_of(element)).before != none; }

/// Faces in double precision, side by side. Faces that are certainly wrong are marked.
bool build_faces(const Sites& sites, const SiteBoxes& boxes, const Context& context, Borders& borders, std::vector<char>& again,
                 DiagramCounters& counters) {
  const Instance& in = sites.instance();
  const std::size_t n = in.element_count();
  struct Part {
    std::vector<Link> links;
    FaceCounters counters;
    std::uint64_t faces = 0;
  };
  std::vector<Part> parts((n + block - 1) / block);
  again.assign(n, 0);
  borders.count.assign(n, 0);
  kernel::Progress progress(context, n);
  const bool done = kernel::parallel_blocks(context, n, block, [&](std::size_t from, std::size_t to) {
    Part& part = parts[from / block];
    FaceBuilder builder(sites, boxes);
    for (Index e = Index(from); e < to && !context.cancelled(); ++e) {
      if (!has_face(in, e)) continue;
      const std::size_t start = part.links.size();
      again[e] = !builder.build(e, part.links);
      borders.count[e] = Index(part.links.size() - start);
      ++part.faces;
    }
    part.counters = builder.counters;
    progress.add(to - from);
  });
  if (!done || context.cancelled()) return false;
  borders.first.resize(n);
  Index total = 0;
  for (std::size_t e = 0; e < n; ++e) borders.first[e] = total, total += borders.count[e];
  kernel::reserve_pages(context, borders.links, total);
  for (Part& part : parts) {
    borders.links.insert(borders.links.end(), part.links.begin(), part.links.end());
    counters.candidates += part.counters.candidates;
    counters.faces += part.faces;
    part.links = {};
  }
  return true;
}

/// Marks, among the given faces, those that disagree with a neighbour, and the neighbour.
void mark_disagreeing(const Borders& borders, const std::vector<Index>& faces, const Context& context, std::vector<char>& marked) {
  Context quiet;
  quiet.threads = context.threads;
  std::vector<std::vector<Index>> parts((faces.size() + block - 1) / block);
  kernel::parallel_blocks(quiet, faces.size(), block, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const Index face = faces[k];
      for (Index i = borders.first[face]; i < borders.first[face] + borders.count[face]; ++i) {
        if (borders.links[i].label == none || borders.twin(face, i) != none) continue;
        for (const Index f : {face, borders.links[i].label, borders.before(face, i), borders.after(face, i)}) {
          if (f < Diagram::base) parts[from / block].push_back(f);
        }
      }
    }
  });
  for (const auto& part : parts) {
    for (const Index face : part) marked[face] = 1;
  }
}

/// Does the given faces again in quadruple precision; the new borders stand at the end.
void build_again(const Sites& sites, const SiteBoxes& boxes, const std::vector<Index>& faces, const Context& context,
                 Borders& borders) {
  constexpr std::size_t few = 8;
  struct Part {
    std::vector<Link> links;
    std::vector<Index> count;
  };
  std::vector<Part> parts((faces.size() + few - 1) / few);
  Context quiet;
  quiet.threads = context.threads;
  quiet.cancel = context.cancel;
  kernel::parallel_blocks(quiet, faces.size(), few, [&](std::size_t from, std::size_t to) {
    Part& part = parts[from / few];
    FaceBuilder builder(sites, boxes);
    for (std::size_t k = from; k < to; ++k) {
      const std::size_t start = part.links.size();
      builder.build_precisely(faces[k], part.links);
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
  return {ErrorCode::computation, "the Voronoi diagram could not be certified: face " + std::to_string(face) +
                                      " and one of its neighbours disagree in quadruple precision",
          "near x " + std::to_string(p.x) + ", y " + std::to_string(p.y) + " relative to the data's origin",
          "please report this input"};
}

/// Brings all faces to agree. Faces done in quadruple precision are true ones of the moved instance, so they agree with each
/// other; what grows from round to round is only the rim where they meet faces in double precision.
Status settle(const Sites& sites, const SiteBoxes& boxes, const Context& context, Borders& borders, std::vector<char>& again,
              DiagramCounters& counters) {
  const Index n = Index(borders.count.size());
  std::vector<char> precise(n, 0);
  std::vector<Index> faces(n);
  for (Index e = 0; e < n; ++e) faces[e] = e;
  mark_disagreeing(borders, faces, context, again);
  for (int round = 0;; ++round) {
    faces.clear();
    Index stuck = none;
    for (Index e = 0; e < n; ++e) {
      if (!again[e]) continue;
      if (!precise[e]) faces.push_back(e);
      if (precise[e] && stuck == none) stuck = e;
    }
    if (faces.empty() && stuck == none) return std::monostate{};
    if (faces.empty() || round == most_rounds) return disagreement(sites, stuck == none ? faces[0] : stuck);
    ++counters.rounds;
    counters.faces_in_quadruple += faces.size();
    std::vector<char> look(n, 0);
    const auto look_around = [&] {
      for (const Index e : faces) {
        look[e] = 1;
        for (const Link& l : borders.border(e)) {
          if (l.label != none) look[l.label] = 1;
        }
      }
    };
    look_around();
    for (Index e = 0; e < n; ++e) look[e] = char(look[e] || again[e]);
    build_again(sites, boxes, faces, context, borders);
    if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    look_around();
    for (const Index e : faces) precise[e] = 1;
    faces.clear();
    for (Index e = 0; e < n; ++e) {
      if (look[e]) faces.push_back(e);
    }
    again.assign(n, 0);
    mark_disagreeing(borders, faces, context, again);
  }
}

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

}  // namespace

Result<Diagram> build_diagram(const Sites& sites, const SiteBoxes& boxes, const Context& context) {
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};
  Borders borders(sites.instance());
  DiagramCounters counters;
  std::vector<char> again;
  if (!build_faces(sites, boxes, context, borders, again, counters)) return cancelled;
  if (Status agreed = settle(sites, boxes, context, borders, again, counters); !agreed) return agreed.error();
  Diagram d = lay_out(borders, context);
  d.counters = counters;
  place_vertices(sites, borders, context, d);
  return d;
}

}  // namespace krepl::voronoi
