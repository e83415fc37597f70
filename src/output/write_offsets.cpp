// Parallel curves as lines with true arcs, or with chords where a format has no arcs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/curve_pieces.hpp"
#include "output/offset_file.hpp"
#include "output/ogr_dataset.hpp"
#include "output/ogr_geometry.hpp"
#include "output/output_stream.hpp"
#include "output/svg_text.hpp"

namespace krepl::output {

namespace {

Error interrupted() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }

using Written = Result<ZoneFileReport>;

/// Through `put` curve by curve, for the formats that have nothing but curves.
template <class Put>
Written write_stream(const std::string& path, std::span<const OffsetSet> sets, const Context& context, Put put) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  for (const OffsetSet& set : sets) {
    for (const OffsetCurve& curve : set.curves) {
      if (context.cancelled()) return interrupted();
      put(*stream, curve);
    }
  }
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

void put_wkb(OutputStream& stream, const OffsetCurve& curve) {
  const auto geometry = compound_curve(runs_of(curve.pieces));
  std::vector<unsigned char> bytes(geometry->WkbSize());
  geometry->exportToWkb(wkbNDR, bytes.data(), wkbVariantIso);
  stream.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Written write_dxf_curves(const std::string& path, std::span<const OffsetSet> sets, const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  const auto name = [](const OffsetSet& set) { return fmt::format("OFFSET_{}", set.distance); };
  std::vector<std::string> layers;
  std::size_t count = 0;
  for (const OffsetSet& set : sets) {
    if (std::find(layers.begin(), layers.end(), name(set)) == layers.end()) layers.push_back(name(set));
    count += set.curves.size();
  }
  DxfDocument document(*stream, layers, count);
  for (const OffsetSet& set : sets) {
    for (const OffsetCurve& curve : set.curves) {
      if (context.cancelled()) return interrupted();
      const auto vertices = bulges_of(curve.pieces, curve.closed);
      document.put(vertices, curve.closed, name(set));
    }
  }
  document.finish();
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

/// The box of the input, grown by the largest distance, relative to its origin.
void put_svg_head(SvgText& text, std::span<const OffsetSet> sets, const Network& network) {
  double reach = 0, west = 0, south = 0, east = 0, north = 0;
  for (const OffsetSet& set : sets) reach = std::max(reach, std::abs(set.distance));
  for (Point p : network.vertices()) {
    west = std::min(west, p.x), east = std::max(east, p.x), south = std::min(south, p.y), north = std::max(north, p.y);
  }
  const double margin = reach + 0.02 * std::max(east - west, north - south);
  const double width = east - west + 2 * margin, height = north - south + 2 * margin,
               scale = 1000 / std::max(width, height);
  text.put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  text.format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"{} {} {} {}\" "
      "data-origin=\"{} {}\">\n",
      std::max(1.0, width * scale), std::max(1.0, height * scale), west - margin, -north - margin, width, height,
      network.origin().x, network.origin().y);
  text.put(
      "<style>path{fill:none;vector-effect:non-scaling-stroke;stroke-linejoin:round;stroke-linecap:round}"
      ".offset path{stroke:#1d4e7e;stroke-width:1}.input path{stroke:#b3261e;stroke-width:1}</style>\n");
}

void put_svg_curve(SvgText& text, const OffsetCurve& curve, double radius) {
  text.put("<path d=\"");
  text.put_absolute('M', curve.pieces.front().start);
  for (const CurvePiece& piece : curve.pieces) {
    if (!is_arc(piece)) {
      text.put_absolute('L', piece.end);
      continue;
    }
    const std::vector<Point> ends = in_sense(piece, arc_ends(as_zone_piece(piece), largest_svg_arc));
    for (std::size_t i = 1; i < ends.size(); ++i) text.put_arc(radius, ends[i], piece.clockwise);
  }
  text.put(curve.closed ? "Z\"/>\n" : "\"/>\n");
}

Written write_svg_curves(const std::string& path, std::span<const OffsetSet> sets, const Network& network,
                         const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  SvgText text(network.origin());
  put_svg_head(text, sets, network);
  text.put("<g class=\"input\">\n");
  for (std::uint32_t part = 0; part < network.part_count(); ++part) {
    text.put("<path d=\"");
    char command = 'M';
    for (std::uint32_t v : network.part(part)) text.put_relative(command, network.vertices()[v]), command = 'L';
    text.put(network.part_is_ring(part) ? "Z\"/>\n" : "\"/>\n");
    text.flush(*stream);
  }
  text.put("</g>\n");
  for (const OffsetSet& set : sets) {
    text.format("<g class=\"offset\" data-distance=\"{}\">\n", set.distance);
    for (const OffsetCurve& curve : set.curves) {
      if (context.cancelled()) return interrupted();
      put_svg_curve(text, curve, std::abs(set.distance));
      text.flush(*stream);
    }
    text.put("</g>\n");
  }
  text.put("</svg>\n");
  text.flush(*stream);
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

Status write_layer(OgrDataset& dataset, std::span<const OffsetSet> sets, const OffsetFileOptions& options,
                   ZoneFileReport& report, const Context& context) {
  const bool curves = dataset.can(ODsCCurveGeometries);
  Result<OGRLayer*> layer = dataset.create_layer("offset", curves ? wkbCompoundCurve : wkbLineString,
                                                 {{"distance", OFTReal},
                                                  {"length", OFTReal},
                                                  {"closed", OFTInteger},
                                                  {"feature", OFTInteger64},
                                                  {"part", OFTInteger64}});
  if (!layer) return layer.error();
  for (const OffsetSet& set : sets) {
    const double radius = std::abs(set.distance);
    Linearizer linearizer(radius, options.max_error > 0 ? options.max_error : radius / 1000);
    for (const OffsetCurve& curve : set.curves) {
      if (context.cancelled()) return interrupted();
      OGRFeature row((*layer)->GetLayerDefn());
      if (dataset.has_fields()) {
        row.SetField("distance", set.distance);
        row.SetField("length", curve.length);
        row.SetField("closed", curve.closed ? 1 : 0);
        if (curve.feature >= 0) row.SetField("feature", GIntBig(curve.feature));
        row.SetField("part", GIntBig(curve.part));
      }
      if (curves)
        row.SetGeometryDirectly(compound_curve(runs_of(curve.pieces)).release());
      else
        row.SetGeometryDirectly(line_geometry(chords_of(curve.pieces, linearizer)).release());
      if (Status added = dataset.add(**layer, row); !added) return added;
    }
    if (!curves) report.deviation = std::max(report.deviation.value_or(0), linearizer.deviation());
  }
  return std::monostate{};
}

}  // namespace

Result<ZoneFileReport> write_offsets(const std::string& path, std::span<const OffsetSet> sets, const Network& network,
                                     const ZoneFormat& format, const OffsetFileOptions& options,
                                     const Context& context) {
  for (const OffsetSet& set : sets) {
    if (options.max_error > 0 && options.max_error < Linearizer::finest(std::abs(set.distance))) {
      return Error{ErrorCode::usage, "--max-error is too small for the distance", "",
                   "give at least 1e-12 of the distance"};
    }
  }
  switch (format.kind) {
    case ZoneFormat::Kind::wkt:
      return write_stream(path, sets, context, [](OutputStream& s, const OffsetCurve& curve) { s.write(wkt_of(curve.pieces)); });
    case ZoneFormat::Kind::wkb:
      return write_stream(path, sets, context, put_wkb);
    case ZoneFormat::Kind::dxf:
      return write_dxf_curves(path, sets, context);
    case ZoneFormat::Kind::svg:
      return write_svg_curves(path, sets, network, context);
    case ZoneFormat::Kind::geojson:
    case ZoneFormat::Kind::ogr:
      break;
  }
  ZoneFileReport report;
  const std::string driver = format.kind == ZoneFormat::Kind::geojson ? "GeoJSON" : format.driver;
  Status written = write_dataset(path, driver, options.crs, report.notes, [&](OgrDataset& dataset) {
    return write_layer(dataset, sets, options, report, context);
  });
  if (!written) return written.error();
  return report;
}

}  // namespace krepl::output
