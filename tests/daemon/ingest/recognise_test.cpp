#include "daemon/ingest/recognise.hpp"

#include <catch2/catch.hpp>

#include "tests/support/netcdf.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

// What the program does with files stands in glidehelm_ingest_test.cpp; here is what is recognised in headers.

namespace {

/// A header on lat(2), lon(2) and whatever `more` declares, opened.
struct Opened {
  test::ScratchFolder folder;
  std::string bytes;
  std::optional<Result<NetcdfFile>> file;

  explicit Opened(const std::string& more, const std::string& kind = "netCDF-4") {
    bytes = test::file_bytes(test::make_netcdf(
        folder, "h.nc",
        "netcdf h { dimensions: lat = 2 ; lon = 2 ; n = 3 ; variables: float lat(lat) ; float lon(lon) ; " + more +
            " }",
        kind));
    file.emplace(NetcdfFile::open(std::as_bytes(std::span{bytes.data(), bytes.size()})));
    REQUIRE(*file);
  }
  const NetcdfFile& operator*() const { return **file; }
};

std::string pair_of(const std::string& more) {
  const Opened opened{more};
  const auto pair = recognise_velocity(*opened, "", "");
  return pair ? pair->east->name + "/" + pair->north->name + " by " + pair->why : pair.error().what;
}

}  // namespace

TEST_CASE("known names count in any case, and winds are none") {
  CHECK(pair_of("float SSU(lat, lon) ; float SSV(lat, lon) ;") == "SSU/SSV by name SSU");
  CHECK(pair_of("float vozocrtx(lat, lon) ; float vomecrty(lat, lon) ;") == "vozocrtx/vomecrty by name vozocrtx");
  CHECK(pair_of("float u10(lat, lon) ; float v10(lat, lon) ;").find("no east and north velocity is recognised") == 0);
}

TEST_CASE("files that are something else are refused for what they are") {
  CHECK(pair_of("float uamp(n, lat, lon) ; float vamp(n, lat, lon) ; float con(n) ;")
            .find("tidal constituents: uamp(n, lat, lon) describes the tide by its constituents") == 0);
  CHECK(pair_of("int mesh ; mesh:cf_role = \"mesh_topology\" ;").find("unstructured grid: mesh describes a mesh") == 0);
  CHECK(pair_of("group: forecast { variables: float u(lat, lon) ; float v(lat, lon) ; }")
            .find("(its groups are not read: forecast); say which with --variables EAST,NORTH") != std::string::npos);
}

TEST_CASE("the components of a file are listed, by standard_name before names") {
  const Opened named{"float b(lat, lon) ; b:standard_name = \"northward_sea_water_velocity\" ; float u(lat, lon) ;"};
  const auto components = velocity_components(*named);
  REQUIRE(components.size() == 1);
  CHECK(components[0].variable->name == "b");
  CHECK_FALSE(components[0].is_east);
  const Opened both{"float u(lat, lon) ; float northward_flow(lat, lon) ;"};
  CHECK(velocity_components(*both).size() == 2);
  CHECK(velocity_components(*Opened{"float salt(lat, lon) ;"}).empty());
}

TEST_CASE("heights are found by standard_name, by name, or as anomaly and mean") {
  const auto found = [](const std::string& more) {
    const Opened opened{more};
    const auto heights = recognise_heights(*opened);
    if (!heights) return heights.error().what;
    return *heights ? (*heights)->why : std::string{"none"};
  };
  CHECK(found("float h(lat, lon) ; h:standard_name = \"sea_surface_height_above_geoid\" ; float zos(lat, lon) ;") ==
        "h, standard_name sea_surface_height_above_geoid");
  CHECK(found("float mdt(lat, lon) ; mdt:standard_name = \"sea_surface_height_above_geoid\" ; float SLA(lat, lon) ;") ==
        "SLA + mdt, by name");
  CHECK(found("float ssh(lat, lon) ;") == "ssh, by name");
  CHECK(found("float temp(lat, lon) ;") == "none");
  CHECK(found("float sla(lat, lon) ;").find("sla(lat, lon) is the height above the mean sea surface") == 0);
}
