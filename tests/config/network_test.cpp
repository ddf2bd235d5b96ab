#include "config/network.hpp"

#include <catch2/catch.hpp>

using glidehelm::config::Endpoint;
using glidehelm::config::IpAddress;
using glidehelm::config::Network;

TEST_CASE("addresses of both families are read, and nothing that only looks like one") {
  for (const char* text : {"127.0.0.1", "0.0.0.0", "255.255.255.255", "::", "::1", "2001:db8::7", "1:2:3:4:5:6:7:8",
                           "1::8", "FE80::ABCD"}) {
    CAPTURE(text);
    CHECK(IpAddress::from_text(text));
  }
  for (const char* text : {"", "127.0.0", "127.0.0.1.1", "127.0.0.01", "256.0.0.1", "1.2.3.a", " 1.2.3.4", "1.2.3.4 ",
                           ":", ":::", "1:2:3:4:5:6:7", "1:2:3:4:5:6:7:8:9", "1::2::3",
                           "12345::", "g::", "1:2:3:4:5:6:7::8", "fe80::1%eth0", "-1.0.0.0"}) {
    CAPTURE(text);
    CHECK_FALSE(IpAddress::from_text(text));
  }
  CHECK(IpAddress::from_text("::ffff:7f00:1") ==
        IpAddress::from_text("127.0.0.1"));  // the mapped form is the same address
  CHECK(IpAddress::from_text("1::8") == IpAddress::from_text("1:0:0:0:0:0:0:8"));
}

TEST_CASE("loopback is 127.0.0.0/8 and ::1") {
  for (const char* text : {"127.0.0.1", "127.255.0.3", "::1", "::ffff:7f00:1"})
    CHECK(IpAddress::from_text(text)->is_loopback());
  for (const char* text : {"128.0.0.1", "0.0.0.0", "::", "::2", "126.255.255.255"})
    CHECK_FALSE(IpAddress::from_text(text)->is_loopback());
}

TEST_CASE("a network contains the addresses that share its prefix") {
  struct Row {
    const char *network, *address;
    bool inside;
  };
  const auto row = GENERATE(values<Row>({{"192.0.2.0/24", "192.0.2.255", true},
                                         {"192.0.2.0/24", "192.0.3.0", false},
                                         {"192.0.2.128/25", "192.0.2.127", false},
                                         {"192.0.2.128/25", "192.0.2.129", true},
                                         {"192.0.2.7", "192.0.2.7", true},
                                         {"192.0.2.7", "192.0.2.6", false},
                                         {"0.0.0.0/0", "203.0.113.9", true},
                                         {"0.0.0.0/0", "2001:db8::1", false},
                                         {"::/0", "203.0.113.9", true},
                                         {"2001:db8:12::/48", "2001:db8:12:ffff::1", true},
                                         {"2001:db8:12::/48", "2001:db8:13::1", false}}));
  CAPTURE(row.network, row.address);
  CHECK(Network::from_text(row.network)->contains(*IpAddress::from_text(row.address)) == row.inside);
}

TEST_CASE("a network with host bits, a wrong prefix or no address is none") {
  for (const char* text : {"192.0.2.7/24", "192.0.2.0/33", "192.0.2.0/", "192.0.2.0/024", "192.0.2.0/-1",
                           "2001:db8::1/64", "::/129", "example.org/8", "/8", ""}) {
    CAPTURE(text);
    CHECK_FALSE(Network::from_text(text));
  }
}

TEST_CASE("an endpoint is a host and a port, and prints as it was read") {
  for (const char* text : {"127.0.0.1:6500", "localhost:1", "bridge-2.example.org:65535", "[::1]:6500"}) {
    CAPTURE(text);
    REQUIRE(Endpoint::from_text(text));
    CHECK(Endpoint::from_text(text)->text() == text);
  }
  CHECK(Endpoint::from_text("[2001:db8::7]:80")->host == "2001:db8::7");
  for (const char* text : {"", ":1", "host", "host:", "host:0", "host:65536", "host:08", "host:1x", "::1:6500", "[::1]",
                           "[1.2.3.4]:5", "[]:5", "a_b:1", "-a:1", "a b:1", "host:123456"}) {
    CAPTURE(text);
    CHECK_FALSE(Endpoint::from_text(text));
  }
}
