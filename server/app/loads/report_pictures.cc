#include "server/app/loads/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "core/system/check.h"
#include "core/system/stop_signal.h"
#include "render/camera/camera.h"
#include "render/image/png_file.h"
#include "server/app/html.h"
#include "server/app/loads/report_text.h"

namespace kinescope::app {
namespace {

constexpr std::size_t kPostures = 3;
constexpr std::size_t kCaptionJoints = 2;

// Without the other people, who would stand in the way or be taken for the person of the page.
SceneState SceneWithOnly(int character, const SceneState& of) {
  SceneState scene = of;
  scene.people.erase(
      std::remove_if(scene.people.begin(), scene.people.end(),
                     [&](const PersonState& person) { return person.character != character; }),
      scene.people.end());
  KINESCOPE_CHECK(scene.people.size() == 1);
  return scene;
}

// The named camera, drawn near: `person` fills the picture.
render::Camera CloseUp(const SceneState& scene, const PersonState& person,
                       const render::PictureSpec& view) {
  Eigen::AlignedBox3d box;
  for (const urdf::Pose& link : person.links) box.extend(link.position);
  render::Camera camera = render::NamedCamera("three_quarter", scene);
  camera.position += box.center() - camera.target;
  camera.target = box.center();
  const double widest = camera.vertical_fov_rad;
  const auto fits = [&] {
    constexpr double kAround = 0.2;  // m, from the joints to skin, top of the head, finger tips
    return std::all_of(person.links.begin(), person.links.end(), [&](const urdf::Pose& link) {
      const render::Projected at = render::Project(link.position, camera, view.width, view.height);
      const double around = kAround * at.px_per_m;
      return at.x_px >= around && at.x_px <= view.width - around && at.y_px >= around &&
             at.y_px <= view.height - around;
    });
  };
  for (int percent = 30; percent < 180; percent += 2) {
    camera.vertical_fov_rad = 0.01 * percent * widest;
    if (fits()) break;
  }
  return camera;
}

// Of the moment's joint with its direction, then the highest others at that time.
std::string RatiosOf(const PersonState& person, const WorstMoment& moment) {
  const std::size_t first = moment.joint;
  std::vector<std::size_t> joints;
  for (std::size_t i = 0; i < person.loads.size(); ++i) {
    const JointLoad& load = person.loads[i];
    if (load.band != LoadClass::kUnknown && std::isfinite(load.ratio)) joints.push_back(i);
  }
  std::stable_sort(joints.begin(), joints.end(), [&](std::size_t a, std::size_t b) {
    if ((a == first) != (b == first)) return a == first;
    return person.loads[a].ratio > person.loads[b].ratio;
  });
  if (joints.size() > kCaptionJoints) joints.resize(kCaptionJoints);
  std::string text;
  for (const std::size_t joint : joints) {
    const JointLoad& load = person.loads[joint];
    const bool is_in_title = joint == first && !moment.is_of_compression;
    text += fmt::format("{}{}{:.2f}{}", text.empty() ? "" : ", ",
                        is_in_title ? "" : JointWord(joint) + " ", load.ratio,
                        load.ratio > 1 ? "‡" : "");
    if (joint != first || load.channel.empty()) continue;
    text += fmt::format(" ({}", load.channel);
    if (!load.is_of_compression && std::isfinite(load.capacity)) {
      text += fmt::format(", {:.0f} of {:.0f} N·m", std::abs(load.deciding_moment), load.capacity);
    }
    text += ")";
  }
  return text;
}

}  // namespace

std::vector<ReportPicture> DrawWorstPostures(const LoadTrial& trial, render::Renderer& renderer) {
  const render::PictureSpec view = {420, 480, 2, {}, false};
  std::vector<ReportPicture> pictures;
  for (const WorstMoment& moment : trial.WorstPostures(kPostures)) {
    if (StopRequested()) throw std::runtime_error("interrupted; the report was not written");
    SceneState scene = SceneWithOnly(trial.newest().character, *moment.scene);
    PersonState& person = scene.people.front();
    for (JointLoad& load : person.loads) {
      load.shown_ratio = load.ratio;
      load.load_class = load.band;
    }
    const std::vector<std::uint8_t> png =
        render::EncodePng(renderer.Render(scene, CloseUp(scene, person, view), view));
    ReportPicture picture;
    picture.url = DataUrl("image/png", {reinterpret_cast<const char*>(png.data()), png.size()});
    const double secs = trial.SecsOf(person.sample.stamp_nanos);
    if (moment.is_of_compression) {
      picture.title = fmt::format("{:.2f} s, highest compression, {:.0f} N.", secs,
                                  person.forces.lumbar->compression);
    } else {
      const bool is_peak = moment.ratio == trial.exposure().Of(moment.joint).peak_ratio;
      picture.title = fmt::format("{:.2f} s, {}{}.", secs, JointWord(moment.joint),
                                  is_peak ? " at its peak" : "");
    }
    picture.lines = RatiosOf(person, moment);
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace kinescope::app
