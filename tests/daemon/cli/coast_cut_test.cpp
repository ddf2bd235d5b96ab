#include "daemon/cli/coast_cut.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/chart/chart.hpp"

using namespace glidehelm;
using namespace glidehelm::cli;

namespace {

/// 0…100 east and 0…50 north, in units of 1e-7°: numbers that can be read.
const chart::CoastArea kBox{0, 100, 0, 50};

using Points = std::vector<chart::CoastPoint>;

std::vector<ShoreLine> read(const std::string& text, const chart::CoastArea& area = kBox) {
  std::vector<ShoreLine> lines;
  REQUIRE(read_shore_lines(text, area, lines));
  return lines;
}

CoastCut cut(const std::vector<ShoreLine>& lines) {
  auto made = CoastCut::make(kBox, lines);
  REQUIRE(made);
  return *std::move(made);
}

/// Twice the area inside a ring, without sign.
std::int64_t twice_area(const chart::CoastRing& ring) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    const auto &a = ring.points[i], &b = ring.points[(i + 1) % ring.points.size()];
    sum += std::int64_t{a.x} * b.y - std::int64_t{b.x} * a.y;
  }
  return std::abs(sum);
}

}  // namespace

TEST_CASE("GMT text gives lines, whatever the comments, blanks and turns of longitude") {
  const chart::CoastArea fiji{1'760'000'000, 1'840'000'000, -200'000'000, -140'000'000};
  const auto lines = read(
      "# comment\n> Shore Bin # 1, Level 1\n177.5\t-17\n-179.5  -17.25\r\n\n>\n>next\n182.5 -16.0000000499\n175 -16",
      fiji);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0] == ShoreLine{{15'000'000, -170'000'000}, {45'000'000, -172'500'000}});
  CHECK(lines[1] == ShoreLine{{65'000'000, -160'000'000}, {-10'000'000, -160'000'000}});
}

TEST_CASE("what GMT never writes is refused with its line") {
  for (const std::string bad : {"1", "1 x", "1 2 3", "nan 2", "1 91", "721 1", "1,2"}) {
    std::vector<ShoreLine> lines;
    const auto result = read_shore_lines("> a\n1 2\n" + bad + "\n", kBox, lines);
    REQUIRE_FALSE(result);
    CHECK(result.error() == "line 3 is no longitude and latitude: '" + bad + "'");
  }
}

TEST_CASE("pieces are joined end to start, end to end and to closed lines") {
  // an open line in three pieces, the middle one the other way round; a ring in two; a ring of one piece
  const auto lines = joined({{{1, 1}, {2, 2}},
                             {{4, 4}, {3, 3}, {2, 2}},
                             {{4, 4}, {5, 5}},
                             {{10, 0}, {12, 1}, {10, 3}},
                             {{10, 3}, {8, 1}, {10, 0}},
                             {{20, 0}, {21, 0}, {20, 1}, {20, 0}}});
  REQUIRE(lines.size() == 3);
  CHECK(lines[0] == ShoreLine{{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}});
  CHECK(lines[1] == ShoreLine{{20, 0}, {21, 0}, {20, 1}, {20, 0}});
  CHECK(lines[2] == ShoreLine{{10, 0}, {12, 1}, {10, 3}, {8, 1}, {10, 0}});
  CHECK(joined({}).empty());
}

TEST_CASE("pieces in any order and direction give the same land") {
  // two triangles that share a corner, each cut into its three sides: four ends meet there
  const std::vector<ShoreLine> sides{{{10, 10}, {30, 10}}, {{30, 10}, {20, 25}}, {{20, 25}, {10, 10}},
                                     {{20, 25}, {30, 40}}, {{30, 40}, {10, 40}}, {{10, 40}, {20, 25}}};
  std::mt19937_64 random{1};
  for (int k = 0; k < 100; ++k) {
    auto pieces = sides;
    std::shuffle(pieces.begin(), pieces.end(), random);
    for (auto& piece : pieces)
      if (random() % 2 == 0) std::reverse(piece.begin(), piece.end());
    const auto coast = chart::Coast::make(kBox, "a test", cut(joined(pieces)).rings(false));
    REQUIRE(coast);
    const double unit = kPi / 180 / chart::kCoastUnitsPerDegree;
    const auto land = [&](double x, double y) { return (*coast)->land().contains(y * unit, x * unit); };
    for (const double y : {13.0, 20.0, 23.0, 28.0, 37.0}) {
      // half the width of the hourglass at this height: 10 at its ends, 0 at its waist
      const double half = std::abs(y - 25) / 15 * 10;
      CHECK(land(20, y));
      CHECK(land(20 + 0.9 * half, y));
      CHECK(land(20 - 0.9 * half, y));
      CHECK_FALSE(land(20 + 1.1 * half, y));
      CHECK_FALSE(land(20 - 1.1 * half, y));
    }
  }
}

TEST_CASE("an island within the area is a ring, one outside is left out") {
  const auto c = cut({{{10, 10}, {20, 10}, {20, 20}, {10, 10}}, {{110, 10}, {120, 10}, {120, 20}, {110, 10}}});
  REQUIRE(c.stretches().size() == 1);
  CHECK(c.stretches()[0].length == 300);
  const auto rings = c.rings(false);
  REQUIRE(rings.size() == 1);
  CHECK(rings[0].points == Points{{10, 10}, {20, 10}, {20, 20}});
  CHECK(rings[0].cut == std::vector<bool>{false, false, false});
}

TEST_CASE("without a crossing the border is all water or all land") {
  CHECK(cut({}).rings(false).empty());
  const auto land = cut({}).rings(true);
  REQUIRE(land.size() == 1);
  CHECK(land[0].points == Points{{0, 0}, {100, 0}, {100, 50}, {0, 50}});
  CHECK(land[0].cut == std::vector<bool>(4, true));
}

