#pragma once

#include <string>

#include "krepl/zone.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

/// Writes what lies outside of a zone, a feature a component, with the fields `component` and `area`: number 0 is the unbounded
/// one, cut off at the zone's bounding box grown by its radius; each hole of the zone is the border of another, in the order of the
/// rings. True curves where the format has them; chords lie within the zone then. Errors: a format that holds no features (SVG,
/// DXF; usage); whatever keeps the file from being written.
Result<ZoneFileReport> write_components(const std::string& path, const Zone& zone, const ZoneFormat& format,
                                        const ZoneFileOptions& options);

}  // namespace krepl::output
