#include "daemon/world/real_procs.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace glidehelm::world {

namespace {

using End = ProcessResult::End;

double seconds_now() {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// A program beside the running one, so that a build tree and an installation both find their own children; then PATH.
std::string resolved(const std::string& program) {
  if (program.find('/') != std::string::npos) return program;
  std::array<char, 4096> self{};
  const ssize_t n = ::readlink("/proc/self/exe", self.data(), self.size() - 1);
  if (n > 0) {
    std::string folder{self.data(), static_cast<std::size_t>(n)};
    folder.resize(folder.rfind('/') + 1);
    // In a build tree programs lie in folders of their own room.
    for (const char* beside : {"", "../ingest/", "../verify/", "../cli/", "../"})
      if (const auto path = folder + beside + program; ::access(path.c_str(), X_OK) == 0) return path;
  }
  const char* path = std::getenv("PATH");
  std::string_view rest{path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin"};
  while (!rest.empty()) {
    const auto colon = rest.find(':');
    const auto candidate = std::string{rest.substr(0, colon)} + "/" + program;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
    rest = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon + 1);
  }
  return program;
}

struct Pipe {
  int read_end{-1}, write_end{-1};
  bool open() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return false;
    read_end = ends[0];
    write_end = ends[1];
    return true;
  }
  static void close(int& fd) {
    if (fd >= 0) ::close(fd);
    fd = -1;
  }
  ~Pipe() {
    close(read_end);
    close(write_end);
  }
};

/// What runs between fork and exec: only async-signal-safe calls, no allocation.
[[noreturn]] void become(const ProcessRequest& request, const char* program, char* const* arguments,
                         char* const* environment, int in, int out, int err, int three, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // the parent died before the line above
  // The sources may be any numbers, 0–3 among them: they are moved out of the way first.
  const int safe_in = ::fcntl(in, F_DUPFD, 10), safe_out = ::fcntl(out, F_DUPFD, 10),
            safe_err = ::fcntl(err, F_DUPFD, 10);
  const int safe_three = three >= 0 ? ::fcntl(three, F_DUPFD, 10) : -1;
  ::dup2(safe_in, 0);
  ::dup2(safe_out, 1);
  ::dup2(safe_err, 2);
  if (safe_three >= 0) ::dup2(safe_three, 3);
  ::syscall(SYS_close_range, safe_three >= 0 ? 4U : 3U, ~0U, 0U);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  if (request.memory_at_most > 0) {
    const rlimit limit{request.memory_at_most, request.memory_at_most};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::execve(program, arguments, environment);
  ::_exit(errno == ENOENT ? 127 : 126);
}

/// Moves bytes until both outputs are closed, the deadline is over, too much came, or `kill` is raised.
End serve(const ProcessRequest& request, Pipe& in, Pipe& out, Pipe& err, pid_t child, const std::atomic<bool>& kill,
          ProcessResult& result) {
  const double until = seconds_now() + request.deadline.count();
  std::string_view input{request.input};
  ::fcntl(in.write_end, F_SETFL, O_NONBLOCK);
  std::array<char, 65536> block{};
  End end = End::exited;
  while (out.read_end >= 0 || err.read_end >= 0) {
    if (input.empty()) Pipe::close(in.write_end);
    const double left = until - seconds_now();
    if (left <= 0 || kill) {
      end = End::deadline;
      break;
    }
    std::array<pollfd, 3> watched{pollfd{out.read_end, POLLIN, 0}, pollfd{err.read_end, POLLIN, 0},
                                  pollfd{in.write_end, POLLOUT, 0}};
    ::poll(watched.data(), watched.size(), static_cast<int>(std::min(left * 1000 + 1, 100.0)));
    if (watched[2].revents != 0) {
      const ssize_t n = ::write(in.write_end, input.data(), input.size());
      if (n > 0)
        input.remove_prefix(static_cast<std::size_t>(n));
      else if (n < 0 && errno != EAGAIN && errno != EINTR)
        input = {};  // the child does not want its input: its output decides
    }
    const auto take = [&](Pipe& pipe, const pollfd& state, std::string& into) {
      if (state.revents == 0) return;
      const ssize_t n = ::read(pipe.read_end, block.data(), block.size());
      if (n > 0)
        into.append(block.data(), static_cast<std::size_t>(n));
      else if (n == 0 || (errno != EINTR && errno != EAGAIN))
        Pipe::close(pipe.read_end);
    };
    take(out, watched[0], result.out);
    take(err, watched[1], result.err);
    if (result.out.size() > request.output_at_most || result.err.size() > request.output_at_most) {
      end = End::output_too_long;
      break;
    }
  }
  if (end != End::exited) ::kill(child, SIGKILL);
  // A child may close its outputs and live on: the deadline holds for that too.
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (end == End::exited && (seconds_now() >= until || kill)) {
      end = End::deadline;
      ::kill(child, SIGKILL);
    }
    const timespec nap{0, 1'000'000};
    ::nanosleep(&nap, nullptr);
  }
  if (end != End::exited) return end;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
  return WIFEXITED(status) ? End::exited : End::signalled;
}

ProcessResult execute(const ProcessRequest& request, const std::atomic<bool>& kill) {
  ProcessResult result;
  Pipe in, out, err;
  if (!in.open() || !out.open() || !err.open()) {
    result.code = errno;
    return result;
  }
  const std::string program = resolved(request.program);
  std::vector<std::string> words{program};
  words.insert(words.end(), request.arguments.begin(), request.arguments.end());
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<std::string> settings{"LC_ALL=C"};
  for (const char* name : {"PATH", "TMPDIR"})
    if (const char* value = std::getenv(name)) settings.push_back(std::string{name} + "=" + value);
  std::vector<char*> environment;
  for (auto& setting : settings) environment.push_back(setting.data());
  environment.push_back(nullptr);

  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    result.code = errno;
    return result;
  }
  if (child == 0)
    become(request, program.c_str(), arguments.data(), environment.data(), in.read_end, out.write_end, err.write_end,
           request.descriptor3 ? request.descriptor3->descriptor() : -1, parent);
  Pipe::close(in.read_end);
  Pipe::close(out.write_end);
  Pipe::close(err.write_end);
  result.end = serve(request, in, out, err, child, kill, result);
  if (result.end == End::exited && result.code == 127) {
    result.end = End::not_started;
    result.code = ENOENT;
  }
  return result;
}

}  // namespace

