#include "daemon/ingest/whole_file.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

constexpr std::uint64_t kHuge = std::uint64_t{1} << 62;

std::uint64_t multiplied(std::uint64_t a, std::uint64_t b) { return a != 0 && b > kHuge / a ? kHuge : a * b; }
std::uint64_t added(std::uint64_t a, std::uint64_t b) { return std::min(kHuge, a + b); }

/// Reads the big-endian header of a classic file. After a read beyond the end `failed` is set and all reads give zero.
struct Header {
  std::span<const std::byte> bytes;
  int version{};
  std::size_t at{};
  bool failed{};

  std::uint64_t big_endian(std::size_t width) {
    if (failed || bytes.size() - at < width) {
      failed = true;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width; ++i) value = value << 8 | static_cast<std::uint64_t>(bytes[at + i]);
    at += width;
    return value;
  }
  std::uint32_t tag() { return static_cast<std::uint32_t>(big_endian(4)); }
  /// NON_NEG of the format: 64 bits in CDF-5, else 32.
  std::uint64_t count() { return big_endian(version == 5 ? 8 : 4); }
  std::uint64_t offset() { return big_endian(version == 1 ? 4 : 8); }
  void skip(std::uint64_t length) {
    if (failed || bytes.size() - at < length) {
      failed = true;
      return;
    }
    at += static_cast<std::size_t>(length);
  }
  std::string name() {
    const auto length = count();
    if (failed || bytes.size() - at < length) {
      failed = true;
      return {};
    }
    std::string text(reinterpret_cast<const char*>(bytes.data() + at), static_cast<std::size_t>(length));
    skip((length + 3) / 4 * 4);
    return text;
  }
};

/// Bytes of one value of an nc_type; 0 for a number that is no type of this version.
std::uint64_t width_of(std::uint32_t type, int version) {
  switch (type) {
    case 1:
    case 2:
      return 1;  // byte, char
    case 3:
      return 2;  // short
    case 4:
    case 5:
      return 4;  // int, float
    case 6:
      return 8;  // double
    case 7:
      return version == 5 ? 1 : 0;  // unsigned byte
    case 8:
      return version == 5 ? 2 : 0;  // unsigned short
    case 9:
      return version == 5 ? 4 : 0;  // unsigned int
    case 10:
    case 11:
      return version == 5 ? 8 : 0;  // 64-bit
    default:
      return 0;
  }
}

constexpr std::uint32_t kDimensions = 10, kVariables = 11, kAttributes = 12;

/// The number of entries of a list that must carry `tag`; an absent list is two zeros.
std::uint64_t list(Header& header, std::uint32_t tag) {
  const auto found = header.tag();
  const auto entries = header.count();
  if (found == 0 && entries == 0) return 0;
  if (found != tag || entries > header.bytes.size()) header.failed = true;
  return header.failed ? 0 : entries;
}

void skip_attributes(Header& header) {
  const auto entries = list(header, kAttributes);
  for (std::uint64_t i = 0; i < entries && !header.failed; ++i) {
    header.name();
    const auto width = width_of(header.tag(), header.version);
    const auto values = header.count();
    if (width == 0) header.failed = true;
    header.skip(multiplied(values, width) / 4 * 4 + (multiplied(values, width) % 4 != 0 ? 4 : 0));
  }
}

struct Extent {
  std::uint64_t begin{}, size{};  ///< of a record variable: of one record
  bool record{};
};

/// Reads the list of variables; `lengths` are the dimensions', 0 marks the record dimension.
std::vector<Extent> variables(Header& header, const std::vector<std::uint64_t>& lengths) {
  std::vector<Extent> extents;
  const auto entries = list(header, kVariables);
  for (std::uint64_t i = 0; i < entries && !header.failed; ++i) {
    header.name();
    const auto rank = header.count();
    Extent extent;
    std::uint64_t values = 1;
    for (std::uint64_t d = 0; d < rank && !header.failed; ++d) {
      const auto id = header.count();
      if (id >= lengths.size() || (lengths[id] == 0 && d != 0)) {
        header.failed = true;
        break;
      }
      if (lengths[id] == 0)
        extent.record = true;
      else
        values = multiplied(values, lengths[id]);
    }
    skip_attributes(header);
    const auto width = width_of(header.tag(), header.version);
    if (width == 0) header.failed = true;
    header.count();  // vsize: redundant, and wrong for large variables
    extent.begin = header.offset();
    extent.size = multiplied(values, width);
    extents.push_back(extent);
  }
  return extents;
}

std::uint64_t little_endian(std::span<const std::byte> bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = width; i-- > 0;) value = value << 8 | static_cast<std::uint64_t>(bytes[at + i]);
  return value;
}

/// The end-of-file address of an HDF5 superblock at offset 0; 0 when this is none that we know.
std::uint64_t hdf5_length(std::span<const std::byte> file) {
  if (file.size() < 48) return 0;
  const auto version = static_cast<unsigned>(file[8]);
  if (version <= 1 && static_cast<unsigned>(file[13]) == 8 && file.size() >= 56)
    return little_endian(file, version == 0 ? 40 : 44, 8);
  if ((version == 2 || version == 3) && static_cast<unsigned>(file[9]) == 8) return little_endian(file, 28, 8);
  return 0;
}

