#include "server/wrenches/mot_wrenches.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/system/errors.h"
#include "core/system/words.h"
#include "server/wrenches/wrench_cells.h"

namespace kinescope::wrenches {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kForceColumns = 0, kPointColumns = 1, kTorqueColumns = 2;
constexpr std::array<const char*, 3> kQuantityNames = {"force", "point", "torque"};
constexpr int kMostHeaderLines = 200;
constexpr std::size_t kMostGroups = 16;
constexpr char kMotForm[] =
    "expected a MOT or STO file of OpenSim: a header that ends with a line "
    "endheader, a line of labels, rows";

std::vector<std::string_view> Split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  while ((begin = text.find_first_not_of(separators, begin)) != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return parts;
}

struct Label {
  std::string key;
  std::size_t quantity = 0, axis = 0;
};

// "ground_force_1_vx": force x of "ground_1". nullopt: of no force, point or torque.
std::optional<Label> ParseLabel(std::string_view text) {
  const std::string lower = Lower(std::string(text));
  std::vector<std::string_view> words = Split(lower, "_.");
  if (words.size() < 2) return std::nullopt;
  const std::string_view last = words.back();
  words.pop_back();
  const char axis = last.back();
  if (axis < 'x' || axis > 'z' || last.size() > 2) return std::nullopt;
  Label label;
  label.axis = static_cast<std::size_t>(axis - 'x');
  std::optional<std::size_t> quantity;
  if (last.size() == 2) {
    if (last[0] == 'v' || last[0] == 'f') quantity = kForceColumns;
    if (last[0] == 'p') quantity = kPointColumns;
    if (last[0] == 'm' || last[0] == 't') quantity = kTorqueColumns;
    if (!quantity) return std::nullopt;
  }
  for (const std::string_view word : words) {
    std::optional<std::size_t> said;
    if (word == "force") said = kForceColumns;
    if (word == "point" || word == "cop") said = kPointColumns;
    if (word == "torque" || word == "moment") said = kTorqueColumns;
    if (!said) {
      label.key += (label.key.empty() ? "" : "_") + std::string(word);
    } else if (last.size() == 1) {
      quantity = said;
    }
  }
  if (!quantity) return std::nullopt;
  label.quantity = *quantity;
  return label;
}

// "ground_force_1" of "ground_force_1_vx".
std::string NameOfGroup(std::string_view force_label) {
  const std::size_t end = force_label.find_last_of("_.");
  return std::string(force_label.substr(0, end));
}

// What the words of its name say, and nothing else does: "ground_r", "calcn_l", "left_hand".
std::optional<WrenchBody> BodyByName(const std::string& key) {
  bool is_right = false, is_left = false, is_hand = false;
  for (const std::string_view word : Split(key, "_")) {
    if (word == "r" || word == "right") {
      is_right = true;
    } else if (word == "l" || word == "left") {
      is_left = true;
    } else if (word == "hand") {
      is_hand = true;
    } else if (word != "ground" && word != "grf" && word != "foot" && word != "calcn") {
      return std::nullopt;
    }
  }
  if (is_right == is_left) return std::nullopt;
  if (is_hand) return is_right ? WrenchBody::kRightHand : WrenchBody::kLeftHand;
  return is_right ? WrenchBody::kRightFoot : WrenchBody::kLeftFoot;
}

}  // namespace

MotWrenches::MotWrenches(BoundedLines lines, const std::vector<GroupBody>& bodies, double sign)
    : lines_(std::move(lines)), sign_(sign) {
  ReadHeader();
  ReadLabels();
  Assign(bodies);
  next_group_ = groups_.size();
}

void MotWrenches::ReadHeader() {
  const auto whole = [&](std::string_view key, std::string_view text) {
    long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0) {
      lines_.Refuse(fmt::format("{}: {}: expected a whole number", key, Quoted(text)));
    }
    return value;
  };
  for (int i = 0; i < kMostHeaderLines; ++i) {
    const auto line = lines_.Next();
    if (!line && i == 0) lines_.RefuseFile(fmt::format("the file is empty; {}", kMotForm));
    if (!line) break;
    const std::string_view text = Trimmed(*line);
    if (text == "endheader") return;
    const std::vector<std::string_view> words = Split(text, "= \t");
    if (words.size() != 2) continue;
    if (words[0] == "nRows" || words[0] == "datarows") announced_rows_ = whole(words[0], words[1]);
    if (words[0] == "nColumns" || words[0] == "datacolumns") {
      announced_columns_ = whole(words[0], words[1]);
    }
    if (words[0] == "DataType" && words[1] != "double") {
      lines_.Refuse(fmt::format("DataType={}: expected double", Quoted(words[1])));
    }
  }
  lines_.RefuseFile(
      fmt::format("no line endheader in the first {} lines; {}", kMostHeaderLines, kMotForm));
}

