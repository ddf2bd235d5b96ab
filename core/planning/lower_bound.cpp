#include "core/planning/lower_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/ocean/flooded.hpp"
#include "core/planning/envelope.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/front.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kOwnClearance = 25;                  // metres by which walls are drawn back
constexpr std::array<double, 3> kCoarser{1, 1.5, 2};  // spacings and steps of the runs
constexpr double kDoubt = 2;                          // what the two earliest runs differ by, and as much again
constexpr double kCoasts = 0.15;  // spacings that the front may be late behind coasts: its shortest edges there
constexpr double kCorners = 6;    // and behind the corners of walls on which it cannot walk

/// One run of a front from the fix to the goal.
class Run {
 public:
  enum class End { reached, not_reached, cut };

  Run(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, double speed, double spacing,
      double step, double until)
      : problem_{problem},
        ocean_{ocean},
        goal_{disc_of(problem)},
        speed_{speed},
        step_{step},
        until_{until},
        beside_{2 * spacing},
        envelope_{speed + ocean.dive.fastest().si(), ocean.surface.fastest().si(), problem.schedule.stint.count(),
                  problem.schedule.surface.count()},
        front_{problem.start.fix, ocean.dive, chart, clearance(problem, chart), spacing} {}

  End go(const Budget& budget, int surfacings_per_isochrone) {
    if (distance(problem_.start.fix, goal_.centre) <= goal_.radius) return reach(0);
    for (int stint = 0; now_ < until_; ++stint) {
      if (budget.expired && budget.expired()) return End::cut;
      if (steps() > budget.work || !front_.complete()) return End::cut;
      if (move(ocean_.surface, 0, problem_.schedule.drift_before(stint).count())) return reach(now_);
      if (move(ocean_.dive, speed_, problem_.schedule.stint_length(stint).count())) return reach(now_);
      front_.stop([this](double lat, double lon) {
        const double way = distance_lower_bound(lat, lon, goal_.centre.lat.radians(), goal_.centre.lon.radians()) -
                           goal_.radius.si() - beside_;
        return now_ + envelope_.least_time(way) > until_;
      });
      if (surfacings_per_isochrone > 0 && stint % surfacings_per_isochrone == 0) keep_isochrone();
      if (nothing_moves()) return End::not_reached;
    }
    return End::not_reached;
  }

  [[nodiscard]] double arrival() const { return now_; }
  [[nodiscard]] std::uint64_t steps() const { return front_.evaluations() / 8; }
  [[nodiscard]] bool met_coast() const { return front_.met_coast(); }
  [[nodiscard]] bool met_shallows() const { return front_.met_shallows(); }
  [[nodiscard]] bool met_dry() const { return front_.met_dry(); }
  [[nodiscard]] std::size_t evaluations() const { return front_.evaluations(); }
  [[nodiscard]] std::size_t most_markers() const { return most_markers_; }
  [[nodiscard]] std::vector<Isochrone> isochrones() { return std::move(isochrones_); }

 private:
  /// A start or goal inside the margin makes it smaller everywhere: the reached set only grows by that.
  static double clearance(const Problem& problem, const chart::Chart& chart) {
    const double start = chart.clearance(problem.start.fix).si() - 1.0;
    return std::max(0.0, std::min(problem.coast_margin.si() - kOwnClearance, start));
  }
  End reach(double when) {
    now_ = when;
    return now_ <= until_ ? End::reached : End::not_reached;
  }
  /// True when the goal is reached; `now_` is then the arrival.
  bool move(ocean::FieldRef field, double speed, double seconds) {
    const int steps = std::max(1, static_cast<int>(std::ceil(seconds / step_ - 1e-9)));
    const double dt = seconds / steps, begin = now_;
    if (seconds <= 0) return false;
    for (int i = 0; i < steps; ++i) {
      const double t = begin + i * dt;
      if (t > until_) break;
      const auto entry = front_.advance(field, speed, problem_.start.fix_s + t, dt, goal_, i == 0 && speed > 0);
      if (entry) {
        now_ = t + *entry;
        return true;
      }
      if (speed > 0) {
        front_.refine();
        front_.prune(problem_.start.fix_s + t);
        most_markers_ = std::max(most_markers_, front_.markers().size());
      }
    }
    now_ = begin + seconds;
    return false;
  }
  void keep_isochrone() {
    Isochrone isochrone{problem_.start.fix_s + now_, {}};
    bool begins = true;
    for (const auto& m : front_.markers()) {
      if (begins) isochrone.lines.emplace_back();
      isochrone.lines.back().push_back(GeoPoint::from_kernel(m.lat, m.lon));
      begins = m.closes;
    }
    isochrones_.push_back(std::move(isochrone));
  }
  [[nodiscard]] bool nothing_moves() const {
    return std::all_of(front_.markers().begin(), front_.markers().end(), [](const Marker& m) { return m.idle; });
  }

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  vehicle::Disc goal_;
  double speed_, step_, until_;  ///< seconds from the fix
  double beside_;  ///< metres: what may lie on the edges beside a marker stays of use when the marker is not
  Envelope envelope_;
  Front front_;
  double now_{};
  std::size_t most_markers_{};
  std::vector<Isochrone> isochrones_;
};

