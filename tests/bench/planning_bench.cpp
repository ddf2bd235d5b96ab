#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <string_view>
#include <vector>

#include "core/ocean/gridded.hpp"
#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/registry.hpp"
#include "tests/bench/case_suite.hpp"
#include "tests/support/fields.hpp"

// The 650 km case of product.md 10: a field of 1/20° with eddies of 28–62 km radius, static or hourly over three days, M = 18,
// stints of 8 h, one thread. The hourly field is held after its third day, as a mission does by default; a way of 650 km
// takes weeks. The peer is a plain scalar bilinear loop over interleaved floats, over places that the search evaluates
// in the search's order: what its current evaluations alone would cost. Both are timed alternately in one run; main
// prints the table, unless single benchmarks are asked for (--benchmark_filter=…): then nothing else runs, for a profiler.

using namespace glidehelm;

namespace {

constexpr double kSouth = 36.0, kWest = -18.0, kCellsPerDegree = 20.0;
constexpr std::size_t kRows = 201, kColumns = 241;
constexpr double kT0 = 1.7e9;
constexpr int kHours = 73;

struct Eddy {
  double lat, lon, radius_m, speed, drift_east, drift_north;
};

/// Eddies whose azimuthal speed is greatest at their radius; neighbours turn either way.
std::vector<Eddy> eddies() {
  std::mt19937_64 random{20};
  std::uniform_real_distribution<double> lat{36.5, 45.5}, lon{-17.5, -6.5}, radius{28e3, 62e3}, speed{0.1, 0.35},
      drift{-0.05, 0.05};
  std::vector<Eddy> all(40);
  for (auto& e : all)
    e = {lat(random),   lon(random),  radius(random), speed(random) * (random() % 2 == 0 ? 1 : -1),
         drift(random), drift(random)};
  return all;
}

ocean::Grid grid_of(bool hourly) {
  ocean::GridAxes axes{
      hourly ? test::steps(kT0, 3600, kHours) : std::vector<double>{0.0}, {0.0}, {}, {}, hourly, false};
  for (std::size_t k = 0; k < kRows; ++k) axes.lats_deg.push_back(kSouth + static_cast<double>(k) / kCellsPerDegree);
  for (std::size_t k = 0; k < kColumns; ++k) axes.lons_deg.push_back(kWest + static_cast<double>(k) / kCellsPerDegree);
  const auto all = eddies();
  return test::make_grid(std::move(axes), [&](double lat, double lon, double, double t) {
    double east = 0, north = 0;
    const double age = hourly ? t - kT0 : 0.0;
    const double per_lon = 111.2e3 * std::cos(41.0 * kPi / 180), per_lat = 111.1e3;
    for (const auto& e : all) {
      const double x = (lon - e.lon) * per_lon - e.drift_east * age, y = (lat - e.lat) * per_lat - e.drift_north * age;
      const double r2 = (x * x + y * y) / (e.radius_m * e.radius_m);
      if (r2 > 16) continue;
      const double swirl = e.speed * std::exp(0.5 * (1 - r2)) / e.radius_m;
      east -= swirl * y;
      north += swirl * x;
    }
    return std::pair{east, north};
  });
}

/// 650 km from south-west to north-east.
planning::Problem problem(double cell_m) {
  planning::Problem p;
  p.start = {geo_point(38.4, -15.6), kT0};
  p.goal = planning::PointGoal{destination(p.start.fix, Bearing{degrees(53)}, Metres{650e3}), Metres{2000}};
  p.glider.horizontal_speed = p.glider.believed_speed = MetresPerSecond{0.3};
  p.schedule.stint = p.schedule.first_stint = Seconds{8 * 3600.0};
  p.headings = 18;
  p.cell = Metres{cell_m};
  p.coast_margin = Metres{0};
  p.horizon_s = kT0 + 3 * planning::still_water_time(p).count();
  return p;
}

struct Setting {
  ocean::Grid grid;
  ocean::GriddedField field;
  ocean::Ocean ocean;
  chart::Chart chart;
  explicit Setting(bool hourly) : grid{grid_of(hourly)}, field{grid, {}}, ocean{field, field} {}
};
const Setting& setting(bool hourly) {
  static const Setting still{false}, moving{true};
  return hourly ? moving : still;
}

/// A current evaluation of the search.
struct Visit {
  double lat, lon, t;
};

/// The field, writing down where its lanes go: the places that the peer evaluates, in the search's own order.
class Recorder {
 public:
  explicit Recorder(const ocean::GriddedField& field) : field_{field} {}
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t_s) const {
    return field_.sample(p, z, t_s);
  }
  [[nodiscard]] ocean::Coverage coverage() const { return field_.coverage(); }
  [[nodiscard]] MetresPerSecond fastest() const { return field_.fastest(); }
  /// Three expansions in four go by unrecorded: 64 advances are about eight stints.
  void advance(ocean::Lanes& lanes, double t_s, double dt) const {
    if (calls_++ / 64 % 4 == 0)
      for (const double ahead : {0.0, 0.5, 0.5, 1.0})
        for (std::size_t k = 0; k < static_cast<std::size_t>(lanes.count); ++k)
          places_.push_back({lanes.lat[k], lanes.lon[k], t_s + ahead * dt});
    field_.advance(lanes, t_s, dt);
  }
  [[nodiscard]] const std::vector<Visit>& places() const { return places_; }

