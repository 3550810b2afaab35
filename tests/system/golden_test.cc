// The tester tested: a golden check that cannot fail is worth nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "server/app/golden/golden_lock.h"
#include "tests/folders.h"
#include "tests/shared_data.h"
#include "tests/system/golden_fixture.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::ExpectRefusal;
using testing::Golden;
using testing::GoldenCheck;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::ProgramResult;
using testing::TempFolder;

TEST_F(GoldenCheck, AcceptsThePictureThatItWrote) {
  EXPECT_EQ(Check().exit_code, 0) << Check().out;
}

TEST_F(GoldenCheck, NamesTheJointWhoseClassDiffers) {
  ReplaceInLock("\"left_wrist\",\"class\":\"low\"", "\"left_wrist\",\"class\":\"high\"");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("left_wrist: expected high (red), found low (green)"),
                                HasSubstr("The program has changed it")));
}

TEST_F(GoldenCheck, NamesTheJointsWhoseLoadsDifferForAnotherPerson) {
  AddToCase("sex: female\nmass: 120");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("7 loads (l5_s1, "), HasSubstr("found 3 high (red)"),
                                HasSubstr("load ratios changed by up to")));
  const auto run = nlohmann::json::parse(testing::ReadFile(case_ / "out/run.json"));
  std::set<std::string> named;
  for (const auto& finding : run.at("cases").at(0).at("findings")) {
    if (finding.at("kind") == "class") named.insert(finding.at("object"));
  }
  EXPECT_EQ(named.size(), 7u);
}

TEST_F(GoldenCheck, DetectsDifferentPixelsAndShowsThem) {
  AddToCase("background: '#e0e0e0'");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("pixels: "), HasSubstr("background: added, #e0e0e0"),
                                HasSubstr("says nothing about the program")));
  EXPECT_TRUE(fs::exists(case_ / "out/bend.actual.png"));
  EXPECT_TRUE(fs::exists(case_ / "out/bend.diff.png"));
}

// A picture that was changed by hand, or by a merge.
TEST_F(GoldenCheck, KnowsThePictureThatWasAccepted) {
  render::Image image = render::ReadPng(case_ / "bend.png");
  for (std::size_t i = 0; i < 400; ++i) image.rgba[i] ^= 0x80;
  render::WritePng(case_ / "bend.png", image);
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("is not the picture that golden.lock names"),
                                Not(HasSubstr("The program has changed it"))));
  EXPECT_THAT(Golden({"update", case_}).out, HasSubstr("is written again"));
  EXPECT_EQ(Check().exit_code, 0);
}

TEST_F(GoldenCheck, SaysWhichSizeThePictureHas) {
  std::ofstream(case_ / "bend.yaml")
      << "source: demo:lift\ntime: 2.5\ncamera: right\nsize: 160x90\n";
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("size of the picture: expected 320x180, found 160x90"));
}

// Nothing is known of the picture then: that is no difference.
TEST_F(GoldenCheck, DoesNotCompareWhatIsNotAccepted) {
  fs::remove(case_ / "bend.png");
  fs::remove(case_ / "golden.lock");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, AllOf(HasSubstr("bend                     NOT COMPARED"),
                                HasSubstr("bend.yaml: not accepted yet"),
                                HasSubstr("golden accept " + (case_ / "out").string() + " bend"),
                                HasSubstr("1 of 1 picture could not be compared")));
  EXPECT_TRUE(fs::exists(case_ / "out/bend.actual.png")) << "to be looked at";
}

// Git LFS may not have fetched it; golden.lock knows what it is.
TEST_F(GoldenCheck, ComparesAPictureThatIsNotHere) {
  for (const bool is_pointer : {false, true}) {
    fs::remove(case_ / "bend.png");
    if (is_pointer) WritePointer(app::ReadLock(case_ / "golden.lock")["bend"].file_sha256);
    const ProgramResult result = Check();
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_THAT(result.out, HasSubstr("compared by golden.lock alone"));
  }
  WritePointer(std::string(64, '0'));
  EXPECT_THAT(Check().out, HasSubstr("to another picture than golden.lock names"));
  fs::remove(case_ / "bend.png");
  AddToCase("hide: cop");
  const ProgramResult differs = Check();
  EXPECT_EQ(differs.exit_code, 1);
  EXPECT_THAT(differs.out, AllOf(HasSubstr("centre of pressure: is missing"),
                                 HasSubstr("how many is not known")));
}

