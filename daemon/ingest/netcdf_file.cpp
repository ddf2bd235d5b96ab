#include "daemon/ingest/netcdf_file.hpp"

#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

Type type_of(nc_type type) {
  switch (type) {
    case NC_CHAR:
    case NC_STRING:
      return Type::text;
    case NC_BYTE:
      return Type::int8;
    case NC_UBYTE:
      return Type::uint8;
    case NC_SHORT:
      return Type::int16;
    case NC_USHORT:
      return Type::uint16;
    case NC_INT:
      return Type::int32;
    case NC_UINT:
      return Type::uint32;
    case NC_INT64:
      return Type::int64;
    case NC_UINT64:
      return Type::uint64;
    case NC_FLOAT:
      return Type::float32;
    case NC_DOUBLE:
      return Type::float64;
    default:
      return Type::other;
  }
}

Unexpected<Fault> library_fault(const std::string& doing, int code) {
  return unexpected(Fault{"unreadable while " + doing + ": " + nc_strerror(code), true});
}

/// A C text without what follows its first NUL: some writers pad with them.
std::string cut_at_nul(std::string text) {
  if (const auto nul = text.find('\0'); nul != std::string::npos) text.resize(nul);
  return text;
}

}  // namespace

const Attribute* Variable::find(std::string_view attribute) const {
  for (const auto& candidate : attributes)
    if (candidate.name == attribute) return &candidate;
  return nullptr;
}

double Variable::as_meant(double stored) const {
  if (!is_unsigned || !(stored < 0)) return stored;
  const double turn = type == Type::int8 ? 0x1p8 : type == Type::int16 ? 0x1p16 : type == Type::int32 ? 0x1p32 : 0x1p64;
  return stored + turn;
}

std::string Variable::text(std::string_view attribute) const {
  const auto* found = find(attribute);
  return found != nullptr ? std::string{trimmed(found->text)} : std::string{};
}

std::optional<std::string> Variable::unit() const {
  for (const char* spelling : {"units", "unit", "Unit", "Units"})
    if (auto value = text(spelling); !value.empty()) return value;
  return std::nullopt;
}

NetcdfFile::~NetcdfFile() {
  if (id_ >= 0) nc_close(id_);
}
NetcdfFile::NetcdfFile(NetcdfFile&& other) noexcept
    : id_{std::exchange(other.id_, -1)},
      remote_{other.remote_},
      dimensions_{std::move(other.dimensions_)},
      variables_{std::move(other.variables_)},
      attributes_{std::move(other.attributes_)},
      groups_{std::move(other.groups_)},
      member_{std::move(other.member_)} {}

Result<NetcdfFile> NetcdfFile::open(std::span<const std::byte> bytes) {
  int id = -1;
  // The library takes a pointer to non-const memory but NC_NOWRITE leaves it alone.
  void* memory = const_cast<std::byte*>(bytes.data());
  if (const int code = nc_open_mem("forecast", NC_NOWRITE, bytes.size(), memory, &id); code != NC_NOERR)
    return library_fault("opening", code);
  NetcdfFile file{id, false};
  if (auto header = file.read_header(); !header) return unexpected(header.error());
  return file;
}

Result<NetcdfFile> NetcdfFile::open_address(const std::string& address) {
  int id = -1;
  const std::string uncached = address + (address.find('#') == std::string::npos ? "#" : "&") + "noprefetch&nocache";
  if (const int code = nc_open(uncached.c_str(), NC_NOWRITE, &id); code != NC_NOERR)
    return library_fault("asking the OPeNDAP server", code);
  NetcdfFile file{id, true};
  if (auto header = file.read_header(); !header) return unexpected(header.error());
  return file;
}

