#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "input/geometry_source.hpp"
#include "input/network_reader.hpp"
#include "input/parts.hpp"

namespace krepl::input {

/// What readers of lines, rings and points share.
struct Collected {
  Parts parts;
  std::size_t with_geometry = 0, without_geometry = 0;
};

/// What becomes of arcs: chords within `error` if that is above zero; else they are kept or refused.
struct ArcTreatment {
  double error = 0;
  bool keep = false;
};

/// All geometries of a source; `seen` is called for each that is not empty, with the number of parts there are with it.
using Seen = std::function<void(const GeometrySource::Item&, std::size_t parts)>;
Result<Collected> collect(GeometrySource& source, const ArcTreatment& arcs, const Context& context, const Seen& seen = {});

/// Why there is no part at all.
Error nothing_found(const NetworkRequest& request, const Collected& found);

/// What the user should know about what was read: features and heights left out, chords for arcs, what the reader of the format loses.
std::vector<std::string> notes_on(const Collected& all, const GeometrySource& source);

/// The coordinate system the data have: the one that the request assigns, else the file's.
Result<std::optional<OGRSpatialReference>> crs_of_data(const NetworkRequest& request, const GeometrySource& source);

/// The parts as a network.
Result<Network> build_network(const Parts& parts, const Context& context);
/// The same with their arcs.
Result<CurveNetwork> build_curve_network(const Parts& parts, const Context& context);
/// Arcs that are kept cannot be projected: what a projection makes of one is none.
Status check_projection(const Parts& parts, const std::string& to_crs,
                        const std::function<std::string(std::int64_t)>& place);
/// Adds part i to a network, as one of this feature; without arcs it has none, middles or not.
void add_part(Network::Builder& builder, const Parts& parts, std::size_t i, std::int64_t feature);
void add_part(CurveNetwork::Builder& builder, const Parts& parts, std::size_t i, std::int64_t feature);

}  // namespace krepl::input
