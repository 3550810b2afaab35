#include "urdf/rig/usual_names.h"

#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace kinescope::rig {
namespace {

constexpr std::size_t kLongest = 80;  // of a name that is looked at

bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsLower(char c) { return c >= 'a' && c <= 'z'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// In lower case. "DEF-upperArm.L" is def, upper, arm, l.
std::vector<std::string> WordsOf(std::string_view name) {
  std::vector<std::string> words;
  bool is_in_word = false, was_lower = false;
  for (const char c : name) {
    const bool is_letter = IsUpper(c) || IsLower(c) || IsDigit(c);
    if (!is_letter || (IsUpper(c) && was_lower)) is_in_word = false;
    was_lower = IsLower(c);
    if (!is_letter) continue;
    if (!is_in_word) words.emplace_back();
    is_in_word = true;
    words.back() += IsUpper(c) ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return words;
}

// Of all bones of a rig alike.
const std::set<std::string>& Prefixes() {
  static const std::set<std::string> kPrefixes = {"def",   "bip",  "bip01", "bip001", "biped",
                                                  "b",     "cc",   "base",  "valve",  "jnt",
                                                  "joint", "bone", "rig",   "bind",   "skin"};
  return kPrefixes;
}

const std::map<std::string, std::string>& OfTheMiddle() {
  static const std::map<std::string, std::string> kNames = {
      {"hips", "hips"},    {"hip", "hips"},    {"pelvis", "hips"},      {"spine", "spine"},
      {"waist", "spine"},  {"chest", "spine"}, {"neck", "neck"},        {"neck01", "neck"},
      {"neck1", "neck"},   {"head", "head"},   {"necktwist01", "neck"}, {"spine004", "neck"},
      {"spine006", "head"}};  // Blender counts on from the hips
  return kNames;
}

const std::map<std::string, std::string>& OfASide() {
  static const std::map<std::string, std::string> kNames = {
      {"clavicle", "shoulder"}, {"collar", "shoulder"},   {"shoulder", "shoulder"},
      {"arm", "upperarm"},      {"upperarm", "upperarm"}, {"forearm", "lowerarm"},
      {"lowerarm", "lowerarm"}, {"elbow", "lowerarm"},    {"hand", "hand"},
      {"wrist", "hand"},        {"thigh", "upperleg"},    {"upperleg", "upperleg"},
      {"upleg", "upperleg"},    {"hip", "upperleg"},      {"calf", "lowerleg"},
      {"shin", "lowerleg"},     {"lowerleg", "lowerleg"}, {"knee", "lowerleg"},
      {"foot", "foot"},         {"ankle", "foot"},        {"toe", "toes"},
      {"toes", "toes"},         {"toe0", "toes"},         {"toebase", "toes"},
      {"ball", "toes"}};
  return kNames;
}

bool IsSpine(const std::string& name) {
  constexpr std::string_view kBegin = "spine";
  if (name.compare(0, kBegin.size(), kBegin) != 0 || name.size() > kBegin.size() + 3) return false;
  for (const char c : name.substr(kBegin.size())) {
    if (!IsDigit(c)) return false;
  }
  return true;
}

}  // namespace

std::string UsualName(const std::string& name) {
  if (name.size() > kLongest) return "";
  std::string side, part;
  for (const std::string& word : WordsOf(name)) {
    const bool is_left = word == "l" || word == "left", is_right = word == "r" || word == "right";
    if (is_left || is_right) {
      if (!side.empty()) return "";
      side = is_left ? "left" : "right";
    } else if (Prefixes().count(word) == 0) {
      part += word;
    }
  }
  const auto& names = side.empty() ? OfTheMiddle() : OfASide();
  const auto found = names.find(part);
  if (found != names.end()) return side + found->second;
  return side.empty() && IsSpine(part) ? "spine" : "";
}

}  // namespace kinescope::rig
