#include "daemon/cli/field_info.hpp"
#include "daemon/cli/field_sample.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/utc.hpp"
#include "daemon/world/real.hpp"
#include "tests/daemon/ingest/model_file.hpp"
#include "tests/support/data.hpp"
#include "tests/support/netcdf.hpp"

// The verb with the real adapters and the real child.

using namespace glidehelm;
using namespace glidehelm::cli;
using nlohmann::json;

namespace {

struct Said {
  int code{};
  std::string out, err;
  [[nodiscard]] json document() const { return json::parse(out); }
};

/// The built child is found through PATH, as an installed one would be.
world::World real_world() {
  static world::RealWorld real;
  static const bool once = [] {
    const std::string program = GLIDEHELM_INGEST;
    const char* path = std::getenv("PATH");
    const std::string extended = program.substr(0, program.rfind('/')) + ":" + (path != nullptr ? path : "");
    return setenv("PATH", extended.c_str(), 1) == 0;
  }();
  REQUIRE(once);
  return real.world();
}

Said info(const std::vector<std::string>& files, bool as_json = true) {
  auto world = real_world();
  std::ostringstream out, err;
  FieldInfoOptions options;
  options.files = files;
  options.json = as_json;
  const int code = run_field_info(options, world, out, err);
  return {code, out.str(), err.str()};
}
Said sample(const FieldSampleOptions& options) {
  auto world = real_world();
  std::ostringstream out, err;
  const int code = run_field_sample(options, world, out, err);
  return {code, out.str(), err.str()};
}

/// A shelf: two hours, three levels, 4 × 4 columns; the west column is land, the next ends at 10 m. At 01:00 the last
/// column has a gap. u = 0.1 + level/10, v = hour/10.
std::string shelf(const test::ScratchFolder& folder) {
  std::string u, v;
  for (int t = 0; t < 2; ++t)
    for (int z = 0; z < 3; ++z)
      for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i) {
          const bool dry = i <= 1 || (i == 2 && z > 1) || (t == 1 && i == 5);
          u += (u.empty() ? "" : ", ") + (dry ? std::string{"_"} : std::to_string(0.1 + 0.1 * z));
          v += (v.empty() ? "" : ", ") + (dry ? std::string{"_"} : std::to_string(0.1 * t));
        }
  return test::make_netcdf(folder, "shelf.nc", R"(netcdf shelf {
dimensions: time = 2 ; depth = 3 ; lat = 6 ; lon = 6 ;
variables:
  double time(time) ; time:units = "hours since 2024-05-01" ; float depth(depth) ; depth:units = "m" ; depth:positive = "down" ;
  float lat(lat) ; lat:units = "degrees_north" ; float lon(lon) ; lon:units = "degrees_east" ;
  float uo(time, depth, lat, lon) ; uo:units = "m s-1" ; uo:standard_name = "eastward_sea_water_velocity" ; uo:_FillValue = -99.f ;
  float vo(time, depth, lat, lon) ; vo:units = "m s-1" ; vo:standard_name = "northward_sea_water_velocity" ; vo:_FillValue = -99.f ;
data:
  time = 0, 1 ; depth = 0, 10, 20 ; lat = 30, 31, 32, 33, 34, 35 ; lon = -20, -19, -18, -17, -16, -15 ;
  uo = )" + u + " ;\n  vo = " + v + " ;\n}");
}

FieldSampleOptions at(const std::string& file, double lat, double lon, const char* time) {
  FieldSampleOptions options;
  options.files = {file};
  options.lat_deg = lat;
  options.lon_deg = lon;
  options.time = utc_from_text(time);
  options.json = true;
  return options;
}

}  // namespace

TEST_CASE("field info says in words how a model's own grid was read") {
  const test::ScratchFolder folder;
  const auto model = test::Turned{}.file([](double, double) { return 0.3; }, [](double, double) { return -0.4; });
  const auto file = test::make_netcdf(folder, "roms.nc", model.cdl());
  const auto document = info({file}).document();
  CHECK(document["grid"]["kind"] == "curvilinear");
  const auto published = document["grid"]["published_as"].get<std::string>();
  for (const char* part : {"curvilinear Arakawa C grid of 6 by 7 points (lat_rho, lon_rho)", "turned by angle (",
                           "land where values are missing", "brought onto "})
    CHECK(published.find(part) != std::string::npos);
  const auto text = info({file}, false).out;
  CHECK(text.find("published  curvilinear Arakawa C grid") != std::string::npos);
  CHECK(info({shelf(folder)}, false).out.find("published") == std::string::npos);
}

