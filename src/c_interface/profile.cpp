#include "krepl/profile.hpp"

#include <limits>
#include <utility>
#include <vector>

#include "c_interface/handles.hpp"

namespace ci = krepl::c_interface;

struct krepl_profile {
  krepl::Profile profile;
};

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

int32_t kind_of(krepl::ProfilePiece::Kind kind) {
  switch (kind) {
    case krepl::ProfilePiece::Kind::segment:
      return KREPL_SEGMENT;
    case krepl::ProfilePiece::Kind::arc:
      return KREPL_ARC;
    case krepl::ProfilePiece::Kind::half_line:
      break;
  }
  return KREPL_HALF_LINE;
}

krepl_profile_piece piece_of(const krepl::ProfileRow& row) {
  const bool arc = row.kind == krepl::ProfilePiece::Kind::arc;
  krepl_profile_piece result{};
  result.start_x = row.start.x;
  result.start_z = row.start.y;
  result.end_x = row.end.x;
  result.end_z = row.end.y;
  result.center_x = arc ? row.center.x : not_a_number;
  result.center_z = arc ? row.center.y : not_a_number;
  result.index = row.index;
  result.kind = kind_of(row.kind);
  return result;
}

}  // namespace

krepl_status krepl_profile_compute(krepl_context* context, const double* xz, size_t count, double radius,
                                   krepl_profile** profile) {
  if (profile != nullptr) *profile = nullptr;
  return ci::guarded(context, [&]() -> krepl_status {
    if (profile == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "no place is given for the profile");
    if (xz == nullptr && count > 0) return ci::fail(context, KREPL_ERROR_USAGE, "the array of coordinates is NULL");
    std::vector<krepl::Point> terrain(count);
    for (std::size_t i = 0; i < count; ++i) terrain[i] = {xz[2 * i], xz[2 * i + 1]};
    auto computed = krepl::compute_profile(std::move(terrain), radius, ci::settings(context));
    if (!computed) return ci::fail(context, computed.error());
    *profile = new krepl_profile{std::move(*computed)};
    return KREPL_OK;
  });
}

void krepl_profile_destroy(krepl_profile* profile) { delete profile; }

double krepl_profile_radius(const krepl_profile* profile) {
  return profile == nullptr ? not_a_number : profile->profile.radius;
}

size_t krepl_profile_piece_count(const krepl_profile* profile) {
  return profile == nullptr ? 0 : profile->profile.pieces.size();
}

size_t krepl_profile_explicit_vertex_count(const krepl_profile* profile) {
  if (profile == nullptr) return 0;
  return krepl::count_profile_vertices(profile->profile.terrain, profile->profile.pieces).explicit_ones;
}

krepl_status krepl_profile_pieces(krepl_context* context, const krepl_profile* profile, size_t first, size_t count,
                                  krepl_profile_piece* pieces, size_t size) {
  if (profile == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "the profile is NULL");
  return ci::copy_elements(context, profile->profile.pieces.size(), first, count, pieces, size,
                           [profile](std::size_t k) { return piece_of(profile->profile.row(k)); });
}
