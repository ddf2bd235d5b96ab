#include "daemon/ingest/ensemble.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <span>

#include "tests/daemon/ingest/model_file.hpp"
#include "tests/daemon/ingest/run.hpp"

// Members of an ensemble: the built program on files that ncgen makes here.

using namespace glidehelm;
using test::run_ingest;

namespace {

/// A dimension of the velocity.
struct Axis {
  std::string name;
  std::size_t length;
};
const std::array<Axis, 5> kAxes{{{"number", 3}, {"time", 2}, {"depth", 2}, {"lat", 2}, {"lon", 3}}};

/// What stands at a node: every index can be told from it, and a float holds it to 1e-7.
double east_at(std::size_t member, std::size_t t, std::size_t z, std::size_t j, std::size_t i) {
  return 0.1 * static_cast<double>(member) + 0.04 * static_cast<double>(t) + 0.02 * static_cast<double>(z) +
         0.008 * static_cast<double>(j) + 0.002 * static_cast<double>(i);
}

const char* const kRealization = "int number(number) ; number:standard_name = \"realization\" ; number:units = \"1\" ;";

/// The file with its dimensions in the given order; v is −u.
std::string cdl(const std::array<std::size_t, 5>& order, const std::string& coordinate = kRealization,
                const std::string& numbers = "number = 4, 7, 9 ;") {
  std::string names, u, v;
  for (const auto d : order) names += (names.empty() ? "" : ", ") + kAxes[d].name;
  std::array<std::size_t, 5> at{};
  const auto next = [&] {
    for (std::size_t k = 5; k-- > 0;) {
      if (++at[order[k]] < kAxes[order[k]].length) return true;
      at[order[k]] = 0;
    }
    return false;
  };
  do {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", east_at(at[0], at[1], at[2], at[3], at[4]));
    u += (u.empty() ? "" : ", ") + std::string{text};
    v += (v.empty() ? "-" : ", -") + std::string{text};
  } while (next());
  return "netcdf f {\ndimensions: number = 3 ; time = 2 ; depth = 2 ; lat = 2 ; lon = 3 ;\nvariables:\n" + coordinate +
         "\ndouble time(time) ; time:units = \"hours since 2024-01-01\" ;\n"
         "double depth(depth) ; depth:units = \"m\" ; depth:positive = \"down\" ;\n"
         "double lat(lat) ; lat:units = \"degrees_north\" ;\ndouble lon(lon) ; lon:units = \"degrees_east\" ;\n"
         "float u(" +
         names + ") ; u:units = \"m/s\" ;\nfloat v(" + names + ") ; v:units = \"m/s\" ;\ndata:\n" + numbers +
         "\ntime = 6, 12 ; depth = 0, 10 ; lat = 40, 40.5 ; lon = -5, -4.5, -4 ;\nu = " + u + " ;\nv = " + v +
         " ;\n}\n";
}

const std::array<std::size_t, 5> kUsual{0, 1, 2, 3, 4};

std::string refusal(const test::ScratchFolder& folder, const std::string& arguments) {
  const auto result = run_ingest(folder, arguments);
  CHECK(result.ran.code != 0);
  return result.ran.err;
}
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

void check_member(const test::Ingested& result, std::size_t member) {
  REQUIRE(result.view);
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t z = 0; z < 2; ++z)
      for (std::size_t j = 0; j < 2; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
          // Written with three decimals and kept as a float: half a unit of the last bit near 0.3 is 1.5e-8.
          const double expected = east_at(member, t, z, j, i);
          CHECK(static_cast<double>(result.at(t, z, j, i, 0)) == Approx(expected).margin(2e-8));
          CHECK(static_cast<double>(result.at(t, z, j, i, 1)) == Approx(-expected).margin(2e-8));
        }
}

}  // namespace

TEST_CASE("a member is read wherever the dimension of the members stands among the others") {
  const test::ScratchFolder folder;
  // The member's place moves through the order; the rest once as usual and once turned round.
  for (std::size_t place = 0; place < 5; ++place)
    for (const bool turned : {false, true}) {
      std::array<std::size_t, 4> rest{1, 2, 3, 4};
      if (turned) std::reverse(rest.begin(), rest.end());
      std::array<std::size_t, 5> order{};
      for (std::size_t k = 0, r = 0; k < 5; ++k) order[k] = k == place ? 0 : rest[r++];
      INFO("place " << place << (turned ? ", turned" : ""));
      const auto file = test::make_netcdf(folder, "f.nc", cdl(order));
      check_member(run_ingest(folder, file + " --member 2"), 2);
    }
}

TEST_CASE("each member is its own, the first where none is named, and the facts say which of how many") {
  const test::ScratchFolder folder;
  const auto file = test::make_netcdf(folder, "f.nc", cdl(kUsual), "netCDF-4");
  for (const std::size_t member : {0U, 1U, 2U})
    check_member(run_ingest(folder, file + " --member " + std::to_string(member)), member);
  const auto first = run_ingest(folder, file);
  check_member(first, 0);
  CHECK(first.view->facts.layout ==
        "member 0, counted from 0, of an ensemble of 3 members along number (standard_name realization), number 4");
  CHECK(contains(run_ingest(folder, file + " --member 2").view->facts.layout, "member 2, counted from 0"));
}

