#include "daemon/cli/coast.hpp"

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>

#include "core/chart/chart.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/data.hpp"
#include "tests/support/netcdf.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;

namespace {

/// gmt as the test wants it: answers of its own, or the real one with other arguments.
class OtherProcs final : public world::Procs {
 public:
  explicit OtherProcs(std::function<world::ProcessResult(const world::ProcessRequest&)> answer)
      : answer_{std::move(answer)} {}
  void run(world::ProcessRequest request, std::function<void(world::ProcessResult)> then) override {
    then(answer_(request));
  }
  [[nodiscard]] world::ProcessResult run_and_wait(const world::ProcessRequest& request) override {
    return answer_(request);
  }

 private:
  std::function<world::ProcessResult(const world::ProcessRequest&)> answer_;
};

world::ProcessResult said(std::string out, std::string err = "", int code = 0) {
  return {world::ProcessResult::End::exited, code, std::move(out), std::move(err)};
}

struct Run {
  int code;
  std::string out, err;
};

Run run(const std::string& area, const std::string& output, world::Procs* procs = nullptr) {
  static world::RealWorld real;
  auto world = real.world();
  world::World mine{world.clock, world.files, world.net, world.rng, procs != nullptr ? *procs : world.procs};
  std::ostringstream out, err;
  const int code = run_coast({{area}, output}, mine, out, err);
  return {code, out.str(), err.str()};
}

/// A sea with one square island, by a gmt that knows nothing else.
world::ProcessResult island(const world::ProcessRequest& request) {
  if (request.arguments.front() == "select") return said("");
  return said(
      "> Shore Bin # 1, Level 1\n-15.1\t27.9\n-14.9\t27.9\n-14.9\t28.1\n> Shore Bin # 2, Level "
      "1\n-14.9\t28.1\n-15.1\t28.1\n-15.1\t27.9\n",
      "pscoast [INFORMATION]: GSHHG version 9.8.7\n");
}

std::vector<std::string> names_in(const test::ScratchFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{folder.path()}) names.push_back(entry.path().filename());
  return names;
}

bool gmt_is_here() {
  static const bool here = std::system("gmt coast -R-16/-15/27/28 -Df -W -M --GMT_HISTORY=false > /dev/null 2>&1") == 0;
  return here;
}

#define NEEDS_GMT()                                            \
  if (!gmt_is_here()) {                                        \
    WARN("not run: gmt and gmt-gshhg-full are not installed"); \
    return;                                                    \
  }

std::shared_ptr<const chart::Coast> cut(const std::string& area, const test::ScratchFolder& folder,
                                        world::Procs* procs = nullptr) {
  const auto done = run(area, folder / "x.coast", procs);
  INFO(done.err);
  REQUIRE(done.code == 0);
  auto coast = chart::Coast::parse(test::file_bytes(folder / "x.coast"));
  REQUIRE(coast);
  return *coast;
}

struct Node {
  double lon, lat;
  bool land;
};
/// gmt's own mask on about `count` nodes of an uneven grid within the area. The outermost row and column all round are left
/// out: there grdlandmask clips by its own region, not by the shore.
std::vector<Node> landmask(double west, double east, double south, double north, int count,
                           const test::ScratchFolder& folder) {
  const double step = std::sqrt((east - west) * (north - south) / count) * 0.99;
  const int columns = static_cast<int>((east - west) / step) - 1, rows = static_cast<int>((north - south) / step) - 1;
  const double x0 = west + 0.617 * step, y0 = south + 0.531 * step, x1 = x0 + (columns - 1) * step,
               y1 = y0 + (rows - 1) * step;
  char command[600];
  std::snprintf(command, sizeof command,
                "cd '%s' && gmt grdlandmask -R%.9f/%.9f/%.9f/%.9f -I%d+n/%d+n -Df -N0/1/0/1/0 -Gmask.nc && gmt grd2xyz "
                "mask.nc -bo3d",
                folder.path().c_str(), x0, x1, y0, y1, columns, rows);
  std::vector<Node> nodes;
  FILE* pipe = popen(command, "r");
  REQUIRE(pipe != nullptr);
  for (double xyz[3]; std::fread(xyz, sizeof xyz, 1, pipe) == 1;)
    if (xyz[0] > x0 + step / 2 && xyz[0] < x1 - step / 2 && xyz[1] > y0 + step / 2 && xyz[1] < y1 - step / 2)
      nodes.push_back({xyz[0], xyz[1], xyz[2] > 0.5});
  CHECK(pclose(pipe) == 0);
  return nodes;
}

