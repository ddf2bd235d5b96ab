#include "config/network.hpp"

#include <algorithm>
#include <vector>

namespace glidehelm::config {

namespace {

/// A decimal number without leading zeros; nothing beyond `most`.
std::optional<unsigned> decimal(std::string_view text, unsigned most) {
  if (text.empty() || text.size() > 5 || (text.size() > 1 && text.front() == '0')) return std::nullopt;
  unsigned value = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + static_cast<unsigned>(c - '0');
  }
  if (value > most) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(at);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<IpAddress> ipv4(std::string_view text) {
  const auto parts = split(text, '.');
  if (parts.size() != 4) return std::nullopt;
  IpAddress address;
  address.bytes[10] = address.bytes[11] = 0xFF;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto part = decimal(parts[i], 255);
    if (!part) return std::nullopt;
    address.bytes[12 + i] = static_cast<std::uint8_t>(*part);
  }
  return address;
}

std::optional<unsigned> hextet(std::string_view text) {
  if (text.empty() || text.size() > 4) return std::nullopt;
  unsigned value = 0;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9', small = c >= 'a' && c <= 'f', large = c >= 'A' && c <= 'F';
    if (!digit && !small && !large) return std::nullopt;
    value = value * 16 + static_cast<unsigned>(digit ? c - '0' : small ? c - 'a' + 10 : c - 'A' + 10);
  }
  return value;
}

/// Hextets between colons into `out`; false when one is none.
bool hextets(std::string_view text, std::vector<unsigned>& out) {
  if (text.empty()) return true;
  for (const auto part : split(text, ':')) {
    const auto value = hextet(part);
    if (!value) return false;
    out.push_back(*value);
  }
  return true;
}

std::optional<IpAddress> ipv6(std::string_view text) {
  std::vector<unsigned> head, tail;
  const auto gap = text.find("::");
  if (gap == std::string_view::npos) {
    if (!hextets(text, head) || head.size() != 8) return std::nullopt;
  } else {
    if (!hextets(text.substr(0, gap), head) || !hextets(text.substr(gap + 2), tail)) return std::nullopt;
    if (head.size() + tail.size() > 7) return std::nullopt;
    head.resize(8 - tail.size(), 0);
    head.insert(head.end(), tail.begin(), tail.end());
  }
  IpAddress address;
  for (std::size_t i = 0; i < 8; ++i) {
    address.bytes[2 * i] = static_cast<std::uint8_t>(head[i] >> 8U);
    address.bytes[2 * i + 1] = static_cast<std::uint8_t>(head[i] & 0xFFU);
  }
  return address;
}

bool is_host(std::string_view text) {
  if (text.empty() || text.size() > 253 || text.front() == '-' || text.front() == '.') return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
  });
}

}  // namespace

std::optional<IpAddress> IpAddress::from_text(std::string_view text) {
  return text.find(':') == std::string_view::npos ? ipv4(text) : ipv6(text);
}

bool IpAddress::is_loopback() const {
  static const Network kIpv4 = *Network::from_text("127.0.0.0/8");
  static const Network kIpv6 = *Network::from_text("::1");
  return kIpv4.contains(*this) || kIpv6.contains(*this);
}

std::optional<Network> Network::from_text(std::string_view text) {
  const auto slash = text.find('/');
  const auto address = IpAddress::from_text(text.substr(0, slash));
  if (!address) return std::nullopt;
  Network network;
  network.address = *address;
  if (slash == std::string_view::npos) return network;
  const bool v4 = text.substr(0, slash).find(':') == std::string_view::npos;
  const auto prefix = decimal(text.substr(slash + 1), v4 ? 32 : 128);
  if (!prefix) return std::nullopt;
  network.prefix = static_cast<int>(*prefix) + (v4 ? 96 : 0);
  for (int bit = network.prefix; bit < 128; ++bit)
    if ((address->bytes[static_cast<std::size_t>(bit / 8)] >> (7 - bit % 8) & 1) != 0) return std::nullopt;
  return network;
}

bool Network::contains(const IpAddress& peer) const {
  for (int bit = 0; bit < prefix; ++bit) {
    const auto byte = static_cast<std::size_t>(bit / 8);
    if (((address.bytes[byte] ^ peer.bytes[byte]) >> (7 - bit % 8) & 1) != 0) return false;
  }
  return true;
}

std::optional<Endpoint> Endpoint::from_text(std::string_view text) {
  const auto colon = text.find_last_of(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto port = decimal(text.substr(colon + 1), 65535);
  auto host = text.substr(0, colon);
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  const bool right =
      bracketed ? host.find(':') != std::string_view::npos && IpAddress::from_text(host).has_value() : is_host(host);
  if (!port || *port == 0 || !right) return std::nullopt;
  return Endpoint{std::string{host}, static_cast<std::uint16_t>(*port)};
}

std::string Endpoint::text() const {
  const bool v6 = host.find(':') != std::string::npos;
  return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

}  // namespace glidehelm::config
