#include "core/ocean/family.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/ocean/gridded.hpp"
#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

namespace {

const GeoPoint kHere = geo_point(40, 5);
// Sums of a few numbers below 1: some ten roundings of 1.1e-16 each.
constexpr double kRounding = 1e-14;

/// Eastward current that grows with the latitude: rate·(lat − 40°).
test::FromFunction shear(double rate) {
  return {[rate](double lat, double, double) { return std::pair{rate * (lat - 40 * kPi / 180), 0.0}; }, 1.0};
}

/// A field that has no current, for one reason.
struct Dry {
  NoCurrent why{NoCurrent::no_data};
  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint, Depth, double) const { return unexpected(why); }
  [[nodiscard]] Coverage coverage() const { return {}; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{0}; }
};

/// Members on one grid, each with numbers of its own, and a hole of one node in the members 3 and 4.
std::vector<GriddedField> random_members(std::size_t count) {
  std::vector<GriddedField> members;
  std::mt19937_64 random{31};
  for (std::size_t k = 0; k < count; ++k) {
    std::uniform_real_distribution<double> current{-0.4 + 0.1 * static_cast<double>(k), 0.5};
    const GridAxes axes{test::steps(0, 3600, 3), {0, 50}, test::steps(39, 0.5, 5), test::steps(4, 0.5, 5), true, true};
    members.emplace_back(test::make_grid(axes,
                                         [&](double lat, double lon, double, double) {
                                           const std::pair value{current(random), current(random)};
                                           const bool hole = (k == 3 || k == 4) && lat == 40 && lon == 5;
                                           return hole ? std::pair{test::kDry, test::kDry} : value;
                                         }),
                         GriddedOptions{OutsideTime::hold, Interpolation::linear, 0, false});
  }
  return members;
}

Family family_of(const std::vector<GriddedField>& members) { return Family{{members.begin(), members.end()}}; }

}  // namespace

TEST_CASE("two members around a mean have that mean and the root of two times their distance from it as spread") {
  // (d² + d²)/(2 − 1) = 2·d² per component.
  const test::Uniform slow{0.30 - 0.05, 0.10 + 0.12}, fast{0.30 + 0.05, 0.10 - 0.12};
  const Family family{{slow, fast}};
  const auto said = family.sample(kHere, {}, 0);
  REQUIRE(said);
  CHECK(said->members == 2);
  CHECK_FALSE(said->extrapolated);
  CHECK(said->mean.east.si() == Approx(0.30).margin(kRounding));
  CHECK(said->mean.north.si() == Approx(0.10).margin(kRounding));
  REQUIRE(said->spread);
  CHECK(said->spread->east.si() == Approx(0.05 * std::sqrt(2.0)).margin(kRounding));
  CHECK(said->spread->north.si() == Approx(0.12 * std::sqrt(2.0)).margin(kRounding));
  CHECK(said->spread->vector().si() == Approx(0.13 * std::sqrt(2.0)).margin(kRounding));
}

TEST_CASE(
    "members that shear at equal steps of the rate are apart by the deviation of those rates times the distance") {
  // Rates r + k·h for k = −2 … 2: mean r, Σk² = 10, spread h·√(10/4) of the rate.
  std::vector<test::FromFunction> members;
  for (int k = -2; k <= 2; ++k) members.push_back(shear(8.0 + 1.5 * k));
  const Family family{{members.begin(), members.end()}};
  for (const double degrees_north : {39.0, 40.0, 40.7}) {
    const auto said = family.sample(geo_point(degrees_north, 5), {}, 0);
    REQUIRE(said);
    const double y = (degrees_north - 40) * kPi / 180;
    CHECK(said->mean.east.si() == Approx(8 * y).margin(kRounding));
    CHECK(said->spread->east.si() == Approx(1.5 * std::sqrt(2.5) * std::abs(y)).margin(kRounding));
    CHECK(said->spread->north == MetresPerSecond{0});
  }
}

