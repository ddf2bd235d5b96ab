#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace glidehelm::cli {

/// "[####      ] 4 of 10 flights".
inline std::string progress_bar(std::size_t done, std::size_t of) {
  constexpr std::size_t kWide = 30;
  const auto filled = of == 0 ? kWide : done * kWide / of;
  return fmt::format("[{}{}] {} of {} flights", std::string(filled, '#'), std::string(kWide - filled, ' '), done, of);
}

}  // namespace glidehelm::cli
