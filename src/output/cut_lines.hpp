#pragma once

#include <span>
#include <string>
#include <vector>

#include "output/cut_file.hpp"
#include "output/output_stream.hpp"

namespace krepl::output {

/// A ring of a contour or a chain of a section, ready to be written. Pieces are relative to the terrain's origin.
struct CutLine {
  std::size_t cut = 0;     ///< number of the contour or section
  std::size_t number = 0;  ///< of the ring or chain in it
  double level = 0;        ///< of contours, absolute
  bool is_ring = false, is_hole = false;
  std::ptrdiff_t parent = -1;
  std::span<const CutPiece> pieces;
};

/// What all writers of cuts work on.
struct CutDrawing {
  std::vector<CutLine> lines;
  bool of_contours = false;
  Point3 origin;                      ///< of the terrain
  std::span<const Section> sections;  ///< for the plane of a drawing
  const Terrain* terrain = nullptr;
  CutFileOptions options;

  Point3 absolute(Point3 p) const { return {p.x + origin.x, p.y + origin.y, p.z + origin.z}; }
};

/// A piece in the plane of a drawing: x and y of a contour, distance and height of a section, both relative to the
/// origin.
struct PlanePiece {
  CutPiece::Kind kind;
  Point start, end, centre, axis[2];
  double from, to;
};
PlanePiece in_plane(const CutDrawing& drawing, const CutLine& line, const CutPiece& piece);

/// Half axes of an ellipse given by conjugate ones: the longer, the shorter, and the angle of the longer.
struct EllipseAxes {
  double longer, shorter, angle;
};
EllipseAxes main_axes(const PlanePiece& piece);

/// Points in the plane of a drawing after the piece's start, within max_error.
std::vector<Point> plane_points(const CutDrawing& drawing, const CutLine& line, const CutPiece& piece);

Status write_cut_csv(const std::string& path, const CutDrawing& drawing, const Context& context);
Status write_cut_svg(const std::string& path, const CutDrawing& drawing, CutFileReport& report, const Context& context);
Status write_cut_dxf(const std::string& path, const CutDrawing& drawing, CutFileReport& report, const Context& context);
Status write_cut_wkt(const std::string& path, const CutDrawing& drawing, CutFileReport& report, const Context& context);
Status write_cut_layer(const std::string& path, const std::string& driver, const CutDrawing& drawing,
                       CutFileReport& report, const Context& context);

}  // namespace krepl::output
