#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "core/ocean/bilinear.hpp"
#include "core/ocean/gridded.hpp"
#include "tests/support/fields.hpp"

// How to lay out a grid of currents in memory: the same interpolation (bilinear in space, linear in time, the bits of the kernel) over six
// layouts, three sizes of field and two orders of places, against what the machine can do at most. Decision 021 rests on it.
//
// Limits, measured in the same run:
//   arithmetic  the same loop over the same number of places that all lie in one small corner, so that everything is in the first cache;
//   loads       a loop that does nothing but fetch the cache lines of the same places from the same numbers, addresses written down before.
// The lower of the two is what the rate is a fraction of. Rates are the best of five runs, taken in turns.

using namespace glidehelm;
using ocean::Float2;
using ocean::Float4;

namespace {

/// A place, located: what every layout starts from.
struct Place {
  std::uint32_t time, row, column;
  float fx, fy, ft;
};

struct Size {
  std::size_t times, rows, columns;
  [[nodiscard]] std::size_t nodes() const { return times * rows * columns; }
};

/// The numbers that all layouts hold: (east, north) by time, row, column.
std::vector<float> currents(const Size& size) {
  std::vector<float> all;
  all.reserve(2 * size.nodes());
  for (std::size_t t = 0; t < size.times; ++t)
    for (std::size_t j = 0; j < size.rows; ++j)
      for (std::size_t i = 0; i < size.columns; ++i) {
        all.push_back(0.35F * std::sin(0.3F * static_cast<float>(j) + 0.1F * static_cast<float>(t)));
        all.push_back(0.35F * std::sin(0.3F * static_cast<float>(i)));
      }
  return all;
}

// Every layout: what it is, a function at(place) -> (east, north), and the corners that it loads for a place.

/// The corners of a place in rows of interleaved pairs, at one time or two.
template <class Number, class See>
void corners_in_rows(const Number* values, std::size_t slice, std::size_t row, const Place& p, std::size_t times,
                     const See& see) {
  for (std::size_t t = 0; t < times; ++t)
    for (std::size_t north = 0; north < 2; ++north)
      for (std::size_t east = 0; east < 2; ++east)
        see(values + (p.time + t) * slice + (p.row + north) * row + 2 * (p.column + east));
}

/// [time][row][column](east, north): the flat grid's own.
class Rows {
 public:
  static constexpr const char* name = "[t][y][x](u,v)";
  Rows(const std::vector<float>& values, const Size& size)
      : values_{values}, row_{2 * size.columns}, slice_{2 * size.rows * size.columns} {}
  template <bool kTimed>
  [[nodiscard]] Float2 at(const Place& p) const {
    const float* corner = values_.data() + p.time * slice_ + p.row * row_ + 2 * p.column;
    return kTimed ? ocean::bilinear_between(corner, corner + slice_, row_, p.fx, p.fy, p.ft)
                  : ocean::bilinear_at(corner, row_, p.fx, p.fy);
  }
  template <class See>
  void corners(const Place& p, std::size_t times, const See& see) const {
    corners_in_rows(values_.data(), slice_, row_, p, times, see);
  }
  [[nodiscard]] std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  const std::vector<float>& values_;
  std::size_t row_, slice_;
};

/// All of east, then all of north, as files have it.
class Planes {
 public:
  static constexpr const char* name = "u[t][y][x], v[t][y][x]";
  Planes(const std::vector<float>& values, const Size& size) : row_{size.columns}, slice_{size.rows * size.columns} {
    for (std::size_t k = 0; k < size.nodes(); ++k) {
      east_.push_back(values[2 * k]);
      north_.push_back(values[2 * k + 1]);
    }
  }
  template <bool kTimed>
  [[nodiscard]] Float2 at(const Place& p) const {
    const std::size_t corner = p.time * slice_ + p.row * row_ + p.column;
    return Float2{plane<kTimed>(east_.data() + corner, p), plane<kTimed>(north_.data() + corner, p)};
  }
  template <class See>
  void corners(const Place& p, std::size_t times, const See& see) const {
    for (const auto* plane : {&east_, &north_})
      for (std::size_t t = 0; t < times; ++t)
        for (std::size_t north = 0; north < 2; ++north)
          for (std::size_t east = 0; east < 2; ++east)
            see(plane->data() + (p.time + t) * slice_ + (p.row + north) * row_ + p.column + east);
  }
  [[nodiscard]] std::size_t bytes() const { return (east_.size() + north_.size()) * sizeof(float); }

