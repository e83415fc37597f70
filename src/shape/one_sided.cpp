#include "shape/one_sided.hpp"

namespace krepl::shape {

Result<Zone> one_sided(std::shared_ptr<const Network>, const ShapeOptions&, const Context&) {
  return Error{ErrorCode::usage, "not yet", "", ""};
}

}  // namespace krepl::shape
