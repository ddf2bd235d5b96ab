#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <random>
#include <vector>

#include "core/ocean/forecast.hpp"
#include "tests/support/fields.hpp"

// Current evaluations per second: `GriddedField::advance` (eighteen lanes, steps of half an hour, stints of eight hours)
// against the peer of product.md 10, a plain scalar bilinear loop over interleaved floats. Both run over the same field
// and the same places, in one run; main prints the ratio, and the rate as a share of the kernel's own limit: the same work with
// every stint from one place, so that all it reads stays in the first cache. Then what a field and a forecast allocate beside the grid.

using namespace glidehelm;

namespace {

std::size_t g_allocated{};  ///< bytes that operator new has given and not got back

}  // namespace

// Every allocation of this program, counted: the size stands before the block.
void* operator new(std::size_t size) {
  constexpr std::size_t kBefore = 64;  // keeps any alignment
  auto* const block =
      static_cast<std::size_t*>(std::aligned_alloc(kBefore, (size + 2 * kBefore - 1) / kBefore * kBefore));
  if (block == nullptr) throw std::bad_alloc{};
  *block = size;
  g_allocated += size;
  return reinterpret_cast<char*>(block) + kBefore;
}
void operator delete(void* at) noexcept {
  if (at == nullptr) return;
  auto* const block = reinterpret_cast<std::size_t*>(static_cast<char*>(at) - 64);
  g_allocated -= *block;
  std::free(block);
}
void operator delete(void* at, std::size_t) noexcept { operator delete(at); }

namespace {

constexpr int kLanes = 18, kSteps = 16;
constexpr double kStep = 1800.0;
constexpr int kStarts = 512;

/// Eddies of 50 km on a grid of 1/20°, 9° by 9° around 42° N; `times` hourly fields in which they drift.
ocean::Grid eddies(std::size_t times) {
  const auto degrees = [](std::size_t n) { return static_cast<double>(n) / 20.0; };
  ocean::GridAxes axes{test::steps(0, 3600, times), {0.0}, {}, {}, times > 1, false};
  for (std::size_t k = 0; k <= 180; ++k) {
    axes.lats_deg.push_back(37.5 + degrees(k));
    axes.lons_deg.push_back(-17.0 + degrees(k));
  }
  return test::make_grid(std::move(axes), [](double lat, double lon, double, double t) {
    const double x = 7.0 * lon, y = 9.0 * lat + t / 40000.0;
    return std::pair{0.35 * std::sin(y), 0.35 * std::sin(x)};
  });
}

struct Start {
  double lat, lon, t;
};
std::vector<Start> starts(double last_s) {
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> lat{38.5, 45.5}, lon{-16, -9}, t{0, std::max(1.0, last_s - kSteps * kStep)};
  std::vector<Start> all(kStarts);
  for (auto& start : all) start = {lat(random) * kPi / 180, lon(random) * kPi / 180, t(random)};
  return all;
}

ocean::Lanes lanes_at(const Start& start) {
  ocean::Lanes lanes;
  lanes.count = kLanes;
  for (std::size_t k = 0; k < kLanes; ++k) {
    const double heading = 2 * kPi * static_cast<double>(k) / kLanes;
    lanes.lat[k] = start.lat;
    lanes.lon[k] = start.lon;
    lanes.water_east[k] = 0.3 * std::sin(heading);
    lanes.water_north[k] = 0.3 * std::cos(heading);
    lanes.lost[k] = 0;
  }
  return lanes;
}

double fly(const ocean::GriddedField& field, const std::vector<Start>& from) {
  double check = 0;
  for (const auto& start : from) {
    auto lanes = lanes_at(start);
    for (int step = 0; step < kSteps; ++step) field.advance(lanes, start.t + step * kStep, kStep);
    check += lanes.lat[3] + lanes.lon[5];
  }
  return check;
}
constexpr double kFlown = 4.0 * kLanes * kSteps * kStarts;

/// The places that the lanes pass, in their order: what the peer evaluates.
struct Visit {
  double lat, lon, t;
};
std::vector<Visit> visits(const ocean::GriddedField& field, const std::vector<Start>& from) {
  std::vector<Visit> all;
  for (const auto& start : from) {
    auto lanes = lanes_at(start);
    for (int step = 0; step < kSteps; ++step) {
      const double t = start.t + step * kStep;
      for (const double dt : {0.0, 0.5 * kStep, 0.5 * kStep, kStep})
        for (std::size_t k = 0; k < kLanes; ++k) all.push_back({lanes.lat[k], lanes.lon[k], t + dt});
      field.advance(lanes, t, kStep);
    }
  }
  return all;
}

/// The peer: uniform axes, one place after the other, nothing checked.
struct Plain {
  const float* values;
  std::size_t rows, columns;
  double south, west, per_degree;
  double first_s, per_second;
  bool timed;

