#include "daemon/ingest/vertical.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using namespace glidehelm::ingest;

TEST_CASE("Vtransform 1 and 2 place a level where the formulas do by hand") {
  // h = 100 m, hc = 20 m, s = −0.5, C = −0.25, ζ = 2 m.
  TerrainLevels levels{LevelLaw::transform_1, {-0.5}, {-0.25}, 20};
  // 1: Zo = 20·(−0.5) + 80·(−0.25) = −30; z = −30 + 2·(1 − 30/100) = −28.6; below the surface: 2 + 28.6 = 30.6.
  CHECK(levels.depth(0, 100, 2) == Approx(30.6));
  CHECK(levels.depth(0, 100, 0) == Approx(30));
  // 2: S = (20·(−0.5) + 100·(−0.25))/120 = −35/120; z = 2 + 102·S = −27.75; below the surface 29.75.
  levels.law = LevelLaw::transform_2;
  CHECK(levels.depth(0, 100, 2) == Approx(29.75));
  // CF's ocean_s_coordinate: z = 2·(1 − 0.5) + 20·(−0.5) + 80·(−0.25) = −29; below the surface 31.
  levels.law = LevelLaw::s_coordinate;
  CHECK(levels.depth(0, 100, 2) == Approx(31));
  // σ: z = 2 − 0.5·102 = −49; below the surface 51.
  levels.law = LevelLaw::sigma;
  CHECK(levels.depth(0, 100, 2) == Approx(51));
}

TEST_CASE("every law has the surface at 0 and the floor at the depth of the water") {
  for (const auto law : {LevelLaw::sigma, LevelLaw::s_coordinate, LevelLaw::transform_1, LevelLaw::transform_2})
    for (const double zeta : {-1.5, 0.0, 2.0}) {
      const TerrainLevels levels{law, {-1, 0}, {-1, 0}, 15};
      CHECK(levels.depth(0, 300, zeta) == Approx(300 + zeta));
      CHECK(levels.depth(1, 300, zeta) == Approx(0).margin(1e-12));
    }
}

TEST_CASE("every stretching runs from -1 at the floor to 0 at the surface without turning back") {
  for (int stretching = 1; stretching <= 5; ++stretching)
    for (const double theta_s : {0.5, 1.0, 3.0, 7.0})
      for (const double theta_b : {0.1, 0.4, 1.0}) {
        INFO(stretching << " " << theta_s << " " << theta_b);
        const StretchingChoice choice{2, stretching, theta_s, theta_b, 20};
        CHECK(stretching_curve(choice, -1) == Approx(-1).margin(1e-9));
        CHECK(stretching_curve(choice, 0) == Approx(0).margin(1e-9));
        if (stretching == 3 && (theta_s != 1 || theta_b != 1)) continue;  // Geyer's only rises for exponents near 1
        double last = -1 - 1e-9;
        for (int k = 1; k < 100; ++k) {
          const double c = stretching_curve(choice, k / 100.0 - 1);
          CHECK(c >= last - 1e-9);
          last = c;
        }
      }
}

TEST_CASE("stretchings agree with their formulas by hand") {
  // 1: θs = 2, θb = 0.5, s = −0.5: 0.5·sinh(−1)/sinh 2 + 0.5·(tanh 0/(2 tanh 1) − 0.5) = −0.5·1.175201/3.626860 − 0.25.
  CHECK(stretching_curve({1, 1, 2, 0.5, 0}, -0.5) == Approx(-0.5 * 1.1752011936 / 3.6268604078 - 0.25));
  // 1 without stretching: C = s.
  CHECK(stretching_curve({1, 1, 0, 0, 0}, -0.3) == Approx(-0.3));
  // 2: θs = 1, θb = 0: (1 − cosh 0.5)/(cosh 1 − 1) = −0.1276260/0.5430806.
  CHECK(stretching_curve({2, 2, 1, 0, 0}, -0.5) == Approx(-0.1276259652 / 0.5430806348));
  // 2: θs = θb = 1, s = −0.5: weight 0.5·1.5 = 0.75; bottom sinh 0.5/sinh 1 − 1 = −0.5565906.
  CHECK(stretching_curve({2, 2, 1, 1, 0}, -0.5) ==
        Approx(0.75 * -0.1276259652 / 0.5430806348 + 0.25 * (0.5210953055 / 1.1752011936 - 1)));
  // 3: θs = θb = 1, s = −0.5: the weight is a half, surface and floor are −ln cosh 1.5/ln cosh 3 and that + 1, mirrored:
  // ½(−a) + ½(a − 1) = −½.
  CHECK(stretching_curve({2, 3, 1, 1, 0}, -0.5) == Approx(-0.5));
  // 4: θs = 1, θb = 1: (exp(C) − 1)/(1 − exp(−1)) with C as in 2.
  CHECK(stretching_curve({2, 4, 1, 1, 0}, -0.5) == Approx((std::exp(-0.1276259652 / 0.5430806348) - 1) / 0.6321205588));
  // 4 without surface stretching: C = −s².
  CHECK(stretching_curve({2, 4, 0, 0, 0}, -0.5) == Approx(-0.25));
}

