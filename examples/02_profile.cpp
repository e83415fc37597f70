// The path of a disk's centre that rolls over a terrain: the profile of a valley and a cliff, radius 1.
#include <cstdio>
#include <krepl/profile.hpp>

int main() {
  const auto profile = krepl::compute_profile({{0, 0}, {4, 3}, {8, 0}, {8, 5}, {12, 5}}, 1.0);
  if (!profile) return std::fprintf(stderr, "%s\n", profile.error().text().c_str()), 1;
  for (std::size_t k = 0; k < profile->pieces.size(); ++k) {
    const krepl::ProfileRow row = profile->row(k);
    std::printf("%s: (%.6g, %.6g) to (%.6g, %.6g)\n", krepl::profile_cause(row).c_str(), row.start.x, row.start.y,
                row.end.x, row.end.y);
  }
  return 0;
}