void MotWrenches::ReadLabels() {
  std::optional<std::string_view> line = lines_.Next();
  while (line && Trimmed(*line).empty()) line = lines_.Next();
  if (!line) lines_.RefuseFile(fmt::format("no labels after endheader; {}", kMotForm));
  for (const std::string_view label : Split(*line, " \t")) labels_.emplace_back(label);
  if (labels_.front() != "time") {
    lines_.Refuse(fmt::format("the first label is {}: expected time", Quoted(labels_.front())));
  }
  const auto columns = static_cast<long>(labels_.size());
  if (announced_columns_ && *announced_columns_ != columns) {
    lines_.Refuse(
        fmt::format("{} labels; expected {}, as nColumns says", columns, *announced_columns_));
  }
  values_.resize(labels_.size());
  for (std::size_t i = 1; i < labels_.size(); ++i) {
    const auto label = ParseLabel(labels_[i]);
    if (!label) {
      lines_.Refuse(fmt::format(
          "label {}: expected columns of a force (such as ground_force_1_vx), of its point "
          "(ground_force_1_px) and of the torque (ground_torque_1_x); remove other columns",
          Quoted(labels_[i])));
    }
    auto group = std::find_if(groups_.begin(), groups_.end(),
                              [&](const Group& each) { return each.key == label->key; });
    if (group == groups_.end()) {
      if (groups_.size() == kMostGroups) {
        lines_.Refuse(fmt::format("expected at most {} groups of columns", kMostGroups));
      }
      group = groups_.insert(groups_.end(), Group());
      group->key = label->key;
    }
    auto& column = group->columns[label->quantity][label->axis];
    if (column)
      lines_.Refuse(fmt::format("label {} stands for a column that is there already: {}",
                                Quoted(labels_[i]), Quoted(labels_[*column])));
    column = i;
    if (label->quantity == kForceColumns) group->name = NameOfGroup(labels_[i]);
  }
  for (const Group& group : groups_) {
    for (std::size_t quantity = 0; quantity < group.columns.size(); ++quantity) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (group.columns[quantity][axis]) continue;
        lines_.Refuse(
            fmt::format("{}: {} of its {} is missing; expected x, y and z of force, "
                        "point and torque",
                        Quoted(group.name.empty() ? group.key : group.name), "xyz"[axis],
                        kQuantityNames[quantity]));
      }
    }
  }
  if (groups_.empty()) lines_.Refuse("no columns beside time; expected those of forces");
}

void MotWrenches::Assign(const std::vector<GroupBody>& bodies) {
  std::vector<std::string> names;
  names.reserve(groups_.size());
  for (const Group& group : groups_) names.push_back(group.name);
  const std::string listed = fmt::format("{}", fmt::join(names, ", "));
  for (const GroupBody& given : bodies) {
    if (std::count(names.begin(), names.end(), given.group) > 0) continue;
    throw UsageError(fmt::format("--wrench_bodies: no group {} in {}; its groups: {}",
                                 Quoted(given.group), lines_.name(), listed));
  }
  std::array<const Group*, kWrenchBodyCount> taken{};
  for (Group& group : groups_) {
    const auto given = std::find_if(bodies.begin(), bodies.end(), [&](const GroupBody& each) {
      return each.group == group.name;
    });
    group.body = given != bodies.end() ? given->body : BodyByName(group.key);
    if (!group.body && given == bodies.end()) {
      throw UsageError(
          fmt::format("{}: unknown on which body {} acts; add --wrench_bodies {}=BODY, where BODY "
                      "is RightFoot, "
                      "LeftFoot, RightHand, LeftHand, Ground or none. Groups of the file: {}",
                      lines_.name(), Quoted(group.name), group.name, listed));
    }
    if (!group.body) continue;
    const Group*& other = taken[At(*group.body)];
    if (other != nullptr) {
      throw UsageError(
          fmt::format("{}: {} and {} are both of {}; give each group its own body "
                      "with --wrench_bodies",
                      lines_.name(), Quoted(other->name), Quoted(group.name), Name(*group.body)));
    }
    other = &group;
  }
}

bool MotWrenches::ReadRow() {
  std::optional<std::string_view> line;
  do {
    line = lines_.Next();
    if (!line) {
      if (announced_rows_ && rows_ != *announced_rows_) {
        lines_.RefuseFile(fmt::format("{} rows; expected {}, as nRows says: the file is cut short",
                                      rows_, *announced_rows_));
      }
      return false;
    }
  } while (Trimmed(*line).empty());
  const std::vector<std::string_view> cells = Split(*line, " \t");
  if (cells.size() != labels_.size()) {
    lines_.Refuse(
        fmt::format("{} cells; expected {}, one per label", cells.size(), labels_.size()));
  }
  if (announced_rows_ && rows_ == *announced_rows_) {
    lines_.Refuse(fmt::format("more rows than the {} that nRows says", *announced_rows_));
  }
  const double secs = NumberIn(cells[0], labels_[0], kMostSecs, lines_);
  if (rows_ > 0 && secs <= values_[0]) {
    lines_.Refuse(
        fmt::format("time {} after {}; expected rows with increasing times", secs, values_[0]));
  }
  values_[0] = secs;
  for (const Group& group : groups_) {
    for (std::size_t quantity = 0; quantity < group.columns.size(); ++quantity) {
      const double most = quantity == kPointColumns ? kFarthestPoint : kMostForce;
      for (const auto& column : group.columns[quantity]) {
        values_[*column] = NumberIn(cells[*column], labels_[*column], most, lines_);
      }
    }
  }
  ++rows_;
  return true;
}

Vector3d MotWrenches::Vector(const Group& group, std::size_t quantity) const {
  const auto& columns = group.columns[quantity];
  return {values_[*columns[0]], -values_[*columns[2]], values_[*columns[1]]};
}

WrenchRow MotWrenches::RowOf(const Group& group) const {
  WrenchRow row;
  row.secs = values_[0];
  row.body = *group.body;
  const double sign = IsHand(row.body) ? 1 : sign_;
  row.force = sign * Vector(group, kForceColumns);
  row.torque = sign * Vector(group, kTorqueColumns);
  row.point = Vector(group, kPointColumns);
  CheckRow(row, lines_);
  return row;
}

std::optional<WrenchRow> MotWrenches::Next() {
  for (;;) {
    while (next_group_ < groups_.size()) {
      const Group& group = groups_[next_group_++];
      if (group.body) return RowOf(group);
    }
    if (!ReadRow()) return std::nullopt;
    next_group_ = 0;
  }
}

}  // namespace kinescope::wrenches
