#include "server/app/render/moments.h"

namespace kinescope::app {

std::optional<Moment> Moments::Next() {
  if (clip_ && !clip_->Has(next_picture_)) clip_.reset();
  if (still_nanos_ && (!clip_ || *still_nanos_ <= clip_->NanosOf(next_picture_))) {
    const Moment still = {*still_nanos_, std::nullopt};
    still_nanos_.reset();
    return still;
  }
  if (!clip_) return std::nullopt;
  const Moment moment = {clip_->NanosOf(next_picture_), next_picture_};
  ++next_picture_;
  return moment;
}

}  // namespace kinescope::app
