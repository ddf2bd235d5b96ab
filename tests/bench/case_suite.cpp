#include "tests/bench/case_suite.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/planning/flight.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/planning.hpp"
#include "tests/support/random_sea.hpp"

namespace glidehelm::suite {

namespace {

using test::Dice;

constexpr double kT0 = 1.7e9;
constexpr double kCellsPerDegree = 20.0;
constexpr double kMiddleLat = 41.0, kMiddleLon = -12.0;
constexpr double kMetresPerDegree = 111.2e3;

struct Eddy {
  double x, y;  ///< metres from the middle of the sea
  double radius, speed;
  double east, north;  ///< its own drift, m/s
};

struct SeaPlan {
  double half_north, half_east;  ///< metres from the middle to the edges
  int eddies;
  double least_radius, largest_radius;
  double drift;  ///< m/s, largest of each component
  int hours;     ///< 0: static
};

std::vector<Eddy> eddies_of(const SeaPlan& sea, Dice& dice) {
  std::vector<Eddy> all(static_cast<std::size_t>(sea.eddies));
  for (auto& e : all) {
    e.x = dice.between(-sea.half_east, sea.half_east);
    e.y = dice.between(-sea.half_north, sea.half_north);
    e.radius = dice.between(sea.least_radius, sea.largest_radius);
    e.speed = dice.between(0.1, 0.35) * (dice.roll() < 0.5 ? 1 : -1);
    e.east = dice.between(-sea.drift, sea.drift);
    e.north = dice.between(-sea.drift, sea.drift);
  }
  return all;
}

ocean::GriddedField field_of(const SeaPlan& sea, const std::vector<Eddy>& all) {
  const bool moves = sea.hours > 0;
  const double per_lon = kMetresPerDegree * std::cos(kMiddleLat * kPi / 180);
  ocean::GridAxes axes{
      moves ? test::steps(kT0, 3600, static_cast<std::size_t>(sea.hours) + 1) : std::vector<double>{0.0},
      {0.0},
      {},
      {},
      moves,
      false};
  const int rows = static_cast<int>(std::ceil(sea.half_north / kMetresPerDegree * kCellsPerDegree)) + 20;
  const int columns = static_cast<int>(std::ceil(sea.half_east / per_lon * kCellsPerDegree)) + 20;
  for (int j = -rows; j <= rows; ++j) axes.lats_deg.push_back(kMiddleLat + j / kCellsPerDegree);
  for (int i = -columns; i <= columns; ++i) axes.lons_deg.push_back(kMiddleLon + i / kCellsPerDegree);
  auto grid = test::make_grid(std::move(axes), [&](double lat, double lon, double, double t) {
    const double age = moves ? t - kT0 : 0.0;
    double east = 0, north = 0;
    for (const auto& e : all) {
      const double x = (lon - kMiddleLon) * per_lon - e.x - e.east * age;
      const double y = (lat - kMiddleLat) * kMetresPerDegree - e.y - e.north * age;
      const double r2 = (x * x + y * y) / (e.radius * e.radius);
      if (r2 > 16) continue;
      const double swirl = e.speed * std::exp(0.5 * (1 - r2)) / e.radius;
      east -= swirl * y;
      north += swirl * x;
    }
    return std::pair{east, north};
  });
  return ocean::GriddedField{std::move(grid), {}};
}

ocean::GriddedField field_of(const SeaPlan& sea, Dice& dice) { return field_of(sea, eddies_of(sea, dice)); }

GeoPoint offset_from(GeoPoint p, double bearing, double metres) {
  return destination(p, Bearing{Radians{bearing}}, Metres{metres});
}

/// A round island of sixteen corners.
chart::Area island(GeoPoint centre, double radius, int number) {
  chart::Area area{"island " + std::to_string(number), {}};
  for (int i = 0; i < 16; ++i) area.vertices.push_back(offset_from(centre, 2 * kPi * i / 16, radius));
  return area;
}

/// Islands between start and goal, the first on the straight way; none within 15 % of the way, or 40 km, of either end.
std::vector<chart::Area> islands_between(GeoPoint from, GeoPoint to, int count, double least, double largest,
                                         Dice& dice) {
  const auto way = geodesic(from, to);
  const double bearing = way.departing.from_north().si(), length = way.length.si();
  std::vector<chart::Area> all;
  while (static_cast<int>(all.size()) < count) {
    const bool first = all.empty();
    const double radius = dice.between(least, largest);
    const double along = dice.between(first ? 0.35 : 0.0, first ? 0.65 : 1.0) * length;
    const double across = first ? dice.between(-0.3, 0.3) * radius : dice.between(-0.3, 0.3) * length;
    const auto centre = offset_from(offset_from(from, bearing, along), bearing + kPi / 2, across);
    const double room = radius + std::min(40e3, 0.15 * length);
    if (distance(centre, from).si() < room || distance(centre, to).si() < room) continue;
    all.push_back(island(centre, radius, static_cast<int>(all.size()) + 1));
  }
  return all;
}

std::string numbered(const char* kind, double speed, int i, bool islands) {
  char text[64];
  std::snprintf(text, sizeof text, "%s %.1f m/s %02d%s", kind, speed, i + 1, islands ? " islands" : "");
  return text;
}

}  // namespace

planning::Problem problem_of(GeoPoint from, GeoPoint to, MetresPerSecond speed) {
  planning::Problem p;
  p.start = {from, kT0};
  p.goal = planning::PointGoal{to, Metres{2000}};
  p.glider.name = "suite";
  p.glider.horizontal_speed = p.glider.believed_speed = speed;
  p.schedule.stint = p.schedule.first_stint = Seconds{8 * 3600.0};
  return p;
}

Case::Case(std::string name_, planning::Problem problem_, ocean::GriddedField field, std::vector<chart::Area> islands)
    : name{std::move(name_)},
      problem{std::move(problem_)},
      gridded_{std::make_shared<ocean::GriddedField>(std::move(field))},
      has_islands_{!islands.empty()} {
  chart_ = islands.empty() ? std::make_shared<chart::Chart>()
                           : std::make_shared<chart::Chart>(chart::ChartSources{nullptr, {}, std::move(islands)});
}
Case::Case(std::string name_, planning::Problem problem_, ocean::AnalyticField field)
    : name{std::move(name_)},
      problem{std::move(problem_)},
      analytic_{std::make_shared<ocean::AnalyticField>(std::move(field))},
      chart_{std::make_shared<chart::Chart>()} {}
Case::Case(std::string name_, planning::Problem problem_, ocean::Forecast forecast)
    : name{std::move(name_)},
      problem{std::move(problem_)},
      forecast_{std::move(forecast)},
      chart_{std::make_shared<chart::Chart>()} {}

ocean::Ocean Case::ocean() const {
  if (forecast_) return forecast_->ocean();
  if (gridded_) return {*gridded_, *gridded_};
  return {*analytic_, *analytic_};
}

std::vector<Case> static_cases(MetresPerSecond speed, int count) {
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    Dice dice{0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(i + 1)};
    for (int k = 0; k < 16; ++k) dice.roll();
    const SeaPlan sea{620e3, 620e3, 60, 28e3, 62e3, 0, 0};
    auto field = field_of(sea, dice);
    const double bearing = dice.between(0, 2 * kPi);
    const auto from = offset_from(geo_point(kMiddleLat, kMiddleLon), bearing + kPi, kLongWay / 2);
    const auto to =
        offset_from(from, geodesic(from, geo_point(kMiddleLat, kMiddleLon)).departing.from_north().si(), kLongWay);
    auto problem = problem_of(from, to, speed);
    problem.horizon_s = kT0 + planning::automatic_horizon(problem).count();
    const bool rocky = i % 2 == 1;
    problem.coast_margin = Metres{rocky ? 2000.0 : 0.0};
    auto islands = rocky ? islands_between(from, to, 6, 10e3, 45e3, dice) : std::vector<chart::Area>{};
    cases.emplace_back(numbered("static", speed.si(), i, rocky), problem, std::move(field), std::move(islands));
  }
  return cases;
}

