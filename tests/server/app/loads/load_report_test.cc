// The report of `kinescope loads` as a browser and a reader get it.
#include "server/app/loads/load_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <regex>

#include "core/system/errors.h"
#include "server/app/html.h"
#include "server/table/load_rows.h"
#include "tests/full_disk.h"
#include "tests/server/app/loads/trial_scenes.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using testing::AddTo;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::SceneWithRatio;
using testing::ShortLift;
using testing::TempFolder;
using testing::TrialOf;

constexpr double kNoRatioInReport = std::numeric_limits<double>::quiet_NaN();

// Two seconds at 0.2, then two of which nothing is known: no picture to draw.
LoadTrial TrialWithoutPictures(const std::string& name = "") {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 40; ++i) {
    SceneState scene =
        SceneWithRatio(0.1 * i, i < 20 ? 0.2 : kNoRatioInReport, i < 20 ? "" : "<in> the \"air\"");
    for (JointLoad& load : scene.people[0].loads) load.load_class = load.band = LoadClass::kUnknown;
    scene.people[0].name = name;
    AddTo(trial, scene);
  }
  trial.Finish();
  return trial;
}

const SensitivityRows kNoRuns = [](int) { return std::vector<SensitivityRow>(); };

// Without the pictures' bytes, which no failure has to print.
std::string ReportOf(const std::map<int, LoadTrial>& trials, const TrialContext& context) {
  const TempFolder folder;
  WriteReport(trials, context, {"sha256 12ab, 34 bytes", "kinescope loads take.mvnx"}, kNoRuns, {},
              folder / "report.html");
  std::string html = testing::ReadFile(folder / "report.html");
  const std::string begin = ";base64,";
  for (std::size_t at = html.find(begin); at != std::string::npos; at = html.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    html.erase(from, html.find('"', from) - from);
  }
  return html;
}

std::string ReportOf(const LoadTrial& trial, const TrialContext& context = {}) {
  std::map<int, LoadTrial> trials;
  trials.emplace(0, trial);
  return ReportOf(trials, context);
}

