// PNG: the surface in relief, lit from the north-west. Colours tell what the ball touches: a face (sand), an edge (blue), a
// vertex (red). Valleys and rims are drawn as lines.
#include <gdal_priv.h>

#include <array>
#include <cmath>
#include <limits>

#include "krepl/drop_cutter.hpp"
#include "ogr/message_capture.hpp"
#include "output/atomic_file.hpp"
#include "output/surface_patch.hpp"
#include "output/surface_raster.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

struct Colour {
  double r = 0, g = 0, b = 0;
};
Colour mix(Colour a, Colour b, double t) { return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)}; }

constexpr Colour paper{1, 1, 1}, valley_ink{0.10, 0.13, 0.22}, rim_ink{0.25, 0.25, 0.25};

Colour colour_of(Terrain::FeatureKind kind) {
  switch (kind) {
    case Terrain::FeatureKind::face: return {0.91, 0.85, 0.70};
    case Terrain::FeatureKind::edge: return {0.47, 0.67, 0.84};
    case Terrain::FeatureKind::vertex: return {0.89, 0.45, 0.34};
  }
  return {};
}

/// Each pixel is the mean of so many places a side.
constexpr std::size_t samples = 2;

class Relief {
 public:
  Relief(const Surface& surface, std::size_t width) : surface_(surface), width_(width) {}

  Status paint(const Context& context);
  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  std::array<std::vector<std::uint8_t>, 3> bands() const;

 private:
  Status look_over(const DropCutter& cutter, const SurfaceFrame& frame, const Context& context);
  Colour light(const DropCutter::Contact& contact, Point place) const;
  void take_strip(std::size_t first_row, std::size_t rows, std::span<const DropCutter::Contact> contacts);
  Status draw_edges(Surface::EdgeKind kind, Colour ink, const Context& context);
  void draw_segment(Point a, Point b, double weight);
  double weight(Surface::Index e, Point3 middle, double faintest) const;
  double faintest(Surface::EdgeKind kind) const;

  const Surface& surface_;
  std::size_t width_, height_ = 0;
  DropCutter::Raster raster_;  // of the samples
  std::vector<Colour> pixel_;
  std::vector<float> coverage_;  // of the lines being drawn
  double exaggeration_ = 1;      // of heights, for the light only
  double lowest_ = 0, highest_ = 1;  // centres of the ball
};

/// Gentle hills are lit as if they were steeper, or they would hardly show: the mean slope of some ten thousand places
/// tells how much.
Status Relief::look_over(const DropCutter& cutter, const SurfaceFrame& frame, const Context& context) {
  constexpr double places = 10000, wanted = 0.35, most = 6;
  const double cell = std::sqrt(frame.width() * frame.height() / places);
  const Result<DropCutter::Raster> raster = covering_raster(frame, cell, cell, "--width");
  if (!raster) return raster.error();
  double sum = 0, count = 0;
  lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_;
  Status seen = for_each_strip(cutter, *raster, 1, context, [&](std::size_t row, std::size_t rows, auto contacts) {
    for (std::size_t i = 0; i < rows * raster->columns; ++i) {
      const DropCutter::Contact& contact = contacts[i];
      if (!contact.touches()) continue;
      const Point place = raster->place(i % raster->columns, row + i / raster->columns);
      const double across = std::hypot(place.x - contact.point.x, place.y - contact.point.y);
      sum += std::min(1.0, across / (contact.height - contact.point.z));  // near a wall the slope has no bound
      ++count;
      lowest_ = std::min(lowest_, contact.height), highest_ = std::max(highest_, contact.height);
    }
    return Status(std::monostate{});
  });
  exaggeration_ = std::clamp(wanted * count / std::max(sum, 1e-9), 1.0, most);
  return seen;
}

/// The ball rests where the surface's normal points from the touched place to the centre, so the relief needs no differences.
Colour Relief::light(const DropCutter::Contact& contact, Point place) const {
  if (!contact.touches()) return paper;
  const double x = exaggeration_ * (place.x - contact.point.x), y = exaggeration_ * (place.y - contact.point.y);
  const double z = contact.height - contact.point.z, length = std::sqrt(x * x + y * y + z * z);
  const double facing = (-0.5 * x + 0.5 * y + std::sqrt(0.5) * z) / length;  // 45 degrees above the north-west
  const double rise =
      highest_ > lowest_ ? std::clamp((contact.height - lowest_) / (highest_ - lowest_), 0.0, 1.0) : 1.0;
  const double shade = (0.30 + 0.95 * std::max(0.0, facing)) * (0.80 + 0.20 * rise);  // the deeper, the darker
  const Colour colour = colour_of(surface_.terrain().feature_kind(contact.feature));
  return shade < 1 ? mix({0.05, 0.06, 0.12}, colour, shade) : mix(colour, paper, std::min(0.7, 2 * (shade - 1)));
}

