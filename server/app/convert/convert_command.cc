// `kinescope convert`: a motion from any source into files for other programs.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/not_source.h"
#include "core/system/stop_signal.h"
#include "core/system/words.h"
#include "server/app/commands.h"
#include "server/app/convert/beginning_rate.h"
#include "server/app/convert/frame_index.h"
#include "server/app/convert/motion_file.h"
#include "server/app/print.h"
#include "server/app/progress.h"
#include "server/options/option_json.h"
#include "server/options/option_list.h"
#include "server/scene/new_samples.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"
#include "server/source/scheme.h"
#include "server/source/source_identity.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

// How long a motion is looked at before its files begin.
constexpr std::int64_t kOutlineNanos = kNanosPerSecond;
constexpr std::size_t kOutlineStates = 4096;

std::vector<std::string> NamesOfQuantities() {
  std::vector<std::string> names;
  for (const auto& [name, quantity] : QuantityNames()) names.push_back(name);
  return names;
}

Quantity ParseQuantity(const std::string& text) {
  for (const auto& [name, quantity] : QuantityNames()) {
    if (name == text) return quantity;
  }
  throw options::BadValue("expected " + Alternatives(NamesOfQuantities()),
                          SuggestionFor(text, NamesOfQuantities()));
}

// A file has no colours and no meshes.
void RemoveUnused(options::OptionList& list) {
  list.Remove(
      {"model_name", "body_model", "tool", "mesh_units", "mesh_up", "mesh_scale", "mesh_frame"});
}

struct ConvertOptions {
  options::Text source;
  options::Texts out{MotionFormatNames()};
  options::Choice<TableLayout> layout{{{"wide", TableLayout::kWide}, {"long", TableLayout::kLong}},
                                      TableLayout::kWide};
  options::List<Quantity> quantities{"some of " + Alternatives(NamesOfQuantities()),
                                     kQuantityCount,
                                     ParseQuantity,
                                     {},
                                     NamesOfQuantities()};
  options::Optional<options::Number> seconds{options::Number(0, {0, kLatestSecs, "s", true})};
  options::Number rate_hz{kSubjectRateHz, {1, 1000, "Hz"}};
  PersonOptions person;
  LoadOptions loads;

  void List(options::OptionList& option) {
    option("source", source, "source of the motion: " + SourceKinds());
    option("out", out, "file to write; may be repeated: all are written in one pass");
    option.Group("Tables");
    option("layout", layout, "a row per sample, or a row per value");
    option("quantities", quantities, "what the table has; default: all that the source has");
    option.Group("Motion");
    option("seconds", seconds,
           "length of the motion to convert; default: all (demo: and pose: 10 s; a stream: until "
           "Ctrl-C)");
    option("rate_hz", rate_hz, "sample rate of the built-in subject");
    person.List(option);
    loads.List(option);
    RemoveUnused(option);
    for (const char* name : {"layout", "quantities"}) {
      option.HasNoEffect(name, "without a table (.csv)", [this] { return !HasTable(); });
    }
    for (const std::string& name : WrenchOptionNames()) {
      option.HasNoEffect(name, "with a live stream, whose sensors come over ROS",
                         [this] { return IsLiveUrl(*source); });
    }
    option.HasNoEffect("rate_hz", "with a source other than demo: and pose:", [this] {
      return !IsSubjectUrl(*source);
    });
  }

  bool HasTable() const {
    return std::any_of(out->begin(), out->end(), [](const std::string& path) {
      return fs::path(path).extension() == ".csv";
    });
  }
};

void CheckOutputs(const ConvertOptions& options) {
  std::vector<fs::path> taken;
  for (const std::string& path : *options.out) {
    if (FindMotionFormat(path) == nullptr) {
      throw UsageError(
          fmt::format("--out={}: expected a name that ends in {}", path, MotionFormatNames()));
    }
    CheckIsNotSource(*options.source, path, "--out=" + path);
    const fs::path place = PlaceOfOutput(path);
    if (std::find(taken.begin(), taken.end(), place) != taken.end()) {
      throw UsageError("--out=" + path + " is given twice; give each output its own name");
    }
    taken.push_back(place);
    const OutputFile probe(path);  // a folder that takes no file is known before the work
  }
}

