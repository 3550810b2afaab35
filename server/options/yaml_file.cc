#include "server/options/yaml_file.h"

#include <yaml-cpp/eventhandler.h>

#include <fstream>
#include <sstream>
#include <utility>

namespace kinescope::options {
namespace {

// Reads a document without keeping anything of it.
class YamlLimits : public YAML::EventHandler {
 public:
  explicit YamlLimits(int deepest) : deepest_(deepest) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (std::exchange(has_begun_, true)) {
      throw YAML::ParserException(mark, "a second document; remove the line '---' before it");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw YAML::ParserException(mark, "alias; write the value itself");
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Enter(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Enter(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  void Enter(const YAML::Mark& mark) {
    if (++depth_ <= deepest_) return;
    throw YAML::ParserException(mark, "too many levels; at most " + std::to_string(deepest_));
  }

  const int deepest_;
  int depth_ = 0;
  bool has_begun_ = false;
};

}  // namespace

YAML::Node ParseYaml(const std::string& text, int deepest) {
  if (text.size() > kMaxYamlBytes) {
    throw YAML::ParserException(YAML::Mark(),
                                "too long; at most " + std::to_string(kMaxYamlBytes) + " bytes");
  }
  std::istringstream stream(text);
  YamlLimits limits(deepest);
  YAML::Parser parser(stream);
  while (parser.HandleNextDocument(limits)) {
  }
  return YAML::Load(text);
}

YAML::Node LoadYaml(const std::string& path, int deepest) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxYamlBytes + 1, '\0');  // it may be a pipe or a device without an end
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.empty() && !file.eof()) throw YAML::BadFile(path);
  return ParseYaml(text, deepest);
}

std::string ToYaml(const std::vector<YamlLine>& lines) {
  YAML::Emitter yaml;
  yaml << YAML::BeginMap;
  for (const YamlLine& line : lines) {
    yaml << YAML::Key << line.name << YAML::Value;
    if (line.is_list) yaml << YAML::BeginSeq;
    for (const std::string& text : line.texts) yaml << text;
    if (line.is_list) yaml << YAML::EndSeq;
  }
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace kinescope::options
