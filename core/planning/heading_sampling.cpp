#include "core/planning/heading_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/vehicle/constrained_motion.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kVariance = 0.1745;  // rad²
constexpr double kSpacing = 2 * kPi / kCourses;

void normalise(CourseWeights& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(sum > 0)) return;
  for (double& w : weights) w /= sum;
}

struct Direction {
  double sin, cos;
};
const std::array<Direction, kCourses>& directions() {
  static const auto kTable = [] {
    std::array<Direction, kCourses> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double angle = static_cast<double>(i) * kSpacing;
      table[i] = {std::sin(angle), std::cos(angle)};
    }
    return table;
  }();
  return kTable;
}

/// The sample nearest to the goal's direction, which is 0 on the circle, moved there.
void keep_goal(std::span<double> courses) {
  const auto off = [](double course) { return std::abs(std::remainder(course, 2 * kPi)); };
  *std::min_element(courses.begin(), courses.end(), [&](double a, double b) { return off(a) < off(b); }) = 0.0;
}

}  // namespace

CourseWeights goal_weights() {
  CourseWeights weights{};
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (const double turns : {-1.0, 0.0, 1.0}) {
      const double off = static_cast<double>(i) * kSpacing + turns * 2 * kPi;
      weights[i] += std::exp(-off * off / (2 * kVariance));
    }
  normalise(weights);
  return weights;
}

CourseWeights speed_weights(double first, double speed_m_per_s, const Current& current) {
  // The current in the frame of the first course: components along it and to the right of it.
  const double s = std::sin(first), c = std::cos(first);
  const double ahead = current.east.si() * s + current.north.si() * c;
  const double right = current.east.si() * c - current.north.si() * s;
  CourseWeights weights{};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto& d = directions()[i];
    const double speed = vehicle::speed_on_course(d.sin, d.cos, speed_m_per_s, right, ahead);
    weights[i] = speed > 0 ? speed : 0.0;  // NaN, beyond the cone, is not greater
  }
  normalise(weights);
  return weights;
}

void resample(std::span<const double> weights, double r, std::span<int> chosen) {
  const double step = 1.0 / static_cast<double>(chosen.size());
  std::size_t i = 0;
  double sum = weights[0];
  for (std::size_t m = 0; m < chosen.size(); ++m) {
    const double u = (r + static_cast<double>(m)) * step;
    while (sum < u && i + 1 < weights.size()) sum += weights[++i];
    chosen[m] = static_cast<int>(i);
  }
}

void repair_duplicates(std::span<double> angles, Draws& draws) {
  const std::size_t n = angles.size();
  if (n == 0) return;
  // The neighbours are those before any repair: the last distinct value seen, and the first of the next group.
  double before = angles[n - 1] - 2 * kPi;
  const double first = angles[0];
  for (std::size_t i = 0; i < n;) {
    const double value = angles[i];
    std::size_t end = i + 1;
    while (end < n && angles[end] == value) ++end;
    const double after = end < n ? angles[end] : first + 2 * kPi;
    const double low = 0.5 * (before + value), high = 0.5 * (value + after);
    for (std::size_t k = i + 1; k < end; ++k) angles[k] = low + (high - low) * draws.next();
    std::sort(angles.begin() + static_cast<std::ptrdiff_t>(i), angles.begin() + static_cast<std::ptrdiff_t>(end));
    before = value;
    i = end;
  }
}

AdaptiveHeadings::AdaptiveHeadings(MetresPerSecond speed, std::uint64_t seed)
    : speed_{speed.si()}, seed_{seed}, goal_{goal_weights()} {}

void AdaptiveHeadings::draw(double to_goal, const Current& current, std::uint64_t stream,
                            std::span<double> headings) const {
  Draws draws{seed_, stream};
  const auto by_speed = speed_weights(to_goal, speed_, current);
  const bool feasible = std::any_of(by_speed.begin(), by_speed.end(), [](double w) { return w > 0; });
  CourseWeights weights = goal_;
  if (feasible)
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = 0.5 * (goal_[i] + by_speed[i]);
  std::array<int, kCourses> chosen;
  resample(weights, draws.next(), std::span{chosen}.first(headings.size()));
  std::transform(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(headings.size()), headings.begin(),
                 [](int i) { return i * kSpacing; });
  repair_duplicates(headings, draws);
  keep_goal(headings);
  for (double& angle : headings) {
    const Course course{Radians{to_goal + angle}};
    const auto held = vehicle::hold_course(course, MetresPerSecond{speed_}, current);
    angle = held ? held->heading.from_north().si() : course.from_north().si();
  }
}

}  // namespace glidehelm::planning
