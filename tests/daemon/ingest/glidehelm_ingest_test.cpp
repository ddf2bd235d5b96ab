#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "core/base/utc.hpp"
#include "tests/daemon/ingest/run.hpp"

// The built program on files that ncgen makes here.

using namespace glidehelm;

namespace {

using test::Ingested;
using test::run_ingest;

std::string refusal(const std::string& cdl, const std::string& more = "", const std::string& kind = "classic") {
  const test::ScratchFolder folder;
  const auto file = test::make_netcdf(folder, "f.nc", cdl, kind);
  const auto result = run_ingest(folder, file + " " + more);
  CHECK(result.ran.code == 1);
  const std::string begin = "glidehelm-ingest: " + file + ": ";
  CHECK(result.ran.err.substr(0, begin.size()) == begin);
  return result.ran.err.size() > begin.size() ? result.ran.err.substr(begin.size()) : result.ran.err;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Axes of a hundred thousand times and a thousand rows and columns; the values themselves are never written.
std::string monstrous_axes() {
  std::string text =
      "u:_Storage = \"chunked\" ; u:_ChunkSizes = 1, 10, 10 ; v:_Storage = \"chunked\" ; v:_ChunkSizes = 1, 10, 10 ; "
      "data: ";
  const auto axis = [&](const char* name, int count, double first, double step) {
    text += std::string{name} + " = ";
    for (int i = 0; i < count; ++i)
      text += (i > 0 ? ", " : "") + (step == 1 ? std::to_string(i) : std::to_string(first + step * i));
    text += " ; ";
  };
  axis("time", 100000, 0, 1);
  axis("lat", 1000, 0, 0.01);
  axis("lon", 1000, 0, 0.01);
  return text;
}

/// Two times, two rows, three columns: u = 0.1·(1…12), v = −u; one missing value of each.
const std::string kPlain = R"(netcdf f {
dimensions: time = 2 ; lat = 2 ; lon = 3 ;
variables:
  double time(time) ; time:units = "hours since 2024-01-01" ;
  double lat(lat) ; lat:units = "degrees_north" ;
  double lon(lon) ; lon:units = "degrees_east" ;
  float u(time, lat, lon) ; u:units = "m/s" ; u:_FillValue = -99.f ;
  float v(time, lat, lon) ; v:units = "m/s" ; v:_FillValue = -99.f ;
data:
  time = 6, 12 ; lat = 40, 40.5 ; lon = -5, -4.5, -4 ;
  u = 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, _ ;
  v = -0.1, -0.2, -0.3, _, -0.5, -0.6, -0.7, -0.8, -0.9, -1.0, -1.1, -1.2 ;
})";

}  // namespace

TEST_CASE("a plain file becomes the grid it describes") {
  const test::ScratchFolder folder;
  const auto result = run_ingest(folder, test::make_netcdf(folder, "f.nc", kPlain));
  REQUIRE(result.view);
  const auto& axes = result.view->axes;
  CHECK(axes.times_s == std::vector<double>{epoch_seconds(*utc_from_text("2024-01-01T06:00:00Z")),
                                            epoch_seconds(*utc_from_text("2024-01-01T12:00:00Z"))});
  CHECK(axes.lats_deg == std::vector<double>{40, 40.5});
  CHECK(axes.lons_deg == std::vector<double>{-5, -4.5, -4});
  CHECK(axes.has_time);
  CHECK_FALSE(axes.has_depth);
  CHECK(result.at(0, 0, 0, 1, 0) == 0.2F);
  CHECK(result.at(1, 0, 0, 2, 1) == -0.9F);
  // A node with one missing component has none.
  CHECK(std::isnan(result.at(0, 0, 1, 0, 0)));
  CHECK(std::isnan(result.at(0, 0, 1, 0, 1)));
  CHECK(std::isnan(result.at(1, 0, 1, 2, 1)));
  const auto& facts = result.view->facts;
  CHECK(facts.east_variable == "u");
  CHECK(facts.recognised_by == "name u");
  CHECK(facts.east_unit == "m/s");
  CHECK(facts.time_unit == "hours since 2024-01-01");
  CHECK(facts.cycle == "f.nc, from 2024-01-01T06:00:00Z");
  CHECK(facts.sources.size() == 1);
  CHECK(facts.sources[0].hash == Sha256::of(test::file_bytes(folder / "f.nc")));
  CHECK(facts.warnings.empty());
  CHECK(result.ran.err.empty());
}

