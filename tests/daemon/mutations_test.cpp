#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>

#include "daemon/ingest_client.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/fixed_rng.hpp"
#include "tests/support/netcdf.hpp"

// Damaged forecasts through the daemon's own way of reading them: one child for each file, so that a death is that file's.
// GLIDEHELM_MUTATIONS: how many of each format; GLIDEHELM_FORMAT: only this one (scripts/campaign mutations). By themselves
// a few of all.

using namespace glidehelm;

namespace {

const char* kSea = R"(netcdf f {
dimensions: time = UNLIMITED ; depth = 2 ; lat = 4 ; lon = 5 ;
variables:
  double time(time) ; time:units = "hours since 2026-11-25" ; time:calendar = "gregorian" ;
  float depth(depth) ; depth:units = "m" ; depth:positive = "down" ;
  float lat(lat) ; lat:units = "degrees_north" ; lat:standard_name = "latitude" ;
  float lon(lon) ; lon:units = "degrees_east" ; lon:standard_name = "longitude" ;
  short uo(time, depth, lat, lon) ; uo:units = "m s-1" ; uo:scale_factor = 0.001 ; uo:_FillValue = -32767s ;
    uo:standard_name = "eastward_sea_water_velocity" ;
  short vo(time, depth, lat, lon) ; vo:units = "m s-1" ; vo:scale_factor = 0.001 ; vo:_FillValue = -32767s ;
    vo:standard_name = "northward_sea_water_velocity" ;
  :title = "a small sea" ; :forecast_reference_time = "2026-11-25T00:00:00Z" ;
data:
  time = 0, 6, 12 ; depth = 0, 50 ; lat = 27, 28, 29, 30 ; lon = -17, -16, -15, -14, -13 ;
  uo = U ;
  vo = V ;
}
)";

std::string sea() {
  std::string text = kSea, u, v;
  for (int i = 0; i < 120; ++i) {
    u += (i > 0 ? ", " : "") + std::to_string(i % 17 == 0 ? -32767 : 50 + 3 * i);
    v += (i > 0 ? ", " : "") + std::to_string(i % 17 == 0 ? -32767 : 400 - 2 * i);
  }
  text.replace(text.find("uo = U"), 6, "uo = " + u);
  text.replace(text.find("vo = V"), 6, "vo = " + v);
  return text;
}

/// One to eight bytes of `bytes` become others: any bit, any byte, or one of those that break counts and offsets.
std::string mutated(std::string bytes, test::FixedRng& rng) {
  constexpr unsigned char kTelling[] = {0x00, 0x01, 0x7f, 0x80, 0xff};
  const auto changes = 1 + rng.below(8);
  // Headers are small beside data, and are where it hurts: half of the changes go there.
  const auto header = std::min<std::uint64_t>(bytes.size(), 1500);
  for (std::uint64_t i = 0; i < changes; ++i) {
    const auto at = rng.below(rng.coin() ? header : bytes.size());
    switch (rng.below(3)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << rng.below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(rng.below(256));
        break;
      default:
        bytes[at] = static_cast<char>(kTelling[rng.below(sizeof kTelling)]);
    }
  }
  return bytes;
}

/// The folder in which the client has its grids made, for as long as this lives.
struct GridsIn {
  explicit GridsIn(const std::string& path) { ::setenv("TMPDIR", path.c_str(), 1); }
  ~GridsIn() { ::unsetenv("TMPDIR"); }
  GridsIn(const GridsIn&) = delete;
  GridsIn& operator=(const GridsIn&) = delete;
};

int count_wanted(int by_itself) {
  const char* wanted = std::getenv("GLIDEHELM_MUTATIONS");
  return wanted != nullptr ? std::atoi(wanted) : by_itself;
}

