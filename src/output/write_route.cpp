// A route in the plane as a curve of lines and arcs, as rows, or as a picture (write_route_svg.cpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "output/curve_pieces.hpp"
#include "output/ogr_dataset.hpp"
#include "output/ogr_geometry.hpp"
#include "output/output_stream.hpp"
#include "output/route_file.hpp"
#include "output/route_svg.hpp"

namespace krepl::output {

namespace {

using Written = Result<ZoneFileReport>;

/// The piece as segments and arcs: parabolas become chords of equal parameter steps, which deviate most in the middle,
/// by |start - 2 control + end| / (4 n^2).
void append_curves(const Route::Piece& piece, double max_error, std::vector<CurvePiece>& out, double& deviation) {
  if (piece.kind != Route::Kind::parabola) {
    out.push_back({piece.kind == Route::Kind::arc, piece.clockwise, piece.start, piece.end, piece.center});
    return;
  }
  const double bend =
      std::hypot(piece.start.x - 2 * piece.control.x + piece.end.x, piece.start.y - 2 * piece.control.y + piece.end.y);
  const double most = 1 << 16, steps = std::clamp(std::ceil(std::sqrt(bend / (4 * max_error))), 1.0, most);
  Point before = piece.start;
  for (double i = 1; i <= steps; ++i) {
    const double t = i / steps, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
    const Point at = i == steps ? piece.end
                                : Point{a * piece.start.x + b * piece.control.x + c * piece.end.x,
                                        a * piece.start.y + b * piece.control.y + c * piece.end.y};
    out.push_back({false, false, before, at, {}});
    before = at;
  }
  deviation = std::max(deviation, bend / (4 * steps * steps));
}

const char* kind_name(Route::Kind kind) {
  return kind == Route::Kind::line ? "line" : kind == Route::Kind::arc ? "arc" : "parabola";
}

std::int64_t feature_of(const Network& network, const Route::Piece& piece) {
  return piece.vertex == Route::none ? -1 : network.vertex_source(piece.vertex).feature;
}

Written write_csv(const std::string& path, const Route& route, const Network& network) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  fmt::memory_buffer text;
  const auto put = [&](std::string_view s) { text.append(s.data(), s.data() + s.size()); };
  put("kind,x0,y0,x1,y1,cx,cy,sense,vertex,feature,length,clearance\n");
  for (const Route::Piece& p : route.pieces) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},", kind_name(p.kind), p.start.x, p.start.y, p.end.x,
                   p.end.y);
    if (p.kind == Route::Kind::line)
      put(",,,,,");
    else
      fmt::format_to(std::back_inserter(text), "{},{},{},", p.center.x, p.center.y,
                     p.kind == Route::Kind::parabola ? ""
                     : p.clockwise                   ? "cw"
                                                     : "ccw");
    if (p.kind != Route::Kind::line && p.vertex == Route::none) put(",,");
    if (p.kind != Route::Kind::line && p.vertex != Route::none)
      fmt::format_to(std::back_inserter(text), "{},{},", p.vertex, feature_of(network, p));
    fmt::format_to(std::back_inserter(text), "{},", p.length);
    if (std::isfinite(p.clearance)) fmt::format_to(std::back_inserter(text), "{}", p.clearance);
    put("\n");
  }
  stream->write({text.data(), text.size()});
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

Written write_text(const std::string& path, const std::vector<CurvePiece>& pieces, bool binary) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  if (binary) {
    const auto geometry = compound_curve(runs_of(pieces));
    std::vector<unsigned char> bytes(geometry->WkbSize());
    geometry->exportToWkb(wkbNDR, bytes.data(), wkbVariantIso);
    stream->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } else {
    stream->write(wkt_of(pieces));
  }
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

Written write_dxf_route(const std::string& path, const std::vector<CurvePiece>& pieces) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  DxfDocument document(*stream, {"ROUTE"}, 1);
  document.put(bulges_of(pieces, false), false, "ROUTE");
  document.finish();
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

/// One route, its pieces as curves, and how far chords may be off.
class RouteLayers {
 public:
  RouteLayers(const Route& route, const Network& network, const std::vector<CurvePiece>& pieces, double max_error)
      : route_(route),
        network_(network),
        pieces_(pieces),
        max_error_(max_error),
        linearizer_(route.turn_radius > 0 ? route.turn_radius : 1, max_error) {}

