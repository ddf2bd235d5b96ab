#include "daemon/ingest/model_levels.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/netcdf.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

const Units& units() {
  static const Units kUnits = [] {
    auto loaded = Units::load();
    REQUIRE(loaded);
    return std::move(*loaded);
  }();
  return kUnits;
}

/// What the levels of u and v of a file come out as.
struct Described {
  std::string words, fault;
  std::vector<std::string> warnings;
  std::optional<Levels> levels;
};
Described described(const std::string& variables, const std::string& data,
                    const std::optional<StretchingChoice>& given = std::nullopt) {
  const test::ScratchFolder folder;
  const auto bytes = test::file_bytes(test::make_netcdf(
      folder, "l.nc",
      "netcdf l { dimensions: time = 2 ; s_rho = 2 ; z = 3 ; y = 2 ; x = 2 ; one = 1 ; variables: double time(time) ; "
      "time:units = \"hours since 2024-01-01\" ; " +
          variables + " data: time = 0, 1 ; " + data + " }"));
  const auto file = NetcdfFile::open(std::as_bytes(std::span{bytes.data(), bytes.size()}));
  REQUIRE(file);
  const ModelFiles files{{&*file}};
  const ModelVelocity velocity{{&*file, file->find("u")}, {&*file, file->find("v")}, "", ModelVelocity::Sense::open};
  Described result;
  const auto u = split(velocity.u), v = split(velocity.v);
  if (!u || !v) {
    result.fault = !u ? u.error().what : v.error().what;
    return result;
  }
  auto levels = levels_of(files, velocity, *u, *v, {2, 2}, units(), given, result.warnings);
  if (!levels) {
    result.fault = levels.error().what;
    return result;
  }
  result.words = levels->words;
  // Files are gone with this function: what is read of them now stays.
  if (const auto zeta = surface_at(*levels, 1); zeta && !zeta->empty())
    result.words += " " + std::to_string((*zeta)[0]);
  levels->zeta = {};
  result.levels = std::move(*levels);
  return result;
}

const std::string kU = "float u(time, s_rho, y, x) ; float v(time, s_rho, y, x) ; ";
const std::string kH = "double h(y, x) ; ", kHData = "h = 100, 100, 50, 0 ; ";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("ROMS describes its levels by variables: Vtransform, s_rho, Cs_r, hc, h, zeta") {
  const auto d = described(
      kU + kH + "double s_rho(s_rho) ; double Cs_r(s_rho) ; double hc ; int Vtransform ; double zeta(time, y, x) ;",
      kHData +
          "s_rho = -0.75, -0.25 ; Cs_r = -0.5, -0.1 ; hc = 20 ; Vtransform = 2 ; zeta = 0, 0, 0, 0, 1.25, 0, 0, 0 ;");
  INFO(d.fault);
  REQUIRE(d.levels);
  CHECK(d.words ==
        "2 terrain-following levels (Vtransform 2, Cs_r of the file, hc 20 m, h), below the moving surface zeta "
        "1.250000");
  CHECK(d.levels->terrain->law == LevelLaw::transform_2);
  CHECK(d.levels->terrain->c == std::vector<double>{-0.5, -0.1});
  CHECK(d.levels->h == std::vector<double>{100, 100, 50, 0});
  CHECK(d.levels->has_depth);
}

TEST_CASE("CF describes them by standard_name and formula_terms, with any names") {
  const auto named = [](const std::string& standard) {
    return described(
        "float u(time, s_rho, y, x) ; float v(time, s_rho, y, x) ; double s_rho(s_rho) ; s_rho:standard_name = \"" +
            standard +
            "\" ; s_rho:formula_terms = \"s: s_rho C: curve eta: el depth: bottom depth_c: critical\" ; double "
            "curve(s_rho) ; "
            "double bottom(y, x) ; double critical ; double el(time, y, x) ;",
        "s_rho = -0.75, -0.25 ; curve = -0.5, -0.1 ; critical = 20 ; bottom = 100, 100, 50, 60 ; el = 0, 0, 0, 0, 2, "
        "0, 0, 0 ;");
  };
  CHECK(named("ocean_s_coordinate_g1").words ==
        "2 terrain-following levels (Vtransform 1, Cs_r of the file, hc 20 m, bottom), below the moving surface el "
        "2.000000");
  CHECK(named("ocean_s_coordinate_g2").levels->terrain->law == LevelLaw::transform_2);
  CHECK(named("ocean_s_coordinate").levels->terrain->law == LevelLaw::s_coordinate);
  CHECK(contains(named("ocean_double_sigma_coordinate").fault,
                 "levels of the kind ocean_double_sigma_coordinate are not read"));
}