GeoPoint at(double lat, double lon) { return geo_point(lat, lon > 180 ? lon - 360 : lon); }

void agrees_with_landmask(const std::string& text, int count, bool both_kinds) {
  const test::ScratchFolder folder;
  const auto coast = cut(text, folder);
  const auto deg = [](std::int64_t v) { return static_cast<double>(v) / chart::kCoastUnitsPerDegree; };
  const auto& area = coast->area();
  const auto nodes = landmask(deg(area.west), deg(area.east), deg(area.south), deg(area.north), count, folder);
  CHECK(static_cast<int>(nodes.size()) > 0.85 * count);
  int land = 0, wrong = 0;
  for (const auto& node : nodes) {
    land += node.land;
    wrong +=
        coast->land().contains(at(node.lat, node.lon).lat.radians(), at(node.lat, node.lon).lon.radians()) != node.land;
  }
  INFO(text << ": " << nodes.size() << " nodes, " << land << " on land");
  CHECK(wrong == 0);
  if (both_kinds) {
    CHECK(land > 20);
    CHECK(land + 20 < static_cast<int>(nodes.size()));
  }
}

}  // namespace

TEST_CASE("an area is read in degrees, across the antimeridian too") {
  CHECK(coast_area("-19/-12/26.5/30").value() ==
        chart::CoastArea{-190'000'000, -120'000'000, 265'000'000, 300'000'000});
  const chart::CoastArea fiji{1'760'000'000, 1'840'000'000, -200'000'000, -140'000'000};
  CHECK(coast_area("176/-176/-20/-14").value() == fiji);
  CHECK(coast_area("176/184/-20/-14").value() == fiji);
  CHECK(coast_area("180/-175/0/1").value() == chart::CoastArea{-1'800'000'000, -1'750'000'000, 0, 10'000'000});
  CHECK(coast_area("-180/0/-85/85"));
}

TEST_CASE("an area that makes no sense is refused with what is allowed") {
  for (const auto& [text, why] : std::vector<std::pair<std::string, std::string>>{{"", "found ''"},
                                                                                  {"1/2/3", "has 3 numbers"},
                                                                                  {"1/2/3/4/5", "has 5 numbers"},
                                                                                  {"1/2/3/x", "found '1/2/3/x'"},
                                                                                  {"1/2/3/", "found"},
                                                                                  {"1/2/30/20", "S is north of N"},
                                                                                  {"1/2/30/30", "too small"},
                                                                                  {"1/1.001/30/31", "too small"},
                                                                                  {"-181/-170/0/1", "W is not"},
                                                                                  {"-10/175/0/1", "more than 180"},
                                                                                  {"10/10/0/1", "more than 180"},
                                                                                  {"1/2/3/86", "beyond 85"},
                                                                                  {"1/2/-86/4", "beyond 85"},
                                                                                  {"1/nan/3/4", "found"}}) {
    const auto area = coast_area(text);
    INFO(text);
    REQUIRE_FALSE(area);
    CHECK(area.error().find(why) != std::string::npos);
    CHECK(area.error().find("W/E/S/N in degrees") != std::string::npos);
    CHECK(run(text, "/tmp/never.coast").code == 2);
  }
}

TEST_CASE("the cut is written whole, over an older file, and nothing else is left") {
  const test::ScratchFolder folder;
  test::write_bytes(folder / "a.coast", "old");
  OtherProcs gmt{island};
  const auto done = run("-16/-14/27/29", folder / "a.coast", &gmt);
  CHECK(done.code == 0);
  CHECK(done.err.empty());
  CHECK(done.out.find("1 rings, 4 points") != std::string::npos);
  const auto coast = chart::Coast::parse(test::file_bytes(folder / "a.coast"));
  REQUIRE(coast);
  CHECK((*coast)->source() == "GSHHG 9.8.7 full resolution, levels 1 to 4, cut with gmt");
  CHECK((*coast)->rings().size() == 1);
  CHECK(names_in(folder) == std::vector<std::string>{"a.coast"});
}

