#include "server/app/serve/ros_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <future>
#include <memory>
#include <utility>

#include "render/image/png_file.h"
#include "server/app/serve/change_notes.h"
#include "server/app/serve/operator_log.h"
#include "server/http/answer.h"
#include "server/scene/model_factory.h"
#include "server/scene/scene_options.h"

namespace kinescope::app {
namespace {

using ros_bridge::LiveSettings;
using ros_bridge::RosAnswer;
using ros_bridge::SettingsChange;

constexpr std::chrono::milliseconds kLook(50);  // for the end of the server
constexpr char kNotNow[] = "the server is starting or stopping";

using Refused = std::vector<std::string>;  // why not, of each that is not changed

// Whose topics and parameters have no prefix; null: there is none now.
const PersonState* FirstPerson(const SceneState* state) {
  if (state == nullptr) return nullptr;
  const auto first =
      std::find_if(state->people.begin(), state->people.end(),
                   [](const PersonState& person) { return person.model->index == 0; });
  return first == state->people.end() ? nullptr : &*first;
}

struct First {
  std::optional<int> character;
  std::string why_not;
};
First FirstOf(const RosDesk::Parts& parts) {
  const auto state = parts.states.Get();
  if (const PersonState* const first = FirstPerson(state.get())) return {first->character, ""};
  const bool is_empty = state == nullptr || state->people.empty();
  return {std::nullopt, is_empty ? kNobodyYet : "the first person of the stream is away"};
}

// Before the first sample.
bool HasNothing(const std::shared_ptr<const SceneState>& state) {
  return state == nullptr ||
         (state->stamp_nanos == 0 && state->people.empty() && state->objects.empty() &&
          state->robots.empty() && state->markers.empty() && state->images.empty());
}

// As operators of the page do it: their marks and reports have it.
Refused ChangeOnPage(const RosDesk::Parts& parts, const SettingsChange& wanted) {
  Refused refused;
  const auto add = [&](const ControlDesk::Result& result) {
    if (!result) refused.push_back(result.error().reason);
  };
  if (wanted.class_limits) add(parts.desk->SetClassLimits(*wanted.class_limits, kRosRole));
  if (!wanted.person.is_empty()) {
    const First first = FirstOf(parts);
    if (first.character) {
      add(parts.desk->SetPerson({first.character, wanted.person}, kRosRole));
    } else {
      refused.push_back(first.why_not);
    }
  }
  if (!wanted.camera) return refused;
  const std::string wrong = parts.page->SelectCamera(*wanted.camera, kRosRole);
  if (!wrong.empty()) refused.push_back(wrong);
  return refused;
}

Refused ChangeAlone(const RosDesk::Parts& parts, const SettingsChange& wanted) {
  Refused refused;
  OperatorLog log(nullptr, parts.states);
  const auto state = parts.states.Get();
  if (wanted.class_limits) {
    const std::string wrong = FindDefect(*wanted.class_limits);
    if (wrong.empty()) {
      NoteClassLimits(log, kRosRole, state->class_limits, *wanted.class_limits);
      parts.changes.Put(*wanted.class_limits);
    } else {
      refused.push_back(wrong);
    }
  }
  if (!wanted.person.is_empty()) {
    const First first = FirstOf(parts);
    const std::string wrong = first.character ? FindDefect(wanted.person) : first.why_not;
    if (wrong.empty()) {
      if (const PersonState* const person = FindPerson(state.get(), *first.character)) {
        NoteChange(log, kRosRole, *person, {}, wanted.person);
      }
      parts.changes.Put(*first.character, wanted.person);
    } else {
      refused.push_back(wrong);
    }
  }
  if (wanted.camera) refused.push_back(http::kNoRenderer);
  return refused;
}

}  // namespace

void RosDesk::Open(const Parts& parts) {
  const std::lock_guard<std::mutex> lock(mutex_);
  parts_.emplace(parts);
}

void RosDesk::Close() {
  is_closing_ = true;
  const std::lock_guard<std::mutex> lock(mutex_);
  parts_.reset();
}

// nullopt: the server ends.
template <class Result>
std::optional<Result> RosDesk::Await(std::future<Result>& result) const {
  while (result.wait_for(kLook) != std::future_status::ready) {
    if (is_closing_) return std::nullopt;
  }
  return result.get();
}

RosAnswer RosDesk::Snapshot() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_) return {false, kNotNow};
  if (parts_->pictures == nullptr) return {false, http::kNoRenderer};
  if (HasNothing(parts_->states.Get())) return {false, "no sample yet, and nothing else to draw"};
  const recording::Folder& folder = parts_->folder;
  if (const std::string wrong = folder.Prepare(); !wrong.empty()) return {false, wrong};
  try {
    auto picture = parts_->pictures->Order({});
    const auto image = Await(picture);
    if (!image) return {false, kNotNow};
    const std::string stem = folder.FreeStem("snapshot_" + recording::TimeName());
    const auto file = std::filesystem::absolute(folder.path() / (stem + ".png"));
    render::WritePng(file, *image);
    return {true, file.string()};
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
}

template <class Result>
std::optional<Result> RosDesk::OnPage(std::function<Result()> work) const {
  const auto promise = std::make_shared<std::promise<Result>>();
  auto result = promise->get_future();
  parts_->page->Post([promise, work = std::move(work)] { promise->set_value(work()); });
  return Await(result);
}

RosAnswer RosDesk::Record(bool run) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_ || parts_->desk == nullptr) return {false, kNotNow};
  const auto file = OnPage<ControlDesk::Recorded>([run, desk = parts_->desk] {
    return desk->Record({run, ""}, kRosRole);
  });
  if (!file) return {false, kNotNow};
  if (!*file) return {false, file->error().reason};
  return {true, std::filesystem::absolute(parts_->folder.path() / **file).string()};
}

std::optional<LiveSettings> RosDesk::Settings() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_) return std::nullopt;
  LiveSettings now;
  const auto state = parts_->states.Get();
  if (const PersonState* const first = FirstPerson(state.get())) first_model_ = first->model;
  const PersonModel& model = first_model_ ? *first_model_ : *parts_->initial_model;
  now.class_limits = state->class_limits;
  now.mass_kg = model.description.mass_kg;
  now.sex = model.description.sex;
  now.height_m = model.human.skeleton.height;
  if (parts_->page == nullptr || parts_->pictures == nullptr) return now;
  const auto camera = OnPage<std::string>([page = parts_->page] { return page->camera(); });
  if (!camera) return std::nullopt;
  now.camera = *camera;
  return now;
}

RosAnswer RosDesk::Change(const SettingsChange& wanted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_) return {false, kNotNow};
  const auto change = [parts = *parts_, wanted] {
    return parts.page != nullptr ? ChangeOnPage(parts, wanted) : ChangeAlone(parts, wanted);
  };
  const auto refused = parts_->page != nullptr ? OnPage<Refused>(change) : std::optional(change());
  if (!refused) return {false, kNotNow};
  return {refused->empty(), fmt::format("{}", fmt::join(*refused, "; "))};
}

}  // namespace kinescope::app