/// What the reason of a refusal begins with, without names and numbers of the file.
std::string end_of(const std::string& what) {
  for (const char* death :
       {"died of signal", "used more CPU", "killed", "forbidden", "may not", "memory", "longer than"})
    if (const auto at = what.find(death); at != std::string::npos)
      return what.substr(at, std::min<std::size_t>(what.find(" while reading", at) - at, 60));
  return "refused";
}

}  // namespace

TEST_CASE("ten thousand damaged files of every format: whatever becomes of the child, the daemon has an answer") {
  const int count = count_wanted(60);
  const test::ScratchFolder folder;
  std::filesystem::create_directory(folder / "grids");
  const GridsIn grids{folder / "grids"};
  world::RealWorld real;
  auto world = real.world();
  const char* only = std::getenv("GLIDEHELM_FORMAT");
  if (only == nullptr)
    std::cout << "damaged forecasts, through daemon/ingest_client and one child each (seed 20261125):\n";
  for (const char* kind : {"classic", "64-bit offset", "64-bit data", "netCDF-4"}) {
    if (only != nullptr && std::string_view{only} != kind) continue;
    const auto good = test::file_bytes(test::make_netcdf(folder, "good.nc", sea(), kind));
    REQUIRE(daemon::ingest_files({folder / "good.nc"}, {}, world));
    test::FixedRng rng{20261125};
    std::map<std::string, int> ends;
    std::string worst;
    for (int i = 0; i < count; ++i) {
      const auto bytes = mutated(good, rng);
      test::write_bytes(folder / "bad.nc", bytes);
      const auto result = daemon::ingest_files({folder / "bad.nc"}, {}, world);
      const auto end = result ? std::string{"read"} : end_of(result.error());
      ++ends[end];
      if (!result) {
        INFO(kind << " " << i << ": " << result.error());
        // The answer is one line and names the file.
        CHECK(result.error().find(folder / "bad.nc") != std::string::npos);
        CHECK(result.error().find('\n') == std::string::npos);
      }
      if (end != "read" && end != "refused") {
        worst += "  " + std::string{kind} + " " + std::to_string(i) + ": " +
                 result.error().substr(folder.path().size()) + "\n";
        if (const char* keep = std::getenv("GLIDEHELM_KEEP"))
          test::write_bytes(std::string{keep} + "/" + std::to_string(i) + "-" + (kind + std::strlen(kind) - 1) + ".nc",
                            bytes);
      }
    }
    std::cout << "  " << kind << ": files=" << count;
    for (const auto& [end, n] : ends) std::cout << "; " << end << "=" << n;
    std::cout << "\n" << worst << std::flush;
    // Some are read: bytes that changed a number but not its sense. Most are not.
    CHECK(ends["refused"] > count / 10);
  }
  // Nothing is left of any child.
  CHECK(std::filesystem::is_empty(folder / "grids"));
}

TEST_CASE("a classic file cut at two hundred places is refused two hundred times") {
  if (std::getenv("GLIDEHELM_FORMAT") != nullptr) return;
  const test::ScratchFolder folder;
  world::RealWorld real;
  auto world = real.world();
  const auto good = test::file_bytes(test::make_netcdf(folder, "good.nc", sea()));
  int refused = 0, by_length = 0;
  for (std::size_t place = 0; place < 200; ++place) {
    // Evenly over the file. Two bytes of padding may end it: what is cut there is no datum.
    test::write_bytes(folder / "bad.nc", good.substr(0, place * (good.size() - 4) / 199));
    const auto result = daemon::ingest_files({folder / "bad.nc"}, {}, world);
    refused += result ? 0 : 1;
    by_length += !result && (result.error().find("truncated") != std::string::npos ||
                             result.error().find("the file is empty") != std::string::npos ||
                             result.error().find("not a NetCDF file") != std::string::npos);
  }
  std::cout << "a classic file cut at 200 places: refused=" << refused << "\n";
  CHECK(refused == 200);
  CHECK(by_length == 200);  // before the library, which would have read zeros, saw it
}
