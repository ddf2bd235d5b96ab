#include "daemon/ingest/water_mean.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

using namespace glidehelm;
using ingest::WaterMean;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> kDepths{0, 10, 50, 200};

}  // namespace

TEST_CASE("of columns that are equally deep each level has their mean") {
  WaterMean mean{4};
  mean.add(std::vector<double>{20.0, 18, 12, 6}, std::vector<double>{36.0, 36, 35.5, 35});
  mean.add(std::vector<double>{10.0, 12, 8, 4}, std::vector<double>{34.0, 35, 35.5, 36});
  const auto layers = mean.layers(kDepths);
  // Halves of sums of whole numbers and halves are exact.
  const std::vector<ocean::WaterLayer> wanted{
      {Metres{0}, 15, 35}, {Metres{10}, 15, 35.5}, {Metres{50}, 10, 35.5}, {Metres{200}, 5, 35.5}};
  CHECK(layers == wanted);
  CHECK(mean.columns() == 2);
}

TEST_CASE("a cold shelf that ends does not make the mean column warmer downwards") {
  // Two deep columns of one profile and a shelf that is 10 degrees colder: the plain mean of each level would rise by 2 degrees from 10 to 50 m.
  WaterMean mean{4};
  for (int k = 0; k < 2; ++k) mean.add(std::vector<double>{20.0, 19, 18, 10}, std::vector<double>(4, 35.0));
  mean.add(std::vector<double>{10.0, 9, kNone, kNone}, std::vector<double>{35.0, 35, kNone, kNone});
  const auto layers = mean.layers(kDepths);
  const std::vector<ocean::WaterLayer> wanted{
      {Metres{0}, 20, 35}, {Metres{10}, 19, 35}, {Metres{50}, 18, 35}, {Metres{200}, 10, 35}};
  CHECK(layers == wanted);
}

TEST_CASE("below the depth that half of the columns reach the mean column follows those that go on") {
  // One of three goes deeper than 10 m. Its own changes, −4 and −6, carry the mean of all three, 14, on.
  WaterMean mean{4};
  mean.add(std::vector<double>{16.0, 15, kNone, kNone}, std::vector<double>{35.0, 35, kNone, kNone});
  mean.add(std::vector<double>{18.0, 17, kNone, kNone}, std::vector<double>{35.0, 35, kNone, kNone});
  mean.add(std::vector<double>{11.0, 10, 6, 0}, std::vector<double>{35.0, 35, 36, 34});
  const auto layers = mean.layers(kDepths);
  const std::vector<ocean::WaterLayer> wanted{
      {Metres{0}, 15, 35}, {Metres{10}, 14, 35}, {Metres{50}, 10, 36}, {Metres{200}, 4, 34}};
  CHECK(layers == wanted);
}

TEST_CASE("land, missing values and one of the two alone are no water") {
  WaterMean mean{4};
  mean.add(std::vector<double>(4, 0.0), std::vector<double>(4, 0.0));  // land filled with zeros
  mean.add(std::vector<double>(4, kNone), std::vector<double>(4, 35.0));
  mean.add(std::vector<double>(4, 10.0), std::vector<double>(4, kNone));
  CHECK(mean.columns() == 0);
  CHECK(mean.layers(kDepths).empty());
  mean.add(std::vector<double>{0.0, 1, 2, 3}, std::vector<double>(4, 35.0));  // freezing, but salt
  CHECK(mean.columns() == 1);
  CHECK(mean.layers(kDepths).size() == 4);
  CHECK_FALSE(mean.impossible());
}

TEST_CASE("a column that begins below the first depth begins there") {
  WaterMean mean{4};
  mean.add(std::vector<double>{kNone, 12.0, 8, 4}, std::vector<double>(4, 35.0));
  const auto layers = mean.layers(kDepths);
  REQUIRE(layers.size() == 3);
  CHECK(layers.front() == ocean::WaterLayer{Metres{10}, 12, 35});
}

TEST_CASE("a value that no sea has is told with its companion") {
  WaterMean mean{4};
  mean.add(std::vector<double>{10.0, 293.15, 8, 400}, std::vector<double>(4, 35.0));
  REQUIRE(mean.impossible());
  CHECK(*mean.impossible() == "293.15 °C with salinity 35, allowed is -3 to 45 °C and 0 to 45");
}
