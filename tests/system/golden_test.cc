// The tester tested: a golden check that cannot fail is worth nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::ExpectRefusal;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::ProgramResult;
using testing::TempFolder;

// As on a person's machine, also where these tests run in CI.
ProgramResult Golden(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "golden");
  return Kinescope(std::move(arguments), {"CI="});
}

class GoldenCheck : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteCase("bend", "source: demo:lift\ntime: 2.5\ncamera: right\nsize: 320x180\n");
    ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  }
  void WriteCase(const std::string& name, const std::string& yaml) const {
    std::ofstream(case_ / (name + ".yaml")) << yaml;
  }
  ProgramResult Check(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"check", case_, "--out", case_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Golden(arguments);
  }

  TempFolder folder_;
  fs::path case_ = folder_.path();
};

TEST_F(GoldenCheck, AcceptsThePictureThatItWrote) {
  EXPECT_EQ(Check().exit_code, 0) << Check().out;
}

TEST_F(GoldenCheck, NamesTheJointWhoseClassDiffers) {
  std::string objects = testing::ReadFile(case_ / "bend.objects.json");
  const std::string before = "\"joint\": \"left_wrist\", \"class\": \"low\"";
  const std::size_t at = objects.find(before);
  ASSERT_NE(at, std::string::npos) << objects;
  objects.replace(at, before.size(), "\"joint\": \"left_wrist\", \"class\": \"high\"");
  std::ofstream(case_ / "bend.objects.json") << objects;
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("left_wrist: expected high (red), found low (green)"));
}

TEST_F(GoldenCheck, NamesAJointWhoseLoadDiffersForAnotherPerson) {
  std::ofstream(case_ / "bend.yaml", std::ios::app) << "sex: female\nmass: 120\n";
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("l5_s1: expected "));
}

TEST_F(GoldenCheck, DetectsDifferentPixelsAndShowsThem) {
  render::Image image = render::ReadPng(case_ / "bend.png");
  for (std::size_t i = 0; i < 400; ++i) image.rgba[i] ^= 0x80;
  render::WritePng(case_ / "bend.png", image);
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("100 pixels differ"));
  EXPECT_TRUE(fs::exists(case_ / "out/bend.actual.png"));
  EXPECT_TRUE(fs::exists(case_ / "out/bend.diff.png"));
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
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, AllOf(HasSubstr("bend                     NOT COMPARED"),
                                HasSubstr("bend.png: no such file"), HasSubstr("golden update"),
                                HasSubstr("0 same, 0 differ, 1 not compared")));
  EXPECT_TRUE(fs::exists(case_ / "out/bend.actual.png")) << "to be looked at";
}

TEST_F(GoldenCheck, NamesAPictureThatGitHasNotFetched) {
  std::ofstream(case_ / "bend.png") << "version https://git-lfs.github.com/spec/v1\noid sha256:0\n";
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("bend.png: a pointer of Git LFS"), HasSubstr("git lfs pull")));
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
                    HasSubstr("c_missing.yaml: source"), HasSubstr("nowhere.mvnx"),
                    HasSubstr("d_late"), HasSubstr("bend                     same"),
                    HasSubstr("1 same, 0 differ, 4 not compared")));
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
  fs::remove(case_ / "bend.objects.json");
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
  render::Image image = render::ReadPng(case_ / "bend.png");
  image.rgba[0] ^= 0x80;
  render::WritePng(case_ / "bend.png", image);
  EXPECT_EQ(Check({"--junit", case_ / "junit.xml"}).exit_code, 2);
  const std::string xml = testing::ReadFile(case_ / "junit.xml");
  EXPECT_THAT(xml,
              AllOf(HasSubstr("tests=\"3\" failures=\"1\" errors=\"1\""),
                    HasSubstr("name=\"a&#60;b&#38;\""), HasSubstr("<error type=\"not compared\""),
                    HasSubstr("<failure type=\"differs\" message=\"1 pixels differ"),
                    HasSubstr("[[ATTACHMENT|" + (case_ / "out/bend.diff.png").string() + "]]")));
  EXPECT_THAT(xml, Not(HasSubstr("a<b")));
}

TEST_F(GoldenCheck, ReportsWhyItCannotWrite) {
  fs::create_directories(case_ / "out/bend.objects.json");
  fs::remove(case_ / "bend.png");
  ExpectRefusal(Check(), "out/bend.objects.json: Is a directory");
  fs::remove(case_ / "bend.objects.json");
  fs::create_directory(case_ / "bend.objects.json");
  ExpectRefusal(Golden({"update", case_}), "bend.objects.json: Is a directory");
}

TEST_F(GoldenCheck, AcceptsOnlyWhatHasChangedAndSaysWhat) {
  const auto written_at = fs::last_write_time(case_ / "bend.png");
  const ProgramResult same = Golden({"update", case_});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_THAT(same.out, HasSubstr("unchanged"));
  EXPECT_EQ(fs::last_write_time(case_ / "bend.png"), written_at);
  std::ofstream(case_ / "bend.yaml", std::ios::app) << "mass: 120\n";
  EXPECT_THAT(Golden({"update", case_}).out, HasSubstr("written: picture, load spheres"));
}

TEST_F(GoldenCheck, AcceptsTheOthersWhenACaseShowsNothing) {
  WriteCase("a_nothing",
            "source: demo:lift\nsize: 64x64\nfloor: off\nno_overlays: true\n"
            "hide: body,loads,com,cop,support,forces,hand_loads,shadows\n");
  WriteCase("c_new", "source: demo:n_pose\nsize: 64x64\n");
  const ProgramResult result = Golden({"update", case_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, AllOf(HasSubstr("a_nothing                NOT ACCEPTED"),
                                HasSubstr("the picture is of one colour"),
                                HasSubstr("c_new                    written: picture (new)")));
  EXPECT_FALSE(fs::exists(case_ / "a_nothing.png"));
}

TEST_F(GoldenCheck, AcceptsNothingInCi) {
  ExpectRefusal(Kinescope({"golden", "update", case_}, {"CI=true"}), "CI=true");
}

TEST_F(GoldenCheck, ListsTheCasesWithTheirPurposes) {
  WriteCase("new", "source: demo:lift\nwhy: the purpose\n");
  const ProgramResult result = Golden({"list", case_});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, AllOf(HasSubstr("bend                     accepted"),
                                HasSubstr("not accepted the purpose")));
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
  std::ofstream(other_) << "no picture";
  ExpectRefusal(Golden({"compare", one_, other_}), "other.png");
  ExpectRefusal(Golden({"compare", one_}), "other");
}

}  // namespace
}  // namespace kinescope
