#include "lab/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace krepl::lab {

namespace {

using Index = Surface::Index;

/// From the plane to a picture 800 wide or 600 high, y upwards.
struct Frame {
  double min_x = 1e300, min_y = 1e300, max_x = -1e300, max_y = -1e300;

  void add(double x, double y) {
    min_x = std::min(min_x, x), max_x = std::max(max_x, x), min_y = std::min(min_y, y), max_y = std::max(max_y, y);
  }
  static constexpr double margin = 16, title = 28;
  double scale() const {
    return std::min(800 / std::max(max_x - min_x, 1e-300), 600 / std::max(max_y - min_y, 1e-300));
  }
  double x(double at) const { return margin + (at - min_x) * scale(); }
  double y(double at) const { return title + margin + (max_y - at) * scale(); }
  std::string place(double at_x, double at_y) const { return fmt::format("{:.1f} {:.1f}", x(at_x), y(at_y)); }

  std::string head(const std::string& text, const std::string& style) const {
    // At least as wide as the title.
    const double width = 2 * margin + std::max((max_x - min_x) * scale(), 9 * double(text.size())),
                 height = title + 2 * margin + (max_y - min_y) * scale();
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>text{{font:bold 14px "
        "sans-serif;fill:#222}}path{{stroke-linejoin:round}}{2}</style>\n"
        "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#fff\"/>\n<text x=\"{3}\" y=\"24\">{4}</text>\n",
        width, height, style, margin, text);
  }
};

/// Points of an edge along half-edge 2e, one every eight units of the picture.
std::vector<Point3> course(const Surface& surface, Index e, const Frame& frame) {
  std::vector<Point3> points = surface.curve(e, 3);
  if (surface.edge(e).curve == Surface::Curve::line) return points;
  double length = 0;
  for (int k = 0; k < 2; ++k) length += std::hypot(points[k + 1].x - points[k].x, points[k + 1].y - points[k].y);
  return surface.curve(e, std::clamp(int(length * frame.scale() / 8) + 2, 3, 65));
}

void put_loop(std::string& path, const Surface& surface, Index first, const Frame& frame) {
  const Subdivision& topology = surface.subdivision();
  Index h = first;
  char command = 'M';
  do {
    std::vector<Point3> points = course(surface, Subdivision::edge(h), frame);
    if (h % 2 == 1) std::reverse(points.begin(), points.end());
    points.pop_back();
    for (const Point3& p : points) path += command + frame.place(p.x, p.y), command = 'L';
    h = topology.next[h];
  } while (h != first);
  path += 'Z';
}

const char* face_class(const Surface& surface, Index feature) {
  switch (surface.terrain().feature_kind(feature)) {
    case Terrain::FeatureKind::face:
      return "plane";
    case Terrain::FeatureKind::edge:
      return "cylinder";
    default:
      return "sphere";
  }
}

constexpr const char* edge_class[] = {"seam", "valley", "rim"};

void put_faces(std::string& text, const Surface& surface, const Frame& frame) {
  const Subdivision& topology = surface.subdivision();
  for (Index f = 1; f < topology.face_count(); ++f) {
    if (surface.face_feature(f) == Surface::none) continue;
    std::string path;
    put_loop(path, surface, topology.face_outer[f], frame);
    for (const Index h : topology.inner_loops(f)) put_loop(path, surface, h, frame);
    text += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", face_class(surface, surface.face_feature(f)), path);
  }
}

/// The edges, and the places where three valleys meet.
void put_edges(std::string& text, const Surface& surface, const Frame& frame) {
  const Subdivision& topology = surface.subdivision();
  std::vector<int> valleys(topology.vertex_count, 0);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Surface::EdgeKind kind = surface.edge(e).kind;
    std::string path;
    for (const Point3& p : course(surface, e, frame)) path += (path.empty() ? 'M' : 'L') + frame.place(p.x, p.y);
    text += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", edge_class[int(kind)], path);
    if (kind == Surface::EdgeKind::valley) ++valleys[topology.origin[2 * e]], ++valleys[topology.origin[2 * e + 1]];
  }
  const double size = topology.vertex_count > 500 ? 1.2 : 3;
  for (Index v = 0; v < topology.vertex_count; ++v) {
    const Point3 p = surface.vertex(v);
    if (valleys[v] >= 3)
      text += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>\n", frame.x(p.x), frame.y(p.y), size);
  }
}

/// The chain of pieces as one path, from the lower end of the left half-line to that of the right one.
std::string outline(const Profile& profile, const Frame& frame) {
  std::string path;
  for (std::size_t k = 0; k < profile.pieces.size(); ++k) {
    const ProfileRow row = profile.row(k);
    const Point start = std::isfinite(row.start.y) ? row.start : Point{row.start.x, frame.min_y};
    const Point end = std::isfinite(row.end.y) ? row.end : Point{row.end.x, frame.min_y};
    if (path.empty()) path = 'M' + frame.place(start.x, start.y);
    const double radius = profile.radius * frame.scale();
    if (row.kind == ProfilePiece::Kind::arc)
      path += fmt::format("A{0:.2f} {0:.2f} 0 0 1 {1}", radius, frame.place(end.x, end.y));
    else
      path += 'L' + frame.place(end.x, end.y);
  }
  return path;
}

/// Whether the pieces before and after a vertex continue each other: then it lies straight above what causes one of
/// them.
bool is_implicit(const ProfileRow& before, const ProfileRow& after) {
  using Kind = ProfilePiece::Kind;
  if (before.kind == Kind::half_line || after.kind == Kind::half_line) return true;
  if (before.kind == Kind::arc && after.kind == Kind::segment) return before.index == after.index;
  return before.kind == Kind::segment && after.kind == Kind::arc && after.index == before.index + 1;
}

}  // namespace

