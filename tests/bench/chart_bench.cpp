#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/chart/chart.hpp"
#include "core/chart/coast.hpp"

// What planners ask of a chart, beside a coast as detailed as GSHHG's: twenty islands with 5000 corners each (some 100 m
// apart) in a sea of 7° by 4° around 28° N.

using namespace glidehelm;

namespace {

constexpr double kRad = kPi / 180;

std::shared_ptr<const chart::Coast> islands() {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> wobble{-1, 1};
  const chart::CoastArea area{-190'000'000, -120'000'000, 260'000'000, 300'000'000};
  std::vector<chart::CoastRing> rings;
  for (int k = 0; k < 20; ++k) {
    chart::CoastRing ring;
    const double x0 = 0.6e7 + 1.2e7 * (k % 5) + 0.2e7 * wobble(random),
                 y0 = 26.5e7 + 1e7 * (k / 5) + 0.1e7 * wobble(random);
    double rough = 0;
    for (int i = 0; i < 5000; ++i) {
      rough = 0.98 * rough + 0.004 * wobble(random);
      const double a = 2 * kPi * i / 5000, r = 0.3e7 * (0.7 + 0.2 * std::sin(3 * a + k) + rough);
      ring.points.push_back(
          {static_cast<std::int32_t>(x0 + r * std::cos(a)), static_cast<std::int32_t>(y0 + r * std::sin(a))});
      ring.cut.push_back(false);
    }
    rings.push_back(std::move(ring));
  }
  return *chart::Coast::make(area, "made by a benchmark", std::move(rings));
}

const std::shared_ptr<const chart::Coast>& coast() {
  static const auto kCoast = islands();
  return kCoast;
}
const chart::Chart& sea() {
  static const chart::Chart kSea{chart::ChartSources{coast(), {}, {}}};
  return kSea;
}

struct Way {
  double lat, lon, lat1, lon1;
};

/// Ways of `length` metres whose start has a clearance between the two.
std::vector<Way> ways(double least, double most, double length) {
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> lat{26.2 * kRad, 29.8 * kRad}, lon{-18.8 * kRad, -12.2 * kRad},
      turn{0, 2 * kPi};
  std::vector<Way> all;
  while (all.size() < 1024) {
    const double y = lat(random), x = lon(random), a = turn(random), r = length / 6.371e6;
    const double clearance = sea().clearance(y, x);
    if (clearance < least || clearance > most) continue;
    all.push_back({y, x, y + r * std::cos(a), x + r * std::sin(a) / std::cos(y)});
  }
  return all;
}

template <class Ask>
void each(benchmark::State& state, const std::vector<Way>& all, const Ask& ask) {
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ask(all[k]));
    k = (k + 1) % all.size();
  }
  state.SetItemsProcessed(state.iterations());
}

void clearance_at_least(benchmark::State& state) {
  each(state, ways(-60'000, 60'000, 0), [](const Way& w) { return sea().clearance_at_least(w.lat, w.lon); });
}
BENCHMARK(clearance_at_least);

void segment_far(benchmark::State& state) {
  // ways of a twentieth of a stint, 15 km or more from land: the two discs of the raster cover them
  each(state, ways(15'000, 60'000, 5'000),
       [](const Way& w) { return sea().segment_is_clear(w.lat, w.lon, w.lat1, w.lon1, 2'000); });
}
BENCHMARK(segment_far);

void segment_far_and_long(benchmark::State& state) {
  each(state, ways(15'000, 60'000, 30'000),
       [](const Way& w) { return sea().segment_is_clear(w.lat, w.lon, w.lat1, w.lon1, 2'000); });
}
BENCHMARK(segment_far_and_long);

void segment_near(benchmark::State& state) {
  each(state, ways(2'000, 4'000, 5'000),
       [](const Way& w) { return sea().segment_is_clear(w.lat, w.lon, w.lat1, w.lon1, 2'000); });
}
BENCHMARK(segment_near);

void clearance_far(benchmark::State& state) {
  each(state, ways(15'000, 60'000, 0), [](const Way& w) { return sea().clearance(w.lat, w.lon); });
}
BENCHMARK(clearance_far);

void clearance_near(benchmark::State& state) {
  each(state, ways(-2'000, 4'000, 0), [](const Way& w) { return sea().clearance(w.lat, w.lon); });
}
BENCHMARK(clearance_near);

void is_land_near(benchmark::State& state) {
  each(state, ways(-2'000, 4'000, 0), [](const Way& w) { return sea().is_land(GeoPoint::from_kernel(w.lat, w.lon)); });
}
BENCHMARK(is_land_near);

void chart_building(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(chart::Chart{chart::ChartSources{coast(), {}, {}}});
}
BENCHMARK(chart_building)->Unit(benchmark::kMillisecond);

void coast_parsing(benchmark::State& state) {
  const std::string text = coast()->text();
  for (auto _ : state) benchmark::DoNotOptimize(chart::Coast::parse(text));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(coast_parsing)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