std::vector<Case> dynamic_cases(MetresPerSecond speed, int count) {
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    Dice dice{0xD1B54A32D192ED03ULL * static_cast<std::uint64_t>(i + 1)};
    for (int k = 0; k < 16; ++k) dice.roll();
    const int hours = i % 2 == 0 ? 72 : 96;
    const SeaPlan sea{280e3, 280e3, 24, 15e3, 40e3, 0.05, hours};
    auto field = field_of(sea, dice);
    const auto from = offset_from(geo_point(kMiddleLat, kMiddleLon), dice.between(0, 2 * kPi), dice.between(0, 60e3));
    // As far as half again what still water allows: no method arrives, the distance left counts.
    const auto to = offset_from(from, dice.between(0, 2 * kPi), 1.5 * speed.si() * hours * 3600);
    auto problem = problem_of(from, to, speed);
    problem.schedule.stint = problem.schedule.first_stint = Seconds{(hours * 3600 - 12 * 900) / 12.0};
    problem.horizon_s = kT0 + hours * 3600.0 + 1;
    const bool rocky = i % 3 == 2;
    problem.coast_margin = Metres{rocky ? 2000.0 : 0.0};
    auto islands = rocky ? islands_between(from, to, 4, 4e3, 15e3, dice) : std::vector<chart::Area>{};
    cases.emplace_back(numbered("dynamic", speed.si(), i, rocky), problem, std::move(field), std::move(islands));
  }
  return cases;
}

