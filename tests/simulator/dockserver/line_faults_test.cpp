#include "simulator/dockserver/line_faults.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace glidehelm;
using simulator::CallFaults;
using simulator::LineNoise;
using simulator::LineSetup;
using simulator::Random;

namespace {

std::string lines(int count) {
  std::string s;
  for (int i = 0; i < count; ++i) s += "line " + std::to_string(i) + " of a print that is long enough\r\n";
  return s;
}

}  // namespace

TEST_CASE("a good line passes bytes as they are and draws nothing") {
  LineNoise a{{}, Random{1}}, b{{}, Random{1}};
  const auto text = lines(30);
  for (int i = 0; i < 10; ++i) CHECK(a.spoil(text, {}) == text);
  CallFaults garbled;
  garbled.garbled = true;
  CHECK(a.spoil(text, garbled) == b.spoil(text, garbled));
}

TEST_CASE("a garbled line changes about as many places as it is told to") {
  LineNoise noise{LineSetup{120, 5}, Random{7}};
  CallFaults garbled;
  garbled.garbled = true;
  const std::string zeros(1'000'000, '0');
  const auto got = noise.spoil(zeros, garbled);
  const auto changed = std::count_if(got.begin(), got.end(), [](char c) { return c != '0'; });
  // 5000 places, a deviation of 71; 40 % are changed to another byte (255 of 256), 30 % lose one byte, 30 % one to twenty
  // (10.5 in the mean). Four deviations of each count.
  CHECK(changed == Approx(5000 * 0.4).margin(4 * 45));
  const double lost = static_cast<double>(zeros.size() - got.size());
  CHECK(lost == Approx(5000 * (0.3 + 0.3 * 10.5)).margin(4 * 480));
}

TEST_CASE("a dockserver block falls into the middle of a line and leaves the rest, or eats a little of it") {
  CallFaults faults;
  faults.injected = true;
  const auto text = lines(30);
  for (std::uint64_t seed = 1; seed < 60; ++seed) {
    LineNoise noise{{}, Random{seed}};
    auto got = noise.spoil(text, faults);
    const auto begin = got.find("<dockserver "), end = got.find("</dockserver>");
    REQUIRE(begin != std::string::npos);
    REQUIRE(end != std::string::npos);
    CHECK(got[begin - 1] != '\n');
    got.erase(begin, end + 13 - begin);
    CHECK(got == text);
    CallFaults lossy;
    lossy.injected_lossily = true;
    LineNoise other{{}, Random{seed}};
    auto less = other.spoil(text, lossy);
    const auto at = less.find("<dockserver ");
    less.erase(at, less.find("</dockserver>") + 13 - at);
    CHECK(less.size() < text.size());
    CHECK(less.size() >= text.size() - 12);
  }
}

TEST_CASE("a doubled line says everything twice") {
  LineNoise noise{{}, Random{1}};
  CallFaults twice;
  twice.duplicated = true;
  CHECK(noise.spoil("abc\r\n", twice) == "abc\r\nabc\r\n");
}

TEST_CASE("binary bytes hold every value and escape the ones of the protocol") {
  const auto bytes = LineNoise::binary(20'000, Random{1});
  CHECK(std::set<char>(bytes.begin(), bytes.end()).size() == 256);
  for (std::size_t i = 1; i < bytes.size(); ++i)
    if (bytes[i] == '*') CHECK(bytes[i - 1] == 0x18);
}

TEST_CASE("every fault has a name of its own") {
  std::set<std::string> names;
  for (const auto& fault : simulator::fault_names()) {
    CallFaults one;
    one.*fault.flag = true;
    CHECK(simulator::struck(one) == std::vector<std::string>{fault.name});
    names.insert(fault.name);
  }
  CHECK(names.size() == simulator::fault_names().size());
  CHECK(simulator::struck({}).empty());
}
