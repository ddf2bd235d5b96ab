#include "simulator/ocean_truth.hpp"

#include <catch2/catch.hpp>

#include "core/ocean/grid_format.hpp"
#include "daemon/world/real_files.hpp"
#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::OceanTruth;
using simulator::TruthPlan;

namespace {

const Instant kStart = instant_at(1.7e9);

}  // namespace

TEST_CASE("still water has a current of zero everywhere and for ever") {
  world::RealFiles files;
  TruthPlan plan;
  plan.still = true;
  const auto truth = OceanTruth::make(plan, kStart, false, files);
  REQUIRE(truth);
  const auto s = truth->ocean().dive.sample(geo_point(-40, 170), Depth{Metres{100}}, 5e9);
  REQUIRE(s);
  CHECK(s->current == Current{});
}

TEST_CASE("analytic fields add up") {
  world::RealFiles files;
  TruthPlan plan;
  for (const double u : {0.1, 0.25}) {
    ocean::AnalyticSpec spec;
    spec.kind = "constant";
    spec.origin = geo_point(40, 5);
    spec.params = {{"u", u}, {"v", -u}};
    plan.analytic.push_back(spec);
  }
  const auto truth = OceanTruth::make(plan, kStart, false, files);
  REQUIRE(truth);
  const auto s = truth->ocean().surface.sample(geo_point(40, 5), 1.7e9);
  CHECK(s->current.east.si() == Approx(0.35));
  CHECK(s->current.north.si() == Approx(-0.35));
}

TEST_CASE("an analytic field of an unknown kind or parameter is refused by name") {
  world::RealFiles files;
  TruthPlan plan;
  plan.analytic.push_back({});
  plan.analytic[0].kind = "whirl";
  const auto truth = OceanTruth::make(plan, kStart, false, files);
  REQUIRE_FALSE(truth);
  CHECK(truth.error().message().find("whirl") != std::string::npos);
}

TEST_CASE("a grid moves a diver at its depth and a drifter at the surface, and ends with its last hour") {
  ocean::Grid grid;
  grid.axes.times_s = {1.7e9, 1.7e9 + 3600};
  grid.axes.depths_m = {0, 100};
  grid.axes.lats_deg = {40, 41};
  grid.axes.lons_deg = {4, 5};
  for (int t = 0; t < 2; ++t)
    for (const float east : {0.4F, 0.1F})
      for (int node = 0; node < 4; ++node) {
        grid.values.push_back(east);
        grid.values.push_back(0.0F);
      }
  TempFolder temp;
  temp.write("g", ocean::write_grid(grid));
  world::RealFiles files;
  TruthPlan plan;
  plan.grid = (temp.path / "g").string();
  const auto truth = OceanTruth::make(plan, kStart, false, files);
  REQUIRE(truth);
  const auto ocean = truth->ocean();
  const auto p = geo_point(40.5, 4.5);
  CHECK(ocean.dive.sample(p, Depth{Metres{50}}, 1.7e9)->current.east.si() == Approx(0.25).margin(1e-6));
  CHECK(ocean.surface.sample(p, Depth{Metres{50}}, 1.7e9)->current.east.si() == Approx(0.4).margin(1e-6));
  const auto late = ocean.dive.sample(p, 1.7e9 + 3601);
  REQUIRE_FALSE(late);
  CHECK(late.error() == ocean::NoCurrent::outside_time);
}

TEST_CASE("a grid that is missing or damaged is refused with its path") {
  TempFolder temp;
  temp.write("bad", "not a grid at all");
  world::RealFiles files;
  for (const char* name : {"absent", "bad"}) {
    TruthPlan plan;
    plan.grid = (temp.path / name).string();
    const auto truth = OceanTruth::make(plan, kStart, false, files);
    REQUIRE_FALSE(truth);
    CHECK(truth.error().message().find(name) != std::string::npos);
  }
}
