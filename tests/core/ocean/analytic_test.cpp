#include "core/ocean/analytic.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;
using analytic::Uv;

namespace {

constexpr double kH = 1e-5;
/// Central differences of second order: truncation h²/6·|f'''| ≈ 2e-11·|f'''| and cancellation 1e-16/h = 1e-11·|f|. The
/// third derivatives of the test functions stay below 1e3, so 1e-7 is safe by a factor of five.
constexpr double kDifference = 1e-7;

template <class K>
void stream_gives_velocity(const K& kind, double width, double height) {
  std::mt19937_64 random{5};
  std::uniform_real_distribution<double> xs{-width, width}, ys{-height, height}, ts{-20, 20};
  for (int n = 0; n < 500; ++n) {
    const double x = xs(random), y = ys(random), t = ts(random);
    const Uv uv = kind.at(x, y, t);
    INFO("x " << x << ", y " << y << ", t " << t);
    CHECK(uv.u == Approx(-(kind.stream(x, y + kH, t) - kind.stream(x, y - kH, t)) / (2 * kH)).margin(kDifference));
    CHECK(uv.v == Approx((kind.stream(x + kH, y, t) - kind.stream(x - kH, y, t)) / (2 * kH)).margin(kDifference));
  }
}

template <class K>
double divergence(const K& kind, double x, double y, double t) {
  return (kind.at(x + kH, y, t).u - kind.at(x - kH, y, t).u + kind.at(x, y + kH, t).v - kind.at(x, y - kH, t).v) /
         (2 * kH);
}
template <class K>
void has_no_divergence(const K& kind, double width, double height) {
  std::mt19937_64 random{6};
  std::uniform_real_distribution<double> xs{-width, width}, ys{-height, height}, ts{-20, 20};
  for (int n = 0; n < 500; ++n) CHECK(std::abs(divergence(kind, xs(random), ys(random), ts(random))) < kDifference);
}

AnalyticSpec spec(const std::string& kind, std::vector<std::pair<std::string, double>> params = {}) {
  AnalyticSpec s;
  s.kind = kind;
  s.origin = geo_point(40, 5);
  s.length_scale = Metres{20000};
  s.speed_scale = MetresPerSecond{0.25};
  s.params = std::move(params);
  if (kind == "gaussians") s.gaussians = {{3, 0, 0, 1, 0.2, 0.5, 0.1, 0}, {-2, 2, 1, 0.3, 0, 0.3, 0, 0}};
  return s;
}
const std::vector<std::string> kKinds{"constant",    "source", "sink",  "solid-body", "shear",
                                      "double-eddy", "stuart", "tiled", "jet",        "gaussians"};

AnalyticField made(const AnalyticSpec& s, const Coverage& box = {}) {
  const auto field = AnalyticField::make(s, Instant{}, box);
  REQUIRE(field);
  return *field;
}
Coverage box_around_origin() {
  Coverage box;
  box.south = 38.5 * kPi / 180;
  box.north = 41 * kPi / 180;
  box.west = 3 * kPi / 180;
  box.east = 6 * kPi / 180;
  return box;
}

}  // namespace

TEST_CASE(
    "velocities are the derivatives of their stream functions, with the errata of the jet and the Stuart vortex") {
  stream_gives_velocity(analytic::DoubleEddy{}, 2, 1);
  stream_gives_velocity(analytic::Stuart{}, 6, 3);
  stream_gives_velocity(analytic::Tiled{false}, 20, 20);
  stream_gives_velocity(analytic::Tiled{true}, 20, 20);
  stream_gives_velocity(analytic::Jet{}, 12, 4);
  stream_gives_velocity(analytic::Gaussians{{{3, 0, 0, 1, 0.2, 0.5, 0.1, 0}, {-2, 2, 1, 0.3, 0, 0.3, 0, -0.05}}}, 4, 4);
}

