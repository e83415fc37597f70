#include "input/projection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <functional>

#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

constexpr std::size_t chunk = 4096;

struct FreeTransformation {
  void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
};
using Transformation = std::unique_ptr<OGRCoordinateTransformation, FreeTransformation>;

Result<Transformation> make_transformation(const OGRSpatialReference& from, const OGRSpatialReference& to) {
  ogr::MessageCapture messages;
  Transformation transformation(OGRCreateCoordinateTransformation(&from, &to));
  if (!transformation) {
    return messages.error(ErrorCode::input, "no transformation from " + ogr::crs_name(from) + " to " + ogr::crs_name(to));
  }
  return transformation;
}

struct Block {
  std::vector<double> x, y;
  std::vector<int> success;
};

/// Transforms points first .. first + count into `block`; `success` says which of them arrived.
void transform_block(OGRCoordinateTransformation& t, const Parts& parts, std::size_t first, std::size_t count, Block& block) {
  block.x.resize(count);
  block.y.resize(count);
  block.success.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    block.x[i] = parts.points[first + i].x;
    block.y[i] = parts.points[first + i].y;
  }
  ogr::MessageCapture ignored;  // `success` tells the same, by vertex
  t.Transform(static_cast<int>(count), block.x.data(), block.y.data(), nullptr, block.success.data());
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(block.x[i]) || !std::isfinite(block.y[i])) block.success[i] = 0;
  }
}

std::string place_of_point(const Parts& parts, std::size_t point, const ProjectionRequest& request) {
  auto after = std::upper_bound(parts.begin.begin(), parts.begin.end(), point);
  auto part = static_cast<std::size_t>(after - parts.begin.begin()) - 1;
  const Point& p = parts.points[point];
  return fmt::format("{}, vertex {} ({} {})", request.place(parts.feature[part]), point - parts.begin[part], p.x, p.y);
}

/// Transforms all points, block by block; take(first, block) looks at each before the next.
Status transform_blocks(const Parts& parts, const OGRSpatialReference& to, const ProjectionRequest& request,
                        const Context& context, const std::function<Status(std::size_t first, const Block& block)>& take) {
  Result<Transformation> transformation = make_transformation(*request.from, to);
  if (!transformation) return transformation.error();
  Block block;
  for (std::size_t first = 0; first < parts.points.size(); first += chunk) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while projecting", "", ""};
    transform_block(**transformation, parts, first, std::min(chunk, parts.points.size() - first), block);
    if (Status taken = take(first, block); !taken) return taken;
  }
  return std::monostate{};
}

Status transform_all(Parts& parts, const OGRSpatialReference& to, const ProjectionRequest& request, const Context& context) {
  return transform_blocks(parts, to, request, context, [&](std::size_t first, const Block& block) -> Status {
    for (std::size_t i = 0; i < block.x.size(); ++i) {
      if (!block.success[i]) {
        return Error{ErrorCode::input, "cannot be projected to " + ogr::crs_name(to), place_of_point(parts, first + i, request),
                     "choose another --to-crs or leave the feature out with --where"};
      }
    }
    // Only now, so that the message above shows the coordinates as they were given.
    for (std::size_t i = 0; i < block.x.size(); ++i) parts.points[first + i] = {block.x[i], block.y[i]};
    return std::monostate{};
  });
}

struct GeographicExtent {
  LongitudeRange longitude;
  double south = 90, north = -90;
  double middle_latitude() const { return (south + north) / 2; }
  double middle_longitude() const {
    double middle = longitude.west + longitude.width / 2;
    return middle >= 180 ? middle - 360 : middle;
  }
};

Result<GeographicExtent> geographic_extent(const Parts& parts, const OGRSpatialReference& geographic,
                                           const ProjectionRequest& request, const Context& context) {
  GeographicExtent extent;
  std::vector<double> longitudes;
  longitudes.reserve(parts.points.size());
  const auto take = [&](std::size_t first, const Block& block) -> Status {
    for (std::size_t i = 0; i < block.x.size(); ++i) {
      if (!block.success[i] || std::fabs(block.y[i]) > 90 || std::fabs(block.x[i]) > 360) {
        return Error{ErrorCode::input, "is not a place on earth", place_of_point(parts, first + i, request),
                     "check the coordinate system, or name it with --crs"};
      }
      longitudes.push_back(block.x[i]);
      extent.south = std::min(extent.south, block.y[i]);
      extent.north = std::max(extent.north, block.y[i]);
    }
    return std::monostate{};
  };
  if (Status taken = transform_blocks(parts, geographic, request, context, take); !taken) return taken.error();
  extent.longitude = longitude_range(longitudes);
  return extent;
}

bool fits_utm(const GeographicExtent& extent) {
  return extent.longitude.width <= 6 && extent.south >= -80 && extent.north <= 84;
}