TEST_CASE("every format, order of dimensions and direction of axes gives the same grid") {
  const test::ScratchFolder folder;
  const auto plain = run_ingest(folder, test::make_netcdf(folder, "f.nc", kPlain));
  REQUIRE(plain.view);
  for (const char* kind : {"64-bit offset", "64-bit data", "netCDF-4", "netCDF-4 classic model"}) {
    INFO(kind);
    const auto same = run_ingest(folder, test::make_netcdf(folder, "f.nc", kPlain, kind));
    REQUIRE(same.view);
    CHECK(std::equal(plain.view->values, plain.view->values + 24, same.view->values,
                     [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
  }
  // (lon, time, lat), all axes descending, longitudes 0–360.
  const auto turned = run_ingest(folder, test::make_netcdf(folder, "g.nc", R"(netcdf g {
dimensions: lon = 3 ; time = 2 ; lat = 2 ;
variables:
  float lon(lon) ; lon:units = "degrees_east" ; float lat(lat) ; lat:units = "degrees_north" ;
  int time(time) ; time:units = "minutes since 2024-01-01 00:00" ;
  float uo(lon, time, lat) ; uo:units = "m/s" ; float vo(lon, time, lat) ; vo:units = "m/s" ;
data:
  lon = 356, 355.5, 355 ; lat = 40.5, 40 ; time = 720, 360 ;
  uo = _, 0.9, 0.6, 0.3,  1.1, 0.8, 0.5, 0.2,  1.0, 0.7, 0.4, 0.1 ;
  vo = -1.2, -0.9, -0.6, -0.3,  -1.1, -0.8, -0.5, -0.2,  -1.0, -0.7, _, -0.1 ;
})"));
  REQUIRE(turned.view);
  CHECK(turned.view->axes == plain.view->axes);
  CHECK(std::equal(plain.view->values, plain.view->values + 24, turned.view->values,
                   [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
}

TEST_CASE("packed values, several missing markers and other units come out in m/s, whatever the valid range") {
  const test::ScratchFolder folder;
  const auto result = run_ingest(folder, test::make_netcdf(folder, "p.nc", R"(netcdf p {
dimensions: latitude = 2 ; longitude = 4 ;
variables:
  float latitude(latitude) ; latitude:units = "degrees_north" ; float longitude(longitude) ; longitude:units = "degrees_east" ;
  short east(latitude, longitude) ; east:standard_name = "eastward_sea_water_velocity" ; east:units = "cm/s" ;
    east:scale_factor = 0.1 ; east:add_offset = 10. ; east:_FillValue = -32767s ; east:missing_value = -9s ; east:valid_max = 900s ;
  double north(latitude, longitude) ; north:standard_name = "northward_sea_water_velocity" ; north:units = "kn" ;
    north:missing_value = 1.e20, -999. ; north:valid_range = -8., 8. ;
data:
  latitude = 1, 2 ; longitude = 1, 2, 3, 4 ;
  east = 100, -100, _, -9, 901, 0, 0, 0 ;
  north = 1, 2, 0, 0, 0, 1.e20, -999, 9 ;
})"));
  REQUIRE(result.view);
  // 0.1·100 + 10 = 20 cm/s; 0.1·(−100) + 10 = 0. One knot is 1852 m/h.
  CHECK(result.at(0, 0, 0, 0, 0) == Approx(0.2F));
  CHECK(result.at(0, 0, 0, 1, 0) == Approx(0.0F).margin(1e-9));
  CHECK(result.at(0, 0, 0, 0, 1) == Approx(1852.0 / 3600).epsilon(1e-7));
  for (const auto& [j, i] : {std::pair{0, 2}, std::pair{0, 3}, std::pair{1, 1}, std::pair{1, 2}})
    CHECK(std::isnan(result.at(0, 0, static_cast<std::size_t>(j), static_cast<std::size_t>(i), 0)));
  CHECK_FALSE(result.view->axes.has_time);
  CHECK(result.view->facts.recognised_by == "standard_name eastward_sea_water_velocity");
  CHECK(result.view->facts.warnings ==
        std::vector<std::string>{"p.nc: no time axis: taken as the same at every instant",
                                 "p.nc: 1 values of east lie outside its valid range any to 900 and are kept",
                                 "p.nc: 1 values of north lie outside its valid range -8 to 8 and are kept",
                                 "p.nc: a current of 4.63 m/s at 2.0000, 4.0000"});
  // 0.1·901 + 10 = 100.1 cm/s, and 9 kn.
  CHECK(result.at(0, 0, 1, 0, 0) == Approx(1.001F));
  CHECK(result.at(0, 0, 1, 3, 1) == Approx(9 * 1852.0 / 3600).epsilon(1e-7));
}

TEST_CASE("depths turn positive down whatever the file says, and a scalar time counts") {
  const test::ScratchFolder folder;
  const auto result = run_ingest(folder, test::make_netcdf(folder, "d.nc", R"(netcdf d {
dimensions: z = 3 ; y = 2 ; x = 2 ; member = 1 ;
variables:
  float z(z) ; z:units = "cm" ; z:positive = "up" ; float y(y) ; y:standard_name = "latitude" ; y:units = "radians" ;
  float x(x) ; x:standard_name = "longitude" ; x:units = "degrees" ;
  double time ; time:units = "days since 2024-01-01" ;
  float u(member, z, y, x) ; u:units = "m/s" ; u:coordinates = "time" ; float v(member, z, y, x) ; v:units = "m/s" ;
data:
  z = -5000, -1000, 0 ; y = 0.5, 0.6 ; x = 1, 2 ; time = 1.5 ;
  u = 0.3, 0.3, 0.3, 0.3, 0.2, 0.2, 0.2, 0.2, 0.1, 0.1, 0.1, 0.1 ;
  v = 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 ;
})"));
  REQUIRE(result.view);
  CHECK(result.view->axes.depths_m == std::vector<double>{0, 10, 50});
  CHECK(result.view->axes.times_s == std::vector<double>{epoch_seconds(*utc_from_text("2024-01-02T12:00:00Z"))});
  CHECK(result.view->axes.lats_deg[0] == Approx(0.5 * 180 / 3.14159265358979).epsilon(1e-7));
  CHECK(result.at(0, 0, 0, 0, 0) == 0.1F);
  CHECK(result.at(0, 2, 1, 1, 0) == 0.3F);
}

TEST_CASE("missing units are guessed with a warning, `Unit` counts, unreadable ones are refused") {
  const test::ScratchFolder folder;
  auto cdl = replaced(kPlain, R"(u:units = "m/s" ;)", "");
  cdl = replaced(cdl, R"(lat:units = "degrees_north" ;)", "");
  cdl = replaced(cdl, R"(v:units = "m/s")", R"(v:Unit = "cm/s")");
  const auto result = run_ingest(folder, test::make_netcdf(folder, "f.nc", cdl));
  REQUIRE(result.view);
  CHECK(result.view->facts.warnings ==
        std::vector<std::string>{"f.nc: axis lat has no unit; taken as degrees", "f.nc: u has no unit; taken as m/s"});
  CHECK(result.ran.err ==
        "glidehelm-ingest: warning: f.nc: axis lat has no unit; taken as degrees\n"
        "glidehelm-ingest: warning: f.nc: u has no unit; taken as m/s\n");
  CHECK(result.at(0, 0, 0, 0, 1) == Approx(-0.001F));

  CHECK(refusal(replaced(kPlain, R"(u:units = "m/s")", R"(u:units = "knotty")")) ==
        "u: the unit \"knotty\" cannot be read; allowed is any unit of UDUNITS that converts to m/s\n");
  CHECK(refusal(replaced(kPlain, R"(v:units = "m/s")", R"(v:units = "m")")) ==
        "v: the unit \"m\" does not convert to m/s\n");
  CHECK(refusal(replaced(kPlain, R"(lat:units = "degrees_north")", R"(lat:units = "km")")) ==
        "axis lat: the unit \"km\" does not convert to degrees\n");
}

TEST_CASE("a time axis without an epoch needs one from outside") {
  const auto cdl = replaced(kPlain, "hours since 2024-01-01", "hours");
  CHECK(refusal(cdl) == "axis time has the unit \"hours\" without an epoch; say its epoch with --time-epoch TIME\n");
  const test::ScratchFolder folder;
  const auto result = run_ingest(folder, test::make_netcdf(folder, "f.nc", cdl) + " --time-epoch 2024-01-01");
  REQUIRE(result.view);
  CHECK(result.view->axes.times_s[0] == epoch_seconds(*utc_from_text("2024-01-01T06:00:00Z")));
  const auto none = run_ingest(
      folder, test::make_netcdf(folder, "n.nc", replaced(kPlain, "time:units = \"hours since 2024-01-01\" ;", "")) +
                  " --time-epoch 2024-01-01T00:00:00Z");
  REQUIRE(none.view);
  CHECK(none.view->axes.times_s[0] == epoch_seconds(*utc_from_text("2024-01-01T00:00:06Z")));
  CHECK(none.view->facts.warnings ==
        std::vector<std::string>{"n.nc: axis time has no unit; taken as seconds since the given epoch"});
  CHECK(refusal(replaced(kPlain, R"(since 2024-01-01")", R"(since 2024-01-01" ; time:calendar = "360_day")")) ==
        "axis time: the calendar \"360_day\" has days that never were; allowed are standard, gregorian, "
        "proleptic_gregorian, julian, noleap and 365_day\n");
}

TEST_CASE("variables are found in the order that is promised") {
  // standard_name before name; the exact one before prefixed ones; anomalies and flags are none.
  auto with = [](const std::string& variables, const std::string& data, const std::string& more = "") {
    const test::ScratchFolder folder;
    const auto result =
        run_ingest(folder, test::make_netcdf(folder, "f.nc",
                                             "netcdf f { dimensions: lat = 2 ; lon = 2 ; variables: "
                                             "float lat(lat) ; float lon(lon) ; " +
                                                 variables + " data: lat = 1, 2 ; lon = 1, 2 ; " + data + " }") +
                               " " + more);
    return result.view ? result.view->facts.east_variable + "/" + result.view->facts.north_variable + " by " +
                             result.view->facts.recognised_by
                       : result.ran.err;
  };
  const auto pair = [](const std::string& east, const std::string& north, const std::string& prefix,
                       const std::string& suffix = "") {
    std::string text = "float " + east + "(lat, lon) ; float " + north + "(lat, lon) ; ";
    if (!prefix.empty() || !suffix.empty())
      text += east + ":standard_name = \"" + prefix + "eastward_sea_water_velocity" + suffix + "\" ; " + north +
              ":standard_name = \"" + prefix + "northward_sea_water_velocity" + suffix + "\" ; ";
    return text;
  };
  const auto values = [](const std::string& a, const std::string& b) {
    return a + " = .1, .1, .1, .1 ; " + b + " = .1, .1, .1, .1 ; ";
  };
  CHECK(with(pair("u", "v", "") + pair("a", "b", "surface_geostrophic_"), values("a", "b")) ==
        "a/b by standard_name surface_geostrophic_eastward_sea_water_velocity");
  CHECK(with(pair("u", "v", "") + pair("a", "b", "x", "_assuming_sea_level_for_geoid"), values("u", "v")) ==
        "u/v by name u");
  CHECK(with(pair("water_u", "water_v", "") + pair("u", "v", ""), values("water_u", "water_v")) ==
        "water_u/water_v by name water_u");
  CHECK(with(pair("eastward_flow", "northward_flow", ""), values("eastward_flow", "northward_flow")) ==
        "eastward_flow/northward_flow by name eastward_flow");
  CHECK(with(pair("u", "v", "") + pair("a", "b", ""), values("a", "b"), "--variables a,b") == "a/b by asked for");
  CHECK(with(pair("a", "b", "p_") + pair("c", "d", "q_"), "")
            .find("several eastward velocities (a, c); say which with --variables") != std::string::npos);
  CHECK(with(pair("uo", "vo", "p_") + pair("c", "d", "q_"), values("uo", "vo")) ==
        "uo/vo by standard_name p_eastward_sea_water_velocity, of several by name");
}

TEST_CASE("missing velocities are refused with what there is") {
  const std::string cdl =
      replaced(kPlain, "float u(time, lat, lon) ;", "float s(time, lat, lon) ; float u(time, lat, lon) ;");
  CHECK(refusal(cdl, "--variables east,v")
            .find("no variable east; it has s(time, lat, lon), u(time, lat, lon), v(time, lat, lon)") == 0);
  CHECK(
      refusal(
          R"(netcdf f { dimensions: lat = 2 ; lon = 2 ; variables: float lat(lat) ; float lon(lon) ; float sst(lat, lon) ; })") ==
      "no east and north velocity is recognised; it has sst(lat, lon); say which with --variables EAST,NORTH\n");
}

TEST_CASE("grids that are not rectilinear are refused by name") {
  CHECK(
      refusal(
          R"(netcdf f { dimensions: y = 2 ; x = 2 ; variables: float lat(y, x) ; float lon(y, x) ; float u(y, x) ; float v(y, x) ; })") ==
      "lat, lon hold no position (are they missing, or metres of a map projection?)\n");
  CHECK(
      refusal(
          R"(netcdf f { dimensions: node = 5 ; time = 2 ; variables: float lat(node) ; float lon(node) ; float u(time, node) ; float v(time, node) ; })")
          .find("unstructured grid: lat(node) and lon(node) lie on one dimension") == 0);
  CHECK(
      refusal(
          R"(netcdf f { dimensions: s_rho = 3 ; lat = 2 ; lon = 2 ; variables: float lat(lat) ; float lon(lon) ; float u(s_rho, lat, lon) ; float v(s_rho, lat, lon) ; })") ==
      "lat, lon hold no position (are they missing, or metres of a map projection?)\n");
  CHECK(
      refusal(
          R"(netcdf f { dimensions: y = 2 ; x = 2 ; variables: float y(y) ; y:standard_name = "projection_y_coordinate" ; float x(x) ; x:standard_name = "projection_x_coordinate" ; float u(y, x) ; float v(y, x) ; })")
          .find("projected grid: dimension y of u(y, x)") == 0);
  CHECK(
      refusal(
          R"(netcdf f { dimensions: quantile = 3 ; lat = 2 ; lon = 2 ; variables: float lat(lat) ; float lon(lon) ; float u(quantile, lat, lon) ; float v(quantile, lat, lon) ; })") ==
      "dimension quantile of u(quantile, lat, lon) is neither time, depth, latitude nor longitude\n");
  CHECK(
      refusal(
          R"(netcdf f { dimensions: lat = 2 ; lon = 2 ; lat_v = 2 ; variables: float lat(lat) ; float lon(lon) ; float lat_v(lat_v) ; float u(lat, lon) ; float v(lat_v, lon) ; })")
          .find("staggered grid: u(lat, lon) and v(lat_v, lon) lie on different dimensions") == 0);
}

TEST_CASE("axes with holes, jumps or impossible values are refused by index") {
  CHECK(refusal(replaced(kPlain, "lon = -5, -4.5, -4", "lon = -5, -5, -4")) ==
        "axis lon neither ascends nor descends at index 1 (-5)\n");
  CHECK(refusal(replaced(kPlain, "lat = 40, 40.5", "lat = 40, 140")) == "latitude 140 in lat, allowed is -90 to 90\n");
  CHECK(refusal(replaced(kPlain, "time = 6, 12", "time = 6, NaN")) == "axis time has no value at index 1\n");
  CHECK(refusal(replaced(kPlain, "time = 6, 12", "time = 6, 6")) ==
        "axis time neither ascends nor descends at index 1 (1.70409e+09)\n");
}

TEST_CASE("a sea of zeros, of nothing, or faster than a sea is refused") {
  const std::string head = kPlain.substr(0, kPlain.find("  u = 0.1"));
  CHECK(refusal(head + "u = 0,0,0,0,0,0,0,0,0,0,0,0 ; v = 0,0,0,_,0,0,0,0,0,0,0,0 ; }") ==
        "every value is exactly zero: no sea is that still, the file was probably never filled\n");
  CHECK(refusal(head + "u = _,_,_,_,_,_,_,_,_,_,_,_ ; v = 1,1,1,1,1,1,1,1,1,1,1,1 ; }") ==
        "every value is missing; u is the fill value everywhere: the file was made and its values were never written, "
        "or are still to "
        "come\n");
  CHECK(
      refusal(head + "u = 1,1,1,1,1,1,0,0,0,0,0,0 ; v = 1,1,1,1,1,1,0,0,0,0,0,_ ; }") ==
      "every value at 2024-01-01T12:00:00Z is exactly zero (1 of 2 times): the file is probably still being written\n");
  CHECK(refusal(head + "u = 1,1,1,1,1,1,0,0,0,3,0,0 ; v = 1,1,1,1,1,1,0,0,0,4.1,0,0 ; }") ==
        "a current of 5.08 m/s at 40.5000, -5.0000, 2024-01-01T12:00:00Z, allowed is at most 5 m/s (is the unit "
        "right?)\n");
  const test::ScratchFolder folder;
  const auto fast = run_ingest(
      folder,
      test::make_netcdf(folder, "f.nc", head + "u = 4,1,1,1,1,1,_,_,_,_,_,_ ; v = 1,1,1,1,1,1,1,1,1,1,1,1 ; }"));
  REQUIRE(fast.view);
  CHECK(fast.view->axes.times_s.size() == 1);
  CHECK(fast.view->facts.warnings ==
        std::vector<std::string>{"f.nc: a current of 4.12 m/s at 40.0000, -5.0000, 2024-01-01T06:00:00Z",
                                 "f.nc: 1 of 2 times have no value at all and are left out"});
}

TEST_CASE("a small file that describes a monstrous grid is refused before anything is allocated") {
  CHECK(
      refusal("netcdf f { dimensions: time = 100000 ; lat = 1000 ; lon = 1000 ; variables: int time(time) ; time:units "
              "= \"s since "
              "2000-01-01\" ; float lat(lat) ; float lon(lon) ; float u(time, lat, lon) ; float v(time, lat, lon) ; " +
                  monstrous_axes() + " }",
              "", "netCDF-4") == "it has 1e+11 nodes, allowed is 2e+09; cut it with --area W/E/S/N\n");
}

TEST_CASE("a truncated or unreadable file is refused before the library sees it") {
  const test::ScratchFolder folder;
  const auto file = test::make_netcdf(folder, "f.nc", kPlain);
  const auto bytes = test::file_bytes(file);
  test::write_bytes(file, bytes.substr(0, bytes.size() - 30));
  const auto cut = run_ingest(folder, file);
  CHECK(cut.ran.code == 1);
  CHECK(cut.ran.err == "glidehelm-ingest: " + file + ": truncated: the file has " + std::to_string(bytes.size() - 30) +
                           " bytes, its header needs " + std::to_string(bytes.size()) + "\n");
  CHECK(run_ingest(folder, folder / "nowhere.nc").ran.code == 5);
  CHECK(run_ingest(folder, folder.path()).ran.err ==
        "glidehelm-ingest: " + folder.path() +
            ": is a folder; allowed are files, for example by a pattern like FOLDER/*.nc\n");
  test::write_bytes(folder / "page.nc", "<html>");
  CHECK(run_ingest(folder, folder / "page.nc").ran.err ==
        "glidehelm-ingest: " + (folder / "page.nc") +
            ": not a NetCDF file: a web page: a server answered with a page instead of the file, perhaps an error or a "
            "login\n");
}

TEST_CASE("misuse ends with 2, and an output that cannot be written now with 5") {
  const test::ScratchFolder folder;
  const auto file = test::make_netcdf(folder, "f.nc", kPlain);
  const std::string program = GLIDEHELM_INGEST;
  CHECK(test::run_command(program, folder).code == 2);
  CHECK(test::run_command(program + " " + file, folder).code == 2);
  CHECK(test::run_command(program + " --no-such-option " + file + " -o " + (folder / "g"), folder).code == 2);
  for (const char* bad :
       {"--variables u", "--time-epoch noon", "--area 1/2/3", "--area 1/2/4/3", "--area a/b/c/d", "--area=-190/0/0/1"})
    CHECK(test::run_command(program + " " + file + " -o " + (folder / "g") + " " + bad, folder).code == 2);
  CHECK(test::run_command(program + " --help", folder).code == 0);
  const auto unwritable = test::run_command(program + " " + file + " -o " + (folder / "no/such/grid"), folder);
  CHECK(unwritable.code == 5);
  CHECK(unwritable.err.find((folder / "no/such/grid") + ": ") != std::string::npos);
}

TEST_CASE("an area is cut with one node to spare, across seams in one piece") {
  const test::ScratchFolder folder;
  std::string lons, values;
  for (int i = 0; i < 36; ++i) lons += (i > 0 ? ", " : "") + std::to_string(10 * i);
  for (int i = 0; i < 4 * 36; ++i)
    values += (i > 0 ? ", " : "") + std::to_string(0.01 * (i % 36) + 0.001 * (i / 36 + 1));
  const auto file =
      test::make_netcdf(folder, "w.nc",
                        "netcdf w { dimensions: lat = 4 ; lon = 36 ; variables: float lat(lat) ; "
                        "float lon(lon) ; float u(lat, lon) ; float v(lat, lon) ; data: lat = 30, 20, 10, 0 ; lon = " +
                            lons + " ; u = " + values + " ; v = " + values + " ; }");
  const auto seam = run_ingest(folder, file + " --area=-15/25/12/18");
  REQUIRE(seam.view);
  CHECK(seam.view->axes.lons_deg == std::vector<double>{-20, -10, 0, 10, 20, 30});
  CHECK(seam.view->axes.lats_deg == std::vector<double>{10, 20});
  // Latitude 10 is the file's third row, longitude −20 its column 34, longitude 30 its column 3.
  CHECK(seam.at(0, 0, 0, 0, 0) == Approx(0.34 + 0.003));
  CHECK(seam.at(0, 0, 0, 5, 0) == Approx(0.03 + 0.003));
  CHECK(seam.at(0, 0, 1, 2, 1) == Approx(0.00 + 0.002));
  const auto antimeridian = run_ingest(folder, file + " --area 175/-175/0/30");
  REQUIRE(antimeridian.view);
  CHECK(antimeridian.view->axes.lons_deg == std::vector<double>{170, 180, 190});
  CHECK(antimeridian.view->axes.lats_deg.size() == 4);
  const auto whole = run_ingest(folder, file + " --area=-180/180/0/30");
  REQUIRE(whole.view);
  CHECK(whole.view->axes.lons_deg.size() == 36);
  const auto missed = run_ingest(folder, file + " --area 0/20/50/60");
  CHECK(missed.ran.code == 1);
  CHECK(missed.ran.err.find("nothing of it lies in the area asked for: the grid covers latitudes 0 to 30") !=
        std::string::npos);
}

TEST_CASE("longitudes that jump within the axis, or close the circle, are unwrapped") {
  const test::ScratchFolder folder;
  const auto with = [&](const std::string& lons, int count) {
    std::string values;
    for (int i = 0; i < 2 * count; ++i) values += (i > 0 ? ", " : "") + std::to_string(0.1 * (i + 1));
    const auto result =
        run_ingest(folder, test::make_netcdf(folder, "l.nc",
                                             "netcdf l { dimensions: lat = 2 ; lon = " + std::to_string(count) +
                                                 " ; variables: float lat(lat) ; float lon(lon) ; float u(lat, lon) ; "
                                                 "float v(lat, lon) ; data: lat = 0, 1 ; lon = " +
                                                 lons + " ; u = " + values + " ; v = " + values + " ; }"));
    REQUIRE(result.view);
    return result.view->axes.lons_deg;
  };
  CHECK(with("350, 355, 0, 5", 4) == std::vector<double>{-10, -5, 0, 5});
  CHECK(with("178, 179, -180, -179", 4) == std::vector<double>{178, 179, 180, 181});
  CHECK(with("-179, -180, 179", 3) == std::vector<double>{179, 180, 181});
  CHECK(with("0, 90, 180, 270, 360", 5) == std::vector<double>{0, 90, 180, 270});
  CHECK(with("-180, -90, 0, 90, 180", 5) == std::vector<double>{-180, -90, 0, 90});
}

TEST_CASE("the output replaces what was there, whole") {
  const test::ScratchFolder folder;
  const auto file = test::make_netcdf(folder, "f.nc", kPlain);
  test::write_bytes(folder / "grid", "old");
  const auto result = run_ingest(folder, file);
  REQUIRE(result.view);
  int left = 0;
  for (const auto& entry : std::filesystem::directory_iterator{folder.path()})
    left += entry.path().filename().string().find("grid") != std::string::npos ? 1 : 0;
  CHECK(left == 0);  // the grid itself was read and removed above; nothing staged stays
}

TEST_CASE("what stands in a file's attributes cannot make lines of its own in a log") {
  CHECK(refusal(replaced(kPlain, "hours since 2024-01-01", "moons\\nALERT sim01\\033[31m since 2024-01-01")) ==
        "axis time: the time unit \"moons?ALERT sim01?[31m since 2024-01-01\" cannot be read; allowed is like \"hours "
        "since "
        "1950-01-01 00:00:00\"\n");
}
