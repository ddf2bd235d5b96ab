#include "daemon/ingest/quality.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/ingest/run.hpp"

using namespace glidehelm;

namespace {

/// A file with 2 × 3 nodes whose flags are written into `flags`: declarations and data.
test::Ingested with_flags(const std::string& ancillary, const std::string& flags, const std::string& data) {
  const test::ScratchFolder folder;
  return test::run_ingest(
      folder, test::make_netcdf(
                  folder, "q.nc",
                  "netcdf q { dimensions: lat = 2 ; lon = 3 ; variables: float lat(lat) ; lat:units = "
                  "\"degrees_north\" ; float lon(lon) ; lon:units = \"degrees_east\" ; float u(lat, lon) ; u:units = "
                  "\"m/s\" ; u:ancillary_variables = \"" +
                      ancillary + "\" ; float v(lat, lon) ; v:units = \"m/s\" ; " + flags +
                      " data: lat = 1, 2 ; lon = 1, 2, 3 ; u = .1, .2, .3, .4, .5, _ ; v = .1, .1, .1, .1, .1, .1 ; " +
                      data + " }"));
}
std::string flag(const std::string& name) {
  return "byte " + name + "(lat, lon) ; " + name + ":flag_values = 1b, 3b, 4b ; " + name +
         ":flag_meanings = \"pass suspect fail\" ; ";
}
std::string kept(const test::Ingested& result) {
  REQUIRE(result.view);
  std::string text;
  for (std::size_t n = 0; n < 6; ++n) text += std::isnan(result.view->values[2 * n]) ? '-' : '+';
  return text;
}

}  // namespace

TEST_CASE("what failed any test of the producer is left out, what is suspect is kept") {
  const auto result = with_flags("qa qb", flag("qa") + flag("qb"), "qa = 1, 4, 3, 1, 1, 4 ; qb = 1, 4, 1, 4, 1, 1 ;");
  CHECK(kept(result) == "+-+-+-");
  CHECK(result.view->facts.warnings.back() ==
        "q.nc: 2 of 5 values failed the producer's quality control (qa, qb) and are left out");
}

TEST_CASE("a summary flag overrules the single tests") {
  const auto result = with_flags("qa q_primary", flag("qa") + flag("q_primary"),
                                 "qa = 4, 4, 4, 4, 4, 4 ; q_primary = 1, 1, 1, 1, 4, 1 ;");
  CHECK(kept(result) == "++++--");
}

TEST_CASE("flags that say nothing of failing, lie elsewhere or are not there do not count") {
  CHECK(
      kept(with_flags("qa qc nowhere",
                      "byte qa(lat, lon) ; qa:flag_values = 0b, 1b ; qa:flag_meanings = \"sea land\" ; byte qc(lat) ; "
                      "qc:flag_values = 4b ; qc:flag_meanings = \"fail\" ;",
                      "qa = 1, 1, 1, 1, 1, 1 ; qc = 4, 4 ;")) == "+++++-");
  CHECK(kept(with_flags("", flag("qa"), "qa = 4, 4, 4, 4, 4, 4 ;")) == "+++++-");
}
