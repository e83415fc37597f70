#include "solid/brep_builder.hpp"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <numeric>

namespace krepl::solid {

namespace {

constexpr double least_tolerance = 1e-7;  // OpenCASCADE tells nothing closer apart
constexpr double margin = 2;              // deviations are those of samples

}  // namespace

BrepBuilder::BrepBuilder(Point3 origin, double curve_tolerance) : origin_(origin), curve_tolerance_(curve_tolerance) {}

int BrepBuilder::add_corner(Point3 place) {
  corner_.push_back(place);
  TopoDS_Vertex vertex;
  BRep_Builder().MakeVertex(vertex, to_occ(place + origin_), least_tolerance);
  vertex_.push_back(vertex);
  return int(corner_.size()) - 1;
}

int BrepBuilder::add_edge(const Curve& curve, int from, int to) {
  BRep_Builder builder;
  Edge edge{curve, from, to, {}, -1};
  const gp_Vec shift(origin_.x, origin_.y, origin_.z);
  builder.MakeEdge(edge.shape, Handle(Geom_Curve)::DownCast(curve.curve->Translated(shift)), least_tolerance);
  builder.Add(edge.shape, vertex_[std::size_t(from)].Oriented(TopAbs_FORWARD));
  builder.Add(edge.shape, vertex_[std::size_t(to)].Oriented(TopAbs_REVERSED));
  builder.Range(edge.shape, curve.first, curve.last);
  const double gap = std::max(distance(from_occ(curve.curve->Value(curve.first)), corner(from)),
                              distance(from_occ(curve.curve->Value(curve.last)), corner(to)));
  deviation_ = std::max(deviation_, gap);
  for (const int c : {from, to}) builder.UpdateVertex(vertex_[std::size_t(c)], std::max(least_tolerance, margin * gap));
  edge_.push_back(std::move(edge));
  return int(edge_.size()) - 1;
}

std::vector<Point3> BrepBuilder::points(int e, int count) const {
  const Curve& curve = edge_[std::size_t(e)].curve;
  std::vector<Point3> result;
  for (int i = 0; i < count; ++i)
    result.push_back(from_occ(curve.curve->Value(curve.first + (curve.last - curve.first) * i / (count - 1))));
  return result;
}

void BrepBuilder::set_tolerance(Edge& edge, double deviation) {
  deviation_ = std::max(deviation_, deviation);
  const double tolerance = std::max(least_tolerance, margin * deviation);
  BRep_Builder builder;
  builder.UpdateEdge(edge.shape, tolerance);
  for (const int c : {edge.from, edge.to}) builder.UpdateVertex(vertex_[std::size_t(c)], tolerance);
}

void BrepBuilder::add_face(const Patch& patch, const std::vector<std::vector<Directed>>& loops) {
  BRep_Builder builder;
  Patch placed = patch;
  placed.at = placed.at + origin_;
  const Handle(Geom_Surface) surface = to_occ(placed);
  TopoDS_Face face;
  builder.MakeFace(face, surface, least_tolerance);
  const int number = int(face_.size());
  parent_.push_back(number);
  for (const auto& loop : loops) {
    TopoDS_Wire wire;
    builder.MakeWire(wire);
    for (const auto& [e, reversed] : loop) {
      Edge& edge = edge_[std::size_t(e)];
      if (patch.kind == Patch::Kind::plane) {
        set_tolerance(edge, solid::deviation(patch, edge.curve));
      } else {
        const Trace trace = trace_on(patch, edge.curve, curve_tolerance_);
        builder.UpdateEdge(edge.shape, trace.curve, surface, TopLoc_Location(), least_tolerance);
        set_tolerance(edge, trace.deviation);
      }
      builder.Add(wire, edge.shape.Oriented(reversed ? TopAbs_REVERSED : TopAbs_FORWARD));
      if (edge.face < 0) edge.face = number;
      parent_[std::size_t(root(number))] = root(edge.face);
    }
    wire.Closed(true);
    builder.Add(face, wire);
  }
  face_.push_back(face);
}

int BrepBuilder::root(int f) {
  while (parent_[std::size_t(f)] != f) f = parent_[std::size_t(f)] = parent_[std::size_t(parent_[std::size_t(f)])];
  return f;
}

TopoDS_Shape BrepBuilder::finish(bool closed, std::size_t& shells) {
  BRep_Builder builder;
  std::map<int, std::vector<int>> parts;  // by their first face, so that the order is that of the faces
  std::vector<int> first(face_.size(), -1);
  for (int f = 0; f < int(face_.size()); ++f) {
    int& least = first[std::size_t(root(f))];
    if (least < 0) least = f;
    parts[least].push_back(f);
  }
  std::vector<TopoDS_Shape> shapes;
  for (const auto& [least, faces] : parts) {
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    for (const int f : faces) builder.Add(shell, face_[std::size_t(f)]);
    shell.Closed(closed);
    if (!closed) {
      shapes.push_back(shell);
      continue;
    }
    TopoDS_Solid solid;
    builder.MakeSolid(solid);
    builder.Add(solid, shell);
    shapes.push_back(solid);
  }
  shells = shapes.size();
  if (shapes.size() == 1) return shapes[0];
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

}  // namespace krepl::solid
