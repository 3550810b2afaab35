/// The built-in subject: a person whose motion is generated, for demos, tests and users without a
/// suit. Joint motions are smooth functions of time; velocities, accelerations and angular rates
/// are their true derivatives. Feet stay on the floor in stance.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/source.h"

namespace kinescope::subject {

/// "lift": stands at the origin facing +x, picks a box from the floor, carries it at the chest,
/// holds it out to the left and puts it down; repeats every 8 s. "walk": walks round the origin,
/// counter-clockwise, at 1.2 m/s and 1.5 m from it. Held still: "n_pose", "t_pose", "squat",
/// "overhead" (arms raised), "sit" (without a chair: the feet carry everything).
/// Paths and speeds are those of a person of 1.75 m; others move in proportion, equally fast in
/// time.
const std::vector<std::string>& MotionNames();

/// The subject at `seconds` since it began; any time, in any order, same in same out.
/// Its joint angles (degrees, MVN's own order), CoM (of a man of 75 kg) and derivatives are filled
/// in; its stamps count from 2020-01-01T00:00:00Z, its time code from 0. `counter` stays 0.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual BodySample At(double seconds) const = 0;
  virtual const Character& character() const = 0;
};

/// @pre 0.5 <= height_m <= 2.5
/// @throws SourceError naming the motion asked for and those that exist.
std::unique_ptr<Motion> MakeMotion(const std::string& name, double height_m = 1.75);

/// `demo:lift` as a source of `rate_hz` samples a second that ends after `seconds` (0: never). It
/// is not live: each call of Poll gives the next sample; pacing is the caller's.
/// @throws SourceError as above, and for rates outside (0, 10000] or a negative duration.
std::unique_ptr<Source> OpenSubject(const std::string& motion, double rate_hz, double seconds);

}  // namespace kinescope::subject
