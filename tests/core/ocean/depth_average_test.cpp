#include "core/ocean/depth_average.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

namespace {

/// Mean of a function over a dive, by a sum over a hundred thousand slices: an independent way to the closed form.
template <class F>
double by_slices(const F& value, double upper, double lower, double above, double below, double bottom) {
  const int slices = 100000;
  double sum = 0, weight = 0;
  const double end = std::min(lower, bottom);
  for (int i = 0; i < slices; ++i) {
    const double z = end * (i + 0.5) / slices, w = z < upper ? above : below;
    sum += w * value(z);
    weight += w;
  }
  return sum / weight;
}

double dot(const std::vector<double>& weights, const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * values[k];
  return sum;
}

}  // namespace

TEST_CASE("a stint's profile has the densities of the Thesis: outer water twice, inner water 2n times") {
  // 0.3 m/s at 26° sinks at 0.1463 m/s. Four hours: 2·(200 + (n − 1)·180) = 0.1463·14400 m, n = 5.74.
  const auto profile =
      DiveProfile::of_stint(Metres{20}, Metres{200}, MetresPerSecond{0.3}, degrees(26), Seconds{14400});
  const double w = 0.3 * std::tan(26 * kPi / 180), n = 1 + (w * 14400 / 2 - 200) / 180;
  CHECK(profile.upper == Metres{20});
  CHECK(profile.lower == Metres{200});
  CHECK(profile.below / profile.above == Approx(n).epsilon(1e-12));
  // The time under water is that of 2.14: the integral of the density times 2/w.
  CHECK(2 / w * (20 * profile.above + 180 * profile.below) == Approx(14400).epsilon(1e-12));
}

TEST_CASE("a stint too short for the full depth turns where its time is half over") {
  const auto profile = DiveProfile::of_stint(Metres{20}, Metres{200}, MetresPerSecond{0.3}, degrees(26), Seconds{1800});
  const double w = 0.3 * std::tan(26 * kPi / 180);
  CHECK(profile.lower.si() == Approx(w * 900).epsilon(1e-12));
  CHECK(profile.above == profile.below);
  const auto tiny = DiveProfile::of_stint(Metres{20}, Metres{200}, MetresPerSecond{0.3}, degrees(26), Seconds{60});
  CHECK(tiny.upper == tiny.lower);
}

TEST_CASE("weights are the exact integral of the piecewise linear current") {
  const std::vector<double> depths{2, 10, 35, 120, 300};
  const std::vector<double> values{0.9, -0.4, 0.6, 0.1, 2.0};
  const auto current = [&](double z) {
    if (z <= depths[0]) return values[0];
    std::size_t k = 0;
    while (k + 2 < depths.size() && z > depths[k + 1]) ++k;
    return values[k] + (z - depths[k]) / (depths[k + 1] - depths[k]) * (values[k + 1] - values[k]);
  };
  for (const double inner : {1.0, 4.5}) {
    const DiveProfile profile{Metres{20}, Metres{200}, 1, inner};
    for (std::size_t wet = 1; wet <= depths.size(); ++wet) {
      const auto weights = column_weights(depths, wet, profile);
      double sum = 0;
      for (const double weight : weights) sum += weight;
      CHECK(sum == Approx(1).epsilon(1e-14));
      for (std::size_t k = wet; k < depths.size(); ++k) CHECK(weights[k] == 0);
      // The midpoint sum is off by at most half a slice at each of six kinks: 200/1e5 · slope 0.16 / 200 · 6 ≈ 1e-5.
      CHECK(dot(weights, values) == Approx(by_slices(current, 20, 200, 1, inner, depths[wet - 1])).margin(1e-5));
    }
  }
}

