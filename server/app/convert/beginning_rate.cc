#include "server/app/convert/beginning_rate.h"

#include <cmath>

#include "core/near_whole.h"
#include "core/system/clocks.h"
#include "server/mvn/datagram.h"

namespace kinescope::app {

void BeginningRate::Add(const BodySample& sample) {
  last_ = {sample.stamp_nanos, sample.time_code_millis, sample.counter};
  if (samples_++ == 0) first_ = last_;
  frames_.Add(static_cast<int>(mvn::Type::kPose), sample.counter,
              static_cast<std::uint32_t>(sample.time_code_millis),
              {sample.stamp_nanos, sample.stamp_nanos});
}

// From the first to the last: by the sender's clock, which does not tremble, else by the stamps.
double BeginningRate::Secs() const {
  constexpr double kClockMayDiffer = 0.2;
  const double stamped = kinescope::Secs(last_.stamp_nanos - first_.stamp_nanos);
  const double sent = 1e-3 * static_cast<double>(last_.time_code_millis - first_.time_code_millis);
  return std::abs(sent - stamped) <= kClockMayDiffer * stamped ? sent : stamped;
}

double BeginningRate::rate_hz() const {
  const double secs = Secs();
  if (samples_ == 0 || !(secs > 0)) return 0;
  const double frames = last_.counter > first_.counter
                            ? static_cast<double>(last_.counter - first_.counter) / counter_step()
                            : static_cast<double>(samples_ - 1);
  return NearWhole(frames / secs);
}

}  // namespace kinescope::app