TEST_CASE("gmt is asked for whole degrees with room around the area, in parts, without leaving traces") {
  std::vector<world::ProcessRequest> asked;
  OtherProcs gmt{[&](const world::ProcessRequest& request) {
    asked.push_back(request);
    return said("");
  }};
  const test::ScratchFolder folder;
  const auto done = run("170/-170/-1.5/21", folder / "a.coast", &gmt);
  REQUIRE(done.code == 0);
  std::vector<std::string> regions;
  for (const auto& request : asked) {
    CHECK(request.program == "gmt");
    CHECK(std::count(request.arguments.begin(), request.arguments.end(), "--GMT_HISTORY=false") == 1);
    if (request.arguments[0] == "coast") regions.push_back(request.arguments[1]);
  }
  CHECK(regions ==
        std::vector<std::string>{"-R169/189/-2/18", "-R189/191/-2/18", "-R169/189/18/22", "-R189/191/18/22"});
  CHECK(done.err.find("part 4 of 4") != std::string::npos);
}

TEST_CASE("a missing gmt and missing coastlines are answered with the apt line, and nothing is written") {
  const std::string apt = "apt-get install gmt gmt-gshhg-full";
  const test::ScratchFolder folder;
  OtherProcs none{[](const world::ProcessRequest&) {
    return world::ProcessResult{world::ProcessResult::End::not_started, 2, "", ""};
  }};
  auto done = run("-16/-14/27/29", folder / "a.coast", &none);
  CHECK(done.code == 1);
  CHECK(done.err == "glidehelm coast: the program gmt cannot be started; install it with: " + apt + "\n");
  OtherProcs bare{[](const world::ProcessRequest&) {
    return said("",
                "pscoast [ERROR]: Could not find file [GSHHG full resolution shorelines]\npscoast [ERROR]: No GSHHG "
                "databases available - must abort\n",
                79);
  }};
  done = run("-16/-14/27/29", folder / "a.coast", &bare);
  CHECK(done.code == 1);
  CHECK(done.err == "glidehelm coast: gmt finds no full-resolution GSHHG coastlines; install them with: " + apt + "\n");
  OtherProcs odd{[](const world::ProcessRequest&) { return said("", "first\nlast words\n", 3); }};
  CHECK(run("-16/-14/27/29", folder / "a.coast", &odd).err ==
        "glidehelm coast: gmt failed with exit code 3: last words\n");
  OtherProcs slow{[](const world::ProcessRequest&) {
    return world::ProcessResult{world::ProcessResult::End::deadline, 0, "", ""};
  }};
  CHECK(run("-16/-14/27/29", folder / "a.coast", &slow).err == "glidehelm coast: gmt took longer than 300 s\n");
  CHECK(names_in(folder).empty());
}

TEST_CASE("nonsense from gmt is refused, and nothing is written") {
  const test::ScratchFolder folder;
  // an open shoreline
  OtherProcs loose{[](const world::ProcessRequest& r) {
    return said(r.arguments[0] == "select" ? "" : "> a\n-15 28\n-15.1 28.1\n");
  }};
  CHECK(run("-16/-14/27/29", folder / "a.coast", &loose).err.find("ends in the middle of the area") !=
        std::string::npos);
  OtherProcs garbled{[](const world::ProcessRequest&) { return said("> a\nhello\n"); }};
  CHECK(run("-16/-14/27/29", folder / "a.coast", &garbled).err.find("no longitude and latitude: 'hello'") !=
        std::string::npos);
  // land everywhere along the border of a shore that crosses it
  OtherProcs both{[](const world::ProcessRequest& r) {
    if (r.arguments[0] == "select") return said(r.input);
    return said("> a\n-17 28\n-15 28.2\n-13 28\n");
  }};
  CHECK(run("-16/-14/27/29", folder / "a.coast", &both).err.find("do not alternate") != std::string::npos);
  OtherProcs numbers{[](const world::ProcessRequest& r) { return said(r.arguments[0] == "select" ? "1 2 99\n" : ""); }};
  CHECK(run("-16/-14/27/29", folder / "a.coast", &numbers).err.find("makes no sense") != std::string::npos);
  CHECK(names_in(folder).empty());
}

TEST_CASE("an output that cannot be written is said with its reason") {
  OtherProcs gmt{island};
  const test::ScratchFolder folder;
  CHECK(run("-16/-14/27/29", folder / "missing/a.coast", &gmt).code == 1);
  CHECK(run("-16/-14/27/29", folder / "missing/a.coast", &gmt).err.find("No such file or directory") !=
        std::string::npos);
  CHECK(run("-16/-14/27/29", folder.path() + "/", &gmt).code == 2);
  CHECK(run("-16/-14/27/29", "", &gmt).code == 2);
  // a folder that takes no file is found out before gmt is asked
  int asked = 0;
  OtherProcs counted{[&](const world::ProcessRequest& request) {
    ++asked;
    return island(request);
  }};
  CHECK(run("-16/-14/27/29", "/proc/a.coast", &counted).code == 1);
  CHECK(asked == 0);
  // a folder of that name is in the way: the staged file goes again
  std::filesystem::create_directory(folder / "a.coast");
  const auto done = run("-16/-14/27/29", folder / "a.coast", &gmt);
  CHECK(done.code == 1);
  CHECK(done.err.find("cannot write") != std::string::npos);
  CHECK(names_in(folder) == std::vector<std::string>{"a.coast"});
}

