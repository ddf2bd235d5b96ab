#include "daemon/grid_cache.hpp"

#include <catch2/catch.hpp>

#include "tests/support/fields.hpp"
#include "tests/support/memory_files.hpp"

using namespace glidehelm;
using namespace glidehelm::daemon;

namespace {

constexpr const char* kGrids = "/state/grids";

std::string grid_bytes(double east) {
  return ocean::write_grid(test::make_grid(test::flat_axes({0, 1}, {0, 1}), [east](double, double, double, double) {
    return std::pair{east, 0.2};
  }));
}
Sha256 hash(const std::string& text) { return Sha256::of(std::string_view{text}); }

struct Place {
  test::MemoryFiles files;
  Place() {
    for (const char* folder : {"/state", "/data"}) files.make_folder_at(folder);
  }
  std::shared_ptr<GridCache> open(GridCache::Limits limits = {}) {
    auto cache = GridCache::open(files, kGrids, limits);
    REQUIRE(cache);
    return *cache;
  }
  /// Makes a grid as a child does, and takes it in.
  std::unique_ptr<MappedGrid> put(GridCache& cache, const Sha256& key, double east = 0.1) {
    files.put(cache.staging() + "/g", grid_bytes(east));
    auto grid = cache.put("g", key);
    REQUIRE(grid);
    return std::move(*grid);
  }
  std::vector<std::string> names() { return files.names(kGrids); }
};

}  // namespace

TEST_CASE("a key is the contents in order, how they are read, and the format") {
  const auto a = hash("a"), b = hash("b");
  const auto key = GridCache::key_of("recipe", {a, b});
  CHECK(key == GridCache::key_of("recipe", {a, b}));
  CHECK(key != GridCache::key_of("recipe", {b, a}));
  CHECK(key != GridCache::key_of("recipe", {a}));
  CHECK(key != GridCache::key_of("another", {a, b}));
}

TEST_CASE("a grid that was taken in is found again, also by the next daemon") {
  Place place;
  const auto key = hash("key");
  {
    const auto cache = place.open();
    std::string damage;
    CHECK(cache->take(key, damage) == nullptr);
    const auto grid = place.put(*cache, key, 0.25);
    CHECK(grid->view.values[0] == 0.25F);
    CHECK(grid->path == std::string{kGrids} + "/" + key.hex() + ".grid");
    CHECK(place.files.names(cache->staging()).empty());
  }
  const auto cache = place.open();
  std::string damage;
  const auto grid = cache->take(key, damage);
  REQUIRE(grid);
  CHECK(grid->view.values[0] == 0.25F);
  CHECK(damage.empty());
}

TEST_CASE("a damaged grid is removed and said, never used, a bad one is never taken in") {
  Place place;
  const auto cache = place.open();
  const auto key = hash("key");
  place.put(*cache, key);
  const auto path = std::string{kGrids} + "/" + key.hex() + ".grid";
  for (const std::size_t at : {std::size_t{3}, std::size_t{40}, place.files.get(path)->size() - 1}) {
    place.put(*cache, key);
    place.files.rot(path, [at](std::string& bytes) { bytes[at] = static_cast<char>(bytes[at] ^ 4); });
    std::string damage;
    CHECK(cache->take(key, damage) == nullptr);
    CHECK_FALSE(damage.empty());
    CHECK_FALSE(place.files.get(path));
  }
  place.files.put(cache->staging() + "/g", grid_bytes(0.1).substr(0, 200));
  CHECK_FALSE(cache->put("g", key));
  CHECK_FALSE(cache->put("none", key));
  CHECK_FALSE(place.files.get(path));
}

TEST_CASE("grids that nobody holds go, the oldest first, when there are too many bytes") {
  Place place;
  const auto size = grid_bytes(0.1).size();
  const auto cache = place.open({3 * size, 100});
  const auto held = place.put(*cache, hash("0"));
  for (const char* key : {"1", "2", "3"}) place.put(*cache, hash(key));
  // Four are one too many: the oldest is held, so the second oldest goes.
  std::string damage;
  CHECK(cache->take(hash("0"), damage));
  CHECK_FALSE(cache->take(hash("1"), damage));
  CHECK(cache->take(hash("2"), damage));
  CHECK(cache->take(hash("3"), damage));
  CHECK(place.names().size() == 3);
}

