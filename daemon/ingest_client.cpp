#include "daemon/ingest_client.hpp"

#include <cstdio>
#include <utility>

#include "core/base/utc.hpp"

namespace glidehelm::daemon {

namespace {

using End = world::ProcessResult::End;

/// One run of the child: what it is asked and where it writes.
struct Job {
  world::ProcessRequest request;
  std::vector<std::string> files;
  std::string folder, name;
  bool keep{};
  [[nodiscard]] std::string path() const { return folder + "/" + name; }
};

std::string decimal(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

Expected<Job, std::string> job_for(const std::vector<std::string>& patterns, const IngestOptions& options,
                                   const world::World& world) {
  Job job;
  for (const auto& pattern : patterns) {
    const auto found = world.files.glob(pattern);
    if (found.empty()) return unexpected("no file matches " + pattern);
    job.files.insert(job.files.end(), found.begin(), found.end());
  }
  if (job.files.empty()) return unexpected(std::string{"no forecast file was named"});
  job.keep = !options.keep_in.empty();
  job.folder = job.keep ? options.keep_in : world.files.scratch();
  job.name = "glidehelm-" + std::to_string(world.rng.next()) + ".grid";

  auto& request = job.request;
  request.program = "glidehelm-ingest";
  request.deadline = options.deadline;
  request.memory_at_most = options.memory_at_most;
  auto& arguments = request.arguments;
  arguments = {"-o", job.path()};
  if (!options.east.empty() || !options.north.empty()) {
    arguments.emplace_back("--variables");
    arguments.push_back(options.east + "," + options.north);
  }
  if (options.time_epoch) {
    arguments.emplace_back("--time-epoch");
    arguments.push_back(utc_text(*options.time_epoch));
  }
  if (options.area) {
    // One word with "=": a western edge begins with a minus sign.
    arguments.push_back("--area=" + decimal(options.area->west_deg) + "/" + decimal(options.area->east_deg) + "/" +
                        decimal(options.area->south_deg) + "/" + decimal(options.area->north_deg));
  }
  arguments.emplace_back("--");
  arguments.insert(arguments.end(), job.files.begin(), job.files.end());
  return job;
}

/// The child's last line that is not a warning, without its name.
std::string complaint(const std::string& text) {
  std::string found;
  for (std::size_t at = 0; at < text.size();) {
    auto end = text.find('\n', at);
    if (end == std::string::npos) end = text.size();
    std::string line = text.substr(at, end - at);
    at = end + 1;
    constexpr std::string_view kName = "glidehelm-ingest: ";
    if (line.compare(0, kName.size(), kName) == 0) line.erase(0, kName.size());
    if (!line.empty() && line.compare(0, 9, "warning: ") != 0) found = line;
  }
  return found;
}

std::string failure(const Job& job, const world::ProcessResult& result) {
  const std::string reading = " while reading " + job.files.front() +
                              (job.files.size() > 1 ? " and " + std::to_string(job.files.size() - 1) + " more" : "");
  switch (result.end) {
    case End::exited: {
      const auto said = complaint(result.err);
      return said.empty() ? "glidehelm-ingest ended with code " + std::to_string(result.code) + reading : said;
    }
    case End::signalled:
      return "glidehelm-ingest died of signal " + std::to_string(result.code) + reading;
    case End::deadline:
      return "glidehelm-ingest took longer than " + decimal(job.request.deadline.count()) + " s" + reading;
    case End::output_too_long:
      return "glidehelm-ingest complained without end" + reading;
    case End::not_started:
      return "glidehelm-ingest cannot be started (error " + std::to_string(result.code) + ")";
  }
  return "glidehelm-ingest failed" + reading;
}

/// Takes away the grid's name, and what a killed child may have staged for it.
void clean_up(const Job& job, world::Files& files) {
  auto folder = files.open_folder(job.folder);
  if (!folder) return;
  (void)(*folder)->unlink(job.name);
  const auto names = (*folder)->list();
  if (!names) return;
  for (const auto& name : *names)
    if (name.compare(0, job.name.size() + 1, "." + job.name) == 0) (void)(*folder)->unlink(name);
}

/// Maps the grid, takes its name away, and believes it only after the checks of open_grid.
IngestResult take(const Job& job, const world::ProcessResult& result, world::Files& files) {
  IngestResult taken = [&]() -> IngestResult {
    if (!result.succeeded()) return unexpected(failure(job, result));
    auto mapping = files.map(job.path());
    if (!mapping) return unexpected(mapping.error().message());
    auto view = ocean::open_grid((*mapping)->bytes());
    if (!view) return unexpected("the grid made of " + job.files.front() + " is not sound, " + view.error().message());
    return std::make_unique<LoadedGrid>(
        LoadedGrid{std::move(*mapping), std::move(*view), job.keep ? job.path() : "", job.files});
  }();
  if (!taken || !job.keep) clean_up(job, files);
  return taken;
}

}  // namespace

IngestResult ingest_files(const std::vector<std::string>& patterns, const IngestOptions& options,
                          const world::World& world) {
  const auto job = job_for(patterns, options, world);
  if (!job) return unexpected(job.error());
  return take(*job, world.procs.run_and_wait(job->request), world.files);
}

void ingest_files_async(const std::vector<std::string>& patterns, const IngestOptions& options,
                        const world::World& world, std::function<void(IngestResult)> then) {
  auto job = job_for(patterns, options, world);
  if (!job) {
    world.net.post([then = std::move(then), error = job.error()] { then(unexpected(error)); });
    return;
  }
  auto request = job->request;
  world.procs.run(std::move(request), [job = std::move(*job), &files = world.files, then = std::move(then)](
                                          world::ProcessResult result) { then(take(job, result, files)); });
}

}  // namespace glidehelm::daemon