TEST_CASE("members are recognised by the mark of their axis and by known names too") {
  const test::ScratchFolder folder;
  const auto layout = [&](const std::string& name, const std::string& attribute) {
    const auto text = replaced(cdl(kUsual, "int number(number) ; " + attribute), "number", name);
    const auto result = run_ingest(folder, test::make_netcdf(folder, "f.nc", text) + " --member 1");
    INFO(result.ran.err);
    check_member(result, 1);
    return result.view->facts.layout;
  };
  CHECK(contains(layout("number", ""), "3 members along number (by name), number 7"));
  CHECK(contains(layout("Ensemble", ""), "3 members along Ensemble (by name)"));
  CHECK(contains(layout("realisation", ""), "(by name)"));
  CHECK(contains(layout("run", "run:axis = \"E\" ;"), "3 members along run (axis E)"));
  CHECK(contains(layout("run", "run:_CoordinateAxisType = \"Ensemble\" ;"), "(_CoordinateAxisType Ensemble)"));
  // A dimension without any coordinate has its name alone.
  const auto bare = test::make_netcdf(folder, "f.nc", cdl(kUsual, "", ""));
  CHECK(run_ingest(folder, bare).view->facts.layout ==
        "member 0, counted from 0, of an ensemble of 3 members along number (by name)");
}

TEST_CASE("members with issue times of their own are members, not times") {
  const test::ScratchFolder folder;
  const std::string lagged = std::string{kRealization} +
                             " double issued(number) ; issued:standard_name = \"forecast_reference_time\" ; "
                             "issued:units = \"hours since 2024-01-01\" ;";
  const auto file = test::make_netcdf(folder, "f.nc", cdl(kUsual, lagged, "number = 4, 7, 9 ; issued = 0, -6, -12 ;"));
  check_member(run_ingest(folder, file + " --member 1"), 1);
  // The member's own issue time, -6 h: 2023-12-31T18:00:00Z.
  CHECK(run_ingest(folder, file + " --member 1").view->facts.reference_s == 1704067200.0 - 6 * 3600);
}

TEST_CASE("a member that a file does not have is refused with those that it has") {
  const test::ScratchFolder folder;
  const auto file = test::make_netcdf(folder, "f.nc", cdl(kUsual));
  CHECK(refusal(folder, file + " --member 3") ==
        "glidehelm-ingest: " + file +
            ": it has no member 3: 3 members along number (standard_name realization), allowed is 0 to 2\n");
  CHECK(run_ingest(folder, file + " --member -1").ran.code == 2);
  CHECK(run_ingest(folder, file + " --member all").ran.code == 2);
}

TEST_CASE("a plain forecast is its own member 0 and has no other") {
  const test::ScratchFolder folder;
  const auto text = replaced(replaced(cdl({1, 2, 0, 3, 4}), "number", "box"), "realization", "quantile");
  CHECK(contains(refusal(folder, test::make_netcdf(folder, "odd.nc", text)),
                 "dimension box of u(time, depth, box, lat, lon)"));
  const std::string plain = R"(netcdf f { dimensions: lat = 2 ; lon = 2 ; variables:
    double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;
    float u(lat, lon) ; u:units = "m/s" ; float v(lat, lon) ; v:units = "m/s" ;
    data: lat = 40, 41 ; lon = 3, 4 ; u = 0.1, 0.2, 0.3, 0.4 ; v = 0.1, 0.2, 0.3, 0.4 ; })";
  const auto file = test::make_netcdf(folder, "f.nc", plain);
  const auto zero = run_ingest(folder, file + " --member 0");
  REQUIRE(zero.view);
  CHECK(zero.view->facts.layout.empty());
  CHECK(contains(refusal(folder, file + " --member 1"),
                 "member 1 is asked for and it holds no ensemble: u(lat, lon) lies on no dimension"));
}

TEST_CASE("places called members are no ensemble, and two ensemble dimensions are refused") {
  const test::ScratchFolder folder;
  const std::string places = R"(netcdf f { dimensions: time = 2 ; depth = 2 ; number = 3 ; variables:
    double time(time) ; time:units = "hours since 2024-01-01" ; double depth(depth) ; depth:units = "m" ; depth:positive = "down" ;
    double lat(number) ; lat:units = "degrees_north" ; double lon(number) ; lon:units = "degrees_east" ;
    float u(time, depth, number) ; u:units = "m/s" ; float v(time, depth, number) ; v:units = "m/s" ;
    data: time = 0, 1 ; depth = 0, 10 ; lat = 1, 2, 3 ; lon = 1, 2, 3 ; })";
  CHECK(contains(refusal(folder, test::make_netcdf(folder, "f.nc", places)),
                 "unstructured grid: lat(number) and lon(number)"));
  const auto two = replaced(cdl(kUsual, "", ""), "depth = 2 ; lat", "member = 2 ; lat");
  auto text = replaced(two, "double depth(depth) ; depth:units = \"m\" ; depth:positive = \"down\" ;", "");
  text = replaced(replaced(text, "depth = 0, 10 ;", ""), "depth", "member");
  CHECK(contains(refusal(folder, test::make_netcdf(folder, "f.nc", text)),
                 "several dimensions count members of an ensemble: number and member; allowed is one"));
}

