#include "lab/sub_rivers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace krepl::lab {

namespace {

SubRiver zigzag(const char* name, std::size_t reaches, double pitch) {
  SubRiver river{name, {}, 1};
  for (std::size_t i = 0; i <= reaches; ++i) river.vertices.push_back({pitch * double(i), i % 2 == 0 ? 0.0 : 4.0});
  return river;
}

constexpr double unit = 60, margin = 16, title_height = 28;  // of the picture; a radius is one unit

struct Frame {
  double top;
  std::string place(Point p) const {
    return fmt::format("{:.2f} {:.2f}", margin + unit * (p.x + 1), title_height + margin + unit * (top - p.y));
  }
};

std::string cigar_path(Point a, Point b, double r, const Frame& frame) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const Point n{(b.y - a.y) / length * r, (a.x - b.x) / length * r};
  const auto moved = [&](Point p, double sense) { return frame.place({p.x + sense * n.x, p.y + sense * n.y}); };
  const double size = r * unit;
  return fmt::format("M{}L{}A{:.2f} {:.2f} 0 0 0 {}L{}A{:.2f} {:.2f} 0 0 0 {}Z", moved(a, 1), moved(b, 1), size, size,
                     moved(b, -1), moved(a, -1), size, size, moved(a, 1));
}

std::string zone_path(const Zone& zone, const Frame& frame) {
  std::string path;
  for (std::uint32_t r = 0; r < zone.ring_count(); ++r) {
    for (std::uint32_t e = zone.ring_begin(r); e < zone.ring_begin(r + 1); ++e) {
      const Zone::Piece p = zone.piece(e);
      if (e == zone.ring_begin(r)) path += "M" + frame.place(p.start);
      if (p.kind == Zone::Kind::segment) {
        path += "L" + frame.place(p.end);
      } else {
        path += fmt::format("A{:.2f} {:.2f} 0 0 0 {}", zone.radius() * unit, zone.radius() * unit, frame.place(p.end));
      }
    }
    path += 'Z';
  }
  return path;
}

}  // namespace

SubRiver bundle(std::size_t reaches) { return zigzag("bundle", reaches, 1 / double(reaches)); }
SubRiver spread(std::size_t reaches) { return zigzag("spread", reaches, 0.9); }

std::size_t bundle_crossings(std::size_t reaches) { return (reaches - 1) * (reaches - 2); }

std::string svg_of(const SubRiver& river, const Zone& zone, const std::string& title) {
  double width = 0, height = 0;
  for (const Point p : river.vertices) width = std::max(width, p.x), height = std::max(height, p.y);
  const Frame frame{height + 1};
  const double across = std::max(2 * margin + unit * (width + 2), 9 * double(title.size()) + 2 * margin);
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>text{{font:bold 14px sans-serif;fill:#222}}"
      "path{{fill:none;stroke-linejoin:round}}.zone{{fill:#e4eef8;stroke:#1f4e79;stroke-width:3}}"
      ".cigar{{stroke:#c0504d;stroke-width:.7}}.river{{stroke:#222;stroke-width:1.5}}</style>\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#fff\"/>\n<text x=\"{2}\" y=\"24\">{3}</text>\n",
      across, title_height + 2 * margin + unit * (height + 2), margin, title);
  text += fmt::format("<path class=\"zone\" d=\"{}\"/>\n", zone_path(zone, frame));
  std::string course;
  for (std::size_t i = 0; i < river.vertices.size(); ++i) {
    course += (i == 0 ? "M" : "L") + frame.place(river.vertices[i]);
    if (i == 0) continue;
    text += fmt::format("<path class=\"cigar\" d=\"{}\"/>\n",
                        cigar_path(river.vertices[i - 1], river.vertices[i], river.radius, frame));
  }
  return text + fmt::format("<path class=\"river\" d=\"{}\"/>\n</svg>\n", course);
}

}  // namespace krepl::lab
