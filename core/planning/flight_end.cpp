#include "core/planning/flight_end.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::planning {

namespace {

using Eigen::Matrix2d;
using Eigen::RowVector2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using LaneValues = std::array<double, ocean::Lanes::kMax>;

constexpr int kLanes = 7;  // the way; east, north and heading to both sides

Vector3d earth_fixed(double lat, double lon) {
  const double s = std::sin(lat);
  const double n = LocalMetric::kEquatorialRadius / std::sqrt(1 - LocalMetric::kEccentricity2 * s * s);
  return {n * std::cos(lat) * std::cos(lon), n * std::cos(lat) * std::sin(lon),
          n * (1 - LocalMetric::kEccentricity2) * s};
}
/// Unit vectors of east and north.
Eigen::Matrix<double, 3, 2> tangents(double lat, double lon) {
  Eigen::Matrix<double, 3, 2> t;
  t.col(0) = Vector3d{-std::sin(lon), std::cos(lon), 0};
  t.col(1) = Vector3d{-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat)};
  return t;
}

/// How the end of one stint, and what it pays, answer to its beginning and its heading.
struct Link {
  Matrix2d end_by_place = Matrix2d::Identity();
  Vector2d end_by_turn = Vector2d::Zero();
  RowVector2d toll_by_place = RowVector2d::Zero();
  double toll_by_turn{};
};

}  // namespace

FlightEndings::FlightEndings(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
                             Metres margin, Metres buffer)
    : problem_{problem},
      flight_{problem, ocean, chart, margin},
      goal_{earth_fixed(flight_.goal().centre.lat.radians(), flight_.goal().centre.lon.radians())},
      place_step_{std::min(250.0, buffer.si() > 0 ? buffer.si() / 3 : 250.0)},
      turn_step_{place_step_ / (problem.glider.horizontal_speed.si() * problem.schedule.stint.count())} {
  flight_.set_buffer(buffer);
}

FlightEnd FlightEndings::end(std::span<const double> headings, double until_s) {
  HeldLanes lane;
  lane.begin(1, problem_.start.fix.lat.radians(), problem_.start.fix.lon.radians());
  for (std::size_t k = 0; k < headings.size() && lane.flies(0); ++k)
    flight_.fly(lane, static_cast<int>(k), LaneValues{headings[k]}, until_s, false);
  FlightEnd e;
  e.off = earth_fixed(lane.at.lat[0], lane.at.lon[0]) - goal_;
  e.toll = lane.toll[0];
  return e;
}

FlightEnd FlightEndings::end_with_slopes(std::span<const double> headings, double until_s) {
  const auto n = headings.size();
  std::vector<Link> links(n);
  FlightEnd e;
  double lat = problem_.start.fix.lat.radians(), lon = problem_.start.fix.lon.radians();
  for (std::size_t k = 0; k < n; ++k) {
    HeldLanes lanes;
    lanes.begin(kLanes, lat, lon);
    LaneValues turned;
    std::fill_n(turned.begin(), kLanes, headings[k]);
    const auto metric = LocalMetric::at(lat);
    lanes.at.lon[1] += place_step_ / metric.parallel_radius;
    lanes.at.lon[2] -= place_step_ / metric.parallel_radius;
    lanes.at.lat[3] += place_step_ / metric.meridian_radius;
    lanes.at.lat[4] -= place_step_ / metric.meridian_radius;
    turned[5] += turn_step_;
    turned[6] -= turn_step_;
    flight_.fly(lanes, static_cast<int>(k), turned, until_s, false);
    const auto difference = [&](std::size_t a, std::size_t b, double step) -> Vector2d {
      const auto off = local_offset(lanes.at.lat[b], lanes.at.lon[b], lanes.at.lat[a], lanes.at.lon[a]);
      return Vector2d{off.east, off.north} / (2 * step);
    };
    auto& link = links[k];
    link.end_by_place.col(0) = difference(1, 2, place_step_);
    link.end_by_place.col(1) = difference(3, 4, place_step_);
    link.end_by_turn = difference(5, 6, turn_step_);
    link.toll_by_place = RowVector2d{lanes.toll[1] - lanes.toll[2], lanes.toll[3] - lanes.toll[4]} / (2 * place_step_);
    link.toll_by_turn = (lanes.toll[5] - lanes.toll[6]) / (2 * turn_step_);
    lat = lanes.at.lat[0];
    lon = lanes.at.lon[0];
    e.toll += lanes.toll[0];
    if (!lanes.flies(0)) break;  // the links after it keep the place and pay nothing
  }
  e.off = earth_fixed(lat, lon) - goal_;
  e.off_by_turn = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(n));
  e.toll_by_turn = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(n));
  Eigen::Matrix<double, 3, 2> off_by_place = tangents(lat, lon);
  RowVector2d toll_by_place = RowVector2d::Zero();
  for (std::size_t k = n; k-- > 0;) {
    const auto& link = links[k];
    const auto column = static_cast<Eigen::Index>(k);
    e.off_by_turn.col(column) = off_by_place * link.end_by_turn;
    e.toll_by_turn[column] = toll_by_place.dot(link.end_by_turn) + link.toll_by_turn;
    off_by_place = (off_by_place * link.end_by_place).eval();
    toll_by_place = (toll_by_place * link.end_by_place + link.toll_by_place).eval();
  }
  return e;
}

}  // namespace glidehelm::planning