OGRSpatialReference utm_zone(const OGRSpatialReference& geographic, const GeographicExtent& extent) {
  int zone = std::clamp(static_cast<int>(std::floor((extent.middle_longitude() + 180) / 6)) + 1, 1, 60);
  bool north = extent.middle_latitude() >= 0;
  OGRSpatialReference utm;
  const char* given = geographic.GetName();
  std::string name = given != nullptr ? given : "unnamed";
  if (name.starts_with("WGS 84")) {
    utm.importFromEPSG((north ? 32600 : 32700) + zone);
  } else if (name == "ETRS89" && north && zone >= 28 && zone <= 38) {
    utm.importFromEPSG(25800 + zone);
  } else {
    utm.SetProjCS(fmt::format("{} / UTM zone {}{}", name, zone, north ? 'N' : 'S').c_str());
    utm.CopyGeogCSFrom(&geographic);
    utm.SetUTM(zone, north);
    utm.AutoIdentifyEPSG();
  }
  return utm;
}

OGRSpatialReference equidistant(const OGRSpatialReference& geographic, const GeographicExtent& extent) {
  // Two decimals, so that the name shows the whole definition.
  double latitude = std::round(extent.middle_latitude() * 100) / 100;
  double longitude = std::round(extent.middle_longitude() * 100) / 100;
  OGRSpatialReference aeqd;
  aeqd.SetProjCS(fmt::format("Azimuthal equidistant around {} {}", longitude, latitude).c_str());
  aeqd.CopyGeogCSFrom(&geographic);
  aeqd.SetAE(latitude, longitude, 0, 0);
  aeqd.SetLinearUnits(SRS_UL_METER, 1.0);
  return aeqd;
}

Result<OGRSpatialReference> automatic_crs(const Parts& parts, const ProjectionRequest& request, const Context& context) {
  ogr::MessageCapture ignored;
  std::unique_ptr<OGRSpatialReference> geographic(request.from->CloneGeogCS());
  if (!geographic) {
    return Error{ErrorCode::input, "--to-crs auto needs a coordinate system on earth, not " + ogr::crs_name(*request.from),
                 "", "name a system as EPSG:n"};
  }
  geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  Result<GeographicExtent> extent = geographic_extent(parts, *geographic, request, context);
  if (!extent) return extent.error();
  OGRSpatialReference crs = fits_utm(*extent) ? utm_zone(*geographic, *extent) : equidistant(*geographic, *extent);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

bool is_in_degrees(const OGRSpatialReference& crs) {
  return crs.IsGeographic() || crs.IsDerivedGeographic() || crs.IsGeocentric();
}

}  // namespace

LongitudeRange longitude_range(const std::vector<double>& longitudes) {
  constexpr int bins = 7200;  // 0.05 degrees each
  std::bitset<bins> occupied;
  auto [least, greatest] = std::minmax_element(longitudes.begin(), longitudes.end());
  LongitudeRange plain{*least, *greatest - *least};
  for (double longitude : longitudes) {
    double turn = (longitude + 180) / 360;
    turn -= std::floor(turn);
    occupied.set(std::min(bins - 1, static_cast<int>(turn * bins)));
  }
  // The complement of the largest empty gap around the circle.
  int first = 0;
  while (!occupied[static_cast<std::size_t>(first)]) ++first;
  int gap_end = first, gap = 0;
  for (int i = 1, last = first; i <= bins; ++i) {
    int bin = (first + i) % bins;
    if (!occupied[static_cast<std::size_t>(bin)]) continue;
    if (int length = first + i - last; length > gap) {
      gap = length;
      gap_end = bin;
    }
    last = first + i;
  }
  LongitudeRange around{-180 + 360.0 * gap_end / bins, 360.0 * (bins - gap + 1) / bins};
  return around.width < plain.width - 360.0 / bins ? around : plain;
}

Result<std::optional<OGRSpatialReference>> project(Parts& parts, const ProjectionRequest& request,
                                                   std::vector<std::string>& notes, const Context& context) {
  if (request.to_crs.empty()) {
    if (request.from && is_in_degrees(*request.from)) {
      return Error{ErrorCode::input, "coordinates are in degrees (" + ogr::crs_name(*request.from) + "), not in a plane", "",
                   "project them with --to-crs EPSG:n, or with --to-crs auto"};
    }
    return request.from;
  }
  if (!request.from) {
    return Error{ErrorCode::input, "--to-crs needs to know the coordinate system of the data, and the file does not say", "",
                 "name it with --crs EPSG:n"};
  }
  bool automatic = request.to_crs == "auto";
  Result<OGRSpatialReference> to =
      automatic ? automatic_crs(parts, request, context) : ogr::parse_crs(request.to_crs);
  if (!to) return to.error();
  if (is_in_degrees(*to)) {
    return Error{ErrorCode::usage, "--to-crs " + request.to_crs + " is not a plane coordinate system", "",
                 "name a projected one, or auto"};
  }
  if (Status transformed = transform_all(parts, *to, request, context); !transformed) return transformed.error();
  if (automatic) notes.push_back("note: coordinates projected to " + ogr::crs_name(*to));
  return std::optional<OGRSpatialReference>(*to);
}

}  // namespace krepl::input
