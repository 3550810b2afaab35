#include <fmt/format.h>

#include <unordered_map>
#include <unordered_set>

#include "urdf/robot/robot_model.h"
#include "urdf/robot/urdf_check_parts.h"

namespace kinescope::urdf {
namespace {

using Kind = UrdfProblem::Kind;

constexpr std::size_t kMaxNamed = 6;  // links of a loop or roots that are listed

// Links are counted from 0; -1: none, or none that exists.
class Tree {
 public:
  Tree(const XmlOutline& xml, UrdfReport& report, std::vector<UrdfProblem>& problems)
      : xml_(xml), report_(report), problems_(problems) {}

  std::vector<bool> Check() {
    for (int at = xml_[0].first_child; at >= 0; at = xml_[at].next_sibling) {
      if (xml_[at].tag == "link") AddLink(at);
    }
    for (int at = xml_[0].first_child; at >= 0; at = xml_[at].next_sibling) {
      if (xml_[at].tag == "joint") AddJoint(at);
    }
    CheckMimics();
    if (report_.links == 0) {
      Say(Kind::kUnreadable, 0, "robot", "it has no <link>", "add at least one <link>");
    } else if (report_.links > kMaxLinks) {
      Say(Kind::kUnreadable, 0, "robot", fmt::format("it has {} links", report_.links),
          fmt::format("at most {} are drawn", kMaxLinks));
    }
    FindRoots();
    FindLoops();
    std::vector<bool> moves(xml_.elements.size(), false);
    for (const Link& link : links_) moves[static_cast<std::size_t>(link.at)] = link.moves;
    return moves;
  }

 private:
  struct Link {
    std::string name;
    int at = 0;       // its element
    int parent = -1;  // link
    int joint = -1;   // element of the joint that it hangs on
    bool moves = false;
  };

  void Say(Kind kind, int at, std::string element, std::string what, std::string suggestion) {
    problems_.push_back(
        {kind, xml_[at].line, std::move(element), std::move(what), std::move(suggestion)});
  }

  const std::string* NameOf(int at, const std::string& tag) {
    const std::string* name = xml_[at].Attribute("name");
    if (name != nullptr && !name->empty()) return name;
    Say(Kind::kUnreadable, at, tag, "it has no name", "write name=\"...\"");
    return nullptr;
  }

  void AddLink(int at) {
    ++report_.links;
    const std::string* name = NameOf(at, "link");
    if (name == nullptr) return;
    const auto [known, is_new] = link_of_.emplace(*name, static_cast<int>(links_.size()));
    if (is_new) {
      links_.push_back({*name, at, -1, -1, false});
      return;
    }
    Say(Kind::kUnreadable, at, Called("link", *name),
        fmt::format("the name is already used in line {}",
                    xml_[links_[static_cast<std::size_t>(known->second)].at].line),
        "give it another name");
  }

  // The link that <parent> or <child> names.
  int End(int joint, const std::string& element, const char* tag) {
    const int at = xml_.Child(joint, tag);
    const std::string* name = at < 0 ? nullptr : xml_[at].Attribute("link");
    if (name == nullptr) {
      Say(Kind::kUnreadable, at < 0 ? joint : at, element, fmt::format("it names no {} link", tag),
          fmt::format("write <{} link=\"...\"/>", tag));
      return -1;
    }
    const auto link = link_of_.find(*name);
    if (link != link_of_.end()) return link->second;
    Say(Kind::kUnreadable, at, element,
        fmt::format("its {} {} does not exist", tag, Called("link", *name)),
        "add <link name=...>, or correct the name");
    return -1;
  }

