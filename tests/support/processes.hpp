#pragma once

#include <fcntl.h>
#include <grp.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace glidehelm::test {

using WallClock = std::chrono::steady_clock;

/// Waits until `happened`, at most `limit`. Wall time: only for things that other processes do.
inline bool wait_until(const std::function<bool()>& happened, std::chrono::seconds limit) {
  const auto end = WallClock::now() + limit;
  while (!happened()) {
    if (WallClock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  return true;
}

/// A port of the loopback that nobody listens on now: below the range from which the system takes ports for connections, and
/// from another place for each process, so that tests side by side do not meet.
inline int free_port() {
  constexpr int kFirst = 16'000, kPorts = 16'000, kApart = 32;
  static int next = static_cast<int>(getpid() % (kPorts / kApart)) * kApart;
  for (int tries = 0; tries < kPorts; ++tries) {
    const int port = kFirst + next++ % kPorts;
    const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    setsockopt(probe, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool is_free = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(probe);
    if (is_free) return port;
  }
  FAIL("no free port");
  return 0;
}

/// How a process ended.
struct Ended {
  bool in_time{};             ///< false: it had to be killed when its time was over
  std::optional<int> code;    ///< it left with this code
  std::optional<int> signal;  ///< or died of this signal
};

/// A program that runs beside the test. It never outlives the test, not even a crashed one.
class Program {
 public:
  struct Order {
    std::string path;
    std::vector<std::string> arguments;
    std::string out;                       ///< file to which stdout and stderr are appended
    std::vector<std::string> environment;  ///< NAME=VALUE, beside what the test has
    bool as_nobody{};                      ///< without root's rights, when the test has them
  };

  explicit Program(const Order& order) {
    std::vector<std::string> arguments{order.path};
    arguments.insert(arguments.end(), order.arguments.begin(), order.arguments.end());
    std::vector<std::string> environment;
    for (char** e = environ; *e != nullptr; ++e)
      if (std::string_view{*e}.rfind("GLIDEHELM_FAILPOINT=", 0) != 0) environment.emplace_back(*e);
    environment.insert(environment.end(), order.environment.begin(), order.environment.end());
    const auto argv = pointers(arguments), envp = pointers(environment);
    // Opened with the test's rights: the folders above the program may be closed to nobody.
    const int program = open(order.path.c_str(), O_RDONLY | O_CLOEXEC);
    const int out = open(order.out.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    REQUIRE(program >= 0);
    REQUIRE(out >= 0);
    const pid_t parent = getpid();
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      if (dup2(out, 1) < 0 || dup2(out, 2) < 0) _exit(126);
      if (order.as_nobody && geteuid() == 0) {
        constexpr id_t kNobody = 65'534;
        if (setgroups(0, nullptr) != 0 || setgid(kNobody) != 0 || setuid(kNobody) != 0 || geteuid() == 0) _exit(126);
      }
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // after setuid, which clears it
      if (getppid() != parent) _exit(126);
      fexecve(program, argv.data(), envp.data());
      _exit(127);
    }
    close(program);
    close(out);
  }
  ~Program() {
    if (running()) {
      send(SIGKILL);
      send(SIGCONT);
      waitpid(pid_, nullptr, 0);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void send(int number) const {
    if (!ended_) kill(pid_, number);
  }
  [[nodiscard]] bool running() {
    if (ended_) return false;
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
    ended_ = Ended{true, WIFEXITED(status) ? std::optional{WEXITSTATUS(status)} : std::nullopt,
                   WIFSIGNALED(status) ? std::optional{WTERMSIG(status)} : std::nullopt};
    return false;
  }
  /// Waits for the end; a program that takes longer is killed.
  Ended wait(std::chrono::seconds limit) {
    if (!wait_until([this] { return !running(); }, limit)) {
      send(SIGKILL);
      waitpid(pid_, nullptr, 0);
      ended_ = Ended{false, std::nullopt, SIGKILL};
    }
    return *ended_;
  }

 private:
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (auto& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
  }
  pid_t pid_{-1};
  std::optional<Ended> ended_;
};

}  // namespace glidehelm::test