TEST_CASE("a current that is linear in depth has the mean of its profile's mean depth") {
  const std::vector<double> depths{0, 50, 100, 200};
  // Mean depth of the profile: (20·10·1 + 180·110·n)/(20 + 180·n).
  for (const double n : {1.0, 3.0, 10.0}) {
    const double mean = (20 * 10 + 180 * 110 * n) / (20 + 180 * n);
    CHECK(dot(column_weights(depths, 4, {Metres{20}, Metres{200}, 1, n}), depths) == Approx(mean).epsilon(1e-13));
  }
}

TEST_CASE("a column shallower than the profile is averaged over its water") {
  const std::vector<double> depths{0, 10, 50};
  // Bottom at 10 m, above the upper turning depth: a plain mean of the upper layer.
  CHECK(dot(column_weights(depths, 2, {Metres{20}, Metres{200}, 1, 5}), {1, 3, 99}) == Approx(2).epsilon(1e-14));
  // Only the surface is wet: its value stands for the column.
  CHECK(dot(column_weights(depths, 1, {Metres{20}, Metres{200}, 1, 5}), {7, 0, 0}) == 7);
  // A mean between 20 m and 40 m does not exist where the water ends at 10 m.
  CHECK(column_weights(depths, 2, DiveProfile::between(Metres{20}, Metres{40})).empty());
  CHECK(column_weights(depths, 1, DiveProfile::between(Metres{20}, Metres{40})).empty());
  CHECK(dot(column_weights(depths, 3, DiveProfile::between(Metres{20}, Metres{40})), {0, 0, 40}) ==
        Approx(20).epsilon(1e-14));  // value at 30 m on the line from 0 at 10 m to 40 at 50 m
}

TEST_CASE("a grid with depths becomes one without, column by column, at every time") {
  GridAxes axes{{0, 3600}, {0, 100, 200}, {0, 1}, {0, 1, 2}, true, true};
  const Grid grid = test::make_grid(axes, [](double lat, double lon, double z, double t) {
    const double floor = lon == 0 ? 200 : lon == 1 ? 100 : -1;
    return z > floor ? std::pair{test::kDry, test::kDry} : std::pair{z / 100 + t / 3600, lat};
  });
  const Grid mean = depth_average(view_of(grid), DiveProfile{Metres{0}, Metres{200}, 1, 1});
  CHECK(mean.axes.depths_m.size() == 1);
  CHECK_FALSE(mean.axes.has_depth);
  CHECK(mean.values.size() == 2 * 2 * 6);
  const auto at = [&](std::size_t t, std::size_t j, std::size_t i) {
    return mean.values.data() + 2 * ((t * 2 + j) * 3 + i);
  };
  CHECK(at(0, 0, 0)[0] == Approx(1.0));  // mean depth 100 m
  CHECK(at(1, 1, 0)[0] == Approx(2.0));
  CHECK(at(0, 1, 1)[0] == Approx(0.5));  // mean depth 50 m over the wet part
  CHECK(at(1, 1, 1)[1] == Approx(1.0));
  CHECK(std::isnan(at(0, 0, 2)[0]));
  CHECK(std::isnan(at(0, 0, 2)[1]));
}

TEST_CASE("a hole in a column ends it: the glider does not fly through rock") {
  GridAxes axes{{0.0}, {0, 100, 200}, {0, 1}, {0, 1}, false, true};
  const Grid grid = test::make_grid(axes, [](double, double, double z, double) {
    return z == 100 ? std::pair{test::kDry, test::kDry} : std::pair{z + 1, 0.0};
  });
  CHECK(depth_average(view_of(grid), {Metres{20}, Metres{200}, 1, 1}).values[0] == 1.0F);
}

TEST_CASE("a grid with one level is its own mean") {
  GridAxes axes{{0.0}, {0.5}, {0, 1}, {0, 1}, false, true};
  const Grid grid = test::make_grid(axes, [](double lat, double lon, double, double) { return std::pair{lat, lon}; });
  CHECK(depth_average(view_of(grid), {}).values == grid.values);
}

