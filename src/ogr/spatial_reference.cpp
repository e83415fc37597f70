#include "ogr/spatial_reference.hpp"

#include <cpl_conv.h>

#include "ogr/message_capture.hpp"

namespace krepl::ogr {

Result<OGRSpatialReference> parse_crs(const std::string& text) {
  initialise();
  MessageCapture messages;
  OGRSpatialReference crs;
  if (crs.SetFromUserInput(text.c_str()) != OGRERR_NONE) {
    return messages.error(ErrorCode::usage, "'" + text + "' is not a coordinate system", "",
                          "give for example EPSG:25832, WKT or a PROJ string");
  }
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

std::string crs_name(const OGRSpatialReference& crs) {
  const char* name = crs.GetName();
  std::string text = name != nullptr ? name : "unnamed";
  const char* authority = crs.GetAuthorityName(nullptr);
  const char* code = crs.GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr) text += std::string(" (") + authority + ":" + code + ")";
  return text;
}

std::string crs_definition(const OGRSpatialReference& crs) {
  MessageCapture messages;
  char* wkt = nullptr;
  const char* options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  std::string text;
  if (crs.exportToWkt(&wkt, options) == OGRERR_NONE && wkt != nullptr) text = wkt;
  CPLFree(wkt);
  return text;
}

}  // namespace krepl::ogr