 private:
  template <bool kTimed>
  [[nodiscard]] float plane(const float* a, const Place& p) const {
    const float* b = a + row_;
    float sw = a[0], se = a[1], nw = b[0], ne = b[1];
    if constexpr (kTimed) {
      const float *c = a + slice_, *d = b + slice_;
      sw += p.ft * (c[0] - sw);
      se += p.ft * (c[1] - se);
      nw += p.ft * (d[0] - nw);
      ne += p.ft * (d[1] - ne);
    }
    const float west = sw + p.fy * (nw - sw), east = se + p.fy * (ne - se);
    return west + p.fx * (east - west);
  }
  std::vector<float> east_, north_;
  std::size_t row_, slice_;
};

/// [row][column][time](east, north): the two times of a node side by side.
class TimesInside {
 public:
  static constexpr const char* name = "[y][x][t](u,v)";
  TimesInside(const std::vector<float>& values, const Size& size)
      : node_{2 * size.times}, row_{2 * size.times * size.columns} {
    values_.resize(2 * size.nodes());
    std::size_t k = 0;
    for (std::size_t t = 0; t < size.times; ++t)
      for (std::size_t n = 0; n < size.rows * size.columns; ++n, k += 2)
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(k), 2,
                    values_.begin() + static_cast<std::ptrdiff_t>(n * node_ + 2 * t));
  }
  template <bool kTimed>
  [[nodiscard]] Float2 at(const Place& p) const {
    const float* a = values_.data() + p.row * row_ + p.column * node_ + 2 * p.time;
    const float* b = a + row_;
    const Float2 sw = node<kTimed>(a, p.ft), se = node<kTimed>(a + node_, p.ft), nw = node<kTimed>(b, p.ft),
                 ne = node<kTimed>(b + node_, p.ft);
    const Float2 west = sw + p.fy * (nw - sw), east = se + p.fy * (ne - se);
    return west + p.fx * (east - west);
  }
  template <class See>
  void corners(const Place& p, std::size_t times, const See& see) const {
    for (std::size_t t = 0; t < times; ++t)
      for (std::size_t north = 0; north < 2; ++north)
        for (std::size_t east = 0; east < 2; ++east)
          see(values_.data() + (p.row + north) * row_ + (p.column + east) * node_ + 2 * (p.time + t));
  }
  [[nodiscard]] std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  template <bool kTimed>
  static Float2 node(const float* at, float ft) {
    if constexpr (!kTimed) {
      Float2 value;
      std::memcpy(&value, at, sizeof value);
      return value;
    } else {
      const Float4 both = ocean::load4(at);
      const Float2 first = __builtin_shufflevector(both, both, 0, 1), next = __builtin_shufflevector(both, both, 2, 3);
      return first + ft * (next - first);
    }
  }
  std::vector<float> values_;
  std::size_t node_, row_;
};

