#include "core/vehicle/force_balance.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm;
using namespace glidehelm::vehicle;

namespace {

/// Water that is the same everywhere: then everything has a closed form but for the compression of the hull.
const WaterColumn& even_water() {
  static const WaterColumn water{{{Metres{0}, 10, 35}}};
  return water;
}
Hull stiff_hull() {
  Hull hull;
  hull.compressibility_per_pa = 0;
  hull.expansion_per_c = 0;
  hull.neutral_at = Metres{0};
  return hull;
}

}  // namespace

TEST_CASE("the angle of attack solves the balance of lift and drag, and the pitch leads back to it") {
  const Hull hull;
  for (const double pitch : {15.0, 26.0, 35.0, 60.0, 85.0}) {
    const auto alpha = angle_of_attack(hull, degrees(pitch));
    REQUIRE(alpha);
    const double a = alpha->si();
    CHECK(a > 0);
    // 2.40, to the rounding of its terms (about 0.1 each).
    CHECK(hull.lift_per_rad * a * std::tan(degrees(pitch).si() + a) ==
          Approx(hull.drag + hull.induced_drag_per_rad2 * a * a).margin(1e-11));
    CHECK(in_degrees(pitch_of(hull, *alpha)) == Approx(pitch).margin(1e-9));
  }
  // So steep that tan(θ + α) is nearly 1/(π/2 − θ − α): α is nearly C_D0·(π/2 − θ)/a, smaller than a tenth of a degree at 85°.
  CHECK(angle_of_attack(hull, degrees(85))->si() ==
        Approx(hull.drag * degrees(5).si() / hull.lift_per_rad).epsilon(0.03));
}

TEST_CASE("a pitch too flat for the wings is no flight") {
  CHECK_FALSE(angle_of_attack(Hull{}, degrees(0.5)));
  // At a stall of 8° the balance 2.40 asks for tan(θ + α) = (0.1 + 2.88·0.1396²)/(6.1·0.1396) = 0.1834: a pitch of 10.39° − 8° = 2.39°.
  CHECK_FALSE(angle_of_attack(Hull{}, degrees(2.38)));
  CHECK(angle_of_attack(Hull{}, degrees(2.40)));
  Hull no_wings;
  no_wings.lift_per_rad = 0.5;
  CHECK_FALSE(angle_of_attack(no_wings, degrees(10)));
  CHECK(angle_of_attack(no_wings, degrees(80)));
}

TEST_CASE("the forces of a steady glide cancel") {
  const auto hull = stiff_hull();
  const double density = even_water().density(Metres{0});
  for (const double net : {-2.0, 1.5}) {
    const auto glide = steady_glide(hull, degrees(26), net, density);
    REQUIRE(glide);
    const double u = glide->path.si(), a = glide->angle_of_attack.si(), gamma = glide->glide_angle.si();
    const double drag = 0.5 * density * hull.area_m2 * u * u * (hull.drag + hull.induced_drag_per_rad2 * a * a);
    const double lift = 0.5 * density * hull.area_m2 * u * u * hull.lift_per_rad * a;
    CHECK(lift * std::sin(gamma) == Approx(drag * std::cos(gamma)).epsilon(1e-9));
    CHECK(lift * std::cos(gamma) + drag * std::sin(gamma) == Approx(std::abs(net)).epsilon(1e-9));
    CHECK(std::signbit(glide->vertical.si()) == std::signbit(net));
    CHECK(glide->path.si() == Approx(std::hypot(glide->horizontal.si(), glide->vertical.si())));
  }
}

TEST_CASE("the Thesis' glider comes out: half a metre a second at a pitch of 35 degrees and 200 cc") {
  // Thesis 2.2.3: at ΔV = 200 cc the vertical speed without lift is about 0.8 m/s, which by B.10 means a drag coefficient of
  // 2·g·200e-6/(0.1·0.8²) = 0.0613 (the water's density cancels); then the greatest horizontal speed is about 0.5 m/s, at a pitch of about
  // 35° and an angle of attack of about 1°. The figures are read off a drawing: a tenth of them, or 5°, is what they are worth.
  auto hull = stiff_hull();
  hull.drag = 2 * kGravity * 200e-6 / (hull.area_m2 * 0.8 * 0.8);
  const double net = net_buoyancy(hull, even_water(), Metres{0}, 200e-6), density = even_water().density(Metres{0});
  CHECK(float_speed(hull, net, density).si() == Approx(0.8).epsilon(1e-6));
  double best = 0, at = 0, attack = 0;
  const auto curves = glide_polar(hull, even_water(), Metres{0}, {200e-6});
  for (const auto& p : curves.front())
    if (p.horizontal.si() > best) {
      best = p.horizontal.si();
      at = in_degrees(p.pitch);
      attack = in_degrees(p.angle_of_attack);
    }
  CHECK(best == Approx(0.5).epsilon(0.1));
  CHECK(at == Approx(35).margin(5));
  CHECK(attack == Approx(1).margin(0.5));
}

