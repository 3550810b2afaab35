/// Texts of RViz configurations, and what is read from them.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "server/picture/rviz_file.h"

namespace kinescope::testing {

inline constexpr int kRvizWidth = 800, kRvizHeight = 600;  // px

inline std::map<std::string, std::string> SettingsOf(const app::RvizPicture& picture) {
  std::map<std::string, std::string> settings;
  for (const auto& each : picture.settings) {
    EXPECT_TRUE(settings.emplace(each.option, each.text).second) << each.option << " twice";
  }
  return settings;
}

inline app::RvizPicture ReadText(const std::string& text) {
  return app::ParseRvizFile("saved.rviz", text, kRvizHeight);
}

/// A configuration with these displays, and more lines of the manager.
inline std::string WithDisplays(const std::string& displays, const std::string& more = "") {
  return "Visualization Manager:\n  Displays:\n" + displays + more;
}

inline std::string WithView(const std::string& lines) {
  return "Visualization Manager:\n  Views:\n    Current:\n" + lines;
}

}  // namespace kinescope::testing
