/// Detects which parts of the feet are on the floor from their height and speed, with the
/// hysteresis and ramps of joint-loads.md 2.5. The result depends only on the samples in order. One
/// thread; no allocation.
///
/// If the sender reports contacts (BodySample::foot_contacts), they are used, with the same ramps.
///
/// Each foot has two ends with separate contacts: the heel, and the forefoot (ball and toe tip).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/body_forces.h"
#include "core/body_sample.h"
#include "server/loads/foot_motion.h"
#include "server/loads/ground.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

class FootContacts {
 public:
  struct Settings {
    double on_below = 0.05, off_above = 0.08;    // m above the floor
    double on_slower = 0.30, off_faster = 0.50;  // m/s, speed of the point
    int least_samples = 2;                       // that a change must last
    double least_secs = 0.016;                   // that a change must last, s: two samples at 60 Hz
    double ramp_secs = 0.10;  // of the contact weight after landing, raised cosine, s
    double heel_part = 0.30, forefoot_part = 0.40;  // share of the foot's length that supports when
                                                    // alone
    double half_width_of_stature = 0.0275;  // of the support polygon of a foot, as a share of the
                                            // stature
  };

  /// Adds a sample. Speeds are those of FootMotion: streamed, or fitted to the positions and then
  /// 0.05 s late. The first sample, and one after a gap of more than 0.5 s or a step back in time,
  /// starts over: height and speed decide at once, without a ramp. A repeated stamp changes
  /// nothing. `floor_z`: world, m.
  void Update(const BodySample& sample, const urdf::LinkPoses& links,
              const urdf::Skeleton& skeleton, double floor_z, const Settings& settings);

  bool touches(urdf::Side side) const { return ends_[side][kHeel].on || ends_[side][kForefoot].on; }
  bool any() const { return touches(urdf::kRight) || touches(urdf::kLeft); }

  /// For SplitGround, by urdf::Side: centre of the parts in contact, and contact weight.
  const std::array<FootOnGround, 2>& feet() const { return feet_; }

  /// Of one end alone, 0 to 1.
  double heel_weight(urdf::Side side) const { return ends_[side][kHeel].weight(); }
  double forefoot_weight(urdf::Side side) const { return ends_[side][kForefoot].weight(); }

  /// Support polygon of one foot; empty without contact.
  const SupportPolygon& polygon(urdf::Side side) const { return polygons_[side]; }
  /// Support polygon of both feet.
  const SupportPolygon& support() const { return support_; }

 private:
  enum End { kHeel, kForefoot };
  struct ContactEnd {
    bool on = false;
    int contrary_samples = 0;  // in a row that say the opposite of `on`
    double contrary_secs = 0;  // since the first of them
    double ramp = 0;           // progress, 0..1
    double weight() const;
  };
  static void Follow(ContactEnd& end, bool on, bool fresh, double step_secs,
                     const Settings& settings);
  void Judge(ContactEnd& end, double height, double speed, bool fresh, double step_secs,
             const Settings& settings);
  void Place(urdf::Side side, double stature, const Settings& settings);

  std::array<std::array<ContactEnd, 2>, 2> ends_{};
  FootMotion motion_;
  bool has_last_ = false;
  std::int64_t last_nanos_ = 0;
  std::array<FootOnGround, 2> feet_{};
  std::array<SupportPolygon, 2> polygons_{};
  SupportPolygon support_;
};

}  // namespace kinescope::loads
