#include "daemon/cli/drift.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/drift_verb.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/four_oceans.hpp"
#include "tests/support/netcdf.hpp"

using namespace glidehelm;

namespace {

/// Eastward 0.2 m/s at the surface, northward 0.1 m/s at 500 m; one day of it.
const std::string kTwoLevels = R"(netcdf d {
dimensions: time = 2 ; depth = 2 ; lat = 2 ; lon = 2 ;
variables: double time(time) ; time:units = "hours since 2026-03-01" ;
  double depth(depth) ; depth:units = "m" ; depth:positive = "down" ; depth:standard_name = "depth" ;
  double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;
  float u(time, depth, lat, lon) ; u:units = "m/s" ; u:standard_name = "eastward_sea_water_velocity" ;
  float v(time, depth, lat, lon) ; v:units = "m/s" ; v:standard_name = "northward_sea_water_velocity" ;
data: time = 0, 24 ; depth = 0, 500 ; lat = -2, 2 ; lon = 0, 8 ;
  u = 0.2, 0.2, 0.2, 0.2, 0, 0, 0, 0, 0.2, 0.2, 0.2, 0.2, 0, 0, 0, 0 ;
  v = 0, 0, 0, 0, 0.1, 0.1, 0.1, 0.1, 0, 0, 0, 0, 0.1, 0.1, 0.1, 0.1 ;
})";

struct Heard {
  int code{};
  nlohmann::json json;
  std::string out, err;
};
struct Adrift {
  test::ScratchFolder folder;
  cli::DriftOptions options;
  explicit Adrift(const std::string& sea, const std::string& more = {}) {
    test::make_netcdf(folder, "sea.nc", sea);
    test::write_bytes(folder / "m.yaml",
                      "schema: glidehelm/mission/v1\nname: adrift\nglider: sim01\ngoal: {lat_deg: 0.0, lon_deg: 3.4}\n"
                      "start: {lat_deg: 0.0, lon_deg: 3.0, time: 2026-03-01T00:00:00Z}\ncurrents: {files: [" +
                          (folder / "sea.nc") + "]}\napproval: {mode: manual}\n" + more);
    options.mission = folder / "m.yaml";
    options.duration = Seconds{48 * 3600.0};
    options.json = true;
  }
  [[nodiscard]] Heard drift() const {
    world::RealWorld real;
    auto w = real.world();
    std::ostringstream out, err;
    Heard heard{cli::run_drift(options, w, out, err), {}, out.str(), err.str()};
    if (options.json) heard.json = nlohmann::json::parse(heard.out, nullptr, false);
    return heard;
  }
};

/// What the parser says of the words after `glidehelm drift`.
bool parses(const std::string& words) {
  CLI::App app;
  cli::Action action;
  cli::add_drift(app, action);
  try {
    app.parse("drift " + words);
  } catch (const CLI::ParseError&) {
    return false;
  }
  return action != nullptr;
}

}  // namespace

TEST_CASE("a drifter's way, that of the members and how they spread are told") {
  Adrift adrift{test::four_oceans()};
  adrift.options.members = 4;
  const auto heard = adrift.drift();
  INFO(heard.err);
  REQUIRE(heard.code == 0);
  const auto& j = heard.json;
  CHECK(j["schema"] == "glidehelm/drift/v1");
  CHECK(j["vehicle"]["kind"] == "drifter");
  CHECK(j["end"]["reason"] == "time");
  CHECK(j["end"]["after_s"] == 48 * 3600.0);
  REQUIRE(j["track"].size() == 9);  // every six hours, both ends
  const double seconds = 48 * 3600.0;
  // The values are kept as floats: 3e-8 of them, and the equator has one scale.
  CHECK(j["end"]["distance_m"].get<double>() == Approx(0.02 * seconds).epsilon(1e-6));
  CHECK(j["end"]["bearing_deg"].get<double>() == Approx(90).margin(1e-6));
  CHECK(j["track"][4]["east_m_per_s"].get<double>() == Approx(0.02));
  const auto& all = j["ensemble"];
  CHECK(all["members"] == 4);
  CHECK(all["afloat"] == 4);
  CHECK(all["ends"][3]["distance_m"].get<double>() == Approx(0.6 * seconds).epsilon(1e-6));
  const double mean = (0.02 + 0.06 - 0.06 - 0.6) / 4;
  double square = 0;
  for (const double u : {0.02, 0.06, -0.06, -0.6}) square += std::pow((u - mean) * seconds, 2) / 4;
  CHECK(all["spread_m"].get<double>() == Approx(std::sqrt(square)).epsilon(1e-6));

  adrift.options.json = false;
  const auto said = adrift.drift();
  CHECK(said.out.find("after 48 h 00 min at 0.0000,3.0310, 3.5 km at 090 from the start; still afloat") !=
        std::string::npos);
  CHECK(said.out.find("301.8627") != std::string::npos);  // 3456 m of the equator at 111 319.49 m a degree are 1.8627′
  CHECK(said.out.find("member   3: after 48 h 00 min") != std::string::npos);
  CHECK(said.out.find("4 of 4 members are afloat to the end") != std::string::npos);
}

