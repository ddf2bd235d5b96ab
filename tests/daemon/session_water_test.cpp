#include <catch2/catch.hpp>

#include "core/mission/in_water.hpp"
#include "tests/support/forecast_shelf.hpp"
#include "tests/support/session_desk.hpp"

// A daemon's session whose mission gives a body and no water.

using namespace glidehelm;
using daemon::RecordType;
using test::ForecastShelf;
using test::SessionDesk;

namespace {

constexpr const char* kBody =
    "schema: glidehelm/mission/v1\nname: leg-2\nglider: sim01\nglider_mission: glide.mi\n"
    "goal: {lat_deg: 29.1667, lon_deg: -15.5}\ncurrents: {files: [/data/*.nc]}\n"
    "vehicle: {force_balance: {}}\nplanning: {method: direct}\napproval: {mode: auto}\n";

struct BodyDesk {
  SessionDesk desk;
  ForecastShelf shelf{desk.world};

  void publish(const std::string& name, double hours_ago, std::optional<double> surface_c) {
    const double from = epoch_seconds(desk.world.clock.utc()) - 3600 * hours_ago;
    shelf.publish(name, {0.05, from, from, 96, surface_c});
  }
  void fly() {
    desk.session->fly({SessionDesk::mission(kBody)}, "start");
    REQUIRE(desk.session->start());
    desk.dial();
  }
  [[nodiscard]] MetresPerSecond speed() const { return desk.session->pilot().mission()->horizontal_speed; }
  [[nodiscard]] static MetresPerSecond speed_in(double surface_c) {
    return in_water(SessionDesk::mission(kBody).mission, ForecastShelf::water(surface_c)).mission.horizontal_speed;
  }
};

}  // namespace

TEST_CASE("a glider of a body flies in the forecast's water, follows the next forecast's, and says so") {
  BodyDesk d;
  d.publish("a.nc", 12, 24.0);
  d.fly();
  CHECK(d.speed() == BodyDesk::speed_in(24));
  CHECK(d.desk.said("in the forecast's water (made up)") == 1);
  CHECK(d.desk.recorded(RecordType::event, "forecast_water") == 1);
  d.desk.say(d.desk.connection_block(30) + d.desk.at_surface_block(30, 3));
  const auto planned = d.desk.session->pilot().learned().speed;
  CHECK(planned == BodyDesk::speed_in(24));

  d.publish("b.nc", 1, 8.0);
  d.desk.session->look_at_forecast();
  d.desk.settle();
  CHECK(d.speed() == BodyDesk::speed_in(8));
  CHECK(d.speed() != BodyDesk::speed_in(24));
  CHECK(d.desk.recorded(RecordType::event, "forecast_water") == 2);
  const auto children = d.shelf.children();
  d.desk.session->look_at_forecast();  // the same files, and a mission that is the same but for its water
  d.desk.settle();
  CHECK(d.shelf.children() == children);
  CHECK(d.desk.recorded(RecordType::event, "forecast_water") == 2);
}

TEST_CASE("after a restart the pilot has the water of the journal before a forecast is read") {
  BodyDesk d;
  d.publish("a.nc", 12, 24.0);
  d.fly();
  d.desk.say(d.desk.connection_block(30) + d.desk.at_surface_block(30, 3));
  const auto past = d.desk.journal->all().value();
  BodyDesk again;  // with another disk: there is no forecast
  again.desk.session->recover(past);
  CHECK(again.speed() == BodyDesk::speed_in(24));
  CHECK(again.desk.session->pilot().learned() == d.desk.session->pilot().learned());
}

TEST_CASE("without temperature and salinity in the forecast it is the climatological profile, said once") {
  BodyDesk d;
  d.publish("a.nc", 12, std::nullopt);
  d.fly();
  CHECK(d.speed() == SessionDesk::mission(kBody).mission.horizontal_speed);
  CHECK(d.desk.said("the climatological profile, for want of the forecast's water") == 1);
}