double spacing_of(const Problem& problem, const BoundSettings& settings) {
  if (settings.spacing.si() > 0) return settings.spacing.si();
  return std::clamp(distance(problem.start.fix, disc_of(problem).centre).si() / 130, 100.0, 5000.0);
}

std::string hours(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  return text;
}

/// All runs of one answer.
class Certificate {
 public:
  Certificate(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget,
              const BoundSettings& settings)
      : problem_{problem},
        ocean_{ocean},
        chart_{chart},
        budget_{budget},
        settings_{settings},
        spacing_{spacing_of(problem, settings)},
        step_{settings.step.count() > 0 ? settings.step.count()
                                        : std::min(3600.0, spacing_ / problem.glider.horizontal_speed.si())},
        horizon_{problem.horizon_s - problem.start.fix_s},
        known_{settings.earlier_than_s - problem.start.fix_s} {}

  Bound make() {
    std::array<Outcome, kCoarser.size()> runs;
    const auto body = [&](std::size_t k) {
      runs[k] = before_known(kCoarser[k], k == 0 ? settings_.surfacings_per_isochrone : 0);
    };
    if (settings_.at_once) {
      settings_.at_once(runs.size(), body);
    } else {
      for (std::size_t k = 0; k < runs.size(); ++k) body(k);
    }
    bound_.isochrones = std::move(runs[0].isochrones);
    std::vector<double> arrivals;
    for (const auto& run : runs) {
      if (!count(run)) return cut();
      if (run.reached()) arrivals.push_back(*run.arrival);
    }
    if (arrivals.empty())
      return runs[0].until < horizon_ ? nothing("the front does not reach the goal before the known arrival")
                                      : prove_unreachable();
    std::sort(arrivals.begin(), arrivals.end());
    const double arrival = arrivals[0];
    const double error = arrivals.size() > 1 ? kDoubt * (arrivals[1] - arrival) : runs[0].until - arrival;
    double late = late_at_walls();
    if (met_shallows_ || met_dry_) {
      // Do these walls matter? Without a chart, and with the field's dry places flooded, the front has no corners to go round, and what it says is
      // a bound in any case. It may be late by a spacing where currents end at a flooded shore.
      const auto open = run(0, 1, runs[0].until, 0, true);
      if (!count(open)) return cut();
      const double detour = open.reached() ? std::max(0.0, arrival - *open.arrival) : 0.0;
      late = std::min(late, detour + (met_dry_ ? spacing_ / problem_.glider.horizontal_speed.si() : 0.0));
    }
    if (arrival - late > (1 + kLeastError) * known_)
      return nothing(
          "the front comes to the goal later than a plan that is known: it has lost a way and proves nothing");
    certify(arrival, error + kLeastError * arrival + late);
    return std::move(bound_);
  }

 private:
  /// What a run found, and what it cost.
  struct Outcome {
    std::optional<double>
        arrival;  ///< seconds from the fix, NaN when the goal is not reached; none when the run was cut
    double until{};
    Statistics statistics;
    std::size_t most_markers{};
    bool met_coast{}, met_shallows{}, met_dry{};
    std::vector<Isochrone> isochrones;
    [[nodiscard]] bool reached() const { return arrival && !std::isnan(*arrival); }
  };