void Relief::take_strip(std::size_t first_row, std::size_t rows, std::span<const DropCutter::Contact> contacts) {
  constexpr double part = 1.0 / (samples * samples);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < raster_.columns; ++column) {
      const Point place = raster_.place(column, first_row + row);
      const Colour colour = light(contacts[row * raster_.columns + column], place);
      Colour& pixel = pixel_[(first_row + row) / samples * width_ + column / samples];
      pixel = {pixel.r + part * colour.r, pixel.g + part * colour.g, pixel.b + part * colour.b};
    }
  }
}

/// Covers the pixels near a segment, given in pixels from the centre of the first one: a line one pixel wide.
void Relief::draw_segment(Point a, Point b, double weight) {
  const auto range = [](double from, double to, std::size_t count) {
    const double last = double(count) - 1;
    return std::pair{std::size_t(std::clamp(std::ceil(from - 1), 0.0, last)),
                     std::size_t(std::clamp(std::floor(to + 1), 0.0, last))};
  };
  const auto [top, bottom] = range(std::min(a.y, b.y), std::max(a.y, b.y), height_);
  const Point d{b.x - a.x, b.y - a.y};
  const double square = d.x * d.x + d.y * d.y;
  const auto [left, right] = range(std::min(a.x, b.x), std::max(a.x, b.x), width_);
  for (std::size_t row = top; row <= bottom; ++row) {
    for (std::size_t column = left; column <= right; ++column) {
      const Point p{double(column) - a.x, double(row) - a.y};
      const double t = square > 0 ? std::clamp((p.x * d.x + p.y * d.y) / square, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(p.x - t * d.x, p.y - t * d.y);
      float& covered = coverage_[row * width_ + column];
      covered = std::max(covered, float(weight * std::clamp(1 - distance, 0.0, 1.0)));
    }
  }
}

/// Lines so dense that they would hide the patches are drawn fainter, except sharp valleys.
double Relief::faintest(Surface::EdgeKind kind) const {
  double length = 0;
  const Subdivision& topology = surface_.subdivision();
  for (Surface::Index e = 0; e < topology.edge_count(); ++e) {
    if (surface_.edge(e).kind != kind) continue;
    const Point3 a = surface_.vertex(topology.origin[2 * e]), b = surface_.vertex(topology.origin[2 * e + 1]);
    length += std::hypot(a.x - b.x, a.y - b.y);
  }
  const double density = length / (raster_.step_x * double(samples)) / double(width_ * height_);
  return std::clamp(0.05 / std::max(density, 1e-9), 0.06, 0.8);
}

/// A valley is the darker the larger the angle between its two sides; from 20 degrees on it is drawn in full. Below one
/// degree it fades away: triangles that are coplanar but for rounding should look so.
double Relief::weight(Surface::Index e, Point3 middle, double faint) const {
  const Surface::Edge edge = surface_.edge(e);
  if (edge.feature[0] == Surface::none || edge.feature[1] == Surface::none) return 1;
  const Point3 m = SurfacePatch(surface_.terrain(), edge.feature[0], surface_.radius()).normal(middle);
  const Point3 n = SurfacePatch(surface_.terrain(), edge.feature[1], surface_.radius()).normal(middle);
  const double sine = std::hypot(m.y * n.z - m.z * n.y, m.z * n.x - m.x * n.z, m.x * n.y - m.y * n.x);
  const double sharp = std::min(1.0, sine / 0.34);
  return std::min(1.0, sine / 0.0175) * (faint + (1 - faint) * sharp * sharp);
}

Status Relief::draw_edges(Surface::EdgeKind kind, Colour ink, const Context& context) {
  const double step_x = raster_.step_x * samples, step_y = raster_.step_y * samples;
  const double half = (samples - 1) / 2.0;
  const Point first{raster_.first.x + half * raster_.step_x, raster_.first.y + half * raster_.step_y};
  coverage_.assign(width_ * height_, 0);
  const double faint = faintest(kind);
  for (std::size_t e = 0; e < surface_.subdivision().edge_count(); ++e) {
    if (surface_.edge(Surface::Index(e)).kind != kind) continue;
    if (context.cancelled()) return surface_interrupted();
    // Pieces of some four pixels look curved.
    double length = 0;
    std::vector<Point3> points = surface_.curve(Surface::Index(e), 3);
    for (int pass = 0; pass < 2; ++pass) {
      length = 0;
      for (std::size_t i = 1; i < points.size(); ++i)
        length += std::hypot((points[i].x - points[i - 1].x) / step_x, (points[i].y - points[i - 1].y) / step_y);
      if (pass == 0 && length > 8) points = surface_.curve(Surface::Index(e), 2 + int(std::min(length / 4, 1e5)));
    }
    const double dark = weight(Surface::Index(e), points[points.size() / 2], faint);
    for (std::size_t i = 1; i < points.size(); ++i) {
      draw_segment({(points[i - 1].x - first.x) / step_x, (points[i - 1].y - first.y) / step_y},
                   {(points[i].x - first.x) / step_x, (points[i].y - first.y) / step_y}, dark);
    }
  }
  constexpr double opacity = 0.9;
  for (std::size_t i = 0; i < pixel_.size(); ++i) pixel_[i] = mix(pixel_[i], ink, opacity * double(coverage_[i]));
  return std::monostate{};
}

Status Relief::paint(const Context& context) {
  const SurfaceFrame frame = surface_frame(surface_.terrain(), surface_.radius());
  const double pixel = frame.width() / double(width_);
  height_ = static_cast<std::size_t>(std::max(1.0, std::ceil(frame.height() / pixel * (1 - 1e-12))));
  if (double(height_) * double(width_) > 1e9) {
    return Error{ErrorCode::usage, fmt::format("a picture of {} x {} pixels is too large", width_, height_), "",
                 "give a smaller --width"};
  }
  const double fine = pixel / samples;
  const SurfaceFrame whole{frame.min_x, frame.max_y - double(height_) * pixel, frame.max_x, frame.max_y};
  raster_ = {{whole.min_x + fine / 2, whole.max_y - fine / 2}, fine, -fine, width_ * samples, height_ * samples};
  pixel_.assign(width_ * height_, {});
  // Borrowed: the cutter does not outlive the surface.
  const std::shared_ptr<const Terrain> terrain(std::shared_ptr<void>(), &surface_.terrain());
  const Result<DropCutter> cutter = DropCutter::build(terrain, surface_.radius(), context);
  if (!cutter) return cutter.error();
  if (Status seen = look_over(*cutter, frame, context); !seen) return seen;
  Status painted = for_each_strip(*cutter, raster_, samples, context, [&](std::size_t row, std::size_t rows, auto contacts) {
    take_strip(row, rows, contacts);
    return Status(std::monostate{});
  });
  if (!painted) return painted;
  if (Status drawn = draw_edges(Surface::EdgeKind::valley, valley_ink, context); !drawn) return drawn;
  return draw_edges(Surface::EdgeKind::rim, rim_ink, context);
}

std::array<std::vector<std::uint8_t>, 3> Relief::bands() const {
  std::array<std::vector<std::uint8_t>, 3> bands;
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); };
  for (auto& band : bands) band.reserve(pixel_.size());
  for (const Colour& colour : pixel_) {
    bands[0].push_back(byte(colour.r));
    bands[1].push_back(byte(colour.g));
    bands[2].push_back(byte(colour.b));
  }
  return bands;
}

