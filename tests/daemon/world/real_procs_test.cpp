#include "daemon/world/real_procs.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <set>
#include <sstream>
#include <thread>

#include "daemon/world/real.hpp"
#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::world;
using glidehelm::test::TempFolder;
using End = ProcessResult::End;

namespace {

ProcessRequest shell(const std::string& script) {
  ProcessRequest request;
  request.program = "/bin/sh";
  request.arguments = {"-c", script};
  return request;
}
ProcessResult run(const ProcessRequest& request) { return RealWorld{}.world().procs.run_and_wait(request); }

}  // namespace

TEST_CASE("a child's exit code and both outputs come back") {
  const auto result = run(shell("echo out; echo err >&2; exit 3"));
  CHECK(result.end == End::exited);
  CHECK(result.code == 3);
  CHECK(result.out == "out\n");
  CHECK(result.err == "err\n");
  CHECK_FALSE(result.succeeded());
  CHECK(run(shell("true")).succeeded());
  CHECK(run(shell("exit 127")).code == 127);  // its own, not "no such program"
  CHECK(run(shell("exit 127")).end == End::exited);
}

TEST_CASE("a child that dies of a signal says which") {
  const auto result = run(shell("kill -SEGV $$"));
  CHECK(result.end == End::signalled);
  CHECK(result.code == SIGSEGV);
}

TEST_CASE("a program that cannot be started says why") {
  TempFolder temp;
  temp.write("plain", "no program");
  ProcessRequest request;
  request.program = temp.path / "none";
  CHECK(run(request).end == End::not_started);
  CHECK(run(request).code == ENOENT);
  request.program = temp.path / "plain";
  CHECK(run(request).end == End::not_started);
  CHECK(run(request).code == EACCES);
  request.program = "glidehelm-no-such-program";
  CHECK(run(request).code == ENOENT);
}

TEST_CASE("a name is looked up beside the running program, then in PATH") {
  ProcessRequest request;
  request.program = "world_tests";
  request.arguments = {"--list-tags"};
  CHECK(run(request).succeeded());
  request.program = "cat";
  request.arguments = {};
  request.input = "through PATH";
  CHECK(run(request).out == "through PATH");
}

TEST_CASE("input of any size reaches the child, wanted or not") {
  auto request = shell("wc -c");
  request.input = std::string(3'000'000, 'x');
  CHECK(std::stol(run(request).out) == 3'000'000);
  request = shell("exit 0");
  request.input = std::string(3'000'000, 'x');
  CHECK(run(request).succeeded());
  CHECK(run(shell("cat")).out.empty());
}

TEST_CASE("descriptor 3 is the file that was handed over, and nothing else is open") {
  TempFolder temp;
  temp.write("file", "staged bytes");
  RealWorld real;
  const auto world = real.world();
  auto request = shell("cat <&3; echo; ls /proc/self/fd");
  request.descriptor3 = world.files.open_folder(temp.path).value()->open("file").value();
  // Sockets of the loop are not close-on-exec by themselves.
  const auto listener = world.net.listen_tcp("127.0.0.1", 0, [](auto) {}).value();
  auto result = world.procs.run_and_wait(request);
  REQUIRE(result.succeeded());
  std::istringstream lines{result.out};
  std::string first;
  std::getline(lines, first);
  CHECK(first == "staged bytes");
  std::set<int> open;
  for (int fd = 0; lines >> fd;) open.insert(fd);
  CHECK(open == std::set<int>{0, 1, 2, 3, 4});  // 4 is the folder that ls reads
  request = shell("ls /proc/self/fd");
  result = world.procs.run_and_wait(request);
  CHECK(result.out == "0\n1\n2\n3\n");
}

TEST_CASE("a child sees PATH, TMPDIR and LC_ALL=C and no other setting") {
  ::setenv("GLIDEHELM_SECRET", "x", 1);
  ::setenv("TMPDIR", "/tmp", 1);
  ProcessRequest request;
  request.program = "env";
  const auto result = run(request);
  ::unsetenv("GLIDEHELM_SECRET");
  REQUIRE(result.succeeded());
  std::istringstream lines{result.out};
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    names.insert(line.substr(0, line.find('=')));
    if (line.rfind("LC_ALL", 0) == 0) CHECK(line == "LC_ALL=C");
  }
  CHECK(names == std::set<std::string>{"LC_ALL", "PATH", "TMPDIR"});
}

TEST_CASE("a child that is late is killed") {
  RealWorld real;
  const auto world = real.world();
  for (const char* script :
       {"exec sleep 60", "exec >/dev/null 2>&1; exec sleep 60"}) {  // the second closes its outputs
    auto request = shell(script);
    request.deadline = Seconds{0.2};
    const auto begun = world.clock.tick();
    const auto result = world.procs.run_and_wait(request);
    CHECK(result.end == End::deadline);
    CHECK(world.clock.tick() - begun < std::chrono::seconds{20});
    CHECK(world.clock.tick() - begun >= std::chrono::milliseconds{199});
  }
}

