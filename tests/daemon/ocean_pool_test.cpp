#include "daemon/ocean_pool.hpp"

#include <catch2/catch.hpp>

#include "core/base/utc.hpp"
#include "core/mission/in_water.hpp"
#include "tests/support/forecast_shelf.hpp"

using namespace glidehelm;
using namespace glidehelm::daemon;
using glidehelm::test::ForecastShelf;

namespace {

/// A shelf with one good forecast, a pool, and what each asker was answered.
struct Desk {
  test::ManualWorld manual;
  world::World world{manual.world()};
  ForecastShelf shelf{manual};
  OceanPool pool;
  std::vector<OceanOutcome> answers;

  Desk() {
    manual.files.make_folder_at("/state");
    manual.files.make_folder_at("/state/grids");
    const double now_s = epoch_seconds(manual.clock.utc());
    shelf.publish("a.nc", {0.125, now_s - 3600, now_s - 3600, 96});
  }
  [[nodiscard]] OceanOrder order() const {
    mission::Mission m;
    m.glider = "sim01";
    m.goal = geo_point(28.5, -15.5);
    m.currents.files = {"/data/*.nc"};
    return {m, "/state/grids", true, manual.clock.utc(), {}};
  }
  void ask(const OceanOrder& order, const std::string& seen = "as it is") {
    pool.load(order, seen, world, [this](OceanOutcome outcome) { answers.push_back(std::move(outcome)); });
  }
};

}  // namespace

TEST_CASE("gliders that ask while a forecast is read share the reading and the forecast") {
  Desk desk;
  auto other = desk.order();
  other.mission.glider = "sim02";
  other.mission.goal = geo_point(29, -15);  // another way through the same water
  desk.ask(desk.order());
  desk.ask(other);
  desk.manual.net.settle();
  REQUIRE(desk.answers.size() == 2);
  REQUIRE(desk.answers[0]);
  CHECK(*desk.answers[0] == *desk.answers[1]);  // the same object
  CHECK(desk.shelf.children() == 1);
}

TEST_CASE("who asks later gets the forecast that is in use, told from the loop") {
  Desk desk;
  desk.ask(desk.order());
  desk.manual.net.settle();
  desk.ask(desk.order());
  CHECK(desk.answers.size() == 1);
  desk.manual.net.settle();
  REQUIRE(desk.answers.size() == 2);
  CHECK(*desk.answers[0] == *desk.answers[1]);
  CHECK(desk.shelf.children() == 1);
}

TEST_CASE("another dive profile, another coast or changed files are another forecast") {
  Desk desk;
  desk.ask(desk.order());
  auto deeper = desk.order();
  deeper.mission.dive_depth = Metres{400};
  desk.ask(deeper);
  auto coastless = desk.order();
  coastless.has_coast = false;
  desk.ask(coastless);
  desk.ask(desk.order(), "changed");
  desk.manual.net.settle();
  REQUIRE(desk.answers.size() == 4);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK(*desk.answers[i] != *desk.answers[j]);
  CHECK(desk.shelf.children() == 4);
}

TEST_CASE("a forecast that nobody uses any more is forgotten") {
  Desk desk;
  desk.ask(desk.order());
  desk.manual.net.settle();
  const std::weak_ptr<const OceanSource> first = *desk.answers[0];
  desk.answers.clear();
  CHECK(first.expired());
  desk.ask(desk.order());
  desk.manual.net.settle();
  CHECK(desk.answers.at(0));
  CHECK(desk.shelf.children() == 2);
}

TEST_CASE("a failure is told to everybody who waits, and the next asker has the files read again") {
  Desk desk;
  desk.shelf.take("a.nc");
  desk.shelf.publish_bad("a.nc", "cut short");
  desk.ask(desk.order());
  desk.ask(desk.order());
  desk.manual.net.settle();
  REQUIRE(desk.answers.size() == 2);
  for (const auto& answer : desk.answers) {
    REQUIRE_FALSE(answer);
    CHECK(answer.error().what.find("cut short") != std::string::npos);
  }
  const auto children = desk.shelf.children();
  desk.ask(desk.order());
  desk.manual.net.settle();
  CHECK(desk.answers.size() == 3);
  CHECK(desk.shelf.children() > children);
}

TEST_CASE("analytic currents lie around each glider's own goal and are not shared") {
  Desk desk;
  auto order = desk.order();
  order.mission.currents.files.clear();
  order.mission.currents.analytic = {
      ocean::AnalyticSpec{"constant", {}, Metres{1}, MetresPerSecond{1}, {}, {}, false, {}, {}}};
  desk.ask(order);
  desk.ask(order);
  desk.manual.net.settle();
  REQUIRE(desk.answers.size() == 2);
  REQUIRE(desk.answers[0]);
  CHECK(*desk.answers[0] != *desk.answers[1]);
}

TEST_CASE("a body's mission in the forecast's water is the same order as before it was put there") {
  Desk desk;
  auto body = desk.order();
  body.mission.flight_model.emplace();
  desk.ask(body);
  desk.manual.net.settle();
  auto there = body;
  there.mission = in_water(body.mission, ForecastShelf::water(24)).mission;
  REQUIRE(there.mission.horizontal_speed != body.mission.horizontal_speed);
  desk.ask(there);
  desk.ask(desk.order());  // a configured speed has another profile
  desk.manual.net.settle();
  REQUIRE(desk.answers.size() == 3);
  CHECK(*desk.answers[0] == *desk.answers[1]);
  CHECK(*desk.answers[0] != *desk.answers[2]);
}