Status write_png(const std::string& path, const Relief& relief) {
  ogr::MessageCapture messages;
  const auto failure = [&] {
    return messages.error(ErrorCode::io, "cannot be written", "", "free some space or choose another place");
  };
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDriver* png = GetGDALDriverManager()->GetDriverByName("PNG");
  if (memory == nullptr || png == nullptr) return failure();
  const int width = int(relief.width()), height = int(relief.height());
  std::unique_ptr<GDALDataset> picture(memory->Create("", width, height, 3, GDT_Byte, nullptr));
  if (!picture) return failure();
  auto bands = relief.bands();
  for (int b = 0; b < 3; ++b) {
    if (picture->GetRasterBand(b + 1)->RasterIO(GF_Write, 0, 0, width, height, bands[std::size_t(b)].data(), width, height,
                                                GDT_Byte, 0, 0, nullptr) != CE_None) {
      return failure();
    }
  }
  std::unique_ptr<GDALDataset> copy(png->CreateCopy(path.c_str(), picture.get(), FALSE, nullptr, nullptr, nullptr));
  if (!copy) return failure();
  copy->FlushCache(true);
  copy.reset();
  if (messages.failed()) return failure();
  return std::monostate{};
}

}  // namespace

SurfaceWriteResult write_surface_png(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                     const Context& context) {
  ogr::initialise();
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  Relief relief(surface, std::size_t(std::max(1, options.width)));
  if (Status painted = relief.paint(context); !painted) return painted.error();
  if (Status written = write_png(file->temporary_path(), relief); !written) return written.error();
  if (Status committed = file->commit(); !committed) return committed.error();
  SurfaceFileReport report;
  report.columns = relief.width();
  report.rows = relief.height();
  return report;
}

}  // namespace krepl::output
