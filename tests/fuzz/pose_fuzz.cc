// Any text as a written pose: a reason in one line, or a pose that stands on the floor, is finite
// and reads the same again.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/subject/pose_text.h"
#include "server/subject/subject.h"
#include "tests/fuzz/invariants.h"
#include "urdf/kinematics.h"

namespace pose_fuzz {
namespace {

using namespace kinescope;

void CheckRefusal(const std::string& reason) {
  constexpr std::size_t kLongestLine = 1000;
  KINESCOPE_CHECK(reason.rfind("pose: ", 0) == 0 && reason.size() < kLongestLine);
  for (const char c : reason) KINESCOPE_CHECK(static_cast<unsigned char>(c) >= ' ');
}

void CheckPose(const subject::WrittenPose& pose) {
  const subject::WrittenPose again = subject::ParsePose(pose.text);
  KINESCOPE_CHECK(again.text == pose.text && again.base == pose.base);
  KINESCOPE_CHECK(again.values == pose.values);
  const auto motion = subject::MakePose(pose.text);
  const BodySample sample = motion->At(0);
  fuzz::CheckSample(sample);
  const double lowest = urdf::LowestSolePoint(*motion->character().skeleton, LinkPosesOf(sample));
  KINESCOPE_CHECK(lowest > -1e-9 && lowest < 0.2);  // a ball of a foot may be lower
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  subject::WrittenPose pose;
  try {
    pose = subject::ParsePose(text);
  } catch (const SourceError& error) {
    CheckRefusal(error.what());
    return 0;
  }
  CheckPose(pose);
  return 0;
}

}  // namespace pose_fuzz
