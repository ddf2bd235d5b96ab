#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glidehelm {

/// SHA-256 of some bytes; comparable, printable. (nettle)
struct Sha256 {
  std::array<std::uint8_t, 32> bytes{};
  static Sha256 of(std::span<const std::byte> data);
  static Sha256 of(std::string_view data);
  [[nodiscard]] std::string hex() const;
  /// False when `text` is not 64 hexadecimal digits.
  static bool from_hex(std::string_view text, Sha256& out);
  friend auto operator<=>(const Sha256&, const Sha256&) = default;
};

/// CRC-32C (Castagnoli), as iSCSI and ext4 use it. (Boost.CRC)
std::uint32_t crc32c(std::span<const std::byte> data);
std::uint32_t crc32c(std::string_view data);

}  // namespace glidehelm
