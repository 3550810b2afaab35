#include "server/app/serve/control_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/json_text.h"
#include "render/camera/camera.h"
#include "server/app/serve/change_notes.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {
namespace {

using http::ControlRefusal;
using nlohmann::json;

constexpr std::int64_t kStatusEvery = kNanosPerSecond / 2;
constexpr std::size_t kMostFiles = 1000;                   // listed
constexpr double kShortestClip = 0.1, kLongestClip = 600;  // s

// --hand_load; without the places of loads that are not at the grip.
std::string HandLoadOption(const HandLoad& load) {
  std::string text;
  const auto add = [&text](const char* where, double kilograms) {
    if (kilograms > 0) text += fmt::format("{}{}:{:g}", text.empty() ? "" : ",", where, kilograms);
  };
  add("right", load.mass_kg[urdf::kRight]);
  add("left", load.mass_kg[urdf::kLeft]);
  add("both", load.both_kg);
  return text.empty() ? "none" : text;
}

}  // namespace

ControlDesk::ControlDesk(DeskParts parts)
    : parts_(std::move(parts)),
      start_micros_(WallNanos() / 1000),
      log_(parts_.marks, parts_.states),
      held_(log_, parts_.first_hand_load),
      trials_(parts_.folder),
      camera_(parts_.camera) {}

ControlDesk::~ControlDesk() {
  held_.Flush();
  if (running_) StopTrial();
}

ControlStatus ControlDesk::Look() {
  ControlStatus status;
  status.why_no_recording = parts_.why_no_recording;
  status.why_no_clips = parts_.why_no_clips;
  status.why_no_trials = WhyNoTrial();
  if (parts_.recorder != nullptr) status.recording = parts_.recorder->status();
  if (const auto free = parts_.folder.free_bytes()) {
    const auto spare = recording::RawRecorder::kSpareBytes;
    status.free_bytes = *free > spare ? *free - spare : 0;
  }
  status.trial = running_;
  status.jobs = workshop_.jobs();
  status.state = parts_.states.Get();
  status.stated = stated_;
  status.held = held_.all();
  status.first_held = {parts_.first_hand_load, start_micros_, "option"};
  for (const auto& [name, value] : parts_.loads_options) {
    status.mass_is_option = status.mass_is_option || name == "mass";
    status.sex_is_option = status.sex_is_option || name == "sex";
  }
  status.class_limits = ClassLimitsNow();
  status.class_limits_are_set = class_limits_.has_value();
  const bool is_recording = status.recording.state != recording::RawRecorder::State::kOff;
  const std::uint64_t ended = workshop_.ended();
  if (ended != jobs_seen_ended_ || (was_recording_ && !is_recording)) ++files_revision_;
  jobs_seen_ended_ = ended;
  was_recording_ = is_recording;
  status.files_revision = files_revision_;
  return status;
}

std::string ControlDesk::StatusJson() {
  const std::int64_t now = MonotonicNanos();
  if (now < status_due_nanos_) return status_;
  status_due_nanos_ = now + kStatusEvery;
  status_ = ToJson(Look());
  return status_;
}

std::string ControlDesk::FilesJson(http::Role role) {
  const std::string folder = http::MayAct(role, http::Role::kOperator)
                                 ? std::filesystem::absolute(parts_.folder.path()).string()
                                 : std::string();
  return FilesToJson(folder, files_revision_, RunMicros(), parts_.folder.List(kMostFiles),
                     trials_.trials());
}

std::optional<std::filesystem::path> ControlDesk::FindFile(const std::string& name) const {
  return parts_.folder.Find(name);
}

ControlDesk::Result ControlDesk::Record(const http::RecordingOrder& order, http::Role role) {
  const Recorded file = Record(order, http::Name(role));
  if (!file) return tl::unexpected(file.error());
  return JsonText(json{{"file", *file}});
}

ControlDesk::Recorded ControlDesk::Record(const http::RecordingOrder& order,
                                          std::string_view role) {
  if (parts_.recorder == nullptr) return RefuseOrder(409, parts_.why_no_recording);
  if (running_) return RefuseOrder(409, "a trial runs and is recorded; stop the trial first");
  status_due_nanos_ = 0;
  const std::string before = parts_.recorder->status().file;
  if (!order.run) {
    if (parts_.recorder->status().state != recording::RawRecorder::State::kOn) {
      return RefuseOrder(409, "nothing is recorded now");
    }
    parts_.recorder->Stop();
    log_.Note(role, "recording", before, "stopped");
    return before;
  }
  const std::string stem = parts_.folder.FreeStem(recording::NamePart(order.label, "recording") +
                                                  "_" + recording::TimeName());
  const std::string wrong = parts_.recorder->Start(stem);
  if (!wrong.empty()) return RefuseOrder(409, wrong);
  was_recording_ = true;
  ++files_revision_;
  log_.Note(role, "recording", "off", stem + recording::RawRecorder::kEnding);
  return stem + recording::RawRecorder::kEnding;
}

