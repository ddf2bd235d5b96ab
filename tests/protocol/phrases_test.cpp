#include "protocol/phrases.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <tuple>

using namespace glidehelm::protocol;

namespace {

using Found = std::vector<std::tuple<std::size_t, std::size_t, std::size_t>>;

Found found(const Phrases& phrases, std::string_view text) {
  Found all;
  phrases.find(text, [&](const Phrases::Hit& h) { all.emplace_back(h.phrase, h.begin, h.end); });
  return all;
}

/// The definition, by brute force: at each beginning the longest phrase, of equal ones the first.
Found by_definition(const std::vector<std::string_view>& phrases, std::string_view text) {
  Found all;
  for (std::size_t begin = 0; begin < text.size(); ++begin) {
    std::size_t best = phrases.size();
    for (std::size_t i = 0; i < phrases.size(); ++i)
      if (phrases[i].size() >= 2 && text.substr(begin).starts_with(phrases[i]) &&
          (best == phrases.size() || phrases[i].size() > phrases[best].size()))
        best = i;
    if (best != phrases.size()) all.emplace_back(best, begin, begin + phrases[best].size());
  }
  return all;
}

}  // namespace

TEST_CASE("every phrase is found wherever it stands") {
  const Phrases phrases{{"GPS Location:", "sensor:", "MissionName:", "Mission"}};
  CHECK(found(phrases, "xsensor:GPS Location:") == Found{{1, 1, 8}, {0, 8, 21}});
  CHECK(found(phrases, "MissionName:") == Found{{2, 0, 12}});
  CHECK(found(phrases, "Missions: MissionName:") == Found{{3, 0, 7}, {2, 10, 22}});
  CHECK(found(phrases, "GPS GPS Location:") == Found{{0, 4, 17}});
  CHECK(found(phrases, "GPS Locatio").empty());
  CHECK(found(phrases, "").empty());
}

TEST_CASE("bytes beyond ASCII and NUL are bytes like others") {
  const std::string text{
      "a\0\xff"
      "b\xff",
      5};
  const Phrases phrases{
      {"\xff"
       "b"}};
  CHECK(found(phrases, text) == Found{{0, 2, 4}});
}

TEST_CASE("the search agrees with brute force on random texts of few letters") {
  std::mt19937 rng{7};  // few letters make overlaps and phrases inside phrases common
  const auto word = [&](std::size_t most) {
    std::string s;
    for (std::size_t n = rng() % (most + 1); n > 0; --n) s += static_cast<char>('a' + rng() % 3);
    return s;
  };
  for (int round = 0; round < 300; ++round) {
    std::vector<std::string> owned;
    for (int i = 0; i < 6; ++i) owned.push_back(word(5));
    const std::vector<std::string_view> views(owned.begin(), owned.end());
    const Phrases phrases{views};
    const auto text = word(60);
    REQUIRE(found(phrases, text) == by_definition(views, text));
  }
}

TEST_CASE("more different first bytes than classes cost time and no hit") {
  std::vector<std::string> owned;
  for (int c = 33; c < 127; ++c) owned.push_back(std::string{static_cast<char>(c), static_cast<char>(160 - c)} + "!");
  const std::vector<std::string_view> views(owned.begin(), owned.end());
  const Phrases phrases{views};
  for (std::size_t i = 0; i < owned.size(); ++i) CHECK(found(phrases, "  " + owned[i]) == Found{{i, 2, 5}});
}
