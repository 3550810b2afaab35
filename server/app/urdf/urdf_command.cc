// `kinescope urdf`: writes the URDF of a person; checks and draws any URDF.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"
#include "render/image/new_file.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/app/urdf/person_export.h"
#include "server/app/urdf/skin_export.h"
#include "server/app/urdf/urdf_picture.h"
#include "server/app/urdf/urdf_report.h"
#include "server/body/body_meshes.h"
#include "server/options/option_list.h"
#include "server/scene/robot_source.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"
#include "server/source/open_source.h"
#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/robot_model.h"
#include "urdf/robot/urdf_check.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Model = std::shared_ptr<const PersonModel>;

struct WriteOptions {
  options::Text source, out, package;
  options::Optional<options::Number> time{options::Number(0, {0, kLatestSecs, "s"})};
  options::Flag no_skeleton, gazebo;
  PersonOptions person;

  void List(options::OptionList& option) {
    option("source", source,
           "person to write: " + SourceKinds() + "; default: the default body of --height");
    option(
        "out", out,
        "FILE.urdf; FILE.glb for the skin with its skeleton, in the bind pose or that of --time; "
        "or a folder for person.urdf and meshes/; default, and -: standard output");
    option("time", time,
           "time after the first sample whose posture a FILE.glb shows; not given: the bind pose");
    option("no_skeleton", no_skeleton,
           "write the surface without bones and weights to FILE.glb, for viewers without skinning");
    option("package", package,
           "name of the ROS package that the folder is: meshes are written as package://NAME/...");
    option("gazebo", gazebo,
           "give every link a mass, taken from its segment: Gazebo ignores links without mass and "
           "their children");
    person.List(option);
  }
};

struct UrdfCheckOptions {
  options::Text file;
  options::Flag json;
  options::Texts package_path;

  void List(options::OptionList& option) {
    option("file", file, "URDF to check");
    option("json", json, "print one JSON object with every problem");
    option("package_path", package_path, kPackagePathHelp);
  }
};

// Remembers whose segment lengths a source has sent.
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

// A suit sends lengths every few seconds; before, all people would have those of the default body.
Model LiveModel(const std::string& url, const SceneOptions& options) {
  constexpr int kPatienceSecs = 10;
  constexpr std::int64_t kMasterPatienceNanos = 3 * kNanosPerSecond;  // as of every start
  const std::int64_t begin = MonotonicNanos();
  const auto source = OpenSource(url);
  std::shared_ptr<const SceneState> state;
  SceneBuilder builder(options, url, 0, [&](const auto& newest) { state = newest; });
  builder.Start();
  DescribedPeople described(builder);
  spdlog::info("waiting up to {} s for a person from {}", kPatienceSecs, source->description());
  const std::int64_t end = MonotonicNanos() + kPatienceSecs * kNanosPerSecond;
  bool has_ended = false;
  while (!has_ended && !StopRequested() && MonotonicNanos() < end) {
    has_ended = source->Poll(std::chrono::milliseconds(50), described) == Source::State::kEnded;
    for (const PersonState& person : state->people) {
      if (described.Has(person.character)) return person.model;
    }
    const bool is_time_to_look = MonotonicNanos() - begin > kMasterPatienceNanos;
    if (is_time_to_look && HindranceOf(url, *source).is_for_long) break;
  }
  const std::string missing = HindranceOf(url, *source).text;
  if (!missing.empty()) throw SourceError("source '" + url + "': " + missing);
  const char* const way_out =
      StartsWith(url, "ros:") ? "start the bridge of a person" : "switch on Scaling Data in MVN";
  throw SourceError(
      fmt::format("source '{}': no person with poses and segment lengths received within {} s; "
                  "{}, and check the stream with `kinescope inspect`",
                  url, kPatienceSecs, way_out));
}

// Without a source, the default body.
Model ModelOf(const std::string& source, const SceneOptions& scene) {
  if (source.empty()) {
    const auto to_nobody = [](const std::shared_ptr<const SceneState>&) {};
    return SceneBuilder(scene, "", 0, to_nobody).InitialModel();
  }
  if (IsLiveUrl(source)) return LiveModel(source, scene);
  SceneReader reader(source, scene);
  const auto state = reader.Next();
  if (!state) throw SourceError("source '" + source + "' contains no sample");
  return state->people.front().model;
}

// Of the first person of that moment; between samples too.
PersonState PersonAt(const std::string& source, double secs, const SceneOptions& scene) {
  const std::string option = fmt::format("--time={}", secs);
  if (source.empty()) {
    throw UsageError(option + ": needs a source, such as demo:lift or a recording");
  }
  CheckReach(option, secs, source);
  SceneReader reader(source, scene);
  SceneTimeline timeline(reader);
  auto state = timeline.At(secs);
  if (!state) {
    throw UsageError(fmt::format("{}: {} ends before this time, at {:.3f} s", option, source,
                                 timeline.NewestSecs()));
  }
  if (state->people.empty()) {
    throw UsageError(fmt::format("{}: {} has no person at this time", option, source));
  }
  return std::move(state->people.front());
}

// A name that ends as a URDF does is a file, anything else a folder.
bool IsFileName(const fs::path& out) {
  return out.extension() == ".urdf" || out.extension() == ".xml";
}

// True if there are meshes in it.
bool WriteFolder(urdf::HumanModel human, const BodyAppearance& appearance,
                 const WriteOptions& options) {
  PersonFiles files;
  if (appearance.is_smooth) files.body = BodyMeshFiles(human, appearance.custom.get());
  if (appearance.tools) {
    files.tools = ToolMeshFiles(*appearance.tools, human.skeleton);
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      human.tools.set(side, (*appearance.tools)[side].has_value());
    }
  }
  ExportPerson(std::move(human), files, *options.out, *options.package);
  return !files.body.empty() || !files.tools.empty();
}