TEST_CASE("s lies at the middle of the layers, and at stretching 5 where its quadratic law puts it") {
  CHECK(s_of_layers(4, 4) == std::vector<double>{-0.875, -0.625, -0.375, -0.125});
  const auto five = s_of_layers(10, 5);
  // k = ½: −(0.25 − 10 + 0.5 + 100 − 10)/90 − 0.01·(0.25 − 5)/(−9) = −0.8972222 − 0.0052778.
  CHECK(five.front() == Approx(-0.9025));
  // k = 9½: −(90.25 − 190 + 9.5 + 100 − 10)/90 − 0.01·(90.25 − 95)/(−9) = 0.0027778 − 0.0052778.
  CHECK(five.back() == Approx(-0.0025));
}

TEST_CASE("levels that turn back or leave -1 to 0 are refused") {
  CHECK(check_levels({LevelLaw::sigma, {-0.9, -0.5, -0.1}, {}, 0}));
  CHECK(check_levels({LevelLaw::sigma, {-0.1, -0.5, -0.9}, {}, 0}));
  CHECK_FALSE(check_levels({LevelLaw::sigma, {-0.9, -0.1, -0.5}, {}, 0}));
  CHECK_FALSE(check_levels({LevelLaw::sigma, {0.1, 0.5, 0.9}, {}, 0}));
  CHECK_FALSE(check_levels({LevelLaw::transform_2, {-0.9, -0.5}, {-0.9}, 10}));
  CHECK_FALSE(check_levels({LevelLaw::transform_2, {-0.9, -0.5}, {-0.9, NAN}, 10}));
  CHECK_FALSE(check_levels({LevelLaw::transform_2, {-0.9, -0.5}, {-0.9, -0.5}, -1}));
}

TEST_CASE("the fixed depths are those of the ladder, as far as there is water") {
  CHECK(fixed_depths(1) == std::vector<double>{0});
  CHECK(fixed_depths(12) == std::vector<double>{0, 2, 4, 6, 8, 10});
  CHECK(fixed_depths(15).back() == 15);
  const auto deep = fixed_depths(5591);
  CHECK(deep.back() == 5500);
  CHECK(deep.size() == 1 + 5 + 8 + 5 + 5 + 4 + 6 + 6 + 4 + 7);
  for (std::size_t k = 1; k < deep.size(); ++k) CHECK(deep[k] > deep[k - 1]);
}

TEST_CASE("a linear shear comes through a column exactly, constant beyond its levels, nothing below the floor") {
  for (const bool upwards : {false, true}) {
    std::vector<double> depths{2, 10, 30, 80}, values;
    if (upwards) std::reverse(depths.begin(), depths.end());
    for (const double d : depths) values.push_back(1 - 0.01 * d);
    Column column;
    column.set(depths, 100);
    CHECK(column.at(0, values) == Approx(0.98));
    CHECK(column.at(2, values) == Approx(0.98));
    CHECK(column.at(5, values) == Approx(0.95));
    CHECK(column.at(79, values) == Approx(0.21));
    CHECK(column.at(100, values) == Approx(0.20));
    CHECK(std::isnan(column.at(100.1, values)));
    values[1] = NAN;  // a level without value is bridged
    CHECK(column.at(20, values) == Approx(0.8));
  }
}

TEST_CASE("a stretching is read from its five parameters, and nothing else") {
  const auto choice = stretching_choice_from("vtransform=2, vstretching=4,theta_s=5,theta_b=0.4,hc=50");
  REQUIRE(choice);
  CHECK(*choice == StretchingChoice{2, 4, 5, 0.4, 50});
  for (const char* wrong : {"", "vtransform=2", "vtransform=3,vstretching=4,theta_s=5,theta_b=0.4,hc=50",
                            "vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50,hc=50",
                            "vtransform=1.5,vstretching=4,theta_s=5,theta_b=0.4,hc=50",
                            "vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,tcline=50",
                            "vtransform=2,vstretching=4,theta_s=x,theta_b=0.4,hc=50"}) {
    INFO(wrong);
    const auto refused = stretching_choice_from(wrong);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what.find("allowed is vtransform=1|2") != std::string::npos);
  }
}
