#include "core/safety/judge.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "tests/core/safety/sample_dossier.hpp"

using namespace glidehelm;
using namespace glidehelm::safety;
using test::good_case;
using test::margin;

TEST_CASE("a good file passes every rule, each judged once and in order") {
  const auto c = good_case();
  const auto verdict = c.judged();
  CHECK(c.failing() == "");
  CHECK(verdict.accepted);
  CHECK(verdict.of == Sha256::of(c.dossier.file_bytes));
  CHECK(verdict.file_name == "goto_l10.ma");
  REQUIRE(verdict.margins.size() == rules().size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < verdict.margins.size(); ++i) {
    CHECK(verdict.margins[i].rule == rules()[i].name);
    CHECK_FALSE(verdict.margins[i].message.empty());
    names.insert(verdict.margins[i].rule);
  }
  CHECK(names.size() == rules().size());
  CHECK(c.judged() == c.judged());
  CHECK(accept(c.dossier.file_name, c.dossier.file_bytes, verdict).has_value());
}

TEST_CASE("a file in which one digit of a coordinate was changed is refused") {
  auto c = good_case();
  // One stint suffices here and keeps 300 verdicts quick.
  c.dossier.horizon_s = c.dossier.fix_s + c.dossier.schedule.surfacing_time(0).count() + 1;
  c.promise_as_flown();
  REQUIRE(c.failing() == "");
  const std::string good = c.dossier.file_bytes;
  int changed = 0;
  for (std::size_t i = good.find("<start:waypoints>"); i < good.size(); ++i)
    for (const int step : {-1, 1}) {
      const char digit = static_cast<char>(good[i] + step);
      if (good[i] < '0' || good[i] > '9' || digit < '0' || digit > '9') continue;
      c.dossier.file_bytes = good;
      c.dossier.file_bytes[i] = digit;
      ++changed;
      const auto verdict = c.judged();
      CAPTURE(c.dossier.file_bytes);
      CHECK_FALSE(verdict.accepted);
      CHECK_FALSE(margin(verdict, "4 points").holds);
    }
  // Digits 1 … 8 count twice, 0 and 9 once; 4 points of 15 to 17 digits.
  CHECK(changed > 90);
  // The radius is promised too.
  c.dossier.file_bytes = good;
  c.dossier.promise.radius = Metres{400};
  CHECK(c.failing() == "");
  c.dossier.file_bytes.replace(good.find(" 400.0"), 6, " 401.0");
  CHECK_FALSE(margin(c.judged(), "4 points").holds);
}

TEST_CASE("a file cut anywhere, or of random bytes, is refused and judged by every rule") {
  auto c = good_case();
  const std::string good = c.dossier.file_bytes;
  for (std::size_t n = 0; n < good.size(); ++n) {
    c.dossier.file_bytes = good.substr(0, n);
    const auto verdict = c.judged();
    REQUIRE_FALSE(verdict.accepted);
    REQUIRE_FALSE(margin(verdict, "4 format").holds);
    REQUIRE(verdict.margins.size() == rules().size());
  }
  std::mt19937 random{7};
  for (int round = 0; round < 300; ++round) {
    c.dossier.file_bytes.clear();
    for (auto n = random() % 5000; n > 0; --n) c.dossier.file_bytes += static_cast<char>(random() % 256);
    REQUIRE_FALSE(c.judged().accepted);
  }
}

TEST_CASE("the station list, one waypoint at the goal, is accepted inside and outside its radius") {
  auto c = good_case();
  c.dossier.at.fix = destination(c.dossier.promise.goal, Bearing{degrees(120)}, Metres{800});
  c.write({c.dossier.promise.goal}, 100);
  CHECK(c.failing() == "");
  CHECK(margin(c.judged(), "1 legs").holds);
  CHECK(c.dossier.promise.list_arrival_s == c.dossier.fix_s);
  c.write({c.dossier.promise.goal}, 1000);  // hit at once: it is the only point and the goal
  CHECK(c.failing() == "");
}

TEST_CASE("a direct list, the goal alone, may lead over any distance") {
  auto c = good_case();
  c.dossier.promise.goal = test::as_written(destination(c.dossier.at.fix, Bearing{degrees(80)}, Metres{300'000}));
  c.write({c.dossier.promise.goal}, 500);
  CHECK(c.failing() == "");
  CHECK_FALSE(c.dossier.promise.list_arrival_s.has_value());
}

TEST_CASE("a waiting list and lists on both sides of the antimeridian are accepted") {
  auto c = good_case();
  auto points = std::vector<GeoPoint>{};
  for (const auto& p : c.dossier.promise.points) points.push_back(p.at);
  c.write(points, 400, "-2", "6");
  CHECK(c.failing() == "");
  for (const double lon : {179.95, -179.95}) {
    auto far = good_case();
    auto& d = far.dossier;
    d.at.fix = geo_point(-52, lon);
    const Bearing way{degrees(lon > 0 ? 80 : 280)};
    d.promise.goal = test::as_written(destination(d.at.fix, way, Metres{20'000}));
    far.write({destination(d.at.fix, way, Metres{4500}), destination(d.at.fix, way, Metres{9000}), d.promise.goal},
              400);
    CHECK(far.failing() == "");
  }
}

TEST_CASE("a list is judged in the corrected forecast, and a correction that makes no sense is refused") {
  // The good file's ocean, 0.05 m/s east and 0.02 north, as a forecast without its eastward part and a correction with
  // scales so long that it is the same everywhere.
  auto c = good_case();
  c.field = test::uniform(0.0, 0.02);
  CHECK(c.failing().find("promise surfacing") != std::string::npos);
  ocean::LocalCorrection missing;
  missing.at = c.dossier.at.fix;
  missing.at_s = c.dossier.fix_s;
  missing.added = {MetresPerSecond{0.05}, MetresPerSecond{0}};
  missing.length = Metres{1e7};
  missing.time = Seconds{1e8};
  c.dossier.correction = missing;
  CHECK(c.failing() == "");
  c.dossier.correction->added.east = MetresPerSecond{1.5};
  CHECK(c.failing().find("0 dossier") != std::string::npos);
  c.dossier.correction = missing;
  c.dossier.correction->time = Seconds{0};
  CHECK(c.failing().find("0 dossier") != std::string::npos);
}

TEST_CASE("the tail is flown with the shares that the rules name") {
  auto c = good_case();
  c.dossier.rules.tail_stint = 0.12;
  c.dossier.rules.tail_slower = 0.2;
  CHECK(margin(c.judged(), "2 tail").message ==
        "with the stint 12 % shorter or longer and the speed 20 % lower or 5 % higher");
  c.dossier.rules.tail_slower = 0.7;
  CHECK(c.failing().find("0 dossier") != std::string::npos);
}
