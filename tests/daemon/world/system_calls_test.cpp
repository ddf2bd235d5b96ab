#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

// Only daemon/world asks the system for time, files, sockets, randomness and processes (trust.md M-1). This test reads
// the sources; what it looks for stands in the table.

namespace fs = std::filesystem;

namespace {

struct Forbidden {
  std::string what;
  std::regex token;
  std::string also_in{};  ///< folder that may use it beside daemon/world
};

/// Words are matched whole; a call is a word before a parenthesis that is no member (`x.read(`, `X::read(`).
std::regex word(const std::string& names) { return std::regex{"(^|[^A-Za-z0-9_])(" + names + ")([^A-Za-z0-9_]|$)"}; }
std::regex call(const std::string& names) { return std::regex{"(^|[^A-Za-z0-9_.>:~])(::|std::)?(" + names + ") *\\("}; }
std::regex global_call(const std::string& names) { return std::regex{"(^|[^A-Za-z0-9_>])::(" + names + ") *\\("}; }
std::regex header(const std::string& names) { return std::regex{"^ *# *include *<(" + names + ")>"}; }

const std::vector<Forbidden>& table() {
  static const std::vector<Forbidden> kTable{
      {"time", std::regex{"_clock::now|::now\\("}},
      {"time", word("clock_gettime|gettimeofday|timespec_get|clock_nanosleep|nanosleep|usleep|localtime|localtime_r|"
                    "gmtime|gmtime_r|mktime|strftime|timerfd_create|sleep_for|sleep_until|wait_for|wait_until")},
      {"time", std::regex{"(^|[^A-Za-z0-9_.>:])(std::|::)?time *\\( *(nullptr|NULL|0|&)"}},
      {"time", call("sleep|alarm|clock")},
      {"files", header("filesystem|fstream|dirent\\.h|fcntl\\.h|glob\\.h|unistd\\.h|sys/stat\\.h|sys/mman\\.h|"
                       "sys/file\\.h|sys/inotify\\.h|cstdio_ext\\.h")},
      {"files",
       word("std::filesystem|ifstream|ofstream|fstream|filebuf|fopen|freopen|fdopen|tmpfile|mkstemp|mkdtemp|"
            "openat|openat2|opendir|fdopendir|readdir|mmap|munmap|ftruncate|fsync|fdatasync|renameat|renameat2|"
            "unlinkat|mkdirat|fstatat|inotify_init|inotify_init1")},
      {"files", call("fread|fwrite|fgets|fscanf|rename|unlink|mkdir|rmdir|chmod|chdir|getcwd|symlink|realpath|"
                     "access|truncate")},
      {"files", std::regex{R"re((^|[^A-Za-z0-9_.>:~])(::|std::)?remove *\( *[A-Za-z0-9_.]*(\.c_str\(\))? *\))re"}},
      {"files",
       global_call("open|close|read|write|pread|pwrite|lseek|stat|fstat|lstat|glob|access|dup|dup2|pipe|pipe2")},
      {"files", word("std::cin|stdin|scanf|getline *\\( *std::cin")},
      {"files", word("nc_open|nc_open_mem|nc_create"), "daemon/ingest"},
      {"sockets",
       std::regex{"^ *# *include *<(boost/asio|sys/socket|sys/un|netinet/|arpa/|netdb|poll|sys/epoll|sys/select)"}},
      {"sockets", word("getaddrinfo|gethostbyname|inet_pton|inet_ntop|setsockopt|getsockopt|epoll_create1|epoll_ctl|"
                       "boost::asio|sockaddr|sockaddr_un|sockaddr_in")},
      {"sockets", global_call("socket|connect|bind|listen|accept|send|recv|sendto|recvfrom|poll|select|shutdown")},
      {"randomness", word("random_device|getrandom|getentropy|arc4random|/dev/u?random|srand|drand48|rand_r")},
      {"randomness", call("rand|random")},
      {"processes", header("spawn\\.h|sys/wait\\.h|sys/prctl\\.h|sys/resource\\.h|csignal|signal\\.h|sys/types\\.h")},
      {"processes", word("posix_spawn|posix_spawnp|popen|pclose|fork|vfork|execv|execve|execvp|execl|execlp|execvpe|"
                         "waitpid|sigaction|prctl|setrlimit|getpid|getppid|getuid|geteuid")},
      {"processes", call("system|raise|kill|signal")},
      {"processes", word("getenv|secure_getenv|setenv|putenv|environ|_exit|quick_exit")},
  };
  return kTable;
}

/// The lines of a source without comments and without what stands in string and character literals.
std::vector<std::string> code_lines(const std::string& text) {
  enum class In { code, line_comment, block_comment, string, character, raw } in = In::code;
  std::string out, raw_end;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const char next = i + 1 < text.size() ? text[i + 1] : '\0';
    if (c == '\n') {
      out += c;
      if (in == In::line_comment) in = In::code;
      continue;
    }
    switch (in) {
      case In::code:
        if (c == '/' && next == '/')
          in = In::line_comment;
        else if (c == '/' && next == '*')
          in = In::block_comment;
        else if (c == '"' && i > 0 && text[i - 1] == 'R') {
          const auto open = text.find('(', i);
          raw_end = ")" + text.substr(i + 1, open - i - 1) + "\"";
          in = In::raw;
        } else if (c == '"')
          in = In::string;
        else if (c == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1]))))
          in = In::character;
        if (in == In::code || in == In::string || in == In::character) out += c;
        break;
      case In::line_comment:
        break;
      case In::block_comment:
        if (c == '*' && next == '/') {
          in = In::code;
          ++i;
        }
        break;
      case In::string:
      case In::character:
        if (c == '\\')
          ++i;
        else if (c == (in == In::string ? '"' : '\'')) {
          out += c;
          in = In::code;
        }
        break;
      case In::raw:
        if (text.compare(i, raw_end.size(), raw_end) == 0) {
          i += raw_end.size() - 1;
          in = In::code;
        }
        break;
    }
  }
  std::vector<std::string> lines{""};
  for (const char c : out) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  return lines;
}

