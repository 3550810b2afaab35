// Any numbers as samples of a person, any text as a load: what is called a class has a finite
// ratio, what is unknown has a reason, and whatever text is taken makes sense.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "core/system/check.h"
#include "server/loads/load_estimator.h"

namespace loads_fuzz {
namespace {

using namespace kinescope;
using namespace kinescope::loads;

// Numbers of the input one after the other, and again from its start.
class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  double Next() {
    double number = 0;
    if (at_ + sizeof number > size_) at_ = 0;
    std::memcpy(&number, data_ + at_, std::min(sizeof number, size_));
    at_ += sizeof number;
    return number;
  }
  Eigen::Vector3d Vector() {
    const double x = Next(), y = Next();
    return {x, y, Next()};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

BodySample SampleOf(Numbers& numbers) {
  BodySample sample;
  for (SegmentState& segment : sample.segments) {
    segment.position = numbers.Vector();
    segment.orientation.coeffs() << numbers.Vector(), numbers.Next();
    segment.velocity = numbers.Vector();
    segment.acceleration = numbers.Vector();
    segment.angular_velocity = numbers.Vector();
    segment.angular_acceleration = numbers.Vector();
  }
  sample.has_linear = sample.has_angular = numbers.Next() >= 0;
  return sample;
}

void CheckLoads(const LoadResult& result) {
  for (const JointLoad& load : result.loads) {
    if (load.load_class == LoadClass::kUnknown) {
      KINESCOPE_CHECK(!load.reason.empty());
    } else {
      KINESCOPE_CHECK(std::isfinite(load.ratio) && load.ratio >= 0);
      KINESCOPE_CHECK(load.is_of_compression || load.capacity > 0);
      KINESCOPE_CHECK(load.shown_ratio >= 0 && load.band != LoadClass::kUnknown);
    }
  }
  for (const JointForce& joint : result.forces.joints) {
    KINESCOPE_CHECK(!joint.why_unknown.empty() ||
                    (joint.moment.allFinite() && joint.force.allFinite()));
  }
  KINESCOPE_CHECK(!result.cop || result.cop->allFinite());
}

void EstimateFrom(const std::uint8_t* data, std::size_t size) {
  static const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  static const urdf::BodyParameters body = urdf::MakeBodyParameters({}, skeleton);
  Numbers numbers(data, size);
  LoadEstimator estimator;
  LoadSettings settings;
  settings.metric = data[0] % 2 == 0 ? LoadMetric::kTotal : LoadMetric::kOverload;
  settings.hands.is_known = true;
  settings.hands.mass_kg = {5, 0};
  std::int64_t stamp = 1;
  for (int i = 0; i < 4; ++i) {
    BodySample sample = SampleOf(numbers);
    sample.stamp_nanos = stamp += data[static_cast<std::size_t>(i) % size] * 1'000'000;
    CheckLoads(estimator.Update(sample, LinkPosesOf(sample), {skeleton, body}, settings));
  }
}

void ParseTexts(const std::string& text) {
  try {
    KINESCOPE_CHECK(FindDefect(ParseHandLoad(text)).empty());
  } catch (const std::runtime_error& refused) {
    KINESCOPE_CHECK(refused.what()[0] != '\0');
  }
  try {
    urdf::BodyDescription body;
    body.added_masses = {urdf::ParseAddedMass(text)};
    KINESCOPE_CHECK(urdf::FindDefect(body).empty());
  } catch (const std::invalid_argument& refused) {
    KINESCOPE_CHECK(refused.what()[0] != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  ParseTexts({reinterpret_cast<const char*>(data), size});
  EstimateFrom(data, size);
  return 0;
}

}  // namespace loads_fuzz
