#include "simulator/coastal.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using simulator::CoastalField;
using simulator::CoastalSpec;
using simulator::Variant;

namespace {

CoastalSpec sea(std::uint64_t seed = 1) {
  CoastalSpec s;
  s.seed = seed;
  s.west_deg = 3;
  s.east_deg = 5.5;
  s.south_deg = 40;
  s.north_deg = 42.5;
  s.from = geo_point(40.6, 3.8);
  s.to = geo_point(41.6, 4.6);
  s.start_s = 1.7e9;
  return s;
}

}  // namespace

TEST_CASE("the flow is the curl of the stream function, and free of divergence") {
  const CoastalField field{sea(), Variant::truth};
  const double t = 1.7e9 + 7 * 3600.0;
  // Central differences over ±h of a smooth function of length scale ≥ 3 km (σ of the smallest eddy): the relative
  // error is (h/σ)²/6 ≤ 2e-6 for h = 10 m, of flows below 1 m/s; the difference of ψ ~ 1e4 m²/s loses 1e-16·1e4/20.
  constexpr double h = 10;
  for (double x = -90e3; x < 90e3; x += 17e3)
    for (double y = -110e3; y < 110e3; y += 19e3) {
      const auto c = field.flow(x, y, t);
      const double dx = (field.stream_function(x + h, y, t) - field.stream_function(x - h, y, t)) / (2 * h);
      const double dy = (field.stream_function(x, y + h, t) - field.stream_function(x, y - h, t)) / (2 * h);
      CHECK(c.east == Approx(-dy).margin(1e-5));
      CHECK(c.north == Approx(dx).margin(1e-5));
      const double divergence = (field.flow(x + h, y, t).east - field.flow(x - h, y, t).east +
                                 field.flow(x, y + h, t).north - field.flow(x, y - h, t).north) /
                                (2 * h);
      // The field's own derivatives are of 0.1 m/s over 3 km = 3e-5 1/s; differences err by 2e-6 of that.
      CHECK(std::fabs(divergence) < 1e-9);
    }
}

TEST_CASE("the straight way lies in an opposing jet with a favourable one beside it") {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    auto spec = sea(seed);
    spec.eddies = 0;
    spec.tide = 0;
    const CoastalField field{spec, Variant::forecast};
    const auto way = geodesic(spec.from, spec.to);
    const auto along = [&](double share, double side_m) {
      const auto p = destination(destination(spec.from, way.departing, way.length * share), way.departing + degrees(90),
                                 Metres{side_m});
      const auto c = field.sample(p, Depth{}, spec.start_s);
      REQUIRE(c);
      return c->current.east.si() * way.departing.east() + c->current.north.si() * way.departing.north();
    };
    CHECK(along(0.3, 0) == Approx(-spec.jet).margin(0.01));
    CHECK(along(0.7, 0) == Approx(-spec.jet).margin(0.01));
    CHECK(std::max(along(0.5, 14e3), along(0.5, -14e3)) == Approx(spec.counter_jet).margin(0.01));
  }
}

TEST_CASE("the fastest eddy is at most as fast as asked and at least half, at half its diameter") {
  auto spec = sea();
  spec.jet = spec.counter_jet = spec.tide = 0;
  spec.eddies = 1;
  const CoastalField field{spec, Variant::forecast};
  REQUIRE(field.eddy_count() == 1);
  double fastest = 0;
  for (double x = -140e3; x < 140e3; x += 1e3)
    for (double y = -170e3; y < 170e3; y += 1e3) {
      const auto c = field.flow(x, y, spec.start_s);
      fastest = std::max(fastest, std::hypot(c.east, c.north));
    }
  // On a 1 km raster the ring of fastest flow (σ ≥ 12.5 km, curvature 1/σ²) is met within (0.7/12.5)²: 0.3 %.
  CHECK(fastest <= 0.12 + 1e-9);
  CHECK(fastest >= 0.06 * 0.997);
  CHECK(field.fastest().si() >= fastest);
}