// Everything that decides the content of the files.
nlohmann::ordered_json ProvenanceOf(ConvertOptions& options) {
  options::OptionList list;
  options.person.List(list);
  options.loads.List(list);
  RemoveUnused(list);
  nlohmann::ordered_json values = options::ValuesOf(list);
  if (options.seconds) values["seconds"] = *options.seconds;
  if (IsSubjectUrl(*options.source)) values["rate_hz"] = *options.rate_hz;
  return {{"program", "kinescope " KINESCOPE_VERSION},
          {"command", "convert"},
          {"source", ToJson(IdentityOf(*options.source))},
          {"inputs", options::InputsOf(list)},
          {"options", values}};
}

SourceSettings SettingsOf(const ConvertOptions& options) {
  SourceSettings settings;
  settings.subject_rate_hz = *options.rate_hz;
  return settings;
}

class Conversion {
 public:
  explicit Conversion(ConvertOptions& options)
      : options_(options),
        provenance_(ProvenanceOf(options)),
        reader_(SceneReader::OfAnySource(
            *options.source, ToSceneOptions(options.person, options.loads), SettingsOf(options))) {
    if (options_.seconds) {
      CheckReach(fmt::format("--seconds={}", *options_.seconds), *options_.seconds,
                 *options_.source);
      length_ = *options_.seconds;
    } else if (IsSubjectUrl(*options_.source)) {
      length_ = kSubjectClipSecs;
    }
  }

  void Run() {
    if (reader_.is_live()) {
      spdlog::info("reading {}; Ctrl-C completes {}", reader_.description(),
                   options_.out->size() == 1 ? "the file" : "the files");
    }
    {
      const double expected = length_.value_or(0) * reader_.rate_hz();
      Progress progress("samples:", static_cast<int>(std::ceil(expected)));
      while (const auto scene = reader_.Next()) {
        if (!reader_.is_live() && StopRequested()) {
          throw std::runtime_error("interrupted; nothing was written");
        }
        if (!begin_nanos_) begin_nanos_ = scene->stamp_nanos;
        if (!IsWithinLength(*begin_nanos_, scene->stamp_nanos, length_)) break;
        Take(scene);
        progress.Step();
      }
    }
    if (files_.empty()) Begin();
    for (const auto& file : files_) file->Finish();
  }

  std::vector<std::string> paths() const {
    std::vector<std::string> all;
    for (const auto& file : files_) {
      for (const std::string& path : file->paths()) all.push_back(path);
    }
    return all;
  }

  void PrintSummary() const {
    for (const std::string& path : paths()) Print("{}: written\n", path);
    Print("{}, {}, {:.2f} s{}\n", Counted(samples_, "sample"),
          Counted(people_.size(), "person", "people"), Secs(last_nanos_ - *begin_nanos_),
          rate_hz_ > 0 ? fmt::format(" at {:.6g} Hz", rate_hz_) : "");
    for (const auto& [character, index] : people_) {
      if (index.holes() == 0) continue;
      const FrameIndex::Hole& longest = *index.longest_hole();
      Print("person {}: {} samples are missing in {}; the longest: {:.2f} s after {:.2f} s\n",
            character, index.missing_frames(), Counted(index.holes(), "hole"), longest.secs,
            longest.from_secs);
    }
    for (const auto& file : files_) {
      for (const std::string& note : file->notes()) Print("{}\n", note);
    }
  }

 private:
  void Take(const std::shared_ptr<const SceneState>& scene) {
    if (!files_.empty()) return Add(*scene);
    head_.push_back(scene);
    if (scene->stamp_nanos - *begin_nanos_ >= kOutlineNanos || head_.size() >= kOutlineStates) {
      Begin();
    }
  }