Fault truncated(std::uint64_t found, std::uint64_t needed) {
  return {"truncated: the file has " + std::to_string(found) + " bytes, its header needs " + std::to_string(needed)};
}

bool begins_with(std::string_view text, std::string_view begin) { return text.substr(0, begin.size()) == begin; }

/// What bytes are that are no NetCDF, as far as their beginning tells.
std::string what_it_is(std::string_view bytes) {
  using namespace std::string_view_literals;
  static constexpr std::pair<std::string_view, const char*> kKnown[] = {
      {"\x1f\x8b"sv, "compressed with gzip; unpack it first"},
      {"BZh"sv, "compressed with bzip2; unpack it first"},
      {"\xfd"
       "7zXZ"sv,
       "compressed with xz; unpack it first"},
      {"\x28\xb5\x2f\xfd"sv, "compressed with zstd; unpack it first"},
      {"PK\x03\x04"sv, "a ZIP archive (or Zarr in one); unpack it first"},
      {"GRIB"sv, "a GRIB file; convert it to NetCDF first, for example with cdo or wgrib2"},
      {"BUFR"sv, "a BUFR file"},
      {"\x0e\x03\x13\x01"sv, "an HDF4 file; convert it to NetCDF first"},
      {"%PDF"sv, "a PDF document"},
      {"\x89PNG"sv, "a picture"},
      {"\xff\xd8\xff"sv, "a picture"}};
  for (const auto& [begin, what] : kKnown)
    if (begins_with(bytes, begin)) return what;
  if (bytes.find_first_not_of('\0') == std::string_view::npos)
    return "nothing but zero bytes: room was made for it and nothing written";
  std::string_view visible = bytes.substr(0, 512);
  if (begins_with(visible, "\xef\xbb\xbf")) visible.remove_prefix(3);
  visible.remove_prefix(std::min(visible.size(), visible.find_first_not_of(" \t\r\n")));
  const auto first = lower(visible.substr(0, 9));
  if (begins_with(first, "<!doctype") || begins_with(first, "<html"))
    return "a web page: a server answered with a page instead of the file, perhaps an error or a login";
  if (begins_with(first, "<?xml")) return "an XML document: a server answered with it instead of the file";
  if (begins_with(first, "netcdf ")) return "CDL, the text form of a NetCDF file; make the file with ncgen";
  const bool text = std::all_of(visible.begin(), visible.end(),
                                [](unsigned char c) { return c >= 0x20 || c == '\n' || c == '\r' || c == '\t'; });
  return text ? "plain text" : "it begins with neither CDF nor the HDF5 signature";
}

}  // namespace

Result<std::uint64_t> classic_length(std::span<const std::byte> file) {
  Header header{file};
  if (file.size() < 4 || std::memcmp(file.data(), "CDF", 3) != 0) return fault("not a classic NetCDF file");
  header.version = static_cast<int>(file[3]);
  if (header.version != 1 && header.version != 2 && header.version != 5)
    return fault("classic NetCDF of version " + std::to_string(header.version) + ", allowed are 1, 2 and 5");
  header.at = 4;
  const auto records = header.count();
  const bool streaming = records == (header.version == 5 ? std::numeric_limits<std::uint64_t>::max() : 0xffffffffU);

  std::vector<std::uint64_t> lengths;
  const auto dimensions = list(header, kDimensions);
  for (std::uint64_t i = 0; i < dimensions && !header.failed; ++i) {
    header.name();
    lengths.push_back(header.count());
  }
  skip_attributes(header);
  const auto extents = variables(header, lengths);
  if (header.failed)
    return fault("truncated or damaged: its header does not end within " + std::to_string(file.size()) + " bytes");

  std::uint64_t record_size = 0, record_variables = 0, end = header.at;
  for (const auto& extent : extents) {
    if (!extent.record) {
      end = std::max(end, added(extent.begin, extent.size));
      continue;
    }
    ++record_variables;
    record_size = added(record_size, added(extent.size, 3) / 4 * 4);
  }
  if (record_variables == 0) return end;
  if (streaming) return fault("still being written: its header does not say how many records it has");
  // A single record variable is written without padding between its records.
  if (record_variables == 1)
    for (const auto& extent : extents)
      if (extent.record) record_size = extent.size;
  for (const auto& extent : extents)
    if (extent.record && records > 0)
      end = std::max(end, added(extent.begin, added(multiplied(records - 1, record_size), extent.size)));
  return end;
}

Result<Done> check_whole(std::span<const std::byte> file) {
  if (file.empty()) return fault("the file is empty");
  if (file.size() >= 4 && std::memcmp(file.data(), "CDF", 3) == 0) {
    const auto needed = classic_length(file);
    if (!needed) return unexpected(needed.error());
    if (*needed > file.size()) return unexpected(truncated(file.size(), *needed));
    return Done{};
  }
  static constexpr unsigned char kHdf5[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  if (file.size() >= 8 && std::memcmp(file.data(), kHdf5, 8) == 0) {
    const auto needed = hdf5_length(file);
    if (needed == 0) return fault("truncated or damaged: its HDF5 superblock cannot be read");
    if (needed > file.size()) return unexpected(truncated(file.size(), needed));
    return Done{};
  }
  return fault("not a NetCDF file: " + what_it_is({reinterpret_cast<const char*>(file.data()), file.size()}));
}

}  // namespace glidehelm::ingest
