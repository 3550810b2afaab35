// `kinescope urdf`: the URDF of a person, and a look at anybody's.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "server/app/commands.h"
#include "server/app/option_list.h"
#include "server/app/options.h"
#include "server/app/pipeline_options.h"
#include "server/app/scene_reader.h"
#include "urdf/robot_model.h"

namespace kinescope::app {
namespace {

struct UrdfOptions {
  std::string source;
  std::string out;
  std::string file;  // of check
  PersonOptions person;
};

void Write(const UrdfOptions& options) {
  // A person without a source is the default body, of the height asked for.
  const std::string source = options.source.empty() ? "demo:n_pose" : options.source;
  SceneOptions scene = ToSceneOptions(options.person, SceneOptions().stale_secs);
  SceneReader reader(source, scene);
  const auto state = reader.Next();
  if (!state) throw SourceError("source '" + source + "' has no frame");
  urdf::HumanModel human = state->people.front().model->human;
  if (options.source.empty()) {
    human.skeleton = urdf::DefaultSkeleton(scene.height_m);
    human.body = urdf::MakeBodyParameters(scene.body, human.skeleton);
    human.mesh_folder.clear();
  }
  const std::string xml = urdf::WriteUrdf(human);
  if (options.out.empty()) {
    fmt::print("{}", xml);
    return;
  }
  std::ofstream file(options.out, std::ios::binary);
  file << xml << std::flush;
  if (!file) throw UsageError("--out=" + options.out + ": cannot be written");
}

bool Check(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw UsageError("file '" + path + "': not there, or it may not be read");
  const std::string xml((std::istreambuf_iterator<char>(file)), {});
  try {
    const urdf::RobotModel robot = urdf::ParseUrdf(xml);
    double mass = 0;
    for (const urdf::Link& link : robot.links) mass += link.mass;
    fmt::print("{}: robot '{}', root '{}', {} links, {} joints, {:.3f} kg\n", path, robot.name,
               robot.root_link, robot.links.size(), robot.joints.size(), mass);
    return true;
  } catch (const urdf::UrdfError& error) {
    fmt::print(stderr, "{}: {}\n", path, error.what());
    return false;
  }
}

}  // namespace

void AddUrdf(CommandLine line) {
  CLI::App* command =
      line.app.add_subcommand("urdf", "Write the URDF of a person; `urdf check FILE` reads one");
  const auto o = std::make_shared<UrdfOptions>();
  command->add_option("--source", o->source, "whose; default: the default body of --height");
  command->add_option("--out", o->out, "file to write; default: standard output");
  o->person.Visit(FlagAdder(*command));
  CLI::App* check = command->add_subcommand("check", "Read a URDF and say what is in it");
  check->add_option("file", o->file)->required();
  int& exit_code = line.exit_code;
  check->callback([o, &exit_code] { exit_code = Check(o->file) ? 0 : 1; });
  command->callback([o, check] {
    if (!check->parsed()) Write(*o);
  });
}

}  // namespace kinescope::app
