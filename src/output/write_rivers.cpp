// Sub-rivers, reaches and nodes as vector files. Numbers start at 1, as people count; a missing one is NULL.
#include <fmt/format.h>

#include <iterator>

#include "output/ogr_dataset.hpp"
#include "output/ogr_geometry.hpp"
#include "output/output_stream.hpp"
#include "output/river_file.hpp"
#include "output/river_writers.hpp"

namespace krepl::output {

namespace {

using Index = RiverNetwork::Index;
using Notes = Result<std::vector<std::string>>;

Error interrupted() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }

std::size_t line_count(const RiverNetwork& rivers, const RiverFileOptions& options) {
  return options.reaches ? rivers.reaches().size() : rivers.sub_rivers().size();
}

std::vector<Point> line(const RiverNetwork& rivers, const RiverFileOptions& options, Index i) {
  if (!options.reaches) return rivers.sub_river_line(i);
  const auto points = rivers.reach_line(i);
  return {points.begin(), points.end()};
}

class RiverLayers {
 public:
  RiverLayers(const RiverNetwork& rivers, OgrDataset& dataset, const AttributeRows& attributes,
              std::vector<std::string>& notes, const Context& context)
      : rivers_(rivers), dataset_(dataset), attributes_(attributes), notes_(notes), context_(context) {}

  Status write_sub_rivers() {
    Result<OGRLayer*> layer = dataset_.create_layer("sub_rivers", wkbLineString, sub_river_fields());
    if (!layer) return layer.error();
    SourceAttributes source(attributes_);
    if (Status made = source.create(**layer, dataset_, notes_); !made) return made;
    return write(**layer, rivers_.sub_rivers().size(), [&](OGRFeature& row, Index s) {
      if (dataset_.has_fields()) {
        set_sub_river(row, rivers_, s);
        source.set(row, rivers_.sub_rivers()[s].feature);
      }
      row.SetGeometryDirectly(line_geometry(rivers_.sub_river_line(s)).release());
    });
  }

  Status write_reaches() {
    Result<OGRLayer*> layer = dataset_.create_layer("reaches", wkbLineString,
                                                    {{"id", OFTInteger64},
                                                     {"sub_river", OFTInteger64},
                                                     {"strahler", OFTInteger},
                                                     {"length", OFTReal},
                                                     {"from_node", OFTInteger64},
                                                     {"to_node", OFTInteger64},
                                                     {"cycle", OFTInteger},
                                                     {"feature", OFTInteger64}});
    if (!layer) return layer.error();
    SourceAttributes source(attributes_);
    std::vector<std::string> told;  // sub-rivers have told them
    if (Status made = source.create(**layer, dataset_, dataset_.driver() == "GPKG" ? told : notes_); !made) return made;
    return write(**layer, rivers_.reaches().size(), [&](OGRFeature& row, Index r) {
      if (dataset_.has_fields()) {
        set_reach(row, r);
        source.set(row, rivers_.reaches()[r].feature);
      }
      row.SetGeometryDirectly(line_geometry(rivers_.reach_line(r)).release());
    });
  }

  Status write_nodes() {
    Result<OGRLayer*> layer = dataset_.create_layer(
        "nodes", wkbPoint, {{"id", OFTInteger64}, {"kind", OFTString}, {"n_in", OFTInteger}, {"n_out", OFTInteger}});
    if (!layer) return layer.error();
    return write(**layer, rivers_.nodes().size(), [&](OGRFeature& row, Index n) {
      const RiverNetwork::Node& node = rivers_.nodes()[n];
      row.SetField("id", GIntBig(n) + 1);
      row.SetField("kind", node.is_source()        ? "source"
                           : node.is_drain()       ? "drain"
                           : node.is_fusion()      ? "fusion"
                           : node.is_bifurcation() ? "bifurcation"
                                                   : "joint");
      row.SetField("n_in", int(node.in));
      row.SetField("n_out", int(node.out));
      row.SetGeometryDirectly(new OGRPoint(node.at.x, node.at.y));
    });
  }

 private:
  void set_reach(OGRFeature& row, Index r) const {
    const RiverNetwork::Reach& reach = rivers_.reaches()[r];
    row.SetField("id", GIntBig(r) + 1);
    row.SetField("sub_river", GIntBig(reach.sub_river) + 1);
    row.SetField("strahler", int(reach.order));
    row.SetField("length", reach.length);
    row.SetField("from_node", GIntBig(reach.from) + 1);
    row.SetField("to_node", GIntBig(reach.to) + 1);
    row.SetField("cycle", reach.closes_cycle ? 1 : 0);
    if (reach.feature >= 0) row.SetField("feature", GIntBig(reach.feature));
  }