// The first half at 0.1, then the right knee at 0.9; scenes that can be drawn.
LoadTrial CountedTrialThatCanBeDrawn() {
  constexpr std::size_t kRightKnee = 11;
  LoadTrial trial(true, 0);
  for (int i = 0; i < 20; ++i) {
    SceneState scene = *ShortLift().back();
    scene.stamp_nanos = scene.people[0].sample.stamp_nanos = i * 100'000'000LL;
    for (JointLoad& load : scene.people[0].loads) {
      load.ratio = 0.1;
      load.band = LoadClass::kLow;
    }
    if (i >= 10) {
      scene.people[0].loads[kRightKnee].ratio = 0.9;
      scene.people[0].loads[kRightKnee].band = LoadClass::kHigh;
    }
    AddTo(trial, scene);
  }
  trial.Finish();
  return trial;
}

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// "" when each element that is opened is closed in turn; else the first that is not.
std::string FindUnbalancedTag(const std::string& html) {
  std::vector<std::string> open;
  // Style is not markup.
  const std::string text =
      html.substr(0, html.find("<style>")) + html.substr(html.find("</style>") + 8);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const bool closes = text[at + 1] == '/';
    std::size_t end = at + (closes ? 2 : 1);
    while (end < text.size() && std::isalnum(static_cast<unsigned char>(text[end])) != 0) ++end;
    const std::string name = text.substr(at + (closes ? 2 : 1), end - at - (closes ? 2 : 1));
    const bool is_void = name.empty() || name == "meta" || name == "img" || name == "br";
    if (is_void || text[text.find('>', at) - 1] == '/') continue;  // <!DOCTYPE>, <rect/>
    if (!closes) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "/" + name;
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

TEST(LoadReport, ShowsPersonSourceAndEveryJointOnOnePage) {
  TrialContext context;
  context.source = "take.mvnx";
  context.rate_hz = 60;
  const std::string html = ReportOf(TrialWithoutPictures("Anna"), context);
  EXPECT_EQ(FindUnbalancedTag(html), "");
  EXPECT_THAT(html, HasSubstr("<meta charset=\"utf-8\">"));
  EXPECT_THAT(html, HasSubstr("<title>Joint loads: take.mvnx</title>"));
  EXPECT_THAT(html, HasSubstr("<h1>Joint loads of one trial: take.mvnx</h1>"));
  EXPECT_THAT(html, HasSubstr("Person 0, &#8220;Anna&#8221; &#183; 4.00 s, 40 samples at 60 Hz "
                              "&#183; 1970-01-01 00:00:00 UTC"));
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(CountOf(html, "<th>" + EscapeHtml(ScoredLabel(i)) + "</th>"), 1U) << ScoredLabel(i);
  }
  for (const char* heading : {"Exposure", "Worst postures", "Over time", "Amplitude distribution",
                              "Method", "How far to believe it", "What would change the answer"}) {
    EXPECT_EQ(CountOf(html, std::string("<h2>") + heading), 1U) << heading;
  }
  for (const char* part : {"Checked by", "<div>Date</div>", "sha256 12ab, 34 bytes",
                           "<code>kinescope loads take.mvnx</code>", "page 1 of 1"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
}

// In a dashed box with the word, so that a grey copy keeps it.
TEST(LoadReport, MarksAssumedValuesAndNoOthers) {
  testing::Scenes scenes = ShortLift();
  const auto values_of = [&](bool is_assumed) {
    testing::Scenes changed;
    for (const auto& scene : scenes) {
      auto copy = std::make_shared<SceneState>(*scene);
      auto model = std::make_shared<PersonModel>(*copy->people[0].model);
      model->description.sex_is_assumed = model->description.mass_is_assumed = is_assumed;
      copy->people[0].model = model;
      copy->people[0].forces.stated_hand_load = {!is_assumed, {0, 0}, 0};
      changed.push_back(copy);
    }
    TrialContext context;
    context.scene.loads.strength.factor = is_assumed ? 1 : 1.2;
    return ReportOf(TrialOf(changed), context);
  };
  const std::string assumed = values_of(true), given = values_of(false);
  for (const char* value :
       {"male", "75 kg", "unknown, computed as empty", "50th percentile of men"}) {
    EXPECT_THAT(assumed, HasSubstr("<b class=\"as\">" + std::string(value) + ", assumed</b>"));
  }
  EXPECT_THAT(given, Not(HasSubstr("assumed</b>")));
  EXPECT_THAT(given, HasSubstr("<b>75 kg</b>"));
  EXPECT_THAT(given, HasSubstr("<b>50th percentile of men &#215; 1.2</b>"));
}

TEST(LoadReport, BeginsWithTheFinding) {
  EXPECT_THAT(
      ReportOf(CountedTrialThatCanBeDrawn()),
      HasSubstr("<p class=\"find high\"><b>Right knee was above a ratio of 0.60 for 50.0 % of the "
                "trial"));
}

TEST(LoadReport, ContainsNoScriptsAndNoExternalLinks) {
  const std::string html = ReportOf(TrialWithoutPictures());
  for (const char* part :
       {"<script", "javascript:", "https:", "<link", "@import", "url(", "src=\"http"}) {
    EXPECT_THAT(html, Not(HasSubstr(part)));
  }
}

TEST(LoadReport, EscapesExternalNamesAndReasons) {
  TrialContext context;
  context.source = "<script>alert(\"x\")</script>&\x01\xFF.mvnx";
  const std::string html =
      ReportOf(TrialWithoutPictures("</main><b onclick='x'>\xC0\x1b"), context);
  EXPECT_EQ(FindUnbalancedTag(html), "");
  for (const char* part : {"<script", "<b onclick", "</main><b", "alert(\"", "<in>"}) {
    EXPECT_THAT(html, Not(HasSubstr(part)));
  }
  EXPECT_THAT(html, HasSubstr("<title>Joint loads: &#60;script&#62;alert(&#34;x&#34;)"));
  EXPECT_THAT(html, HasSubstr("&#60;in&#62; the &#34;air&#34;"));
  for (const char c : html) {
    EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= ' ') << static_cast<int>(c);
  }
  EXPECT_EQ(nlohmann::json(html).dump(-1, ' ', false, nlohmann::json::error_handler_t::strict),
            nlohmann::json(html).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
      << "it says that it is UTF-8";
}

TEST(LoadReport, HasOnePagePerPersonInTheirOrder) {
  std::map<int, LoadTrial> trials;
  trials.emplace(3, TrialWithoutPictures("Ben"));
  trials.emplace(1, TrialWithoutPictures("Anna"));
  const std::string html = ReportOf(trials, {});
  EXPECT_EQ(CountOf(html, "<main>"), 2U);
  EXPECT_LT(html.find("8220;Anna"), html.find("8220;Ben"));
  EXPECT_THAT(html, HasSubstr("page 2 of 2"));
}

TEST(LoadReport, ShowsTheWorstPostureWithItsValues) {
  const std::string html = ReportOf(TrialOf(ShortLift()));
  EXPECT_EQ(CountOf(html, "src=\"data:image/png;base64,"), 1U)
      << "a quarter of a second has one moment";
  EXPECT_TRUE(std::regex_search(
      html, std::regex("<b>0\\.[0-9]{2} s, highest compression, [0-9]+ N\\.</b> [^<]+ 0\\.[0-9]{2} "
                       "\\([a-z ]+, [0-9]+ of [0-9]+ N[^<]+\\), ")));
}

TEST(LoadReport, ShowsOnlyThePersonOfThePage) {
  testing::Scenes with_another;
  for (const auto& scene : ShortLift()) {
    auto copy = std::make_shared<SceneState>(*scene);
    copy->people.push_back(copy->people[0]);
    copy->people[1].character = 1;
    for (urdf::Pose& link : copy->people[1].links) link.position.y() += 0.5;
    with_another.push_back(copy);
  }
  const auto picture_of = [](const testing::Scenes& scenes) {
    const TempFolder folder;
    std::map<int, LoadTrial> trials;
    trials.emplace(0, TrialOf(scenes));
    WriteReport(trials, {}, {}, kNoRuns, {}, folder / "report.html");
    const std::string html = testing::ReadFile(folder / "report.html");
    const std::size_t from = html.find("data:image/png");
    return html.substr(from, html.find('"', from) - from);
  };
  EXPECT_TRUE(picture_of(with_another) == picture_of(ShortLift())) << "another person is in it";
}

TEST(LoadReport, ReportsThatNoLoadIsKnown) {
  LoadTrial trial(true, 0);
  AddTo(trial, SceneWithRatio(0, kNoRatioInReport, "no foot contact"));
  trial.Finish();
  const std::string html = ReportOf(trial);
  EXPECT_THAT(html, HasSubstr("<b>No load could be computed at any time.</b>"));
  EXPECT_EQ(CountOf(html, "<img "), 0U);
}

TEST(LoadReport, ShortensTextsThatWouldNeedAnotherPage) {
  TrialContext context;
  context.source = std::string(250, 'W') + ".mvnx";
  const std::string html = ReportOf(TrialWithoutPictures(std::string(300, 'M')), context);
  EXPECT_THAT(html, Not(HasSubstr(std::string(100, 'M'))));
  const std::size_t title = html.find("<h1>");
  EXPECT_LT(html.find("</h1>") - title, 100U);
}

TEST(LoadReport, IsTheSameForTheSameTrial) {
  const auto all_of = [](const LoadTrial& trial) {
    const TempFolder folder;
    std::map<int, LoadTrial> trials;
    trials.emplace(0, trial);
    WriteReport(trials, {}, {}, kNoRuns, {}, folder / "report.html");
    return testing::ReadFile(folder / "report.html");
  };
  EXPECT_EQ(all_of(TrialOf(ShortLift())), all_of(TrialOf(ShortLift())));
}

TEST(LoadReport, AcceptsNamesOfHtmlAndRejectsOthers) {
  CheckReportName("page.html");
  CheckReportName("a.b/page.htm");
  for (const char* name : {"page", "page.png", "page.html.gz", "html"}) {
    try {
      CheckReportName(name);
      ADD_FAILURE() << name << " was accepted";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string("--report=") + name +
                                          ": expected a name that ends in .html, .htm or .pdf"));
    }
  }
}

