// A golden case that is a web page, drawn by the real Chromium: what a person reads on it is
// compared, then its pixels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "server/app/golden/golden_lock.h"
#include "server/app/golden/page_browser.h"
#include "tests/shared_data.h"
#include "tests/system/golden_fixture.h"
#include "tests/system/small_web_server.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::Golden;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::ProgramResult;
using testing::SmallWebServer;

constexpr char kHtml[] =
    "<!doctype html><meta charset=utf-8><title>Trial 7</title>"
    "<style>body{margin:0;font:16px 'DejaVu Sans'}#bar{width:200px;height:40px;background:#060}"
    "</style><h1 id=title>Trial 7</h1><p id=knee>right knee: 0.72</p><div id=bar></div>"
    "<button id=go>Start</button>";

class GoldenPage : public testing::GoldenCheck {
 protected:
  void SetUp() override {
    try {
      (void)app::FindChromium();
    } catch (const std::runtime_error& missing) {
      GTEST_SKIP() << missing.what();
    }
    fs::create_directory(case_ / "pages of #1");
    WritePage("", "");
    WriteCase("report",
              "page: 'pages of #1/report.html'\nsize: 400x300\nwhy: the report of a trial\n");
    const ProgramResult result = Golden({"update", case_});
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  }

  // The page with one text replaced by another one.
  void WritePage(const std::string& before, const std::string& now,
                 const std::string& name = "report") const {
    std::string html = kHtml;
    if (!before.empty()) html.replace(html.find(before), before.size(), now);
    std::ofstream(case_ / ("pages of #1/" + name + ".html")) << html;
  }

  // What the check says of a page that differs.
  std::string Difference() const {
    const ProgramResult result = Check();
    EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
    return result.out;
  }
};

TEST_F(GoldenPage, IsTheSameEachTime) {
  const ProgramResult result = Check({"--strict"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("The picture is the same"));
  EXPECT_EQ(render::ReadPng(case_ / "report.png").width, 400);
  const app::AcceptedCase accepted = app::ReadLock(case_ / "golden.lock").at("report");
  EXPECT_EQ(accepted.environment.count("browser"), 1u);
  EXPECT_EQ(accepted.environment.count("gl_version"), 0u) << "our renderer has no part in it";
}

TEST_F(GoldenPage, NamesWhatHasChanged) {
  const std::vector<std::string> names = {"colour", "label", "missing", "moved", "text"};
  for (const std::string& name : names) {
    WritePage("", "", name);
    WriteCase(name, "page: 'pages of #1/" + name + ".html'\nsize: 400x300\n");
  }
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  WritePage("#060", "#600", "colour");
  WritePage("<button id=go>", "<button id=go aria-label=Stop>", "label");
  WritePage("<button id=go>Start</button>", "", "missing");
  WritePage("#bar{", "#bar{margin-bottom:3px;", "moved");
  WritePage("0.72", "0.73", "text");
  const std::string difference = Difference();
  EXPECT_THAT(difference, HasSubstr("knee: expected “right knee: 0.72”, found “right knee: 0.73”"));
  EXPECT_THAT(difference, HasSubstr("go: text “Start” is missing"));
  EXPECT_THAT(difference, HasSubstr("go: texts moved by up to 3.0 px"));
  EXPECT_THAT(difference, HasSubstr("8000 beyond 0.05 of colour distance"));
  EXPECT_THAT(difference, HasSubstr("go: expected “Start”, found “Start (Stop)”"));
  EXPECT_THAT(difference, HasSubstr("report                   same"));
}

TEST_F(GoldenPage, LeavesOutWhatChangesByItself) {
  WritePage("<p id=knee>", "<p id=knee data-changing>");
  std::ofstream(case_ / "pages of #1/report.html", std::ios::app)
      << "<script>document.getElementById('knee').textContent = String(performance.now());"
         "</script>";
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 0) << result.out;
}

TEST_F(GoldenPage, IsAcceptedFromTheRunThatDrewIt) {
  WritePage("0.72", "0.73");
  (void)Difference();
  const ProgramResult accepted = Golden({"accept", case_ / "out", "report"});
  EXPECT_EQ(accepted.exit_code, 0) << accepted.out << accepted.err;
  EXPECT_EQ(Check({"--strict"}).exit_code, 0);
}

