#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

/// NetCDF files made at run time with ncgen, and programs run on them.
namespace glidehelm::test {

/// A folder that is gone with the test.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "glidehelm-test-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

inline std::string file_bytes(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  REQUIRE(file);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}
inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream file{path, std::ios::binary};
  file << bytes;
  REQUIRE(file);
}

struct Ran {
  int code{};
  std::string out, err;
};
/// Runs a shell command, its outputs caught.
inline Ran run_command(const std::string& command, const ScratchFolder& folder) {
  const std::string out = folder / "stdout", err = folder / "stderr";
  const int status = std::system((command + " >" + out + " 2>" + err).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), file_bytes(out), file_bytes(err)};
}

/// `kind` as ncgen's -k: classic, "64-bit offset", "64-bit data", netCDF-4. Returns the path of the file.
inline std::string make_netcdf(const ScratchFolder& folder, const std::string& name, const std::string& cdl,
                               const std::string& kind = "classic") {
  write_bytes(folder / (name + ".cdl"), cdl);
  const auto ran =
      run_command("ncgen -k '" + kind + "' -o " + (folder / name) + " " + (folder / (name + ".cdl")), folder);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  return folder / name;
}

}  // namespace glidehelm::test
