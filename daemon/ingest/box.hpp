#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/component.hpp"
#include "daemon/ingest/part.hpp"
#include "daemon/ingest/recognise.hpp"

/// The part of a file that is read: its axes in the grid's order, and any variable over them.
namespace glidehelm::ingest {

/// Axes ascending, with the way back to the file; without a time (depth) axis one value that means nothing.
struct Box {
  Ascending times, depths, lats, lons;
  bool has_time{}, has_depth{};
  [[nodiscard]] ocean::GridAxes axes() const {
    return {times.values, depths.values, lats.values, lons.values, has_time, has_depth};
  }
};

/// Reads the axes, and cuts them to the area that was asked for. Refused: more nodes than the
/// options allow.
Result<Box> read_box(const NetcdfFile& file, const Axes& axes, const Units& units, const ReadOptions& options,
                     std::vector<std::string>& warnings);

/// What reading a variable showed beside its values.
struct Told {
  std::size_t outside_valid{};  ///< values outside the valid range; they are kept
  bool nothing{true};           ///< no value at all
  std::array<bool, 3> marks{};  ///< by Missing::Mark: met before the first value
};

/// Reads a variable on `axes` over the box into `values[0]`, `values[step]`, `values[2·step]`, …, ordered [time][depth]
/// [latitude][longitude], in the unit of `component`.
Result<Told> read_values(const NetcdfFile& file, const Variable& variable, const Axes& axes, const Box& box,
                         const Component& component, float* values, std::size_t step);

}  // namespace glidehelm::ingest
