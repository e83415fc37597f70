// Every case has a zone, and the zone passes validate() and the brute-force checks.
#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

using Soundness = PropertyTest;

TEST_P(Soundness, PassesTheVerifier) {
  holds("sound", [](const ZoneCase& c) {
    const auto fault = fault_in(c);
    if (fault) RC_LOG() << *fault << '\n';
    RC_ASSERT(!fault);
  });
}

TEST_P(Soundness, AlsoWithTinyAndHugeRadius) {
  holds("sound at any radius", [](const ZoneCase& c) {
    for (const double factor : {1e-3, 1e4}) {
      ZoneCase other = c;
      other.radius *= factor;
      // Radii near the coordinates' own steps are refused.
      double largest = 0;
      for (const InputPart& part : c.parts)
        for (const Point& p : part.vertices) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
      if (other.radius < 1e-11 * largest) continue;
      const auto fault = fault_in(other);
      if (fault) RC_LOG() << text(other) << '\n' << *fault << '\n';
      RC_ASSERT(!fault);
    }
  });
}

KREPL_FOR_ALL_FAMILIES(Soundness);

}  // namespace
}  // namespace krepl::test