TEST_CASE("speeds grow with the root of what the pump moves, and dives mirror climbs in even water") {
  const auto hull = stiff_hull();
  const auto curves = glide_polar(hull, even_water(), Metres{0}, {100e-6, 400e-6, -100e-6});
  for (std::size_t k = 0; k < curves[0].size(); ++k) {
    CHECK(curves[1][k].horizontal.si() == Approx(2 * curves[0][k].horizontal.si()));
    CHECK(curves[2][k].vertical.si() == Approx(-curves[0][k].vertical.si()));
  }
}

TEST_CASE("the mean over a yo in even water is the glide itself") {
  auto hull = stiff_hull();
  // Pressure alone changes the density of even water: by 0.45 % per 1000 m, 4.6e-6 of the volume times 70 l = 32 cc over 100 m. So the two halves
  // are equal only near the neutral depth: 5 m around it the change is 1.6 cc of 230, and speeds go with its root: 0.4 %.
  hull.neutral_at = Metres{50};
  const auto means = yo_means(hull, Trim{}, even_water(), Metres{45}, Metres{55});
  REQUIRE(means);
  const auto glide = steady_glide(hull, degrees(26), net_buoyancy(hull, even_water(), Metres{50}, 230e-6),
                                  even_water().density(Metres{50}));
  CHECK(means->horizontal.si() == Approx(glide->horizontal.si()).epsilon(4e-3));
  CHECK(means->glide_angle.si() == Approx(glide->glide_angle.si()).epsilon(1e-9));
  CHECK(means->down.count() == Approx(10 / std::abs(glide->vertical.si())).epsilon(8e-3));
}

TEST_CASE("a glider that is too light to sink says where and by how much") {
  Hull hull;
  hull.neutral_at = Metres{0};  // trimmed at a warm surface: colder water below carries it
  Trim trim;
  trim.pumped_down_m3 = -20e-6;
  const auto means = yo_means(hull, trim, WaterColumn::climatological(), Metres{0}, Metres{200});
  REQUIRE_FALSE(means);
  CHECK(means.error().find("the glider does not sink at") == 0);
  CHECK(means.error().find("g too light") != std::string::npos);
  trim = {};
  trim.pitch_up = degrees(0.5);
  CHECK(yo_means(Hull{}, trim, WaterColumn::climatological(), Metres{0}, Metres{200}).error().find("too flat") !=
        std::string::npos);
}

TEST_CASE("a float with its neutral volume neither sinks nor climbs") {
  const Hull hull;
  const auto water = WaterColumn::climatological();
  for (const double z : {10.0, 500.0, 1000.0}) {
    const double pumped = neutral_volume(hull, water, Metres{z});
    // Weight and buoyancy are 700 N each: their difference is zero to 1e-12 of that.
    CHECK(net_buoyancy(hull, water, Metres{z}, pumped) == Approx(0).margin(1e-9));
    CHECK(float_speed(hull, net_buoyancy(hull, water, Metres{z}, pumped + 10e-6), water.density(Metres{z})).si() > 0);
  }
}

TEST_CASE("the wing's slope and induced drag are those of the formulas") {
  // 2.37 by hand for A = 7, Ω = 43°: tan² = 0.86957, √(49·1.86957 + 4) = 9.77819; 2π·7/11.77819 = 3.73420. (Merckelbach et al. use 3.7.)
  CHECK(wing_lift_slope(7, degrees(43)) == Approx(3.7342).margin(2e-4));
  // 2.35: 3.7342²/(π·7·0.8) = 0.79260. (Merckelbach et al. use 0.78.)
  CHECK(wing_induced_drag(3.7342, 7) == Approx(0.7926).margin(1e-4));
}