TEST_F(GoldenCheck, ComparesTheOthersWhenACaseCannotBeDrawn) {
  WriteCase("a_key", "source: demo:lift\ncolour: red\n");
  WriteCase("b_cut", "source: demo:lift\ncamera: {front");
  WriteCase("c_missing", "source: nowhere.mvnx\n");
  WriteCase("d_late", "source: demo:lift\ntime: 800000\n");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("a_key.yaml:2"), HasSubstr("colour"), HasSubstr("b_cut.yaml"),
                    HasSubstr("c_missing.yaml:1: source"), HasSubstr("nowhere.mvnx"),
                    HasSubstr("d_late"), HasSubstr("bend                     same"),
                    HasSubstr("4 of 5 pictures could not be compared")));
}

TEST_F(GoldenCheck, NamesTheLineThatIsWrong) {
  WriteCase("a_key", "source: demo:lift\n\ncamra: right\n");
  WriteCase("b_cut", "source: demo:lift\nsize: 64x64\ncamera: {front");
  WriteCase("c_missing", "camera: front\nsource: nowhere.mvnx\n");
  WriteCase("d_late", "source: demo:lift\ntime: 800000\n");
  WriteCase("e_bomb",
            "source: demo:lift\n"
            "a: &a [x, x, x, x, x, x, x, x, x]\nb: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a]\n"
            "c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b]\nd: [*c, *c, *c, *c, *c, *c, *c, *c]\n");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, HasSubstr("unknown option 'camra'; nearest: camera (see `kinescope"));
  EXPECT_THAT(result.out, HasSubstr("c_missing.yaml:2: source '"));
  EXPECT_THAT(result.out, HasSubstr("d_late.yaml:2: golden case d_late: time: 800000"));
  EXPECT_THAT(result.out, HasSubstr("bend                     same"));
  const auto run = nlohmann::json::parse(testing::ReadFile(case_ / "out/run.json"));
  const std::map<std::string, int> expected = {{"a_key", 3},  {"b_cut", 3},  {"c_missing", 2},
                                               {"d_late", 2}, {"e_bomb", 3}, {"bend", 1}};
  std::map<std::string, int> lines;
  for (const auto& verdict : run.at("cases")) lines[verdict.at("case")] = verdict.at("line");
  EXPECT_EQ(lines, expected) << result.out;
}

TEST_F(GoldenCheck, SaysThatTheAcceptedPictureIsDamaged) {
  const std::string whole = testing::ReadFile(case_ / "bend.png");
  for (const std::string& damaged : {whole.substr(0, whole.size() / 2), std::string("no PNG")}) {
    std::ofstream(case_ / "bend.png", std::ios::binary) << damaged;
    const ProgramResult result = Check();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, AllOf(HasSubstr("bend.png"), HasSubstr("cannot be read"),
                                  HasSubstr("what was drawn is what golden.lock names"),
                                  Not(HasSubstr("The program has changed it"))));
  }
}

// The name of an environment makes a check strong or weak; without one it is neither.
TEST_F(GoldenCheck, FailsIfTheAcceptedEnvironmentIsNotKnown) {
  app::GoldenLock lock = app::ReadLock(case_ / "golden.lock");
  lock["bend"].environment.clear();
  app::WriteLock(case_ / "golden.lock", lock);
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("does not say in which environment"),
                                Not(HasSubstr("weaker check"))));
  EXPECT_EQ(Golden({"accept", case_ / "out", "bend"}).exit_code, 0);
  EXPECT_EQ(Check().exit_code, 0);
}

TEST_F(GoldenCheck, LeavesNoFileThatLooksLikeACaseUnread) {
  std::ofstream(case_ / "side.yml") << "source: demo:lift\n";
  WriteCase("Bend", "source: demo:walk\nsize: 64x64\n");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("side.yml "), HasSubstr("is not read: a case is called NAME.yaml"),
                    HasSubstr("Bend.yaml: only upper and lower case tell it from bend.yaml"),
                    HasSubstr("bend.yaml: only upper and lower case tell it from Bend.yaml")));
}

TEST_F(GoldenCheck, FailsForAPictureThatBelongsToNoCase) {
  fs::copy(case_ / "bend.png", case_ / "former.png");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("former.png"), HasSubstr("belongs to no case")));
  EXPECT_EQ(Check({"bend"}).exit_code, 0) << "of the cases that are not chosen nothing is said";
}

