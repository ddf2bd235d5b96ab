#include "core/ocean/forecast.hpp"

#include <catch2/catch.hpp>
#include <optional>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

namespace {

Grid deep() {
  GridAxes axes{{0, 3600}, {0, 100, 200}, {39, 40, 41}, {4, 5, 6}, true, true};
  Grid grid = test::make_grid(axes, [](double, double, double z, double) { return std::pair{0.4 - z / 1000, 0.1}; });
  grid.facts.cycle = "model of Monday";
  grid.facts.reference_s = -7200;
  grid.facts.warnings = {"from ingest"};
  grid.facts.sources = {{"a.nc", Sha256::of("a")}};
  return grid;
}
const DiveProfile kPlain{Metres{0}, Metres{200}, 1, 1};

double east_of(const Expected<Sample, NoCurrent>& s) {
  REQUIRE(s);
  return s->current.east.si();
}
AnalyticField constant(double u) {
  AnalyticSpec spec;
  spec.kind = "constant";
  spec.origin = geo_point(40, 5);
  spec.params = {{"u", u}, {"v", 0}};
  return *AnalyticField::make(spec, Instant{});
}

}  // namespace

TEST_CASE(
    "a dive moves with the mean of its profile, a drift with the shallowest level, the verifier with all levels") {
  const Grid grid = deep();
  const auto forecast = Forecast::prepare(view_of(grid), kPlain, {}, nullptr);
  REQUIRE(forecast);
  const auto p = geo_point(40, 5);
  CHECK(east_of(forecast->ocean().dive.sample(p, 0)) == Approx(0.3).margin(1e-6));
  CHECK(east_of(forecast->ocean().surface.sample(p, 0)) == Approx(0.4).margin(1e-6));
  CHECK(east_of(forecast->full().sample(p, Depth{Metres{150}}, 0)) == Approx(0.25).margin(1e-6));
  CHECK(forecast->full().sample(p, Depth{Metres{201}}, 0).error() == NoCurrent::below_bottom);
  const auto& facts = forecast->facts();
  CHECK(facts.name == "model of Monday");
  CHECK(facts.levels == 3);
  CHECK(facts.first_s == 0);
  CHECK(facts.last_s == 3600);
  CHECK(facts.provenance == provenance_of(grid.facts.sources));
  CHECK(facts.warnings == std::vector<std::string>{"from ingest"});
}

TEST_CASE("a forecast keeps its grid alive, and a copy keeps the forecast") {
  std::optional<Ocean> ocean;
  std::optional<Forecast> copy;
  {
    auto owner = std::make_shared<const Grid>(deep());
    const auto forecast = Forecast::prepare(view_of(*owner), kPlain, {}, owner);
    REQUIRE(forecast);
    copy = *forecast;
    ocean = forecast->ocean();
  }
  CHECK(east_of(ocean->dive.sample(geo_point(40, 5), 0)) == Approx(0.3).margin(1e-6));
}

TEST_CASE("a two-dimensional grid serves dive, drift and verifier alike") {
  const Grid grid = test::make_grid(test::flat_axes({39, 40}, {4, 5}), [](double, double, double, double) {
    return std::pair{0.2, 0.0};
  });
  const auto forecast = Forecast::prepare(view_of(grid), kPlain, {}, nullptr);
  REQUIRE(forecast);
  const auto p = geo_point(39.5, 4.5);
  CHECK(east_of(forecast->ocean().dive.sample(p, 0)) == east_of(forecast->ocean().surface.sample(p, 0)));
  CHECK(east_of(forecast->full().sample(p, Depth{Metres{900}}, 0)) == east_of(forecast->ocean().dive.sample(p, 0)));
  CHECK_FALSE(forecast->facts().has_time);
  CHECK(forecast->age(instant_at(1e9)) == Seconds{0});
}

TEST_CASE("the age counts from the reference time, else from the first field") {
  Grid grid = deep();
  CHECK(Forecast::prepare(view_of(grid), kPlain, {}, nullptr)->age(instant_at(3600)) == Seconds{3600 + 7200});
  grid.facts.reference_s = std::numeric_limits<double>::quiet_NaN();
  CHECK(Forecast::prepare(view_of(grid), kPlain, {}, nullptr)->age(instant_at(5400)) == Seconds{5400});
}