TEST_CASE("a grid that two hold stays until the second lets go") {
  Place place;
  const auto size = grid_bytes(0.1).size();
  const auto cache = place.open({size, 100});
  auto first = place.put(*cache, hash("0"));
  std::string damage;
  auto second = cache->take(hash("0"), damage);
  first.reset();
  auto other = place.put(*cache, hash("1"));
  CHECK(cache->take(hash("0"), damage));
  second.reset();
  other.reset();
  place.put(*cache, hash("2"));
  CHECK_FALSE(cache->take(hash("0"), damage));
  CHECK(place.names().size() == 1);
}

TEST_CASE("a file is known while it looks the same, before and after a restart") {
  Place place;
  place.files.put("/data/a.nc", "content");
  place.files.put("/data/b with space.nc", "other");
  {
    const auto cache = place.open();
    CHECK_FALSE(cache->contents({"/data/a.nc"}));
    for (const char* path : {"/data/a.nc", "/data/b with space.nc"})
      cache->learn(path, FileIdentity::of(place.files.stat(path).value()), hash(path));
    CHECK(cache->contents({"/data/b with space.nc", "/data/a.nc"}) ==
          std::vector<Sha256>{hash("/data/b with space.nc"), hash("/data/a.nc")});
    REQUIRE(cache->save());
  }
  const auto cache = place.open();
  CHECK(cache->contents({"/data/b with space.nc"}) == std::vector<Sha256>{hash("/data/b with space.nc")});
  place.files.put("/data/a.nc", "content");  // the same bytes in another inode
  CHECK_FALSE(cache->contents({"/data/a.nc"}));
  place.files.take("/data/b with space.nc");
  CHECK_FALSE(cache->contents({"/data/b with space.nc"}));
}

TEST_CASE("a refusal is remembered for the contents as they were read, with its reason") {
  Place place;
  const std::vector<Sha256> one{hash("1")}, set{hash("1"), hash("2")};
  {
    const auto cache = place.open();
    CHECK(cache->refusal("r", one) == nullptr);
    cache->refuse("r", one, "speed of 7 m/s,\nover two lines");
    cache->refuse("r", set, "different grids");
    REQUIRE(cache->save());
  }
  const auto cache = place.open();
  REQUIRE(cache->refusal("r", one));
  CHECK(cache->refusal("r", one)->reason == "speed of 7 m/s, over two lines");
  CHECK(cache->refusal("r", set)->reason == "different grids");
  CHECK(cache->refusal("another", one) == nullptr);
  CHECK(cache->refusal("r", {hash("2")}) == nullptr);
  const auto list = cache->refused_list("r");
  CHECK(list.find(ocean::provenance_of({{"", hash("1")}}).hex() + "\n") != std::string::npos);
  CHECK(list.size() == 2 * 65);
  CHECK(cache->refused_list("another").empty());
}

TEST_CASE("the last accepted grid of an order is remembered") {
  Place place;
  {
    const auto cache = place.open();
    CHECK_FALSE(cache->accepted("order"));
    cache->accept("order", hash("1"));
    cache->accept("order", hash("2"));
    REQUIRE(cache->save());
  }
  CHECK(place.open()->accepted("order") == hash("2"));
  CHECK_FALSE(place.open()->accepted("another"));
}

TEST_CASE("memory is bounded: the oldest is forgotten") {
  Place place;
  const auto cache = place.open({1 << 20, 16});
  for (int i = 0; i < 40; ++i) {
    const auto name = std::to_string(i);
    place.files.put("/data/" + name, name);
    cache->learn("/data/" + name, FileIdentity::of(place.files.stat("/data/" + name).value()), hash(name));
    cache->refuse("r", {hash(name)}, "bad");
    cache->accept(name, hash(name));
  }
  CHECK(cache->contents({"/data/39"}));
  CHECK(cache->contents({"/data/24"}));
  CHECK_FALSE(cache->contents({"/data/23"}));
  CHECK(cache->refused_list("r").size() == 4 * 65);
  CHECK(cache->accepted("39"));
  CHECK_FALSE(cache->accepted("38"));
}