TEST_CASE("a shore across the area leaves land on one side or the other, closed along the border") {
  // in from the west, out to the north
  const auto c = cut({{{-10, 20}, {30, 20}, {30, 60}}});
  REQUIRE(c.stretches().size() == 2);
  CHECK(c.stretches()[0].from == 220);   // north side, at x = 30
  CHECK(c.stretches()[0].length == 60);  // to the north-west corner and down to y = 20
  CHECK(c.stretches()[1].length == 240);
  const auto corner = c.rings(true);
  REQUIRE(corner.size() == 1);
  CHECK(corner[0].points == Points{{0, 20}, {30, 20}, {30, 50}, {0, 50}});
  CHECK(corner[0].cut == std::vector<bool>{false, false, true, true});
  const auto rest = c.rings(false);
  REQUIRE(rest.size() == 1);
  CHECK(rest[0].points == Points{{0, 20}, {30, 20}, {30, 50}, {100, 50}, {100, 0}, {0, 0}});
  CHECK(twice_area(corner[0]) + twice_area(rest[0]) == 2 * 100 * 50);
}

TEST_CASE("an island that reaches out of the area twice is cut into what lies inside") {
  // a ring with two capes into the area from the east
  const auto c = cut({{{110, 5}, {80, 10}, {110, 15}, {110, 25}, {90, 30}, {110, 35}, {130, 20}, {110, 5}}});
  CHECK(c.stretches().size() == 4);
  auto rings = c.rings(true);
  if (twice_area(rings[0]) > 2000) rings = c.rings(false);
  REQUIRE(rings.size() == 2);
  for (const auto& ring : rings) {
    CHECK(ring.points.size() == 3);
    CHECK(std::count(ring.cut.begin(), ring.cut.end(), true) == 1);
  }
}

TEST_CASE("a shore that touches the border, runs along it or passes a corner leaves whole rings") {
  // touches the southern border with one corner
  CHECK(cut({{{40, 0}, {60, 10}, {40, 20}, {40, 0}}}).rings(false).size() == 1);
  // one side runs along the southern border: no shore there
  const auto along = cut({{{20, 0}, {40, 0}, {30, 20}, {20, 0}}});
  auto rings = along.rings(true);
  if (twice_area(rings[0]) > 2000) rings = along.rings(false);
  REQUIRE(rings.size() == 1);
  CHECK(rings[0].points.size() == 3);
  CHECK(std::count(rings[0].cut.begin(), rings[0].cut.end(), true) == 1);
  // cuts a corner from outside, between two points outside
  const auto corner = cut({{{-10, 20}, {20, -10}, {-10, -10}, {-10, 20}}});
  REQUIRE(corner.stretches().size() == 2);
  rings = corner.rings(true);
  if (twice_area(rings[0]) > 2000) rings = corner.rings(false);
  REQUIRE(rings.size() == 1);
  CHECK(twice_area(rings[0]) == 100);
}

TEST_CASE("a shoreline that ends within the area is an error that says where") {
  const auto made = CoastCut::make({0, 100'000'000, 0, 50'000'000}, {{{-10, 20'000'000}, {30'000'000, 20'000'000}}});
  REQUIRE_FALSE(made);
  CHECK(made.error() == "a shoreline ends in the middle of the area, at 2.0000000, 3.0000000");
}

TEST_CASE("random islands cut by random areas keep their land, and close with valid rings") {
  std::mt19937_64 random{7};
  std::uniform_int_distribution<std::int64_t> place{-5'000'000, 15'000'000}, reach{500'000, 4'000'000};
  const chart::CoastArea area{100'000'000, 110'000'000, 400'000'000, 410'000'000};
  for (int k = 0; k < 60; ++k) {
    // squares on a diagonal raster of their own, so that none overlap; cut into sides
    std::vector<ShoreLine> pieces;
    std::vector<std::array<std::int64_t, 4>> squares;
    for (int i = 0; i < 6; ++i) {
      const auto x = place(random), y = 400'000'000 + place(random), r = reach(random);
      const bool apart = std::all_of(squares.begin(), squares.end(), [&](const auto& s) {
        return x + r < s[0] || s[1] < x - r || y + r < s[2] || s[3] < y - r;
      });
      if (!apart) continue;
      squares.push_back({x - r, x + r, y - r, y + r});
      const std::array<ShorePoint, 4> corners{{{x - r, y - r}, {x + r, y - r}, {x + r, y + r}, {x - r, y + r}}};
      for (std::size_t side = 0; side < 4; ++side) pieces.push_back({corners[side], corners[(side + 1) % 4]});
    }
    const auto made = CoastCut::make(area, joined(pieces));
    REQUIRE(made);
    const auto land_at = [&](const ShorePoint& p) {
      return std::any_of(squares.begin(), squares.end(),
                         [&](const auto& s) { return p.x > s[0] && p.x < s[1] && p.y > s[2] && p.y < s[3]; });
    };
    const auto& first = made->stretches().front();
    const bool even = land_at(made->border_point(first.from + first.length / 2, 1));
    const auto coast = chart::Coast::make(area, "a test", made->rings(even));
    REQUIRE(coast);
    std::uniform_int_distribution<std::int64_t> inside{1, 9'999'999};
    for (int i = 0; i < 300; ++i) {
      const ShorePoint p{inside(random), 400'000'000 + inside(random)};
      INFO("try " << k << ", " << p.x << ", " << p.y);
      const double unit = kPi / 180 / chart::kCoastUnitsPerDegree;
      CHECK((*coast)->land().contains(static_cast<double>(p.y) * unit, static_cast<double>(area.west + p.x) * unit) ==
            land_at(p));
    }
  }
}