TEST_F(GoldenPage, IsAnInputSoThatAnotherFileIsNoFaultOfTheProgram) {
  WritePage("0.72", "0.73");
  const std::string difference = Difference();
  EXPECT_THAT(difference, AllOf(HasSubstr("page: the content of report.html has changed"),
                                HasSubstr("says nothing about the program")));
  WritePage("0.72", "0.74");
  const ProgramResult accepted = Golden({"accept", case_ / "out", "report"});
  EXPECT_NE(accepted.exit_code, 0) << "the run has drawn another file";
  EXPECT_THAT(accepted.out + accepted.err, HasSubstr("report"));
}

TEST_F(GoldenPage, IsBlamedForWhatItLoads) {
  WritePage("<p id=knee>right knee: 0.72</p>", "<p id=knee></p><script src=value.js></script>");
  const auto write_value = [&](const char* value) {
    std::ofstream(case_ / "pages of #1/value.js")
        << "document.getElementById('knee').textContent = '" << value << "'";
  };
  write_value("0.72");
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  write_value("0.73");
  EXPECT_THAT(Difference(),
              AllOf(HasSubstr("knee: expected “0.72”, found “0.73”"),
                    HasSubstr("The page has changed:"), Not(HasSubstr("The program has changed"))));
}

TEST_F(GoldenPage, StandsBesideScenes) {
  WriteCase("bend", "source: demo:lift\ntime: 2.5\ncamera: right\nsize: 160x90\n");
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  const ProgramResult same = Check({"--strict"});
  EXPECT_EQ(same.exit_code, 0) << same.out;
  EXPECT_THAT(same.out, Not(HasSubstr("weaker")));
  WriteCase("bend", "source: demo:lift\ntime: 2.5\ncamera: front\nsize: 160x90\n");
  WritePage("0.72", "0.73");
  EXPECT_EQ(Check().exit_code, 1);
  const ProgramResult accepted = Golden({"accept", case_ / "out"});
  EXPECT_EQ(accepted.exit_code, 0) << accepted.out << accepted.err;
  EXPECT_EQ(Check({"--strict"}).exit_code, 0);
}

TEST_F(GoldenPage, IsReadFromAServerToo) {
  SmallWebServer server({{"/live", {"200 OK", "text/html", kHtml}}});
  WriteCase("live", "page: " + server.url() + "/live\nsize: 400x300\n");
  WriteCase("gone", "page: " + server.url() + "/gone\nsize: 400x300\n");
  const ProgramResult result = Golden({"update", case_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, AllOf(HasSubstr("live"), HasSubstr("gone"), HasSubstr("404")));
  EXPECT_EQ(Check({"live"}).exit_code, 0);
}

TEST_F(GoldenPage, ThatShowsNothingIsNeverAccepted) {
  std::ofstream(case_ / "pages of #1/report.html") << "<!doctype html><title>blank</title>";
  EXPECT_THAT(Difference(), HasSubstr("shows nothing: all pixels have one colour"));
  const ProgramResult accepted = Golden({"accept", case_ / "out", "report"}),
                      updated = Golden({"update", case_});
  EXPECT_EQ(accepted.exit_code, 2);
  EXPECT_THAT(accepted.out, HasSubstr("shows nothing"));
  EXPECT_EQ(updated.exit_code, 2);
  EXPECT_THAT(updated.out, HasSubstr("shows nothing"));
}

TEST_F(GoldenPage, IsRefusedWithTheWayOut) {
  const auto complaint = [&](const std::string& yaml) {
    WriteCase("wrong", yaml);
    const ProgramResult result = Check();
    EXPECT_EQ(result.exit_code, 2) << yaml;
    EXPECT_THAT(result.out, HasSubstr("report                   same")) << "the others run";
    return result.out;
  };
  EXPECT_THAT(complaint("page: nothing.html\n"),
              AllOf(HasSubstr("wrong.yaml: page=nothing.html: there is no such file"),
                    HasSubstr("dashboard with a source")));
  EXPECT_THAT(complaint("page: dashboard\n"), HasSubstr("source is missing"));
  EXPECT_THAT(complaint("page: 'pages of #1/report.html'\ncamera: right\n"),
              HasSubstr("camera: has no effect on a web page"));
  EXPECT_THAT(complaint("page: dashboard\nsource: demo:walk\nseconds: 2\n"),
              HasSubstr("seconds: has no effect on the dashboard"));
  EXPECT_THAT(complaint("page: http://127.0.0.1:1/\nsize: 100x100\n"),
              HasSubstr("ERR_UNSAFE_PORT"));
}

TEST_F(GoldenPage, NeedsABrowserThatItNames) {
  const ProgramResult result = Kinescope({"golden", "check", case_, "--out", case_ / "out"},
                                         {"CI=", "KINESCOPE_CHROMIUM=/nowhere/chromium"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, HasSubstr("/nowhere/chromium"));
}

TEST_F(GoldenPage, ThatIsAnotherEachTimeIsFoundByStress) {
  const SmallWebServer server(
      {{"/text", {"200 OK", "text/html", "<p id=number>answer {count}</p>"}},
       {"/colour",
        {"200 OK", "text/html",
         "<style>body{margin:0}#bar{width:200px;height:40px;background:rgb(0,1{count},0)}"
         "</style><div id=bar></div>"}}});
  WriteCase("text", "page: " + server.url() + "/text\nsize: 400x300\n");
  WriteCase("colour", "page: " + server.url() + "/colour\nsize: 400x300\n");
  const ProgramResult result = Golden({"stress", case_, "text", "colour"});
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("8 filling threads            DIFFERS\n  colour: 8000 "
                                          "pixels differ, the first at x 0, y 0"),
                                HasSubstr("text: number: expected “answer ")));
}

