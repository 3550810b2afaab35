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
  for (const char* file : {"take.mvnx", "-", "", "/data/demo:1.mvnx", "./ros:x", "demo"}) {
    EXPECT_EQ(KindOfSource(file), SourceKind::kFile) << file;
  }
  EXPECT_EQ(WithoutScheme("demo:walk"), "walk");
  EXPECT_EQ(WithoutScheme("take.mvnx"), "take.mvnx");
}

TEST(Scheme, IsLiveForNetworkAndRosSources) {
  for (const char* live : {"udp:9763", "tcp:9763", "ros:"}) EXPECT_TRUE(IsLiveUrl(live)) << live;
  for (const char* not_live : {"demo:lift", "take.mvnx"}) EXPECT_FALSE(IsLiveUrl(not_live));
}

TEST(Scheme, ListsEveryMotionInTheHelp) {
  for (const std::string& motion : subject::MotionNames()) {
    EXPECT_THAT(SourceKinds(), ::testing::HasSubstr(motion));
  }
}

}  // namespace
}  // namespace kinescope::app
