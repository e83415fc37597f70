// Contours and sections as CSV, SVG, DXF.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "output/cut_lines.hpp"
#include "output/dxf_document.hpp"
#include "output/surface_file.hpp"
#include "output/svg_text.hpp"

namespace krepl::output {

namespace {

using Kind = CutPiece::Kind;

Error interrupted() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }

const char* name_of(Kind kind) { return kind == Kind::line ? "line" : kind == Kind::circle ? "circle" : "ellipse"; }

/// The direction in which angles of a piece run with x to the right and y upwards.
bool is_clockwise(const PlanePiece& p) {
  return (p.axis[0].x * p.axis[1].y - p.axis[0].y * p.axis[1].x > 0) != (p.to > p.from);
}

Point at_angle(const PlanePiece& p, double t) {
  return {p.centre.x + std::cos(t) * p.axis[0].x + std::sin(t) * p.axis[1].x,
          p.centre.y + std::cos(t) * p.axis[0].y + std::sin(t) * p.axis[1].y};
}

/// Calls put(end, sweep) for equal parts of an arc of no more than `largest` each.
template <class Put>
void each_part(const PlanePiece& p, double largest, const Put& put) {
  const double sweep = std::abs(p.to - p.from);
  const int parts = std::max(1, int(std::ceil(sweep / largest - 1e-9)));
  for (int i = 1; i <= parts; ++i)
    put(i == parts ? p.end : at_angle(p, p.from + (p.to - p.from) * i / parts), sweep / parts);
}

void put_svg_piece(SvgText& text, const CutDrawing& drawing, const CutLine& line, const CutPiece& piece,
                   CutFileReport& report) {
  const PlanePiece p = in_plane(drawing, line, piece);
  if (p.kind == Kind::line) return text.put_relative('L', p.end);
  const EllipseAxes axes = main_axes(p);
  // Viewers solve for the centre again, in vain where an ellipse is long and the arc short.
  constexpr double longest = 1000;
  if (axes.longer > longest * axes.shorter) {
    report.has_chords = true;
    for (const Point q : plane_points(drawing, line, piece)) text.put_relative('L', q);
    return;
  }
  each_part(p, largest_svg_arc, [&](Point end, double) {
    text.format("A{} {} {} 0 {} {} {}", axes.longer, axes.shorter,
                p.kind == Kind::circle ? 0 : 0.0 - axes.angle * 180 / std::numbers::pi, is_clockwise(p) ? 1 : 0, end.x,
                0.0 - end.y);
  });
}

struct Frame {
  double west = std::numeric_limits<double>::infinity(), south = west, east = -west, north = -west;
  void add(Point p) {
    west = std::min(west, p.x), east = std::max(east, p.x), south = std::min(south, p.y), north = std::max(north, p.y);
  }
};

Frame frame_of(const CutDrawing& drawing) {
  Frame frame;
  for (const CutLine& line : drawing.lines) {
    for (const CutPiece& piece : line.pieces) {
      frame.add(in_plane(drawing, line, piece).start);
      for (const double s : {0.25, 0.5, 0.75, 1.0}) {
        CutPiece one;
        one.end = piece.at(s);
        frame.add(in_plane(drawing, line, one).end);
      }
    }
  }
  if (drawing.lines.empty()) frame = {0, 0, 1, 1};
  return frame;
}

/// From blue through green to brown.
std::string colour(double share) {
  constexpr std::array<std::array<double, 3>, 4> stops{{{29, 78, 126}, {30, 140, 120}, {170, 140, 40}, {150, 60, 30}}};
  const double place = std::clamp(share, 0.0, 1.0) * 3;
  const std::size_t i = std::min<std::size_t>(std::size_t(place), 2);
  const double t = place - double(i);
  const auto mix = [&](std::size_t k) { return int(std::lround(stops[i][k] + t * (stops[i + 1][k] - stops[i][k]))); };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2));
}

void put_svg_head(SvgText& text, const CutDrawing& drawing) {
  const Frame frame = frame_of(drawing);
  const double margin = 0.02 * std::max(frame.east - frame.west, frame.north - frame.south) + 1e-9;
  const double width = frame.east - frame.west + 2 * margin, height = frame.north - frame.south + 2 * margin;
  const double scale = 1000 / std::max(width, height);
  text.put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  text.format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"{} {} {} {}\" "
      "data-origin=\"{} {}\">\n",
      std::max(1.0, width * scale), std::max(1.0, height * scale), frame.west - margin, -frame.north - margin, width,
      height, drawing.of_contours ? drawing.origin.x : 0.0, drawing.of_contours ? drawing.origin.y : drawing.origin.z);
  text.put(
      "<style>path{fill:none;stroke-width:1;vector-effect:non-scaling-stroke;stroke-linejoin:round;stroke-linecap:"
      "round}</style>\n");
}

