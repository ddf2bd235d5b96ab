#include "simulator/dockserver/line_faults.hpp"

#include <algorithm>

#include "simulator/dockserver/dialog_writer.hpp"

namespace glidehelm::simulator {
namespace {

constexpr std::size_t kWorthInjecting = 400;  // a block falls into prints, not into single lines
constexpr std::size_t kMostEaten = 12, kLongestGap = 20;
constexpr char kZdle = 0x18;

}  // namespace

const std::vector<NamedFault>& fault_names() {
  using F = CallFaults;
  static const std::vector<NamedFault> kNames{{"lost_calls", &F::lost},
                                              {"not_taken", &F::not_taken},
                                              {"no_connection_block", &F::no_connection_block},
                                              {"redial", &F::redial},
                                              {"cut", &F::cut},
                                              {"half_open", &F::half_open},
                                              {"call_back", &F::call_back},
                                              {"late_script", &F::late_script},
                                              {"transfer_cut", &F::transfer_cut},
                                              {"science_files", &F::science_files},
                                              {"wrong_keys", &F::wrong_keys},
                                              {"chatter", &F::chatter},
                                              {"garbled", &F::garbled},
                                              {"injected", &F::injected},
                                              {"injected_lossily", &F::injected_lossily},
                                              {"duplicated", &F::duplicated},
                                              {"slow", &F::slow}};
  return kNames;
}

std::vector<std::string> struck(const CallFaults& faults) {
  std::vector<std::string> names;
  for (const auto& fault : fault_names())
    if (faults.*fault.flag) names.emplace_back(fault.name);
  return names;
}

std::string LineNoise::binary(std::size_t size, Random random) {
  std::string bytes;
  while (bytes.size() < size) {
    const auto byte = static_cast<char>(random.next() >> 56U);
    if (byte == kZdle || byte == '*') bytes += kZdle;
    bytes += byte;
  }
  return bytes;
}

void LineNoise::garble(std::string& bytes) {
  const double chance = setup_.garbled_per_kilobyte / 1000;
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (random_.uniform() >= chance) {
      out += bytes[i];
      continue;
    }
    const double kind = random_.uniform();
    if (kind < 0.4)
      out += static_cast<char>(random_.next() >> 56U);
    else if (kind > 0.7)  // else this one byte is lost
      i += static_cast<std::size_t>(random_.uniform() * kLongestGap);
  }
  bytes = std::move(out);
}

/// Into the middle of a line: never at its beginning, where it would tear nothing.
void LineNoise::inject(std::string& bytes, bool lossily) {
  if (bytes.size() < kWorthInjecting) return;
  auto at = static_cast<std::size_t>(random_.uniform(0.1, 0.9) * static_cast<double>(bytes.size()));
  while (at < bytes.size() && (bytes[at - 1] == '\n' || bytes[at] == '\r' || bytes[at] == '\n')) ++at;
  if (lossily) {
    const auto eaten = 1 + static_cast<std::size_t>(random_.uniform() * kMostEaten);
    bytes.erase(at, eaten);
  }
  bytes.insert(std::min(at, bytes.size()), dialog::dockserver_block());
}

std::string LineNoise::spoil(std::string bytes, const CallFaults& faults) {
  if (faults.injected) inject(bytes, false);
  if (faults.injected_lossily) inject(bytes, true);
  if (faults.garbled) garble(bytes);
  if (faults.duplicated) bytes += std::string{bytes};
  return bytes;
}

}  // namespace glidehelm::simulator
