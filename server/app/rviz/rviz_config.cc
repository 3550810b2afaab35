#include "server/app/rviz/rviz_config.h"

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "core/system/json_text.h"

namespace kinescope::app {
namespace {

using ros_bridge::RunningNode;
using ros_bridge::RunningPerson;

// JSON texts are YAML texts.
std::string Quoted(const std::string& text) { return JsonText(nlohmann::json(text)); }

// In all lines "key: ...".
void SetValue(const std::string& key, const std::string& value, std::string& text) {
  const std::string start = " " + key + ": ";
  for (std::size_t at = text.find(start); at != std::string::npos;
       at = text.find(start, at + start.size())) {
    const std::size_t from = at + start.size();
    text.replace(from, text.find('\n', from) - from, Quoted(value));
  }
}

bool IsOf(const std::string& display, const char* type) {
  return display.find(std::string("- Class: rviz/") + type + "\n") != std::string::npos;
}

// `display`: as in the usual configuration.
std::string DisplayOf(std::string display, const char* name, const RunningPerson& person) {
  SetValue("Name", std::string(name) + " of " + person.model, display);
  SetValue("Robot Description", person.description, display);
  SetValue("Marker Topic", person.topics + "markers", display);
  return display;
}

std::string DisplaysOf(const std::string& display, const RunningNode& node, bool with_view) {
  std::string all;
  if (IsOf(display, "RobotModel")) {
    for (const RunningPerson& person : node.people) all += DisplayOf(display, "Body", person);
  } else if (IsOf(display, "MarkerArray")) {
    for (const RunningPerson& person : node.people) all += DisplayOf(display, "Loads", person);
  } else if (!IsOf(display, "Camera")) {
    all = display;
  } else if (node.has_view && with_view) {
    all = display;
    SetValue("Image Topic", node.name + "/view/image_raw", all);
    for (const char* key : {"Enabled", "Value"}) SetValue(key, "true", all);
  }
  return all;
}

}  // namespace

std::string RvizConfig(const std::string& usual, const RunningNode& node, bool with_view) {
  std::string text, display;
  bool is_display = false;
  const auto end_display = [&] { text += DisplaysOf(std::exchange(display, ""), node, with_view); };
  std::istringstream lines(usual);
  for (std::string line; std::getline(lines, line);) {
    line += '\n';
    const bool begins = line.rfind("    - Class: rviz/", 0) == 0;
    const bool ends = is_display && line.rfind("    ", 0) != 0;
    if (is_display && (begins || ends)) end_display();
    if (ends) is_display = false;
    if (line == "  Displays:\n") is_display = true;
    (is_display && line != "  Displays:\n" ? display : text) += line;
  }
  SetValue("Fixed Frame", node.reference_frame, text);
  SetValue("Target Frame", node.people.front().model + "_pelvis", text);
  return text;
}

}  // namespace kinescope::app
