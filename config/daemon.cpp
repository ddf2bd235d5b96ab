#include "config/daemon.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "config/paths.hpp"
#include "config/yaml_reader/schema.hpp"

namespace glidehelm::config {

bool Listen::lets_in(std::string_view peer) const {
  const auto address = IpAddress::from_text(peer);
  if (!address) return false;
  if (allow.empty()) return address->is_loopback();
  return std::any_of(allow.begin(), allow.end(), [&](const Network& network) { return network.contains(*address); });
}

namespace {

/// `line:` as it stands in the file.
struct LineDraft {
  std::optional<Endpoint> listen, connect;
  std::vector<std::string> allow;
};
struct EntryDraft : GliderEntry {
  LineDraft draft;
};
struct DaemonDraft : DaemonConfig {
  std::vector<EntryDraft> entries;
};

bool matches_endpoint(std::string_view text) { return Endpoint::from_text(text).has_value(); }
const Pattern kEndpoint{"^(\\[[0-9A-Fa-f:]+\\]|[A-Za-z0-9][A-Za-z0-9.-]*):[1-9][0-9]{0,4}$",
                        "HOST:PORT or [IPV6]:PORT, ports 1 to 65535", matches_endpoint};
bool matches_network(std::string_view text) { return Network::from_text(text).has_value(); }
const Pattern kNetwork{"^[0-9A-Fa-f:.]+(/[0-9]{1,3})?$", "networks such as 192.0.2.0/24, host bits 0", matches_network};

void add_endpoint(Fields<LineDraft>& f, Key key, std::optional<Endpoint> LineDraft::*member) {
  Shape shape;
  shape.pattern = &kEndpoint;
  const auto name = key.name;
  f.custom(
      key, shape, "",
      [member](const At& at, LineDraft& line) {
        if (const auto text = read_text(at, kEndpoint)) line.*member = Endpoint::from_text(*text);
      },
      [member, name](const LineDraft& line, const std::string& path, Effective& out) {
        out.leaf(path, name, line.*member ? yaml_text((line.*member)->text()) : "");
      });
}

Fields<LineDraft> line_fields() {
  Fields<LineDraft> f;
  add_endpoint(f, {"listen", "address and port on which the dialog is piped to us", false, "none"}, &LineDraft::listen);
  add_endpoint(f, {"connect", "host and port that we dial for the dialog", false, "none"}, &LineDraft::connect);
  Shape networks;
  networks.kind = Shape::Kind::list;
  networks.parts.push_back(Shape{});
  networks.parts.back().pattern = &kNetwork;
  f.custom(
      {"allow", "networks that may connect to `listen`; without any only this machine may"}, networks, "[]",
      [](const At& at, LineDraft& line) {
        if (!expect_list(at, 0, 64)) return;
        for (std::size_t i = 0; i < at.node.items.size(); ++i)
          if (auto text = read_text(at.item(i), kNetwork)) line.allow.push_back(std::move(*text));
      },
      [](const LineDraft& line, const std::string& path, Effective& out) {
        out.leaf(path, "allow", yaml_list(line.allow));
      });
  return f;
}

constexpr int kMostWordings = 16;

bool matches_wording(std::string_view text) {
  return text.size() >= 2 && text.size() <= 120 && text.front() != ' ' && text.back() != ' ' &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}
const Pattern kWording{"^[!-~][ -~]{0,118}[!-~]$", "2 to 120 printable ASCII characters, no blank at either end",
                       matches_wording};

using Words = protocol::DialogWords;

/// The wordings of one fact; what the file says replaces the usual ones.
void add_wordings(Fields<Words>& f, const Key& key, std::vector<std::string> Words::*member) {
  Shape shape;
  shape.kind = Shape::Kind::list;
  shape.at_least = 1;
  shape.at_most = kMostWordings;
  shape.parts.push_back(Shape{});
  shape.parts.back().pattern = &kWording;
  f.custom(
      key, shape, yaml_list(Words{}.*member),
      [member](const At& at, Words& words) {
        if (!expect_list(at, 1, kMostWordings)) return;
        (words.*member).clear();
        for (std::size_t i = 0; i < at.node.items.size(); ++i)
          if (auto text = read_text(at.item(i), kWording)) (words.*member).push_back(std::move(*text));
      },
      [member, name = key.name](const Words& words, const std::string& path, Effective& out) {
        out.leaf(path, name, yaml_list(words.*member));
      });
}

struct Wordings {
  const char *key, *meaning;
  std::vector<std::string> Words::*member;
};
constexpr Wordings kWordings[]{
    {"reread", "Ctrl-F was answered: the glider reads its mafiles again", &Words::reread},
    {"transfer_starts", "a transfer began; the file's name follows", &Words::transfer_starts},
    {"transfer_done", "a transfer ended with its file; the name follows", &Words::transfer_done},
    {"transfer_failed", "a transfer ended without its file; the name follows", &Words::transfer_failed},
    {"command_succeeded", "a `!` command ended well; the command follows", &Words::command_succeeded},
    {"command_failed", "a `!` command was refused; the command follows", &Words::command_failed},
    {"nothing_to_send", "in a dockserver block: there was no file to send", &Words::nothing_to_send}};

Fields<Words> dialog_fields() {
  Fields<Words> f;
  for (const auto& w : kWordings) add_wordings(f, {w.key, w.meaning}, w.member);
  return f;
}

/// One text that says two things: only one of them would ever be heard.
void check_dialog(const At& at, const Words& words) {
  std::map<std::string, std::string> first;
  for (const auto& wordings : kWordings) {
    const auto* key = wordings.key;
    const auto& texts = words.*wordings.member;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const auto path = at.path + "." + key;
      const auto [before, is_new] = first.emplace(texts[i], key);
      if (is_new) continue;
      // One of the two stands in the file; the other may be a usual text of a key that was left out.
      const auto* here = at.node.find(key);
      const auto other = here != nullptr ? before->second : std::string{key};
      const auto problem = other == key ? "stands twice" : "is also a text of " + other;
      if (here != nullptr)
        At{*here, &at.node, path, at.reading}.item(i).complain(problem, shown(texts[i]));
      else
        at.reading.complain(at.path + "." + before->second, problem, shown(texts[i]));
    }
  }
}

/// What `line:` says as a whole.
void check_line(const At& at, const LineDraft& line) {
  const auto complain = [&](const char* key, std::string problem, std::string found, std::string allowed) {
    at.reading.complain(at.path + key, std::move(problem), std::move(found), std::move(allowed));
  };
  const auto is_set = [&](const char* key) { return at.reading.places.count(at.path + key) > 0; };
  if (is_set(".listen") && is_set(".connect")) complain("", "both listen and connect", {}, "one of the two");
  if (!is_set(".listen") && !is_set(".connect"))
    complain("", "neither listen nor connect", {}, "{listen: ADDRESS:PORT} or {connect: HOST:PORT}");
  if (is_set(".connect") && !line.allow.empty()) complain(".allow", "goes with listen only", {}, {});
  if (!line.listen) return;
  const auto& host = line.listen->host;
  const auto address = IpAddress::from_text(host == "localhost" ? "127.0.0.1" : host);
  if (!address)
    complain(".listen", "not an address of this machine", shown(host), "an IP address or localhost");
  else if (!address->is_loopback() && !is_set(".allow"))
    complain(".listen", "listens beyond this machine without saying to whom", shown(host),
             "127.0.0.1, or an allow: list of networks beside it");
  else if (!address->is_loopback() && at.node.find("allow")->items.empty())
    complain(".allow", "no network, but listen is open beyond this machine", {}, "networks such as 192.0.2.0/24");
}

void add_clock(Fields<DaemonDraft>& f) {
  struct Simulated {
    std::string socket;
  };
  static const auto kFields = [] {
    Fields<Simulated> s;
    s.text({"simulated", "socket of glidersim, which then hands out the time", true}, &Simulated::socket);
    return s;
  }();
  f.custom(
      {"clock", "`system`, or the clock of a simulation: nothing then leaves the simulation's folders"},
      Fields<DaemonDraft>::any_of({Fields<DaemonDraft>::word_shape({"system"}), kFields.shape()}), "system",
      [](const At& at, DaemonDraft& d) {
        if (!at.node.is(Node::Kind::map)) {
          (void)read_word(at, {"system"});
          return;
        }
        Simulated s;
        kFields.read(at, s);
        d.simulated_clock = path_beside(at.reading.problems.file(), s.socket);
      },
      [](const DaemonDraft& d, const std::string& path, Effective& out) {
        out.leaf(path, "clock", d.simulated_clock ? "{simulated: " + yaml_text(*d.simulated_clock) + "}" : "system");
      });
}

const Fields<DaemonDraft>& daemon_fields() {
  static const Fields<DaemonDraft> kFields = [] {
    Fields<EntryDraft> glider;
    glider.text({"name", "name as the glider's dialog says it, in lower case", true}, &EntryDraft::name, kName);
    const auto line = line_fields();
    glider.custom(
        {"line", "where its dialog comes from: `listen` or `connect`", true}, line.shape(), "",
        [line](const At& at, EntryDraft& entry) {
          if (!expect_map(at)) return;
          line.read(at, entry.draft);
          check_line(at, entry.draft);
        },
        [line](const EntryDraft& entry, const std::string& path, Effective& out) {
          out.open("line");
          line.print(entry.draft, path, out);
          out.close();
        });
    glider.text({"to_glider", "the dockserver's folder of files for this glider", true}, &EntryDraft::to_glider);
    const auto dialog = dialog_fields();
    glider.custom(
        {"dialog", "texts of its dialog, where they are not the usual ones; what is left out stays as it is"},
        dialog.shape(), "",
        [dialog](const At& at, EntryDraft& entry) {
          if (!expect_map(at)) return;
          dialog.read(at, entry.dialog);
          check_dialog(at, entry.dialog);
        },
        [dialog](const EntryDraft& entry, const std::string& path, Effective& out) {
          out.open("dialog");
          dialog.print(entry.dialog, path, out);
          out.close();
        });
    glider.flag({"clock_skew_ok", "the glider's clock is known to differ by more than 5 min: emit nevertheless"},
                &EntryDraft::clock_skew_ok);
    Fields<DaemonDraft> log;
    log.word({"level", "least level that is logged"}, &DaemonDraft::log_level,
             std::vector<std::pair<std::string, LogLevel>>{{"debug", LogLevel::debug},
                                                           {"info", LogLevel::info},
                                                           {"warn", LogLevel::warn},
                                                           {"error", LogLevel::error}});
    Fields<DaemonDraft> f;
    f.constant({"schema", "what this file is", true}, kDaemonSchema);
    add_clock(f);
    f.text({"state_dir", "folder of the journal and of the ocean grids"}, &DaemonDraft::state_dir);
    f.text({"control_socket", "socket for commands to the running daemon"}, &DaemonDraft::control_socket);
    f.texts({"missions", "mission files; shell patterns"}, &DaemonDraft::missions, 0);
    f.text({"coast", "coast file of missions that name none", false, "none"}, &DaemonDraft::coast);
    f.section({"log", "what is logged"}, log);
    f.list({"gliders", "the gliders, one line each", true}, &DaemonDraft::entries, glider, 1);
    return f;
  }();
  return kFields;
}

std::string without_slash(std::string path) {
  for (auto at = path.find("//"); at != std::string::npos; at = path.find("//")) path.erase(at, 1);
  for (auto at = path.find("/./"); at != std::string::npos; at = path.find("/./")) path.erase(at, 2);
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

/// Says that a value which must be one glider's own stands twice.
class Unique {
 public:
  Unique(Reading& reading, std::string what) : reading_{reading}, what_{std::move(what)} {}
  void add(const std::string& value, const std::string& path, const std::string& shown_value) {
    if (value.empty()) return;
    const auto [first, is_new] = first_.emplace(value, path);
    if (!is_new)
      reading_.complain(path,
                        "two gliders with one " + what_ + "; the first stands in line " +
                            std::to_string(reading_.place_of(first->second).line),
                        shown(shown_value));
  }

 private:
  Reading& reading_;
  std::string what_;
  std::map<std::string, std::string> first_;
};

void check_gliders(const DaemonDraft& d, Reading& reading) {
  Unique names{reading, "name"}, ports{reading, "port"}, peers{reading, "host and port"},
      folders{reading, "to_glider folder"};
  for (std::size_t i = 0; i < d.entries.size(); ++i) {
    const auto& entry = d.entries[i];
    const auto path = "gliders[" + std::to_string(i) + "]";
    names.add(entry.name, path + ".name", entry.name);
    if (entry.draft.listen)
      ports.add(std::to_string(entry.draft.listen->port), path + ".line.listen", entry.draft.listen->text());
    if (entry.draft.connect)
      peers.add(entry.draft.connect->text(), path + ".line.connect", entry.draft.connect->text());
    folders.add(without_slash(path_beside(reading.problems.file(), entry.to_glider)), path + ".to_glider",
                entry.to_glider);
  }
}

void resolve(DaemonDraft& d, const std::string& file) {
  d.state_dir = without_slash(path_beside(file, d.state_dir));
  d.control_socket = path_beside(file, d.control_socket);
  for (auto& pattern : d.missions) pattern = path_beside(file, pattern);
  d.coast = path_beside(file, d.coast);
  for (auto& entry : d.entries) {
    entry.to_glider = without_slash(path_beside(file, entry.to_glider));
    if (entry.draft.connect) {
      entry.line = Connect{*entry.draft.connect};
    } else {
      Listen listen{*entry.draft.listen, {}};
      for (const auto& network : entry.draft.allow) listen.allow.push_back(*Network::from_text(network));
      entry.line = std::move(listen);
    }
    d.gliders.push_back(static_cast<const GliderEntry&>(entry));
  }
}

}  // namespace

Expected<DaemonFile, std::vector<ConfigError>> read_daemon_file(std::string_view text, const std::string& file) {
  auto document = read_yaml(text, file);
  Reading reading{file};
  for (auto& error : document.errors) reading.problems.add(std::move(error));
  DaemonDraft draft;
  if (document.readable) {
    const At root{document.root, nullptr, "", reading};
    reading.places[""] = document.root.place;
    if (expect_map(root)) {
      daemon_fields().read(root, draft);
      check_gliders(draft, reading);
    }
  }
  if (!reading.problems.empty()) return unexpected(reading.problems.sorted());
  resolve(draft, file);
  DaemonFile result;
  Effective effective{&reading};
  daemon_fields().print(draft, "", effective);
  result.effective = effective.text();
  result.config = static_cast<const DaemonConfig&>(draft);
  for (std::size_t i = 0; i < draft.entries.size(); ++i)
    result.glider_places.push_back(reading.place_of("gliders[" + std::to_string(i) + "].name"));
  return result;
}

std::vector<std::string> mission_patterns(std::string_view text, const std::string& file) {
  const auto document = read_yaml(text, file);
  if (!document.readable) return {};
  Reading reading{file};
  DaemonDraft draft;
  const At root{document.root, nullptr, "", reading};
  if (!expect_map(root)) return {};
  daemon_fields().read(root, draft);
  resolve(draft, file);
  return draft.missions;
}

Shape daemon_shape() { return daemon_fields().shape(); }

std::string daemon_schema() { return json_schema(daemon_shape(), kDaemonSchema, "Glidehelm daemon"); }

}  // namespace glidehelm::config
