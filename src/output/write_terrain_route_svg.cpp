// Plan and profile of a route over a terrain. The plan: heights of the offset surface, light from the north-west; the
// profile: the way on the ground from left to right, the surface below, and the route above it.
#include <algorithm>
#include <cmath>

#include "output/output_stream.hpp"
#include "output/svg_text.hpp"
#include "output/terrain_route_file.hpp"

namespace krepl::output {

namespace {

constexpr double width = 1000, profile_height = 260, gap = 30;
constexpr int columns = 200;

class Plan {
 public:
  explicit Plan(const TerrainPicture& picture) : picture_(picture) {
    const double across = picture.high.x - picture.low.x, up = picture.high.y - picture.low.y;
    scale_ = width / std::max(across, 1e-9 * up);
    if (up * scale_ > width) scale_ = width / up;
    height_ = up * scale_;
    cell_ = std::max(across, up) / columns;
  }
  double height() const { return height_; }
  Point at(double x, double y) const {
    return {(x - picture_.low.x) * scale_, height_ - (y - picture_.low.y) * scale_};
  }

  /// Cells of one row with the same shade are one rectangle.
  void shade(SvgText& text, OutputStream& stream) const {
    text.put("<g class=\"heights\" shape-rendering=\"crispEdges\">\n");
    const int rows = int((picture_.high.y - picture_.low.y) / cell_),
              across = int((picture_.high.x - picture_.low.x) / cell_);
    for (int row = 0; row < rows; ++row) {
      int first = 0, shade = shade_at(0, row);
      for (int column = 1; column <= across; ++column) {
        const int next = column < across ? shade_at(column, row) : -2;
        if (next == shade) continue;
        if (shade >= 0) {
          const Point p = at(picture_.low.x + first * cell_, picture_.low.y + (row + 1) * cell_);
          text.format(
              "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#{:02x}{:02x}{:02x}\"/>\n",
              p.x, p.y, (column - first) * cell_ * scale_, cell_ * scale_, shade, shade, shade);
        }
        first = column, shade = next;
      }
      text.flush(stream);
    }
    text.put("</g>\n");
  }

 private:
  /// -1 where the ball touches nothing.
  int shade_at(int column, int row) const {
    const Point p{picture_.low.x + (column + 0.5) * cell_, picture_.low.y + (row + 0.5) * cell_};
    const double h = picture_.rest(p), east = picture_.rest({p.x + cell_, p.y}),
                 north = picture_.rest({p.x, p.y + cell_});
    if (!std::isfinite(h)) return -1;
    const double dx = std::isfinite(east) ? (east - h) / cell_ : 0, dy = std::isfinite(north) ? (north - h) / cell_ : 0;
    const double light = (1 + (dx - dy) / std::sqrt(2.0)) / std::sqrt(1 + dx * dx + dy * dy);
    return std::clamp(int(110 + 90 * light) / 6 * 6, 40, 250);
  }

  const TerrainPicture& picture_;
  double scale_, height_, cell_;
};

void put_plan_route(SvgText& text, const Plan& plan, const TerrainRoute& route) {
  text.format("<path class=\"route\" data-length=\"{}\" data-clearance=\"{}\" d=\"", route.length, route.clearance);
  char command = 'M';
  for (const Point3& p : route.points) {
    const Point q = plan.at(p.x, p.y);
    text.format("{}{:.2f} {:.2f}", command, q.x, q.y);
    command = 'L';
  }
  text.put("\"/>\n");
  for (const Point3& p : {route.points.front(), route.points.back()}) {
    const Point q = plan.at(p.x, p.y);
    text.format("<circle class=\"end\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"5\"/>\n", q.x, q.y);
  }
}

void put_profile(SvgText& text, double top, const TerrainRoute& route, const TerrainPicture& picture) {
  std::vector<Point> ground, flight;  // way on the ground, height
  double way = 0, low = 1e300, high = -1e300;
  for (std::size_t i = 0; i < route.points.size(); ++i) {
    const Point3 a = route.points[i];
    flight.push_back({way, a.z});
    low = std::min(low, a.z), high = std::max(high, a.z);
    if (i + 1 == route.points.size()) break;
    const Point3 b = route.points[i + 1];
    const double step = std::hypot(b.x - a.x, b.y - a.y);
    constexpr int samples = 12;
    for (int k = 0; k <= samples && step > 0; ++k) {
      const double t = double(k) / samples, h = picture.rest({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
      if (!std::isfinite(h)) continue;
      ground.push_back({way + t * step, h});
      low = std::min(low, h), high = std::max(high, h);
    }
    way += step;
  }
  const double x_scale = width / std::max(way, 1e-12 * std::max(high - low, 1e-300)),
               tall = std::max(high - low, 1e-9 * way);
  const auto put = [&](char command, Point p) {
    text.format("{}{:.2f} {:.2f}", command, p.x * x_scale,
                top + profile_height - 20 - (p.y - low) / std::max(tall, 1e-300) * (profile_height - 40));
  };
  if (!ground.empty()) {
    text.format("<path class=\"ground\" d=\"M0 {:.2f}", top + profile_height);
    for (const Point& p : ground) put('L', p);
    text.format("L{:.2f} {:.2f}Z\"/>\n", ground.back().x * x_scale, top + profile_height);
  }
  text.put("<path class=\"route\" d=\"");
  for (std::size_t i = 0; i < flight.size(); ++i) put(i == 0 ? 'M' : 'L', flight[i]);
  text.format(
      "\"/>\n<text x=\"6\" y=\"{:.0f}\">height of the centre {:.6g} to {:.6g}, way {:.6g}; grey: where the ball "
      "rests</text>\n",
      top + 12, low, high, way);
}

}  // namespace

Status write_terrain_route_svg(const std::string& path, const TerrainRoute& route, const TerrainPicture& picture,
                               const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  const Plan plan(picture);
  SvgText text({0, 0});
  const double height = plan.height() + gap + profile_height;
  text.put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  text.format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n",
      width, height);
  text.put(
      "<style>.route{fill:none;stroke:#c8321e;stroke-width:2.5;stroke-linejoin:round;stroke-linecap:round}"
      ".ground{fill:#b8b8b8;stroke:#5a5a5a;stroke-width:1}.end{fill:#c8321e}text{font:12px sans-serif}</style>\n");
  plan.shade(text, *stream);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while writing", "", ""};
  put_plan_route(text, plan, route);
  put_profile(text, plan.height() + gap, route, picture);
  text.put("</svg>\n");
  text.flush(*stream);
  return stream->finish();
}

}  // namespace krepl::output