TEST_F(GoldenCheck, NamesACaseWithInvalidUtf8InJson) {
  fs::remove(case_ / "bend.yaml");
  fs::remove(case_ / "bend.png");
  fs::remove(case_ / "golden.lock");
  WriteCase("n\xFF", "source: demo:lift\nsize: 32x32\n");
  const ProgramResult result = Check({"--json"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  const auto verdict = nlohmann::json::parse(result.out);
  EXPECT_EQ(verdict.at("case"), "n\uFFFD");
  EXPECT_EQ(verdict.at("outcome"), "not compared");
}

TEST_F(GoldenCheck, WritesJunitForServers) {
  WriteCase("a<b&", "source: nowhere.mvnx\n");
  WriteCase("n_pose", "source: demo:n_pose\nsize: 64x64\n");
  ASSERT_EQ(Golden({"update", case_, "n_pose"}).exit_code, 0);
  AddToCase("background: '#e0e0e0'");
  EXPECT_EQ(Check({"--junit", case_ / "junit.xml"}).exit_code, 2);
  const std::string xml = testing::ReadFile(case_ / "junit.xml");
  EXPECT_THAT(xml,
              AllOf(HasSubstr("tests=\"3\" failures=\"1\" errors=\"1\""),
                    HasSubstr("name=\"a&#60;b&#38;\""), HasSubstr("<error type=\"not compared\""),
                    HasSubstr("<failure type=\"differs\" message=\""),
                    HasSubstr("[[ATTACHMENT|" + (case_ / "out/bend.compare.png").string() + "]]")));
  EXPECT_THAT(xml, Not(HasSubstr("a<b")));
}

TEST_F(GoldenCheck, ReportsWhyItCannotWrite) {
  fs::create_directories(case_ / "out/bend.actual.png/a_folder");
  ExpectRefusal(Check(), "out/bend.actual.png: ");
  fs::remove(case_ / "golden.lock");
  fs::create_directory(case_ / "golden.lock");
  ExpectRefusal(Golden({"update", case_}), "golden.lock: ");
}

TEST_F(GoldenCheck, AcceptsOnlyWhatHasChangedAndSaysWhat) {
  const auto written_at = fs::last_write_time(case_ / "bend.png");
  const ProgramResult same = Golden({"update", case_});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_THAT(same.out, HasSubstr("unchanged"));
  EXPECT_EQ(fs::last_write_time(case_ / "bend.png"), written_at);
  AddToCase("mass: 120");
  EXPECT_THAT(Golden({"update", case_}).out,
              HasSubstr("accepted: picture, what it shows, case; check the picture"));
}

TEST_F(GoldenCheck, AcceptsTheOthersWhenACaseShowsNothing) {
  WriteCase("a_nothing",
            "source: demo:lift\nsize: 64x64\nfloor: off\nno_overlays: true\n"
            "hide: body,loads,com,cop,support,forces,hand_loads,shadows\n");
  WriteCase("c_new", "source: demo:n_pose\nsize: 64x64\n");
  const ProgramResult result = Golden({"update", case_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, AllOf(HasSubstr("a_nothing                NOT ACCEPTED"),
                                HasSubstr("shows nothing: all pixels have one colour"),
                                HasSubstr("c_new                    accepted for the first time")));
  EXPECT_FALSE(fs::exists(case_ / "a_nothing.png"));
}

TEST_F(GoldenCheck, AcceptsNothingInCi) {
  ExpectRefusal(Kinescope({"golden", "update", case_}, {"CI=true"}), "CI=true");
}

// On another machine, perhaps, which need not be able to draw.
TEST_F(GoldenCheck, TakesWhatARunHasDrawn) {
  AddToCase("hide: cop");
  WriteCase("c_new", "source: demo:n_pose\nsize: 64x64\n");
  ASSERT_EQ(Check().exit_code, 2);
  const ProgramResult one = Golden({"accept", case_ / "out", "bend"});
  EXPECT_EQ(one.exit_code, 0) << one.out << one.err;
  EXPECT_THAT(one.out, Not(HasSubstr("c_new")));
  const ProgramResult all = Golden({"accept", case_ / "out"});
  EXPECT_EQ(all.exit_code, 0) << all.out << all.err;
  EXPECT_THAT(all.out, HasSubstr("c_new                    accepted"));
  EXPECT_EQ(Check({"--strict"}).exit_code, 0) << Check().out;
  EXPECT_THAT(Golden({"accept", case_ / "out"}).out, HasSubstr("nothing to accept"));
}

TEST_F(GoldenCheck, TakesNothingThatIsNotOfTheRun) {
  AddToCase("hide: cop");
  ASSERT_EQ(Check().exit_code, 1);
  const auto refusal = [&] {
    const ProgramResult result = Golden({"accept", case_ / "out", "bend"});
    EXPECT_EQ(result.exit_code, 2);
    return result.out;
  };
  const std::string lock = testing::ReadFile(case_ / "golden.lock");
  AddToCase("mass: 90");
  EXPECT_THAT(refusal(), HasSubstr("its case is not that of the run (mass: added, 90)"));
  WriteCase("bend", "source: demo:lift\ntime: 2.5\ncamera: right\nsize: 320x180\nhide: cop\n");
  ReplaceInLock("\"pixels\": \"", "\"pixels\": \"0");
  EXPECT_THAT(refusal(), HasSubstr("another picture was accepted since the run"));
  std::ofstream(case_ / "golden.lock") << lock;
  ReplaceInLock("\"backend\":\"osmesa\"", "\"backend\":\"egl\"");
  EXPECT_THAT(refusal(), HasSubstr("another environment than bend (backend: was egl, is osmesa)"));
  std::ofstream(case_ / "golden.lock") << lock;
  render::WritePng(case_ / "out/bend.actual.png", render::ReadPng(case_ / "bend.png"));
  EXPECT_THAT(refusal(), HasSubstr("is not the picture of the run"));
  EXPECT_EQ(testing::ReadFile(case_ / "golden.lock"), lock);
  ExpectRefusal(Golden({"accept", case_ / "out", "bent"}), "nearest: bend");
  ExpectRefusal(Golden({"accept", case_}), "run.json");
}

TEST_F(GoldenCheck, TellsARecordingThatLostASampleFromAChangedProgram) {
  const fs::path recording = case_ / "walk.mvnx";
  ASSERT_EQ(Kinescope({"convert", "demo:walk", "--seconds", "0.3", "--out", recording}).exit_code,
            0);
  WriteCase("recorded", "source: walk.mvnx\ntime: 0\nsize: 320x180\n");
  ASSERT_EQ(Golden({"update", case_, "recorded"}).exit_code, 0);
  std::string text = testing::ReadFile(recording);
  const std::size_t last = text.rfind("<frame "), end = text.find("</frame>", last);
  ASSERT_NE(end, std::string::npos);
  std::ofstream(recording) << text.erase(last, end + 8 - last);
  const ProgramResult result = Check({"recorded"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("input source: the content of walk.mvnx has changed"),
                                HasSubstr("says nothing about the program")));
}

TEST_F(GoldenCheck, WritesAReportThatNeedsNothingElse) {
  WriteCase("a<b&", "source: nowhere.mvnx\n");
  AddToCase("hide: cop");
  EXPECT_EQ(Check().exit_code, 2);
  const std::string html = testing::ReadFile(case_ / "out/report.html");
  EXPECT_THAT(html, AllOf(HasSubstr("1 of 2 pictures differs, 1 could not be compared"),
                          HasSubstr("centre of pressure: is missing"), HasSubstr("a&#60;b&#38;"),
                          HasSubstr("golden accept " + (case_ / "out").string() + " bend"),
                          HasSubstr("href=\"data:image/png;base64,"), Not(HasSubstr("http://"))));
  EXPECT_THAT(html, Not(HasSubstr("a<b")));
}

// Names come from files: GitHub must not obey what they say.
TEST_F(GoldenCheck, TellsGithubWhereAndObeysNothing) {
  WriteCase("a,b%:", "source: nowhere.mvnx\nwhy: \"::add-mask::bend\"\n");
  AddToCase("hide: cop");
  const fs::path summary = case_ / "summary.md";
  const ProgramResult result =
      Kinescope({"golden", "check", case_, "--out", case_ / "out"},
                {"CI=true", "GITHUB_ACTIONS=true", "GITHUB_STEP_SUMMARY=" + summary.string()});
  EXPECT_EQ(result.exit_code, 2);
  const std::string token = result.out.substr(0, result.out.find('\n'));
  ASSERT_THAT(token, ::testing::StartsWith("::stop-commands::kinescope-"));
  const std::size_t resumed = result.out.find("::" + token.substr(17) + "::");
  ASSERT_NE(resumed, std::string::npos);
  EXPECT_LT(result.out.find("::add-mask::"), resumed);
  const std::string annotations = result.out.substr(resumed);
  EXPECT_THAT(annotations, Not(HasSubstr("::add-mask::")));
  EXPECT_THAT(annotations,
              AllOf(HasSubstr("::error file=" + (case_ / "bend.yaml").string() +
                              ",line=5,title=golden bend%3A differs::centre of pressure"),
                    HasSubstr("a%2Cb%25%3A")));
  EXPECT_THAT(testing::ReadFile(summary),
              AllOf(HasSubstr("## ✕ 1 of 2 pictures differs"), HasSubstr("| **bend** |")));
}

TEST_F(GoldenCheck, WritesACaseThatItReads) {
  ExpectRefusal(Golden({"new", case_, "side", "--source=demo:lift", "--loads=skin"}), "use both");
  EXPECT_FALSE(fs::exists(case_ / "side.yaml")) << "a check would refuse it";
  const ProgramResult result = Golden({"new", case_, "side", "--source=demo:lift", "--time=1",
                                       "--size=64x64", "--title=a: 'b' #c"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(Golden({"update", case_, "side"}).exit_code, 0);
  EXPECT_THAT(testing::ReadFile(case_ / "golden.lock"), HasSubstr("\"title\":\"a: 'b' #c\""));
  ExpectRefusal(Golden({"new", case_, "side", "--source=demo:lift"}), "there is such a case");
  ExpectRefusal(Golden({"new", case_, "../x", "--source=demo:lift"}), "case '../x'");
  ExpectRefusal(Golden({"new", case_, "typo", "--source=demo:lft"}), "demo:lft");
  ExpectRefusal(Golden({"new", case_, "typo", "--source=missing.mvnx"}), "missing.mvnx");
  EXPECT_FALSE(fs::exists(case_ / "typo.yaml"));
  // From here; the case says it from where it is.
  ASSERT_EQ(Kinescope({"golden", "new", case_ / "sub", "robot", "--source=demo:lift",
                       "--robot=" + (case_ / "arm.urdf").string()})
                .exit_code,
            0);
  EXPECT_THAT(testing::ReadFile(case_ / "sub/robot.yaml"), HasSubstr("arm.urdf"));
  EXPECT_THAT(Golden({"keys"}).out, AllOf(HasSubstr("camera: "), HasSubstr("class_limits: 0.3")));
}

TEST_F(GoldenCheck, DrawsTheSameBytesUnderAllCircumstances) {
  WriteCase("n_pose", "source: demo:n_pose\nsize: 64x64\n");
  const ProgramResult result = Golden({"stress", case_});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("2 pictures, drawn under 10 circumstances:"),
                                HasSubstr("8 filling threads            2 the same"),
                                HasSubstr("read-only home               2 the same"),
                                Not(HasSubstr("not tried")),
                                HasSubstr("working folder /             2 the same"),
                                HasSubstr("lowest priority              2 the same")));
  EXPECT_EQ(Golden({"check", case_, "n_pose"}).exit_code, 2) << "stress accepts nothing";
}

TEST_F(GoldenCheck, SaysUnderWhichCircumstanceWhatChanges) {
  const ProgramResult result = Kinescope(
      {"golden", "stress", case_},
      {"LD_PRELOAD=" + kinescope::testing::InBuild("tests/system/libother_digits.so").string()});
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("time zone Asia/Kathmandu     DIFFERS\n  bend: "),
                    HasSubstr(" pixels differ, the first at x "), HasSubstr(", nearest to "),
                    HasSubstr("working folder /             1 the same")));
}

TEST_F(GoldenCheck, SaysUnderWhichCircumstancesNothingIsDrawn) {
  WriteCase("late", "source: walk.pcap\nsize: 64x64\n");
  const ProgramResult result = Golden({"stress", case_, "late"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, HasSubstr("late: could not be drawn"));
}

TEST_F(GoldenCheck, FindsPicturesInAnotherFolder) {
  const fs::path elsewhere = folder_ / "elsewhere";
  ASSERT_EQ(Golden({"update", case_, "--pictures", elsewhere}).exit_code, 0);
  EXPECT_TRUE(fs::exists(elsewhere / "bend.png"));
  EXPECT_FALSE(fs::exists(case_ / "bend.png"));
  EXPECT_EQ(Check({"--strict"}).exit_code, 0);
  AddToCase("hide: cop");
  EXPECT_THAT(Check().out, HasSubstr("centre of pressure: is missing"));
  EXPECT_EQ(Golden({"accept", case_ / "out"}).exit_code, 0);
  EXPECT_EQ(Check({"--strict"}).exit_code, 0);
  fs::copy(elsewhere / "bend.png", elsewhere / "former.png");
  fs::copy(elsewhere / "bend.png", case_ / "bend.png");
  const ProgramResult orphans = Check();
  EXPECT_EQ(orphans.exit_code, 1);
  EXPECT_THAT(orphans.out, AllOf(HasSubstr("elsewhere/former.png"), HasSubstr("bend.png "),
                                 HasSubstr("2 of 3 pictures differ")));
}

TEST_F(GoldenCheck, SaysWhatMakesItWeaker) {
  ReplaceInLock("\"scene_library\":\"VTK", "\"scene_library\":\"NTK");
  const ProgramResult weaker = Check();
  EXPECT_EQ(weaker.exit_code, 0);
  EXPECT_THAT(weaker.out,
              HasSubstr("weaker check, in another environment: scene_library: was NTK"));
  EXPECT_EQ(Check({"--strict"}).exit_code, 1);
}

TEST_F(GoldenCheck, ListsTheCasesWithTheirPurposes) {
  WriteCase("new", "source: demo:lift\nwhy: the purpose\n");
  const ProgramResult result = Golden({"list", case_});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, AllOf(HasSubstr("bend                     accepted"),
                                HasSubstr("not accepted the purpose")));
}

// What people break, and how it must be told. Each of them changes the accepted picture, the case
// or what golden.lock says that was seen.
class GoldenMutation : public GoldenCheck {
 protected:
  void SetUp() override {
    WriteCase("bend",
              "source: demo:lift\ntime: 2\ncamera: 0.3,-3.4,1.1:0.3,0,0.8\ntitle: lift 60 %\n");
    ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  }
  void ExpectTold(const std::string& words) const {
    const ProgramResult result = Check();
    EXPECT_EQ(result.exit_code, 1) << words;
    EXPECT_THAT(result.out, HasSubstr(words));
  }
  // As if this picture had been accepted.
  void Accept(const render::Image& image) const {
    render::WritePng(case_ / "bend.png", image);
    app::GoldenLock lock = app::ReadLock(case_ / "golden.lock");
    lock["bend"].pixels_sha256 = app::PixelsHash(image);
    app::WriteLock(case_ / "golden.lock", lock);
  }
  void ChangeInCase(const std::string& before, const std::string& now) const {
    std::string yaml = testing::ReadFile(case_ / "bend.yaml");
    const std::size_t at = yaml.find(before);
    ASSERT_NE(at, std::string::npos);
    std::ofstream(case_ / "bend.yaml") << yaml.replace(at, before.size(), now);
  }
  // `change`: of a level, by the index of its byte.
  template <class Change>
  void ChangePixels(const Change& change) const {
    render::Image image = render::ReadPng(case_ / "bend.png");
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
      if (i % 4 == 3) continue;
      const int level = static_cast<int>(change(int{image.rgba[i]}, i));
      image.rgba[i] = static_cast<std::uint8_t>(std::clamp(level, 0, 255));
    }
    Accept(image);
  }
};