Result<std::vector<Attribute>> NetcdfFile::read_attributes(int variable, int count) const {
  std::vector<Attribute> attributes;
  for (int i = 0; i < count; ++i) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_type type{};
    std::size_t length = 0;
    if (const int code = nc_inq_attname(id_, variable, i, name.data()); code != NC_NOERR)
      return library_fault("listing attributes", code);
    if (const int code = nc_inq_att(id_, variable, name.data(), &type, &length); code != NC_NOERR)
      return library_fault(std::string{"reading attribute "} + name.data(), code);
    Attribute attribute{name.data(), type_of(type), {}, {}};
    int code = NC_NOERR;
    if (type == NC_CHAR) {
      attribute.text.resize(length);
      code = nc_get_att_text(id_, variable, name.data(), attribute.text.data());
      attribute.text = cut_at_nul(std::move(attribute.text));
    } else if (type == NC_STRING && length > 0) {
      std::vector<char*> strings(length, nullptr);
      code = nc_get_att_string(id_, variable, name.data(), strings.data());
      if (code == NC_NOERR) {
        if (strings[0] != nullptr) attribute.text = strings[0];
        nc_free_string(length, strings.data());
      }
    } else if (is_number(attribute.type)) {
      attribute.numbers.resize(length);
      code = nc_get_att_double(id_, variable, name.data(), attribute.numbers.data());
    }
    if (code != NC_NOERR) return library_fault(std::string{"reading attribute "} + name.data(), code);
    attributes.push_back(std::move(attribute));
  }
  return attributes;
}

Result<Done> NetcdfFile::read_header() {
  int dimensions = 0, variables = 0, globals = 0, unlimited = 0;
  if (const int code = nc_inq(id_, &dimensions, &variables, &globals, &unlimited); code != NC_NOERR)
    return library_fault("reading the header", code);
  std::vector<int> dimension_ids(static_cast<std::size_t>(dimensions));
  if (const int code = nc_inq_dimids(id_, &dimensions, dimension_ids.data(), 0); code != NC_NOERR)
    return library_fault("reading the dimensions", code);
  for (const int dimension : dimension_ids) {
    std::array<char, NC_MAX_NAME + 1> name{};
    std::size_t length = 0;
    if (const int code = nc_inq_dim(id_, dimension, name.data(), &length); code != NC_NOERR)
      return library_fault("reading the dimensions", code);
    dimensions_.push_back({name.data(), length});
  }
  for (int v = 0; v < variables; ++v) {
    std::array<char, NC_MAX_NAME + 1> name{};
    std::array<int, NC_MAX_VAR_DIMS> ids{};
    nc_type type{};
    int rank = 0, count = 0;
    if (const int code = nc_inq_var(id_, v, name.data(), &type, &rank, ids.data(), &count); code != NC_NOERR)
      return library_fault("reading the variables", code);
    Variable variable{v, name.data(), type_of(type), {}, {}, false, {}};
    for (int d = 0; d < rank; ++d) {
      std::size_t at = 0;
      while (at < dimension_ids.size() && dimension_ids[at] != ids[static_cast<std::size_t>(d)]) ++at;
      if (at == dimension_ids.size()) return fault("variable " + variable.name + " has a dimension of another group");
      variable.dimensions.push_back(at);
    }
    auto attributes = read_attributes(v, count);
    if (!attributes) return unexpected(attributes.error());
    variable.attributes = std::move(*attributes);
    const bool is_signed = variable.type == Type::int8 || variable.type == Type::int16 ||
                           variable.type == Type::int32 || variable.type == Type::int64;
    variable.is_unsigned = is_signed && lower(variable.text("_Unsigned")) == "true";
    variables_.push_back(std::move(variable));
  }
  auto attributes = read_attributes(NC_GLOBAL, globals);
  if (!attributes) return unexpected(attributes.error());
  attributes_ = std::move(*attributes);
  return read_groups();
}

Result<Done> NetcdfFile::read_groups() {
  int count = 0;
  if (const int code = nc_inq_grps(id_, &count, nullptr); code != NC_NOERR)
    return library_fault("listing the groups", code);
  std::vector<int> ids(static_cast<std::size_t>(count));
  if (count > 0) nc_inq_grps(id_, &count, ids.data());
  for (const int group : ids) {
    std::array<char, NC_MAX_NAME + 1> name{};
    if (const int code = nc_inq_grpname(group, name.data()); code != NC_NOERR)
      return library_fault("listing the groups", code);
    groups_.emplace_back(name.data());
  }
  return Done{};
}