TEST_CASE("fields of eddies have no divergence, a source has two") {
  has_no_divergence(analytic::DoubleEddy{}, 2, 1);
  has_no_divergence(analytic::Stuart{}, 6, 3);
  has_no_divergence(analytic::Tiled{true}, 20, 20);
  has_no_divergence(analytic::Jet{}, 12, 4);
  has_no_divergence(analytic::Gaussians{{{3, 0, 0, 1, 0.2, 0.5, 0.1, 0}}}, 4, 4);
  has_no_divergence(analytic::SolidBody{2}, 4, 4);
  has_no_divergence(analytic::Shear{2}, 4, 4);
  CHECK(divergence(analytic::Source{1}, 0.3, -2, 1) == Approx(2).margin(kDifference));
  CHECK(divergence(analytic::Source{-1}, 0.3, -2, 1) == Approx(-2).margin(kDifference));
}

TEST_CASE("known values of the analytic fields") {
  // Double eddy of Thesis 5.15 at t = 0 (f = x): u = −πA sin(πx) cos(πy), v = πA cos(πx) sin(πy).
  const analytic::DoubleEddy eddy;
  CHECK(eddy.at(0.5, 0, 0).u == Approx(-kPi * 0.1));
  CHECK(eddy.at(0.5, 0, 0).v == Approx(0).margin(1e-15));
  CHECK(eddy.at(0, 0.5, 0).v == Approx(kPi * 0.1));
  // The dividing line x = 1 moves, the walls y = 0 and y = 1 stay: no flow through them at any time.
  for (const double t : {0.0, 0.2, 0.7}) CHECK(eddy.at(0.37, 1, t).v == Approx(0).margin(1e-15));
  // Stuart: far north the current tends to 2, far south to 0; on the axis at x = t it is u = 1, v = 0.
  const analytic::Stuart stuart;
  CHECK(stuart.at(0.3, 40, 0).u == Approx(2));
  CHECK(stuart.at(0.3, -40, 0).u == Approx(0).margin(1e-15));
  CHECK(stuart.at(2, 0, 2).u == 1);
  CHECK(stuart.at(2, 0, 2).v == Approx(0).margin(1e-16));
  CHECK(std::isfinite(stuart.at(0, 1e5, 0).u));
  // Jet on its axis where the meander turns (x = ct): Q = 0, A_x = 0, so u = 1 and v = 0. ωt + θ = π/2 at t = 0: B = B0.
  const analytic::Jet jet;
  CHECK(jet.at(0, 1.2, 0).u == Approx(1));
  CHECK(jet.at(0, 1.2, 0).v == Approx(0).margin(1e-15));
  CHECK(jet.at(0, 1e6, 0).u == 0);
  // Tiled eddies.
  CHECK(analytic::Tiled{false}.at(kPi / 2, kPi / 2, 9).u == -1);
  CHECK(analytic::Tiled{true}.at(kPi / 2, 0, kPi / 2).u == -1);
  // Solid body: counter-clockwise.
  CHECK(analytic::SolidBody{2}.at(1, 0, 0).v == 2);
  CHECK(analytic::SolidBody{2}.at(0, 1, 0).u == -2);
  // A hill of sea surface turns clockwise in the north: eastward current on its northern side.
  CHECK(analytic::Gaussians{{{1, 0, 0, 1, 0, 1, 0, 0}}}.at(0, 1, 0).u == Approx(std::exp(-0.5) / (2 * kPi)));
}

TEST_CASE("the meandering jet is that of Eichhorn's equation 7, evaluated as printed") {
  // φ = 1 − tanh((y − B cos(k(x − ct)))/√(1 + k²B² sin²(k(x − ct)))), u = −∂φ/∂y, v = ∂φ/∂x.
  const auto phi = [](double x, double y, double t) {
    const double b = 1.2 + 0.3 * std::cos(0.4 * t + kPi / 2), p = 0.84 * (x - 0.12 * t);
    return 1 - std::tanh((y - b * std::cos(p)) / std::sqrt(1 + 0.84 * 0.84 * b * b * std::sin(p) * std::sin(p)));
  };
  const analytic::Jet jet;
  for (double x = -6; x < 6; x += 0.7)
    for (double y = -2; y < 2; y += 0.3) {
      CHECK(jet.at(x, y, 3).u == Approx(-(phi(x, y + kH, 3) - phi(x, y - kH, 3)) / (2 * kH)).margin(kDifference));
      CHECK(jet.at(x, y, 3).v == Approx((phi(x + kH, y, 3) - phi(x - kH, y, 3)) / (2 * kH)).margin(kDifference));
    }
}