TEST_F(GoldenMutation, OfAClassIsNamed) {
  AddToCase("class_limits: 0.3,0.85");
  ExpectTold("right_knee: expected high (red), found medium (orange)");
}

TEST_F(GoldenMutation, OfAMissingSphereIsNamed) {
  app::GoldenLock lock = app::ReadLock(case_ / "golden.lock");
  auto& objects = lock["bend"].facts.objects;
  objects.push_back(objects.front());
  objects.back().name = "left_little_finger";
  app::WriteLock(case_ / "golden.lock", lock);
  ExpectTold("left_little_finger: is missing");
}

// As seen in the picture, not as the scene has it.
TEST_F(GoldenMutation, OfSpheresThatAreNotDrawnIsNamed) {
  AddToCase("hide: loads");
  EXPECT_EQ(Check().exit_code, 1);
  const auto run = nlohmann::json::parse(testing::ReadFile(case_ / "out/run.json"));
  std::set<std::string> missing;
  for (const auto& finding : run.at("cases").at(0).at("findings")) {
    if (finding.at("kind") == "missing") missing.insert(finding.at("object"));
  }
  EXPECT_THAT(missing, AllOf(::testing::Contains("right_knee"), ::testing::Contains("l5_s1"),
                             Not(::testing::Contains("body"))));
}

