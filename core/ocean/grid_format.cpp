#include "core/ocean/grid_format.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

namespace glidehelm::ocean {

static_assert(std::endian::native == std::endian::little,
              "the flat grid is used in place, so it has the machine's byte order");

namespace {

constexpr std::string_view kMagic = "GLHGRID1";
constexpr std::size_t kFixedHeader = 96;
constexpr std::size_t kCrcOffset = 16;
constexpr std::size_t kHeaderAtMost = 256U << 20;
constexpr std::uint32_t kAxisAtMost = 1U << 22;
constexpr std::uint32_t kHasTime = 1, kHasDepth = 2;

template <class T>
void put(std::string& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

/// Reads forward through the header; after the first read beyond its end everything is empty and `failed()`.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : bytes_{bytes} {}

  template <class T>
  T take() {
    T value{};
    if (bytes_.size() - at_ < sizeof(T)) {
      failed_ = true;
      return value;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const auto length = take<std::uint32_t>();
    if (failed_ || bytes_.size() - at_ < length) {
      failed_ = true;
      return {};
    }
    std::string out(reinterpret_cast<const char*>(bytes_.data() + at_), length);
    at_ += length;
    return out;
  }
  std::vector<double> doubles(std::uint32_t count) {
    if (failed_ || (bytes_.size() - at_) / sizeof(double) < count) {
      failed_ = true;
      return {};
    }
    std::vector<double> out(count);
    std::memcpy(out.data(), bytes_.data() + at_, count * sizeof(double));
    at_ += count * sizeof(double);
    return out;
  }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_{};
  bool failed_{};
};

std::optional<GridError> fault_of_axis(const std::vector<double>& axis, const char* name, double lowest,
                                       double highest) {
  for (std::size_t i = 0; i < axis.size(); ++i) {
    // A negated comparison, so that NaN fails too.
    if (!(axis[i] >= lowest && axis[i] <= highest))
      return GridError{"value " + std::to_string(i) + " is " + std::to_string(axis[i]) + ", allowed is " +
                           std::to_string(lowest) + " to " + std::to_string(highest),
                       name};
    if (i > 0 && !(axis[i] > axis[i - 1]))
      return GridError{"value " + std::to_string(i) + " is not above the one before; axes ascend", name};
  }
  return std::nullopt;
}

std::optional<GridError> fault_of_axes(const GridAxes& axes) {
  if (auto fault = fault_of_axis(axes.times_s, "times", -1e12, 1e12)) return fault;
  if (auto fault = fault_of_axis(axes.depths_m, "depths", -100, 12000)) return fault;
  if (auto fault = fault_of_axis(axes.lats_deg, "latitudes", -90, 90)) return fault;
  if (auto fault = fault_of_axis(axes.lons_deg, "longitudes", -180, 540)) return fault;
  if (axes.lats_deg.size() < 2) return GridError{"there is one; allowed is two or more", "latitudes"};
  if (axes.lons_deg.size() < 2) return GridError{"there is one; allowed is two or more", "longitudes"};
  if (axes.lons_deg.front() >= 180) return GridError{"the first is not in [-180, 180)", "longitudes"};
  if (axes.lons_deg.back() - axes.lons_deg.front() >= 360)
    return GridError{"they span 360 degrees or more", "longitudes"};
  return std::nullopt;
}

std::optional<GridError> fault_of_values(const float* values, std::size_t nodes) {
  for (std::size_t i = 0; i < nodes; ++i) {
    const float east = values[2 * i], north = values[2 * i + 1];
    if (std::isfinite(east) && std::isfinite(north)) continue;
    if (!std::isnan(east) || !std::isnan(north))
      return GridError{"node " + std::to_string(i) + " is neither a current nor two NaN", "payload"};
  }
  return std::nullopt;
}

std::uint32_t crc_with_field_zero(std::span<const std::byte> header) {
  std::string copy(reinterpret_cast<const char*>(header.data()), header.size());
  std::memset(copy.data() + kCrcOffset, 0, sizeof(std::uint32_t));
  return crc32c(copy);
}

void read_facts(Cursor& cursor, GridFacts& facts) {
  for (std::string* text : {&facts.cycle, &facts.east_variable, &facts.north_variable, &facts.east_unit,
                            &facts.north_unit, &facts.recognised_by, &facts.time_unit, &facts.layout})
    *text = cursor.text();
  const auto sources = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < sources && !cursor.failed(); ++i) {
    GridSource source;
    source.name = cursor.text();
    source.hash.bytes = cursor.take<std::array<std::uint8_t, 32>>();
    facts.sources.push_back(std::move(source));
  }
  const auto warnings = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < warnings && !cursor.failed(); ++i) facts.warnings.push_back(cursor.text());
}

constexpr std::uint32_t kRunsAtMost = 1U << 23;

void read_runs(Cursor& cursor, std::vector<NodeRun>& runs) {
  const auto count = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < std::min(count, kRunsAtMost) && !cursor.failed(); ++i) {
    const auto first = cursor.take<std::uint64_t>();
    runs.push_back({first, cursor.take<std::uint64_t>()});
  }
}
void put_runs(std::string& out, const std::vector<NodeRun>& runs) {
  put(out, static_cast<std::uint32_t>(runs.size()));
  for (const auto& run : runs) {
    put(out, run.first);
    put(out, run.length);
  }
}

