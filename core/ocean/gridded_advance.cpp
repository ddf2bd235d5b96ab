#include <array>
#include <cmath>

#include "core/ocean/bilinear.hpp"
#include "core/ocean/gridded.hpp"

namespace glidehelm::ocean {

/// The Runge–Kutta step of all lanes over one gridded field: what `GriddedField::advance` runs.
struct GriddedKernel {
  GriddedKernel(const GriddedField& of, Lanes& moved, double from_s, double step_s)
      : field{of}, lanes{moved}, t_s{from_s}, dt{step_s} {}

  const GriddedField& field;
  Lanes& lanes;
  double t_s, dt;

  /// One instant of the step: the two slices around it.
  struct Stage {
    double t;
    const float *before, *behind;
    float ft;
  };
  /// Lanes under way and their state, compact: `lane[n]` is the lane of entry n.
  int count{};
  std::array<std::int32_t, Lanes::kMax> lane;
  alignas(64) std::array<double, Lanes::kMax> lat0, lon0, rate_lat, rate_lon, sum_lat, sum_lon;

  void run();
  void gather();
  template <bool kUniform, bool kTimed>
  void stage(const Stage& at, double fraction, double weight);
  void stage_by_samples(const Stage& at, double fraction, double weight);
  void evaluate(const Stage& at, double fraction, double weight);
  void finish();
  /// The careful path of one lane. False: the lane is lost and says why.
  bool careful(int n, double lat, double lon, const Stage& at, EastNorth& current);
  void drop_lost();
};

void GriddedKernel::gather() {
  const double west = field.lons_.first();
  for (int i = 0; i < lanes.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (lanes.lost[k] != 0) continue;
    const auto n = static_cast<std::size_t>(count++);
    lane[n] = i;
    lat0[n] = lanes.lat[k];
    double lon = lanes.lon[k];
    if (!(lon >= west && lon <= field.lons_.last())) lon -= 2 * kPi * std::floor((lon - west) / (2 * kPi));
    lon0[n] = lon;
    rate_lat[n] = rate_lon[n] = sum_lat[n] = sum_lon[n] = 0;
  }
}

bool GriddedKernel::careful(int n, double lat, double lon, const Stage& at, EastNorth& current) {
  const auto answer = field.at(lat, lon, 0.0, at.t);
  if (!answer) {
    lanes.lost[static_cast<std::size_t>(lane[static_cast<std::size_t>(n)])] = static_cast<std::uint8_t>(answer.error());
    return false;
  }
  current = {static_cast<float>(answer->current.east.si()), static_cast<float>(answer->current.north.si())};
  return true;
}

template <bool kUniform, bool kTimed>
void GriddedKernel::stage(const Stage& at, double fraction, double weight) {
  const double south = field.lats_.first(), north = field.lats_.last();
  const double west = field.lons_.first(), east = field.lons_.last();
  const double per_lat = field.lats_.cells_per_radian(), per_lon = field.lons_.cells_per_radian();
  const int last_row = static_cast<int>(field.lats_.size()) - 2, last_column = static_cast<int>(field.lons_.size()) - 2;
  const std::size_t row = field.row_stride_;
  const bool nearest = field.options_.interpolation == Interpolation::nearest;
  const MetricTable& metric = *field.metric_;
  const double ahead = fraction * dt;
  bool lost = false;
  for (int n = 0; n < count; ++n) {
    const auto k = static_cast<std::size_t>(n);
    const double lat = lat0[k] + ahead * rate_lat[k], lon = lon0[k] + ahead * rate_lon[k];
    EastNorth current{NAN, NAN};
    if (lat >= south && lat <= north && lon >= west && lon <= east) {
      std::size_t corner;
      float fx, fy;
      if constexpr (kUniform) {
        const double y = (lat - south) * per_lat, x = (lon - west) * per_lon;
        const int j = std::min(static_cast<int>(y), last_row), i = std::min(static_cast<int>(x), last_column);
        fy = static_cast<float>(y - static_cast<double>(j));
        fx = static_cast<float>(x - static_cast<double>(i));
        corner = static_cast<std::size_t>(j) * row + 2 * static_cast<std::size_t>(i);
      } else {
        const AxisPlace y = field.lats_.place(lat), x = field.lons_.place(lon);
        fy = static_cast<float>(y.fraction);
        fx = static_cast<float>(x.fraction);
        corner = y.cell * row + 2 * x.cell;
      }
      if (nearest) {
        fx = fx < 0.5F ? 0.0F : 1.0F;
        fy = fy < 0.5F ? 0.0F : 1.0F;
      }
      if constexpr (kTimed)
        current = bilinear_between(at.before + corner, at.behind + corner, row, fx, fy, at.ft);
      else
        current = bilinear_at(at.before + corner, row, fx, fy);
    }
    if (current.east != current.east && !careful(n, lat, lon, at, current)) {
      lost = true;
      continue;
    }
    const auto inverse = metric.at(lat);
    const auto l = static_cast<std::size_t>(lane[k]);
    rate_lat[k] = (lanes.water_north[l] + static_cast<double>(current.north)) * inverse.meridian;
    rate_lon[k] = (lanes.water_east[l] + static_cast<double>(current.east)) * inverse.parallel;
    sum_lat[k] += weight * rate_lat[k];
    sum_lon[k] += weight * rate_lon[k];
  }
  if (lost) drop_lost();
}

void GriddedKernel::stage_by_samples(const Stage& at, double fraction, double weight) {
  bool lost = false;
  for (int n = 0; n < count; ++n) {
    const auto k = static_cast<std::size_t>(n);
    const double lat = lat0[k] + fraction * dt * rate_lat[k], lon = lon0[k] + fraction * dt * rate_lon[k];
    EastNorth current{};
    if (!careful(n, lat, lon, at, current)) {
      lost = true;
      continue;
    }
    const auto inverse = field.metric_->at(lat);
    const auto l = static_cast<std::size_t>(lane[k]);
    rate_lat[k] = (lanes.water_north[l] + static_cast<double>(current.north)) * inverse.meridian;
    rate_lon[k] = (lanes.water_east[l] + static_cast<double>(current.east)) * inverse.parallel;
    sum_lat[k] += weight * rate_lat[k];
    sum_lon[k] += weight * rate_lon[k];
  }
  if (lost) drop_lost();
}

void GriddedKernel::drop_lost() {
  int kept = 0;
  for (int n = 0; n < count; ++n) {
    const auto from = static_cast<std::size_t>(n), to = static_cast<std::size_t>(kept);
    if (lanes.lost[static_cast<std::size_t>(lane[from])] != 0) continue;
    lane[to] = lane[from];
    for (auto* values : {&lat0, &lon0, &rate_lat, &rate_lon, &sum_lat, &sum_lon}) (*values)[to] = (*values)[from];
    ++kept;
  }
  count = kept;
}

void GriddedKernel::evaluate(const Stage& at, double fraction, double weight) {
  const auto how = field.options_.interpolation;
  if (how == Interpolation::cubic || how == Interpolation::akima) return stage_by_samples(at, fraction, weight);
  const bool timed = at.behind != at.before;
  if (field.lats_.uniform() && field.lons_.uniform())
    timed ? stage<true, true>(at, fraction, weight) : stage<true, false>(at, fraction, weight);
  else
    timed ? stage<false, true>(at, fraction, weight) : stage<false, false>(at, fraction, weight);
}

void GriddedKernel::run() {
  gather();
  std::array<Stage, 3> stages;
  for (std::size_t s = 0; s < 3; ++s) {
    const double t = t_s + 0.5 * static_cast<double>(s) * dt;
    const auto bracket = field.times_.bracket(t);
    if (!bracket) {
      for (int n = 0; n < count; ++n)
        lanes.lost[static_cast<std::size_t>(lane[static_cast<std::size_t>(n)])] =
            static_cast<std::uint8_t>(NoCurrent::outside_time);
      return;
    }
    stages[s] = {t, field.slice(bracket->first, 0), field.slice(bracket->next, 0),
                 static_cast<float>(bracket->fraction)};
    if (field.options_.interpolation == Interpolation::nearest)
      stages[s].before = stages[s].behind = stages[s].ft < 0.5F ? stages[s].before : stages[s].behind;
  }
  evaluate(stages[0], 0.0, 1.0);
  evaluate(stages[1], 0.5, 2.0);
  evaluate(stages[1], 0.5, 2.0);
  evaluate(stages[2], 1.0, 1.0);
  finish();
}

void GriddedKernel::finish() {
  for (int n = 0; n < count; ++n) {
    const auto k = static_cast<std::size_t>(n);
    const auto l = static_cast<std::size_t>(lane[k]);
    lanes.lat[l] += dt / 6.0 * sum_lat[k];
    lanes.lon[l] += dt / 6.0 * sum_lon[k];
  }
}

void GriddedField::advance(Lanes& lanes, double t_s, double dt) const { GriddedKernel{*this, lanes, t_s, dt}.run(); }

}  // namespace glidehelm::ocean
