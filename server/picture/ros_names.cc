#include "server/picture/ros_names.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "server/options/text.h"

namespace kinescope::app {
namespace {

bool IsName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/';
  });
}

}  // namespace

bool IsTopicName(const std::string& text) {
  const bool is_private = !text.empty() && text.front() == '~';
  const std::string name = is_private ? text.substr(1) : text;
  return IsName(name) &&
         (name.front() == '/' || std::isalpha(static_cast<unsigned char>(name.front())) != 0);
}

bool IsFrameName(const std::string& text) { return IsName(text) && text.front() != '/'; }

bool AreTopicNames(const std::string& text) {
  const std::vector<std::string> names = options::SplitItems(text);
  return names.size() <= kMaxMarkerTopics && std::all_of(names.begin(), names.end(), IsTopicName);
}

options::Text MarkerTopics() {
  return {"", "up to 16 topics with commas between, such as /walls,/plan", AreTopicNames};
}

}  // namespace kinescope::app
