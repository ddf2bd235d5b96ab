#include "core/planning/lattice_water.hpp"

#include <algorithm>
#include <cmath>

#include "core/planning/flight.hpp"

namespace glidehelm::planning {

namespace {

/// Between what values the current of a place changes, seen at some instants in order.
class Swing {
 public:
  void add(Current c) {
    east_.add(c.east.si());
    north_.add(c.north.si());
  }
  [[nodiscard]] bool any() const { return east_.most >= east_.least; }
  [[nodiscard]] double east() const { return 0.5 * (east_.least + east_.most); }
  [[nodiscard]] double north() const { return 0.5 * (north_.least + north_.most); }
  /// How far it is from there at most.
  [[nodiscard]] double reach() const { return std::hypot(east_.half(), north_.half()); }

 private:
  struct Range {
    double least{1e9}, most{-1e9};
    double before{std::nan("")}, last{std::nan("")}, bend{};
    void add(double value) {
      least = std::min(least, value), most = std::max(most, value);
      if (const double second = std::abs(before - 2 * last + value); second > bend) bend = second;
      before = last, last = value;
    }
    /// A parabola through three instants rises above them by an eighth of its second difference at most.
    [[nodiscard]] double half() const { return 0.5 * (most - least) + bend / 8; }
  };
  Range east_, north_;
};

/// Instants at which a field is looked at.
class Instants {
 public:
  Instants(const Problem& problem, const ocean::Coverage& of) {
    const double from = problem.start.fix_s, to = std::max(from, problem.horizon_s);
    // What comes after the data is held or begins again: fewer instants will do.
    const double end = of.last_s > from && of.last_s < to ? of.last_s : to;
    spread(from, end, end < to ? kMostInstants * 4 / 5 : kMostInstants);
    if (end < to) spread(end, to, kMostInstants / 5);
    for (const double share : {0.0, 0.3819660112501051, 0.7236067977499790, 1.0})
      probes_.push_back(from + share * (to - from));
  }

  Swing swing(const ocean::FieldRef& field, GeoPoint p, std::uint64_t& evaluations) const {
    const auto seen = [&](const std::vector<double>& at, Swing& swing) {
      evaluations += at.size();
      for (const double t : at)
        if (const auto s = field.sample(p, t)) swing.add(s->current);
    };
    Swing few;
    seen(probes_, few);
    if (!few.any() || few.reach() == 0) return few;  // the same at instants that no period has in common
    Swing all;
    seen(instants_, all);
    return all;
  }

 private:
  void spread(double from, double to, int most) {
    const int steps = std::clamp(static_cast<int>(std::ceil((to - from) / 3600)), 1, most - 1);
    for (int i = 0; i <= steps; ++i) instants_.push_back(from + (to - from) * i / steps);
  }
  std::vector<double> instants_, probes_;
};

/// A parabolic jet along a side: corners and middle of the triangle differ by k·side²/6, and its mean is 0.21·k·side² slower than the jet.
constexpr double kPerBend = 1.3;

/// The mean of what several places have.
class Mean {
 public:
  void add(const Swing& s) {
    if (s.any()) add(s.east(), s.north(), s.reach());
  }
  void add(double east, double north, double reach) {
    ++count_;
    east_ += east, north_ += north, reach_ += reach;
  }
  void widen(double reach) { wider_ += reach; }
  [[nodiscard]] bool any() const { return count_ > 0; }
  [[nodiscard]] double east() const { return east_ / count_; }
  [[nodiscard]] double north() const { return north_ / count_; }
  [[nodiscard]] double reach() const { return reach_ / count_ + wider_; }

