/// One measured force on a body, as a line of a file gives it. World frame of the file, z up;
/// seconds, metres, newtons, N·m. Plain data; any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::wrenches {

/// What the force acts on. kGround: both feet together, as one plate under them measures it.
enum class WrenchBody { kRightFoot, kLeftFoot, kRightHand, kLeftHand, kGround };
constexpr std::size_t kWrenchBodyCount = 5;

constexpr std::size_t At(WrenchBody body) { return static_cast<std::size_t>(body); }
constexpr bool IsHand(WrenchBody body) {
  return body == WrenchBody::kRightHand || body == WrenchBody::kLeftHand;
}

/// "RightFoot", "LeftFoot", "RightHand", "LeftHand", "Ground".
const char* Name(WrenchBody body);
/// Of all bodies.
std::vector<std::string> WrenchBodyNames();
/// By its name, or by that of its link ("right_foot"); nullopt: unknown.
std::optional<WrenchBody> FindWrenchBody(std::string_view name);

struct WrenchRow {
  double secs = 0;  // of the file
  WrenchBody body = WrenchBody::kGround;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  // N·m, about `point`
  std::optional<Eigen::Vector3d> point;              // m; absent: the grip of the hand
};

/// Which body a group of columns is of; nullopt: of none, it is left out.
struct GroupBody {
  std::string group;
  std::optional<WrenchBody> body;
};

/// Below this vertical force, N, the values of a plate are noise: no force.
constexpr double kMinGroundForce = 20;

}  // namespace kinescope::wrenches