TEST_CASE("scales: a current of V·(u, v) at x = N cos φ0·Δλ/L, y = M·Δφ/L, t in L/V unless said") {
  const auto field = made(spec("solid-body", {{"omega", 1}}));
  const auto metric = LocalMetric::at(40 * kPi / 180);
  const auto at = field.sample(geo_point(40.1, 5.2), Depth{}, 0);
  REQUIRE(at);
  CHECK(at->current.east.si() == Approx(-0.25 * 0.1 * kPi / 180 * metric.meridian_radius / 20000).epsilon(1e-12));
  CHECK(at->current.north.si() == Approx(0.25 * 0.2 * kPi / 180 * metric.parallel_radius / 20000).epsilon(1e-12));

  // Dynamic tiles: one time unit is L/V = 80000 s, or what is given.
  auto tiles = spec("tiled", {{"dynamic", 1}});
  CHECK(made(tiles).sample(tiles.origin, Depth{}, 80000)->current.east.si() == Approx(-0.25 * std::sin(1.0)));
  tiles.time_scale = Seconds{1000};
  tiles.t0 = instant_at(500);
  CHECK(made(tiles).sample(tiles.origin, Depth{}, 1500)->current.east.si() == Approx(-0.25 * std::sin(1.0)));
}

TEST_CASE("south turns both components around") {
  for (const auto& kind : kKinds) {
    auto s = spec(kind);
    if (kind == "constant") s.params = {{"u", 0.3}, {"v", 0.1}};
    const auto north = made(s);
    s.south = true;
    const auto south = made(s);
    const auto a = north.sample(geo_point(40.2, 5.3), Depth{}, 1e4),
               b = south.sample(geo_point(40.2, 5.3), Depth{}, 1e4);
    CHECK(a->current.east == -b->current.east);
    CHECK(a->current.north == -b->current.north);
    CHECK(north.fastest() == south.fastest());
  }
}

TEST_CASE("the plane is continuous across the antimeridian") {
  auto s = spec("shear");
  s.kind = "solid-body";
  s.origin = geo_point(0, 179.9);
  const auto field = made(s);
  CHECK(field.plane(geo_point(0, -179.9)).u == Approx(-field.plane(geo_point(0, 179.7)).u).epsilon(1e-9));
}

TEST_CASE("fastest bounds every sample within the coverage and is not far above it") {
  std::mt19937_64 random{8};
  const auto box = box_around_origin();
  for (const auto& kind : kKinds) {
    auto s = spec(kind);
    if (kind == "constant") s.params = {{"u", 0.3}, {"v", 0.1}};
    const auto field = made(s, box);
    std::uniform_real_distribution<double> lat{38.5, 41}, lon{3, 6}, t{-1e6, 1e6};
    double found = 0;
    for (int n = 0; n < 40000; ++n)
      found =
          std::max(found, field.sample(geo_point(lat(random), lon(random)), Depth{}, t(random))->current.speed().si());
    for (const double a : {38.5, 41.0})
      for (const double o : {3.0, 6.0})
        found = std::max(
            found, field
                       .sample(GeoPoint::from_kernel(a == 41.0 ? box.north : box.south, o == 6.0 ? box.east : box.west),
                               Depth{}, 0)
                       ->current.speed()
                       .si());
    INFO(kind);
    CHECK(found <= field.fastest().si());
    // The bounds of the double eddy (whose f grows with x) and of the Gaussians add up what never meets.
    CHECK(field.fastest().si() <= found * 2.5);
  }
}