TEST_CASE("a missing Cs_r is computed from Vstretching and its parameters") {
  const auto d = described(kU + kH + "double hc ; int Vtransform ; int Vstretching ; double theta_s ; double theta_b ;",
                           kHData + "hc = 20 ; Vtransform = 2 ; Vstretching = 4 ; theta_s = 5 ; theta_b = 0.4 ;");
  INFO(d.fault);
  REQUIRE(d.levels);
  CHECK(d.levels->terrain->s == std::vector<double>{-0.75, -0.25});
  const StretchingChoice choice{2, 4, 5, 0.4, 20};
  CHECK(d.levels->terrain->c[0] == stretching_curve(choice, -0.75));
  CHECK(contains(d.words, "stretching computed"));
  CHECK(contains(d.words, "below zeta = 0"));
}

TEST_CASE("a description that contradicts itself, or lacks something, is refused") {
  CHECK(described(kU + kH +
                      "double s_rho(s_rho) ; s_rho:standard_name = \"ocean_s_coordinate_g1\" ; double Cs_r(s_rho) ; "
                      "double hc ; int Vtransform ;",
                  kHData + "s_rho = -0.75, -0.25 ; Cs_r = -0.5, -0.1 ; hc = 20 ; Vtransform = 2 ;")
            .fault == "Vtransform = 2 contradicts the standard_name ocean_s_coordinate_g1");
  CHECK(
      contains(described(kU + kH + "double s_rho(s_rho) ; double Cs_r(s_rho) ; double hc ;",
                         kHData + "s_rho = -0.75, -0.25 ; Cs_r = -0.5, -0.1 ; hc = 20 ;")
                   .fault,
               "2 terrain-following levels whose depths are not known: the files have no Vtransform; say --s-levels"));
  CHECK(contains(described(kU, "").fault, "the files have no Vtransform, no Cs_r, no hc"));
  CHECK(contains(described(kU + kH + "double Cs_r(s_rho) ; double hc ; int Vtransform ;",
                           "h = -100, -50, -3000, -20 ; Cs_r = -0.5, -0.1 ; hc = 20 ; Vtransform = 2 ;")
                     .fault,
                 "the depth of the water h has the median -100 m, allowed is positive down"));
  CHECK(contains(described(kU + kH + "double Cs_r(s_rho) ; double hc ; int Vtransform ;",
                           kHData + "Cs_r = 0.5, 0.1 ; hc = 20 ; Vtransform = 2 ;")
                     .fault,
                 "allowed is -1 to 0"));
}

TEST_CASE("what is given fills what the files do not say, and only that") {
  const StretchingChoice given{1, 1, 5, 0.4, 12};
  const auto filled = described(kU + kH, kHData, given);
  INFO(filled.fault);
  REQUIRE(filled.levels);
  CHECK(filled.levels->terrain->law == LevelLaw::transform_1);
  CHECK(filled.levels->terrain->hc_m == 12);
  CHECK(filled.warnings.empty());
  const auto partly = described(kU + kH + "double hc ; ", kHData + "hc = 20 ;", given);
  REQUIRE(partly.levels);
  CHECK(partly.levels->terrain->hc_m == 20);
  const auto whole = described(kU + kH + "double s_rho(s_rho) ; double Cs_r(s_rho) ; double hc ; int Vtransform ;",
                               kHData + "s_rho = -0.75, -0.25 ; Cs_r = -0.5, -0.1 ; hc = 20 ; Vtransform = 2 ;", given);
  REQUIRE(whole.levels);
  CHECK(whole.levels->terrain->law == LevelLaw::transform_2);
  CHECK(whole.warnings ==
        std::vector<std::string>{"the files describe their levels themselves; the s-levels given are not used"});
}

TEST_CASE("depths stay depths, and only equal ones of both components") {
  const auto d = described(
      "float u(time, z, y, x) ; float v(time, z, y, x) ; float z(z) ; z:units = \"m\" ; z:positive = \"up\" ;",
      "z = -1, -10, -50 ;");
  INFO(d.fault);
  REQUIRE(d.levels);
  CHECK_FALSE(d.levels->terrain);
  CHECK(d.levels->depths == std::vector<double>{1, 10, 50});
  CHECK(d.levels->order == std::vector<std::size_t>{0, 1, 2});
  CHECK(d.words == "3 depths of the file");
  const auto none = described("float u(time, y, x) ; float v(time, y, x) ; ", "");
  REQUIRE(none.levels);
  CHECK_FALSE(none.levels->has_depth);
  CHECK(contains(
      described("float u(time, z, y, x) ; float v(time, y, x) ; float z(z) ; z:units = \"m\" ; z:positive = \"down\" ;",
                "z = 1, 2, 3 ;")
          .fault,
      "only one of the two components has levels"));
}

TEST_CASE("a dimension that is neither time nor level is refused by name, unless it is one long") {
  CHECK(described("float u(z, time, y, x) ; float v(z, time, y, x) ;", "").fault ==
        "dimension z of u(z, time, y, x) is neither time nor depth");
  CHECK(described("float u(one, time, y, x) ; float v(one, time, y, x) ;", "").levels);
}