TEST_CASE("a drifter at depth goes with the current there until the forecast ends") {
  Adrift adrift{kTwoLevels};
  adrift.options.vehicle = vehicle::Drifter{Metres{500}};
  const auto heard = adrift.drift();
  INFO(heard.err);
  REQUIRE(heard.code == 0);
  CHECK(heard.json["end"]["reason"] == "forecast");
  CHECK(heard.json["end"]["after_s"] == 24 * 3600.0);
  CHECK(heard.json["end"]["bearing_deg"].get<double>() == Approx(0).margin(1e-6));
  CHECK(heard.json["end"]["distance_m"].get<double>() == Approx(0.1 * 24 * 3600).epsilon(1e-6));
  CHECK(heard.json["track"].back()["depth_m"] == 500);
  CHECK_FALSE(heard.json.contains("ensemble"));

  adrift.options.vehicle = vehicle::Drifter{Metres{600}};
  const auto none = adrift.drift();
  CHECK(none.code == 1);
  CHECK(none.json["end"]["reason"] == "bottom");
  CHECK(none.json["end"]["lat_deg"].is_null());
  CHECK(none.json["track"].empty());
}

TEST_CASE("a float that parks below the forecast's last level is carried there and the answer says so") {
  Adrift adrift{kTwoLevels};
  adrift.options.vehicle = vehicle::ProfilingFloat{};
  adrift.options.json = false;
  const auto heard = adrift.drift();
  REQUIRE(heard.code == 0);
  CHECK(heard.out.find("float parked at 1000 m") != std::string::npos);
  CHECK(heard.out.find("at 500 m instead of 1000 m") != std::string::npos);
  CHECK(heard.out.find("parked\n") != std::string::npos);
  Adrift flat{test::four_oceans()};
  flat.options.vehicle = vehicle::ProfilingFloat{};
  CHECK(flat.drift().err.find("one level only") != std::string::npos);
}

TEST_CASE("areas that bind the glider do not stop what drifts") {
  // The drifter gets to 3.031 E, through an area that is forbidden to the glider from 3.02 E.
  Adrift adrift{test::four_oceans(),
                "safety: {keep_out: [[{lat_deg: -0.1, lon_deg: 3.02}, {lat_deg: -0.1, lon_deg: 3.1}, {lat_deg: 0.1, "
                "lon_deg: 3.1}, {lat_deg: 0.1, lon_deg: 3.02}]]}\n"};
  const auto heard = adrift.drift();
  INFO(heard.err);
  CHECK(heard.code == 0);
  CHECK(heard.json["end"]["reason"] == "time");
}

TEST_CASE("drift refuses what cannot be and says what is allowed") {
  CHECK(parses("m.yaml --depth 15 --hours 24"));
  CHECK(parses("m.yaml --float --park 500 --profile 1000 --from -28.2,-15.2 --at 2026-03-01T00:00:00Z"));
  CHECK_FALSE(parses(""));
  CHECK_FALSE(parses("m.yaml --float --depth 15"));
  CHECK_FALSE(parses("m.yaml --park 500"));  // of floats only
  CHECK_FALSE(parses("m.yaml --depth -5"));
  CHECK_FALSE(parses("m.yaml --every 0"));
  CHECK_FALSE(parses("m.yaml --from 28.2"));

  Adrift adrift{test::four_oceans()};
  adrift.options.vehicle = vehicle::ProfilingFloat{Metres{1000}, Metres{500}};
  const auto shallow = adrift.drift();
  CHECK(shallow.code == 2);
  CHECK(shallow.err.find("the profile must begin at the parking depth or deeper") != std::string::npos);
  adrift.options.vehicle = vehicle::Drifter{};
  adrift.options.from = {95.0, 3.0};
  CHECK(adrift.drift().code == 2);
  adrift.options.from = {0.0, 30.0};  // outside the files
  const auto outside = adrift.drift();
  CHECK(outside.code == 1);
  CHECK(outside.json["end"]["reason"] == "left_area");
}
