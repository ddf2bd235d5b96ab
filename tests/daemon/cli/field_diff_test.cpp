#include "daemon/cli/field_diff.hpp"

#include <nlohmann/json.hpp>

#include "tests/daemon/cli/field_verb.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;
using nlohmann::json;

namespace {

test::SeaFile plain_sea() {
  test::SeaFile file;
  file.u = [](int t, int z, int j, int i) {
    return i == 0 && j == 0 ? test::kDryNode : 0.1 + 0.01 * i - 0.02 * z + 0.03 * t;
  };
  file.v = [](int t, int z, int j, int i) {
    return i == 0 && j == 0 ? test::kDryNode : -0.2 + 0.05 * j + 0.01 * z + 0.01 * t;
  };
  return file;
}
test::Ran diff(const std::string& a, const std::string& b, double tolerance = 0) {
  FieldDiffOptions options;
  options.a = a;
  options.b = b;
  options.tolerance = tolerance;
  options.json = true;
  return test::run_verb(run_field_diff, options);
}

}  // namespace

TEST_CASE("field diff: a field does not differ from itself") {
  const test::ScratchFolder folder;
  const auto file = test::make_sea(folder, "a.nc", plain_sea());
  const auto said = diff(file, file);
  CHECK(said.code == 0);
  const auto all = json::parse(said.out)["all"];
  CHECK(all["nodes"] == 3 * 3 * 15);  // one column of sixteen is dry
  CHECK(all["max_m_per_s"] == 0.0);
  CHECK(all["rms_m_per_s"] == 0.0);
  CHECK(all["correlation_east"].get<double>() == Approx(1));
}

TEST_CASE("field diff: a constant difference is bias and rms and one node's is the maximum with place and time") {
  const test::ScratchFolder folder;
  auto other = plain_sea();
  // B − A = (0.03, −0.04): length 0.05 everywhere, and 0.35 more northward at one node.
  other.u = [f = other.u](int t, int z, int j, int i) { return f(t, z, j, i) + 0.03; };
  other.v = [f = other.v](int t, int z, int j, int i) {
    return f(t, z, j, i) - 0.04 + (t == 2 && z == 1 && j == 3 && i == 2 ? -0.35 : 0);
  };
  const auto said = diff(test::make_sea(folder, "a.nc", plain_sea()), test::make_sea(folder, "b.nc", other), 0.06);
  CHECK(said.code == 1);
  const auto all = json::parse(said.out)["all"];
  // Floats of 0.3 m/s are rounded to 1.5e-8 at most.
  CHECK(all["bias_east_m_per_s"].get<double>() == Approx(0.03).margin(1e-7));
  CHECK(all["bias_north_m_per_s"].get<double>() == Approx(-0.04 - 0.35 / 135).margin(1e-7));
  CHECK(all["rms_m_per_s"].get<double>() ==
        Approx(std::sqrt((134 * 0.0025 + 0.03 * 0.03 + 0.39 * 0.39) / 135)).margin(1e-7));
  CHECK(all["max_m_per_s"].get<double>() == Approx(std::hypot(0.03, 0.39)).margin(1e-7));
  CHECK(all["max_lat_deg"] == 32.0);
  CHECK(all["max_lon_deg"] == -19.0);
  CHECK(all["max_depth_m"] == 10.0);
  CHECK(all["max_time"] == "2024-05-01T03:00:00Z");
  CHECK(all["correlation_east"].get<double>() == Approx(1).margin(1e-6));
  const auto document = json::parse(said.out);
  REQUIRE(document["depths"].size() == 3);
  REQUIRE(document["times"].size() == 3);
  CHECK(document["depths"][0]["max_m_per_s"].get<double>() == Approx(0.05).margin(1e-7));
  CHECK(document["times"][2]["max_m_per_s"].get<double>() == Approx(std::hypot(0.03, 0.39)).margin(1e-7));
  // The tolerance decides: the same two pass with a larger one.
  CHECK(diff(folder / "a.nc", folder / "b.nc", 0.4).code == 0);
}

TEST_CASE("field diff: B on other axes is interpolated: it is exact on what is linear in every axis") {
  const test::ScratchFolder folder;
  // Linear in time, depth, latitude and longitude, so every interpolation of it is exact to the rounding of floats.
  const auto value = [](double t, double z, double lat, double lon) {
    return 0.1 + 0.02 * t - 0.001 * z + 0.03 * (lat - 30) + 0.02 * (lon + 20);
  };
  const double at[] = {0, 1, 3}, zt[] = {0.5, 10, 50}, lt[] = {30, 30.5, 31.25, 32}, ln[] = {-20, -19.5, -19, -18};
  auto a = plain_sea();
  a.u = [&](int t, int z, int j, int i) { return value(at[t], zt[z], lt[j], ln[i]); };
  a.v = [&](int, int, int, int) { return 0.2; };
  test::SeaFile b;
  b.times = "0, 4";
  b.depths = "0.5, 60";
  b.lats = "29, 33";
  b.lons = "339, 343";  // in the other turn
  b.u = [&](int t, int z, int j, int i) { return value(4.0 * t, z == 0 ? 0.5 : 60, 29 + 4.0 * j, -21 + 4.0 * i); };
  b.v = a.v;
  const auto said = diff(test::make_sea(folder, "a.nc", a), test::make_sea(folder, "b.nc", b), 1e-6);
  INFO(said.out << said.err);
  CHECK(said.code == 0);
  const auto document = json::parse(said.out);
  CHECK(document["same_axes"] == false);
  CHECK(document["all"]["nodes"] == 144);
  CHECK(document["all"]["correlation_north"].is_null());  // one that does not vary has none
}

TEST_CASE("field diff: without an overlap the message names the axis and both ranges") {
  const test::ScratchFolder folder;
  auto later = plain_sea(), north = plain_sea();
  later.times = "30, 31, 33";
  north.lats = "40, 40.5, 41.25, 42";
  const auto a = test::make_sea(folder, "a.nc", plain_sea());
  const auto in_time = diff(a, test::make_sea(folder, "later.nc", later));
  CHECK(in_time.code == 1);
  CHECK(in_time.err ==
        "glidehelm field: the two have no time in common: A has 2024-05-01T00:00:00Z to 2024-05-01T03:00:00Z, B "
        "2024-05-02T06:00:00Z to 2024-05-02T09:00:00Z\n");
  const auto in_space = diff(a, test::make_sea(folder, "north.nc", north));
  CHECK(in_space.code == 1);
  CHECK(in_space.err.find("no latitude in common: A has 30.0000 to 32.0000, B 40.0000 to 42.0000") !=
        std::string::npos);
}

TEST_CASE("field diff: on the same axes a node that only one side has is a difference") {
  const test::ScratchFolder folder;
  auto wetter = plain_sea();
  wetter.u = [f = wetter.u](int t, int z, int j, int i) { return i + j == 0 && z == 0 ? 0.1 : f(t, z, j, i); };
  wetter.v = [f = wetter.v](int t, int z, int j, int i) { return i + j == 0 && z == 0 ? 0.1 : f(t, z, j, i); };
  const auto said = diff(test::make_sea(folder, "a.nc", plain_sea()), test::make_sea(folder, "b.nc", wetter), 1);
  CHECK(said.code == 1);
  CHECK(json::parse(said.out)["only_b"] == 3);
  CHECK(json::parse(said.out)["only_a"] == 0);
}
