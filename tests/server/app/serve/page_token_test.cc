#include "server/app/serve/page_token.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "core/system/errors.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr char kLongEnough[] = "0123456789abcdef";

std::string ErrorOf(const std::string& option, const std::string& file) {
  try {
    FindPageToken(kOperatorToken, {option, ""}, file, nullptr);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

class PageTokenTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& text, fs::perms perms = fs::perms::owner_read) {
    const std::string path = (folder_.path() / "token").string();
    std::ofstream(path) << text;
    fs::permissions(path, perms);
    return path;
  }
  kinescope::testing::TempFolder folder_;
};

TEST_F(PageTokenTest, ComesFromTheFirstLineOfItsFile) {
  const PageToken token =
      FindPageToken(kOperatorToken, {}, Write("0123456789abcdef \r\nmore\n"), "ignored");
  EXPECT_EQ(token.text, kLongEnough);
  EXPECT_THAT(token.origin, HasSubstr("--token_file="));
  EXPECT_THAT(token.how_to_see, HasSubstr("cat "));
  EXPECT_THAT(token.notes, IsEmpty());
}

TEST_F(PageTokenTest, OfAMissingFileIsRandomAndStaysTheSame) {
  const std::string path = (folder_.path() / "made").string();
  const PageToken made = FindPageToken(kOperatorToken, {}, path, nullptr);
  EXPECT_GE(made.text.size(), 32u);
  EXPECT_THAT(made.notes, ElementsAre(HasSubstr("made with a random token")));
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  const PageToken again = FindPageToken(kOperatorToken, {}, path, nullptr);
  EXPECT_EQ(again.text, made.text);
  EXPECT_THAT(again.notes, IsEmpty());
}

TEST_F(PageTokenTest, ThatOtherUsersCanReadIsReported) {
  const auto perms = fs::perms::owner_read | fs::perms::others_read;
  EXPECT_THAT(FindPageToken(kOperatorToken, {}, Write(kLongEnough, perms), nullptr).notes,
              ElementsAre(HasSubstr("chmod 600")));
}

TEST_F(PageTokenTest, IsReportedToBeVisibleAccordingToWhereItWasGiven) {
  const auto given_as = [](const std::string& origin) {
    return FindPageToken(kOperatorToken, {kLongEnough, origin}, "", nullptr);
  };
  EXPECT_THAT(given_as("--token").notes,
              ElementsAre(AllOf(StartsWith("--token: "), HasSubstr("processes"))));
  EXPECT_THAT(given_as("~token").notes,
              ElementsAre(AllOf(StartsWith("~token: "), HasSubstr("ROS master"))));
  EXPECT_THAT(given_as("lab.yaml:3: token").notes, IsEmpty());
  EXPECT_EQ(given_as("lab.yaml:3: token").origin, "lab.yaml:3: token");
}

TEST_F(PageTokenTest, ComesFromTheEnvironmentIfNoOptionIsGiven) {
  EXPECT_EQ(FindPageToken(kOperatorToken, {}, "", kLongEnough).text, kLongEnough);
  EXPECT_EQ(FindPageToken(kOperatorToken, {}, "", kLongEnough).origin, "KINESCOPE_TOKEN");
  EXPECT_EQ(FindPageToken(kOperatorToken, {"of-the-option", ""}, "", kLongEnough).text,
            "of-the-option");
  EXPECT_EQ(FindPageToken(kOperatorToken, {}, "", "").text, "");
  EXPECT_EQ(FindPageToken(kOperatorToken, {}, "", nullptr).text, "");
}

TEST_F(PageTokenTest, OfViewersHasNamesOfItsOwn) {
  EXPECT_EQ(FindPageToken(kViewerToken, {}, "", kLongEnough).origin, "KINESCOPE_VIEWER_TOKEN");
  const std::string path = Write(kLongEnough);
  EXPECT_EQ(FindPageToken(kViewerToken, {}, path, nullptr).origin, "--viewer_token_file=" + path);
  const PageToken given = FindPageToken(kViewerToken, {kLongEnough, ""}, "", nullptr);
  EXPECT_EQ(given.origin, "--viewer_token");
  EXPECT_THAT(given.notes, ElementsAre(AllOf(StartsWith("--viewer_token: "),
                                             HasSubstr("prefer --viewer_token_file"),
                                             HasSubstr("KINESCOPE_VIEWER_TOKEN"))));
}

std::string ErrorOfValue(const std::string& given_as, const std::string& value) {
  try {
    CheckTokenIsGiven(given_as, value);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST_F(PageTokenTest, IsNotSilentlyMissingIfItsOptionIsEmpty) {
  EXPECT_THAT(ErrorOfValue("--token_file", ""), StartsWith("--token_file=: empty"));
  EXPECT_THAT(ErrorOfValue("--token", ""), StartsWith("--token=: empty"));
  EXPECT_THAT(ErrorOfValue("lab.yaml:3: token_file", ""), HasSubstr("empty"));
  EXPECT_EQ(ErrorOfValue("~token_file", ""), "") << "launch files set every parameter";
  EXPECT_EQ(ErrorOfValue("", ""), "") << "not given";
  EXPECT_EQ(ErrorOfValue("--token_file", "file"), "");
}

TEST_F(PageTokenTest, IsRejectedIfItsFileHasNone) {
  EXPECT_THAT(ErrorOf("", Write("\n")), HasSubstr("the first line is empty"));
  EXPECT_THAT(ErrorOf("", folder_.path().string()), HasSubstr("cannot read a token"));
  EXPECT_THAT(ErrorOf("", Write(std::string(4097, 'a'))), HasSubstr("4097 bytes"));
  EXPECT_THAT(ErrorOf("", "/dev/zero"), HasSubstr("a pipe or a device"));
  const std::string pipe = (folder_.path() / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(ErrorOf("", pipe), HasSubstr("a pipe or a device"));
  EXPECT_THAT(ErrorOf("", "/nowhere/token"), HasSubstr("--token_file=/nowhere/token: cannot make"));
  EXPECT_THAT(ErrorOf("a", "b"), HasSubstr("remove --token"));
}

}  // namespace
}  // namespace kinescope::app