TEST_CASE("field info says what a forecast is, as JSON") {
  const test::ScratchFolder folder;
  const auto file = shelf(folder);
  const auto said = info({file});
  REQUIRE(said.code == 0);
  const auto document = said.document();
  CHECK(document["schema"] == "glidehelm/field-info/v1");
  CHECK(document["variables"]["east"] == json{{"name", "uo"}, {"unit", "m s-1"}});
  CHECK(document["variables"]["recognised_by"] == "standard_name eastward_sea_water_velocity");
  CHECK(document["grid"]["kind"] == "rectilinear");
  CHECK(document["grid"]["latitudes"] ==
        json{{"count", 6}, {"first_deg", 30.0}, {"last_deg", 35.0}, {"step_deg", 1.0}, {"even", true}});
  CHECK(document["extent"]["west_deg"] == -20);
  CHECK(document["extent"]["around_globe"] == false);
  CHECK(document["times"]["count"] == 2);
  CHECK(document["times"]["first"] == "2024-05-01T00:00:00Z");
  CHECK(document["times"]["last"] == "2024-05-01T01:00:00Z");
  CHECK(document["depths_m"] == json{0.0, 10.0, 20.0});
  // Columns 0, 1 dry; column 2 lacks a third of its levels; column 5 is dry at the second hour.
  CHECK(document["wet_fraction"].get<double>() == Approx((4 - 1.0 / 3 - 0.5) / 6).epsilon(1e-9));
  CHECK(document["speed_m_per_s"]["min"].get<double>() == Approx(0.1));
  CHECK(document["sources"][0]["file"] == file);
  CHECK(document["sources"][0]["sha256"] == Sha256::of(test::file_bytes(file)).hex());
  CHECK(document["warnings"].empty());
  CHECK(document["reference_time"].is_null());
  CHECK(said.err.empty());
}

TEST_CASE("field info reads for people too") {
  const test::ScratchFolder folder;
  const auto said = info({shelf(folder)}, false);
  CHECK(said.code == 0);
  CHECK(said.out.find("grid       rectilinear, 6 latitudes 30.0000 to 35.0000, 6 longitudes -20.0000 to -15.0000") !=
        std::string::npos);
  CHECK(said.out.find("times      2, 2024-05-01T00:00:00Z to 2024-05-01T01:00:00Z") != std::string::npos);
}

TEST_CASE("field info says when the current is computed from heights") {
  const test::ScratchFolder folder;
  const auto file = test::make_netcdf(folder, "adt.nc", R"(netcdf adt { dimensions: lat = 3 ; lon = 3 ;
variables: float lat(lat) ; lat:units = "degrees_north" ; float lon(lon) ; lon:units = "degrees_east" ;
  float adt(lat, lon) ; adt:units = "m" ;
data: lat = 40, 41, 42 ; lon = 5, 6, 7 ; adt = 0, 0.1, 0.2, 0, 0.1, 0.2, 0, 0.1, 0.2 ; })");
  const auto said = info({file}, false);
  CHECK(said.code == 0);
  CHECK(said.out.find("variables  adt (m); the current is computed from heights: adt, by name\n") != std::string::npos);
  CHECK(info({file}).document()["variables"]["recognised_by"] == "computed from heights: adt, by name");
}

TEST_CASE("field sample gives the current, between times and levels") {
  const test::ScratchFolder folder;
  auto options = at(shelf(folder), 32.5, -16.5, "2024-05-01T00:30:00Z");
  auto said = sample(options);
  REQUIRE(said.code == 0);
  CHECK(said.document()["east_m_per_s"].get<double>() == Approx(0.1).epsilon(1e-6));  // the shallowest level
  CHECK(said.document()["north_m_per_s"].get<double>() == Approx(0.05).epsilon(1e-6));
  CHECK(said.document()["extrapolated"] == false);
  CHECK(said.document().size() == 3);

  options.depth_m = 15;
  CHECK(sample(options).document()["east_m_per_s"].get<double>() == Approx(0.25).epsilon(1e-6));
  options.depth_m.reset();
  options.depth_mean = {0.0, 20.0};
  CHECK(sample(options).document()["east_m_per_s"].get<double>() == Approx(0.2).epsilon(1e-6));
  options.depth_mean = {10.0, 20.0};
  CHECK(sample(options).document()["east_m_per_s"].get<double>() == Approx(0.25).epsilon(1e-6));
}