TEST_F(GoldenPage, IsWrittenAsACaseWithAPathFromHere) {
  const ProgramResult result = Golden(
      {"new", case_ / "sub", "again", "--page=" + (case_ / "pages of #1/report.html").string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(testing::ReadFile(case_ / "sub/again.yaml"), HasSubstr("../pages of #1/report.html"));
}

class GoldenDashboard : public testing::GoldenCheck {
 protected:
  void SetUp() override {
    try {
      (void)app::FindChromium();
    } catch (const std::runtime_error& missing) {
      GTEST_SKIP() << missing.what();
    }
  }
  void Record(const std::string& seconds) const {
    ASSERT_EQ(
        Kinescope({"convert", "demo:lift", "--seconds", seconds, "--out", case_ / "lift.mvnx"})
            .exit_code,
        0);
  }
};

TEST_F(GoldenDashboard, ShowsTheMomentOfARecording) {
  Record("2");
  WriteCase("dashboard",
            "page: dashboard?view=wall\nsource: lift.mvnx\ntime: 1.5\nsize: 800x600\n"
            "theme: dark\nhand_load: right:5\nwhy: what the lab sees on the wall\n");
  const ProgramResult update = Golden({"update", case_});
  ASSERT_EQ(update.exit_code, 0) << update.out << update.err;
  const ProgramResult same = Check({"--strict"});
  EXPECT_EQ(same.exit_code, 0) << same.out;
  // Another load on the hand: the case names its own change, and the page other ratios.
  WriteCase("dashboard",
            "page: dashboard?view=wall\nsource: lift.mvnx\ntime: 1.5\nsize: 800x600\n"
            "theme: dark\nhand_load: right:15\nwhy: what the lab sees on the wall\n");
  const ProgramResult other = Check();
  EXPECT_EQ(other.exit_code, 1) << other.out;
  EXPECT_THAT(other.out, AllOf(HasSubstr("hand_load"), HasSubstr("expected “")));
}

TEST_F(GoldenDashboard, TellsAChangedRecordingFromAChangedPage) {
  Record("2");
  WriteCase("dashboard", "page: dashboard\nsource: lift.mvnx\ntime: 1\nsize: 800x600\n");
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  Record("2.1");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("input source"));
}

TEST_F(GoldenDashboard, HasTheSameBytesInChromiumAsInItsHeadlessShell) {
  const std::string whole = "/usr/bin/chromium", shell = "/usr/bin/chromium-headless-shell";
  for (const std::string& program : {whole, shell}) {
    if (!fs::exists(program)) GTEST_SKIP() << program << " is missing";
  }
  const auto golden = [&](const std::string& chromium, std::vector<std::string> words) {
    words.insert(words.begin(), "golden");
    return Kinescope(words, {"CI=", "KINESCOPE_CHROMIUM=" + chromium});
  };
  Record("1");
  WriteCase("dashboard", "page: dashboard\nsource: lift.mvnx\ntime: 0.5\nsize: 800x600\n");
  ASSERT_EQ(golden(whole, {"update", case_}).exit_code, 0);
  const ProgramResult checked = golden(shell, {"check", case_, "--strict", "--out", case_ / "out"});
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
}

}  // namespace
}  // namespace kinescope
