#include "server/ros/description_parameters.h"

#include <ros/names.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "urdf/human_urdf.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

constexpr char kDescription[] = "robot_description";
// A stream may change the body with every sample. Each one that is described has its meshes
// written, so the newest one follows after this time.
constexpr std::int64_t kDescribeEveryNanos = kNanosPerSecond;

// A name of this computer that means another one to others.
bool IsLoopback(const std::string& host) {
  return host == "localhost" || host == "::1" || StartsWith(host, "127.");
}

}  // namespace

void DescriptionParameters::Forget() {
  described_.clear();
  names_.clear();
  told_.clear();
}

// Whether another program has set it. What a Kinescope has written is taken for our own.
bool DescriptionParameters::IsOthers(const std::string& parameter, bool& answers) {
  XmlRpcValue arguments;
  arguments[0] = ros::names::resolve(parameter);
  MasterReply has = master_.Call("hasParam", arguments);
  answers = has.code == MasterReply::Code::kGood;
  if (!answers || has.value.getType() != XmlRpcValue::TypeBoolean) return answers;
  if (!static_cast<bool>(has.value)) return false;
  MasterReply set = master_.Call("getParam", arguments);
  if (set.code == MasterReply::Code::kNoAnswer && set.problem.empty()) answers = false;
  if (set.code != MasterReply::Code::kGood) return true;  // one that is too large, for example
  if (set.value.getType() != XmlRpcValue::TypeString) return true;
  return !urdf::IsWrittenByKinescope(static_cast<std::string&>(set.value));
}

// The Kinescope that runs beside this one and has its person in it; "": none.
std::string DescriptionParameters::OwnerOf(const std::string& parameter) {
  for (const RunningNode& node : OtherNodes()) {
    for (const RunningPerson& person : node.people) {
      if (person.description == ros::names::resolve(parameter)) return node.name;
    }
  }
  return "";
}

// The parameter of a URDF at this master; nullopt: the master does not answer. A robot keeps its
// own, or gets it back if it is started after us.
std::optional<std::string> DescriptionParameters::DescriptionOf(const std::string& prefix) {
  if (prefix.empty() && !config_.description.empty()) {
    return names_[prefix] = config_.description;
  }
  const auto known = names_.find(prefix);
  if (known != names_.end()) {
    bool answers = true;
    const bool is_others = described_.count(known->second) != 0 && IsOthers(known->second, answers);
    if (!answers) return std::nullopt;
    if (!is_others) return known->second;
    described_.erase(known->second);
    names_.erase(known);
  }
  const std::string usual = prefix + kDescription;
  std::string owner;  // of that; "": this node, or no Kinescope
  for (const std::string& name :
       {usual, prefix + "human_description", "~" + prefix + "human_description"}) {
    bool answers = true;
    const bool is_others = IsOthers(name, answers);
    if (!answers) return std::nullopt;
    const std::string node = is_others ? "" : OwnerOf(name);
    if (name == usual) owner = node;
    if (is_others || !node.empty()) continue;
    if (name != usual) {
      // A monitor has the people of other nodes: that is no conflict.
      spdlog::log(
          !owner.empty() && config_.people_are_of_graph ? spdlog::level::info : spdlog::level::warn,
          "the parameter {} belongs to {} and stays as it is: the URDF of the person "
          "is in {} (--description sets another name)",
          ros::names::resolve(usual), owner.empty() ? "another program" : "the Kinescope " + owner,
          ros::names::resolve(name));
    }
    return names_[prefix] = name;
  }
  return names_[prefix] = "~" + prefix + "human_description";
}

