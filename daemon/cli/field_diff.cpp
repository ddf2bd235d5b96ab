#include "daemon/cli/field_diff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "daemon/cli/field_text.hpp"

namespace glidehelm::cli {

namespace {

using nlohmann::ordered_json;

/// Where a value of A's axis lies on B's: between nodes k and k + 1, `fraction` of the way; 0 on a node.
struct Between {
  std::size_t k{};
  double fraction{};
};
using AxisMap = std::vector<std::optional<Between>>;

/// A's values on B's axis. A value within `same` of a node is on it: axes written as floats differ in the last digits.
AxisMap map_axis(const std::vector<double>& a, const std::vector<double>& b, double same) {
  AxisMap map;
  for (const double value : a) {
    const auto above = std::upper_bound(b.begin(), b.end(), value);
    const auto k = static_cast<std::size_t>(above == b.begin() ? 0 : above - b.begin() - 1);
    if (std::abs(value - b[k]) <= same)
      map.emplace_back(Between{k, 0});
    else if (k + 1 < b.size() && std::abs(value - b[k + 1]) <= same)
      map.emplace_back(Between{k + 1, 0});
    else if (value < b.front() || value > b.back())
      map.emplace_back(std::nullopt);
    else
      map.emplace_back(Between{k, (value - b[k]) / (b[k + 1] - b[k])});
  }
  return map;
}

/// Longitudes of A in the turn in which B's are.
AxisMap map_longitudes(std::vector<double> a, const std::vector<double>& b, double same) {
  for (double& lon : a) {
    while (lon < b.front() - same) lon += 360;
    while (lon > b.back() + same && lon - 360 >= b.front() - same) lon -= 360;
  }
  AxisMap map;
  for (const double lon : a) map.push_back(map_axis({lon}, b, same).front());
  return map;
}

constexpr double kSameDegrees = 2e-5, kSameMetres = 1e-3, kSameSeconds = 0.5;

/// A's nodes on B's axes.
struct Overlap {
  AxisMap times, depths, lats, lons;

  Overlap(const ocean::GridAxes& a, const ocean::GridAxes& b)
      : times{a.has_time && b.has_time ? map_axis(a.times_s, b.times_s, kSameSeconds)
                                       : AxisMap(a.times_s.size(), Between{})},
        depths{a.has_depth && b.has_depth ? map_axis(a.depths_m, b.depths_m, kSameMetres)
                                          : AxisMap(a.depths_m.size(), std::nullopt)},
        lats{map_axis(a.lats_deg, b.lats_deg, kSameDegrees)},
        lons{map_longitudes(a.lons_deg, b.lons_deg, kSameDegrees)} {
    if (!a.has_depth || !b.has_depth) depths.front() = Between{};
  }
  /// Why there is nothing to compare; empty when there is.
  [[nodiscard]] std::string nothing(const ocean::GridAxes& a, const ocean::GridAxes& b) const {
    const auto none = [](const AxisMap& map) {
      return std::none_of(map.begin(), map.end(), [](const auto& at) { return at.has_value(); });
    };
    const auto range = [](const std::vector<double>& axis, const char* unit) {
      return decimal(axis.front(), 4) + " to " + decimal(axis.back(), 4) + unit;
    };
    const auto between = [&](const char* axis, const std::string& of_a, const std::string& of_b) {
      return std::string{"the two have no "} + axis + " in common: A has " + of_a + ", B " + of_b;
    };
    if (none(times))
      return between("time", time_text(a.times_s.front()) + " to " + time_text(a.times_s.back()),
                     time_text(b.times_s.front()) + " to " + time_text(b.times_s.back()));
    if (none(depths)) return between("depth", range(a.depths_m, " m"), range(b.depths_m, " m"));
    if (none(lats)) return between("latitude", range(a.lats_deg, ""), range(b.lats_deg, ""));
    if (none(lons)) return between("longitude", range(a.lons_deg, ""), range(b.lons_deg, ""));
    return {};
  }
};

/// B at a mapped node: linear in every axis; NaN unless all nodes with weight have a value.
std::array<double, 2> value_at(const ocean::GridView& b, const std::array<Between, 4>& at) {
  const std::array<std::size_t, 4> size{b.axes.times_s.size(), b.axes.depths_m.size(), b.axes.lats_deg.size(),
                                        b.axes.lons_deg.size()};
  std::array<double, 2> sum{};
  for (unsigned corner = 0; corner < 16; ++corner) {
    double weight = 1;
    std::size_t node = 0;
    for (unsigned axis = 0; axis < 4; ++axis) {
      const bool upper = ((corner >> axis) & 1U) != 0;
      weight *= upper ? at[axis].fraction : 1 - at[axis].fraction;
      node = node * size[axis] + at[axis].k + (upper ? 1 : 0);
    }
    if (weight == 0) continue;
    sum[0] += weight * static_cast<double>(b.values[2 * node]);
    sum[1] += weight * static_cast<double>(b.values[2 * node + 1]);
  }
  return sum;
}

/// Sums over compared nodes.
struct Row {
  std::uint64_t nodes{};
  double squares{}, longest{-1};
  std::size_t t{}, z{}, j{}, i{};  ///< of the longest difference
  struct Side {
    double bias{}, a{}, b{}, aa{}, bb{}, ab{};  ///< mean of b − a; means and centred sums of a and b
    void add(double x, double y, double n) {
      bias += (y - x - bias) / n;
      const double dx = x - a, dy = y - b;
      a += dx / n;
      b += dy / n;
      aa += dx * (x - a);
      bb += dy * (y - b);
      ab += dx * (y - b);
    }
    [[nodiscard]] std::optional<double> correlation() const {
      const double product = aa * bb;
      return product > 0 ? std::optional{ab / std::sqrt(product)} : std::nullopt;
    }
  };
  std::array<Side, 2> sides;

