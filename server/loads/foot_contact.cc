#include "server/loads/foot_contact.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"
#include "server/loads/gap.h"
#include "server/loads/support_polygon.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using urdf::kLeft;
using urdf::kRight;
using urdf::Side;

// A foot that has just touched the floor carries load at once if it is the only one.
constexpr double kMinWeight = 1e-3;

}  // namespace

double FootContacts::ContactEnd::weight() const { return 0.5 * (1 - std::cos(M_PI * ramp)); }

// Applies the contact of an end; its weight follows during the ramp.
void FootContacts::Follow(ContactEnd& end, bool on, bool fresh, double step_secs,
                          const Settings& settings) {
  end.on = on;
  const double step = fresh || settings.ramp_secs <= 0 ? 1.0 : step_secs / settings.ramp_secs;
  end.ramp = std::clamp(end.ramp + (on ? step : -step), 0.0, 1.0);
}

void FootContacts::Judge(ContactEnd& end, double height, double speed, bool fresh, double step_secs,
                         const Settings& settings) {
  const bool comes_down = height < settings.on_below && speed < settings.on_slower;
  const bool stays = height <= settings.off_above && speed <= settings.off_faster;
  const bool contradicts = end.on ? !stays : comes_down;
  end.contrary_samples = contradicts && !fresh ? end.contrary_samples + 1 : 0;
  end.contrary_secs = end.contrary_samples > 1 ? end.contrary_secs + step_secs : 0;
  constexpr double kRounding = 1e-6;  // s, of stamps
  const bool lasted = end.contrary_samples >= settings.least_samples &&
                      end.contrary_secs >= settings.least_secs - kRounding;
  if (lasted) end.contrary_samples = 0;
  Follow(end, fresh ? comes_down : end.on != lasted, fresh, step_secs, settings);
}

void FootContacts::Place(Side side, double stature, const Settings& settings) {
  const Vector2d heel = motion_.at(side, kHeelPoint).head<2>();
  const Vector2d ball = motion_.at(side, kBallPoint).head<2>();
  const Vector2d tip = motion_.at(side, kTipPoint).head<2>();
  const ContactEnd& heel_end = ends_[side][kHeel];
  const ContactEnd& fore_end = ends_[side][kForefoot];

  // Midpoint of the ends in contact (joint-loads.md 2.5), moving smoothly after an end has changed.
  const double of_heel = heel_end.weight(), of_fore = fore_end.weight();
  const double flat = std::min(of_heel, of_fore), most = std::max(of_heel, of_fore);
  FootOnGround& foot = feet_[side];
  foot.center = 0.5 * (heel + tip);
  if (most > 0) {
    foot.center =
        (flat * foot.center + (of_heel - flat) * heel + (of_fore - flat) * 0.5 * (ball + tip)) /
        most;
  }
  foot.weight = touches(side) ? std::max(most, kMinWeight) : most;

  polygons_[side] = {};
  if (!touches(side)) return;
  const double from = heel_end.on ? 0 : 1 - settings.forefoot_part;
  const double to = fore_end.on ? 1 : settings.heel_part;
  const Vector2d along = tip - heel;
  const double length = along.norm();
  const Vector2d forward = length > 0 ? Vector2d(along / length) : Vector2d(1, 0);
  const Vector2d aside =
      settings.half_width_of_stature * stature * Vector2d(-forward.y(), forward.x());
  polygons_[side] = ConvexHull({heel + from * along - aside, heel + to * along - aside,
                                heel + to * along + aside, heel + from * along + aside},
                               4);
}

void FootContacts::Update(const BodySample& sample, const urdf::LinkPoses& links,
                          const urdf::Skeleton& skeleton, double floor_z,
                          const Settings& settings) {
  const double step_secs = Secs(sample.stamp_nanos - last_nanos_);
  if (has_last_ && step_secs == 0) return;
  const bool fresh = !has_last_ || step_secs < 0 || step_secs > kLongestGapSecs;
  motion_.Update(sample, links, skeleton);
  for (const Side side : {kRight, kLeft}) {
    ContactEnd& heel = ends_[side][kHeel];
    ContactEnd& forefoot = ends_[side][kForefoot];
    if (sample.foot_contacts) {
      const FootContactFlags& flags = (*sample.foot_contacts)[side];
      Follow(heel, flags.heel, fresh, step_secs, settings);
      Follow(forefoot, flags.forefoot, fresh, step_secs, settings);
    } else {
      const auto judge = [&](ContactEnd& end, FootPoint point) {
        Judge(end, motion_.at(side, point).z() - floor_z, motion_.speed(side, point), fresh,
              step_secs, settings);
      };
      judge(heel, kHeelPoint);
      judge(forefoot, motion_.lower_forefoot(side));
    }
    // A foot in the air carries nothing, also during the ramps of its ends.
    if (!touches(side)) heel.ramp = forefoot.ramp = 0;
    Place(side, skeleton.height, settings);
  }
  std::array<Vector2d, kMaxSupportPoints> corners;
  std::size_t count = 0;
  for (const SupportPolygon& polygon : polygons_) {
    for (std::size_t i = 0; i < polygon.size; ++i) corners[count++] = polygon.corners[i];
  }
  support_ = ConvexHull(corners, count);
  has_last_ = true;
  last_nanos_ = sample.stamp_nanos;
}

}  // namespace kinescope::loads