std::optional<GridError> fault_of_runs(const std::vector<NodeRun>& runs, const float* values, std::uint64_t nodes) {
  std::uint64_t free = 0;
  for (const auto& run : runs) {
    if (run.length == 0 || run.first < free || run.first >= nodes || run.length > nodes - run.first)
      return GridError{"they do not ascend within the " + std::to_string(nodes) + " nodes", "filled nodes"};
    for (std::uint64_t n = run.first; n < run.first + run.length; ++n)
      if (std::isnan(values[2 * n])) return GridError{"node " + std::to_string(n) + " has no value", "filled nodes"};
    free = run.first + run.length + 1;
  }
  return std::nullopt;
}

void read_water(Cursor& cursor, GridWater& water) {
  const auto count = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && !cursor.failed(); ++i) {
    WaterLayer layer;
    layer.depth = Metres{cursor.take<double>()};
    layer.temperature_c = cursor.take<double>();
    layer.salinity = cursor.take<double>();
    water.layers.push_back(layer);
  }
  water.words = cursor.text();
}
void put_water(std::string& out, const GridWater& water) {
  put(out, static_cast<std::uint32_t>(water.layers.size()));
  for (const auto& layer : water.layers)
    for (const double value : {layer.depth.si(), layer.temperature_c, layer.salinity}) put(out, value);
  put_text(out, water.words);
}
std::optional<GridError> fault_of_water(const GridWater& water) {
  std::vector<double> depths;
  for (const auto& layer : water.layers) {
    if (!plausible(layer))
      return GridError{"layer " + std::to_string(depths.size()) + " has a temperature or salinity that no sea has",
                       "water"};
    depths.push_back(layer.depth.si());
  }
  return fault_of_axis(depths, "water", -100, 12000);
}

void put_facts(std::string& out, const GridFacts& facts) {
  for (const std::string* text : {&facts.cycle, &facts.east_variable, &facts.north_variable, &facts.east_unit,
                                  &facts.north_unit, &facts.recognised_by, &facts.time_unit, &facts.layout})
    put_text(out, *text);
  put(out, static_cast<std::uint32_t>(facts.sources.size()));
  for (const auto& source : facts.sources) {
    put_text(out, source.name);
    put(out, source.hash.bytes);
  }
  put(out, static_cast<std::uint32_t>(facts.warnings.size()));
  for (const auto& warning : facts.warnings) put_text(out, warning);
}

}  // namespace

Sha256 provenance_of(const std::vector<GridSource>& sources) {
  std::string hashes;
  for (const auto& source : sources) hashes += source.hash.hex();
  return Sha256::of(hashes);
}

std::vector<NodeRun> runs_of(const std::vector<bool>& marked) {
  std::vector<NodeRun> runs;
  for (std::size_t n = 0; n < marked.size(); ++n) {
    if (!marked[n]) continue;
    if (n > 0 && marked[n - 1])
      ++runs.back().length;
    else
      runs.push_back({n, 1});
  }
  return runs;
}

std::string write_grid(const Grid& grid) {
  const auto& axes = grid.axes;
  std::string header;
  header.append(kMagic);
  put(header, kGridVersion);
  put(header, std::uint32_t{0});
  put(header, std::uint32_t{0});
  put(header, crc32c(std::as_bytes(std::span{grid.values})));
  put(header, static_cast<std::uint64_t>(grid.values.size() * sizeof(float)));
  for (const auto* axis : {&axes.times_s, &axes.depths_m, &axes.lats_deg, &axes.lons_deg})
    put(header, static_cast<std::uint32_t>(axis->size()));
  put(header, (axes.has_time ? kHasTime : 0U) | (axes.has_depth ? kHasDepth : 0U));
  put(header, std::uint32_t{0});
  put(header, grid.facts.reference_s);
  put(header, provenance_of(grid.facts.sources).bytes);
  for (const auto* axis : {&axes.times_s, &axes.depths_m, &axes.lats_deg, &axes.lons_deg})
    for (const double value : *axis) put(header, value);
  put_facts(header, grid.facts);
  put_runs(header, grid.filled);
  put_water(header, grid.facts.water);
  header.resize((header.size() + 63) / 64 * 64, '\0');
  const auto size = static_cast<std::uint32_t>(header.size());
  std::memcpy(header.data() + 12, &size, sizeof size);
  const std::uint32_t crc = crc32c(header);
  std::memcpy(header.data() + kCrcOffset, &crc, sizeof crc);
  header.append(reinterpret_cast<const char*>(grid.values.data()), grid.values.size() * sizeof(float));
  return header;
}