TEST_CASE("the Canaries: land and water are gmt's own on 20 000 places, and known places are right") {
  NEEDS_GMT();
  agrees_with_landmask("-19/-12/26.5/30", 22'000, true);
  const test::ScratchFolder folder;
  const chart::Chart chart{chart::ChartSources{cut("-19/-12/26.5/30", folder), {}, {}}};
  CHECK(chart.is_land(geo_point(27.95, -15.6)));   // Gran Canaria
  CHECK(chart.is_land(geo_point(28.27, -16.64)));  // Teide
  CHECK(chart.is_land(geo_point(27.5, -12.5)));    // Africa, cut by the eastern border
  CHECK_FALSE(chart.is_land(geo_point(29.1667, -15.5)));
  CHECK_FALSE(chart.is_land(geo_point(28.3, -16.0)));  // between Tenerife and Gran Canaria
  CHECK_FALSE(chart.is_charted(geo_point(28, -11.9)));
  // Alegranza's and Montaña Clara's channel: the island is there, as Natural Earth would not know
  CHECK(chart.is_land(geo_point(29.40, -13.51)));
}

TEST_CASE("areas across the antimeridian, beside the poles, of land alone and of water alone are cut right") {
  NEEDS_GMT();
  agrees_with_landmask("176/-176/-20/-14", 8'000, true);
  agrees_with_landmask("-68/-60/-68/-62", 8'000, true);         // Antarctic ice front
  agrees_with_landmask("15/25/76.5/81", 8'000, true);           // Svalbard
  agrees_with_landmask("-89.5/-84.25/44.1/49.3", 8'000, true);  // lakes with islands, no sea
  agrees_with_landmask("20/21/10/11", 2'000, false);
  agrees_with_landmask("-40/-38/20/22", 2'000, false);
  agrees_with_landmask("10.37/10.81/59.33/59.87", 8'000, true);  // borders through islands of a fjord
}

TEST_CASE("a cut in parts is the cut in one: islands on the seams are whole") {
  NEEDS_GMT();
  const test::ScratchFolder folder;
  // 21.5° wide are two parts, the seam at 8° E through the Ligurian coast; the same without its last degree is one part.
  const auto two = cut("-11.5/10/42/44.5", folder), one = cut("-9.5/9/42/44.5", folder);
  for (int k = 0; k < 4000; ++k) {
    const double lat = kPi / 180 * (42.01 + 2.48 * (k % 63) / 63.0), lon = kPi / 180 * (-9.49 + 18.48 * k / 4000.0);
    CHECK(two->land().contains(lat, lon) == one->land().contains(lat, lon));
  }
}

TEST_CASE("real data: the land mask of Washington's coast agrees with our cut, lakes left out") {
  GLIDEHELM_NEEDS_DATA(data);
  NEEDS_GMT();
  const test::ScratchFolder folder;
  // The mask was made with lakes counted as land (-N0/1/1/1/1), so gmt is asked for level 1 alone.
  static world::RealWorld real;
  auto world = real.world();
  OtherProcs without_lakes{[&](world::ProcessRequest request) {
    request.arguments.emplace_back("-A0/0/1");
    if (request.arguments[0] == "select") request.arguments[2] = "-Ns/k/k/k/k";
    return world.procs.run_and_wait(request);
  }};
  const auto coast = cut("-127/-122/46/51", folder, &without_lakes);
  const std::string command =
      "/usr/bin/python3 -c \"import netCDF4, sys\n"
      "d = netCDF4.Dataset('" +
      data +
      "/coast/landmask_washington_0p5min.nc')\n"
      "z, lat, lon = d['z'][:], d['lat'][:], d['lon'][:]\n"
      "for i in range(len(lat)):\n"
      "  print(float(lat[i]).hex(), ''.join('1' if v else '0' for v in z[i]))\n"
      "print('lons', *[float(v).hex() for v in lon])\"";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  for (char buffer[4096]; const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe);) text.append(buffer, n);
  REQUIRE(pclose(pipe) == 0);
  std::istringstream lines{text};
  std::vector<std::pair<double, std::string>> rows;
  std::vector<double> lons;
  for (std::string first, second; lines >> first;) {
    if (first == "lons") {
      while (lines >> second) lons.push_back(std::stod(second));
    } else {
      lines >> second;
      rows.emplace_back(std::stod(first), second);
    }
  }
  REQUIRE(rows.size() == 601);
  REQUIRE(lons.size() == 601);
  // The outermost nodes lie on the border, where grdlandmask and the chart each decide for themselves.
  int wrong = 0, land = 0;
  for (std::size_t i = 1; i + 1 < rows.size(); ++i)
    for (std::size_t j = 1; j + 1 < lons.size(); ++j) {
      const bool expected = rows[i].second[j] == '1';
      land += expected;
      wrong += coast->land().contains(rows[i].first * kPi / 180, lons[j] * kPi / 180) != expected;
    }
  CHECK(land > 100'000);
  CHECK(wrong == 0);
}

TEST_CASE("coast grows and simplifies a file that is there and says what it did") {
  const test::ScratchFolder folder;
  const std::int64_t degree = 10'000'000;
  chart::CoastRing rock{{{4'000'000, 505'000'000}, {4'010'000, 505'000'000}, {4'000'000, 505'010'000}},
                        {false, false, false}};
  const auto coast = chart::Coast::make({5 * degree, 6 * degree, 50 * degree, 51 * degree}, "a test", {rock}).value();
  std::ofstream{folder / "a.coast"} << coast->text();
  static world::RealWorld real;
  auto world = real.world();
  const auto grow = [&](CoastOptions options) {
    std::ostringstream out, err;
    const int code = run_coast(options, world, out, err);
    return Run{code, out.str(), err.str()};
  };
  CoastOptions options{{}, folder / "b.coast", folder / "a.coast", 3000.0, {}};
  const auto ran = grow(options);
  CHECK(ran.err == "");
  REQUIRE(ran.code == 0);
  CHECK(ran.out.find("land grown by 3000 m and simplified outwards by at most 100 m") != std::string::npos);
  const auto land = chart::Coast::parse(test::file_bytes(folder / "b.coast"));
  REQUIRE(land);
  const chart::Chart chart{chart::ChartSources{*land, {}, {}}};
  const auto at = GeoPoint::from_degrees(50.5, 5.4).value();
  for (int k = 0; k < 12; ++k) {  // the rock reaches 111 m from its corner
    CHECK(chart.is_land(destination(at, Bearing{degrees(30 * k)}, Metres{2980})));
    CHECK_FALSE(chart.is_land(destination(at, Bearing{degrees(30 * k)}, Metres{3225})));
  }
  options.areas = {"5/6/50/51"};
  CHECK(grow(options).code == 2);
  options.areas.clear();
  options.from.clear();
  CHECK(grow(options).code == 2);
  options.from = folder / "none.coast";
  CHECK(grow(options).code == 1);
  options.from = folder / "a.coast";
  options.grow_m = -1;
  CHECK(grow(options).err.find("0 to 50000 m") != std::string::npos);
}

TEST_CASE("two areas are cut into one file, with land between them") {
  NEEDS_GMT();
  const test::ScratchFolder folder;
  static world::RealWorld real;
  auto world = real.world();
  std::ostringstream out, err;
  CoastOptions options;
  options.areas = {"-16/-15.5/27.8/28.2", "-14.2/-13.7/28/28.4"};
  options.output = folder / "two.coast";
  REQUIRE(run_coast(options, world, out, err) == 0);
  CHECK(out.str().find("2 areas") != std::string::npos);
  const auto coast = chart::Coast::parse(test::file_bytes(options.output));
  REQUIRE(coast);
  const chart::Chart chart{chart::ChartSources{*coast, {}, {}}};
  CHECK_FALSE(chart.is_land(geo_point(28.15, -15.8)));  // water west of Gran Canaria
  CHECK(chart.is_land(geo_point(28.1, -15)));           // between the areas
  CHECK(chart.is_land(geo_point(28.3, -14.0)));         // Fuerteventura
  options.areas.push_back("-15.6/-15/27.8/28");
  CHECK(run_coast(options, world, out, err) == 1);
  CHECK(err.str().find("overlap or touch") != std::string::npos);
}