/// What a source asks of the system, as "line N: what: the line".
std::vector<std::string> found_in(const std::string& path, const std::string& text) {
  std::vector<std::string> found;
  const auto lines = code_lines(text);
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (const auto& f : table())
      if (std::regex_search(lines[i], f.token) && (f.also_in.empty() || path.rfind(f.also_in, 0) != 0))
        found.push_back(path + ":" + std::to_string(i + 1) + ": " + f.what + ": " + lines[i]);
  return found;
}

std::string content_of(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

}  // namespace

TEST_CASE("nothing outside daemon/world asks the system for time, files, sockets, randomness or processes") {
  const fs::path root{GLIDEHELM_SOURCE};
  std::vector<std::string> found;
  std::size_t read = 0;
  std::set<std::string> rooms;
  for (const char* top : {"core", "protocol", "config", "daemon", "simulator"})
    for (const auto& entry : fs::recursive_directory_iterator{root / top}) {
      const auto path = fs::relative(entry.path(), root).string();
      const auto extension = entry.path().extension();
      if ((extension != ".cpp" && extension != ".hpp") || path.rfind("daemon/world/", 0) == 0) continue;
      ++read;
      rooms.insert(top);
      const auto here = found_in(path, content_of(entry.path()));
      found.insert(found.end(), here.begin(), here.end());
    }
  for (const auto& line : found) UNSCOPED_INFO(line);
  CHECK(found.empty());
  CHECK(read > 100);
  CHECK(rooms.size() == 5);
}

TEST_CASE("the look finds what it looks for, and only in code") {
  for (const char* line : {"auto t = std::chrono::system_clock::now();",
                           "clock_gettime(CLOCK_REALTIME, &t);",
                           "std::time(nullptr);",
                           "std::this_thread::sleep_for(1s);",
                           "std::ifstream file{path};",
                           "#include <filesystem>",
                           "#include <fstream>",
                           "int fd = ::open(path, O_RDONLY);",
                           "FILE* f = fopen(\"x\", \"r\");",
                           "std::rename(a, b);",
                           "std::remove(path.c_str());",
                           "remove(path);",
                           "rename(a, b);",
                           "nc_open(path, 0, &id);",
                           "#include <boost/asio/io_context.hpp>",
                           "::connect(fd, a, n);",
                           "getaddrinfo(h, p, 0, &r);",
                           "std::random_device device;",
                           "int n = rand();",
                           "popen(\"ls\", \"r\");",
                           "system(\"ls\");",
                           "pid = fork();",
                           "const char* p = std::getenv(\"HOME\");",
                           "std::cin >> x;",
                           "#include <csignal>"}) {
    CAPTURE(line);
    CHECK_FALSE(found_in("core/x.cpp", line).empty());
  }
  for (const char* line :
       {"// std::chrono::system_clock::now()", "/* fopen(\"x\") */", "std::string s{\"getenv fork( ::open(\"};",
        "auto j = Journal::open(folder);", "reader.read(bytes);", "stage_->rename_new(a, b, c);",
        "stream->write(bytes);", "Emitter::open(files);", "std::remove(a.begin(), a.end(), 3);",
        "double time(double x);", "const auto n = file->read(3);", "char c = '\"'; // fopen(",
        "auto r = R\"(system(\"ls\"))\";", "const int system_count = 3;", "clock.utc();",
        "x = 1'000'000; y = random_draw();", "socket_ = path;", "#include \"daemon/world/files.hpp\""}) {
    CAPTURE(line);
    CHECK(found_in("core/x.cpp", line).empty());
  }
  CHECK(found_in("daemon/ingest/x.cpp", "nc_open_mem(name, 0, n, p, &id);").empty());
}
