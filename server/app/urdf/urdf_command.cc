// `kinescope urdf`: the URDF of a person, and a look at anybody's.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

#include "core/clocks.h"
#include "core/stop_signal.h"
#include "render/new_file.h"
#include "server/app/commands.h"
#include "server/app/urdf/person_export.h"
#include "server/app/urdf/urdf_picture.h"
#include "server/app/urdf/urdf_report.h"
#include "server/body/figure_files.h"
#include "server/options/option_list.h"
#include "server/scene/robot_source.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"
#include "server/source/open_source.h"
#include "urdf/mesh_uri.h"
#include "urdf/urdf_check.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

struct WriteOptions {
  std::string source;
  std::string out;
  std::string package;
  bool gazebo = false;
  PersonOptions person;
};

struct UrdfCheckOptions {
  std::string file;
  bool json = false;
  std::vector<std::string> package_path;
};

// Remembers of whom a source has told the lengths.
class DescribedPeople : public SampleSink {
 public:
  explicit DescribedPeople(SceneBuilder& to) : to_(to) {}
  void OnCharacter(const Character& character) override {
    if (character.skeleton) ids_.insert(character.id);
    to_.OnCharacter(character);
  }
  void OnSample(const BodySample& sample) override { to_.OnSample(sample); }
  void OnObjects(const ObjectsSample& sample) override { to_.OnObjects(sample); }
  bool Has(int id) const { return ids_.count(id) > 0; }

 private:
  SceneBuilder& to_;
  std::set<int> ids_;
};

// A suit tells lengths every few seconds; before, everybody would have those of the default body.
urdf::HumanModel LiveHuman(const std::string& url, const SceneOptions& options) {
  constexpr int kPatienceSecs = 10;
  const auto source = OpenSource(url);
  std::shared_ptr<const SceneState> state;
  SceneBuilder builder(options, url, 0, [&](const auto& newest) { state = newest; });
  builder.Start();
  DescribedPeople described(builder);
  spdlog::info("waiting up to {} s for a person from {}", kPatienceSecs, source->description());
  const std::int64_t end = MonotonicNanos() + std::int64_t{kPatienceSecs} * 1'000'000'000;
  bool has_ended = false;
  while (!has_ended && !StopRequested() && MonotonicNanos() < end) {
    has_ended = source->Poll(std::chrono::milliseconds(50), described) == Source::State::kEnded;
    for (const PersonState& person : state->people) {
      if (described.Has(person.character)) return person.model->human;
    }
  }
  throw SourceError(
      fmt::format("source '{}': no person with poses and segment lengths came within {} s (a suit "
                  "has to send scale data; `kinescope inspect` says what comes)",
                  url, kPatienceSecs));
}

// Without a source, the default body.
urdf::HumanModel HumanOf(const std::string& source, const SceneOptions& scene) {
  if (source.empty()) {
    const auto to_nobody = [](const std::shared_ptr<const SceneState>&) {};
    return SceneBuilder(scene, "", 0, to_nobody).InitialModel()->human;
  }
  if (IsLiveUrl(source)) return LiveHuman(source, scene);
  SceneReader reader(source, scene);
  const auto state = reader.Next();
  if (!state) throw SourceError("source '" + source + "' has no frame");
  return state->people.front().model->human;
}

// A name that ends as a URDF does is a file, anything else a folder.
bool IsFileName(const fs::path& out) {
  return out.extension() == ".urdf" || out.extension() == ".xml";
}

