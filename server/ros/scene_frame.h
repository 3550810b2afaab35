/// The frame in which a scene without people stands: people have one of their own. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/ros/force_frames.h"

namespace kinescope::ros_bridge {

/// Of a graph, whose frames come one after another.
class SceneFrame {
 public:
  /// `wanted`: the frame of people, and that of a scene without them where TF has it.
  SceneFrame(std::string wanted, std::shared_ptr<const TfTree> tf);

  const std::string& name() const { return name_; }
  /// A person is there: from now on it is the wanted one.
  void SetPerson() { has_person_ = true; }
  /// Whether it is to be looked for: at most twice a second, and not once it is that of people.
  bool IsDue(std::int64_t monotonic_nanos) const;
  /// `of_marker`: a frame in which something stands that is to be shown, for graphs without TF; "":
  /// there is none.
  void Update(std::int64_t monotonic_nanos, const std::string& of_marker);

 private:
  std::string Find(const std::string& of_marker) const;

  const std::string wanted_;
  const std::shared_ptr<const TfTree> tf_;
  std::string name_;
  bool has_person_ = false;
  std::int64_t looked_nanos_ = 0;
  std::int64_t looks_ = 0;
};

}  // namespace kinescope::ros_bridge
