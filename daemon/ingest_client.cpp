#include "daemon/ingest_client.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <utility>

#include "core/base/one_line.hpp"
#include "core/base/utc.hpp"
#include "daemon/world/program_version.hpp"

namespace glidehelm::daemon {

namespace {

using End = world::ProcessResult::End;

// Exit codes of glidehelm-ingest.
constexpr int kUsage = 2, kMemory = 3, kRefusedBefore = 4, kNotNow = 5;

constexpr unsigned kCpuAtMost_s = 120;
constexpr std::size_t kDescriptorsBesideFiles = 64;
constexpr std::size_t kLeftOutAtMost = 8;
constexpr double kHole = 1.5;  // of the median step
// A sanitizer reserves terabytes of address space before main: under a limit its programs cannot start.
#if defined(GLIDEHELM_SANITIZED)
constexpr bool kMemoryIsLimited = false;
#else
constexpr bool kMemoryIsLimited = true;
#endif

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

/// How the child is told to read; also the text that the cache knows it by.
std::vector<std::string> reading_arguments(const IngestOptions& options) {
  std::vector<std::string> arguments;
  if (!options.east.empty() || !options.north.empty()) {
    arguments.emplace_back("--variables");
    arguments.push_back(options.east + "," + options.north);
  }
  if (options.time_epoch) {
    arguments.emplace_back("--time-epoch");
    arguments.push_back(utc_text(*options.time_epoch));
  }
  const auto number_option = [&](const char* name, const std::optional<double>& value) {
    if (!value) return;
    arguments.emplace_back(name);
    arguments.push_back(decimal(*value));
  };
  if (!options.heights.empty()) {
    arguments.emplace_back("--heights");
    arguments.push_back(options.heights);
  }
  number_option("--equator-band", options.equator_band_deg);
  number_option("--fill-gaps", options.fill_gaps_km);
  for (const auto& [name, text] :
       {std::pair{"--rotation", &options.rotation}, std::pair{"--s-levels", &options.s_levels}}) {
    if (text->empty()) continue;
    arguments.emplace_back(name);
    arguments.push_back(*text);
  }
  if (options.member) {
    arguments.emplace_back("--member");
    arguments.push_back(std::to_string(*options.member));
  }
  if (options.area) {
    // One word with "=": a western edge begins with a minus sign.
    arguments.push_back("--area=" + decimal(options.area->west_deg) + "/" + decimal(options.area->east_deg) + "/" +
                        decimal(options.area->south_deg) + "/" + decimal(options.area->north_deg));
  }
  return arguments;
}

/// The files of the patterns; the grid file last, as the child counts it.
Expected<std::vector<std::string>, IngestFault> files_of(const std::vector<std::string>& patterns,
                                                         const std::string& grid_file, const world::World& world) {
  std::vector<std::string> files;
  for (const auto& pattern : patterns) {
    if (pattern.find("://") != std::string::npos) {  // not a name of this machine
      files.push_back(pattern);
      continue;
    }
    const auto found = world.files.glob(pattern);
    if (found.empty()) return unexpected(IngestFault{"no file matches " + pattern, true});
    files.insert(files.end(), found.begin(), found.end());
  }
  if (files.empty()) return unexpected(IngestFault{"no forecast file was named", false});
  if (grid_file.empty()) return files;
  files.erase(std::remove(files.begin(), files.end(), grid_file), files.end());
  files.push_back(grid_file);
  return files;
}

Job job_for(std::vector<std::string> files, const IngestOptions& options, const world::World& world) {
  Job job;
  job.files = std::move(files);
  job.keep = !options.keep_in.empty() || options.cache;
  job.folder = options.cache ? options.cache->staging() : job.keep ? options.keep_in : world.files.scratch();
  job.name = "glidehelm-" + std::to_string(world.rng.next()) + ".grid";

  auto& request = job.request;
  request.program = "glidehelm-ingest";
  request.disposable = true;
  request.deadline = options.deadline;
  request.memory_at_most = kMemoryIsLimited ? options.memory_at_most : 0;
  request.file_at_most = options.memory_at_most;
  request.cpu_at_most_s = kCpuAtMost_s;
  request.descriptors_at_most = static_cast<unsigned>(job.files.size() + kDescriptorsBesideFiles);
  auto& arguments = request.arguments;
  arguments = {"-o", job.path(), "--tell"};
  if (options.settle > Seconds{0}) {
    arguments.emplace_back("--settle");
    arguments.push_back(decimal(options.settle.count()));
  }
  if (options.cache) {
    arguments.emplace_back("--refused-before");
    request.input = options.cache->refused_list(recipe_of(options));
  }
  for (auto& argument : reading_arguments(options)) arguments.push_back(std::move(argument));
  const bool grid = !options.grid_file.empty() && job.files.size() > 1 && job.files.back() == options.grid_file;
  if (grid) {
    arguments.emplace_back("--grid-file");
    arguments.push_back(options.grid_file);
  }
  arguments.emplace_back("--");
  arguments.insert(arguments.end(), job.files.begin(), job.files.end() - (grid ? 1 : 0));
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
    if (!line.empty() && line.compare(0, 9, "warning: ") != 0) found = one_line(line);
  }
  return found;
}

/// "/data/a.nc", or "/data/a.nc and 2 more" for a set.
std::string subject(const Job& job, const IngestStory& story) {
  if (story.at && *story.at < job.files.size()) return job.files[*story.at];
  return job.files.front() + (job.files.size() > 1 ? " and " + std::to_string(job.files.size() - 1) + " more" : "");
}

/// What became of a child that made no grid.
IngestFault fault_of(const Job& job, const world::ProcessResult& result, const IngestStory& story) {
  constexpr bool kPassing = true;
  const auto about = subject(job, story);
  switch (result.end) {
    case End::exited: {
      if (result.code == kMemory)
        return {about + ": reading it needs more than the " + std::to_string(job.request.memory_at_most >> 20) +
                " MiB of memory that are allowed; cut it to the "
                "area, times and depths of the mission"};
      if (const auto said = complaint(result.err); !said.empty()) return {said, result.code == kNotNow};
      return {about + ": glidehelm-ingest ended with code " + std::to_string(result.code), result.code != kUsage};
    }
    case End::signalled: {
      // The system's own kill says nothing about the file.
      constexpr int kKilled = 9;
      return {about + ": glidehelm-ingest " + world::death_by(result.code) + " while reading it",
              result.code == kKilled};
    }
    case End::deadline:
      return {
          about + ": glidehelm-ingest took longer than " + decimal(job.request.deadline.count()) + " s and was stopped",
          kPassing};
    case End::output_too_long:
      return {about + ": glidehelm-ingest complained without end while reading it"};
    case End::not_started:
      return {"glidehelm-ingest cannot be started (error " + std::to_string(result.code) + ")", kPassing};
  }
  return {about + ": glidehelm-ingest failed", kPassing};
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

std::string unsound(const Job& job, const std::string& why) {
  return "the grid made of " + job.files.front() + " is not sound, " + why;
}

/// Maps the grid, takes its name away, and believes it only after the checks of open_grid.
IngestOutcome take(const Job& job, const world::ProcessResult& result, world::Files& files) {
  IngestOutcome taken = [&]() -> IngestOutcome {
    if (!result.succeeded()) return unexpected(fault_of(job, result, read_story(result.out)));
    auto mapping = files.map(job.path());
    if (!mapping) return unexpected(IngestFault{mapping.error().message(), true});
    auto view = ocean::open_grid((*mapping)->bytes());
    if (!view) return unexpected(IngestFault{unsound(job, view.error().message()), true});
    return std::make_unique<LoadedGrid>(LoadedGrid{std::move(*mapping),
                                                   std::move(*view),
                                                   job.keep ? job.path() : "",
                                                   job.files,
                                                   nullptr,
                                                   std::nullopt,
                                                   {},
                                                   false,
                                                   {}});
  }();
  if (!taken || !job.keep) clean_up(job, files);
  return taken;
}

/// The first step in time that is larger than kHole median ones, in words; empty when there is none.
std::string hole_in(const ocean::GridAxes& axes) {
  if (!axes.has_time || axes.times_s.size() < 3) return {};
  std::vector<double> steps;
  for (std::size_t k = 1; k < axes.times_s.size(); ++k) steps.push_back(axes.times_s[k] - axes.times_s[k - 1]);
  auto sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (steps[k] > kHole * *middle)
      return "the others have nothing between " + utc_text(instant_at(axes.times_s[k])) + " and " +
             utc_text(instant_at(axes.times_s[k + 1]));
  return {};
}

/// One order of the daemon: the cache, as many children as there are bad files and one more, and the answer.
class Ingestion : public std::enable_shared_from_this<Ingestion> {
 public:
  Ingestion(std::vector<std::string> files, IngestOptions options, world::World world,
            std::function<void(IngestOutcome)> then)
      : files_{std::move(files)}, options_{std::move(options)}, world_{world}, then_{std::move(then)} {}

  void attempt() {
    if (options_.cache) {
      if (auto contents = options_.cache->contents(files_)) {
        if (auto fault = remembered(*contents)) return fail(*fault, culprit_);
        const auto key = GridCache::key_of(recipe(), *contents);
        std::string damage;
        if (auto grid = options_.cache->take(key, damage)) return succeed(std::move(grid), key);
        if (!damage.empty()) notes_.push_back("a cached grid was damaged and is made anew (" + damage + ")");
      }
    }
    auto job = job_for(files_, options_, world_);
    auto request = job.request;
    world_.procs.run(std::move(request), [self = shared_from_this(), job = std::move(job)](
                                             const world::ProcessResult& result) { self->ended(job, result); });
  }

 private:
  [[nodiscard]] std::string recipe() const { return recipe_of(options_); }

  /// What is remembered against these contents; sets `culprit_` to the file, or to none for the set.
  std::optional<IngestFault> remembered(const std::vector<Sha256>& contents) {
    for (std::size_t i = 0; i < contents.size(); ++i)
      if (const auto* refusal = options_.cache->refusal(recipe(), {contents[i]})) {
        culprit_ = i;
        return IngestFault{files_[i] + ": " + refusal->reason, false};
      }
    culprit_.reset();
    if (const auto* refusal = options_.cache->refusal(recipe(), contents)) return IngestFault{refusal->reason, false};
    return std::nullopt;
  }

  void ended(const Job& job, const world::ProcessResult& result) {
    if (!options_.cache) {
      auto taken = take(job, result, world_.files);
      const auto story = read_story(result.out);
      if (!taken) return fail(taken.error(), story.at);
      return answer(std::move(taken));
    }
    const auto story = read_story(result.out);
    for (const auto& source : story.sources)
      if (source.file < files_.size()) options_.cache->learn(files_[source.file], source.identity, source.content);
    if (result.succeeded())
      take_in(job, story);
    else
      refuse(job, result, story);
  }

  /// The contents of all files, in order; of as many as were told.
  static std::vector<Sha256> contents_in(const IngestStory& story) {
    auto sources = story.sources;
    std::sort(sources.begin(), sources.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
    std::vector<Sha256> contents;
    for (const auto& source : sources)
      if (source.file == contents.size()) contents.push_back(source.content);
    return contents;
  }

  void take_in(const Job& job, const IngestStory& story) {
    const auto contents = contents_in(story);
    const auto key = GridCache::key_of(recipe(), contents);
    // The child may be wrong about everything but is made to be consistent: a grid of other sources is none of ours.
    auto grid = contents.size() == files_.size()
                    ? options_.cache->put(job.name, key)
                    : Expected<std::unique_ptr<MappedGrid>, std::string>{unexpected(std::string{"its sources are not "
                                                                                                "named"})};
    options_.cache->discard(job.name);
    if (!grid) return fail({unsound(job, grid.error()), true}, std::nullopt);
    succeed(std::move(*grid), key);
  }

  void refuse(const Job& job, const world::ProcessResult& result, const IngestStory& story) {
    options_.cache->discard(job.name);
    const auto contents = contents_in(story);
    if (result.end == End::exited && result.code == kRefusedBefore && contents.size() == files_.size())
      if (auto fault = remembered(contents)) return fail(*fault, culprit_);
    const auto fault = fault_of(job, result, story);
    if (!fault.passing && contents.size() == files_.size() && !(result.end == End::exited && result.code == kUsage)) {
      if (story.at && *story.at < files_.size()) {
        const auto begin = files_[*story.at] + ": ";
        options_.cache->refuse(
            recipe(), {contents[*story.at]},
            fault.what.compare(0, begin.size(), begin) == 0 ? fault.what.substr(begin.size()) : fault.what);
      } else {
        options_.cache->refuse(recipe(), contents, fault.what);
      }
    }
    fail(fault, story.at);
  }

  void succeed(std::unique_ptr<MappedGrid> grid, const Sha256& key) {
    answer(std::make_unique<LoadedGrid>(LoadedGrid{std::move(grid->mapping),
                                                   std::move(grid->view),
                                                   std::move(grid->path),
                                                   files_,
                                                   std::move(grid->hold),
                                                   key,
                                                   {},
                                                   false,
                                                   {}}));
  }

  /// A bad file is left out and the others are tried, unless it is the only one.
  void fail(const IngestFault& fault, std::optional<std::size_t> file) {
    // Without its grid a model would be read as something else.
    const bool grid = file && *file < files_.size() && files_[*file] == options_.grid_file;
    if (file && !grid && *file < files_.size() && files_.size() > 1 && left_out_.size() < kLeftOutAtMost) {
      left_out_.push_back({files_[*file], fault.what});
      passing_ = passing_ || fault.passing;
      files_.erase(files_.begin() + static_cast<std::ptrdiff_t>(*file));
      return attempt();
    }
    if (left_out_.empty()) return answer(unexpected(fault));
    answer(unexpected(
        IngestFault{left_out_.front().why + " (without that file: " + fault.what + ")", passing_ || fault.passing}));
  }

  void answer(IngestOutcome outcome) {
    if (outcome && !left_out_.empty())
      if (const auto hole = hole_in((*outcome)->view.axes); !hole.empty())
        outcome = unexpected(IngestFault{left_out_.front().why + " (" + hole + ")", passing_});
    if (outcome) {
      (*outcome)->left_out = left_out_;
      (*outcome)->try_again = passing_;
      (*outcome)->notes = notes_;
    }
    if (options_.cache)
      if (const auto saved = options_.cache->save(); !saved && outcome)
        (*outcome)->notes.push_back("what was learned of forecast files cannot be kept: " + saved.error().message());
    // From the loop, whether a child ran or not.
    world_.net.post([then = std::move(then_), held = std::make_shared<IngestOutcome>(std::move(outcome))] {
      then(std::move(*held));
    });
  }

  std::vector<std::string> files_;
  IngestOptions options_;
  world::World world_;
  std::function<void(IngestOutcome)> then_;
  std::optional<std::size_t> culprit_;
  std::vector<LeftOut> left_out_;
  std::vector<std::string> notes_;
  bool passing_{};
};

}  // namespace

std::string recipe_of(const IngestOptions& options) {
  std::string text = std::string{"glidehelm "} + world::program_version();
  for (const auto& argument : reading_arguments(options)) text += "\n" + argument;
  return text;
}

IngestStory read_story(const std::string& out) {
  IngestStory story;
  std::istringstream lines{out};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words{line};
    std::string word, hash;
    std::size_t file{};
    words >> word;
    if (word == "joining" || word == "writing") {
      story.at.reset();
      story.copying = false;
    } else if (word == "copying" || word == "reading") {
      if (!(words >> file)) continue;
      story.at = file;
      story.copying = word == "copying";
    } else if (word == "source") {
      IngestStory::Source source;
      auto& identity = source.identity;
      if (words >> source.file >> hash >> identity.device >> identity.inode >> identity.size >> identity.modified_ns >>
              identity.changed_ns &&
          Sha256::from_hex(hash, source.content))
        story.sources.push_back(source);
    }
  }
  return story;
}

IngestResult ingest_files(const std::vector<std::string>& patterns, const IngestOptions& options,
                          const world::World& world) {
  auto files = files_of(patterns, options.grid_file, world);
  if (!files) return unexpected(files.error().what);
  auto without_cache = options;
  without_cache.cache.reset();
  const auto job = job_for(std::move(*files), without_cache, world);
  auto taken = take(job, world.procs.run_and_wait(job.request), world.files);
  if (!taken) return unexpected(taken.error().what);
  return std::move(*taken);
}

void ingest_files_async(const std::vector<std::string>& patterns, const IngestOptions& options,
                        const world::World& world, std::function<void(IngestOutcome)> then) {
  auto files = files_of(patterns, options.grid_file, world);
  if (!files) {
    world.net.post([then = std::move(then), fault = files.error()] { then(unexpected(fault)); });
    return;
  }
  std::make_shared<Ingestion>(std::move(*files), options, world, std::move(then))->attempt();
}

}  // namespace glidehelm::daemon
