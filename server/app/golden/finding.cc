#include "server/app/golden/finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace kinescope::app {
namespace {

constexpr std::array<const char*, 16> kKindNames = {
    "picture", "fault", "class", "joint", "camera",  "missing", "new",       "text",
    "input",   "load",  "floor", "moved", "visible", "light",   "structure", "pixels"};

constexpr double kRatioLimit = 0.005;
constexpr double kVisibleLimit = 0.15, kFewPixels = 12;  // of an object; below: a pixel's rounding
constexpr double kMetresLimit = 0.002, kDegreesLimit = 0.05;
constexpr double kJointDegreesLimit = 0.5;

double Degrees(double radians) { return radians * 180 / M_PI; }

// Of unit quaternions.
double DegreesBetween(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  double cosine = 0, squared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    cosine += a[i] * b[i];
    squared += (a[i] - b[i]) * (a[i] - b[i]);
  }
  // By the chord, which is exact where the angle is small; of the two signs that both are the same
  // rotation, the nearer one.
  const double chord = std::sqrt(cosine >= 0 ? squared : std::max(0.0, 4 - squared));
  return Degrees(4 * std::asin(std::min(1.0, chord / 2)));
}

std::string ClassText(LoadClass load_class) {
  return fmt::format("{} ({})", Name(load_class), render::ColorName(load_class));
}

std::string PlaceText(const ObjectFact& object) {
  return fmt::format("x {:.0f}, y {:.0f}", object.x_px, object.y_px);
}

class Findings {
 public:
  explicit Findings(double most_px) : place_limit_px(most_px) {}

  /// Where what is added from here on is.
  void At(std::optional<double> x_px, std::optional<double> y_px) {
    x_px_ = x_px;
    y_px_ = y_px;
  }
  void Add(FindingKind kind, const std::string& object, const std::string& words,
           std::string expected = "", std::string actual = "", double amount = 0) {
    all_.push_back({kind, object, std::move(expected), std::move(actual), amount,
                    object + ": " + words, x_px_, y_px_});
  }
  void AddChange(FindingKind kind, const std::string& object, const std::string& what,
                 const std::string& expected, const std::string& actual, double amount = 0) {
    Add(kind, object, fmt::format("expected {}{}, found {}", what, expected, actual), expected,
        actual, amount);
  }
  std::vector<GoldenFinding> Take() { return std::move(all_); }

  const double place_limit_px;

 private:
  std::vector<GoldenFinding> all_;
  std::optional<double> x_px_, y_px_;
};

void CompareLoads(const ObjectFact& expected, const ObjectFact& actual, Findings& findings) {
  if (expected.load_class && actual.load_class && expected.load_class != actual.load_class) {
    findings.AddChange(FindingKind::kClass, expected.name, "", ClassText(*expected.load_class),
                       ClassText(*actual.load_class));
  }
  if (expected.ratio && actual.ratio) {
    const double change = *actual.ratio - *expected.ratio;
    if (std::abs(change) <= kRatioLimit) return;
    findings.AddChange(FindingKind::kLoad, expected.name, "a load ratio of ",
                       fmt::format("{:.3f}", *expected.ratio), fmt::format("{:.3f}", *actual.ratio),
                       change);
  } else if (expected.ratio.has_value() != actual.ratio.has_value()) {
    findings.Add(FindingKind::kLoad, expected.name,
                 fmt::format("its load is now {}", actual.ratio ? "known" : "unknown"),
                 expected.ratio ? "known" : "unknown", actual.ratio ? "known" : "unknown");
  }
}

// `where`: "in front" or "shining through".
void CompareShare(const std::string& object, const char* where, std::int64_t expected,
                  std::int64_t actual, Findings& findings) {
  const auto before = static_cast<double>(expected), now = static_cast<double>(actual);
  const double limit = std::max(kFewPixels, kVisibleLimit * std::max(before, now));
  if (std::abs(now - before) <= limit) return;
  findings.Add(FindingKind::kVisible, object,
               fmt::format("expected {} px {}, found {}", expected, where, actual),
               std::to_string(expected), std::to_string(actual), now - before);
}

