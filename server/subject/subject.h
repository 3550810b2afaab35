/// The built-in subject: a person whose motion is generated, for demos, tests and users without a
/// suit. Joint motions are smooth functions of time; velocities, accelerations and angular rates are
/// their true derivatives. Feet stay on the floor in stance.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "server/core/source.h"

namespace kinescope::subject {

/// "lift": picks a box from the floor, carries it at the chest, puts it down; repeats every 8 s.
/// "walk": walks in a circle at 1.2 m/s. Also "n_pose" and "t_pose", which stand still.
const std::vector<std::string>& MotionNames();

/// The subject at `seconds` since it began; any time, in any order, same in same out.
/// Its joint angles (degrees, MVN's own order), CoM and derivatives are filled in.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual BodySample At(double seconds) const = 0;
  virtual const Character& character() const = 0;
};

/// @throws SourceError naming the motion asked for and those that exist.
std::unique_ptr<Motion> MakeMotion(const std::string& name, double height_m = 1.75);

/// `demo:lift` as a source of `rate_hz` samples a second that ends after `seconds` (0: never).
/// @throws SourceError as above.
std::unique_ptr<Source> OpenSubject(const std::string& motion, double rate_hz, double seconds);

}  // namespace kinescope::subject