  void AddJoint(int at) {
    ++report_.joints;
    const std::string* type = xml_[at].Attribute("type");
    const bool moves = type != nullptr && *type != "fixed";
    report_.moving_joints += moves ? 1 : 0;
    const std::string* name = NameOf(at, "joint");
    const std::string element = Called("joint", name != nullptr ? *name : "");
    if (name != nullptr) {
      const auto [known, is_new] = joint_of_.emplace(*name, at);
      if (!is_new) {
        Say(Kind::kUnreadable, at, element,
            fmt::format("the name is already used in line {}", xml_[known->second].line),
            "give it another name");
      }
    }
    const int parent = End(at, element, "parent");
    const int child = End(at, element, "child");
    if (child < 0) return;
    Link& link = links_[static_cast<std::size_t>(child)];
    if (link.joint >= 0) {
      Say(Kind::kUnreadable, at, Called("link", link.name),
          fmt::format("it is the child of two joints; the other is in line {}",
                      xml_[link.joint].line),
          "a URDF is a tree: keep only one of these joints");
      return;
    }
    link.parent = parent;
    link.joint = at;
    link.moves = moves;
  }

  void CheckMimics() {
    for (const auto& [name, at] : joint_of_) {
      const int mimic = xml_.Child(at, "mimic");
      const std::string* other = mimic < 0 ? nullptr : xml_[mimic].Attribute("joint");
      if (mimic < 0) continue;
      if (other == nullptr) {
        Say(Kind::kUnreadable, mimic, Called("joint", name), "<mimic> names no joint",
            "write <mimic joint=\"...\"/>");
      } else if (joint_of_.count(*other) == 0) {
        Say(Kind::kWrong, mimic, Called("joint", name),
            "it mimics " + Called("joint", *other) + ", which does not exist", "correct the name");
      }
    }
  }

  void FindRoots() {
    for (const Link& link : links_) {
      if (link.joint < 0) report_.roots.push_back(link.name);
    }
    if (report_.roots.size() < 2) return;
    std::string names;
    for (std::size_t i = 0; i < std::min(report_.roots.size(), kMaxNamed); ++i) {
      names += (i == 0 ? "" : ", ") + Called("link", report_.roots[i]);
    }
    Say(Kind::kUnreadable, links_[static_cast<std::size_t>(link_of_.at(report_.roots[1]))].at,
        "robot",
        fmt::format("it has {} roots: {}{}", report_.roots.size(), names,
                    report_.roots.size() > kMaxNamed ? ", …" : ""),
        "connect all but one with a joint, such as a fixed one");
  }

  // Up from every link; a way that comes back to itself is a loop, and each is reported once.
  void FindLoops() {
    std::vector<int> walk(links_.size(), -1);  // the walk that was here
    for (int start = 0; start < static_cast<int>(links_.size()); ++start) {
      int at = start;
      while (at >= 0 && walk[static_cast<std::size_t>(at)] < 0) {
        walk[static_cast<std::size_t>(at)] = start;
        at = links_[static_cast<std::size_t>(at)].parent;
      }
      if (at >= 0 && walk[static_cast<std::size_t>(at)] == start) SayLoop(at);
    }
  }

  void SayLoop(int start) {
    std::string path = links_[static_cast<std::size_t>(start)].name;
    std::size_t length = 0;
    int at = start;
    do {
      at = links_[static_cast<std::size_t>(at)].parent;
      if (++length <= kMaxNamed) path = links_[static_cast<std::size_t>(at)].name + " → " + path;
    } while (at != start);
    const Link& link = links_[static_cast<std::size_t>(start)];
    Say(Kind::kUnreadable, link.joint, Called("link", link.name),
        fmt::format("it is its own ancestor in a loop of {} links: {}{}", length,
                    length > kMaxNamed ? "… " : "", path),
        "a URDF is a tree: remove one of these joints");
  }

  const XmlOutline& xml_;
  UrdfReport& report_;
  std::vector<UrdfProblem>& problems_;
  std::vector<Link> links_;
  std::unordered_map<std::string, int> link_of_;
  std::unordered_map<std::string, int> joint_of_;
};

}  // namespace

std::vector<bool> CheckTree(const XmlOutline& xml, UrdfReport& report,
                            std::vector<UrdfProblem>& problems) {
  return Tree(xml, report, problems).Check();
}

}  // namespace kinescope::urdf
