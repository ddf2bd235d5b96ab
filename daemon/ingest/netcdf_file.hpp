#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

/// Types as far as reading numbers needs them.
enum class Type { text, int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64, other };
[[nodiscard]] inline bool is_number(Type type) { return type != Type::text && type != Type::other; }
[[nodiscard]] inline bool is_floating(Type type) { return type == Type::float32 || type == Type::float64; }

struct Attribute {
  std::string name;
  Type type{Type::other};
  std::string text;             ///< of text and string attributes
  std::vector<double> numbers;  ///< of numeric ones
};

struct Dimension {
  std::string name;
  std::size_t length{};
};

struct Variable {
  int id{};
  std::string name;
  Type type{Type::other};
  std::vector<std::size_t> dimensions;  ///< indices into NetcdfFile::dimensions
  std::vector<Attribute> attributes;
  /// The values are unsigned although the type is not (`_Unsigned = "true"`, for formats without unsigned types).
  bool is_unsigned{};
  /// Where, in the file's own order, the dimension stood that NetcdfFile::narrow took out; ascending, mostly empty.
  std::vector<std::size_t> narrowed{};

  /// A stored number, or one of an attribute that is compared with stored ones, as the file means it: negative numbers
  /// of an `is_unsigned` variable become what their bits say without a sign.
  [[nodiscard]] double as_meant(double stored) const;
  [[nodiscard]] const Attribute* find(std::string_view attribute) const;
  /// Trimmed text of an attribute; empty when absent or not text.
  [[nodiscard]] std::string text(std::string_view attribute) const;
  /// The unit: `units`, also written `unit`, `Unit`, `Units`; nothing when none of them is there (or it is empty).
  [[nodiscard]] std::optional<std::string> unit() const;
};

/// One member of an ensemble that lies along a dimension.
struct EnsembleMember {
  std::size_t dimension{};      ///< index into NetcdfFile::dimensions
  std::size_t count{};          ///< members that the file holds
  std::size_t index{};          ///< from 0, in the order of the file
  std::string name;             ///< of the dimension
  std::string why;              ///< how it was recognised: "standard_name realization", "by name"
  std::optional<double> label;  ///< the number that the file itself gives the member
};

/// One NetCDF file of any format, held in memory: the library never opens a path (it would open it twice), and nobody can
/// change the bytes while they are read. Only the root group is read; others are named.
class NetcdfFile {
 public:
  /// Reads the header. Precondition: check_whole() accepted the bytes, which stay alive.
  static Result<NetcdfFile> open(std::span<const std::byte> bytes);
  /// Asks an OPeNDAP server for the header; `read` asks for values. Blocks as long as the server is silent.
  ///
  /// libnetcdf takes an answer that ends early for a whole one and leaves zeros where it ended ("packet is apparently too
  /// short" on stderr is all it says). So the end of every answer is asked for again by itself and must be the same: the
  /// last value, or, where the answer ends in zeros, all that belongs to them. Nothing is taken from the library's cache.
  static Result<NetcdfFile> open_address(const std::string& address);
  ~NetcdfFile();
  NetcdfFile(NetcdfFile&& other) noexcept;
  NetcdfFile& operator=(NetcdfFile&&) = delete;

  [[nodiscard]] const std::vector<Dimension>& dimensions() const { return dimensions_; }
  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  [[nodiscard]] const std::vector<Attribute>& attributes() const { return attributes_; }
  /// Names of the groups below the root, in the order of the file; empty but in NetCDF-4.
  [[nodiscard]] const std::vector<std::string>& groups() const { return groups_; }
  [[nodiscard]] const Variable* find(std::string_view name) const;
  /// Text of a global attribute; empty when absent.
  [[nodiscard]] std::string text(std::string_view attribute) const;
  [[nodiscard]] std::size_t length_of(std::size_t dimension) const { return dimensions_[dimension].length; }
  /// From here on the file is that member alone: its dimension is gone from every variable, and reading counts without it.
  void narrow(EnsembleMember member);
  [[nodiscard]] const std::optional<EnsembleMember>& member() const { return member_; }
  /// "u(time, lat, lon)".
  [[nodiscard]] std::string shape_of(const Variable& variable) const;

  /// The stored numbers of a box of a variable as doubles, row-major, neither unpacked nor masked, `as_meant`.
  Result<std::vector<double>> read(const Variable& variable, std::span<const std::size_t> start,
                                   std::span<const std::size_t> count) const;
  Result<std::vector<double>> read(const Variable& variable) const;

 private:
  NetcdfFile(int id, bool remote) : id_{id}, remote_{remote} {}
  Result<std::vector<double>> fetch(const Variable& variable, std::span<const std::size_t> start,
                                    std::span<const std::size_t> count) const;
  [[nodiscard]] Result<Done> prove_end(const Variable& variable, std::span<const std::size_t> start,
                                       std::span<const std::size_t> count, const std::vector<double>& values) const;
  Result<Done> read_header();
  Result<Done> read_groups();
  Result<std::vector<Attribute>> read_attributes(int variable, int count) const;
  int id_{-1};
  bool remote_{};
  std::vector<Dimension> dimensions_;
  std::vector<Variable> variables_;
  std::vector<Attribute> attributes_;
  std::vector<std::string> groups_;
  std::optional<EnsembleMember> member_;
};

}  // namespace glidehelm::ingest
