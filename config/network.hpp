#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace glidehelm::config {

/// An IPv4 or IPv6 address as 16 bytes; IPv4 stands in ::ffff:0:0/96.
struct IpAddress {
  std::array<std::uint8_t, 16> bytes{};
  /// "192.0.2.7" (four decimal numbers without leading zeros) or "2001:db8::7"; no zone, no brackets.
  static std::optional<IpAddress> from_text(std::string_view text);
  [[nodiscard]] bool is_loopback() const;  ///< 127.0.0.0/8 or ::1
  friend auto operator<=>(const IpAddress&, const IpAddress&) = default;
};

/// A network in CIDR form.
struct Network {
  IpAddress address;
  int prefix{128};  ///< leading bits that count, of 128
  /// "192.0.2.0/24", "2001:db8::/32", or one address. Bits beyond the prefix must be 0: a slip of the pen otherwise.
  static std::optional<Network> from_text(std::string_view text);
  [[nodiscard]] bool contains(const IpAddress& peer) const;
  friend auto operator<=>(const Network&, const Network&) = default;
};

/// A host and a TCP port.
struct Endpoint {
  std::string host;  ///< without brackets
  std::uint16_t port{};
  /// "HOST:PORT" or "[IPV6]:PORT"; ports 1 to 65535; a host is an address or a name of letters, digits, - and dots.
  static std::optional<Endpoint> from_text(std::string_view text);
  /// The same form again.
  [[nodiscard]] std::string text() const;
  friend auto operator<=>(const Endpoint&, const Endpoint&) = default;
};

}  // namespace glidehelm::config