 private:
  const ocean::GriddedField& field_;
  mutable std::uint64_t calls_{};
  mutable std::vector<Visit> places_;
};

std::vector<Visit> visits(const Setting& s, const planning::Problem& p) {
  const Recorder recorder{s.field};
  benchmark::DoNotOptimize(planning::search(p, {recorder, recorder}, s.chart, {}));
  return recorder.places();
}

/// The peer: uniform axes, one place after the other, nothing checked but the end of time (the last field is held).
double plain_loop(const Setting& s, const std::vector<Visit>& places, bool hourly) {
  const float* const values = s.grid.values.data();
  constexpr double south = kSouth * kPi / 180, west = kWest * kPi / 180, per_radian = kCellsPerDegree * 180 / kPi;
  const auto plane = [](const float* p, float fx, float fy) {
    const float* q = p + 2 * kColumns;
    const float u0 = p[0] + fx * (p[2] - p[0]), u1 = q[0] + fx * (q[2] - q[0]);
    const float v0 = p[1] + fx * (p[3] - p[1]), v1 = q[1] + fx * (q[3] - q[1]);
    return std::pair{u0 + fy * (u1 - u0), v0 + fy * (v1 - v0)};
  };
  float east = 0, north = 0;
  for (const auto& place : places) {
    const double y = (place.lat - south) * per_radian, x = (place.lon - west) * per_radian;
    const auto j = static_cast<std::size_t>(y), i = static_cast<std::size_t>(x);
    const auto fy = static_cast<float>(y - static_cast<double>(j)), fx = static_cast<float>(x - static_cast<double>(i));
    const float* corner = values + 2 * (j * kColumns + i);
    const double w = hourly ? (place.t - kT0) * (1.0 / 3600) : kHours;
    if (w >= kHours - 1) {
      const auto [u, v] = plane(hourly ? corner + 2 * (kHours - 1) * kRows * kColumns : corner, fx, fy);
      east += u;
      north += v;
      continue;
    }
    const auto k = static_cast<std::size_t>(w);
    const auto ft = static_cast<float>(w - static_cast<double>(k));
    const float* slice = corner + 2 * k * kRows * kColumns;
    const auto a = plane(slice, fx, fy), b = plane(slice + 2 * kRows * kColumns, fx, fy);
    east += a.first + ft * (b.first - a.first);
    north += a.second + ft * (b.second - a.second);
  }
  return static_cast<double>(east) + static_cast<double>(north);
}

constexpr double kTwentieth = 5560.0;  ///< metres of 1/20° of latitude

