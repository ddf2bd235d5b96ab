#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>

#include "daemon/verify/dossier_json.hpp"
#include "daemon/verify/judge_request.hpp"
#include "daemon/world/real_files.hpp"

// glidehelm-verify: judges the bytes of one staged file. A fresh process for each file; knows no planner.

namespace {

using namespace glidehelm;

constexpr int kAccepted = 0, kFailed = 1, kUsage = 2, kRefused = 4;
constexpr std::size_t kLargestRequest = 16U << 20, kLargestStaged = 1U << 20;

constexpr const char* kHelp =
    "usage: glidehelm-verify [--explain] <REQUEST.json 3<goto_lNN.ma\n"
    "\n"
    "Judges the staged waypoint file on descriptor 3 by the request on standard input\n"
    "(schema glidehelm/verify-request/v1: dossier, grid or analytic currents, coast, areas)\n"
    "and prints the verdict, one JSON document (schema glidehelm/verdict/v1).\n"
    "\n"
    "  --explain  print the verdict as text: one line per rule, broken rules first\n"
    "  --help     print this\n"
    "\n"
    "exit status: 0 accepted, 4 refused, 1 no verdict (an input could not be read), 2 usage\n";

int complain(int status, std::string_view what) {
  std::cerr << "glidehelm-verify: " << what << '\n';
  return status;
}

int run(bool explained) {
  world::RealFiles files;
  const auto text = files.read_descriptor(0, kLargestRequest);
  if (!text) return complain(kFailed, text.error().message());
  auto request = verify::request_from_json(*text);
  if (!request) return complain(kUsage, "request: " + request.error().message());
  auto staged = files.read_descriptor(3, kLargestStaged);
  if (!staged) return complain(kFailed, staged.error().message());
  // What lies in the staged file is judged, whatever the request says that it holds.
  request->dossier.file_bytes = *std::move(staged);
  const auto verdict = verify::judge_request(*request, files);
  if (!verdict) return complain(kFailed, verdict.error().message());
  std::cout << (explained ? verify::explain(*verdict) : verify::to_json(*verdict) + "\n") << std::flush;
  if (!std::cout) return complain(kFailed, "the verdict could not be written");
  return verdict->accepted ? kAccepted : kRefused;
}

}  // namespace

int main(int argc, char** argv) {
  bool explained = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--help") {
      std::cout << kHelp;
      return kAccepted;
    }
    if (argument != "--explain") {
      std::cerr << kHelp;
      return complain(kUsage, "unknown argument '" + std::string{argument} + "'");
    }
    explained = true;
  }
  try {
    return run(explained);
  } catch (const std::exception& e) {
    return complain(kFailed, e.what());
  }
}