void Write(const WriteOptions& options) {
  const bool is_folder = !options.out.empty() && !IsFileName(options.out);
  if (!options.package.empty() && !is_folder) {
    throw UsageError("--package=" + options.package + ": needs --out FOLDER, the package");
  }
  if (is_folder && fs::is_regular_file(options.out)) {
    throw UsageError("--out=" + options.out + ": is a file; name a folder, or a file *.urdf");
  }
  const SceneOptions scene = ToSceneOptions(options.person, SceneOptions().stale_secs);
  urdf::HumanModel human = HumanOf(options.source, scene);
  human.mass_inside_joints = options.gazebo;
  if (is_folder) {
    PersonFiles files;
    if (scene.smooth_figure) files.figure = FigureFiles(human, scene.figure_meshes.get());
    if (scene.tools) files.tools = ToolFiles(*scene.tools, human.skeleton);
    ExportPerson(human, files, options.out, options.package);
    const bool has_meshes = !files.figure.empty() || !files.tools.empty();
    fmt::print("{}: person.urdf{}\n", options.out, has_meshes ? " and its meshes" : "");
    return;
  }
  const std::string xml = urdf::WriteUrdf(human);
  if (options.out.empty()) {
    fmt::print("{}", xml);
    return;
  }
  try {
    render::WriteNewFile(options.out, xml);
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("--out={}: {}", options.out, error.what()));
  }
}

bool Check(const UrdfCheckOptions& options) {
  const urdf::UrdfReport report = urdf::CheckUrdf(
      ReadUrdfFile(options.file), urdf::MakeMeshSearch(options.file, options.package_path));
  fmt::print("{}", options.json ? UrdfReportJson(options.file, report)
                                : UrdfReportText(options.file, report));
  return report.is_usable();
}

constexpr char kPackagePathHelp[] =
    "folder with packages, for package:// names; may be given again. Before $ROS_PACKAGE_PATH";

void AddCheck(CLI::App& urdf, int& exit_code) {
  CLI::App* command =
      urdf.add_subcommand("check", "What is in a URDF, and what is wrong with it, with lines");
  const auto o = std::make_shared<UrdfCheckOptions>();
  command->add_option("file", o->file, "a URDF")->required();
  command->add_flag("--json", o->json, "one JSON object with every problem");
  command->add_option("--package-path", o->package_path, kPackagePathHelp)->allow_extra_args(false);
  command->footer("Exit code: 0 usable, 1 something is wrong, 2 it could not be read.");
  command->callback([o, &exit_code] { exit_code = Check(*o) ? 0 : 1; });
}

void AddPicture(CLI::App& urdf) {
  CLI::App* command = urdf.add_subcommand("picture", "Any robot as a picture");
  const auto o = std::make_shared<UrdfPictureOptions>();
  command->add_option("file", o->file, "a URDF")->required();
  command->add_option("--out", o->out, "file to write, .png")->required();
  o->view.Visit(FlagAdder(*command));
  o->backend.Visit(FlagAdder(*command));
  command->add_option("--joint", o->joints, "NAME=RADIANS (or metres); may be given again")
      ->allow_extra_args(false);
  command->add_option("--package-path", o->package_path, kPackagePathHelp)->allow_extra_args(false);
  command->add_flag("--json", o->json,
                    "tell the result as JSON: the camera, and each mesh that is missing");
  command->callback([o] { DrawUrdf(*o); });
}

}  // namespace

void AddUrdf(CommandLine line) {
  CLI::App* command = line.app.add_subcommand(
      "urdf",
      "Write the URDF of a person; `urdf check FILE` looks for faults in one, `urdf picture FILE` "
      "draws one");
  const auto o = std::make_shared<WriteOptions>();
  command->add_option("--source,source", o->source, "whose; default: the default body of --height");
  command->add_option(
      "--out", o->out,
      "FILE.urdf, or a folder for person.urdf and meshes/; default: standard output");
  command->add_option("--package", o->package,
                      "the folder is the ROS package of this name: meshes are package://NAME/...");
  command->add_flag("--gazebo", o->gazebo,
                    "let every link weigh something, at the cost of its segment: Gazebo leaves out "
                    "links without mass, and with them what hangs on them");
  o->person.Visit(FlagAdder(*command));
  AddCheck(*command, line.exit_code);
  AddPicture(*command);
  command->callback([o, command] {
    if (command->get_subcommands().empty()) Write(*o);
  });
}

}  // namespace kinescope::app