void cts_astar_650_km(benchmark::State& state) {
  const auto& s = setting(state.range(0) != 0);
  const auto p = problem(state.range(1) != 0 ? kTwentieth : 0.0);
  planning::CtsSearch found;
  for (auto _ : state) {
    found = planning::search(p, s.ocean, s.chart, {});
    benchmark::DoNotOptimize(found);
  }
  state.counters["expansions"] = static_cast<double>(found.statistics.expansions);
  state.counters["evaluations"] = static_cast<double>(found.statistics.current_evaluations);
}
BENCHMARK(cts_astar_650_km)
    ->ArgNames({"hourly", "twentieth"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

void whole_answer_650_km(benchmark::State& state) {
  const auto& s = setting(state.range(0) != 0);
  const auto p = problem(0.0);
  const auto best = planning::planner_named("best");
  const std::array<ocean::Ocean, 1> members{s.ocean};
  for (auto _ : state) benchmark::DoNotOptimize(best->plan(p, members, s.chart, {}, {}));
}
BENCHMARK(whole_answer_650_km)->ArgName("hourly")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// The second static case of the suite: six islands, a margin of 2 km, U = 0.4 m/s.
const suite::Case& among_islands() {
  static const auto cases = suite::static_cases(MetresPerSecond{0.4}, 2);
  return cases.back();
}
void cts_astar_among_islands(benchmark::State& state) {
  const auto& c = among_islands();
  for (auto _ : state) benchmark::DoNotOptimize(planning::search(c.problem, c.ocean(), c.chart(), {}));
}
BENCHMARK(cts_astar_among_islands)->Unit(benchmark::kMillisecond);
void whole_answer_among_islands(benchmark::State& state) {
  const auto& c = among_islands();
  const auto best = planning::planner_named("best");
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  for (auto _ : state) benchmark::DoNotOptimize(best->plan(c.problem, members, c.chart(), {}, {}));
}
BENCHMARK(whole_answer_among_islands)->Unit(benchmark::kMillisecond);

/// Wall and processor seconds; the ratio is of processor time, so that a busy machine does not spoil it.
struct Took {
  double wall{1e9}, processor{1e9};
};
template <class F>
void best_of(Took& best, const F& work) {
  const auto begin = std::chrono::steady_clock::now();
  const auto ticks = std::clock();
  benchmark::DoNotOptimize(work());
  best.processor = std::min(best.processor, static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC);
  best.wall = std::min(best.wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

/// Best of seven, taken alternately so that both see the same machine.
void print_row(bool hourly, double cell_m) {
  const auto& s = setting(hourly);
  const auto p = problem(cell_m);
  const auto places = visits(s, p);
  planning::CtsSearch found;
  Took ours, plain;
  for (int run = 0; run < 11; ++run) {
    best_of(ours, [&] { return (found = planning::search(p, s.ocean, s.chart, {})).arrival_s; });
    best_of(plain, [&] { return plain_loop(s, places, hourly); });
  }
  const double rate = static_cast<double>(places.size()) / plain.processor;
  const auto evaluations = static_cast<double>(found.statistics.current_evaluations);
  const std::array<ocean::Ocean, 1> members{s.ocean};
  const auto direct = planning::planner_named("direct")->plan(p, members, s.chart, {}, {});
  const auto plan = planning::planner_named("cts-astar")->plan(p, members, s.chart, {}, {});
  std::printf(
      "%-6s cell %4.2f km: %6.1f ms wall, %6.1f ms processor | %6llu expansions, %6zu labels, %7zu cells, %5.1f MB | "
      "%5.2f M evaluations, %4.1f per "
      "stint | plain loop %5.1f M/s = %5.1f ms | ratio %4.2f | arrives after %6.2f h (flown %6.2f h), direct %s\n",
      hourly ? "hourly" : "static", 1e-3 * found.cell_m, 1e3 * ours.wall, 1e3 * ours.processor,
      static_cast<unsigned long long>(found.statistics.expansions), found.labels, found.cells,
      static_cast<double>(found.memory_bytes) * 1e-6, 1e-6 * evaluations,
      evaluations / static_cast<double>(found.statistics.cost_evaluations), 1e-6 * rate, 1e3 * evaluations / rate,
      ours.processor * rate / evaluations, (found.arrival_s - kT0) / 3600, plan ? (plan->arrival_s - kT0) / 3600 : 0.0,
      direct && direct->reaches_goal() ? (std::to_string((direct->arrival_s - kT0) / 3600) + " h").c_str()
                                       : "does not");
}

struct Named {
  const char* name;
  planning::Guidance guidance;
};
std::vector<Named> guidances() {
  using planning::Heuristic;
  using planning::Weighting;
  std::vector<Named> all;
  for (const auto& [name, heuristic] :
       {std::pair{"straight_line", Heuristic::straight_line}, std::pair{"envelope", Heuristic::envelope}}) {
    all.push_back({name, {heuristic, Weighting::none, 0}});
    for (const double weight : {0.1, 0.5, 1.0}) {
      all.push_back({name, {heuristic, Weighting::constant, weight}});
      all.push_back({name, {heuristic, Weighting::by_depth, weight}});
    }
  }
  return all;
}

/// Heuristics and weightings, at the default cell: the whole search, the heuristic's own making included.
void print_guidances(bool hourly) {
  const auto& s = setting(hourly);
  auto p = problem(0.0);
  double best = 0;
  for (const auto& [name, guidance] : guidances()) {
    p.guidance = guidance;
    planning::CtsSearch found;
    Took took;
    for (int run = 0; run < 5; ++run)
      best_of(took, [&] { return (found = planning::search(p, s.ocean, s.chart, {})).arrival_s; });
    const double hours = (found.arrival_s - kT0) / 3600;
    if (best == 0) best = hours;
    constexpr std::array kWords{"", "static", "dynamic"};
    std::printf("%-6s %-13s %-7s %3.1f: %6llu expansions, %6.1f ms processor | arrives after %6.2f h (%+.2f %%)\n",
                hourly ? "hourly" : "static", name, kWords[static_cast<std::size_t>(guidance.weighting)],
                guidance.weight, static_cast<unsigned long long>(found.statistics.expansions), 1e3 * took.processor,
                hours, 100 * (hours / best - 1));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool all = std::none_of(
      argv, argv + argc, [](const char* word) { return std::string_view{word}.starts_with("--benchmark_filter"); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  if (!all) return 0;
  std::printf("650 km, M = 18, stints of 8 h, U = 0.3 m/s, currents up to %.2f m/s\n",
              setting(false).field.fastest().si());
  for (const bool hourly : {false, true})
    for (const double cell : {0.0, kTwentieth}) print_row(hourly, cell);
  for (const bool hourly : {false, true}) print_guidances(hourly);
  return 0;
}
