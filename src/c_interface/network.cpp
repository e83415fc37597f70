#include "c_interface/network.hpp"

#include <span>
#include <utility>
#include <vector>

#include "c_interface/handles.hpp"

namespace ci = krepl::c_interface;

struct krepl_builder {
  krepl::Network::Builder builder;
};

namespace {

krepl_status add_part(krepl_context* context, krepl_builder* builder, const double* xy, size_t count, int64_t feature,
                      bool ring) {
  return ci::guarded(context, [&]() -> krepl_status {
    if (builder == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "the builder is NULL");
    if (xy == nullptr && count > 0) return ci::fail(context, KREPL_ERROR_USAGE, "the array of coordinates is NULL");
    std::vector<krepl::Point> points(count);
    for (std::size_t i = 0; i < count; ++i) points[i] = {xy[2 * i], xy[2 * i + 1]};
    if (ring)
      builder->builder.add_ring(points, feature);
    else
      builder->builder.add_line(points, feature);
    return KREPL_OK;
  });
}

}  // namespace

krepl_builder* krepl_builder_create(void) { return new (std::nothrow) krepl_builder; }

void krepl_builder_destroy(krepl_builder* builder) { delete builder; }

krepl_status krepl_builder_add_line(krepl_context* context, krepl_builder* builder, const double* xy, size_t count,
                                    int64_t feature) {
  return add_part(context, builder, xy, count, feature, false);
}

krepl_status krepl_builder_add_ring(krepl_context* context, krepl_builder* builder, const double* xy, size_t count,
                                    int64_t feature) {
  return add_part(context, builder, xy, count, feature, true);
}

krepl_status krepl_builder_add_point(krepl_context* context, krepl_builder* builder, double x, double y,
                                     int64_t feature) {
  const double xy[] = {x, y};
  return krepl_builder_add_line(context, builder, xy, 1, feature);
}

krepl_status krepl_network_build(krepl_context* context, krepl_builder* builder, krepl_network** network) {
  if (network != nullptr) *network = nullptr;
  return ci::guarded(context, [&]() -> krepl_status {
    if (builder == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "the builder is NULL");
    if (network == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "no place is given for the network");
    auto built = std::exchange(builder->builder, {}).build(ci::settings(context));
    if (!built) return ci::fail(context, built.error());
    *network = new krepl_network{std::make_shared<const krepl::Network>(std::move(*built))};
    return KREPL_OK;
  });
}

void krepl_network_destroy(krepl_network* network) { delete network; }

size_t krepl_network_vertex_count(const krepl_network* network) {
  return network == nullptr ? 0 : network->network->vertices().size();
}

size_t krepl_network_segment_count(const krepl_network* network) {
  return network == nullptr ? 0 : network->network->segments().size();
}