void CompareSight(const ObjectFact& expected, const ObjectFact& actual, Findings& findings) {
  const double moved = std::hypot(expected.x_px - actual.x_px, expected.y_px - actual.y_px);
  if (moved > findings.place_limit_px) {
    findings.Add(FindingKind::kMoved, expected.name, fmt::format("moved by {:.1f} px", moved),
                 PlaceText(expected), PlaceText(actual), moved);
  }
  CompareShare(expected.name, "in front", expected.pixels, actual.pixels, findings);
  CompareShare(expected.name, "shining through", expected.through, actual.through, findings);
}

void CompareObjects(const PictureFacts& expected, const PictureFacts& actual, Findings& findings) {
  std::map<std::string, const ObjectFact*> now;
  for (const ObjectFact& object : actual.objects) now[object.name] = &object;
  for (const ObjectFact& object : expected.objects) {
    findings.At(object.x_px, object.y_px);
    const auto match = now.find(object.name);
    if (match == now.end()) {
      findings.Add(FindingKind::kMissing, object.name,
                   "is missing; expected at " + PlaceText(object), PlaceText(object));
      continue;
    }
    CompareLoads(object, *match->second, findings);
    CompareSight(object, *match->second, findings);
    now.erase(match);
  }
  for (const ObjectFact& object : actual.objects) {
    if (now.count(object.name) == 0) continue;
    findings.At(object.x_px, object.y_px);
    const std::string shown = object.load_class ? ", " + ClassText(*object.load_class) : "";
    findings.Add(FindingKind::kNew, object.name, "is new, at " + PlaceText(object) + shown, "",
                 PlaceText(object));
  }
}

void CompareJoints(const PictureFacts& expected, const PictureFacts& actual, Findings& findings) {
  std::map<std::string, const JointFact*> now;
  for (const JointFact& joint : actual.joints) now[joint.name] = &joint;
  for (const JointFact& joint : expected.joints) {
    const auto match = now.find(joint.name);
    if (match == now.end()) continue;  // its person is missing, which is told
    const double turned = DegreesBetween(joint.parent_from_child, match->second->parent_from_child);
    if (turned <= kJointDegreesLimit) continue;
    const auto seen =
        std::find_if(actual.objects.begin(), actual.objects.end(),
                     [&](const ObjectFact& object) { return object.name == joint.name; });
    findings.At(std::nullopt, std::nullopt);
    if (seen != actual.objects.end()) findings.At(seen->x_px, seen->y_px);
    findings.Add(FindingKind::kJoint, joint.name, fmt::format("turned by {:.1f}°", turned), "", "",
                 turned);
  }
}

// Of one part of a picture: equal texts are the same ones; of the others, the first that is there
// no more has become the first that is new.
void CompareTextsOf(const std::string& part, std::vector<TextFact> before,
                    std::vector<TextFact> now, Findings& findings) {
  double moved = 0;
  for (auto each = before.begin(); each != before.end();) {
    const auto same = std::find_if(now.begin(), now.end(),
                                   [&](const TextFact& text) { return text.text == each->text; });
    if (same == now.end()) {
      ++each;
      continue;
    }
    moved = std::max(moved, std::hypot(same->x_px - each->x_px, same->y_px - each->y_px));
    now.erase(same);
    each = before.erase(each);
  }
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    const std::string old_text = i < before.size() ? "“" + before[i].text + "”" : "",
                      new_text = i < now.size() ? "“" + now[i].text + "”" : "";
    const TextFact& placed = i < before.size() ? before[i] : now[i];
    findings.At(placed.x_px, placed.y_px);
    if (new_text.empty()) {
      findings.Add(FindingKind::kText, part, "text " + old_text + " is missing", old_text);
    } else if (old_text.empty()) {
      findings.Add(FindingKind::kText, part, "text " + new_text + " is new", "", new_text);
    } else {
      findings.AddChange(FindingKind::kText, part, "", old_text, new_text);
    }
  }
  if (moved <= findings.place_limit_px) return;
  findings.At(std::nullopt, std::nullopt);
  findings.Add(FindingKind::kMoved, part, fmt::format("texts moved by up to {:.1f} px", moved), "",
               "", moved);
}