  Status write(OgrDataset& dataset) {
    curves_ = dataset.can(ODsCCurveGeometries);
    Result<OGRLayer*> layer = dataset.create_layer(
        "route", type(), {{"radius", OFTReal}, {"length", OFTReal}, {"clearance", OFTReal}, {"widest", OFTReal}});
    if (!layer) return layer.error();
    OGRFeature row((*layer)->GetLayerDefn());
    if (dataset.has_fields()) {
      row.SetField("radius", route_.radius);
      row.SetField("length", route_.length);
      if (std::isfinite(route_.clearance)) row.SetField("clearance", route_.clearance);
      if (route_.widest > 0 && std::isfinite(route_.widest)) row.SetField("widest", route_.widest);
    }
    set_geometry(row, pieces_);
    if (Status added = dataset.add(**layer, row); !added) return added;
    return dataset.driver() == "GPKG" ? write_pieces(dataset) : Status(std::monostate{});
  }
  bool has_curves() const { return curves_; }
  double deviation() const { return linearizer_.deviation(); }

 private:
  OGRwkbGeometryType type() const { return curves_ ? wkbCompoundCurve : wkbLineString; }
  void set_geometry(OGRFeature& row, const std::vector<CurvePiece>& pieces) {
    if (curves_)
      row.SetGeometryDirectly(compound_curve(runs_of(pieces)).release());
    else
      row.SetGeometryDirectly(line_geometry(chords_of(pieces, linearizer_)).release());
  }

  Status write_pieces(OgrDataset& dataset) {
    Result<OGRLayer*> layer = dataset.create_layer("pieces", type(),
                                                   {{"kind", OFTString},
                                                    {"length", OFTReal},
                                                    {"clearance", OFTReal},
                                                    {"x", OFTReal},
                                                    {"y", OFTReal},
                                                    {"vertex", OFTInteger64},
                                                    {"feature", OFTInteger64}});
    if (!layer) return layer.error();
    for (const Route::Piece& piece : route_.pieces) {
      OGRFeature row((*layer)->GetLayerDefn());
      row.SetField("kind", kind_name(piece.kind));
      row.SetField("length", piece.length);
      if (std::isfinite(piece.clearance)) row.SetField("clearance", piece.clearance);
      if (piece.kind != Route::Kind::line) {
        row.SetField("x", piece.center.x), row.SetField("y", piece.center.y);
        if (piece.vertex != Route::none) {
          row.SetField("vertex", GIntBig(piece.vertex));
          row.SetField("feature", GIntBig(feature_of(network_, piece)));
        }
      }
      std::vector<CurvePiece> curve;
      double unused = 0;
      append_curves(piece, max_error_, curve, unused);
      set_geometry(row, curve);
      if (Status added = dataset.add(**layer, row); !added) return added;
    }
    return std::monostate{};
  }

  const Route& route_;
  const Network& network_;
  const std::vector<CurvePiece>& pieces_;
  double max_error_;
  Linearizer linearizer_;
  bool curves_ = false;
};

}  // namespace

Result<RouteFormat> find_route_format(const std::string& path, const std::string& asked) {
  const auto ends_in_csv = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text == "csv" || text.ends_with(".csv");
  };
  if (ends_in_csv(asked.empty() ? path : asked)) return RouteFormat{true, {}};
  Result<ZoneFormat> format = find_zone_format(path, asked);
  if (!format) return format.error();
  return RouteFormat{false, *format};
}

Result<ZoneFileReport> write_route(const std::string& path, const Route& route, const Network& network,
                                   const Zone* zone, const RouteFormat& format, const RouteFileOptions& options,
                                   const Context& context) {
  const double max_error = options.max_error > 0 ? options.max_error : route.radius / 1000;
  if (max_error < Linearizer::finest(std::max(route.radius, route.turn_radius)))
    return Error{ErrorCode::usage, "--max-error is too small for the radius", "", "give at least 1e-12 of the radius"};
  if (format.csv) return write_csv(path, route, network);
  if (format.curves.kind == ZoneFormat::Kind::svg) return write_route_svg(path, route, network, zone, context);
  std::vector<CurvePiece> pieces;
  double deviation = 0;
  for (const Route::Piece& piece : route.pieces) append_curves(piece, max_error, pieces, deviation);
  ZoneFileReport report;
  switch (format.curves.kind) {
    case ZoneFormat::Kind::wkt:
    case ZoneFormat::Kind::wkb: {
      Written written = write_text(path, pieces, format.curves.kind == ZoneFormat::Kind::wkb);
      if (!written) return written;
      break;
    }
    case ZoneFormat::Kind::dxf: {
      Written written = write_dxf_route(path, pieces);
      if (!written) return written;
      break;
    }
    default: {
      const bool geojson = format.curves.kind == ZoneFormat::Kind::geojson;
      RouteLayers layers(route, network, pieces, max_error);
      Status written = write_dataset(path, geojson ? "GeoJSON" : format.curves.driver, options.crs, report.notes,
                                     [&](OgrDataset& dataset) { return layers.write(dataset); });
      if (!written) return written.error();
      if (!layers.has_curves()) report.deviation = std::max(deviation, layers.deviation());
    }
  }
  if (!report.deviation && deviation > 0) report.deviation = deviation;
  return report;
}

}  // namespace krepl::output
