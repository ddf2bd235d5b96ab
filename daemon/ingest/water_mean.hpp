#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ocean/seawater.hpp"

namespace glidehelm::ingest {

/// One column of temperature and salinity out of many, each of which may end at a bottom of its own.
///
/// Down to the depth that half of the columns reach, each level has the mean over the columns that reach it, the same ones at every
/// level; deeper, the change from level to level is the mean over the columns that have both. A mean over all that have water at a level
/// would lose the shelf's cold water where the shelf ends, and become warmer and lighter downwards although no column does. Where all
/// columns are equally deep the two are the same. The column ends where none goes on.
class WaterMean {
 public:
  explicit WaterMean(std::size_t levels) : by_deepest_(levels, std::vector<Sum>(levels)), steps_(levels) {}

  /// One column, by level from the top, NaN where it has none. Exactly 0 °C with salinity 0 is what land is filled with, and is none; a
  /// value that no sea has makes `impossible`.
  void add(std::span<const double> temperature_c, std::span<const double> salinity);

  /// Columns with water at one level or more.
  [[nodiscard]] std::size_t columns() const { return columns_; }
  /// The first value that no sea has, in words.
  [[nodiscard]] const std::optional<std::string>& impossible() const { return impossible_; }
  /// The column at the levels' depths, as far as it goes.
  [[nodiscard]] std::vector<ocean::WaterLayer> layers(std::span<const double> depths_m) const;

 private:
  struct Sum {
    double temperature{}, salinity{};
    std::size_t count{};
    void add(double t, double s) { temperature += t, salinity += s, ++count; }
    void add(const Sum& sum) { temperature += sum.temperature, salinity += sum.salinity, count += sum.count; }
  };
  /// The deepest level that half of the columns reach.
  [[nodiscard]] std::size_t reached_by_half() const;

  std::vector<std::vector<Sum>> by_deepest_;  ///< of the values by the column's deepest level, then by level
  std::vector<Sum> steps_;                    ///< of the changes from the level above
  std::size_t columns_{};
  std::optional<std::string> impossible_;
};

}  // namespace glidehelm::ingest