void WriteFile(const std::string& out, const std::string& content) {
  try {
    render::WriteNewFile(out, content);
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("--out={}: {}", out, error.what()));
  }
  Print("{}: written\n", out);
}

void WriteSkin(const WriteOptions& options) {
  if (!options.package->empty() || *options.gazebo) {
    throw UsageError("--out=" + *options.out + ": a skin has no --package and no --gazebo");
  }
  const SceneOptions scene = ToSceneOptions(options.person);
  const auto check = [&](const PersonModel& model) {
    if (model.has_built_in_surface) return;
    throw UsageError("--out=" + *options.out +
                     ": only the built-in body has a skin; expected --body_model smooth");
  };
  if (options.time) {
    const PersonState person = PersonAt(*options.source, *options.time, scene);
    check(*person.model);
    return WriteFile(*options.out, PosedSkinGlbOf(person, !*options.no_skeleton));
  }
  const Model model = ModelOf(*options.source, scene);
  check(*model);
  WriteFile(*options.out, SkinGlbOf(*model, !*options.no_skeleton));
}

void Write(const WriteOptions& options) {
  if (fs::path(*options.out).extension() == ".glb") return WriteSkin(options);
  if (options.time) {
    throw UsageError(
        fmt::format("--time={}: needs --out FILE.glb; a URDF has no posture", *options.time));
  }
  if (*options.no_skeleton) throw UsageError("--no_skeleton: needs --out FILE.glb");
  const bool is_folder = !options.out->empty() && !IsFileName(*options.out);
  if (!options.package->empty() && !is_folder) {
    throw UsageError("--package=" + *options.package +
                     ": needs --out FOLDER, the folder of the package");
  }
  const bool looks_like_file = fs::path(*options.out).has_extension() && !fs::exists(*options.out);
  if (is_folder && looks_like_file) {
    throw UsageError(
        "--out=" + *options.out +
        ": expected NAME.urdf, NAME.xml, NAME.glb, or a folder (a new folder has no point in its "
        "name)");
  }
  if (is_folder && fs::is_regular_file(*options.out)) {
    throw UsageError("--out=" + *options.out +
                     ": this file exists and is not a URDF; expected a folder or NAME.urdf");
  }
  if (is_folder) {
    const SceneOptions scene = ToSceneOptions(options.person);
    urdf::HumanModel human = ModelOf(*options.source, scene)->human;
    human.mass_inside_joints = *options.gazebo;
    const bool has_meshes = WriteFolder(std::move(human), scene.appearance, options);
    Print("{}: person.urdf{}\n", *options.out, has_meshes ? " and its meshes" : "");
    return;
  }
  SceneOptions scene = ToShownSceneOptions(options.person);
  UseMeshFiles(MeshCache::Lifetime::kUser, scene);
  const auto model = ModelOf(*options.source, scene);
  if (model->mesh_files) model->mesh_files->Provide();
  urdf::HumanModel human = model->human;
  human.mass_inside_joints = *options.gazebo;
  const std::string xml = urdf::WriteUrdf(human);
  if (options.out->empty()) {
    PrintText(stdout, xml);
    return;
  }
  WriteFile(*options.out, xml);
}

// With the meshes that are on web servers; of a file that is no URDF, which the check will say,
// there are none.
urdf::MeshSearch SearchForCheck(const UrdfCheckOptions& options, const std::string& xml) {
  try {
    return SearchFor(urdf::ParseUrdf(xml), *options.file, *options.package_path);
  } catch (const urdf::UrdfError&) {
    return urdf::MakeMeshSearch(*options.file, *options.package_path);
  }
}

bool Check(const UrdfCheckOptions& options) {
  const std::string xml = ReadUrdfFile(*options.file);
  const urdf::UrdfReport report = urdf::CheckUrdf(xml, SearchForCheck(options, xml));
  PrintText(stdout, *options.json ? UrdfReportJson(*options.file, report)
                                  : UrdfReportText(*options.file, report));
  return report.is_usable();
}

Command CheckCommand() {
  const auto values = std::make_shared<UrdfCheckOptions>();
  Command command;
  command.name = "check";
  command.about = "Checks a URDF and reports errors with line numbers";
  values->List(command.options);
  command.positionals = {"file"};
  command.required = {"file"};
  command.footer = "Exit code: 0 usable, 1 not usable, 2 error.";
  command.run = [values](options::OptionList&) { return Check(*values) ? 0 : 1; };
  return command;
}

Command PictureCommand() {
  const auto values = std::make_shared<UrdfPictureOptions>();
  Command command;
  command.name = "picture";
  command.about = "Draws any robot";
  values->List(command.options);
  command.positionals = {"file"};
  command.required = {"file", "out"};
  command.run = [values](options::OptionList&) {
    DrawUrdf(*values);
    return 0;
  };
  return command;
}

}  // namespace

Command UrdfCommand() {
  const auto values = std::make_shared<WriteOptions>();
  Command command = CommandNamed("urdf");
  values->List(command.options);
  command.positionals = {"source"};
  command.run = [values](options::OptionList&) {
    if (*values->out == "-") values->out = std::string();
    Write(*values);
    return 0;
  };
  command.parts.push_back(CheckCommand());
  command.parts.push_back(PictureCommand());
  return command;
}

}  // namespace kinescope::app
