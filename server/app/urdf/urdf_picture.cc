#include "server/app/urdf/urdf_picture.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/scene_extent.h"
#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "render/camera/camera.h"
#include "render/image/png_file.h"
#include "render/renderer.h"
#include "server/app/print.h"
#include "server/picture/camera_json.h"
#include "server/picture/render_planner.h"
#include "server/scene/robot_source.h"

namespace kinescope::app {
namespace {

void PrintPicture(const UrdfPictureOptions& options, const RobotState& robot,
                  const render::Camera& camera, const std::vector<std::string>& problems) {
  if (!*options.json) {
    const std::string boxes =
        problems.empty()
            ? ""
            : fmt::format(", {} mesh files or textures missing or rejected", problems.size());
    Print("{}: robot '{}', {} links{}\n", *options.out, robot.name, robot.model->links.size(),
          boxes);
    return;
  }
  const nlohmann::ordered_json line = {
      {"out", *options.out},
      {"robot", robot.name},
      {"links", robot.model->links.size()},
      {"root_position", XyzList(robot.world_from_link.front().translation())},
      {"bounds", {XyzList(robot.bounds.min()), XyzList(robot.bounds.max())}},
      {"camera", CameraJson(camera)},
      {"problems", problems},
  };
  Print("{}\n", JsonText(line));
}

// The picture shows what was asked for; the robot could not stand like that.
void WarnOutsideLimits(const urdf::RobotModel& model, const urdf::JointPositions& positions) {
  for (const urdf::RobotJoint& joint : model.joints) {
    const auto given = positions.find(joint.name);
    if (given == positions.end() || !joint.limits) continue;
    const auto& [name, position] = *given;
    const bool has_range = joint.type != urdf::RobotJoint::Type::kContinuous;
    if (!has_range || (position >= joint.limits->lower && position <= joint.limits->upper))
      continue;
    spdlog::warn("--joint={}={}: outside the limits of this joint, {:.4g} to {:.4g}", name,
                 position, joint.limits->lower, joint.limits->upper);
  }
}

}  // namespace

void JointsValue::ParseAll(const std::vector<std::string>& texts) {
  urdf::JointPositions positions;
  for (const std::string& text : texts) {
    const auto parts = options::SplitAtLast(text, '=');
    const auto position = parts ? options::ParseNumber(parts->second) : std::nullopt;
    if (!position || parts->first.empty()) RefuseText();
    positions[parts->first] = *position;
  }
  value_ = std::move(positions);
}

std::string JointsValue::ToText() const {
  std::string text;
  for (const auto& [name, position] : value_) {
    text += (text.empty() ? "" : ";") + name + "=" + options::NumberText(position);
  }
  return text;
}

void UrdfPictureOptions::List(options::OptionList& option) {
  option("file", file, "URDF to draw");
  option("out", out, "file to write, .png");
  option("joint", joint, "position of a joint; may be repeated");
  option("package_path", package_path, kPackagePathHelp);
  option("json", json, "print the result as JSON: the camera, and each missing mesh");
  view.List(option);
  option.Remove({"ghost", "ghost_opacity", "trail", "trail_secs", "plot", "orbit", "follow"});
  backend.List(option);
}

void DrawUrdf(const UrdfPictureOptions& options) {
  if (std::filesystem::path(*options.out).extension() != ".png") {
    throw UsageError("--out=" + *options.out + ": expected a name that ends in .png");
  }
  RenderPlanner planner(options.view);
  SceneState scene;
  scene.liveness = Liveness::kLive;
  scene.source = *options.file;
  scene.robots.push_back(ReadRobot(*options.file, *options.package_path, *options.joint));
  RobotState& robot = scene.robots.front();
  for (const std::string& note : robot.model->notes) spdlog::warn("{}: {}", *options.file, note);

  WarnOutsideLimits(*robot.model, *options.joint);

  const auto renderer = StartRenderer(options.backend);
  robot.bounds = renderer->Bounds(robot);
  if (robot.bounds.isEmpty()) {
    throw SourceError(*options.file + ": has no <visual>, so there is nothing to draw");
  }
  StandOnFloor(robot);
  scene.extent = ExtentOf(scene.robots, {});
  const RenderRequest request = planner.Only(scene);
  const render::Image image = renderer->Render(request.state, request.camera, request.spec);
  std::map<std::string, std::string> facts = DrawnBy(*renderer);
  facts["Software"] = "Kinescope " KINESCOPE_VERSION;
  facts["Source"] = std::filesystem::path(*options.file).filename().string();
  facts["Camera"] = options.view.camera.ToText();
  render::WritePng(*options.out, image, facts, request.spec.print.PixelsPerMetre(image.width));
  PrintPicture(options, request.state.robots.front(), request.camera, renderer->problems());
}

}  // namespace kinescope::app
