#include <algorithm>
#include <array>
#include <cmath>

#include "core/ocean/bilinear.hpp"
#include "core/ocean/gridded.hpp"

namespace glidehelm::ocean {

/// The Runge–Kutta step of all lanes over one gridded field: what `GriddedField::advance` runs.
///
/// Longitude and latitude, east and north, the two inverse radii: everything comes in pairs, so a lane's state is a few
/// two-wide registers, and all lanes do one stage before the next, so that one lane's loads hide behind the others'.
struct GriddedKernel {
  GriddedKernel(const GriddedField& of, Lanes& moved, double from_s, double step_s)
      : field{of}, lanes{moved}, t_s{from_s}, dt{step_s} {}
  void run();

 private:
  /// One instant of the step: the two slices around it.
  struct Stage {
    double t;
    const float *before, *behind;
    float ft;
  };
  using Pairs = std::array<Double2, Lanes::kMax>;  ///< (longitude or east, latitude or north)

  void gather();
  /// The slices around `t`; false, and every lane lost, when the field has none.
  bool open_stage(double t, Stage& at);
  template <bool kUniform, bool kTimed, bool kInside>
  void stage(const Stage& at, double ahead, double weight);
  void stage_by_samples(const Stage& at, double ahead, double weight);
  void evaluate(const Stage& at, double ahead, double weight);
  void move(std::size_t n, Float2 current, Double2 inverse, double weight) {
    rate[n] = (water[n] + __builtin_convertvector(current, Double2)) * inverse;
    sum[n] += weight * rate[n];
  }
  /// The careful path of one lane. False: the lane is lost and says why.
  bool careful(std::size_t n, Double2 place, const Stage& at, Float2& current);
  void drop_lost();

  const GriddedField& field;
  Lanes& lanes;
  double t_s, dt;
  /// Lanes under way and their state, compact: `lane[n]` is the lane of entry n.
  std::size_t count{};
  std::array<std::uint32_t, Lanes::kMax> lane;
  alignas(64) Pairs place0, rate, sum, water;
  bool inside{true};  ///< no lane can reach an edge of the nodes within this step
};

void GriddedKernel::gather() {
  const double south = field.lats_.first(), north = field.lats_.last();
  const double west = field.lons_.first(), east = field.lons_.last();
  double lowest = north, highest = south, left = east, right = west, fastest = 0;
  for (int i = 0; i < lanes.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (lanes.lost[k] != 0) continue;
    double lon = lanes.lon[k];
    const double lat = lanes.lat[k];
    if (!(lon >= west && lon <= east)) lon -= 2 * kPi * std::floor((lon - west) / (2 * kPi));
    lane[count] = static_cast<std::uint32_t>(i);
    place0[count] = Double2{lon, lat};
    water[count] = Double2{lanes.water_east[k], lanes.water_north[k]};
    rate[count] = sum[count] = Double2{0, 0};
    ++count;
    lowest = std::min(lowest, lat);
    highest = std::max(highest, lat);
    left = std::min(left, lon);
    right = std::max(right, lon);
    fastest = std::max({fastest, std::abs(lanes.water_east[k]), std::abs(lanes.water_north[k])});
    inside = inside && std::isfinite(lat + lon + lanes.water_east[k] + lanes.water_north[k]);
  }
  // Each component stays below `reach` metres; the largest inverse radii of the step lie at its edge nearest a pole.
  const double reach = std::abs(dt) * (fastest + field.fastest_);
  const double up = reach / 6.3e6, polar = std::max(std::abs(lowest), std::abs(highest)) + up;
  const double aside = polar < 1.5 ? reach / (6.378e6 * std::cos(polar)) : 10;
  inside = inside && lowest - up >= south && highest + up <= north && left - aside >= west && right + aside <= east;
}

bool GriddedKernel::careful(std::size_t n, Double2 place, const Stage& at, Float2& current) {
  const auto answer = field.at(place[1], place[0], 0.0, at.t);
  if (!answer) {
    lanes.lost[lane[n]] = static_cast<std::uint8_t>(answer.error());
    return false;
  }
  current = Float2{static_cast<float>(answer->current.east.si()), static_cast<float>(answer->current.north.si())};
  return true;
}

template <bool kUniform, bool kTimed, bool kInside>
void GriddedKernel::stage(const Stage& at, double ahead, double weight) {
  const Double2 first{field.lons_.first(), field.lats_.first()}, last{field.lons_.last(), field.lats_.last()};
  const Double2 per_cell{field.lons_.cells_per_radian(), field.lats_.cells_per_radian()};
  const int last_row = static_cast<int>(field.lats_.size()) - 2, last_column = static_cast<int>(field.lons_.size()) - 2;
  const std::size_t row = field.row_stride_;
  const float* const before = at.before;
  const float* const behind = at.behind;
  const float ft = at.ft;
  const bool nearest = field.options_.interpolation == Interpolation::nearest;
  const MetricTable& metric = *field.metric_;
  bool lost = false;
  for (std::size_t n = 0; n < count; ++n) {
    const Double2 place = place0[n] + ahead * rate[n];
    Float2 current{NAN, NAN};
    if (kInside || (place[0] >= first[0] && place[0] <= last[0] && place[1] >= first[1] && place[1] <= last[1])) {
      std::size_t corner;
      float fx, fy;
      if constexpr (kUniform) {
        const Double2 cells = (place - first) * per_cell;
        int i = static_cast<int>(cells[0]), j = static_cast<int>(cells[1]);
        if constexpr (!kInside) {  // a place on the last node belongs to the last cell
          i = std::min(i, last_column);
          j = std::min(j, last_row);
        }
        const Double2 f = cells - Double2{static_cast<double>(i), static_cast<double>(j)};
        fx = static_cast<float>(f[0]);
        fy = static_cast<float>(f[1]);
        corner = static_cast<std::size_t>(j) * row + 2 * static_cast<std::size_t>(i);
      } else {
        const AxisPlace x = field.lons_.place(place[0]), y = field.lats_.place(place[1]);
        fx = static_cast<float>(x.fraction);
        fy = static_cast<float>(y.fraction);
        corner = y.cell * row + 2 * x.cell;
      }
      if (nearest) {
        fx = fx < 0.5F ? 0.0F : 1.0F;
        fy = fy < 0.5F ? 0.0F : 1.0F;
      }
      current = kTimed ? bilinear_between(before + corner, behind + corner, row, fx, fy, ft)
                       : bilinear_at(before + corner, row, fx, fy);
    }
    if (current[0] != current[0] && !careful(n, place, at, current)) {
      lost = true;
      continue;
    }
    move(n, current, metric.at(place[1]), weight);
  }
  if (lost) drop_lost();
}

void GriddedKernel::stage_by_samples(const Stage& at, double ahead, double weight) {
  bool lost = false;
  for (std::size_t n = 0; n < count; ++n) {
    const Double2 place = place0[n] + ahead * rate[n];
    Float2 current{};
    if (careful(n, place, at, current))
      move(n, current, field.metric_->at(place[1]), weight);
    else
      lost = true;
  }
  if (lost) drop_lost();
}

void GriddedKernel::drop_lost() {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (lanes.lost[lane[n]] != 0) continue;
    lane[kept] = lane[n];
    for (auto* values : {&place0, &rate, &sum, &water}) (*values)[kept] = (*values)[n];
    ++kept;
  }
  count = kept;
}

