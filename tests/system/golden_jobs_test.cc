// A golden case whose process crashes or hangs fails alone.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <future>
#include <string>

#include "tests/system/golden_fixture.h"
#include "tests/system/reader_of.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::Golden;
using ::testing::HasSubstr;
using testing::ProgramResult;

class GoldenJobs : public testing::GoldenCheck {
 protected:
  // A recording that is a named pipe: whoever opens it waits for a writer.
  void WriteCaseThatWaits(const std::string& name) const {
    ASSERT_EQ(::mkfifo((case_ / (name + ".mvnx")).c_str(), 0600), 0);
    WriteCase(name, "source: " + name + ".mvnx\nsize: 64x64\n");
  }
};

TEST_F(GoldenJobs, KeepTheOrderOfTheSuite) {
  for (const std::string name : {"a", "c", "d", "e"}) {
    WriteCase(name, "source: demo:n_pose\nsize: 64x64\n");
  }
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  const ProgramResult one = Check({"--jobs", "1"}), many = Check({"--jobs", "5"});
  EXPECT_EQ(one.exit_code, 0) << one.out << one.err;
  EXPECT_EQ(one.out, many.out);
  EXPECT_THAT(many.out, ::testing::StartsWith("a  "));
}

TEST_F(GoldenJobs, EndACaseThatHangsAndCompareTheOthers) {
  WriteCaseThatWaits("a_hangs");
  const ProgramResult result = Check({"--jobs", "1", "--case_limit_secs", "3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("a_hangs.yaml: was not finished within 3 s (--case_limit_secs)"),
                    HasSubstr("bend                     same"),
                    HasSubstr("1 of 2 pictures could not be compared")));
}

TEST_F(GoldenJobs, CompareTheOthersWhenACaseCrashes) {
  WriteCaseThatWaits("a_crashes");
  auto check = std::async(std::launch::async, [&] { return Check({"--jobs", "1"}); });
  const fs::path pipe = case_ / "a_crashes.mvnx";
  const int writer = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC);  // returns when it is read
  ASSERT_GE(writer, 0);
  ASSERT_EQ(::kill(testing::ReaderOf(pipe), SIGSEGV), 0);
  ::close(writer);
  const ProgramResult result = check.get();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("a_crashes.yaml: the process that drew it ended with signal 11"),
                    HasSubstr("bend                     same")));
}

TEST_F(GoldenJobs, AcceptTheOthersWhenACaseHangs) {
  WriteCaseThatWaits("a_hangs");
  WriteCase("c", "source: demo:n_pose\nsize: 64x64\n");
  const ProgramResult result = Golden({"update", case_, "--jobs=1", "--case_limit_secs=3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("a_hangs                  NOT ACCEPTED"), HasSubstr("within 3 s"),
                    HasSubstr("bend                     unchanged"),
                    HasSubstr("c                        accepted for the first time")));
  EXPECT_EQ(Check({"c"}).exit_code, 0);
}

TEST_F(GoldenJobs, SayWhyNothingCanBeDrawn) {
  const ProgramResult result =
      testing::Kinescope({"golden", "check", case_, "--out", case_ / "out", "--backend", "egl"},
                         {"CI=", "__EGL_VENDOR_LIBRARY_DIRS=/nowhere"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("EGL"));
}

}  // namespace
}  // namespace kinescope