TEST_CASE("a component by component ensemble is paired, other members and other ensembles are not") {
  const test::ScratchFolder folder;
  const auto without = [](std::string text, const std::string& component) {
    const auto shape = "float " + component + "(number, time, depth, lat, lon) ; " + component + ":units = \"m/s\" ;\n";
    text = replaced(text, shape, "");
    const auto at = text.find("\n" + component + " = ");
    return text.erase(at, text.find(';', at) + 1 - at);
  };
  const auto u = test::make_netcdf(folder, "u.nc", without(cdl(kUsual), "v"));
  const auto v = test::make_netcdf(folder, "v.nc", without(cdl(kUsual), "u"));
  check_member(run_ingest(folder, u + " " + v + " --member 1"), 1);
  const auto other = test::make_netcdf(folder, "w.nc", without(cdl(kUsual, kRealization, "number = 5, 8, 9 ;"), "u"));
  CHECK(contains(refusal(folder, u + " " + other + " --member 1"), "no file with the northward one"));
}

TEST_CASE("files of different members are not joined in time") {
  const test::ScratchFolder folder;
  const auto early = test::make_netcdf(folder, "a.nc", cdl(kUsual));
  const auto late = replaced(cdl(kUsual), "time = 6, 12", "time = 18, 24");
  const auto joined = run_ingest(folder, early + " " + test::make_netcdf(folder, "b.nc", late) + " --member 1");
  REQUIRE(joined.view);
  CHECK(joined.view->axes.times_s.size() == 4);
  CHECK(contains(joined.view->facts.layout, "member 1"));
  const auto others = test::make_netcdf(folder, "c.nc", replaced(late, "number = 4, 7, 9", "number = 4, 8, 9"));
  CHECK(contains(refusal(folder, early + " " + others + " --member 1"), "files that are joined hold the same member"));
}

TEST_CASE("a member on a model's own grid is the file of that member alone") {
  const test::ScratchFolder folder;
  const auto mesh = test::turned_mesh(6, 7, 40, 5, 20, 0.1);
  const auto current = [](std::size_t member, bool north) {
    return test::over(6, 7, 0, 0, [=](double j, double i) {
      return (north ? -0.1 : 0.1) * static_cast<double>(member + 1) + 0.01 * j + 0.02 * i;
    });
  };
  const auto file = [&](const std::string& dimension, const std::vector<double>& u, const std::vector<double>& v) {
    return "netcdf m {\ndimensions: time = 1 ; " + std::string{dimension.empty() ? "" : "ens = 3 ; "} +
           "y = 6 ; x = 7 ;\nvariables:\ndouble time(time) ; time:units = \"hours since 2024-01-01\" ;\n"
           "double nav_lat(y, x) ; nav_lat:units = \"degrees_north\" ;\n"
           "double nav_lon(y, x) ; nav_lon:units = \"degrees_east\" ;\n"
           "double uo(time, " +
           dimension +
           "y, x) ; uo:units = \"m/s\" ; uo:coordinates = \"nav_lat nav_lon\" ; "
           "uo:standard_name = \"eastward_sea_water_velocity\" ;\n"
           "double vo(time, " +
           dimension +
           "y, x) ; vo:units = \"m/s\" ; vo:coordinates = \"nav_lat nav_lon\" ; "
           "vo:standard_name = \"northward_sea_water_velocity\" ;\ndata:\ntime = 0 ;\n" +
           test::cdl_data("nav_lat", mesh.lat) + test::cdl_data("nav_lon", mesh.lon) + test::cdl_data("uo", u) +
           test::cdl_data("vo", v) + "}\n";
  };
  std::vector<double> u, v;
  for (std::size_t member = 0; member < 3; ++member)
    for (auto [all, north] : {std::pair{&u, false}, std::pair{&v, true}}) {
      const auto one = current(member, north);
      all->insert(all->end(), one.begin(), one.end());
    }
  const auto ensemble = test::make_netcdf(folder, "all.nc", file("ens, ", u, v));
  for (const std::size_t member : {0U, 2U}) {
    const auto alone = run_ingest(
        folder, test::make_netcdf(folder, "one.nc", file("", current(member, false), current(member, true))));
    const auto chosen = run_ingest(folder, ensemble + " --member " + std::to_string(member));
    INFO(chosen.ran.err << alone.ran.err);
    REQUIRE(alone.view);
    REQUIRE(chosen.view);
    CHECK(chosen.view->axes == alone.view->axes);
    const std::size_t numbers = 2 * alone.view->axes.nodes();
    const std::span a{alone.view->values, numbers}, b{chosen.view->values, numbers};
    CHECK(std::equal(a.begin(), a.end(), b.begin(),
                     [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); }));
    CHECK(chosen.view->facts.layout == alone.view->facts.layout + "; member " + std::to_string(member) +
                                           ", counted from 0, of an ensemble of 3 members along ens (by name)");
  }
}
