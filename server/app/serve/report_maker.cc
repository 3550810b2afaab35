#include "server/app/serve/report_maker.h"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <stdexcept>

#include "server/picture/child_process.h"

namespace kinescope::app {
namespace {

constexpr std::chrono::minutes kLongestReport(10);

std::string LastLineOf(const std::string& text) {
  std::istringstream in(text);
  std::string last;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

options::OptionList ListOf(PersonOptions& person, LoadOptions& loads) {
  options::OptionList list;
  person.List(list);
  loads.List(list);
  return list;
}

}  // namespace

OptionTexts LoadsOptionsOf(const PersonOptions& person, const LoadOptions& loads) {
  PersonOptions given_person = person, default_person;
  LoadOptions given_loads = loads, default_loads;
  options::OptionList given = ListOf(given_person, given_loads);
  options::OptionList defaults = ListOf(default_person, default_loads);
  OptionTexts texts;
  for (const options::Option& option : given) {
    const options::Value& value = *option.value;
    const options::Value& usual = *defaults.Find(option.name)->value;
    const bool is_usual = value.IsGiven() == usual.IsGiven() && value.ToText() == usual.ToText();
    if (value.IsGiven() && !is_usual) texts.emplace_back(option.name, value.ToText());
  }
  return texts;
}

void SetOption(OptionTexts& options, const std::string& name, const std::string& value) {
  const auto known = std::find_if(options.begin(), options.end(),
                                  [&](const auto& option) { return option.first == name; });
  if (known != options.end()) {
    known->second = value;
  } else {
    options.emplace_back(name, value);
  }
}

std::string ToLines(const OptionTexts& options) {
  std::string lines;
  for (const auto& [name, value] : options) lines.append(name).append("=").append(value) += '\n';
  return lines;
}

OptionTexts OptionsFromLines(const std::string& lines) {
  PersonOptions person;
  LoadOptions loads;
  options::OptionList known = ListOf(person, loads);
  OptionTexts options;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const std::size_t sign = line.find('=');
    if (sign == std::string::npos || known.Find(line.substr(0, sign)) == nullptr) continue;
    options.emplace_back(line.substr(0, sign), line.substr(sign + 1));
  }
  return options;
}

void MakeReport(const std::filesystem::path& recording, const std::filesystem::path& report,
                const OptionTexts& options, const Workshop::Progress& progress) {
  std::vector<std::string> command = {"/proc/self/exe", "loads", recording.string(), "--report",
                                      report.string()};
  for (const auto& [name, value] : options) command.push_back("--" + name + "=" + value);
  const ChildResult result =
      RunChild(command, kLongestReport, [&progress] { return progress.is_wanted(); });
  if (!progress.is_wanted()) return;
  if (result.was_too_slow) throw std::runtime_error("the report took more than ten minutes");
  if (result.exit_code == 0 && result.signal == 0) return;
  const std::string why = LastLineOf(result.err);
  throw std::runtime_error("no report: " + (why.empty() ? "the program ended by itself" : why));
}

}  // namespace kinescope::app
