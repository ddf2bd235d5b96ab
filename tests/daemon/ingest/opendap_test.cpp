#include "daemon/ingest/opendap.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/utc.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/dap_server.hpp"

using namespace glidehelm;
using test::run_ingest;

namespace {

/// What the program says of a server in a mode; empty when it reads it.
std::string refusal(const std::string& mode) {
  const test::ScratchFolder folder;
  const test::DapServer server{mode, folder};
  const auto result = run_ingest(folder, server.address());
  if (result.view) return "";
  CHECK(result.ran.code != 0);
  // The library writes lines of its own before.
  const auto at = result.ran.err.find("glidehelm-ingest: " + server.address() + ": ");
  REQUIRE(at != std::string::npos);
  std::string said = result.ran.err.substr(at + server.address().size() + 20);
  CHECK(said.find('\n') == said.size() - 1);
  return said.substr(0, said.size() - 1);
}

}  // namespace

TEST_CASE("what is an address is one") {
  CHECK(ingest::is_address("http://server/sea"));
  CHECK(ingest::is_address("https://server/sea?u[0:1:3]"));
  CHECK_FALSE(ingest::is_address("/data/http/file.nc"));
  CHECK_FALSE(ingest::is_address("ftp://server/file.nc"));
}

TEST_CASE("a loopback server is read like a file") {
  const test::ScratchFolder folder;
  const test::DapServer server{"good", folder};
  const auto result = run_ingest(folder, server.address());
  INFO(result.ran.err);
  REQUIRE(result.view);
  const auto& axes = result.view->axes;
  CHECK(axes.times_s == std::vector<double>{epoch_seconds(*utc_from_text("2024-01-01T00:00:00Z")),
                                            epoch_seconds(*utc_from_text("2024-01-01T06:00:00Z")),
                                            epoch_seconds(*utc_from_text("2024-01-01T12:00:00Z"))});
  CHECK(axes.lats_deg == std::vector<double>{40, 40.25, 40.5, 40.75});
  CHECK(axes.lons_deg == std::vector<double>{-10, -9.75, -9.5, -9.25, -9});
  // The server's own formula: u = 0.1·i + 0.01·t, v = −0.1·j − 0.01·t, the south-western node dry.
  for (std::size_t t = 0; t < 3; ++t)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 5; ++i) {
        if (i == 0 && j == 0) {
          CHECK(std::isnan(result.at(t, 0, j, i, 0)));
          continue;
        }
        CHECK(result.at(t, 0, j, i, 0) == Approx(0.1 * double(i) + 0.01 * double(t)).margin(1e-7));
        CHECK(result.at(t, 0, j, i, 1) == Approx(-0.1 * double(j) - 0.01 * double(t)).margin(1e-7));
      }
  CHECK(result.view->facts.recognised_by == "name u");
  CHECK(result.view->facts.sources.front().name == server.address());
  // The hash is that of the numbers: the same again, and another for a part.
  const auto again = run_ingest(folder, server.address());
  CHECK(again.view->facts.sources == result.view->facts.sources);
  const auto part = run_ingest(folder, server.address() + " --area=-9.6/-9.4/40.3/40.7");
  REQUIRE(part.view);
  CHECK(part.view->axes.lons_deg.size() == 3);
  CHECK(part.view->facts.sources.front().hash != result.view->facts.sources.front().hash);
}

TEST_CASE("a constraint at the end of an address cuts what is asked for") {
  const test::ScratchFolder folder;
  const test::DapServer server{"good", folder};
  const auto result =
      run_ingest(folder, "'" + server.address() +
                             "?time[1:1:2],lat[0:1:3],lon[1:1:3],u[1:1:2][0:1:3][1:1:3],v[1:1:2][0:1:3][1:1:3]'");
  INFO(result.ran.err);
  REQUIRE(result.view);
  CHECK(result.view->axes.times_s.size() == 2);
  CHECK(result.view->axes.lons_deg == std::vector<double>{-9.75, -9.5, -9.25});
  CHECK(result.at(0, 0, 0, 0, 0) == Approx(0.11F));
}

TEST_CASE("answers that end early, change, or say nothing of a sea are refused") {
  // libnetcdf itself gives zeros for what an answer lacks, and no error.
  for (const char* mode : {"cut", "short"}) {
    INFO(mode);
    const auto said = refusal(mode);
    CHECK((said == "an answer with u ended early, or the values changed meanwhile" ||
           said == "every value is exactly zero: no sea is that still, the file was probably never filled"));
  }
  CHECK(refusal("growing") == "it changed while it was read: it is still being written");
  CHECK(refusal("written") == "an answer with u ended early, or the values changed meanwhile");
  CHECK(refusal("zeros") ==
        "every value at 2024-01-01T12:00:00Z is exactly zero (1 of 3 times): the file is probably still being written");
  CHECK(refusal("missing") == "unreadable while asking the OPeNDAP server: NetCDF: file not found");
  CHECK(refusal("huge") == "it has 1.2e+08 nodes, allowed is 4e+07; cut it with --area W/E/S/N");
}

TEST_CASE("an address where nobody answers is refused, and so is one with a password, without its being asked") {
  const test::ScratchFolder folder;
  const auto nobody = "http://127.0.0.1:" + std::to_string(test::free_port()) + "/sea";
  const auto result = run_ingest(folder, nobody);
  CHECK(result.ran.err.find("glidehelm-ingest: " + nobody +
                            ": unreadable while asking the OPeNDAP server: NetCDF: I/O failure\n") !=
        std::string::npos);
  const auto secret = run_ingest(folder, "http://me:secret@127.0.0.1:1/sea");
  CHECK(secret.ran.code == 1);
  CHECK(secret.ran.err.find("an address with a name and password would stand in every log; it is not read") !=
        std::string::npos);
}