void CompareTexts(const PictureFacts& expected, const PictureFacts& actual, Findings& findings) {
  using Texts = std::vector<TextFact>;
  std::map<std::string, std::pair<Texts, Texts>> parts;
  for (const TextFact& text : expected.texts) parts[text.part].first.push_back(text);
  for (const TextFact& text : actual.texts) parts[text.part].second.push_back(text);
  for (auto& [part, texts] : parts) {
    CompareTextsOf(part, std::move(texts.first), std::move(texts.second), findings);
  }
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void CompareCameras(const CameraFact& expected, const CameraFact& actual, Findings& findings) {
  const render::Camera &before = expected.camera, &now = actual.camera;
  const std::string name = expected.view.empty() ? "camera" : "camera of view " + expected.view;
  const Eigen::Vector3d old_axis = before.target - before.position,
                        new_axis = now.target - now.position;
  const double turned = Degrees(AngleBetween(old_axis, new_axis)),
               rolled = Degrees(AngleBetween(before.up, now.up));
  if (std::max(turned, rolled) > kDegreesLimit) {
    findings.Add(FindingKind::kCamera, name,
                 fmt::format("turned by {:.2f}°", std::max(turned, rolled)), "", "",
                 std::max(turned, rolled));
  }
  const double target = (before.target - now.target).norm(),
               nearer = old_axis.norm() - new_axis.norm();
  if (target > kMetresLimit) {
    findings.Add(FindingKind::kCamera, name,
                 fmt::format("looks at a place {:.0f} mm away", 1000 * target), "", "", target);
  }
  if (std::abs(nearer) > kMetresLimit) {
    findings.Add(
        FindingKind::kCamera, name,
        fmt::format("is {:.0f} mm {}", std::abs(1000 * nearer), nearer > 0 ? "nearer" : "farther"),
        "", "", nearer);
  }
  const double opened = Degrees(now.vertical_fov_rad - before.vertical_fov_rad),
               higher = now.ortho_height_m - before.ortho_height_m;
  if (std::abs(opened) > kDegreesLimit || std::abs(higher) > kMetresLimit) {
    findings.Add(FindingKind::kCamera, name, "shows another field of view");
  }
}

void CompareAllCameras(const PictureFacts& expected, const PictureFacts& actual,
                       Findings& findings) {
  if (expected.cameras.size() != actual.cameras.size()) {
    findings.AddChange(FindingKind::kCamera, "views", "", std::to_string(expected.cameras.size()),
                       std::to_string(actual.cameras.size()));
    return;
  }
  for (std::size_t i = 0; i < expected.cameras.size(); ++i) {
    CompareCameras(expected.cameras[i], actual.cameras[i], findings);
  }
}

constexpr std::size_t kMany = 5;  // objects, which are then told together

bool IsOfPicture(const GoldenFinding& finding) { return finding.object == kWholePicture; }

// Without the object. Findings may come from a file: their text may be anything.
std::string ClauseOf(const GoldenFinding& finding) {
  const std::size_t prefix = finding.object.size() + 2;
  const bool is_whole = IsOfPicture(finding) || finding.text.size() < prefix;
  return is_whole ? finding.text : finding.text.substr(prefix);
}

// "right_knee, l5_s1 and 6 more".
std::string SomeNames(const std::vector<const GoldenFinding*>& findings) {
  std::string names = findings[0]->object + ", " + findings[1]->object;
  return findings.size() == 2 ? names : fmt::format("{} and {} more", names, findings.size() - 2);
}

// "15 loads (l5_s1, ...): expected unknown (grey), found 12 low (green), 3 high (red)".
std::string ManyClasses(const std::vector<const GoldenFinding*>& findings) {
  std::map<std::string, std::map<std::string, int>> found;  // by what was expected
  for (const GoldenFinding* finding : findings) ++found[finding->expected][finding->actual];
  std::string text = fmt::format("{} loads ({}): ", findings.size(), SomeNames(findings));
  const char* separator = "";
  for (const auto& [expected, counts] : found) {
    text += fmt::format("{}expected {}, found ", separator, expected);
    const char* comma = "";
    for (const auto& [actual, count] : counts) {
      text += fmt::format("{}{} {}", comma, count, actual);
      comma = ", ";
    }
    separator = "; ";
  }
  return text;
}

// @pre `findings` are of one kind, the largest amount first.
std::string Many(const std::vector<const GoldenFinding*>& findings) {
  const GoldenFinding& worst = *findings.front();
  const std::size_t count = findings.size();
  switch (worst.kind) {
    case FindingKind::kClass: return ManyClasses(findings);
    case FindingKind::kMissing:

      return fmt::format("{} objects are missing: {}", count, SomeNames(findings));
    case FindingKind::kNew:

      return fmt::format("{} objects are new: {}", count, SomeNames(findings));
    case FindingKind::kLoad:
      return worst.amount == 0 ? fmt::format("{} loads are now {}", count, worst.actual)
                               : fmt::format("{} load ratios changed by up to {:.3f} ({})", count,
                                             std::abs(worst.amount), worst.object);
    case FindingKind::kJoint:
      return fmt::format("{} joints turned by up to {:.1f}° ({})", count, worst.amount,
                         worst.object);
    case FindingKind::kMoved:
      return fmt::format("{} objects moved by up to {:.1f} px ({})", count, worst.amount,
                         worst.object);
    default:
      return fmt::format(
          "{} objects are more or less in front, such as {} ({} px expected, found {})", count,
          worst.object, worst.expected, worst.actual);
  }
}

bool CanBeToldTogether(FindingKind kind) {
  switch (kind) {
    case FindingKind::kClass:
    case FindingKind::kJoint:
    case FindingKind::kMissing:
    case FindingKind::kNew:
    case FindingKind::kLoad:
    case FindingKind::kMoved:
    case FindingKind::kVisible: return true;
    default: return false;
  }
}

}  // namespace

