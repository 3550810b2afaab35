/// Reads YAML files, and writes simple ones. Their content is untrusted: size and depth are
/// bounded, and there are no aliases, with which a short file stands for a very long one. Pure
/// functions; any thread.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>
#include <vector>

namespace kinescope::options {

inline constexpr std::size_t kMaxYamlBytes = 1 << 20;

inline constexpr int kDeepestYaml = 16;  // levels of what people write

/// The only document of `text`, of at most `deepest` levels. @throws YAML::Exception with the line
/// and the reason.
YAML::Node ParseYaml(const std::string& text, int deepest = kDeepestYaml);

/// As ParseYaml(). @throws YAML::BadFile, too, if `path` cannot be read.
YAML::Node LoadYaml(const std::string& path, int deepest = kDeepestYaml);

struct YamlLine {
  std::string name;
  std::vector<std::string> texts;
  bool is_list = false;  // else there is one text
};

/// A map with these members, in this order, each text quoted where it must be.
std::string ToYaml(const std::vector<YamlLine>& lines);

}  // namespace kinescope::options
