#include "core/base/one_line.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;

TEST_CASE("a stranger's text becomes one line, and stays what it is otherwise") {
  using namespace std::string_literals;
  CHECK(one_line("unit \"m/s\"") == "unit \"m/s\"");
  CHECK(one_line("hour\ns since\r\x1b[31m\0\x7f\t"s) == "hour?s since??[31m???");
  CHECK(one_line("m·s⁻¹") == "m·s⁻¹");
  CHECK(one_line("").empty());
}