TEST_CASE("a mean over a filled level is filled") {
  Grid grid = test::make_grid({{0, 3600}, {0, 100}, {0, 1}, {0, 1}, true, true}, [](double, double, double, double) {
    return std::pair{0.1, 0.2};
  });
  grid.filled = {{3, 1}, {12, 2}};  // first time, surface, last node; second time, 100 m, first two nodes
  CHECK(depth_average(view_of(grid), DiveProfile{Metres{0}, Metres{100}, 1, 1}).filled == std::vector<NodeRun>{{3, 3}});
  Grid flat = test::make_grid({{0}, {0}, {0, 1}, {0, 1}, true, false}, [](double, double, double, double) {
    return std::pair{0.1, 0.2};
  });
  flat.filled = {{1, 2}};
  CHECK(depth_average(view_of(flat), {}).filled == flat.filled);
}

TEST_CASE("a glider that turns at a near bottom sinks as far in the same time") {
  const auto profile =
      DiveProfile::of_stint(Metres{20}, Metres{200}, MetresPerSecond{0.3}, degrees(26), Seconds{14400});
  for (const double depth : {21.0, 60.0, 150.0, 199.0}) {
    const auto turned = profile.turned_at(Metres{depth});
    // The same yo planned for that depth from the start: the way w·T/2 is shared among more yos.
    const auto planned =
        DiveProfile::of_stint(Metres{20}, Metres{depth}, MetresPerSecond{0.3}, degrees(26), Seconds{14400});
    CHECK(turned.upper == planned.upper);
    CHECK(turned.lower == planned.lower);
    CHECK(turned.above == Approx(planned.above));
    CHECK(turned.below == Approx(planned.below));
  }
  CHECK(profile.turned_at(Metres{200}) == profile);
  CHECK(profile.turned_at(Metres{5000}) == profile);
  const auto shallow = profile.turned_at(Metres{15});
  const double way = 20 + 180 * profile.below;
  CHECK(shallow.lower == Metres{15});
  CHECK(shallow.upper.si() * shallow.above == Approx(way));
}

TEST_CASE("over a near bottom a current that is linear in depth has the mean of the turned profile") {
  // u = z/100: the mean of u is the profile's mean depth over 100. Levels from 0 to 300 m in steps of 50 hold it exactly.
  Grid grid;
  grid.axes.lats_deg = {40, 41};
  grid.axes.lons_deg = {5, 6};
  grid.axes.times_s = {0};
  grid.axes.depths_m = {0, 50, 100, 150, 200, 250, 300};
  for (const double z : grid.axes.depths_m)
    for (int n = 0; n < 4; ++n) {
      grid.values.push_back(static_cast<float>(z / 100));
      grid.values.push_back(0.5F);
    }
  const DiveProfile profile{Metres{20}, Metres{200}, 1, 5};
  // Bottom over the four columns: unknown, deep, 80 m, 10 m.
  const auto turning = [](double lat, double lon) {
    const bool north = lat > 40.5 * kPi / 180, east = lon > 5.5 * kPi / 180;
    return !north ? (east ? 900.0 : std::numeric_limits<double>::quiet_NaN()) : (east ? 10.0 : 80.0);
  };
  const auto mean = depth_average(view_of(grid), profile, turning);
  const double full = (20 * 10 + 180 * 5 * 110.0) / (20 + 180 * 5) / 100;
  const double near = (20 * 10 + 900 * 50.0) / (20 + 900) / 100;  // 180·5 m of way below 20 m, shared by 60 m
  CHECK(static_cast<double>(mean.values[0]) == Approx(full).epsilon(1e-6));  // float
  CHECK(static_cast<double>(mean.values[2]) == Approx(full).epsilon(1e-6));
  CHECK(static_cast<double>(mean.values[4]) == Approx(near).epsilon(1e-6));
  CHECK(static_cast<double>(mean.values[6]) == Approx(0.05).epsilon(1e-6));
  for (const std::size_t n : {1U, 3U, 5U, 7U}) CHECK(static_cast<double>(mean.values[n]) == Approx(0.5));
}