TEST_CASE("a forecast without water, or too fast to be true, is refused, a very fast one is warned about") {
  const auto with_speed = [](double speed) {
    const Grid grid = test::make_grid(test::flat_axes({39, 40}, {4, 5}), [&](double, double, double, double) {
      return std::pair{speed, 0.0};
    });
    return Forecast::prepare(view_of(grid), kPlain, {}, nullptr);
  };
  CHECK(with_speed(5.1).error().message() == "the fastest current is 5.10 m/s, allowed is at most 5.00 m/s");
  REQUIRE(with_speed(5.0));
  REQUIRE(with_speed(4.0));
  CHECK(with_speed(4.0)->facts().warnings == std::vector<std::string>{"the fastest current is 4.00 m/s"});
  CHECK(with_speed(3.0)->facts().warnings.empty());
  CHECK(with_speed(test::kDry).error().message() == "no node has a current");
}

TEST_CASE("analytic fields add to a grid on its box, and alone they are a forecast of their own") {
  const Grid grid = deep();
  const auto both = Forecast::prepare(view_of(grid), kPlain, {}, nullptr, {constant(0.05)});
  REQUIRE(both);
  CHECK(east_of(both->ocean().dive.sample(geo_point(40, 5), 0)) == Approx(0.35).margin(1e-6));
  CHECK(east_of(both->ocean().surface.sample(geo_point(40, 5), 0)) == Approx(0.45).margin(1e-6));
  CHECK(both->ocean().dive.sample(geo_point(50, 5), 0).error() == NoCurrent::outside_area);
  CHECK(both->facts().name == "model of Monday + analytic constant");
  CHECK(both->facts().provenance != provenance_of(grid.facts.sources));

  const auto one = Forecast::prepare({constant(0.1)});
  const auto two = Forecast::prepare({constant(0.1), constant(0.2)});
  REQUIRE(one);
  REQUIRE(two);
  CHECK(east_of(one->ocean().dive.sample(geo_point(0, 0), 0)) == 0.1);
  CHECK(east_of(two->full().sample(geo_point(0, 0), 0)) == Approx(0.3));
  CHECK(one->facts().provenance != two->facts().provenance);
  CHECK(one->facts().provenance == Forecast::prepare({constant(0.1)})->facts().provenance);
  CHECK_FALSE(Forecast::prepare(std::vector<AnalyticField>{}));
}

TEST_CASE("what the options change is said") {
  const Grid grid = deep();
  GriddedOptions options;
  options.mask_is_land = true;
  options.outside_time = OutsideTime::cycle;
  const auto forecast = Forecast::prepare(view_of(grid), kPlain, options, nullptr);
  REQUIRE(forecast);
  CHECK(forecast->facts().warnings.size() == 3);
  CHECK(forecast->facts().warnings[1] == "no coastline: the model's mask is taken as land");
}

TEST_CASE("a forecast has the water of its most trusted source that has one") {
  Grid bay = deep(), globe = deep();
  bay.facts.water.words = "temp and salt are not used: they are of one depth only";
  globe.facts.water = {{{Metres{0}, 20, 36}, {Metres{100}, 15, 35.5}}, "thetao and so"};
  const auto water_over = [](const Grid& first, const Grid& second) {
    return water_of(
        {ForecastSource{"bay", view_of(first), {}, nullptr}, ForecastSource{"globe", view_of(second), {}, nullptr}});
  };
  CHECK(water_over(bay, globe) == GridWater{globe.facts.water.layers, "source 'globe': thetao and so"});
  CHECK(water_over(globe, bay).words == "source 'bay': thetao and so");
  CHECK(water_over(bay, bay) == GridWater{{}, "source 'bay': temp and salt are not used: they are of one depth only"});
  CHECK(water_over(deep(), deep()) == GridWater{});
  const auto alone = Forecast::prepare(view_of(globe), kPlain, {}, nullptr);
  REQUIRE(alone);
  CHECK(alone->facts().water == globe.facts.water);
}