/// [time], then squares of 4 by 4 nodes: two cache lines that neighbours in both directions share.
class Squares {
 public:
  static constexpr const char* name = "[t] squares of 4 x 4";
  Squares(const std::vector<float>& values, const Size& size)
      : across_{(size.columns + 3) / 4}, slice_{32 * across_ * ((size.rows + 3) / 4)} {
    values_.resize(slice_ * size.times);
    std::size_t k = 0;
    for (std::size_t t = 0; t < size.times; ++t)
      for (std::size_t j = 0; j < size.rows; ++j)
        for (std::size_t i = 0; i < size.columns; ++i, k += 2)
          std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(k), 2,
                      values_.begin() + static_cast<std::ptrdiff_t>(t * slice_ + place(j, i)));
  }
  template <bool kTimed>
  [[nodiscard]] Float2 at(const Place& p) const {
    const float* slice = values_.data() + p.time * slice_;
    const std::size_t sw = place(p.row, p.column), se = place(p.row, p.column + 1), nw = place(p.row + 1, p.column),
                      ne = place(p.row + 1, p.column + 1);
    Float4 south = pair(slice + sw, slice + se), north = pair(slice + nw, slice + ne);
    if constexpr (kTimed) {
      const float* next = slice + slice_;
      south += p.ft * (pair(next + sw, next + se) - south);
      north += p.ft * (pair(next + nw, next + ne) - north);
    }
    return ocean::bilinear(south, north, p.fx, p.fy);
  }
  template <class See>
  void corners(const Place& p, std::size_t times, const See& see) const {
    for (std::size_t t = 0; t < times; ++t)
      for (std::size_t north = 0; north < 2; ++north)
        for (std::size_t east = 0; east < 2; ++east)
          see(values_.data() + (p.time + t) * slice_ + place(p.row + north, p.column + east));
  }
  [[nodiscard]] std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  [[nodiscard]] std::size_t place(std::size_t j, std::size_t i) const {
    return 32 * ((j / 4) * across_ + i / 4) + 8 * (j % 4) + 2 * (i % 4);
  }
  static Float4 pair(const float* west, const float* east) {
    Float2 a, b;
    std::memcpy(&a, west, sizeof a);
    std::memcpy(&b, east, sizeof b);
    return __builtin_shufflevector(a, b, 0, 1, 2, 3);
  }
  std::size_t across_, slice_;
  std::vector<float> values_;
};

/// [time][row][column], each cell with its four corners: four times the memory, one line at most.
class Cells {
 public:
  static constexpr const char* name = "[t][y][x] four corners";
  Cells(const std::vector<float>& values, const Size& size)
      : columns_{size.columns}, slice_{size.rows * size.columns}, cells_(size.nodes()) {
    for (std::size_t t = 0; t < size.times; ++t)
      for (std::size_t j = 0; j + 1 < size.rows; ++j)
        for (std::size_t i = 0; i + 1 < size.columns; ++i)
          for (std::size_t north = 0; north < 2; ++north)
            std::copy_n(values.data() + 2 * ((t * size.rows + j + north) * size.columns + i), 4,
                        cells_[t * slice_ + j * columns_ + i].values + 4 * north);
  }
  template <bool kTimed>
  [[nodiscard]] Float2 at(const Place& p) const {
    const Cell* cell = cells_.data() + p.time * slice_ + p.row * columns_ + p.column;
    return kTimed ? ocean::bilinear_between(cell->values, cell[slice_].values, 4, p.fx, p.fy, p.ft)
                  : ocean::bilinear_at(cell->values, 4, p.fx, p.fy);
  }
  template <class See>
  void corners(const Place& p, std::size_t times, const See& see) const {
    for (std::size_t t = 0; t < times; ++t) see(cells_.data() + (p.time + t) * slice_ + p.row * columns_ + p.column);
  }
  [[nodiscard]] std::size_t bytes() const { return cells_.size() * sizeof(Cell); }

 private:
  struct alignas(32) Cell {
    float values[8];
  };
  std::size_t columns_, slice_;
  std::vector<Cell> cells_;
};