TEST_CASE("a damaged index is forgotten, whatever byte it is, grids stay") {
  Place place;
  place.files.put("/data/a.nc", "content");
  {
    const auto cache = place.open();
    cache->learn("/data/a.nc", FileIdentity::of(place.files.stat("/data/a.nc").value()), hash("a"));
    cache->refuse("r", {hash("1")}, "bad");
    place.put(*cache, hash("key"));
    REQUIRE(cache->save());
  }
  const auto good = *place.files.get("/state/grids/index");
  for (std::size_t at = 0; at < good.size(); ++at) {
    place.files.put("/state/grids/index", good);
    place.files.rot("/state/grids/index", [at](std::string& b) { b[at] = static_cast<char>(b[at] ^ 1); });
    const auto cache = place.open();
    CHECK_FALSE(cache->contents({"/data/a.nc"}));
    std::string damage;
    CHECK(cache->take(hash("key"), damage));
  }
  for (std::size_t length = 0; length < good.size(); ++length) {
    place.files.put("/state/grids/index", good.substr(0, length));
    CHECK(place.open()->refusal("r", {hash("1")}) == nullptr);
  }
}

TEST_CASE("what a crash left half made is swept at the start, grids and index are not") {
  Place place;
  {
    const auto cache = place.open();
    place.put(*cache, hash("key"));
    cache->accept("order", hash("key"));
    REQUIRE(cache->save());
  }
  place.files.put("/state/grids/staging/half", "half");
  place.files.put("/state/grids/staging/.half.77", "half");
  place.files.put("/state/grids/glidehelm-12.grid", "of an older version");
  const auto cache = place.open();
  CHECK(place.files.names("/state/grids/staging").empty());
  CHECK(place.names() == std::vector<std::string>{hash("key").hex() + ".grid", "index"});
}

TEST_CASE("after a power cut at any step the cache opens, and what it gives is whole") {
  // Every operation of a life of the cache is a place for the cut; of what was not synced any part may survive.
  std::size_t cuts = 0;
  for (std::size_t at = 1;; ++at) {
    bool ended = false;
    for (const std::uint64_t seed : {0U, 1U, 2U, 3U, 4U}) {
      Place place;
      place.files.put("/data/a.nc", "content");
      const auto staged = grid_bytes(0.25);
      place.open();  // the folders are there
      place.files.plan({test::MemoryFiles::Fault::What::power_cut, at, 0, false});
      try {
        const auto cache = *GridCache::open(place.files, kGrids);
        cache->learn("/data/a.nc", FileIdentity::of(place.files.stat("/data/a.nc").value()), hash("a"));
        auto folder = *place.files.open_folder(cache->staging());
        (void)folder->create("g", staged, 0644);
        const auto grid = cache->put("g", hash("key"));
        cache->accept("order", hash("key"));
        (void)cache->save();
        ended = true;
      } catch (const test::PowerCut&) {
        ++cuts;
      }
      place.files.cut_power(seed);
      const auto cache = place.open();
      std::string damage;
      const auto grid = cache->take(hash("key"), damage);
      if (grid) CHECK(grid->view.values[0] == 0.25F);
      CHECK(damage.empty());  // a name appears only after its bytes are durable
      if (const auto known = cache->contents({"/data/a.nc"})) CHECK(known->front() == hash("a"));
    }
    if (ended) break;
  }
  CHECK(cuts > 40);
}

TEST_CASE("a full disk costs memory, not correctness") {
  Place place;
  const auto cache = place.open();
  cache->refuse("r", {hash("1")}, "bad");
  place.files.plan({test::MemoryFiles::Fault::What::error, 1, ENOSPC, true});
  CHECK_FALSE(cache->save());
  CHECK(cache->refusal("r", {hash("1")}));
  place.files.plan_nothing();
  CHECK(cache->save());
  CHECK(place.open()->refusal("r", {hash("1")}));
}
