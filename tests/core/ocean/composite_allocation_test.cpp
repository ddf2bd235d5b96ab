#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>
#include <random>

#include "core/ocean/composite.hpp"
#include "core/ocean/family.hpp"
#include "tests/support/fields.hpp"

// A search samples a composite field some hundred million times, and a map asks a family at every node: not one of them may
// ask for memory.

namespace {
std::atomic<std::size_t> g_asked{};  // how often this program has asked for memory
}

// Both forms that the library's vectors and sorts use, and what gives back their blocks. Never inline: the compiler would see
// `free` meet a `new` and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_asked;
  if (void* const block = std::malloc(size == 0 ? 1 : size)) return block;
  throw std::bad_alloc{};
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++g_asked;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void operator delete(void* block) noexcept { std::free(block); }
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept { std::free(block); }

using namespace glidehelm;
using namespace glidehelm::ocean;

namespace {

/// Two models with depths and times, the inner one trusted more and ending earlier: every kind of seam.
CompositeField two_models(Interpolation interpolation) {
  const auto model = [&](const std::string& name, double hours, double south, double west, double step) {
    const GridAxes axes{test::steps(0, 3600, static_cast<std::size_t>(hours)),
                        {0, 20, 50, 100, 200},
                        test::steps(south, step, 21),
                        test::steps(west, step, 21),
                        true,
                        true};
    const auto current = [&](double lat, double lon, double z, double t) {
      return std::sin(9 * lat) * std::sin(7 * lon) > 0.8 ? std::pair{test::kDry, test::kDry}
                                                         : std::pair{0.3 - z / 1000, 1e-6 * t};
    };
    return CompositeSource{name,
                           GriddedField{test::make_grid(axes, current), {OutsideTime::hold, interpolation, 0, true}}};
  };
  std::vector<CompositeSource> sources;
  sources.push_back(model("inner", 12, 39, 4, 0.1));
  sources.push_back(model("outer", 24, 37, 2, 0.3));
  return {std::move(sources), Seams{}};
}

}  // namespace

TEST_CASE("sampling sources in order of trust asks for no memory") {
  for (const auto interpolation : {Interpolation::linear, Interpolation::akima}) {
    const auto field = two_models(interpolation);
    std::mt19937_64 random{25};
    std::uniform_real_distribution<double> lat{36, 44}, lon{1, 9}, depth{0, 250}, time{-3600, 30 * 3600.0};
    std::size_t values = 0;
    const auto before = g_asked.load();
    for (int n = 0; n < 2000; ++n)
      if (field.sample(geo_point(lat(random), lon(random)), Depth{Metres{depth(random)}}, time(random))) ++values;
    const auto after = g_asked.load();
    CHECK(after == before);
    CHECK(values > 500);
  }
}

TEST_CASE("sampling all members of a family asks for no memory") {
  const auto one = two_models(Interpolation::linear), other = two_models(Interpolation::akima);
  const Family family{{one, other, one}};
  std::mt19937_64 random{27};
  std::uniform_real_distribution<double> lat{36, 44}, lon{1, 9}, depth{0, 250}, time{-3600, 30 * 3600.0};
  std::size_t values = 0;
  const auto before = g_asked.load();
  for (int n = 0; n < 2000; ++n)
    if (family.sample(geo_point(lat(random), lon(random)), Depth{Metres{depth(random)}}, time(random))) ++values;
  CHECK(g_asked.load() == before);
  CHECK(values > 500);
}

TEST_CASE("stepping lanes through sources asks for no memory") {
  const auto field = two_models(Interpolation::linear);
  std::mt19937_64 random{26};
  std::uniform_real_distribution<double> lat{38, 42}, lon{3, 7};
  Lanes lanes{};
  lanes.count = Lanes::kMax;
  for (std::size_t k = 0; k < Lanes::kMax; ++k) {
    lanes.lat[k] = lat(random) * kPi / 180;
    lanes.lon[k] = lon(random) * kPi / 180;
    lanes.water_north[k] = 0.3;
  }
  const auto before = g_asked.load();
  for (int n = 0; n < 40; ++n) field.advance(lanes, n * 1800.0, 1800);
  CHECK(g_asked.load() == before);
}

TEST_CASE("the count sees the memory that the weights ask for") {
  const auto field = two_models(Interpolation::linear);
  const auto before = g_asked.load();
  CHECK(field.weights(geo_point(40, 5), Depth{}, 0).size() == 2);
  CHECK(g_asked.load() > before);
}