void GriddedKernel::evaluate(const Stage& at, double ahead, double weight) {
  const auto how = field.options_.interpolation;
  if (how == Interpolation::cubic || how == Interpolation::akima) return stage_by_samples(at, ahead, weight);
  const bool timed = at.behind != at.before;
  if (!(field.lats_.uniform() && field.lons_.uniform()))
    timed ? stage<false, true, false>(at, ahead, weight) : stage<false, false, false>(at, ahead, weight);
  else if (inside)
    timed ? stage<true, true, true>(at, ahead, weight) : stage<true, false, true>(at, ahead, weight);
  else
    timed ? stage<true, true, false>(at, ahead, weight) : stage<true, false, false>(at, ahead, weight);
}

bool GriddedKernel::open_stage(double t, Stage& at) {
  const auto bracket = field.times_.bracket(t);
  if (!bracket) {
    for (std::size_t n = 0; n < count; ++n) lanes.lost[lane[n]] = static_cast<std::uint8_t>(NoCurrent::outside_time);
    return false;
  }
  at = {t, field.slice(bracket->first, 0), field.slice(bracket->next, 0), static_cast<float>(bracket->fraction)};
  if (field.options_.interpolation == Interpolation::nearest)
    at.before = at.behind = at.ft < 0.5F ? at.before : at.behind;
  return true;
}

void GriddedKernel::run() {
  gather();
  Stage at{};
  if (!open_stage(t_s, at)) return;
  evaluate(at, 0.0, 1.0);
  if (!open_stage(t_s + 0.5 * dt, at)) return;
  evaluate(at, 0.5 * dt, 2.0);
  evaluate(at, 0.5 * dt, 2.0);
  if (!open_stage(t_s + dt, at)) return;
  evaluate(at, dt, 1.0);
  for (std::size_t n = 0; n < count; ++n) {
    lanes.lon[lane[n]] += dt / 6.0 * sum[n][0];
    lanes.lat[lane[n]] += dt / 6.0 * sum[n][1];
  }
}

void GriddedField::advance(Lanes& lanes, double t_s, double dt) const { GriddedKernel{*this, lanes, t_s, dt}.run(); }

}  // namespace glidehelm::ocean
