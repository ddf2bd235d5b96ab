#include "daemon/world/real_procs.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
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
    // A test of a build tree lies beside the folder of programs.
    for (const char* beside : {"", "../bin/"})
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

/// What a child needs to become its program, prepared before it exists.
struct Launch {
  const ProcessRequest* request{};
  const char* program{};
  char* const* arguments{};
  char* const* environment{};
  int in{}, out{}, err{}, three{-1};
  int failed{};  ///< write end of the pipe that tells the parent why exec failed
  pid_t parent{};
};

/// Sets what the request limits; a hard limit equals the soft one, but for CPU time, whose soft limit tells why.
bool set_limits(const ProcessRequest& request) {
  const auto limited = [](decltype(RLIMIT_AS) what, std::size_t soft, std::size_t hard) {
    const rlimit limit{soft, hard};
    return ::setrlimit(what, &limit) == 0;
  };
  const auto none_or = [&](decltype(RLIMIT_AS) what, std::size_t most) {
    return most == 0 || limited(what, most, most);
  };
  const std::size_t cpu = request.cpu_at_most_s;
  return none_or(RLIMIT_AS, request.memory_at_most) && none_or(RLIMIT_FSIZE, request.file_at_most) &&
         none_or(RLIMIT_NOFILE, request.descriptors_at_most) && (cpu == 0 || limited(RLIMIT_CPU, cpu, cpu + 1)) &&
         limited(RLIMIT_CORE, 0, 0);
}

/// What runs between vfork and exec, in the parent's memory: only async-signal-safe calls, no allocation, nothing written
/// that the parent reads.
[[noreturn]] void become(const Launch& launch) {
  const auto give_up = [&] {
    const int problem = errno;
    static_cast<void>(!::write(launch.failed, &problem, sizeof problem));
    ::_exit(127);
  };
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != launch.parent) ::_exit(127);  // the parent died before the line above
  // The sources may be any numbers, 0–3 among them: they are copied out of the way first.
  const int safe_in = ::fcntl(launch.in, F_DUPFD_CLOEXEC, 10);
  const int safe_out = ::fcntl(launch.out, F_DUPFD_CLOEXEC, 10);
  const int safe_err = ::fcntl(launch.err, F_DUPFD_CLOEXEC, 10);
  const int safe_three = launch.three >= 0 ? ::fcntl(launch.three, F_DUPFD_CLOEXEC, 10) : -1;
  const bool has_three = launch.three >= 0;
  if (::dup2(safe_in, 0) < 0 || ::dup2(safe_out, 1) < 0 || ::dup2(safe_err, 2) < 0) give_up();
  if (has_three && ::dup2(safe_three, 3) < 0) give_up();
  // Asio's sockets are not close-on-exec: everything above is marked.
  if (::syscall(SYS_close_range, has_three ? 4U : 3U, ~0U, CLOSE_RANGE_CLOEXEC) != 0) give_up();
  for (const int number : {SIGPIPE, SIGHUP, SIGINT, SIGTERM, SIGXCPU, SIGXFSZ}) ::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (launch.request->disposable) {
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) give_up();
    // Only a wish: without /proc the child is an ordinary one.
    if (const int score = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC); score >= 0)
      static_cast<void>(!::write(score, "500", 3));
  }
  if (!set_limits(*launch.request)) give_up();
  ::execve(launch.program, launch.arguments, launch.environment);
  give_up();
  ::_exit(127);
}

/// vfork, so that a daemon with gigabytes of mapped forecast starts a child without copying its page tables. Signals wait
/// meanwhile: a handler must not run in the child, in our memory.
pid_t spawn(const Launch& launch) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t child = ::vfork();
  if (child == 0) become(launch);
  const int problem = errno;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = problem;
  return child;
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
    if (const char* value = std::getenv(name); value != nullptr && !request.disposable)
      settings.push_back(std::string{name} + "=" + value);
  std::vector<char*> environment;
  for (auto& setting : settings) environment.push_back(setting.data());
  environment.push_back(nullptr);

  Pipe started;
  if (!started.open()) {
    result.code = errno;
    return result;
  }
  Launch launch;
  launch.request = &request;
  launch.program = program.c_str();
  launch.arguments = arguments.data();
  launch.environment = environment.data();
  launch.in = in.read_end;
  launch.out = out.write_end;
  launch.err = err.write_end;
  launch.three = request.descriptor3 ? request.descriptor3->descriptor() : -1;
  launch.failed = started.write_end;
  launch.parent = ::getpid();
  const pid_t child = spawn(launch);
  if (child < 0) {
    result.code = errno;
    return result;
  }
  Pipe::close(in.read_end);
  Pipe::close(out.write_end);
  Pipe::close(err.write_end);
  Pipe::close(started.write_end);
  int problem = 0;
  ssize_t told = 0;
  while ((told = ::read(started.read_end, &problem, sizeof problem)) < 0 && errno == EINTR) {
  }
  if (told == static_cast<ssize_t>(sizeof problem)) {  // exec closes the pipe; a number in it is why it did not happen
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    result.code = problem;
    return result;
  }
  result.end = serve(request, in, out, err, child, kill, result);
  return result;
}

}  // namespace

std::string death_by(int signal) {
  switch (signal) {
    case SIGXCPU:
      return "used more CPU time than it may";
    case SIGXFSZ:
      return "wrote a larger file than it may";
    case SIGSYS:
      return "asked the system for something that it may not";
    case SIGKILL:
      return "was killed, perhaps because the machine ran out of memory";
    default:
      break;
  }
  const char* name = ::sigdescr_np(signal);
  return "died of signal " + std::to_string(signal) + (name != nullptr ? std::string{" ("} + name + ")" : "");
}

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
