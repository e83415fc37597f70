#pragma once

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "solid/borders.hpp"
#include "solid/brep.hpp"
#include "solid/curve.hpp"

namespace krepl::solid {

/// An edge and the way a loop runs along it.
struct Directed {
  int edge = -1;
  bool reversed = false;
};

/// Edges and faces of a solid, as they are made. Corners and edges are known by number.
class BrepBuilder {
 public:
  BrepBuilder(Point3 origin, double curve_tolerance);

  int add_corner(Point3 place);
  Point3 corner(int c) const { return corner_[std::size_t(c)]; }
  int add_edge(const Curve& curve, int from, int to);
  /// A face on the outward side of a patch, to the left of its loops; coordinates are relative to the origin.
  void add_face(const Patch& patch, const std::vector<std::vector<Directed>>& loops);
  /// So many points along an edge, ends included.
  std::vector<Point3> points(int edge, int count) const;

  /// The faces as shells or solids, those together that share edges.
  TopoDS_Shape finish(bool closed, std::size_t& shells);
  double deviation() const { return deviation_; }
  std::size_t edge_count() const { return edge_.size(); }

 private:
  struct Edge {
    Curve curve;
    int from, to;
    TopoDS_Edge shape;
    int face = -1;  // one that has it
  };
  void set_tolerance(Edge& edge, double deviation);
  int root(int face);

  Point3 origin_;
  double curve_tolerance_, deviation_ = 0;
  std::vector<Point3> corner_;
  std::vector<TopoDS_Vertex> vertex_;
  std::vector<Edge> edge_;
  std::vector<TopoDS_Face> face_;
  std::vector<int> parent_;  // faces of one shell have one root
};

}  // namespace krepl::solid