const Variable* NetcdfFile::find(std::string_view name) const {
  for (const auto& variable : variables_)
    if (variable.name == name) return &variable;
  return nullptr;
}

std::string NetcdfFile::text(std::string_view attribute) const {
  for (const auto& candidate : attributes_)
    if (candidate.name == attribute) return std::string{trimmed(candidate.text)};
  return {};
}

void NetcdfFile::narrow(EnsembleMember member) {
  for (auto& variable : variables_) {
    std::vector<std::size_t> left;
    for (std::size_t d = 0; d < variable.dimensions.size(); ++d)
      if (variable.dimensions[d] == member.dimension)
        variable.narrowed.push_back(d);
      else
        left.push_back(variable.dimensions[d]);
    variable.dimensions = std::move(left);
  }
  member_ = std::move(member);
}

std::string NetcdfFile::shape_of(const Variable& variable) const {
  std::string text = variable.name + "(";
  for (std::size_t d = 0; d < variable.dimensions.size(); ++d)
    text += (d > 0 ? ", " : "") + dimensions_[variable.dimensions[d]].name;
  return text + ")";
}

Result<Done> NetcdfFile::prove_end(const Variable& variable, std::span<const std::size_t> start,
                                   std::span<const std::size_t> count, const std::vector<double>& values) const {
  std::size_t zeros = 0;
  while (zeros < values.size() && values[values.size() - 1 - zeros] == 0) ++zeros;
  std::vector<std::size_t> from(start.begin(), start.end()), some(count.begin(), count.end());
  for (std::size_t d = 0; d < some.size(); ++d) {
    if (zeros > 0 && count[d] > 1) {
      // From here on dimensions are whole, so that what is read again is the end of what was read.
      const std::size_t row = values.size() / count[d];
      const std::size_t rows = std::min(count[d], (zeros + row - 1) / row);
      from[d] += count[d] - rows;
      some[d] = rows;
      break;
    }
    from[d] += count[d] - 1;
    some[d] = 1;
  }
  const auto again = fetch(variable, from, some);
  if (!again) return unexpected(again.error());
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  if (!std::equal(again->rbegin(), again->rend(), values.rbegin(), same))
    return unexpected(Fault{"an answer with " + variable.name + " ended early, or the values changed meanwhile", true});
  return Done{};
}

Result<std::vector<double>> NetcdfFile::read(const Variable& variable, std::span<const std::size_t> start,
                                             std::span<const std::size_t> count) const {
  auto values = fetch(variable, start, count);
  if (remote_ && values && !values->empty())
    if (auto whole = prove_end(variable, start, count, *values); !whole) return unexpected(whole.error());
  return values;
}

Result<std::vector<double>> NetcdfFile::fetch(const Variable& variable, std::span<const std::size_t> start,
                                              std::span<const std::size_t> count) const {
  std::size_t size = 1;
  for (const auto n : count) size *= n;
  std::vector<double> values(size);
  if (size == 0) return values;
  std::vector<std::size_t> from(start.begin(), start.end()), some(count.begin(), count.end());
  for (const auto d : variable.narrowed) {
    from.insert(from.begin() + static_cast<std::ptrdiff_t>(d), member_->index);
    some.insert(some.begin() + static_cast<std::ptrdiff_t>(d), 1);
  }
  const int code = from.empty() ? nc_get_var_double(id_, variable.id, values.data())
                                : nc_get_vara_double(id_, variable.id, from.data(), some.data(), values.data());
  if (code != NC_NOERR) return library_fault("reading " + variable.name, code);
  if (variable.is_unsigned)
    for (double& value : values) value = variable.as_meant(value);
  return values;
}

Result<std::vector<double>> NetcdfFile::read(const Variable& variable) const {
  std::vector<std::size_t> start(variable.dimensions.size(), 0), count;
  for (const auto dimension : variable.dimensions) count.push_back(length_of(dimension));
  return read(variable, start, count);
}

}  // namespace glidehelm::ingest
