#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "protocol/goto_list.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

/// Any bytes as a list of ours: what is taken can be written, and what is written is read as the same list.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glidehelm;
  using namespace glidehelm::protocol;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  const auto list = read_goto_list(bytes);
  if (!list) {
    require(!list.error().message.empty());
    return 0;
  }
  require(size <= kLargestGotoList && !list->points.empty());
  GotoListComment comment;
  comment.plan_id = bytes.substr(0, 80);
  const auto written = write_goto_list(*list, comment);
  const auto again = read_goto_list(written);
  require(again && again->points.size() == list->points.size() && again->at_end == list->at_end);
  require(write_goto_list(*again, comment) == written);
  return 0;
}
