#include "simulator/random.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using glidehelm::simulator::Random;

TEST_CASE("the generator gives the published numbers of SplitMix64") {
  // Reference values for seed 1234567 from the algorithm's published test vector.
  Random r{1234567};
  CHECK(r.next() == 6457827717110365317ULL);
  CHECK(r.next() == 3203168211198807973ULL);
  CHECK(r.next() == 9817491932198370423ULL);
}

TEST_CASE("even and normal draws have the moments they should") {
  Random r{3};
  constexpr int n = 100'000;
  double sum = 0, square = 0, normal_sum = 0, normal_square = 0;
  for (int i = 0; i < n; ++i) {
    const double u = r.uniform(), z = r.normal();
    REQUIRE(u >= 0);
    REQUIRE(u < 1);
    sum += u;
    square += u * u;
    normal_sum += z;
    normal_square += z * z;
  }
  // Standard errors: 0.289/√n, √(4/45)/√n, 1/√n, √2/√n; four of each.
  const double root = std::sqrt(static_cast<double>(n));
  CHECK(std::fabs(sum / n - 0.5) < 4 * 0.289 / root);
  CHECK(std::fabs(square / n - 1.0 / 3) < 4 * 0.299 / root);
  CHECK(std::fabs(normal_sum / n) < 4 / root);
  CHECK(std::fabs(normal_square / n - 1) < 4 * 1.415 / root);
}

TEST_CASE("streams for different purposes differ and do not depend on what else is drawn") {
  Random a{5};
  const auto first = a.stream(1).next();
  CHECK(first == Random{5}.stream(1).next());
  CHECK(first != Random{5}.stream(2).next());
  CHECK(first != Random{6}.stream(1).next());
}
