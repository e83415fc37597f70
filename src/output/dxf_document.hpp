#pragma once

#include <memory>
#include <string>
#include <vector>

#include "krepl/zone.hpp"
#include "output/output_stream.hpp"

namespace krepl::output {

/// A drawing of AutoCAD 2000 made of LWPOLYLINEs, whose bulges are true arcs. The sections before the entities are the
/// fewest that readers of this version insist on.
class DxfDocument {
 public:
  /// tangent of a quarter of the angle to the next vertex, positive counter-clockwise; 0: straight
  struct Vertex {
    Point at;
    double bulge;
  };

  /// All layers must be named, and the polylines counted, before the first one is put.
  DxfDocument(OutputStream& stream, const std::vector<std::string>& layers, std::size_t polylines);
  ~DxfDocument();
  DxfDocument(const DxfDocument&) = delete;
  DxfDocument& operator=(const DxfDocument&) = delete;

  /// `elevation`: z of all vertices.
  void put(const std::vector<Vertex>& vertices, bool closed, const std::string& layer, double elevation = 0);
  /// To be called once, after the last polyline.
  void finish();

  /// Vertices of an arc, as zones have it, but for its end.
  static std::vector<Vertex> arc_vertices(const Zone::Piece& arc);

 private:
  class Text;
  std::unique_ptr<Text> text_;
};

}  // namespace krepl::output
