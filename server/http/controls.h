/// What operators do with a running server beside marks and hand loads: recordings, clips, people,
/// limits, trials. Implemented in server/app; called on the server's thread, must return at once.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/force_inputs.h"
#include "core/person_change.h"
#include "server/http/role.h"

namespace kinescope::http {

struct RecordingOrder {
  bool run = false;   // start, else stop
  std::string label;  // part of the file's name
};

/// Exactly one of them: `last_secs`, `next_secs`, a time from `from_micros` to `to_micros`, or the
/// job to cancel.
struct ClipOrder {
  std::optional<double> last_secs, next_secs;
  std::optional<std::int64_t> from_micros, to_micros;  // of the history
  std::optional<std::uint64_t> cancel;
  std::string camera;  // by name; "": that of the live picture
};

struct PersonOrder {
  std::optional<int> person;  // character; absent: the only person
  PersonChange change;        // its numbers are not checked yet
};

struct TrialOrder {
  enum class Act { kStart, kStop, kMake };
  Act act = Act::kStop;
  std::string person, condition;  // start
  int number = 1;                 // start
  std::string trial;              // make: its name
  bool clip = false;              // make
  bool report = false;            // make
};

/// Why an order is not carried out.
struct ControlRefusal {
  int status = 409;    // of the answer
  std::string reason;  // one line for the client, with the way out
};

class Controls {
 public:
  virtual ~Controls() = default;
  using Result = tl::expected<std::string, ControlRefusal>;  // a JSON object

  /// The message "controls" and /api/v1/controls: a JSON object that changes at most every half
  /// second, and after orders.
  virtual std::string StatusJson() = 0;
  /// /api/v1/files. Viewers do not see the folder.
  virtual std::string FilesJson(Role role) = 0;
  /// The file to download; nullopt: it is none of ours.
  virtual std::optional<std::filesystem::path> FindFile(const std::string& name) const = 0;

  virtual Result Record(const RecordingOrder& order, Role role) = 0;
  virtual Result Clip(const ClipOrder& order, Role role) = 0;
  virtual Result SetPerson(const PersonOrder& order, Role role) = 0;
  virtual Result SetClassLimits(const std::array<double, 2>& limits, Role role) = 0;
  virtual Result RunTrial(const TrialOrder& order, Role role) = 0;

  /// What was changed by other routes.
  virtual void OnHandLoad(int character, const HandLoad& load, Role role) = 0;
  virtual void OnCamera(const std::string& before, const std::string& after,
                        std::string_view role) = 0;
};

}  // namespace kinescope::http
