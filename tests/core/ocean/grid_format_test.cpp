#include "core/ocean/grid_format.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

namespace {

Grid small() {
  GridAxes axes{{1000.0, 4600.5}, {0.5, 10}, {-30, -29.75, -29.5}, {170, 180, 190.5}, true, true};
  Grid grid = test::make_grid(std::move(axes), [](double lat, double lon, double z, double t) {
    return lat == -30 && lon == 180 ? std::pair{test::kDry, 0.0} : std::pair{lat / 100 + z, lon / 1000 + t * 1e-6};
  });
  grid.facts.cycle = "model 2024-11-20";
  grid.facts.reference_s = 900;
  grid.facts.east_variable = "uo";
  grid.facts.north_variable = "vo";
  grid.facts.east_unit = grid.facts.north_unit = "m s-1";
  grid.facts.recognised_by = "standard_name";
  grid.facts.time_unit = "hours since 1950-01-01";
  grid.facts.sources = {{"a.nc", Sha256::of("a")}, {"b.nc", Sha256::of("b")}};
  grid.facts.warnings = {"first", ""};
  grid.facts.water = {{{Metres{0.5}, 21.25, 36.5}, {Metres{10}, 1.0 / 3, 35}}, "temp and salt"};
  grid.filled = {{2, 3}, {9, 1}};
  return grid;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span{text.data(), text.size()});
}

/// The bytes with the header's checksum made right again: what a program with a bug would write.
void seal(std::string& bytes) {
  std::uint32_t size = 0, crc = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  std::memcpy(bytes.data() + 16, &crc, 4);
  crc = crc32c(std::string_view{bytes}.substr(0, size));
  std::memcpy(bytes.data() + 16, &crc, 4);
}
std::uint32_t header_size(const std::string& bytes) {
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  return size;
}

}  // namespace

TEST_CASE("a grid comes back from its bytes as it was written") {
  const Grid grid = small();
  const std::string bytes = write_grid(grid);
  const auto view = open_grid(bytes_of(bytes));
  REQUIRE(view);
  CHECK(view->axes == grid.axes);
  CHECK(view->facts.cycle == "model 2024-11-20");
  CHECK(view->facts.reference_s == 900);
  CHECK(view->facts.recognised_by == "standard_name");
  CHECK(view->facts.time_unit == "hours since 1950-01-01");
  CHECK(view->facts.sources == grid.facts.sources);
  CHECK(view->facts.warnings == grid.facts.warnings);
  CHECK(view->facts.water == grid.facts.water);
  CHECK(view->filled == grid.filled);
  CHECK(view->provenance == provenance_of(grid.facts.sources));
  CHECK(std::memcmp(view->values, grid.values.data(), grid.values.size() * sizeof(float)) == 0);
  CHECK(write_grid(grid) == bytes);
}

TEST_CASE("no flipped bit and no cut of a grid is believed") {
  const std::string good = write_grid(small());
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
    INFO("byte " << i);
    CHECK_FALSE(open_grid(bytes_of(bad)));
    CHECK_FALSE(open_grid(bytes_of(good).first(i)));
  }
  CHECK_FALSE(open_grid(bytes_of(good + "x")));
}

TEST_CASE("a right checksum does not excuse impossible sizes") {
  const std::string good = write_grid(small());
  for (const std::uint32_t count : {0U, 1U, 3U, 0x7fffffffU, 0xffffffffU, 0x40000000U})
    for (const std::size_t axis : {32U, 36U, 40U, 44U}) {
      std::string bad = good;
      std::memcpy(bad.data() + axis, &count, 4);
      if (bad == good) continue;
      seal(bad);
      CHECK_FALSE(open_grid(bytes_of(bad)));
    }
  for (const std::uint32_t length : {0xffffffffU, 100000U}) {
    std::string bad = good;  // the first text's length lies behind the four axes
    std::memcpy(bad.data() + 96 + 8 * (2 + 2 + 3 + 3), &length, 4);
    seal(bad);
    const auto view = open_grid(bytes_of(bad));
    REQUIRE_FALSE(view);
    CHECK(view.error().message() == "header: axes or texts run beyond it");
  }
}

TEST_CASE("axes that do not ascend, lie out of range or wrap around are refused by name") {
  const auto refused = [](auto change) {
    Grid grid = small();
    change(grid.axes);
    const std::string bytes = write_grid(grid);
    const auto view = open_grid(bytes_of(bytes));
    REQUIRE_FALSE(view);
    return view.error().where;
  };
  CHECK(refused([](GridAxes& a) { a.times_s = {5, 5}; }) == "times");
  CHECK(refused([](GridAxes& a) { a.times_s[1] = std::nan(""); }) == "times");
  CHECK(refused([](GridAxes& a) { a.depths_m = {10, 0}; }) == "depths");
  CHECK(refused([](GridAxes& a) { a.depths_m[1] = 20000; }) == "depths");
  CHECK(refused([](GridAxes& a) { a.lats_deg[2] = 91; }) == "latitudes");
  CHECK(refused([](GridAxes& a) { a.lons_deg = {181, 182, 183}; }) == "longitudes");
  CHECK(refused([](GridAxes& a) { a.lons_deg = {-180, 0, 180}; }) == "longitudes");
  CHECK(refused([](GridAxes& a) { a.has_time = false; }) == "times");
  CHECK(refused([](GridAxes& a) { a.has_depth = false; }) == "depths");
}