TEST_CASE("mean and spread of gridded members are those of direct sums over the members with water") {
  const auto members = random_members(9);
  const auto family = family_of(members);
  std::mt19937_64 random{32};
  std::uniform_real_distribution<double> lat{39, 41}, lon{4, 6}, depth{0, 50}, time{0, 7200};
  std::size_t partly = 0;
  for (int n = 0; n < 500; ++n) {
    const auto at = geo_point(lat(random), lon(random));
    const Depth z{Metres{depth(random)}};
    const double t = time(random);
    std::vector<Current> values;
    for (const auto& member : members)
      if (const auto sample = member.sample(at, z, t)) values.push_back(sample->current);
    partly += values.size() < members.size() ? 1 : 0;
    double east = 0, north = 0, east2 = 0, north2 = 0;
    const auto count = static_cast<double>(values.size());
    for (const auto& c : values) {
      east += c.east.si() / count;
      north += c.north.si() / count;
    }
    for (const auto& c : values) {
      east2 += (c.east.si() - east) * (c.east.si() - east) / (count - 1);
      north2 += (c.north.si() - north) * (c.north.si() - north) / (count - 1);
    }
    const auto said = family.sample(at, z, t);
    REQUIRE(said);
    CHECK(said->members == values.size());
    CHECK(said->mean.east.si() == Approx(east).margin(kRounding));
    CHECK(said->mean.north.si() == Approx(north).margin(kRounding));
    CHECK(said->spread->east.si() == Approx(std::sqrt(east2)).margin(kRounding));
    CHECK(said->spread->north.si() == Approx(std::sqrt(north2)).margin(kRounding));
  }
  CHECK(partly > 10);
}

TEST_CASE("a large current that all members share does not hide how far they are apart") {
  // Differences of 1e-6 m/s around 4 m/s: Σc² − n·c̄² would keep two figures of 1e-12 of 16, Welford's sums lose 4·1e-16 of 1e-6.
  CurrentMoments moments;
  for (const double d : {-1e-6, 0.0, 1e-6}) moments.add({MetresPerSecond{4 + d}, MetresPerSecond{-d}});
  CHECK(moments.spread()->east.si() == Approx(1e-6).epsilon(1e-8));
  CHECK(moments.spread()->north.si() == Approx(1e-6).epsilon(1e-8));
}

TEST_CASE("where at least half of the members have water the others are left out and counted") {
  const test::Uniform one{0.1, 0}, other{0.3, 0};
  const Dry land{NoCurrent::land}, hole;
  const auto said = Family{{one, land, other, hole}}.sample(kHere, {}, 0);
  REQUIRE(said);
  CHECK(said->members == 2);
  CHECK(said->mean.east.si() == Approx(0.2).margin(kRounding));
}

TEST_CASE("where most members have no water there is none for the reason of the first of them") {
  const test::Uniform wet{0.1, 0};
  const Dry land{NoCurrent::land}, hole;
  const auto said = Family{{wet, hole, land}}.sample(kHere, {}, 0);
  REQUIRE_FALSE(said);
  CHECK(said.error() == NoCurrent::no_data);
}

TEST_CASE("a single member is the mean and says nothing of a spread") {
  const test::Uniform alone{0.1, -0.2};
  const auto said = Family{{alone}}.sample(kHere, {}, 0);
  REQUIRE(said);
  CHECK(said->mean == Current{MetresPerSecond{0.1}, MetresPerSecond{-0.2}});
  CHECK_FALSE(said->spread);
}

TEST_CASE("a value that one member borrows marks the sample of the family") {
  const auto coast = [](double, double lon) {
    return lon > 5 ? std::pair{test::kDry, test::kDry} : std::pair{0.1, 0.0};
  };
  const auto open = [](double, double) { return std::pair{0.2, 0.0}; };
  const auto lats = test::steps(39, 0.5, 5), lons = test::steps(4, 0.5, 5);
  const auto borrows = test::make_field(lats, lons, coast), wet = test::make_field(lats, lons, open);
  const auto near_coast = geo_point(40, 5.4);
  REQUIRE(borrows.sample(near_coast, {}, 0)->extrapolated);
  CHECK(Family{{wet, borrows}}.sample(near_coast, {}, 0)->extrapolated);
  CHECK_FALSE(Family{{wet, borrows}}.sample(geo_point(40, 4.2), {}, 0)->extrapolated);
}