TEST_F(GoldenMutation, OfASphereThatMovedByThreePixelsIsNamed) {
  app::GoldenLock lock = app::ReadLock(case_ / "golden.lock");
  for (app::ObjectFact& object : lock["bend"].facts.objects) {
    if (object.name == "left_wrist") object.x_px += 3;
  }
  app::WriteLock(case_ / "golden.lock", lock);
  ExpectTold("left_wrist: moved by 3.0 px");
}

TEST_F(GoldenMutation, OfWhatIsHiddenIsNamed) {
  AddToCase("hide: cop");
  ExpectTold("centre of pressure: is missing");
}

TEST_F(GoldenMutation, OfALegendAndOfOneDigitIsNamed) {
  AddToCase("class_limits: 0.3,0.65");
  ChangeInCase("lift 60", "lift 80");
  ExpectTold("legend: expected “≤ 60 %”, found “≤ 65 %”");
  ExpectTold("title: expected “lift 60 %”, found “lift 80 %”");
}

TEST_F(GoldenMutation, OfAPoseIsNamed) {
  ChangeInCase("time: 2", "time: 2.1");
  ExpectTold("objects moved by up to ");
}

TEST_F(GoldenMutation, OfAnArmBentByThreeDegreesMoreIsNamed) {
  WriteCase("bend", "source: pose:right_elbow=90\ncamera: 0.2,-1.8,1.2:0.2,0,1.1\n");
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  EXPECT_EQ(Check({"--strict"}).exit_code, 0) << "a written pose stands still";
  ChangeInCase("right_elbow=90", "right_elbow=93");
  ExpectTold("right_wrist: moved by ");
  ExpectTold("right_elbow: turned by 3.0°");
  ExpectTold("source: was pose:right_elbow=90, is pose:right_elbow=93");
  ExpectTold(
      "input source: pose:right_elbow=93 was not read before; pose:right_elbow=90 is not read");
}

