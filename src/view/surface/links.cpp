#include "view/surface/links.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace krepl::view {

namespace {

using File = input::SubdivisionFile;
using Index = File::Index;

bool finite(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

class LinkCheck {
 public:
  explicit LinkCheck(const File& file) : file_(file), seen_(file.half_edges.size(), false) {}

  Status check() {
    if (!(file_.radius > 0) || !std::isfinite(file_.radius)) return fault("the radius is not a positive number", "");
    for (const auto step : {&LinkCheck::numbers, &LinkCheck::features, &LinkCheck::half_edges, &LinkCheck::faces})
      if (Status done = (this->*step)(); !done) return done;
    return std::monostate{};
  }

 private:
  static Status fault(const std::string& what, const std::string& where) {
    return Error{ErrorCode::input, what, where, "give a subdivision as krepl terrain wrote it"};
  }
  template <class T>
  static std::string item(const char* list, T index) {
    return fmt::format("{}[{}]", list, index);
  }
  bool feature_or_none(Index f) const { return f == File::none || f < file_.features.size(); }

  Status numbers() {
    for (std::size_t i = 0; i < file_.vertices.size(); ++i)
      if (!finite(file_.vertices[i])) return fault("a coordinate is not finite", item("vertices", i));
    for (std::size_t e = 0; e < file_.edges.size(); ++e) {
      for (std::uint64_t p = file_.edges[e].first; p < file_.points_end(e); ++p)
        if (!finite(file_.points[p])) return fault("a coordinate is not finite", item("edges", e));
      if (file_.points_end(e) < file_.edges[e].first + 2) return fault("fewer than two points", item("edges", e));
    }
    return std::monostate{};
  }

  Status features() {
    for (std::size_t f = 0; f < file_.features.size(); ++f)
      for (int i = 0; i < file_.features[f].count; ++i)
        if (!finite(file_.features[f].at[std::size_t(i)]))
          return fault("a coordinate is not finite", item("features", f));
    for (std::size_t e = 0; e < file_.edges.size(); ++e)
      for (const Index f : file_.edges[e].feature)
        if (!feature_or_none(f)) return fault(fmt::format("there is no feature {}", f), item("edges", e));
    return std::monostate{};
  }

  Status half_edges() {
    const std::vector<File::HalfEdge>& half = file_.half_edges;
    if (half.size() != 2 * file_.edges.size()) return fault("not two half-edges for each edge", "half_edges");
    for (Index h = 0; h < half.size(); ++h) {
      const File::HalfEdge& e = half[h];
      if (e.edge != h / 2 || e.twin != (h ^ 1u))
        return fault("is not one of its edge's two half-edges", item("half_edges", h));
      if (e.origin >= file_.vertices.size() || e.next >= half.size() || e.face >= file_.faces.size())
        return fault("leads to something that is not there", item("half_edges", h));
      if (half[e.next].face != e.face || half[e.next].origin != half[h ^ 1u].origin)
        return fault("the next half-edge does not follow it", item("half_edges", h));
      if (seen_[e.next]) return fault("two half-edges go on to one", item("half_edges", e.next));
      seen_[e.next] = true;
    }
    return std::monostate{};
  }

  Status faces() {
    for (Index f = 0; f < file_.faces.size(); ++f) {
      const File::Face& face = file_.faces[f];
      if (!feature_or_none(face.feature))
        return fault(fmt::format("there is no feature {}", face.feature), item("faces", f));
      if (face.feature != File::none && face.outer == File::none) return fault("has no outer loop", item("faces", f));
      if (face.outer != File::none && !starts(face.outer, f))
        return fault("its outer loop is another's", item("faces", f));
      for (std::uint64_t i = face.first_inner; i < file_.inner_end(f); ++i)
        if (!starts(file_.inner[i], f)) return fault("an inner loop is another's", item("faces", f));
    }
    return std::monostate{};
  }
  bool starts(Index h, Index face) const { return h < file_.half_edges.size() && file_.half_edges[h].face == face; }

  const File& file_;
  std::vector<bool> seen_;
};

}  // namespace

Status check_links(const input::SubdivisionFile& file) { return LinkCheck(file).check(); }

}  // namespace krepl::view
