#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "core/ocean/gridded.hpp"
#include "tests/support/fields.hpp"

// Current evaluations per second: `GriddedField::advance` (eighteen lanes, steps of half an hour, stints of eight hours)
// against the peer of product.md 10, a plain scalar bilinear loop over interleaved floats. Both run over the same field
// and the same places, in one run; main prints the ratio.

using namespace glidehelm;

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
  double ours = 1e9, plain = 1e9;
  for (int run = 0; run < 7; ++run) {
    ours = std::min(ours, seconds_of([&] { return fly(s.field, s.from); }));
    plain = std::min(plain, seconds_of([&] { return sum_plain(s); }));
  }
  const double ours_rate = kFlown / ours, plain_rate = static_cast<double>(s.places.size()) / plain;
  std::printf("%s field: advance %.1f M evaluations/s, plain scalar loop %.1f M/s, ratio of times %.2f\n",
              hourly ? "hourly" : "static", ours_rate * 1e-6, plain_rate * 1e-6, plain_rate / ours_rate);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  print_ratio(false);
  print_ratio(true);
  return 0;
}