TEST_CASE("a value that is infinite or half a current is refused") {
  for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    Grid grid = small();
    grid.values[7] = bad;
    const std::string bytes = write_grid(grid);
    const auto view = open_grid(bytes_of(bytes));
    REQUIRE_FALSE(view);
    CHECK(view.error().message() == "payload: node 3 is neither a current nor two NaN");
  }
}

TEST_CASE("bytes that are no grid are refused as such") {
  CHECK_FALSE(open_grid({}));
  const std::string netcdf = "CDF\x01" + std::string(200, '\0');
  REQUIRE_FALSE(open_grid(bytes_of(netcdf)));
  CHECK(open_grid(bytes_of(netcdf)).error().what == "this is not a grid of glidehelm-ingest");
}

TEST_CASE("statistics count wet nodes and their speeds") {
  const Grid grid = test::make_grid(test::flat_axes({0, 1}, {0, 1}), [](double lat, double lon, double, double) {
    return lat == 0 && lon == 0 ? std::pair{test::kDry, test::kDry} : std::pair{3 * lat, 4 * lon};
  });
  const auto statistics = statistics_of(view_of(grid));
  CHECK(statistics.wet_fraction == 0.75);
  CHECK(statistics.slowest == 3);  // of the speeds 4, 3 and 5
  CHECK(statistics.fastest == 5);
  CHECK(statistics.mean == 4);
}

TEST_CASE("the payload begins at a multiple of 64 bytes") { CHECK(header_size(write_grid(small())) % 64 == 0); }

TEST_CASE("filled nodes that do not exist, overlap or have no value are not believed") {
  // Node 1 is dry: the first row's second column.
  for (const auto& runs : {std::vector<NodeRun>{{1, 1}}, std::vector<NodeRun>{{0, 2}}, std::vector<NodeRun>{{2, 0}},
                           std::vector<NodeRun>{{36, 1}}, std::vector<NodeRun>{{30, ~std::uint64_t{0}}},
                           std::vector<NodeRun>{{4, 3}, {6, 1}}, std::vector<NodeRun>{{4, 3}, {2, 1}}}) {
    Grid grid = small();
    grid.filled = runs;
    const auto view = open_grid(bytes_of(write_grid(grid)));
    REQUIRE_FALSE(view);
    CHECK(view.error().where == "filled nodes");
  }
}

TEST_CASE("a grid of the layout before, which ends without water, is read") {
  Grid grid = small();
  grid.facts.water = {};
  // The water of a grid without any is eight zero bytes at the end of the header: as good as its padding.
  std::string bytes = write_grid(grid);
  const std::uint32_t before = kGridVersionWithoutWater;
  std::memcpy(bytes.data() + 8, &before, 4);
  seal(bytes);
  const auto view = open_grid(bytes_of(bytes));
  REQUIRE(view);
  CHECK(view->axes == grid.axes);
  CHECK(view->filled == grid.filled);
  CHECK(view->facts.water == GridWater{});
  const std::uint32_t unknown = kGridVersionWithoutWater - 1;
  std::memcpy(bytes.data() + 8, &unknown, 4);
  seal(bytes);
  CHECK_FALSE(open_grid(bytes_of(bytes)));
}

TEST_CASE("water that no sea has, or whose depths do not ascend, is refused") {
  const double nan = std::nan("");
  for (const auto& layers :
       {std::vector<WaterLayer>{{Metres{0}, 45.5, 35}}, std::vector<WaterLayer>{{Metres{0}, -3.5, 35}},
        std::vector<WaterLayer>{{Metres{0}, 10, 45.5}}, std::vector<WaterLayer>{{Metres{0}, 10, -0.5}},
        std::vector<WaterLayer>{{Metres{0}, nan, 35}}, std::vector<WaterLayer>{{Metres{0}, 10, nan}},
        std::vector<WaterLayer>{{Metres{nan}, 10, 35}},
        std::vector<WaterLayer>{{Metres{5}, 10, 35}, {Metres{5}, 9, 35}}}) {
    Grid grid = small();
    grid.facts.water.layers = layers;
    const auto view = open_grid(bytes_of(write_grid(grid)));
    REQUIRE_FALSE(view);
    CHECK(view.error().where == "water");
  }
  // A number of layers that the header does not hold.
  std::string bad = write_grid(small());
  const auto text = bad.find("temp and salt");
  REQUIRE(text != std::string::npos);
  const std::uint32_t many = 0xffffffff;
  std::memcpy(bad.data() + text - 4 - 2 * 24 - 4, &many, 4);
  seal(bad);
  CHECK_FALSE(open_grid(bytes_of(bad)));
}

TEST_CASE("marks become runs and say the same") {
  CHECK(runs_of({}).empty());
  CHECK(runs_of({false, false}).empty());
  CHECK(runs_of({true, true, false, true}) == std::vector<NodeRun>{{0, 2}, {3, 1}});
}