  [[nodiscard]] std::pair<float, float> at(const Visit& p) const {
    const double y = (p.lat - south) * per_degree, x = (p.lon - west) * per_degree;
    const auto j = static_cast<std::size_t>(y), i = static_cast<std::size_t>(x);
    const auto fy = static_cast<float>(y - static_cast<double>(j)), fx = static_cast<float>(x - static_cast<double>(i));
    const std::size_t corner = 2 * (j * columns + i);
    if (!timed) return plane(values + corner, fx, fy);
    const double w = (p.t - first_s) * per_second;
    const auto k = static_cast<std::size_t>(w);
    const auto ft = static_cast<float>(w - static_cast<double>(k));
    const auto a = plane(values + 2 * k * rows * columns + corner, fx, fy);
    const auto b = plane(values + 2 * (k + 1) * rows * columns + corner, fx, fy);
    return {a.first + ft * (b.first - a.first), a.second + ft * (b.second - a.second)};
  }
  [[nodiscard]] std::pair<float, float> plane(const float* p, float fx, float fy) const {
    const float* q = p + 2 * columns;
    const float u0 = p[0] + fx * (p[2] - p[0]), u1 = q[0] + fx * (q[2] - q[0]);
    const float v0 = p[1] + fx * (p[3] - p[1]), v1 = q[1] + fx * (q[3] - q[1]);
    return {u0 + fy * (u1 - u0), v0 + fy * (v1 - v0)};
  }
};

Plain plain_over(const ocean::Grid& grid) {
  const auto& axes = grid.axes;
  return {grid.values.data(),
          axes.lats_deg.size(),
          axes.lons_deg.size(),
          axes.lats_deg.front() * kPi / 180,
          axes.lons_deg.front() * kPi / 180,
          20.0 * 180 / kPi,
          axes.times_s.front(),
          1.0 / 3600,
          axes.has_time};
}

struct Setting {
  ocean::Grid grid;
  ocean::GriddedField field;
  std::vector<Start> from;
  std::vector<Visit> places;
  explicit Setting(std::size_t times)
      : grid{eddies(times)}, field{grid, {}}, from{starts(grid.axes.times_s.back())}, places{visits(field, from)} {}
};
const Setting& setting(bool hourly) {
  static const Setting still{1}, moving{73};
  return hourly ? moving : still;
}

double sum_plain(const Setting& s) {
  const Plain plain = plain_over(s.grid);
  float east = 0, north = 0;
  for (const auto& place : s.places) {
    const auto [u, v] = plain.at(place);
    east += u;
    north += v;
  }
  return static_cast<double>(east) + static_cast<double>(north);
}

void advance(benchmark::State& state) {
  const auto& s = setting(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(fly(s.field, s.from));
  state.counters["evaluations"] =
      benchmark::Counter(kFlown * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(advance)->ArgName("hourly")->Arg(0)->Arg(1);

void plain_scalar_loop(benchmark::State& state) {
  const auto& s = setting(state.range(0) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(sum_plain(s));
  state.counters["evaluations"] = benchmark::Counter(
      static_cast<double>(s.places.size()) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(plain_scalar_loop)->ArgName("hourly")->Arg(0)->Arg(1);

/// Best rate of seven runs, taken alternately so that both see the same machine.
template <class F>
double seconds_of(const F& work) {
  const auto begin = std::chrono::steady_clock::now();
  benchmark::DoNotOptimize(work());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
void print_ratio(bool hourly) {
  const auto& s = setting(hourly);
  const std::vector<Start> one_place(s.from.size(), s.from.front());
  double ours = 1e9, plain = 1e9, cached = 1e9;
  for (int run = 0; run < 7; ++run) {
    ours = std::min(ours, seconds_of([&] { return fly(s.field, s.from); }));
    plain = std::min(plain, seconds_of([&] { return sum_plain(s); }));
    cached = std::min(cached, seconds_of([&] { return fly(s.field, one_place); }));
  }
  const double ours_rate = kFlown / ours, plain_rate = static_cast<double>(s.places.size()) / plain;
  std::printf(
      "%s field: advance %.1f M evaluations/s (%.0f %% of %.1f M/s from the first cache), plain scalar loop %.1f M/s, "
      "ratio of times "
      "%.2f\n",
      hourly ? "hourly" : "static", ours_rate * 1e-6, 100 * cached / ours, kFlown / cached * 1e-6, plain_rate * 1e-6,
      plain_rate / ours_rate);
}

/// What a field and a whole forecast hold beside the grid they read, which is a mapping in service. `make` answers with what shall live.
template <class F>
void print_memory(const char* what, const ocean::Grid& grid, const F& make) {
  const std::size_t before = g_allocated;
  const auto alive = make();
  const double grid_bytes = static_cast<double>(grid.values.size() * sizeof(float));
  std::printf("%s: %.1f MB of numbers, %.2f MB beside them, %.3f times the floats in all\n", what, grid_bytes * 1e-6,
              static_cast<double>(g_allocated - before) * 1e-6,
              (grid_bytes + static_cast<double>(g_allocated - before)) / grid_bytes);
}
void print_memory() {
  const auto& hourly = setting(true).grid;
  print_memory("field, hourly", hourly, [&] { return ocean::GriddedField{ocean::view_of(hourly), {}}; });
  ocean::GridAxes axes{test::steps(0, 3600, 24), test::steps(0, 50, 20), {}, {}, true, true};
  axes.lats_deg = test::steps(37.5, 0.05, 121);
  axes.lons_deg = test::steps(-17.0, 0.05, 121);
  const auto deep = test::make_grid(std::move(axes), [](double lat, double lon, double z, double) {
    return std::pair{0.3 * std::sin(9 * lat) * std::exp(-z / 500), 0.3 * std::sin(7 * lon)};
  });
  print_memory("forecast, hourly with 20 levels", deep, [&] {
    return ocean::Forecast::prepare(ocean::view_of(deep), ocean::DiveProfile{Metres{20}, Metres{200}}, {}, {});
  });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  print_ratio(false);
  print_ratio(true);
  print_memory();
  return 0;
}