  void add(const float* x, const std::array<double, 2>& y, const std::array<std::size_t, 4>& node) {
    ++nodes;
    double squared = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      const double difference = y[s] - static_cast<double>(x[s]);
      squared += difference * difference;
      sides[s].add(static_cast<double>(x[s]), y[s], static_cast<double>(nodes));
    }
    squares += squared;
    if (squared <= longest * std::abs(longest)) return;
    longest = std::sqrt(squared);
    t = node[0], z = node[1], j = node[2], i = node[3];
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / static_cast<double>(nodes)); }
};

struct Comparison {
  Row all;
  std::vector<Row> depths, times;
  std::uint64_t only_a{}, only_b{};
};

Comparison compare(const ocean::GridView& a, const ocean::GridView& b, const Overlap& overlap) {
  const auto& axes = a.axes;
  Comparison result;
  result.depths.resize(axes.depths_m.size());
  result.times.resize(axes.times_s.size());
  const float* value = a.values;
  for (std::size_t t = 0; t < axes.times_s.size(); ++t)
    for (std::size_t z = 0; z < axes.depths_m.size(); ++z)
      for (std::size_t j = 0; j < axes.lats_deg.size(); ++j)
        for (std::size_t i = 0; i < axes.lons_deg.size(); ++i, value += 2) {
          if (!overlap.times[t] || !overlap.depths[z] || !overlap.lats[j] || !overlap.lons[i]) continue;
          const auto other = value_at(b, {*overlap.times[t], *overlap.depths[z], *overlap.lats[j], *overlap.lons[i]});
          const bool has_a = !std::isnan(*value), has_b = !std::isnan(other[0]);
          if (has_a != has_b) ++(has_a ? result.only_a : result.only_b);
          if (!has_a || !has_b) continue;
          for (Row* row : {&result.all, &result.depths[z], &result.times[t]}) row->add(value, other, {t, z, j, i});
        }
  return result;
}

ordered_json row_json(const Row& row, const ocean::GridAxes& axes) {
  const auto correlation = [](const Row::Side& side) {
    const auto value = side.correlation();
    return value ? ordered_json(*value) : ordered_json{};
  };
  if (row.nodes == 0)
    return {{"nodes", 0},
            {"rms_m_per_s", nullptr},
            {"bias_east_m_per_s", nullptr},
            {"bias_north_m_per_s", nullptr},
            {"correlation_east", nullptr},
            {"correlation_north", nullptr},
            {"max_m_per_s", nullptr},
            {"max_lat_deg", nullptr},
            {"max_lon_deg", nullptr},
            {"max_depth_m", nullptr},
            {"max_time", nullptr}};
  return {{"nodes", row.nodes},
          {"rms_m_per_s", row.rms()},
          {"bias_east_m_per_s", row.sides[0].bias},
          {"bias_north_m_per_s", row.sides[1].bias},
          {"correlation_east", correlation(row.sides[0])},
          {"correlation_north", correlation(row.sides[1])},
          {"max_m_per_s", row.longest},
          {"max_lat_deg", axes.lats_deg[row.j]},
          {"max_lon_deg", axes.lons_deg[row.i]},
          {"max_depth_m", axes.has_depth ? ordered_json(axes.depths_m[row.z]) : ordered_json{}},
          {"max_time", axes.has_time ? ordered_json(time_text(axes.times_s[row.t])) : ordered_json{}}};
}