tl::expected<ClipSpan, ControlRefusal> ControlDesk::SpanOf(const http::ClipOrder& order) const {
  const auto extent = parts_.history->extent();
  const marks::Moment now = log_.Now();
  if (!extent || now.state == 0) return RefuseOrder(409, "no sample has come yet");
  const auto too_long = [](double secs) {
    return fmt::format("a clip of {:.1f} s; expected {} to {} s", secs, kShortestClip,
                       kLongestClip);
  };
  const double kept = Secs(now.made_nanos - extent->first_nanos);
  if (order.from_micros) {
    const ClipSpan span = {1000 * *order.from_micros, 1000 * *order.to_micros};
    const double secs = Secs(span.to_nanos - span.from_nanos);
    if (!(secs >= kShortestClip && secs <= kLongestClip)) return RefuseOrder(400, too_long(secs));
    if (span.to_nanos > now.made_nanos + kNanosPerSecond) {
      return RefuseOrder(409,
                         "the end of this clip has not come yet; ask for the next seconds instead");
    }
    if (span.from_nanos < extent->first_nanos) {
      return RefuseOrder(410,
                         fmt::format("the beginning of this clip is no longer kept: {:.1f} s are "
                                     "(--history_minutes)",
                                     kept));
    }
    return span;
  }
  const double secs = order.last_secs.value_or(order.next_secs.value_or(0));
  if (!(secs >= kShortestClip && secs <= kLongestClip)) return RefuseOrder(400, too_long(secs));
  const auto nanos = static_cast<std::int64_t>(secs * 1e9);
  if (order.next_secs) return ClipSpan{now.made_nanos, now.made_nanos + nanos};
  if (now.made_nanos - nanos < extent->first_nanos) {
    return RefuseOrder(410, fmt::format("the last {:g} s are more than is kept: {:.1f} s "
                                        "(--history_minutes)",
                                        secs, kept));
  }
  return ClipSpan{now.made_nanos - nanos, now.made_nanos};
}

// "": there is room for a clip.
std::string ControlDesk::WhyNoRoom() const {
  std::string wrong = parts_.folder.Prepare();
  if (!wrong.empty()) return wrong;
  const auto free = parts_.folder.free_bytes();
  if (!free || *free >= recording::RawRecorder::kSpareBytes) return "";
  return "the disk is full; delete files, or choose another disk with --recordings_folder";
}

tl::expected<std::uint64_t, std::string> ControlDesk::AddClip(const ClipSpan& span,
                                                              const std::string& camera,
                                                              const std::string& title,
                                                              const std::string& name) {
  const std::string wrong = WhyNoRoom();
  if (!wrong.empty()) return tl::unexpected(wrong);
  const ClipMakerOrder order = {span, camera, title, parts_.folder.path() / name};
  return workshop_.Add("clip", name, [this, order](Workshop::Progress& progress) {
    parts_.clips->Make(order, progress);
  });
}

ControlDesk::Result ControlDesk::Clip(const http::ClipOrder& order, http::Role /*role*/) {
  status_due_nanos_ = 0;
  if (order.cancel) {
    if (workshop_.Cancel(*order.cancel)) return JsonText(json{{"id", *order.cancel}});
    return RefuseOrder(409, "job " + std::to_string(*order.cancel) + " does not wait or run");
  }
  if (parts_.clips == nullptr) return RefuseOrder(503, parts_.why_no_clips);
  const auto& cameras = render::CameraNames();
  const std::string camera = order.camera.empty() ? camera_ : order.camera;
  const bool is_known = order.camera.empty() || camera == parts_.camera ||
                        std::find(cameras.begin(), cameras.end(), camera) != cameras.end();
  if (!is_known) {
    return RefuseOrder(400, "camera " + camera + ": unknown camera");
  }
  const auto span = SpanOf(order);
  if (!span) return tl::unexpected(span.error());
  const std::string name = parts_.folder.FreeStem("clip_" + recording::TimeName()) + ".mp4";
  const auto added = AddClip(*span, camera, "", name);
  if (!added) return RefuseOrder(409, added.error());
  return JsonText(json{{"id", *added}, {"file", name}});
}

