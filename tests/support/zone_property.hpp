#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "support/zone_generators.hpp"

namespace krepl::test {

inline const char* name(Family f) {
  static constexpr const char* names[] = {"grid_lines", "grid_points", "streets", "on_segments", "collinear", "tangent",
                                          "cocircular", "near_equal",  "rings",   "digitised",   "scattered", "comb"};
  return names[std::size_t(f)];
}

/// A googletest parameterised over all families; PropertyTest::holds checks a property on random cases of its family.
class PropertyTest : public testing::TestWithParam<int> {
 protected:
  /// `property(case)` uses RC_ASSERT. Cases shrink to few and small bytes and print as text.
  template <class F>
  void holds(const std::string& what, F&& property) {
    const Family family = Family(GetParam());
    EXPECT_TRUE(rc::check(what + " on " + name(family), [&] {
      const auto bytes =
          *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::resize(100, rc::gen::arbitrary<std::uint8_t>()));
      const ZoneCase c = decode(family, bytes);
      RC_LOG() << text(c) << '\n';
      property(c);
    }));
  }
};

#define KREPL_FOR_ALL_FAMILIES(suite)                                              \
  INSTANTIATE_TEST_SUITE_P(Families, suite, testing::Range(0, int(Family::count)), \
                           [](const auto& info) { return name(Family(info.param)); })

}  // namespace krepl::test