void print_row(const std::string& name, const Row& row, const ocean::GridAxes& axes, std::ostream& out) {
  const auto correlation = [](const Row::Side& side) {
    const auto value = side.correlation();
    return value ? decimal(*value, 4) : std::string{"-"};
  };
  char line[160];
  if (row.nodes == 0) {
    std::snprintf(line, sizeof line, "%-22s %10d  nothing to compare\n", name.c_str(), 0);
    out << line;
    return;
  }
  std::snprintf(line, sizeof line, "%-22s %10llu %7.4f %8.4f %8.4f %8s %8s %7.4f  ", name.c_str(),
                static_cast<unsigned long long>(row.nodes), row.rms(), row.sides[0].bias, row.sides[1].bias,
                correlation(row.sides[0]).c_str(), correlation(row.sides[1]).c_str(), row.longest);
  out << line << decimal(axes.lats_deg[row.j], 4) << ", " << decimal(axes.lons_deg[row.i], 4);
  if (axes.has_depth) out << ", " << decimal(axes.depths_m[row.z], 1) << " m";
  if (axes.has_time) out << ", " << time_text(axes.times_s[row.t]);
  out << '\n';
}

void print(const Comparison& result, const ocean::GridView& a, const ocean::GridView& b, const Overlap& overlap,
           std::ostream& out) {
  const auto& axes = a.axes;
  out << "A  " << a.facts.cycle << "\nB  " << b.facts.cycle << "\nB - A in m/s, east and north";
  if (axes.has_depth != b.axes.has_depth)
    out << "; " << (axes.has_depth ? "B" : "A") << " has no depths and is compared with the shallowest level";
  out << "\n\n" << std::string(37, ' ') << "rms   bias E   bias N   corr. E  corr. N    max  where\n";
  print_row("all", result.all, axes, out);
  if (axes.has_depth)
    for (std::size_t z = 0; z < axes.depths_m.size(); ++z)
      if (overlap.depths[z]) print_row(decimal(axes.depths_m[z], 1) + " m", result.depths[z], axes, out);
  if (axes.has_time)
    for (std::size_t t = 0; t < axes.times_s.size(); ++t)
      if (overlap.times[t]) print_row(time_text(axes.times_s[t]), result.times[t], axes, out);
  if (result.only_a + result.only_b > 0)
    out << "\nonly A has a current at " << result.only_a << " nodes, only B at " << result.only_b << '\n';
}

ordered_json json_of(const Comparison& result, const ocean::GridView& a, const ocean::GridView& b,
                     const Overlap& overlap) {
  const auto& axes = a.axes;
  ordered_json depths = ordered_json::array(), times = ordered_json::array();
  for (std::size_t z = 0; axes.has_depth && z < axes.depths_m.size(); ++z) {
    if (!overlap.depths[z]) continue;
    ordered_json row{{"depth_m", axes.depths_m[z]}};
    row.update(row_json(result.depths[z], axes));
    depths.push_back(std::move(row));
  }
  for (std::size_t t = 0; axes.has_time && t < axes.times_s.size(); ++t) {
    if (!overlap.times[t]) continue;
    ordered_json row{{"time", time_text(axes.times_s[t])}};
    row.update(row_json(result.times[t], axes));
    times.push_back(std::move(row));
  }
  return {{"schema", "glidehelm/field-diff/v1"}, {"a", a.facts.cycle},          {"b", b.facts.cycle},
          {"same_axes", a.axes == b.axes},       {"only_a", result.only_a},     {"only_b", result.only_b},
          {"all", row_json(result.all, axes)},   {"depths", std::move(depths)}, {"times", std::move(times)}};
}

}  // namespace

int run_field_diff(const FieldDiffOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (options.a.empty() || options.b.empty()) return refuse_field(err, 2, "two files are needed: A and B");
  if (!(options.tolerance >= 0)) return refuse_field(err, 2, "--tolerance: allowed is 0 m/s or more");
  const auto loaded_a = daemon::ingest_files({options.a}, options.ingest, world);
  if (!loaded_a) return refuse_field(err, 1, "A: " + loaded_a.error());
  const auto loaded_b = daemon::ingest_files({options.b}, options.ingest, world);
  if (!loaded_b) return refuse_field(err, 1, "B: " + loaded_b.error());
  const auto &a = (*loaded_a)->view, &b = (*loaded_b)->view;
  const Overlap overlap{a.axes, b.axes};
  if (const auto nothing = overlap.nothing(a.axes, b.axes); !nothing.empty()) return refuse_field(err, 1, nothing);
  const auto result = compare(a, b, overlap);
  if (result.all.nodes == 0) return refuse_field(err, 1, "the two have no node in common at which both have a current");

  const bool mask_differs = a.axes == b.axes && result.only_a + result.only_b > 0;
  const bool differ = result.all.longest > options.tolerance || mask_differs;
  if (options.json) {
    auto json = json_of(result, a, b, overlap);
    json["tolerance_m_per_s"] = options.tolerance;
    json["differ"] = differ;
    out << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  } else {
    print(result, a, b, overlap, out);
    out << (differ ? "\nthey differ" : "\nno difference") << " beyond " << decimal(options.tolerance, 4) << " m/s\n";
  }
  return differ ? 1 : 0;
}

}  // namespace glidehelm::cli