// From where it is hardly seen, and without a sphere on it.
TEST_F(GoldenMutation, OfAnArmIsNamedFromEverySide) {
  for (const char* camera : {"front", "back", "left", "top"}) {
    WriteCase("bend", std::string("source: pose:right_elbow=40\nhide: loads\ncamera: ") + camera +
                          "\nsize: 320x180\n");
    ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
    ChangeInCase("right_elbow=40", "right_elbow=43");
    ExpectTold("right_elbow: turned by 3.0°");
  }
}

TEST_F(GoldenMutation, OfTheFloorIsNamed) {
  AddToCase("floor: off");
  ExpectTold("floor: expected a floor, found none");
}

TEST_F(GoldenMutation, OfACameraByHalfADegreeIsNamed) {
  ChangeInCase("0.3,-3.4,1.1:", "0.3297,-3.3999,1.1:");
  ExpectTold("camera: turned by 0.50°");
}

// A picture in grey, and a person who does not see red and green, would not notice.
TEST_F(GoldenMutation, OfTwoColorsOfEqualGreyIsNamed) {
  constexpr double kRed = 0.299, kGreen = 0.587;
  render::Image image = render::ReadPng(case_ / "bend.png");
  std::int64_t swapped = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const double red = image.rgba[i], green = image.rgba[i + 1];
    if (red - green < 60) continue;  // the sphere of a high load
    image.rgba[i] = static_cast<std::uint8_t>(std::lround(std::min(255.0, green * kGreen / kRed)));
    image.rgba[i + 1] = static_cast<std::uint8_t>(std::lround(red * kRed / kGreen));
    ++swapped;
  }
  ASSERT_GT(swapped, 200);
  Accept(image);
  ExpectTold("pixels: ");
  ExpectTold("beyond 0.05 of colour distance");
}