  template <class Fill>
  Status write(OGRLayer& layer, std::size_t count, Fill fill) {
    for (std::size_t i = 0; i < count; ++i) {
      if (context_.cancelled()) return interrupted();
      if (context_.progress && i % 1024 == 0) context_.progress(double(i) / double(count));
      OGRFeature feature(layer.GetLayerDefn());
      fill(feature, Index(i));
      if (Status added = dataset_.add(layer, feature); !added) return added;
    }
    return std::monostate{};
  }

  const RiverNetwork& rivers_;
  OgrDataset& dataset_;
  const AttributeRows& attributes_;
  std::vector<std::string>& notes_;
  const Context& context_;
};

Status write_layers(OgrDataset& dataset, const RiverNetwork& rivers, const RiverFileOptions& options,
                    std::vector<std::string>& notes, const Context& context) {
  RiverLayers layers(rivers, dataset, options.attributes, notes, context);
  const bool all = dataset.driver() == "GPKG";
  if (all || !options.reaches) {
    if (Status written = layers.write_sub_rivers(); !written) return written;
  }
  if (all || options.reaches) {
    if (Status written = layers.write_reaches(); !written) return written;
  }
  return all ? layers.write_nodes() : Status(std::monostate{});
}

Notes write_by_driver(const std::string& path, const std::string& driver, const RiverNetwork& rivers,
                      const RiverFileOptions& options, const Context& context) {
  std::vector<std::string> notes;
  Status written = write_dataset(path, driver, options.crs, notes,
                                 [&](OgrDataset& dataset) { return write_layers(dataset, rivers, options, notes, context); });
  if (!written) return written.error();
  return notes;
}

Notes write_wkt_lines(const std::string& path, const RiverNetwork& rivers, const RiverFileOptions& options,
                      const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  fmt::memory_buffer text;
  for (Index i = 0; i < line_count(rivers, options); ++i) {
    if (context.cancelled()) return interrupted();
    text.clear();
    const char* before = "LINESTRING (";
    for (Point p : line(rivers, options, i)) {
      fmt::format_to(std::back_inserter(text), "{}{} {}", before, p.x, p.y);
      before = ", ";
    }
    stream->write({text.data(), text.size()});
    stream->write(")\n");
  }
  if (Status finished = stream->finish(); !finished) return finished.error();
  return std::vector<std::string>{};
}

Notes write_wkb_lines(const std::string& path, const RiverNetwork& rivers, const RiverFileOptions& options,
                      const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  std::vector<unsigned char> bytes;
  for (Index i = 0; i < line_count(rivers, options); ++i) {
    if (context.cancelled()) return interrupted();
    const auto geometry = line_geometry(line(rivers, options, i));
    bytes.resize(geometry->WkbSize());
    geometry->exportToWkb(wkbNDR, bytes.data(), wkbVariantIso);
    stream->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  if (Status finished = stream->finish(); !finished) return finished.error();
  return std::vector<std::string>{};
}

}  // namespace

OgrDataset::Fields sub_river_fields() {
  static constexpr std::initializer_list<std::pair<const char*, OGRFieldType>> fields = {
      {"id", OFTInteger64},         {"strahler", OFTInteger},    {"main", OFTInteger},
      {"length", OFTReal},          {"from_node", OFTInteger64}, {"to_node", OFTInteger64},
      {"downstream", OFTInteger64}, {"stem", OFTInteger64},      {"feature", OFTInteger64}};
  return fields;
}

void set_sub_river(OGRFeature& row, const RiverNetwork& rivers, Index s) {
  const RiverNetwork::SubRiver& river = rivers.sub_rivers()[s];
  row.SetField("id", GIntBig(s) + 1);
  row.SetField("strahler", int(river.order));
  row.SetField("main", river.is_stem ? 1 : 0);
  row.SetField("length", river.length);
  row.SetField("from_node", GIntBig(river.from) + 1);
  row.SetField("to_node", GIntBig(river.to) + 1);
  if (river.downstream) row.SetField("downstream", GIntBig(*river.downstream) + 1);
  row.SetField("stem", GIntBig(river.stem) + 1);
  if (river.feature >= 0) row.SetField("feature", GIntBig(river.feature));
}

Notes write_rivers(const std::string& path, const RiverNetwork& rivers, const ZoneFormat& format,
                   const RiverFileOptions& options, const Context& context) {
  switch (format.kind) {
    case ZoneFormat::Kind::wkt:
      return write_wkt_lines(path, rivers, options, context);
    case ZoneFormat::Kind::wkb:
      return write_wkb_lines(path, rivers, options, context);
    case ZoneFormat::Kind::svg:
      return write_river_svg(path, rivers, context);
    case ZoneFormat::Kind::geojson:
      return write_by_driver(path, "GeoJSON", rivers, options, context);
    case ZoneFormat::Kind::dxf:
      return write_by_driver(path, "DXF", rivers, options, context);
    case ZoneFormat::Kind::ogr:
      break;
  }
  return write_by_driver(path, format.driver, rivers, options, context);
}

}  // namespace krepl::output
