/// The file of measured forces of a recording, and how it fits the recording.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/options/option_list.h"
#include "server/wrenches/wrench_reader.h"

namespace kinescope::app {

/// FILE.csv, FILE.mot or FILE.sto; "": none.
class WrenchFileValue : public options::FilePath {
 public:
  WrenchFileValue& operator=(std::string path) {
    value_ = std::move(path);
    return *this;
  }

  void Parse(const std::string& text) override;
  std::string Expected() const override { return "FILE.csv, FILE.mot or FILE.sto"; }
};

/// X,Y,YAW (m and degrees).
class WrenchPlaceValue : public options::ValueOf<std::array<double, 3>> {
 public:
  WrenchPlaceValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
};

/// GROUP=BODY, with commas between several. A group may begin with a digit, as in 1_ground_force.
class WrenchBodiesValue : public options::ValueOf<std::vector<wrenches::GroupBody>> {
 public:
  WrenchBodiesValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;

 private:
  std::string text_;
};

struct WrenchOptions {
  WrenchOptions();

  WrenchFileValue wrenches;
  options::Optional<WrenchBodiesValue> wrench_bodies;
  options::Optional<options::Number> wrench_offset;  // s
  options::Optional<WrenchPlaceValue> wrench_place;
  options::Optional<options::Choice<bool>> wrench_sign;  // true: on_plate

  void List(options::OptionList& option);
};

/// For commands without a recording: the names of all options above.
std::vector<std::string> WrenchOptionNames();

/// nullopt without a file.
std::optional<wrenches::WrenchSettings> ToWrenchSettings(const WrenchOptions& options);

}  // namespace kinescope::app
