#pragma once

#include <cstddef>
#include <cstring>

namespace glidehelm::ocean {

/// Short vectors that the compiler keeps in one register on any machine (GCC and clang vector extension).
using Float2 = float __attribute__((vector_size(8)));
using Float4 = float __attribute__((vector_size(16)));
using Double2 = double __attribute__((vector_size(16)));

inline Float4 load4(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// The one bilinear formula of the room, used by `sample` and by the kernel alike, so that both give the same bits:
/// rows first, then columns; (east, north) of two neighbouring columns lie in one 16-byte load. Gives (east, north);
/// NaN in any corner is NaN in the result.
inline Float2 bilinear(Float4 south, Float4 north, float fx, float fy) {
  const Float4 row = south + fy * (north - south);
  const Float2 west = __builtin_shufflevector(row, row, 0, 1), east = __builtin_shufflevector(row, row, 2, 3);
  return west + fx * (east - west);
}

/// At one time: `corner` is the south-western node, `row` the floats from one row to the next.
inline Float2 bilinear_at(const float* corner, std::size_t row, float fx, float fy) {
  return bilinear(load4(corner), load4(corner + row), fx, fy);
}

/// Between two times: `later` is `corner` one time on; `ft` the way from the first to the second.
inline Float2 bilinear_between(const float* corner, const float* later, std::size_t row, float fx, float fy, float ft) {
  const Float4 south0 = load4(corner), north0 = load4(corner + row);
  const Float4 south = south0 + ft * (load4(later) - south0);
  const Float4 north = north0 + ft * (load4(later + row) - north0);
  return bilinear(south, north, fx, fy);
}

}  // namespace glidehelm::ocean
