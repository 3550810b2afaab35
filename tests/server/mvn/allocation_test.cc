// The input path allocates nothing per pose datagram. A program of its own, since it counts every
// allocation of the process.
#include <gtest/gtest.h>

#include "server/mvn/assembler.h"
#include "server/mvn/encode.h"
#include "tests/allocations.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

struct CountingSink : SampleSink {
  int samples = 0;
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample&) override { ++samples; }
};

TEST(InputPath, AllocatesNothingPerValidOrRejectedDatagram) {
  testing::RandomValues random(5);
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const TypeSet every_type =
      MakeTypeSet({Type::kEulerPose, Type::kPose, Type::kMarkers, Type::kJointAngles, Type::kLinear,
                   Type::kAngular, Type::kTrackers, Type::kCenterOfMass, Type::kTimeCode});
  std::vector<std::vector<std::string>> sent;
  for (std::uint32_t counter = 1; counter <= 200; ++counter) {
    sent.push_back(EncodeSample(testing::RandomFullSample(random, counter), every_type,
                                urdf::LandmarksOf(skeleton)));
    ASSERT_EQ(sent.back().size(), 9U);
    sent.back().push_back(R"({"sync":"start"})");
    sent.back().push_back(sent.back().front().substr(0, 700));
  }
  Assembler assembler;
  CountingSink sink;
  std::int64_t now = 1'000'000'000;
  std::size_t before = 0;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (i == 20) before = kinescope::testing::Allocations();  // the stream itself is there
    for (const std::string& datagram : sent[i]) assembler.Add({}, datagram, {now, now}, sink);
    now += 4'000'000;
    assembler.Expire(now, sink);
  }
  const std::size_t counted = kinescope::testing::Allocations() - before;
  EXPECT_EQ(counted, 0U);
  EXPECT_EQ(sink.samples, 200);
}

}  // namespace
}  // namespace kinescope::mvn