Case ensemble_case(MetresPerSecond speed, int member, int hours) {
  Dice dice{0xA0761D6478BD642FULL};
  for (int k = 0; k < 16; ++k) dice.roll();
  const SeaPlan sea{620e3, 620e3, 60, 28e3, 62e3, hours > 0 ? 0.05 : 0.0, hours};
  auto eddies = eddies_of(sea, dice);
  Dice own{0xE7037ED1A0B428DBULL * static_cast<std::uint64_t>(member + 1)};
  for (int k = 0; k < 16; ++k) own.roll();
  if (member > 0)
    for (auto& e : eddies) {
      e.x += own.between(-30e3, 30e3);
      e.y += own.between(-30e3, 30e3);
      e.speed *= own.between(0.7, 1.3);
    }
  const auto middle = geo_point(kMiddleLat, kMiddleLon);
  const auto from = offset_from(middle, 0.9 + kPi, kLongWay / 2);
  auto problem =
      problem_of(from, offset_from(from, geodesic(from, middle).departing.from_north().si(), kLongWay), speed);
  problem.coast_margin = Metres{0};
  problem.horizon_s = kT0 + planning::automatic_horizon(problem).count();
  return {numbered("member", speed.si(), member, false), problem, field_of(sea, eddies)};
}

std::vector<Case> jet_cases() {
  constexpr double kUnit = 20e3, kSpeed = 0.6;
  const auto origin = geo_point(36.0, -60.0);
  ocean::AnalyticSpec spec;
  spec.kind = "jet";
  spec.origin = origin;
  spec.length_scale = Metres{kUnit};
  spec.speed_scale = MetresPerSecond{kSpeed};
  const auto at = [&](double x, double y) { return offset_from(origin, std::atan2(x, y), std::hypot(x, y) * kUnit); };
  ocean::Coverage box;
  const double half_lat = 6 * kUnit / LocalMetric::at(origin.lat.radians()).meridian_radius;
  const double unit_lon = kUnit / LocalMetric::at(origin.lat.radians()).parallel_radius;
  box.south = origin.lat.radians() - half_lat;
  box.north = origin.lat.radians() + half_lat;
  box.west = origin.lon.radians() - unit_lon;
  box.east = origin.lon.radians() + 13 * unit_lon;
  const auto field =
      ocean::AnalyticField::make(spec, Instant{std::chrono::milliseconds{static_cast<std::int64_t>(kT0 * 1000)}}, box);
  std::vector<Case> cases;
  for (const double y : {-3.0, -1.5, 0.0, 1.5, 3.0}) {
    auto problem = problem_of(at(0, y), at(10, 0), MetresPerSecond{0.5 * kSpeed});
    problem.goal = planning::PointGoal{at(10, 0), Metres{500}};
    problem.coast_margin = Metres{0};
    problem.horizon_s = kT0 + planning::automatic_horizon(problem).count();
    char name[32];
    std::snprintf(name, sizeof name, "jet (0, %.1f)", y);
    cases.emplace_back(name, problem, *field);
  }
  return cases;
}

std::vector<Case> analytic_cases() {
  std::vector<Case> cases;
  for (auto& sea : test::analytic_seas()) cases.emplace_back(sea.name, sea.problem, sea.field);
  return cases;
}

}  // namespace glidehelm::suite