struct RealProcs::Child {
  std::atomic<bool> kill{false}, finished{false};
  std::thread thread;
};

RealProcs::RealProcs(RealLoop& loop) : loop_{loop} { ::signal(SIGPIPE, SIG_IGN); }

RealProcs::~RealProcs() {
  for (const auto& child : children_) child->kill = true;
  for (const auto& child : children_) child->thread.join();
}

void RealProcs::forget_finished() {
  for (auto child = children_.begin(); child != children_.end();) {
    if ((*child)->finished) {
      (*child)->thread.join();
      child = children_.erase(child);
    } else {
      ++child;
    }
  }
}

void RealProcs::run(ProcessRequest request, std::function<void(ProcessResult)> then) {
  forget_finished();
  auto child = std::make_shared<Child>();
  children_.push_back(child);
  // PR_SET_PDEATHSIG fires when the *thread* that forked ends; this thread outlives its child because it waits for it.
  child->thread = std::thread{[this, child, request = std::move(request), then = std::move(then)]() mutable {
    auto result = execute(request, child->kill);
    boost::asio::post(loop_.context,
                      [then = std::move(then), result = std::move(result)]() mutable { then(std::move(result)); });
    child->finished = true;
  }};
}

ProcessResult RealProcs::run_and_wait(const ProcessRequest& request) {
  const std::atomic<bool> never{false};
  return execute(request, never);
}

}  // namespace glidehelm::world
