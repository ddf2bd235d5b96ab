#include "daemon/world/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using world::ServiceManager;

TEST_CASE("what is told to the service manager arrives word by word") {
  test::TempFolder temp;
  const std::string path = temp.path / "notify";
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  REQUIRE(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  const auto heard = [&] {
    std::array<char, 256> text{};
    const auto n = ::recv(fd, text.data(), text.size(), MSG_DONTWAIT);
    return std::string{text.data(), n > 0 ? static_cast<std::size_t>(n) : 0};
  };
  ServiceManager manager;
  manager.ready("2 gliders");
  CHECK(heard() == "READY=1\nSTATUS=2 gliders");
  manager.status("flying");
  CHECK(heard() == "STATUS=flying");
  manager.still_alive();
  CHECK(heard() == "WATCHDOG=1");
  manager.reloading();
  CHECK(heard().rfind("RELOADING=1", 0) == 0);
  manager.stopping();
  CHECK(heard() == "STOPPING=1");
  ::unsetenv("NOTIFY_SOCKET");
  manager.ready("nobody listens");
  CHECK(heard().empty());
  ::close(fd);
}

TEST_CASE("the watchdog is stroked at half its time, when there is one") {
  ServiceManager manager;
  ::unsetenv("WATCHDOG_USEC");
  CHECK_FALSE(manager.watchdog_interval());
  ::setenv("WATCHDOG_USEC", "30000000", 1);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  CHECK(manager.watchdog_interval() == Seconds{15});
  ::setenv("WATCHDOG_PID", "1", 1);  // another process's
  CHECK_FALSE(manager.watchdog_interval());
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("WATCHDOG_PID");
}
