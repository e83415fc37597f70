#include <algorithm>
#include <cmath>

#include "section/each_cut.hpp"
#include "section/tracing.hpp"

// Sections by vertical planes.
namespace krepl::section {

namespace {

using Side = Crossing::Side;

class SectionTracer {
 public:
  SectionTracer(const Parts& parts, Point from, Point to) : parts_(parts), tracing_(parts) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    length_ = std::hypot(dx, dy);
    line_ = {from, {dx / length_, dy / length_}};
    section_.from = from;
    section_.to = to;
  }

  Result<Section> run() {
    collect_edges();
    move_off_vertices();
    for (const Index e : edges_) cross(e);
    const bool paired = tracing_.pair(
        [&](const Patch&, const Crossing& c) {
          return Patch::Place{0, line_.along({c.at.x, c.at.y})};
        },
        {});
    if (!paired || !trace())
      return Error{ErrorCode::computation, "the section does not connect", "", "please report this input"};
    clip();
    return std::move(section_);
  }

 private:
  double aside(Index half_edge) const {
    const Point3 p = parts_.surface->vertex(parts_.topology().origin[half_edge]);
    return line_.aside({p.x, p.y});
  }
  bool is_left(Index half_edge) const { return aside(half_edge) >= 0; }

  void collect_edges() {
    const Point d = line_.direction;
    const auto meets = [&](const Parts::Box& box) {
      const Point middle{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
      const double reach = std::abs(d.y) * (box.high.x - box.low.x) / 2 + std::abs(d.x) * (box.high.y - box.low.y) / 2;
      return std::abs(line_.aside(middle)) <= reach + 2 * parts_.shift;
    };
    parts_.each_edge(meets, [&](Index e) { edges_.push_back(e); });
  }

  /// A line along edges or through vertices would be on the side that rounding has it.
  void move_off_vertices() {
    const double near = parts_.shift / 4;
    const bool touches = std::any_of(edges_.begin(), edges_.end(), [&](Index e) {
      return std::abs(aside(2 * e)) <= near || std::abs(aside(2 * e + 1)) <= near;
    });
    if (!touches) return;
    line_.base.x += parts_.shift * line_.direction.y;
    line_.base.y -= parts_.shift * line_.direction.x;
  }

  void cross(Index e) {
    const bool starts_left = is_left(2 * e), ends_left = is_left(2 * e + 1);
    const Surface::Edge edge = parts_.surface->edge(e);
    if (starts_left == ends_left && edge.curve == Surface::Curve::line) return;
    find_crossings(
        EdgeCourse(parts_, e), e, Side::both, starts_left, ends_left,
        [&](Point3 p) {
          return line_.aside({p.x, p.y});
        },
        2 * parts_.shift, tracing_.crossings);
  }

  /// The height of a face where the line crosses its border.
  Point3 end_on(Index face, Index crossing) const {
    Point3 p = tracing_.crossings[crossing].at;
    if (parts_.is_rim(tracing_.crossings[crossing].edge)) {
      const Surface::Edge edge = parts_.surface->edge(tracing_.crossings[crossing].edge);
      const int upper = edge.feature[0] != none ? 0 : 1;
      if (parts_.topology().face[2 * tracing_.crossings[crossing].edge + Index(upper)] != face)
        p.z = parts_.patch(face).height({p.x, p.y});
    }
    return p;
  }

  bool has_patch(Index face) const { return face != none && parts_.surface->face_feature(face) != none; }

  void add_piece(Index from, Index to) {
    const Index face = tracing_.entered(from);
    CutPiece piece = parts_.patch(face).line_piece(end_on(face, from), end_on(face, to), line_);
    piece.face = face;
    piece.feature = parts_.surface->face_feature(face);
    section_.pieces.push_back(piece);
  }

  /// From the piece added last up or down to the face beyond a rim.
  void add_wall(Index crossing) {
    const Index next = tracing_.entered(crossing), last = tracing_.left(crossing);
    CutPiece piece;
    piece.start = section_.pieces.back().end;
    piece.end = end_on(next, crossing);
    if (piece.start == piece.end) return;
    piece.wall = true;
    piece.face = piece.end.z > piece.start.z ? next : last;
    piece.feature = parts_.surface->face_feature(piece.face);
    section_.pieces.push_back(piece);
  }

  /// From where the line comes in over a rim to where it leaves over one.
  bool trace() {
    std::vector<Index> starts;
    std::vector<bool> entered(tracing_.crossings.size());
    for (Index c = 0; c < tracing_.crossings.size(); ++c) {
      if (tracing_.enters(c) && !has_patch(tracing_.left(c))) starts.push_back(c);
    }
    std::stable_sort(starts.begin(), starts.end(), [&](Index a, Index b) { return along(a) < along(b); });
    for (Index c : starts) {
      for (bool first = true; tracing_.enters(c); first = false) {
        if (entered[c]) return false;
        entered[c] = true;
        if (!first) add_wall(c);
        add_piece(c, tracing_.exit(c));
        c = tracing_.exit(c);
      }
      section_.chain_begin.push_back(Index(section_.pieces.size()));
    }
    return true;
  }

  double along(Index crossing) const {
    const Point3 p = tracing_.crossings[crossing].at;
    return line_.along({p.x, p.y});
  }

  /// Leaves of the whole line's section what is between its ends.
  void clip() {
    Section whole;
    std::swap(whole, section_);
    section_.from = whole.from;
    section_.to = whole.to;
    const auto place = [&](Point3 p) { return line_.along({p.x, p.y}); };
    for (std::size_t c = 0; c < whole.chain_count(); ++c) {
      const auto chain = whole.chain(c);
      std::size_t first = 0, last = chain.size();
      while (first < last && !(place(chain[first].end) > 0)) ++first;
      while (first < last && !(place(chain[last - 1].start) < length_)) --last;
      if (first == last) continue;
      for (std::size_t i = first; i < last; ++i) {
        const double from = i == first && place(chain[i].start) < 0 ? parameter(chain[i], 0) : 0;
        const double to = i + 1 == last && place(chain[i].end) > length_ ? parameter(chain[i], length_) : 1;
        section_.pieces.push_back(from > 0 || to < 1 ? chain[i].part(from, to) : chain[i]);
      }
      section_.chain_begin.push_back(Index(section_.pieces.size()));
    }
  }

  /// s of the place of a piece at a distance along the line.
  double parameter(const CutPiece& piece, double at) const {
    double a = 0, b = 1;
    for (int i = 0; i < 80 && b - a > 0x1p-54; ++i) {
      const double s = a + (b - a) / 2;
      const Point3 p = piece.at(s);
      (line_.along({p.x, p.y}) < at ? a : b) = s;
    }
    return b;
  }

  const Parts& parts_;
  Line line_;
  double length_;
  Section section_;
  Tracing tracing_;
  std::vector<Index> edges_;
};

}  // namespace

}  // namespace krepl::section

namespace krepl {

Result<Section> SurfaceCutter::section(Point from, Point to) const {
  for (const double value : {from.x, from.y, to.x, to.y}) {
    if (!std::isfinite(value)) return Error{ErrorCode::usage, "an end of the line is not finite", "", ""};
  }
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > 0) || !std::isfinite(length)) return Error{ErrorCode::usage, "the ends of the line are equal", "", ""};
  return section::SectionTracer(*parts_, from, to).run();
}

Result<std::vector<Section>> SurfaceCutter::sections(std::span<const Line> lines, const Context& context) const {
  return section::make_each<Section>(lines.size(), context,
                                     [&](std::size_t i) { return section(lines[i].from, lines[i].to); });
}

}  // namespace krepl