// RViz on another computer cannot read the files of this one.
std::string DescriptionParameters::UrdfOf(const PersonModel& model) const {
  if (!model.mesh_files) return model.urdf_xml;
  const std::string& host = ros::network::getHost();
  const std::string& folder =
      model.human.mesh_folder.empty() ? model.human.tool_folder : model.human.mesh_folder;
  const std::string set = folder.substr(folder.rfind('/') + 1);
  const int port =
      config_.serve_meshes && !IsLoopback(host) ? config_.serve_meshes(set, model.mesh_files) : 0;
  if (port == 0) {
    model.mesh_files->Provide();
    return model.urdf_xml;
  }
  urdf::HumanModel human = model.human;
  for (std::string* const place : {&human.mesh_folder, &human.tool_folder}) {
    if (!place->empty()) *place = fmt::format("http://{}:{}/{}", host, port, set);
  }
  return urdf::WriteUrdf(human);
}

// Stops at the first that the master does not accept; the rest is tried again next time.
void DescriptionParameters::Set(const Models& models, bool has_met_nobody) {
  if (has_met_nobody && config_.initial_model) {
    const std::optional<std::string> name = DescriptionOf("");
    if (!name) return;
    if (described_.count(*name) == 0) {
      if (!master_.SetParameter(*name, UrdfOf(*config_.initial_model))) return;
      described_[*name] = {0, 0, config_.initial_model->mesh_files};
    }
  }
  std::map<std::string, std::string> names_of_models;
  if (models.empty() && config_.initial_model) {
    names_of_models[""] = config_.initial_model->human.model_name;
  }
  for (const auto& [prefix, model] : models) {
    const std::optional<std::string> name = DescriptionOf(prefix);
    if (!name) return;
    names_of_models[prefix] = model->human.model_name;
    const auto set = described_.find(*name);
    const std::int64_t now = MonotonicNanos();
    if (set != described_.end() && (set->second.revision == model->revision ||
                                    now - set->second.set_nanos < kDescribeEveryNanos)) {
      continue;
    }
    if (!master_.SetParameter(*name, UrdfOf(*model))) return;
    described_[*name] = {model->revision, now, model->mesh_files};
  }
  TellWhatIsPublished(names_of_models);
}

// For programs that show it (running.h). `models`: by prefix.
void DescriptionParameters::TellWhatIsPublished(const std::map<std::string, std::string>& models) {
  XmlRpcValue published, people;
  people.setSize(static_cast<int>(models.size()));
  int i = 0;
  for (const auto& [prefix, model] : models) {
    XmlRpcValue& person = people[i++];
    person["model"] = model;
    person["description"] = ros::names::resolve(names_[prefix]);
    person["topics"] = ros::this_node::getName() + "/" + prefix;
  }
  published["reference_frame"] = config_.reference_frame;
  published["tf"] = config_.tf;
  published["people"] = people;
  const std::string text = published.toXml();
  if (text == told_ || !master_.SetParameter("~published", published)) return;
  told_ = text;
  if (config_.tf != "none") WarnOfTheSameFrames(models);
}

// The other Kinescope nodes; none if the master has just gone.
std::vector<RunningNode> DescriptionParameters::OtherNodes() {
  std::vector<RunningNode> nodes;
  try {
    nodes = FindRunningNodes();
  } catch (const UsageError&) {
  }
  const auto is_this = [](const RunningNode& node) {
    return node.name == ros::this_node::getName();
  };
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(), is_this), nodes.end());
  return nodes;
}

// A frame with two publishers jumps between two poses.
void DescriptionParameters::WarnOfTheSameFrames(const std::map<std::string, std::string>& models) {
  for (const RunningNode& node : OtherNodes()) {
    if (!node.has_frames) continue;
    for (const RunningPerson& person : node.people) {
      const bool is_same = std::any_of(models.begin(), models.end(), [&](const auto& ours) {
        return ours.second == person.model;
      });
      if (!is_same || !twins_.insert(node.name).second) continue;
      spdlog::warn(
          "the node {} publishes the frames of a person called {}, too: in TF that person jumps "
          "between two poses; start one of the nodes with another --model_name, or with --tf=none",
          node.name, person.model);
    }
  }
}

}  // namespace kinescope::ros_bridge
