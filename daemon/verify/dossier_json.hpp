#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/hash.hpp"
#include "core/chart/chart.hpp"
#include "core/ocean/analytic.hpp"
#include "core/ocean/composite.hpp"
#include "core/ocean/gridded.hpp"
#include "core/safety/judge.hpp"

/// What daemon and glidehelm-verify say to each other.
namespace glidehelm::verify {

/// A file that the verifier opens itself, and what it must turn out to be.
struct InputFile {
  std::string path;
  Sha256 hash;  ///< of a grid: `grid_identity`; of a coast file: of all its bytes
  friend bool operator==(const InputFile&, const InputFile&) = default;
};

/// SHA-256 of the fixed 96 bytes at the head of a flat grid (core/ocean/grid_format.hpp). They hold the checksums of
/// header and payload, which `open_grid` proves, so they name the whole file without hashing gigabytes. Nothing when
/// the bytes are fewer.
std::optional<Sha256> grid_identity(std::string_view first_bytes);
inline constexpr std::size_t kGridHead = 96;

/// One source of a composite field: a grid and what it counts for.
struct SourceFile {
  std::string name;
  InputFile grid;
  ocean::GriddedOptions options;
  std::vector<GeoPoint> region;  ///< corners; empty: everywhere
  double from_s{-1e18}, to_s{1e18};
  friend bool operator==(const SourceFile&, const SourceFile&) = default;
};

/// Everything one run of glidehelm-verify needs. At least one of `grid`, `sources` and `analytic`; several fields add.
struct VerifyRequest {
  safety::Dossier dossier;
  std::optional<InputFile> grid;
  ocean::GriddedOptions grid_options;
  std::vector<SourceFile> sources;  ///< in order of trust, instead of `grid`
  ocean::Seams seams;
  std::vector<ocean::AnalyticSpec> analytic;
  Instant analytic_start;  ///< t0 of specifications that name none
  ocean::Coverage analytic_box;
  std::optional<InputFile> coast, bathymetry;
  Metres least_depth{};  ///< of the water, with bathymetry
  std::vector<chart::Area> keep_in, keep_out;
  friend bool operator==(const VerifyRequest&, const VerifyRequest&) = default;
};

/// Why a text is not what it should be: where in the document, and what is wrong there.
struct JsonProblem {
  std::string what;
  [[nodiscard]] const std::string& message() const { return what; }
  friend bool operator==(const JsonProblem&, const JsonProblem&) = default;
};

/// One JSON document each, without line breaks. Exact: numbers come back bit by bit (shortest decimal that reads back;
/// NaN and infinities as the strings "nan", "inf", "-inf"), positions are radians, texts that are not printable ASCII
/// are {"hex": "…"}. Reading believes nothing: a missing member, another type, a position out of range, another schema
/// are problems; no exception leaves these functions.
std::string to_json(const safety::Dossier& dossier);
std::string to_json(const safety::Verdict& verdict);
std::string to_json(const VerifyRequest& request);
Expected<safety::Dossier, JsonProblem> dossier_from_json(std::string_view text);
Expected<safety::Verdict, JsonProblem> verdict_from_json(std::string_view text);
Expected<VerifyRequest, JsonProblem> request_from_json(std::string_view text);

}  // namespace glidehelm::verify