TEST_F(GoldenMutation, OfLightIsNamed) {
  ChangePixels([](int level, std::size_t) { return std::lround(level / 0.99); });
  ExpectTold("light: ");
}

TEST_F(GoldenMutation, OfSharpnessIsNamed) {
  const render::Image sharp = render::ReadPng(case_ / "bend.png");
  const std::size_t row = 4 * static_cast<std::size_t>(sharp.width);
  ChangePixels([&](int level, std::size_t i) {
    if (i < row || i + row + 4 >= sharp.rgba.size()) return level;
    const int around =
        sharp.rgba[i - row] + sharp.rgba[i + row] + sharp.rgba[i - 4] + sharp.rgba[i + 4];
    return (around + 4 * level) / 8;
  });
  ExpectTold("structure: ");
}

TEST_F(GoldenMutation, OfRoundingPasses) {
  ChangePixels([](int level, std::size_t i) { return level + (i / 3 % 2 == 0 ? 1 : -1); });
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("same (within the limits)"));
}

// Mesa draws both in software; the name of the other one makes the check weaker, and no failure.
TEST_F(GoldenMutation, OfTheSoftwareBackendPasses) {
  const ProgramResult result = Check({"--backend", "egl"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("same"),
                                HasSubstr("weaker check, in another environment: backend: was "
                                          "osmesa, is egl")));
  EXPECT_EQ(Check({"--backend", "egl", "--strict"}).exit_code, 1);
}

