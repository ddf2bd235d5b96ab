#include "daemon/ingest/whole_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/support/data.hpp"
#include "tests/support/netcdf.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span{text.data(), text.size()});
}

const char* kFixed = R"(netcdf a {
dimensions: x = 3 ; y = 5 ;
variables:
  double a(y, x) ; a:units = "m/s" ; a:odd = 1s, 2s, 3s ;
  short b(x) ;
  :title = "five" ;
data:
  a = 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15 ;
  b = 1, 2, 3 ;
})";
/// Records of several variables are padded to four bytes, those of a single one are not.
const char* kRecords = R"(netcdf b {
dimensions: t = UNLIMITED ; x = 3 ;
variables: short a(t, x) ; byte b(t) ; double t(t) ;
data: a = 1,2,3, 4,5,6, 7,8,9 ; b = 1, 2, 3 ; t = 1, 2, 3 ;
})";
const char* kSingle = R"(netcdf c {
dimensions: t = UNLIMITED ; x = 3 ;
variables: short a(t, x) ;
data: a = 1,2,3, 4,5,6, 7,8,9 ;
})";
const char* kNoRecords = R"(netcdf d {
dimensions: t = UNLIMITED ; x = 3 ;
variables: short a(t, x) ; float b(x) ;
data: b = 1, 2, 3 ;
})";

}  // namespace

TEST_CASE("a whole classic file is accepted, every shorter one is refused, in all three versions") {
  const test::ScratchFolder folder;
  for (const char* kind : {"classic", "64-bit offset", "64-bit data"})
    for (const char* cdl : {kFixed, kRecords, kSingle, kNoRecords}) {
      const auto bytes = test::file_bytes(test::make_netcdf(folder, "a.nc", cdl, kind));
      INFO(kind << " " << cdl);
      CHECK(check_whole(bytes_of(bytes)));
      const auto needed = classic_length(bytes_of(bytes));
      REQUIRE(needed);
      // The library pads the last variable or record to four bytes; no datum lies in the padding.
      CHECK(*needed <= bytes.size());
      CHECK(bytes.size() - *needed < 4);
      for (std::size_t length = 0; length < *needed; ++length) CHECK_FALSE(check_whole(bytes_of(bytes).first(length)));
    }
}

TEST_CASE("a truncated file is refused with both lengths") {
  const test::ScratchFolder folder;
  const auto bytes = test::file_bytes(test::make_netcdf(folder, "a.nc", kFixed));
  const auto needed = *classic_length(bytes_of(bytes));
  const auto cut = check_whole(bytes_of(bytes).first(bytes.size() - 40));
  REQUIRE_FALSE(cut);
  CHECK(cut.error().what == "truncated: the file has " + std::to_string(bytes.size() - 40) +
                                " bytes, its header needs " + std::to_string(needed));
}

TEST_CASE("NetCDF-4 files are measured by their superblock") {
  const test::ScratchFolder folder;
  for (const char* kind : {"netCDF-4", "netCDF-4 classic model"}) {
    const auto bytes = test::file_bytes(test::make_netcdf(folder, "a.nc", kFixed, kind));
    CHECK(check_whole(bytes_of(bytes)));
    CHECK_FALSE(check_whole(bytes_of(bytes).first(bytes.size() - 1)));
    CHECK_FALSE(check_whole(bytes_of(bytes).first(20)));
  }
}

TEST_CASE("counts that no file could hold do not make the check run, allocate or wrap") {
  const test::ScratchFolder folder;
  for (const char* kind : {"classic", "64-bit offset", "64-bit data"}) {
    const auto good = test::file_bytes(test::make_netcdf(folder, "a.nc", kRecords, kind));
    for (std::size_t at = 4; at + 4 <= 200; ++at) {
      std::string bad = good;
      for (std::size_t i = 0; i < 4; ++i) bad[at + i] = static_cast<char>(0xff);
      // Whatever these bytes meant: an answer, never a crash; and never a length that overflowed to a small one.
      if (const auto needed = classic_length(bytes_of(bad))) CHECK(*needed >= 32);
    }
  }
}

TEST_CASE("a file that is still being written as a stream is refused") {
  const test::ScratchFolder folder;
  auto bytes = test::file_bytes(test::make_netcdf(folder, "a.nc", kRecords));
  for (std::size_t i = 4; i < 8; ++i) bytes[i] = static_cast<char>(0xff);
  const auto answer = check_whole(bytes_of(bytes));
  REQUIRE_FALSE(answer);
  CHECK(answer.error().what == "still being written: its header does not say how many records it has");
}

TEST_CASE("what is no NetCDF is said to be none") {
  CHECK(check_whole({}).error().what == "the file is empty");
  CHECK(check_whole(bytes_of("CDF\x03 something")).error().what ==
        "classic NetCDF of version 3, allowed are 1, 2 and 5");
  using namespace std::string_literals;
  const auto what = [](const std::string& bytes) { return check_whole(bytes_of(bytes)).error().what; };
  const auto page =
      "not a NetCDF file: a web page: a server answered with a page instead of the file, perhaps an error or "
      "a login"s;
  CHECK(what("<html>404 not found</html>") == page);
  CHECK(what("\xef\xbb\xbf\r\n  <!DOCTYPE html><title>Sign in</title>") == page);
  CHECK(what("<?xml version=\"1.0\"?><ExceptionReport/>") ==
        "not a NetCDF file: an XML document: a server answered with it instead of the file");
  CHECK(what("netcdf f {\n") == "not a NetCDF file: CDL, the text form of a NetCDF file; make the file with ncgen");
  CHECK(what("quota exceeded\n") == "not a NetCDF file: plain text");
  CHECK(what("\x1f\x8b\x08\0\0"s) == "not a NetCDF file: compressed with gzip; unpack it first");
  CHECK(what("GRIB\0\0\0\2"s) ==
        "not a NetCDF file: a GRIB file; convert it to NetCDF first, for example with cdo or wgrib2");
  CHECK(what("PK\x03\x04....") == "not a NetCDF file: a ZIP archive (or Zarr in one); unpack it first");
  CHECK(what(std::string(4096, '\0')) ==
        "not a NetCDF file: nothing but zero bytes: room was made for it and nothing written");
  CHECK(what("\x01\x02\x03\x04") == "not a NetCDF file: it begins with neither CDF nor the HDF5 signature");
}

TEST_CASE("real data: every NetCDF file of the samples is whole, and no truncated copy of one is") {
  GLIDEHELM_NEEDS_DATA(data);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{data + "/currents"}) {
    if (entry.path().extension() != ".nc") continue;
    const auto bytes = test::file_bytes(entry.path().string());
    INFO(entry.path().string());
    CHECK(check_whole(bytes_of(bytes)));
    for (int part = 0; part < 50; ++part)
      CHECK_FALSE(check_whole(bytes_of(bytes).first(bytes.size() * static_cast<std::size_t>(part) / 50)));
    CHECK_FALSE(check_whole(bytes_of(bytes).first(bytes.size() - 4)));
    ++files;
  }
  CHECK(files > 40);
}
