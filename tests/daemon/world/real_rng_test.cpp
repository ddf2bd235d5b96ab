#include "daemon/world/real_rng.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/support/fixed_rng.hpp"

using namespace glidehelm;

TEST_CASE("the machine's numbers differ from each other in every bit position") {
  world::RealRng rng;
  std::set<std::uint64_t> seen;
  std::uint64_t ones = 0, zeros = 0;
  for (int i = 0; i < 128; ++i) {
    const auto n = rng.next();
    seen.insert(n);
    ones |= n;
    zeros |= ~n;
  }
  CHECK(seen.size() == 128);         // two equal ones among 128: about 4e-16
  CHECK(ones == ~std::uint64_t{0});  // a position that is never set: 64 / 2^128
  CHECK(zeros == ~std::uint64_t{0});
}

TEST_CASE("fixed numbers are those of SplitMix64") {
  test::FixedRng rng{1234567};
  // The first outputs for this seed in the published reference implementation's test vector.
  for (const std::uint64_t expected : {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL})
    CHECK(rng.next() == expected);
  test::FixedRng a{7}, b{7}, c{8};
  CHECK(a.next() == b.next());
  CHECK(a.next() != c.next());
}