/// As Rows in 16-bit numbers of 0.2 mm/s: half the memory, and a conversion for each corner.
class Shorts {
 public:
  static constexpr const char* name = "[t][y][x](u,v) 16 bits";
  Shorts(const std::vector<float>& values, const Size& size)
      : row_{2 * size.columns}, slice_{2 * size.rows * size.columns} {
    for (const float v : values) values_.push_back(static_cast<std::int16_t>(std::lround(v / kUnit)));
  }
  template <bool kTimed>
  [[nodiscard]] Float2 at(const Place& p) const {
    const std::int16_t* corner = values_.data() + p.time * slice_ + p.row * row_ + 2 * p.column;
    Float4 south = load(corner), north = load(corner + row_);
    if constexpr (kTimed) {
      south += p.ft * (load(corner + slice_) - south);
      north += p.ft * (load(corner + slice_ + row_) - north);
    }
    return kUnit * ocean::bilinear(south, north, p.fx, p.fy);
  }
  template <class See>
  void corners(const Place& p, std::size_t times, const See& see) const {
    corners_in_rows(values_.data(), slice_, row_, p, times, see);
  }
  [[nodiscard]] std::size_t bytes() const { return values_.size() * sizeof(std::int16_t); }
  static constexpr float kUnit = 2e-4F;  ///< m/s; ±6.5 m/s fit

 private:
  using Short4 = std::int16_t __attribute__((vector_size(8)));
  static Float4 load(const std::int16_t* from) {
    Short4 value;
    std::memcpy(&value, from, sizeof value);
    return __builtin_convertvector(value, Float4);
  }
  std::vector<std::int16_t> values_;
  std::size_t row_, slice_;
};

template <class Layout, bool kTimed>
double sum(const Layout& layout, const std::vector<Place>& places) {
  Float2 all{};
  for (const auto& place : places) all += layout.template at<kTimed>(place);
  return static_cast<double>(all[0]) + static_cast<double>(all[1]);
}

volatile double kept;  ///< what nobody reads, so that nothing is left out
template <class F>
double seconds_of(const F& work) {
  const auto begin = std::chrono::steady_clock::now();
  kept = work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Where and in which order: lanes of a search in lockstep, or anywhere.
std::vector<Place> anywhere(const Size& size, std::size_t count) {
  std::mt19937_64 random{11};
  std::uniform_real_distribution<float> part{0, 1};
  std::vector<Place> all(count);
  for (auto& p : all)
    p = {static_cast<std::uint32_t>(size.times > 1 ? random() % (size.times - 1) : 0),
         static_cast<std::uint32_t>(random() % (size.rows - 1)),
         static_cast<std::uint32_t>(random() % (size.columns - 1)),
         part(random),
         part(random),
         part(random)};
  return all;
}
/// 18 lanes spread from one node over half a stint of four cells, 64 evaluations each; then from another node.
std::vector<Place> as_a_search(const Size& size, std::size_t count) {
  std::mt19937_64 random{12};
  std::vector<Place> all;
  all.reserve(count);
  while (all.size() < count) {
    const double row = 6 + static_cast<double>(random() % (size.rows - 12));
    const double column = 6 + static_cast<double>(random() % (size.columns - 12));
    const auto time = static_cast<double>(size.times > 9 ? random() % (size.times - 9) : 0);
    for (int step = 0; step < 64; ++step)
      for (int lane = 0; lane < 18; ++lane) {
        const double way = 4.0 * step / 64, heading = 2 * kPi * lane / 18;
        const double y = row + way * std::cos(heading), x = column + way * std::sin(heading);
        const double t = size.times > 1 ? time + 8.0 * step / 64 : 0;
        all.push_back({static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(x),
                       static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y)),
                       static_cast<float>(t - std::floor(t))});
      }
  }
  all.resize(count);
  return all;
}
/// The same places folded into four by four cells and two times: the arithmetic alone.
std::vector<Place> in_a_corner(std::vector<Place> places) {
  for (auto& p : places) {
    p.time = 0;
    p.row %= 4;
    p.column %= 4;
  }
  return places;
}