TEST_CASE("the tide turns with M2, and truth and forecast differ by the lag asked for") {
  auto spec = sea();
  spec.jet = spec.counter_jet = spec.noise = 0;
  spec.eddies = 0;
  const CoastalField forecast{spec, Variant::forecast}, truth{spec, Variant::truth};
  const auto p = geo_point(41, 4);
  const auto at = [&](const CoastalField& f, double t) { return f.sample(p, Depth{}, t)->current; };
  constexpr double period = 12.4206012 * 3600;
  const double t = spec.start_s;
  CHECK(at(forecast, t + period).east.si() == Approx(at(forecast, t).east.si()).margin(1e-6));
  CHECK(at(forecast, t + period / 2).north.si() == Approx(-at(forecast, t).north.si()).margin(1e-6));
  // A lag in phase of 15° is period/24 earlier in the truth.
  CHECK(at(truth, t).east.si() == Approx(at(forecast, t + period / 24).east.si()).margin(1e-6));
  for (double s = 0; s < period; s += period / 16) CHECK(at(forecast, t + s).speed().si() <= 0.10 + 1e-9);
}

TEST_CASE("truth and forecast of one seed are alike and not equal, another seed is another sea") {
  const CoastalField forecast{sea(), Variant::forecast}, truth{sea(), Variant::truth}, other{sea(9), Variant::forecast};
  double same = 0, power = 0, error = 0, foreign = 0;
  for (double x = -90e3; x < 90e3; x += 5e3)
    for (double y = -110e3; y < 110e3; y += 5e3) {
      const auto f = forecast.flow(x, y, 1.7e9), t = truth.flow(x, y, 1.7e9), o = other.flow(x, y, 1.7e9);
      power += f.east * f.east + f.north * f.north;
      error += std::pow(f.east - t.east, 2) + std::pow(f.north - t.north, 2);
      foreign += std::pow(f.east - o.east, 2) + std::pow(f.north - o.north, 2);
      same += f.east * t.east + f.north * t.north;
    }
  CHECK(error > 0.005 * power);
  CHECK(error < 0.4 * power);  // a forecast worth planning on: correlation well above one half
  CHECK(foreign > 2 * error);
  CHECK(same > 0);
}

TEST_CASE("two fields of one specification are equal to the bit") {
  const CoastalField a{sea(), Variant::truth}, b{sea(), Variant::truth};
  for (int i = 0; i < 50; ++i) {
    const auto p = geo_point(40.1 + 0.04 * i, 3.1 + 0.04 * i);
    const auto ca = a.sample(p, Depth{}, 1.7e9 + 600 * i), cb = b.sample(p, Depth{}, 1.7e9 + 600 * i);
    CHECK(ca->current == cb->current);
  }
}

TEST_CASE("outside its area the sea has no current, and says so") {
  const CoastalField field{sea(), Variant::forecast};
  const auto s = field.sample(geo_point(39.99, 4), Depth{}, 1.7e9);
  REQUIRE_FALSE(s);
  CHECK(s.error() == ocean::NoCurrent::outside_area);
}

TEST_CASE("no current is faster than the bound") {
  const CoastalField field{sea(), Variant::truth};
  for (double lat = 40.02; lat < 42.5; lat += 0.07)
    for (double lon = 3.02; lon < 5.5; lon += 0.07)
      CHECK(field.sample(geo_point(lat, lon), Depth{}, 1.7e9 + 3e4)->current.speed() <= field.fastest());
}

TEST_CASE("jets and eddies fade with depth as stated, the tide does not") {
  auto spec = sea();
  spec.fading_m = 200;
  const CoastalField field{spec, Variant::truth};
  spec.eddy = spec.jet = spec.counter_jet = spec.noise = 0;
  const CoastalField tide{spec, Variant::truth};
  const auto p = geo_point(41.0, 4.2);
  const auto at = [&](const CoastalField& f, double z) {
    return f.sample(p, Depth{Metres{z}}, spec.start_s + 5e4)->current;
  };
  CHECK(at(tide, 300) == at(tide, 0));
  const double top = at(field, 0).east.si() - at(tide, 0).east.si();
  CHECK(std::fabs(top) > 0.01);
  CHECK(at(field, 300).east.si() - at(tide, 300).east.si() == Approx(top * std::exp(-1.5)));
}