TEST_CASE("the bound of the jet's constant: q·sech² q stays below 0.4480") {
  double largest = 0;
  for (double q = 0; q < 5; q += 1e-5) largest = std::max(largest, q / std::pow(std::cosh(q), 2));
  CHECK(largest < 0.4480);
  CHECK(largest > 0.4476);
}

TEST_CASE("outside its coverage a field has no current") {
  const auto field = made(spec("tiled"), box_around_origin());
  const auto outside = field.sample(geo_point(45, 5), Depth{}, 0);
  REQUIRE_FALSE(outside);
  CHECK(outside.error() == NoCurrent::outside_area);
  Coverage timed = box_around_origin();
  timed.first_s = 0;
  timed.last_s = 100;
  timed.holds_outside = false;
  const auto late = made(spec("tiled"), timed).sample(geo_point(40, 5), Depth{}, 101);
  REQUIRE_FALSE(late);
  CHECK(late.error() == NoCurrent::outside_time);
}

TEST_CASE("a whole globe still has a finite bound that holds at the far side") {
  const auto field = made(spec("source"));
  const auto far = field.sample(geo_point(-89, -175.0001), Depth{}, 0);
  CHECK(far->current.speed() < field.fastest());
  CHECK(std::isfinite(field.fastest().si()));
}

TEST_CASE("specifications that make no field are refused with what is allowed") {
  const auto refused = [](AnalyticSpec s) {
    const auto field = AnalyticField::make(s, Instant{});
    REQUIRE_FALSE(field);
    return field.error().message();
  };
  CHECK(refused(spec("vortex")).find("allowed: constant, source") != std::string::npos);
  CHECK(refused(spec("jet", {{"B1", 1}})) == "jet has no parameter B1; allowed: B0, epsilon, omega, theta, k, c");
  CHECK(refused(spec("source", {{"x", 1}})) == "source has no parameter x; allowed: none");
  CHECK(refused(spec("shear", {{"rate", std::nan("")}})) == "parameter rate of shear is not a finite number");
  auto s = spec("tiled");
  s.length_scale = Metres{0};
  CHECK(refused(s) == "length_scale_m must be positive");
  s = spec("tiled");
  s.time_scale = Seconds{-1};
  CHECK(refused(s) == "time_scale_s must be positive");
  s = spec("gaussians");
  s.gaussians[1][4] = 0.4;
  CHECK(refused(s) == "gaussians row 2 has a covariance that is not positive definite");
  s.gaussians = {};
  CHECK(refused(s) == "gaussians needs at least one row in list");
}

TEST_CASE("fields add: currents, bounds and the overlap of their boxes") {
  const auto tiles = made(spec("tiled"), box_around_origin());
  const auto jet = made(spec("jet"));
  const FieldSum sum{{FieldRef{jet}, FieldRef{tiles}}};
  const auto p = geo_point(40.3, 5.5);
  const auto a = tiles.sample(p, Depth{}, 1e4), b = jet.sample(p, Depth{}, 1e4), both = sum.sample(p, Depth{}, 1e4);
  CHECK(both->current.east == a->current.east + b->current.east);
  CHECK(both->current.north == a->current.north + b->current.north);
  CHECK(sum.fastest() == tiles.fastest() + jet.fastest());
  CHECK(sum.coverage() == tiles.coverage());
  CHECK(sum.sample(geo_point(45, 5), Depth{}, 0).error() == NoCurrent::outside_area);
}

TEST_CASE("boxes of a sum overlap also when they are counted from different turns of the globe") {
  Coverage east, west;
  east.west = 170 * kPi / 180;
  east.east = 190 * kPi / 180;
  west.west = -185 * kPi / 180;
  west.east = -160 * kPi / 180;
  const auto a = made(spec("tiled"), east), b = made(spec("tiled"), west);
  const auto box = FieldSum{{FieldRef{a}, FieldRef{b}}}.coverage();
  CHECK(box.west == Approx(175 * kPi / 180));
  CHECK(box.east == Approx(190 * kPi / 180));
}
