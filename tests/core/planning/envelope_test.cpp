#include "core/planning/envelope.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;
using planning::Envelope;

namespace {

/// Metres covered from a surfacing on after `t` seconds, second by second: what least_time inverts.
double covered(const Envelope& e, double t) {
  double metres = 0;
  for (int s = 0; s < static_cast<int>(t); ++s)
    metres += std::fmod(s, e.surface + e.stint) < e.surface ? e.drift : e.dive;
  return metres;
}

}  // namespace

TEST_CASE("the least time is that of drifting and diving straight on at full speed") {
  for (const Envelope e : {Envelope{0.8, 0.5, 3600, 900}, Envelope{0.3, 0.0, 3600, 900}, Envelope{0.4, 1.5, 3600, 900},
                           Envelope{0.5, 0.2, 3600, 0}})
    for (const double t : {1.0, 450.0, 899.0, 2000.0, 4499.0, 4501.0, 12345.0}) {
      const double metres = covered(e, t);
      if (metres == 0) continue;
      // Where nothing moves in a drift the same metres are reached at its beginning already.
      INFO(e.dive << " " << e.drift << " after " << t);
      CHECK(e.least_time(metres) <= t + 1e-6);
      if (e.drift > 0) CHECK(e.least_time(metres) == Approx(t));
    }
}

TEST_CASE("it grows with the distance and is consistent over one stint") {
  for (const Envelope e : {Envelope{0.8, 0.5, 3600, 900}, Envelope{0.3, 0.0, 3600, 900}}) {
    double before = 0;
    for (double d = -100; d < 20e3; d += 37) {
      const double h = e.least_time(d);
      CHECK(h >= before);
      CHECK(h <= e.surface + e.stint + e.least_time(d - e.cycle()) + 1e-6);
      before = h;
    }
    CHECK(e.least_time(-1) == 0);
    CHECK(e.least_time(0) == 0);
  }
}

TEST_CASE("from a fix the first drift and stint have their own lengths, still water gives the schedule's travel time") {
  model::DiveSchedule schedule;
  schedule.first_stint = Seconds{1800};
  schedule.stint = Seconds{3600};
  schedule.surface = Seconds{600};
  schedule.time_to_dive = Seconds{1200};
  const Envelope still{0.3, 0.0, 3600, 600};
  for (const double underwater : {10.0, 1700.0, 1900.0, 5000.0, 12000.0})
    CHECK(still.least_time_from_fix(0.3 * underwater, schedule) ==
          Approx(schedule.travel_time(Seconds{underwater}).count()));
  const Envelope windy{0.3, 0.5, 3600, 600};
  CHECK(windy.least_time_from_fix(300, schedule) == Approx(600));  // within the first drift
  CHECK(windy.least_time_from_fix(600 + 540 + 300, schedule) == Approx(1200 + 1800 + 600));
}
