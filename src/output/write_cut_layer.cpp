// Contours and sections as geometries of OGR.
#include <cmath>
#include <numbers>

#include "output/cut_lines.hpp"
#include "output/ogr_dataset.hpp"

namespace krepl::output {

namespace {

using Kind = CutPiece::Kind;

Error interrupted() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }

/// In space; an arc's middle and end points go into circular strings, which are arcs in plan only.
class GeometryWriter {
 public:
  GeometryWriter(const CutDrawing& drawing, CutFileReport& report) : drawing_(drawing), report_(report) {}

  std::unique_ptr<OGRLineString> chords(const CutLine& line) const {
    auto geometry = std::make_unique<OGRLineString>();
    add(*geometry, line.pieces.front().start);
    for (const CutPiece& piece : line.pieces) append_chords(piece, *geometry);
    return geometry;
  }

  std::unique_ptr<OGRCompoundCurve> curves(const CutLine& line) const {
    auto compound = std::make_unique<OGRCompoundCurve>();
    for (std::size_t i = 0; i < line.pieces.size();) {
      const bool arcs = line.pieces[i].kind == Kind::circle;
      std::unique_ptr<OGRSimpleCurve> run;
      if (arcs)
        run = std::make_unique<OGRCircularString>();
      else
        run = std::make_unique<OGRLineString>();
      add(*run, line.pieces[i].start);
      for (; i < line.pieces.size() && (line.pieces[i].kind == Kind::circle) == arcs; ++i) {
        if (arcs)
          append_arc(line.pieces[i], *run);
        else
          append_chords(line.pieces[i], *run);
      }
      compound->addCurveDirectly(run.release());
    }
    return compound;
  }

 private:
  void add(OGRSimpleCurve& curve, Point3 p) const {
    const Point3 q = drawing_.absolute(p);
    curve.addPoint(q.x, q.y, q.z);
  }
  void append_arc(const CutPiece& piece, OGRSimpleCurve& curve) const {
    const int arcs = std::max(1, int(std::ceil(std::abs(piece.to - piece.from) / (0.7 * std::numbers::pi))));
    for (int i = 1; i <= 2 * arcs; ++i) add(curve, i == 2 * arcs ? piece.end : piece.at(double(i) / (2 * arcs)));
  }
  void append_chords(const CutPiece& piece, OGRSimpleCurve& curve) const {
    if (piece.kind != Kind::line) report_.has_chords = true;
    std::vector<Point3> points;
    piece.append_points(drawing_.options.max_error, points);
    for (const Point3 p : points) add(curve, p);
  }

  const CutDrawing& drawing_;
  CutFileReport& report_;
};

Status write_rows(OgrDataset& dataset, const CutDrawing& drawing, CutFileReport& report, const Context& context) {
  const bool curves = drawing.of_contours && dataset.can(ODsCCurveGeometries);
  const OGRwkbGeometryType type = curves ? wkbCompoundCurveZ : wkbLineString25D;
  Result<OGRLayer*> layer =
      drawing.of_contours
          ? dataset.create_layer(
                "contour", type,
                {{"level", OFTReal}, {"ring", OFTInteger64}, {"hole", OFTInteger}, {"parent", OFTInteger64}})
          : dataset.create_layer("section", type, {{"section", OFTInteger64}, {"chain", OFTInteger64}});
  if (!layer) return layer.error();
  const GeometryWriter writer(drawing, report);
  for (const CutLine& line : drawing.lines) {
    if (context.cancelled()) return interrupted();
    OGRFeature row((*layer)->GetLayerDefn());
    if (dataset.has_fields() && drawing.of_contours) {
      row.SetField("level", line.level);
      row.SetField("ring", GIntBig(line.number));
      row.SetField("hole", line.is_hole ? 1 : 0);
      if (line.parent >= 0) row.SetField("parent", GIntBig(line.parent));
    } else if (dataset.has_fields()) {
      row.SetField("section", GIntBig(line.cut));
      row.SetField("chain", GIntBig(line.number));
    }
    if (curves)
      row.SetGeometryDirectly(writer.curves(line).release());
    else
      row.SetGeometryDirectly(writer.chords(line).release());
    if (Status added = dataset.add(**layer, row); !added) return added;
  }
  return std::monostate{};
}

}  // namespace

Status write_cut_wkt(const std::string& path, const CutDrawing& drawing, CutFileReport& report,
                     const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  const GeometryWriter writer(drawing, report);
  OGRWktOptions options;
  options.variant = wkbVariantIso;
  options.precision = 17;
  options.format = OGRWktFormat::G;
  for (const CutLine& line : drawing.lines) {
    if (context.cancelled()) return interrupted();
    if (drawing.of_contours)
      stream->write(writer.curves(line)->exportToWkt(options));
    else
      stream->write(writer.chords(line)->exportToWkt(options));
    stream->write("\n");
  }
  return stream->finish();
}

Status write_cut_layer(const std::string& path, const std::string& driver, const CutDrawing& drawing,
                       CutFileReport& report, const Context& context) {
  return write_dataset(path, driver, drawing.options.crs, report.notes,
                       [&](OgrDataset& dataset) { return write_rows(dataset, drawing, report, context); });
}

}  // namespace krepl::output