 private:
  int count_{};
  double east_{}, north_{}, reach_{}, wider_{};
};

/// The mean over each triangle of its corners and its middle; none where all four have no current.
std::vector<Mean> means(const TriangleLattice& lattice, const ocean::FieldRef& field, const Instants& instants,
                        std::uint64_t& evaluations) {
  std::vector<Swing> corners;
  corners.reserve(lattice.nodes());
  for (std::size_t n = 0; n < lattice.nodes(); ++n) {
    const auto p = lattice.at(n);
    corners.push_back(instants.swing(field, GeoPoint::from_kernel(p.lat, p.lon), evaluations));
  }
  std::vector<Mean> all(lattice.triangles());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto t = lattice.triangle(i);
    for (const auto corner : {t.left, t.right, t.apex}) all[i].add(corners[corner]);
    const auto p = lattice.middle(t);
    const auto middle = instants.swing(field, GeoPoint::from_kernel(p.lat, p.lon), evaluations);
    const double bend =
        all[i].any() && middle.any() ? std::hypot(middle.east() - all[i].east(), middle.north() - all[i].north()) : 0.0;
    all[i].add(middle);
    all[i].widen(kPerBend * bend);
  }
  return all;
}

/// Fills dry triangles that touch wet ones: water may reach into them. What is left without is land.
void lend_to_neighbours(const TriangleLattice& lattice, std::vector<Mean>& means) {
  std::vector<Mean> of_nodes(lattice.nodes());
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (!means[i].any()) continue;
    const auto t = lattice.triangle(i);
    for (const auto corner : {t.left, t.right, t.apex})
      of_nodes[corner].add(means[i].east(), means[i].north(), means[i].reach());
  }
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (means[i].any()) continue;
    const auto t = lattice.triangle(i);
    for (const auto corner : {t.left, t.right, t.apex})
      if (const auto& lent = of_nodes[corner]; lent.any()) means[i].add(lent.east(), lent.north(), lent.reach());
  }
}

/// Whether some place of a triangle may have the clearance `least`.
bool has_room(const TriangleLattice& lattice, const TriangleLattice::Triangle& t, const chart::Chart& chart,
              double least) {
  const auto p = lattice.middle(t);
  const double far = std::max(std::hypot(0.5 * t.base * t.widest, t.height / 3), std::abs(t.height) * 2 / 3);
  if (chart.clearance_at_least(p.lat, p.lon) + far >= least) return true;
  return chart.clearance(p.lat, p.lon) + far >= least;
}

/// The clearance that every way keeps: what the start and the goal have, where that is less than the margin. A metre is let go.
double kept_clearance(const Problem& problem, const chart::Chart& chart) {
  const auto goal = disc_of(problem);
  const double at_goal = chart.clearance(goal.centre).si() - goal.radius.si();
  return std::min({problem.coast_margin.si(), chart.clearance(problem.start.fix).si(), at_goal}) - 1;
}

}  // namespace

LatticeWater water_of(const TriangleLattice& lattice, const Problem& problem, const ocean::Ocean& ocean,
                      const chart::Chart& chart) {
  LatticeWater water;
  auto& evaluations = water.current_evaluations;
  auto dive = means(lattice, ocean.dive, {problem, ocean.dive.coverage()}, evaluations);
  lend_to_neighbours(lattice, dive);
  std::vector<Mean> surface;
  const bool one_field = ocean.surface.is(ocean.dive);
  if (!one_field) {
    surface = means(lattice, ocean.surface, {problem, ocean.surface.coverage()}, evaluations);
    lend_to_neighbours(lattice, surface);
  }
  const double least = kept_clearance(problem, chart), speed = problem.glider.horizontal_speed.si();
  water.triangles.resize(lattice.triangles());
  for (std::size_t i = 0; i < water.triangles.size(); ++i) {
    if (!dive[i].any() || !has_room(lattice, lattice.triangle(i), chart, least)) continue;
    const auto& drift = one_field || !surface[i].any() ? dive[i] : surface[i];
    water.triangles[i] = {
        dive[i].east(), dive[i].north(), speed + dive[i].reach(), drift.east(), drift.north(), drift.reach(), true};
  }
  return water;
}

}  // namespace glidehelm::planning
