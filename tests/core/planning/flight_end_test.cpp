#include "core/planning/flight_end.hpp"

#include <catch2/catch.hpp>

#include "tests/contract/planner_contract.hpp"
#include "tests/support/random_sea.hpp"

using namespace glidehelm;

namespace {

std::vector<double> headings_about(test::Dice& dice, std::size_t n, double middle) {
  std::vector<double> headings;
  for (std::size_t i = 0; i < n; ++i) headings.push_back(middle + dice.between(-0.5, 0.5));
  return headings;
}

}  // namespace

TEST_CASE("in still water the end answers to each heading as the end of a chain of equal links") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto from = geo_point(0, 10);
  const auto p = test::problem_between(from, destination(from, Bearing{degrees(50)}, Metres{60e3}));
  const chart::Chart open;
  planning::FlightEndings endings{p, ocean, open, Metres{0}, Metres{0}};
  const std::vector<double> headings{0.3, 0.9, 1.4};
  const double until = p.start.fix_s + p.schedule.surfacing_time(2).count();
  const auto end = endings.end_with_slopes(headings, until);
  // At the equator east is the second axis turned by the longitude, north the third. A turn moves the end by the way of a stint at a
  // right angle to the heading. The metric over 30 km differs from that at the start by (30/6378)² = 2e-5, the difference of a
  // sine over the turn of 250 m by (250/8640)²/6 = 1.4e-4.
  const double way = test::kSpeed * test::kStint;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double h = headings[static_cast<std::size_t>(k)];
    const double lon = from.lon.radians();
    const Eigen::Vector3d expected = way * (std::cos(h) * Eigen::Vector3d{-std::sin(lon), std::cos(lon), 0} -
                                            std::sin(h) * Eigen::Vector3d{0, 0, 1});
    // The tangents at the end are turned by 30/6378 against those at the start.
    CHECK((end.off_by_turn.col(k) - expected).norm() < 0.006 * way);
    CHECK(end.off_by_turn.col(k).norm() == Approx(way).epsilon(3e-4));
  }
  CHECK(end.off.norm() == Approx(endings.end(headings, until).off.norm()).epsilon(1e-12));
}

TEST_CASE("slopes of distance and toll are those of whole flights turned a little") {
  test::Dice dice{0x5EED1ULL};
  const auto origin = geo_point(43, 5);
  const auto specs = test::random_sea(dice, origin, 0.25, 0.05, -0.03);
  const auto eddies = ocean::AnalyticField::make(specs[0], instant_at(test::kT0));
  REQUIRE(eddies);
  const ocean::Ocean ocean{*eddies, *eddies};
  auto p = test::problem_between(origin, destination(origin, Bearing{degrees(70)}, Metres{80e3}));
  const auto chart = test::block_between(origin, destination(origin, Bearing{degrees(70)}, Metres{36e3}), 7e3);
  const auto buffer = Metres{1000};
  planning::FlightEndings endings{p, ocean, chart, Metres{2000}, buffer};
  int paid = 0;
  for (int round = 0; round < 12; ++round) {
    const auto headings = headings_about(dice, 5, 70 * kPi / 180);
    const double until = p.start.fix_s + p.schedule.dive_time(4).count() + dice.between(0.3, 1.0) * test::kStint;
    const auto slopes = endings.end_with_slopes(headings, until);
    paid += slopes.toll > 0 ? 1 : 0;
    for (std::size_t k = 0; k < headings.size(); ++k) {
      const double turn = 1e-3;
      auto right = headings, left = headings;
      right[k] += turn;
      left[k] -= turn;
      const auto a = endings.end(right, until), b = endings.end(left, until);
      const auto column = static_cast<Eigen::Index>(k);
      INFO("round " << round << ", stint " << k);
      // Both are central differences, of 250 m (83 m with a buffer) and of 9 m. Eddies are 12 km wide or more: the wider is wrong by
      // (83/12000)²/6 = 8e-6 of the slope in each of five links, by less than 1e-3 also where a link multiplies it tenfold.
      const Eigen::Vector3d whole = (a.off - b.off) / (2 * turn);
      CHECK((slopes.off_by_turn.col(column) - whole).norm() < 1e-3 * test::kSpeed * test::kStint * 5);
      // Toll bends within the buffer of 1 km: a third of its slope's scale (1 per buffer and metre flown in it) over a step of 83 m.
      const double toll = (a.toll - b.toll) / (2 * turn);
      CHECK(std::abs(slopes.toll_by_turn[column] - toll) < 0.1 * std::abs(toll) + 0.02 * test::kSpeed * test::kStint);
    }
  }
  CHECK(paid >= 3);  // the block is really met
}

TEST_CASE("stints after the instant count nothing, and a flight out of the data ends there") {
  const auto box = test::box_around(geo_point(28, -16), 0.2);
  const test::FromFunction small{[](double, double, double) { return std::pair{0.0, 0.0}; }, 0, box};
  const ocean::Ocean ocean{small, small};
  const auto from = geo_point(28, -16);
  const auto p = test::problem_between(from, destination(from, Bearing{degrees(90)}, Metres{15e3}));
  const chart::Chart open;
  planning::FlightEndings endings{p, ocean, open, Metres{0}, Metres{0}};
  const std::vector<double> east(5, kPi / 2);
  const double first = p.start.fix_s + p.schedule.surfacing_time(0).count();
  const auto one = endings.end_with_slopes(east, first);
  CHECK(one.off_by_turn.col(0).norm() > 8000);
  for (Eigen::Index k = 1; k < 5; ++k) CHECK(one.off_by_turn.col(k).norm() == 0);
  // The edge is 0.2° of latitude, 22 km, to the east: five stints of 8.6 km do not fit.
  const auto out = endings.end(east, p.start.fix_s + p.schedule.surfacing_time(4).count());
  CHECK(out.off.norm() < 8.6e3);
}
