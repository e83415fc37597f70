#include "solid/inspection.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

namespace krepl::solid {

namespace {

bool is_sound(const BRepCheck_ListOfStatus& found) {
  for (const BRepCheck_Status status : found)
    if (status != BRepCheck_NoError) return false;
  return true;
}

bool is_sound(const Handle(BRepCheck_Result) & result) {
  if (result.IsNull()) return true;
  if (!is_sound(result->Status())) return false;
  for (result->InitContextIterator(); result->MoreShapeInContext(); result->NextShapeInContext())
    if (!is_sound(result->StatusOnShape())) return false;
  return true;
}

}  // namespace

std::optional<Point3> fault_of(const TopoDS_Shape& shape) {
  const BRepCheck_Analyzer analyzer(shape);
  if (analyzer.IsValid()) return std::nullopt;
  for (const TopAbs_ShapeEnum type :
       {TopAbs_VERTEX, TopAbs_EDGE, TopAbs_WIRE, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID}) {
    TopTools_IndexedMapOfShape parts;
    TopExp::MapShapes(shape, type, parts);
    for (int i = 1; i <= parts.Extent(); ++i) {
      if (is_sound(analyzer.Result(parts(i)))) continue;
      const TopExp_Explorer vertices(parts(i), TopAbs_VERTEX);
      if (!vertices.More()) continue;
      const gp_Pnt p = BRep_Tool::Pnt(TopoDS::Vertex(vertices.Current()));
      return Point3{p.X(), p.Y(), p.Z()};
    }
  }
  return Point3{};
}

Inspection inspect(const TopoDS_Shape& shape) {
  Inspection result;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face face = TopoDS::Face(faces.Current());
    switch (BRepAdaptor_Surface(face, false).GetType()) {
      case GeomAbs_Plane:
        ++result.faces[0];
        break;
      case GeomAbs_Cylinder:
        ++result.faces[1];
        break;
      case GeomAbs_Sphere:
        ++result.faces[2];
        break;
      default:
        ++result.faces[3];
    }
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(face, properties, 1e-9);
    result.area += properties.Mass();
  }
  result.fault = fault_of(shape);
  return result;
}

Result<TopoDS_Shape> read_step(const std::string& path, const std::string& unit) {
  const Error unreadable{ErrorCode::io, "OpenCASCADE cannot read the file", "", ""};
  try {
    silence();
    STEPControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", unit_name(unit));
    STEPControl_Reader reader;
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone || reader.TransferRoots() < 1) return unreadable;
    return reader.OneShape();
  } catch (const Standard_Failure&) {
    return unreadable;
  }
}

const char* unit_name(const std::string& unit) {
  constexpr const char* known[][2] = {{"mm", "MM"}, {"cm", "CM"},   {"m", "M"},
                                      {"km", "KM"}, {"in", "INCH"}, {"ft", "FT"}};
  for (const auto& [name, other] : known)
    if (unit == name) return other;
  return nullptr;
}

void silence() { Message::DefaultMessenger()->ChangePrinters().Clear(); }

}  // namespace krepl::solid
