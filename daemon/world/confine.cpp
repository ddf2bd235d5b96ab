#include "daemon/world/confine.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace glidehelm::world {

namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;
#endif

Unexpected<std::string> failed(const std::string& what) { return unexpected(what + ": " + std::strerror(errno)); }

// ---- files

constexpr std::uint64_t kReadFile = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWriteFile = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_MAKE_REG |
                                     LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kTruncate = std::uint64_t{1} << 14;  // of version 3; the header of Debian 12 has version 2

/// Every right on files that version `version` of Landlock knows.
std::uint64_t all_rights(long version) {
  std::uint64_t rights = (std::uint64_t{LANDLOCK_ACCESS_FS_MAKE_SYM} << 1) - 1;
  if (version >= 2) rights |= LANDLOCK_ACCESS_FS_REFER;
  if (version >= 3) rights |= kTruncate;
  return rights;
}

Expected<Done, std::string> permit(int rules, const std::string& path, std::uint64_t rights) {
  landlock_path_beneath_attr beneath{};
  beneath.allowed_access = rights;
  beneath.parent_fd = ::open(path.c_str(), O_PATH | O_CLOEXEC);
  if (beneath.parent_fd < 0) {
    if (errno == ENOENT) return Done{};
    return failed(path);
  }
  struct ::stat s {};
  if (::fstat(beneath.parent_fd, &s) == 0 && !S_ISDIR(s.st_mode))
    beneath.allowed_access &= LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate;
  const long done = ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0U);
  const int problem = errno;
  ::close(beneath.parent_fd);
  errno = problem;
  if (done != 0) return failed("Landlock on " + path);
  return Done{};
}

/// A sanitizer's run time makes calls of its own, and looks for leaks in /proc: its builds are not fenced.
#if defined(GLIDEHELM_SANITIZED)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

Expected<bool, std::string> fence_files(const Confinement& order) {
  if (kSanitized) return false;
  const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, std::size_t{0}, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return false;
  landlock_ruleset_attr handled{};
  handled.handled_access_fs = all_rights(version);
  const int rules =
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &handled, sizeof handled.handled_access_fs, 0U));
  if (rules < 0) return failed("Landlock");
  Expected<bool, std::string> result = true;
  for (const auto& path : order.read_below)
    if (auto done = permit(rules, path, kReadFile); !done && result) result = unexpected(done.error());
  for (const auto& path : order.write_below)
    if (auto done = permit(rules, path, (kWriteFile | kTruncate) & all_rights(version)); !done && result)
      result = unexpected(done.error());
  if (result && ::syscall(SYS_landlock_restrict_self, rules, 0U) != 0) result = failed("Landlock");
  ::close(rules);
  return result;
}

// ---- system calls

using Filter = std::vector<sock_filter>;

sock_filter statement(int code, std::uint32_t value) { return {static_cast<std::uint16_t>(code), 0, 0, value}; }
sock_filter jump(int code, std::uint32_t value, std::uint8_t when_true, std::uint8_t when_false) {
  return {static_cast<std::uint16_t>(code), when_true, when_false, value};
}
constexpr std::uint32_t refusal(int error) { return SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error); }

/// If the call's number, which is loaded, is `number`: answer `verdict`.
void answer(Filter& filter, long number, std::uint32_t verdict) {
  filter.push_back(jump(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(number), 0, 1));
  filter.push_back(statement(BPF_RET | BPF_K, verdict));
}

[[maybe_unused]] Filter forbidden_calls(bool network) {
  Filter filter;
  filter.push_back(statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)));
  filter.push_back(jump(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0));
  filter.push_back(statement(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
  filter.push_back(statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
#if defined(__x86_64__)
  constexpr std::uint32_t kX32 = 0x40000000;  // the same machine by other numbers
  filter.push_back(jump(BPF_JMP | BPF_JGE | BPF_K, kX32, 0, 1));
  filter.push_back(statement(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
#endif
  for (const long number : {SYS_ptrace,
                            SYS_process_vm_readv,
                            SYS_process_vm_writev,
                            SYS_kexec_load,
                            SYS_init_module,
                            SYS_finit_module,
                            SYS_delete_module,
                            SYS_mount,
                            SYS_umount2,
                            SYS_pivot_root,
                            SYS_chroot,
                            SYS_setns,
                            SYS_unshare,
                            SYS_bpf,
                            SYS_perf_event_open,
                            SYS_keyctl,
                            SYS_add_key,
                            SYS_request_key,
                            SYS_reboot,
                            SYS_swapon,
                            SYS_swapoff,
                            SYS_setuid,
                            SYS_setgid,
                            SYS_setresuid,
                            SYS_setresgid,
                            SYS_userfaultfd,
                            SYS_personality})
    answer(filter, number, SECCOMP_RET_KILL_PROCESS);
  for (const long number : {SYS_execve, SYS_execveat, SYS_kill, SYS_tkill, SYS_pidfd_open, SYS_pidfd_send_signal,
                            SYS_io_uring_setup, SYS_prlimit64})
    answer(filter, number, refusal(EPERM));
#if defined(__x86_64__)
  for (const long number : {SYS_fork, SYS_vfork}) answer(filter, number, refusal(EPERM));
#endif
  if (!network)
    for (const long number : {SYS_socket, SYS_socketpair, SYS_connect, SYS_bind, SYS_listen, SYS_sendto, SYS_sendmsg})
      answer(filter, number, refusal(EPERM));
  // Flags of clone3 lie in memory that a filter cannot read: "not there" makes libc take clone, whose flags it can.
  answer(filter, SYS_clone3, refusal(ENOSYS));
  filter.push_back(jump(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone, 0, 3));
  filter.push_back(statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args)));
  filter.push_back(jump(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 1, 0));
  filter.push_back(statement(BPF_RET | BPF_K, refusal(EPERM)));
  filter.push_back(statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  return filter;
}

Expected<bool, std::string> fence_calls(bool network) {
  if (kSanitized || kMachine == 0) return false;
  auto filter = forbidden_calls(network);
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  if (::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0U, &program) == 0) return true;
  if (errno == ENOSYS || errno == EINVAL) return false;  // a kernel without it
  return failed("seccomp");
}

}  // namespace

Expected<Confined, std::string> confine(const Confinement& order) {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return failed("no_new_privs");
  const auto files = fence_files(order);
  if (!files) return unexpected(files.error());
  const auto calls = fence_calls(order.network);
  if (!calls) return unexpected(calls.error());
  return Confined{*files, *calls};
}

}  // namespace glidehelm::world
