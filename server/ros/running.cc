#include "server/ros/running.h"

#include <ros/init.h>
#include <ros/names.h>
#include <ros/this_node.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <set>

#include "core/system/errors.h"
#include "server/ros/bridge.h"
#include "server/ros/init.h"
#include "server/ros/master_client.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

constexpr std::chrono::milliseconds kAnswerPatience(500);  // for each node
constexpr char kPublished[] = "/published/reference_frame";

XmlRpcValue Ask(const char* method, const XmlRpcValue& arguments) {
  MasterClient master;
  const MasterReply reply = master.Call(method, arguments);
  if (reply.code == MasterReply::Code::kGood) return reply.value;
  throw UsageError("no ROS master at " + MasterUri() +
                   (reply.problem.empty() ? "" : ": it " + reply.problem) +
                   "; start roscore, or set ROS_MASTER_URI");
}

// "" where there is none, or it is something else.
std::string TextOf(XmlRpcValue& map, const char* member) {
  if (map.getType() != XmlRpcValue::TypeStruct || !map.hasMember(member)) return "";
  XmlRpcValue& value = map[member];
  return value.getType() == XmlRpcValue::TypeString ? static_cast<std::string>(value) : "";
}

std::set<std::string> Topics() {
  XmlRpcValue everywhere;
  everywhere[0] = "";
  XmlRpcValue all = Ask("getPublishedTopics", everywhere);
  std::set<std::string> names;
  if (all.getType() != XmlRpcValue::TypeArray) return names;
  for (int i = 0; i < all.size(); ++i) {
    if (all[i].getType() != XmlRpcValue::TypeArray || all[i].size() < 1) continue;
    if (all[i][0].getType() == XmlRpcValue::TypeString) names.insert(std::string(all[i][0]));
  }
  return names;
}

std::vector<RunningPerson> PeopleOf(XmlRpcValue& published, const std::set<std::string>& topics) {
  std::vector<RunningPerson> people;
  if (!published.hasMember("people")) return people;
  XmlRpcValue& all = published["people"];
  if (all.getType() != XmlRpcValue::TypeArray) return people;
  for (int i = 0; i < all.size(); ++i) {
    const RunningPerson person = {TextOf(all[i], "model"), TextOf(all[i], "description"),
                                  TextOf(all[i], "topics")};
    if (topics.count(person.topics + "joint_loads") != 0) people.push_back(person);
  }
  return people;
}

}  // namespace

std::vector<RunningNode> FindRunningNodes() {
  InitRos();
  const std::set<std::string> topics = Topics();
  XmlRpcValue names = Ask("getParamNames", XmlRpcValue());
  std::vector<RunningNode> nodes;
  if (names.getType() != XmlRpcValue::TypeArray) return nodes;
  for (int i = 0; i < names.size(); ++i) {
    if (names[i].getType() != XmlRpcValue::TypeString) continue;
    const std::string name = names[i];
    const std::string ending = kPublished;
    if (name.size() <= ending.size()) continue;
    const std::string node = name.substr(0, name.size() - ending.size());
    if (node + ending != name) continue;
    XmlRpcValue arguments;
    arguments[0] = node + "/published";
    XmlRpcValue published = Ask("getParam", arguments);
    RunningNode found = {node,
                         TextOf(published, "reference_frame"),
                         TextOf(published, "tf") != "none",
                         topics.count(node + "/view/image_raw") != 0,
                         {}};
    if (found.reference_frame.empty()) continue;
    found.people = PeopleOf(published, topics);
    if (!found.people.empty() && DoesNodeAnswer(node, kAnswerPatience)) nodes.push_back(found);
  }
  return nodes;
}

std::string FullNodeName(const std::string& name) {
  InitRos();
  try {
    return ros::names::resolve(name, /*remap=*/false);
  } catch (const ros::InvalidNameException& error) {
    throw UsageError(std::string("--node: ") + error.what());
  }
}

void WarnOfNamesake() {
  if (ros::isStarted()) return;  // a source of this node has looked
  if (!DoesNodeAnswer(ros::this_node::getName(), kAnswerPatience)) return;
  spdlog::warn(
      "another node is named {}: the ROS master ends it now; to have both, start one with another "
      "name, such as __name:=kinescope_2",
      ros::this_node::getName());
}

}  // namespace kinescope::ros_bridge
