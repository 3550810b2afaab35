#include "server/alarms/rule_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "core/compression_limits.h"
#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/utf8.h"
#include "core/system/web_address.h"
#include "core/system/words.h"
#include "server/options/yaml_file.h"
#include "urdf/segments.h"

namespace kinescope::alarms {

const char* const kDefaultRules = R"(rules:
  - name: high compression
    value: compression
    above: 3400
    for: 0.5
    priority: high
  - name: high load
    value: ratio
    above: high
    for: 2
  - name: unsteady
    value: margin
    below: -0.10
    for: 1
  - name: losing data
    value: loss
    above: 0.02
    for: 1
    over_after: 5
    priority: low
)";

namespace {

constexpr std::size_t kMostRules = 64;
constexpr std::size_t kLongestName = 40;   // characters, so that the page has room for it
constexpr std::size_t kLongestUrl = 2000;  // bytes
constexpr double kLongestDelaySecs = 3600;

struct QuantityInfo {
  Quantity quantity;
  double least, most;  // of a limit
  double band;         // unless the rule has one: of the limit, or in its unit for a margin
};

constexpr std::array<QuantityInfo, 7> kQuantities = {{
    {Quantity::kRatio, 0, 10, 0.05},
    {Quantity::kClass, 0, 0, 0},
    {Quantity::kExposure, 0, 1, 0.05},
    {Quantity::kCompression, 0, 50'000, 0.05},
    {Quantity::kMargin, -2, 2, 0.01},
    {Quantity::kLoss, 0, 1, 0.2},
    {Quantity::kStale, 0.05, 3600, 0},
}};

bool HasLimit(Quantity quantity) { return quantity != Quantity::kClass; }
bool HasClass(Quantity quantity) {
  return quantity == Quantity::kClass || quantity == Quantity::kExposure;
}
bool HasJoint(Quantity quantity) { return HasClass(quantity) || quantity == Quantity::kRatio; }
bool IsOfSignal(Quantity quantity) {
  return quantity == Quantity::kLoss || quantity == Quantity::kStale;
}
const char* LimitKey(Quantity quantity) {
  return quantity == Quantity::kMargin ? "below" : "above";
}
bool IsClass(const std::string& word) { return word == "medium" || word == "high"; }
const char* ClassKey(Quantity quantity) { return quantity == Quantity::kClass ? "at_least" : "of"; }

std::vector<std::string> JointNames() {
  std::vector<std::string> names;
  names.reserve(urdf::kScoredJointCount);
  for (const int joint : urdf::kScoredJoints) {
    names.emplace_back(urdf::kJoints[urdf::At(joint)].ros_name);
  }
  return names;
}

// One file being read: says where something is wrong.
class Reader {
 public:
  explicit Reader(std::string path) : path_(std::move(path)) {}

  template <class Load>
  Rules Read(const Load& load) const {
    YAML::Node root;
    try {
      root = load();
    } catch (const YAML::BadFile&) {
      throw UsageError(fmt::format(
          "--alarms={}; expected a file of rules (docs/alarms.md) or default", CannotRead(path_)));
    } catch (const YAML::Exception& problem) {
      throw UsageError(
          fmt::format("--alarms={}: line {}: {}", path_, problem.mark.line + 1, problem.msg));
    }
    return RulesOf(root);
  }

 private:
  [[noreturn]] void Refuse(const YAML::Node& node, const std::string& reason) const {
    throw UsageError(fmt::format("--alarms={}: line {}: {}", path_,
                                 node.IsDefined() ? node.Mark().line + 1 : 1, reason));
  }

  std::string Text(const YAML::Node& node, const std::string& key) const {
    if (!node.IsScalar()) Refuse(node, key + ": expected one value");
    return node.Scalar();
  }

  double Number(const YAML::Node& node, const std::string& key, double least, double most) const {
    double value = 0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) ||
        !(value >= least && value <= most)) {
      Refuse(node,
             fmt::format("{}: {}: expected a number from {} to {}", key,
                         node.IsScalar() ? PrintableLine(node.Scalar()) : "a list", least, most));
    }
    return value;
  }

  // The place of a text among `words`.
  std::size_t Choice(const YAML::Node& node, const std::string& key,
                     const std::vector<std::string>& words) const {
    const std::string text = Text(node, key);
    const auto found = std::find(words.begin(), words.end(), text);
    if (found == words.end()) {
      Refuse(node,
             fmt::format("{}: {}: expected {}", key, PrintableLine(text), Alternatives(words)));
    }
    return static_cast<std::size_t>(found - words.begin());
  }

