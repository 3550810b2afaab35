/// Reads labels from the names of recordings: "{person}_{condition}_{trial}" of "S07_lift_003".
/// Values; any thread.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/options/value.h"

namespace kinescope::app {

class LabelPattern : public options::Value {
 public:
  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;
  bool IsGiven() const override { return !text_.empty(); }

  /// The labels of `name`; nullopt if it does not have this form. A label ends where the text after
  /// it begins for the first time, the last one at the end.
  std::optional<std::map<std::string, std::string>> Of(const std::string& name) const;

 private:
  struct Part {
    std::string before;  // text that stands before the label
    std::string label;   // "": the end
  };

  std::string text_;
  std::vector<Part> parts_;
};

}  // namespace kinescope::app