ControlDesk::Result ControlDesk::SetPerson(const http::PersonOrder& order, http::Role role) {
  return SetPerson(order, http::Name(role));
}

ControlDesk::Result ControlDesk::SetPerson(const http::PersonOrder& order, std::string_view role) {
  const auto state = parts_.states.Get();
  if (state == nullptr || state->people.empty()) {
    return RefuseOrder(409, kNobodyYet);
  }
  if (!order.person && state->people.size() > 1) {
    return RefuseOrder(400, "several persons in the stream; set \"person\"");
  }
  const int character = order.person.value_or(state->people.front().character);
  const PersonState* const person = FindPerson(state.get(), character);
  if (person == nullptr) return RefuseOrder(404, "unknown person " + std::to_string(character));
  const PersonChange& change = order.change;
  const std::string wrong = FindDefect(change);
  if (!wrong.empty()) return RefuseOrder(400, wrong);
  const PersonModel& model = *person->model;
  PersonChange& stated = stated_[character];
  NoteChange(log_, role, *person, stated, change);
  stated.Add(change);
  parts_.changes.Put(character, change);
  status_due_nanos_ = 0;
  json answer = {{"person", character}};
  if (change.height_m && model.lengths_are_measured) {
    answer["note"] = fmt::format(
        "kept as stated; the body has the segment lengths of the stream, which give {:.2f} m",
        model.human.skeleton.height);
  }
  return JsonText(answer);
}

std::array<double, 2> ControlDesk::ClassLimitsNow() const {
  const auto state = parts_.states.Get();
  return class_limits_.value_or(state != nullptr ? state->class_limits : kDefaultClassLimits);
}

ControlDesk::Result ControlDesk::SetClassLimits(const std::array<double, 2>& limits,
                                                http::Role role) {
  return SetClassLimits(limits, http::Name(role));
}

ControlDesk::Result ControlDesk::SetClassLimits(const std::array<double, 2>& limits,
                                                std::string_view role) {
  const std::string wrong = FindDefect(limits);
  if (!wrong.empty()) return RefuseOrder(400, wrong);
  NoteClassLimits(log_, role, ClassLimitsNow(), limits);
  class_limits_ = limits;
  parts_.changes.Put(limits);
  status_due_nanos_ = 0;
  return JsonText(json{{"class_limits", limits}});
}

// As marks call a person.
void ControlDesk::OnHandLoad(int character, const HandLoad& load, http::Role role) {
  const auto state = parts_.states.Get();
  held_.OnOrder(character, NameOf(state.get(), character), load, http::Name(role),
                StatedHandLoadOf(state.get(), character));
  status_due_nanos_ = 0;
}

void ControlDesk::OnRosHandLoad(int character, const HandLoad& load, std::int64_t now_nanos) {
  const auto state = parts_.states.Get();
  held_.OnRos(character, NameOf(state.get(), character), load, now_nanos,
              StatedHandLoadOf(state.get(), character));
}

void ControlDesk::OnCamera(const std::string& before, const std::string& after,
                           std::string_view role) {
  log_.Note(role, "camera of the server picture", before, after);
  camera_ = after;
}

OptionTexts ControlDesk::OptionsNow() const {
  OptionTexts options = parts_.loads_options;
  const auto state = parts_.states.Get();
  if (class_limits_) {
    SetOption(options, "class_limits",
              fmt::format("{},{}", (*class_limits_)[0], (*class_limits_)[1]));
  }
  if (state == nullptr || state->people.empty()) return options;
  // The report's options are those of all people in it: of the first one.
  const int character = state->people.front().character;
  const auto stated = stated_.find(character);
  if (stated != stated_.end()) {
    const PersonChange& change = stated->second;
    if (change.mass_kg) SetOption(options, "mass", fmt::format("{}", *change.mass_kg));
    if (change.sex) SetOption(options, "sex", Name(*change.sex));
    if (change.height_m) SetOption(options, "height", fmt::format("{}", *change.height_m));
  }
  const HandLoad load = held_.Of(character);
  if (load.is_known) SetOption(options, "hand_load", HandLoadOption(load));
  return options;
}

}  // namespace kinescope::app
