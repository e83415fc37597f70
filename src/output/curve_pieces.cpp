#include "output/curve_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace krepl::output {

namespace {

void put_points(fmt::memory_buffer& text, const std::vector<Point>& points) {
  const char* before = "(";
  for (Point p : points) {
    fmt::format_to(std::back_inserter(text), "{}{} {}", before, p.x, p.y);
    before = ", ";
  }
  text.push_back(')');
}

}  // namespace

Zone::Piece as_zone_piece(const CurvePiece& p) {
  const Zone::Kind kind = p.arc ? Zone::Kind::arc : Zone::Kind::segment;
  return p.arc && p.clockwise ? Zone::Piece{kind, p.end, p.start, p.center, 0, false, 0}
                              : Zone::Piece{kind, p.start, p.end, p.center, 0, false, 0};
}

bool is_arc(const CurvePiece& p) { return p.arc && !is_negligible(as_zone_piece(p)); }

std::vector<Point> in_sense(const CurvePiece& p, std::vector<Point> points) {
  if (p.clockwise) std::reverse(points.begin(), points.end());
  return points;
}

std::vector<CurveRun> runs_of(std::span<const CurvePiece> pieces) {
  std::vector<CurveRun> runs;
  for (const CurvePiece& piece : pieces) {
    const bool arc = is_arc(piece);
    if (runs.empty() || runs.back().arc != arc) runs.push_back({arc, {piece.start}});
    const std::vector<Point> along =
        arc ? in_sense(piece, arc_points(as_zone_piece(piece))) : std::vector<Point>{piece.start, piece.end};
    runs.back().points.insert(runs.back().points.end(), along.begin() + 1, along.end());
  }
  return runs;
}

std::vector<Point> chords_of(std::span<const CurvePiece> pieces, Linearizer& linearizer) {
  std::vector<Point> points{pieces.front().start};
  for (const CurvePiece& piece : pieces) {
    if (!is_arc(piece)) {
      points.push_back(piece.end);
      continue;
    }
    const Zone::Piece arc = as_zone_piece(piece);
    std::vector<Point> along{arc.start};
    linearizer.append_arc(arc, along);
    along = in_sense(piece, std::move(along));
    points.insert(points.end(), along.begin() + 1, along.end());
  }
  return points;
}

std::string wkt_of(std::span<const CurvePiece> pieces) {
  const std::vector<CurveRun> runs = runs_of(pieces);
  fmt::memory_buffer text;
  const auto put = [&](std::string_view s) { text.append(s.data(), s.data() + s.size()); };
  put(runs.size() > 1 ? "COMPOUNDCURVE (" : runs[0].arc ? "" : "LINESTRING ");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    put(i > 0 ? ", " : "");
    put(runs[i].arc ? "CIRCULARSTRING " : "");
    put_points(text, runs[i].points);
  }
  put(runs.size() > 1 ? ")\n" : "\n");
  return fmt::to_string(text);
}

std::vector<DxfDocument::Vertex> bulges_of(std::span<const CurvePiece> pieces, bool closed) {
  std::vector<DxfDocument::Vertex> vertices;
  for (const CurvePiece& piece : pieces) {
    if (!is_arc(piece)) {
      vertices.push_back({piece.start, 0});
      continue;
    }
    // A bulge stands at the start of its arc: turned round, each goes to the other end.
    auto along = DxfDocument::arc_vertices(as_zone_piece(piece));
    along.push_back({as_zone_piece(piece).end, 0});
    for (std::size_t i = along.size() - 1; piece.clockwise && i > 0; --i) along[i].bulge = -along[i - 1].bulge;
    if (piece.clockwise) std::reverse(along.begin(), along.end());
    vertices.insert(vertices.end(), along.begin(), along.end() - 1);
  }
  if (!closed) vertices.push_back({pieces.back().end, 0});
  return vertices;
}

}  // namespace krepl::output