Expected<GridView, GridError> open_grid(std::span<const std::byte> bytes) {
  const auto fault = [](std::string what, std::string where) {
    return unexpected(GridError{std::move(what), std::move(where)});
  };
  if (bytes.size() < kFixedHeader || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    return fault("this is not a grid of glidehelm-ingest", "header");
  if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(float) != 0)
    return fault("the bytes are not aligned", "header");
  Cursor fixed{bytes.subspan(kMagic.size())};
  const auto version = fixed.take<std::uint32_t>();
  if (version != kGridVersion && version != kGridVersionWithoutWater)
    return fault("version " + std::to_string(version) + ", allowed is " + std::to_string(kGridVersionWithoutWater) +
                     " or " + std::to_string(kGridVersion),
                 "header");
  const auto header_size = fixed.take<std::uint32_t>();
  const auto header_crc = fixed.take<std::uint32_t>();
  const auto payload_crc = fixed.take<std::uint32_t>();
  const auto payload_size = fixed.take<std::uint64_t>();
  if (header_size < kFixedHeader || header_size % 64 != 0 || header_size > kHeaderAtMost || header_size > bytes.size())
    return fault("its size is " + std::to_string(header_size) + " of " + std::to_string(bytes.size()) + " bytes",
                 "header");
  if (crc_with_field_zero(bytes.first(header_size)) != header_crc) return fault("the checksum is wrong", "header");

  std::uint32_t counts[4];
  std::uint64_t nodes = 1;
  for (auto& count : counts) {
    count = fixed.take<std::uint32_t>();
    // Four counts below 2^22 cannot overflow before the comparison with the file's own size.
    if (count == 0 || count > kAxisAtMost || nodes > bytes.size())
      return fault("an axis has an impossible length", "header");
    nodes *= count;
  }
  if (nodes > bytes.size() / 8 || payload_size != nodes * 8 || bytes.size() - header_size != payload_size)
    return fault("the payload has " + std::to_string(bytes.size() - header_size) + " bytes where the axes need " +
                     std::to_string(nodes) + " times 8",
                 "header");

  GridView view;
  const auto flags = fixed.take<std::uint32_t>();
  if ((flags & ~(kHasTime | kHasDepth)) != 0) return fault("unknown flags", "header");
  view.axes.has_time = (flags & kHasTime) != 0;
  view.axes.has_depth = (flags & kHasDepth) != 0;
  (void)fixed.take<std::uint32_t>();
  view.facts.reference_s = fixed.take<double>();
  view.provenance.bytes = fixed.take<std::array<std::uint8_t, 32>>();

  Cursor cursor{bytes.subspan(kFixedHeader, header_size - kFixedHeader)};
  view.axes.times_s = cursor.doubles(counts[0]);
  view.axes.depths_m = cursor.doubles(counts[1]);
  view.axes.lats_deg = cursor.doubles(counts[2]);
  view.axes.lons_deg = cursor.doubles(counts[3]);
  read_facts(cursor, view.facts);
  read_runs(cursor, view.filled);
  if (version == kGridVersion) read_water(cursor, view.facts.water);
  if (cursor.failed()) return fault("axes or texts run beyond it", "header");
  if (auto bad = fault_of_axes(view.axes)) return unexpected(std::move(*bad));
  if (!view.axes.has_time && counts[0] != 1) return fault("several times without a time axis", "times");
  if (!view.axes.has_depth && counts[1] != 1) return fault("several depths without a depth axis", "depths");
  if (view.provenance != provenance_of(view.facts.sources))
    return fault("the hash is not that of the sources", "header");

  if (auto bad = fault_of_water(view.facts.water)) return unexpected(std::move(*bad));

  const auto payload = bytes.subspan(header_size);
  if (crc32c(payload) != payload_crc) return fault("the checksum is wrong", "payload");
  view.values = reinterpret_cast<const float*>(payload.data());
  if (auto bad = fault_of_values(view.values, nodes)) return unexpected(std::move(*bad));
  if (auto bad = fault_of_runs(view.filled, view.values, nodes)) return unexpected(std::move(*bad));
  return view;
}

GridView view_of(const Grid& grid) {
  return {grid.axes, grid.facts, provenance_of(grid.facts.sources), grid.values.data(), grid.filled};
}

GridStatistics statistics_of(const GridView& view) {
  GridStatistics statistics;
  const std::size_t nodes = view.axes.nodes();
  std::size_t wet = 0;
  double slowest = std::numeric_limits<double>::infinity(), sum = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double east = view.values[2 * i], north = view.values[2 * i + 1];
    if (std::isnan(east)) continue;
    const double speed = std::sqrt(east * east + north * north);
    ++wet;
    sum += speed;
    slowest = std::min(slowest, speed);
    statistics.fastest = std::max(statistics.fastest, speed);
  }
  if (wet == 0) return statistics;
  statistics.wet_fraction = static_cast<double>(wet) / static_cast<double>(nodes);
  statistics.slowest = slowest;
  statistics.mean = sum / static_cast<double>(wet);
  return statistics;
}

}  // namespace glidehelm::ocean