TEST_F(GoldenMutation, OfTheFileAlonePasses) {
  const render::Image image = render::ReadPng(case_ / "bend.png");
  render::WritePng(case_ / "bend.png", image, {{"Comment", "other bytes"}});
  EXPECT_EQ(Check({"--strict"}).exit_code, 0);
}

class GoldenCompare : public ::testing::Test {
 protected:
  void SetUp() override {
    image_.width = image_.height = 64;
    image_.rgba.assign(64 * 64 * 4, 200);
    render::WritePng(one_, image_);
  }
  ProgramResult Compare(const std::vector<std::string>& more = {}) {
    render::WritePng(other_, image_);
    std::vector<std::string> arguments = {"compare", one_, other_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Golden(arguments);
  }

  TempFolder folder_;
  const std::string one_ = folder_ / "one.png", other_ = folder_ / "other.png";
  render::Image image_;
};

TEST_F(GoldenCompare, SaysThatPixelsAreTheSame) {
  const ProgramResult result = Compare();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "the same pixels\n");
}

TEST_F(GoldenCompare, SaysThatPicturesAreTheSameToTheEye) {
  for (std::size_t i = 0; i < image_.rgba.size(); i += 8) image_.rgba[i] += 1;
  const ProgramResult result = Compare();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out,
              ::testing::StartsWith("the same to the eye: largest difference 1 level\n"));
}

TEST_F(GoldenCompare, NamesTheLayersThatDifferWithFoundValueAndLimit) {
  for (std::size_t i = 0; i < 40; ++i) image_.rgba[4 * (64 * 20 + i)] = 90;
  const std::string heat_map = folder_ / "heat.png";
  const ProgramResult result = Compare({"--out", heat_map});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out,
              AllOf(::testing::StartsWith("DIFFERS: pixels, structure\n"),
                    HasSubstr("pixels     DIFFERS  40 beyond 0.05 of colour distance (0.98 %, "),
                    HasSubstr("largest cluster 40x1 px at x 0, y 20 (40 pixels)"),
                    HasSubstr("structure  DIFFERS  worst block 0."), HasSubstr("(limit 0.975)"),
                    HasSubstr("light      same     less than 0.01 levels off")));
  EXPECT_EQ(render::ReadPng(heat_map).width, 64);
}

TEST_F(GoldenCompare, PrintsItsNumbersAsJson) {
  for (std::uint8_t& channel : image_.rgba) channel = channel == 200 ? 197 : channel;
  for (std::size_t i = 3; i < image_.rgba.size(); i += 4) image_.rgba[i] = 200;
  const ProgramResult result = Compare({"--json"});
  EXPECT_EQ(result.exit_code, 1);
  const auto verdict = nlohmann::json::parse(result.out);
  EXPECT_EQ(verdict.at("text"), "DIFFERS: light");
  EXPECT_FALSE(verdict.at("byte_equal"));
  EXPECT_EQ(verdict.at("pixels").at("changed"), 0);
  EXPECT_EQ(verdict.at("structure").at("limit"), 0.975);
  EXPECT_NEAR(verdict.at("light").at("worst").at("red"), -2.35, 0.4);
}

TEST_F(GoldenCompare, SaysThatSizesDifferAndRefusesWhatItCannotRead) {
  image_.height = 8;
  image_.rgba.resize(64 * 8 * 4);
  const ProgramResult result = Compare();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("size       DIFFERS  expected 64x64 px, found 64x8 px"));
  std::fill(image_.rgba.begin(), image_.rgba.end(), std::uint8_t{0});
  render::WritePng(one_, image_);
  image_.rgba[0] = 255;
  render::WritePng(other_, image_);
  ExpectRefusal(Golden({"compare", one_, other_}), "wholly transparent");
  std::ofstream(other_) << "no picture";
  ExpectRefusal(Golden({"compare", one_, other_}), "other.png");
  ExpectRefusal(Golden({"compare", one_}), "other");
}

}  // namespace
}  // namespace kinescope