const char* Name(FindingKind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

FindingKind FindingKindNamed(const std::string& name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) throw std::runtime_error("no kind of finding: '" + name + "'");
  return static_cast<FindingKind>(found - kKindNames.begin());
}

void SortWorstFirst(std::vector<GoldenFinding>& findings) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const GoldenFinding& a, const GoldenFinding& b) {
                     if (a.kind != b.kind) return a.kind < b.kind;
                     return std::abs(a.amount) > std::abs(b.amount);
                   });
}

std::vector<std::string> Summarize(const std::vector<GoldenFinding>& findings) {
  std::map<FindingKind, std::vector<const GoldenFinding*>> by_kind;
  for (const GoldenFinding& finding : findings) {
    if (!IsOfPicture(finding)) by_kind[finding.kind].push_back(&finding);
  }
  const auto is_many = [&](const GoldenFinding& finding) {
    return !IsOfPicture(finding) && CanBeToldTogether(finding.kind) &&
           by_kind[finding.kind].size() >= kMany;
  };
  std::vector<std::string> lines, of_picture;
  std::map<std::string, std::size_t> line_of;  // of objects
  for (const GoldenFinding& finding : findings) {
    if (IsOfPicture(finding)) {
      (finding.kind == FindingKind::kPicture ? lines : of_picture).push_back(finding.text);
    } else if (is_many(finding)) {
      const auto& all = by_kind[finding.kind];
      if (all.front() == &finding) lines.push_back(Many(all));
    } else if (const auto known = line_of.find(finding.object); known != line_of.end()) {
      lines[known->second] += "; " + ClauseOf(finding);
    } else {
      line_of[finding.object] = lines.size();
      lines.push_back(finding.text);
    }
  }
  lines.insert(lines.end(), of_picture.begin(), of_picture.end());
  return lines;
}

std::vector<GoldenFinding> Compare(const PictureFacts& expected, const PictureFacts& actual,
                                   double place_limit_px) {
  Findings findings(place_limit_px);
  CompareObjects(expected, actual, findings);
  CompareJoints(expected, actual, findings);
  CompareTexts(expected, actual, findings);
  findings.At(std::nullopt, std::nullopt);
  if (expected.has_floor != actual.has_floor) {
    findings.AddChange(FindingKind::kFloor, "floor", "", expected.has_floor ? "a floor" : "none",
                       actual.has_floor ? "a floor" : "none");
  } else if (expected.floor_z_m && actual.floor_z_m &&
             std::abs(*actual.floor_z_m - *expected.floor_z_m) > kMetresLimit) {
    findings.AddChange(
        FindingKind::kFloor, "floor", "", fmt::format("{:.3f} m", *expected.floor_z_m),
        fmt::format("{:.3f} m", *actual.floor_z_m), *actual.floor_z_m - *expected.floor_z_m);
  }
  CompareAllCameras(expected, actual, findings);
  std::vector<GoldenFinding> all = findings.Take();
  SortWorstFirst(all);
  return all;
}

}  // namespace kinescope::app