  void certify(double arrival, double error) {
    bound_.kind = Bound::Kind::arrival;
    bound_.error_s = std::min(error, arrival);
    bound_.travel_s = arrival - bound_.error_s;
  }
  Bound prove_unreachable() {
    const double late = late_at_walls();
    const auto raised = run(kSpeedBar, 1, horizon_ + late, 0);
    if (!count(raised)) return cut();
    if (raised.reached()) {  // within the bar of the horizon: the faster vehicle's arrival is a bound
      certify(horizon_, std::max(0.0, horizon_ - *raised.arrival) + late + kLeastError * horizon_);
      return std::move(bound_);
    }
    bound_.kind = Bound::Kind::unreachable;
    bound_.travel_s = std::nan("");
    char text[256];
    std::snprintf(
        text, sizeof text,
        "no vehicle with this speed and dive schedule, free to turn at every instant, reaches the goal within "
        "the horizon of %s, not even %.1f %% faster",
        hours(horizon_).c_str(), 100 * kSpeedBar);
    bound_.reason = text;
    return std::move(bound_);
  }
  Bound nothing(std::string reason) {
    bound_.kind = Bound::Kind::cut;
    bound_.travel_s = std::nan("");
    bound_.reason = std::move(reason);
    return std::move(bound_);
  }
  [[nodiscard]] double late_at_walls() const {
    const double spacings = met_shallows_ || met_dry_ ? kCorners : met_coast_ ? kCoasts : 0.0;
    return spacings * spacing_ / problem_.glider.horizontal_speed.si();
  }
  Bound cut() { return nothing("the front was stopped before it came to the goal"); }

  /// The arrival that is looked for before a known one. Markers that cannot be there in time stop; so the room over the known arrival, for a
  /// front that comes late round corners, is made only where it is needed.
  [[nodiscard]] Outcome before_known(double coarser, int isochrones) const {
    auto first = run(0, coarser, std::min(horizon_, 1.02 * known_), isochrones);
    if (first.reached() || !first.arrival || first.until >= horizon_) return first;
    auto second = run(0, coarser, std::min(horizon_, 1.1 * known_), isochrones);
    second.statistics += first.statistics;
    second.most_markers = std::max(first.most_markers, second.most_markers);
    return second;
  }
  /// No state of this object is changed: several may run at once.
  [[nodiscard]] Outcome run(double raised, double coarser, double until, int isochrones,
                            bool open_water = false) const {
    static const chart::Chart kOpen;
    const ocean::FloodedField dive{ocean_.dive}, surface{ocean_.surface};
    const ocean::Ocean flooded{dive, surface};
    Run one{problem_,
            open_water ? flooded : ocean_,
            open_water ? kOpen : chart_,
            problem_.glider.horizontal_speed.si() * (1 + raised),
            coarser * spacing_,
            coarser * step_,
            until};
    Outcome found;
    const auto end = one.go(budget_, isochrones);
    if (end != Run::End::cut) found.arrival = end == Run::End::reached ? one.arrival() : std::nan("");
    found.until = until;
    found.statistics.expansions = one.steps();
    found.statistics.current_evaluations = one.evaluations();
    found.most_markers = one.most_markers();
    found.met_coast = one.met_coast();
    found.met_shallows = one.met_shallows();
    found.met_dry = one.met_dry();
    if (isochrones > 0) found.isochrones = one.isochrones();
    return found;
  }
  /// Adds a run to the answer. False when it was cut, or when all runs together did more than they may.
  bool count(const Outcome& found) {
    bound_.statistics += found.statistics;
    bound_.most_markers = std::max(bound_.most_markers, found.most_markers);
    met_coast_ = met_coast_ || found.met_coast;
    met_shallows_ = met_shallows_ || found.met_shallows;
    met_dry_ = met_dry_ || found.met_dry;
    return found.arrival && bound_.statistics.expansions <= budget_.work;
  }

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  const Budget& budget_;
  const BoundSettings& settings_;
  double spacing_, step_, horizon_;
  double known_;  ///< arrival, seconds from the fix
  bool met_coast_{}, met_shallows_{}, met_dry_{};
  Bound bound_;
};

}  // namespace

Expected<Bound, PlanFailure> lower_bound(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
                                         const Budget& budget, const BoundSettings& settings) {
  if (auto wrong = check_ends(problem, ocean, chart)) return unexpected(*wrong);
  return Certificate{problem, ocean, chart, budget, settings}.make();
}

double front_arrival(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres spacing,
                     Seconds step) {
  Run run{problem,
          ocean,
          chart,
          problem.glider.horizontal_speed.si(),
          spacing.si(),
          step.count(),
          problem.horizon_s - problem.start.fix_s};
  return run.go({}, 0) == Run::End::reached ? run.arrival() : std::nan("");
}

}  // namespace glidehelm::planning