TEST_CASE("field sample tells mean and spread of the members beside the value of member 0") {
  const test::ScratchFolder folder;
  // Eastward 0.1, 0.2 and 0.6 m/s: mean 0.3, deviations −0.2, −0.1 and 0.3, spread √(0.14/2). At 50 and 60 north two of three are dry, and
  // 59 is beyond the 1.5 cells that a value is borrowed over.
  auto options = at(test::make_netcdf(folder, "e.nc", R"(netcdf e {
dimensions: member = 3 ; lat = 4 ; lon = 2 ;
variables: double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;
  float u(member, lat, lon) ; u:units = "m/s" ; u:standard_name = "eastward_sea_water_velocity" ; u:_FillValue = -99.f ;
  float v(member, lat, lon) ; v:units = "m/s" ; v:standard_name = "northward_sea_water_velocity" ; v:_FillValue = -99.f ;
data: lat = 30, 40, 50, 60 ; lon = 0, 8 ;
  u = 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.2, _, _, _, _, 0.6, 0.6, 0.6, 0.6, _, _, _, _ ;
  v = 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, _, _, _, _, 0.05, 0.05, 0.05, 0.05, _, _, _, _ ;
})"),
                    35, 4, "2024-05-01");
  options.members = 3;
  auto said = sample(options);
  INFO(said.err);
  REQUIRE(said.code == 0);
  const auto document = said.document();
  const auto& all = document["ensemble"];
  // Floats: 3e-8 of a value below 1.
  CHECK(document["east_m_per_s"].get<double>() == Approx(0.1).margin(1e-7));
  CHECK(all["members"] == 3);
  CHECK(all["mean_east_m_per_s"].get<double>() == Approx(0.3).margin(1e-7));
  CHECK(all["mean_north_m_per_s"].get<double>() == Approx(0.05).margin(1e-7));
  CHECK(all["spread_east_m_per_s"].get<double>() == Approx(std::sqrt(0.07)).margin(1e-7));
  CHECK(all["spread_north_m_per_s"].get<double>() == Approx(0).margin(1e-7));
  CHECK(all["spread_m_per_s"].get<double>() == Approx(std::sqrt(0.07)).margin(1e-7));
  options.json = false;
  CHECK(sample(options).out.find(
            "  mean of 3 members: east 0.3000 m/s, north 0.0500 m/s; spread 0.2646 m/s (east 0.2646, ") !=
        std::string::npos);

  options.lat_deg = 59;
  options.json = true;
  CHECK(sample(options).document()["ensemble"].is_null());
  options.members = 4;
  said = sample(options);
  CHECK(said.code == 1);
  CHECK(said.err.find("member 3: ") != std::string::npos);
  options.ingest.member = 1;
  CHECK(sample(options).code == 2);
}

TEST_CASE("field sample says why there is no current, and ends with 1") {
  const test::ScratchFolder folder;
  const auto file = shelf(folder);
  const auto reason = [&](const FieldSampleOptions& options) {
    const auto said = sample(options);
    CHECK(said.code == 1);
    const auto document = said.document();
    CHECK_FALSE(document["message"].get<std::string>().empty());
    return document["none"].get<std::string>();
  };
  CHECK(reason(at(file, 32, -19.9, "2024-05-01")) == "land");
  CHECK(reason(at(file, 32, -15.0, "2024-05-01T03:00:00Z")) == "outside_time");
  CHECK(reason(at(file, 32, -14.9, "2024-05-01")) == "outside_area");
  CHECK(reason(at(file, -32, 19.9, "2024-05-01")) == "outside_area");
  auto deep = at(file, 32, -18, "2024-05-01");
  deep.depth_m = 15;
  CHECK(reason(deep) == "below_bottom");
  deep.depth_m.reset();
  deep.depth_mean = {12.0, 20.0};
  CHECK(reason(deep) == "below_bottom");
}

TEST_CASE("a gap in time is no data, beside the coast the value is extrapolated") {
  const test::ScratchFolder folder;
  std::string cdl_values = "0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1";
  const auto file = test::make_netcdf(folder, "gap.nc",
                                      R"(netcdf gap {
dimensions: time = 2 ; lat = 2 ; lon = 6 ;
variables: double time(time) ; time:units = "hours since 2024-05-01" ; float lat(lat) ; float lon(lon) ;
  float u(time, lat, lon) ; u:_FillValue = -99.f ; float v(time, lat, lon) ; v:_FillValue = -99.f ;
data: time = 0, 1 ; lat = 0, 1 ; lon = 0, 1, 2, 3, 4, 5 ;
  u = )" + cdl_values + ", 0.1, _, _, _, _, _, 0.1, _, _, _, _, _ ; v = " +
                                          cdl_values + ", " + cdl_values + " ; }");
  const auto gap = sample(at(file, 0.5, 4, "2024-05-01T01:00:00Z"));
  CHECK(gap.code == 1);
  CHECK(gap.document()["none"] == "no_data");
  const auto borrowed = sample(at(file, 0.5, 1.0, "2024-05-01T01:00:00Z"));
  REQUIRE(borrowed.code == 0);
  CHECK(borrowed.document()["extrapolated"] == true);
  CHECK(borrowed.err.find("warning: gap.nc: axis lat has no unit; taken as degrees") != std::string::npos);
}

