// What CI servers are told of a check: annotations and summary of GitHub, JUnit for all others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_github.h"
#include "server/app/golden/golden_junit.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TempFolder;

// A case whose right knee has another class, or moved.
CaseVerdict Differs(const std::string& name, FindingKind kind, const std::string& text) {
  CaseVerdict verdict;
  verdict.name = name;
  verdict.file = "golden/" + name + ".yaml";
  verdict.line = 3;
  verdict.outcome = Outcome::kDiffers;
  verdict.accepted_pixels = "0";
  verdict.now.emplace();
  verdict.findings = {{kind, "right_knee", "", "", 1, "right_knee: " + text}};
  return verdict;
}

CaseVerdict Weak(const std::string& name) {
  CaseVerdict verdict;
  verdict.name = name;
  verdict.changes.environment = {"backend: was osmesa, is egl"};
  verdict.notes = {"weaker check, in another environment: backend: was osmesa, is egl"};
  return verdict;
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// GitHub shows ten of a step, and no others: so they must be the worst.
TEST(GithubOutput, AnnotatesTheWorstAndSaysThatThereAreMore) {
  std::vector<CaseVerdict> verdicts;
  for (int i = 0; i < 12; ++i) {
    verdicts.push_back(Differs("moved_" + std::to_string(i), FindingKind::kMoved, "moved by 3 px"));
  }
  verdicts.push_back(Differs("z_class", FindingKind::kClass, "expected low, found high"));
  const std::string annotations = ToAnnotations(verdicts, "out dir");
  EXPECT_EQ(Count(annotations, "::error "), 10u);
  EXPECT_THAT(annotations,
              AllOf(HasSubstr("The worst 9 are shown here; out dir/report.html shows all"),
                    HasSubstr("::error file=golden/z_class.yaml,line=3,title=golden z_class"),
                    HasSubstr("Accept: kinescope golden accept 'out dir' z_class")));
}

TEST(GithubOutput, StaysWithinTheLimitsOfGithub) {
  std::vector<CaseVerdict> verdicts;
  for (int i = 0; i < 3000; ++i) {
    CaseVerdict verdict = Differs("case_" + std::to_string(i), FindingKind::kMoved, "moved");
    verdict.findings.front().text += std::string(2000, 'x');
    for (int line = 0; line < 20; ++line) verdict.notes.push_back("note " + std::to_string(line));
    verdicts.push_back(std::move(verdict));
  }
  const std::string summary = ToMarkdown(verdicts, "out");
  EXPECT_LT(summary.size(), 1024u * 1024u);
  EXPECT_THAT(summary, HasSubstr(" more\n"));
  EXPECT_THAT(summary, HasSubstr("</details>"));
  const std::string annotations = ToAnnotations({verdicts.front()}, "out");
  EXPECT_EQ(Count(annotations, "%0A"), 8u) << "eight lines, and the command";
}

TEST(GithubOutput, WarnsOfAWeakerCheckThoughAllAreTheSame) {
  const std::vector<CaseVerdict> verdicts = {Weak("a"), Weak("b"), CaseVerdict()};
  const std::string words = "weaker check: 2 pictures were compared in another environment";
  EXPECT_THAT(ToAnnotations(verdicts, "out"),
              AllOf(HasSubstr("::warning title=golden::" + words),
                    HasSubstr("backend: was osmesa, is egl"), Not(HasSubstr("::error"))));
  EXPECT_THAT(ToMarkdown(verdicts, "out"), AllOf(HasSubstr("All 3 pictures"), HasSubstr(words)));
  EXPECT_EQ(ToAnnotations({CaseVerdict()}, "out"), "");
  EXPECT_THAT(ToMarkdown({CaseVerdict()}, "out"), Not(HasSubstr("weaker")));
}

class JunitTest : public ::testing::Test {
 protected:
  ~JunitTest() override {
    unsetenv("GITLAB_CI");
    unsetenv("CI_PROJECT_DIR");
  }
  // The path that a server is given for the picture of a case.
  std::string Attachment() const {
    const fs::path out = project_ / "run";
    fs::create_directories(out);
    std::ofstream(CompositeOf(out, "knee")) << "a picture";
    const std::string xml =
        ToJunit({Differs("knee", FindingKind::kMoved, "moved")}, project_ / "golden", out);
    const std::string before = "[[ATTACHMENT|";
    const std::size_t begin = xml.find(before);
    if (begin == std::string::npos) return xml;
    return xml.substr(begin + before.size(), xml.find("]]") - begin - before.size());
  }

  TempFolder folder_;
  const fs::path project_ = folder_ / "project";
};

TEST_F(JunitTest, NamesThePictureAsEachServerReadsIt) {
  EXPECT_EQ(Attachment(), (project_ / "run/knee.compare.png").string()) << "Jenkins";
  setenv("GITLAB_CI", "true", 1);
  setenv("CI_PROJECT_DIR", project_.c_str(), 1);
  EXPECT_EQ(Attachment(), "run/knee.compare.png") << "from the project, wherever the job stands";
}

TEST_F(JunitTest, HasWhatMakesAPassingTestWeaker) {
  const std::string xml = ToJunit({Weak("a"), CaseVerdict()}, "golden", "out");
  EXPECT_THAT(xml, AllOf(HasSubstr("tests=\"2\" failures=\"0\" errors=\"0\""),
                         HasSubstr("<system-out>weaker check, in another environment")));
  EXPECT_EQ(Count(xml, "<system-out>"), 1u);
}

}  // namespace
}  // namespace kinescope::app
