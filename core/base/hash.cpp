#include "core/base/hash.hpp"

#include <nettle/sha2.h>

#include <boost/crc.hpp>
#if defined(__x86_64__)
#include <nmmintrin.h>

#include <cstring>
#endif

namespace glidehelm {

namespace {

#if defined(__x86_64__)
/// The same polynomial as one instruction of SSE 4.2: a grid is checked by every process that opens it.
__attribute__((target("sse4.2"))) std::uint32_t crc32c_by_instruction(std::span<const std::byte> data) {
  std::uint64_t crc = 0xFFFFFFFF;
  std::size_t at = 0;
  for (; at + sizeof(std::uint64_t) <= data.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, data.data() + at, sizeof word);
    crc = _mm_crc32_u64(crc, word);
  }
  auto last = static_cast<std::uint32_t>(crc);
  for (; at < data.size(); ++at) last = _mm_crc32_u8(last, std::to_integer<std::uint8_t>(data[at]));
  return last ^ 0xFFFFFFFF;
}
#endif

}  // namespace

Sha256 Sha256::of(std::span<const std::byte> data) {
  sha256_ctx context;
  sha256_init(&context);
  sha256_update(&context, data.size(), reinterpret_cast<const std::uint8_t*>(data.data()));
  Sha256 result;
  sha256_digest(&context, result.bytes.size(), result.bytes.data());
  return result;
}

Sha256 Sha256::of(std::string_view data) { return of(std::as_bytes(std::span{data.data(), data.size()})); }

std::string Sha256::hex() const {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(64);
  for (const auto byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

bool Sha256::from_hex(std::string_view text, Sha256& out) {
  if (text.size() != 64) return false;
  const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1; };
  for (std::size_t i = 0; i < 32; ++i) {
    const int high = digit(text[2 * i]);
    const int low = digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    out.bytes[i] = static_cast<std::uint8_t>(high * 16 + low);
  }
  return true;
}

std::uint32_t crc32c(std::span<const std::byte> data) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("sse4.2")) return crc32c_by_instruction(data);
#endif
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
  crc.process_bytes(data.data(), data.size());
  return crc.checksum();
}

std::uint32_t crc32c(std::string_view data) { return crc32c(std::as_bytes(std::span{data.data(), data.size()})); }

}  // namespace glidehelm
