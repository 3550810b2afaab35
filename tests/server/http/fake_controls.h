/// Controls that note what they are ordered to do.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/controls.h"

namespace kinescope::http::testing {

class FakeControls : public Controls {
 public:
  std::string StatusJson() override { return R"({"recording": {"state": "off"}})"; }
  std::string FilesJson(Role role) override {
    return role == Role::kOperator ? R"({"files": [], "folder": "/lab"})" : R"({"files": []})";
  }
  std::optional<std::filesystem::path> FindFile(const std::string& name) const override {
    if (name != "S07_lift_001.mp4") return std::nullopt;
    return std::filesystem::path("/lab") / name;
  }
  Result Record(const RecordingOrder& order, Role) override {
    return Note(order.run ? "record " + order.label : "stop recording");
  }
  Result Clip(const ClipOrder& order, Role) override {
    return Note(order.last_secs ? "last " + std::to_string(*order.last_secs) : "other clip");
  }
  Result SetPerson(const PersonOrder& order, Role) override {
    return Note("person " + order.change.name.value_or(""));
  }
  Result SetClassLimits(const std::array<double, 2>&, Role) override { return Note("limits"); }
  Result RunTrial(const TrialOrder& order, Role) override { return Note("trial " + order.person); }
  void OnHandLoad(int, const HandLoad&, Role) override { Note("hand load"); }
  void OnCamera(const std::string& before, const std::string& after,
                std::string_view role) override {
    Note(before + " to " + after + " by " + std::string(role));
  }

  std::string refusal;  // of all orders; "": none
  const std::vector<std::string>& orders() const { return orders_; }

 private:
  Result Note(const std::string& order) {
    if (!refusal.empty()) return tl::unexpected(ControlRefusal{409, refusal});
    orders_.push_back(order);
    return "{}";
  }
  std::vector<std::string> orders_;
};

}  // namespace kinescope::http::testing
