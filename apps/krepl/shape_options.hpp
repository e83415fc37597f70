#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "input/network_reader.hpp"
#include "krepl/shape.hpp"
#include "verbs.hpp"

namespace krepl::app {

/// The options about a zone's shape as they were typed.
struct ShapeArguments {
  std::string cap, join, mitre_limit, side;
  bool ring = false;
};

/// Declares --cap, --join, --mitre-limit, --side and --ring. What is given must live until the verb has run.
void add_shape_options(Verb& verb, ShapeArguments& shape);

/// The options but for the distance. Errors of code usage.
Result<ShapeOptions> parse_shape(const ShapeArguments& shape);

/// True if radii and options ask for no more than compute_zone does.
bool is_plain(const ShapeOptions& shape, const std::vector<double>& radii);

/// As parse_radii, but single radii may be negative.
Result<std::vector<double>> parse_signed_radii(std::string_view text);

/// Notes about what is wrong with the rings of polygons.
Status tell_ring_faults(const Network& network, const std::string& in_name, Session& session);
Status tell_ring_faults(const CurveNetwork& network, const std::string& in_name, Session& session);

/// True if zones of the shape are made of arcs as they are; else they are to be replaced by chords.
bool takes_arcs(const ShapeOptions& shape);

/// The zones at these radii, negative ones shrunk; tells on standard error what is wrong with the rings of the
/// polygons, and what comes out empty. `in_name` names the input in messages.
Result<std::vector<Zone>> shaped_zones(const input::NetworkData& data, const std::vector<double>& radii,
                                       const ShapeOptions& shape, const std::string& in_name, Session& session);

}  // namespace krepl::app
