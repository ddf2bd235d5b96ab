#include "daemon/ingest/opendap.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "daemon/ingest/ensemble.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kRemoteNodesAtMost = 4e7;

bool begins_with(const std::string& text, const char* begin) { return text.compare(0, std::strlen(begin), begin) == 0; }

bool has_password(const std::string& address) {
  const auto host = address.find("://") + 3;
  return address.substr(host, address.find('/', host) - host).find('@') != std::string::npos;
}

bool same(const Attribute& a, const Attribute& b) {
  const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return a.name == b.name && a.type == b.type && a.text == b.text &&
         std::equal(a.numbers.begin(), a.numbers.end(), b.numbers.begin(), b.numbers.end(), equal);
}
bool same(const std::vector<Attribute>& a, const std::vector<Attribute>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Attribute& x, const Attribute& y) { return same(x, y); });
}

/// True when two openings of an address describe the same data.
bool same_header(const NetcdfFile& a, const NetcdfFile& b) {
  const auto same_dimension = [](const Dimension& x, const Dimension& y) {
    return x.name == y.name && x.length == y.length;
  };
  const auto same_variable = [](const Variable& x, const Variable& y) {
    return x.name == y.name && x.type == y.type && x.dimensions == y.dimensions && same(x.attributes, y.attributes);
  };
  return std::equal(a.dimensions().begin(), a.dimensions().end(), b.dimensions().begin(), b.dimensions().end(),
                    same_dimension) &&
         std::equal(a.variables().begin(), a.variables().end(), b.variables().begin(), b.variables().end(),
                    same_variable) &&
         same(a.attributes(), b.attributes());
}

/// True when `again`, which holds the last time only, repeats what `grid` has then.
bool same_last_time(const ocean::Grid& grid, const ocean::Grid& again) {
  if (again.axes.lats_deg != grid.axes.lats_deg || again.axes.lons_deg != grid.axes.lons_deg ||
      again.axes.depths_m != grid.axes.depths_m)
    return false;
  const auto last = grid.values.end() - static_cast<std::ptrdiff_t>(again.values.size());
  // Zeros that all times together showed to be land may be too few to tell in one.
  return std::equal(again.values.begin(), again.values.end(), last,
                    [](float a, float b) { return a == b || (std::isnan(b) && (std::isnan(a) || a == 0)); });
}

Sha256 hash_of(const ocean::Grid& grid) {
  std::string bytes;
  const auto append = [&](const auto& numbers) {
    bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0]));
  };
  for (const auto* axis : {&grid.axes.times_s, &grid.axes.depths_m, &grid.axes.lats_deg, &grid.axes.lons_deg})
    append(*axis);
  append(grid.values);
  return Sha256::of(bytes);
}

}  // namespace

bool is_address(const std::string& name) { return begins_with(name, "http://") || begins_with(name, "https://"); }

Expected<Part, AddressFault> read_address(const std::string& address, const Units& units, ReadOptions options) {
  const auto passing = [](std::string what) { return unexpected(AddressFault{std::move(what), true}); };
  if (has_password(address))
    return unexpected(
        AddressFault{"an address with a name and password would stand in every log; it is not read", false});
  options.nodes_at_most = std::min(options.nodes_at_most, kRemoteNodesAtMost);
  auto opened = NetcdfFile::open_address(address);
  if (!opened) return passing(opened.error().what);
  const auto file = one_member(std::move(opened), options.member);
  if (!file) return unexpected(AddressFault{file.error().what, file.error().by_library});
  auto part = read_open_file(address, *file, Sha256{}, units, options);
  if (!part) return unexpected(AddressFault{part.error().what, part.error().by_library});

  const auto again = one_member(NetcdfFile::open_address(address), options.member);
  if (!again) return passing(again.error().what);
  options.only_time_s = part->grid.axes.times_s.back();
  const auto last = read_open_file(address, *again, Sha256{}, units, options);
  if (!last && last.error().by_library) return passing(last.error().what);
  if (!same_header(*file, *again) || !last || !same_last_time(part->grid, last->grid))
    return passing("it changed while it was read: it is still being written");
  part->grid.facts.sources.front().hash = hash_of(part->grid);
  return std::move(*part);
}

}  // namespace glidehelm::ingest
