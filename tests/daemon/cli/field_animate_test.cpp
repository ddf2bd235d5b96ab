#include "daemon/cli/field_animate.hpp"

#include <cmath>

#include "daemon/cli/field_page.hpp"
#include "tests/daemon/cli/field_verb.hpp"
#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;

namespace {

ocean::Grid grid_of(std::size_t times, std::size_t rows, std::size_t columns) {
  return test::make_grid({test::steps(1714521600, 3600, times),
                          {0.0},
                          test::steps(30, 0.01, rows),
                          test::steps(-20, 0.01, columns),
                          times > 1,
                          false},
                         [](double lat, double lon, double, double t) {
                           if (lat < 30.005 && lon < -19.995) return std::pair{test::kDry, test::kDry};
                           return std::pair{0.1 + lat / 1000, 0.2 + t / 1e12};
                         });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("an animation holds every number of a small field to the millimetre per second") {
  const auto grid = grid_of(3, 4, 5);
  const auto animation = animation_of(ocean::view_of(grid), 0, nullptr);
  REQUIRE(animation.mm_per_s.size() == 2 * 3 * 4 * 5);
  CHECK(animation.decimation.empty());
  CHECK(animation.mm_per_s[0] == Animation::kNoCurrent);
  for (std::size_t n = 0; n < animation.mm_per_s.size(); ++n) {
    if (std::isnan(grid.values[n])) continue;
    // Rounding: half a unit.
    CHECK(std::abs(animation.mm_per_s[n] - 1000 * static_cast<double>(grid.values[n])) <= 0.5001);
  }
}

TEST_CASE("a large field is thinned by the stated rule and says so") {
  const auto grid = grid_of(60, 300, 300);
  const auto animation = animation_of(ocean::view_of(grid), 0, nullptr);
  // 300 · 300 is above 40 000; every second row and column gives 150 · 150 = 22 500, times 60 is below 1 500 000.
  CHECK(animation.lats_deg.size() == 150);
  CHECK(animation.lons_deg.size() == 150);
  CHECK(animation.times_s.size() == 60);
  CHECK(animation.decimation == "one of 2 rows and columns is shown");
  CHECK(animation.lats_deg[1] == grid.axes.lats_deg[2]);
  // Base64 takes 16 bits in 8/3 characters; with script and axes the page stays below 9 MB for any field.
  CHECK(animation_page(animation).size() < 8 * animation.mm_per_s.size() / 3 + 40'000);
}

TEST_CASE("many times are thinned too") {
  const auto grid = grid_of(200, 100, 100);
  const auto animation = animation_of(ocean::view_of(grid), 0, nullptr);
  CHECK(animation.times_s.size() == 100);
  CHECK(animation.times_s[1] == grid.axes.times_s[2]);
  CHECK(animation.decimation == "one of 2 times is shown");
}

TEST_CASE("the shore is drawn in the field's turn and without the border of the cut and without rings outside") {
  const auto grid = grid_of(1, 10, 10);
  // A triangle within the field, its last edge cut; a ring outside.
  const auto coast = chart::Coast::parse([] {
    std::vector<chart::CoastRing> rings{
        {{{10'000'000, 300'200'000}, {10'500'000, 300'500'000}, {10'500'000, 300'100'000}}, {false, false, false}},
        {{{0, 290'000'000}, {1'000'000, 290'000'000}, {1'000'000, 291'000'000}}, {false, false, false}}};
    const auto made = chart::Coast::make({-210'000'000, -180'000'000, 290'000'000, 310'000'000}, "a test", rings);
    REQUIRE(made);
    return (*made)->text();
  }());
  REQUIRE(coast);
  const auto animation = animation_of(ocean::view_of(grid), 0, coast->get());
  REQUIRE(animation.shores.size() == 1);
  REQUIRE(animation.shores[0].size() == 4);  // closed
  CHECK(animation.shores[0][0].first == Approx(-20.0));
  CHECK(animation.shores[0][0].second == Approx(30.02));
}

TEST_CASE("text of a file cannot become markup of a page or a map") {
  auto grid = grid_of(2, 4, 4);
  grid.facts.cycle = "</title><script>alert(1)</script>\"& \xff";
  grid.facts.warnings = {"<img src=x onerror=alert(2)>"};
  const auto animation = animation_of(ocean::view_of(grid), 0, nullptr);
  const auto page = animation_page(animation), map = animation_kml(animation);
  for (const auto* text : {&page, &map}) {
    CHECK_FALSE(contains(*text, "<script>alert"));
    CHECK_FALSE(contains(*text, "<img"));
    CHECK_FALSE(contains(*text, "\xff"));
    CHECK(contains(*text, "&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt;&quot;&amp; ?"));
  }
  CHECK(contains(page, "&lt;img src=x onerror=alert(2)&gt;"));
  // Nothing is loaded from anywhere.
  CHECK(contains(page, "default-src 'none'"));
  CHECK_FALSE(contains(page, "http://"));
  CHECK_FALSE(contains(page, "https://"));
}

TEST_CASE("a map has a time span per time and its arrows point to where the water flows") {
  auto grid = test::make_grid({test::steps(1714521600, 3600, 2), {0.0}, {0.0, 1.0}, {10.0, 11.0}, true, false},
                              [](double, double, double, double) {
                                return std::pair{0.5, 0.0};
                              });
  const auto map = animation_kml(animation_of(ocean::view_of(grid), 0, nullptr));
  CHECK(contains(map, "<begin>2024-05-01T00:00:00Z</begin><end>2024-05-01T01:00:00Z</end>"));
  CHECK(contains(map, "<begin>2024-05-01T01:00:00Z</begin><end>2024-05-01T02:00:00Z</end>"));
  // Eastward at the equator, the fastest: from 10, 0 one distance between arrows to the east.
  CHECK(contains(map, "<coordinates>10.00000,0.00000 11.00000,0.00000 "));
}

TEST_CASE("field animate writes both kinds of files and replaces none") {
  const test::ScratchFolder folder;
  test::SeaFile sea;
  sea.u = [](int t, int z, int j, int i) { return i + j == 0 ? test::kDryNode : 0.1 * z + 0.05 + 0.01 * (t + i); };
  sea.v = [](int, int, int j, int i) { return i + j == 0 ? test::kDryNode : 0.1 + 0.01 * j; };
  FieldAnimateOptions options;
  options.files = {test::make_sea(folder, "a.nc", sea)};
  options.depth_m = 12;
  for (const char* name : {"a.html", "a.kml"}) {
    options.out = folder / name;
    const auto said = test::run_verb(run_field_animate, options);
    INFO(said.err);
    REQUIRE(said.code == 0);
    CHECK(contains(test::file_bytes(options.out), "10.0 m"));  // the nearest level
    CHECK(test::run_verb(run_field_animate, options).code == 1);
  }
  options.out = folder / "a.gif";
  CHECK(test::run_verb(run_field_animate, options).code == 2);
}