TEST_CASE("a child that says too much is killed") {
  for (const char* where : {"", ">&2"}) {
    auto request = shell(std::string{"exec yes "} + where);
    request.output_at_most = 100'000;
    const auto result = run(request);
    CHECK(result.end == End::output_too_long);
    CHECK(result.out.size() + result.err.size() < 100'000 + 2 * 65536);
  }
}

TEST_CASE("a child's memory is limited, and it leaves no core") {
  auto request = shell("ulimit -v; ulimit -c");
  request.memory_at_most = std::size_t{256} << 20;
  CHECK(run(request).out == "262144\n0\n");
}

TEST_CASE("a child dies with its parent") {
  TempFolder temp;
  const pid_t parent = ::fork();
  REQUIRE(parent >= 0);
  if (parent == 0) {
    // The pid goes through a file: the grandchild's outputs end with its parent.
    static_cast<void>(run(shell("echo $$ >" + (temp.path / "new").string() + "; mv " + (temp.path / "new").string() +
                                " " + (temp.path / "pid").string() + "; exec sleep 60")));
    ::_exit(0);
  }
  for (int i = 0; i < 2000 && !temp.has("pid"); ++i) ::usleep(5000);
  REQUIRE(temp.has("pid"));
  const auto child = static_cast<pid_t>(std::stol(temp.read("pid")));
  CHECK(::kill(child, 0) == 0);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  const auto lives = [&] {  // an orphan may stay a zombie where nobody reaps
    std::ifstream stat{"/proc/" + std::to_string(child) + "/stat"};
    std::string pid, name, state;
    return static_cast<bool>(stat >> pid >> name >> state) && state != "Z";
  };
  for (int i = 0; i < 2000 && lives(); ++i) ::usleep(5000);
  CHECK_FALSE(lives());
}

TEST_CASE("results come from the loop, in any number at once") {
  RealWorld real;
  auto world = real.world();
  const auto here = std::this_thread::get_id();
  int ended = 0;
  bool right = true;
  for (int i = 0; i < 8; ++i)
    world.procs.run(shell("exit " + std::to_string(i)), [&, i](const ProcessResult& result) {
      right = right && result.code == i && std::this_thread::get_id() == here;
      if (++ended == 8) world.net.stop();
    });
  world.clock.call_at(world.clock.tick() + std::chrono::seconds{20}, [&] { world.net.stop(); });
  world.net.run();
  CHECK(ended == 8);
  CHECK(right);
}

TEST_CASE("the end of the adapter is the end of its children") {
  const auto begun = RealWorld{}.world().clock.tick();
  {
    RealWorld real;
    real.world().procs.run(shell("exec sleep 60"), [](const ProcessResult&) { FAIL("nobody runs the loop"); });
  }
  CHECK(RealWorld{}.world().clock.tick() - begun < std::chrono::seconds{20});
}

TEST_CASE("the limits of a child end in signals that are told apart") {
  auto spins = shell("while true; do :; done");
  spins.cpu_at_most_s = 1;
  spins.deadline = Seconds{60};
  const auto spun = run(spins);
  CHECK(spun.end == End::signalled);
  CHECK(spun.code == SIGXCPU);
  CHECK(death_by(spun.code) == "used more CPU time than it may");

  TempFolder temp;
  auto writes = shell("exec head -c 100000 /dev/zero > " + (temp.path / "big").string());
  writes.file_at_most = 5000;
  const auto wrote = run(writes);
  CHECK(wrote.end == End::signalled);
  CHECK(wrote.code == SIGXFSZ);
  CHECK(std::filesystem::file_size(temp.path / "big") == 5000);
  CHECK(death_by(wrote.code) == "wrote a larger file than it may");
  writes.file_at_most = 0;
  CHECK(run(writes).succeeded());

  CHECK(death_by(SIGSEGV) == "died of signal 11 (Segmentation fault)");
  CHECK(death_by(SIGSYS) == "asked the system for something that it may not");
  CHECK(death_by(SIGKILL) == "was killed, perhaps because the machine ran out of memory");
}

TEST_CASE("a child's descriptors are limited") {
  auto opens = shell("ulimit -n");
  opens.descriptors_at_most = 17;
  CHECK(run(opens).out == "17\n");
}

TEST_CASE("a disposable child has no environment but its locale, gains nothing, and dies first") {
  auto request = shell(
      "env | grep -v '^PWD=\\|^_=\\|^SHLVL=' | sort; grep NoNewPrivs /proc/self/status; "
      "cat /proc/self/oom_score_adj; ulimit -c");
  request.disposable = true;
  CHECK(run(request).out == "LC_ALL=C\nNoNewPrivs:\t1\n500\n0\n");
  request.disposable = false;
  CHECK(run(request).out.find("NoNewPrivs:\t0\n") != std::string::npos);
}
