/// Carries out what operators order on the page: recordings, clips, people, limits, trials,
/// reports; and notes each change. On the page's thread, except where stated.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "core/playback.h"
#include "core/scene_state.h"
#include "core/system/latest.h"
#include "server/app/serve/change_mailbox.h"
#include "server/app/serve/clip_maker.h"
#include "server/app/serve/control_status.h"
#include "server/app/serve/hand_load_log.h"
#include "server/app/serve/operator_log.h"
#include "server/app/serve/option_texts.h"
#include "server/app/serve/workshop.h"
#include "server/history/history.h"
#include "server/http/controls.h"
#include "server/marks/mark_book.h"
#include "server/recording/raw_recorder.h"
#include "server/recording/trial_book.h"

namespace kinescope::app {

/// All are borrowed.
struct DeskParts {
  const Latest<SceneState>& states;
  ChangeMailbox& changes;
  const history::History* history = nullptr;  // null: neither clips nor trials
  marks::MarkBook* marks = nullptr;           // null: changes are not noted
  const recording::Folder& folder;
  recording::RawRecorder* recorder = nullptr;  // null: nothing can be recorded
  std::string why_no_recording;                // of a null recorder
  const ClipMaker* clips = nullptr;            // null: no clips
  std::string why_no_clips;                    // of null clips
  std::string camera;                          // of the live picture, at the start
  OptionTexts loads_options;                   // as the server was started
  OptionTexts clip_options;                    // of clips of recordings
  HandLoad first_hand_load;                    // of all people, as the server was started
};

inline constexpr char kNobodyYet[] = "no person in the stream yet";

inline tl::unexpected<http::ControlRefusal> RefuseOrder(int status, std::string reason) {
  return tl::unexpected(http::ControlRefusal{status, std::move(reason)});
}

class ControlDesk : public http::Controls {
 public:
  explicit ControlDesk(DeskParts parts);
  ~ControlDesk() override;  // ends a trial that runs

  std::string StatusJson() override;
  std::string FilesJson(http::Role role) override;
  std::optional<std::filesystem::path> FindFile(const std::string& name) const override;

  Result Record(const http::RecordingOrder& order, http::Role role) override;
  Result Clip(const http::ClipOrder& order, http::Role role) override;
  Result SetPerson(const http::PersonOrder& order, http::Role role) override;
  Result SetClassLimits(const std::array<double, 2>& limits, http::Role role) override;
  Result RunTrial(const http::TrialOrder& order, http::Role role) override;

  /// As above; `role`: of who orders it, for the mark.
  Result SetPerson(const http::PersonOrder& order, std::string_view role);
  Result SetClassLimits(const std::array<double, 2>& limits, std::string_view role);

  /// The file, or why not.
  using Recorded = tl::expected<std::string, http::ControlRefusal>;
  Recorded Record(const http::RecordingOrder& order, std::string_view role);

  void OnHandLoad(int character, const HandLoad& load, http::Role role) override;
  void OnCamera(const std::string& before, const std::string& after,
                std::string_view role) override;

  /// A hand load that came over ROS. Any thread.
  void OnRosHandLoad(int character, const HandLoad& load, std::int64_t now_nanos);
  /// Call it many times a second. Any thread.
  void OnTime(std::int64_t now_nanos) { held_.OnTime(now_nanos); }

 private:
  Result StartTrial(const http::TrialOrder& order, http::Role role);
  Result StopTrial();
  Result MakeOfTrial(const http::TrialOrder& order);
  std::string AddTrialClip(const recording::Trial& trial);
  std::string AddTrialReport(const recording::Trial& trial);
  std::string AddRecordedClip(const recording::Trial& trial);
  using MakeOfRecording = void (*)(const std::filesystem::path& recording,
                                   const std::filesystem::path& made, const OptionTexts& options,
                                   const Workshop::Progress& progress);
  std::string AddOfRecording(const std::string& kind, const std::filesystem::path& from,
                             const std::string& name, OptionTexts options, MakeOfRecording make);
  std::string WhyNoRoom() const;
  OptionTexts ReportOptionsOf(const recording::Trial& trial) const;
  tl::expected<ClipSpan, http::ControlRefusal> SpanOf(const http::ClipOrder& order) const;
  tl::expected<std::uint64_t, std::string> AddClip(const ClipSpan& span, const std::string& camera,
                                                   const std::string& title,
                                                   const std::string& name);
  std::string WhyNoTrial() const;
  std::int64_t RunMicros() const;
  OptionTexts OptionsNow() const;
  std::array<double, 2> ClassLimitsNow() const;
  ControlStatus Look();

  const DeskParts parts_;
  const std::int64_t start_micros_;  // wall clock
  OperatorLog log_;
  HandLoadLog held_;
  recording::TrialBook trials_;
  std::optional<recording::Trial> running_;
  std::string camera_;                                 // of the live picture
  std::map<int, PersonChange> stated_;                 // by character
  std::optional<std::array<double, 2>> class_limits_;  // as they were set
  std::uint64_t files_revision_ = 1;
  std::uint64_t jobs_seen_ended_ = 0;
  bool was_recording_ = false;
  std::string status_;  // JSON
  std::int64_t status_due_nanos_ = 0;

  Workshop workshop_;  // last: its work uses the other members
};

}  // namespace kinescope::app