std::string svg_of(const Surface& surface, const std::string& title) {
  Frame frame;
  for (Index v = 0; v < surface.subdivision().vertex_count; ++v) {
    const Point3 p = surface.vertex(v);
    frame.add(p.x, p.y);
  }
  for (Index e = 0; e < surface.subdivision().edge_count(); ++e) {
    for (const Point3& p : surface.curve(e, 17)) frame.add(p.x, p.y);
  }
  std::string text = frame.head(
      title,
      ".plane{fill:#ecd9a8}.cylinder{fill:#9cc3e4}.sphere{fill:#e8a49c}.seam,.valley,.rim{fill:none}"
      ".seam{stroke:#777;stroke-width:.5}.valley{stroke:#123a6b;stroke-width:.8}.rim{stroke:#000;stroke-width:1.4}");
  put_faces(text, surface, frame);
  put_edges(text, surface, frame);
  return text + "</svg>\n";
}

std::string svg_of(const Profile& profile, const std::string& title) {
  Frame frame;
  for (const Point& p : profile.terrain) {
    frame.add(p.x - profile.radius, p.y + profile.radius);
    frame.add(p.x + profile.radius, p.y - 0.2 * profile.radius);
  }
  std::string text = frame.head(
      title,
      ".sum{fill:#9cc3e4;fill-opacity:.4;stroke:#123a6b;stroke-width:1.5}"
      ".terrain{fill:#ecd9a8;stroke:#7a5c12;stroke-width:1.5}.explicit{fill:#b3261e}.implicit{fill:#123a6b}");
  text += fmt::format("<path class=\"sum\" d=\"{}Z\"/>\n", outline(profile, frame));
  std::string ground = 'M' + frame.place(profile.terrain.front().x, frame.min_y);
  for (const Point& p : profile.terrain) ground += 'L' + frame.place(p.x, p.y);
  ground += 'L' + frame.place(profile.terrain.back().x, frame.min_y) + 'Z';
  text += fmt::format("<path class=\"terrain\" d=\"{}\"/>\n", ground);
  for (std::size_t k = 1; k < profile.pieces.size(); ++k) {
    const ProfileRow after = profile.row(k);
    const bool implicit = is_implicit(profile.row(k - 1), after);
    text +=
        fmt::format("<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\"/>\n", implicit ? "implicit" : "explicit",
                    frame.x(after.start.x), frame.y(after.start.y), implicit ? 2.5 : 4.5);
  }
  return text + "</svg>\n";
}

}  // namespace krepl::lab
