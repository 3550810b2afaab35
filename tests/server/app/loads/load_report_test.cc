// The report of `kinescope loads` as a browser and a reader get it.
#include "server/app/loads/load_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <regex>

#include "server/app/loads/load_rows.h"
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

// Without the pictures' bytes, which no failure has to print.
std::string ReportOf(const std::map<int, LoadTrial>& trials, const TrialContext& context) {
  const TempFolder folder;
  WriteReport(trials, context, {}, folder / "report.html");
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
    if (name.empty() || name == "meta" || name == "img") continue;  // <!DOCTYPE>, void elements
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
  EXPECT_THAT(
      html,
      HasSubstr(
          "Anna (person 0), 40 samples, 4.00 s at 60 Hz, starting at 1970-01-01T00:00:00.000000Z"));
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(CountOf(html, "<tr><td>" + std::string(ScoredLabel(i)) + "</td>"), 1U)
        << ScoredLabel(i);
  }
  for (const char* heading : {"Highest loads", "Exposure", "Load ratio over time",
                              "Assumptions, checks and unknown loads"}) {
    EXPECT_EQ(CountOf(html, std::string("<h2>") + heading + "</h2>"), 1U) << heading;
  }
  for (const char* unit : {"<th>at (s)</th>", "direction (N·m)", "<th>unknown %</th>"}) {
    EXPECT_THAT(html, HasSubstr(unit));
  }
  EXPECT_EQ(CountOf(html, "<img class=\"plot\" alt=\"\" src=\"data:image/svg+xml;base64,"), 1U);
}

TEST(LoadReport, ContainsNoScriptsAndNoExternalLinks) {
  const std::string html = ReportOf(TrialWithoutPictures());
  for (const char* part :
       {"<script", "javascript:", "http:", "https:", "<link", "@import", "url("}) {
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

// Of 4 s the first half had a ratio of 0.2, but for the left elbow, of which nothing was known.
TEST(LoadReport, ShowsSharesOfSamplesAndDashesForUnknownValues) {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 40; ++i) {
    SceneState scene = *ShortLift().back();  // who can be drawn
    scene.stamp_nanos = scene.people[0].sample.stamp_nanos = i * 100'000'000LL;
    for (std::size_t joint = 0; joint < 15; ++joint) {
      JointLoad& load = scene.people[0].loads[joint];
      const bool is_known = i < 20 && joint != 6;
      load.ratio = is_known ? 0.2 : kNoRatioInReport;
      load.load_class = load.band = is_known ? LoadClass::kLow : LoadClass::kUnknown;
      load.channel = "flexion";
      load.deciding_moment = -12.34;
      load.capacity = 61.7;
      load.is_of_compression = false;
    }
    AddTo(trial, scene);
  }
  trial.Finish();
  const std::string html = ReportOf(trial);
  const auto row_of = [&](std::size_t joint) {
    const std::size_t begin = html.find("<tr><td>" + std::string(ScoredLabel(joint)));
    return html.substr(begin, html.find("</tr>", begin) - begin);
  };
  EXPECT_THAT(row_of(5), HasSubstr("<td>100.0</td><td>0.0</td><td>0.0</td><td>50.0</td>"));
  EXPECT_THAT(row_of(5), HasSubstr("<td>0.20</td><td>0.00</td><td>0.00</td><td>0</td>"
                                   "<td class=\"text\">flexion, 12.3 of 61.7</td>"));
  EXPECT_THAT(row_of(5), HasSubstr("<i class=\"low\" style=\"width:50.00%\"></i>"
                                   "<i class=\"unknown\" style=\"width:50.00%\"></i>"));
  EXPECT_THAT(row_of(6), HasSubstr("<td>–</td><td>–</td><td>–</td><td>100.0</td>"
                                   "<td>–</td><td>–</td><td>–</td><td>–</td><td>–</td>"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  EXPECT_THAT(html, Not(HasSubstr("inf")));
}

TEST(LoadReport, ShowsTheGivenClassLimitsInLegendAndBands) {
  TrialContext context;
  context.scene.loads.meter.up = {0.1, 0.25};
  context.scene.loads.compression_counts = false;
  const std::string html = ReportOf(TrialWithoutPictures(), context);
  EXPECT_THAT(html, HasSubstr("ratio up to 0.10"));
  EXPECT_THAT(html, HasSubstr("high, above 0.25"));
  EXPECT_THAT(html, HasSubstr("(compression is switched off here)"));
}

TEST(LoadReport, HasOnePagePerPersonInTheirOrder) {
  std::map<int, LoadTrial> trials;
  trials.emplace(3, TrialWithoutPictures("Ben"));
  trials.emplace(1, TrialWithoutPictures("Anna"));
  const std::string html = ReportOf(trials, {});
  EXPECT_EQ(CountOf(html, "<main>"), 2U);
  EXPECT_LT(html.find("Anna (person"), html.find("Ben (person"));
}

TEST(LoadReport, ShowsTheTimeOfTheHighestLoadWithItsValues) {
  const std::string html = ReportOf(TrialOf(ShortLift()));
  EXPECT_EQ(CountOf(html, "<figure><img alt=\"\" src=\"data:image/png;base64,"), 1U)
      << "a quarter of a second has one moment";
  EXPECT_TRUE(std::regex_search(
      html, std::regex("<figcaption><b>0\\.[0-9]{2} s</b> [^<]+: ([0-9.]+ \\((low|medium|high)\\), "
                       "[a-z ]+, [0-9]+ of [0-9]+ N·m|[0-9]+ N compression \\([a-z]+\\))"
                       "</figcaption>")));
}

TEST(LoadReport, ReportsThatNoLoadIsKnown) {
  EXPECT_THAT(ReportOf(TrialWithoutPictures()),
              HasSubstr("No load could be computed at any time."));
}

std::string WriteReportError(const std::filesystem::path& path) {
  std::map<int, LoadTrial> trials;
  trials.emplace(0, TrialWithoutPictures());
  try {
    WriteReport(trials, {}, {}, path);
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