/// Vertices of a piece but for its end.
void append_vertices(const CutDrawing& drawing, const CutLine& line, const CutPiece& piece, Point shift,
                     std::vector<DxfDocument::Vertex>& vertices, CutFileReport& report) {
  const PlanePiece p = in_plane(drawing, line, piece);
  const auto add = [&](Point at, double bulge) { vertices.push_back({{at.x + shift.x, at.y + shift.y}, bulge}); };
  if (p.kind == Kind::circle) {
    Point last = p.start;
    each_part(p, std::numbers::pi, [&](Point end, double sweep) {
      add(last, (is_clockwise(p) ? -1 : 1) * std::tan(sweep / 4));
      last = end;
    });
    return;
  }
  add(p.start, 0);
  if (p.kind == Kind::line) return;
  report.has_chords = true;
  std::vector<Point> points = plane_points(drawing, line, piece);
  points.pop_back();
  for (const Point q : points) add(q, 0);
}

std::string layer_name(const CutLine& line) {
  return line.is_ring ? fmt::format("CONTOUR_{}", line.level) : fmt::format("SECTION_{}", line.cut);
}

}  // namespace

Status write_cut_csv(const std::string& path, const CutDrawing& drawing, const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  stream->write(drawing.of_contours ? "level,ring,hole,parent" : "section,chain");
  stream->write(",kind,wall,feature,x0,y0,z0,x1,y1,z1,cx,cy,cz,ux,uy,uz,vx,vy,vz,from,to\n");
  for (const CutLine& line : drawing.lines) {
    if (context.cancelled()) return interrupted();
    std::string text;
    const auto put = std::back_inserter(text);
    for (const CutPiece& piece : line.pieces) {
      if (!drawing.of_contours)
        fmt::format_to(put, "{},{}", line.cut, line.number);
      else {
        fmt::format_to(put, "{},{},{},", line.level, line.number, line.is_hole ? 1 : 0);
        if (line.parent >= 0) fmt::format_to(put, "{}", line.parent);
      }
      const Terrain::FeatureKind touched = drawing.terrain->feature_kind(piece.feature);
      fmt::format_to(put, ",{},{},{}{}", name_of(piece.kind), piece.wall ? 1 : 0, output::name_of(touched)[0],
                     piece.feature);
      const auto put_point = [&](Point3 p) { fmt::format_to(put, ",{},{},{}", p.x, p.y, p.z); };
      put_point(drawing.absolute(piece.start));
      put_point(drawing.absolute(piece.end));
      if (piece.kind == Kind::line)
        text += ",,,,,,,,,,,\n";
      else {
        put_point(drawing.absolute(piece.centre));
        put_point(piece.axis[0]);
        put_point(piece.axis[1]);
        fmt::format_to(put, ",{},{}\n", piece.from, piece.to);
      }
    }
    stream->write(text);
  }
  return stream->finish();
}

Status write_cut_svg(const std::string& path, const CutDrawing& drawing, CutFileReport& report,
                     const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  SvgText text({0, 0});
  put_svg_head(text, drawing);
  const double cuts = drawing.lines.empty() ? 1 : std::max<double>(1, double(drawing.lines.back().cut));
  for (std::size_t i = 0; i < drawing.lines.size(); ++i) {
    if (context.cancelled()) return interrupted();
    const CutLine& line = drawing.lines[i];
    if (i == 0 || line.cut != drawing.lines[i - 1].cut) {
      text.put(i == 0 ? "" : "</g>\n");
      if (drawing.of_contours)
        text.format("<g class=\"contour\" data-level=\"{}\"", line.level);
      else
        text.format("<g class=\"section\" data-section=\"{}\"", line.cut);
      text.format(" stroke=\"{}\">\n", colour(double(line.cut) / cuts));
    }
    text.put("<path d=\"");
    text.put_relative('M', in_plane(drawing, line, line.pieces.front()).start);
    for (const CutPiece& piece : line.pieces) put_svg_piece(text, drawing, line, piece, report);
    text.put(line.is_ring ? "Z\"/>\n" : "\"/>\n");
    text.flush(*stream);
  }
  text.put(drawing.lines.empty() ? "</svg>\n" : "</g>\n</svg>\n");
  text.flush(*stream);
  return stream->finish();
}

Status write_cut_dxf(const std::string& path, const CutDrawing& drawing, CutFileReport& report,
                     const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  std::vector<std::string> layers;
  for (const CutLine& line : drawing.lines) {
    if (layers.empty() || layers.back() != layer_name(line)) layers.push_back(layer_name(line));
  }
  DxfDocument document(*stream, layers, drawing.lines.size());
  const Point shift = drawing.of_contours ? Point{drawing.origin.x, drawing.origin.y} : Point{0, drawing.origin.z};
  for (const CutLine& line : drawing.lines) {
    if (context.cancelled()) return interrupted();
    std::vector<DxfDocument::Vertex> vertices;
    for (const CutPiece& piece : line.pieces) append_vertices(drawing, line, piece, shift, vertices, report);
    if (!line.is_ring) {
      const Point end = in_plane(drawing, line, line.pieces.back()).end;
      vertices.push_back({{end.x + shift.x, end.y + shift.y}, 0});
    }
    document.put(vertices, line.is_ring, layer_name(line), line.is_ring ? line.level : 0);
  }
  document.finish();
  return stream->finish();
}

}  // namespace krepl::output
