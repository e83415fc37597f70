#include "input/ogr_curve.hpp"

namespace krepl::input {

namespace {

Point point_at(const OGRSimpleCurve& curve, int i) { return {curve.getX(i), curve.getY(i)}; }

}  // namespace

void append_pieces(const OGRCurve& curve, std::vector<ResultPiece>& pieces) {
  switch (wkbFlatten(curve.getGeometryType())) {
    case wkbCompoundCurve:
      for (const OGRCurve* part : *curve.toCompoundCurve()) append_pieces(*part, pieces);
      return;
    case wkbCircularString: {
      const OGRSimpleCurve& arcs = *curve.toSimpleCurve();
      for (int i = 0; i + 2 < arcs.getNumPoints(); i += 2) {
        pieces.push_back({true, point_at(arcs, i), point_at(arcs, i + 1), point_at(arcs, i + 2)});
      }
      return;
    }
    default: {
      const OGRSimpleCurve& line = *curve.toSimpleCurve();
      for (int i = 0; i + 1 < line.getNumPoints(); ++i) {
        pieces.push_back({false, point_at(line, i), {}, point_at(line, i + 1)});
      }
    }
  }
}

std::optional<double> number_field(const OGRFeature* feature, const char* name) {
  if (feature == nullptr) return std::nullopt;
  int index = feature->GetFieldIndex(name);
  if (index < 0 || !feature->IsFieldSetAndNotNull(index)) return std::nullopt;
  return feature->GetFieldAsDouble(index);
}

}  // namespace krepl::input