  // Each key once, and only those of `known`.
  void CheckKeys(const YAML::Node& map, const std::vector<std::string>& known) const {
    std::set<std::string> seen;
    for (const auto& entry : map) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        Refuse(entry.first, fmt::format("unknown key '{}'{}; expected {}", PrintableLine(key),
                                        SuggestionFor(key, known), Alternatives(known)));
      }
      if (!seen.insert(key).second) Refuse(entry.first, key + ": given twice; remove one");
    }
  }

  Rules RulesOf(const YAML::Node& root) const {
    if (!root.IsMap()) Refuse(root, "expected 'rules:' and a list below it");
    CheckKeys(root, {"rules", "lost_after", "webhook"});
    Rules rules;
    if (const YAML::Node node = root["lost_after"]) {
      rules.lost_secs = Number(node, "lost_after", 0.2, kLongestDelaySecs);
    }
    if (const YAML::Node node = root["webhook"]) rules.webhook = Url(node);
    const YAML::Node list = root["rules"];
    if (!list || !(list.IsSequence() || list.IsNull())) {
      Refuse(list ? list : root, "rules: expected a list; [] for none");
    }
    if (list.size() > kMostRules) {
      Refuse(list, fmt::format("{} rules are more than {}", list.size(), kMostRules));
    }
    std::set<std::string> names;
    for (const YAML::Node& node : list) {
      rules.rules.push_back(RuleOf(node));
      const std::string& name = rules.rules.back().name;
      if (!names.insert(name).second) Refuse(node, "name: " + name + ": given twice");
    }
    return rules;
  }

  std::string Url(const YAML::Node& node) const {
    std::string url = Text(node, "webhook");
    if (!IsWebAddress(url) || url.size() > kLongestUrl || PrintableLine(url) != url) {
      Refuse(node, "webhook: expected the URL of a web server, http://... or https://...");
    }
    return url;
  }

  Rule RuleOf(const YAML::Node& node) const {
    if (!node.IsMap() || !node["value"]) {
      Refuse(node,
             "expected a rule, such as {name: high compression, value: compression, above: "
             "3400, for: 0.5}");
    }
    std::vector<std::string> quantities;
    quantities.reserve(kQuantities.size());
    for (const QuantityInfo& each : kQuantities) quantities.emplace_back(Name(each.quantity));
    const QuantityInfo& info = kQuantities[Choice(node["value"], "value", quantities)];
    CheckKeys(node, KeysOf(info.quantity));
    Rule rule;
    rule.quantity = info.quantity;
    ReadName(node, rule);
    ReadLimit(node, info, rule);
    if (const YAML::Node joint = node["joint"]) ReadJoint(joint, rule);
    ReadDelays(node, rule);
    if (const YAML::Node priority = node["priority"]) {
      rule.priority =
          static_cast<Priority>(Choice(priority, "priority", {"low", "medium", "high"}));
    }
    rule.latches = rule.priority == Priority::kHigh && !IsOfSignal(rule.quantity);
    if (const YAML::Node latch = node["latch"]) {
      rule.latches = Choice(latch, "latch", {"false", "true"}) == 1;
    }
    return rule;
  }

  static std::vector<std::string> KeysOf(Quantity quantity) {
    std::vector<std::string> keys = {"name", "value"};
    if (HasLimit(quantity)) keys.insert(keys.end(), {LimitKey(quantity), "band"});
    if (HasClass(quantity)) keys.emplace_back(ClassKey(quantity));
    if (HasJoint(quantity)) keys.emplace_back("joint");
    keys.insert(keys.end(), {"for", "over_after", "priority", "latch"});
    return keys;
  }

  void ReadName(const YAML::Node& node, Rule& rule) const {
    const YAML::Node name = node["name"];
    rule.name = name ? Text(name, "name") : "";
    if (rule.name.empty() || PrintableLine(rule.name) != rule.name ||
        DecodeUtf8(rule.name).size() > kLongestName) {
      Refuse(name ? name : node,
             fmt::format("name: expected a text of 1 to {} characters", kLongestName));
    }
    if (rule.name == Name(Quantity::kLost)) {
      Refuse(name, "name: lost: this rule is always there; lost_after sets its time");
    }
  }

  void ReadLimit(const YAML::Node& node, const QuantityInfo& info, Rule& rule) const {
    if (HasClass(rule.quantity)) {
      const char* const key = ClassKey(rule.quantity);
      const YAML::Node least = node[key];
      if (least) {
        rule.least_class =
            Choice(least, key, {"medium", "high"}) == 0 ? LoadClass::kMedium : LoadClass::kHigh;
      }
      rule.limit = static_cast<double>(rule.least_class) - 0.5;  // of kClass
    }
    if (!HasLimit(rule.quantity)) return;
    const char* const key = LimitKey(rule.quantity);
    const YAML::Node limit = node[key];
    if (!limit) Refuse(node, fmt::format("{}: {} is missing", rule.name, key));
    const YAML::Node band = node["band"];
    if (rule.quantity == Quantity::kRatio && limit.IsScalar() && IsClass(limit.Scalar())) {
      rule.limit_class = limit.Scalar() == "high" ? LoadClass::kHigh : LoadClass::kMedium;
      rule.band_share = band ? 0 : info.band;
      FollowClassLimits(kDefaultClassLimits, rule);
    } else {
      rule.limit = Number(limit, key, info.least, info.most);
      rule.band = rule.quantity == Quantity::kMargin ? info.band : info.band * rule.limit;
    }
    if (band) rule.band = Number(band, "band", 0, info.most);
  }

  void ReadJoint(const YAML::Node& node, Rule& rule) const {
    std::vector<std::string> names = JointNames();
    names.emplace_back("any");
    const std::size_t place = Choice(node, "joint", names);
    if (place < urdf::kScoredJointCount) rule.joint = urdf::kScoredJoints[place];
  }

  void ReadDelays(const YAML::Node& node, Rule& rule) const {
    if (const YAML::Node delay = node["for"]) {
      rule.for_secs = Number(delay, "for", 0, kLongestDelaySecs);
    }
    if (const YAML::Node delay = node["over_after"]) {
      rule.over_secs = Number(delay, "over_after", 0, kLongestDelaySecs);
    }
  }

  std::string path_;
};

}  // namespace

Rules LoadRules(const std::string& path) {
  if (path == "default") return ParseRules(path, kDefaultRules);
  return Reader(path).Read([&] { return options::LoadYaml(path); });
}

Rules ParseRules(const std::string& path, const std::string& text) {
  return Reader(path).Read([&] { return options::ParseYaml(text); });
}

}  // namespace kinescope::alarms
