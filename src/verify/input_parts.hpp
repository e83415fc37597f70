#pragma once

#include <string>
#include <vector>

#include "input/network_reader.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "verify/obstacle.hpp"

namespace krepl::verify {

/// Which input to take and how to project it; the same meaning as for `krepl buffer`.
struct InputRequest {
  std::string path, layer, where, crs, to_crs;
  double arc_error = 0;
  bool keep_arcs = false;  ///< without `arc_error` arcs are kept
  std::string radius_field = {}, radius_expression = {};  ///< a radius of its own for each part
};

/// What a reader of the input is asked for.
input::NetworkRequest network_request(const InputRequest& request);

/// Lines, rings and points as they are in the file, after projection. Stops before Network, whose welding and shift of
/// origin the verifier must not share.
Result<std::vector<InputPart>> read_parts(const InputRequest& request, const Context& context = {});

}  // namespace krepl::verify
