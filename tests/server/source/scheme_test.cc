#include "server/source/scheme.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/subject/subject.h"

namespace kinescope::app {
namespace {

TEST(Scheme, IsRecognisedByTheBeginningOfTheUrl) {
  EXPECT_EQ(KindOfSource("udp://:9763"), SourceKind::kUdp);
  EXPECT_EQ(KindOfSource("tcp://10.0.0.5:9763"), SourceKind::kTcp);
  EXPECT_EQ(KindOfSource("ros:/tf"), SourceKind::kGraph);
  EXPECT_EQ(KindOfSource("demo:walk"), SourceKind::kSubject);
  EXPECT_EQ(KindOfSource("pose:right_elbow=90"), SourceKind::kPose);
  for (const char* file :
       {"take.mvnx", "-", "", "/data/demo:1.mvnx", "./ros:x", "demo", "./pose:x", "pose"}) {
    EXPECT_EQ(KindOfSource(file), SourceKind::kFile) << file;
  }
  EXPECT_EQ(WithoutScheme("demo:walk"), "walk");
  EXPECT_EQ(WithoutScheme("take.mvnx"), "take.mvnx");
}

TEST(Scheme, IsLiveForNetworkAndRosSources) {
  for (const char* live : {"udp:9763", "tcp:9763", "ros:"}) EXPECT_TRUE(IsLiveUrl(live)) << live;
  for (const char* not_live : {"demo:lift", "pose:t_pose", "take.mvnx"}) {
    EXPECT_FALSE(IsLiveUrl(not_live)) << not_live;
  }
}

TEST(Scheme, OfGeneratedSamplesIsThatOfTheSubject) {
  for (const char* generated : {"demo:lift", "pose:t_pose"}) EXPECT_TRUE(IsSubjectUrl(generated));
  for (const char* other : {"take.mvnx", "udp://:1", "ros:"}) EXPECT_FALSE(IsSubjectUrl(other));
}

TEST(Scheme, ListsEveryMotionAndAPoseInTheHelp) {
  for (const std::string& motion : subject::MotionNames()) {
    EXPECT_THAT(SourceKinds(), ::testing::HasSubstr(motion));
  }
  for (const std::string& kinds : {SourceKinds(), RecordedSourceKinds()}) {
    EXPECT_THAT(kinds, ::testing::HasSubstr("pose:right_elbow=90"));
  }
}

}  // namespace
}  // namespace kinescope::app