TEST_CASE("many places come from a CSV, one answer each, one without a current makes the whole end with 1") {
  const test::ScratchFolder folder;
  test::write_bytes(folder / "points.csv",
                    "lat,lon,time,depth\n32.5, -16.5, 2024-05-01T00:30:00Z, 10\n# a remark\n\n32.5,-16.5,2024-05-01\n");
  FieldSampleOptions options;
  options.files = {shelf(folder)};
  options.points = folder / "points.csv";
  options.json = true;
  auto said = sample(options);
  CHECK(said.code == 0);
  const auto document = said.document();
  CHECK(document["schema"] == "glidehelm/field-samples/v1");
  REQUIRE(document["samples"].size() == 2);
  CHECK(document["samples"][0]["east_m_per_s"].get<double>() == Approx(0.2).epsilon(1e-6));
  CHECK(document["samples"][0]["depth_m"] == 10);
  CHECK(document["samples"][0]["lon_deg"] == -16.5);
  CHECK(document["samples"][1]["time"] == "2024-05-01T00:00:00Z");
  CHECK(document["samples"][1]["east_m_per_s"].get<double>() == Approx(0.1).epsilon(1e-6));

  test::write_bytes(folder / "points.csv", "32.5,-16.5,2024-05-01\n32.5,-20,2024-05-01\n");
  said = sample(options);
  CHECK(said.code == 1);
  CHECK(said.document()["samples"][1]["none"] == "land");
}

TEST_CASE("misuse ends with 2 and says what is allowed") {
  const test::ScratchFolder folder;
  const auto file = shelf(folder);
  const auto misuse = [](const FieldSampleOptions& options) {
    const auto said = sample(options);
    CHECK(said.code == 2);
    CHECK(said.out.empty());
    return said.err;
  };
  CHECK(info({}).code == 2);
  CHECK(misuse({}) == "glidehelm field: no file was named\n");
  FieldSampleOptions bare;
  bare.files = {file};
  CHECK(misuse(bare) == "glidehelm field: --lat and --lon, or --points, are needed\n");
  auto options = at(file, 95, 0, "2024-05-01");
  CHECK(misuse(options).find("95") != std::string::npos);
  options = at(file, 32, -16, "2024-05-01");
  options.time.reset();
  CHECK(
      misuse(options).find("--time is needed: the files have 2 times, 2024-05-01T00:00:00Z to 2024-05-01T01:00:00Z") !=
      std::string::npos);
  options.depth_m = -1;
  CHECK(misuse(options) == "glidehelm field: --depth is positive down, allowed is 0 or more\n");
  options.depth_m = 1;
  options.depth_mean = {0.0, 1.0};
  CHECK(misuse(options) == "glidehelm field: --depth and --depth-mean exclude each other\n");
  bare.points = folder / "points.csv";
  for (const auto& [line, complaint] :
       {std::pair{"1,2", "2 columns"}, std::pair{"1,x,2024-05-01", "\"x\" is no number of degrees"},
        std::pair{"1,2,noon", "\"noon\" is no time"}, std::pair{"91,2,2024-05-01", "91"},
        std::pair{"1,2,2024-05-01,deep", "\"deep\" is no depth"}}) {
    test::write_bytes(bare.points, std::string{"lat,lon,time\n"} + line + "\n");
    const auto said = misuse(bare);
    CHECK(said.find("points.csv:2: ") != std::string::npos);
    CHECK(said.find(complaint) != std::string::npos);
  }
}

TEST_CASE("files that the child refuses end with 1 and its reason") {
  const test::ScratchFolder folder;
  test::write_bytes(folder / "bad.nc", "<html>");
  const auto said = info({folder / "bad.nc"});
  CHECK(said.code == 1);
  CHECK(said.out.empty());
  CHECK(said.err == "glidehelm field: " + (folder / "bad.nc") +
                        ": not a NetCDF file: a web page: a server answered with a page instead of the file, perhaps "
                        "an error or a login\n");
  CHECK(info({folder / "none*.nc"}).err == "glidehelm field: no file matches " + (folder / "none*.nc") + "\n");
}

TEST_CASE("real data: info and sample of a coastal forecast with longitudes west of Greenwich") {
  GLIDEHELM_NEEDS_DATA(data);
  const auto file = data + "/currents/rtofs_washington/wa_RTOFS_global.nc";
  const auto said = info({file});
  REQUIRE(said.code == 0);
  CHECK(said.document()["times"]["count"] == 64);
  CHECK(said.document()["warnings"].size() == 4);
  CHECK(sample(at(file, 47.2, -125.9, "2024-10-28T03:00:00Z")).code == 0);
  CHECK(sample(at(file, 47.2, -124.02, "2024-10-28T03:00:00Z")).document()["none"] == "land");
}