// So that another person can repeat it, on another machine.
TEST(LoadReport, TellsHowToRepeatItWithoutTheFoldersOfThisMachine) {
  const TempFolder folder;
  std::ofstream(folder / "take one.mvnx") << "content";
  options::Text source, csv;
  options::Number mass(75, {20, 300, "kg"}), height(1.75, {});
  options::OptionList list;
  list("source", source, "");
  list("csv", csv, "");
  list("mass", mass, "");
  list("height", height, "");
  const auto set = [&](const char* name, const std::string& text) {
    list.Set(*list.Find(name), name, {text}, options::Channel::kCommandLine);
  };
  set("csv", (folder / "loads.csv").string());
  set("mass", "82.5");
  const std::string take = (folder / "take one.mvnx").string();
  const ReportOrigin origin = OriginOf(take, IdentityOf(take), list);
  EXPECT_EQ(origin.command, "kinescope loads 'take one.mvnx' --mass 82.5 --report page.html");
  EXPECT_EQ(origin.digest,
            "sha256 ed7002b439e9ac845f22357d822bac1444730fbdb6016d3ec9432297b9ec9f73, 7 bytes");
  EXPECT_EQ(OriginOf("demo:lift", IdentityOf("demo:lift"), list).digest,
            "generated motion, no file");
}

std::string WriteReportError(const std::filesystem::path& path) {
  std::map<int, LoadTrial> trials;
  trials.emplace(0, TrialWithoutPictures());
  try {
    WriteReport(trials, {}, {}, kNoRuns, {}, path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(LoadReport, NamesTheFileAndTheReasonWhenTheDiskIsFull) {
  const TempFolder folder;
  {
    const testing::SmallFilesOnly full(1000);
    EXPECT_THAT(WriteReportError(folder / "report.html"),
                AllOf(HasSubstr((folder / "report.html").string()), EndsWith("File too large")));
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(LoadReport, NamesAFolderThatIsMissing) {
  EXPECT_THAT(WriteReportError("/nowhere/report.html"),
              AllOf(HasSubstr("/nowhere/report.html"), HasSubstr("No such file or directory")));
}

}  // namespace
}  // namespace kinescope::app
