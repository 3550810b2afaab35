#include "server/subject/pose_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "core/system/utf8.h"
#include "core/system/words.h"
#include "server/subject/subject.h"
#include "urdf/anatomical_limits.h"

namespace kinescope::subject {
namespace {

constexpr std::string_view kPelvisName = "vertical_pelvis";

// As `convert` names them.
constexpr std::array<const char*, 3> kTrunkAxes = {"lateral_bending", "axial_rotation", "flexion"};
constexpr std::array<const char*, 3> kLimbAxes = {"abduction", "rotation", "flexion"};

struct Quantity {
  std::string name;        // "right_elbow_flexion"
  std::string short_name;  // "right_elbow", of a flexion; "" of others
  double lower, upper;
  const char* unit;
};

std::vector<Quantity> MakeQuantities() {
  std::vector<Quantity> all;
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const std::string name(urdf::kJoints[urdf::At(joint)].ros_name);
    const auto& axes = joint <= urdf::jC1Head ? kTrunkAxes : kLimbAxes;
    for (int axis = 0; axis < 3; ++axis) {
      const urdf::AngleRange range = urdf::AnatomicalRangeOf(joint, axis);
      all.push_back({name + "_" + axes[urdf::At(axis)], axis == 2 ? name : "",
                     std::round(range.lower), std::round(range.upper), "degrees"});
    }
  }
  const std::string pelvis(kPelvisName);
  // At 90 degrees, forward is no heading any more.
  all.push_back({pelvis + "_lateral_bending", "", -85, 85, "degrees"});
  all.push_back({pelvis + "_flexion", pelvis, -85, 85, "degrees"});
  all.push_back({"heading", "", -360, 360, "degrees"});
  all.push_back({"x", "", -100, 100, "m"});
  all.push_back({"y", "", -100, 100, "m"});
  return all;
}

const std::vector<Quantity>& Quantities() {
  static const std::vector<Quantity> all = MakeQuantities();
  return all;
}

std::string_view WithoutBlanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

// Untrusted text in a message: one line, not longer than any valid entry.
std::string Quoted(std::string_view text) {
  constexpr std::size_t kLongest = 48;
  const bool is_long = text.size() > kLongest;
  return "'" + PrintableLine(text.substr(0, kLongest)) + (is_long ? "…'" : "'");
}

std::optional<double> NumberOf(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

// "right_elbow" of "right_elbow_bend", with the words for its axes; "" if no joint begins so.
std::string JointOf(std::string_view name, std::vector<std::string>& axes) {
  for (const Quantity& quantity : Quantities()) {
    const std::string& joint = quantity.short_name;
    if (joint.empty() || !StartsWith(name, joint + "_")) continue;
    for (const Quantity& other : Quantities()) {
      if (StartsWith(other.name, joint + "_")) axes.push_back(other.name.substr(joint.size() + 1));
    }
    return joint;
  }
  return "";
}

class PoseReader {
 public:
  WrittenPose Read(std::string_view text) {
    if (text.size() > kMaxPoseChars) {
      throw SourceError("pose: a text of " + std::to_string(text.size()) +
                        " bytes; expected at most " + std::to_string(kMaxPoseChars));
    }
    if (WithoutBlanks(text).empty()) {
      throw SourceError("pose: nothing is written; expected " + Forms());
    }
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      entry_ = WithoutBlanks(text.substr(begin, end - begin));
      ++number_;
      ReadEntry();
      begin = end + 1;
    }
    return std::move(pose_);
  }

 private:
  static std::string Forms() {
    return Alternatives(StaticPoseNames()) +
           ", then JOINT=DEGREES, with commas between; such as "
           "pose:right_elbow=90,left_knee=45";
  }

  [[noreturn]] void Refuse(const std::string& reason) const {
    throw SourceError("pose: entry " + std::to_string(number_) + ", " + Quoted(entry_) + ": " +
                      reason);
  }

  void ReadEntry() {
    if (entry_.empty()) Refuse("is empty; remove one of the commas");
    const std::size_t sign = entry_.find('=');
    if (sign == std::string_view::npos) return ReadBase();
    const std::string_view name = WithoutBlanks(entry_.substr(0, sign));
    const std::string_view value = WithoutBlanks(entry_.substr(sign + 1));
    const std::size_t index = Find(name);
    CheckIsFirst(index);
    pose_.values[index] = ReadNumber(value, Quantities()[index]);
    Remember(std::string(name) + "=" + std::string(value));
  }

  void ReadBase() {
    const std::string name(entry_);
    const auto& bases = StaticPoseNames();
    const bool is_base = std::find(bases.begin(), bases.end(), name) != bases.end();
    if (is_base && number_ > 1) Refuse("a static pose is the first entry; write it there");
    if (!is_base) RefuseBase(name);
    pose_.base = name;
    Remember(name);
  }

  [[noreturn]] void RefuseBase(const std::string& name) const {
    const auto& motions = MotionNames();
    if (number_ > 1) Refuse("expected JOINT=DEGREES, such as right_elbow=90");
    if (std::find(motions.begin(), motions.end(), name) != motions.end()) {
      Refuse("is a motion; expected " + Forms());
    }
    Refuse("unknown pose; expected " + Forms() + SuggestionFor(name, StaticPoseNames()));
  }

  std::size_t Find(std::string_view name) const {
    const auto& all = Quantities();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (name == all[i].name || (!name.empty() && name == all[i].short_name)) return i;
    }
    std::vector<std::string> axes;
    const std::string joint = JointOf(name, axes);
    if (!joint.empty()) {
      const std::string_view axis = name.substr(joint.size() + 1);
      Refuse("unknown axis of " + joint + "; expected " + Alternatives(axes) +
             SuggestionFor(axis, axes));
    }
    RefuseName(name);
  }

  [[noreturn]] void RefuseName(std::string_view name) const {
    std::vector<std::string> short_names, names;
    for (const Quantity& quantity : Quantities()) {
      const bool is_axis = quantity.short_name.empty();
      if (!is_axis) short_names.push_back(quantity.short_name);
      if (quantity.unit == std::string_view("m") || quantity.name == "heading") {
        short_names.push_back(quantity.name);
      }
      names.push_back(quantity.name);
    }
    names.insert(names.begin(), short_names.begin(), short_names.end());
    const std::string nearest = SuggestionFor(name, names);
    Refuse("unknown joint" +
           (nearest.empty() ? "; expected " + Alternatives(short_names) : nearest));
  }

  void CheckIsFirst(std::size_t index) {
    if (first_[index].empty()) {
      first_[index] = std::string(entry_);
      return;
    }
    Refuse("was written before, as " + Quoted(first_[index]) + "; remove one of them");
  }

  double ReadNumber(std::string_view text, const Quantity& quantity) const {
    const auto number = NumberOf(text);
    if (number && *number >= quantity.lower && *number <= quantity.upper) return *number;
    std::ostringstream reason;
    if (!number) reason << "not a number; ";
    reason << "expected " << quantity.lower << " to " << quantity.upper << " " << quantity.unit;
    Refuse(reason.str());
  }

  void Remember(const std::string& entry) { pose_.text += (pose_.text.empty() ? "" : ",") + entry; }

  WrittenPose pose_;
  std::string_view entry_;
  int number_ = 0;                                       // of the entry, from 1
  std::array<std::string, kWrittenQuantities> first_{};  // the entry that wrote it
};

}  // namespace

WrittenPose ParsePose(std::string_view text) { return PoseReader().Read(text); }

}  // namespace kinescope::subject
