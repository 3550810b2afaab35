/// The built-in subject: a person with a generated motion, for demos, tests and users without a
/// suit. Joint motions are smooth functions of time; velocities, accelerations and angular rates
/// are their exact derivatives. Feet stay on the floor in stance. Any thread; a motion or source
/// belongs to one thread at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/source.h"

namespace kinescope::subject {

/// "lift": stands at the origin facing +x, picks a box from the floor, carries it at the chest,
/// holds it out to the left and puts it down; repeats every 8 s. "walk": walks around the origin,
/// counter-clockwise, at 1.2 m/s and 1.5 m from it. Static poses: "n_pose", "t_pose", "squat",
/// "overhead" (arms raised), "sit" (without a chair: the feet carry everything).
/// Paths and speeds are those of a person of 1.75 m; for others they are scaled to the stature, at
/// the same pace.
const std::vector<std::string>& MotionNames();

/// Those of them that do not move, on which a written pose can be based.
const std::vector<std::string>& StaticPoseNames();

/// At(): the subject `seconds` after its start; any time, in any order; equal times give equal
/// samples.
/// The samples contain joint angles (degrees, MVN's order), CoM (of a man of 75 kg) and
/// derivatives. Stamps start at 2020-01-01T00:00:00Z, time codes at 0. `counter` stays 0.
class Motion {
 public:
  virtual ~Motion() = default;
  virtual BodySample At(double seconds) const = 0;
  virtual const Character& character() const = 0;
};

/// @pre 0.5 <= height_m <= 2.5
/// @throws SourceError with the requested motion and those that exist.
std::unique_ptr<Motion> MakeMotion(const std::string& name, double height_m = urdf::kDefaultHeight);

/// A pose that is written in words and degrees (pose_text.h), at all times. It stands at the
/// origin facing +x unless place and heading are written, with the lowest point of its feet on z =
/// 0.
/// @pre 0.5 <= height_m <= 2.5
/// @throws SourceError as ParsePose() does.
std::unique_ptr<Motion> MakePose(const std::string& text, double height_m = urdf::kDefaultHeight);

/// `demo:lift` as a source of `rate_hz` samples per second that ends after `seconds` (0: never). It
/// is not live: each Poll() returns the next sample at once.
/// @throws SourceError as above, and for rates outside (0, 10000] or a negative duration.
std::unique_ptr<Source> OpenSubject(const std::string& motion, double rate_hz, double seconds,
                                    double height_m = urdf::kDefaultHeight);

/// `pose:right_elbow=90` as a source in the same way, without an end.
std::unique_ptr<Source> OpenPose(const std::string& text, double rate_hz,
                                 double height_m = urdf::kDefaultHeight);

}  // namespace kinescope::subject