/// One address in each cache line that the places need, evaluation by evaluation: a line that the evaluation has already fetched is not
/// asked for again.
template <class Layout>
std::vector<const volatile char*> lines_of(const Layout& layout, const std::vector<Place>& places, std::size_t times) {
  std::vector<const volatile char*> all;
  for (const auto& place : places) {
    const std::size_t begin = all.size();
    layout.corners(place, times, [&](const void* corner) {
      const auto* const line = reinterpret_cast<const char*>(reinterpret_cast<std::uintptr_t>(corner) / 64 * 64 + 32);
      if (std::find(all.begin() + static_cast<std::ptrdiff_t>(begin), all.end(), line) == all.end())
        all.push_back(line);
    });
  }
  return all;
}
double fetch(const std::vector<const volatile char*>& lines) {
  int all = 0;
  for (const auto* line : lines) all += *line;
  return all;
}

constexpr std::size_t kPlaces = 2'000'000;

struct Result {
  const char* layout;
  double rate{}, arithmetic{}, loads{}, lines{}, bytes{}, check{};
};

template <class Layout, bool kTimed>
Result measure(const std::vector<float>& values, const Size& size, const std::vector<Place>& places,
               const std::vector<Place>& corner) {
  const Layout layout{values, size};
  const auto lines = lines_of(layout, places, kTimed ? 2 : 1);
  double here = 1e9, small = 1e9, loads = 1e9;
  for (int run = 0; run < 5; ++run) {
    here = std::min(here, seconds_of([&] { return sum<Layout, kTimed>(layout, places); }));
    small = std::min(small, seconds_of([&] { return sum<Layout, kTimed>(layout, corner); }));
    loads = std::min(loads, seconds_of([&] { return fetch(lines); }));
  }
  const auto count = static_cast<double>(places.size());
  return {Layout::name,
          count / here,
          count / small,
          count / loads,
          static_cast<double>(lines.size()) / count,
          static_cast<double>(layout.bytes()),
          sum<Layout, kTimed>(layout, places)};
}

template <bool kTimed>
void compare(const char* what, const Size& size, bool random_order) {
  const auto values = currents(size);
  const auto places = random_order ? anywhere(size, kPlaces) : as_a_search(size, kPlaces);
  const auto corner = in_a_corner(places);
  const double plain_bytes = static_cast<double>(values.size() * sizeof(float));
  std::printf("\n%s, %zu x %zu x %zu nodes (%.1f MB), %s order\n", what, size.times, size.rows, size.columns,
              plain_bytes * 1e-6, random_order ? "random" : "a search's");
  std::printf("%-24s %9s %11s %7s %9s %6s %7s\n", "layout", "M eval/s", "arithmetic", "loads", "of limit", "lines",
              "memory");
  const Result all[] = {measure<Rows, kTimed>(values, size, places, corner),
                        measure<Planes, kTimed>(values, size, places, corner),
                        measure<TimesInside, kTimed>(values, size, places, corner),
                        measure<Squares, kTimed>(values, size, places, corner),
                        measure<Cells, kTimed>(values, size, places, corner),
                        measure<Shorts, kTimed>(values, size, places, corner)};
  for (const auto& r : all)
    std::printf(
        "%-24s %9.1f %11.1f %7.1f %7.0f %% %6.2f %6.2fx%s\n", r.layout, r.rate * 1e-6, r.arithmetic * 1e-6,
        r.loads * 1e-6, 100 * r.rate / std::min(r.arithmetic, r.loads), r.lines, r.bytes / plain_bytes,
        std::abs(r.check - all[0].check) <= (r.layout == Shorts::name ? 1e-4 * kPlaces : 0.0) ? "" : "  DIFFERS");
}

}  // namespace

int main() {
  compare<false>("static", {1, 201, 241}, false);
  compare<false>("static", {1, 201, 241}, true);
  compare<true>("hourly", {73, 201, 241}, false);
  compare<true>("hourly", {73, 201, 241}, true);
  compare<true>("hourly, large", {73, 585, 585}, false);
  compare<true>("hourly, large", {73, 585, 585}, true);
  return 0;
}
