#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/dockserver/dialog_writer.hpp"
#include "simulator/dockserver/line_faults.hpp"
#include "simulator/dockserver/report.hpp"
#include "simulator/dockserver/to_glider.hpp"
#include "simulator/glider/behaviours.hpp"

namespace glidehelm::simulator {

/// The time line of a call and of the dockserver's script, in seconds.
struct CallSetup {
  double call_after{45};        ///< from the last fix to the connection block: the age of the fix when it is first read
  double at_surface_after{15};  ///< from the connection block to the at-surface block
  double reprint_every{60};     ///< printout_cycle_time
  double dockzr_after{120};     ///< from the connection block to the script's `!dockzr *`
  double transfer_overhead{20};  ///< of each file …
  double bytes_per_s{100};       ///< … and its speed
  bool reread_always{true};      ///< Ctrl-F at every call, as scripts do; false: only after a goto file was sent
  bool resume_at_once{false};    ///< Ctrl-R as soon as the script is through, not at the end of the scheduled interval
  Firmware firmware{Firmware::g3};
  int aborts{};   ///< since reset: what the dialog tells of them
  Telling tells;  ///< what the dialog tells of the glider
  friend bool operator==(const CallSetup&, const CallSetup&) = default;
};

/// What came over the line: bytes; or the link fell and what follows comes on a new connection; or it was `abandoned`:
/// what follows comes on a new connection while the older one stays open and silent.
struct LineEvent {
  enum class Kind { bytes, dropped, abandoned } kind{};
  std::string bytes;
  friend bool operator==(const LineEvent&, const LineEvent&) = default;
};

/// What a call led to.
struct CallOutcome {
  std::vector<std::string> sent;        ///< names of all files that reached the glider
  std::optional<OfferedFile> list;      ///< the goto list among them, when it is the one the mission reads
  bool partial{};                       ///< a cut transfer left the first part of a goto list on the glider
  bool reread{};                        ///< Ctrl-F was pressed
  std::optional<BehaviourError> error;  ///< the list that was read was bad: the mission is over
  std::string note;                     ///< why no list was taken; empty when one was
};

/// One call of a glider on the surface, from the connection block to the dive, and the script that answers it:
/// at `dockzr_after` it sends what lies in `to-glider` (a file that arrives later waits for the next surfacing), then
/// presses Ctrl-F, and Ctrl-R at the end of the scheduled surface interval (or at once). Nobody extends the window.
///
/// The link may fall on the way, and the glider may call again: then the script begins anew.
///
/// On its files the glider keeps the last `goto_lNN.ma` that it was sent; Ctrl-F reads that one, or the list that it
/// started with when none came yet.
class Call {
 public:
  /// Glider and folder must outlive the call. `on_board` are the bytes of the glider's goto list file; empty while it
  /// flies the list it started with.
  Call(const CallSetup& setup, CallFaults faults, Glider& glider, ToGlider& folder, std::string& on_board);

  /// Epoch second of what happens next; none when only the dive is left.
  [[nodiscard]] std::optional<double> next_s() const;
  /// Lets it happen.
  std::vector<LineEvent> step();
  [[nodiscard]] double dive_s() const { return dive_s_; }
  [[nodiscard]] const CallOutcome& outcome() const { return outcome_; }
  [[nodiscard]] const CallFaults& faults() const { return faults_; }

 private:
  enum class What {
    connect,
    at_surface,
    chatter,
    wrong_key,
    drop,
    call_back,
    cut,
    reprint,
    science,
    fetched,
    dockzr,
    torn,
    sent,
    reread,
    resume
  };
  struct Due {
    double at_s{};
    What what{};
  };
  void plan(double at_s, What what);
  void forget(What what);
  std::string dockzr(double now_s);
  std::string sent(double now_s);
  std::string science(double now_s);
  std::string fetched(double now_s);
  void plan_script(double call_s);
  std::vector<LineEvent> link_falls(double now_s, std::string last, double again_after, LineEvent::Kind kind);
  std::vector<LineEvent> transfer_is_torn(double now_s);
  [[nodiscard]] Report report(double now_s) const;
  std::string reread(double now_s);
  [[nodiscard]] double left(double now_s) const { return resume_s_ - now_s; }

  CallSetup setup_;
  CallFaults faults_;
  Glider* glider_;
  ToGlider* folder_;
  std::string* on_board_;
  std::vector<Due> due_;
  std::vector<OfferedFile> sending_, fetching_;
  bool busy_{}, torn_{};
  double call_s_{};
  double dive_s_{}, resume_s_{};
  CallOutcome outcome_;
};

}  // namespace glidehelm::simulator