  // All that the files must say before their first sample.
  void Begin() {
    MotionOutline outline;
    outline.source = provenance_.at("source").at("name");
    outline.layout = *options_.layout;
    BeginningRate beginning;
    std::optional<int> first;
    NewSamples fresh;
    for (const auto& scene : head_) {
      for (const PersonState& person : scene->people) {
        if (!fresh.IsNew(person)) continue;
        outline.quantities |= QuantitiesOf(person);
        outline.trackers |= person.sample.has_tracker;
        outline.has_foot_contacts |= person.sample.foot_contacts.has_value();
        if (first.value_or(person.character) != person.character) continue;
        first = person.character;
        beginning.Add(person.sample);
      }
    }
    if (!first) throw SourceError(*options_.source + ": contains no sample of a person");
    counter_step_ = beginning.counter_step();
    rate_hz_ = reader_.rate_hz() > 0 ? reader_.rate_hz() : beginning.rate_hz();
    outline.rate_hz = rate_hz_;
    outline.begin_nanos = *begin_nanos_;
    Choose(outline);
    provenance_["rate_hz"] =
        rate_hz_ > 0 ? nlohmann::ordered_json(rate_hz_) : nlohmann::ordered_json(nullptr);
    outline.provenance = JsonText(provenance_, -1, JsonBytes::kAscii);
    for (const std::string& path : *options_.out) {
      files_.push_back(FindMotionFormat(path)->make(path, outline));
    }
    for (const auto& scene : head_) Add(*scene);
    head_.clear();
  }

  // Those that were asked for; one that the source does not have is an error.
  void Choose(MotionOutline& outline) const {
    if (options_.quantities->empty()) return;
    QuantitySet wanted;
    for (const Quantity quantity : *options_.quantities) {
      const auto index = static_cast<std::size_t>(quantity);
      if (!outline.quantities.test(index)) {
        throw UsageError(fmt::format("--quantities={}: {} has none of them",
                                     QuantityNames()[index].first, *options_.source));
      }
      wanted.set(index);
    }
    outline.quantities = wanted;
  }

  void Add(const SceneState& scene) {
    for (const PersonState& person : scene.people) {
      if (!fresh_.IsNew(person)) continue;
      ++samples_;
      last_nanos_ = person.sample.stamp_nanos;
      const std::int64_t frame = people_.try_emplace(person.character, rate_hz_, counter_step_)
                                     .first->second.Next(person.sample);
      for (const auto& file : files_) file->Add(person, frame);
    }
  }

  ConvertOptions& options_;
  nlohmann::ordered_json provenance_;
  SceneReader reader_;
  std::optional<double> length_;
  std::optional<std::int64_t> begin_nanos_;
  std::vector<std::shared_ptr<const SceneState>> head_;  // before the files begin
  double rate_hz_ = 0;
  double counter_step_ = 1;
  std::vector<std::unique_ptr<MotionFile>> files_;
  NewSamples fresh_;
  std::map<int, FrameIndex> people_;  // by character
  std::uint64_t samples_ = 0;
  std::int64_t last_nanos_ = 0;
};

// Returns the files that were written.
std::vector<std::string> Convert(ConvertOptions& options) {
  CheckOutputs(options);
  Conversion conversion(options);
  conversion.Run();
  conversion.PrintSummary();
  return conversion.paths();
}

}  // namespace

Command ConvertCommand() {
  const auto values = std::make_shared<ConvertOptions>();
  Command command = CommandNamed("convert");
  command.shows_progress = true;
  command.about +=
      "\n  kinescope convert take.pcap --out take.csv --out take.mvnx"
      "\n  kinescope convert udp://:9763 --out live.mvnx      (until Ctrl-C)";
  values->List(command.options);
  command.positionals = {"source"};
  command.required = {"source", "out"};
  command.reads = {"source"};
  // Where a format has a file for each person, only the motion tells their names.
  const auto written = std::make_shared<std::vector<std::string>>();
  command.outputs = [values, written] {
    std::vector<DeclaredOutput> outputs;
    for (const std::string& path : written->empty() ? *values->out : *written) {
      outputs.push_back({"out", path});
    }
    return outputs;
  };
  command.run = [values, written](options::OptionList&) {
    *written = Convert(*values);
    return 0;
  };
  return command;
}

}  // namespace kinescope::app
