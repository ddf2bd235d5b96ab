#pragma once

#include <fstream>
#include <string>

#include "tests/support/netcdf.hpp"
#include "tests/support/processes.hpp"

namespace glidehelm::test {

/// The DAP2 server of dap_server.py on a port of its own, in one of its modes, as long as this lives.
class DapServer {
 public:
  DapServer(const std::string& mode, const ScratchFolder& folder)
      : out_{folder / ("dap-" + mode)},
        program_{{"/usr/bin/python3", {GLIDEHELM_SOURCE "/tests/support/dap_server.py", mode}, out_, {}, false}} {
    REQUIRE(wait_until([this] { return !port().empty(); }, std::chrono::seconds{30}));
  }
  [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + port() + "/sea"; }

 private:
  /// The first line, once it is whole.
  [[nodiscard]] std::string port() const {
    std::ifstream file{out_};
    std::string line;
    return std::getline(file, line) && !file.eof() ? line : "";
  }
  std::string out_;
  Program program_;
};

}  // namespace glidehelm::test
