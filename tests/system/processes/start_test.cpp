#include <sys/stat.h>

#include "tests/system/processes/sea.hpp"

using namespace glidehelm;
using namespace glidehelm::test;

namespace {

/// Somebody else on a port.
class Squatter {
 public:
  explicit Squatter(int port) : socket_{socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int yes = 1;
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    REQUIRE(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    REQUIRE(listen(socket_, 1) == 0);
  }
  ~Squatter() { close(socket_); }
  Squatter(const Squatter&) = delete;
  Squatter& operator=(const Squatter&) = delete;

 private:
  int socket_;
};

/// A daemon on the system's clock: it needs no simulator to fail.
struct Harbour {
  Harbour() {
    std::filesystem::create_directories(folder.path / "dock/sim01/to-glider");
    write_daemon("daemon", "state", port);
  }
  void write_daemon(const std::string& name, const std::string& state, int at_port,
                    const std::string& more = "") const {
    std::ostringstream text;
    text << "schema: glidehelm/daemon/v1\n"
         << "state_dir: " << path(state) << "\n"
         << "control_socket: " << path("control.sock") << "\n"
         << "missions: [missions.d/*.yaml]\n"
         << "gliders:\n"
         << "  - {name: sim01, line: {listen: \"127.0.0.1:" << at_port
         << "\"}, to_glider: " << path("dock/sim01/to-glider") << "}\n"
         << more;
    folder.write(name + ".yaml", text.str());
  }
  [[nodiscard]] std::unique_ptr<Program> start(const std::string& name, bool as_nobody = false) const {
    return std::make_unique<Program>(Program::Order{
        GLIDEHELM_BIN "/glidehelmd", {"--config", path(name + ".yaml")}, path(name + ".log"), {}, as_nobody});
  }
  /// Exit code 1, and a line that says why.
  void check_refuses(const std::string& name, const std::string& pattern, bool as_nobody = false) const {
    auto daemon = start(name, as_nobody);
    const auto ended = daemon->wait(kStepLimit);
    const auto log = folder.read(name + ".log");
    CAPTURE(log, pattern);
    CHECK(ended.in_time);
    CHECK(ended.code == 1);
    CHECK(lines_with(log, pattern).size() == 1);
    CHECK(lines_with(log, "ready:").empty());
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder.path / name).string(); }

  TempFolder folder;
  int port{free_port()};
};

void give_to_nobody(const std::filesystem::path& path) {
  if (geteuid() == 0) REQUIRE(chown(path.c_str(), 65'534, 65'534) == 0);
}

}  // namespace

TEST_CASE("a daemon does not start on a port that somebody else listens on") {
  Harbour harbour;
  Squatter squatter{harbour.port};
  harbour.check_refuses("daemon",
                        "ALERT sim01 +line of sim01: .*127\\.0\\.0\\.1:" + std::to_string(harbour.port) + ".*in use");
}

TEST_CASE("a daemon does not start without its to-glider folder, and does not make it") {
  Harbour harbour;
  std::filesystem::remove(harbour.folder.path / "dock/sim01/to-glider");
  harbour.check_refuses("daemon", "ALERT sim01 +.*" + harbour.path("dock/sim01/to-glider") + ".*No such file");
  CHECK_FALSE(harbour.folder.has("dock/sim01/to-glider"));
}

TEST_CASE("a daemon does not start where it may not write into to-glider, or beside it") {
  // Two of three folders belong to the daemon's user; the third is somebody else's, readable for all.
  for (const std::string closed : {"dock/sim01/to-glider", "dock/sim01"}) {
    Harbour harbour;
    CAPTURE(closed);
    std::filesystem::create_directory(harbour.folder.path / "state");
    chmod(harbour.folder.path.c_str(), 0755);
    for (const std::string name : {"state", "dock/sim01", "dock/sim01/to-glider"})
      if (name != closed) give_to_nobody(harbour.folder.path / name);
    REQUIRE(chmod(harbour.path(closed).c_str(), 0555) == 0);
    harbour.check_refuses("daemon", "ALERT sim01 +.*" + harbour.path(closed) + ".*(Permission denied|not writable)",
                          true);
    REQUIRE(chmod(harbour.path(closed).c_str(), 0755) == 0);
  }
}

TEST_CASE("a daemon prints every error of its file before it gives up") {
  Harbour harbour;
  harbour.write_daemon("daemon", "state", harbour.port, "log_levle: info\ncontrol_socket: twice.sock\nstate-dir: x\n");
  harbour.check_refuses("daemon", "daemon\\.yaml:7:1: log_levle: unknown key");
  const auto log = harbour.folder.read("daemon.log");
  CAPTURE(log);
  CHECK(lines_with(log, "daemon\\.yaml:8:1: .*control_socket").size() == 1);
  CHECK(lines_with(log, "daemon\\.yaml:9:1: .*state-dir").size() == 1);
  CHECK(lines_with(log, "^glidehelmd: 3 errors, not started$").size() == 1);
  CHECK_FALSE(harbour.folder.has("state"));
}

TEST_CASE("a daemon prints every error of all its missions before it gives up") {
  Harbour harbour;
  std::filesystem::create_directory(harbour.folder.path / "missions.d");
  for (const std::string name : {"a", "b"})
    harbour.folder.write("missions.d/" + name + ".yaml",
                         "schema: glidehelm/mission/v1\n"
                         "name: " +
                             name +
                             "\n"
                             "glider: sim01\n"
                             "goal: {lat_deg: 95, lon_deg: 4.7}\n"
                             "currents: {files: [\"*.nc\"]}\n"
                             "vehicle: {horizontal_speed_m_per_s: fast}\n");
  harbour.check_refuses("daemon", "missions\\.d/a\\.yaml:4:17: goal\\.lat_deg: .*found 95; allowed: -90 to 90");
  const auto log = harbour.folder.read("daemon.log");
  CAPTURE(log);
  CHECK(lines_with(log, "missions\\.d/a\\.yaml:6:37: .*found fast; allowed: ").size() == 1);
  CHECK(lines_with(log, "missions\\.d/b\\.yaml:4:17: ").size() == 1);
  CHECK(lines_with(log, "missions\\.d/b\\.yaml:6:37: ").size() == 1);
  CHECK(lines_with(log, "^glidehelmd: 4 errors, not started$").size() == 1);
  CHECK_FALSE(harbour.folder.has("state"));
}

TEST_CASE("two daemons never share a to-glider folder or a journal, the first one goes on") {
  Harbour harbour;
  auto first = harbour.start("daemon");
  REQUIRE(
      wait_until([&] { return !lines_with(harbour.folder.read("daemon.log"), "ready:").empty() || !first->running(); },
                 kStepLimit));
  INFO(harbour.folder.read("daemon.log"));
  REQUIRE(first->running());
  harbour.write_daemon("same-folder", "other-state", free_port());
  harbour.check_refuses("same-folder", "ALERT sim01 +.*dock/sim01/\\.glidehelm.*(another|other) process");
  harbour.write_daemon("same-state", "state", free_port());
  harbour.check_refuses("same-state", "PAGE  - +.*journal.*(another|other) process");
  CHECK(first->running());
  first->send(SIGTERM);
  CHECK(first->wait(kStepLimit).code == 0);
  CHECK(lines_with(harbour.folder.read("daemon.log"), "info  - +stopping: asked to stop").size() == 1);
}
