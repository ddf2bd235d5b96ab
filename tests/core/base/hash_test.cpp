#include "core/base/hash.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;

TEST_CASE("SHA-256 gives the values of FIPS 180-4") {
  CHECK(Sha256::of(std::string_view{"abc"}).hex() ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(Sha256::of(std::string_view{}).hex() == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_CASE("a hash is read back from its hexadecimal digits, and only from those") {
  const auto hash = Sha256::of(std::string_view{"abc"});
  Sha256 read;
  REQUIRE(Sha256::from_hex(hash.hex(), read));
  CHECK(read == hash);
  CHECK_FALSE(Sha256::from_hex(hash.hex().substr(1), read));
  CHECK_FALSE(Sha256::from_hex(std::string(64, 'g'), read));
}

TEST_CASE("CRC-32C gives the check value of its catalogue entry") {
  CHECK(crc32c(std::string_view{"123456789"}) == 0xE3069283U);  // iSCSI, RFC 3720
  CHECK(crc32c(std::string_view{}) == 0U);
}
